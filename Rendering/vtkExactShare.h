// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkExactShare
 * @brief the share of a light that texels see, from the occluders themselves
 *
 * Where few triangles decide what is seen (penumbra::PairPlan::IsExact()), cutting the light along
 * their shadows (penumbra::PolygonVisibility) costs about what counting many samples does, and has
 * no error but rounding. Samples still tell where penumbras are.
 */
#ifndef vtkExactShare_h
#define vtkExactShare_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "PolygonVisibility.h"
#include "TexelRectangle.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"

#include <cstddef> // for std::size_t
#include <vector>  // for shares

class vtkOpenGLRenderWindow;
class vtkStageTexture;

class PENUMBRARENDERING_EXPORT vtkExactShare : public vtkObject
{
public:
  static vtkExactShare* New();
  vtkTypeMacro(vtkExactShare, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Take up a light on a receiver of the given texels. `visibility` is kept by reference; with
   * nullptr there are no exact shares. No rectangle will be larger than `largest`. False, after
   * vtkErrorMacro, if OpenGL refuses.
   */
  bool Begin(const penumbra::PolygonVisibility* visibility, vtkOpenGLRenderWindow* window,
    const glm::ivec2& texels, const glm::ivec2& largest);

  /**
   * Find the shares of the texels of a rectangle that are in a penumbra, or near one: samples that
   * all see the light, or do not, may have missed a part of it. `counted` has what samples say
   * (vtkVisibilityShare); its texel (0, 0) is the receiver's `firstTexel`, and the
   * receiver's texels in `around` are taken from it; it must be the same for the same rectangle,
   * since Begin(). False if there are none. The caller saves and restores vtkOpenGLState around it.
   */
  bool Find(vtkStageTexture* counted, const glm::ivec2& firstTexel,
    const penumbra::TexelRectangle& around, const penumbra::TexelRectangle& rectangle);

  /**
   * The shares; -1 where Find() found none. Its texel (0, 0) is the rectangle's first one.
   */
  vtkStageTexture* GetTexture() { return this->Texture; }

  /**
   * How many texels have got one since Begin().
   */
  std::size_t GetCount() const;

  /**
   * Free the OpenGL resources.
   */
  void ReleaseGraphicsResources();

protected:
  vtkExactShare();
  ~vtkExactShare() override;

private:
  vtkExactShare(const vtkExactShare&) = delete;
  void operator=(const vtkExactShare&) = delete;

  /// The shares of a rectangle's texels, row by row.
  struct Shares
  {
    penumbra::TexelRectangle Rectangle;
    std::vector<float> Values;
    std::size_t Count = 0; ///< of texels that have one
  };

  Shares FindShares(vtkStageTexture* counted, const glm::ivec2& firstTexel,
    const penumbra::TexelRectangle& around, const penumbra::TexelRectangle& rectangle) const;
  /// Finds those of a tile that are wanted; `wanted` says so for each of the shares.
  void FindTile(
    const penumbra::TexelRectangle& tile, const std::vector<bool>& wanted, Shares& shares) const;

  const penumbra::PolygonVisibility* Visibility = nullptr;
  glm::ivec2 Texels{ 1 };
  std::vector<Shares> Found; ///< since Begin(): what is asked for again is not found again
  vtkNew<vtkStageTexture> Texture;
};

#endif

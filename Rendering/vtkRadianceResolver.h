// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceResolver
 * @brief adds what one light sends to a receiver to its radiance texture
 *
 * The closed form of the unoccluded light (vtkClosedForm) times the share of it that each texel
 * sees (vtkVisibilityShare), by vtkRadianceResolveFS.glsl. One instance serves one light on one
 * receiver at a time: Begin(), then
 * - nothing blocks: ResolveUnblocked();
 * - samples decide, all at once: SetSamples(), and ResolveMasks() for the rows whose masks have
 * been drawn;
 * - samples decide, in batches: SetSamples(), CountMasks() for all rows, and again; at last
 *   ResolveCounts().
 *
 * All is done in strips of rows, so that what the stages hand on takes little memory.
 */
#ifndef vtkRadianceResolver_h
#define vtkRadianceResolver_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceTexture.h" // for its Region
#include "vtkWeakPointer.h"     // for vtkWeakPointer

#include <vector> // for samples

class vtkClosedForm;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkVisibilityMask;
class vtkVisibilityShare;

class PENUMBRARENDERING_EXPORT vtkRadianceResolver : public vtkObject
{
public:
  static vtkRadianceResolver* New();
  vtkTypeMacro(vtkRadianceResolver, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// How a light is taken up.
  struct Options
  {
    glm::dvec3 Reflectance{ 1.0 };
    bool InBatches = false;      ///< CountMasks() will be called, not ResolveMasks()
    bool Reconstruction = false; ///< shares are filtered across texels
  };

  /**
   * Take up a light on a receiver of the given texels: `seen`, which is kept by reference, is the
   * light's part in front of the receiver. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
    const penumbra::LightShape& seen, const glm::ivec2& texels, const Options& options);

  /**
   * The samples of the light whose masks will come: see vtkVisibilityShare.
   */
  bool SetSamples(const std::vector<penumbra::LightSample>& samples, int previousCount = 0);

  /**
   * The rows beside those that are resolved whose masks are needed, too.
   */
  int GetHalo() const;

  ///@{
  /**
   * Add the light to the rows [firstRow, lastRow) of a region of `target`: without samples; from
   * masks whose row 0 is the receiver's row `maskFirstRow`; from what was counted. The caller saves
   * and restores vtkOpenGLState around it.
   */
  void ResolveUnblocked(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region);
  void ResolveMasks(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    int firstRow, int lastRow, vtkVisibilityMask* masks, int maskFirstRow);
  void ResolveCounts(
    vtkRadianceTexture* target, const vtkRadianceTexture::Region& region, bool add);
  ///@}

  /**
   * Count the masks of the rows [firstRow, lastRow), which begin with row `maskFirstRow`.
   */
  void CountMasks(vtkVisibilityMask* masks, int maskFirstRow, int firstRow, int lastRow);

  /**
   * The bytes that the textures between the stages take.
   */
  std::size_t GetBytes() const;

  /**
   * Free the OpenGL resources.
   */
  void ReleaseGraphicsResources();

protected:
  vtkRadianceResolver();
  ~vtkRadianceResolver() override;

private:
  vtkRadianceResolver(const vtkRadianceResolver&) = delete;
  void operator=(const vtkRadianceResolver&) = delete;

  /// 1 for the components that the share of the given index is of: all, if there is one share
  /// alone.
  glm::dvec3 GetChannels(int share) const;

  /// What a strip's shares are in.
  enum class Shares
  {
    None,
    Strip, ///< of the strip and its halo alone
    All
  };
  void ResolveStrip(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    int firstRow, int lastRow, Shares shares, bool add);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkShaderProgram* Program = nullptr; ///< the window's
  Options Chosen;
  glm::ivec2 Texels{ 1 };
  int StripRows = 1;
  /// The components whose shares differ, each with its own: 3, if a light's cells differ in hue.
  int ShareCount = 1;
  vtkNew<vtkClosedForm> ClosedForm;
  vtkNew<vtkVisibilityShare> Share[3];
};

#endif

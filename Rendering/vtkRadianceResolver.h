// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceResolver
 * @brief adds what one light sends to a receiver to its radiance texture
 *
 * The closed form of the unoccluded light (vtkClosedForm) times the share of it that each texel
 * sees (vtkVisibilityShare), by vtkRadianceResolveFS.glsl. One instance serves one light on one
 * receiver at a time: Begin(), then ResolveUniform() for what no shadow reaches, and for the rest
 * - samples at once: SetSamples(), and ResolveMasks() for the rows whose masks have been drawn;
 * - samples in batches, or whose shares are to be kept: SetSamples(), CountMasks(), and again; at
 *   last ResolveCounts();
 * - shares that were kept: ResolveCounts().
 *
 * All is done in strips of rows, so that what the stages hand on takes little memory.
 */
#ifndef vtkRadianceResolver_h
#define vtkRadianceResolver_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "TexelRectangle.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceTexture.h" // for its Region
#include "vtkSmartPointer.h"    // for vtkSmartPointer
#include "vtkVisibilityShare.h" // for shares that are kept
#include "vtkWeakPointer.h"     // for vtkWeakPointer

#include <array>  // for shares
#include <vector> // for samples

class vtkClosedForm;
class vtkExactShare;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkVisibilityMask;

namespace penumbra
{
class PolygonVisibility;
}

class PENUMBRARENDERING_EXPORT vtkRadianceResolver : public vtkObject
{
public:
  static vtkRadianceResolver* New();
  vtkTypeMacro(vtkRadianceResolver, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The shares of one light that outlast a bake: for light whose radiance changes, and for the part
   * of a receiver that no change reaches.
   */
  struct KeptShares
  {
    std::array<vtkSmartPointer<vtkVisibilityShare>, 3> Shares; ///< as many as the light needs
    penumbra::TexelRectangle Stored;                           ///< of the receiver's texels

    std::size_t GetBytes() const;
    int GetCount() const;
    void Release();
    /// Make room for others, too; these are wholly seen.
    bool Extend(const penumbra::TexelRectangle& needed);
  };

  /// How a light is taken up.
  struct Options
  {
    glm::dvec3 Reflectance{ 1.0 };
    bool Reconstruction = false; ///< shares are filtered across texels
    bool InBatches = false;      ///< CountMasks() will be called, not ResolveMasks()
    bool Translucent = false;    ///< SetTransmittances() will be called before masks come
    bool Tinted = false;         ///< and components may differ in what passes
    /// Where shares are kept; they are made here if there are none. Implies InBatches.
    KeptShares* Kept = nullptr;
  };

  /**
   * Take up a light on a receiver of the given texels: `seen`, which is kept by reference, is the
   * light's part in front of the receiver. `resolved` bounds the texels that will be asked for, and
   * `shaded` is where samples decide. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
    const penumbra::LightShape& seen, const glm::ivec2& texels,
    const penumbra::TexelRectangle& resolved, const penumbra::TexelRectangle& shaded,
    const Options& options);

  /**
   * The samples of the light whose masks will come: see vtkVisibilityShare.
   */
  bool SetSamples(const std::vector<penumbra::LightSample>& samples, int previousCount = 0);

  /**
   * What each translucent surface lets through whose masks will come, in their order.
   */
  bool SetTransmittances(const std::vector<glm::dvec3>& transmittances);

  ///@{
  /**
   * The texels around those that are resolved whose masks are needed, too; with Reconstruction.
   */
  int GetHalo() const;
  static int GetReconstructionHalo();
  ///@}

  ///@{
  /**
   * How many shares a light takes that may be tinted on its way, and their bytes for a texel.
   */
  static int CountShares(const penumbra::LightShape& light, bool tinted);
  static std::size_t GetKeptBytesPerTexel(const penumbra::LightShape& light, bool tinted);
  ///@}

  ///@{
  /**
   * The texels whose masks are needed to resolve some others.
   */
  penumbra::TexelRectangle GetMaskRectangle(const penumbra::TexelRectangle& resolved) const;
  static penumbra::TexelRectangle GetMaskRectangle(const penumbra::TexelRectangle& resolved,
    const penumbra::TexelRectangle& shaded, bool reconstruction, const glm::ivec2& texels);
  ///@}

  ///@{
  /**
   * Add the light to a rectangle of the receiver's texels in a region of `target`: where all of
   * them see the same share of it, 0 or 1; from masks whose texel (0, 0) is the receiver's
   * `maskFirstTexel`; from what was counted. The caller saves and restores vtkOpenGLState around
   * it.
   */
  void ResolveUniform(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    const penumbra::TexelRectangle& rectangle, float share);
  void ResolveMasks(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    const penumbra::TexelRectangle& rectangle, vtkVisibilityMask* masks,
    const glm::ivec2& maskFirstTexel);
  void ResolveCounts(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    const penumbra::TexelRectangle& rectangle, bool add);
  ///@}

  /**
   * Count the masks of a rectangle of texels.
   */
  void CountMasks(vtkVisibilityMask* masks, const glm::ivec2& maskFirstTexel,
    const penumbra::TexelRectangle& rectangle);

  /**
   * From now on, find the shares within penumbras by `exact`, which is kept by reference: what was
   * counted says where penumbras are, and must not change any more. All components get the same
   * share. nullptr, as after Begin(): by samples. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool SetExact(const penumbra::PolygonVisibility* exact);

  /**
   * How many texels have got such a share since then.
   */
  std::size_t GetExactCount() const;

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

  /// Where the shares of a strip are.
  struct StripShares
  {
    float Uniform = 1.0f; ///< without textures
    bool HasTextures = false;
    glm::ivec2 FirstTexel{ 0 }; ///< the receiver's texel that is (0, 0) of the textures
  };
  void ResolveStrip(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region,
    const penumbra::TexelRectangle& strip, const StripShares& shares, bool add);
  /// Calls use(strip) for each strip of the rectangle.
  template <typename Use>
  void ForEachStrip(const penumbra::TexelRectangle& rectangle, const Use& use);
  vtkVisibilityShare* GetShare(int index);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkShaderProgram* Program = nullptr; ///< the window's
  Options Chosen;
  glm::ivec2 Texels{ 1 };
  penumbra::TexelRectangle Shaded;
  penumbra::TexelRectangle Stored; ///< of the textures of CountMasks()
  glm::ivec2 StripSize{ 1 };       ///< of the largest strip
  /// The components whose shares differ, each with its own: 3, if a light's cells differ in hue or
  /// what it passes is tinted.
  int ShareCount = 1;
  vtkNew<vtkClosedForm> ClosedForm;
  vtkNew<vtkVisibilityShare> Share[3];
  vtkNew<vtkExactShare> Exact;
};

#endif

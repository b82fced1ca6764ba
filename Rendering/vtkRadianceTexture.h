// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceTexture
 * @brief the radiance of the receivers of one surface, as a texture
 *
 * An atlas: each receiver has a region of texels. Per texel it holds, in single precision, the
 * irradiance over pi from all lights (three components), what is blocked of it (in the mean of the
 * components), and the variance of the mean of the three once they are reflected: 20 bytes.
 *
 * The gutter around each region of an atlas of several (penumbra::AtlasLayout) repeats its border.
 * Triangles may share a slot: what is drawn in a region then leaves the other one's side alone.
 */
#ifndef vtkRadianceTexture_h
#define vtkRadianceTexture_h

#include "AtlasLayout.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer
#include "vtkWeakPointer.h"  // for vtkWeakPointer

#include "TexelRectangle.h"
#include <vector> // for texels

class vtkOpenGLFramebufferObject;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkTextureObject;

class PENUMBRARENDERING_EXPORT vtkRadianceTexture : public vtkObject
{
public:
  static vtkRadianceTexture* New();
  vtkTypeMacro(vtkRadianceTexture, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  using Region = penumbra::AtlasRegion;

  /// What Download() gives of a region, i (along EdgeX) fastest.
  struct Texels
  {
    std::vector<glm::vec4> Irradiance; ///< over pi; a: what is blocked, in the mean
    std::vector<float> Variance;
  };

  /**
   * Make room for receivers of the given sizes in texels, all black; with or without variance. Of
   * those that are said to be triangles, texels may be left out that belong to their other half.
   * False, after vtkErrorMacro, if they do not fit into one texture or OpenGL refuses.
   */
  bool Allocate(vtkOpenGLRenderWindow* window,
    const std::vector<penumbra::AtlasReceiver>& receivers, bool withVariance = true);

  /**
   * Exchange the textures, and what is in them, with another one of the same window.
   */
  void Swap(vtkRadianceTexture* other);

  /**
   * Copy a region, with its gutter, of another one that has variance if this one has, to one of its
   * shape (penumbra::AtlasRegion::HasShapeOf).
   */
  void CopyRegion(vtkRadianceTexture* source, const Region& from, const Region& to);

  /**
   * Whether there is a texture: not before Allocate(), and not once its window has freed it.
   */
  bool IsAllocated() const;

  /**
   * The receivers' places, in the order that Allocate() has them in.
   */
  const std::vector<Region>& GetRegions() const { return this->Layout.Regions; }

  /**
   * Width and height of the whole texture.
   */
  const glm::ivec2& GetSize() const { return this->Layout.Size; }

  /**
   * Run a shader that is ready, and that two outputs are for (vtkRadianceResolveFS.glsl and
   * vtkRadianceDownsampleFS.glsl say which), on a rectangle of a region's texels, with the gutter
   * beyond what of the region's border is in it. With `add`, what is drawn adds to what is there.
   * The caller saves and restores vtkOpenGLState around it.
   */
  void Draw(vtkShaderProgram* program, const Region& region,
    const penumbra::TexelRectangle& rectangle, bool add);

  /**
   * Make a rectangle of a region's texels black again, with the gutter beyond it.
   */
  void Clear(const Region& region, const penumbra::TexelRectangle& rectangle);

  /**
   * Fill a rectangle of a region from a texture that is `factor` times finer, whose own texel (0,
   * 0) is `fineFirst` of the receiver's finer ones. False, after vtkErrorMacro, if OpenGL refuses
   * the shader.
   */
  bool Downsample(vtkRadianceTexture* fine, const glm::ivec2& fineFirst, const Region& region,
    const penumbra::TexelRectangle& rectangle, int factor);

  /**
   * Add what a window of finer texels (penumbra::FineWindow) changes in a rectangle of a region.
   * `texels` has those of the window that are in `fine`, `factor` times as many as the region's
   * along each axis, and `without` what the rectangle holds without the window; nullptr: this
   * counts for nothing. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool AddMeans(vtkRadianceTexture* texels, vtkRadianceTexture* without, const glm::ivec2& factor,
    const penumbra::TexelRectangle& fine, const Region& region,
    const penumbra::TexelRectangle& rectangle);

  ///@{
  /**
   * How many times as long as wide the part of the texture may be that a pixel shows, as floors
   * have it near the horizon, without being blurred to its length. 1 is the cheapest and takes the
   * nearest mip level; more blends two levels. Takes effect with the next GenerateMipmaps().
   * Default is 0: 16 on graphics processors, 1 where OpenGL is software. Levels of an atlas of
   * several receivers are blended, but not anisotropic.
   */
  void SetMaximumAnisotropy(int ratio);
  int GetMaximumAnisotropy() const { return this->MaximumAnisotropy; }
  ///@}

  /**
   * Make the mip levels of the irradiance, after the last region is filled, to show it. False,
   * after vtkErrorMacro, if OpenGL refuses.
   */
  bool GenerateMipmaps();

  /**
   * Free them.
   */
  void ReleaseMipmaps();

  /**
   * Make the mip levels of a texture with this one's layout, and set its filter. False, after
   * vtkErrorMacro, if OpenGL refuses.
   */
  bool GenerateMipmaps(vtkTextureObject* texture);

  /**
   * The texels of a texture with this layout, with or without mip levels.
   */
  std::size_t CountTexels(bool withMipmaps) const;

  /**
   * Read a region back; without variance, if there is none. Texels that the region does not own
   * (penumbra::AtlasRegion::Owns) are another receiver's.
   */
  Texels Download(const Region& region);

  bool GetHasVariance() const { return this->HasVariance; }

  /**
   * The texture of irradiance: GL_RGBA32F.
   */
  vtkTextureObject* GetIrradiance();

  /**
   * The bytes that the textures take, mip levels among them.
   */
  std::size_t GetBytes() const;

  /**
   * Free the textures.
   */
  void ReleaseGraphicsResources();

protected:
  vtkRadianceTexture();
  ~vtkRadianceTexture() override;

private:
  vtkRadianceTexture(const vtkRadianceTexture&) = delete;
  void operator=(const vtkRadianceTexture&) = delete;

  void BindAsTarget(bool add);
  /// Calls action() for each part of the rectangle's place that is the region's own, cut to it.
  template <typename Action>
  void ForEachPart(
    const Region& region, const penumbra::TexelRectangle& rectangle, const Action& action);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkSmartPointer<vtkTextureObject> Irradiance;
  vtkSmartPointer<vtkTextureObject> Variance;
  vtkNew<vtkOpenGLFramebufferObject> Framebuffer;
  penumbra::AtlasLayout Layout;
  int MaximumAnisotropy = 0;
  bool HasVariance = false;
  bool HasMipmaps = false;
};

#endif

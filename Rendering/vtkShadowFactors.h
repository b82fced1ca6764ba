// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowFactors
 * @brief what shadows multiply the diffuse shade of receivers by, as a texture to be shown
 *
 * Of each texel of a vtkRadianceTexture, the radiance relative to what it would be unblocked, in
 * the mean of the components; 1 where no light could arrive. The layout is the radiance's, with its
 * gutters, and there are mip levels.
 *
 * Texels take 4 bytes (GL_RGB10_A2) and hold the factor over GetScale(), so the step is
 * GetScale() / 1023. An 8-bit frame has 255 levels: half of a step is 255 / 2046 of a level, an
 * eighth, where all light is grey (scale 1), and at most three times that.
 */
#ifndef vtkShadowFactors_h
#define vtkShadowFactors_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include "Vectors.h"
#include <vector> // for what regions have

class vtkOpenGLFramebufferObject;
class vtkOpenGLRenderWindow;
class vtkRadianceTexture;
class vtkTextureObject;

class PENUMBRARENDERING_EXPORT vtkShadowFactors : public vtkObject
{
public:
  static vtkShadowFactors* New();
  vtkTypeMacro(vtkShadowFactors, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Make the texture. False, after vtkErrorMacro, if OpenGL refuses. The caller saves and restores
   * vtkOpenGLState around it.
   *
   * @param radiance what was baked
   * @param ambient of each of its regions, the ambient radiance that comes in
   * @param largest a bound of the factors: see GetLargestFactor()
   */
  bool Make(vtkOpenGLRenderWindow* window, vtkRadianceTexture* radiance,
    const std::vector<glm::dvec3>& ambient, double largest);

  /**
   * The largest factor of light of one hue: its largest component over their mean, 1 to 3.
   *
   * A factor is a sum over what arrives, of one component, over the sum of the means of that and of
   * what is blocked: no more than the largest of the summands' own ratios, hence no more than the
   * largest of this over the lights and the ambient radiance.
   */
  static double GetLargestFactor(const glm::dvec3& light);
  /// The same of light of any hue.
  static constexpr double LargestFactor = 3.0;

  /**
   * The texture, whose values are to be multiplied by GetScale().
   */
  vtkTextureObject* GetTexture() { return this->Texture; }
  float GetScale() const { return this->Scale; }

  /**
   * The bytes that the texture takes, mip levels among them.
   */
  std::size_t GetBytes() const { return this->Bytes; }

  /**
   * Free the texture.
   */
  void ReleaseGraphicsResources();

protected:
  vtkShadowFactors();
  ~vtkShadowFactors() override;

private:
  vtkShadowFactors(const vtkShadowFactors&) = delete;
  void operator=(const vtkShadowFactors&) = delete;

  void BindAsTarget(const glm::ivec2& size);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkTextureObject> Texture;
  vtkNew<vtkOpenGLFramebufferObject> Framebuffer;
  float Scale = 1.0f;
  std::size_t Bytes = 0;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkVisibilityMask
 * @brief per texel of a receiver, one bit per light sample: 1 where the sample is blocked
 *
 * The occluders are drawn once for every 32 samples, one instance a sample, each with the
 * registered projection of its own, into a layer of an integer texture whose logic op ORs the bits
 * (DESIGN 5). There is nothing to accumulate: the bits do not depend on the order of the triangles
 * or of the samples. Each translucent surface has bits of its own, beside those of all that is
 * opaque: its transmittance weighs a sample once.
 *
 * Needs no more than OpenGL 3.2. The caller saves and restores vtkOpenGLState around it.
 */
#ifndef vtkVisibilityMask_h
#define vtkVisibilityMask_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "RegisteredProjection.h"
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include <vector> // for the projections

class vtkOccluderGeometry;
class vtkOpenGLRenderWindow;

class PENUMBRARENDERING_EXPORT vtkVisibilityMask : public vtkObject
{
public:
  static vtkVisibilityMask* New();
  vtkTypeMacro(vtkVisibilityMask, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Samples that one layer holds.
  static constexpr int SamplesPerLayer = 32;

  /**
   * Make room for `samples` samples of `sets` sets of occluders at so many texels: of each set, 4
   * bytes for every 32 samples of a texel. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Allocate(
    vtkOpenGLRenderWindow* window, const glm::ivec2& size, int samples, std::size_t sets);

  /**
   * Draw the masks of a receiver of `texels` from its texel `firstTexel` on, as many as were
   * allocated, for as many sets of occluders. There must be as many projections as samples; those
   * from `firstSample` up to `endSample` are drawn, and of a layer the first ones first. What is
   * drawn in one rectangle is, to the bit, what is drawn in any other that holds the same texels,
   * if no triangle reaches up to a sample. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Draw(vtkOccluderGeometry* occluders,
    const std::vector<penumbra::RegisteredProjection>& projections, const glm::ivec2& texels,
    const glm::ivec2& firstTexel, int firstSample, int endSample);

  /**
   * The texture: GL_TEXTURE_2D_ARRAY of GL_R32UI; sample s is bit s % 32 of layer s / 32, counted
   * from the first layer of the set; sets follow each other.
   */
  unsigned int GetTexture() const { return this->Texture; }

  /**
   * The most samples that the window's OpenGL can hold for so many sets, 32 per layer.
   */
  static int GetMaximumSamples(vtkOpenGLRenderWindow* window, std::size_t sets);

  /**
   * The bytes of the texture.
   */
  std::size_t GetBytes() const;

  /**
   * Free the texture. The window must be current.
   */
  void ReleaseGraphicsResources();

protected:
  vtkVisibilityMask();
  ~vtkVisibilityMask() override;

private:
  vtkVisibilityMask(const vtkVisibilityMask&) = delete;
  void operator=(const vtkVisibilityMask&) = delete;

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  unsigned int Texture = 0;
  unsigned int Framebuffer = 0;
  glm::ivec2 Size{ 0 };
  int Sets = 1;
  int LayersOfSet = 1;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkVisibilityShare
 * @brief the share of a light that each texel of a receiver sees, counted from masks
 *
 * Of one light on one receiver: Begin(), then SetSamples() and Count() for the rows whose masks
 * have been drawn (vtkVisibilityShareFS.glsl). More samples may follow: the answer is then, to the
 * bit, that of all samples at once. Where translucent surfaces weaken the light, samples are
 * weighed by what these let through, by another variant of the shader.
 */
#ifndef vtkVisibilityShare_h
#define vtkVisibilityShare_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "TexelRectangle.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include <vector> // for samples

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkStageTexture;
class vtkTextureObject;
class vtkVisibilityMask;

class PENUMBRARENDERING_EXPORT vtkVisibilityShare : public vtkObject
{
public:
  static vtkVisibilityShare* New();
  vtkTypeMacro(vtkVisibilityShare, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * How many samples there are after each of the batches that so many may come in: half of them,
   * rounded up, before the last one, and so on, but no fewer than 64 if there are as many.
   */
  static std::vector<int> GetBatchEnds(int samples);

  /**
   * Take up a light on a receiver of the given texels: `seen` is its part in front of the receiver.
   * The textures have the given size: that of all rectangles, if the samples will come in batches.
   * With `translucent`, SetTransmittances() will be called. False, after vtkErrorMacro, if OpenGL
   * refuses.
   */
  bool Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
    const penumbra::LightShape& seen, const glm::ivec2& texels, const glm::ivec2& size,
    bool inBatches, bool translucent);

  /**
   * The samples. The first half (the greater, if their number is odd) and the second must each be
   * spread over the light. If `previousCount` of them, as GetBatchEnds() has it, were counted
   * before, masks will come of the others alone, and of so many earlier ones that the first is a
   * multiple of vtkVisibilityMask::SamplesPerLayer. Of Emission::Cells, `channels` says which
   * components of their power count. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool SetSamples(const std::vector<penumbra::LightSample>& samples, const glm::dvec3& channels,
    int previousCount);

  /**
   * What the translucent surfaces let through whose masks will come, in their order, of the light
   * that this share is of. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool SetTransmittances(const std::vector<double>& transmittances);

  /**
   * Count a rectangle of the receiver's texels into the texture, where the receiver's texel
   * `firstTexel` is (0, 0). Of the masks, that is `maskFirstTexel`. The caller saves and restores
   * vtkOpenGLState around it.
   */
  void Count(vtkVisibilityMask* masks, const glm::ivec2& maskFirstTexel,
    const penumbra::TexelRectangle& rectangle, const glm::ivec2& firstTexel);

  /**
   * Make the texture that of another rectangle of the receiver's texels. What was in the old one
   * stays; the rest is wholly seen. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Extend(const penumbra::TexelRectangle& from, const penumbra::TexelRectangle& to);

  /**
   * In r, the share; in g, half of what the halves differ by; in batches, the sums in b and a.
   */
  vtkStageTexture* GetTexture();

  /**
   * The bytes that the textures take.
   */
  std::size_t GetBytes() const;

  /**
   * Free what counting needs, and keep what was counted. Textures know their window; buffers would
   * be freed in whatever context is current when they go.
   */
  void ReleaseSamples();

  /**
   * Free the OpenGL resources.
   */
  void ReleaseGraphicsResources();

protected:
  vtkVisibilityShare();
  ~vtkVisibilityShare() override;

private:
  vtkVisibilityShare(const vtkVisibilityShare&) = delete;
  void operator=(const vtkVisibilityShare&) = delete;

  bool UploadBuffer(
    vtkOpenGLBufferObject* buffer, vtkTextureObject* texture, const std::vector<glm::vec4>& values);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkShaderProgram* Program = nullptr; ///< the window's
  penumbra::ReceiverFrame Frame;
  glm::ivec2 Texels{ 1 };
  double LengthUnit = 1.0; ///< of the places in Samples, in units of the metric frame
  bool HasCells = false;
  bool IsTranslucent = false;
  int TranslucentCount = 0;
  glm::dvec3 Power{ 0.0 }; ///< of the light's cells
  int Components = 2;
  int SampleCount = 0;
  int PreviousCount = 0;
  vtkNew<vtkOpenGLBufferObject> SampleBuffer, CellBuffer, TransmittanceBuffer;
  vtkNew<vtkTextureObject> Samples, Cells, Transmittances;
  /// The one that is counted into, and the answer of earlier samples.
  vtkNew<vtkStageTexture> Textures[2];
  int Current = 0; ///< the former
};

#endif

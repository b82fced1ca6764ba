// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceBaker
 * @brief bakes receivers, from plan to texture
 *
 * For each receiver: its frame, the lights in front of it, what each needs (penumbra::PlanEffect),
 * the occluders between them; then, light by light, masks are drawn (vtkVisibilityMask) and
 * resolved (vtkRadianceResolver) into one texture. The view's pass and the RadianceMap filter both
 * bake by this class, so that the same scene gives the same texels, bit for bit.
 *
 * Nothing is read back, but for ErrorTolerance. Masks are drawn in bands of rows of at most
 * MaximumMaskBytes.
 */
#ifndef vtkRadianceBaker_h
#define vtkRadianceBaker_h

#include "EffectPlanner.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceResolver.h" // for its Options

#include <string> // for reports
#include <vector> // for reports

class vtkOccluderGeometry;
class vtkOpenGLRenderWindow;
class vtkRadianceTexture;
class vtkVisibilityMask;

class PENUMBRARENDERING_EXPORT vtkRadianceBaker : public vtkObject
{
public:
  static vtkRadianceBaker* New();
  vtkTypeMacro(vtkRadianceBaker, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The most bytes that masks take at a time, but for one row of texels with its neighbours. It
   * changes no texel. Default is DefaultMaskBytes.
   */
  static constexpr std::size_t DefaultMaskBytes = std::size_t{ 128 } * 1024 * 1024;
  void SetMaximumMaskBytes(std::size_t bytes) { this->MaximumMaskBytes = bytes; }
  std::size_t GetMaximumMaskBytes() const { return this->MaximumMaskBytes; }
  ///@}

  /// What was done for one receiver.
  struct Report
  {
    /// Index into the scene's receivers.
    std::size_t Receiver = 0;
    /// False, after vtkErrorMacro, if OpenGL refused something: the texels mean nothing.
    bool IsComplete = false;
    /// Of each light of the scene, in the scene's order.
    std::vector<penumbra::Effect> Effects;
    /// Of each light: the samples that were drawn; 0 where none were needed.
    std::vector<int> LightSamples;
    /// The property that decided how many samples were taken: "LightSamples",
    /// "SolidAnglePerSample", "ErrorTolerance" or "MaximumLightSamples".
    std::string StoppedBy;
    /// Of each light: the triangles that could block it.
    std::vector<std::size_t> Triangles;
    /// Bytes of masks and textures at their peak, before any is made to be shown.
    std::size_t PeakBytes = 0;
    /// Seconds until OpenGL had finished.
    double Seconds = 0.0;
  };

  /**
   * Bake the receivers with the given indices into `texture`, whose regions are in their order.
   * `window` must be current. The answer has a report for each; it is empty, after vtkErrorMacro,
   * if the texture could not be made or there is no OpenGL context.
   */
  std::vector<Report> Bake(const penumbra::ShadowScene& scene,
    const std::vector<std::size_t>& receivers, vtkOpenGLRenderWindow* window,
    vtkRadianceTexture* texture);

protected:
  vtkRadianceBaker();
  ~vtkRadianceBaker() override;

private:
  vtkRadianceBaker(const vtkRadianceBaker&) = delete;
  void operator=(const vtkRadianceBaker&) = delete;

  struct Job;
  Report BakeReceiver(const penumbra::ShadowScene& scene, std::size_t receiver,
    vtkOpenGLRenderWindow* window, vtkRadianceTexture* texture, std::size_t region);
  bool BakeLights(Job& job);
  bool BakeLight(Job& job, std::size_t light, int count);
  /// ErrorTolerance: more samples for the lights, until they have enough of them.
  bool RefineLights(Job& job);
  bool RefineLight(Job& job, std::size_t light, double allowed, vtkRadianceTexture* scratch);
  /// Draws masks in bands of rows and calls use(firstRow, lastRow, maskFirstRow) for each.
  template <typename Use>
  bool DrawMasks(Job& job, const std::vector<penumbra::LightSample>& samples, const Use& use);
  vtkRadianceResolver::Options GetOptions(const Job& job) const;

  std::size_t MaximumMaskBytes = DefaultMaskBytes;
  vtkNew<vtkOccluderGeometry> Occluders;
  vtkNew<vtkVisibilityMask> Masks;
  vtkNew<vtkRadianceResolver> Resolver;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceBaker
 * @brief bakes receivers, from plan to texture
 *
 * For each receiver: what each light needs (penumbra::PlanReceiver); then, light by light, masks
 * are drawn (vtkVisibilityMask) and resolved (vtkRadianceResolver) into one texture. The view's
 * pass and the RadianceMap filter both bake by this class, so that the same scene gives the same
 * texels, bit for bit; whether a receiver is baked at once or in parts changes no bit either.
 *
 * Nothing is read back, but for ErrorTolerance and exact shares. Masks cover what shadows can
 * reach, and are drawn in bands of rows of at most MaximumMaskBytes.
 */
#ifndef vtkRadianceBaker_h
#define vtkRadianceBaker_h

#include "EffectPlanner.h"
#include "OccluderSelector.h"
#include "PartMasks.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "PolygonVisibility.h"
#include "ShadowScene.h"
#include "TexelRectangle.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceResolver.h" // for its Options
#include "vtkRadianceTexture.h"  // for its Region
#include "vtkSmartPointer.h"     // for masks

#include <optional>
#include <set>    // for warnings
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

  /// What was done for one light on a receiver.
  struct PairReport
  {
    penumbra::Effect Effect = penumbra::Effect::None;
    std::string Reason;        ///< of the effect
    int LightSamples = 0;      ///< that were drawn; 0 where none were needed
    std::size_t Texels = 0;    ///< that masks were drawn for
    std::size_t Triangles = 0; ///< that could block the light, of SceneTriangles
    std::size_t SceneTriangles = 0;
    double Milliseconds = 0.0;   ///< until OpenGL had finished
    std::size_t Bytes = 0;       ///< of masks and of what is between them and the texture
    std::size_t ExactTexels = 0; ///< whose shares were cut out of the light: PairPlan::IsExact()
  };

  /// What was done for one receiver.
  struct Report
  {
    /// Index into the scene's receivers.
    std::size_t Receiver = 0;
    /// False, after vtkErrorMacro, if OpenGL refused something: the texels mean nothing.
    bool IsComplete = false;
    /// Of each light of the scene, in the scene's order.
    std::vector<PairReport> Pairs;
    /// The property that decided how many samples were taken: "LightSamples",
    /// "SolidAnglePerSample", "ErrorTolerance" or "MaximumLightSamples".
    std::string StoppedBy;
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

  /// The report of a receiver for which nothing has been done yet but its plan.
  static Report MakeReport(
    const penumbra::ReceiverPlan& plan, const penumbra::ShadowScene& scene, std::size_t receiver);

  /// Adds what was done for a window to the report of its receiver.
  static void AddReport(const Report& window, Report& receiver);

  /// What is kept of a light between bakes of a receiver. Within Shares.Stored, all shares but the
  /// stale ones are those that a whole bake of the present scene would count.
  struct KeptLight
  {
    vtkRadianceResolver::KeptShares Shares;
    penumbra::TexelRectangle Stale; ///< of the shares: what has to be drawn anew
  };

  /// How much of a receiver is baked, and how.
  struct Part
  {
    penumbra::TexelRectangle Rectangle; ///< of the receiver's texels
    int MostSamples = 0; ///< of each light; 0: as many as the receiver's settings ask
    /// Of each light of the scene; nullptr: nothing is kept. Lights with shares are not drawn, but
    /// for what is stale; others leave theirs if they fit into KeptBytes.
    std::vector<KeptLight>* Kept = nullptr;
    std::size_t KeptBytes = 0;
    /// What masks may take together with what is kept: bands of them get lower for it.
    std::size_t MaskAndKeptBytes = 0;
    /// Those of DrawMasksUntil(), when it is done; nullptr: they are drawn as they are needed.
    const penumbra::PartMasks* Masks = nullptr;
    /// Whether the receiver's texels hold the mean of its windows; else, these are shown, and it
    /// has no small shadows.
    bool TakesMeans = true;
  };

  ///@{
  /**
   * For those who bake in parts: take up a scene, which is kept by reference; plan one of its
   * receivers; bake a part of it into a region of `texture`, where the rest of the region stays as
   * it is. `window` must be current. Receivers with an ErrorTolerance are baked whole.
   */
  void SetScene(const penumbra::ShadowScene& scene);
  penumbra::ReceiverPlan Plan(std::size_t receiver);
  penumbra::ReceiverPlan PlanWindow(
    const penumbra::Receiver& window, const penumbra::ReceiverPlan& parent);
  Report BakePart(const penumbra::ReceiverPlan& plan, std::size_t receiver,
    vtkOpenGLRenderWindow* window, vtkRadianceTexture* texture, std::size_t region,
    const Part& part);
  ///@}

  /**
   * Draw masks of a part, some samples at a time, until it is late: heavy occluders may take longer
   * than a frame should. `until` is in vtkTimerLog::GetUniversalTime()'s seconds. What BakePart()
   * makes of them is the same, to the bit.
   */
  penumbra::DrawProgress DrawMasksUntil(double until, const penumbra::ReceiverPlan& plan,
    std::size_t receiver, vtkOpenGLRenderWindow* window, const penumbra::TexelRectangle& rectangle,
    penumbra::PartMasks& masks);

  /**
   * Free what bakes share. The window must be current.
   */
  void ReleaseGraphicsResources();

protected:
  vtkRadianceBaker();
  ~vtkRadianceBaker() override;

private:
  vtkRadianceBaker(const vtkRadianceBaker&) = delete;
  void operator=(const vtkRadianceBaker&) = delete;

  struct Job;
  /// Its masks and texels, for a receiver that may be a window of the scene's.
  Report BakeRectangle(const penumbra::ReceiverPlan& plan, const penumbra::Receiver& receiver,
    std::size_t index, vtkOpenGLRenderWindow* window, vtkRadianceTexture* texture,
    const vtkRadianceTexture::Region& region, const Part& part);
  /// Whether OpenGL has drawn all that it was told to since this was last asked; says so if not.
  bool HasDrawn();
  bool BakeReceiver(Job& job, vtkRadianceTexture* texture, const vtkRadianceTexture::Region& place);
  ///@{
  /// What windows give in place of the receiver's own texels.
  bool BakeWindows(Job& job);
  void WarnOfGrowth(const penumbra::WindowPlan& fine, std::size_t receiver);
  bool BakeWithout(Job& job, const penumbra::TexelRectangle& rectangle, vtkRadianceTexture* target,
    const vtkRadianceTexture::Region& region);
  bool BakeWindow(
    Job& job, const penumbra::FineWindow& window, const penumbra::TexelRectangle& rectangle);
  ///@}
  bool BakeLights(Job& job);
  bool BakeLight(Job& job, std::size_t light, int count);
  bool BakeShaded(Job& job, std::size_t light, int count);
  /// Whether a light's shares are kept; they are then made to fit.
  bool MayKeep(Job& job, std::size_t light);
  bool BakeFromKept(Job& job, std::size_t light, int count, const penumbra::TexelRectangle& shaded);
  bool SelectOccluders(
    const Job& job, std::size_t light, const penumbra::TexelRectangle& rectangle);
  bool SetTransmittances(const Job& job, std::size_t light);
  penumbra::DrawProgress DrawLightUntil(
    double until, Job& job, std::size_t light, penumbra::PartMasks::LightMasks& masks);
  bool UseMasks(Job& job, std::size_t light, const std::vector<penumbra::LightSample>& samples,
    const penumbra::TexelRectangle& shaded);
  /// ErrorTolerance: more samples for the lights, until they have enough of them.
  bool RefineLights(Job& job);
  bool RefineLight(Job& job, std::size_t light, double allowed, vtkRadianceTexture* scratch);
  /// Draws masks in bands of the rectangle's rows, with what GetMaskRectangle() adds around them if
  /// `withHalo`, and calls use(band, maskFirstTexel) for each.
  template <typename Use>
  bool DrawMasks(Job& job, std::size_t light, const std::vector<penumbra::LightSample>& samples,
    const penumbra::TexelRectangle& rectangle, bool withHalo, const Use& use);
  vtkRadianceResolver::Options GetOptions(const Job& job, std::size_t light) const;
  /// Has penumbras' shares found exactly, or not, as the plan says for so many samples.
  bool ChooseExact(const Job& job, std::size_t light, int samples);

  std::size_t MaximumMaskBytes = DefaultMaskBytes;
  const penumbra::ShadowScene* Scene = nullptr;
  penumbra::OccluderSelector Occluders;
  vtkNew<vtkOccluderGeometry> Geometry;
  vtkNew<vtkVisibilityMask> Masks;
  vtkNew<vtkRadianceResolver> Resolver;
  std::optional<penumbra::PolygonVisibility> Exact; ///< of the light that is resolved
  penumbra::TimedDrawing Drawing;                   ///< of DrawMasksUntil()
  /// Receivers whose finer texels are fewer than shadows ask for: that is said once for as long as
  /// it is so.
  std::set<std::size_t> Grown;
};

#endif

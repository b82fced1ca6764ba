// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceBaker.h"

#include "BakeJob.h"
#include "OpenGLErrors.h"
#include "RegisteredProjection.h"
#include "SamplingPattern.h"
#include "vtkObjectFactory.h"
#include "vtkOccluderGeometry.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceResolver.h"
#include "vtkRadianceTexture.h"
#include "vtkTimerLog.h"
#include "vtkVisibilityMask.h"
#include "vtkVisibilityShare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

vtkStandardNewMacro(vtkRadianceBaker);

namespace
{

/// The lowest height of a sample, in units of the receiver's size: on the plane itself it would
/// have no projection, and it sends nothing. What is lower is rounding.
constexpr double SmallestSampleHeight = std::numeric_limits<double>::epsilon();

/// The largest coordinates in the receiver's frame that a light's projections are made of: its own,
/// and the receiver's.
glm::dvec3 GetReach(const penumbra::LightShape& light, const penumbra::ReceiverFrame& frame)
{
  glm::dvec3 reach(1.0, 1.0, 0.0);
  for (const glm::dvec3& point : light.GetHull().Points)
  {
    reach = glm::max(reach, glm::abs(frame.ToFrame(point)));
  }
  return reach;
}

/**
 * Where a sample is that its own cell, drawn in single precision, is surely behind: before the
 * cell by what rounding may move its plane. Backward, the projection of a vertex has four roundings
 * along each axis: of the coordinate, of k, of their product and of the difference. Those of the
 * sample's and of the cell's are eight, of half an epsilon each. Unless that takes the sample to
 * the receiver, of which it keeps half the height.
 */
glm::dvec3 MoveBeforeCell(const penumbra::LightSample& sample, const penumbra::ReceiverFrame& frame,
  const glm::dvec3& reach)
{
  constexpr double Roundings = 4.0 * std::numeric_limits<float>::epsilon();
  const penumbra::Parallelogram& base = frame.GetBase();
  const glm::dvec3 along(glm::dot(sample.Normal, base.EdgeX), glm::dot(sample.Normal, base.EdgeY),
    glm::dot(sample.Normal, frame.GetNormal()) * frame.GetSize());
  const double wanted = Roundings * glm::dot(glm::abs(along), reach) + sample.Unevenness;
  const glm::dvec3 place = frame.ToFrame(sample.Place);
  const glm::dvec3 step = frame.DirectionToFrame(sample.Normal);
  const double most = step.z < 0.0 ? 0.5 * place.z / -step.z : wanted;
  return place + std::clamp(wanted, 0.0, std::max(most, 0.0)) * step;
}

std::vector<penumbra::RegisteredProjection> MakeProjections(
  const std::vector<penumbra::LightSample>& samples, const penumbra::LightShape& light,
  const penumbra::ReceiverFrame& frame)
{
  const bool hasCells = light.GetEmission() == penumbra::Emission::Cells;
  const glm::dvec3 reach = hasCells ? GetReach(light, frame) : glm::dvec3(0.0);
  std::vector<penumbra::RegisteredProjection> projections;
  for (const penumbra::LightSample& sample : samples)
  {
    glm::dvec3 place = hasCells ? MoveBeforeCell(sample, frame, reach)
      : sample.IsDirection      ? frame.DirectionToFrame(sample.Place)
                                : frame.ToFrame(sample.Place);
    place.z = std::max(place.z, SmallestSampleHeight);
    projections.push_back(sample.IsDirection ? penumbra::RegisteredProjection::FromDirection(place)
                                             : penumbra::RegisteredProjection::FromPoint(place));
  }
  return projections;
}

/// The root mean square of the standard error and the peak of the mean of radiance's components.
glm::dvec2 FindErrorAndPeak(
  const vtkRadianceTexture::Texels& texels, const penumbra::ReceiverSettings& settings)
{
  double variance = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < texels.Irradiance.size(); ++i)
  {
    const glm::dvec3 radiance =
      settings.Reflectance * (settings.AmbientRadiance + glm::dvec3(texels.Irradiance[i]));
    variance += static_cast<double>(texels.Variance[i]);
    peak = std::max(peak, (radiance.x + radiance.y + radiance.z) / 3.0);
  }
  return { std::sqrt(variance / static_cast<double>(texels.Variance.size())), peak };
}

/// Adds the time since `start` to a light's, when OpenGL has finished. A bake ends with waiting for
/// that in any case.
void AddTime(double start, vtkRadianceBaker::PairReport& pair)
{
  glFinish();
  pair.Milliseconds += 1000.0 * (vtkTimerLog::GetUniversalTime() - start);
}

/// The parts of a rectangle that another one leaves.
std::vector<penumbra::TexelRectangle> Subtract(
  const penumbra::TexelRectangle& from, const penumbra::TexelRectangle& other)
{
  const penumbra::TexelRectangle inner = from.Intersection(other);
  if (inner.IsEmpty())
  {
    return { from };
  }
  std::vector<penumbra::TexelRectangle> parts;
  for (const penumbra::TexelRectangle& part :
    { from.Rows(from.Low.y, inner.Low.y), from.Rows(inner.High.y, from.High.y),
      penumbra::TexelRectangle{ { from.Low.x, inner.Low.y }, { inner.Low.x, inner.High.y } },
      penumbra::TexelRectangle{ { inner.High.x, inner.Low.y }, { from.High.x, inner.High.y } } })
  {
    if (!part.IsEmpty())
    {
      parts.push_back(part);
    }
  }
  return parts;
}

} // namespace

vtkRadianceBaker::vtkRadianceBaker() = default;
vtkRadianceBaker::~vtkRadianceBaker() = default;

std::vector<vtkRadianceBaker::Report> vtkRadianceBaker::Bake(const penumbra::ShadowScene& scene,
  const std::vector<std::size_t>& receivers, vtkOpenGLRenderWindow* window,
  vtkRadianceTexture* texture)
{
  if (!penumbra::HasOpenGLContext())
  {
    vtkErrorMacro("No OpenGL context is current, so there is no bake: the "
      << window->GetClassName() << " must be initialized and current.");
    return {};
  }
  std::vector<penumbra::AtlasReceiver> whole; // triangles, too: all of their texels are asked for
  for (const std::size_t i : receivers)
  {
    whole.emplace_back(scene.Receivers[i].Texels);
  }
  std::vector<Report> reports;
  vtkOpenGLState* state = window->GetState();
  state->Push();
  if (!receivers.empty() && texture->Allocate(window, whole))
  {
    this->SetScene(scene);
    for (std::size_t i = 0; i < receivers.size(); ++i)
    {
      const double start = vtkTimerLog::GetUniversalTime();
      const penumbra::ReceiverPlan plan = this->Plan(receivers[i]);
      Part all;
      all.Rectangle = penumbra::WholeRectangle(whole[i].Size);
      reports.push_back(this->BakePart(plan, receivers[i], window, texture, i, all));
      reports.back().Seconds = vtkTimerLog::GetUniversalTime() - start;
    }
  }
  this->ReleaseGraphicsResources();
  state->Pop();
  return reports;
}

void vtkRadianceBaker::SetScene(const penumbra::ShadowScene& scene)
{
  this->Scene = &scene;
  this->Occluders.SetScene(scene);
}

penumbra::ReceiverPlan vtkRadianceBaker::Plan(std::size_t receiver)
{
  return penumbra::PlanReceiver(*this->Scene, this->Scene->Receivers[receiver], this->Occluders);
}

penumbra::ReceiverPlan vtkRadianceBaker::PlanWindow(
  const penumbra::Receiver& window, const penumbra::ReceiverPlan& parent)
{
  return penumbra::PlanWindow(*this->Scene, window, parent, this->Occluders);
}

vtkRadianceBaker::Report vtkRadianceBaker::MakeReport(
  const penumbra::ReceiverPlan& plan, const penumbra::ShadowScene& scene, std::size_t receiver)
{
  std::size_t triangles = 0;
  for (const penumbra::SharedSurface& surface : scene.Surfaces)
  {
    triangles += surface->Triangles.size();
  }
  Report report;
  report.Receiver = receiver;
  for (const penumbra::PairPlan& pair : plan.Pairs)
  {
    report.Pairs.push_back(
      { pair.Needed, pair.Reason, 0, 0, pair.Triangles, triangles, 0.0, 0, 0 });
  }
  return report;
}

vtkRadianceBaker::Report vtkRadianceBaker::BakePart(const penumbra::ReceiverPlan& plan,
  std::size_t receiver, vtkOpenGLRenderWindow* window, vtkRadianceTexture* texture,
  std::size_t region, const Part& part)
{
  return this->BakeRectangle(plan, this->Scene->Receivers[receiver], receiver, window, texture,
    texture->GetRegions()[region], part);
}

vtkRadianceBaker::Report vtkRadianceBaker::BakeRectangle(const penumbra::ReceiverPlan& plan,
  const penumbra::Receiver& receiver, std::size_t index, vtkOpenGLRenderWindow* window,
  vtkRadianceTexture* texture, const vtkRadianceTexture::Region& region, const Part& part)
{
  const double start = vtkTimerLog::GetUniversalTime();
  Job job{ plan, receiver, part, window, nullptr, {}, {}, part.KeptBytes,
    MakeReport(plan, *this->Scene, index) };
  this->Occluders.SetReceiver(receiver, plan.Frame);
  vtkOpenGLState* state = window->GetState();
  state->Push();
  job.Result.IsComplete = this->BakeReceiver(job, texture, region) && this->HasDrawn();
  glFinish();
  state->Pop();
  job.Result.Seconds = vtkTimerLog::GetUniversalTime() - start;
  return job.Result;
}

bool vtkRadianceBaker::HasDrawn()
{
  if (penumbra::TakeDrawingError())
  {
    vtkErrorMacro("OpenGL refused to draw a part of a receiver. There is no bake; use a "
                  "larger TexelSize or fewer LightSamples, or update the OpenGL driver.");
    return false;
  }
  return true;
}

bool vtkRadianceBaker::BakeReceiver(
  Job& job, vtkRadianceTexture* texture, const vtkRadianceTexture::Region& place)
{
  const penumbra::TexelRectangle& wanted = job.Wanted.Rectangle;
  const int factor = job.Plan.Supersampling;
  job.Resolved = job.FindResolved();
  // What the tolerance is measured on is all of the receiver's texels.
  const bool isCut = job.HasTolerance() && place.Half != penumbra::AtlasHalf::Whole;
  if (factor == 1 && !isCut)
  {
    texture->Clear(place, wanted);
    job.Target = texture;
    job.Region = place;
    return this->BakeLights(job) && this->BakeWindows(job);
  }
  vtkNew<vtkRadianceTexture> fine;
  bool isDone = false;
  if (fine->Allocate(job.Window, { job.Resolved.GetSize() }))
  {
    job.Target = fine;
    job.Region = { -job.Resolved.Low, job.Plan.Texels };
    isDone = this->BakeLights(job) && this->BakeWindows(job) &&
      texture->Downsample(fine, job.Resolved.Low, place, wanted, factor);
  }
  fine->ReleaseGraphicsResources();
  return isDone;
}

bool vtkRadianceBaker::BakeWindows(Job& job)
{
  std::vector<std::pair<const penumbra::FineWindow*, penumbra::TexelRectangle>> touched;
  for (const penumbra::FineWindow& window : job.Plan.Fine.Windows)
  {
    const penumbra::TexelRectangle rectangle = window.GetTexels().Intersection(job.Resolved);
    if (!rectangle.IsEmpty())
    {
      touched.emplace_back(&window, rectangle);
    }
  }
  this->WarnOfGrowth(job.Plan.Fine, job.Result.Receiver);
  // Several may have parts of one texel: first these get what they hold without any.
  const bool takesMeans = job.Wanted.TakesMeans;
  bool isDone = true;
  for (const auto& [window, rectangle] : touched)
  {
    if (takesMeans || !window->IsWhole)
    {
      job.Target->Clear(job.Region, rectangle);
    }
    isDone =
      isDone && (window->IsWhole || this->BakeWithout(job, rectangle, job.Target, job.Region));
  }
  for (const auto& [window, rectangle] : touched)
  {
    isDone = isDone && (!takesMeans || this->BakeWindow(job, *window, rectangle));
  }
  return isDone;
}

void vtkRadianceBaker::WarnOfGrowth(const penumbra::WindowPlan& fine, std::size_t receiver)
{
  // Half as many texels across a shadow are still enough to tell its area by.
  constexpr double MostGrowth = 2.0;
  if (fine.Growth > 1.0 && fine.Growth <= MostGrowth)
  {
    this->Grown.erase(receiver);
  }
  else if (fine.Growth > MostGrowth && this->Grown.insert(receiver).second)
  {
    vtkWarningMacro(
      "Receiver " << receiver << " has shadows that are small against its texels. They need "
                  << fine.NeededTexels << " finer ones; allowed: " << penumbra::MostFineTexels
                  << ". Those that are used are " << fine.Growth
                  << " times as large along each edge. Set a "
                  << "TexelSize, or divide the receiver.");
  }
}

bool vtkRadianceBaker::BakeWithout(Job& job, const penumbra::TexelRectangle& rectangle,
  vtkRadianceTexture* target, const vtkRadianceTexture::Region& region)
{
  bool isDone = true;
  for (const std::size_t light : this->Scene->GetLightOrder())
  {
    const penumbra::Effect effect = job.Plan.Pairs[light].Needed;
    if (!isDone || effect == penumbra::Effect::None)
    {
      continue;
    }
    isDone = this->Resolver->Begin(job.Window, job.Plan.Frame, *job.Plan.Lights[light],
      job.Plan.Texels, rectangle, {}, this->GetOptions(job, light));
    if (isDone)
    {
      this->Resolver->ResolveUniform(
        target, region, rectangle, effect == penumbra::Effect::Umbra ? 0.0f : 1.0f);
    }
  }
  return isDone;
}

bool vtkRadianceBaker::BakeWindow(
  Job& job, const penumbra::FineWindow& window, const penumbra::TexelRectangle& rectangle)
{
  const penumbra::Receiver receiver = window.MakeReceiver(job.Receiver, job.Plan.GetSide());
  const penumbra::ReceiverPlan plan =
    penumbra::PlanWindow(*this->Scene, receiver, job.Plan, this->Occluders);
  Part part;
  part.MostSamples = job.Wanted.MostSamples;
  const penumbra::TexelRectangle fine =
    penumbra::TexelRectangle{ rectangle.Low * window.Factor, rectangle.High * window.Factor }
      .Intersection(window.Fine);
  part.Rectangle = { fine.Low - window.Fine.Low, fine.High - window.Fine.Low };
  vtkNew<vtkRadianceTexture> texels, without;
  bool isDone = texels->Allocate(job.Window, { part.Rectangle.GetSize() }) &&
    without->Allocate(job.Window, { rectangle.GetSize() });
  if (isDone)
  {
    const Report report = this->BakeRectangle(plan, receiver, job.Result.Receiver, job.Window,
      texels, { -part.Rectangle.Low, receiver.Texels }, part);
    AddReport(report, job.Result);
    isDone = report.IsComplete &&
      (window.IsWhole ||
        this->BakeWithout(job, rectangle, without, { -rectangle.Low, job.Plan.Texels })) &&
      job.Target->AddMeans(texels, window.IsWhole ? nullptr : without.Get(), window.Factor, fine,
        job.Region, rectangle);
  }
  texels->ReleaseGraphicsResources();
  without->ReleaseGraphicsResources();
  return isDone;
}

void vtkRadianceBaker::AddReport(const Report& window, Report& receiver)
{
  for (std::size_t i = 0; i < window.Pairs.size(); ++i)
  {
    PairReport& pair = receiver.Pairs[i];
    const PairReport& added = window.Pairs[i];
    if (pair.Effect == penumbra::Effect::Hard && added.Effect == penumbra::Effect::Soft)
    {
      pair.Effect = added.Effect;
      pair.Reason = added.Reason;
    }
    pair.LightSamples = std::max(pair.LightSamples, added.LightSamples);
    pair.Texels += added.Texels;
    pair.Milliseconds += added.Milliseconds;
    pair.Bytes = std::max(pair.Bytes, added.Bytes);
    pair.ExactTexels += added.ExactTexels;
  }
  receiver.PeakBytes = std::max(receiver.PeakBytes, window.PeakBytes);
}

bool vtkRadianceBaker::BakeLights(Job& job)
{
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const bool hasTolerance = job.HasTolerance();
  job.Result.StoppedBy = hasTolerance    ? "ErrorTolerance"
    : settings.SolidAnglePerSample > 0.0 ? "SolidAnglePerSample"
                                         : "LightSamples";
  for (const std::size_t light : this->Scene->GetLightOrder())
  {
    const double solidAngle = job.Plan.Lights[light]->GetSolidAngleBound(job.Receiver.Base);
    const int count = hasTolerance ? job.GetBatchEnds(light).front() : job.CountSamples(light);
    if (!hasTolerance && settings.SolidAnglePerSample > 0.0 &&
      settings.SolidAnglePerSample * settings.GetSampleCount(solidAngle) < solidAngle)
    {
      job.Result.StoppedBy = "MaximumLightSamples";
    }
    const double start = vtkTimerLog::GetUniversalTime();
    if (hasTolerance && count == 1 && job.Plan.Pairs[light].Needed == penumbra::Effect::Soft &&
      job.TakeSamples(light, 2).size() > 1)
    {
      job.Result.StoppedBy = "MaximumLightSamples"; // one sample has no halves, and no estimate
    }
    if (!this->BakeLight(job, light, count))
    {
      return false;
    }
    AddTime(start, job.Result.Pairs[light]);
  }
  return !hasTolerance || this->RefineLights(job);
}

vtkRadianceResolver::Options vtkRadianceBaker::GetOptions(const Job& job, std::size_t light) const
{
  vtkRadianceResolver::Options options;
  options.Reflectance = job.Receiver.Settings.Reflectance;
  options.Reconstruction = job.Receiver.Settings.Reconstruction;
  options.Translucent = job.Plan.Pairs[light].Translucent > 0;
  options.Tinted = job.Plan.Pairs[light].IsTinted;
  return options;
}

bool vtkRadianceBaker::ChooseExact(const Job& job, std::size_t light, int samples)
{
  if (!job.Plan.Pairs[light].IsExact(samples))
  {
    return this->Resolver->SetExact(nullptr);
  }
  const penumbra::LightShape& seen = *job.Plan.Lights[light];
  this->Occluders.Select(seen);
  this->Exact.emplace(job.Plan.Frame, *seen.GetPolygons().front().Polygon, this->Occluders);
  return this->Resolver->SetExact(&*this->Exact);
}

bool vtkRadianceBaker::BakeLight(Job& job, std::size_t light, int count)
{
  const penumbra::PairPlan& pair = job.Plan.Pairs[light];
  if (pair.Needed == penumbra::Effect::None)
  {
    return true;
  }
  if (!this->Resolver->Begin(job.Window, job.Plan.Frame, *job.Plan.Lights[light], job.Plan.Texels,
        job.Resolved, {}, this->GetOptions(job, light)))
  {
    return false;
  }
  if (pair.Needed == penumbra::Effect::Umbra)
  {
    this->Resolver->ResolveUniform(job.Target, job.Region, job.Resolved, 0.0f);
    return true;
  }
  for (const penumbra::TexelRectangle& lit : Subtract(job.Resolved, pair.Shaded))
  {
    this->Resolver->ResolveUniform(job.Target, job.Region, lit, 1.0f);
  }
  if (job.Resolved.Intersection(pair.Shaded).IsEmpty())
  {
    return true;
  }
  const bool isDone = this->BakeShaded(job, light, count);
  job.Result.Pairs[light].ExactTexels = this->Resolver->GetExactCount();
  return isDone;
}

bool vtkRadianceBaker::BakeShaded(Job& job, std::size_t light, int count)
{
  const penumbra::PairPlan& pair = job.Plan.Pairs[light];
  const penumbra::TexelRectangle shaded = job.Resolved.Intersection(pair.Shaded);
  if (job.Wanted.Kept && this->MayKeep(job, light))
  {
    return this->BakeFromKept(job, light, count, shaded);
  }
  if (!this->Resolver->Begin(job.Window, job.Plan.Frame, *job.Plan.Lights[light], job.Plan.Texels,
        shaded, pair.Shaded, this->GetOptions(job, light)))
  {
    return false;
  }
  if (!this->ChooseExact(job, light, count))
  {
    return false;
  }
  const std::vector<penumbra::LightSample> samples = job.TakeSamples(light, count);
  if (job.Wanted.Masks)
  {
    return this->UseMasks(job, light, samples, shaded);
  }
  return this->Resolver->SetSamples(samples) &&
    this->DrawMasks(job, light, samples, shaded, true,
      [&](const penumbra::TexelRectangle& band, const glm::ivec2& maskFirstTexel)
      { this->Resolver->ResolveMasks(job.Target, job.Region, band, this->Masks, maskFirstTexel); });
}

bool vtkRadianceBaker::UseMasks(Job& job, std::size_t light,
  const std::vector<penumbra::LightSample>& samples, const penumbra::TexelRectangle& shaded)
{
  const penumbra::TexelRectangle all = this->Resolver->GetMaskRectangle(shaded);
  if (!this->Resolver->SetSamples(samples) ||
    (job.Plan.Pairs[light].Translucent > 0 &&
      !(this->SelectOccluders(job, light, all) && this->SetTransmittances(job, light))))
  {
    return false;
  }
  vtkVisibilityMask* masks = job.Wanted.Masks->Lights[light].Masks;
  this->Resolver->ResolveMasks(job.Target, job.Region, shaded, masks, all.Low);
  PairReport& report = job.Result.Pairs[light];
  report.LightSamples += static_cast<int>(samples.size());
  report.Texels = static_cast<std::size_t>(all.GetArea());
  job.NoteBytes(light, masks->GetBytes() + this->Resolver->GetBytes());
  return true;
}

bool vtkRadianceBaker::SelectOccluders(
  const Job& job, std::size_t light, const penumbra::TexelRectangle& rectangle)
{
  if (job.Receiver.Settings.Planner)
  {
    const penumbra::TexelRectangle around =
      rectangle.Grown(1).Intersection(penumbra::WholeRectangle(job.Plan.Texels));
    const glm::dvec2 texels(job.Plan.Texels);
    this->Occluders.Select(*job.Plan.Lights[light],
      glm::dvec4(glm::dvec2(around.Low) / texels, glm::dvec2(around.High) / texels));
  }
  else
  {
    this->Occluders.SelectAll(*job.Plan.Lights[light]);
  }
  return this->Geometry->Upload(this->Occluders);
}

bool vtkRadianceBaker::SetTransmittances(const Job& job, std::size_t light)
{
  if (job.Plan.Pairs[light].Translucent == 0)
  {
    return true;
  }
  std::vector<glm::dvec3> transmittances;
  for (const penumbra::Caster& caster : this->Occluders.GetTranslucentCasters())
  {
    transmittances.push_back(this->Scene->Surfaces[caster.Surface]->Transmittance);
  }
  return this->Resolver->SetTransmittances(transmittances);
}

template <typename Use>
bool vtkRadianceBaker::DrawMasks(Job& job, std::size_t light,
  const std::vector<penumbra::LightSample>& samples, const penumbra::TexelRectangle& rectangle,
  bool withHalo, const Use& use)
{
  const auto getMasks = [&](const penumbra::TexelRectangle& band)
  { return withHalo ? this->Resolver->GetMaskRectangle(band) : band; };
  const penumbra::TexelRectangle all = getMasks(rectangle);
  const glm::ivec2 size = all.GetSize();
  const int halo = withHalo ? this->Resolver->GetHalo() : 0;
  const int count = static_cast<int>(samples.size());
  if (!this->SelectOccluders(job, light, all) || !this->SetTransmittances(job, light))
  {
    return false;
  }
  const std::size_t sets = this->Geometry->GetNumberOfSets();
  const std::size_t layers = sets *
    (static_cast<std::size_t>(count + vtkVisibilityMask::SamplesPerLayer - 1) /
      vtkVisibilityMask::SamplesPerLayer);
  const std::size_t bytesPerRow = static_cast<std::size_t>(size.x) * layers * sizeof(std::uint32_t);
  std::size_t most = this->MaximumMaskBytes;
  if (job.Wanted.Kept)
  {
    const std::size_t kept = job.Wanted.KeptBytes - job.KeptBytes;
    most =
      std::min(most, job.Wanted.MaskAndKeptBytes - std::min(kept, job.Wanted.MaskAndKeptBytes));
  }
  const int fitting =
    static_cast<int>(std::min(most / bytesPerRow, static_cast<std::size_t>(size.y)));
  const int rows = fitting == size.y ? fitting : std::max(fitting - 2 * halo, 1);
  const glm::ivec2 maskSize(size.x, std::min(rows + 2 * halo, size.y));
  if (!this->Masks->Allocate(job.Window, maskSize, count, sets))
  {
    return false;
  }
  const std::vector<penumbra::RegisteredProjection> projections =
    MakeProjections(samples, *job.Plan.Lights[light], job.Plan.Frame);
  for (int row = rectangle.Low.y; row < rectangle.High.y; row += rows)
  {
    const penumbra::TexelRectangle band =
      rectangle.Rows(row, std::min(row + rows, rectangle.High.y));
    const glm::ivec2 first = getMasks(band).Low;
    if (!this->Masks->Draw(this->Geometry, projections, job.Plan.Texels, first, 0, count))
    {
      return false;
    }
    use(band, first);
  }
  PairReport& report = job.Result.Pairs[light];
  report.LightSamples += count;
  report.Texels = static_cast<std::size_t>(all.GetArea());
  job.NoteBytes(
    light, bytesPerRow * static_cast<std::size_t>(maskSize.y) + this->Resolver->GetBytes());
  return true;
}

penumbra::DrawProgress vtkRadianceBaker::DrawMasksUntil(double until,
  const penumbra::ReceiverPlan& plan, std::size_t receiver, vtkOpenGLRenderWindow* window,
  const penumbra::TexelRectangle& rectangle, penumbra::PartMasks& masks)
{
  const penumbra::Receiver& r = this->Scene->Receivers[receiver];
  Part part;
  part.Rectangle = rectangle;
  Job job{ plan, r, part, window, nullptr, {}, {}, 0, MakeReport(plan, *this->Scene, receiver) };
  job.Resolved = job.FindResolved();
  this->Occluders.SetReceiver(r, plan.Frame);
  masks.Lights.resize(plan.Lights.size());
  vtkOpenGLState* state = window->GetState();
  state->Push();
  penumbra::DrawProgress progress = penumbra::DrawProgress::Done;
  for (std::size_t light = 0;
       light < plan.Lights.size() && progress == penumbra::DrawProgress::Done; ++light)
  {
    progress = this->DrawLightUntil(until, job, light, masks.Lights[light]);
  }
  state->Pop();
  return this->HasDrawn() ? progress : penumbra::DrawProgress::Failed;
}

penumbra::DrawProgress vtkRadianceBaker::DrawLightUntil(
  double until, Job& job, std::size_t light, penumbra::PartMasks::LightMasks& masks)
{
  const penumbra::PairPlan& pair = job.Plan.Pairs[light];
  const penumbra::TexelRectangle shaded = job.Resolved.Intersection(pair.Shaded);
  const bool hasSamples =
    pair.Needed == penumbra::Effect::Soft || pair.Needed == penumbra::Effect::Hard;
  if (!hasSamples || shaded.IsEmpty())
  {
    return penumbra::DrawProgress::Done;
  }
  const std::vector<penumbra::LightSample> taken = job.TakeSamples(light, job.CountSamples(light));
  const int count = static_cast<int>(taken.size());
  masks.Count = count;
  if (masks.Masks && masks.Drawn == count)
  {
    return penumbra::DrawProgress::Done;
  }
  const penumbra::TexelRectangle all = vtkRadianceResolver::GetMaskRectangle(
    shaded, pair.Shaded, job.Receiver.Settings.Reconstruction, job.Plan.Texels);
  if (!this->SelectOccluders(job, light, all))
  {
    return penumbra::DrawProgress::Failed;
  }
  if (!masks.Masks)
  {
    masks.Masks = vtkSmartPointer<vtkVisibilityMask>::New();
    if (!masks.Masks->Allocate(job.Window, all.GetSize(), count, this->Geometry->GetNumberOfSets()))
    {
      return penumbra::DrawProgress::Failed;
    }
  }
  const std::vector<penumbra::RegisteredProjection> projections =
    MakeProjections(taken, *job.Plan.Lights[light], job.Plan.Frame);
  return this->Drawing.Draw(until, masks, this->Geometry, this->Occluders.GetTriangles().size(),
    projections, job.Plan.Texels, all.Low, all.GetArea());
}

bool vtkRadianceBaker::RefineLights(Job& job)
{
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const glm::dvec2 first = FindErrorAndPeak(job.Target->Download(job.Region), settings);
  const double allowed = settings.ErrorTolerance * first.y;
  const auto hasSamples = [](const penumbra::PairPlan& pair)
  { return pair.Needed == penumbra::Effect::Soft && !pair.Shaded.IsEmpty(); };
  const auto soft = std::count_if(job.Plan.Pairs.begin(), job.Plan.Pairs.end(), hasSamples);
  if (first.x <= allowed || soft == 0)
  {
    return true;
  }
  vtkNew<vtkRadianceTexture> scratch;
  if (!scratch->Allocate(job.Window, { job.Plan.Texels }))
  {
    return false;
  }
  // The lights' errors add up as their squares do, and each gets an equal part.
  const double allowedOfLight = allowed / std::sqrt(static_cast<double>(soft));
  job.Target->Clear(job.Region, job.Resolved);
  bool isDone = true;
  for (const std::size_t light : this->Scene->GetLightOrder())
  {
    const double start = vtkTimerLog::GetUniversalTime();
    job.Result.Pairs[light].LightSamples = 0;
    isDone = isDone &&
      (hasSamples(job.Plan.Pairs[light]) ? this->RefineLight(job, light, allowedOfLight, scratch)
                                         : this->BakeLight(job, light, 1));
    AddTime(start, job.Result.Pairs[light]);
  }
  scratch->ReleaseGraphicsResources();
  if (!isDone)
  {
    return false;
  }
  const glm::dvec2 last = FindErrorAndPeak(job.Target->Download(job.Region), settings);
  if (last.x > settings.ErrorTolerance * last.y)
  {
    job.Result.StoppedBy = "MaximumLightSamples";
  }
  return true;
}

bool vtkRadianceBaker::RefineLight(
  Job& job, std::size_t light, double allowed, vtkRadianceTexture* scratch)
{
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const bool grows =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(settings.SamplingPattern)].Grows;
  vtkRadianceResolver::Options options = this->GetOptions(job, light);
  options.InBatches = true;
  const penumbra::TexelRectangle& shaded = job.Plan.Pairs[light].Shaded;
  if (!this->Resolver->Begin(job.Window, job.Plan.Frame, *job.Plan.Lights[light], job.Plan.Texels,
        job.Resolved, shaded, options))
  {
    return false;
  }
  const penumbra::TexelRectangle counted = this->Resolver->GetMaskRectangle(shaded);
  const vtkRadianceTexture::Region scratchRegion = scratch->GetRegions().front();
  scratch->Clear(scratchRegion, penumbra::WholeRectangle(job.Plan.Texels));
  int previous = 0;
  for (const int count : job.GetBatchEnds(light))
  {
    std::vector<penumbra::LightSample> samples = job.TakeSamples(light, count);
    const int total = static_cast<int>(samples.size());
    const bool isReady =
      this->Resolver->SetSamples(samples, previous) && this->ChooseExact(job, light, count);
    // Masks of the new samples, in whole layers.
    constexpr int Layer = vtkVisibilityMask::SamplesPerLayer;
    samples.erase(samples.begin(), samples.begin() + previous / Layer * Layer);
    if (!isReady ||
      !this->DrawMasks(job, light, samples, counted, false,
        [&](const penumbra::TexelRectangle& band, const glm::ivec2& maskFirstTexel)
        { this->Resolver->CountMasks(this->Masks, maskFirstTexel, band); }))
    {
      return false;
    }
    job.Result.Pairs[light].LightSamples = total;
    this->Resolver->ResolveCounts(scratch, scratchRegion, shaded, false);
    const glm::dvec2 error = FindErrorAndPeak(scratch->Download(scratchRegion), settings);
    if (error.x <= allowed)
    {
      break;
    }
    previous = grows ? count : 0;
  }
  this->Resolver->ResolveCounts(job.Target, job.Region, shaded, true);
  job.Result.Pairs[light].ExactTexels = this->Resolver->GetExactCount();
  for (const penumbra::TexelRectangle& lit : Subtract(job.Resolved, shaded))
  {
    this->Resolver->ResolveUniform(job.Target, job.Region, lit, 1.0f);
  }
  return true;
}

bool vtkRadianceBaker::MayKeep(Job& job, std::size_t light)
{
  const penumbra::PairPlan& pair = job.Plan.Pairs[light];
  const penumbra::LightShape& seen = *job.Plan.Lights[light];
  KeptLight& kept = (*job.Wanted.Kept)[light];
  if (kept.Shares.GetCount() != vtkRadianceResolver::CountShares(seen, pair.IsTinted))
  {
    kept.Shares.Release(); // a tint has come or gone
    kept = KeptLight();
  }
  const penumbra::TexelRectangle needed = job.GetKeptRectangle(light);
  const auto bytes = static_cast<std::size_t>(kept.Shares.Stored.Union(needed).GetArea()) *
    vtkRadianceResolver::GetKeptBytesPerTexel(seen, pair.IsTinted);
  // New shares are kept of whole bakes alone, and all only while there is room.
  const bool isNew = kept.Shares.Stored.IsEmpty();
  if (bytes > job.KeptBytes ||
    (isNew ? !job.Resolved.Holds(pair.Shaded)
           : !kept.Shares.Stored.Holds(needed) && !kept.Shares.Extend(needed)))
  {
    kept = KeptLight();
    return false;
  }
  job.KeptBytes -= bytes;
  // All that is stored, also what is not needed now: it may be needed again.
  kept.Stale = isNew ? needed : kept.Stale.Intersection(kept.Shares.Stored);
  return true;
}

bool vtkRadianceBaker::BakeFromKept(
  Job& job, std::size_t light, int count, const penumbra::TexelRectangle& shaded)
{
  const penumbra::PairPlan& pair = job.Plan.Pairs[light];
  KeptLight& kept = (*job.Wanted.Kept)[light];
  vtkRadianceResolver::Options options = this->GetOptions(job, light);
  options.Kept = &kept.Shares;
  const penumbra::TexelRectangle stale = kept.Stale;
  const std::vector<penumbra::LightSample> samples = job.TakeSamples(light, count);
  if (!this->Resolver->Begin(job.Window, job.Plan.Frame, *job.Plan.Lights[light], job.Plan.Texels,
        shaded, pair.Shaded, options) ||
    !this->ChooseExact(job, light, count) ||
    (!stale.IsEmpty() &&
      (!this->Resolver->SetSamples(samples) ||
        !this->DrawMasks(job, light, samples, stale, false,
          [&](const penumbra::TexelRectangle& band, const glm::ivec2& maskFirstTexel)
          { this->Resolver->CountMasks(this->Masks, maskFirstTexel, band); }))))
  {
    kept = KeptLight();
    return false;
  }
  this->Resolver->ResolveCounts(job.Target, job.Region, shaded, true);
  if (!this->HasDrawn())
  {
    kept = KeptLight();
    return false;
  }
  kept.Stale = {};
  for (const vtkSmartPointer<vtkVisibilityShare>& share : kept.Shares.Shares)
  {
    if (share)
    {
      share->ReleaseSamples();
    }
  }
  return true;
}

void vtkRadianceBaker::ReleaseGraphicsResources()
{
  this->Resolver->ReleaseGraphicsResources();
  this->Masks->ReleaseGraphicsResources();
  this->Geometry->ReleaseGraphicsResources();
  this->Occluders.Clear();
  this->Exact.reset();
}

void vtkRadianceBaker::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumMaskBytes: " << this->MaximumMaskBytes << "\n";
}

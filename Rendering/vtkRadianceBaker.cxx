// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceBaker.h"

#include "RegisteredProjection.h"
#include "SamplingPattern.h"
#include "vtkObjectFactory.h"
#include "vtkOccluderGeometry.h"
#include "vtkOpenGLError.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceResolver.h"
#include "vtkRadianceTexture.h"
#include "vtkTimerLog.h"
#include "vtkVisibilityMask.h"

#include <algorithm>
#include <cmath>
#include <limits>

vtkStandardNewMacro(vtkRadianceBaker);

namespace
{

/// The lowest height of a sample, in units of the receiver's size: on the plane itself it would
/// have no projection, and it sends nothing. What is lower is rounding.
constexpr double SmallestSampleHeight = std::numeric_limits<double>::epsilon();

/// The first samples of a light whose error is to be found: fewer say little of it.
constexpr int FirstBatch = 64;

/// The lights as the receiver sees them: what lies in front of it.
std::vector<penumbra::Light> ClipLights(
  const std::vector<penumbra::Light>& lights, const penumbra::ReceiverFrame& frame)
{
  std::vector<penumbra::Light> seen;
  for (const penumbra::Light& light : lights)
  {
    seen.emplace_back(light->Clip(frame.GetBase().Corner, frame.GetNormal()));
  }
  return seen;
}

std::vector<penumbra::RegisteredProjection> MakeProjections(
  const std::vector<penumbra::LightSample>& samples, const penumbra::ReceiverFrame& frame)
{
  std::vector<penumbra::RegisteredProjection> projections;
  for (const penumbra::LightSample& sample : samples)
  {
    glm::dvec3 place =
      sample.IsDirection ? frame.DirectionToFrame(sample.Place) : frame.ToFrame(sample.Place);
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

} // namespace

/// What the stages of one receiver's bake share.
struct vtkRadianceBaker::Job
{
  const penumbra::ShadowScene& Scene;
  const penumbra::Receiver& Receiver;
  penumbra::ReceiverFrame Frame;
  std::vector<penumbra::Light> Lights; ///< clipped to the receiver's front
  vtkOpenGLRenderWindow* Window;
  vtkRadianceTexture* Target;
  vtkRadianceTexture::Region Region; ///< in Target, of supersampled texels
  Report Result;

  /// A pattern's points for a light.
  std::vector<penumbra::LightSample> TakeSamples(std::size_t light, int count) const
  {
    const penumbra::ReceiverSettings& settings = this->Receiver.Settings;
    const penumbra::SamplingPattern& pattern =
      penumbra::GetSamplingPatterns()[static_cast<std::size_t>(settings.SamplingPattern)];
    std::vector<glm::dvec2> points = pattern.Generate(
      count, static_cast<std::uint32_t>(settings.Seed), this->Lights[light]->GetAspect());
    // OpenGL 3.2 promises room for 8192 samples; Mesa and most drivers have it for all.
    points.resize(std::min(
      points.size(), static_cast<std::size_t>(vtkVisibilityMask::GetMaximumSamples(this->Window))));
    return this->Lights[light]->TakeSamples(points);
  }
};

vtkRadianceBaker::vtkRadianceBaker() = default;
vtkRadianceBaker::~vtkRadianceBaker() = default;

std::vector<vtkRadianceBaker::Report> vtkRadianceBaker::Bake(const penumbra::ShadowScene& scene,
  const std::vector<std::size_t>& receivers, vtkOpenGLRenderWindow* window,
  vtkRadianceTexture* texture)
{
  std::vector<glm::ivec2> sizes;
  for (const std::size_t i : receivers)
  {
    sizes.push_back(scene.Receivers[i].Texels);
  }
  std::vector<Report> reports;
  vtkOpenGLState* state = window->GetState();
  state->Push();
  if (!receivers.empty() && texture->Allocate(window, sizes))
  {
    for (std::size_t i = 0; i < receivers.size(); ++i)
    {
      reports.push_back(this->BakeReceiver(scene, receivers[i], window, texture, i));
    }
  }
  this->Resolver->ReleaseGraphicsResources();
  this->Masks->ReleaseGraphicsResources();
  this->Occluders->ReleaseGraphicsResources();
  state->Pop();
  vtkOpenGLCheckErrorMacro("failed after baking");
  return reports;
}

vtkRadianceBaker::Report vtkRadianceBaker::BakeReceiver(const penumbra::ShadowScene& scene,
  std::size_t receiver, vtkOpenGLRenderWindow* window, vtkRadianceTexture* texture,
  std::size_t region)
{
  const double start = vtkTimerLog::GetUniversalTime();
  const penumbra::Receiver& r = scene.Receivers[receiver];
  const penumbra::ReceiverFrame frame = scene.MakeFrame(r);
  const penumbra::ReceiverSettings& settings = r.Settings;
  const vtkRadianceTexture::Region place = texture->GetRegions()[region];
  Job job{ scene, r, frame, ClipLights(scene.Lights, frame), window, texture, place, {} };
  job.Result.Receiver = receiver;

  if (settings.Supersampling > 1)
  {
    vtkNew<vtkRadianceTexture> fine;
    if (fine->Allocate(window, { place.Size * settings.Supersampling }))
    {
      job.Target = fine;
      job.Region = fine->GetRegions().front();
      this->BakeLights(job);
      texture->Downsample(fine, place, settings.Supersampling);
    }
    fine->ReleaseGraphicsResources();
  }
  else
  {
    this->BakeLights(job);
  }
  glFinish();
  job.Result.Seconds = vtkTimerLog::GetUniversalTime() - start;
  return job.Result;
}

bool vtkRadianceBaker::BakeLights(Job& job)
{
  this->Occluders->SetReceiver(job.Scene, job.Receiver, job.Frame);
  job.Result.LightSamples.assign(job.Lights.size(), 0);
  for (const penumbra::Light& light : job.Lights)
  {
    const std::size_t triangles =
      light->IsValid() ? this->Occluders->Select(penumbra::BlockingRegion(job.Frame, *light)) : 0;
    job.Result.Triangles.push_back(triangles);
    job.Result.Effects.push_back(penumbra::PlanEffect(job.Frame, *light, triangles > 0));
  }
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const bool hasTolerance = settings.ErrorTolerance > 0.0;
  job.Result.StoppedBy = hasTolerance    ? "ErrorTolerance"
    : settings.SolidAnglePerSample > 0.0 ? "SolidAnglePerSample"
                                         : "LightSamples";
  for (const std::size_t light : job.Scene.GetLightOrder())
  {
    const double solidAngle = job.Lights[light]->GetSolidAngleBound(job.Receiver.Base);
    const int count = hasTolerance ? std::min(FirstBatch, settings.MaximumLightSamples)
                                   : settings.GetSampleCount(solidAngle);
    if (!hasTolerance && settings.SolidAnglePerSample * count < solidAngle &&
      settings.SolidAnglePerSample > 0.0)
    {
      job.Result.StoppedBy = "MaximumLightSamples";
    }
    if (hasTolerance && count == 1 && job.Result.Effects[light] == penumbra::Effect::Soft &&
      job.TakeSamples(light, 2).size() > 1)
    {
      job.Result.StoppedBy = "MaximumLightSamples"; // one sample has no halves, and no estimate
    }
    if (job.Result.Effects[light] != penumbra::Effect::None && !this->BakeLight(job, light, count))
    {
      return false;
    }
  }
  return !hasTolerance || this->RefineLights(job);
}

vtkRadianceResolver::Options vtkRadianceBaker::GetOptions(const Job& job) const
{
  vtkRadianceResolver::Options options;
  options.Reflectance = job.Receiver.Settings.Reflectance;
  options.Reconstruction = job.Receiver.Settings.Reconstruction;
  return options;
}

bool vtkRadianceBaker::BakeLight(Job& job, std::size_t light, int count)
{
  const penumbra::LightShape& seen = *job.Lights[light];
  if (!this->Resolver->Begin(job.Window, job.Frame, seen, job.Region.Size, this->GetOptions(job)))
  {
    return false;
  }
  if (job.Result.Effects[light] == penumbra::Effect::Unoccluded)
  {
    this->Resolver->ResolveUnblocked(job.Target, job.Region);
    return true;
  }
  this->Occluders->Select(penumbra::BlockingRegion(job.Frame, seen));
  this->Occluders->Upload();
  const std::vector<penumbra::LightSample> samples = job.TakeSamples(light, count);
  job.Result.LightSamples[light] = static_cast<int>(samples.size());
  return this->Resolver->SetSamples(samples) &&
    this->DrawMasks(job, samples,
      [&](int firstRow, int lastRow, int maskFirstRow)
      {
        this->Resolver->ResolveMasks(
          job.Target, job.Region, firstRow, lastRow, this->Masks, maskFirstRow);
      });
}

template <typename Use>
bool vtkRadianceBaker::DrawMasks(
  Job& job, const std::vector<penumbra::LightSample>& samples, const Use& use)
{
  const glm::ivec2 size = job.Region.Size;
  const int count = static_cast<int>(samples.size());
  const int halo = this->Resolver->GetHalo();
  const std::size_t layers =
    static_cast<std::size_t>(count + vtkVisibilityMask::SamplesPerLayer - 1) /
    vtkVisibilityMask::SamplesPerLayer;
  const std::size_t bytesPerRow = static_cast<std::size_t>(size.x) * layers * sizeof(std::uint32_t);
  const int most = static_cast<int>(
    std::min(this->MaximumMaskBytes / bytesPerRow, static_cast<std::size_t>(size.y)));
  const int rows = most == size.y ? most : std::max(most - 2 * halo, 1);
  const int maskRows = std::min(rows + 2 * halo, size.y);
  if (!this->Masks->Allocate(job.Window, size.x, maskRows, count))
  {
    return false;
  }
  const std::vector<penumbra::RegisteredProjection> projections =
    MakeProjections(samples, job.Frame);
  for (int row = 0; row < size.y; row += rows)
  {
    const int maskFirstRow = std::max(row - halo, 0);
    this->Masks->Draw(this->Occluders, projections, size, maskFirstRow);
    use(row, std::min(row + rows, size.y), maskFirstRow);
  }
  const std::size_t bytes = bytesPerRow * static_cast<std::size_t>(maskRows) +
    job.Target->GetBytes() + this->Resolver->GetBytes();
  job.Result.PeakBytes = std::max(job.Result.PeakBytes, bytes);
  return true;
}

bool vtkRadianceBaker::RefineLights(Job& job)
{
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const glm::dvec2 first = FindErrorAndPeak(job.Target->Download(job.Region), settings);
  const double allowed = settings.ErrorTolerance * first.y;
  const auto soft =
    std::count(job.Result.Effects.begin(), job.Result.Effects.end(), penumbra::Effect::Soft);
  if (first.x <= allowed || soft == 0)
  {
    return true;
  }
  vtkNew<vtkRadianceTexture> scratch;
  if (!scratch->Allocate(job.Window, { job.Region.Size }))
  {
    return false;
  }
  // The lights' errors add up as their squares do, and each gets an equal part.
  const double allowedOfLight = allowed / std::sqrt(static_cast<double>(soft));
  job.Target->Clear(job.Region);
  bool isDone = true;
  for (const std::size_t light : job.Scene.GetLightOrder())
  {
    const penumbra::Effect effect = job.Result.Effects[light];
    isDone = isDone &&
      (effect == penumbra::Effect::Soft
          ? this->RefineLight(job, light, allowedOfLight, scratch)
          : effect == penumbra::Effect::None || this->BakeLight(job, light, 0));
  }
  scratch->ReleaseGraphicsResources();
  const glm::dvec2 last = FindErrorAndPeak(job.Target->Download(job.Region), settings);
  if (last.x > settings.ErrorTolerance * last.y)
  {
    job.Result.StoppedBy = "MaximumLightSamples";
  }
  return isDone;
}

bool vtkRadianceBaker::RefineLight(
  Job& job, std::size_t light, double allowed, vtkRadianceTexture* scratch)
{
  const penumbra::ReceiverSettings& settings = job.Receiver.Settings;
  const bool grows =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(settings.SamplingPattern)].Grows;
  vtkRadianceResolver::Options options = this->GetOptions(job);
  options.InBatches = true;
  if (!this->Resolver->Begin(job.Window, job.Frame, *job.Lights[light], job.Region.Size, options))
  {
    return false;
  }
  this->Occluders->Select(penumbra::BlockingRegion(job.Frame, *job.Lights[light]));
  this->Occluders->Upload();
  int previous = 0;
  for (int count = std::min(FirstBatch, settings.MaximumLightSamples);;
       count = std::min(2 * count, settings.MaximumLightSamples))
  {
    std::vector<penumbra::LightSample> samples = job.TakeSamples(light, count);
    const int total = static_cast<int>(samples.size());
    if (grows)
    {
      samples.erase(samples.begin(), samples.begin() + previous);
    }
    if (!this->Resolver->SetSamples(samples, grows ? previous : 0) ||
      !this->DrawMasks(job, samples,
        [&](int firstRow, int lastRow, int maskFirstRow)
        { this->Resolver->CountMasks(this->Masks, maskFirstRow, firstRow, lastRow); }))
    {
      return false;
    }
    job.Result.LightSamples[light] = total;
    this->Resolver->ResolveCounts(scratch, scratch->GetRegions().front(), false);
    const glm::dvec2 error =
      FindErrorAndPeak(scratch->Download(scratch->GetRegions().front()), settings);
    if (error.x <= allowed || total >= settings.MaximumLightSamples || total <= previous)
    {
      break;
    }
    previous = total;
  }
  this->Resolver->ResolveCounts(job.Target, job.Region, true);
  return true;
}

void vtkRadianceBaker::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumMaskBytes: " << this->MaximumMaskBytes << "\n";
}

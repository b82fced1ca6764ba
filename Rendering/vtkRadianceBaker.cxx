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

vtkStandardNewMacro(vtkRadianceBaker);

namespace
{

/// The lowest height of a sample, in units of the receiver's size: on the plane itself it would
/// have no projection, and it sends nothing.
constexpr double SmallestSampleHeight = 1e-12;

/// The lights as the receiver sees them: what lies in front of it.
std::vector<penumbra::PolygonLight> ClipLights(
  const std::vector<penumbra::PolygonLight>& lights, const penumbra::ReceiverFrame& frame)
{
  std::vector<penumbra::PolygonLight> seen;
  for (const penumbra::PolygonLight& light : lights)
  {
    seen.push_back(light.ClippedToFront(frame.GetBase().Corner, frame.GetNormal()));
  }
  return seen;
}

/// The height of the highest light vertex, in units of the receiver's size.
double MaximumHeight(
  const std::vector<penumbra::PolygonLight>& lights, const penumbra::ReceiverFrame& frame)
{
  double highest = 0.0;
  for (const penumbra::PolygonLight& light : lights)
  {
    for (const glm::dvec3& vertex : light.GetVertices())
    {
      highest = std::max(highest, frame.ToFrame(vertex).z);
    }
  }
  return highest;
}

} // namespace

/// What the stages of one receiver's bake share.
struct vtkRadianceBaker::Job
{
  const penumbra::ShadowScene& Scene;
  const penumbra::Receiver& Receiver;
  penumbra::ReceiverFrame Frame;
  std::vector<penumbra::PolygonLight> Lights; ///< clipped to the receiver's front
  std::vector<glm::dvec2> Pattern;
  vtkOpenGLRenderWindow* Window;
  vtkRadianceTexture* Target;
  vtkRadianceTexture::Region Region; ///< in Target, of supersampled texels
  Report Result;
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
    this->Masks->ReleaseGraphicsResources(); // before the mip levels take their place
    texture->GenerateMipmaps();
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
  std::vector<glm::dvec2> pattern =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(settings.SamplingPattern)].Generate(
      settings.GetSampleCount(), static_cast<std::uint32_t>(settings.Seed));
  // OpenGL 3.2 promises room for 8192 samples; Mesa and most drivers have it for all.
  pattern.resize(std::min(
    pattern.size(), static_cast<std::size_t>(vtkVisibilityMask::GetMaximumSamples(window))));
  Job job{ scene, r, frame, ClipLights(scene.Lights, frame), std::move(pattern), window, texture,
    place, {} };
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
  this->Occluders->Build(job.Scene, job.Receiver, job.Frame, MaximumHeight(job.Lights, job.Frame));
  job.Result.Triangles = this->Occluders->GetNumberOfTriangles();
  job.Result.LightSamples.assign(job.Lights.size(), 0);
  for (const penumbra::PolygonLight& light : job.Lights)
  {
    job.Result.Effects.push_back(
      penumbra::PlanEffect(job.Frame, light, this->Occluders->GetNumberOfTriangles() > 0));
  }
  for (const std::size_t light : job.Scene.GetLightOrder())
  {
    if (job.Result.Effects[light] != penumbra::Effect::None && !this->BakeLight(job, light))
    {
      return false;
    }
  }
  return true;
}

bool vtkRadianceBaker::BakeLight(Job& job, std::size_t light)
{
  const penumbra::PolygonLight& seen = job.Lights[light];
  if (job.Result.Effects[light] == penumbra::Effect::Unoccluded)
  {
    if (!this->Resolver->Begin(job.Window, job.Frame, job.Receiver.Settings.Reflectance, seen, {}))
    {
      return false;
    }
    this->Resolver->Resolve(job.Target, job.Region, 0, job.Region.Size.y, nullptr);
    return true;
  }

  std::vector<glm::dvec3> samples;
  std::vector<penumbra::RegisteredProjection> projections;
  for (const glm::dvec2& s : job.Pattern)
  {
    samples.push_back(seen.Sample(s));
    glm::dvec3 sample = job.Frame.ToFrame(samples.back());
    sample.z = std::max(sample.z, SmallestSampleHeight);
    projections.push_back(penumbra::RegisteredProjection::FromPoint(sample));
  }
  const glm::ivec2 size = job.Region.Size;
  const int count = static_cast<int>(samples.size());
  const std::size_t layers =
    static_cast<std::size_t>(count + vtkVisibilityMask::SamplesPerLayer - 1) /
    vtkVisibilityMask::SamplesPerLayer;
  const std::size_t bytesPerRow = static_cast<std::size_t>(size.x) * layers * sizeof(std::uint32_t);
  const int rows = static_cast<int>(
    std::clamp<std::size_t>(MaximumMaskBytes / bytesPerRow, 1, static_cast<std::size_t>(size.y)));
  if (!this->Masks->Allocate(job.Window, size.x, rows, count) ||
    !this->Resolver->Begin(job.Window, job.Frame, job.Receiver.Settings.Reflectance, seen, samples))
  {
    return false;
  }
  for (int row = 0; row < size.y; row += rows)
  {
    this->Masks->Draw(this->Occluders, projections, size, row);
    this->Resolver->Resolve(job.Target, job.Region, row, std::min(row + rows, size.y), this->Masks);
  }
  job.Result.LightSamples[light] = count;
  const std::size_t bytes = bytesPerRow * static_cast<std::size_t>(rows) + job.Target->GetBytes();
  job.Result.PeakBytes = std::max(job.Result.PeakBytes, bytes);
  return true;
}

void vtkRadianceBaker::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

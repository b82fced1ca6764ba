// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What visibility masks gain over the loop of H&H 1997, section 3.5, what they take, and what baked
// shadows cost a frame. See README.md.

#include "BenchmarkTools.h"
#include "LiteralLoop.h"
#include "PairedView.h"
#include "ShadowScene.h"
#include "Spheres.h"

#include "vtkActor.h"
#include "vtkAreaLightSource.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkPlaneSource.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkRenderer.h"
#include "vtkShadowReceiver.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace
{

/// How much is done.
struct Plan
{
  int Texels = 512; ///< along each side of the floor
  int Samples = 256;
  int Runs = 5;
  int Frames = 200; ///< of each kind
  std::vector<int> Rings{ 4, 11 };
  bool JudgesTimes = true;
};

/// CI's: enough for counts, too little for times.
Plan MakeSmallestPlan()
{
  return { 64, 64, 1, 3, { 4 }, false };
}

constexpr double FloorEdge = 10.0;
/// The floor under the spheres, and a light of 2 x 2 at a height of 8.
penumbra::ShadowScene MakeScene(const Plan& plan, int rings)
{
  penumbra::Receiver receiver;
  receiver.Base = { glm::dvec3(0.0), { FloorEdge, 0.0, 0.0 }, { 0.0, FloorEdge, 0.0 } };
  receiver.Settings.LightSamples = plan.Samples;
  receiver.Settings.Reconstruction = false; // the literal loop has none
  receiver.Texels = glm::ivec2(plan.Texels);
  penumbra::Surface floor;
  floor.Points = { { 0, 0, 0 }, { FloorEdge, 0, 0 }, { FloorEdge, FloorEdge, 0 },
    { 0, FloorEdge, 0 } };
  floor.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  floor.Regions = { 0, 0 };
  penumbra::ShadowScene scene;
  scene.Surfaces = { floor, MakeSpheres(rings) };
  scene.Receivers = { receiver };
  scene.Lights = { penumbra::PolygonLight::Parallelogram({ 4, 4, 8 }, { 4, 6, 8 }, { 6, 4, 8 }) };
  return scene;
}

/// What was found of one scene's bake.
struct BakeResult
{
  std::size_t Triangles = 0;
  double MaskSeconds = 0.0;    ///< median
  double LiteralSeconds = 0.0; ///< median
  double PeakBytesPerTexel = 0.0;
  double ShownBytesPerTexel = 0.0;
  double AllowedBytesPerTexel = 0.0;
  std::size_t Differing = 0;      ///< texels where masks and loop differ by over 1e-5 of the peak
  double LargestDifference = 0.0; ///< of the peak
  double Speedup() const { return this->LiteralSeconds / this->MaskSeconds; }
};

/// Texels at which single samples may differ, since an occluder's edge passes through the texel's
/// centre: see TestLiteralLoop.cxx, which proves them so one by one.
constexpr double TossUpShare = 2e-3;
constexpr double Tolerance = 1e-5;

void Compare(
  const std::vector<glm::vec4>& baked, const std::vector<glm::dvec3>& reference, BakeResult& result)
{
  double peak = 0.0;
  for (const glm::dvec3& value : reference)
  {
    peak = std::max(peak, value.x);
  }
  for (std::size_t i = 0; i < baked.size(); ++i)
  {
    const double difference = std::abs(static_cast<double>(baked[i].x) - reference[i].x) / peak;
    result.LargestDifference = std::max(result.LargestDifference, difference);
    result.Differing += difference <= Tolerance ? 0 : 1;
  }
}

/// Masks and loop in turn, so that what disturbs the machine disturbs both.
BakeResult MeasureBake(const Plan& plan, int rings, vtkOpenGLRenderWindow* window)
{
  const penumbra::ShadowScene scene = MakeScene(plan, rings);
  const double texels = static_cast<double>(plan.Texels) * plan.Texels;
  vtkNew<vtkRadianceBaker> baker;
  vtkNew<vtkRadianceTexture> texture;
  LiteralLoop loop;
  BakeResult result;

  // Untimed: shaders are compiled; and the loop's ratio form is what the masks compute.
  const auto reports = baker->Bake(scene, { 0 }, window, texture);
  loop.Bake(scene, 0, window, LiteralLoop::Estimator::Ratio);
  Compare(
    texture->Download(texture->GetRegions().front()).Irradiance, loop.GetIrradiance(), result);
  result.Triangles = reports.front().Pairs.front().Triangles;
  result.PeakBytesPerTexel = static_cast<double>(reports.front().PeakBytes) / texels;
  texture->GenerateMipmaps();
  result.ShownBytesPerTexel = static_cast<double>(texture->GetBytes()) / texels;
  result.AllowedBytesPerTexel = reports.front().Pairs.front().LightSamples / 8.0 + 24.0;

  std::vector<double> masks, literal;
  for (int run = 0; run < plan.Runs; ++run)
  {
    const double start = GetTime();
    baker->Bake(scene, { 0 }, window, texture);
    texture->GenerateMipmaps();
    window->WaitForCompletion();
    masks.push_back(GetTime() - start);
    loop.Bake(scene, 0, window, LiteralLoop::Estimator::PlainSum);
    literal.push_back(loop.GetSeconds());
  }
  texture->ReleaseGraphicsResources();
  result.MaskSeconds = GetMedian(masks);
  result.LiteralSeconds = GetMedian(literal);
  return result;
}

vtkSmartPointer<vtkPolyData> MakePolyData(const penumbra::Surface& surface)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const glm::dvec3& p : surface.Points)
  {
    points->InsertNextPoint(p.x, p.y, p.z);
  }
  vtkNew<vtkCellArray> triangles;
  for (const penumbra::Surface::Triangle& t : surface.Triangles)
  {
    triangles->InsertNextCell({ t[0], t[1], t[2] });
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(triangles);
  return data;
}

/// How the scene is looked at.
enum class Framing
{
  Whole, ///< as vtkRenderer::ResetCamera frames it, from above
  Close  ///< the floor fills most of the picture, and all else is cheap
};

void Fill(const Plan& plan, vtkRenderer* renderer)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(0.0, 0.0, 0.0);
  plane->SetPoint1(FloorEdge, 0.0, 0.0);
  plane->SetPoint2(0.0, FloorEdge, 0.0);
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(plane->GetOutputPort());
  receiver->SetTexelSize(FloorEdge / plan.Texels);
  receiver->SetLightSamples(plan.Samples);
  renderer->AddActor(MakeActor(receiver));

  vtkNew<vtkAreaLightSource> light;
  light->SetOrigin(4.0, 4.0, 8.0);
  light->SetPoint1(4.0, 6.0, 8.0);
  light->SetPoint2(6.0, 4.0, 8.0);
  renderer->AddActor(MakeActor(light));

  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(MakePolyData(MakeSpheres(plan.Rings.back())));
  vtkNew<vtkActor> spheres;
  spheres->SetMapper(mapper);
  renderer->AddActor(spheres);
}

FrameResult MeasureFrames(const Plan& plan, vtkRenderWindow* window, Framing framing)
{
  PairedView view(window, [&](vtkRenderer* renderer) { Fill(plan, renderer); });
  vtkCamera* camera = view.GetCamera();
  camera->SetFocalPoint(FloorEdge / 2, FloorEdge / 2, 0.0);
  camera->SetPosition(FloorEdge / 2, -0.6 * FloorEdge, 0.9 * FloorEdge);
  camera->SetViewUp(0.0, 0.0, 1.0);
  if (framing == Framing::Whole)
  {
    view.ShowAll();
  }
  return view.Measure(plan.Frames);
}

/// What issue 2 asks for.
constexpr double RequiredSpeedups[] = { 2.0, 1.4 };
constexpr double LargestFrameRatio = 1.05;

void PrintFrames(const Plan& plan, const char* name, const FrameResult& frames)
{
  std::printf("Frames, 800 x 600, %s, medians of %d: without shadows %.3f ms, with %.3f ms of all "
              "processors, ratio %.3f; bakes: %d\n",
    name, plan.Frames, 1e3 * frames.PlainSeconds, 1e3 * frames.ShadowSeconds, frames.Ratio,
    frames.Bakes);
}

void PrintTable(const Plan& plan, const std::vector<BakeResult>& bakes)
{
  std::printf("%d x %d texels, n = %d, medians of %d runs\n\n", plan.Texels, plan.Texels,
    plan.Samples, plan.Runs);
  std::printf("| triangles | masks, s | literal, s | speed-up | bytes a texel: at the peak, then | "
              "allowed | texels that differ | largest difference |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const BakeResult& b : bakes)
  {
    std::printf("| %zu | %.3f | %.3f | %.2f | %.2f, %.2f | %.2f | %zu | %.1e |\n", b.Triangles,
      b.MaskSeconds, b.LiteralSeconds, b.Speedup(), b.PeakBytesPerTexel, b.ShownBytesPerTexel,
      b.AllowedBytesPerTexel, b.Differing, b.LargestDifference);
  }
  std::printf("\n");
}

bool WriteJson(const std::string& path, const Plan& plan, const std::vector<BakeResult>& bakes,
  const FrameResult& frames, const FrameResult& closeFrames)
{
  std::ofstream file(path);
  file << "{\n  \"texels\": " << plan.Texels << ", \"samples\": " << plan.Samples
       << ", \"runs\": " << plan.Runs << ",\n  \"bakes\": [";
  const char* separator = "\n";
  for (const BakeResult& b : bakes)
  {
    file << separator << "    { \"triangles\": " << b.Triangles
         << ", \"maskSeconds\": " << b.MaskSeconds << ", \"literalSeconds\": " << b.LiteralSeconds
         << ", \"speedup\": " << b.Speedup() << ", \"peakBytesPerTexel\": " << b.PeakBytesPerTexel
         << ", \"shownBytesPerTexel\": " << b.ShownBytesPerTexel
         << ", \"allowedBytesPerTexel\": " << b.AllowedBytesPerTexel
         << ", \"differingTexels\": " << b.Differing
         << ", \"largestDifference\": " << b.LargestDifference << " }";
    separator = ",\n";
  }
  file << "\n  ],\n  \"frames\": { \"count\": " << plan.Frames
       << ", \"plainSeconds\": " << frames.PlainSeconds
       << ", \"shadowSeconds\": " << frames.ShadowSeconds << ", \"ratio\": " << frames.Ratio
       << ", \"bakes\": " << frames.Bakes << ", \"closeRatio\": " << closeFrames.Ratio << " }\n}\n";
  file.close();
  return !file.fail();
}

bool Judge(const Plan& plan, const std::vector<BakeResult>& bakes, const FrameResult& frames)
{
  bool good = Require(frames.Bakes == 1, "moving the camera must not bake");
  for (std::size_t i = 0; i < bakes.size(); ++i)
  {
    const BakeResult& b = bakes[i];
    const std::string name = std::to_string(b.Triangles) + " triangles: ";
    good &= Require(static_cast<double>(b.Differing) <= TossUpShare * plan.Texels * plan.Texels,
      name + "masks and loop must agree to 1e-5 of the peak");
    good &= Require(std::max(b.PeakBytesPerTexel, b.ShownBytesPerTexel) <= b.AllowedBytesPerTexel,
      name + "masks and textures must take no more than n/8 + 24 bytes a texel");
    good &= Require(!plan.JudgesTimes || b.Speedup() >= RequiredSpeedups[i],
      name + "masks must be " + std::to_string(RequiredSpeedups[i]) + " times as fast");
  }
  return good &
    Require(!plan.JudgesTimes || frames.Ratio <= LargestFrameRatio,
      "a frame with baked shadows must take no more than 1.05 of one without");
}

int Run(const Plan& plan, const std::string& jsonPath)
{
  const vtkSmartPointer<vtkOpenGLRenderWindow> window = MakeWindow();
  window->SetSize(800, 600);
  window->Initialize(); // VTK 9.6 renders nothing, and makes no context, where there is no renderer
  if (!window->SupportsOpenGL())
  {
    std::fprintf(stderr, "BakeSpeed: no OpenGL: %s\n", window->ReportCapabilities());
    return 1;
  }
  window->MakeCurrent(); // VTK 9.6 has asked a window of its own
  std::vector<BakeResult> bakes;
  for (const int rings : plan.Rings)
  {
    bakes.push_back(MeasureBake(plan, rings, window));
  }
  PrintTable(plan, bakes);
  const FrameResult frames = MeasureFrames(plan, window, Framing::Whole);
  PrintFrames(plan, "the whole scene", frames);
  const FrameResult closeFrames = MeasureFrames(plan, window, Framing::Close);
  PrintFrames(plan, "the floor alone (not judged)", closeFrames);
  if (!jsonPath.empty() && !WriteJson(jsonPath, plan, bakes, frames, closeFrames))
  {
    std::fprintf(stderr, "BakeSpeed: cannot write %s\n", jsonPath.c_str());
    return 1;
  }
  return Judge(plan, bakes, frames) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  return RunBenchmark(argc, argv, "BakeSpeed", Plan(), MakeSmallestPlan(), Run);
}

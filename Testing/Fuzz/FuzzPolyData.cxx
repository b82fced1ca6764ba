// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The target of libFuzzer: whatever polygonal data are given, nothing crashes, what is refused is
// refused by one message that says what is allowed, and the scene is finite.

#include "ParallelogramFit.h"
#include "PlanarRegions.h"
#include "PolyDataFromBytes.h"
#include "vtkAreaLightFromSurface.h"
#include "vtkCellArray.h"
#include "vtkLogger.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPolyData.h"
#include "vtkShadowReceiver.h"
#include "vtkShadowSceneBuilder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace
{

/// Ends the program, as fuzzers want it.
void Require(bool isTrue, const std::string& what)
{
  if (!isTrue)
  {
    std::cerr << "Violated: " << what << "\n";
    std::abort();
  }
}

/// Keeps what VTK has to say.
class MessageWindow : public vtkOutputWindow
{
public:
  static MessageWindow* New();
  vtkTypeMacro(MessageWindow, vtkOutputWindow)

  void DisplayText(const char* text) override { this->Texts.emplace_back(text); }

  /// Of what was done since the last call: no more messages than this, and all by the product.
  void RequireAtMost(std::size_t most, const std::string& what)
  {
    std::string all;
    for (const std::string& text : this->Texts)
    {
      all += text;
      Require(text.find("allowed:") != std::string::npos ||
          text.find("TexelSize is too small") != std::string::npos,
        what + " says what is allowed:\n" + text);
    }
    Require(this->Texts.size() <= most, what + " says it once:\n" + all);
    this->Texts.clear();
  }

private:
  std::vector<std::string> Texts;
};
vtkStandardNewMacro(MessageWindow);

MessageWindow* GetMessages()
{
  static const vtkNew<MessageWindow> window;
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkOutputWindow::SetInstance(window);
  return window;
}

bool IsFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void RequireFinite(const penumbra::Parallelogram& base, const std::string& what)
{
  Require(IsFinite(base.Corner) && IsFinite(base.EdgeX) && IsFinite(base.EdgeY), what);
  const penumbra::ReceiverFrame frame(base, penumbra::ReceiverFrame::Side::Front);
  Require(frame.IsValid(), what + " has a frame");
  Require(std::abs(glm::length(frame.GetNormal()) - 1.0) < 1e-6, what + " has a unit normal");
  Require(IsFinite(frame.ToFrame(base.Corner + base.EdgeX)), what + " has coordinates");
}

void RequireFinite(const penumbra::Surface& surface)
{
  Require(surface.Regions.empty() || surface.Regions.size() == surface.Triangles.size(),
    "each triangle has a region");
  for (const penumbra::Surface::Triangle& triangle : surface.Triangles)
  {
    for (const std::uint32_t id : triangle)
    {
      Require(id < surface.Points.size(), "triangles have points");
      Require(IsFinite(surface.Points[id]), "triangles are finite");
    }
  }
}

void RequireFinite(const penumbra::Light& light, const penumbra::Parallelogram& base)
{
  Require(IsFinite(light->Radiance), "a light's radiance is finite");
  if (!light->IsValid())
  {
    return;
  }
  for (const glm::dvec3& p : light->GetHull().Points)
  {
    Require(IsFinite(p), "a light is finite");
  }
  Require(std::isfinite(light->GetMeasure()), "a light's size is finite");
  const penumbra::ReceiverFrame frame(base, penumbra::ReceiverFrame::Side::Front);
  const glm::dvec3 x = frame.ToWorld({ 0.5, 0.5, 0.0 });
  Require(IsFinite(light->Irradiance(x, frame.GetNormal())), "light is finite");
  const penumbra::Light seen(light->Clip(base.Corner, frame.GetNormal()));
  if (seen->IsValid())
  {
    for (const penumbra::LightSample& sample : seen->TakeSamples({ { 0.0, 0.0 }, { 0.7, 0.9 } }))
    {
      Require(IsFinite(sample.Place), "samples are finite");
    }
  }
}

void RequireFinite(const penumbra::ShadowScene& scene)
{
  for (const penumbra::SharedSurface& shared : scene.Surfaces)
  {
    const penumbra::Surface& surface = *shared;
    RequireFinite(surface);
  }
  for (const penumbra::Receiver& receiver : scene.Receivers)
  {
    RequireFinite(receiver.Base, "a receiver");
    Require(receiver.Texels.x > 0 && receiver.Texels.y > 0, "a receiver has texels");
    Require(receiver.Settings.FindProblem().empty(), "a receiver's settings make sense");
    Require(receiver.Surface < scene.Surfaces.size(), "a receiver has a surface");
    const penumbra::ReceiverFrame frame = scene.MakeFrame(receiver);
    Require(frame.IsValid(), "a receiver has a side");
  }
  for (const penumbra::Light& light : scene.Lights)
  {
    RequireFinite(light, penumbra::Parallelogram());
    if (!scene.Receivers.empty())
    {
      RequireFinite(light, scene.Receivers.front().Base);
    }
  }
}

void TryBuilder(vtkPolyData* data, ByteReader& bytes)
{
  vtkNew<vtkMatrix4x4> matrix;
  const int roles = bytes.Byte();
  const bool hasMatrix = bytes.Flag();
  for (int i = 0; hasMatrix && i < 12; ++i)
  {
    matrix->SetElement(i / 4, i % 4, bytes.Number());
  }
  vtkNew<vtkShadowSceneBuilder> builder;
  builder->AddData(data, hasMatrix ? matrix.Get() : nullptr, roles, "fuzzed");
  RequireFinite(builder->GetScene());
  // A receiver that does not fit, and its polygons that are no part of the scene.
  GetMessages()->RequireAtMost(2, "the builder");
}

void TryReceiver(vtkPolyData* data)
{
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(data);
  receiver->Update();
  GetMessages()->RequireAtMost(1, "ShadowReceiver");
  vtkNew<vtkShadowSceneBuilder> builder;
  builder->AddData(receiver->GetOutput(), nullptr,
    vtkShadowSceneBuilder::DefaultReceiver | vtkShadowSceneBuilder::Occluder, "receiver");
  RequireFinite(builder->GetScene());
  GetMessages()->RequireAtMost(1, "the builder after ShadowReceiver");
}

void TryLight(vtkPolyData* data, ByteReader& bytes)
{
  vtkNew<vtkAreaLightFromSurface> light;
  light->SetInputData(data);
  light->SetTwoSided(bytes.Flag());
  light->SetRadianceArray(bytes.Flag() ? FuzzedRadianceArray : "");
  light->Update();
  GetMessages()->RequireAtMost(1, "AreaLightFromSurface");
  vtkNew<vtkShadowSceneBuilder> builder;
  builder->AddData(light->GetOutput(), nullptr, vtkShadowSceneBuilder::Light, "light");
  RequireFinite(builder->GetScene());
  GetMessages()->RequireAtMost(0, "the builder after AreaLightFromSurface");
}

/// Without what VTK's data go through before.
void TryRegions(ByteReader& bytes)
{
  penumbra::PolygonMesh mesh;
  constexpr int mostPoints = 12, mostPolygons = 6, mostCorners = 6;
  for (int i = 1 + bytes.Below(mostPoints); i > 0; --i)
  {
    const double x = bytes.Number(), y = bytes.Number();
    mesh.Points.emplace_back(x, y, bytes.Number());
  }
  for (int i = bytes.Below(mostPolygons); i > 0; --i)
  {
    std::vector<int>& polygon = mesh.Polygons.emplace_back();
    for (int j = 3 + bytes.Below(mostCorners); j > 0; --j)
    {
      polygon.push_back(bytes.Byte() % static_cast<int>(mesh.Points.size()));
    }
  }
  const penumbra::PlanarRegions regions = penumbra::FindPlanarRegions(mesh);
  Require(regions.Problem.empty() != regions.Regions.empty(), "there are regions or a problem");
  for (const penumbra::PlanarRegion& region : regions.Regions)
  {
    RequireFinite(region.Base, "a region");
  }
  for (const glm::dvec3& normal : { glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0, 0.8) })
  {
    if (const auto base = penumbra::FitParallelogram(mesh.Points, normal))
    {
      Require(IsFinite(base->Corner) && IsFinite(base->EdgeX) && IsFinite(base->EdgeY), "a fit");
    }
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  ByteReader bytes(data, size);
  GetMessages();
  const int choice = bytes.Below(4);
  if (choice == 0)
  {
    TryRegions(bytes);
    return 0;
  }
  const vtkSmartPointer<vtkPolyData> polygons = MakePolyData(bytes);
  if (choice == 1)
  {
    TryBuilder(polygons, bytes);
  }
  else if (choice == 2)
  {
    TryReceiver(polygons);
  }
  else
  {
    TryLight(polygons, bytes);
  }
  return 0;
}

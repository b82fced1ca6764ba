// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TestScenes.h"

#include "OracleScene.h"
#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

namespace
{

vtkSmartPointer<vtkRenderWindow> TheWindow;

} // namespace

vtkOpenGLRenderWindow* GetTestWindow()
{
  if (!TheWindow)
  {
    TheWindow = vtkSmartPointer<vtkRenderWindow>::New();
    TheWindow->SetSize(16, 16);
    TheWindow->Render();
  }
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(TheWindow);
  window->MakeCurrent();
  return window;
}

void ReleaseTestWindow()
{
  TheWindow = nullptr;
}

void TestScene::AddLight(const glm::dvec3& origin, const glm::dvec3& point1,
  const glm::dvec3& point2, const glm::dvec3& radiance)
{
  this->Lights.push_back(penumbra::PolygonLight::Parallelogram(origin, point1, point2));
  this->Lights.back()->Radiance = radiance;
}

void TestScene::AddPlate(const glm::dvec3& corner, const glm::dvec3& edge1, const glm::dvec3& edge2)
{
  const oracle::Vec3 a = ToOracle(corner);
  const oracle::Vec3 b = ToOracle(corner + edge1);
  const oracle::Vec3 c = ToOracle(corner + edge1 + edge2);
  const oracle::Vec3 d = ToOracle(corner + edge2);
  this->Occluders.push_back({ a, b, c });
  this->Occluders.push_back({ a, c, d });
}

void TestScene::AddBox(const glm::dvec3& low, const glm::dvec3& high)
{
  const glm::dvec3 size = high - low;
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 across(0.0), edge1(0.0), edge2(0.0);
    across[axis] = size[axis];
    edge1[(axis + 1) % 3] = size[(axis + 1) % 3];
    edge2[(axis + 2) % 3] = size[(axis + 2) % 3];
    this->AddPlate(low, edge1, edge2);
    this->AddPlate(low + across, edge1, edge2);
  }
}

penumbra::ShadowScene TestScene::MakeScene() const
{
  penumbra::Surface floor;
  const penumbra::Parallelogram& b = this->Base;
  floor.Points = { b.Corner, b.Corner + b.EdgeX, b.Corner + b.EdgeX + b.EdgeY, b.Corner + b.EdgeY };
  floor.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  floor.Regions = { 0, 0 };

  penumbra::Surface occluders;
  for (const oracle::Triangle& t : this->Occluders)
  {
    const auto first = static_cast<std::uint32_t>(occluders.Points.size());
    occluders.Points.insert(
      occluders.Points.end(), { FromOracle(t.A), FromOracle(t.B), FromOracle(t.C) });
    occluders.Triangles.push_back({ first, first + 1, first + 2 });
  }

  penumbra::Receiver receiver;
  receiver.Base = this->Base;
  receiver.Settings = this->Settings;
  receiver.Texels = this->Texels;
  penumbra::ShadowScene scene;
  scene.Surfaces = { floor, occluders };
  scene.Receivers = { receiver };
  scene.Lights = this->Lights;
  return scene;
}

glm::dvec3 TestScene::GetExact(int i, int j) const
{
  const penumbra::Parallelogram& b = this->Base;
  const glm::dvec3 x =
    b.Corner + ((i + 0.5) / this->Texels.x) * b.EdgeX + ((j + 0.5) / this->Texels.y) * b.EdgeY;
  std::vector<oracle::Light> lights;
  for (const penumbra::Light& light : this->Lights)
  {
    oracle::Light& entry = lights.emplace_back();
    for (const glm::dvec3& vertex : light->GetPolygons().front().Polygon->GetVertices())
    {
      entry.Vertices.push_back(ToOracle(vertex));
    }
    entry.TwoSided = light->TwoSided;
    entry.Radiance = { light->Radiance.x, light->Radiance.y, light->Radiance.z };
  }
  const std::array<double, 3> exact =
    oracle::Radiance(ToOracle(x), ToOracle(glm::cross(b.EdgeX, b.EdgeY)), lights, this->Occluders,
      { 1.0, 1.0, 1.0 }, { 0.0, 0.0, 0.0 });
  return { exact[0], exact[1], exact[2] };
}

TestBake BakeReceiver(const penumbra::ShadowScene& scene, std::size_t receiver)
{
  vtkNew<vtkRadianceBaker> baker;
  vtkNew<vtkRadianceTexture> texture;
  TestBake result;
  result.Reports = baker->Bake(scene, { receiver }, GetTestWindow(), texture);
  if (!result.Reports.empty())
  {
    result.Texels = texture->Download(texture->GetRegions().front());
  }
  texture->ReleaseGraphicsResources();
  return result;
}

std::size_t CountExactTexels(const TestBake& bake)
{
  std::size_t count = 0;
  for (const vtkRadianceBaker::Report& report : bake.Reports)
  {
    for (const vtkRadianceBaker::PairReport& pair : report.Pairs)
    {
      count += pair.ExactTexels;
    }
  }
  return count;
}

TestError CompareWithOracle(const TestScene& scene)
{
  const TestBake bake = BakeReceiver(scene.MakeScene());
  double peak = 0.0, largest = 0.0, squares = 0.0;
  for (int j = 0; j < scene.Texels.y; ++j)
  {
    for (int i = 0; i < scene.Texels.x; ++i)
    {
      const glm::dvec3 exact = scene.GetExact(i, j);
      const auto texel = static_cast<std::size_t>(j * scene.Texels.x + i);
      const glm::dvec3 error = glm::dvec3(bake.Texels.Irradiance.at(texel)) - exact;
      for (int c = 0; c < 3; ++c)
      {
        peak = std::max(peak, exact[c]);
        largest = std::max(largest, std::abs(error[c]));
        squares += error[c] * error[c];
      }
    }
  }
  const double count = 3.0 * scene.Texels.x * scene.Texels.y;
  return { std::sqrt(squares / count) / peak, largest / peak };
}

std::vector<TestScene> GetOccludedScenes()
{
  std::vector<TestScene> scenes;

  TestScene convex;
  convex.Name = "ConvexOccluder";
  convex.AddLight({ -0.4, 0.5, 3.0 }, { 0.5, 0.5, 2.9 }, { -0.4, -0.4, 3.1 });
  convex.AddBox({ -0.4, -0.3, 0.3 }, { 0.3, 0.4, 0.9 });
  scenes.push_back(convex);

  TestScene overlapping;
  overlapping.Name = "OverlappingOccluders";
  overlapping.AddLight({ -0.4, 0.4, 3.0 }, { 0.4, 0.4, 3.0 }, { -0.4, -0.4, 3.0 });
  overlapping.AddPlate({ -0.8, -0.4, 0.7 }, { 1.2, 0.2, 0.1 }, { -0.1, 0.5, 0.1 });
  overlapping.AddPlate({ -0.1, -0.7, 1.0 }, { 0.4, 0.1, 0.0 }, { 0.1, 1.1, -0.1 });
  overlapping.AddBox({ 0.1, 0.1, 0.2 }, { 0.6, 0.7, 0.6 });
  scenes.push_back(overlapping);

  TestScene slanted = overlapping;
  slanted.Name = "SlantedReceiver";
  slanted.Base = { { -2, -2, -0.6 }, { 4, 0.3, 0.7 }, { -0.3, 4, 0.1 } };
  // A rectangle: EdgeY is made perpendicular to EdgeX.
  slanted.Base.EdgeY -= slanted.Base.EdgeX *
    (glm::dot(slanted.Base.EdgeY, slanted.Base.EdgeX) /
      glm::dot(slanted.Base.EdgeX, slanted.Base.EdgeX));
  scenes.push_back(slanted);

  TestScene skewed = convex;
  skewed.Name = "SkewedReceiver";
  skewed.Base = { { -2.5, -1.5, 0 }, { 3.5, 0.5, 0 }, { 1.7, 2.6, 0 } };
  scenes.push_back(skewed);

  TestScene coloured = overlapping;
  coloured.Name = "ColouredLights";
  coloured.Lights.clear();
  coloured.AddLight({ -1.5, 0.5, 2.5 }, { -0.5, 0.5, 3.0 }, { -1.5, -0.5, 2.5 }, { 2.0, 0.5, 0.1 });
  coloured.Lights.push_back(
    penumbra::PolygonLight::Triangle({ 0.6, 0.8, 2.8 }, { 1.8, 0.4, 2.2 }, { 0.9, -0.6, 2.6 }));
  coloured.Lights.back()->Radiance = { 0.1, 0.6, 3.0 };
  scenes.push_back(coloured);
  return scenes;
}

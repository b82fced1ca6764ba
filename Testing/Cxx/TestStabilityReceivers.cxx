// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Receivers of hard shapes, scenes of all sizes and far from the origin.

#include "StabilityTools.h"

#include "vtkCellArray.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkShadowSceneBuilder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace
{

using Texels = std::vector<glm::vec4>;
using Polygons = std::vector<std::vector<vtkIdType>>;

oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

vtkSmartPointer<vtkPolyData> MakePolyData(
  const std::vector<glm::dvec3>& points, const Polygons& polygons, int type = VTK_DOUBLE)
{
  vtkNew<vtkPoints> places;
  places->SetDataType(type);
  for (const glm::dvec3& p : points)
  {
    places->InsertNextPoint(p.x, p.y, p.z);
  }
  vtkNew<vtkCellArray> cells;
  for (const std::vector<vtkIdType>& polygon : polygons)
  {
    cells->InsertNextCell(static_cast<vtkIdType>(polygon.size()), polygon.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(places);
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> MakeSquare(const TestScene& scene, int type = VTK_DOUBLE)
{
  const penumbra::Parallelogram& b = scene.Base;
  return MakePolyData(
    { b.Corner, b.Corner + b.EdgeX, b.Corner + b.EdgeX + b.EdgeY, b.Corner + b.EdgeY },
    { { 0, 1, 2, 3 } }, type);
}

/// The scene with the receivers that the product finds in the data, in place of its own. The lights
/// are above.
CountError CompareData(
  TestScene scene, const std::vector<vtkPolyData*>& receivers, vtkMatrix4x4* matrix = nullptr)
{
  vtkNew<vtkShadowSceneBuilder> builder;
  for (vtkPolyData* data : receivers)
  {
    builder->AddData(data, matrix,
      vtkShadowSceneBuilder::DefaultReceiver | vtkShadowSceneBuilder::Occluder, scene.Name);
  }
  penumbra::ShadowScene made = builder->GetScene();
  EXPECT_EQ(made.Receivers.size(), receivers.size()) << scene.Name;
  if (made.Receivers.empty())
  {
    return { 1.0, 1.0 };
  }
  scene.Base = made.Receivers.front().Base;
  const bool isUp = glm::cross(scene.Base.EdgeX, scene.Base.EdgeY).z > 0.0;
  scene.Settings.Side = isUp ? penumbra::ReceiverSide::Front : penumbra::ReceiverSide::Back;
  const penumbra::ShadowScene own = scene.MakeScene();
  made.Surfaces.push_back(own.Surfaces.back());
  made.Lights = own.Lights;
  return CompareWithCount(scene, made);
}

void ExpectExactData(const TestScene& scene, const std::vector<vtkPolyData*>& receivers,
  vtkMatrix4x4* matrix = nullptr)
{
  const CountError error = CompareData(scene, receivers, matrix);
  ExpectWithin(scene.Name, error.Largest, GetRadianceBound(scene.Settings.LightSamples));
  // Slivers lie along texels: more of their rays pass an edge by less than the tolerance.
  constexpr double MostOpen = 0.125;
  EXPECT_LE(error.Open, MostOpen) << scene.Name;
}

TestScene MakeBoxScene()
{
  TestScene scene = MakeLampScene();
  scene.AddBox({ 0.3, -0.4, 0.0 }, { 0.8, 0.5, 0.7 });
  scene.AddPlate({ -0.9, -0.8, 0.7 }, { 0.6, 0.2, 0.1 }, { -0.1, 1.2, 0.1 });
  return scene;
}

/// Every coordinate times `scale`, plus `shift`.
TestScene Place(TestScene scene, double scale, const glm::dvec3& shift)
{
  const auto place = [&](const glm::dvec3& p) { return scale * p + shift; };
  scene.Base = { place(scene.Base.Corner), scale * scene.Base.EdgeX, scale * scene.Base.EdgeY };
  for (penumbra::Light& light : scene.Lights)
  {
    const std::vector<glm::dvec3> v = light->GetPolygons().front().Polygon->GetVertices();
    light = penumbra::PolygonLight::Parallelogram(place(v[0]), place(v[1]), place(v[3]));
  }
  for (oracle::Triangle& triangle : scene.Occluders)
  {
    for (oracle::Vec3* p : { &triangle.A, &triangle.B, &triangle.C })
    {
      *p = ToOracle(
        place({ static_cast<double>(p->X), static_cast<double>(p->Y), static_cast<double>(p->Z) }));
    }
  }
  return scene;
}

/// The largest difference of two bakes, of the first one's peak.
double GetDifference(const Texels& a, const Texels& b)
{
  double largest = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    largest = std::max(largest, static_cast<double>(std::abs(a[i].r - b.at(i).r)));
    peak = std::max(peak, static_cast<double>(a[i].r));
  }
  return largest / peak;
}

} // namespace

TEST(StabilityReceiver, SkewedDownToOneDegree)
{
  for (const double degrees : { 60.0, 20.0, 5.0, 1.0 })
  {
    TestScene scene = MakeBoxScene();
    scene.Name = "skewed to " + std::to_string(degrees) + " degrees";
    const double angle = glm::radians(degrees);
    scene.Base.EdgeX = { 4.0, 0.0, 0.0 };
    scene.Base.EdgeY = { 4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0 };
    scene.Base.Corner = -0.5 * (scene.Base.EdgeX + scene.Base.EdgeY);
    const auto data = MakeSquare(scene);
    ExpectExactData(scene, { data });
  }
}

TEST(StabilityReceiver, SliverTriangle)
{
  for (const double width : { 1e-2, 1e-3, 1e-4 })
  {
    TestScene scene = MakeBoxScene();
    std::ostringstream name;
    name << "triangle of aspect " << 4.0 / width;
    scene.Name = name.str();
    scene.Texels = { 64, 2 };
    const auto data = MakePolyData(
      { { -2.0, 0.1, 0.0 }, { 2.0, 0.1, 0.0 }, { 0.7, 0.1 + width, 0.0 } }, { { 0, 1, 2 } });
    ExpectExactData(scene, { data });
  }
}

TEST(StabilityReceiver, OneToTenThousand)
{
  TestScene scene = MakeBoxScene();
  scene.Name = "rectangle of 1 : 10 000";
  scene.Texels = { 512, 1 };
  scene.Base = { { -2.0, 0.1, 0.0 }, { 4.0, 0.0, 0.0 }, { 0.0, 4e-4, 0.0 } };
  const auto data = MakeSquare(scene);
  ExpectExactData(scene, { data });
}

TEST(StabilityReceiver, ConcaveAndHoled)
{
  TestScene scene = MakeBoxScene();
  scene.Name = "concave";
  const auto concave = MakePolyData(
    { { -2, -2, 0 }, { 2, -2, 0 }, { 2, 2, 0 }, { 1, 2, 0 }, { 1, -1, 0 }, { -2, -1, 0 } },
    { { 0, 1, 2, 3, 4, 5 } });
  ExpectExactData(scene, { concave });
  scene.Name = "holed";
  const auto holed = MakePolyData({ { -2, -2, 0 }, { 2, -2, 0 }, { 2, 2, 0 }, { -2, 2, 0 },
                                    { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } },
    { { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 } });
  ExpectExactData(scene, { holed });
}

// Neither shadows the other, though their heights differ by what their coordinates are rounded by.
TEST(StabilityReceiver, CoplanarOverlapping)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    TestScene scene = MakeLampScene();
    scene.Name = type == VTK_FLOAT ? "coplanar floats" : "coplanar doubles";
    scene.Base = { { -2.1, -1.7, -0.6 }, { 4.0, 0.3, 0.7 }, { -0.3, 4.0, 0.1 } };
    const auto below = MakeSquare(scene, type);
    TestScene other = scene;
    other.Base.Corner += 0.123 * scene.Base.EdgeX + 0.217 * scene.Base.EdgeY;
    const auto above = MakeSquare(other, type);
    ExpectExactData(scene, { below, above });
    ExpectExactData(scene, { above, below });
  }
}

// A slanted grid of floats, every other quad wound the other way round.
TEST(StabilityReceiver, PlanarWithinFloatRoundingAndWoundBothWays)
{
  TestScene scene = MakeBoxScene();
  scene.Name = "planar within float rounding";
  scene.Base = { { -2.1, -1.7, -0.6 }, { 4.0, 0.3, 0.7 }, { -0.3, 4.0, 0.1 } };
  const int n = 20;
  std::vector<glm::dvec3> points;
  Polygons quads;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      points.push_back(scene.Base.Corner + static_cast<double>(i) / n * scene.Base.EdgeX +
        static_cast<double>(j) / n * scene.Base.EdgeY);
      const vtkIdType at = j * (n + 1) + i;
      if (i < n && j < n)
      {
        quads.push_back({ at, at + 1, at + n + 2, at + n + 1 });
        if ((i + j) % 2 == 0)
        {
          std::reverse(quads.back().begin(), quads.back().end());
        }
      }
    }
  }
  const auto data = MakePolyData(points, quads, VTK_FLOAT);
  ExpectExactData(scene, { data });
}

TEST(StabilityReceiver, ReversedWinding)
{
  TestScene scene = MakeBoxScene();
  scene.Name = "wound the other way round";
  const auto data =
    MakePolyData({ { -2, -2, 0 }, { -2, 2, 0 }, { 2, 2, 0 }, { 2, -2, 0 } }, { { 0, 1, 2, 3 } });
  ExpectExactData(scene, { data });
}

TEST(StabilityReceiver, ReflectedAndShearedMatrix)
{
  const double reflected[16] = { -1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
  const double sheared[16] = { 1, 1.7, 0, 0.1, 0.2, 1, 0, 0, 0.1, -0.3, -0.5, 0, 0, 0, 0, 1 };
  TestScene scene = MakeBoxScene();
  const auto data = MakeSquare(scene);
  vtkNew<vtkMatrix4x4> matrix;
  matrix->DeepCopy(reflected);
  scene.Name = "reflected by its actor";
  ExpectExactData(scene, { data }, matrix);
  matrix->DeepCopy(sheared);
  scene.Name = "sheared by its actor";
  ExpectExactData(scene, { data }, matrix);
}

// The bound of 1e-5 is the contract's: what decides rays is the same but for roundings, so that
// none that is decided changes.
TEST(StabilityPlace, ScaledByPowersOfTen)
{
  const TestScene scene = MakeBoxScene();
  const Texels texels = BakeTexels(scene);
  for (int exponent = -9; exponent <= 9; exponent += 3)
  {
    TestScene scaled = Place(scene, std::pow(10.0, exponent), glm::dvec3(0.0));
    scaled.Name = "scaled by 1e" + std::to_string(exponent);
    const auto data = MakeSquare(scaled);
    ExpectExactData(scaled, { data });
    ExpectWithin(
      scaled.Name + ", against the unscaled one", GetDifference(texels, BakeTexels(scaled)), 1e-5);
  }
}

// Coordinates of 4e7 have a rounding of 4e-9, 1e-9 of the receiver's size, in double.
TEST(StabilityPlace, TenMillionSizesFromTheOrigin)
{
  const TestScene scene = MakeBoxScene();
  const Texels texels = BakeTexels(scene);
  for (const glm::dvec3& towards :
    { glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(-0.6, 1.0, 0.0), glm::dvec3(0.3, -0.7, 1.0) })
  {
    for (const double sizes : { 1e3, 1e5, 1e7 })
    {
      TestScene moved = Place(scene, 1.0, 4.0 * sizes * towards);
      std::ostringstream name;
      name << "moved by " << sizes << " sizes";
      moved.Name = name.str();
      const auto data = MakeSquare(moved);
      ExpectExactData(moved, { data });
      ExpectWithin(
        moved.Name + ", against the unmoved one", GetDifference(texels, BakeTexels(moved)), 1e-5);
    }
  }
}

TEST(StabilityPlace, RestingOccludersKeepTheirContactFarAway)
{
  TestScene scene = MakeLampScene();
  scene.AddBox({ 0.3, -0.4, 0.0 }, { 0.8, 0.5, 0.7 });
  scene.AddPlate({ -0.9, -0.8, 0.0 }, { 0.6, 0.2, 0.0 }, { -0.1, 1.2, 0.0 }); // a rug
  TestScene moved = Place(scene, 1.0, { 4e7, -3e7, 1e7 + 1.0 / 3.0 });
  moved.Name = "box and rug, 1e7 sizes away";
  const auto data = MakeSquare(moved);
  ExpectExactData(moved, { data });
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Polygons as VTK draws them, and the triangles that cast their shadows.

#include "PolygonCells.h"
#include "Vectors.h"
#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkShadowSceneBuilder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace
{

using Outline = std::vector<glm::dvec2>;
using Triangle = std::array<vtkIdType, 3>;

/// A polygon at z = 1, turned by `angle` about the z axis; its points are numbered in order.
vtkNew<vtkPolyData> MakePolygon(const Outline& outline, double angle, bool is64Bit)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdList> ids;
  for (const glm::dvec2& p : outline)
  {
    const double c = std::cos(angle), s = std::sin(angle);
    ids->InsertNextId(points->InsertNextPoint(c * p.x - s * p.y, s * p.x + c * p.y, 1.0));
  }
  vtkNew<vtkCellArray> polygons;
  is64Bit ? polygons->Use64BitStorage() : polygons->Use32BitStorage();
  polygons->InsertNextCell(ids);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polygons);
  return data;
}

std::vector<Triangle> FindTriangles(vtkPolyData* data)
{
  std::vector<Triangle> triangles;
  penumbra::VisitTriangles(data->GetPolys(), data->GetPoints(),
    [&](vtkIdType, const Triangle& corners) { triangles.push_back(corners); });
  return triangles;
}

/// What VTK's mapper draws of a polygon whose points are numbered in order.
std::vector<Triangle> MakeFan(vtkIdType points)
{
  std::vector<Triangle> fan;
  for (vtkIdType i = 2; i < points; ++i)
  {
    fan.push_back({ 0, i - 1, i });
  }
  return fan;
}

double GetSide(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool IsCovered(vtkPolyData* data, const std::vector<Triangle>& triangles, const glm::dvec2& p)
{
  return std::any_of(triangles.begin(), triangles.end(),
    [&](const Triangle& corners)
    {
      glm::dvec2 c[3];
      for (int i = 0; i < 3; ++i)
      {
        double place[3];
        data->GetPoint(corners[static_cast<std::size_t>(i)], place);
        c[i] = { place[0], place[1] };
      }
      const double x = GetSide(c[0], c[1], p), y = GetSide(c[1], c[2], p),
                   z = GetSide(c[2], c[0], p);
      return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
    });
}

/// Random places, which no edge meets, are covered by the triangles just where they are drawn.
void ExpectDrawn(const Outline& outline, const std::string& name)
{
  for (const bool is64Bit : { false, true })
  {
    for (const double angle : { 0.0, 0.3, 2.0 })
    {
      const auto data = MakePolygon(outline, angle, is64Bit);
      const std::vector<Triangle> triangles = FindTriangles(data);
      const std::vector<Triangle> drawn = MakeFan(data->GetNumberOfPoints());
      std::mt19937 engine(7);
      std::uniform_real_distribution<double> place(-6.0, 6.0);
      int covered = 0;
      for (int i = 0; i < 2000; ++i)
      {
        const glm::dvec2 p(place(engine), place(engine));
        const bool wanted = IsCovered(data, drawn, p);
        covered += wanted ? 1 : 0;
        ASSERT_EQ(IsCovered(data, triangles, p), wanted)
          << name << ", turned by " << angle << ", at (" << p.x << ", " << p.y << ")";
      }
      EXPECT_GT(covered, 50) << name;
    }
  }
}

Outline MakeKeyhole(double outer, double inner)
{
  return { { -outer, -outer }, { outer, -outer }, { outer, outer }, { -outer, outer },
    { -outer, -outer }, { -inner, -inner }, { -inner, inner }, { inner, inner }, { inner, -inner },
    { -inner, -inner } };
}

} // namespace

TEST(PolygonCells, WhatIsDrawnIsCovered)
{
  ExpectDrawn({ { -3, -2 }, { 3, -2 }, { 2, 3 }, { -2, 3 } }, "a quad");
  ExpectDrawn(MakeKeyhole(4, 1), "a bridge to a hole");
  ExpectDrawn(MakeKeyhole(3, 2.5), "a bridge to a wide hole");
  ExpectDrawn({ { -3, -3 }, { 3, 3 }, { 3, -3 }, { -3, 3 } }, "a bow-tie");
  ExpectDrawn({ { -3, -3 }, { 3, 2 }, { 3, -3 }, { -3, 4 } }, "a lopsided bow-tie");
  ExpectDrawn({ { -3, -3 }, { -3, -3 }, { 3, -3 }, { 0, 3 } }, "a quad that begins twice");
  ExpectDrawn({ { -3, -3 }, { 3, -3 }, { 3, -3 }, { 0, 3 } }, "a quad with a corner twice");
  ExpectDrawn({ { -3, -3 }, { 3, -3 }, { 0, 3 }, { 0, 3 } }, "a quad that ends twice");
  ExpectDrawn({ { -3, -3 }, { 3, -3 }, { 0, 3 }, { -3, -3 } }, "a quad that is closed");
  ExpectDrawn({ { -3, -3 }, { -3, -3 }, { 3, -3 }, { 3, -3 }, { 3, 3 }, { 3, 3 }, { -3, 3 },
                { -3, 3 }, { -3, -3 } },
    "every corner twice, and closed");
}

// Concave outlines stay what they say: the mapper's fan would cover what is between.
TEST(PolygonCells, ConcaveIsNotFilled)
{
  const Outline outline = { { -4, -4 }, { 4, -4 }, { 4, 4 }, { 2, 4 }, { 2, -2 }, { -2, -2 },
    { -2, 4 }, { -4, 4 } };
  const auto data = MakePolygon(outline, 0.0, true);
  const std::vector<Triangle> triangles = FindTriangles(data);
  EXPECT_TRUE(IsCovered(data, triangles, { 3.1, 3.3 }));
  EXPECT_TRUE(IsCovered(data, triangles, { 0.3, -3.1 }));
  EXPECT_FALSE(IsCovered(data, triangles, { 0.3, 1.1 }));
}

TEST(PolygonCells, FewerThanThreePointsAreNoTriangle)
{
  for (const bool is64Bit : { false, true })
  {
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(3);
    vtkNew<vtkCellArray> polygons;
    is64Bit ? polygons->Use64BitStorage() : polygons->Use32BitStorage();
    vtkNew<vtkIdList> none;
    polygons->InsertNextCell(none);
    polygons->InsertNextCell({ 0 });
    polygons->InsertNextCell({ 0, 1 });
    polygons->InsertNextCell({ 2, 1, 0 });
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(polygons);
    int visits = 0;
    penumbra::VisitTriangles(polygons, points,
      [&](vtkIdType polygon, const Triangle& corners)
      {
        ++visits;
        EXPECT_EQ(polygon, 3);
        EXPECT_EQ(corners, (Triangle{ 2, 1, 0 }));
      });
    EXPECT_EQ(visits, 1);
  }
}

TEST(PolygonCells, StripsComeAfterPolygons)
{
  const auto data = MakePolygon({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, 0.0, false);
  vtkNew<vtkCellArray> lines, strips;
  lines->InsertNextCell({ 0, 1 });
  strips->InsertNextCell({ 0, 1, 2 });
  strips->InsertNextCell({ 0, 1, 3, 2 });
  data->SetLines(lines);
  data->SetStrips(strips);
  vtkNew<vtkIdList> origins;
  const vtkSmartPointer<vtkCellArray> joined = penumbra::JoinStrips(data, origins);
  ASSERT_EQ(joined->GetNumberOfCells(), 4);
  const vtkIdType wanted[] = { 1, 2, 3, 3 }, sizes[] = { 4, 3, 3, 3 };
  for (vtkIdType i = 0; i < 4; ++i)
  {
    EXPECT_EQ(origins->GetId(i), wanted[i]) << i;
    EXPECT_EQ(joined->GetCellSize(i), sizes[i]) << i;
  }
}

// A surface with strips keeps the polygons that ear cutting gives up.
TEST(PolygonCells, KeyholeBesideStripsIsASurface)
{
  const auto data = MakePolygon(MakeKeyhole(4, 1), 0.0, true);
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 0, 1, 2 });
  data->SetStrips(strips);
  vtkNew<vtkShadowSceneBuilder> builder;
  builder->AddData(data, nullptr, vtkShadowSceneBuilder::Occluder, "keyhole");
  ASSERT_EQ(builder->GetScene().Surfaces.size(), 1u);
  const penumbra::Surface& surface = *builder->GetScene().Surfaces.front();
  EXPECT_EQ(surface.Triangles.size(), 8u + 1u);
}

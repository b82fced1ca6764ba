// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which polygons of a mesh form a receiver, and which meshes are refused.

#include "PlanarRegions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace
{

using penumbra::FindPlanarRegions;
using penumbra::Parallelogram;
using penumbra::PlanarRegion;
using penumbra::PlanarRegions;
using penumbra::PolygonMesh;
using Polygon = std::vector<int>;

const double Pi = std::acos(-1.0);
// What PlanarRegions.h documents.
constexpr double PlanarityTolerance = 1e-4;

// A mesh whose points at the same place are one, as FindPlanarRegions() asks for.
class MeshBuilder
{
public:
  void Add(const std::vector<glm::dvec3>& corners)
  {
    Polygon polygon;
    for (const glm::dvec3& corner : corners)
    {
      polygon.push_back(this->PointAt(corner));
    }
    this->Mesh.Polygons.push_back(polygon);
  }

  // Quads over the parallelogram.
  void AddGrid(const Parallelogram& base, int columns, int rows)
  {
    const int first = static_cast<int>(this->Mesh.Points.size());
    std::vector<int> ids;
    for (int i = 0; i < (columns + 1) * (rows + 1); ++i)
    {
      const double u = static_cast<double>(i % (columns + 1)) / columns;
      const double v = static_cast<double>(i / (columns + 1)) / rows;
      ids.push_back(first + i);
      this->Mesh.Points.push_back(base.Corner + u * base.EdgeX + v * base.EdgeY);
    }
    for (int i = 0; i < columns * rows; ++i)
    {
      const int at = first + i % columns + i / columns * (columns + 1);
      this->Mesh.Polygons.push_back({ at, at + 1, at + columns + 2, at + columns + 1 });
    }
  }

  PolygonMesh Mesh;

private:
  int PointAt(const glm::dvec3& place)
  {
    std::vector<glm::dvec3>& points = this->Mesh.Points;
    const auto found = std::find(points.begin(), points.end(), place);
    const auto index = static_cast<int>(found - points.begin());
    if (found == points.end())
    {
      points.push_back(place);
    }
    return index;
  }
};

const Parallelogram UnitSquare{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };

// A plane that leans against all axes.
const Parallelogram Leaning{ { 0, 0, 0 }, { 0.8, 0.36, 0.48 }, { -0.6, 0.48, 0.64 } };

PolygonMesh GridMesh(const Parallelogram& base, int columns, int rows)
{
  MeshBuilder builder;
  builder.AddGrid(base, columns, rows);
  return builder.Mesh;
}

PolygonMesh BoxMesh()
{
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
  {
    mesh.Points.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  }
  mesh.Polygons = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
    { 1, 3, 7, 5 } };
  return mesh;
}

// The side faces of a prism over a regular polygon.
PolygonMesh PrismMesh(int sides, double turn)
{
  PolygonMesh mesh;
  for (int i = 0; i < sides; ++i)
  {
    const double angle = turn + 2.0 * Pi * i / sides;
    mesh.Points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    mesh.Points.emplace_back(std::cos(angle), std::sin(angle), 1.0);
    const int next = (i + 1) % sides;
    mesh.Polygons.push_back({ 2 * i, 2 * next, 2 * next + 1, 2 * i + 1 });
  }
  return mesh;
}

PolygonMesh SphereMesh(int slices)
{
  MeshBuilder builder;
  const auto at = [slices](int i, int j)
  {
    const double theta = Pi * j / slices;
    const double phi = Pi * (i % (2 * slices)) / slices;
    return j % slices == 0 ? glm::dvec3(0.0, 0.0, j == 0 ? 1.0 : -1.0)
                           : glm::dvec3(std::sin(theta) * std::cos(phi),
                               std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (int i = 0; i < 2 * slices; ++i)
  {
    for (int j = 0; j < slices; ++j)
    {
      builder.Add(j == 0 ? std::vector<glm::dvec3>{ at(i, 0), at(i, 1), at(i + 1, 1) }
          : j == slices - 1
          ? std::vector<glm::dvec3>{ at(i, j), at(i, slices), at(i + 1, j) }
          : std::vector<glm::dvec3>{ at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j) });
    }
  }
  return builder.Mesh;
}

// Rounds the points to floats and says by how much that may have moved them, as a reader of float
// data does: by one epsilon of the largest coordinates.
void RoundToFloat(PolygonMesh& mesh)
{
  glm::dvec3 largest(0.0);
  for (glm::dvec3& p : mesh.Points)
  {
    p = glm::dvec3(glm::vec3(p));
    largest = glm::max(largest, glm::abs(p));
  }
  mesh.Rounding = glm::length(largest) * FLT_EPSILON;
}

glm::dvec3 AreaVectorOf(const Parallelogram& base)
{
  return glm::cross(base.EdgeX, base.EdgeY);
}

// No problem, that many regions, and every polygon in exactly one: the one RegionOfPolygon names.
void ExpectRegions(const PolygonMesh& mesh, std::size_t count)
{
  const PlanarRegions found = FindPlanarRegions(mesh);
  EXPECT_EQ(found.Problem, "");
  ASSERT_EQ(found.Regions.size(), count);
  ASSERT_EQ(found.RegionOfPolygon.size(), mesh.Polygons.size());
  std::size_t members = 0;
  for (std::size_t region = 0; region < count; ++region)
  {
    for (const int polygon : found.Regions[region].Polygons)
    {
      EXPECT_EQ(
        found.RegionOfPolygon.at(static_cast<std::size_t>(polygon)), static_cast<int>(region));
      ++members;
    }
  }
  const auto inNone = static_cast<std::size_t>(
    std::count(found.RegionOfPolygon.begin(), found.RegionOfPolygon.end(), -1));
  EXPECT_EQ(members + inNone, mesh.Polygons.size());
}

// Refused, with a sentence that says what would be accepted.
void ExpectProblem(const PolygonMesh& mesh, const std::string& mentions)
{
  const PlanarRegions found = FindPlanarRegions(mesh);
  EXPECT_NE(found.Problem.find(mentions), std::string::npos) << found.Problem;
  EXPECT_NE(found.Problem.find("allowed: "), std::string::npos) << found.Problem;
  EXPECT_TRUE(found.Regions.empty());
}

// The base has the area and the side that `expected` has.
void ExpectBase(const PlanarRegion& region, const Parallelogram& expected, double tolerance)
{
  EXPECT_LE(glm::length(AreaVectorOf(region.Base) - AreaVectorOf(expected)), tolerance);
}

TEST(PlanarRegions, GridIsOneRegion)
{
  for (const int resolution : { 1, 2, 10, 300 })
  {
    const PolygonMesh mesh = GridMesh(UnitSquare, resolution, resolution);
    ExpectRegions(mesh, 1);
    ExpectBase(FindPlanarRegions(mesh).Regions.at(0), UnitSquare, 1e-12);
  }
}

TEST(PlanarRegions, SkewedAndLeaningGridsAreOneRegion)
{
  const Parallelogram skewed{ { 3, 4, 5 }, { 2, 1, 0.5 }, { -0.5, 1.5, 2 } };
  for (const Parallelogram& base : { skewed, Leaning })
  {
    const PolygonMesh mesh = GridMesh(base, 37, 11);
    ExpectRegions(mesh, 1);
    ExpectBase(FindPlanarRegions(mesh).Regions.at(0), base, 1e-12);
  }
}

TEST(PlanarRegions, BoxHasSixRegions)
{
  const PolygonMesh mesh = BoxMesh();
  ExpectRegions(mesh, 6);
  for (const PlanarRegion& region : FindPlanarRegions(mesh).Regions)
  {
    // Outwards: away from the centre.
    EXPECT_GT(glm::dot(AreaVectorOf(region.Base), region.Base.Corner - glm::dvec3(0.5)), 0.0);
    EXPECT_NEAR(glm::length(AreaVectorOf(region.Base)), 1.0, 1e-12);
  }
}

TEST(PlanarRegions, FinelyDividedBoxHasSixRegions)
{
  // Grids that do not even share points along the box's edges, and ones that do.
  const PolygonMesh box = BoxMesh();
  MeshBuilder apart, joined;
  constexpr int n = 8;
  for (const Polygon& face : box.Polygons)
  {
    const auto corner = [&](std::size_t i)
    { return box.Points[static_cast<std::size_t>(face[i])]; };
    const Parallelogram base{ corner(0), corner(1) - corner(0), corner(3) - corner(0) };
    apart.AddGrid(base, n, n);
    for (int i = 0; i < n * n; ++i)
    {
      const auto at = [&](int u, int v) // eighths: exact
      {
        return base.Corner + (i % n + u) / static_cast<double>(n) * base.EdgeX +
          (i / n + v) / static_cast<double>(n) * base.EdgeY;
      };
      joined.Add({ at(0, 0), at(1, 0), at(1, 1), at(0, 1) });
    }
  }
  ExpectRegions(apart.Mesh, 6);
  ExpectRegions(joined.Mesh, 6);
}

TEST(PlanarRegions, SeparateCoplanarRectanglesAreTwoRegions)
{
  MeshBuilder builder;
  builder.AddGrid(UnitSquare, 4, 4);
  builder.AddGrid({ { 2, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, 4, 4);
  ExpectRegions(builder.Mesh, 2);
}

// "Polygons that share an edge": a corner is not one.
TEST(PlanarRegions, SquaresThatTouchInACornerAreTwoRegions)
{
  MeshBuilder builder;
  builder.Add({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
  builder.Add({ { 1, 1, 0 }, { 2, 1, 0 }, { 2, 2, 0 }, { 1, 2, 0 } });
  ExpectRegions(builder.Mesh, 2);
}

TEST(PlanarRegions, LOfQuadsIsOneRegionInItsEnclosingRectangle)
{
  MeshBuilder builder;
  builder.Add({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
  builder.Add({ { 1, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 1, 1, 0 } });
  builder.Add({ { 0, 1, 0 }, { 1, 1, 0 }, { 1, 2, 0 }, { 0, 2, 0 } });
  ExpectRegions(builder.Mesh, 1);
  // The smallest rectangle around the L of edge 2: by its slanted side it is 1.5 sqrt(2) high and 2
  // sqrt(2) long, which is 6; along the axes it is 2 by 2.
  const PlanarRegion region = FindPlanarRegions(builder.Mesh).Regions.at(0);
  ExpectBase(region, { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, 1e-12);
}

// One concave polygon, begun at each of its corners in turn: the front is where its area points.
TEST(PlanarRegions, ConcavePolygonFacesWhereItsAreaPoints)
{
  const std::vector<glm::dvec3> outline{ { 0, 0, 0 }, { 3, 0, 0 }, { 3, 1, 0 }, { 1, 1, 0 },
    { 1, 3, 0 }, { 0, 3, 0 } };
  for (std::size_t start = 0; start < outline.size(); ++start)
  {
    std::vector<glm::dvec3> corners = outline;
    std::rotate(
      corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
    MeshBuilder builder;
    builder.Add(corners);
    ExpectRegions(builder.Mesh, 1);
    EXPECT_GT(AreaVectorOf(FindPlanarRegions(builder.Mesh).Regions.at(0).Base).z, 0.0) << start;
  }
}

// A wall that stands in the middle of a floor: three polygons share the edge between them.
TEST(PlanarRegions, WallOnAFloorIsARegionOfItsOwn)
{
  const std::vector<glm::dvec3> left{ { -1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { -1, 1, 0 } };
  const std::vector<glm::dvec3> right{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  const std::vector<glm::dvec3> wall{ { 0, 0, 0 }, { 0, 1, 0 }, { 0, 1, 1 }, { 0, 0, 1 } };
  std::vector<std::vector<glm::dvec3>> polygons{ left, right, wall };
  std::sort(polygons.begin(), polygons.end(),
    [](const auto& a, const auto& b) { return a.back().x < b.back().x; });
  std::array<std::size_t, 3> order{ 0, 1, 2 };
  do
  {
    MeshBuilder builder;
    for (const std::size_t i : order)
    {
      builder.Add(polygons[i]);
    }
    ExpectRegions(builder.Mesh, 2);
    std::set<std::size_t> sizes;
    for (const PlanarRegion& region : FindPlanarRegions(builder.Mesh).Regions)
    {
      sizes.insert(region.Polygons.size());
    }
    EXPECT_EQ(sizes, (std::set<std::size_t>{ 1, 2 }));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(PlanarRegions, WindingOfSinglePolygonsDoesNotMatter)
{
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i)
  {
    PolygonMesh mesh = GridMesh(Leaning, 10, 10);
    std::vector<std::size_t> order(mesh.Polygons.size());
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::shuffle(order.begin(), order.end(), random);
    const std::size_t reversed = static_cast<std::size_t>(i); // fewer than half of 100
    for (std::size_t j = 0; j < reversed; ++j)
    {
      std::reverse(mesh.Polygons[order[j]].begin(), mesh.Polygons[order[j]].end());
    }
    ExpectRegions(mesh, 1);
    ExpectBase(FindPlanarRegions(mesh).Regions.at(0), Leaning, 1e-12);
  }
}

// "The receiver's front is where more of its area points": of the area, not of the polygons.
TEST(PlanarRegions, FrontIsWhereMoreAreaPoints)
{
  MeshBuilder builder;
  builder.Add({ { 0, 0, 0 }, { 0, 1, 0 }, { 3, 1, 0 }, { 3, 0, 0 } }); // 3 downwards
  builder.Add({ { 3, 0, 0 }, { 4, 0, 0 }, { 4, 1, 0 }, { 3, 1, 0 } }); // 2 upwards in two pieces
  builder.Add({ { 4, 0, 0 }, { 5, 0, 0 }, { 5, 1, 0 }, { 4, 1, 0 } });
  ExpectRegions(builder.Mesh, 1);
  EXPECT_LT(AreaVectorOf(FindPlanarRegions(builder.Mesh).Regions.at(0).Base).z, 0.0);
  builder.Add({ { 5, 0, 0 }, { 7, 0, 0 }, { 7, 1, 0 }, { 5, 1, 0 } }); // now 4
  ExpectRegions(builder.Mesh, 1);
  EXPECT_GT(AreaVectorOf(FindPlanarRegions(builder.Mesh).Regions.at(0).Base).z, 0.0);
}

TEST(PlanarRegions, MovesAndScalesWithTheMesh)
{
  for (const double scale : { 1e-6, 1.0, 1e6 })
  {
    PolygonMesh mesh = BoxMesh();
    for (glm::dvec3& p : mesh.Points)
    {
      p = scale * (p + glm::dvec3(3.0, -7.0, 11.0));
    }
    ExpectRegions(mesh, 6);
  }
}

TEST(PlanarRegions, SphereIsAProblem)
{
  // Bends of 180 / slices degrees, all between 1 and 30.
  for (const int slices : { 8, 16, 64 })
  {
    ExpectProblem(SphereMesh(slices), "meet at an angle of");
  }
}

TEST(PlanarRegions, CylinderIsAProblem)
{
  ExpectProblem(PrismMesh(32, 0.1), "meet at an angle of 11.25 degrees");
  // So fine that single bends could be rounding: it is the whole that is not planar.
  ExpectProblem(PrismMesh(3600, 0.1), "not planar");
}

// "Edges at which the surface bends by 30 degrees or more divide it": up to the twelve sides of
// a prism whose edges bend by 30 degrees and a rounding.
TEST(PlanarRegions, PrismsFallApart)
{
  for (const int sides : { 3, 4, 5, 6, 8, 10, 11, 12 })
  {
    for (int turn = 0; turn < 20; ++turn)
    {
      ExpectRegions(PrismMesh(sides, 0.1 * turn), static_cast<std::size_t>(sides));
    }
  }
}

TEST(PlanarRegions, SlightlyWarpedGridIsAProblem)
{
  // A saddle whose height is 1e-3 of its width: its neighbours bend by less than 0.1 degrees.
  PolygonMesh mesh = GridMesh(UnitSquare, 20, 20);
  for (glm::dvec3& p : mesh.Points)
  {
    p.z = 1e-3 * (p.x - 0.5) * (p.y - 0.5);
  }
  ExpectProblem(mesh, "not planar");
}

TEST(PlanarRegions, NonPlanarQuadIsAProblem)
{
  MeshBuilder builder;
  builder.Add({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0.2 }, { 0, 1, 0 } });
  ExpectProblem(builder.Mesh, "not planar");
}

// The documented tolerance from both sides: a square's corner lifted by z leaves the quad's mean
// plane by z / 4 at each corner, and the extent is sqrt(2).
TEST(PlanarRegions, PlanarityToleranceIsTheDocumentedOne)
{
  for (const double share : { 0.5, 0.9, 1.1, 2.0 })
  {
    const double lift = share * 4.0 * PlanarityTolerance * std::sqrt(2.0);
    MeshBuilder builder;
    builder.Add({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, lift }, { 0, 1, 0 } });
    if (share < 1.0)
    {
      ExpectRegions(builder.Mesh, 1);
    }
    else
    {
      ExpectProblem(builder.Mesh, "not planar");
    }
  }
}

// Floats at a distance of 1e3 are 6e-5 apart: more than the tolerance of a plane of size 1, and a
// share of a cell of up to 0.6 %. Still a plane.
TEST(PlanarRegions, FloatGridFarFromTheOriginIsOneRegion)
{
  for (const double distance : { 1.0, 1e1, 1e2, 1e3 })
  {
    Parallelogram base = Leaning;
    base.Corner = distance * glm::dvec3(0.6, -0.5, 0.7);
    PolygonMesh mesh = GridMesh(base, 100, 100);
    RoundToFloat(mesh);
    ExpectRegions(mesh, 1);
    ExpectBase(FindPlanarRegions(mesh).Regions.at(0), base, 1e-4 + 4.0 * mesh.Rounding);
  }
}

// Cells of a millimetre that are themselves only some roundings wide: their normals mean little.
TEST(PlanarRegions, VeryFineFloatGridFarFromTheOriginIsOneRegion)
{
  for (const double distance : { 1e2, 3e2, 1e3, 3e3 })
  {
    Parallelogram base = Leaning;
    base.Corner = distance * glm::dvec3(0.6, -0.5, 0.7);
    PolygonMesh mesh = GridMesh(base, 1000, 100);
    RoundToFloat(mesh);
    ExpectRegions(mesh, 1);
  }
}

TEST(PlanarRegions, FloatBoxFarFromTheOriginHasSixRegions)
{
  for (const double distance : { 1e2, 1e4 })
  {
    PolygonMesh mesh = BoxMesh();
    for (glm::dvec3& p : mesh.Points)
    {
      p = p.x * Leaning.EdgeX + p.y * Leaning.EdgeY +
        p.z * glm::cross(Leaning.EdgeX, Leaning.EdgeY) + distance * glm::dvec3(0.6, -0.5, 0.7);
    }
    RoundToFloat(mesh);
    ExpectRegions(mesh, 6);
  }
}

// A house with a gable roof, 10 m by 7 m, turned by `angle`, its coordinates rounded to `step`.
void AddHouse(MeshBuilder& builder, const glm::dvec3& place, double angle, double step)
{
  const auto at = [&](double u, double v, double z)
  {
    const glm::dvec3 p = place +
      glm::dvec3(
        u * std::cos(angle) - v * std::sin(angle), u * std::sin(angle) + v * std::cos(angle), z);
    return step * glm::round(p / step);
  };
  const std::array<glm::dvec2, 4> plan{ { { -5, -3.5 }, { 5, -3.5 }, { 5, 3.5 }, { -5, 3.5 } } };
  std::array<glm::dvec3, 4> foot, eave;
  for (std::size_t i = 0; i < 4; ++i)
  {
    foot[i] = at(plan[i].x, plan[i].y, 0.0);
    eave[i] = at(plan[i].x, plan[i].y, 5.3);
  }
  const glm::dvec3 west = at(-5, 0, 8.2), east = at(5, 0, 8.2);
  builder.Add({ foot[0], foot[1], eave[1], eave[0] });
  builder.Add({ foot[1], foot[2], eave[2], east, eave[1] });
  builder.Add({ foot[2], foot[3], eave[3], eave[2] });
  builder.Add({ foot[3], foot[0], eave[0], west, eave[3] });
  builder.Add({ eave[0], eave[1], east, west });
  builder.Add({ eave[2], eave[3], west, east });
}

PolygonMesh HousesMesh(double step, double offset)
{
  MeshBuilder builder;
  for (int i = 0; i < 10; ++i)
  {
    AddHouse(builder, { offset + 20.0 * i, offset, 0.0 }, 0.3 + 0.37 * i, step);
  }
  return builder.Mesh;
}

// Of 7 m and more, 1e-4 is 0.7 mm and more: what the rounding to a millimetre moves is less.
TEST(PlanarRegions, HousesInMillimetresHaveSixFacesEach)
{
  for (const double offset : { 0.0, 5e5 })
  {
    SCOPED_TRACE(offset);
    ExpectRegions(HousesMesh(1e-3, offset), 60);
  }
}

TEST(PlanarRegions, HousesInCentimetresAskForATolerance)
{
  PolygonMesh mesh = HousesMesh(1e-2, 0.0);
  EXPECT_LT(FindPlanarRegions(mesh).Regions.size(), 60u);
  mesh.Tolerance = 0.02;
  ExpectRegions(mesh, 60);
}

// A corner that is half a metre off costs the faces that it warps: a wall, a gable and a roof at
// most, and no more; one message says so.
TEST(PlanarRegions, OneBadCornerCostsItsFacesAlone)
{
  PolygonMesh mesh = HousesMesh(1e-3, 0.0);
  mesh.Points[3] += glm::dvec3(0.4, 0.3, 0.0);
  const PlanarRegions found = FindPlanarRegions(mesh);
  EXPECT_EQ(found.Problem, "");
  EXPECT_GE(found.Regions.size(), 57u);
  EXPECT_LT(found.Regions.size(), 60u);
  EXPECT_NE(found.Refused.find("allowed: "), std::string::npos) << found.Refused;
}

// A tolerance that is wider than facets does not make patches of a curve planar.
TEST(PlanarRegions, CurvesStayCurvedAtAnyTolerance)
{
  for (const double tolerance : { 0.005, 0.02, 0.05 })
  {
    SCOPED_TRACE(tolerance);
    for (const int slices : { 16, 64 })
    {
      PolygonMesh sphere = SphereMesh(slices);
      sphere.Tolerance = tolerance;
      EXPECT_TRUE(FindPlanarRegions(sphere).Regions.empty()) << "sphere of " << slices;
    }
    for (const int sides : { 32, 100, 3600 })
    {
      PolygonMesh prism = PrismMesh(sides, 0.1);
      prism.Tolerance = tolerance;
      EXPECT_TRUE(FindPlanarRegions(prism).Regions.empty()) << "cylinder of " << sides;
    }
  }
}

TEST(PlanarRegions, EmptyMeshIsAProblem)
{
  ExpectProblem({}, "no polygon with an area");
  PolygonMesh pointsAlone;
  pointsAlone.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  ExpectProblem(pointsAlone, "no polygon with an area");
}

TEST(PlanarRegions, PolygonsWithoutAnAreaAreAProblem)
{
  PolygonMesh mesh;
  mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } };
  mesh.Polygons = { { 0, 1, 2 }, { 0, 0, 0 }, { 0, 1, 0 } };
  ExpectProblem(mesh, "no polygon with an area");
}

// Three decimal numbers on a line: no double has an exact tenth, so a rounding's worth of area.
TEST(PlanarRegions, PolygonOfRoundedPointsOnALineIsAProblem)
{
  PolygonMesh mesh;
  mesh.Points = { { 0.1, 0.2, 0.3 }, { 0.3, 0.6, 0.9 }, { 0.7, 1.4, 2.1 } };
  mesh.Polygons = { { 0, 1, 2 } };
  mesh.Rounding = 3.0 * DBL_EPSILON;
  ExpectProblem(mesh, "allowed: ");
}

TEST(PlanarRegions, PolygonsWithoutAnAreaBelongToNoRegion)
{
  MeshBuilder builder;
  builder.AddGrid(UnitSquare, 2, 2);
  builder.Mesh.Polygons.insert(builder.Mesh.Polygons.begin() + 1, { 0, 1, 2 }); // along the edge
  builder.Mesh.Polygons.push_back({ 4, 4, 4 });
  ExpectRegions(builder.Mesh, 1);
  const PlanarRegions found = FindPlanarRegions(builder.Mesh);
  EXPECT_EQ(found.RegionOfPolygon, (std::vector<int>{ 0, -1, 0, 0, 0, -1 }));
}

// A sliver along the edge between floor and wall, as meshers leave them, is no hinge.
TEST(PlanarRegions, SliverBetweenFloorAndWallJoinsThemNot)
{
  for (const double width : { 1e-7, 1e-9, 1e-12 })
  {
    MeshBuilder builder;
    builder.Add({ { -1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { -1, 1, 0 } });
    builder.Add({ { 0, 0, 0 }, { width, 0.5, width }, { 0, 1, 0 } });
    builder.Add({ { 0, 0, 0 }, { width, 0.5, width }, { 0, 1, 0 }, { 0, 1, 1 }, { 0, 0, 1 } });
    const PlanarRegions found = FindPlanarRegions(builder.Mesh);
    EXPECT_EQ(found.Problem, "") << width;
    ASSERT_EQ(found.RegionOfPolygon.size(), 3u);
    EXPECT_NE(found.RegionOfPolygon[0], found.RegionOfPolygon[2]) << width;
  }
}

// A sliver within a plane has no normal to speak of, and is part of the plane all the same.
TEST(PlanarRegions, SliverWithinAPlaneBelongsToIt)
{
  for (const double width : { 1e-6, 1e-9 })
  {
    MeshBuilder builder;
    builder.Add({ { -1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { -1, 1, 0 } });
    builder.Add({ { 0, 0, 0 }, { width, 0, width }, { width, 1, 0 }, { 0, 1, 0 } });
    builder.Add({ { width, 0, width }, { 1, 0, 0 }, { 1, 1, 0 }, { width, 1, 0 } });
    ExpectRegions(builder.Mesh, 1);
  }
}

TEST(PlanarRegions, CoordinatesThatAreNotFiniteAreAProblem)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity })
  {
    PolygonMesh mesh = GridMesh(UnitSquare, 3, 3);
    for (std::size_t i = 0; i < mesh.Points.size(); ++i)
    {
      PolygonMesh broken = mesh;
      broken.Points[i][static_cast<int>(i % 3)] = bad;
      ExpectProblem(broken, "not finite");
    }
  }
}

} // namespace

// Copies of polygons, begun anywhere and wound either way, are of their originals' regions, in time
// that grows as their number does: all pairs of them would take minutes.
TEST(PlanarRegions, CopiesBelongToTheRegionsOfTheirOriginals)
{
  constexpr std::size_t Copies = 20000;
  MeshBuilder builder;
  builder.Add({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
  builder.Add({ { 1, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 1, 1, 0 } });
  builder.Add({ { 0, 0, 0 }, { 0, 1, 0 }, { 0, 1, 1 }, { 0, 0, 1 } });
  const std::size_t originals = builder.Mesh.Polygons.size();
  const PlanarRegions alone = FindPlanarRegions(builder.Mesh);
  for (std::size_t i = 0; i < Copies; ++i)
  {
    Polygon copy = builder.Mesh.Polygons[i % originals];
    std::rotate(
      copy.begin(), copy.begin() + static_cast<std::ptrdiff_t>(i % copy.size()), copy.end());
    if (i % 7 == 0)
    {
      std::reverse(copy.begin(), copy.end());
    }
    builder.Mesh.Polygons.push_back(copy);
  }
  const PlanarRegions regions = FindPlanarRegions(builder.Mesh);
  ASSERT_EQ(regions.Problem, "");
  ASSERT_EQ(regions.Regions.size(), alone.Regions.size());
  for (std::size_t p = 0; p < builder.Mesh.Polygons.size(); ++p)
  {
    const std::size_t original = p < originals ? p : (p - originals) % originals;
    ASSERT_EQ(regions.RegionOfPolygon[p], alone.RegionOfPolygon[original]) << "polygon " << p;
  }
}

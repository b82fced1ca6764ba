// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The plane that stands for a curved surface (H&H 1997, figure 5), and which surfaces get one.

#include "LargestDeviation.h"
#include "ProxyPlane.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace
{

using penumbra::FindPlanarRegions;
using penumbra::FindProxyPlane;
using penumbra::PolygonMesh;
using penumbra::ProxyPlane;
using penumbra::ProxyPlaneMode;
using penumbra::ReceiverSettings;

// Sums of some hundred products of numbers of size 1, and eigenvalues that differ by 0.1 of the
// largest and more: some hundred roundings of 1e-16 leave a margin of ten.
constexpr double Rounding = 1e-12;

/// A polygon of its own for each list of corners.
PolygonMesh MakeMesh(const std::vector<std::vector<glm::dvec3>>& polygons)
{
  PolygonMesh mesh;
  for (const auto& corners : polygons)
  {
    std::vector<int>& polygon = mesh.Polygons.emplace_back();
    for (const glm::dvec3& corner : corners)
    {
      polygon.push_back(static_cast<int>(mesh.Points.size()));
      mesh.Points.push_back(corner);
    }
  }
  return mesh;
}

/// A horizontal rectangle.
std::vector<glm::dvec3> Plate(double x0, double x1, double y, double z)
{
  return { { x0, -y, z }, { x1, -y, z }, { x1, y, z }, { x0, y, z } };
}

/// Two steps, 2 and 1 long, with the heights 0 and 1.
PolygonMesh Stairs()
{
  return MakeMesh({ Plate(0, 2, 5, 0), Plate(2, 3, 5, 1) });
}

PolygonMesh Cube()
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

PolygonMesh Transformed(PolygonMesh mesh, const std::function<glm::dvec3(const glm::dvec3&)>& map)
{
  for (glm::dvec3& point : mesh.Points)
  {
    point = map(point);
  }
  return mesh;
}

PolygonMesh RandomTriangles(unsigned seed)
{
  RandomGeometry random(seed);
  const glm::dvec3 place = random.InBox(10.0);
  std::vector<std::vector<glm::dvec3>> triangles;
  for (int i = 0; i < 20; ++i)
  {
    const auto corner = [&]() { return place + random.InBox(1.0) * glm::dvec3(1.0, 0.7, 0.3); };
    triangles.push_back({ corner(), corner(), corner() });
  }
  return MakeMesh(triangles);
}

/// The integral of the squared distance from the plane over the area: the mean of the midpoints of
/// its edges is exact on a triangle for squares.
double SquaredDistance(const PolygonMesh& mesh, const glm::dvec3& origin, const glm::dvec3& normal)
{
  double sum = 0.0;
  for (const std::vector<int>& triangle : mesh.Polygons)
  {
    const auto point = [&](int i)
    { return mesh.Points[static_cast<std::size_t>(triangle.at(static_cast<std::size_t>(i % 3)))]; };
    const double area = 0.5 * glm::length(glm::cross(point(1) - point(0), point(2) - point(0)));
    for (int i = 0; i < 3; ++i)
    {
      const double distance = glm::dot(0.5 * (point(i) + point(i + 1)) - origin, normal);
      sum += area / 3.0 * distance * distance;
    }
  }
  return sum;
}

/// What FindPlanarRegions() and the settings make of a mesh.
bool NeedsPlane(const PolygonMesh& mesh, bool isOn = true)
{
  ReceiverSettings settings;
  settings.ProxyPlane = isOn;
  return penumbra::NeedsProxyPlane(mesh, FindPlanarRegions(mesh), settings);
}

TEST(ProxyPlane, FitsStairsAsComputedByHand)
{
  // The centroid is (1.5, 0, 1/3). About it, per unit of depth: the integral of x^2 is 3^3 / 12,
  // that of z^2
  // is 2 (1/3)^2 + (2/3)^2 = 2/3, and that of xz, from the steps' centres at -1/2 and 1, is 1/3 +
  // 2/3. The axis along the stairs is where tan(2 t) = 2 xz / (xx - zz); the depth of 10 is a
  // longer axis than both.
  const ProxyPlane plane = FindProxyPlane(Stairs(), ReceiverSettings());
  EXPECT_EQ(plane.Problem, "");
  EXPECT_LE(glm::length(plane.Origin - glm::dvec3(1.5, 0.0, 1.0 / 3.0)), Rounding);
  const double angle = 0.5 * std::atan2(2.0, 27.0 / 12.0 - 2.0 / 3.0);
  const glm::dvec3 normal(-std::sin(angle), 0.0, std::cos(angle));
  EXPECT_LE(glm::length(plane.Normal - normal), Rounding);
}

TEST(ProxyPlane, ExtentReachesTheFarthestPoint)
{
  const PolygonMesh mesh = RandomTriangles(7);
  const ProxyPlane plane = FindProxyPlane(mesh, ReceiverSettings());
  double farthest = 0.0;
  for (const glm::dvec3& point : mesh.Points)
  {
    farthest = std::max(farthest, glm::length(point - plane.Origin));
  }
  EXPECT_EQ(plane.Extent, farthest);
}

TEST(ProxyPlane, HasTheLeastSquaredDistanceOverTheArea)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    RandomGeometry random(seed);
    const PolygonMesh mesh = RandomTriangles(seed);
    const ProxyPlane plane = FindProxyPlane(mesh, ReceiverSettings());
    ASSERT_EQ(plane.Problem, "");
    const double least = SquaredDistance(mesh, plane.Origin, plane.Normal);
    for (const double step : { 1e-3, 0.1, 1.0 })
    {
      const glm::dvec3 normal = glm::normalize(plane.Normal + step * random.Direction());
      const glm::dvec3 origin = plane.Origin + step * random.Between(-1.0, 1.0) * plane.Normal;
      EXPECT_LT(least, SquaredDistance(mesh, plane.Origin, normal)) << seed << ", " << step;
      EXPECT_LT(least, SquaredDistance(mesh, origin, plane.Normal)) << seed << ", " << step;
    }
  }
}

// By area, not by points: where a surface is finely divided does not count.
TEST(ProxyPlane, DoesNotDependOnHowTheSurfaceIsDivided)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const PolygonMesh mesh = RandomTriangles(seed);
    std::vector<std::vector<glm::dvec3>> divided;
    for (std::size_t i = 0; i < mesh.Polygons.size(); ++i)
    {
      const glm::dvec3 &a = mesh.Points[3 * i], &b = mesh.Points[3 * i + 1],
                       &c = mesh.Points[3 * i + 2];
      const glm::dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
      if (i % 2 == 0)
      {
        divided.insert(
          divided.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
      }
      else
      {
        divided.push_back({ ca, a, ab, b, bc, c });
      }
    }
    const ProxyPlane whole = FindProxyPlane(mesh, ReceiverSettings());
    const ProxyPlane parts = FindProxyPlane(MakeMesh(divided), ReceiverSettings());
    EXPECT_LE(largest.Add(glm::length(whole.Normal - parts.Normal)), Rounding) << seed;
    EXPECT_LE(largest.Add(glm::length(whole.Origin - parts.Origin)), Rounding) << seed;
  }
}

// A notch is not part of a polygon that is not convex, though its fan folds over it.
TEST(ProxyPlane, LeavesNotchesOut)
{
  const std::vector<glm::dvec3> arrow{ { 2, 0, 0 }, { 0, 4, 0 }, { 0.5, 0, 0 }, { 0, -4, 0 } };
  const PolygonMesh both =
    MakeMesh({ { arrow[0], arrow[1], arrow[2] }, { arrow[0], arrow[2], arrow[3] } });
  const ProxyPlane parts = FindProxyPlane(both, ReceiverSettings());
  for (int start = 0; start < 4; ++start)
  {
    std::vector<glm::dvec3> turned;
    for (int i = 0; i < 4; ++i)
    {
      turned.push_back(arrow[static_cast<std::size_t>((start + i) % 4)]);
    }
    const ProxyPlane whole = FindProxyPlane(MakeMesh({ turned }), ReceiverSettings());
    EXPECT_LE(glm::length(whole.Origin - parts.Origin), Rounding) << start;
  }
}

TEST(ProxyPlane, FrontIsWhereMoreOfTheAreaPoints)
{
  PolygonMesh mesh = Stairs();
  EXPECT_GT(FindProxyPlane(mesh, ReceiverSettings()).Normal.z, 0.0);
  std::swap(mesh.Polygons[1][0], mesh.Polygons[1][2]); // the smaller step
  EXPECT_GT(FindProxyPlane(mesh, ReceiverSettings()).Normal.z, 0.0);
  std::swap(mesh.Polygons[0][0], mesh.Polygons[0][2]);
  EXPECT_LT(FindProxyPlane(mesh, ReceiverSettings()).Normal.z, 0.0);
}

TEST(ProxyPlane, ScalesAndMovesWithTheSurface)
{
  const ProxyPlane wanted = FindProxyPlane(RandomTriangles(1), ReceiverSettings());
  for (const double scale : { 1e-9, 1.0, 1e9 })
  {
    const glm::dvec3 offset = scale * glm::dvec3(1e3, -2e3, 5e2);
    const ProxyPlane plane = FindProxyPlane(
      Transformed(RandomTriangles(1), [&](const glm::dvec3& p) { return scale * p + offset; }),
      ReceiverSettings());
    EXPECT_EQ(plane.Problem, "");
    // The coordinates themselves are rounded at 1e3 sizes: 1e-13.
    EXPECT_LE(glm::length(plane.Normal - wanted.Normal), 1e3 * Rounding) << scale;
    EXPECT_LE(glm::length(plane.Origin - (scale * wanted.Origin + offset)), 1e3 * Rounding * scale)
      << scale;
  }
}

TEST(ProxyPlane, IsTheGivenOne)
{
  ReceiverSettings settings;
  settings.ProxyMode = ProxyPlaneMode::Given;
  settings.ProxyOrigin = { 10.0, 20.0, -2.0 };
  settings.ProxyNormal = { 0.0, 0.0, -7.0 };
  const ProxyPlane plane = FindProxyPlane(Stairs(), settings);
  EXPECT_EQ(plane.Problem, "");
  EXPECT_EQ(plane.Normal, glm::dvec3(0.0, 0.0, -1.0));
  EXPECT_LE(glm::length(plane.Origin - glm::dvec3(1.5, 0.0, -2.0)), Rounding);
  EXPECT_EQ(FindProxyPlane(Cube(), settings).Problem, ""); // it needs no fit
}

TEST(ProxyPlane, NamesWhatHasNone)
{
  for (const PolygonMesh& mesh :
    { Cube(), MakeMesh({ { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } } }), PolygonMesh() })
  {
    const std::string problem = FindProxyPlane(mesh, ReceiverSettings()).Problem;
    EXPECT_NE(problem.find("allowed"), std::string::npos) << problem;
  }
}

TEST(ProxyPlane, IsForSurfacesThatAreNotPlanarOnly)
{
  EXPECT_TRUE(NeedsPlane(Stairs()));
  EXPECT_TRUE(NeedsPlane(Cube()));
  const PolygonMesh bent =
    MakeMesh({ Plate(0, 1, 1, 0), { { 1, -1, 0 }, { 2, -1, 0.2 }, { 2, 1, 0.2 }, { 1, 1, 0 } } });
  EXPECT_TRUE(NeedsPlane(bent));
  EXPECT_FALSE(NeedsPlane(MakeMesh({ Plate(0, 1, 1, 0) })));
  EXPECT_FALSE(NeedsPlane(MakeMesh({ Plate(0, 1, 1, 2), Plate(3, 4, 1, 2) }))) << "two in a plane";
  for (const PolygonMesh& mesh : { Stairs(), Cube(), bent })
  {
    EXPECT_FALSE(NeedsPlane(mesh, false)) << "off";
  }
}

TEST(ProxyPlane, IsNotForCoordinatesThatAreNotFinite)
{
  PolygonMesh mesh = Stairs();
  mesh.Points[2].y = std::nan("");
  EXPECT_FALSE(NeedsPlane(mesh));
}

TEST(ProxyPlane, GoesWithItsData)
{
  // A rotation about z by 90 degrees, x stretched by 2 after it, and a move.
  const glm::dmat4 matrix(glm::dvec4(0, 1, 0, 0), glm::dvec4(-2, 0, 0, 0), glm::dvec4(0, 0, 1, 0),
    glm::dvec4(5, 6, 7, 1));
  ReceiverSettings settings;
  settings.ProxyOrigin = { 1.0, 2.0, 3.0 };
  settings.ProxyNormal = { 1.0, 2.0, 3.0 };
  const ReceiverSettings moved = settings.Transformed(matrix);
  EXPECT_EQ(moved.ProxyOrigin, glm::dvec3(1.0, 7.0, 10.0));
  RandomGeometry random(1);
  for (int i = 0; i < 100; ++i)
  {
    // Any direction within the plane stays in it.
    const glm::dvec3 d = glm::cross(settings.ProxyNormal, random.Direction());
    EXPECT_NEAR(glm::dot(moved.ProxyNormal, glm::dmat3(matrix) * d), 0.0, Rounding);
  }
}

} // namespace

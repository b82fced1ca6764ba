// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polygon lights: the closed form against the exact oracle, what a plane leaves of a light against
// closed forms of its area, and the sample maps by what makes them area-preserving.

#include "ExactRadiance.h"
#include "LargestDeviation.h"
#include "PolygonLight.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using penumbra::PolygonLight;

constexpr int Lights = 1000;

// What issue 2's oracle tests ask of the form factor. An edge's term is an angle times the cosine
// of a unit vector: some 20 roundings of 1.1e-16, made larger by at most 1 / sin(angle) of the edge
// seen, and by the distance over the height where the horizon clips it; a light has up to six
// edges. 1e-12 leaves room for factors of a hundred.
constexpr double FormFactorTolerance = 1e-12;

// Lengths, areas and heights of coordinates of size 10 and less: some 100 roundings of 1.1e-16
// times 10, and a margin.
constexpr double Rounding = 1e-12;

// The three points that make a light, and which kind.
struct Corners
{
  glm::dvec3 Origin, Point1, Point2;
  bool IsTriangle;

  PolygonLight MakeLight() const
  {
    return this->IsTriangle ? PolygonLight::Triangle(this->Origin, this->Point1, this->Point2)
                            : PolygonLight::Parallelogram(this->Origin, this->Point1, this->Point2);
  }
  // Twice the triangle, once the parallelogram.
  double ParallelogramArea() const
  {
    return glm::length(glm::cross(this->Point1 - this->Origin, this->Point2 - this->Origin));
  }
  double Area() const { return this->ParallelogramArea() * (this->IsTriangle ? 0.5 : 1.0); }
};

// Around the origin, edges up to 2 long and not nearly parallel.
Corners RandomCorners(unsigned seed)
{
  RandomGeometry random(seed);
  Corners corners{};
  do
  {
    corners.Origin = random.InBox(1.0);
    corners.Point1 = corners.Origin + random.InBox(1.2);
    corners.Point2 = corners.Origin + random.InBox(1.2);
    corners.IsTriangle = seed % 2 == 0;
  } while (corners.ParallelogramArea() < 0.05);
  return corners;
}

oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

double ExactFormFactor(
  const glm::dvec3& x, const glm::dvec3& n, const Corners& corners, bool twoSided)
{
  const oracle::Vec3 a = ToOracle(corners.Origin);
  const oracle::Vec3 b = ToOracle(corners.Point1);
  const oracle::Vec3 c = ToOracle(corners.Point2);
  oracle::Light light;
  light.Vertices = corners.IsTriangle ? oracle::Polygon{ a, b, c } : oracle::Parallelogram(a, b, c);
  light.TwoSided = twoSided;
  return static_cast<double>(oracle::FormFactor(ToOracle(x), ToOracle(n), light));
}

// Compares the light's form factor with the oracle's, for one side and two; answers the former.
double ExpectExact(
  const Corners& corners, const glm::dvec3& x, const glm::dvec3& n, LargestDeviation& largest)
{
  PolygonLight light = corners.MakeLight();
  const double front = light.FormFactor(x, n);
  EXPECT_LE(largest.Add(front - ExactFormFactor(x, n, corners, false)), FormFactorTolerance);
  light.TwoSided = true;
  const double both = light.FormFactor(x, n);
  EXPECT_LE(largest.Add(both - ExactFormFactor(x, n, corners, true)), FormFactorTolerance);
  EXPECT_GE(both, front);
  return front;
}

// A point at `height` before (or behind, if negative) the light's plane, over `s` of the light.
glm::dvec3 PointBefore(const Corners& corners, const glm::dvec2& s, double height)
{
  return corners.Origin + s.x * (corners.Point1 - corners.Origin) +
    s.y * (corners.Point2 - corners.Origin) + height * corners.MakeLight().GetNormal();
}

TEST(PolygonLightFormFactor, IsExactOverTheLight)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed + Lights);
    const Corners corners = RandomCorners(seed);
    const glm::dvec2 s(random.Between(0.0, 0.5), random.Between(0.0, 0.5));
    const glm::dvec3 x = PointBefore(corners, s, std::pow(10.0, random.Between(-3.0, 1.0)));
    const glm::dvec3 n = -corners.MakeLight().GetNormal();
    EXPECT_GT(ExpectExact(corners, x, n, largest), 0.0) << seed;
  }
}

// Beside the light's outline and far from it, some points behind its plane, and the receiver
// leaning as it likes.
TEST(PolygonLightFormFactor, IsExactBesideTheLight)
{
  LargestDeviation largest;
  int lit = 0;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed + 2 * Lights);
    const Corners corners = RandomCorners(seed);
    const glm::dvec2 s(random.Between(-4.0, 5.0), random.Between(-4.0, 5.0));
    const glm::dvec3 x = PointBefore(corners, s, random.Between(-1.0, 3.0));
    const glm::dvec3 n =
      glm::normalize(corners.MakeLight().Sample({ 0.5, 0.5 }) - x + random.InBox(3.0));
    lit += ExpectExact(corners, x, n, largest) > 0.0 ? 1 : 0;
  }
  EXPECT_GT(lit, Lights / 4);
  EXPECT_LT(lit, Lights);
}

// The receiver's plane passes through the light's middle, at any angle.
TEST(PolygonLightFormFactor, IsExactWhereTheHorizonCutsTheLight)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed + 3 * Lights);
    const Corners corners = RandomCorners(seed);
    const glm::dvec3 inside =
      corners.MakeLight().Sample({ random.Between(0.2, 0.8), random.Between(0.2, 0.8) });
    const glm::dvec3 x = PointBefore(
      corners, { random.Between(-2.0, 3.0), random.Between(-2.0, 3.0) }, random.Between(0.1, 3.0));
    const glm::dvec3 n = glm::normalize(glm::cross(inside - x, random.Direction()));
    EXPECT_GT(ExpectExact(corners, x, n, largest), 0.0) << seed;
    EXPECT_LT(corners.MakeLight().ClippedToFront(x, n).GetArea(), corners.Area()) << seed; // is cut
  }
}

// Points of one receiver before and behind the light: a one-sided light shines on those before it.
TEST(PolygonLightFormFactor, IsZeroBehindAOneSidedLight)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed + 4 * Lights);
    const Corners corners = RandomCorners(seed);
    const glm::dvec2 s(random.Between(-2.0, 3.0), random.Between(-2.0, 3.0));
    const double height = random.Between(0.01, 2.0);
    for (const double side : { -1.0, 1.0 })
    {
      const glm::dvec3 x = PointBefore(corners, s, side * height);
      const glm::dvec3 n = glm::normalize(corners.MakeLight().Sample({ 0.5, 0.5 }) - x);
      const double front = ExpectExact(corners, x, n, largest);
      EXPECT_EQ(front > 0.0, side > 0.0) << seed;
    }
  }
}

// Reciprocity with the cosines: from a point that looks away there is nothing to see.
TEST(PolygonLightFormFactor, IsZeroWhereTheReceiverLooksAway)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const Corners corners = RandomCorners(seed);
    PolygonLight light = corners.MakeLight();
    light.TwoSided = true;
    for (const double side : { -1.0, 1.0 })
    {
      const glm::dvec3 x = PointBefore(corners, { 0.3, 0.3 }, side);
      EXPECT_EQ(light.FormFactor(x, side * light.GetNormal()), 0.0);
    }
  }
}

// Very close to its middle, a light fills the whole hemisphere but a rim: with rho the distance to
// the nearest edge, 1 - F <= sin^2 of the rim's angle <= (h / rho)^2 (a disk of radius rho alone
// has F = rho^2 / (rho^2 + h^2)).
TEST(PolygonLightFormFactor, ApproachesOneAtTheLight)
{
  const PolygonLight light = PolygonLight::Parallelogram({ -1, -1, 0 }, { 1, -1, 0 }, { -1, 1, 0 });
  for (const double h : { 1e-2, 1e-5, 1e-9 })
  {
    const double f = light.FormFactor({ 0.0, 0.0, h }, { 0.0, 0.0, -1.0 });
    EXPECT_LE(f, 1.0);
    EXPECT_GE(f, 1.0 - h * h - FormFactorTolerance);
  }
  EXPECT_EQ(light.FormFactor({ 0.0, 0.0, 0.0 }, { 0.0, 0.0, -1.0 }), 0.0); // in its plane
}

TEST(PolygonLight, HasTheNormalAndAreaOfItsPoints)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const Corners corners = RandomCorners(seed);
    const PolygonLight light = corners.MakeLight();
    EXPECT_TRUE(light.IsValid());
    EXPECT_NEAR(light.GetArea(), corners.Area(), Rounding);
    const glm::dvec3 cross =
      glm::cross(corners.Point1 - corners.Origin, corners.Point2 - corners.Origin);
    EXPECT_LE(
      glm::length(light.GetNormal() - glm::normalize(cross)), Rounding / glm::length(cross));
    EXPECT_EQ(light.GetVertices().size(), corners.IsTriangle ? 3u : 4u);
  }
}

TEST(PolygonLight, IsInvalidWithoutAnArea)
{
  const glm::dvec3 o(1.0, 2.0, 3.0), p(2.0, 4.0, 6.0), q(4.0, 8.0, 12.0);
  for (const bool isTriangle : { false, true })
  {
    EXPECT_FALSE((Corners{ o, o, o, isTriangle }.MakeLight().IsValid()));
    EXPECT_FALSE((Corners{ o, o, p, isTriangle }.MakeLight().IsValid()));
    EXPECT_FALSE((Corners{ o, p, p, isTriangle }.MakeLight().IsValid()));
    EXPECT_FALSE((Corners{ o, p, q, isTriangle }.MakeLight().IsValid()));
  }
}

// Points that a user types on a line are on it but for the rounding of their decimals.
TEST(PolygonLight, IsInvalidWhereThePointsLieOnALineButForRounding)
{
  const glm::dvec3 direction(0.1, 0.2, 0.3);
  int valid = 0;
  for (int i = 1; i <= 20; ++i)
  {
    for (const bool isTriangle : { false, true })
    {
      const Corners corners{ glm::dvec3(0.0), direction * (0.1 * i), direction * (0.7 * i),
        isTriangle };
      valid += corners.MakeLight().IsValid() ? 1 : 0;
    }
  }
  EXPECT_EQ(valid, 0);
}

TEST(PolygonLight, IsInvalidWithCoordinatesThatAreNotFinite)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity })
  {
    for (int i = 0; i < 18; ++i)
    {
      std::array<glm::dvec3, 3> p{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } };
      p[static_cast<std::size_t>(i % 3)][i / 3 % 3] = bad;
      const PolygonLight light = Corners{ p[0], p[1], p[2], i % 2 == 0 }.MakeLight();
      EXPECT_FALSE(light.IsValid());
      EXPECT_EQ(light.FormFactor({ 0, 0, 1 }, { 0, 0, -1 }), 0.0);
    }
  }
}

// The share of a triangle where the linear function with these values at its vertices is positive:
// one vertex on its own side cuts off a triangle with a share of each of its two edges.
double TriangleShare(const glm::dvec3& h)
{
  for (int i = 0; i < 3; ++i)
  {
    const double a = h[i], b = h[(i + 1) % 3], c = h[(i + 2) % 3];
    if ((a > 0.0) != (b > 0.0) && (a > 0.0) != (c > 0.0))
    {
      const double tip = a / (a - b) * (a / (a - c));
      return a > 0.0 ? tip : 1.0 - tip;
    }
  }
  return h.x > 0.0 ? 1.0 : 0.0;
}

// The same for a square: two triangles.
double ShareInFront(const Corners& corners, const glm::dvec3& point, const glm::dvec3& normal)
{
  const double a = glm::dot(corners.Origin - point, normal);
  const double b = glm::dot(corners.Point1 - point, normal);
  const double c = glm::dot(corners.Point2 - point, normal);
  const double half = TriangleShare({ a, b, c });
  return corners.IsTriangle ? half : 0.5 * (half + TriangleShare({ b, b + c - a, c }));
}

TEST(PolygonLightClipping, LeavesTheAreaInFront)
{
  int cut = 0;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const Corners corners = RandomCorners(seed);
    const glm::dvec3 point = random.InBox(1.0);
    const glm::dvec3 normal = random.Direction();
    const PolygonLight light = corners.MakeLight();
    const double front = light.ClippedToFront(point, normal).GetArea();
    const double back = light.ClippedToFront(point, -normal).GetArea();
    EXPECT_NEAR(front, corners.Area() * ShareInFront(corners, point, normal), Rounding) << seed;
    EXPECT_NEAR(front + back, light.GetArea(), Rounding) << seed;
    cut += front > 0.0 && back > 0.0 ? 1 : 0;
  }
  EXPECT_GT(cut, Lights / 3);
}

TEST(PolygonLightClipping, KeepsWhatTheLightIs)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    PolygonLight light = RandomCorners(seed).MakeLight();
    light.Radiance = { 1.0, 2.0, 3.0 };
    light.TwoSided = seed % 3 == 0;
    const glm::dvec3 point = light.Sample({ random.Between(0.1, 0.9), random.Between(0.1, 0.9) });
    const glm::dvec3 normal = random.Direction();
    const PolygonLight seen = light.ClippedToFront(point, normal);
    EXPECT_EQ(seen.Radiance, light.Radiance);
    EXPECT_EQ(seen.TwoSided, light.TwoSided);
    ASSERT_TRUE(seen.IsValid()) << seed; // the point is within the light
    EXPECT_LE(glm::length(seen.GetNormal() - light.GetNormal()), Rounding / seen.GetArea()) << seed;
    for (const glm::dvec3& vertex : seen.GetVertices())
    {
      EXPECT_GE(glm::dot(vertex - point, normal), -Rounding) << seed;
      EXPECT_NEAR(glm::dot(vertex - point, light.GetNormal()), 0.0, Rounding * 10.0) << seed;
    }
  }
}

TEST(PolygonLightClipping, LeavesAWholeLightAlone)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const PolygonLight light = RandomCorners(seed).MakeLight();
    const glm::dvec3 below(0.0, 0.0, -10.0), up(0.0, 0.0, 1.0);
    const PolygonLight seen = light.ClippedToFront(below, up);
    EXPECT_EQ(seen.GetVertices(), light.GetVertices());
    EXPECT_EQ(seen.GetArea(), light.GetArea());
    // The sample map stays the light's own: the same samples, to the bit.
    EXPECT_EQ(seen.Sample({ 0.3, 0.8 }), light.Sample({ 0.3, 0.8 }));
    EXPECT_FALSE(light.ClippedToFront(below, -up).IsValid());
    EXPECT_EQ(light.ClippedToFront(below, -up).GetArea(), 0.0);
  }
}

TEST(PolygonLightClipping, LeavesAnEdgeOnThePlaneAndNothingInThePlane)
{
  const glm::dvec3 up(0.0, 0.0, 1.0), ground(7.0, -3.0, 0.0);
  const PolygonLight upright = PolygonLight::Parallelogram({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 });
  EXPECT_EQ(upright.ClippedToFront(ground, up).GetArea(), 1.0);
  EXPECT_FALSE(upright.ClippedToFront(ground, -up).IsValid());
  const PolygonLight flat = PolygonLight::Parallelogram({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 });
  EXPECT_FALSE(flat.ClippedToFront(ground, up).IsValid());
  EXPECT_FALSE(flat.ClippedToFront(ground, -up).IsValid());
  // A triangle that touches the plane with a vertex from above, and from below.
  const PolygonLight tip = PolygonLight::Triangle({ 0, 0, 0 }, { 1, 0, 1 }, { -1, 0, 1 });
  EXPECT_EQ(tip.ClippedToFront(ground, up).GetArea(), 1.0);
  EXPECT_FALSE(tip.ClippedToFront(ground, -up).IsValid());
}

// Lights of all three kinds of sample map: whole ones, and fans that one or two planes have cut.
std::vector<PolygonLight> SampledLights()
{
  std::vector<PolygonLight> lights;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    RandomGeometry random(seed);
    PolygonLight light = RandomCorners(seed).MakeLight();
    for (unsigned cut = 0; cut < seed / 2 % 3; ++cut)
    {
      const glm::dvec3 inside =
        light.Sample({ random.Between(0.2, 0.8), random.Between(0.2, 0.8) });
      light = light.ClippedToFront(inside, random.Direction());
    }
    lights.push_back(light);
  }
  return lights;
}

// The signed distance of a point inside the light's plane from the edge behind vertex i, positive
// inside.
double InsideEdge(const PolygonLight& light, std::size_t i, const glm::dvec3& point)
{
  const std::vector<glm::dvec3>& v = light.GetVertices();
  const glm::dvec3 edge = v[(i + 1) % v.size()] - v[i];
  const glm::dvec3 inwards = glm::cross(light.GetNormal(), edge);
  return glm::dot(point - v[i], inwards) / glm::length(edge);
}

TEST(PolygonLightSample, LandsOnTheLight)
{
  for (const PolygonLight& light : SampledLights())
  {
    RandomGeometry random(5);
    for (int i = 0; i < 2000; ++i)
    {
      // Among them the square's corners and edges.
      const double x = i % 7 == 0 ? 0.0 : i % 11 == 0 ? 1.0 - 0x1p-32 : random.Between(0.0, 1.0);
      const double y = i % 5 == 0 ? 0.0 : i % 13 == 0 ? 1.0 - 0x1p-32 : random.Between(0.0, 1.0);
      const glm::dvec3 point = light.Sample({ x, y });
      EXPECT_NEAR(glm::dot(point - light.GetVertices()[0], light.GetNormal()), 0.0, Rounding);
      for (std::size_t edge = 0; edge < light.GetVertices().size(); ++edge)
      {
        EXPECT_GE(InsideEdge(light, edge, point), -Rounding);
      }
    }
  }
}

// Everywhere the map stretches areas alike: |dp/ds1 x dp/ds2| is the light's area. The maps are
// linear in pieces, so a difference over 2^-24 is the derivative, up to a relative 2^24 roundings
// of coordinates below 10 in each of two differences (1e-7); where it happens to straddle two
// pieces (some ten lines: less than one point in 1e5 here) it means nothing, and this tolerates one
// such point in a thousand.
TEST(PolygonLightSample, StretchesAreasAlike)
{
  constexpr double step = 0x1p-24;
  constexpr double tolerance = 1e-6;
  constexpr int points = 2000;
  for (const PolygonLight& light : SampledLights())
  {
    RandomGeometry random(6);
    int wrong = 0;
    for (int i = 0; i < points; ++i)
    {
      const glm::dvec2 s(random.Between(0.0, 1.0 - step), random.Between(0.0, 1.0 - step));
      const glm::dvec3 p = light.Sample(s);
      const glm::dvec3 alongX = (light.Sample(s + glm::dvec2(step, 0.0)) - p) / step;
      const glm::dvec3 alongY = (light.Sample(s + glm::dvec2(0.0, step)) - p) / step;
      const double stretch = glm::length(glm::cross(alongX, alongY));
      wrong += std::abs(stretch - light.GetArea()) > tolerance ? 1 : 0;
    }
    EXPECT_LE(wrong, points / 1000);
  }
}

// And it covers the light evenly: of the centres of n x n cells, the share on one side of a line is
// the light's share there. The line is at most two segments in the square for each triangle of the
// fan, and one for a parallelogram; a segment crosses up to 2 n cells, and so do the sides of the
// strips of the fan's triangles together per strip. Cells that nothing crosses are counted right:
// the error is at most  3 segments x 2 n cells / n^2  for each triangle.
TEST(PolygonLightSample, CoversTheLightEvenly)
{
  constexpr int n = 256;
  for (const PolygonLight& light : SampledLights())
  {
    const double bound = 6.0 / n * static_cast<double>(light.GetVertices().size() - 2);
    RandomGeometry random(7);
    for (int line = 0; line < 4; ++line)
    {
      const glm::dvec3 point = light.Sample({ random.Between(0.2, 0.8), random.Between(0.2, 0.8) });
      const glm::dvec3 normal = random.Direction();
      int inFront = 0;
      for (int i = 0; i < n * n; ++i)
      {
        const glm::dvec2 s((i % n + 0.5) / n, (i / n + 0.5) / n);
        inFront += glm::dot(light.Sample(s) - point, normal) > 0.0 ? 1 : 0;
      }
      const double share = light.ClippedToFront(point, normal).GetArea() / light.GetArea();
      EXPECT_NEAR(static_cast<double>(inFront) / (n * n), share, bound);
    }
  }
}

glm::dmat4 RandomRotation(RandomGeometry& random, bool isMirrored)
{
  const glm::dvec3 z = random.Direction();
  const glm::dvec3 x = glm::normalize(glm::cross(z, random.Direction()));
  const glm::dvec3 y = (isMirrored ? -1.0 : 1.0) * glm::cross(z, x);
  glm::dmat4 matrix(glm::dmat3(x, y, z));
  matrix[3] = glm::dvec4(random.InBox(3.0), 1.0);
  return matrix;
}

// A light that is moved or turned together with what it shines on shines as before; and so it does
// in a mirror: its front stays its front.
void ExpectSameLightAfter(const glm::dmat4& matrix, unsigned seed)
{
  RandomGeometry random(seed);
  const Corners corners = RandomCorners(seed);
  PolygonLight light = corners.MakeLight();
  light.Radiance = { 3.0, 2.0, 1.0 };
  light.TwoSided = seed % 5 == 0;
  const PolygonLight moved = light.Transformed(matrix);
  EXPECT_EQ(moved.Radiance, light.Radiance);
  EXPECT_EQ(moved.TwoSided, light.TwoSided);
  EXPECT_NEAR(moved.GetArea(), light.GetArea(), Rounding);
  const double side = seed % 2 == 0 ? 1.0 : -1.0;
  const glm::dvec3 x = PointBefore(corners, { 0.3, 0.4 }, side * random.Between(0.1, 2.0));
  const glm::dvec3 n = -side * light.GetNormal();
  const glm::dvec3 movedX(matrix * glm::dvec4(x, 1.0));
  const glm::dvec3 movedN(matrix * glm::dvec4(n, 0.0));
  EXPECT_NEAR(moved.FormFactor(movedX, movedN), light.FormFactor(x, n), Rounding) << seed;
  const glm::dvec2 s(random.Between(0.0, 1.0), random.Between(0.0, 1.0));
  const glm::dvec3 movedSample(matrix * glm::dvec4(light.Sample(s), 1.0));
  for (std::size_t edge = 0; edge < moved.GetVertices().size(); ++edge)
  {
    EXPECT_GE(InsideEdge(moved, edge, movedSample), -Rounding) << seed;
  }
}

TEST(PolygonLightTransformed, ShinesAsBeforeWhenMoved)
{
  RandomGeometry random(8);
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    ExpectSameLightAfter(RandomRotation(random, false), seed);
  }
}

TEST(PolygonLightTransformed, ShinesAsBeforeInAMirror)
{
  RandomGeometry random(9);
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    ExpectSameLightAfter(RandomRotation(random, true), seed);
  }
}

// Areas scale with |det| and the stretch of the normal, as those of any surface do.
TEST(PolygonLightTransformed, ScalesItsArea)
{
  const Corners corners{ { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, false };
  glm::dmat4 matrix(1.0);
  matrix[0][0] = 2.0;
  matrix[1][1] = 3.0;
  matrix[2][2] = 5.0;
  const PolygonLight light = corners.MakeLight().Transformed(matrix);
  EXPECT_EQ(light.GetArea(), 6.0);
  EXPECT_EQ(light.Sample({ 0.5, 0.5 }), glm::dvec3(1.0, 1.5, 5.0));
  matrix[1][1] = 0.0; // flattened to a line
  EXPECT_FALSE(corners.MakeLight().Transformed(matrix).IsValid());
}

} // namespace

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// H&H 1997, section 3.4: the parallelogram around a receiver, by the properties that define it.

#include "ParallelogramFit.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace
{

using penumbra::FitParallelogram;
using penumbra::FittedParallelogram;
using penumbra::Parallelogram;
using Points2 = std::vector<glm::dvec2>;
using Points3 = std::vector<glm::dvec3>;

const double Pi = std::acos(-1.0);

// Input may be rounded: vertices of the hull that stand out by less than 1e-5 of the extent count
// as flat. Vertices that are dropped one after the other, flattest first, add up to less than twice
// that (on a smooth curve each round drops every other vertex and is a quarter of the next).
constexpr double Flatness = 2e-5;
// Some 100 roundings (1.1e-16) of numbers of the size of the extent, and a margin.
constexpr double Rounding = 1e-13;

// A plane in space, turned at random.
struct Plane
{
  explicit Plane(RandomGeometry& random)
    : Origin(random.Between(0.0, 10.0) * random.Direction())
    , Normal(random.Direction())
  {
    this->X = glm::normalize(glm::cross(this->Normal, random.Direction()));
    this->Y = glm::cross(this->Normal, this->X);
  }
  glm::dvec3 ToSpace(const glm::dvec2& p) const
  {
    return this->Origin + p.x * this->X + p.y * this->Y;
  }
  Points3 ToSpace(const Points2& points) const
  {
    Points3 result;
    for (const glm::dvec2& p : points)
    {
      result.push_back(this->ToSpace(p));
    }
    return result;
  }

  glm::dvec3 Origin, Normal, X, Y;
};

Points3 Quad(const glm::dvec3& corner, const glm::dvec3& ex, const glm::dvec3& ey)
{
  return { corner, corner + ex, corner + ex + ey, corner + ey };
}

// A rectangle or a skewed parallelogram, its edges 0.1 to 10 long and at 12 degrees or more.
Points3 RandomQuad(RandomGeometry& random, const Plane& plane, bool isSkewed)
{
  const double angle = isSkewed ? random.Between(0.2, Pi - 0.2) : 0.5 * Pi;
  const double turn = random.Between(0.0, 2.0 * Pi);
  const double x = std::pow(10.0, random.Between(-1.0, 1.0));
  const double y = x * random.Between(0.3, 3.0);
  const auto edge = [&](double length, double a)
  { return length * (std::cos(a) * plane.X + std::sin(a) * plane.Y); };
  return Quad(plane.Origin, edge(x, turn), edge(y, turn + angle));
}

// Corners in another order: started elsewhere, and perhaps the other way round.
void Rewind(RandomGeometry& random, Points3& corners)
{
  std::rotate(corners.begin(),
    corners.begin() + static_cast<std::ptrdiff_t>(random.Below(corners.size())), corners.end());
  if (random.Below(2) == 0)
  {
    std::reverse(corners.begin(), corners.end());
  }
}

// Points inside the hull of `corners` and on its edges.
Points3 PointsWithin(RandomGeometry& random, const Points3& corners, int count)
{
  Points3 points;
  for (int i = 0; i < count; ++i)
  {
    const std::size_t a = random.Below(corners.size());
    const glm::dvec3 onEdge =
      glm::mix(corners[a], corners[(a + 1) % corners.size()], random.Between(0.0, 1.0));
    const double inwards = i % 2 == 0 ? 0.0 : random.Between(0.0, 1.0);
    points.push_back(glm::mix(onEdge, corners[random.Below(corners.size())], inwards));
  }
  return points;
}

bool IsOneOf(const glm::dvec3& point, const Points3& points)
{
  return std::find(points.begin(), points.end(), point) != points.end();
}

double ExtentOf(const Points3& points)
{
  double extent = 0.0;
  for (const glm::dvec3& p : points)
  {
    extent = std::max(extent, glm::length(p - points.front()));
  }
  return extent;
}

double AreaOf(const Parallelogram& fit)
{
  return glm::length(glm::cross(fit.EdgeX, fit.EdgeY));
}

// How far a point lies outside of the parallelogram, measured across its edges.
double DistanceOutside(const Parallelogram& fit, const glm::dvec3& point)
{
  const glm::dvec3 n = glm::normalize(glm::cross(fit.EdgeX, fit.EdgeY));
  const glm::dvec3 acrossX = glm::normalize(glm::cross(n, fit.EdgeX));
  const glm::dvec3 acrossY = glm::normalize(glm::cross(fit.EdgeY, n));
  const double y = glm::dot(point - fit.Corner, acrossX);
  const double x = glm::dot(point - fit.Corner, acrossY);
  return std::max({ -x, -y, x - glm::dot(fit.EdgeX, acrossY), y - glm::dot(fit.EdgeY, acrossX) });
}

void ExpectEnclosed(const Parallelogram& fit, const Points3& points, double tolerance)
{
  for (const glm::dvec3& point : points)
  {
    EXPECT_LE(DistanceOutside(fit, point), tolerance);
  }
}

void ExpectFacing(const Parallelogram& fit, const glm::dvec3& normal)
{
  const glm::dvec3 areaVector = glm::cross(fit.EdgeX, fit.EdgeY);
  EXPECT_NEAR(glm::dot(areaVector, normal), glm::length(areaVector), 1e-9 * AreaOf(fit));
}

// The fit is the quad itself, to the bit: its corner the first one, its edges those beside it.
void ExpectOwnFit(const Points3& quad, const glm::dvec3& normal)
{
  const std::optional<FittedParallelogram> fit = FitParallelogram(quad, normal);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->Corner, quad[0]);
  const Points3 edges{ quad[1] - quad[0], quad[3] - quad[0] };
  EXPECT_TRUE(IsOneOf(fit->EdgeX, edges));
  EXPECT_TRUE(IsOneOf(fit->EdgeY, edges));
  ExpectFacing(*fit, normal);
}

// The smallest area of the rectangles that enclose the points and whose sides lie in one of `count`
// directions of the first quadrant.
double SmallestArea(const Points2& points, int count)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i)
  {
    const double angle = 0.5 * Pi * i / count;
    const glm::dvec2 along(std::cos(angle), std::sin(angle));
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec2& p : points)
    {
      const glm::dvec2 q(glm::dot(p, along), p.y * along.x - p.x * along.y);
      low = glm::min(low, q);
      high = glm::max(high, q);
    }
    smallest = std::min(smallest, (high.x - low.x) * (high.y - low.y));
  }
  return smallest;
}

// The fit is a rectangle, encloses all points, and no rectangle that does is smaller.
void ExpectSmallestRectangle(RandomGeometry& random, Points2 points)
{
  const Plane plane(random);
  random.Shuffle(points);
  const Points3 inSpace = plane.ToSpace(points);
  const glm::dvec3 normal = random.Below(2) == 0 ? plane.Normal : -plane.Normal;
  const std::optional<FittedParallelogram> fit = FitParallelogram(inSpace, normal);
  ASSERT_TRUE(fit);
  const double lengths = glm::length(fit->EdgeX) * glm::length(fit->EdgeY);
  EXPECT_NEAR(glm::dot(fit->EdgeX, fit->EdgeY), 0.0, Rounding * lengths);
  ExpectFacing(*fit, normal);
  ExpectEnclosed(*fit, inSpace, Flatness * ExtentOf(inSpace));
  constexpr int directions = 9001;
  EXPECT_LE(AreaOf(*fit), (1.0 + Rounding * 100.0) * SmallestArea(points, directions));
}

Points2 RegularPolygon(int count, double turn)
{
  Points2 points;
  for (int i = 0; i < count; ++i)
  {
    const double angle = turn + 2.0 * Pi * i / count;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  return points;
}

// From either side, whichever corner comes first and whichever way round.
void ExpectOwnFits(RandomGeometry& random, bool isSkewed)
{
  for (int i = 0; i < 1000; ++i)
  {
    const Plane plane(random);
    Points3 quad = RandomQuad(random, plane, isSkewed);
    Rewind(random, quad);
    ExpectOwnFit(quad, i % 2 == 0 ? plane.Normal : -plane.Normal);
  }
}

TEST(ParallelogramFit, IsExactForRectangles)
{
  RandomGeometry random(1);
  ExpectOwnFits(random, false);
}

TEST(ParallelogramFit, IsExactForParallelograms)
{
  RandomGeometry random(2);
  ExpectOwnFits(random, true);
}

TEST(ParallelogramFit, IsExactForAxisAlignedQuads)
{
  const glm::dvec3 x(2.0, 0.0, 0.0), y(0.0, 3.0, 0.0), z(0.0, 0.0, 4.0), corner(1.0, -1.0, 5.0);
  for (const double side : { -1.0, 1.0 })
  {
    ExpectOwnFit(Quad(corner, x, y), side * glm::dvec3(0.0, 0.0, 1.0));
    ExpectOwnFit(Quad(corner, y, z), side * glm::dvec3(1.0, 0.0, 0.0));
    ExpectOwnFit(Quad(corner, z, x), side * glm::dvec3(0.0, 1.0, 0.0));
  }
}

// Points inside and on the edges change nothing but which corner comes first.
TEST(ParallelogramFit, IgnoresPointsInsideAndOnTheEdges)
{
  RandomGeometry random(3);
  for (int i = 0; i < 500; ++i)
  {
    const Plane plane(random);
    const Points3 quad = RandomQuad(random, plane, i % 2 == 0);
    Points3 points = PointsWithin(random, quad, 50);
    points.insert(points.end(), quad.begin(), quad.end());
    points.push_back(quad[random.Below(4)]); // and a corner twice
    random.Shuffle(points);
    const std::optional<FittedParallelogram> fit = FitParallelogram(points, plane.Normal);
    ASSERT_TRUE(fit);
    const auto first = std::find_if(
      points.begin(), points.end(), [&](const glm::dvec3& p) { return IsOneOf(p, quad); });
    EXPECT_EQ(fit->Corner, *first);
    EXPECT_FALSE(fit->IsTriangle);
    // From the corners themselves: the sums are theirs but for the subtraction's rounding.
    const double tolerance = Rounding * (ExtentOf(points) + glm::length(fit->Corner));
    EXPECT_NEAR(AreaOf(*fit), glm::length(glm::cross(quad[1] - quad[0], quad[3] - quad[0])),
      tolerance * ExtentOf(points));
    ExpectEnclosed(*fit, points, tolerance);
    ExpectFacing(*fit, plane.Normal);
  }
}

TEST(ParallelogramFit, PutsATriangleIntoTheLowerLeftHalf)
{
  RandomGeometry random(4);
  for (int i = 0; i < 1000; ++i)
  {
    const Plane plane(random);
    Points3 triangle = RandomQuad(random, plane, true);
    triangle.erase(triangle.begin() + static_cast<std::ptrdiff_t>(random.Below(4)));
    Rewind(random, triangle);
    Points3 points = triangle;
    const Points3 within = PointsWithin(random, triangle, i % 20);
    points.insert(points.end(), within.begin(), within.end());
    const glm::dvec3 normal = i % 3 == 0 ? -plane.Normal : plane.Normal;
    const std::optional<FittedParallelogram> fit = FitParallelogram(points, normal);
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->IsTriangle);
    EXPECT_EQ(fit->Corner, triangle[0]);
    const Points3 edges{ triangle[1] - triangle[0], triangle[2] - triangle[0] };
    EXPECT_TRUE(IsOneOf(fit->EdgeX, edges));
    EXPECT_TRUE(IsOneOf(fit->EdgeY, edges));
    ExpectFacing(*fit, normal);
  }
}

TEST(ParallelogramFit, EnclosesOtherQuadsInTheSmallestRectangle)
{
  RandomGeometry random(5);
  ExpectSmallestRectangle(random, { { 0, 0 }, { 4, 0 }, { 3, 1 }, { 1, 1 } });        // trapezium
  ExpectSmallestRectangle(random, { { 0, 0 }, { 1, -1 }, { 5, 0 }, { 1, 1 } });       // kite
  ExpectSmallestRectangle(random, { { 0, 0 }, { 4, 0 }, { 4, 3 }, { 0.001, 3.01 } }); // nearly one
}

TEST(ParallelogramFit, EnclosesAnLShapeInTheSmallestRectangle)
{
  RandomGeometry random(6);
  for (int i = 0; i < 20; ++i)
  {
    ExpectSmallestRectangle(random, { { 0, 0 }, { 3, 0 }, { 3, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } });
  }
}

TEST(ParallelogramFit, EnclosesRegularPolygonsInTheSmallestRectangle)
{
  RandomGeometry random(7);
  for (const int count : { 5, 6, 7, 8, 12, 64, 1000 })
  {
    ExpectSmallestRectangle(random, RegularPolygon(count, random.Between(0.0, Pi)));
  }
}

// As many vertices as a fine disc has. Around the unit circle the smallest rectangle has area 4;
// the vertices that are dropped stand out by less than the flatness.
TEST(ParallelogramFit, FitsADiscOfManyVertices)
{
  RandomGeometry random(16);
  const Plane plane(random);
  const Points3 disc = plane.ToSpace(RegularPolygon(64000, 0.0));
  const std::optional<FittedParallelogram> fit = FitParallelogram(disc, plane.Normal);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(AreaOf(*fit), 4.0, 4.0 * 2.0 * Flatness);
}

TEST(ParallelogramFit, EnclosesRandomPointsInTheSmallestRectangle)
{
  RandomGeometry random(8);
  for (int i = 0; i < 100; ++i)
  {
    Points2 points;
    const double height = std::pow(10.0, random.Between(-2.0, 1.0));
    const std::size_t count = 5 + random.Below(40);
    while (points.size() < count)
    {
      points.emplace_back(random.Between(-1.0, 1.0), height * random.Between(-1.0, 1.0));
    }
    ExpectSmallestRectangle(random, points);
  }
}

// "So that the fit does not depend on where the points are": moved exactly, nothing else moves.
TEST(ParallelogramFit, MovesWithThePoints)
{
  RandomGeometry random(9);
  const auto onLattice = [](const glm::dvec3& p) { return glm::floor(p * 0x1p20) * 0x1p-20; };
  const glm::dvec3 away(1e6, 2e6, -3e6); // 22 bits, and 20 behind the point: exact in 53
  for (int i = 0; i < 200; ++i)
  {
    Points3 points;
    Points3 moved;
    for (int j = 0; j < 8; ++j)
    {
      points.push_back(onLattice({ random.Between(-4.0, 4.0), random.Between(-4.0, 4.0), 1.0 }));
      moved.push_back(points.back() + away);
    }
    const glm::dvec3 normal(0.0, 0.0, 1.0);
    const std::optional<FittedParallelogram> fit = FitParallelogram(points, normal);
    const std::optional<FittedParallelogram> movedFit = FitParallelogram(moved, normal);
    ASSERT_TRUE(fit && movedFit);
    EXPECT_EQ(fit->EdgeX, movedFit->EdgeX);
    EXPECT_EQ(fit->EdgeY, movedFit->EdgeY);
    // The corner is a sum whose rounding is that of its own size, below 1e7.
    EXPECT_LE(glm::length(fit->Corner - (movedFit->Corner - away)), 1e7 * 0x1p-52);
  }
}

Points3 RoundToFloat(const Points3& points)
{
  Points3 rounded;
  for (const glm::dvec3& p : points)
  {
    rounded.emplace_back(glm::vec3(p));
  }
  return rounded;
}

// Floats at a distance of D round by up to D 2^-24 a coordinate, so a vertex by sqrt(3) times that,
// and the difference of two opposite edges (four vertices) by 7 times. At D = 10 of an extent that
// is 4e-6, less than what counts as flat.
TEST(ParallelogramFit, KnowsFloatParallelogramsOffTheOrigin)
{
  RandomGeometry random(10);
  for (int i = 0; i < 500; ++i)
  {
    Plane plane(random);
    plane.Origin = 10.0 * random.Direction();
    const Points3 exact = Quad(plane.Origin, plane.X, 0.3 * plane.X + 0.9 * plane.Y);
    Points3 points = exact;
    const Points3 within = PointsWithin(random, exact, 50);
    points.insert(points.end(), within.begin(), within.end());
    points = RoundToFloat(points);
    const std::optional<FittedParallelogram> fit = FitParallelogram(points, plane.Normal);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->Corner, points[0]);
    EXPECT_EQ(fit->EdgeX, points[1] - points[0]);
    EXPECT_EQ(fit->EdgeY, points[3] - points[0]);
  }
}

// Farther away the rounding is more than what counts as flat, and a rectangle's hull becomes a
// polygon of many vertices; the fit is good to the size of the rounding all the same.
TEST(ParallelogramFit, EnclosesFloatRectanglesFarFromTheOrigin)
{
  RandomGeometry random(11);
  for (const double distance : { 1e2, 1e3, 1e4 })
  {
    const double rounding = std::sqrt(3.0) * distance * 0x1p-24;
    for (int i = 0; i < 100; ++i)
    {
      Plane plane(random);
      plane.Origin = distance * random.Direction();
      Points3 points = Quad(plane.Origin, 2.0 * plane.X, plane.Y);
      const Points3 within = PointsWithin(random, points, 200);
      points.insert(points.end(), within.begin(), within.end());
      points = RoundToFloat(points);
      const std::optional<FittedParallelogram> fit = FitParallelogram(points, plane.Normal);
      ASSERT_TRUE(fit);
      ExpectEnclosed(*fit, points, 2.0 * rounding + Flatness * ExtentOf(points));
      // No larger than the rectangle (2 by 1) grown by the rounding on all sides.
      EXPECT_LE(AreaOf(*fit), (2.0 + 2.0 * rounding) * (1.0 + 2.0 * rounding) * (1.0 + Rounding));
    }
  }
}

// A plane of many cells, as ParaView's source makes it: its corners, not a hull of rounded
// vertices. At D = 1e4 the rounding is 2e-3, a hundredth of a cell.
TEST(ParallelogramFit, KnowsFloatRectanglesFarFromTheOriginByTheirRounding)
{
  RandomGeometry random(14);
  constexpr int cells = 5;
  for (const double distance : { 1.0, 1e2, 1e3, 1e4 })
  {
    const double rounding = (distance + 3.0) * 0x1p-23;
    for (int i = 0; i < 200; ++i)
    {
      Plane plane(random);
      plane.Origin = distance * random.Direction();
      Points3 points;
      for (int j = 0; j < (cells + 1) * (cells + 1); ++j)
      {
        const double x = 2.0 * (j % (cells + 1)) / cells;
        points.push_back(plane.ToSpace(glm::dvec2(x, 1.0 * (j / (cells + 1)) / cells)));
      }
      points = RoundToFloat(points);
      const std::optional<FittedParallelogram> fit =
        FitParallelogram(points, plane.Normal, rounding);
      ASSERT_TRUE(fit);
      EXPECT_EQ(fit->Corner, points[0]);
      EXPECT_EQ(fit->EdgeX, points[cells] - points[0]);
      EXPECT_EQ(fit->EdgeY, points[cells * (cells + 1)] - points[0]);
    }
  }
}

// Slivers that are thinner than the rounding of their points still get something around them.
TEST(ParallelogramFit, EnclosesSliversOfTheRoundingsSize)
{
  RandomGeometry random(15);
  for (int i = 0; i < 200; ++i)
  {
    const Plane plane(random);
    const double width = std::pow(10.0, random.Between(-6.0, -1.0));
    const Points3 points = Quad(plane.Origin, 2.0 * plane.X, width * plane.Y);
    const double rounding = std::pow(10.0, random.Between(-4.0, -1.0));
    const std::optional<FittedParallelogram> fit = FitParallelogram(points, plane.Normal, rounding);
    ASSERT_TRUE(fit);
    ExpectEnclosed(*fit, points, Rounding * (10.0 + ExtentOf(points)));
  }
}

TEST(ParallelogramFit, FitsNothingAroundTooFewPoints)
{
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  EXPECT_FALSE(FitParallelogram({}, normal));
  EXPECT_FALSE(FitParallelogram({ { 1, 2, 3 } }, normal));
  EXPECT_FALSE(FitParallelogram({ { 1, 2, 3 }, { 4, 5, 3 } }, normal));
  EXPECT_FALSE(FitParallelogram({ { 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 } }, normal));
  EXPECT_FALSE(FitParallelogram({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 0 }, { 0, 0, 0 } }, normal));
}

TEST(ParallelogramFit, FitsNothingAroundPointsOnALine)
{
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  EXPECT_FALSE(FitParallelogram({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }, normal));
  EXPECT_FALSE(FitParallelogram({ { 0, 0, 0 }, { 0, 3, 0 }, { 0, 1, 0 }, { 0, 2, 0 } }, normal));
  EXPECT_FALSE(FitParallelogram({ { 1, 1, 0 }, { 2, 2, 0 }, { 4, 4, 0 } }, normal));
}

// A line as doubles can hold it: off by their rounding, which is not an area.
TEST(ParallelogramFit, FitsNothingAroundRoundedPointsOnALine)
{
  RandomGeometry random(12);
  int fits = 0;
  for (int i = 0; i < 1000; ++i)
  {
    const Plane plane(random);
    Points3 points;
    for (int j = 0; j < 3 + i % 5; ++j)
    {
      points.push_back(plane.Origin + random.Between(-5.0, 5.0) * plane.X);
    }
    fits += FitParallelogram(points, plane.Normal) ? 1 : 0;
  }
  EXPECT_EQ(fits, 0);
}

TEST(ParallelogramFit, FitsNothingAroundCoordinatesThatAreNotFinite)
{
  const Points3 good{ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 0, 1, 0 }, { 1, 2, 0 } };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity })
  {
    for (std::size_t i = 0; i < good.size(); ++i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        Points3 points = good;
        points[i][axis] = bad;
        EXPECT_FALSE(FitParallelogram(points, { 0.0, 0.0, 1.0 })) << bad << " in point " << i;
      }
    }
  }
}

// Many points: sorting them must not rely on an order that NaN does not have.
TEST(ParallelogramFit, FitsNothingAroundManyPointsWithOneNaN)
{
  RandomGeometry random(13);
  for (int i = 0; i < 200; ++i)
  {
    Points3 points;
    for (int j = 0; j < 200; ++j)
    {
      points.emplace_back(random.Between(-1.0, 1.0), random.Between(-1.0, 1.0), 0.0);
    }
    points[random.Below(points.size())].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(FitParallelogram(points, { 0.0, 0.0, 1.0 })) << i;
  }
}

} // namespace

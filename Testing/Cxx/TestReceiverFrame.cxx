// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The receiver's frame and the registered projection in it, against the matrices of the papers,
// which are written out here from their formulas and evaluated in long double.

#include "LargestDeviation.h"
#include "RandomGeometry.h"
#include "ReceiverFrame.h"
#include "RegisteredProjection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace
{

using penumbra::Parallelogram;
using penumbra::ReceiverFrame;
using penumbra::RegisteredProjection;
using Side = ReceiverFrame::Side;
using Long3 = glm::vec<3, long double>;
using Long4 = glm::vec<4, long double>;

constexpr int Pyramids = 1000;

// Unit roundoff of double is e = 1.1e-16. The duals and the normal come from cross products of
// edges whose angle has a sine of at least MinimumSine = 0.2, each with some 20 roundings, so that
// u, v and h of a point p are off by at most (20 / 0.2) e = 1.1e-14 of
// |dual| |p - b|. Tolerance is that with a margin, as issue 2 asks for it; the tests multiply it by
// the size of what was added up.
constexpr double Tolerance = 1e-12;
constexpr double MinimumSine = 0.2;

// A skewed base some way off the origin; its edges are 0.1 to 10 long and differ by up to 3 times.
Parallelogram RandomBase(RandomGeometry& random)
{
  while (true)
  {
    const double size = std::pow(10.0, random.Between(-1.0, 0.5));
    const Parallelogram base{ random.InBox(10.0), size * random.InBox(1.0),
      size * random.InBox(1.0) };
    const double x = glm::length(base.EdgeX);
    const double y = glm::length(base.EdgeY);
    const double sine = glm::length(glm::cross(base.EdgeX, base.EdgeY)) / (x * y);
    if (sine > MinimumSine && std::max(x, y) < 3.0 * std::min(x, y) && std::min(x, y) > 0.1)
    {
      return base;
    }
  }
}

// H&H 1997, figure 4: a pyramid over the base, its apex on the side that is lit, and a point that
// is to be projected.
struct Pyramid
{
  Parallelogram Base;
  ReceiverFrame Frame;
  glm::dvec3 Apex;
  glm::dvec3 Point;
};

Pyramid RandomPyramid(unsigned seed)
{
  RandomGeometry random(seed);
  Pyramid pyramid;
  pyramid.Base = RandomBase(random);
  pyramid.Frame = ReceiverFrame(pyramid.Base, seed % 2 == 0 ? Side::Front : Side::Back);
  const auto inFrame = [&](double low, double high)
  {
    const double u = random.Between(-2.0, 3.0);
    const double v = random.Between(-2.0, 3.0);
    return pyramid.Frame.ToWorld({ u, v, random.Between(low, high) });
  };
  pyramid.Apex = inFrame(0.3, 3.0);
  pyramid.Point = inFrame(-3.0, 6.0); // below the base, between it and the apex, and above that
  return pyramid;
}

// The sizes of what makes up x', y' and w' of a pyramid's point, as they enter the error. With
//   U = |dual| |p - b|,  A = |dual| |a - b|,  H = |p - b| / s,  B = |a - b| / s
// the errors of u, lu, h, lh are at most a tolerance t times U, A, H, B, and therefore that of
//   u - (lu / lh) h   is at most   t (U + (A / lh) H (2 + B / lh)),
// and that of 1 - h / lh is at most t (1 + (H / lh) (1 + B / lh)).
Long3 SizesOf(const Pyramid& pyramid)
{
  const double s = pyramid.Frame.GetSize();
  const double p = glm::length(pyramid.Point - pyramid.Base.Corner);
  const double a = glm::length(pyramid.Apex - pyramid.Base.Corner);
  const double lh = pyramid.Frame.ToFrame(pyramid.Apex).z;
  const double dualX = glm::length(pyramid.Base.EdgeY) / (s * s);
  const double dualY = glm::length(pyramid.Base.EdgeX) / (s * s);
  const double reach = p + a / lh * (p / s) * (2.0 + a / s / lh);
  return { dualX * reach, dualY * reach, 1.0 + p / s / lh * (1.0 + a / s / lh) };
}

glm::dvec3 Project(const Pyramid& pyramid)
{
  return RegisteredProjection::FromPoint(pyramid.Frame.ToFrame(pyramid.Apex))
    .Project(pyramid.Frame.ToFrame(pyramid.Point));
}

// The first, second and fourth row of H&H's M (section 3.3), which give x, y and w; the third is
// (0, 0, 0, 1).
std::array<Long4, 3> HeckbertHerfMatrix(const Parallelogram& base, const glm::dvec3& apex)
{
  const Long3 a(apex), b(base.Corner), ex(base.EdgeX), ey(base.EdgeY);
  const Long3 ew = b - a;
  const Long3 nx = glm::cross(ew, ey);
  const Long3 ny = glm::cross(ex, ew);
  const Long3 nw = glm::cross(ey, ex);
  const long double ax = 1 / glm::dot(nx, ex);
  const long double ay = 1 / glm::dot(ny, ey);
  const long double aw = 1 / glm::dot(nw, ew);
  return { Long4(ax * nx, -ax * glm::dot(nx, b)), Long4(ay * ny, -ay * glm::dot(ny, b)),
    Long4(aw * nw, -aw * glm::dot(nw, a)) };
}

// Blinn 1988, "Me and My (Fake) Shadow": the shadow of P from the light L on the plane G is
// P ((L.G) I - G L^T) in his row vectors, all homogeneous.
Long4 BlinnShadow(const Long4& light, const Long4& plane, const Long4& point)
{
  return glm::dot(light, plane) * point - glm::dot(point, plane) * light;
}

TEST(ReceiverFrame, MapsByItsDefinition)
{
  RandomGeometry random(1);
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const glm::dvec3 uvh = random.InBox(3.0);
    const Long3 ex(pyramid.Base.EdgeX), ey(pyramid.Base.EdgeY);
    const Long3 areaVector = glm::cross(ex, ey);
    const long double area = glm::length(areaVector);
    const Long3 n = (seed % 2 == 0 ? 1.0L : -1.0L) / area * areaVector;
    const long double u = uvh.x, v = uvh.y, h = uvh.z;
    const Long3 expected = Long3(pyramid.Base.Corner) + u * ex + v * ey + h * std::sqrt(area) * n;
    const Long3 actual(pyramid.Frame.ToWorld(uvh));
    const auto size = static_cast<double>(glm::length(expected)) + 30.0;
    EXPECT_LE(static_cast<double>(glm::length(actual - expected)), Tolerance * size) << seed;
  }
}

TEST(ReceiverFrame, RoundTrips)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const glm::dvec3 p = pyramid.Point;
    // u ex is off by |dual| |p - b| |ex| times Tolerance, and |dual| |ex| is one over the sine;
    // the corner is added at last, which rounds to the size of the world's coordinates.
    const double size = glm::length(p - pyramid.Base.Corner) / MinimumSine + glm::length(p);
    const double error = glm::length(pyramid.Frame.ToWorld(pyramid.Frame.ToFrame(p)) - p);
    EXPECT_LE(largest.Add(error, size), Tolerance) << seed;
  }
}

TEST(ReceiverFrame, MatrixIsTheMap)
{
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const glm::dvec4 mapped = pyramid.Frame.GetWorldToFrame() * glm::dvec4(pyramid.Point, 1.0);
    const glm::dvec3 expected = pyramid.Frame.ToFrame(pyramid.Point);
    // The matrix takes the point and the corner apart, so the error is one of their own sizes.
    const double s = pyramid.Frame.GetSize();
    const double longest =
      std::max({ glm::length(pyramid.Base.EdgeX), glm::length(pyramid.Base.EdgeY), s });
    const double size =
      longest / (s * s) * (glm::length(pyramid.Point) + glm::length(pyramid.Base.Corner));
    EXPECT_LE(glm::length(glm::dvec3(mapped) - expected), Tolerance * size) << seed;
    EXPECT_EQ(mapped.w, 1.0);
  }
}

TEST(ReceiverFrame, SidesDifferInTheHeightsSignAlone)
{
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const ReceiverFrame front(pyramid.Base, Side::Front);
    const ReceiverFrame back(pyramid.Base, Side::Back);
    const glm::dvec3 areaVector = glm::cross(pyramid.Base.EdgeX, pyramid.Base.EdgeY);
    EXPECT_GT(glm::dot(front.GetNormal(), areaVector), 0.0) << seed;
    EXPECT_EQ(front.GetNormal(), -back.GetNormal()) << seed;
    EXPECT_EQ(front.GetSize(), back.GetSize()) << seed;
    EXPECT_EQ(
      front.ToFrame(pyramid.Point) * glm::dvec3(1.0, 1.0, -1.0), back.ToFrame(pyramid.Point))
      << seed;
  }
}

TEST(ReceiverFrame, IsInvalidWithoutAnArea)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), zero(0.0);
  EXPECT_FALSE(ReceiverFrame().IsValid());
  EXPECT_TRUE(ReceiverFrame({ zero, x, y }, Side::Front).IsValid());
  EXPECT_FALSE(ReceiverFrame({ zero, x, x }, Side::Front).IsValid());
  EXPECT_FALSE(ReceiverFrame({ zero, x, -2.0 * x }, Side::Front).IsValid());
  EXPECT_FALSE(ReceiverFrame({ zero, x, zero }, Side::Back).IsValid());
  for (const double bad : { nan, infinity, -infinity })
  {
    EXPECT_FALSE(ReceiverFrame({ { 0.0, bad, 0.0 }, x, y }, Side::Front).IsValid());
    EXPECT_FALSE(ReceiverFrame({ zero, { bad, 0.0, 0.0 }, y }, Side::Front).IsValid());
    EXPECT_FALSE(ReceiverFrame({ zero, x, { 0.0, 1.0, bad } }, Side::Front).IsValid());
  }
}

TEST(ReceiverFrame, MetricFramePreservesDistancesAndAngles)
{
  LargestDeviation largest;
  RandomGeometry random(2);
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const ReceiverFrame& frame = pyramid.Frame;
    const double s = frame.GetSize();
    const glm::dvec3 p = pyramid.Point;
    const glm::dvec3 q = p + s * random.InBox(2.0);
    const glm::dvec3 r = p + s * random.InBox(2.0);
    const glm::dvec3 toQ = s * (frame.ToMetric(q) - frame.ToMetric(p));
    const glm::dvec3 toR = s * (frame.ToMetric(r) - frame.ToMetric(p));
    // Equal inner products are equal lengths and equal angles. Each factor is a difference of
    // points, which are off by roundings of their own size.
    const double distant = glm::length(p) + glm::length(q) + glm::length(r) + 10.0;
    EXPECT_LE(largest.Add(glm::dot(toQ, toQ) - glm::dot(q - p, q - p), s * distant), Tolerance);
    EXPECT_LE(largest.Add(glm::dot(toQ, toR) - glm::dot(q - p, r - p), s * distant), Tolerance);
    // Not mirrored, either.
    EXPECT_GT(
      glm::dot(glm::cross(toQ, toR), s * frame.DirectionToMetric(glm::cross(q - p, r - p))), 0.0);
  }
}

TEST(ReceiverFrame, MetricFrameStandsInTheCentreOnTheReceiver)
{
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const ReceiverFrame& frame = pyramid.Frame;
    const double s = frame.GetSize();
    const double tolerance = Tolerance * (1.0 + 20.0 / s); // the world's coordinates are below 20
    const glm::dvec3 centre = frame.ToMetric(frame.ToWorld({ 0.5, 0.5, 0.0 }));
    EXPECT_LE(glm::length(centre), tolerance) << seed;
    const glm::dvec3 along = frame.DirectionToMetric(pyramid.Base.EdgeX);
    EXPECT_LE(
      glm::length(along - glm::dvec3(glm::length(pyramid.Base.EdgeX) / s, 0.0, 0.0)), tolerance);
    const glm::dvec3 up = frame.DirectionToMetric(s * frame.GetNormal());
    EXPECT_LE(glm::length(up - glm::dvec3(0.0, 0.0, 1.0)), tolerance) << seed;
    EXPECT_NEAR(frame.ToMetric(pyramid.Apex).z, frame.ToFrame(pyramid.Apex).z, tolerance * 10.0);
  }
}

// Points, corner and edges are multiples of 2^-20 below 2^4, so that adding 1e7 (24 bits) to a
// coordinate is exact in the 53 bits of a double: nothing may change, not even by a rounding.
TEST(ReceiverFrame, FarFromTheOriginIsAsGoodAsNear)
{
  const auto onLattice = [](const glm::dvec3& p) { return glm::floor(p * 0x1p20) * 0x1p-20; };
  const glm::dvec3 away(1e7, -1e7, 1e7);
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    Pyramid pyramid = RandomPyramid(seed);
    RandomGeometry random(seed + 1);
    pyramid.Base = { onLattice(pyramid.Base.Corner), onLattice(pyramid.Base.EdgeX),
      onLattice(pyramid.Base.EdgeY) };
    const glm::dvec3 point = onLattice(random.InBox(10.0));
    const ReceiverFrame nearby(pyramid.Base, Side::Front);
    const ReceiverFrame distant(
      { pyramid.Base.Corner + away, pyramid.Base.EdgeX, pyramid.Base.EdgeY }, Side::Front);
    ASSERT_TRUE(distant.IsValid());
    EXPECT_EQ(nearby.ToFrame(point), distant.ToFrame(point + away)) << seed;
    EXPECT_EQ(nearby.ToMetric(point), distant.ToMetric(point + away)) << seed;
  }
}

TEST(RegisteredProjection, EqualsHeckbertAndHerfsMatrix)
{
  LargestDeviation largest;
  int inFront = 0, beyond = 0;
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const std::array<Long4, 3> m = HeckbertHerfMatrix(pyramid.Base, pyramid.Apex);
    const Long4 point(Long3(pyramid.Point), 1.0L);
    const Long3 expected(glm::dot(m[0], point), glm::dot(m[1], point), glm::dot(m[2], point));
    const Long3 actual(Project(pyramid));
    const Long3 sizes = SizesOf(pyramid);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_LE(largest.Add(actual[i] - expected[i], sizes[i]), Tolerance) << seed << " " << i;
    }
    ++(actual.z > 0.0 ? inFront : beyond);
  }
  // Both signs of w: in front of the plane through the apex, and beyond it.
  EXPECT_GT(inFront, Pyramids / 4);
  EXPECT_GT(beyond, Pyramids / 4);
}

// x' and y' with w' are the point b + (x'/w') ex + (y'/w') ey of the receiver's plane; times w' it
// is homogeneous and may be compared where w' is 0 or negative. Its scale is 1 / (L.G) of Blinn's.
TEST(RegisteredProjection, EqualsBlinnsProjection)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Pyramids; ++seed)
  {
    const Pyramid pyramid = RandomPyramid(seed);
    const Long3 b(pyramid.Base.Corner), ex(pyramid.Base.EdgeX), ey(pyramid.Base.EdgeY);
    const Long3 n = glm::cross(ex, ey);
    const Long4 plane(n, -glm::dot(n, b));
    const Long4 light(Long3(pyramid.Apex), 1.0L);
    const Long4 expected =
      BlinnShadow(light, plane, Long4(Long3(pyramid.Point), 1.0L)) / glm::dot(light, plane);
    const Long3 p(Project(pyramid));
    const Long4 actual(p.z * b + p.x * ex + p.y * ey, p.z);
    const Long3 sizes = SizesOf(pyramid);
    const long double size =
      sizes.x * glm::length(ex) + sizes.y * glm::length(ey) + sizes.z * glm::length(b);
    EXPECT_LE(largest.Add(glm::length(Long3(actual) - Long3(expected)), size), Tolerance) << seed;
    EXPECT_LE(largest.Add(actual.w - expected.w, sizes.z), Tolerance) << seed;
  }
}

// What makes the projections registered: points of the receiver stay where they are, exactly,
// whatever the sample.
TEST(RegisteredProjection, LeavesTheReceiverWhereItIs)
{
  RandomGeometry random(3);
  for (int i = 0; i < Pyramids; ++i)
  {
    const RegisteredProjection projection = RegisteredProjection::FromPoint(
      { random.Between(-5.0, 5.0), random.Between(-5.0, 5.0), random.Between(0.01, 5.0) });
    const double u = random.Between(-1.0, 2.0);
    const double v = random.Between(-1.0, 2.0);
    EXPECT_EQ(projection.Project({ u, v, 0.0 }), glm::dvec3(u, v, 1.0));
  }
}

// w' is 0 in the plane through the sample that is parallel to the receiver, positive below it.
TEST(RegisteredProjection, DividesSpaceAtTheSamplesHeight)
{
  RandomGeometry random(4);
  for (int i = 0; i < Pyramids; ++i)
  {
    const double height = random.Between(0.01, 5.0);
    const RegisteredProjection projection =
      RegisteredProjection::FromPoint({ random.Between(-5.0, 5.0), 0.0, height });
    EXPECT_GT(projection.Project({ 0.0, 0.0, 0.999 * height }).z, 0.0);
    EXPECT_LT(projection.Project({ 0.0, 0.0, 1.001 * height }).z, 0.0);
    EXPECT_GT(projection.Project({ 0.0, 0.0, -height }).z, 1.0);
  }
}

} // namespace

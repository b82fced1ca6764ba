// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where shadows may fall, and how wide their penumbrae may be: against projections of random points
// of occluders from random points of lights.

#include "DirectionalLight.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "RandomPairs.h"
#include "RegisteredProjection.h"
#include "SegmentLight.h"
#include "ShadowBounds.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace
{

using penumbra::Parallelogram;
using penumbra::PolygonLight;
using penumbra::ReceiverFrame;
using penumbra::RegisteredProjection;
using penumbra::ShadowBounds;
using penumbra::ShadowProjector;
using penumbra::TexelRectangle;
using Side = ReceiverFrame::Side;
using Triangle = std::array<glm::dvec3, 3>;

constexpr int Rounds = 3000;
constexpr int Points = 30;

/// The receiver of the tests with numbers: one unit wide, so that (u, v, h) is (x, y, z).
const ReceiverFrame Unit(Parallelogram(), Side::Front);

/// A lamp of a width over the middle of it.
PolygonLight MakeLamp(double width, double height)
{
  const double low = 0.5 - 0.5 * width, high = 0.5 + 0.5 * width;
  return PolygonLight::Parallelogram(
    { low, low, height }, { low, high, height }, { high, low, height });
}

ShadowBounds FindBounds(
  const ReceiverFrame& frame, const penumbra::LightShape& light, const Triangle& triangle)
{
  const ShadowProjector projector(frame, light);
  ShadowBounds bounds;
  for (const glm::dvec3& p : triangle)
  {
    projector.Add(p, bounds);
  }
  return bounds;
}

/// Where a point's shadow falls; nowhere, if it is not between receiver and sample.
std::optional<glm::dvec2> Project(
  const ReceiverFrame& frame, const penumbra::LightSample& sample, const glm::dvec3& point)
{
  const glm::dvec3 place =
    sample.IsDirection ? frame.DirectionToFrame(sample.Place) : frame.ToFrame(sample.Place);
  const RegisteredProjection projection = sample.IsDirection
    ? RegisteredProjection::FromDirection(place)
    : RegisteredProjection::FromPoint(place);
  const glm::dvec3 p = projection.Project(point);
  return point.z > 0.0 && p.z > 0.0 ? std::optional<glm::dvec2>(glm::dvec2(p) / p.z) : std::nullopt;
}

/// Large or small, some of it perhaps below the receiver or over the light.
Triangle RandomTriangle(RandomGeometry& random, const RandomPair& pair)
{
  const double size = std::pow(10.0, random.Between(-3.0, 0.5));
  const glm::dvec3 centre = RandomPointOnRay(random, pair);
  return { centre + random.InBox(size), centre + random.InBox(size), centre + random.InBox(size) };
}

glm::dvec3 RandomPointOf(RandomGeometry& random, const Triangle& t)
{
  const double a = random.Between(0.0, 1.0), b = random.Between(0.0, 1.0 - a);
  return t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
}

// Projections are good to some roundings, times 1024 where w' is least, and so are lights' corners.
constexpr double Rounding = 1e-9;

bool Holds(const ShadowBounds& bounds, const glm::dvec2& place)
{
  const glm::dvec2 rounding = Rounding * (1.0 + glm::abs(place));
  return bounds.IsUnbounded ||
    (glm::all(glm::greaterThanEqual(place, bounds.Low - rounding)) &&
      glm::all(glm::lessThanEqual(place, bounds.High + rounding)));
}

} // namespace

TEST(ShadowBounds, HoldEveryShadow)
{
  int bounded = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, RandomNearFrame);
    const Triangle triangle = RandomTriangle(random, pair);
    const ShadowBounds bounds = FindBounds(pair.Frame, *pair.Seen, triangle);
    for (int i = 0; i < Points; ++i)
    {
      const std::optional<glm::dvec2> place =
        Project(pair.Frame, RandomSample(random, *pair.Seen), RandomPointOf(random, triangle));
      EXPECT_TRUE(!place || Holds(bounds, *place)) << seed;
      bounded += place && !bounds.IsUnbounded ? 1 : 0;
    }
  }
  EXPECT_GT(bounded, Rounds * Points / 10);
}

// The penumbra of an edge is what is between the shadows that its points have from all of the
// light.
TEST(ShadowBounds, HoldEveryPenumbra)
{
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, RandomNearFrame);
    Triangle triangle = RandomTriangle(random, pair);
    // Many edges stand on the receiver.
    triangle[1].z = random.Below(2) == 0 ? 0.0 : triangle[1].z;
    const ShadowBounds bounds = FindBounds(pair.Frame, *pair.Seen, triangle);
    for (int i = 0; i < Points && !bounds.IsUnbounded; ++i)
    {
      const glm::dvec3 p = glm::mix(triangle[0], triangle[1], random.Between(0.0, 1.0));
      const std::optional<glm::dvec2> a = Project(pair.Frame, RandomSample(random, *pair.Seen), p);
      const std::optional<glm::dvec2> b = Project(pair.Frame, RandomSample(random, *pair.Seen), p);
      if (a && b)
      {
        const glm::dvec2 rounding = Rounding * (1.0 + glm::abs(*a) + glm::abs(*b));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(*a - *b), bounds.Penumbra + rounding)))
          << seed;
      }
    }
  }
}

// An upright light: both ends of an edge have no penumbra, one of them right below the light, the
// other one on the receiver, but what is between them has one.
TEST(ShadowBounds, HoldPenumbraeBetweenSharpEnds)
{
  const penumbra::SegmentLight light({ 0.0, 0.0, 2.0 }, { 0.0, 0.0, 4.0 });
  const glm::dvec3 below(0.0, 0.0, 1.0), on(1.0, 0.0, 0.0);
  const ShadowBounds bounds = FindBounds(Unit, light, { below, on, on });
  // From (0.5, 0, 0.5), the ends' shadows are at 0.5 * 2 / 1.5 and 0.5 * 4 / 3.5.
  EXPECT_GE(bounds.Penumbra.x, 1.0 / 1.5 - 2.0 / 3.5);
}

// Similar triangles: an edge at the height h under a lamp of the width L at the height H has a
// penumbra of L h / (H - h); and no more is said of lamps that are parallel to the receiver.
TEST(ShadowBounds, KnowPenumbraeUnderAFlatLamp)
{
  const PolygonLight lamp = MakeLamp(0.2, 2.0);
  const ShadowBounds bounds =
    FindBounds(Unit, lamp, { { { 0.3, 0.3, 0.5 }, { 0.7, 0.3, 0.5 }, { 0.3, 0.7, 0.5 } } });
  const double width = 0.2 * 0.5 / 1.5;
  EXPECT_NEAR(bounds.Penumbra.x, width, 1e-12);
  EXPECT_NEAR(bounds.Penumbra.y, width, 1e-12);
  EXPECT_NEAR(bounds.GetPenumbraTexels({ 100, 100 }), 100.0 * std::sqrt(2.0) * width, 1e-10);
}

TEST(ShadowBounds, OfPointsAndSunsWithoutSizeHaveNoPenumbra)
{
  const Triangle triangle{ { { 0.3, 0.3, 0.5 }, { 0.7, 0.3, 0.2 }, { 0.3, 0.7, 0.9 } } };
  EXPECT_EQ(
    FindBounds(Unit, penumbra::PointLight({ 0.1, 0.2, 2.0 }), triangle).Penumbra, glm::dvec2(0.0));
  EXPECT_EQ(FindBounds(Unit, penumbra::DirectionalLight({ 1, 1, -1 }, 0.0), triangle).Penumbra,
    glm::dvec2(0.0));
}

TEST(ShadowBounds, EndBelowTheLightsHeight)
{
  const PolygonLight lamp = MakeLamp(0.2, 2.0);
  const auto isUnbounded = [&](double height)
  {
    const glm::dvec3 p(0.5, 0.5, height);
    return FindBounds(Unit, lamp, { p, p, p }).IsUnbounded;
  };
  EXPECT_FALSE(isUnbounded(1.0));
  EXPECT_FALSE(isUnbounded(2.0 * (1.0 - 1.0 / 512)));
  EXPECT_TRUE(isUnbounded(2.0 * (1.0 - 1.0 / 2048)));
  EXPECT_TRUE(isUnbounded(2.0));
  EXPECT_TRUE(isUnbounded(3.0));
}

TEST(ShadowBounds, OfALightAtTheHorizonAreAnywhere)
{
  const PolygonLight wall = PolygonLight::Parallelogram({ 2, 0, 0 }, { 2, 1, 0 }, { 2, 0, 1 });
  const glm::dvec3 p(0.5, 0.5, 0.1);
  const ShadowBounds bounds = FindBounds(Unit, wall, { p, p, p });
  EXPECT_TRUE(bounds.IsUnbounded);
  EXPECT_EQ(bounds.GetTexels({ 7, 5 }), (TexelRectangle{ { 0, 0 }, { 7, 5 } }));
  EXPECT_EQ(bounds.GetPenumbraTexels({ 7, 5 }), std::numeric_limits<double>::infinity());
}

// With one texel around them for the rasteriser.
TEST(ShadowBounds, BecomeTexels)
{
  const penumbra::PointLight light({ 0.5, 0.5, 1.0 });
  const auto find = [&](const glm::dvec3& p) {
    return FindBounds(Unit, light, { p, p, p }).GetTexels({ 10, 20 });
  };
  EXPECT_EQ(find({ 0.5, 0.5, 0.5 }), (TexelRectangle{ { 4, 9 }, { 6, 11 } }));
  EXPECT_EQ(find({ 0.31, 0.5, 0.5 }), (TexelRectangle{ { 0, 9 }, { 3, 11 } })); // at (0.12, 0.5)
  EXPECT_TRUE(find({ 0.1, 0.5, 0.5 }).IsEmpty());                               // at (-0.3, 0.5)
  EXPECT_TRUE(find({ 1e12, 0.5, 0.5 }).IsEmpty());
  EXPECT_TRUE(ShadowBounds().GetTexels({ 10, 20 }).IsEmpty());
}

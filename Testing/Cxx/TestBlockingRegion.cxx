// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The region that holds all rays from a receiver, or a part of it, to a light: in its frame and as
// planes in the world.

#include "BlockingRegion.h"
#include "ClusterTree.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "RandomPairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

using penumbra::BlockingRegion;
using penumbra::Box;
using penumbra::ClusterTree;
using penumbra::ConvexRegion;
using penumbra::Light;
using penumbra::Parallelogram;
using penumbra::ReceiverFrame;
using Side = ReceiverFrame::Side;

constexpr int Regions = 2000;

bool Holds(const BlockingRegion& region, const glm::dvec3& p)
{
  return region.MayHold(p, p, p);
}

// As a query of occluders does it.
bool Holds(const ConvexRegion& region, const glm::dvec3& world)
{
  Box box;
  box.Add(world);
  bool isFound = false;
  ClusterTree({ box }).Visit(region, [&](const ClusterTree::Items&) { isFound = true; });
  return isFound;
}

TEST(BlockingRegion, HoldsEveryRay)
{
  for (unsigned seed = 0; seed < Regions; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random);
    const BlockingRegion region(pair.Frame, *pair.Seen, pair.Range);
    const ConvexRegion planes = region.GetWorldPlanes();
    for (int i = 0; i < 50; ++i)
    {
      const glm::dvec3 p = RandomPointOnRay(random, pair);
      EXPECT_TRUE(Holds(region, p)) << seed;
      EXPECT_TRUE(Holds(planes, pair.Frame.ToWorld(p))) << seed;
    }
  }
}

// Points where the region ends: the planes must not lose any that is inside, nor keep what is
// clearly outside, by 1e-6 in any direction. World coordinates are up to 1e4 receivers large, good
// to 1e-12 of one, and rays that rise by less than 1 in 1e3 have no place here.
TEST(BlockingRegion, HasTheSamePlanesInTheWorld)
{
  constexpr double Clearly = 1e-6;
  int inside = 0, outside = 0;
  for (unsigned seed = 0; seed < Regions; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random);
    const BlockingRegion region(pair.Frame, *pair.Seen, pair.Range);
    const ConvexRegion planes = region.GetWorldPlanes();
    for (int i = 0; i < 50; ++i)
    {
      // World coordinates round, so it is the rounded point that both are asked about.
      const glm::dvec3 nearby =
        RandomPointOnRay(random, pair) + random.InBox(std::pow(10.0, random.Between(-8.0, 1.0)));
      const glm::dvec3 world = pair.Frame.ToWorld(nearby);
      const glm::dvec3 p = pair.Frame.ToFrame(world);
      bool isNearInside = false;
      for (int axis = 0; axis < 6; ++axis)
      {
        glm::dvec3 step(0.0);
        step[axis / 2] = (axis % 2 == 0 ? 1.0 : -1.0) * Clearly * (1.0 + glm::length(p));
        isNearInside = isNearInside || Holds(region, p + step);
      }
      if (Holds(region, p))
      {
        ++inside;
        EXPECT_TRUE(Holds(planes, world)) << seed;
      }
      else if (!isNearInside)
      {
        ++outside;
        EXPECT_FALSE(Holds(planes, world)) << seed;
      }
    }
  }
  EXPECT_GT(inside, 50 * Regions / 20);
  EXPECT_GT(outside, 50 * Regions / 20);
}

// Where MayHold() ends, found by halving the way from a ray to somewhere else until doubles end.
TEST(BlockingRegion, HoldsInTheWorldWhateverItMayHold)
{
  for (unsigned seed = 0; seed < Regions; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random);
    const BlockingRegion region(pair.Frame, *pair.Seen, pair.Range);
    const ConvexRegion planes = region.GetWorldPlanes();
    for (int i = 0; i < 10; ++i)
    {
      glm::dvec3 inside = pair.Frame.ToWorld(RandomPointOnRay(random, pair));
      glm::dvec3 other = pair.Frame.ToWorld(random.InBox(10.0));
      for (int halving = 0; halving < 60; ++halving)
      {
        const glm::dvec3 middle = 0.5 * (inside + other);
        (Holds(region, pair.Frame.ToFrame(middle)) ? inside : other) = middle;
      }
      EXPECT_TRUE(Holds(planes, inside)) << seed;
    }
  }
}

// Each side is as near as it may be: some ray from the edge of the range to a corner of the light
// leaves the region when it is moved outwards.
TEST(BlockingRegion, IsTight)
{
  constexpr double Step = 1e-6;
  for (unsigned seed = 0; seed < Regions; ++seed)
  {
    RandomGeometry random(seed);
    const ReceiverFrame frame = RandomFrame(random);
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 3; ++i)
    {
      corners.push_back(random.InBox(2.0) + glm::dvec3(0.5, 0.5, 2.5));
    }
    const Light light = penumbra::PolygonLight::Triangle(
      frame.ToWorld(corners[0]), frame.ToWorld(corners[1]), frame.ToWorld(corners[2]));
    const glm::dvec4 range = RandomPair(random).Range;
    const BlockingRegion region(frame, *light, range);
    for (int side = 0; side < 4; ++side)
    {
      const int axis = side % 2;
      glm::dvec3 start(range.x, range.y, 0.0);
      start[axis] = range[side];
      glm::dvec3 outwards(0.0);
      outwards[axis] = side < 2 ? -Step : Step;
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
        [&](const glm::dvec3& corner)
        { return !Holds(region, glm::mix(start, corner, 0.5) + outwards); }))
        << seed << " " << side;
    }
  }
}

TEST(BlockingRegion, HoldsNothingWithoutALight)
{
  const ReceiverFrame frame(Parallelogram(), Side::Front);
  const Light below = penumbra::PointLight({ 0.5, 0.5, -1.0 });
  const BlockingRegion region(frame, *below);
  RandomGeometry random(1);
  for (int i = 0; i < 100; ++i)
  {
    EXPECT_FALSE(Holds(region.GetWorldPlanes(), random.InBox(2.0)));
  }
}

} // namespace

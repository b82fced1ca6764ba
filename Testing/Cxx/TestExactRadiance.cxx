// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Proves the oracle by other means than its own: textbook values, a brute-force quadrature that
// casts rays, and identities that any exact answer obeys.

#include "ExactRadiance.h"
#include "OracleTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace
{

using oracle::Cross;
using oracle::Dot;
using oracle::FormFactor;
using oracle::Length;
using oracle::Light;
using oracle::Parallelogram;
using oracle::Polygon;
using oracle::Triangle;
using oracle::Vec3;
using oracle::VisibleFormFactor;

using namespace oracletest;

// A parallelogram light, or its triangle at the corner, with occluders. These reach through the
// receiver's plane and through the light's plane, the normal leans so far that the horizon cuts
// many of the lights, and one point in five is behind its light.
struct Scene
{
  Vec3 X, N;
  Vec3 Corner, Edge1, Edge2;
  bool IsTriangle;
  Occluders Blockers;
  Light Emitter;

  Vec3 At(long double u, long double v) const
  {
    return this->Corner + u * this->Edge1 + v * this->Edge2;
  }
};

Scene RandomScene(unsigned seed)
{
  Random random(seed);
  Scene scene;
  const bool isBehind = seed % 5 == 4;
  scene.X = random.InBox(isBehind ? Vec3{ 0, 0, 2 } : Origin, 0.3);
  scene.N = random.InBox(isBehind ? -1 * Up : Up, 1.0);
  scene.Corner = random.InBox({ -0.5, -0.5, 1 }, 0.2);
  // In this order the light faces down, towards the receiver.
  scene.Edge1 = random.InBox({ 0, 1, 0 }, 0.4);
  scene.Edge2 = random.InBox({ 1, 0, 0 }, 0.4);
  scene.IsTriangle = seed % 3 == 0;
  scene.Blockers = RandomTriangles(random, 1 + static_cast<int>(seed % 12));
  scene.Emitter.Vertices = Parallelogram(scene.At(0, 0), scene.At(1, 0), scene.At(0, 1));
  if (scene.IsTriangle)
  {
    scene.Emitter.Vertices = { scene.At(0, 0), scene.At(1, 0), scene.At(0, 1) };
  }
  scene.Emitter.TwoSided = seed % 2 == 0;
  return scene;
}

// The integrand of the form factor times the light's Jacobian, at one point of its parallelogram.
long double Integrand(const Scene& scene, long double u, long double v)
{
  if (scene.IsTriangle && u + v > 1)
  {
    return 0;
  }
  const Vec3 y = scene.At(u, v);
  const Vec3 r = y - scene.X;
  const long double up = Dot(r, scene.N) / Length(scene.N);
  const long double facing = -Dot(r, Cross(scene.Edge1, scene.Edge2));
  if (up <= 0 || (facing <= 0 && !scene.Emitter.TwoSided))
  {
    return 0;
  }
  return Blocks(scene.Blockers, scene.X, y) ? 0
                                            : up * std::abs(facing) / (Pi * Dot(r, r) * Dot(r, r));
}

// A sphere of 2 (stacks - 1) slices triangles.
Occluders Sphere(const Vec3& centre, long double radius, int stacks, int slices)
{
  const auto at = [&](int stack, int slice)
  {
    const long double theta = Pi * stack / stacks;
    const long double phi = 2 * Pi * (slice % slices) / slices;
    const Vec3 unit = { std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
      std::cos(theta) };
    return centre + radius * unit;
  };
  Occluders triangles;
  for (int slice = 0; slice < slices; ++slice)
  {
    triangles.push_back({ at(0, 0), at(1, slice), at(1, slice + 1) });
    triangles.push_back({ at(stacks, 0), at(stacks - 1, slice + 1), at(stacks - 1, slice) });
    for (int stack = 1; stack < stacks - 1; ++stack)
    {
      triangles.push_back({ at(stack, slice), at(stack + 1, slice), at(stack + 1, slice + 1) });
      triangles.push_back({ at(stack, slice), at(stack + 1, slice + 1), at(stack, slice + 1) });
    }
  }
  return triangles;
}

} // namespace

// ---- Textbook values ----

// Siegel and Howell, Thermal Radiation Heat Transfer, after Hamilton and Morgan 1952: a rectangle a
// x b parallel to the element at distance c, one corner on the element's normal.
TEST(ExactRadiance, ParallelRectangleAboveElement)
{
  Random random(1);
  Largest largest("LargestRelativeDeviation");
  for (int i = 0; i < 100; ++i)
  {
    const long double a = random.Between(0.1, 5), b = random.Between(0.1, 5);
    const long double c = random.Between(0.1, 5);
    const long double x = a / c, y = b / c;
    const long double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    const long double expected = (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * Pi);
    Light light;
    light.Vertices = Parallelogram({ 0, 0, c }, { 0, b, c }, { a, 0, c });
    EXPECT_LE(largest.Add(FormFactor(Origin, Up, light) / expected - 1), Rounding);
  }
}

// From the same source: a rectangle b wide and a high, standing on the element's plane at distance
// c, one lower corner in front of the element.
TEST(ExactRadiance, PerpendicularRectangleInFrontOfElement)
{
  Random random(2);
  Largest largest("LargestRelativeDeviation");
  for (int i = 0; i < 100; ++i)
  {
    const long double a = random.Between(0.1, 5), b = random.Between(0.1, 5);
    const long double c = random.Between(0.1, 5);
    const long double x = a / b, y = c / b;
    const long double r = std::sqrt(x * x + y * y);
    const long double expected = (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * Pi);
    Light light;
    light.Vertices = Parallelogram({ 0, c, 0 }, { b, c, 0 }, { 0, c, a });
    EXPECT_LE(largest.Add(FormFactor(Origin, Up, light) / expected - 1), Rounding);
    // What is added under the horizon gives no light.
    light.Vertices = Parallelogram({ 0, c, -a }, { b, c, -a }, { 0, c, a });
    EXPECT_LE(largest.Add(FormFactor(Origin, Up, light) / expected - 1), Rounding);
  }
}

// A coaxial disk has F = R^2 / (R^2 + h^2); polygons inside and around it bound it from both sides.
TEST(ExactRadiance, PolygonsEncloseDisk)
{
  constexpr int sides = 1000;
  const long double radius = 0.7L, height = 1.3L;
  const auto formFactor = [&](long double r)
  {
    Light light;
    for (int i = 0; i < sides; ++i)
    {
      const long double angle = -2 * Pi * i / sides;
      light.Vertices.push_back({ r * std::cos(angle), r * std::sin(angle), height });
    }
    return FormFactor(Origin, Up, light);
  };
  const long double disk = radius * radius / (radius * radius + height * height);
  EXPECT_LT(formFactor(radius), disk);
  EXPECT_GT(formFactor(radius / std::cos(Pi / sides)), disk);
  // The areas of the two differ by pi^2 / sides^2, about 1e-5; the form factors by less.
  EXPECT_NEAR(static_cast<double>(formFactor(radius) / disk), 1, 1e-5);
}

// Whatever the direction of the normal, a closed room fills its hemisphere.
TEST(ExactRadiance, EnclosureSumsToOne)
{
  Random random(3);
  Largest largest("LargestDeviation");
  const Vec3 axes[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 x = random.InBox(Origin, 0.9);
    const Vec3 n = random.InBox(Origin, 1);
    long double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vec3 u = axes[(axis + 1) % 3], v = axes[(axis + 2) % 3];
      const Vec3 low = Origin - axes[axis] - u - v;
      const Vec3 high = axes[axis] - u - v;
      Light floor, ceiling;
      floor.Vertices = Parallelogram(low, low + 2 * u, low + 2 * v);
      ceiling.Vertices = Parallelogram(high, high + 2 * v, high + 2 * u);
      sum += FormFactor(x, n, floor) + FormFactor(x, n, ceiling);
    }
    EXPECT_LE(largest.Add(sum - 1), Rounding);
  }
}

// From afar a light of width l acts as a point: area cos t cos t' / (pi r^2) at its centre. The
// first order cancels there, and for cosines above 0.3 the second is below 10 (l / r)^2.
TEST(ExactRadiance, TinyLightIsPoint)
{
  Random random(4);
  constexpr double width = 1e-4;
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 centre = random.InBox({ 0, 0, 2 }, 0.8);
    const Vec3 u = width * random.InBox({ 0, 0.5, 0 }, 0.1);
    const Vec3 v = width * random.InBox({ 0.5, 0, 0 }, 0.1);
    Light light;
    light.Vertices = Parallelogram(
      centre - 0.5L * u - 0.5L * v, centre + 0.5L * u - 0.5L * v, centre - 0.5L * u + 0.5L * v);
    const long double r2 = Dot(centre, centre);
    const long double cosines = Dot(Up, centre) * -Dot(Cross(u, v), centre);
    const long double expected = cosines / (Pi * r2 * r2);
    EXPECT_NEAR(static_cast<double>(FormFactor(Origin, Up, light) / expected), 1,
      10 * width * width / static_cast<double>(r2));
  }
}

TEST(ExactRadiance, SidesOfLight)
{
  Light light = Ceiling(1, 1);
  const long double below = FormFactor(Origin, Up, light);
  const Vec3 above = { 0, 0, 2 };
  const Vec3 down = { 0, 0, -3 };
  EXPECT_GT(below, 0);
  EXPECT_EQ(FormFactor(above, down, light), 0);
  EXPECT_EQ(FormFactor(Origin, down, light), 0);
  EXPECT_EQ(FormFactor({ 3, 0, 1 }, Up, light), 0);
  light.TwoSided = true;
  EXPECT_EQ(FormFactor(Origin, Up, light), below);
  EXPECT_LE(std::abs(FormFactor(above, down, light) - below), Rounding);
  EXPECT_EQ(FormFactor({ 3, 0, 1 }, Up, light), 0);
}

// ---- Occlusion, by other means ----

// A plate at half the height takes from the light what the plate would emit in its stead.
TEST(ExactRadiance, PlateTakesItsOwnFormFactor)
{
  const Light light = Ceiling(1, 1);
  const long double expected =
    FormFactor(Origin, Up, light) - FormFactor(Origin, Up, Ceiling(0.3L, 0.5L));
  EXPECT_LE(std::abs(VisibleFormFactor(Origin, Up, light, Plate(0.3L, 0.5L)) - expected), Rounding);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, light, Plate(0.6L, 0.5L)), 0);
}

// A wall through the light's plane hides the half of the light behind it, up to that plane.
TEST(ExactRadiance, WallHidesHalfOfLight)
{
  const Light light = Ceiling(1, 1);
  const Vec3 x = { -0.5L, 0, 0 };
  const Occluders wall = { { { 0, -50, -1 }, { 0, 50, -1 }, { 0, 0, 50 } } };
  Light half;
  half.Vertices = Parallelogram({ -1, -1, 1 }, { -1, 1, 1 }, { 0, -1, 1 });
  EXPECT_LE(std::abs(VisibleFormFactor(x, Up, light, wall) - FormFactor(x, Up, half)), Rounding);
}

// The tolerance is 5 standard errors, as the samples themselves give them: one false alarm in 1.7
// million. Over S scenes the mean square of deviation / error is 1 for an unbiased oracle, with a
// spread of sqrt(2 / S); 5 spreads above catch a bias far below the error of a single scene.
TEST(ExactRadiance, AgreesWithQuadrature)
{
  constexpr int scenes = 120;
  constexpr int cellsPerSide = 150;
  Random random(5);
  Largest largest("LargestDeviation"), largestError("LargestStandardError");
  long double sumOfSquares = 0;
  int compared = 0;
  for (unsigned seed = 0; seed < scenes; ++seed)
  {
    const Scene scene = RandomScene(seed);
    const Estimate estimate = Quadrature(
      [&](long double u, long double v) { return Integrand(scene, u, v); }, cellsPerSide, random);
    const long double exact = VisibleFormFactor(scene.X, scene.N, scene.Emitter, scene.Blockers);
    const long double deviation = largest.Add(exact - estimate.Mean);
    largestError.Add(estimate.StandardError);
    EXPECT_LE(deviation, 5 * estimate.StandardError + Rounding) << "scene " << seed;
    if (estimate.StandardError > 0)
    {
      sumOfSquares += std::pow(deviation / estimate.StandardError, 2.0L);
      ++compared;
    }
  }
  EXPECT_GT(compared, scenes / 2);
  EXPECT_LT(sumOfSquares / compared, 1 + 5 * std::sqrt(2.0L / compared));
}

// The scenes of these tests hold the cases they are meant to hold.
TEST(ExactRadiance, ScenesAreHard)
{
  int horizonCutsLight = 0, behindLight = 0, partlyHidden = 0, throughLightPlane = 0;
  for (unsigned seed = 0; seed < 120; ++seed)
  {
    const Scene scene = RandomScene(seed);
    const Polygon& light = scene.Emitter.Vertices;
    const auto isUp = [&](const Vec3& y) { return Dot(scene.N, y - scene.X) > 0; };
    const auto isInFront = [&](const Vec3& y)
    { return Dot(Cross(scene.Edge1, scene.Edge2), y - scene.Corner) > 0; };
    const auto risen = std::count_if(light.begin(), light.end(), isUp);
    horizonCutsLight += risen > 0 && risen < static_cast<std::ptrdiff_t>(light.size());
    behindLight += !isInFront(scene.X);
    throughLightPlane += std::any_of(scene.Blockers.begin(), scene.Blockers.end(),
      [&](const Triangle& t)
      { return isInFront(t.A) != isInFront(t.B) || isInFront(t.A) != isInFront(t.C); });
    const long double whole = FormFactor(scene.X, scene.N, scene.Emitter);
    const long double seen = VisibleFormFactor(scene.X, scene.N, scene.Emitter, scene.Blockers);
    partlyHidden += seen > 0.01L * whole && seen < 0.99L * whole;
  }
  EXPECT_GE(horizonCutsLight, 20);
  EXPECT_GE(behindLight, 20);
  EXPECT_GE(throughLightPlane, 60);
  EXPECT_GE(partlyHidden, 60);
}

// ---- Identities ----

TEST(ExactRadiance, PartsOfLightSumToWhole)
{
  Random random(6);
  Largest largest("LargestRelativeDeviation");
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const Scene scene = RandomScene(seed);
    const Polygon& whole = scene.Emitter.Vertices;
    const long double t = random.Between(0.1, 0.9);
    const Vec3 cut = whole[0] + t * (whole[1] - whole[0]);
    Light first = scene.Emitter, second = scene.Emitter;
    first.Vertices = { whole[0], cut, whole.back() };
    second.Vertices[0] = cut;
    const auto visible = [&](const Light& light)
    { return VisibleFormFactor(scene.X, scene.N, light, scene.Blockers); };
    const long double deviation = visible(first) + visible(second) - visible(scene.Emitter);
    const long double unoccluded = FormFactor(scene.X, scene.N, scene.Emitter);
    if (unoccluded > 0)
    {
      EXPECT_LE(largest.Add(deviation / unoccluded), Rounding) << "scene " << seed;
    }
  }
}

// Splitting occluders, drawing them twice, turning them round and shuffling them all change
// nothing.
TEST(ExactRadiance, OccludersAreASetOfPoints)
{
  Random random(7);
  Largest largest("LargestRelativeDeviation");
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const Scene scene = RandomScene(seed);
    Occluders same;
    for (const Triangle& t : scene.Blockers)
    {
      const Vec3 cut = t.A + random.Between(0.1, 0.9) * (t.B - t.A);
      same.push_back({ t.A, cut, t.C });
      same.push_back({ cut, t.C, t.B });
      same.push_back({ t.B, t.A, t.C });
    }
    std::shuffle(same.begin(), same.end(), random.Engine);
    const auto visible = [&](const Occluders& occluders)
    { return VisibleFormFactor(scene.X, scene.N, scene.Emitter, occluders); };
    const long double deviation = visible(same) - visible(scene.Blockers);
    const long double unoccluded = FormFactor(scene.X, scene.N, scene.Emitter);
    if (unoccluded > 0)
    {
      EXPECT_LE(largest.Add(deviation / unoccluded), Rounding) << "scene " << seed;
    }
  }
}

// On a closed convex mesh, the triangles that face the receiver hide what all of them hide.
TEST(ExactRadiance, BackOfClosedMeshChangesNothing)
{
  const Vec3 centre = { 0.1L, 0, 0.5L };
  const Occluders all = Sphere(centre, 0.3L, 13, 24);
  ASSERT_EQ(all.size(), 576u);
  const Light light = Ceiling(0.4L, 1.2L);
  Largest largest("LargestRelativeDeviation");
  int penumbral = 0;
  for (int i = 0; i < 12; ++i)
  {
    for (int j = 0; j < 12; ++j)
    {
      const Vec3 x = { 0.15L * i - 0.8L, 0.15L * j - 0.8L, 0 };
      Occluders front, back;
      for (const Triangle& t : all)
      {
        const bool faces = Dot(Cross(t.B - t.A, t.C - t.A), x - t.A) > 0;
        (faces ? front : back).push_back(t);
      }
      const long double whole = FormFactor(x, Up, light);
      const long double expected = VisibleFormFactor(x, Up, light, all);
      penumbral += expected > 0 && expected < whole;
      const auto deviation = [&](const Occluders& side)
      { return largest.Add(VisibleFormFactor(x, Up, light, side) / whole - expected / whole); };
      EXPECT_LE(deviation(front), Rounding);
      EXPECT_LE(deviation(back), Rounding);
    }
  }
  EXPECT_GT(penumbral, 20);
}

TEST(ExactRadiance, WhatIsNotBetweenBlocksNothing)
{
  const Light light = Ceiling(1, 1);
  const long double whole = FormFactor(Origin, Up, light);
  const auto expectNothing = [&](const Occluders& occluders)
  { EXPECT_EQ(VisibleFormFactor(Origin, Up, light, occluders), whole); };
  expectNothing(Plate(5, 1.5L));
  expectNothing(Plate(5, -0.5L));
  expectNothing(Plate(5, 0));
  expectNothing(Plate(5, 1));
  // Off the receiver and off the light by one rounding of a double.
  expectNothing(Plate(5, 1e-16L));
  expectNothing(Plate(5, 1 - 1e-16L));
  // Beside the light, seen edge on, without an area, shrunk to a point.
  expectNothing({ { { 3, 3, 0.5L }, { 4, 3, 0.5L }, { 3, 4, 0.5L } } });
  expectNothing({ { { -1, 0, 0.2L }, { 1, 0, 0.2L }, { 0, 0, 0.8L } } });
  expectNothing({ { { -1, 0, 0.5L }, { 0, 0.1L, 0.5L }, { 1, 0.2L, 0.5L } } });
  expectNothing({ { { 0, 0, 0.5L }, { 0, 0, 0.5L }, { 0, 0, 0.5L } } });
  expectNothing({ { Origin, { 1, 0, 0.5L }, { 0, 1, 0.5L } } });
}

// Small triangles in the slanted planes of the receiver and of the light, around x and within the
// light, block nothing although rounding to double lifts them off by a little.
TEST(ExactRadiance, CoplanarTrianglesBlockNothing)
{
  Random random(8);
  const auto rounded = [](const Vec3& v) {
    return Vec3{ static_cast<double>(v.X), static_cast<double>(v.Y), static_cast<double>(v.Z) };
  };
  for (int i = 0; i < 300; ++i)
  {
    const Vec3 corner = random.InBox({ 10, 20, 30 }, 1);
    const Vec3 u = random.InBox({ 1, 0, 0 }, 0.3), v = random.InBox({ 0, 1, 0 }, 0.3);
    const Vec3 shift = random.InBox({ 0, 0, 1 }, 0.2);
    const auto at = [&](long double s, long double t) { return rounded(corner + s * u + t * v); };
    const auto above = [&](long double s, long double t) { return rounded(at(s, t) + shift); };
    const Vec3 x = at(0.5L, 0.5L);
    Light light;
    light.Vertices = Parallelogram(above(0, 0), above(0, 1), above(1, 0));
    const Occluders coplanar = { { at(0.4L, 0.4L), at(0.7L, 0.4L), at(0.5L, 0.7L) },
      { above(0.4L, 0.4L), above(0.401L, 0.4L), above(0.4L, 0.401L) } };
    const long double whole = FormFactor(x, Cross(u, v), light);
    EXPECT_GT(whole, 0);
    EXPECT_EQ(VisibleFormFactor(x, Cross(u, v), light, coplanar), whole);
  }
}

TEST(ExactRadiance, LengthOfNormalIsFree)
{
  const Light light = Ceiling(1, 1);
  const Occluders plate = Plate(0.3L, 0.5L);
  EXPECT_LE(std::abs(VisibleFormFactor(Origin, 7 * Up, light, plate) -
              VisibleFormFactor(Origin, Up, light, plate)),
    Rounding);
}

// ---- Radiance ----

// H&H 1997, eq. 1, channel by channel: two coloured lights, one of them hidden.
TEST(ExactRadiance, RadianceSumsLights)
{
  Light red = Ceiling(1, 1);
  red.Radiance = { 4, 1, 0 };
  Light hidden = Ceiling(1, 3);
  hidden.Radiance = { 0, 0, 100 };
  const Occluders plate = Plate(3, 2);
  const std::array<double, 3> reflectance = { 0.5, 0.25, 1 };
  const std::array<double, 3> ambient = { 0.125, 0, 0.5 };
  const std::array<double, 3> radiance =
    oracle::Radiance(Origin, Up, { red, hidden }, plate, reflectance, ambient);
  const double f = static_cast<double>(FormFactor(Origin, Up, red));
  EXPECT_DOUBLE_EQ(radiance[0], 0.5 * (0.125 + 4 * f));
  EXPECT_DOUBLE_EQ(radiance[1], 0.25 * f);
  EXPECT_DOUBLE_EQ(radiance[2], 0.5);
  EXPECT_EQ(oracle::Radiance(Origin, Up, {}, plate, reflectance, ambient)[2], 0.5);
}

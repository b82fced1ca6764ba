// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Occluders in hard places: on the receiver, in it, below it; at the light, around it, behind it.

#include "StabilityTools.h"
#include "SurfaceLight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace
{

using Texels = std::vector<glm::vec4>;

/// The largest difference of two bakes' irradiance, of the first one's peak.
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

/// The brightest texel whose centre is in the rectangle: it should be dark.
double GetLeak(const TestScene& scene, const glm::dvec2& low, const glm::dvec2& high)
{
  const Texels texels = BakeTexels(scene);
  double leak = 0.0;
  for (int j = 0; j < scene.Texels.y; ++j)
  {
    for (int i = 0; i < scene.Texels.x; ++i)
    {
      const glm::dvec3 x = scene.Base.Corner + (i + 0.5) / scene.Texels.x * scene.Base.EdgeX +
        (j + 0.5) / scene.Texels.y * scene.Base.EdgeY;
      if (glm::all(glm::lessThan(low, glm::dvec2(x))) &&
        glm::all(glm::lessThan(glm::dvec2(x), high)))
      {
        leak = std::max(
          leak, static_cast<double>(texels[static_cast<std::size_t>(j * scene.Texels.x + i)].r));
      }
    }
  }
  return leak;
}

} // namespace

// No light gets in below the box, and its shadow begins at its foot.
TEST(StabilityOccluderAtReceiver, RestingOnIt)
{
  TestScene scene = MakeLampScene();
  scene.Name = "resting box";
  scene.AddBox({ 0.7, -0.31, 0.0 }, { 1.29, 0.33, 0.8 });
  ExpectExactCount(scene);
  ExpectWithin("leak below the resting box", GetLeak(scene, { 0.7, -0.31 }, { 1.29, 0.33 }), 0.0);
  // Behind its foot, the wall hides the light wholly from all that is nearer than the shadow's
  // core is long: 0.8 / (2 - 0.8) of the way from the light's near edge.
  ExpectWithin("leak behind the foot", GetLeak(scene, { 1.28, -0.1 }, { 1.6, 0.1 }), 0.0);
}

TEST(StabilityOccluderAtReceiver, CutByIt)
{
  TestScene scene = MakeLampScene();
  scene.Name = "box cut by the receiver";
  scene.AddBox({ 0.7, -0.31, -0.4 }, { 1.29, 0.33, 0.4 });
  scene.AddPlate({ -1.3, -1.0, -0.5 }, { 0.3, 0.2, 1.1 }, { -0.2, 1.9, 0.3 });
  ExpectExactCount(scene);
  ExpectWithin("leak inside the box", GetLeak(scene, { 0.7, -0.31 }, { 1.29, 0.33 }), 0.0);
}

TEST(StabilityOccluderAtReceiver, CoplanarBlocksNothing)
{
  TestScene flat = MakeLampScene();
  const Texels unblocked = BakeTexels(flat);
  flat.AddPlate({ -0.7, -0.6, 0.0 }, { 1.1, 0.1, 0.0 }, { -0.1, 1.3, 0.0 });
  ExpectWithin("coplanar plate", GetDifference(unblocked, BakeTexels(flat)), 0.0);

  TestScene slanted = MakeLampScene();
  slanted.Base = { { -2.1, -1.7, -0.6 }, { 4.0, 0.3, 0.7 }, { -0.3, 4.0, 0.1 } };
  const Texels plain = BakeTexels(slanted);
  slanted.AddPlate(slanted.Base.Corner + 0.31 * slanted.Base.EdgeX + 0.27 * slanted.Base.EdgeY,
    0.37 * slanted.Base.EdgeX, 0.43 * slanted.Base.EdgeY);
  ExpectWithin("coplanar plate, slanted", GetDifference(plain, BakeTexels(slanted)), 0.0);
}

TEST(StabilityOccluderAtReceiver, AHairAbove)
{
  for (const int exponent : { 5, 6, 7, 8, 9, 12 })
  {
    TestScene scene = MakeLampScene();
    scene.Name = "plate at height 1e-" + std::to_string(exponent);
    const double h = 4.0 * std::pow(10.0, -exponent); // 4: the receiver's size
    scene.AddPlate({ -0.67, -0.61, h }, { 1.1, 0.1, 0.0 }, { -0.1, 1.3, 0.0 });
    ExpectExactCount(scene);
  }
}

TEST(StabilityOccluderAtReceiver, BelowBlocksNothing)
{
  for (const double depth : { 1e-9, 1e-3, 1.0 })
  {
    TestScene scene = MakeLampScene();
    const Texels unblocked = BakeTexels(scene);
    scene.AddPlate({ -0.67, -0.61, -depth }, { 1.1, 0.1, 0.0 }, { -0.1, 1.3, -depth });
    ExpectWithin("plate below", GetDifference(unblocked, BakeTexels(scene)), 0.0);
  }
}

// A ceiling that a lamp is let into, and one that is cut out around it: neither is in the way. At
// heights that floats hold exactly, and at others.
TEST(StabilityOccluderAtLight, CoplanarBlocksNothing)
{
  for (int i = 0; i < 40; ++i)
  {
    const double h = 1.0 + 0.0503 * i;
    TestScene scene = MakeLampScene();
    scene.Lights.clear();
    scene.AddLight({ -0.5, 0.5, h }, { 0.5, 0.5, h }, { -0.5, -0.5, h });
    const Texels unblocked = BakeTexels(scene);
    scene.AddPlate({ -3.0, -3.0, h }, { 6.0, 0.0, 0.0 }, { 0.0, 6.0, 0.0 });
    std::ostringstream name;
    name << "ceiling in the light's plane at " << h;
    ExpectWithin(name.str(), GetDifference(unblocked, BakeTexels(scene)), 0.0);
  }
}

// A light that is not flat has no plane of its own: its upper half lies in the ceiling.
TEST(StabilityOccluderAtLight, CoplanarWithPartOfALightBlocksNothing)
{
  double largest = 0.0;
  for (int i = 0; i < 40; ++i)
  {
    const double h = 1.0 + 0.0503 * i;
    const auto square = [](double x, double z)
    {
      return penumbra::PolygonLight::Parallelogram(
        { x, 0.5, z }, { x + 0.5, 0.5, z }, { x, -0.5, z });
    };
    TestScene scene = MakeLampScene();
    scene.Lights.clear();
    scene.Lights.emplace_back(penumbra::SurfaceLight({ square(-0.5, 0.7 * h), square(0.0, h) }));
    const Texels unblocked = BakeTexels(scene);
    scene.AddPlate({ -3.0, -3.0, h }, { 6.0, 0.0, 0.0 }, { 0.0, 6.0, 0.0 });
    largest = std::max(largest, GetDifference(unblocked, BakeTexels(scene)));
  }
  ExpectWithin("ceiling in the plane of half a light", largest, 0.0);
}

TEST(StabilityOccluderAtLight, CoplanarAndTiltedBlocksNothing)
{
  for (int i = 0; i < 40; ++i)
  {
    const glm::dvec3 corner(-0.5, 0.5, 2.0 + 0.013 * i);
    const glm::dvec3 x(1.0, 0.01 * i, 1e-6 * std::pow(1.7, i % 20)), y(0.02 * i, -1.0, 0.003 * i);
    TestScene scene = MakeLampScene();
    scene.Lights.clear();
    scene.AddLight(corner, corner + x, corner + y);
    const Texels unblocked = BakeTexels(scene);
    scene.AddPlate(corner - 1.3 * x - 1.1 * y, 3.7 * x, 3.1 * y);
    ExpectWithin("plate in a tilted light's plane " + std::to_string(i),
      GetDifference(unblocked, BakeTexels(scene)), 0.0);
  }
}

// A pane below the lamp, ever closer to it: it hides the part of it that it covers. From 1e-7 of
// the lamp's height on, single precision cannot tell where it is: README, Numerical notes.
TEST(StabilityOccluderAtLight, AHairBelow)
{
  for (const int exponent : { 1, 2, 3, 4, 5, 6 })
  {
    TestScene scene = MakeLampScene();
    scene.Name = "plate below the light by 1e-" + std::to_string(exponent);
    const double gap = 2.0 * std::pow(10.0, -exponent);
    scene.AddPlate({ -0.513, -0.517, 2.0 - gap }, { 0.7, 0.0, 0.0 }, { 0.0, 1.07, 0.0 });
    ExpectExactCount(scene, 0.1);
  }
}

TEST(StabilityOccluderAtLight, Touching)
{
  // A box that hangs from the light, and one that stands beside it and touches its edge.
  TestScene scene = MakeLampScene();
  scene.Name = "box hanging from the light";
  scene.AddBox({ -0.2, -0.3, 1.6 }, { 0.1, 0.2, 2.0 });
  ExpectExactCount(scene);
  TestScene beside = MakeLampScene();
  beside.Name = "box touching the light's edge";
  beside.AddBox({ 0.5, -0.3, 1.3 }, { 0.9, 0.2, 2.4 });
  ExpectExactCount(beside);
}

TEST(StabilityOccluderAtLight, CutByTheLightsPlane)
{
  TestScene scene = MakeLampScene();
  scene.Name = "occluders through the light's plane";
  scene.AddBox({ -0.23, -0.31, 1.7 }, { 0.11, 0.23, 2.3 });
  scene.AddPlate({ 0.2, -0.4, 1.5 }, { 0.2, 0.1, 1.3 }, { -0.1, 0.7, 0.2 });
  ExpectExactCount(scene);
}

TEST(StabilityOccluderAtLight, EnclosingItLeavesNothing)
{
  for (const double gap : { 0.3, 1e-3, 1e-6 })
  {
    TestScene scene = MakeLampScene();
    scene.AddBox({ -0.5 - gap, -0.5 - gap, 2.0 - gap }, { 0.5 + gap, 0.5 + gap, 2.0 + gap });
    std::ostringstream name;
    name << "light out of its box, gap " << gap;
    ExpectWithin(name.str(), GetLeak(scene, { -9.0, -9.0 }, { 9.0, 9.0 }), 0.0);
  }
}

TEST(StabilityOccluderAtLight, BehindItBlocksNothing)
{
  for (const double gap : { 1e-9, 1e-3, 1.0 })
  {
    TestScene scene = MakeLampScene();
    const Texels unblocked = BakeTexels(scene);
    scene.AddPlate({ -3.0, -3.0, 2.0 + gap }, { 6.0, 0.0, 0.0 }, { 0.0, 6.0, gap });
    ExpectWithin("plate behind the light", GetDifference(unblocked, BakeTexels(scene)), 0.0);
  }
}

// Thinner than what separates the samples, and than a texel: some rays meet it.
TEST(StabilityOccluderAtLight, ThinWireBetweenSamples)
{
  for (const double width : { 1e-2, 1e-3 })
  {
    TestScene scene = MakeLampScene();
    std::ostringstream name;
    name << "wire of width " << width;
    scene.Name = name.str();
    scene.AddPlate({ -0.9, 0.013, 1.1 }, { 1.9, 0.1, 0.0 }, { 0.0, width, 0.0 });
    ExpectExactCount(scene);
  }
}

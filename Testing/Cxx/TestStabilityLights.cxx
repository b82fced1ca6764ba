// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Lights in hard places: near the receiver's plane, cut by it, in it, touching it, behind it;
// grazing light.

#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace
{

/// 4, the receiver's size, times 10^-exponent.
double GetHeight(int exponent)
{
  return 4.0 * std::pow(10.0, -exponent);
}

std::string GetName(const std::string& what, int exponent)
{
  return what + " 1e-" + std::to_string(exponent);
}

bool IsDark(const TestScene& scene)
{
  for (const glm::vec4& texel : BakeTexels(scene))
  {
    if (glm::vec3(texel) != glm::vec3(0.0f))
    {
      return false;
    }
  }
  return true;
}

TestScene MakeEmptyScene()
{
  TestScene scene = MakeLampScene();
  scene.Lights.clear();
  return scene;
}

} // namespace

/// The parameter is an exponent of ten.
class StabilityHeight : public testing::TestWithParam<int>
{
};

// A light that lies flat over the receiver, and half as high a plate that hides part of it.
TEST_P(StabilityHeight, FlatLightAndPlateBelowIt)
{
  const double h = GetHeight(this->GetParam());
  TestScene scene = MakeEmptyScene();
  scene.Name = GetName("flat light at height", this->GetParam());
  scene.AddLight({ -1.03, 1.01, h }, { 1.01, 1.01, h }, { -1.03, -1.05, h });
  scene.AddPlate({ -0.27, -0.31, 0.5 * h }, { 1.0, 0.0, 0.0 }, { 0.0, 0.8, 0.0 });
  ExpectExactCount(scene);
}

// A light that leans over the receiver from a height near 0 up, and a box on the floor.
TEST_P(StabilityHeight, SteepLightFromNearThePlane)
{
  const double h = GetHeight(this->GetParam());
  TestScene scene = MakeEmptyScene();
  scene.Name = GetName("steep light from height", this->GetParam());
  scene.AddLight({ 3.0, 1.0, h }, { 3.0, -1.0, h }, { 3.2, 1.0, 2.0 });
  scene.AddBox({ -0.3, -0.4, 0.0 }, { 0.5, 0.4, 0.7 });
  ExpectExactCount(scene);
}

// All of the light is low and far away, and a wall with a hole in it stands between.
TEST_P(StabilityHeight, LowStripBesideTheReceiver)
{
  const double h = GetHeight(this->GetParam());
  TestScene scene = MakeEmptyScene();
  scene.Name = GetName("low strip up to height", this->GetParam());
  scene.AddLight({ 4.0, 1.0, 0.5 * h }, { 4.0, -1.0, 0.5 * h }, { 4.0, 1.0, h });
  scene.AddPlate({ 0.5, -1.0, 0.0 }, { 0.1, 0.7, 0.0 }, { 0.0, 0.0, 1.0 });
  scene.AddPlate({ 0.6, 0.4, 0.0 }, { -0.1, 0.7, 0.0 }, { 0.0, 0.0, 0.3 * h });
  ExpectExactCount(scene);
}

INSTANTIATE_TEST_SUITE_P(Exponents, StabilityHeight, testing::Range(3, 13),
  [](const auto& exponent) { return "Minus" + std::to_string(exponent.param); });

TEST(StabilityLight, CutByThePlane)
{
  for (const double part : { 0.5, 1e-3, 1e-6, 1e-9 })
  {
    // `part` of the light is in front of the plane.
    TestScene scene = MakeEmptyScene();
    std::ostringstream name;
    name << "cut by the plane, " << part << " of it in front";
    scene.Name = name.str();
    scene.AddLight(
      { 3.0, 1.0, part - 1.0 }, { 3.0, -1.0, part - 1.0 }, { 3.5 - part, 1.0, part });
    scene.AddBox({ -0.3, -0.4, 0.0 }, { 0.5, 0.4, 0.7 });
    ExpectExactCount(scene);
  }
}

TEST(StabilityLight, InThePlaneGivesNothing)
{
  TestScene scene = MakeEmptyScene();
  scene.AddLight({ -0.5, 0.5, 0.0 }, { 0.5, 0.5, 0.0 }, { -0.5, -0.5, 0.0 });
  scene.AddBox({ -0.3, -0.4, 0.0 }, { 0.5, 0.4, 0.7 });
  ExpectWithin("light in the plane", IsDark(scene) ? 0.0 : 1.0, 0.0);

  // A slanted plane: the light's corners are in it but for their rounding.
  TestScene slanted = MakeEmptyScene();
  slanted.Base = { { -2.1, -1.7, -0.6 }, { 4.0, 0.3, 0.7 }, { -0.3, 4.0, 0.1 } };
  const auto at = [&](double u, double v)
  { return slanted.Base.Corner + u * slanted.Base.EdgeX + v * slanted.Base.EdgeY; };
  slanted.AddLight(at(0.3, 0.7), at(0.7, 0.7), at(0.3, 0.3));
  slanted.Settings.Side = penumbra::ReceiverSide::Front;
  slanted.AddPlate({ -0.3, -0.3, 0.5 }, { 0.6, 0.0, 0.0 }, { 0.0, 0.6, 0.0 });
  double brightest = 0.0;
  for (const glm::vec4& texel : BakeTexels(slanted))
  {
    ASSERT_TRUE(std::isfinite(texel.r));
    brightest = std::max(brightest, static_cast<double>(texel.r));
  }
  // A point of the receiver that is covered by the light sees it, if rounding has put it above, as
  // a point inside a lamp does: with a form factor of 1. Nothing else gets any: half the plane's
  // light is what the exact answer for these very doubles is, so compare with that.
  const CountError error = CompareWithCount(slanted);
  ExpectWithin("light in a slanted plane", error.Largest, std::max(brightest, 1e-30));
}

TEST(StabilityLight, TouchesThePlaneAtAnEdge)
{
  TestScene scene = MakeEmptyScene();
  scene.Name = "touching at an edge";
  scene.AddLight({ 0.33, 1.0, 0.0 }, { 0.33, -1.0, 0.0 }, { 0.43, 1.0, 1.0 });
  scene.AddBox({ -0.8, -0.4, 0.0 }, { -0.2, 0.4, 0.4 });
  ExpectExactCount(scene);
}

TEST(StabilityLight, TouchesThePlaneAtACorner)
{
  TestScene scene = MakeEmptyScene();
  scene.Name = "touching at a corner";
  scene.Lights.push_back(
    penumbra::PolygonLight::Triangle({ 0.33, 0.03, 0.0 }, { 0.53, -1.0, 1.0 }, { 0.43, 1.0, 1.0 }));
  scene.AddBox({ -0.8, -0.4, 0.0 }, { -0.2, 0.4, 0.4 });
  ExpectExactCount(scene);
}

TEST(StabilityLight, WhollyBehindGivesNothing)
{
  for (const double depth : { 1e-12, 1e-6, 1.0 })
  {
    TestScene scene = MakeEmptyScene();
    scene.Settings.Side = penumbra::ReceiverSide::Front;
    scene.AddLight({ -0.5, -0.5, -depth }, { 0.5, -0.5, -depth }, { -0.5, 0.5, -2.0 * depth });
    scene.Lights.back()->TwoSided = true;
    scene.AddBox({ -0.3, -0.4, -0.5 }, { 0.5, 0.4, 0.7 });
    ExpectWithin("light behind by " + std::to_string(depth), IsDark(scene) ? 0.0 : 1.0, 0.0);
  }
}

TEST(StabilityGrazing, CosinesBelowOneInAMillion)
{
  TestScene scene = MakeEmptyScene();
  scene.Name = "cosines below 1e-6";
  scene.AddLight({ 1e3, 200.0, 1e-4 }, { 1e3, -200.0, 1e-4 }, { 1e3, 200.0, 9e-4 });
  scene.AddPlate({ 0.5, -1.0, 0.0 }, { 0.1, 0.7, 0.0 }, { 0.0, 0.0, 1.0 });
  scene.AddPlate({ 0.6, 0.4, 0.0 }, { -0.1, 0.7, 0.0 }, { 0.0, 0.0, 2e-7 });
  ExpectExactCount(scene);
}

TEST(StabilityGrazing, LightSeenEdgeOn)
{
  for (const double tilt : { 0.0, 1e-9, 1e-6, 1e-3 })
  {
    // The light's plane goes through the middle of the receiver, up to the tilt.
    TestScene scene = MakeEmptyScene();
    std::ostringstream name;
    name << "seen edge-on, tilted by " << tilt;
    scene.Name = name.str();
    scene.AddLight({ tilt, 1.0, 1.0 }, { tilt, -1.0, 1.0 }, { -tilt, 1.0, 2.0 });
    scene.Lights.back()->TwoSided = true;
    scene.AddBox({ 0.3, -0.4, 0.0 }, { 0.6, 0.4, 0.4 });
    ExpectExactCount(scene);
  }
}

// Each texel's own light, not the peak's, is the measure here: it falls by 16 powers of ten.
TEST(StabilityGrazing, FarCornerAtTenThousandLightHeights)
{
  TestScene scene = MakeEmptyScene();
  const double height = 1.0;
  scene.Base = { { 0.0, 0.0, 0.0 }, { 1e4, 0.0, 0.0 }, { 0.0, 1e4, 0.0 } };
  scene.AddLight({ 0.0, 1.0, height }, { 1.0, 1.0, height }, { 0.0, 0.0, height });
  const std::vector<glm::vec4> texels = BakeTexels(scene);
  double largest = 0.0;
  for (int j = 0; j < scene.Texels.y; ++j)
  {
    for (int i = 0; i < scene.Texels.x; ++i)
    {
      const double exact = scene.GetExact(i, j).r;
      const double value = texels[static_cast<std::size_t>(j * scene.Texels.x + i)].r;
      largest = std::max(largest, std::abs(value - exact) / exact);
    }
  }
  // The light is 1e-4 of the receiver's size above it: in the receiver's units its height has a
  // relative rounding of 2^-24, but what the form factor is made of, the light's height and edges,
  // is rounded on its own. The fan of four triangles adds terms of one sign: 4 x 16 roundings of
  // them, and of the distance to the fourth power, 4 x 4 more.
  ExpectWithin("far corner, of each texel's own light", largest, 80.0 * FloatRounding);
}

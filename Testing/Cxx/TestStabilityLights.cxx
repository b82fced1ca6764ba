// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Lights in hard places: near the receiver's plane, cut by it, in it, touching it, behind it;
// grazing light.

#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TestScene MakeLowStrip(double h)
{
  TestScene scene = MakeEmptyScene();
  scene.AddLight({ 4.0, 1.0, 0.5 * h }, { 4.0, -1.0, 0.5 * h }, { 4.0, 1.0, h });
  scene.AddPlate({ 0.5, -1.0, 0.0 }, { 0.1, 0.7, 0.0 }, { 0.0, 0.0, 1.0 });
  scene.AddPlate({ 0.6, 0.4, 0.0 }, { -0.1, 0.7, 0.0 }, { 0.0, 0.0, 0.3 * h });
  return scene;
}

/// A plate under a disk that is 30 degrees off the zenith and looks 10 degrees wide, as far away as
/// that.
TestScene MakeDiskScene(double distance)
{
  TestScene scene = MakeEmptyScene();
  penumbra::LightSettings disk;
  disk.Shape = penumbra::LightKind::Disk;
  const glm::dvec3 towards(0.5, 0.0, -std::sqrt(0.75));
  disk.Origin = -distance * towards;
  const double radius = distance * std::tan(glm::radians(5.0));
  disk.Point1 = disk.Origin + radius * glm::dvec3(std::sqrt(0.75), 0.0, 0.5);
  disk.Point2 = disk.Origin + radius * glm::dvec3(0.0, -1.0, 0.0); // x cross y is `towards`
  scene.Lights.push_back(disk.MakeLight());
  scene.AddPlate({ -0.6, -0.7, 1.0 }, { 1.1, 0.0, 0.0 }, { 0.0, 1.3, 0.0 });
  return scene;
}

} // namespace

// From a million receivers' sizes on, distance changes nothing but places by less than 1/100 of a
// texel: at most a few samples of an edge. A penumbra that is lost is off by up to a half.
TEST(StabilityDistance, DisksKeepTheirPenumbrae)
{
  const std::vector<glm::vec4> closer = BakeTexels(MakeDiskScene(4e6));
  double peak = 0.0;
  for (const glm::vec4& texel : closer)
  {
    peak = std::max(peak, static_cast<double>(texel.x + texel.w));
  }
  ASSERT_GT(peak, 0.0);
  for (const double distance : { 1.5e8, 1.5e11, 4e13, 1e20, 1e35, 1e60 })
  {
    const std::vector<glm::vec4> distant = BakeTexels(MakeDiskScene(distance));
    for (std::size_t i = 0; i < distant.size(); ++i)
    {
      EXPECT_NEAR(distant[i].x / peak, closer[i].x / peak, 0.02)
        << "distance " << distance << ", texel " << i;
    }
  }
}

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

// All of the light is low and far away; a wall and a kerb stand between. Its form factor is of the
// size of the height squared: below 1e-7, the oracle's sums of angles run out of digits.
TEST_P(StabilityHeight, LowStripBesideTheReceiver)
{
  TestScene scene = MakeLowStrip(GetHeight(this->GetParam()));
  scene.Name = GetName("low strip up to height", this->GetParam());
  if (this->GetParam() <= 7)
  {
    ExpectExactCount(scene);
    return;
  }
  // As heights go to 0, light goes with their square: from one of 1e-5 down it does so to within
  // 1e-10. Powers of two change no digit of what is projected.
  const int halvings = static_cast<int>(std::lround((this->GetParam() - 5) * std::log2(10.0)));
  const std::vector<glm::vec4> high = BakeTexels(MakeLowStrip(GetHeight(5)));
  const std::vector<glm::vec4> low = BakeTexels(MakeLowStrip(std::ldexp(GetHeight(5), -halvings)));
  double largest = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < high.size(); ++i)
  {
    const double scaled = std::ldexp(static_cast<double>(low[i].r), 2 * halvings);
    largest = std::max(largest, std::abs(scaled - static_cast<double>(high[i].r)));
    peak = std::max(peak, static_cast<double>(high[i].r));
  }
  ExpectWithin(scene.Name, largest / peak, 2.0 * GetRadianceBound(64));
}

INSTANTIATE_TEST_SUITE_P(Exponents, StabilityHeight, testing::Range(3, 13),
  [](const auto& exponent) { return "Minus" + std::to_string(exponent.param); });

TEST(StabilityLight, CutByThePlane)
{
  for (const double part : { 0.5, 1e-3, 1e-6 })
  {
    // `part` of the light is in front of the plane.
    TestScene scene = MakeEmptyScene();
    std::ostringstream name;
    name << "cut by the plane, " << part << " of it in front";
    scene.Name = name.str();
    scene.AddLight({ 3.0, 1.0, part - 1.0 }, { 3.0, -1.0, part - 1.0 }, { 3.5 - part, 1.0, part });
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
  slanted.AddPlate({ -0.3, -0.3, 0.5 }, { 0.6, 0.0, 0.0 }, { 0.0, 0.6, 0.0 });
  for (const penumbra::ReceiverSide side :
    { penumbra::ReceiverSide::Front, penumbra::ReceiverSide::Back })
  {
    slanted.Settings.Side = side;
    ExpectWithin("light in a slanted plane", IsDark(slanted) ? 0.0 : 1.0, 0.0);
  }
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
  // Terms of the size of the light's elevation, z / r, times its width make up a form factor of
  // that times its height in the view, z / r times d / r. They lose r / d of it; 8 roundings each.
  ExpectWithin(
    "far corner, of each texel's own light", largest, 8.0 * std::sqrt(2.0) * 1e4 * FloatRounding);
}

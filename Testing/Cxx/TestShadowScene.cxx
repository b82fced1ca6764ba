// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the scene decides before anything is drawn: texels, lit sides, the order of the lights, what
// settings are refused, and which effect a pair needs.

#include "EffectPlanner.h"
#include "PolygonLight.h"
#include "SamplingPattern.h"
#include "ShadowScene.h"
#include "ShadowSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <unistd.h> // for alarm()

namespace
{

using penumbra::Effect;
using penumbra::LightKind;
using penumbra::LightSettings;
using penumbra::PlanEffect;
using penumbra::PolygonLight;
using penumbra::Receiver;
using penumbra::ReceiverFrame;
using penumbra::ReceiverSettings;
using penumbra::ReceiverSide;
using penumbra::ShadowScene;
using Side = ReceiverFrame::Side;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

// A rectangle in the plane z = 0.
Receiver Rectangle(double x, double y, double texelSize)
{
  Receiver receiver;
  receiver.Base = { { 0, 0, 0 }, { x, 0, 0 }, { 0, y, 0 } };
  receiver.Settings.TexelSize = texelSize;
  return receiver;
}

// The texels of a single receiver, which must not need to grow.
glm::ivec2 TexelsOf(const Receiver& receiver)
{
  ShadowScene scene;
  scene.Receivers = std::vector<Receiver>{ receiver };
  EXPECT_EQ(scene.ChooseTexels(0), 1.0);
  return scene.Receivers[0].Texels;
}

double LargestSide(const ShadowScene& scene)
{
  double side = 0.0;
  for (const Receiver& receiver : scene.Receivers)
  {
    side = std::max(side,
      static_cast<double>(receiver.Settings.Supersampling) *
        std::max(receiver.Texels.x, receiver.Texels.y));
  }
  return side;
}

double TotalBytes(const ShadowScene& scene)
{
  double texels = 0.0;
  for (const Receiver& receiver : scene.Receivers)
  {
    texels += receiver.GetBakedTexels();
  }
  return texels * ShadowScene::BytesPerTexel;
}

TEST(ChooseTexels, TakesFiveHundredAndTwelveAlongTheLongestEdge)
{
  EXPECT_EQ(TexelsOf(Rectangle(3.0, 3.0, 0.0)), glm::ivec2(512, 512));
  EXPECT_EQ(TexelsOf(Rectangle(3.0, 1.5, 0.0)), glm::ivec2(512, 256));
  EXPECT_EQ(TexelsOf(Rectangle(1e-6, 4e-6, 0.0)), glm::ivec2(128, 512));
  EXPECT_EQ(TexelsOf(Rectangle(1e6, 1e-6, 0.0)), glm::ivec2(512, 1));
  Receiver skewed = Rectangle(2.0, 1.0, 0.0);
  skewed.Base.EdgeY = { 0.6, 0.8, 0.0 }; // as long as it was
  EXPECT_EQ(TexelsOf(skewed), glm::ivec2(512, 256));
}

TEST(ChooseTexels, CoversTheEdgesWithTexelsOfTheSize)
{
  EXPECT_EQ(TexelsOf(Rectangle(1.0, 0.55, 0.1)), glm::ivec2(10, 6));
  EXPECT_EQ(TexelsOf(Rectangle(1.01, 0.1, 0.1)), glm::ivec2(11, 1));
  EXPECT_EQ(TexelsOf(Rectangle(1.0, 1.0, 7.0)), glm::ivec2(1, 1));
  EXPECT_EQ(TexelsOf(Rectangle(1.0, 1.0, 1e300)), glm::ivec2(1, 1));
}

// A length of n texels takes n of them, however the numbers are rounded.
TEST(ChooseTexels, TakesNoTexelForARounding)
{
  for (int n = 1; n <= 1000; ++n)
  {
    EXPECT_EQ(TexelsOf(Rectangle(0.1 * n, 0.1, 0.1)), glm::ivec2(n, 1));
    EXPECT_EQ(TexelsOf(Rectangle(n / 3.0, 1.0 / 3.0, 1.0 / 3.0)), glm::ivec2(n, 1));
    EXPECT_EQ(TexelsOf(Rectangle(n * 0.1f, 0.1f, 0.1)), glm::ivec2(n, 1)); // from floats
  }
}

TEST(ChooseTexels, LeavesEarlierReceiversAlone)
{
  ShadowScene scene;
  scene.Receivers = std::vector<Receiver>{ Rectangle(1.0, 1.0, 0.5), Rectangle(1.0, 1.0, 0.25) };
  scene.Receivers[0].Texels = { 77, 78 };
  EXPECT_EQ(scene.ChooseTexels(1), 1.0);
  EXPECT_EQ(scene.Receivers[0].Texels, glm::ivec2(77, 78));
  EXPECT_EQ(scene.Receivers[1].Texels, glm::ivec2(4, 4));
  EXPECT_EQ(scene.ChooseTexels(2), 1.0); // none at all
}

// Grown no more than the limits ask for. One step of growth overshoots by 1e-4 (its factor), and
// each side of a receiver by a texel in 3600 (the root of the bytes' limit over 20) and more: 1 %
// is a margin of ten. Receivers of few texels across are not asked.
void ExpectJustWithinTheLimits(ShadowScene scene)
{
  const double growth = scene.ChooseTexels(0);
  EXPECT_GT(growth, 1.0);
  EXPECT_LE(LargestSide(scene), ShadowScene::MaximumTextureSide);
  EXPECT_LE(TotalBytes(scene), ShadowScene::MaximumTextureBytes);
  const double used = std::max(LargestSide(scene) / ShadowScene::MaximumTextureSide,
    std::sqrt(TotalBytes(scene) / ShadowScene::MaximumTextureBytes));
  EXPECT_GT(used, 0.99);
  for (const Receiver& receiver : scene.Receivers)
  {
    // All by the same factor: the answer says what a texel has become, and they cover the edge,
    // up to a rounding of 1e-6 of it, with not one too many.
    const double size = growth * receiver.Settings.TexelSize;
    const double edge = glm::length(receiver.Base.EdgeX);
    EXPECT_GE(receiver.Texels.x * size, edge * (1.0 - 1e-6));
    EXPECT_LT((receiver.Texels.x - 1) * size, edge);
  }
}

TEST(ChooseTexels, GrowsTexelsToKeepTheTextureBelowItsBytes)
{
  for (const int supersampling : { 1, 2, 4 })
  {
    Receiver receiver = Rectangle(3.0, 2.0, 1e-4);
    receiver.Settings.Supersampling = supersampling;
    ShadowScene scene;
    scene.Receivers = std::vector<Receiver>{ receiver };
    ExpectJustWithinTheLimits(scene);
    scene.Receivers.assign(6, receiver); // a box's faces share a texture
    ExpectJustWithinTheLimits(scene);
  }
}

TEST(ChooseTexels, GrowsTexelsToKeepTheTextureBelowItsSide)
{
  ShadowScene scene;
  scene.Receivers = std::vector<Receiver>{ Rectangle(100.0, 0.5, 1e-3) };
  ExpectJustWithinTheLimits(scene);
  scene.Receivers = std::vector<Receiver>{ Rectangle(0.002, 100.0, 1e-3) };
  ExpectJustWithinTheLimits(scene);
}

TEST(ChooseTexels, KeepsTheLimitsForAbsurdTexels)
{
  for (const double texelSize : { 1e-12, 1e-100, 1e-300 })
  {
    ShadowScene scene;
    scene.Receivers =
      std::vector<Receiver>{ Rectangle(1.0, 1.0, texelSize), Rectangle(1e3, 1.0, texelSize) };
    ExpectJustWithinTheLimits(scene);
  }
}

// The smallest double is "a length > 0" like any other: how much it grows is beyond what a double
// can hold, but that is no reason for a texture of a single texel.
TEST(ChooseTexels, KeepsTheLimitsForTheSmallestDouble)
{
  ShadowScene scene;
  scene.Receivers =
    std::vector<Receiver>{ Rectangle(1.0, 1.0, std::numeric_limits<double>::denorm_min()) };
  EXPECT_GT(scene.ChooseTexels(0), 1.0);
  EXPECT_LE(TotalBytes(scene), ShadowScene::MaximumTextureBytes);
  EXPECT_GT(scene.Receivers[0].Texels.x, 1000);
  EXPECT_GT(scene.Receivers[0].Texels.y, 1000);
}

// More receivers than the texture has room for, were they a texel each: there is nothing left to
// grow, which must not go on for ever. In a process of its own, which is killed after ten seconds.
TEST(ChooseTexelsDeathTest, TerminatesWhereNoTexelSizeKeepsTheLimits)
{
  const auto choose = []()
  {
    alarm(10);
    Receiver receiver = Rectangle(1.0, 1.0, 1.0);
    receiver.Settings.Supersampling = 4;
    const double bytes = 16.0 * ShadowScene::BytesPerTexel;
    ShadowScene scene;
    scene.Receivers.assign(
      static_cast<std::size_t>(1.1 * ShadowScene::MaximumTextureBytes / bytes), receiver);
    scene.ChooseTexels(0);
    std::_Exit(scene.Receivers[0].Texels == glm::ivec2(1) ? 0 : 1);
  };
  EXPECT_EXIT(choose(), testing::ExitedWithCode(0), "");
}

TEST(ChooseTexels, GetBakedTexelsCountsSupersamples)
{
  Receiver receiver;
  receiver.Texels = { 30, 20 };
  EXPECT_EQ(receiver.GetBakedTexels(), 600.0);
  receiver.Settings.Supersampling = 4;
  EXPECT_EQ(receiver.GetBakedTexels(), 9600.0);
}

// A unit square at the given height that shines on the plane z = 0.
PolygonLight LightAt(double height, double radiance)
{
  PolygonLight light = height > 0.0
    ? PolygonLight::Parallelogram({ 0, 0, height }, { 0, 1, height }, { 1, 0, height })
    : PolygonLight::Parallelogram({ 0, 0, height }, { 1, 0, height }, { 0, 1, height });
  light.Radiance = glm::dvec3(radiance);
  return light;
}

double NormalOf(const ShadowScene& scene, ReceiverSide side)
{
  Receiver receiver = Rectangle(1.0, 1.0, 0.0);
  receiver.Settings.Side = side;
  return scene.MakeFrame(receiver).GetNormal().z;
}

TEST(MakeFrame, TakesTheSideThatIsAskedFor)
{
  ShadowScene scene;
  for (const double height : { 2.0, -2.0 })
  {
    scene.Lights = { LightAt(height, 1.0) };
    EXPECT_EQ(NormalOf(scene, ReceiverSide::Front), 1.0);
    EXPECT_EQ(NormalOf(scene, ReceiverSide::Back), -1.0);
  }
}

TEST(MakeFrame, FindsTheSideTheLightsAreOn)
{
  ShadowScene scene;
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), 1.0); // no light: the front
  scene.Lights = { LightAt(2.0, 1.0) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), 1.0);
  scene.Lights = { LightAt(-2.0, 1.0) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), -1.0);
}

TEST(MakeFrame, FindsTheSideThatGetsMoreLight)
{
  ShadowScene scene;
  scene.Lights = { LightAt(2.0, 1.0), LightAt(-2.0, 3.0) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), -1.0);
  scene.Lights = { LightAt(2.0, 3.0), LightAt(-2.0, 1.0) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), 1.0);
  // The nearer of two equal ones; two far ones together outshine a near one that is dim.
  scene.Lights = { LightAt(3.0, 1.0), LightAt(-2.0, 1.0) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), -1.0);
  scene.Lights = { LightAt(2.0, 1.0), LightAt(2.0, 1.0), LightAt(-2.0, 1.5) };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), 1.0);
}

// A light on the back that shines away from the receiver does not light it.
TEST(MakeFrame, IgnoresLightsThatShineAway)
{
  PolygonLight away = PolygonLight::Parallelogram({ 0, 0, -2 }, { 0, 1, -2 }, { 1, 0, -2 });
  away.Radiance = glm::dvec3(100.0);
  ShadowScene scene;
  scene.Lights = { LightAt(2.0, 1.0), away };
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), 1.0);
  scene.Lights[1]->TwoSided = true;
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), -1.0);
}

// Upright on the back, it shines on the half of the receiver that the centre is not in.
TEST(MakeFrame, FindsTheSideOfALightThatTheCentreDoesNotSee)
{
  ShadowScene scene;
  scene.Lights = { PolygonLight::Parallelogram({ 0.7, 0, -2 }, { 0.7, 1, -2 }, { 0.7, 0, -1 }) };
  ASSERT_EQ(scene.Lights[0]->GetAxis(), glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), -1.0);
}

TEST(MakeFrame, SideDoesNotDependOnTheLightsOrder)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.5, 2.0);
  for (int i = 0; i < 100; ++i)
  {
    ShadowScene scene;
    for (int j = 0; j < 6; ++j)
    {
      // Pairs that balance but for the rounding of their sum.
      const double radiance = uniform(random);
      scene.Lights.push_back(LightAt(2.0, radiance));
      scene.Lights.push_back(LightAt(-2.0, radiance));
    }
    const double normal = NormalOf(scene, ReceiverSide::Auto);
    std::shuffle(scene.Lights.begin(), scene.Lights.end(), random);
    EXPECT_EQ(NormalOf(scene, ReceiverSide::Auto), normal);
  }
}

bool AreAlike(const PolygonLight& a, const PolygonLight& b)
{
  return a.Radiance == b.Radiance && a.TwoSided == b.TwoSided && a.GetVertices() == b.GetVertices();
}

// Lights that differ from another in one thing each, and two that are alike.
std::vector<PolygonLight> AssortedLights()
{
  std::vector<PolygonLight> lights{ LightAt(2.0, 1.0), LightAt(2.0, 1.0), LightAt(2.0, 2.0),
    LightAt(-2.0, 1.0), LightAt(3.0, 1.0),
    PolygonLight::Triangle({ 0, 0, 2 }, { 0, 1, 2 }, { 1, 0, 2 }),
    PolygonLight::Parallelogram({ 0, 0, 2 }, { 1, 0, 2 }, { 0, 1, 2 }),
    PolygonLight::Parallelogram({ 0, 0, 2 }, { 0, 1, 2 }, { 1, 0, 2.0000001 }),
    PolygonLight::Triangle({ 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }) };
  lights.push_back(lights[0]);
  lights.back().TwoSided = true;
  lights.push_back(lights[0]);
  lights.back().Radiance.z = 0.5;
  return lights;
}

TEST(GetLightOrder, DoesNotDependOnTheOrderOfAdding)
{
  ShadowScene scene;
  for (const PolygonLight& light : AssortedLights())
  {
    scene.Lights.push_back(light);
  }
  std::vector<PolygonLight> expected;
  for (const std::size_t i : scene.GetLightOrder())
  {
    expected.push_back(AssortedLights().at(i));
  }
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i)
  {
    std::shuffle(scene.Lights.begin(), scene.Lights.end(), random);
    const std::vector<std::size_t> order = scene.GetLightOrder();
    ASSERT_EQ(order.size(), expected.size());
    for (std::size_t j = 0; j < order.size(); ++j)
    {
      EXPECT_TRUE(
        AreAlike(dynamic_cast<const PolygonLight&>(*scene.Lights.at(order[j])), expected[j]))
        << j;
    }
  }
}

TEST(GetLightOrder, NamesEveryLightOnce)
{
  ShadowScene scene;
  EXPECT_TRUE(scene.GetLightOrder().empty());
  for (const PolygonLight& light : AssortedLights())
  {
    scene.Lights.push_back(light);
  }
  std::vector<std::size_t> order = scene.GetLightOrder();
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < scene.Lights.size(); ++i)
  {
    EXPECT_EQ(order.at(i), i);
  }
}

// What a bad value of a setting must be answered with.
template <typename Settings>
struct BadValue
{
  std::function<void(Settings&)> Set;
  std::string Name, Value, Allowed;
};

template <typename Settings>
void ExpectProblems(const std::vector<BadValue<Settings>>& badValues)
{
  for (const BadValue<Settings>& bad : badValues)
  {
    Settings settings;
    bad.Set(settings);
    const std::string problem = settings.FindProblem();
    for (const std::string& part : { bad.Name, bad.Value, "allowed: " + bad.Allowed })
    {
      EXPECT_NE(problem.find(part), std::string::npos) << "'" << part << "' in: " << problem;
    }
  }
}

TEST(ReceiverSettings, DefaultsAreTheContracts)
{
  const ReceiverSettings settings;
  EXPECT_EQ(settings.FindProblem(), "");
  EXPECT_EQ(settings.TexelSize, 0.0);
  EXPECT_EQ(settings.LightSamples, 64);
  EXPECT_EQ(settings.SampleMultiplier, 1.0);
  EXPECT_EQ(penumbra::GetSamplingPatterns().at(0).Name, "Sobol");
  EXPECT_EQ(settings.SamplingPattern, 0);
  EXPECT_EQ(settings.Supersampling, 1);
  EXPECT_EQ(settings.Side, ReceiverSide::Auto);
}

TEST(ReceiverSettings, AcceptTheEndsOfTheirRanges)
{
  ReceiverSettings settings;
  settings.TexelSize = 1e-300;
  settings.LightSamples = 65536;
  settings.SampleMultiplier = 1e-300;
  settings.SamplingPattern = 4;
  settings.Supersampling = 4;
  settings.Reflectance = { 0.0, 0.5, 1.0 };
  settings.AmbientRadiance = { 0.0, 1.0, 1e30 };
  settings.Side = ReceiverSide::Back;
  settings.Seed = -1;
  EXPECT_EQ(settings.FindProblem(), "");
  settings.LightSamples = 1;
  settings.Supersampling = 2;
  EXPECT_EQ(settings.FindProblem(), "");
}

TEST(ReceiverSettings, NameBadNumbers)
{
  using S = ReceiverSettings;
  const std::string length = "0 (automatic) or a length > 0";
  ExpectProblems<S>({
    { [](S& s) { s.TexelSize = -0.5; }, "TexelSize", "-0.5", length },
    { [](S& s) { s.TexelSize = NaN; }, "TexelSize", "nan", length },
    { [](S& s) { s.PlanarityTolerance = -1e-3; }, "PlanarityTolerance", "-0.001", length },
    { [](S& s) { s.PlanarityTolerance = NaN; }, "PlanarityTolerance", "nan", length },
    { [](S& s) { s.PlanarityTolerance = Infinity; }, "PlanarityTolerance", "inf", length },
    { [](S& s) { s.TexelSize = Infinity; }, "TexelSize", "inf", length },
    { [](S& s) { s.LightSamples = 0; }, "LightSamples", "0", "1 to 65536" },
    { [](S& s) { s.LightSamples = -7; }, "LightSamples", "-7", "1 to 65536" },
    { [](S& s) { s.LightSamples = 65537; }, "LightSamples", "65537", "1 to 65536" },
    { [](S& s) { s.SampleMultiplier = 0.0; }, "SampleMultiplier", "0", "a number > 0" },
    { [](S& s) { s.SampleMultiplier = -2.0; }, "SampleMultiplier", "-2", "a number > 0" },
    { [](S& s) { s.SampleMultiplier = NaN; }, "SampleMultiplier", "nan", "a number > 0" },
    { [](S& s) { s.SampleMultiplier = Infinity; }, "SampleMultiplier", "inf", "a number > 0" },
    { [](S& s) { s.Supersampling = 0; }, "Supersampling", "0", "1, 2 or 4" },
    { [](S& s) { s.Supersampling = 3; }, "Supersampling", "3", "1, 2 or 4" },
  });
}

TEST(ReceiverSettings, NameBadChoicesAndColours)
{
  using S = ReceiverSettings;
  const std::string share = "0 to 1 for each component";
  const std::string radiance = "0 to 1e30 for each component";
  ExpectProblems<S>({
    { [](S& s) { s.SamplingPattern = -1; }, "SamplingPattern", "-1", "0 to 4" },
    { [](S& s) { s.SamplingPattern = 5; }, "SamplingPattern", "5", "0 to 4" },
    { [](S& s) { s.Side = static_cast<ReceiverSide>(4); }, "Side", "4",
      "0 (Auto), 1 (Front), 2 (Back) or 3 (Both)" },
    { [](S& s) { s.Side = static_cast<ReceiverSide>(-1); }, "Side", "-1", "0 (Auto), 1 (Front)" },
    { [](S& s) { s.Reflectance.y = 1.5; }, "Reflectance", "(1, 1.5, 1)", share },
    { [](S& s) { s.Reflectance.z = -0.5; }, "Reflectance", "(1, 1, -0.5)", share },
    { [](S& s) { s.Reflectance.x = NaN; }, "Reflectance", "nan", share },
    { [](S& s) { s.AmbientRadiance.x = -2.0; }, "AmbientRadiance", "(-2, 0, 0)", radiance },
    { [](S& s) { s.AmbientRadiance.y = 1e31; }, "AmbientRadiance", "(0, 1e+31, 0)", radiance },
    { [](S& s) { s.AmbientRadiance.z = Infinity; }, "AmbientRadiance", "inf", radiance },
  });
}

// What a proxy plane is given by counts only where one is.
TEST(ReceiverSettings, NameBadProxyPlanes)
{
  using S = ReceiverSettings;
  const auto given = [](S& s)
  {
    s.ProxyPlane = true;
    s.ProxyMode = penumbra::ProxyPlaneMode::Given;
  };
  const std::string direction = "a direction: finite, and not (0, 0, 0)";
  ExpectProblems<S>({
    { [&](S& s) { given(s), s.ProxyNormal = glm::dvec3(0.0); }, "ProxyNormal", "(0, 0, 0)",
      direction },
    { [&](S& s) { given(s), s.ProxyNormal.y = NaN; }, "ProxyNormal", "nan", direction },
    { [&](S& s) { given(s), s.ProxyNormal.z = Infinity; }, "ProxyNormal", "inf", direction },
    { [&](S& s) { given(s), s.ProxyOrigin.x = NaN; }, "ProxyOrigin", "nan", "finite coordinates" },
    { [&](S& s) { given(s), s.ProxyMode = static_cast<penumbra::ProxyPlaneMode>(2); },
      "ProxyPlaneMode", "2", "0 (Best Fit) or 1 (Given)" },
  });
  ReceiverSettings unused;
  given(unused);
  unused.ProxyPlane = false;
  unused.ProxyNormal = glm::dvec3(NaN);
  EXPECT_EQ(unused.FindProblem(), "");
}

TEST(ReceiverSettings, SampleCountIsTheProductWithinItsLimits)
{
  ReceiverSettings settings;
  EXPECT_EQ(settings.GetSampleCount(), 64);
  settings.SampleMultiplier = 2.5;
  EXPECT_EQ(settings.GetSampleCount(), 160);
  settings.SampleMultiplier = 1e-300;
  EXPECT_EQ(settings.GetSampleCount(), 1);
  settings.SampleMultiplier = 1e300;
  EXPECT_EQ(settings.GetSampleCount(), ReceiverSettings::MostLightSamples);
}

TEST(LightSettings, MakeTheLightTheyDescribe)
{
  LightSettings settings;
  EXPECT_EQ(settings.FindProblem(), "");
  settings.Radiance = { 1.0, 2.0, 3.0 };
  settings.TwoSided = true;
  settings.Point1 = { 1.5, -0.5, 0.0 }; // 2 by 1
  const penumbra::Light made = settings.MakeLight();
  const auto& parallelogram = dynamic_cast<const PolygonLight&>(*made);
  EXPECT_EQ(parallelogram.GetArea(), 2.0);
  EXPECT_EQ(parallelogram.Radiance, settings.Radiance);
  EXPECT_TRUE(parallelogram.TwoSided);
  EXPECT_EQ(parallelogram.GetNormal(), glm::dvec3(0.0, 0.0, 1.0));
  settings.Shape = LightKind::Triangle;
  EXPECT_EQ(settings.MakeLight()->GetMeasure(), 1.0);
}

TEST(LightSettings, NameBadValues)
{
  using S = LightSettings;
  const std::string radiance = "0 to 1e30 for each component";
  ExpectProblems<S>({
    { [](S& s) { s.Shape = static_cast<LightKind>(7); }, "Shape", "7", "0 (Parallelogram)" },
    { [](S& s) { s.Shape = static_cast<LightKind>(-1); }, "Shape", "-1", "0 (Parallelogram)" },
    { [](S& s) { s.Origin.x = NaN; }, "Origin", "nan", "finite coordinates" },
    { [](S& s) { s.Point1.y = Infinity; }, "Point1", "inf", "finite coordinates" },
    { [](S& s) { s.Point2.z = -Infinity; }, "Point2", "-inf", "finite coordinates" },
    { [](S& s) { s.Radiance.x = -1.0; }, "Radiance", "(-1, 1, 1)", radiance },
    { [](S& s) { s.Radiance.y = NaN; }, "Radiance", "nan", radiance },
    { [](S& s) { s.Radiance.z = 1e31; }, "Radiance", "1e+31", radiance },
    { [](S& s) { s.Point1 = s.Origin; }, "Point1", "0", "more than 0" },
    { [](S& s) { s.Point2 = 2.0 * s.Point1 - s.Origin; }, "Point2", "0", "more than 0" },
  });
}

// The effect of a unit square's front with what it can see of the light.
Effect EffectOf(const PolygonLight& light, bool hasOccluders)
{
  const Receiver receiver = Rectangle(1.0, 1.0, 0.0);
  const ReceiverFrame frame(receiver.Base, Side::Front);
  return PlanEffect(
    frame, light.ClippedToFront(receiver.Base.Corner, frame.GetNormal()), hasOccluders);
}

TEST(PlanEffect, IsSoftOrUnoccludedBeforeTheLight)
{
  EXPECT_EQ(EffectOf(LightAt(2.0, 1.0), true), Effect::Soft);
  EXPECT_EQ(EffectOf(LightAt(2.0, 1.0), false), Effect::Unoccluded);
}

TEST(PlanEffect, IsNoneForALightBehindTheReceiver)
{
  EXPECT_EQ(EffectOf(LightAt(-2.0, 1.0), true), Effect::None);
  EXPECT_EQ(EffectOf(LightAt(-2.0, 1.0), false), Effect::None);
}

TEST(PlanEffect, IsNoneForADarkOrDegenerateLight)
{
  EXPECT_EQ(EffectOf(LightAt(2.0, 0.0), true), Effect::None);
  PolygonLight red = LightAt(2.0, 0.0);
  red.Radiance.x = 1e-9;
  EXPECT_EQ(EffectOf(red, true), Effect::Soft);
  EXPECT_EQ(
    EffectOf(PolygonLight::Triangle({ 0, 0, 1 }, { 1, 0, 1 }, { 2, 0, 1 }), true), Effect::None);
}

// H&H 1997, 3.6: of a one-sided light that faces away there is nothing, unless a part of the
// receiver is before it.
TEST(PlanEffect, IsNoneForALightThatFacesAway)
{
  PolygonLight away = PolygonLight::Parallelogram({ 0, 0, 2 }, { 1, 0, 2 }, { 0, 1, 2 });
  EXPECT_EQ(EffectOf(away, true), Effect::None);
  away.TwoSided = true;
  EXPECT_EQ(EffectOf(away, true), Effect::Soft);
  // Upright, facing +x, in the middle of the receiver and past its end.
  const auto upright = [](double x) {
    return PolygonLight::Parallelogram({ x, 0, 0.1 }, { x, 1, 0.1 }, { x, 0, 1.1 });
  };
  EXPECT_EQ(EffectOf(upright(0.5), true), Effect::Soft);
  EXPECT_EQ(EffectOf(upright(-0.5), true), Effect::Soft);
  EXPECT_EQ(EffectOf(upright(1.5), true), Effect::None);
}

TEST(PlanEffect, SeesTheLightAboveTheReceiversPlaneAlone)
{
  const PolygonLight through =
    PolygonLight::Parallelogram({ -1, 0, -1 }, { -1, 1, -1 }, { -1, 0, 1 });
  EXPECT_EQ(EffectOf(through, true), Effect::Soft);
  const PolygonLight below =
    PolygonLight::Parallelogram({ -1, 0, -1 }, { -1, 1, -1 }, { -1, 0, 0 });
  EXPECT_EQ(EffectOf(below, true), Effect::None);
}

// Wherever a light arrives at all, the plan is not None: no light is lost.
TEST(PlanEffect, LosesNoLight)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  const auto point = [&]()
  {
    const double x = uniform(random);
    const double y = uniform(random);
    return glm::dvec3(x, y, uniform(random));
  };
  const ReceiverFrame frame(Rectangle(1.0, 1.0, 0.0).Base, Side::Front);
  int lit = 0;
  for (int i = 0; i < 1000; ++i)
  {
    const glm::dvec3 a = point();
    const glm::dvec3 b = point();
    const PolygonLight light = PolygonLight::Triangle(a, b, point());
    double arriving = 0.0;
    for (int j = 0; j < 36; ++j)
    {
      const glm::dvec3 x = frame.ToWorld({ (j % 6) / 5.0, (j / 6) / 5.0, 0.0 });
      arriving = std::max(arriving, light.FormFactor(x, frame.GetNormal()));
    }
    if (arriving > 0.0)
    {
      EXPECT_NE(EffectOf(light, true), Effect::None) << i;
      ++lit;
    }
  }
  EXPECT_GT(lit, 300);
}

TEST(PlanEffect, HasTheContractsNames)
{
  EXPECT_STREQ(penumbra::GetEffectName(Effect::None), "None");
  EXPECT_STREQ(penumbra::GetEffectName(Effect::Unoccluded), "Unoccluded");
  EXPECT_STREQ(penumbra::GetEffectName(Effect::Soft), "Soft");
}

} // namespace

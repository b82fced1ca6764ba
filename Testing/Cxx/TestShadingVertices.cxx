// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A few vertices shade what is smooth: to within the tolerance, against the closed form.

#include "LargestDeviation.h"
#include "PlanScene.h"
#include "RandomPairs.h"
#include "ShadingVertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

using penumbra::Effect;
using penumbra::ReceiverFrame;
using penumbra::ReceiverPlan;

/// What arrives at a point, and in the last component the mean of what is blocked.
glm::dvec4 Evaluate(const ReceiverPlan& plan, const glm::dvec2& uv)
{
  glm::dvec4 sum(0.0);
  for (std::size_t i = 0; i < plan.Lights.size(); ++i)
  {
    const glm::dvec3 light =
      plan.Lights[i]->Irradiance(plan.Frame.ToWorld({ uv, 0.0 }), plan.Frame.GetNormal());
    const Effect effect = plan.Pairs[i].Needed;
    sum += effect == Effect::Umbra ? glm::dvec4(0, 0, 0, (light.x + light.y + light.z) / 3.0)
      : effect == Effect::None     ? glm::dvec4(0.0)
                                   : glm::dvec4(light, 0.0);
  }
  return sum;
}

/// As a texture's bilinear filter has it, from texels' centres.
glm::dvec4 Interpolate(const ReceiverPlan& vertices, const glm::dvec3& world)
{
  const glm::dvec2 count(vertices.Texels);
  const glm::dvec2 place = glm::dvec2(vertices.Frame.ToFrame(world)) * count - 0.5;
  const glm::dvec2 first = glm::clamp(glm::floor(place), glm::dvec2(0.0), count - 2.0);
  const glm::dvec2 t = place - first;
  const auto at = [&](double i, double j)
  { return Evaluate(vertices, (first + glm::dvec2(i, j) + 0.5) / count); };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), t.x), glm::mix(at(0, 1), at(1, 1), t.x), t.y);
}

/// One to three lights, of which some are blocked wholly.
PlanScene RandomSmoothScene(RandomGeometry& random)
{
  PlanScene scene;
  const ReceiverFrame frame = scene.MakeFrame(scene.Receivers.front());
  const std::size_t lights = 1 + random.Below(3);
  for (std::size_t i = 0; i < lights; ++i)
  {
    scene.Lights.push_back(RandomLight(random, frame));
  }
  if (random.Below(3) == 0)
  {
    scene.Surfaces.emplace_back(PlanScene::MakeSquare(0, 0, 0.2, 50.0));
  }
  scene.GetSettings().PlannerTolerance = std::pow(10.0, random.Between(-4.0, -2.0));
  return scene;
}

} // namespace

TEST(ShadingVertices, ShadeToWithinTheTolerance)
{
  LargestDeviation largest;
  int shaded = 0, umbras = 0;
  for (unsigned seed = 0; seed < 1000; ++seed)
  {
    RandomGeometry random(seed);
    const PlanScene scene = RandomSmoothScene(random);
    const ReceiverPlan plan = scene.Plan();
    const penumbra::ReceiverSettings& settings = scene.Receivers.front().Settings;
    const int count = penumbra::CountShadingVertices(plan, settings);
    if (count == 0)
    {
      continue;
    }
    ++shaded;
    umbras += penumbra::IsUnshadowed(plan) ? 0 : 1;
    const ReceiverPlan vertices = penumbra::PlanVertices(plan, count);
    double peak = 0.0, error = 0.0;
    for (int i = 0; i < 200; ++i)
    {
      const glm::dvec2 uv(random.Between(0.0, 1.0), random.Between(0.0, 1.0));
      const glm::dvec4 exact = Evaluate(plan, uv);
      const glm::dvec4 difference =
        glm::abs(Interpolate(vertices, plan.Frame.ToWorld({ uv, 0.0 })) - exact);
      peak = std::max({ peak, exact.x, exact.y, exact.z, exact.w });
      error = std::max({ error, difference.x, difference.y, difference.z, difference.w });
    }
    if (peak > 0.0)
    {
      EXPECT_LE(largest.Add(error, peak * settings.PlannerTolerance), 1.0) << seed;
    }
  }
  EXPECT_GT(shaded, 300);
  EXPECT_GT(umbras, 30);
}

TEST(ShadingVertices, AreTexelsCentres)
{
  PlanScene scene;
  scene.Receivers.front().Base = { { 1, 2, 3 }, { 4, 1, 0 }, { -1, 2, 5 } };
  for (const penumbra::ReceiverSide side :
    { penumbra::ReceiverSide::Front, penumbra::ReceiverSide::Back })
  {
    scene.GetSettings().Side = side;
    scene.GetSettings().Supersampling = 2;
    const ReceiverPlan plan = scene.Plan();
    for (const int count : { 2, 3, 5, 33 })
    {
      const ReceiverPlan vertices = penumbra::PlanVertices(plan, count);
      EXPECT_EQ(vertices.Texels, glm::ivec2(count));
      EXPECT_EQ(vertices.Supersampling, 1);
      EXPECT_LT(glm::length(vertices.Frame.GetNormal() - plan.Frame.GetNormal()), 1e-12);
      for (int i = 0; i < count * count; ++i)
      {
        const glm::dvec2 place(i % count, i / count);
        const glm::dvec3 texel = vertices.Frame.ToWorld({ (place + 0.5) / double(count), 0.0 });
        const glm::dvec3 vertex = plan.Frame.ToWorld({ place / double(count - 1), 0.0 });
        EXPECT_LT(glm::length(texel - vertex), 1e-12);
      }
    }
  }
}

// Two where light is even; more where it is not, or a closer answer is asked for; none where that
// takes more than 33, or samples decide, or nothing may be decided.
TEST(ShadingVertices, AreAsManyAsItTakes)
{
  const auto count = [](const PlanScene& scene)
  { return penumbra::CountShadingVertices(scene.Plan(), scene.Receivers.front().Settings); };
  PlanScene scene;
  EXPECT_EQ(count(scene), 2) << "in the dark";
  scene.Lights = { PlanScene::MakeLamp(0, 0, 1000, 10) };
  EXPECT_EQ(count(scene), 2);
  scene.Lights = { PlanScene::MakeLamp(0, 0, 16, 1) };
  const int coarse = count(scene);
  EXPECT_GT(coarse, 2);
  scene.GetSettings().PlannerTolerance /= 16.0;
  EXPECT_GT(count(scene), coarse);
  scene.GetSettings().PlannerTolerance = 0.0;
  EXPECT_EQ(count(scene), 0);
  scene.GetSettings() = PlanScene().GetSettings();
  scene.GetSettings().Planner = false;
  EXPECT_EQ(count(scene), 0);
  scene.GetSettings().Planner = true;
  scene.Lights = { PlanScene::MakeLamp(0, 0, 0.01, 0.01) };
  EXPECT_EQ(count(scene), 0) << "a light on the floor";
  scene.Lights = { PlanScene::MakeLamp(0, 0, 1000, 10) };
  scene.Surfaces.emplace_back(PlanScene::MakeSquare(0, 0, 1, 0.5));
  EXPECT_EQ(count(scene), 0) << "samples decide";
}

// A coloured light has its hue on receivers that have a shadow of it, and so on those without one.
TEST(ShadingVertices, KnowWhatIsPlain)
{
  PlanScene scene;
  scene.Lights = { PlanScene::MakeLamp(0, 0, 2, 0.2) };
  const auto isPlain = [&] { return penumbra::IsPlain(scene.Plan(), scene.GetSettings()); };
  EXPECT_TRUE(isPlain());
  scene.Lights.front()->Radiance = glm::dvec3(7.0);
  EXPECT_TRUE(isPlain());
  scene.Lights.front()->Radiance = { 7.0, 7.0, 8.0 };
  EXPECT_FALSE(isPlain());
  scene.Lights.front()->Radiance = glm::dvec3(1.0);
  scene.GetSettings().AmbientRadiance = { 0.1, 0.2, 0.1 };
  EXPECT_FALSE(isPlain());
  scene.GetSettings().AmbientRadiance = glm::dvec3(0.1);
  scene.Lights.push_back(PlanScene::MakeLamp(0, 0, -1, 0.2)); // it does not arrive
  scene.Lights.back()->Radiance = { 1.0, 0.0, 0.0 };
  EXPECT_TRUE(isPlain());
  scene.Surfaces.emplace_back(PlanScene::MakeSquare(0, 0, 0.5, 0.2));
  EXPECT_FALSE(isPlain());
}

TEST(ShadingVertices, KnowWhatIsSmoothAndUnshadowed)
{
  const auto expect = [](Effect effect, bool isSmooth, bool isUnshadowed)
  {
    ReceiverPlan plan;
    plan.Pairs.resize(2);
    plan.Pairs[1].Needed = effect;
    EXPECT_EQ(penumbra::IsSmooth(plan), isSmooth) << GetEffectName(effect);
    EXPECT_EQ(penumbra::IsUnshadowed(plan), isUnshadowed) << GetEffectName(effect);
  };
  expect(Effect::None, true, true);
  expect(Effect::Unoccluded, true, true);
  expect(Effect::Umbra, true, false);
  expect(Effect::Hard, false, false);
  expect(Effect::Soft, false, false);
}

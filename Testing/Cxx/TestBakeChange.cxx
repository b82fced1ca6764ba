// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What of a bake has to be done anew: each rule, and no more than that.

#include "BakeChange.h"
#include "PlanScene.h"
#include "PointLight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{

using penumbra::BakeChange;
using penumbra::Effect;
using penumbra::LightChange;
using penumbra::PolygonLight;
using penumbra::ReceiverPlan;
using penumbra::SharedSurface;
using penumbra::TexelRectangle;

constexpr int Halo = 3;
const TexelRectangle Whole = penumbra::WholeRectangle(glm::ivec2(PlanScene::Side));

/// Two squares with shadows apart from each other, and a lamp.
PlanScene MakeScene()
{
  PlanScene scene;
  scene.Lights = { PlanScene::MakeLamp(0, 0, 2, 0.2) };
  scene.Surfaces.emplace_back(PlanScene::MakeSquare(-0.4, -0.4, 0.5, 0.2));
  scene.Surfaces.emplace_back(PlanScene::MakeSquare(0.4, 0.4, 0.5, 0.2));
  return scene;
}

TexelRectangle GetShadow(const ReceiverPlan& plan, std::size_t caster, std::size_t light = 0)
{
  return plan.Pairs[light].Casters[caster].Shadow;
}

BakeChange Compare(const PlanScene& before, const PlanScene& now)
{
  return penumbra::FindBakeChange(before.Plan(), now.Plan(), Halo);
}

TexelRectangle WithHalo(const TexelRectangle& stale)
{
  return stale.Grown(Halo).Intersection(Whole);
}

/// All is the same as it was.
void ExpectNothing(const BakeChange& change)
{
  EXPECT_TRUE(change.Resolved.IsEmpty());
  for (std::size_t i = 0; i < change.Lights.size(); ++i)
  {
    EXPECT_EQ(change.Lights[i].Before, static_cast<int>(i));
    EXPECT_TRUE(change.Lights[i].Stale.IsEmpty());
  }
}

/// What blocks the one light has changed within a rectangle.
void ExpectStale(const BakeChange& change, const TexelRectangle& stale)
{
  ASSERT_EQ(change.Lights.size(), 1u);
  EXPECT_EQ(change.Lights.front().Before, 0);
  EXPECT_EQ(change.Lights.front().Stale, stale);
  EXPECT_EQ(change.Resolved, WithHalo(stale));
}

} // namespace

TEST(BakeChange, IsNothingWhereNothingChanged)
{
  const PlanScene scene = MakeScene();
  ASSERT_EQ(scene.Plan().Pairs.front().Casters.size(), 2u);
  ExpectNothing(Compare(scene, scene));
}

// A surface that is only alike may be anything else.
TEST(BakeChange, IsWhereASurfaceWasAndIs)
{
  const PlanScene before = MakeScene();
  PlanScene now = before;
  now.Surfaces[2] = SharedSurface(PlanScene::MakeSquare(0.5, 0.3, 0.6, 0.2));
  const TexelRectangle stale = GetShadow(before.Plan(), 1).Union(GetShadow(now.Plan(), 1));
  EXPECT_LT(stale.GetArea(), 0.5 * Whole.GetArea());
  ExpectStale(Compare(before, now), stale);
}

TEST(BakeChange, IsWhereASurfaceCameOrWent)
{
  const PlanScene both = MakeScene();
  PlanScene one = both;
  one.Surfaces.pop_back();
  ExpectStale(Compare(both, one), GetShadow(both.Plan(), 1));
  ExpectStale(Compare(one, both), GetShadow(both.Plan(), 1));
  PlanScene none = one;
  none.Surfaces.pop_back();
  ASSERT_EQ(none.PlanFirst().Needed, Effect::Unoccluded);
  ExpectStale(Compare(one, none), GetShadow(one.Plan(), 0));
  ExpectStale(Compare(none, one), GetShadow(one.Plan(), 0));
}

TEST(BakeChange, IsNothingWhereWhatBlocksNothingMoves)
{
  PlanScene before = MakeScene(), now = before;
  before.Surfaces.emplace_back(PlanScene::MakeSquare(5, 5, 1, 0.2));
  now.Surfaces.emplace_back(PlanScene::MakeSquare(6, 5, 1, 0.2));
  ExpectNothing(Compare(before, now));
}

TEST(BakeChange, IsEverywhereButNotDrawnForRadiance)
{
  const PlanScene before = MakeScene();
  PlanScene now = before;
  now.Lights.front()->Radiance = { 1, 2, 3 };
  const BakeChange change = Compare(before, now);
  EXPECT_EQ(change.Resolved, Whole);
  EXPECT_EQ(change.Lights.front().Before, 0);
  EXPECT_TRUE(change.Lights.front().Stale.IsEmpty());
}

// What was not drawn for a dark light has to be.
TEST(BakeChange, IsEverywhereWhereALightIsSwitched)
{
  const PlanScene on = MakeScene();
  PlanScene off = on;
  off.Lights.front()->Radiance = glm::dvec3(0.0);
  ExpectStale(Compare(off, on), Whole);
  EXPECT_EQ(Compare(on, off).Resolved, Whole);
}

TEST(BakeChange, IsEverywhereForALightThatMoves)
{
  const PlanScene before = MakeScene();
  PlanScene now = before;
  now.Lights = { PlanScene::MakeLamp(0.1, 0, 2, 0.2) };
  const BakeChange change = Compare(before, now);
  EXPECT_EQ(change.Resolved, Whole);
  EXPECT_EQ(change.Lights.front().Before, LightChange::New);
}

TEST(BakeChange, IsEverywhereForALightThatComesOrGoes)
{
  const PlanScene one = MakeScene();
  PlanScene two = one;
  two.Lights.insert(two.Lights.begin(), PlanScene::MakeLamp(0.1, 0, 2, 0.2));
  const BakeChange came = Compare(one, two);
  EXPECT_EQ(came.Resolved, Whole);
  EXPECT_EQ(came.Lights[0].Before, LightChange::New);
  EXPECT_EQ(came.Lights[1].Before, 0);
  EXPECT_TRUE(came.Lights[1].Stale.IsEmpty());
  const BakeChange went = Compare(two, one);
  EXPECT_EQ(went.Resolved, Whole);
  EXPECT_EQ(went.Lights[0].Before, 1);
  EXPECT_TRUE(went.Lights[0].Stale.IsEmpty());
}

// Lights of which nothing arrives may do what they like.
TEST(BakeChange, IsNothingForLightsThatDoNotArrive)
{
  PlanScene before = MakeScene(), now = before;
  now.Lights.push_back(PlanScene::MakeLamp(0, 0, -1, 0.2));
  EXPECT_TRUE(Compare(before, now).Resolved.IsEmpty());
  EXPECT_TRUE(Compare(now, before).Resolved.IsEmpty());
  PlanScene brighter = now;
  brighter.Lights.back()->Radiance = glm::dvec3(7.0);
  ExpectNothing(Compare(now, brighter));
}

TEST(BakeChange, KnowsLightsInAnyOrder)
{
  PlanScene before = MakeScene();
  before.Lights.push_back(PlanScene::MakeLamp(0.1, 0, 2, 0.2));
  before.Lights.push_back(before.Lights.front()); // one like the first
  PlanScene now = before;
  std::swap(now.Lights[0], now.Lights[1]);
  const BakeChange change = Compare(before, now);
  EXPECT_TRUE(change.Resolved.IsEmpty());
  EXPECT_EQ(change.Lights[0].Before, 1);
  EXPECT_EQ(change.Lights[1].Before, 0);
  EXPECT_EQ(change.Lights[2].Before, 2);
}

// An umbra has no shadow whose bounds could tell.
TEST(BakeChange, IsEverywhereWhereAnUmbraComesOrGoes)
{
  const PlanScene open = MakeScene();
  PlanScene dark = open;
  dark.Surfaces.emplace_back(PlanScene::MakeSquare(0, 0, 1, 3.0));
  ASSERT_EQ(dark.PlanFirst().Needed, Effect::Umbra);
  ExpectStale(Compare(open, dark), Whole);
  ExpectStale(Compare(dark, open), Whole);
}

// One sample instead of many: of what has not moved, too.
TEST(BakeChange, IsAllShadowsWhereTheyGetHard)
{
  PlanScene soft;
  // Penumbrae of 100 texels / 2 * sqrt(2) * 0.02 h / (2 - h): 0.47 texels at 0.5 and 2.1 at 1.2.
  soft.Lights = { PlanScene::MakeLamp(0, 0, 2, 0.02) };
  soft.Surfaces.emplace_back(PlanScene::MakeSquare(-0.3, -0.3, 0.5, 0.2));
  PlanScene hard = soft;
  soft.Surfaces.emplace_back(PlanScene::MakeSquare(0.2, 0.2, 1.2, 0.2));
  const ReceiverPlan before = soft.Plan(), now = hard.Plan();
  ASSERT_EQ(before.Pairs.front().Needed, Effect::Soft);
  ASSERT_EQ(now.Pairs.front().Needed, Effect::Hard);
  const TexelRectangle all = before.Pairs.front().Shaded.Union(now.Pairs.front().Shaded);
  ExpectStale(Compare(soft, hard), all);
  ExpectStale(Compare(hard, soft), all);
}

// Shares that were exact are counted from now on, or the other way round, in all shadows; masks are
// what they were.
TEST(BakeChange, IsInAllShadowsButNotDrawnWhereSharesCeaseToBeExact)
{
  PlanScene few = MakeScene();
  few.GetSettings().LightSamples = 512; // enough for 64 triangles
  PlanScene many = few;
  many.Surfaces.emplace_back(PlanScene::MakeSquare(0.4, -0.4, 0.5, 0.2, 8));
  const ReceiverPlan before = few.Plan(), now = many.Plan();
  ASSERT_TRUE(before.Pairs.front().IsExact(512));
  ASSERT_FALSE(now.Pairs.front().IsExact(512));
  for (const BakeChange& change : { Compare(few, many), Compare(many, few) })
  {
    EXPECT_EQ(change.Resolved, WithHalo(now.Pairs.front().Shaded));
    EXPECT_EQ(change.Lights.front().Stale, GetShadow(now, 2));
  }
  PlanScene none = few;
  none.Surfaces.erase(none.Surfaces.begin() + 1, none.Surfaces.end());
  EXPECT_EQ(Compare(few, none).Resolved, WithHalo(before.Pairs.front().Shaded));
}

// Where an occluder is as high as the light, bits may depend on the rectangle that is drawn.
TEST(BakeChange, IsEverywhereWhereShadowsHaveNoBounds)
{
  PlanScene before = MakeScene();
  before.Surfaces.emplace_back(PlanScene::MakePlate({ 0.5, 0, 0 }, { 0.2, 0, 0 }, { 0, 0, 3 }));
  PlanScene now = before;
  ASSERT_TRUE(now.PlanFirst().IsUnbounded);
  ExpectNothing(Compare(before, now));
  now.Surfaces[1] = SharedSurface(PlanScene::MakeSquare(-0.5, -0.4, 0.5, 0.2));
  ExpectStale(Compare(before, now), Whole);
  now.Surfaces.pop_back();
  ASSERT_FALSE(now.PlanFirst().IsUnbounded);
  ExpectStale(Compare(before, now), Whole);
  ExpectStale(Compare(now, before), Whole);
}

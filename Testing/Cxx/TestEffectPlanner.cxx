// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a receiver and a light need, and why.

#include "DirectionalLight.h"
#include "DiskLight.h"
#include "OracleTestTools.h"
#include "PlanScene.h"
#include "PointLight.h"
#include "RandomPairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace
{

using penumbra::Effect;
using penumbra::PairPlan;
using penumbra::PolygonLight;
using penumbra::ReceiverPlan;
using penumbra::Surface;

void Expect(const PairPlan& pair, Effect effect, const std::string& reason)
{
  EXPECT_STREQ(GetEffectName(pair.Needed), GetEffectName(effect));
  EXPECT_EQ(pair.Reason, reason);
}

/// A lamp of 0.4 x 0.4 over the middle at a height of 2, and one surface or none.
PlanScene MakeScene(const std::vector<Surface>& occluders)
{
  PlanScene scene;
  scene.Lights = { PlanScene::MakeLamp(0, 0, 2, 0.4) };
  scene.Surfaces.insert(scene.Surfaces.end(), occluders.begin(), occluders.end());
  return scene;
}

/// What of a receiver's pyramid is at half of the way to the lamp: this wide.
constexpr double Crossing = 0.5 * (PlanScene::Edge + 0.4);

} // namespace

// ---- None ----

TEST(EffectPlanner, NoneForALightBehindTheReceiver)
{
  PlanScene scene = MakeScene({});
  scene.Lights = { PlanScene::MakeLamp(0, 0, -2, 0.4) };
  Expect(scene.PlanFirst(), Effect::None, "the light is behind the receiver");
}

TEST(EffectPlanner, NoneForADarkLight)
{
  PlanScene scene = MakeScene({});
  scene.Lights.front()->Radiance = glm::dvec3(0.0);
  Expect(scene.PlanFirst(), Effect::None, "the light is dark");
}

TEST(EffectPlanner, NoneForALightThatFacesAway)
{
  PlanScene scene = MakeScene({});
  PolygonLight lamp = PolygonLight::Parallelogram({ 0, 0, 2 }, { 1, 0, 2 }, { 0, 1, 2 });
  scene.Lights = { lamp };
  Expect(scene.PlanFirst(), Effect::None, "the light faces away");
  lamp.TwoSided = true;
  scene.Lights = { lamp };
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Unoccluded);
}

// A light alone is never too faint: it is all that there is.
TEST(EffectPlanner, NoneForALightThatIsTooFaint)
{
  PlanScene scene = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.5) });
  PolygonLight faint = PlanScene::MakeLamp(1, 0, 2, 0.4);
  faint.Radiance = glm::dvec3(1e-4);
  scene.Lights.push_back(faint);
  EXPECT_EQ(scene.Plan().Pairs[0].Needed, Effect::Soft);
  Expect(scene.Plan().Pairs[1], Effect::None, "too faint to matter");
  scene.GetSettings().PlannerTolerance = 0.0;
  EXPECT_EQ(scene.Plan().Pairs[1].Needed, Effect::Soft);
  scene.GetSettings() = PlanScene().GetSettings();
  scene.Lights = { faint };
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Soft);
}

// What is left out adds up to less than the tolerance, of the peak that there is without occluders,
// at any point and in every component.
TEST(EffectPlanner, LeavesOutNoMoreThanTheTolerance)
{
  std::size_t faint = 0, kept = 0;
  for (unsigned seed = 0; seed < 300; ++seed)
  {
    RandomGeometry random(seed);
    PlanScene scene;
    scene.GetSettings().PlannerTolerance = std::pow(10.0, random.Between(-4.0, -1.0));
    const penumbra::ReceiverFrame frame = scene.MakeFrame(scene.Receivers.front());
    for (int i = 0; i < 12; ++i)
    {
      scene.Lights.push_back(RandomLight(random, frame));
      scene.Lights.back()->Radiance *= std::pow(10.0, random.Between(-5.0, 0.0));
    }
    const ReceiverPlan plan = scene.Plan();
    double peak = 0.0, largest = 0.0;
    for (int i = 0; i < 21 * 21; ++i)
    {
      const glm::dvec3 x =
        frame.ToWorld({ (i % 21) / 20.0, static_cast<double>(i / 21) / 20.0, 0.0 });
      glm::dvec3 all(0.0), out(0.0);
      for (std::size_t l = 0; l < plan.Lights.size(); ++l)
      {
        const glm::dvec3 light = plan.Lights[l]->Irradiance(x, frame.GetNormal());
        all += light;
        out += plan.Pairs[l].Needed == Effect::None ? light : glm::dvec3(0.0);
      }
      peak = std::max(peak, (all.x + all.y + all.z) / 3.0);
      largest = std::max({ largest, out.x, out.y, out.z });
    }
    // The points at which the planner looks for the peak are among these.
    EXPECT_LE(largest, scene.GetSettings().PlannerTolerance * peak) << seed;
    for (const PairPlan& pair : plan.Pairs)
    {
      ++(pair.Reason == "too faint to matter" ? faint : kept);
    }
  }
  EXPECT_GT(faint, 300u);
  EXPECT_GT(kept, 300u);
}

// ---- Unoccluded ----

TEST(EffectPlanner, UnoccludedWithoutOccluders)
{
  Expect(MakeScene({}).PlanFirst(), Effect::Unoccluded, "no occluder is between them");
}

TEST(EffectPlanner, UnoccludedWhereAShadowFallsBesideTheReceiver)
{
  const PairPlan pair = MakeScene({ PlanScene::MakeSquare(3, 0, 1, 0.5) }).PlanFirst();
  Expect(pair, Effect::Unoccluded, "no occluder is between them");
  EXPECT_EQ(pair.Triangles, 0u);
}

// Walls stand on the receiver's border, or reach below it, or are higher than the lamp: they shade
// nothing of it.
TEST(EffectPlanner, UnoccludedInAnEmptyRoom)
{
  for (const double low : { 0.0, -0.1 })
  {
    for (const double height : { 2.0, 3.0, 100.0 })
    {
      const glm::dvec3 up(0.0, 0.0, height - low);
      const PairPlan pair = MakeScene({ PlanScene::MakePlate({ -1, -1, low }, { 2, 0, 0 }, up),
                                        PlanScene::MakePlate({ -1, 1, low }, { 2, 0, 0 }, up),
                                        PlanScene::MakePlate({ -1, -1, low }, { 0, 2, 0 }, up),
                                        PlanScene::MakePlate({ 1, -1, low }, { 0, 2, 0 }, up) })
                              .PlanFirst();
      Expect(pair, Effect::Unoccluded, "no occluder is between them");
    }
  }
}

// ---- Umbra ----

TEST(EffectPlanner, UmbraUnderOnePlate)
{
  const PairPlan pair = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 1.01 * Crossing) }).PlanFirst();
  Expect(pair, Effect::Umbra, "an occluder hides all of the light");
}

TEST(EffectPlanner, NoUmbraUnderAPlateThatIsTooSmall)
{
  EXPECT_EQ(MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.99 * Crossing) }).PlanFirst().Needed,
    Effect::Soft);
}

TEST(EffectPlanner, UmbraUnderAPlateOfManyTriangles)
{
  EXPECT_EQ(MakeScene({ PlanScene::MakeSquare(0, 0, 1, 1.01 * Crossing, 8) }).PlanFirst().Needed,
    Effect::Umbra);
}

TEST(EffectPlanner, NoUmbraUnderAPlateWithAHole)
{
  const Surface whole = PlanScene::MakeSquare(0, 0, 1, 1.01 * Crossing, 8);
  for (std::size_t hole = 0; hole < whole.Triangles.size(); hole += 9)
  {
    Surface plate = whole;
    plate.Triangles.erase(plate.Triangles.begin() + static_cast<std::ptrdiff_t>(hole));
    EXPECT_EQ(MakeScene({ plate }).PlanFirst().Needed, Effect::Soft) << hole;
  }
}

// Half a lamp each; a gap is as narrow as it may be.
TEST(EffectPlanner, UmbraUnderTwoPlatesOnlyWithoutAGap)
{
  const auto plan = [](double gap)
  {
    return MakeScene({ PlanScene::MakePlate({ -1, -1, 1 }, { 1, 0, 0 }, { 0, 2, 0 }),
                       PlanScene::MakePlate({ gap, -1, 1 }, { 1, 0, 0 }, { 0, 2, 0 }) })
      .PlanFirst();
  };
  static_assert(Crossing < 2.0, "the plates are wide enough");
  EXPECT_EQ(plan(0.0).Needed, Effect::Umbra);
  EXPECT_EQ(plan(-0.1).Needed, Effect::Umbra);
  EXPECT_EQ(plan(1e-6).Needed, Effect::Soft);
}

// Plates at two heights hide the light together, but no one of them does: that is for samples to
// find out.
TEST(EffectPlanner, NoUmbraUnderPlatesAtTwoHeights)
{
  EXPECT_EQ(MakeScene({ PlanScene::MakePlate({ -2, -2, 1 }, { 2, 0, 0 }, { 0, 4, 0 }),
                        PlanScene::MakePlate({ -0.1, -2, 0.9 }, { 2, 0, 0 }, { 0, 4, 0 }) })
              .PlanFirst()
              .Needed,
    Effect::Soft);
}

// The sun's penumbra is 0.0093 of the height: the plate of 2.1 covers 2.02.
TEST(EffectPlanner, UmbraUnderTheSun)
{
  PlanScene scene = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 2.1) });
  for (const double diameter : { 0.0, 0.53 })
  {
    scene.Lights = { penumbra::DirectionalLight({ 0, 0, -1 }, diameter) };
    EXPECT_EQ(scene.PlanFirst().Needed, Effect::Umbra);
    scene.Lights = { penumbra::DirectionalLight({ 0.1, 0, -1 }, diameter) };
    EXPECT_NE(scene.PlanFirst().Needed, Effect::Umbra);
  }
}

// Rays of a sun at the zenith are parallel to a wall and never meet it.
TEST(EffectPlanner, NoUmbraBehindAWallUnderTheZenith)
{
  PlanScene scene =
    MakeScene({ PlanScene::MakePlate({ 0, -100, -100 }, { 0, 200, 0 }, { 0, 0, 200 }) });
  scene.Lights = { penumbra::DirectionalLight({ 0, 0, -1 }, 0.0) };
  EXPECT_NE(scene.PlanFirst().Needed, Effect::Umbra);
}

// A disk is taken by the octagon around it, whose corners are 1 / cos(22.5 degrees) as far away:
// where a plate hides the disk but no corner, that is left to samples.
TEST(EffectPlanner, UmbraOfADiskAsOfTheOctagonAroundIt)
{
  constexpr double Radius = 0.3;
  const auto plan = [](double radius)
  {
    PlanScene scene = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.5 * PlanScene::Edge + radius) });
    scene.Lights = { penumbra::DiskLight({ 0, 0, 2 }, { 0, 0, -1 }, Radius) };
    return scene.PlanFirst().Needed;
  };
  EXPECT_EQ(plan(1.01 * Radius / std::cos(std::acos(-1.0) / 8.0)), Effect::Umbra);
  EXPECT_EQ(plan(0.99 * Radius), Effect::Soft);
}

// Where an umbra is found, every ray is blocked, whatever the light and the plate.
TEST(EffectPlanner, UmbraBlocksEveryRay)
{
  int umbras = 0;
  for (unsigned seed = 0; seed < 3000; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, RandomNearFrame);
    penumbra::Receiver receiver;
    receiver.Base = pair.Frame.GetBase();
    const glm::dvec3 middle = RandomPointOnRay(random, pair);
    const double size = std::pow(10.0, random.Between(-1.0, 1.0));
    const glm::dvec3 x = random.InBox(size), y = random.InBox(size);
    const Surface plate = PlanScene::MakePlate(pair.Frame.ToWorld(middle - 0.5 * (x + y)),
      pair.Frame.ToWorld(x) - pair.Frame.ToWorld({}),
      pair.Frame.ToWorld(y) - pair.Frame.ToWorld({}), 1 + static_cast<int>(random.Below(3)));
    penumbra::ShadowScene scene;
    scene.Surfaces = { Surface(), plate };
    penumbra::OccluderSelector occluders;
    occluders.SetScene(scene);
    occluders.SetReceiver(receiver, pair.Frame);
    occluders.Select(*pair.Seen);
    if (occluders.GetTriangles().empty() ||
      !penumbra::IsWhollyBlocked(pair.Frame, *pair.Seen, occluders))
    {
      continue;
    }
    ++umbras;
    oracletest::Occluders triangles;
    for (const Surface::Triangle& t : plate.Triangles)
    {
      const auto at = [&](std::size_t i)
      {
        const glm::dvec3 p = pair.Frame.ToFrame(plate.Points[t[i]]);
        return oracle::Vec3{ p.x, p.y, p.z };
      };
      triangles.push_back({ at(0), at(1), at(2) });
    }
    for (int i = 0; i < 50; ++i)
    {
      const glm::dvec3 from(random.Between(0.0, 1.0), random.Between(0.0, 1.0), 0.0);
      const penumbra::LightSample sample = RandomSample(random, *pair.Seen);
      const glm::dvec3 to = sample.IsDirection
        ? from + 1e4 * glm::normalize(pair.Frame.DirectionToFrame(sample.Place))
        : pair.Frame.ToFrame(sample.Place);
      EXPECT_TRUE(oracletest::Blocks(triangles, { from.x, from.y, from.z }, { to.x, to.y, to.z }))
        << seed;
    }
  }
  EXPECT_GT(umbras, 30);
}

// ---- Hard and Soft ----

TEST(EffectPlanner, HardForLightsWithoutExtent)
{
  PlanScene scene = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.5) });
  for (const penumbra::Light& light : { penumbra::Light(penumbra::PointLight({ 0, 0, 2 })),
         penumbra::Light(penumbra::DirectionalLight({ 0.1, 0, -1 }, 0.0)) })
  {
    scene.Lights = { light };
    scene.GetSettings().HardPenumbra = 1.0;
    Expect(scene.PlanFirst(), Effect::Hard, "the light has no extent");
    scene.GetSettings().HardPenumbra = 0.0;
    Expect(scene.PlanFirst(), Effect::Hard, "the light has no extent");
    scene.GetSettings().ErrorTolerance = 0.01;
    Expect(scene.PlanFirst(), Effect::Hard, "the light has no extent");
    scene.GetSettings().ErrorTolerance = 0.0;
  }
}

// A plate at half of the lamp's height has a penumbra as wide as the lamp in x and in y; across the
// corner that is sqrt(2) times as much.
class HardPenumbra : public testing::Test
{
protected:
  PlanScene MakeScene(double penumbraTexels)
  {
    PlanScene scene = ::MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.5) });
    const double texel = PlanScene::Edge / PlanScene::Side;
    scene.Lights = { PlanScene::MakeLamp(0, 0, 2, penumbraTexels / std::sqrt(2.0) * texel) };
    return scene;
  }
};

TEST_F(HardPenumbra, IsATexel)
{
  Expect(
    this->MakeScene(0.999).PlanFirst(), Effect::Hard, "no penumbra is wider than HardPenumbra");
  Expect(this->MakeScene(1.001).PlanFirst(), Effect::Soft, "penumbrae up to 2 texels wide");
}

TEST_F(HardPenumbra, IsWhatIsAskedFor)
{
  PlanScene scene = this->MakeScene(4.999);
  scene.GetSettings().HardPenumbra = 5.0;
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Hard);
  scene = this->MakeScene(5.001);
  scene.GetSettings().HardPenumbra = 5.0;
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Soft);
  scene = this->MakeScene(0.001);
  scene.GetSettings().HardPenumbra = 0.0;
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Soft);
}

TEST_F(HardPenumbra, IsNothingWhereAnAccuracyIsAskedFor)
{
  PlanScene scene = this->MakeScene(0.5);
  scene.GetSettings().ErrorTolerance = 0.01;
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Soft);
}

// Texels that are supersampled count.
TEST_F(HardPenumbra, IsATexelThatIsBaked)
{
  PlanScene scene = this->MakeScene(0.6);
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Hard);
  scene.GetSettings().Supersampling = 2;
  EXPECT_EQ(scene.Plan().Texels, glm::ivec2(2 * PlanScene::Side));
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::Soft);
}

// A square of 0.2 at half of the lamp's height: its shadows from the corners of the lamp, which are
// 0.2 off the middle, are 0.4 wide and 0.2 off it, so 0.4 around the middle; and a texel more.
TEST(EffectPlanner, SoftWithinTheShadowsRectangle)
{
  const PairPlan pair = MakeScene({ PlanScene::MakeSquare(0, 0, 1, 0.2) }).PlanFirst();
  EXPECT_EQ(pair.Needed, Effect::Soft);
  const int low = static_cast<int>(std::lround(0.3 * PlanScene::Side));
  EXPECT_LE(pair.Shaded.Low.x, low);
  EXPECT_GE(pair.Shaded.Low.x, low - 2);
  EXPECT_GE(pair.Shaded.High.y, PlanScene::Side - low);
  EXPECT_LE(pair.Shaded.High.y, PlanScene::Side - low + 2);
  EXPECT_EQ(pair.Triangles, 2u);
  ASSERT_EQ(pair.Casters.size(), 1u);
  EXPECT_EQ(pair.Casters.front().Shadow, pair.Shaded);
}

TEST(EffectPlanner, SoftWhereAnOccluderReachesTheLightsHeight)
{
  const PairPlan pair =
    MakeScene({ PlanScene::MakePlate({ 0.5, 0, 0 }, { 0.2, 0, 0 }, { 0, 0, 3 }) }).PlanFirst();
  Expect(pair, Effect::Soft, "an occluder reaches the light's height");
  EXPECT_TRUE(pair.IsUnbounded);
  EXPECT_EQ(pair.Shaded, penumbra::WholeRectangle(glm::ivec2(PlanScene::Side)));
}

// ---- Off ----

TEST(EffectPlanner, DecidesNothingWhereItIsOff)
{
  std::vector<Surface> occluders = { PlanScene::MakeSquare(0, 0, 1, 10.0),
    PlanScene::MakeSquare(50, 0, 1, 0.5), PlanScene::MakeSquare(0, 0, 7, 0.5) };
  PlanScene scene = MakeScene(occluders);
  scene.GetSettings().Planner = false;
  PolygonLight faint = PlanScene::MakeLamp(1, 0, 2, 0.4);
  faint.Radiance = glm::dvec3(1e-9);
  scene.Lights.push_back(faint);
  scene.Lights.push_back(penumbra::PointLight({ 0, 0, 2 }));
  const ReceiverPlan plan = scene.Plan();
  for (const PairPlan& pair : plan.Pairs)
  {
    Expect(pair, Effect::Soft, "the planner is off");
    EXPECT_EQ(pair.Shaded, penumbra::WholeRectangle(plan.Texels));
    EXPECT_EQ(pair.Triangles, 6u);
  }
  scene.Lights = { PlanScene::MakeLamp(0, 0, -2, 0.4) };
  EXPECT_EQ(scene.PlanFirst().Needed, Effect::None);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is seen of a polygon without samples: against the exact answer in long double, against rays,
// and where rounding is all that there is.

#include "LargestDeviation.h"
#include "OccluderSelector.h"
#include "OracleScene.h"
#include "OracleTestTools.h"
#include "PlanScene.h"
#include "PolygonVisibility.h"
#include "RandomPairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace
{

using penumbra::PolygonLight;
using penumbra::PolygonVisibility;

constexpr int Rounds = 300;

PolygonLight RandomPolygon(RandomGeometry& random, const penumbra::ReceiverFrame& frame)
{
  const auto place = [&] { return frame.ToWorld(random.InBox(1.0) + glm::dvec3(0.5, 0.5, 2.0)); };
  const glm::dvec3 a = place(), b = place(), c = place();
  return random.Below(2) == 0 ? PolygonLight::Triangle(a, b, c)
                              : PolygonLight::Parallelogram(a, b, c);
}

/// Triangles of the frame's space, some of them through the receiver or the light.
std::vector<oracle::Triangle> RandomTriangles(
  RandomGeometry& random, const penumbra::ReceiverFrame& frame, std::size_t count)
{
  std::vector<oracle::Triangle> triangles;
  while (triangles.size() < count)
  {
    const glm::dvec3 centre = random.InBox(1.0) + glm::dvec3(0.5, 0.5, 1.0);
    const auto corner = [&] { return ToOracle(frame.ToWorld(centre + random.InBox(0.6))); };
    const oracle::Vec3 a = corner(), b = corner(), c = corner();
    triangles.push_back({ a, b, c });
  }
  return triangles;
}

/// A receiver under one polygon, and what is found of that.
struct Scene
{
  penumbra::ReceiverFrame Frame;
  PolygonLight Seen;
  std::vector<oracle::Triangle> Occluders;
  std::optional<PolygonVisibility> Visibility;

  Scene(const penumbra::ReceiverFrame& frame, const PolygonLight& light,
    const std::vector<oracle::Triangle>& occluders)
    : Frame(frame)
    , Seen(light.ClippedToFront(frame.GetBase().Corner, frame.GetNormal()))
    , Occluders(occluders)
  {
    penumbra::Surface floor, surface;
    const penumbra::Parallelogram& b = frame.GetBase();
    floor.Points = { b.Corner, b.Corner + b.EdgeX, b.Corner + b.EdgeY };
    floor.Triangles = { { 0, 1, 2 } };
    floor.Regions = { 0 };
    for (const oracle::Triangle& t : occluders)
    {
      const auto first = static_cast<std::uint32_t>(surface.Points.size());
      surface.Points.insert(
        surface.Points.end(), { FromOracle(t.A), FromOracle(t.B), FromOracle(t.C) });
      surface.Triangles.push_back({ first, first + 1, first + 2 });
    }
    penumbra::ShadowScene scene;
    scene.Surfaces = { floor, surface };
    penumbra::Receiver receiver;
    receiver.Base = b;
    scene.Receivers = { receiver };
    penumbra::OccluderSelector selector;
    selector.SetScene(scene);
    selector.SetReceiver(scene.Receivers.front(), frame);
    selector.Select(this->Seen);
    this->Visibility.emplace(frame, this->Seen, selector);
  }

  PolygonVisibility::Indices FindAll() const
  {
    return this->Visibility->FindNear({ 0, 0 }, { 1, 1 });
  }

  std::optional<double> FindShare(const glm::dvec2& uv) const
  {
    return this->Visibility->FindShare(uv, this->FindAll());
  }

  /// The oracle's answer; none where the light sends nothing.
  std::optional<long double> GetExact(const glm::dvec2& uv) const
  {
    oracle::Light light;
    light.TwoSided = true;
    for (const glm::dvec3& vertex : this->Seen.GetVertices())
    {
      light.Vertices.push_back(ToOracle(vertex));
    }
    const oracle::Vec3 x = ToOracle(this->Frame.ToWorld({ uv, 0.0 }));
    const oracle::Vec3 normal = ToOracle(this->Frame.GetNormal());
    const long double all = oracle::FormFactor(x, normal, light);
    return all > 1e-12L
      ? std::optional(oracle::VisibleFormFactor(x, normal, light, this->Occluders) / all)
      : std::nullopt;
  }
};

/// Compares random points with the oracle; the answer is how many see some of the light.
int CompareWithOracle(const Scene& scene, RandomGeometry& random, LargestDeviation& largest)
{
  int partial = 0;
  for (int i = 0; i < 10 && scene.Seen.IsValid(); ++i)
  {
    const glm::dvec2 uv(random.Between(0.0, 1.0), random.Between(0.0, 1.0));
    const std::optional<long double> exact = scene.GetExact(uv);
    const std::optional<double> share = scene.FindShare(uv);
    EXPECT_TRUE(share || !exact);
    if (share && exact)
    {
      EXPECT_LE(largest.Add(*share - *exact), 1e-9);
      partial += *share > 1e-6 && *share < 1.0 - 1e-6 ? 1 : 0;
    }
  }
  return partial;
}

} // namespace

TEST(PolygonVisibility, IsTheExactShare)
{
  LargestDeviation largest;
  int partial = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const penumbra::ReceiverFrame frame = RandomNearFrame(random);
    const PolygonLight light = RandomPolygon(random, frame);
    const Scene scene(frame, light, RandomTriangles(random, frame, 1 + random.Below(12)));
    partial += CompareWithOracle(scene, random, largest);
  }
  EXPECT_GT(partial, 5 * Rounds);
}

// By rays, which share nothing with what cuts polygons.
TEST(PolygonVisibility, IsTheShareOfTheRays)
{
  constexpr int Scenes = 40;
  oracletest::Random oracleRandom(1);
  int beyond = 0, compared = 0;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    RandomGeometry random(seed);
    const penumbra::ReceiverFrame frame = RandomNearFrame(random);
    const glm::dvec3 up = frame.GetSize() * frame.GetNormal();
    const glm::dvec3 centre = frame.ToWorld({ 0.5, 0.5, 2.0 });
    const PolygonLight light =
      PolygonLight::Parallelogram(centre, centre + frame.GetBase().EdgeX + 0.2 * up,
        centre + 0.5 * (frame.GetBase().EdgeY - frame.GetBase().EdgeX));
    const Scene scene(frame, light, RandomTriangles(random, frame, 8));
    const glm::dvec2 uv(random.Between(0.0, 1.0), random.Between(0.0, 1.0));
    const std::optional<double> share = scene.FindShare(uv);
    const glm::dvec3 x = frame.ToWorld({ uv, 0.0 });
    const auto send = [&](long double s, long double t, bool withOccluders) -> long double
    {
      const glm::dvec3 y = light.Sample({ static_cast<double>(s), static_cast<double>(t) });
      const glm::dvec3 d = y - x;
      const double r2 = glm::dot(d, d);
      const bool isBlocked =
        withOccluders && oracletest::Blocks(scene.Occluders, ToOracle(x), ToOracle(y));
      return isBlocked
        ? 0.0
        : glm::dot(d, frame.GetNormal()) * std::abs(glm::dot(d, light.GetNormal())) / (r2 * r2);
    };
    const oracletest::Estimate seen = oracletest::Quadrature(
      [&](long double s, long double t) { return send(s, t, true); }, 60, oracleRandom);
    const oracletest::Estimate all = oracletest::Quadrature(
      [&](long double s, long double t) { return send(s, t, false); }, 60, oracleRandom);
    ASSERT_TRUE(share);
    ++compared;
    const long double error = (seen.StandardError + all.StandardError) / all.Mean;
    beyond += std::abs(*share - seen.Mean / all.Mean) > 3.0L * error + 1e-4L ? 1 : 0;
  }
  EXPECT_EQ(compared, Scenes);
  EXPECT_LE(beyond, 1); // three standard errors: 0.3 %
}

// What a part of the receiver needs is enough for its points, to the bit, and less than all.
TEST(PolygonVisibility, NeedsOnlyWhatIsNear)
{
  std::size_t few = 0, all = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const penumbra::ReceiverFrame frame = RandomNearFrame(random);
    const Scene scene(frame, RandomPolygon(random, frame), RandomTriangles(random, frame, 30));
    if (!scene.Seen.IsValid())
    {
      continue;
    }
    const glm::dvec2 low(random.Between(0.0, 0.9), random.Between(0.0, 0.9));
    const PolygonVisibility::Indices nearby = scene.Visibility->FindNear(low, low + 0.1);
    few += nearby.size();
    all += scene.FindAll().size();
    for (int i = 0; i < 10; ++i)
    {
      const glm::dvec2 uv = low + glm::dvec2(random.Between(0.0, 0.1), random.Between(0.0, 0.1));
      EXPECT_EQ(scene.Visibility->FindShare(uv, nearby), scene.FindShare(uv)) << seed;
    }
  }
  EXPECT_GT(few, 0u);
  EXPECT_LT(few, all);
}

// Walls that stand on the lines between parts, and across their corners, seen from either side.
TEST(PolygonVisibility, NeedsWallsThatStandOnTheBordersOfParts)
{
  const penumbra::ReceiverFrame frame(
    { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, penumbra::ReceiverFrame::Side::Front);
  constexpr int Parts = 16, Points = 8;
  int shaded = 0;
  for (const oracle::Vec3& along : { oracle::Vec3{ 0, 1, 0 }, oracle::Vec3{ 1, 0, 0 },
         oracle::Vec3{ 1, -1, 0 }, oracle::Vec3{ 1, 1, 0 } })
  {
    const oracle::Vec3 a = -1 * along, up{ 0, 0, 0.0625L };
    for (const bool isTurned : { false, true })
    {
      std::vector<oracle::Triangle> wall = { { a, along, along + up }, { a, along + up, a + up } };
      for (oracle::Triangle& t : wall)
      {
        t = isTurned ? oracle::Triangle{ t.A, t.C, t.B } : t;
      }
      const Scene scene(frame, PlanScene::MakeLamp(-0.6, 0.4, 2, 0.4), wall);
      for (int part = 0; part < Parts * Parts; ++part)
      {
        const glm::dvec2 low = glm::dvec2(part % Parts, part / Parts) / double(Parts);
        const PolygonVisibility::Indices nearby =
          scene.Visibility->FindNear(low, low + 1.0 / Parts);
        for (int i = 0; i < Points * Points; ++i)
        {
          const glm::dvec2 uv =
            low + (glm::dvec2(i % Points, i / Points) + 0.5) / double(Parts * Points);
          const std::optional<double> share = scene.FindShare(uv);
          EXPECT_EQ(scene.Visibility->FindShare(uv, nearby), share) << uv.x << " " << uv.y;
          shaded += share && *share < 0.9 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(shaded, 100);
}

// A light with a corner on the receiver and another one below it: cut, it has an edge that is
// nothing but rounding.
TEST(PolygonVisibility, IsExactForLightsThatAReceiverCuts)
{
  LargestDeviation largest;
  int partial = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const penumbra::ReceiverFrame frame = RandomNearFrame(random);
    const auto at = [&](double h) {
      return frame.ToWorld({ random.Between(-1.0, 2.0), random.Between(-1.0, 2.0), h });
    };
    const glm::dvec3 on = at(0.0), below = at(-random.Between(0.1, 1.0)),
                     above = at(random.Between(0.5, 2.0));
    PolygonLight light = PolygonLight::Triangle(on, below, above);
    const Scene scene(frame, light, RandomTriangles(random, frame, 6));
    partial += CompareWithOracle(scene, random, largest);
  }
  EXPECT_GT(partial, 3 * Rounds);
}

// A mesh has no cracks, and what it leaves has no seams: nothing is seen through a plate of many
// triangles, all of the light past it, and exactly half of it along its edge.
TEST(PolygonVisibility, HasNoCracks)
{
  const penumbra::ReceiverFrame frame(
    { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp = PlanScene::MakeLamp(0, 0, 2, 0.2);
  std::vector<oracle::Triangle> triangles;
  const penumbra::Surface plate =
    PlanScene::MakePlate({ -0.31, -0.37, 1 }, { 0.31, 0, 0 }, { 0, 0.71, 0 }, 7);
  for (const penumbra::Surface::Triangle& t : plate.Triangles)
  {
    triangles.push_back(
      { ToOracle(plate.Points[t[0]]), ToOracle(plate.Points[t[1]]), ToOracle(plate.Points[t[2]]) });
  }
  const Scene scene(frame, lamp, triangles);
  EXPECT_NEAR(*scene.FindShare({ 0.4, 0.5 }), 0.0, 1e-12);
  EXPECT_EQ(*scene.FindShare({ 0.9, 0.5 }), 1.0);
  EXPECT_NEAR(*scene.FindShare({ 0.5, 0.5 }), 0.5, 1e-12);
}

// The point that looks lies in a triangle's plane, on its edge, at its corner; the light touches
// triangles, or is cut by them.
TEST(PolygonVisibility, BearsContact)
{
  const penumbra::ReceiverFrame frame(
    { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp = PlanScene::MakeLamp(0, 0, 2, 0.5);
  const std::vector<oracle::Triangle> wall = { { { 0, -1, 0 }, { 0, 1, 0 }, { 0, 1, 2 } },
    { { 0, -1, 0 }, { 0, 1, 2 }, { 0, -1, 2 } } };
  const Scene standing(frame, lamp, wall);
  EXPECT_FALSE(standing.FindShare({ 0.5, 0.5 })) << "on which side of the wall is its foot?";
  const Scene aside(frame, lamp, { { { 0, -1, 0 }, { 0, -0.5, 0 }, { 0, -0.5, 2 } } });
  EXPECT_EQ(*aside.FindShare({ 0.5, 0.5 }), 1.0) << "edge-on, a wall hides nothing";
  for (const double side : { -1.0, 1.0 })
  {
    for (const double distance : { 1e-12, 1e-9, 1e-3, 0.4 })
    {
      const glm::dvec2 uv(0.5 + side * distance, 0.43);
      EXPECT_NEAR(*standing.FindShare(uv), static_cast<double>(*standing.GetExact(uv)), 1e-9)
        << side * distance;
    }
  }
  const Scene corner(frame, lamp, { { { 0, 0, 0 }, { 1, 0.2, 1 }, { 0.2, 1, 1.5 } } });
  EXPECT_FALSE(corner.FindShare({ 0.5, 0.5 }));
  for (const double distance : { 1e-11, 1e-6 })
  {
    const glm::dvec2 uv(0.5 + distance, 0.5);
    EXPECT_NEAR(*corner.FindShare(uv), static_cast<double>(*corner.GetExact(uv)), 1e-4);
  }
  const Scene through(frame, lamp, { { { -1, -1, 1.5 }, { 1, -1, 1.5 }, { 0, 1, 2.5 } } });
  for (const double v : { 0.2, 0.5, 0.8 })
  {
    const glm::dvec2 uv(0.45, v);
    EXPECT_NEAR(*through.FindShare(uv), static_cast<double>(*through.GetExact(uv)), 1e-9) << v;
  }
}

// Many slits leave too many pieces: samples are better at that.
TEST(PolygonVisibility, LeavesWhatIsNotSimple)
{
  const penumbra::ReceiverFrame frame(
    { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp = PlanScene::MakeLamp(0, 0, 2, 1.0);
  std::vector<oracle::Triangle> comb;
  // The light's width is twice that of what casts shadows on it.
  const int teeth = 2 * static_cast<int>(PolygonVisibility::MaximumPieces);
  for (int i = 0; i < teeth; ++i)
  {
    const long double x = -0.25L + 0.5L * i / teeth, width = 0.25L / teeth;
    comb.push_back({ { x, -1, 1 }, { x + width, -1, 1 }, { x, 1, 1 } });
  }
  const Scene scene(frame, lamp, comb);
  EXPECT_FALSE(scene.FindShare({ 0.5, 0.5 }));
}

// Where it is only rounding, nothing is said; up to there, the answer is good.
TEST(PolygonVisibility, LeavesWhatRoundingDecides)
{
  const penumbra::ReceiverFrame frame(
    { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, penumbra::ReceiverFrame::Side::Front);
  const std::vector<oracle::Triangle> half = { { { 0, -9, 1 }, { 9, 0, 1 }, { 0, 9, 1 } } };
  for (const double height : { 1e1, 1e3, 1e5, 1e7 })
  {
    const Scene scene(frame, PlanScene::MakeLamp(0, 0, height, 1), half);
    const std::optional<double> share = scene.FindShare({ 0.5, 0.5 });
    ASSERT_TRUE(share) << height;
    EXPECT_NEAR(*share, 0.5, 1e-7) << height;
  }
  EXPECT_FALSE(Scene(frame, PlanScene::MakeLamp(0, 0, 1e10, 1), half).FindShare({ 0.5, 0.5 }));
  const PolygonLight beside = PolygonLight::Parallelogram({ 2, -1, 1 }, { 2, 1, 1 }, { 3, -1, 2 });
  const Scene edgeOn(frame, beside, half);
  EXPECT_TRUE(edgeOn.FindShare({ 0.9, 0.5 }));
  EXPECT_FALSE(edgeOn.FindShare({ 1.0, 0.5 })) << "the point is in the light's plane";
}

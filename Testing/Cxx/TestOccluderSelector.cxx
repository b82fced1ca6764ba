// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which triangles may block: against a look at every triangle of the scene, and against rays.

#include "BlockingRegion.h"
#include "OccluderSelector.h"
#include "OracleTestTools.h"
#include "PolygonLight.h"
#include "RandomPairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace
{

using penumbra::BlockingRegion;
using penumbra::OccluderSelector;
using penumbra::PolygonLight;
using penumbra::Surface;
using Corners = std::array<glm::dvec3, 3>;
using Triangles = std::vector<Corners>;

void AddTriangle(Surface& surface, const Corners& corners)
{
  const auto first = static_cast<std::uint32_t>(surface.Points.size());
  surface.Points.insert(surface.Points.end(), corners.begin(), corners.end());
  surface.Triangles.push_back({ first, first + 1, first + 2 });
}

/// The receiver as surface 0, and so many surfaces of triangles around it.
penumbra::ShadowScene MakeScene(
  const penumbra::ReceiverFrame& frame, const std::vector<Surface>& occluders)
{
  penumbra::Receiver receiver;
  receiver.Base = frame.GetBase();
  const penumbra::Parallelogram& b = receiver.Base;
  Surface floor;
  AddTriangle(floor, { b.Corner, b.Corner + b.EdgeX, b.Corner + b.EdgeX + b.EdgeY });
  AddTriangle(floor, { b.Corner, b.Corner + b.EdgeX + b.EdgeY, b.Corner + b.EdgeY });
  floor.Regions = { 0, 0 };
  penumbra::ShadowScene scene;
  scene.Surfaces = { floor };
  scene.Surfaces.insert(scene.Surfaces.end(), occluders.begin(), occluders.end());
  scene.Receivers = { receiver };
  return scene;
}

/// Enough triangles for trees of some levels, many of them out of the way; few as large as the
/// receiver.
std::vector<Surface> RandomOccluders(RandomGeometry& random, const penumbra::ReceiverFrame& frame)
{
  std::vector<Surface> surfaces(4);
  for (Surface& surface : surfaces)
  {
    const double spread = random.Between(0.5, 10.0);
    for (int i = 0; i < 300; ++i)
    {
      const glm::dvec3 centre = random.InBox(spread);
      const double size = std::pow(10.0, random.Between(-2.0, 0.0));
      AddTriangle(surface,
        { frame.ToWorld(centre + random.InBox(size)), frame.ToWorld(centre + random.InBox(size)),
          frame.ToWorld(centre + random.InBox(size)) });
    }
  }
  return surfaces;
}

bool IsBefore(const Corners& a, const Corners& b)
{
  for (std::size_t i = 0; i < 9; ++i)
  {
    const int axis = static_cast<int>(i % 3);
    if (a[i / 3][axis] != b[i / 3][axis])
    {
      return a[i / 3][axis] < b[i / 3][axis];
    }
  }
  return false;
}

Triangles Sorted(Triangles triangles)
{
  std::sort(triangles.begin(), triangles.end(), IsBefore);
  return triangles;
}

Triangles GetSelected(const OccluderSelector& selector)
{
  Triangles triangles;
  for (const Surface::Triangle& t : selector.GetTriangles())
  {
    const std::vector<glm::dvec3>& points = selector.GetPoints();
    triangles.push_back({ points[t[0]], points[t[1]], points[t[2]] });
  }
  return triangles;
}

/// Of the occluders, what is not all below the receiver, in its frame; none of these scenes has
/// anything in the plane of the receiver or of a light.
Triangles GetAllAbove(const penumbra::ShadowScene& scene, const penumbra::ReceiverFrame& frame)
{
  Triangles triangles;
  for (std::size_t s = 1; s < scene.Surfaces.size(); ++s)
  {
    const Surface& surface = *scene.Surfaces[s];
    for (const Surface::Triangle& t : surface.Triangles)
    {
      const Corners corners{ frame.ToFrame(surface.Points[t[0]]),
        frame.ToFrame(surface.Points[t[1]]), frame.ToFrame(surface.Points[t[2]]) };
      if (std::max({ corners[0].z, corners[1].z, corners[2].z }) > 0.0)
      {
        triangles.push_back(corners);
      }
    }
  }
  return triangles;
}

/// Those that may be in a region, sorted.
Triangles Select(const Triangles& triangles, const BlockingRegion& region)
{
  Triangles selected;
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(selected),
    [&](const Corners& t) { return region.MayHold(t[0], t[1], t[2]); });
  return Sorted(selected);
}

oracle::Vec3 ToVec3(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

bool IsBlocked(const Triangles& triangles, const glm::dvec3& from, const glm::dvec3& to)
{
  return std::any_of(triangles.begin(), triangles.end(),
    [&](const Corners& t)
    {
      return oracletest::Blocks(
        { ToVec3(t[0]), ToVec3(t[1]), ToVec3(t[2]) }, ToVec3(from), ToVec3(to));
    });
}

constexpr int Rounds = 200;

} // namespace

// Rays start at texels' centres, and so from a little within the range: a hundredth of the smallest
// texel there is.
TEST(OccluderSelector, SelectsWhatALookAtAllTrianglesDoes)
{
  std::size_t few = 0, all = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, RandomNearFrame);
    const penumbra::ShadowScene scene = MakeScene(pair.Frame, RandomOccluders(random, pair.Frame));
    const Triangles above = GetAllAbove(scene, pair.Frame);
    constexpr double Within = 0.01 / penumbra::ShadowScene::MaximumTextureSide;
    const Triangles allowed = Select(above, BlockingRegion(pair.Frame, *pair.Seen, pair.Range));
    const Triangles needed = Select(above,
      BlockingRegion(
        pair.Frame, *pair.Seen, pair.Range + glm::dvec4(Within, Within, -Within, -Within)));

    OccluderSelector selector;
    selector.SetScene(scene);
    selector.SetReceiver(scene.Receivers.front(), pair.Frame);
    // What was selected before does not matter.
    selector.SelectAll(*pair.Seen);
    EXPECT_EQ(Sorted(GetSelected(selector)), Sorted(above)) << seed;
    selector.Select(*pair.Seen, pair.Range);
    const Triangles selected = Sorted(GetSelected(selector));
    EXPECT_TRUE(
      std::includes(allowed.begin(), allowed.end(), selected.begin(), selected.end(), IsBefore))
      << seed;
    EXPECT_TRUE(
      std::includes(selected.begin(), selected.end(), needed.begin(), needed.end(), IsBefore))
      << seed;
    few += selected.size();
    all += above.size();
  }
  EXPECT_GT(few, all / 50);
  EXPECT_LT(few, all / 2);
}

TEST(OccluderSelector, NamesTheSurfacesInTheirOrder)
{
  const penumbra::ReceiverFrame frame(
    penumbra::Parallelogram(), penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp = PolygonLight::Triangle({ 0, 0, 3 }, { 0, 1, 3 }, { 1, 0, 3 });
  RandomGeometry random(1);
  std::vector<Surface> surfaces(20);
  for (Surface& surface : surfaces)
  {
    const glm::dvec3 place(random.Between(0.0, 1.0), random.Between(0.0, 1.0), 0.5);
    for (std::size_t count = 1 + random.Below(3); count > 0; --count)
    {
      AddTriangle(surface, { place, place + random.InBox(0.1), place + random.InBox(0.1) });
    }
  }
  const penumbra::ShadowScene scene = MakeScene(frame, surfaces);
  OccluderSelector selector;
  selector.SetScene(scene);
  selector.SetReceiver(scene.Receivers.front(), frame);
  selector.Select(lamp);
  ASSERT_EQ(selector.GetCasters().size(), surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    EXPECT_EQ(selector.GetCasters()[i].Surface, i + 1);
    EXPECT_EQ(selector.GetCasters()[i].Triangles, surfaces[i].Triangles.size());
  }
}

// Triangles that go far beyond are cut: what is left of them blocks the same rays, and none of it
// is far.
TEST(OccluderSelector, CutsWhatIsFar)
{
  int blocked = 0, open = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, RandomNearFrame);
    Surface large;
    for (int i = 0; i < 3; ++i)
    {
      const auto distant = [&] { return pair.Frame.ToWorld(random.InBox(1000.0)); };
      AddTriangle(
        large, { pair.Frame.ToWorld(RandomPointOnRay(random, pair)), distant(), distant() });
    }
    const penumbra::ShadowScene scene = MakeScene(pair.Frame, { large });
    OccluderSelector selector;
    selector.SetScene(scene);
    selector.SetReceiver(scene.Receivers.front(), pair.Frame);
    selector.Select(*pair.Seen);
    const Triangles cut = GetSelected(selector), whole = GetAllAbove(scene, pair.Frame);
    for (int i = 0; i < 50; ++i)
    {
      const glm::dvec3 from(random.Between(0.0, 1.0), random.Between(0.0, 1.0), 0.0);
      const penumbra::LightSample sample = RandomSample(random, *pair.Seen);
      const glm::dvec3 to = sample.IsDirection
        ? from + 1e4 * glm::normalize(pair.Frame.DirectionToFrame(sample.Place))
        : pair.Frame.ToFrame(sample.Place);
      const bool isBlocked = IsBlocked(whole, from, to);
      EXPECT_EQ(IsBlocked(cut, from, to), isBlocked) << seed;
      ++(isBlocked ? blocked : open);
    }
  }
  EXPECT_GT(blocked, Rounds);
  EXPECT_GT(open, Rounds);
}

TEST(OccluderSelector, LeavesOutWhatBlocksNothing)
{
  const penumbra::ReceiverFrame frame(
    penumbra::Parallelogram(), penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp =
    PolygonLight::Parallelogram({ 0.4, 0.4, 2 }, { 0.4, 0.6, 2 }, { 0.6, 0.4, 2 });
  const auto count = [&](const Corners& corners)
  {
    Surface surface;
    AddTriangle(surface, corners);
    const penumbra::ShadowScene scene = MakeScene(frame, { surface });
    OccluderSelector selector;
    selector.SetScene(scene);
    selector.SetReceiver(scene.Receivers.front(), frame);
    selector.Select(lamp);
    return selector.GetTriangles().size();
  };
  EXPECT_EQ(count({ { { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } } }), 1u) << "between them";
  EXPECT_EQ(count({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } }), 0u) << "a rug";
  EXPECT_EQ(count({ { { 0, 0, 2 }, { 1, 0, 2 }, { 0, 1, 2 } } }), 0u) << "a ceiling";
  EXPECT_EQ(count({ { { 0, 0, 3 }, { 1, 0, 3 }, { 0, 1, 3 } } }), 0u) << "above the lamp";
  EXPECT_EQ(count({ { { 0, 0, -1 }, { 1, 0, -1 }, { 0, 1, -1 } } }), 0u) << "below the receiver";
  EXPECT_EQ(count({ { { 2, 0, 1 }, { 3, 0, 1 }, { 2, 1, 1 } } }), 0u) << "beside them";
  EXPECT_EQ(count({ { { 0, 0, 1 }, { 1, 0, 1 }, { 0.5, 0, 1 } } }), 0u) << "without area";
}

// A receiver's own triangles block nothing on it; another region of its surface does.
TEST(OccluderSelector, TakesOtherRegionsOfTheReceiversSurface)
{
  const penumbra::ReceiverFrame frame(
    penumbra::Parallelogram(), penumbra::ReceiverFrame::Side::Front);
  const PolygonLight lamp =
    PolygonLight::Parallelogram({ 0.4, 0.4, 2 }, { 0.4, 0.6, 2 }, { 0.6, 0.4, 2 });
  penumbra::ShadowScene scene = MakeScene(frame, {});
  Surface step = *scene.Surfaces.front();
  AddTriangle(step, { { { 0.4, 0.4, 0.2 }, { 0.6, 0.4, 0.2 }, { 0.4, 0.6, 0.2 } } });
  const auto count = [&](int region)
  {
    step.Regions = { 0, 0, region };
    scene.Surfaces = { step };
    OccluderSelector selector;
    selector.SetScene(scene);
    selector.SetReceiver(scene.Receivers.front(), frame);
    selector.Select(lamp);
    return selector.GetTriangles().size();
  };
  EXPECT_EQ(count(1), 1u);
  EXPECT_EQ(count(0), 0u);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Random scenes make sense, and those that fail become small.

#include "FuzzedScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace
{

constexpr unsigned Seeds = 500;

std::string ToText(const FuzzedScene& scene)
{
  std::ostringstream text;
  text << scene;
  return text.str();
}

} // namespace

TEST(FuzzedScene, MakesSense)
{
  std::set<penumbra::LightKind> kinds;
  for (const FuzzedKind kind : { FuzzedKind::Tame, FuzzedKind::Nasty })
  {
    for (unsigned seed = 0; seed < Seeds; ++seed)
    {
      const FuzzedScene scene = MakeFuzzedScene(seed, kind);
      EXPECT_TRUE(MakesSense(scene)) << seed << "\n" << scene;
      for (const FuzzedLight& light : scene.Lights)
      {
        kinds.insert(light.Settings.Shape);
      }
    }
  }
  EXPECT_EQ(kinds.size(), 7u) << "all kinds of lights";
}

TEST(FuzzedScene, IsTheSameEachTime)
{
  EXPECT_EQ(
    ToText(MakeFuzzedScene(7, FuzzedKind::Nasty)), ToText(MakeFuzzedScene(7, FuzzedKind::Nasty)));
  EXPECT_NE(
    ToText(MakeFuzzedScene(7, FuzzedKind::Nasty)), ToText(MakeFuzzedScene(8, FuzzedKind::Nasty)));
}

// "There are at most two triangles" is no property of scenes: it breaks with three, and nothing
// else is needed.
TEST(FuzzedScene, ShrinksToThreeTriangles)
{
  int tried = 0;
  for (unsigned seed = 0; seed < Seeds; ++seed)
  {
    const FuzzedScene scene = MakeFuzzedScene(seed, FuzzedKind::Nasty);
    if (scene.Occluders.size() <= 2)
    {
      continue;
    }
    ++tried;
    const FuzzedScene small =
      Shrink(scene, [](const FuzzedScene& s) { return s.Occluders.size() > 2; });
    EXPECT_EQ(small.Occluders.size(), 3u) << seed;
    EXPECT_EQ(small.Lights.size(), 0u) << seed;
    EXPECT_EQ(small.Texels, glm::ivec2(1)) << seed;
    EXPECT_EQ(small.Settings.LightSamples, 1) << seed;
    for (const FuzzedTriangle& triangle : small.Occluders)
    {
      EXPECT_EQ(triangle[0], glm::round(triangle[0])) << seed;
    }
  }
  EXPECT_GT(tried, 100);
}

// What a failure needs stays: these two lights out of three, and 5 samples.
TEST(FuzzedScene, ShrinksToWhatIsNeeded)
{
  const auto fails = [](const FuzzedScene& s)
  {
    const auto has = [&](penumbra::LightKind kind)
    {
      return std::any_of(s.Lights.begin(), s.Lights.end(),
        [&](const FuzzedLight& light) { return light.Settings.Shape == kind; });
    };
    return has(penumbra::LightKind::Disk) && has(penumbra::LightKind::Surface) &&
      s.Settings.LightSamples >= 5;
  };
  int tried = 0;
  for (unsigned seed = 0; seed < Seeds; ++seed)
  {
    const FuzzedScene scene = MakeFuzzedScene(seed, FuzzedKind::Nasty);
    if (!fails(scene))
    {
      continue;
    }
    ++tried;
    const FuzzedScene small = Shrink(scene, fails);
    EXPECT_TRUE(fails(small) && MakesSense(small)) << seed;
    EXPECT_EQ(small.Lights.size(), 2u) << seed;
    EXPECT_EQ(small.Settings.LightSamples, 5) << seed;
    EXPECT_EQ(small.Occluders.size(), 0u) << seed;
  }
  EXPECT_GT(tried, 10);
}

TEST(FuzzedScene, DoesNotShrinkWhatHolds)
{
  const FuzzedScene scene = MakeFuzzedScene(3, FuzzedKind::Nasty);
  EXPECT_EQ(ToText(Shrink(scene, [](const FuzzedScene&) { return false; })), ToText(scene));
}

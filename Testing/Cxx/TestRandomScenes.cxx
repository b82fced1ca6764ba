// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The random scenes are what their header says, and their answers are finite.

#include "RandomScenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <variant>

namespace
{

using oracle::AnyLight;
using oracle::RandomScene;
using oracle::Vec3;

constexpr unsigned Scenes = 100;

} // namespace

TEST(RandomScenes, SeedsTellThemApart)
{
  const RandomScene one = oracle::MakeRandomScene(1), again = oracle::MakeRandomScene(1);
  const RandomScene two = oracle::MakeRandomScene(2);
  const auto at = [](const RandomScene& scene)
  { return oracle::Radiance(scene.At(0.4L, 0.6L), scene.Normal(), scene.Contents); };
  EXPECT_EQ(at(one), at(again));
  EXPECT_NE(at(one), at(two));
}

TEST(RandomScenes, AreAsAnnounced)
{
  // A finer grid than the generator's sees the same share, up to the cells on its outline.
  constexpr int side = 32;
  constexpr double outline = 0.03;
  std::array<int, std::variant_size_v<AnyLight>> kinds = {};
  int withTwoLights = 0;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    const RandomScene scene = oracle::MakeRandomScene(seed);
    for (const Vec3& edge : { scene.Edge1, scene.Edge2 })
    {
      EXPECT_GE(Length(edge), 2);
      EXPECT_LE(Length(edge), 4);
    }
    const double share = PenumbralShare(scene, side);
    EXPECT_GE(share, seed % 8 == 0 ? 0.0 : 0.05 - outline) << "scene " << seed;
    EXPECT_LE(share, 0.6 + outline) << "scene " << seed;
    for (const AnyLight& light : scene.Contents.Lights)
    {
      ++kinds[light.index()];
    }
    withTwoLights += scene.Contents.Lights.size() == 2;
  }
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
  {
    // Ellipses are none of them: the study's scenes stay what they are.
    const bool isEllipse = kind == AnyLight(oracle::Ellipse()).index();
    EXPECT_EQ(kinds[kind] == 0, isEllipse) << "kind " << kind;
  }
  EXPECT_GE(withTwoLights, 20);
}

TEST(RandomScenes, CornersOfOccludersAreFloats)
{
  const auto isFloat = [](const Vec3& v)
  {
    const auto same = [](long double x) { return static_cast<float>(x) == x; };
    return same(v.X) && same(v.Y) && same(v.Z);
  };
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    for (const oracle::Triangle& t : oracle::MakeRandomScene(seed).Contents.Occluders)
    {
      EXPECT_TRUE(isFloat(t.A) && isFloat(t.B) && isFloat(t.C)) << "scene " << seed;
    }
  }
}

// Occluders only take light away, down to the ambient light.
TEST(RandomScenes, AnswersLieBetweenAmbientAndUnoccluded)
{
  constexpr int side = 8;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    const RandomScene scene = oracle::MakeRandomScene(seed);
    oracle::Scene open = scene.Contents, dark = scene.Contents;
    open.Occluders.clear();
    dark.Lights.clear();
    for (int i = 0; i < side * side; ++i)
    {
      const Vec3 x = scene.At((i % side + 0.5L) / side, (i / side + 0.5L) / side);
      const auto most = oracle::Radiance(x, scene.Normal(), open);
      const auto least = oracle::Radiance(x, scene.Normal(), dark);
      const auto exact = oracle::Radiance(x, scene.Normal(), scene.Contents);
      for (std::size_t channel = 0; channel < 3; ++channel)
      {
        // A double rounds by 1e-16.
        EXPECT_LE(exact[channel], most[channel] * (1 + 1e-15)) << "scene " << seed;
        EXPECT_GE(exact[channel], least[channel] * (1 - 1e-15)) << "scene " << seed;
      }
    }
  }
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Textures fit into the memory that there is, and texels grow where it hurts least.

#include "TextureMemory.h"

#include "PlanScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace
{

using penumbra::TexelNeed;
using penumbra::TextureNeed;

double Sum(const std::vector<TextureNeed>& textures)
{
  double bytes = 0.0;
  for (const TextureNeed& texture : textures)
  {
    bytes += texture.GetBytes();
  }
  return bytes;
}

std::vector<TextureNeed> MakeNeeds(unsigned seed)
{
  std::mt19937 random(seed);
  const auto pick = [&](int low, int high)
  { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<TextureNeed> textures(static_cast<std::size_t>(pick(1, 6)));
  for (TextureNeed& texture : textures)
  {
    texture.HasVariance = pick(0, 1) == 1;
    for (int i = pick(0, 5); i > 0; --i)
    {
      texture.Receivers.push_back({ { pick(1, 400), pick(1, 400) },
        pick(0, 9) == 0 ? std::numeric_limits<double>::infinity() : pick(0, 900) / 10.0,
        pick(0, 9) == 0 });
    }
  }
  return textures;
}

} // namespace

// 16 bytes of irradiance, and 4 of factors with their mip levels, which is more than the mip levels
// of the irradiance: both of a texel at the last level.
TEST(TextureMemory, CountsTexelsAndWhatIsShown)
{
  TextureNeed need;
  EXPECT_EQ(need.GetBytes(), 0.0);
  need.Receivers = { { { 64, 64 }, 1.0 } };
  double texels = 0.0;
  for (int side = 64; side > 0; side /= 2)
  {
    texels += side * side;
  }
  const double bytes = 16.0 * 64 * 64 + 4.0 * texels;
  EXPECT_EQ(need.GetBytes(), bytes);
  need.HasVariance = true;
  EXPECT_EQ(need.GetBytes(), bytes + 4.0 * 64 * 64);
}

TEST(TextureMemory, FitsOrIsAtItsLeast)
{
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const std::vector<TextureNeed> asked = MakeNeeds(seed);
    for (const double share : { 1.0, 0.5, 0.01, 0.0 })
    {
      std::vector<TextureNeed> fitted = asked;
      const double allowed = share * Sum(asked);
      penumbra::FitTextures(fitted, allowed);
      bool isLeast = true;
      for (std::size_t t = 0; t < asked.size(); ++t)
      {
        for (std::size_t r = 0; r < asked[t].Receivers.size(); ++r)
        {
          const TexelNeed &before = asked[t].Receivers[r], &now = fitted[t].Receivers[r];
          EXPECT_LE(now.Texels.x, before.Texels.x);
          EXPECT_LE(now.Texels.y, before.Texels.y);
          EXPECT_GE(std::min(now.Texels.x, now.Texels.y), 1);
          EXPECT_TRUE(!now.IsFixed || now.Texels == before.Texels);
          EXPECT_TRUE(share < 1.0 || now.Texels == before.Texels) << "it fitted as it was";
          isLeast = isLeast && (now.IsFixed || now.Texels == glm::ivec2(1));
        }
      }
      EXPECT_TRUE(isLeast || Sum(fitted) <= allowed) << "seed " << seed << ", " << share;
    }
  }
}

// No receiver gives texels while the penumbrae of another one are wider in texels, and it has some
// to give.
TEST(TextureMemory, TakesFromTheWidestPenumbraFirst)
{
  std::vector<TextureNeed> textures(3);
  textures[0].Receivers = { { { 300, 300 }, 2.0 } };
  textures[1].Receivers = { { { 300, 300 }, 40.0 } };
  textures[2].Receivers = { { { 300, 300 }, std::numeric_limits<double>::infinity() } };
  const double one = textures[0].GetBytes();
  std::vector<TextureNeed> fitted = textures;
  penumbra::FitTextures(fitted, 2.5 * one);
  EXPECT_EQ(fitted[0].Receivers[0].Texels, glm::ivec2(300));
  EXPECT_EQ(fitted[1].Receivers[0].Texels, glm::ivec2(300));
  EXPECT_LT(fitted[2].Receivers[0].Texels.x, 300);

  fitted = textures;
  penumbra::FitTextures(fitted, 1.2 * one);
  EXPECT_EQ(fitted[0].Receivers[0].Texels, glm::ivec2(300));
  EXPECT_EQ(fitted[2].Receivers[0].Texels, glm::ivec2(1)) << "nothing is in shadow there";
  EXPECT_LT(fitted[1].Receivers[0].Texels.x, 300);
  EXPECT_GE(fitted[1].Receivers[0].Texels.x, 100);
}

TEST(TextureMemory, TellsTheSharpestPenumbra)
{
  PlanScene scene;
  scene.Surfaces.emplace_back(PlanScene::MakeSquare(0.0, 0.0, 0.5, 0.4));
  scene.Lights.emplace_back(PlanScene::MakeLamp(0.0, 0.0, 2.0, 0.6));
  const double wide = penumbra::FindSharpestPenumbra(scene.Plan());
  // A light of 0.6 at the height 2 over an edge at 0.5 has a penumbra of 0.6 x 0.5 / 1.5, and a
  // texel is 0.02; bounds are of the diagonal.
  EXPECT_GE(wide, 0.2 / 0.02 - 1e-9);
  EXPECT_LE(wide, std::sqrt(2.0) * 0.2 / 0.02 + 1.0);
  scene.Lights.emplace_back(PlanScene::MakeLamp(0.0, 0.0, 2.0, 0.06));
  EXPECT_LT(penumbra::FindSharpestPenumbra(scene.Plan()), 0.2 * wide);
  scene.Surfaces.pop_back();
  EXPECT_EQ(penumbra::FindSharpestPenumbra(scene.Plan()), PlanScene::Side) << "no shadow";
  scene.Surfaces.emplace_back(PlanScene::MakePlate({ 0, 0, 0.5 }, { 0.4, 0, 0 }, { 0, 0, 3.0 }));
  EXPECT_EQ(penumbra::FindSharpestPenumbra(scene.Plan()), PlanScene::Side) << "past the lights";
  scene.GetSettings().Supersampling = 2;
  EXPECT_EQ(penumbra::FindSharpestPenumbra(scene.Plan()), PlanScene::Side);
}

TEST(TextureBudget, StaysAsItIsWhileTheSameTexelsAreAskedFor)
{
  std::vector<TextureNeed> asked(2);
  asked[0].Receivers = { { { 300, 300 }, 2.0 } };
  asked[1].Receivers = { { { 300, 300 }, 40.0 } };
  const double both = Sum(asked);
  penumbra::TextureBudget budget;
  const std::vector<TextureNeed> first = budget.Fit(asked, 0.7 * both);
  EXPECT_LT(first[1].Receivers[0].Texels.x, 300);
  std::swap(asked[0].Receivers[0].PenumbraTexels, asked[1].Receivers[0].PenumbraTexels);
  EXPECT_EQ(budget.Fit(asked, 0.7 * both)[1].Receivers[0].Texels, first[1].Receivers[0].Texels);
  EXPECT_EQ(budget.Fit(asked, both)[1].Receivers[0].Texels, glm::ivec2(300));
  EXPECT_EQ(budget.Describe(), "");
  EXPECT_LT(budget.Fit(asked, 0.7 * both)[0].Receivers[0].Texels.x, 300) << "by the new penumbrae";
}

TEST(TextureBudget, SaysHowMuchTexelsGrew)
{
  std::vector<TextureNeed> asked(1);
  asked[0].Receivers = { { { 100, 100 }, 2.0 }, { { 100, 100 }, 40.0 } };
  penumbra::TextureBudget budget;
  budget.Fit(asked, asked[0].GetBytes());
  EXPECT_EQ(budget.Describe(), "");
  EXPECT_EQ(budget.GetBytesLeftPerTexel(), 0.0);
  budget.Fit(asked, 2.0 * asked[0].GetBytes());
  EXPECT_DOUBLE_EQ(budget.GetBytesLeftPerTexel(), asked[0].GetBytes() / 20000.0);
  // A step leaves 80 of 100 texels.
  budget.Fit(asked, asked[0].GetBytes() - 1.0);
  EXPECT_EQ(
    budget.Describe(), "1 of 2 receivers get texels up to 1.25 times as large as asked for");
}

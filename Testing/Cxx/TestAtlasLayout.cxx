// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Where receivers lie in their texture: what a look-up reads, at any mip level, is the receiver's.

#include "AtlasLayout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using penumbra::AtlasLayout;
using penumbra::AtlasRegion;
using penumbra::TexelRectangle;

namespace
{

constexpr int LargestSide = 16384;
constexpr int Nobody = -1, Several = -2;

std::vector<glm::ivec2> MakeSizes(std::mt19937& random, int count, int largest)
{
  std::uniform_int_distribution<int> side(1, largest);
  std::vector<glm::ivec2> sizes;
  for (int i = 0; i < count; ++i)
  {
    sizes.emplace_back(side(random), side(random));
  }
  return sizes;
}

/// Of each texel of the texture the receiver that it belongs to.
std::vector<int> FindOwners(const AtlasLayout& layout)
{
  std::vector<int> owners(
    static_cast<std::size_t>(layout.Size.x) * static_cast<std::size_t>(layout.Size.y), Nobody);
  for (std::size_t r = 0; r < layout.Regions.size(); ++r)
  {
    const AtlasRegion& region = layout.Regions[r];
    const TexelRectangle place = region.Place(penumbra::WholeRectangle(region.Size));
    EXPECT_TRUE(penumbra::WholeRectangle(layout.Size).Holds(place)) << r;
    for (int y = place.Low.y; y < place.High.y; ++y)
    {
      for (int x = place.Low.x; x < place.High.x; ++x)
      {
        int& owner = owners[static_cast<std::size_t>(y * layout.Size.x + x)];
        owner = owner == Nobody ? static_cast<int>(r) : Several;
      }
    }
  }
  return owners;
}

/// Whether all texels that linear interpolation of a mip level reads at a point are a receiver's.
/// OpenGL 3.2, 3.8.8: the four of the level whose centres are less than one of its texels away,
/// along each axis, those beyond the texture clamped to it. Levels are made by boxes.
bool ReadsOnly(int receiver, const std::vector<int>& owners, const AtlasLayout& layout,
  const glm::dvec2& point, int level)
{
  const int side = 1 << level;
  const glm::dvec2 place = point / static_cast<double>(side) - 0.5;
  const glm::ivec2 first(glm::floor(place)), last(glm::ceil(place));
  for (int i = 0; i < 4; ++i)
  {
    const glm::ivec2 corner(i % 2 == 0 ? first.x : last.x, i / 2 == 0 ? first.y : last.y);
    const glm::ivec2 texel = glm::clamp(corner, glm::ivec2(0), layout.Size / side - 1);
    for (int j = 0; j < side * side; ++j)
    {
      const glm::ivec2 at = texel * side + glm::ivec2(j % side, j / side);
      if (owners[static_cast<std::size_t>(at.y * layout.Size.x + at.x)] != receiver)
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace

TEST(AtlasLayout, LooksUpNothingButTheReceiver)
{
  std::mt19937 random(1);
  for (int run = 0; run < 60; ++run)
  {
    const AtlasLayout layout(MakeSizes(random, 2 + run % 9, 1 + 2 * run), LargestSide);
    const std::vector<int> owners = FindOwners(layout);
    ASSERT_EQ(layout.Size % AtlasLayout::Block, glm::ivec2(0)); // levels are made of whole texels
    for (std::size_t r = 0; r < layout.Regions.size(); ++r)
    {
      const AtlasRegion& region = layout.Regions[r];
      for (int step = 0; step < 4 * 41; ++step) // along the border: what is inside is further away
      {
        const int edge = step / 41;
        const double along = step % 41 / 40.0, across = edge % 2;
        const glm::dvec2 uv = edge < 2 ? glm::dvec2(along, across) : glm::dvec2(across, along);
        const glm::dvec2 point = glm::dvec2(region.Origin) + uv * glm::dvec2(region.Size);
        for (int level = 0; level <= AtlasLayout::MipLevels; ++level)
        {
          ASSERT_TRUE(ReadsOnly(static_cast<int>(r), owners, layout, point, level))
            << "run " << run << ", receiver " << r << ", level " << level;
        }
      }
    }
  }
}

TEST(AtlasLayout, OfOneReceiverIsTheReceiver)
{
  const AtlasLayout layout({ { 100, 37 } }, LargestSide);
  EXPECT_EQ(layout.Size, glm::ivec2(100, 37));
  EXPECT_EQ(layout.Gutter, 0);
  EXPECT_EQ(layout.Regions.front().Origin, glm::ivec2(0));
  const TexelRectangle all = penumbra::WholeRectangle(layout.Size);
  EXPECT_EQ(layout.Regions.front().Place(all), all);
}

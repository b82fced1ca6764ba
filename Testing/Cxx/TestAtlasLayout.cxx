// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Where receivers lie in their texture: what a look-up reads, at any mip level, is the receiver's.

#include "AtlasLayout.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using penumbra::AtlasHalf;
using penumbra::AtlasLayout;
using penumbra::AtlasReceiver;
using penumbra::AtlasRegion;
using penumbra::TexelRectangle;

namespace
{

constexpr int LargestSide = 16384;
constexpr int Nobody = -1, Several = -2;

int RandomSide(RandomGeometry& random, int largest)
{
  return 1 + static_cast<int>(random.Below(static_cast<std::size_t>(largest)));
}

/// Triangles and rectangles; triangles come in families of about the same size, as meshes have
/// them.
std::vector<AtlasReceiver> MakeReceivers(RandomGeometry& random, int count, int largest)
{
  std::vector<AtlasReceiver> receivers;
  glm::ivec2 size(1);
  for (int i = 0; i < count; ++i)
  {
    if (random.Below(3) == 0 || i == 0)
    {
      size = { RandomSide(random, largest), RandomSide(random, largest) };
    }
    size += glm::ivec2(random.Below(3), random.Below(3));
    receivers.emplace_back(size, random.Below(4) > 0);
  }
  return receivers;
}

/// Of each texel of the texture, whose it is.
class Owners
{
public:
  explicit Owners(const glm::ivec2& size)
    : Size(size)
    , Texels(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), Nobody)
  {
  }

  int At(const glm::ivec2& texel) const { return this->Texels.at(this->Index(texel)); }

  void Add(const glm::ivec2& texel, int receiver)
  {
    int& owner = this->Texels.at(this->Index(texel));
    owner = owner == Nobody || owner == receiver ? receiver : Several;
  }

  void Add(const TexelRectangle& texels, int receiver)
  {
    for (int y = texels.Low.y; y < texels.High.y; ++y)
    {
      for (int x = texels.Low.x; x < texels.High.x; ++x)
      {
        this->Add({ x, y }, receiver);
      }
    }
  }

  bool HasShared() const
  {
    return std::find(this->Texels.begin(), this->Texels.end(), Several) != this->Texels.end();
  }

  glm::ivec2 Size;

private:
  std::size_t Index(const glm::ivec2& texel) const
  {
    return static_cast<std::size_t>(texel.y * this->Size.x + texel.x);
  }
  std::vector<int> Texels;
};

/// By the regions' own word.
Owners FindOwners(const AtlasLayout& layout)
{
  Owners owners(layout.Size);
  for (std::size_t r = 0; r < layout.Regions.size(); ++r)
  {
    const AtlasRegion& region = layout.Regions[r];
    for (const TexelRectangle& part : region.Place(penumbra::WholeRectangle(region.Size)))
    {
      EXPECT_TRUE(penumbra::WholeRectangle(layout.Size).Holds(part)) << r;
      owners.Add(part, static_cast<int>(r));
    }
  }
  return owners;
}

/// Where (u, v) of a receiver is in the texture, in texels.
glm::dvec2 ToTexture(const AtlasRegion& region, const glm::dvec2& uv)
{
  const glm::dvec2 inside = uv * glm::dvec2(region.Size), low(region.Origin);
  return region.GetStep() > 0 ? low + inside : low + glm::dvec2(region.Size) - inside;
}

/// Points on the border of what is shown of a receiver: what is inside is further away from others.
std::vector<glm::dvec2> MakeBorder(const AtlasRegion& region)
{
  using Vec = glm::dvec2;
  std::vector<Vec> corners = { Vec(0, 0), Vec(1, 0), Vec(1, 1), Vec(0, 1) };
  if (region.Half != AtlasHalf::Whole)
  {
    corners.erase(corners.begin() + 2);
  }
  constexpr int Steps = 64;
  std::vector<Vec> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    for (int step = 0; step < Steps; ++step)
    {
      const Vec &a = corners[i], &b = corners[(i + 1) % corners.size()];
      points.push_back(ToTexture(region, glm::mix(a, b, static_cast<double>(step) / Steps)));
    }
  }
  return points;
}

/// Whether all texels that linear interpolation of a mip level reads at a point are a receiver's.
/// OpenGL 3.2, 3.8.8: the four of the level whose centres are less than one of its texels away,
/// along each axis, those beyond the texture clamped to it. Levels are made by boxes.
bool ReadsOnly(int receiver, const Owners& owners, const glm::dvec2& point, int level)
{
  const int side = 1 << level;
  const glm::dvec2 place = point / static_cast<double>(side) - 0.5;
  const glm::ivec2 first(glm::floor(place)), last(glm::ceil(place));
  for (int i = 0; i < 4; ++i)
  {
    const glm::ivec2 corner(i % 2 == 0 ? first.x : last.x, i / 2 == 0 ? first.y : last.y);
    const glm::ivec2 texel = glm::clamp(corner, glm::ivec2(0), owners.Size / side - 1);
    for (int j = 0; j < side * side; ++j)
    {
      if (owners.At(texel * side + glm::ivec2(j % side, j / side)) != receiver)
      {
        return false;
      }
    }
  }
  return true;
}

/// The texels within a distance, along either axis, of what is shown of a receiver: by the three or
/// four lines around it, moved outwards.
void AddGrown(const AtlasRegion& region, double distance, int receiver, Owners& owners)
{
  const glm::dvec2 size(region.Size);
  const double reach = distance + 0.5; // to a texel's centre, where its side is
  const double diagonal =
    region.Half == AtlasHalf::Whole ? 1e9 : 1.0 + reach / size.x + reach / size.y;
  for (int y = 0; y < owners.Size.y; ++y)
  {
    for (int x = 0; x < owners.Size.x; ++x)
    {
      const glm::dvec2 centre = glm::dvec2(x, y) + 0.5;
      const glm::dvec2 inside =
        static_cast<double>(region.GetStep()) * (centre - ToTexture(region, glm::dvec2(0.0)));
      if (inside.x > -reach && inside.y > -reach && inside.x < size.x + reach &&
        inside.y < size.y + reach && inside.x / size.x + inside.y / size.y < diagonal)
      {
        owners.Add({ x, y }, receiver);
      }
    }
  }
}

std::size_t CountShared(const AtlasLayout& layout)
{
  return static_cast<std::size_t>(std::count_if(layout.Regions.begin(), layout.Regions.end(),
    [](const AtlasRegion& region) { return region.Half != AtlasHalf::Whole; }));
}

} // namespace

TEST(AtlasLayout, LooksUpNothingButTheReceiver)
{
  RandomGeometry random(1);
  std::size_t shared = 0, all = 0;
  for (int run = 0; run < 100; ++run)
  {
    const AtlasLayout layout(MakeReceivers(random, 2 + run % 9, 1 + 2 * run), LargestSide);
    const Owners owners = FindOwners(layout);
    ASSERT_FALSE(owners.HasShared()) << run;
    ASSERT_EQ(layout.Size % AtlasLayout::Block, glm::ivec2(0)); // levels are made of whole texels
    for (std::size_t r = 0; r < layout.Regions.size(); ++r)
    {
      for (const glm::dvec2& point : MakeBorder(layout.Regions[r]))
      {
        for (int level = 0; level <= AtlasLayout::MipLevels; ++level)
        {
          ASSERT_TRUE(ReadsOnly(static_cast<int>(r), owners, point, level))
            << "run " << run << ", receiver " << r << ", level " << level;
        }
      }
    }
    shared += CountShared(layout);
    all += layout.Regions.size();
  }
  EXPECT_GT(shared, all / 4);
}

// Told by their outlines alone: half a gutter around each is its own.
TEST(AtlasLayout, KeepsReceiversApart)
{
  RandomGeometry random(2);
  for (int run = 0; run < 60; ++run)
  {
    const AtlasLayout layout(MakeReceivers(random, 2 + run % 9, 1 + 2 * run), LargestSide);
    Owners nearby(layout.Size);
    for (std::size_t r = 0; r < layout.Regions.size(); ++r)
    {
      AddGrown(layout.Regions[r], 0.5 * layout.Gutter, static_cast<int>(r), nearby);
    }
    ASSERT_FALSE(nearby.HasShared()) << run;
  }
}

// In whatever parts a receiver is baked, it is baked once, and so is its gutter; and only there.
TEST(AtlasLayout, PlacesPartsOnceEach)
{
  RandomGeometry random(3);
  for (int run = 0; run < 60; ++run)
  {
    const AtlasLayout layout(MakeReceivers(random, 2 + run % 5, 10 + run), LargestSide);
    const Owners owners = FindOwners(layout);
    for (std::size_t r = 0; r < layout.Regions.size(); ++r)
    {
      const AtlasRegion& region = layout.Regions[r];
      const glm::ivec2 cut(random.Below(static_cast<std::size_t>(region.Size.x) + 1),
        random.Below(static_cast<std::size_t>(region.Size.y) + 1));
      Owners parts(layout.Size); // here, an owner is the part that a texel is in
      for (int part = 0; part < 4; ++part)
      {
        const bool right = part % 2 != 0, high = part / 2 != 0;
        const TexelRectangle texels{ { right ? cut.x : 0, high ? cut.y : 0 },
          { right ? region.Size.x : cut.x, high ? region.Size.y : cut.y } };
        for (const TexelRectangle& placed :
          texels.IsEmpty() ? std::vector<TexelRectangle>() : region.Place(texels))
        {
          parts.Add(placed, part);
        }
      }
      for (int i = 0; i < layout.Size.x * layout.Size.y; ++i)
      {
        const glm::ivec2 texel(i % layout.Size.x, i / layout.Size.x);
        const bool isOwn = owners.At(texel) == static_cast<int>(r);
        ASSERT_NE(parts.At(texel), Several);
        ASSERT_EQ(parts.At(texel) != Nobody, isOwn) << run << ", " << r;
      }
      for (int i = 0; i < region.Size.x * region.Size.y; ++i)
      {
        const glm::ivec2 texel(i % region.Size.x, i / region.Size.x);
        const glm::ivec2 at = region.GetFirst() + region.GetStep() * texel;
        ASSERT_EQ(region.Owns(texel), owners.At(at) == static_cast<int>(r));
      }
    }
  }
}

// Two triangles of n x n texels share a slot of n + 4 gutters, rounded up to blocks; slots of their
// own have a gutter and half a block more than n at least. Of a few slots alike, some number of
// shelves leaves at most an eighth empty: 7 are 2 of 4.
TEST(AtlasLayout, OfTrianglesIsHalfAsLarge)
{
  for (const int n : { 100, 256, 512, 1000 })
  {
    for (std::size_t count : { 4u, 8u, 14u, 20u, 32u, 80u }) // 20: an icosahedron
    {
      const std::vector<AtlasReceiver> triangles(count, AtlasReceiver(glm::ivec2(n), true));
      const AtlasLayout layout(triangles, LargestSide);
      EXPECT_EQ(CountShared(layout), count);
      const double shared = n + 4.0 * AtlasLayout::GutterTexels + AtlasLayout::Block - 1.0;
      const auto texels = static_cast<double>(layout.CountTexels(false));
      EXPECT_LE(texels, 8.0 / 7.0 * 0.5 * static_cast<double>(count) * shared * shared) << count;
      const std::vector<AtlasReceiver> squares(count, AtlasReceiver(glm::ivec2(n), false));
      const AtlasLayout alone(squares, LargestSide);
      EXPECT_EQ(CountShared(alone), 0u);
      RecordProperty("ratio" + std::to_string(n) + "of" + std::to_string(count),
        std::to_string(texels / static_cast<double>(alone.CountTexels(false))));
    }
  }
}

// Where two gutters more cost more than half of a rectangle saves, triangles have their own.
TEST(AtlasLayout, OfSmallTrianglesIsNotLarger)
{
  for (int n = 1; n < 60; ++n)
  {
    const std::vector<AtlasReceiver> triangles(32, AtlasReceiver(glm::ivec2(n), true));
    const std::vector<AtlasReceiver> squares(32, AtlasReceiver(glm::ivec2(n), false));
    EXPECT_LE(AtlasLayout(triangles, LargestSide).CountTexels(false),
      AtlasLayout(squares, LargestSide).CountTexels(false))
      << n;
  }
}

TEST(AtlasLayout, OfOneReceiverIsTheReceiver)
{
  for (const bool isTriangle : { false, true })
  {
    const AtlasLayout layout({ AtlasReceiver({ 100, 37 }, isTriangle) }, LargestSide);
    EXPECT_EQ(layout.Size, glm::ivec2(100, 37));
    EXPECT_EQ(layout.Gutter, 0);
    const AtlasRegion& region = layout.Regions.front();
    EXPECT_EQ(region.Origin, glm::ivec2(0));
    EXPECT_EQ(region.Half, AtlasHalf::Whole);
    const TexelRectangle all = penumbra::WholeRectangle(layout.Size);
    EXPECT_EQ(region.Place(all), std::vector<TexelRectangle>{ all });
  }
}

// As large as OpenGL allows, alone: with another it would not fit.
TEST(AtlasLayout, SharesNothingThatWouldNotFit)
{
  const glm::ivec2 size(1000, 20);
  const std::vector<AtlasReceiver> triangles(2, AtlasReceiver(size, true));
  EXPECT_EQ(CountShared(AtlasLayout(triangles, 1040)), 2u);
  const AtlasLayout narrow(triangles, 1016);
  EXPECT_EQ(CountShared(narrow), 0u);
  EXPECT_LE(narrow.Size.x, 1016);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtlasLayout.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace penumbra
{
namespace
{

constexpr int Block = AtlasLayout::Block;
constexpr int Gutter = AtlasLayout::GutterTexels;

/// Triangles are in the order of their sizes when they are paired: so many of the next ones are
/// looked at.
constexpr std::size_t Candidates = 32;

/// A rectangle of the texture for a receiver, or for two triangles.
struct Slot
{
  glm::ivec2 Size;
  std::size_t First;
  std::optional<std::size_t> Second = std::nullopt;
};

glm::ivec2 RoundUp(const glm::ivec2& size)
{
  return (size + Block - 1) / Block * Block;
}

/// The slot of one of several: all blocks whose centres are less than a block away from its texels,
/// the first of which is the gutter before them.
glm::ivec2 PadOne(const glm::ivec2& size)
{
  return RoundUp(size + Gutter + Block / 2);
}

/// The slot of two triangles. Of triangles that are as large as the larger side of both, the
/// hypotenuses are parallel to the middle line, which is a gutter away from each along either axis.
glm::ivec2 PadTwo(const glm::ivec2& a, const glm::ivec2& b)
{
  return RoundUp(glm::max(a, b) + 4 * Gutter);
}

double GetArea(const glm::ivec2& size)
{
  return static_cast<double>(size.x) * size.y;
}

/// Of the candidates the one whose sharing a slot with a triangle saves most; where none saves
/// anything, the end.
std::size_t FindPartner(const std::vector<AtlasReceiver>& receivers,
  const std::vector<std::size_t>& triangles, std::size_t first, int largestSide)
{
  const glm::ivec2& own = receivers[triangles[first]].Size;
  const std::size_t end = std::min(first + 1 + Candidates, triangles.size());
  std::size_t best = triangles.size();
  double most = 0.0;
  for (std::size_t i = first + 1; i < end; ++i)
  {
    const glm::ivec2& other = receivers[triangles[i]].Size;
    const glm::ivec2 shared = PadTwo(own, other);
    const double saved = GetArea(PadOne(own)) + GetArea(PadOne(other)) - GetArea(shared);
    if (saved > most && std::max(shared.x, shared.y) <= largestSide)
    {
      most = saved;
      best = i;
    }
  }
  return best;
}

/// The slots of several receivers.
std::vector<Slot> MakeSlots(const std::vector<AtlasReceiver>& receivers, int largestSide)
{
  std::vector<Slot> slots;
  std::vector<std::size_t> triangles;
  for (std::size_t i = 0; i < receivers.size(); ++i)
  {
    if (receivers[i].IsTriangle)
    {
      triangles.push_back(i);
    }
    else
    {
      slots.push_back({ PadOne(receivers[i].Size), i });
    }
  }
  std::stable_sort(triangles.begin(), triangles.end(),
    [&](std::size_t a, std::size_t b)
    {
      const glm::ivec2 &p = receivers[a].Size, &q = receivers[b].Size;
      return p.y != q.y ? p.y > q.y : p.x > q.x;
    });
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const std::size_t partner = FindPartner(receivers, triangles, i, largestSide);
    const std::size_t own = triangles[i];
    if (partner == triangles.size())
    {
      slots.push_back({ PadOne(receivers[own].Size), own });
      continue;
    }
    const std::size_t other = triangles[partner];
    slots.push_back({ PadTwo(receivers[own].Size, receivers[other].Size), own, other });
    triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(partner));
  }
  return slots;
}

/// Slots side by side on shelves.
struct Shelves
{
  std::vector<glm::ivec2> Places; ///< of the slots, in their order
  glm::ivec2 Size{ 0 };
};

Shelves PlaceOnShelves(const std::vector<Slot>& slots, int width)
{
  Shelves shelves;
  glm::ivec2 place(0);
  int shelf = 0;
  for (const Slot& slot : slots)
  {
    if (place.x + slot.Size.x > width)
    {
      place = { 0, place.y + shelf };
      shelf = 0;
    }
    shelves.Places.push_back(place);
    place.x += slot.Size.x;
    shelf = std::max(shelf, slot.Size.y);
    shelves.Size = glm::max(shelves.Size, place + glm::ivec2(0, slot.Size.y));
  }
  return shelves;
}

/// The shelves that leave least of the texture empty, from a square's side to twice that.
Shelves PlaceOnBestShelves(const std::vector<Slot>& slots, int largestSide)
{
  double area = 0.0;
  int widest = 0;
  for (const Slot& slot : slots)
  {
    area += GetArea(slot.Size);
    widest = std::max(widest, slot.Size.x);
  }
  constexpr int Widths = 16;
  Shelves best;
  for (int i = 0; i <= Widths; ++i)
  {
    const double wanted = std::sqrt(area) * (1.0 + static_cast<double>(i) / Widths);
    const double width = std::min(std::ceil(wanted), static_cast<double>(largestSide));
    Shelves shelves = PlaceOnShelves(slots, std::max(widest, static_cast<int>(width)));
    const bool fits = shelves.Size.y <= largestSide, didFit = best.Size.y <= largestSide;
    const bool isSmaller = GetArea(shelves.Size) < GetArea(best.Size);
    if (i == 0 || (fits != didFit ? fits : isSmaller))
    {
      best = std::move(shelves);
    }
  }
  return best;
}

/// Where two triangles lie in their slot.
std::pair<AtlasRegion, AtlasRegion> PlaceTwo(const glm::ivec2& first, const glm::ivec2& second,
  const glm::ivec2& place, const glm::ivec2& slot)
{
  // The middle line is parallel to the diagonal of the larger side of both, (w, h), and passes the
  // slot's centre: h (X - centre.x) + w (Y - centre.y) = 0. In blocks, X = Block (x + 1/2).
  const glm::ivec2 larger = glm::max(first, second);
  const glm::ivec2 normal(larger.y, larger.x);
  const glm::ivec2 twiceCentre = (2 * place + slot) / Block;
  const glm::ivec2 constant = normal * (1 - twiceCentre);
  const glm::ivec3 side(2 * normal, constant.x + constant.y);
  const glm::ivec2 gutter(Gutter);
  const glm::ivec2 firstRest = slot - Gutter - first, secondRest = slot - Gutter - second;
  return { { place + Gutter, first, gutter, firstRest, AtlasHalf::LowerLeft, side },
    { place + secondRest, second, secondRest, gutter, AtlasHalf::UpperRight,
      -side - glm::ivec3(0, 0, 1) } };
}

} // namespace

glm::ivec2 AtlasRegion::GetFirst() const
{
  return this->Half == AtlasHalf::UpperRight ? this->Origin + this->Size - 1 : this->Origin;
}

bool AtlasRegion::OwnsBlock(const glm::ivec2& block) const
{
  return this->Side.x * block.x + this->Side.y * block.y + this->Side.z < 0;
}

bool AtlasRegion::HasShapeOf(const AtlasRegion& other) const
{
  return this->Half == AtlasHalf::Whole && other.Half == AtlasHalf::Whole &&
    this->Size == other.Size && this->GutterLow == other.GutterLow &&
    this->GutterHigh == other.GutterHigh;
}

bool AtlasRegion::Owns(const glm::ivec2& texel) const
{
  return this->Half == AtlasHalf::Whole ||
    this->OwnsBlock((this->GetFirst() + this->GetStep() * texel) / Block);
}

std::vector<TexelRectangle> AtlasRegion::Place(const TexelRectangle& texels) const
{
  TexelRectangle placed = texels;
  if (this->Half == AtlasHalf::UpperRight)
  {
    placed = { this->Size - texels.High, this->Size - texels.Low };
  }
  for (int axis = 0; axis < 2; ++axis)
  {
    placed.Low[axis] -= placed.Low[axis] == 0 ? this->GutterLow[axis] : 0;
    placed.High[axis] += placed.High[axis] == this->Size[axis] ? this->GutterHigh[axis] : 0;
  }
  placed = { placed.Low + this->Origin, placed.High + this->Origin };
  if (this->Half == AtlasHalf::Whole)
  {
    return { placed };
  }
  std::vector<TexelRectangle> parts;
  for (int y = placed.Low.y / Block; Block * y < placed.High.y; ++y)
  {
    // Of a row of blocks, those up to the middle line, or from there on.
    int first = placed.Low.x / Block, last = (placed.High.x - 1) / Block;
    while (first <= last && !this->OwnsBlock({ first, y }))
    {
      ++first;
    }
    while (first <= last && !this->OwnsBlock({ last, y }))
    {
      --last;
    }
    const TexelRectangle blocks{ Block * glm::ivec2(first, y),
      Block * glm::ivec2(last + 1, y + 1) };
    const TexelRectangle part = blocks.Intersection(placed);
    if (!part.IsEmpty())
    {
      parts.push_back(part);
    }
  }
  return parts;
}

AtlasLayout::AtlasLayout(const std::vector<AtlasReceiver>& receivers, int largestSide)
  : Gutter(receivers.size() > 1 ? GutterTexels : 0)
  , Regions(receivers.size())
{
  if (receivers.size() == 1) // it fills its texture: vtkSoftShadowFS.glsl relies on it
  {
    this->Size = receivers.front().Size;
    this->Regions.front().Size = this->Size;
    return;
  }
  std::vector<Slot> slots = MakeSlots(receivers, largestSide);
  std::stable_sort(
    slots.begin(), slots.end(), [](const Slot& a, const Slot& b) { return a.Size.y > b.Size.y; });
  const Shelves shelves = PlaceOnBestShelves(slots, largestSide);
  this->Size = shelves.Size;
  for (std::size_t i = 0; i < slots.size(); ++i)
  {
    const Slot& slot = slots[i];
    const glm::ivec2& place = shelves.Places[i];
    const glm::ivec2& size = receivers[slot.First].Size;
    if (slot.Second)
    {
      std::tie(this->Regions[slot.First], this->Regions[*slot.Second]) =
        PlaceTwo(size, receivers[*slot.Second].Size, place, slot.Size);
    }
    else
    {
      this->Regions[slot.First] = { place + this->Gutter, size, glm::ivec2(this->Gutter),
        slot.Size - size - this->Gutter };
    }
  }
}

std::size_t AtlasLayout::CountTexels(bool withMipmaps) const
{
  std::size_t texels = 0;
  glm::ivec2 size = this->Size;
  for (int level = 0; size.x > 0 && size.y > 0; ++level)
  {
    texels += static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    const bool isLast = size == glm::ivec2(1) || (this->Gutter > 0 && level == MipLevels);
    if (!withMipmaps || isLast)
    {
      break;
    }
    size = glm::max(size / 2, glm::ivec2(1));
  }
  return texels;
}

} // namespace penumbra

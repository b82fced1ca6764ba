// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtlasLayout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra
{
namespace
{

/// The side of a slot for so many texels: all blocks whose centres are less than a block away from
/// them, the first of which is the gutter before them.
int PadSide(int texels)
{
  constexpr int Block = AtlasLayout::Block;
  return (AtlasLayout::GutterTexels + texels + Block / 2 + Block - 1) / Block * Block;
}

} // namespace

TexelRectangle AtlasRegion::Place(const TexelRectangle& texels) const
{
  TexelRectangle placed = texels;
  for (int axis = 0; axis < 2; ++axis)
  {
    placed.Low[axis] -= placed.Low[axis] == 0 ? this->GutterLow[axis] : 0;
    placed.High[axis] += placed.High[axis] == this->Size[axis] ? this->GutterHigh[axis] : 0;
  }
  return { placed.Low + this->Origin, placed.High + this->Origin };
}

AtlasLayout::AtlasLayout(const std::vector<glm::ivec2>& sizes, int largestSide)
  : Gutter(sizes.size() > 1 ? GutterTexels : 0)
  , Regions(sizes.size())
{
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return sizes[a].y > sizes[b].y; });
  const auto pad = [&](const glm::ivec2& size)
  { return this->Gutter > 0 ? glm::ivec2(PadSide(size.x), PadSide(size.y)) : size; };
  double area = 0.0;
  int width = 0;
  for (const glm::ivec2& size : sizes)
  {
    const glm::ivec2 padded = pad(size);
    area += static_cast<double>(padded.x) * padded.y;
    width = std::max(width, padded.x);
  }
  width = std::max(width, std::min(static_cast<int>(std::ceil(std::sqrt(area))), largestSide));

  glm::ivec2 place(0);
  int shelf = 0;
  int used = 0; // a single receiver fills its texture: vtkSoftShadowFS.glsl relies on it
  for (const std::size_t i : order)
  {
    const glm::ivec2 padded = pad(sizes[i]);
    if (place.x + padded.x > width)
    {
      place = { 0, place.y + shelf };
      shelf = 0;
    }
    this->Regions[i] = { place + this->Gutter, sizes[i], glm::ivec2(this->Gutter),
      padded - sizes[i] - this->Gutter };
    place.x += padded.x;
    used = std::max(used, place.x);
    shelf = std::max(shelf, padded.y);
  }
  this->Size = { used, place.y + shelf };
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

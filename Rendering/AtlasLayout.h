// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where the receivers of one surface lie in their texture.
 */
#ifndef AtlasLayout_h
#define AtlasLayout_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "TexelRectangle.h"
#include "Vectors.h"

#include <cstddef>
#include <vector>

namespace penumbra
{

/// A receiver that is to get a place.
struct AtlasReceiver
{
  AtlasReceiver(const glm::ivec2& size, bool isTriangle = false)
    : Size(size)
    , IsTriangle(isTriangle)
  {
  }

  glm::ivec2 Size;
  /// Only the texels of its lower left half are shown: (i + 1/2) / Size.x + (j + 1/2) / Size.y <=
  /// 1, and those that a look-up reads around them.
  bool IsTriangle;
};

/// What a region has of its slot.
enum class AtlasHalf
{
  Whole,
  LowerLeft, ///< as the receiver has it
  UpperRight ///< turned by 180 degrees: the receiver's lower left half
};

/// Texels of a receiver, and the gutter around them, which is its own, too. If it shares its slot,
/// only what lies on its side of the slot's middle line is.
struct PENUMBRARENDERING_EXPORT AtlasRegion
{
  glm::ivec2 Origin{ 0 }; ///< the texels' lowest, in the texture
  glm::ivec2 Size{ 1 };   ///< how many they are
  ///@{
  /// Gutter before the first texel and behind the last one, along each axis.
  glm::ivec2 GutterLow{ 0 };
  glm::ivec2 GutterHigh{ 0 };
  ///@}
  AtlasHalf Half = AtlasHalf::Whole;
  /// The texture's blocks (x, y) of AtlasLayout::Block texels a side are its own where
  /// Side.x x + Side.y y + Side.z < 0.
  glm::ivec3 Side{ 0, 0, -1 };

  ///@{
  /// Where the receiver's texel (0, 0) lies in the texture, and what the next one along either axis
  /// is further: 1, or -1 if it is turned.
  glm::ivec2 GetFirst() const;
  int GetStep() const { return this->Half == AtlasHalf::UpperRight ? -1 : 1; }
  ///@}

  /// Whether a texel of the receiver is there, and not another receiver's in its place.
  bool Owns(const glm::ivec2& texel) const;

  /// Whether the texels, and the gutter around them, of one are those of the other elsewhere: none
  /// of them shares a slot.
  bool HasShapeOf(const AtlasRegion& other) const;

  /// Where a rectangle of the receiver's texels lies in the texture, with the gutter beyond what of
  /// their border is in it: rectangles of what is its own.
  std::vector<TexelRectangle> Place(const TexelRectangle& texels) const;

private:
  bool OwnsBlock(const glm::ivec2& block) const;
};

/**
 * Regions side by side on shelves, the highest first, in a texture that is about square, or wider
 * where that leaves less of it empty. Around each of several there is a gutter, so that mip levels
 * up to MipLevels never mix two receivers; a single one fills its texture, which has all levels.
 *
 * What belongs to a receiver is whole blocks of 2^MipLevels texels a side, which are the texels of
 * the last level. Linear interpolation reads those whose centres are less than a block away, along
 * each axis: these are its own.
 *
 * Triangles fill half of their parallelogram (H&H 1997, 3.4). Two of about the same size share a
 * slot, if that takes less room: one has the lower left half, the other one, turned by 180 degrees,
 * the upper right half. Between them is a gutter from each, up to the slot's middle line.
 */
struct PENUMBRARENDERING_EXPORT AtlasLayout
{
  static constexpr int MipLevels = 3;
  static constexpr int Block = 8;
  /// Before the first texel of each region of several; behind the last one it ends with a block.
  static constexpr int GutterTexels = Block;
  static_assert(Block == 1 << MipLevels, "A block is a texel of the last mip level.");

  AtlasLayout() = default;
  /// `largestSide`: of the texture, if there is a choice.
  AtlasLayout(const std::vector<AtlasReceiver>& receivers, int largestSide);

  /// The texels of the texture, with or without its mip levels.
  std::size_t CountTexels(bool withMipmaps) const;

  int Gutter = 0;
  std::vector<AtlasRegion> Regions; ///< in the order of the receivers
  glm::ivec2 Size{ 0 };             ///< of the texture
};

} // namespace penumbra

#endif

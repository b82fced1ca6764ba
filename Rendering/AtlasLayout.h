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

/// Texels of a receiver, and the gutter around them, which is its own, too.
struct PENUMBRARENDERING_EXPORT AtlasRegion
{
  glm::ivec2 Origin{ 0 }; ///< of the texels
  glm::ivec2 Size{ 1 };   ///< how many they are
  ///@{
  /// Gutter before the first texel and behind the last one, along each axis.
  glm::ivec2 GutterLow{ 0 };
  glm::ivec2 GutterHigh{ 0 };
  ///@}

  /// Where a rectangle of the receiver's texels lies in the texture, with the gutter beyond what of
  /// their border is in it.
  TexelRectangle Place(const TexelRectangle& texels) const;
};

/**
 * Regions side by side on shelves, the highest first, in a texture that is about square. Around
 * each of several there is a gutter, so that mip levels up to MipLevels never mix two receivers; a
 * single one fills its texture, which has all levels.
 *
 * What belongs to a receiver is whole blocks of 2^MipLevels texels a side, which are the texels of
 * the last level. Linear interpolation reads those whose centres are less than a block away, along
 * each axis: these are its own.
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
  AtlasLayout(const std::vector<glm::ivec2>& sizes, int largestSide);

  /// The texels of the texture, with or without its mip levels.
  std::size_t CountTexels(bool withMipmaps) const;

  int Gutter = 0;
  std::vector<AtlasRegion> Regions; ///< in the order of the sizes
  glm::ivec2 Size{ 0 };             ///< of the texture
};

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where the receivers of one surface lie in their texture.
 */
#ifndef AtlasLayout_h
#define AtlasLayout_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "Vectors.h"

#include <cstddef>
#include <vector>

namespace penumbra
{

/// Texels of a receiver: the first one and how many, without the gutter.
struct AtlasRegion
{
  glm::ivec2 Origin{ 0 };
  glm::ivec2 Size{ 1 };
};

/**
 * Regions side by side on shelves, the highest first, in a texture that is about square. Around
 * each of several there is a gutter, so that mip levels up to MipLevels never mix two receivers; a
 * single one fills its texture, which has all levels.
 */
struct PENUMBRARENDERING_EXPORT AtlasLayout
{
  /// Around each region of several: 2^MipLevels texels.
  static constexpr int GutterTexels = 8;
  static constexpr int MipLevels = 3;

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

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Larger texels where the textures of a view would take too much memory.
 */
#ifndef TextureMemory_h
#define TextureMemory_h

#include "EffectPlanner.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "Vectors.h"

#include <string>
#include <vector>

namespace penumbra
{

/// A receiver of a texture.
struct TexelNeed
{
  glm::ivec2 Texels{ 1 };
  double PenumbraTexels = 0.0; ///< how wide its shadows' edges are: FindSharpestPenumbra()
  bool IsFixed = false;        ///< its texels are the few vertices of smooth light
  bool IsTriangle = false;     ///< two of them may share a rectangle
};

/// The receivers of one texture.
struct TextureNeed
{
  std::vector<TexelNeed> Receivers;
  bool HasVariance = false;

  /// With what shows it: the mip levels of its irradiance, or vtkShadowFactors with theirs.
  double GetBytes() const;
};

/**
 * How wide penumbrae may be, in the receiver's texels, of the light of which they are narrowest; at
 * most the receiver's longer side, as where nothing is in shadow.
 */
PENUMBRARENDERING_EXPORT double FindSharpestPenumbra(const ReceiverPlan& plan);

/**
 * Gives receivers fewer texels until their textures take no more than `maximumBytes`: step by step,
 * to the one whose penumbrae are the widest in texels, a fifth fewer along each edge. Linear
 * interpolation between texels errs the less, the wider the penumbra is. One texel is the least.
 * Textures without receivers take none.
 */
PENUMBRARENDERING_EXPORT void FitTextures(std::vector<TextureNeed>& textures, double maximumBytes);

/**
 * FitTextures() for a view whose scene changes: as long as it asks for the same texels and the same
 * memory, it gets the same. An object that moves does not let texels flicker.
 */
class PENUMBRARENDERING_EXPORT TextureBudget
{
public:
  const std::vector<TextureNeed>& Fit(const std::vector<TextureNeed>& asked, double maximumBytes);

  /// What the textures leave of the memory; and for each of their texels.
  double GetBytesLeft() const;
  /// With those of others, as many, which take ShadowScene::BytesPerTexel.
  double GetBytesLeftPerTexel(double others = 0.0) const;

  /// How many receivers got larger texels, and how much larger; empty if none did.
  std::string Describe() const;

private:
  std::vector<TextureNeed> Asked, Fitted;
  double MaximumBytes = 0.0;
};

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where a receiver's texels are too large for the shadows on them.
 */
#ifndef FineWindows_h
#define FineWindows_h

#include "OccluderSelector.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "TexelRectangle.h"

#include <vector>

namespace penumbra
{

/**
 * A rectangle of a receiver that is baked with finer texels, of which the receiver's own take the
 * mean: each of these is divided into Factor.x times Factor.y.
 */
struct PENUMBRARENDERING_EXPORT FineWindow
{
  glm::ivec2 Factor{ 1 };
  TexelRectangle Fine; ///< of the finer texels
  /// Larger shadows fall here, too: it consists of whole texels of the receiver, and what these
  /// would hold without it counts for nothing.
  bool IsWhole = false;

  /// The receiver's texels that it has a part of.
  TexelRectangle GetTexels() const;
  /// The window as a receiver, whose texels are Fine. `side`: the parent's, if that is chosen
  /// automatically.
  Receiver MakeReceiver(const Receiver& parent, ReceiverSide side) const;

  bool operator==(const FineWindow& other) const
  {
    return this->Factor == other.Factor && this->Fine == other.Fine &&
      this->IsWhole == other.IsWhole;
  }
};

/// What PlanWindows() decides.
struct WindowPlan
{
  std::vector<FineWindow> Windows; ///< none overlaps another one
  /// How much larger their texels are, along each edge, than shadows ask for: to stay below
  /// MostFineTexels.
  double Growth = 1.0;
  double NeededTexels = 0.0; ///< of all windows, without that
};

/**
 * Windows to be shown by themselves: these, of at most so many texels in all; where they have more,
 * they get larger ones.
 */
PENUMBRARENDERING_EXPORT std::vector<FineWindow> LimitWindows(
  std::vector<FineWindow> windows, double mostTexels);

/// Of the windows of one receiver, the most texels.
constexpr double MostFineTexels = 4.0 * 1024 * 1024;

/**
 * Whether a receiver's texels are too large for the shadow of a connected part: the shadow is less
 * than 32 texels thick. A shadow's area, counted by texels' centres, is off by up to half a texel
 * at each of its edges, hence by a few percent of so thin a shadow, and by all of a shadow that is
 * smaller than a texel. Its thickness is its area over its length, and the width that its penumbra
 * has everywhere, since smooth shadows need no more.
 */
PENUMBRARENDERING_EXPORT bool NeedsWindow(
  const PartShadow& shadow, const ReceiverFrame& frame, const glm::ivec2& texels);

/**
 * Plans windows around the shadows that need them, each of 64 texels across its thickness; those
 * that overlap are one. `large` are the bounds of the shadows that do not.
 */
PENUMBRARENDERING_EXPORT WindowPlan PlanWindows(const std::vector<PartShadow>& small,
  const std::vector<ShadowBounds>& large, const ReceiverFrame& frame, const glm::ivec2& texels);

} // namespace penumbra

#endif

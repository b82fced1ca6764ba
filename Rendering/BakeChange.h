// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What of a bake has to be done anew.
 */
#ifndef BakeChange_h
#define BakeChange_h

#include "EffectPlanner.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "TexelRectangle.h"

#include <vector>

namespace penumbra
{

/// What has become of a light since a receiver was baked.
struct LightChange
{
  static constexpr int New = -1;
  int Before = New;     ///< its index among the lights of then
  TexelRectangle Stale; ///< where what blocks it has changed
};

/// What has changed since a receiver was baked, in the texels that are baked.
struct BakeChange
{
  TexelRectangle Resolved;         ///< the texels whose irradiance may be another now
  std::vector<LightChange> Lights; ///< of each light of now
};

/**
 * Compares the plans of a receiver that has not changed itself. Lights are the same if all but
 * their radiance is; surfaces, if they are the same SharedSurface. A surface that has moved is one
 * that went and one that came: it can change texels where its shadows were, or are now.
 *
 * `halo` is how far texels depend on the masks of others.
 */
PENUMBRARENDERING_EXPORT BakeChange FindBakeChange(
  const ReceiverPlan& before, const ReceiverPlan& now, int halo);

} // namespace penumbra

#endif

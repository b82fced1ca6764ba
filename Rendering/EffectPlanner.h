// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What a (receiver, light) pair needs.
 */
#ifndef EffectPlanner_h
#define EffectPlanner_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

namespace penumbra
{

/// What has to be computed for a light on a receiver (DESIGN 6).
enum class Effect
{
  None, ///< no light arrives: the light is behind the receiver, or dark, or shines away from it
  Unoccluded, ///< nothing can block: the closed form alone, no samples
  Soft        ///< samples decide how much of the light is seen
};

/// The effect's name, as RadianceMap's field data give it.
PENUMBRARENDERING_EXPORT const char* GetEffectName(Effect effect);

/**
 * Plans one pair from bounds alone.
 *
 * @param frame the receiver
 * @param seen the light, clipped to the receiver's lit side (LightShape::Clip)
 * @param hasOccluders whether any triangle reaches between the receiver and the light
 */
PENUMBRARENDERING_EXPORT Effect PlanEffect(
  const ReceiverFrame& frame, const LightShape& seen, bool hasOccluders);

} // namespace penumbra

#endif

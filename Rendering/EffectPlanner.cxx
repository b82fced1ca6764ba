// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EffectPlanner.h"

#include <algorithm>
#include <array>

namespace penumbra
{

const char* GetEffectName(Effect effect)
{
  switch (effect)
  {
    case Effect::None:
      return "None";
    case Effect::Unoccluded:
      return "Unoccluded";
    case Effect::Soft:
      break;
  }
  return "Soft";
}

Effect PlanEffect(const ReceiverFrame& frame, const LightShape& seen, bool hasOccluders)
{
  if (!seen.IsValid() || seen.Radiance == glm::dvec3(0.0))
  {
    return Effect::None;
  }
  // H&H 1997, 3.6, first test: is the receiver's parallelogram entirely behind the light?
  const std::array<glm::dvec2, 4> corners{ { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } };
  const bool facesReceiver = std::any_of(corners.begin(), corners.end(),
    [&](const glm::dvec2& c) {
      return seen.Faces(frame.ToWorld({ c, 0.0 }));
    });
  if (!facesReceiver)
  {
    return Effect::None;
  }
  return hasOccluders ? Effect::Soft : Effect::Unoccluded;
}

} // namespace penumbra

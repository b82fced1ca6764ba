// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LightShape.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>

namespace penumbra
{

double BoundDistance(const glm::dvec3& low, const glm::dvec3& high, const Parallelogram& receiver)
{
  glm::dvec3 receiverLow(receiver.Corner), receiverHigh(receiver.Corner);
  for (const glm::dvec3& edge : { receiver.EdgeX, receiver.EdgeY })
  {
    receiverLow += glm::min(edge, glm::dvec3(0.0));
    receiverHigh += glm::max(edge, glm::dvec3(0.0));
  }
  const glm::dvec3 gap =
    glm::max(glm::max(low - receiverHigh, receiverLow - high), glm::dvec3(0.0));
  return glm::length(gap);
}

double BoundSolidAngle(
  double area, const glm::dvec3& low, const glm::dvec3& high, const Parallelogram& receiver)
{
  // Boxes are no further apart than what they hold.
  const double distance = BoundDistance(low, high, receiver);
  const double squaredDistance = distance * distance;
  const double most = 4.0 * glm::pi<double>();
  return area < most * squaredDistance ? area / squaredDistance : most;
}

glm::dvec3 LightShape::GetIrradianceBound(const Parallelogram& receiver) const
{
  return this->Radiance * std::min(this->GetSolidAngleBound(receiver) / glm::pi<double>(), 1.0);
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LightShape.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

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
  const LightHull hull = this->GetHull();
  if (hull.Points.empty())
  {
    return glm::dvec3(0.0);
  }
  // The cosines on both ends are heights over the one's plane and the other's, over the distance.
  const glm::dvec3 normal = glm::normalize(glm::cross(receiver.EdgeX, receiver.EdgeY));
  glm::dvec3 low = hull.Points.front(), high = low;
  double overReceiver = 0.0, overLight = 0.0;
  for (const glm::dvec3& p : hull.Points)
  {
    low = glm::min(low, p);
    high = glm::max(high, p);
    overReceiver = std::max(overReceiver, std::abs(glm::dot(normal, p - receiver.Corner)));
  }
  for (const glm::dvec3& edges :
    { glm::dvec3(0.0), receiver.EdgeX, receiver.EdgeY, receiver.EdgeX + receiver.EdgeY })
  {
    overLight = std::max(overLight,
      std::abs(glm::dot(this->GetAxis(), receiver.Corner + edges - hull.Points.front())));
  }
  const double distance = BoundDistance(low, high, receiver);
  const auto boundCosine = [&](double height)
  { return height < distance ? height / distance : 1.0; };
  const double most = this->GetMeasure() / (glm::pi<double>() * distance * distance) *
    boundCosine(overReceiver) * boundCosine(overLight); // may be infinite
  return this->Radiance * std::min(most, 1.0);
}

} // namespace penumbra

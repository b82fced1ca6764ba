// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReceiverFrame.h"

#include "Coordinates.h"

#include <cmath>

namespace penumbra
{

ReceiverFrame::ReceiverFrame(const Parallelogram& base, Side side)
  : Base(base)
{
  const glm::dvec3 areaVector = glm::cross(base.EdgeX, base.EdgeY);
  const double area = glm::length(areaVector);
  if (!(area >= SmallestArea) || !std::isfinite(area) ||
    !std::isfinite(glm::dot(base.Corner, base.Corner)))
  {
    return;
  }
  const glm::dvec3 front = areaVector / area;
  this->Normal = side == Side::Front ? front : -front;
  this->Size = std::sqrt(area);
  this->DualX = glm::cross(base.EdgeY, front) / area;
  this->DualY = glm::cross(front, base.EdgeX) / area;
  const glm::dvec3 axisX = glm::normalize(base.EdgeX);
  this->Axes = glm::dmat3(axisX, glm::cross(this->Normal, axisX), this->Normal);
}

glm::dvec3 ReceiverFrame::ToFrame(const glm::dvec3& world) const
{
  return this->DirectionToFrame(world - this->Base.Corner);
}

glm::dvec3 ReceiverFrame::DirectionToFrame(const glm::dvec3& d) const
{
  return { glm::dot(this->DualX, d), glm::dot(this->DualY, d),
    glm::dot(this->Normal, d) / this->Size };
}

glm::dvec3 ReceiverFrame::ToWorld(const glm::dvec3& uvh) const
{
  return this->Base.Corner + uvh.x * this->Base.EdgeX + uvh.y * this->Base.EdgeY +
    uvh.z * this->Size * this->Normal;
}

glm::dmat4 ReceiverFrame::GetWorldToFrame() const
{
  const glm::dvec3 dualH = this->Normal / this->Size;
  const glm::dvec3& b = this->Base.Corner;
  return glm::transpose(glm::dmat4(glm::dvec4(this->DualX, -glm::dot(this->DualX, b)),
    glm::dvec4(this->DualY, -glm::dot(this->DualY, b)), glm::dvec4(dualH, -glm::dot(dualH, b)),
    glm::dvec4(0.0, 0.0, 0.0, 1.0)));
}

glm::dvec3 ReceiverFrame::ToMetric(const glm::dvec3& world) const
{
  const glm::dvec3 centre = 0.5 * (this->Base.EdgeX + this->Base.EdgeY);
  return this->DirectionToMetric((world - this->Base.Corner) - centre);
}

glm::dvec3 ReceiverFrame::DirectionToMetric(const glm::dvec3& direction) const
{
  return (direction * this->Axes) / this->Size;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra
{

SegmentLight::SegmentLight(const glm::dvec3& begin, const glm::dvec3& end)
  : Begin(begin)
  , End(end)
{
}

SegmentLight SegmentLight::Transformed(const glm::dmat4& matrix) const
{
  SegmentLight result = *this;
  result.Begin = glm::dvec3(matrix * glm::dvec4(this->Begin, 1.0));
  result.End = glm::dvec3(matrix * glm::dvec4(this->End, 1.0));
  return result;
}

SegmentLight SegmentLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  SegmentLight result = *this;
  const double begin = glm::dot(this->Begin - point, normal);
  const double end = glm::dot(this->End - point, normal);
  if (begin <= 0.0 && end <= 0.0)
  {
    result.End = result.Begin;
  }
  else if (begin < 0.0 || end < 0.0)
  {
    const glm::dvec3 cut = this->Begin + begin / (begin - end) * (this->End - this->Begin);
    (begin < 0.0 ? result.Begin : result.End) = cut;
  }
  return result;
}

bool SegmentLight::Faces(const glm::dvec3& point) const
{
  // Along its own line the segment is seen from its end, and shows nothing.
  return glm::length(glm::cross(point - this->Begin, this->GetAxis())) > 0.0;
}

LightHull SegmentLight::GetHull() const
{
  return { { this->Begin, this->End }, false };
}

double SegmentLight::FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const
{
  const SegmentLight seen = this->ClippedToFront(x, normal);
  if (!seen.IsValid())
  {
    return 0.0;
  }
  // A place is foot + l axis; the foot of the perpendicular from x is at the distance d.
  const glm::dvec3 axis = this->GetAxis();
  const double from = glm::dot(seen.Begin - x, axis), to = glm::dot(seen.End - x, axis);
  const glm::dvec3 foot = seen.Begin - x - from * axis;
  const double d = glm::length(foot);
  if (!(d > 0.0))
  {
    return 0.0;
  }
  // The integral of d (n . foot + l n . axis) / (d^2 + l^2)^2.
  const auto antiderivative = [&](double l)
  {
    const double r2 = d * d + l * l;
    return glm::dot(normal, foot) * 0.5 * (l / (d * r2) + std::atan(l / d) / (d * d)) -
      glm::dot(normal, axis) * 0.5 * d / r2;
  };
  return std::max(antiderivative(to) - antiderivative(from), 0.0) / glm::pi<double>();
}

double SegmentLight::GetMeasure() const
{
  const double length = glm::length(this->End - this->Begin);
  return std::isfinite(length) ? length : 0.0;
}

glm::dvec3 SegmentLight::GetIrradianceBound(const Parallelogram& receiver) const
{
  const double distance =
    BoundDistance(glm::min(this->Begin, this->End), glm::max(this->Begin, this->End), receiver);
  return this->Radiance * this->GetMeasure() /
    (glm::pi<double>() * distance * distance); // may be infinite
}

std::vector<LightSample> SegmentLight::TakeSamples(const std::vector<glm::dvec2>& pattern) const
{
  std::vector<LightSample> samples(pattern.size());
  for (std::size_t i = 0; i < pattern.size(); ++i)
  {
    samples[i].Place = this->Begin + pattern[i].x * (this->End - this->Begin);
  }
  return samples;
}

glm::dvec3 SegmentLight::GetAxis() const
{
  const double length = this->GetMeasure();
  return length > 0.0 ? (this->End - this->Begin) / length : glm::dvec3(0.0, 0.0, 1.0);
}

double SegmentLight::GetAspect() const
{
  return std::numeric_limits<double>::infinity();
}

std::vector<double> SegmentLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(2);
  for (const glm::dvec3& v : { this->Begin, this->End })
  {
    key.insert(key.end(), { v.x, v.y, v.z });
  }
  return key;
}

} // namespace penumbra

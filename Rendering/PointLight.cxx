// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra
{

PointLight::PointLight(const glm::dvec3& place)
  : Place(place)
  , IsThere(std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z))
{
}

PointLight PointLight::Transformed(const glm::dmat4& matrix) const
{
  PointLight result(glm::dvec3(matrix * glm::dvec4(this->Place, 1.0)));
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  return result;
}

PointLight PointLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  PointLight result = *this;
  result.IsThere = this->IsThere && glm::dot(this->Place - point, normal) > 0.0;
  return result;
}

LightHull PointLight::GetHull() const
{
  return { { this->Place }, false };
}

double PointLight::FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const
{
  const glm::dvec3 d = this->Place - x;
  const double distance = glm::length(d);
  const double height = glm::dot(d, normal);
  return this->IsThere && height > 0.0
    ? height / (glm::pi<double>() * distance * distance * distance)
    : 0.0;
}

glm::dvec3 PointLight::GetIrradianceBound(const Parallelogram& receiver) const
{
  const double distance = BoundDistance(this->Place, this->Place, receiver);
  return this->Radiance / (glm::pi<double>() * distance * distance); // may be infinite
}

std::vector<LightSample> PointLight::TakeSamples(const std::vector<glm::dvec2>&) const
{
  LightSample sample;
  sample.Place = this->Place;
  return { sample };
}

std::vector<double> PointLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(3);
  key.insert(key.end(), { this->Place.x, this->Place.y, this->Place.z });
  return key;
}

} // namespace penumbra

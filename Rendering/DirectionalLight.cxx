// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DirectionalLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra
{
namespace
{

const glm::dvec3 Origin(0.0);

} // namespace

DirectionalLight::DirectionalLight(const glm::dvec3& direction, double angularDiameter)
  : AngularDiameter(angularDiameter)
  , Disk(Origin, Origin, 0.0)
{
  const double length = glm::length(direction);
  if (length > 0.0 && std::isfinite(length))
  {
    this->IsThere = true;
    this->Source = -direction / length;
    this->Disk = DiskLight(this->Source, -this->Source, this->GetRadius());
  }
}

double DirectionalLight::GetRadius() const
{
  return std::tan(0.5 * glm::radians(this->AngularDiameter));
}

DirectionalLight DirectionalLight::Transformed(const glm::dmat4& matrix) const
{
  DirectionalLight result(glm::dmat3(matrix) * -this->Source, this->AngularDiameter);
  result.SetFirstAxis(glm::dmat3(matrix) * this->Disk.GetFirstAxis());
  result.IsThere = result.IsThere && this->IsThere;
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  return result;
}

DirectionalLight DirectionalLight::ClippedToFront(const glm::dvec3&, const glm::dvec3& normal) const
{
  DirectionalLight result = *this;
  result.Disk = this->Disk.ClippedToFront(Origin, normal);
  result.IsThere = this->IsThere &&
    (this->Disk.IsValid() ? result.Disk.IsValid() : glm::dot(this->Source, normal) > 0.0);
  return result;
}

LightHull DirectionalLight::GetHull() const
{
  return { this->Disk.IsValid() ? this->Disk.GetHull().Points
                                : std::vector<glm::dvec3>{ this->Source },
    true };
}

double DirectionalLight::FormFactor(const glm::dvec3&, const glm::dvec3& normal) const
{
  if (!this->IsThere)
  {
    return 0.0;
  }
  if (!this->Disk.IsValid())
  {
    return std::max(glm::dot(this->Source, normal), 0.0) / glm::pi<double>();
  }
  // The form factor of the whole disk, seen head on: sin^2 of the angular radius.
  const double radius = this->GetRadius();
  const double whole = radius * radius / (1.0 + radius * radius);
  return this->Disk.FormFactor(Origin, normal) / (glm::pi<double>() * whole);
}

double DirectionalLight::GetSolidAngleBound(const Parallelogram&) const
{
  // 2 pi (1 - cos a) = 4 pi sin^2(a / 2).
  const double sine = std::sin(0.25 * glm::radians(this->AngularDiameter));
  return 4.0 * glm::pi<double>() * sine * sine;
}

glm::dvec3 DirectionalLight::GetIrradianceBound(const Parallelogram&) const
{
  return this->Radiance / glm::pi<double>(); // at normal incidence
}

std::vector<LightSample> DirectionalLight::TakeSamples(const std::vector<glm::dvec2>& pattern) const
{
  LightSample sample;
  sample.IsDirection = true;
  sample.Place = this->Source;
  if (!this->Disk.IsValid())
  {
    return { sample };
  }
  std::vector<LightSample> samples;
  for (const glm::dvec2& s : pattern)
  {
    sample.Place = this->Disk.Sample(s);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<double> DirectionalLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(4);
  key.insert(key.end(), { this->Source.x, this->Source.y, this->Source.z, this->AngularDiameter });
  const std::vector<double> diskKey = this->Disk.GetKey(); // what a plane has left of it
  key.insert(key.end(), diskKey.begin(), diskKey.end());
  return key;
}

} // namespace penumbra

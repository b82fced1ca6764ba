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

/// Areas of the disk at distance 1 are cos^-3 of solid angles, and weights fall with cos^4: within
/// 30 degrees of the axis, by less than a half.
constexpr double WidestDisk = 60.0; // degrees

/// The part of a cone of directions that a horizon leaves, divided by solid angle. Around the
/// cone's axis, a horizon leaves the azimuths phi, from its highest point, with
/// cos(phi) >= h / tan(theta), where h is the tangent of its angle to the axis.
class CutCone
{
public:
  CutCone(double angularRadius, double horizon)
    : Horizon(horizon)
    , Height(1.0 - std::cos(angularRadius))
    , Below(Steps + 1, 0.0)
  {
    double before = this->GetAzimuth(0.0);
    for (std::size_t i = 1; i <= Steps; ++i)
    {
      const double now = this->GetAzimuth(this->GetLevel(static_cast<double>(i)));
      this->Below[i] = this->Below[i - 1] + 0.5 * (before + now);
      before = now;
    }
  }

  /// Maps the unit square onto it: the direction in the frame (first axis, across it, cone's axis).
  glm::dvec3 Sample(const glm::dvec2& s) const
  {
    const double wanted = s.x * this->Below.back();
    const auto above = std::upper_bound(this->Below.begin() + 1, this->Below.end() - 1, wanted);
    const double low = *(above - 1), high = *above;
    const double step = static_cast<double>(above - 1 - this->Below.begin()) +
      (high > low ? std::clamp((wanted - low) / (high - low), 0.0, 1.0) : 0.0);
    const double level = this->GetLevel(step);
    const double cosine = 1.0 - level;
    const double sine = std::sqrt(level * (2.0 - level));
    const double azimuth = (2.0 * s.y - 1.0) * this->GetAzimuth(level);
    return { sine * std::cos(azimuth), sine * std::sin(azimuth), cosine };
  }

private:
  /// Steps of equal solid angle of the whole cone: linear in between, shares are off by about
  /// 1 / Steps^2.
  static constexpr std::size_t Steps = 1024;

  /// 1 - cos(theta) after so many steps.
  double GetLevel(double step) const { return this->Height * step / Steps; }

  /// The largest azimuth that is left at 1 - cos(theta).
  double GetAzimuth(double level) const
  {
    const double cosine = 1.0 - level;
    const double sine = std::sqrt(level * (2.0 - level));
    return std::acos(std::clamp(
      this->Horizon * cosine / std::max(sine, std::numeric_limits<double>::min()), -1.0, 1.0));
  }

  double Horizon;
  double Height;             ///< 1 - cosine of the angular radius
  std::vector<double> Below; ///< what is left below each step, up to a factor
};

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
  if (this->IsWide())
  {
    return this->TakeDirections(pattern);
  }
  std::vector<LightSample> samples;
  for (const glm::dvec2& s : pattern)
  {
    sample.Place = this->Disk.Sample(s);
    samples.push_back(sample);
  }
  return samples;
}

bool DirectionalLight::IsWide() const
{
  return this->AngularDiameter > WidestDisk;
}

std::vector<LightSample> DirectionalLight::TakeDirections(
  const std::vector<glm::dvec2>& pattern) const
{
  const double angularRadius = 0.5 * glm::radians(this->AngularDiameter);
  const double radius = this->GetRadius();
  const bool isCut = this->Disk.GetCutOffset() > -1.0;
  const CutCone cone(angularRadius, radius * this->Disk.GetCutOffset());
  const glm::dvec3& first = this->Disk.GetFirstAxis();
  const glm::dvec3 across = glm::cross(this->Disk.GetNormal(), first);
  std::vector<LightSample> samples(pattern.size());
  for (std::size_t i = 0; i < pattern.size(); ++i)
  {
    samples[i].IsDirection = true;
    if (isCut)
    {
      const glm::dvec3 d = cone.Sample(pattern[i]);
      samples[i].Place = d.x * first + d.y * across + d.z * this->Source;
      continue;
    }
    // The disk's concentric map, its areas become solid angles (Lambert's azimuthal projection).
    const glm::dvec3 p = (this->Disk.Sample(pattern[i]) - this->Source) / radius;
    const double level = (1.0 - std::cos(angularRadius)) * std::min(glm::dot(p, p), 1.0);
    const double distance = std::max(glm::length(p), std::numeric_limits<double>::min());
    samples[i].Place =
      (1.0 - level) * this->Source + std::sqrt(level * (2.0 - level)) / distance * p;
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

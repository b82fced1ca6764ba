// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShadowSettings.h"

#include "Coordinates.h"
#include "DirectionalLight.h"
#include "DiskLight.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "SamplingPattern.h"
#include "SegmentLight.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

namespace penumbra
{
namespace
{

/// "Name is VALUE; allowed: WHAT".
template <typename Value>
std::string Describe(const char* name, const Value& value, const std::string& allowed)
{
  std::ostringstream text;
  text << name << " is " << value << "; allowed: " << allowed;
  return text.str();
}

std::string Describe(const char* name, const glm::dvec3& v, const std::string& allowed)
{
  std::ostringstream value;
  value << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return Describe(name, value.str(), allowed);
}

bool IsIn(const glm::dvec3& v, double low, double high)
{
  return glm::all(glm::greaterThanEqual(v, glm::dvec3(low))) &&
    glm::all(glm::lessThanEqual(v, glm::dvec3(high)));
}

} // namespace

bool ReceiverSettings::operator==(const ReceiverSettings& other) const
{
  const auto tie = [](const ReceiverSettings& s)
  {
    return std::tie(s.TexelSize, s.LightSamples, s.SampleMultiplier, s.SamplingPattern,
      s.Supersampling, s.Reflectance, s.AmbientRadiance, s.Side, s.Seed, s.SolidAnglePerSample,
      s.ErrorTolerance, s.MaximumLightSamples, s.Reconstruction, s.ExactShares, s.Planner,
      s.PlannerTolerance, s.HardPenumbra, s.PlanarityTolerance, s.ProxyPlane, s.ProxyMode,
      s.ProxyOrigin, s.ProxyNormal);
  };
  return tie(*this) == tie(other);
}

std::string ReceiverSettings::FindProblem() const
{
  if (!(this->TexelSize >= 0.0) || !std::isfinite(this->TexelSize))
  {
    return Describe("TexelSize", this->TexelSize, "0 (automatic) or a length > 0");
  }
  if (this->LightSamples < 1 || this->LightSamples > MostLightSamples)
  {
    return Describe("LightSamples", this->LightSamples, "1 to 65536");
  }
  if (!(this->SampleMultiplier > 0.0) || !std::isfinite(this->SampleMultiplier))
  {
    return Describe("SampleMultiplier", this->SampleMultiplier, "a number > 0");
  }
  const int patterns = static_cast<int>(GetSamplingPatterns().size());
  if (this->SamplingPattern < 0 || this->SamplingPattern >= patterns)
  {
    return Describe(
      "SamplingPattern", this->SamplingPattern, "0 to " + std::to_string(patterns - 1));
  }
  if (this->Supersampling != 1 && this->Supersampling != 2 && this->Supersampling != 4)
  {
    return Describe("Supersampling", this->Supersampling, "1, 2 or 4");
  }
  if (!IsIn(this->Reflectance, 0.0, 1.0))
  {
    return Describe("Reflectance", this->Reflectance, "0 to 1 for each component");
  }
  if (!IsIn(this->AmbientRadiance, 0.0, LightSettings::MaximumRadiance))
  {
    return Describe("AmbientRadiance", this->AmbientRadiance, "0 to 1e30 for each component");
  }
  if (!(this->SolidAnglePerSample >= 0.0) || !std::isfinite(this->SolidAnglePerSample))
  {
    return Describe(
      "SolidAnglePerSample", this->SolidAnglePerSample, "0 (off) or a solid angle > 0");
  }
  if (!(this->ErrorTolerance >= 0.0 && this->ErrorTolerance <= 1.0))
  {
    return Describe("ErrorTolerance", this->ErrorTolerance, "0 (off) to 1, a share of the peak");
  }
  if (!(this->PlannerTolerance >= 0.0 && this->PlannerTolerance <= 1.0))
  {
    return Describe("PlannerTolerance", this->PlannerTolerance, "0 to 1, a share of the peak");
  }
  if (!(this->HardPenumbra >= 0.0) || !std::isfinite(this->HardPenumbra))
  {
    return Describe("HardPenumbra", this->HardPenumbra, "0 or a number of texels > 0");
  }
  if (!(this->PlanarityTolerance >= 0.0) || !std::isfinite(this->PlanarityTolerance))
  {
    return Describe(
      "PlanarityTolerance", this->PlanarityTolerance, "0 (automatic) or a length > 0");
  }
  if (this->MaximumLightSamples < 1 || this->MaximumLightSamples > MostLightSamples)
  {
    return Describe("MaximumLightSamples", this->MaximumLightSamples, "1 to 65536");
  }
  const int side = static_cast<int>(this->Side);
  if (side < 0 || side > 3)
  {
    return Describe("Side", side, "0 (Auto), 1 (Front), 2 (Back) or 3 (Both)");
  }
  return this->ProxyPlane ? this->FindProxyProblem() : "";
}

std::string ReceiverSettings::FindProxyProblem() const
{
  const int mode = static_cast<int>(this->ProxyMode);
  if (mode < 0 || mode > 1)
  {
    return Describe("ProxyPlaneMode", mode, "0 (Best Fit) or 1 (Given)");
  }
  if (this->ProxyMode == ProxyPlaneMode::BestFit)
  {
    return "";
  }
  if (!IsInRange(this->ProxyOrigin))
  {
    return Describe("ProxyOrigin", this->ProxyOrigin, AllowedCoordinates);
  }
  const double length = glm::length(this->ProxyNormal);
  return length > 0.0 && std::isfinite(length)
    ? ""
    : Describe("ProxyNormal", this->ProxyNormal, "a direction: finite, and not (0, 0, 0)");
}

ReceiverSettings ReceiverSettings::Transformed(const glm::dmat4& matrix) const
{
  ReceiverSettings result = *this;
  result.ProxyOrigin = glm::dvec3(matrix * glm::dvec4(this->ProxyOrigin, 1.0));
  result.ProxyNormal = glm::transpose(glm::inverse(glm::dmat3(matrix))) * this->ProxyNormal;
  const glm::dmat3 linear(matrix);
  result.PlanarityTolerance *=
    std::max({ glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]) });
  return result;
}

int ReceiverSettings::GetSampleCount() const
{
  const double count = std::round(this->LightSamples * this->SampleMultiplier);
  return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(MostLightSamples)));
}

int ReceiverSettings::GetSampleCount(double solidAngle) const
{
  if (this->SolidAnglePerSample <= 0.0 || solidAngle <= 0.0)
  {
    return this->GetSampleCount();
  }
  const double count = std::ceil(solidAngle / this->SolidAnglePerSample);
  return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(this->MaximumLightSamples)));
}

std::string CasterSettings::FindProblem() const
{
  return this->Transmittance && !IsIn(*this->Transmittance, 0.0, 1.0)
    ? Describe("Transmittance", *this->Transmittance, "0 to 1 for each component")
    : "";
}

CasterSettings CasterSettings::Overridden(const CasterSettings& own) const
{
  return { this->CastShadow && own.CastShadow,
    own.Transmittance ? own.Transmittance : this->Transmittance };
}

glm::dvec3 CasterSettings::GetTransmittance() const
{
  return this->CastShadow ? this->Transmittance.value_or(glm::dvec3(0.0)) : glm::dvec3(1.0);
}

glm::dvec3 GetTransmittance(double opacity, const glm::dvec3& colour)
{
  const double largest = std::max({ colour.x, colour.y, colour.z });
  const glm::dvec3 hue = largest > 0.0 ? colour / largest : glm::dvec3(1.0);
  return glm::clamp((1.0 - opacity) * (1.0 - opacity + opacity * hue), 0.0, 1.0);
}

std::string LightSettings::FindProblem() const
{
  const int shape = static_cast<int>(this->Shape);
  if (shape < 0 || shape > static_cast<int>(LightKind::Surface))
  {
    return Describe("Shape", shape,
      "0 (Parallelogram), 1 (Triangle), 2 (Disk), 3 (Segment), 4 (Point) or 5 (Directional)");
  }
  if (!IsInRange(this->Origin))
  {
    return Describe("Origin", this->Origin, AllowedCoordinates);
  }
  if (!IsInRange(this->Point1))
  {
    return Describe("Point1", this->Point1, AllowedCoordinates);
  }
  if (!IsInRange(this->Point2))
  {
    return Describe("Point2", this->Point2, AllowedCoordinates);
  }
  if (!IsIn(this->Radiance, 0.0, MaximumRadiance))
  {
    return Describe("Radiance", this->Radiance, "0 to 1e30 for each component");
  }
  if (!(this->AngularDiameter >= 0.0 && this->AngularDiameter < 180.0))
  {
    return Describe("AngularDiameter", this->AngularDiameter, "0 to less than 180 degrees");
  }
  if (this->Shape == LightKind::Surface || this->MakeLight()->IsValid())
  {
    return "";
  }
  if (this->Shape == LightKind::Segment || this->Shape == LightKind::Directional)
  {
    return Describe("the distance from Origin to Point1", glm::length(this->Point1 - this->Origin),
      "more than 0");
  }
  return Describe("the area between Origin, Point1 and Point2", this->MakeLight()->GetMeasure(),
    "more than 0: the points must not lie on a line");
}

Light LightSettings::MakeLight() const
{
  Light light = this->MakeShape();
  light->Radiance = this->Radiance;
  light->TwoSided = this->TwoSided;
  return light;
}

Light LightSettings::MakeShape() const
{
  // Samples go with the points, so that a light that turns does not flicker.
  const glm::dvec3 toPoint1 = this->Point1 - this->Origin;
  const glm::dvec3 toPoint2 = this->Point2 - this->Origin;
  switch (this->Shape)
  {
    case LightKind::Triangle:
      return PolygonLight::Triangle(this->Origin, this->Point1, this->Point2);
    case LightKind::Disk:
    {
      DiskLight disk(this->Origin, glm::cross(toPoint1, toPoint2), glm::length(toPoint1));
      disk.SetFirstAxis(toPoint1);
      return disk;
    }
    case LightKind::Segment:
      return SegmentLight(this->Origin, this->Point1);
    case LightKind::Point:
      return PointLight(this->Origin);
    case LightKind::Directional:
    {
      DirectionalLight sun(toPoint1, this->AngularDiameter);
      sun.SetFirstAxis(toPoint2);
      return sun;
    }
    default:
      return PolygonLight::Parallelogram(this->Origin, this->Point1, this->Point2);
  }
}

} // namespace penumbra

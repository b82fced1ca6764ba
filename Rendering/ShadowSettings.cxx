// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShadowSettings.h"

#include "SamplingPattern.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace penumbra
{
namespace
{

bool IsFinite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

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
  return IsFinite(v) && glm::all(glm::greaterThanEqual(v, glm::dvec3(low))) &&
    glm::all(glm::lessThanEqual(v, glm::dvec3(high)));
}

/// The largest radiance: sums over many lights stay finite in single precision.
constexpr double MaximumRadiance = 1e30;

} // namespace

std::string ReceiverSettings::FindProblem() const
{
  if (!(this->TexelSize >= 0.0) || !std::isfinite(this->TexelSize))
  {
    return Describe("TexelSize", this->TexelSize, "0 (automatic) or a length > 0");
  }
  if (this->LightSamples < 1 || this->LightSamples > MaximumLightSamples)
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
  if (!IsIn(this->AmbientRadiance, 0.0, MaximumRadiance))
  {
    return Describe("AmbientRadiance", this->AmbientRadiance, "0 to 1e30 for each component");
  }
  const int side = static_cast<int>(this->Side);
  return side < 0 || side > 2 ? Describe("Side", side, "0 (Auto), 1 (Front) or 2 (Back)") : "";
}

int ReceiverSettings::GetSampleCount() const
{
  const double count = std::round(this->LightSamples * this->SampleMultiplier);
  return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(MaximumLightSamples)));
}

std::string LightSettings::FindProblem() const
{
  const int shape = static_cast<int>(this->Shape);
  if (shape < 0 || shape > 1)
  {
    return Describe("Shape", shape, "0 (Parallelogram) or 1 (Triangle)");
  }
  if (!IsFinite(this->Origin))
  {
    return Describe("Origin", this->Origin, "finite coordinates");
  }
  if (!IsFinite(this->Point1))
  {
    return Describe("Point1", this->Point1, "finite coordinates");
  }
  if (!IsFinite(this->Point2))
  {
    return Describe("Point2", this->Point2, "finite coordinates");
  }
  if (!IsIn(this->Radiance, 0.0, MaximumRadiance))
  {
    return Describe("Radiance", this->Radiance, "0 to 1e30 for each component");
  }
  const double area = this->MakeLight().GetArea();
  return area > 0.0 ? ""
                    : Describe("the area between Origin, Point1 and Point2", area,
                        "more than 0: the points must not lie on a line");
}

PolygonLight LightSettings::MakeLight() const
{
  PolygonLight light = this->Shape == LightShape::Triangle
    ? PolygonLight::Triangle(this->Origin, this->Point1, this->Point2)
    : PolygonLight::Parallelogram(this->Origin, this->Point1, this->Point2);
  light.Radiance = this->Radiance;
  light.TwoSided = this->TwoSided;
  return light;
}

} // namespace penumbra

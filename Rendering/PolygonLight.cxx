// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonLight.h"

#include "Coordinates.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace penumbra
{
namespace
{

/// Sutherland and Hodgman 1974, for one plane; `heights` are the vertices' signed distances from
/// it.
std::vector<glm::dvec3> ClipPolygon(
  const std::vector<glm::dvec3>& vertices, const std::vector<double>& heights)
{
  std::vector<glm::dvec3> clipped;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const std::size_t j = (i + 1) % vertices.size();
    if (heights[i] >= 0.0)
    {
      clipped.push_back(vertices[i]);
    }
    if ((heights[i] > 0.0 && heights[j] < 0.0) || (heights[i] < 0.0 && heights[j] > 0.0))
    {
      const double t = heights[i] / (heights[i] - heights[j]);
      clipped.push_back(vertices[i] + t * (vertices[j] - vertices[i]));
    }
  }
  return clipped;
}

/// Area-preserving map from the unit square to barycentric coordinates of a triangle: the half of
/// the square above the diagonal is folded onto the half below it (Heitz 2019, "A Low-Distortion
/// Map Between Triangle and Square").
glm::dvec2 SquareToTriangle(glm::dvec2 s)
{
  if (s.y > s.x)
  {
    s.x *= 0.5;
    s.y -= s.x;
  }
  else
  {
    s.y *= 0.5;
    s.x -= s.y;
  }
  return s;
}

} // namespace

PolygonLight::PolygonLight(std::vector<glm::dvec3> vertices, SampleMap map)
  : Vertices(std::move(vertices))
  , Map(map)
{
  glm::dvec3 areaVector(0.0);
  double extent = 0.0, largest = 0.0;
  for (const glm::dvec3& v : this->Vertices)
  {
    extent = std::max(extent, glm::length(v - this->Vertices[0]));
    largest = std::max(largest, glm::length(v));
  }
  for (std::size_t i = 1; i + 1 < this->Vertices.size(); ++i)
  {
    areaVector += 0.5 *
      glm::cross(this->Vertices[i] - this->Vertices[0], this->Vertices[i + 1] - this->Vertices[0]);
    this->FanShares.push_back(glm::length(areaVector));
  }
  const double area = glm::length(areaVector);
  // Points on a line span the area of their own rounding.
  if (!(area > std::max(SmallestArea, 4.0 * DBL_EPSILON * largest * extent)) ||
    !std::isfinite(area))
  {
    this->Vertices.clear();
    this->FanShares.clear();
    return;
  }
  this->Area = area;
  this->Normal = areaVector / area;
  for (double& share : this->FanShares)
  {
    share /= area;
  }
}

PolygonLight PolygonLight::Parallelogram(
  const glm::dvec3& origin, const glm::dvec3& point1, const glm::dvec3& point2)
{
  return PolygonLight(
    { origin, point1, point1 + (point2 - origin), point2 }, SampleMap::Parallelogram);
}

PolygonLight PolygonLight::Triangle(
  const glm::dvec3& origin, const glm::dvec3& point1, const glm::dvec3& point2)
{
  return PolygonLight({ origin, point1, point2 }, SampleMap::TriangleFan);
}

PolygonLight PolygonLight::Convex(std::vector<glm::dvec3> vertices)
{
  return PolygonLight(std::move(vertices), SampleMap::TriangleFan);
}

PolygonLight PolygonLight::Transformed(const glm::dmat4& matrix) const
{
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& vertex : this->Vertices)
  {
    vertices.emplace_back(matrix * glm::dvec4(vertex, 1.0));
  }
  if (glm::determinant(glm::dmat3(matrix)) < 0.0 && !vertices.empty())
  {
    std::reverse(vertices.begin() + 1, vertices.end()); // a mirror turns the winding round
  }
  PolygonLight result(std::move(vertices), this->Map);
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  return result;
}

PolygonLight PolygonLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  std::vector<double> heights;
  double largest = glm::length(point);
  for (const glm::dvec3& vertex : this->Vertices)
  {
    heights.push_back(glm::dot(vertex - point, normal));
    largest = std::max(largest, glm::length(vertex));
  }
  // A light that lies in the plane, but for the rounding of a difference and three products, sends
  // nothing along it.
  const double rounding = 4.0 * DBL_EPSILON * largest;
  if (std::all_of(heights.begin(), heights.end(), [&](double h) { return h <= rounding; }))
  {
    return PolygonLight({}, this->Map);
  }
  if (std::all_of(heights.begin(), heights.end(), [](double h) { return h >= 0.0; }))
  {
    return *this;
  }
  PolygonLight result(ClipPolygon(this->Vertices, heights), SampleMap::TriangleFan);
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  return result;
}

glm::dvec3 PolygonLight::Sample(const glm::dvec2& s) const
{
  const std::vector<glm::dvec3>& v = this->Vertices;
  if (this->Map == SampleMap::Parallelogram)
  {
    return v[0] + s.x * (v[1] - v[0]) + s.y * (v[3] - v[0]);
  }
  // s.x chooses the triangle by its share of the area; where it falls within the share is used
  // again.
  const auto share = std::upper_bound(this->FanShares.begin(), this->FanShares.end() - 1, s.x);
  const std::size_t i = static_cast<std::size_t>(share - this->FanShares.begin());
  const double before = i > 0 ? this->FanShares[i - 1] : 0.0;
  const double x = std::clamp((s.x - before) / (*share - before), 0.0, 1.0);
  const glm::dvec2 b = SquareToTriangle({ x, s.y });
  return v[0] + b.x * (v[i + 1] - v[0]) + b.y * (v[i + 2] - v[0]);
}

double PolygonLight::FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const
{
  const PolygonLight seen = this->ClippedToFront(x, normal);
  if (!seen.IsValid() || !this->Faces(x))
  {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.Vertices.size(); ++i)
  {
    const glm::dvec3 a = seen.Vertices[i] - x;
    const glm::dvec3 b = seen.Vertices[(i + 1) % seen.Vertices.size()] - x;
    const glm::dvec3 c = glm::cross(a, b);
    const double sine = glm::length(c);
    if (sine > 0.0)
    {
      sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, c) / sine;
    }
  }
  return std::clamp(std::abs(sum) / glm::two_pi<double>(), 0.0, 1.0);
}

bool PolygonLight::Faces(const glm::dvec3& point) const
{
  const double side = glm::dot(point - this->Vertices[0], this->Normal);
  return side > 0.0 || (side < 0.0 && this->TwoSided);
}

LightHull PolygonLight::GetHull() const
{
  return { this->Vertices, false };
}

double PolygonLight::GetSolidAngleBound(const penumbra::Parallelogram& receiver) const
{
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& vertex : this->Vertices)
  {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  return BoundSolidAngle(this->Area, low, high, receiver);
}

double PolygonLight::GetAspect() const
{
  return this->Map == SampleMap::Parallelogram && this->IsValid()
    ? glm::length(this->Vertices[1] - this->Vertices[0]) /
      glm::length(this->Vertices[3] - this->Vertices[0])
    : 1.0;
}

std::vector<LightSample> PolygonLight::TakeSamples(const std::vector<glm::dvec2>& pattern) const
{
  std::vector<LightSample> samples(pattern.size());
  for (std::size_t i = 0; i < pattern.size(); ++i)
  {
    samples[i].Place = this->Sample(pattern[i]);
  }
  return samples;
}

std::vector<EmittingPolygon> PolygonLight::GetPolygons() const
{
  if (this->Vertices.size() > MaximumVertices)
  {
    return {};
  }
  return { { this, this->Radiance } };
}

std::vector<double> PolygonLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(0);
  for (const glm::dvec3& v : this->Vertices)
  {
    key.insert(key.end(), { v.x, v.y, v.z });
  }
  return key;
}

} // namespace penumbra

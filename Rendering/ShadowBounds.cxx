// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShadowBounds.h"

#include <algorithm>
#include <cmath>

namespace penumbra
{
namespace
{

/// What is closer to a sample's height, as a part of it, casts its shadow more than a thousand
/// times as far as it is wide: that is anywhere.
constexpr double SmallestW = 1.0 / 1024.0;
/// Lights of more corners are taken by the box around them.
constexpr std::size_t MostCorners = 16;
/// A rasteriser may move an edge by the rounding of its coordinates, less than a texel.
constexpr double RasterTexels = 1.0;

/// The corners of the box around points.
std::vector<glm::dvec3> GetBoxCorners(const std::vector<glm::dvec3>& points)
{
  glm::dvec3 low = points.front(), high = points.front();
  for (const glm::dvec3& p : points)
  {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 8; ++i)
  {
    corners.emplace_back(
      (i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z);
  }
  return corners;
}

} // namespace

void ShadowBounds::Add(const ShadowBounds& other)
{
  this->Low = glm::min(this->Low, other.Low);
  this->High = glm::max(this->High, other.High);
  this->Penumbra = glm::max(this->Penumbra, other.Penumbra);
  this->IsUnbounded = this->IsUnbounded || other.IsUnbounded;
}

void ShadowBounds::AddPart(const ShadowBounds& other)
{
  this->Add(other);
  this->LowSlope = glm::min(this->LowSlope, other.LowSlope);
  this->HighSlope = glm::max(this->HighSlope, other.HighSlope);
  this->Reach = std::max(this->Reach, other.Reach);
  this->Penumbra = glm::max(this->Penumbra, this->Reach * (this->HighSlope - this->LowSlope));
}

TexelRectangle ShadowBounds::GetTexels(const glm::ivec2& texels) const
{
  const TexelRectangle whole = WholeRectangle(texels);
  if (this->IsUnbounded)
  {
    return whole;
  }
  if (!(this->Low.x <= this->High.x && this->Low.y <= this->High.y))
  {
    return {};
  }
  // Clamped while they are doubles: they may be past any integer.
  const glm::dvec2 count(texels);
  const auto clamp = [&](const glm::dvec2& v)
  { return glm::ivec2(glm::clamp(v, glm::dvec2(0.0), count)); };
  return { clamp(glm::floor(this->Low * count - RasterTexels)),
    clamp(glm::ceil(this->High * count + RasterTexels)) };
}

double ShadowBounds::GetPenumbraTexels(const glm::ivec2& texels) const
{
  return this->IsUnbounded ? std::numeric_limits<double>::infinity()
                           : glm::length(this->Penumbra * glm::dvec2(texels));
}

ShadowProjector::ShadowProjector(const ReceiverFrame& frame, const LightShape& seen)
{
  const LightHull hull = seen.GetHull();
  std::vector<glm::dvec3> corners;
  for (const glm::dvec3& p : hull.Points)
  {
    corners.push_back(hull.AreDirections ? frame.DirectionToFrame(p) : frame.ToFrame(p));
  }
  if (corners.size() > MostCorners && !hull.AreDirections)
  {
    corners = GetBoxCorners(corners);
  }
  const auto project = [&](const glm::dvec3& place)
  {
    return hull.AreDirections ? RegisteredProjection::FromDirection(place)
                              : RegisteredProjection::FromPoint(place);
  };
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& corner : corners)
  {
    if (!(corner.z > 0.0))
    {
      this->Projections.clear(); // the hull reaches the horizon, and shadows any place
      return;
    }
    this->Projections.push_back(project(corner));
    sum += corner;
  }
  this->Centre = project(sum / static_cast<double>(corners.size()));
}

void ShadowProjector::Add(const glm::dvec3& point, ShadowBounds& bounds) const
{
  ShadowBounds own;
  own.IsUnbounded = this->Projections.empty();
  for (const RegisteredProjection& projection : this->Projections)
  {
    const glm::dvec3 p = projection.Project(point);
    if (!(p.z > SmallestW))
    {
      own.IsUnbounded = true;
      break;
    }
    const glm::dvec2 place = glm::dvec2(p) / p.z;
    own.Low = glm::min(own.Low, place);
    own.High = glm::max(own.High, place);
  }
  bounds.Add(own);
  if (!own.IsUnbounded)
  {
    this->AddPenumbra(point, bounds);
  }
}

glm::dvec2 ShadowProjector::ProjectFromCentre(const glm::dvec3& point) const
{
  const glm::dvec3 p = this->Centre.Project(point);
  return p.z > SmallestW ? glm::dvec2(p) / p.z : glm::dvec2(0.0);
}

void ShadowProjector::AddPenumbra(const glm::dvec3& point, ShadowBounds& bounds) const
{
  const glm::dvec3& c = this->Centre.K;
  for (const RegisteredProjection& projection : this->Projections)
  {
    const glm::dvec3& k = projection.K;
    const glm::dvec2 slope = (glm::dvec2(point) * (k.z - c.z) + glm::dvec2(c) - glm::dvec2(k) +
                               point.z * (glm::dvec2(k) * c.z - glm::dvec2(c) * k.z)) /
      projection.Project(point).z;
    bounds.LowSlope = glm::min(bounds.LowSlope, slope);
    bounds.HighSlope = glm::max(bounds.HighSlope, slope);
  }
  // Below the receiver nothing casts a shadow; where an edge enters it, its shadow is itself.
  bounds.Reach = std::max(bounds.Reach, point.z / this->Centre.Project(point).z);
  bounds.Penumbra = glm::max(bounds.Penumbra, bounds.Reach * (bounds.HighSlope - bounds.LowSlope));
}

} // namespace penumbra

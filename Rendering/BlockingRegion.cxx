// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockingRegion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace penumbra
{
namespace
{

/// Of a light's points, the lowest height that is taken, in units of the receiver's size: what is
/// lower is rounding.
constexpr double SmallestHeight = std::numeric_limits<double>::epsilon();
/// Of the numbers that a depth is the difference of: their rounding decides nothing.
constexpr double Rounding = 1e-12;
/// In units of the receiver's size. Floats of this size are good to 4e-6, a five-hundredth of a
/// texel where there are 512 of them.
constexpr double FarAway = 64.0;
/// The plane of a light goes through three of its points, and others are as far off again.
constexpr double RoundingsOfPlane = 4.0;

/// The part of the hull of the points (of the directions, with w = 0) that is above h = 0: those
/// that are, and where the lines between those and the others go through.
std::vector<glm::dvec3> GetUpperHull(const std::vector<glm::dvec3>& points)
{
  std::vector<glm::dvec3> upper;
  for (const glm::dvec3& p : points)
  {
    if (p.z < 0.0)
    {
      continue;
    }
    upper.push_back(p);
    for (const glm::dvec3& q : points)
    {
      if (q.z < 0.0)
      {
        upper.push_back(glm::mix(p, q, p.z / (p.z - q.z)));
      }
    }
  }
  return upper;
}

/// The unit normal of the plane through all points, if there is one. Points count as in it up to
/// their rounding: that of the arithmetic, and that of their type along each axis.
std::optional<glm::dvec3> FindCommonNormal(
  const std::vector<glm::dvec3>& points, const glm::dvec3& rounding)
{
  const glm::dvec3& origin = points.front();
  double largest = 0.0;
  glm::dvec3 farthest(0.0), normal(0.0);
  for (const glm::dvec3& p : points)
  {
    largest = std::max({ largest, std::abs(p.x), std::abs(p.y), std::abs(p.z) });
    farthest = glm::length(p - origin) > glm::length(farthest) ? p - origin : farthest;
  }
  for (const glm::dvec3& p : points)
  {
    const glm::dvec3 area = glm::cross(farthest, p - origin);
    normal = glm::length(area) > glm::length(normal) ? area : normal;
  }
  if (!(glm::length(normal) > 0.0))
  {
    return std::nullopt;
  }
  normal = glm::normalize(normal);
  const double tolerance = 16.0 * std::numeric_limits<double>::epsilon() * largest +
    RoundingsOfPlane * glm::dot(glm::abs(normal), rounding);
  const bool isFlat = std::all_of(points.begin(), points.end(),
    [&](const glm::dvec3& p) { return std::abs(glm::dot(p - origin, normal)) <= tolerance; });
  return isFlat ? std::optional<glm::dvec3>(normal) : std::nullopt;
}

} // namespace

BlockingRegion::BlockingRegion(
  const ReceiverFrame& frame, const LightShape& seen, const glm::dvec4& uvRange)
  : FrameRows(glm::transpose(frame.GetWorldToFrame()))
  , First(uvRange.x, uvRange.y)
  , Last(uvRange.z, uvRange.w)
{
  const glm::dvec3 corner = glm::abs(frame.GetBase().Corner);
  this->CornerSize = std::max({ corner.x, corner.y, corner.z });
  const LightHull hull = seen.GetHull();
  std::vector<glm::dvec3> points;
  for (const glm::dvec3& p : hull.Points)
  {
    points.push_back(hull.AreDirections ? frame.DirectionToFrame(p) : frame.ToFrame(p));
  }
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  this->Low = glm::dvec2(Infinity);
  this->High = glm::dvec2(-Infinity);
  for (glm::dvec3 p : GetUpperHull(points))
  {
    p.z = std::max(p.z, SmallestHeight);
    // (k.x, k.y) - from k.z, where k.z is 0 for a direction.
    const auto slope = [&](const glm::dvec2& from)
    { return (glm::dvec2(p) - (hull.AreDirections ? glm::dvec2(0.0) : from)) / p.z; };
    this->Low = glm::min(this->Low, slope(this->First));
    this->High = glm::max(this->High, slope(this->Last));
    this->Top = std::max(this->Top, hull.AreDirections ? Infinity : p.z);
  }
  if (!hull.AreDirections && !hull.Points.empty())
  {
    this->LightNormal = FindCommonNormal(hull.Points, seen.Rounding);
  }
  if (this->LightNormal)
  {
    const Parallelogram& base = frame.GetBase();
    const glm::dvec3& n = *this->LightNormal;
    this->LightRounding = RoundingsOfPlane * glm::dot(glm::abs(n), seen.Rounding);
    this->LightPlane = { glm::dot(n, base.EdgeX), glm::dot(n, base.EdgeY),
      glm::dot(n, frame.GetNormal()) * frame.GetSize(),
      glm::dot(n, base.Corner - hull.Points.front()) };
  }
}

bool BlockingRegion::LiesInLight(
  const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double tolerance) const
{
  const auto isNear = [&](const glm::dvec3& p)
  {
    return std::abs(glm::dot(this->LightPlane, glm::dvec4(p, 1.0))) <=
      tolerance + this->LightRounding;
  };
  return this->LightNormal && isNear(a) && isNear(b) && isNear(c);
}

double BlockingRegion::GetDepth(int plane, const glm::dvec3& p) const
{
  if (plane >= 4)
  {
    return plane == 4 ? this->Top - p.z : p.z;
  }
  const int axis = plane / 2;
  const bool isLow = plane % 2 == 0;
  const double bound =
    isLow ? this->First[axis] + this->Low[axis] * p.z : this->Last[axis] + this->High[axis] * p.z;
  const double slack = Rounding * (std::abs(p[axis]) + std::abs(bound) + 1.0);
  return slack + (isLow ? p[axis] - bound : bound - p[axis]);
}

bool BlockingRegion::MayHold(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const
{
  // The part above the receiver: what goes below it may be in one of the planes there alone.
  const std::array<glm::dvec3, 3> triangle{ a, b, c };
  std::array<glm::dvec3, 4> above;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const glm::dvec3 &p = triangle[i], &q = triangle[(i + 1) % 3];
    if (p.z >= 0.0)
    {
      above[count++] = p;
    }
    if ((p.z > 0.0 && q.z < 0.0) || (p.z < 0.0 && q.z > 0.0))
    {
      above[count++] = glm::mix(p, q, p.z / (p.z - q.z));
    }
  }
  for (int plane = 0; plane < Planes; ++plane)
  {
    if (std::all_of(above.begin(), above.begin() + count,
          [&](const glm::dvec3& p) { return this->GetDepth(plane, p) < 0.0; }))
    {
      return false;
    }
  }
  return true;
}

// The slack of GetDepth() at h >= 0, made linear: let r = Rounding and b the bound. What is outside
// by t <= r (|u| + |b| + 1) has |u| <= |b| + t, so t (1 - r) <= r (2 |b| + 1), and with
// |b| <= 1 + |low| h that is t <= (3 + 2 |low| h) r / (1 - r) < 4 r (1 + |low| h).
ConvexRegion BlockingRegion::GetWorldPlanes() const
{
  if (!(this->Top > 0.0))
  {
    return { { 0.0, 0.0, 0.0, -1.0 } }; // no light, and nothing is inside
  }
  constexpr double Widening = 4.0 * Rounding;
  std::vector<glm::dvec4> planes{ { 0.0, 0.0, 1.0, 0.0 } }; // of (u, v, h, 1)
  for (int axis = 0; axis < 2; ++axis)
  {
    glm::dvec4 low(
      0.0, 0.0, -this->Low[axis] + Widening * std::abs(this->Low[axis]), -this->First[axis]);
    glm::dvec4 high(
      0.0, 0.0, this->High[axis] + Widening * std::abs(this->High[axis]), this->Last[axis]);
    low[axis] = 1.0;
    high[axis] = -1.0;
    planes.insert(planes.end(), { low, high });
  }
  if (std::isfinite(this->Top))
  {
    planes.push_back({ 0.0, 0.0, -1.0, this->Top * (1.0 + Widening) });
  }
  // A plane in the world is the sum of two, one of them at a right angle to the receiver. Let u =
  // 2^-53 and |n| be the sum of the sizes of its normal's coefficients: those of both are at most
  // 2.45 |n|. Each coefficient is good to 5 roundings of them, 12 u |n|, which queries allow for.
  // The distance from the origin takes 7 of these sizes times the corner's, and as many are in what
  // MayHold() computes: 34 u |n| |corner|, of which this is twice as much.
  constexpr double Roundings = 32.0 * std::numeric_limits<double>::epsilon();
  for (glm::dvec4& plane : planes)
  {
    plane.w += Widening;
    plane = this->FrameRows * plane;
    const glm::dvec3 normal = glm::abs(glm::dvec3(plane));
    plane.w += Roundings * this->CornerSize * (normal.x + normal.y + normal.z);
  }
  return planes;
}

bool BlockingRegion::IsFar(const glm::dvec3& p)
{
  return glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(FarAway)));
}

std::vector<glm::dvec3> BlockingRegion::Clip(
  const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const
{
  std::vector<glm::dvec3> polygon{ a, b, c };
  for (int plane = 0; plane < Planes; ++plane)
  {
    // Sutherland and Hodgman 1974.
    std::vector<glm::dvec3> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double atP = this->GetDepth(plane, p), atQ = this->GetDepth(plane, q);
      if (atP >= 0.0)
      {
        inside.push_back(p);
      }
      if ((atP > 0.0 && atQ < 0.0) || (atP < 0.0 && atQ > 0.0))
      {
        inside.push_back(p + atP / (atP - atQ) * (q - p));
      }
    }
    polygon = std::move(inside);
  }
  return polygon;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelogramFit.h"

#include "Coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace penumbra
{
namespace
{

/// A point in the plane, relative to the first one, with its place in the input.
struct PlanePoint
{
  glm::dvec2 P;
  std::size_t Index;
};

/// Lengths below this share of the points' extent are rounding of the input: float coordinates that
/// are some hundred times their extent away from the origin.
constexpr double FlatnessTolerance = 1e-5;

double Cross(const glm::dvec2& a, const glm::dvec2& b)
{
  return a.x * b.y - a.y * b.x;
}

/// An orthonormal basis of the plane, right-handed about `normal`.
void PlaneBasis(const glm::dvec3& normal, glm::dvec3& axisX, glm::dvec3& axisY)
{
  const glm::dvec3 a = glm::abs(normal);
  const glm::dvec3 other = a.x < a.y && a.x < a.z ? glm::dvec3(1.0, 0.0, 0.0)
    : a.y < a.z                                   ? glm::dvec3(0.0, 1.0, 0.0)
                                                  : glm::dvec3(0.0, 0.0, 1.0);
  axisX = glm::normalize(glm::cross(other, normal));
  axisY = glm::cross(normal, axisX);
}

/// Andrew's monotone chain: the convex hull, counter-clockwise.
std::vector<PlanePoint> ConvexHull(std::vector<PlanePoint> points)
{
  std::sort(points.begin(), points.end(),
    [](const PlanePoint& a, const PlanePoint& b) {
      return a.P.x != b.P.x ? a.P.x < b.P.x : a.P.y != b.P.y ? a.P.y < b.P.y : a.Index < b.Index;
    });
  const auto isSame = [](const PlanePoint& a, const PlanePoint& b) { return a.P == b.P; };
  points.erase(std::unique(points.begin(), points.end(), isSame), points.end());
  std::vector<PlanePoint> hull;
  const auto addChain = [&hull](auto begin, auto end)
  {
    const std::size_t start = hull.size();
    for (auto it = begin; it != end; ++it)
    {
      while (hull.size() >= start + 2 &&
        Cross(hull.back().P - hull[hull.size() - 2].P, it->P - hull.back().P) <= 0.0)
      {
        hull.pop_back();
      }
      hull.push_back(*it);
    }
    hull.pop_back(); // the next chain begins with it
  };
  addChain(points.begin(), points.end());
  addChain(points.rbegin(), points.rend());
  return hull;
}

/// How far b stands out from the line from a to c.
double Height(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
  const double chord = glm::length(c - a);
  const double height = chord > 0.0 ? std::abs(Cross(c - a, b - a)) / chord : 0.0;
  // What overflows is not flat.
  return std::isnan(height) ? std::numeric_limits<double>::infinity() : height;
}

/// Drops vertices that lie within `tolerance` of the line between their neighbours, flattest first.
/// Takes n log n steps.
void Simplify(std::vector<PlanePoint>& hull, double tolerance)
{
  struct Vertex
  {
    std::size_t Before, After;
    double Height;
  };
  const std::size_t count = hull.size();
  std::vector<Vertex> vertices(count);
  std::set<std::pair<double, std::size_t>> byHeight;
  const auto insert = [&](std::size_t i)
  {
    Vertex& v = vertices[i];
    v.Height = Height(hull[v.Before].P, hull[i].P, hull[v.After].P);
    byHeight.emplace(v.Height, i);
  };
  for (std::size_t i = 0; i < count; ++i)
  {
    vertices[i].Before = (i + count - 1) % count;
    vertices[i].After = (i + 1) % count;
    insert(i);
  }
  while (byHeight.size() > 3 && byHeight.begin()->first <= tolerance)
  {
    const auto [before, after, height] = vertices[byHeight.begin()->second];
    byHeight.erase(byHeight.begin());
    vertices[before].After = after;
    vertices[after].Before = before;
    for (const std::size_t neighbour : { before, after })
    {
      byHeight.erase({ vertices[neighbour].Height, neighbour });
      insert(neighbour);
    }
  }
  std::vector<std::size_t> kept;
  for (const auto& entry : byHeight)
  {
    kept.push_back(entry.second);
  }
  std::sort(kept.begin(), kept.end());
  std::vector<PlanePoint> simplified;
  for (const std::size_t i : kept)
  {
    simplified.push_back(hull[i]);
  }
  hull = std::move(simplified);
}

double HullArea(const std::vector<PlanePoint>& hull)
{
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i)
  {
    twice += Cross(hull[i].P - hull[0].P, hull[i + 1].P - hull[0].P);
  }
  return 0.5 * twice;
}

/// The smallest rectangle around the hull, one side along one of its edges, in plane coordinates.
struct Rectangle
{
  glm::dvec2 Corner, EdgeX, EdgeY;
};

Rectangle EnclosingRectangle(const std::vector<PlanePoint>& hull)
{
  Rectangle best{};
  double bestArea = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i)
  {
    const glm::dvec2 origin = hull[i].P;
    const glm::dvec2 along = glm::normalize(hull[(i + 1) % hull.size()].P - origin);
    const glm::dvec2 up(-along.y, along.x);
    double low = 0.0, high = 0.0, top = 0.0;
    for (const PlanePoint& p : hull)
    {
      low = std::min(low, glm::dot(p.P - origin, along));
      high = std::max(high, glm::dot(p.P - origin, along));
      top = std::max(top, glm::dot(p.P - origin, up));
    }
    if ((high - low) * top < bestArea)
    {
      bestArea = (high - low) * top;
      best = { origin + low * along, (high - low) * along, top * up };
    }
  }
  return best;
}

bool IsParallelogram(const std::vector<PlanePoint>& hull, double tolerance)
{
  return hull.size() == 4 &&
    glm::length((hull[1].P - hull[0].P) - (hull[2].P - hull[3].P)) <= tolerance;
}

} // namespace

std::optional<FittedParallelogram> FitParallelogram(
  const std::vector<glm::dvec3>& points, const glm::dvec3& normal, double rounding)
{
  if (points.size() < 3)
  {
    return std::nullopt;
  }
  glm::dvec3 axisX, axisY;
  PlaneBasis(normal, axisX, axisY);
  std::vector<PlanePoint> plane;
  double extent = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const glm::dvec3 d = points[i] - points[0];
    plane.push_back({ { glm::dot(d, axisX), glm::dot(d, axisY) }, i });
    extent = std::max(extent, glm::length(d));
    largest = std::max(largest, glm::length(points[i]));
  }
  if (!(extent > 0.0) || !(largest <= 2.0 * MaximumCoordinate))
  {
    return std::nullopt;
  }

  std::vector<PlanePoint> hull = ConvexHull(std::move(plane));
  // How far a parallelogram's corner stands out from the diagonal beside it, or more. A sliver's is
  // small: what is rounding is measured against it.
  const double thickness = HullArea(hull) / extent;
  const double flatness = FlatnessTolerance * std::min(extent, thickness);
  // Each of the three points that make a height is off by half the rounding, and so is each of the
  // four that make two edges differ. Half the thickness leaves the corners.
  const double known = std::min(rounding, 0.5 * thickness);
  const double tolerance = std::max(flatness, known);
  Simplify(hull, tolerance);
  // Points on a line span the area of their own rounding.
  if (hull.size() < 3 ||
    !(HullArea(hull) >
      std::max(SmallestArea, 4.0 * std::numeric_limits<double>::epsilon() * largest * extent)))
  {
    return std::nullopt;
  }
  std::rotate(hull.begin(),
    std::min_element(hull.begin(), hull.end(),
      [](const PlanePoint& a, const PlanePoint& b) { return a.Index < b.Index; }),
    hull.end());

  if (hull.size() == 3 || IsParallelogram(hull, std::max(flatness, 2.0 * known)))
  {
    // From the input's own points: what was exact stays exact.
    const glm::dvec3& corner = points[hull.front().Index];
    return FittedParallelogram{ { corner, points[hull[1].Index] - corner,
                                  points[hull.back().Index] - corner },
      hull.size() == 3 };
  }
  const Rectangle fit = EnclosingRectangle(hull);
  const auto toWorld = [&](const glm::dvec2& p) { return p.x * axisX + p.y * axisY; };
  return FittedParallelogram{ { points[0] + toWorld(fit.Corner), toWorld(fit.EdgeX),
    toWorld(fit.EdgeY) } };
}

} // namespace penumbra

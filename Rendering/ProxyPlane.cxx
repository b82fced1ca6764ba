// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProxyPlane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra
{
namespace
{

/// Differences below this share are rounding: which of two planes fits better, and which side of a
/// closed surface has more area.
constexpr double Distinctness = 1e-6;

/// Calls visit(a, b, c, area) for the triangles of each polygon's fan, of points relative to
/// `origin`. The area is negative where a fan folds back in the notch of a polygon that is not
/// convex; along the polygon's normal it adds up to the polygon's own.
template <typename Visitor>
void VisitTriangles(const PolygonMesh& mesh, const glm::dvec3& origin, Visitor&& visit)
{
  for (const std::vector<int>& polygon : mesh.Polygons)
  {
    const auto point = [&](std::size_t i)
    { return mesh.Points[static_cast<std::size_t>(polygon[i])] - origin; };
    const auto areaVector = [&](std::size_t i)
    { return 0.5 * glm::cross(point(i) - point(0), point(i + 1) - point(0)); };
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    {
      sum += areaVector(i);
    }
    const double length = glm::length(sum);
    for (std::size_t i = 1; length > 0.0 && i + 1 < polygon.size(); ++i)
    {
      visit(point(0), point(i), point(i + 1), areaVector(i), glm::dot(areaVector(i), sum) / length);
    }
  }
}

/// What a surface's area says of its place.
struct Moments
{
  double Area = 0.0;
  glm::dvec3 Front{ 0.0 }; ///< the sum of its area vectors
  glm::dvec3 Centroid{ 0.0 };
  glm::dmat3 Spread{ 0.0 }; ///< the integral of x x^T, x being relative to the centroid
};

Moments IntegrateArea(const PolygonMesh& mesh)
{
  Moments moments;
  const glm::dvec3 start = mesh.Points.empty() ? glm::dvec3(0.0) : mesh.Points.front();
  glm::dvec3 first(0.0);
  VisitTriangles(mesh, start,
    [&](const auto& a, const auto& b, const auto& c, const glm::dvec3& areaVector, double area)
    {
      moments.Area += area;
      moments.Front += areaVector;
      first += area / 3.0 * (a + b + c);
    });
  if (!(moments.Area > 0.0))
  {
    return moments;
  }
  moments.Centroid = start + first / moments.Area;
  VisitTriangles(mesh, moments.Centroid,
    [&](const auto& a, const auto& b, const auto& c, const glm::dvec3&, double area)
    {
      const glm::dvec3 sum = a + b + c;
      moments.Spread += area / 12.0 *
        (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
          glm::outerProduct(sum, sum));
    });
  return moments;
}

/// A unit eigenvector of a symmetric matrix and its eigenvalue.
struct Axis
{
  double Value;
  glm::dvec3 Direction;
};

/// Jacobi 1846: the principal axes of a symmetric matrix, by growing eigenvalue.
std::array<Axis, 3> FindAxes(glm::dmat3 matrix)
{
  constexpr int Sweeps = 12; // each squares what is left beside the diagonal; six are enough
  constexpr std::array<std::array<int, 2>, 3> Pairs{ { { 0, 1 }, { 0, 2 }, { 1, 2 } } };
  glm::dmat3 axes(1.0);
  for (int sweep = 0; sweep < Sweeps; ++sweep)
  {
    for (const auto& [p, q] : Pairs)
    {
      if (matrix[p][q] == 0.0)
      {
        continue;
      }
      const double cotangent = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
      const double tangent =
        std::copysign(1.0, cotangent) / (std::abs(cotangent) + std::hypot(cotangent, 1.0));
      const double cosine = 1.0 / std::hypot(tangent, 1.0);
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = cosine;
      turn[q][p] = tangent * cosine;
      turn[p][q] = -tangent * cosine;
      matrix = glm::transpose(turn) * matrix * turn;
      axes = axes * turn;
    }
  }
  std::array<Axis, 3> result{ { { matrix[0][0], axes[0] }, { matrix[1][1], axes[1] },
    { matrix[2][2], axes[2] } } };
  std::sort(
    result.begin(), result.end(), [](const Axis& a, const Axis& b) { return a.Value < b.Value; });
  return result;
}

/// The normal to the side where more of the area points; if there is no such side, to that of its
/// largest component.
glm::dvec3 TowardsFront(const glm::dvec3& normal, const Moments& moments)
{
  const glm::dvec3 size = glm::abs(normal);
  const int largest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double front = glm::dot(moments.Front, normal);
  const double sign = std::abs(front) > Distinctness * moments.Area ? front : normal[largest];
  return sign < 0.0 ? -normal : normal;
}

double FindExtent(const PolygonMesh& mesh, const glm::dvec3& origin)
{
  double extent = 0.0;
  for (const std::vector<int>& polygon : mesh.Polygons)
  {
    for (const int point : polygon)
    {
      extent = std::max(extent, glm::length(mesh.Points[static_cast<std::size_t>(point)] - origin));
    }
  }
  return extent;
}

} // namespace

ProxyPlane FindProxyPlane(const PolygonMesh& mesh, const ReceiverSettings& settings)
{
  ProxyPlane plane;
  const Moments moments = IntegrateArea(mesh);
  if (!(moments.Area > 0.0))
  {
    plane.Problem = NoAreaProblem;
    return plane;
  }
  plane.Origin = moments.Centroid;
  if (settings.ProxyMode == ProxyPlaneMode::Given)
  {
    plane.Normal = glm::normalize(settings.ProxyNormal);
    plane.Origin += glm::dot(settings.ProxyOrigin - moments.Centroid, plane.Normal) * plane.Normal;
  }
  else
  {
    const std::array<Axis, 3> axes = FindAxes(moments.Spread);
    if (!(axes[1].Value - axes[0].Value > Distinctness * axes[2].Value))
    {
      plane.Problem = "no plane fits it better than all others; allowed: a surface that is flatter "
                      "in one direction than in the others, or a given proxy plane";
    }
    plane.Normal = TowardsFront(glm::normalize(axes[0].Direction), moments);
  }
  plane.Extent = FindExtent(mesh, plane.Origin);
  return plane;
}

bool NeedsProxyPlane(
  const PolygonMesh& mesh, const PlanarRegions& found, const ReceiverSettings& settings)
{
  if (!settings.ProxyPlane || found.Problem == NotFiniteProblem)
  {
    return false;
  }
  if (!found.Problem.empty() || !found.Refused.empty())
  {
    return true;
  }
  // Regions that lie in one plane are receivers as good as any.
  const Parallelogram& base = found.Regions.front().Base;
  const glm::dvec3 normal = glm::normalize(glm::cross(base.EdgeX, base.EdgeY));
  double extent = 0.0, stray = 0.0;
  for (const PlanarRegion& region : found.Regions)
  {
    for (const int polygon : region.Polygons)
    {
      for (const int point : mesh.Polygons[static_cast<std::size_t>(polygon)])
      {
        const glm::dvec3 d = mesh.Points[static_cast<std::size_t>(point)] - base.Corner;
        extent = std::max(extent, glm::length(d));
        stray = std::max(stray, std::abs(glm::dot(d, normal)));
      }
    }
  }
  // As far from each other as two points may be that stray to opposite sides.
  return found.Regions.size() > 1 && stray > 2.0 * (ExactPlanarity * extent + 2.0 * mesh.Rounding);
}

} // namespace penumbra

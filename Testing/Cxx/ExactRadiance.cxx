// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ExactRadiance.h"

#include "ExactVisibility.h"

#include <cmath>
#include <cstddef>

namespace oracle
{

namespace
{

// The part of the light above the horizon; none if x is in or on the wrong side of its plane.
Polygon RisenLight(const Vec3& x, const Vec3& n, const Light& light)
{
  Polygon polygon;
  for (const Vec3& vertex : light.Vertices)
  {
    polygon.push_back(vertex - x);
  }
  const long double side = polygon.empty() ? 0 : -Dot(AreaNormal(polygon), polygon[0]);
  if (side == 0 || (side < 0 && !light.TwoSided))
  {
    return {};
  }
  return AboveHorizon(polygon, n);
}

} // namespace

long double Length(const Vec3& a)
{
  return std::sqrt(Dot(a, a));
}

Polygon Parallelogram(const Vec3& origin, const Vec3& point1, const Vec3& point2)
{
  return { origin, point1, point1 + point2 - origin, point2 };
}

long double FormFactor(const Vec3& x, const Vec3& n, const Light& light)
{
  return VisibleFormFactor(x, n, light, {});
}

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Light& light, const std::vector<Triangle>& occluders)
{
  const Vec3 unitNormal = (1 / Length(n)) * n;
  const Polygon risen = RisenLight(x, unitNormal, light);
  if (risen.empty())
  {
    return 0;
  }
  const long double sum = SumOverVisible(x, risen, Reach::ToPolygon, occluders,
    [&](const Polygon& piece) { return EdgeSum(piece, unitNormal); });
  const long double pi = std::acos(-1.0L);
  return std::abs(sum) / (2 * pi);
}

std::array<double, 3> Radiance(const Vec3& x, const Vec3& n, const std::vector<Light>& lights,
  const std::vector<Triangle>& occluders, const std::array<double, 3>& reflectance,
  const std::array<double, 3>& ambient)
{
  std::array<long double, 3> arriving = { ambient[0], ambient[1], ambient[2] };
  for (const Light& light : lights)
  {
    const long double formFactor = VisibleFormFactor(x, n, light, occluders);
    for (std::size_t i = 0; i < 3; ++i)
    {
      arriving[i] += light.Radiance[i] * formFactor;
    }
  }
  std::array<double, 3> reflected;
  for (std::size_t i = 0; i < 3; ++i)
  {
    reflected[i] = static_cast<double>(reflectance[i] * arriving[i]);
  }
  return reflected;
}

} // namespace oracle

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ExactRadiance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace oracle
{

namespace
{

// A dot product of three terms is off by at most about 3 units of rounding; twice that and some.
constexpr long double ArithmeticSlack = 8 * std::numeric_limits<long double>::epsilon();

// A point that a caller computed in double to lie on a plane may miss it by a few roundings.
constexpr long double InputSlack = 16 * std::numeric_limits<double>::epsilon();

// Boxes only save time; this much wider than the light's reach, rounding cannot make one miss.
constexpr long double BoxMargin = 1e-6L;

// Everything below is seen from x: points are given relative to it.

struct HalfSpace
{
  Vec3 Normal;
  long double Offset;
  // Heights up to this much from 0 are rounding: the point is taken to lie on the plane.
  long double Slack;

  long double Height(const Vec3& v) const { return Dot(this->Normal, v) - this->Offset; }
};

// The points that a triangle hides from x: inside its three side planes and beyond its own plane.
// The latter comes last, so that it only judges points that the triangle covers: the plane of a
// small triangle is too uncertain elsewhere.
using ShadowVolume = std::array<HalfSpace, 4>;

struct Box
{
  Vec3 Low, High;
};

// A shadow volume and a box around the part of the light's plane that it hides.
struct Shadow
{
  ShadowVolume Volume;
  Box Bounds;
};

// The largest coordinate: a bound on rounding that needs no square root.
long double Size(const Vec3& v)
{
  return std::max({ std::abs(v.X), std::abs(v.Y), std::abs(v.Z) });
}

long double Size(const Polygon& polygon)
{
  long double size = 0;
  for (const Vec3& v : polygon)
  {
    size = std::max(size, Size(v));
  }
  return size;
}

bool HasInside(const Polygon& polygon, const HalfSpace& space)
{
  return std::any_of(
    polygon.begin(), polygon.end(), [&](const Vec3& v) { return space.Height(v) > space.Slack; });
}

bool HasOutside(const Polygon& polygon, const HalfSpace& space)
{
  return std::any_of(
    polygon.begin(), polygon.end(), [&](const Vec3& v) { return space.Height(v) < -space.Slack; });
}

bool Meets(const Polygon& polygon, const ShadowVolume& shadow)
{
  return std::all_of(shadow.begin(), shadow.end(),
    [&](const HalfSpace& space) { return HasInside(polygon, space); });
}

template <typename Points>
Box BoundsOf(const Points& points)
{
  Box box = { points[0], points[0] };
  for (const Vec3& v : points)
  {
    box.Low = { std::min(box.Low.X, v.X), std::min(box.Low.Y, v.Y), std::min(box.Low.Z, v.Z) };
    box.High = { std::max(box.High.X, v.X), std::max(box.High.Y, v.Y), std::max(box.High.Z, v.Z) };
  }
  return box;
}

// A box around a triangle as seen from x on the plane toPlane.v = 1: everything if it reaches so
// far to the side that its image does not end.
Box ImageBounds(const Vec3& x, const Triangle& triangle, const Vec3& toPlane, long double margin)
{
  std::array<Vec3, 3> corners = { triangle.A - x, triangle.B - x, triangle.C - x };
  for (Vec3& v : corners)
  {
    const long double depth = Dot(toPlane, v);
    if (!(depth > 0))
    {
      constexpr long double infinity = std::numeric_limits<long double>::infinity();
      return { { -infinity, -infinity, -infinity }, { infinity, infinity, infinity } };
    }
    v = (1 / depth) * v;
  }
  const Box image = BoundsOf(corners);
  const Vec3 margins = { margin, margin, margin };
  return { image.Low - margins, image.High + margins };
}

bool Overlap(const Box& a, const Box& b)
{
  return a.Low.X <= b.High.X && b.Low.X <= a.High.X && a.Low.Y <= b.High.Y && b.Low.Y <= a.High.Y &&
    a.Low.Z <= b.High.Z && b.Low.Z <= a.High.Z;
}

// The parts of a convex polygon inside and outside a half-space (Sutherland and Hodgman 1974). A
// part that is thinner than rounding is left out, and the other is then the whole polygon.
std::pair<Polygon, Polygon> Split(const Polygon& polygon, const HalfSpace& space)
{
  if (!HasInside(polygon, space))
  {
    return { {}, polygon };
  }
  if (!HasOutside(polygon, space))
  {
    return { polygon, {} };
  }
  Polygon inside, outside;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const long double hp = space.Height(p);
    const long double hq = space.Height(q);
    if (hp >= 0)
    {
      inside.push_back(p);
    }
    if (hp <= 0)
    {
      outside.push_back(p);
    }
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0))
    {
      const Vec3 cut = p + (hp / (hp - hq)) * (q - p);
      inside.push_back(cut);
      outside.push_back(cut);
    }
  }
  return { std::move(inside), std::move(outside) };
}

// The shadow that a triangle casts on points up to `reach` from x; nothing if x lies in its plane.
// In the base a, b, c of its corners a point w has the coordinates (b x c, c x a, a x b).w / det:
// it is in the cone if all are positive, and beyond the triangle if their sum is above 1.
std::optional<ShadowVolume> CastShadow(const Vec3& x, const Triangle& triangle, long double reach)
{
  const Vec3 a = triangle.A - x;
  Vec3 b = triangle.B - x;
  Vec3 c = triangle.C - x;
  const Vec3 normal = Cross(b - a, c - a);
  const long double scale = Size(x) + std::max({ reach, Size(a), Size(b), Size(c) });
  const long double slack = InputSlack * Size(normal) * scale;
  const long double det = Dot(a, normal);
  if (std::abs(det) <= slack)
  {
    return std::nullopt;
  }
  if (det < 0)
  {
    std::swap(b, c);
  }
  const auto side = [reach](const Vec3& p, const Vec3& q)
  {
    const Vec3 sideNormal = Cross(p, q);
    return HalfSpace{ sideNormal, 0, ArithmeticSlack * Size(sideNormal) * reach };
  };
  const HalfSpace beyond = { det < 0 ? -1 * normal : normal, std::abs(det), slack };
  return ShadowVolume{ side(a, b), side(b, c), side(c, a), beyond };
}

// What a shadow leaves of a convex piece, as up to four convex pieces.
std::vector<Polygon> Subtract(const Polygon& piece, const ShadowVolume& shadow)
{
  std::vector<Polygon> lit;
  Polygon rest = piece;
  for (const HalfSpace& space : shadow)
  {
    auto [inside, outside] = Split(rest, space);
    if (inside.empty())
    {
      return { piece };
    }
    if (!outside.empty())
    {
      lit.push_back(std::move(outside));
    }
    rest = std::move(inside);
  }
  return lit;
}

// The sum over a fan of triangles: the unit normal times twice the area.
Vec3 AreaNormal(const Polygon& polygon)
{
  Vec3 normal = { 0, 0, 0 };
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    normal = normal + Cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return normal;
}

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
  return Split(polygon, { n, 0, ArithmeticSlack * Size(n) * Size(polygon) }).first;
}

// Lambert's edge formula (Photometria, 1760): the projected solid angle of a polygon above the
// horizon, twice and signed: the sum over its edges of angle * n.unit(v_i x v_i+1), for a unit n.
long double EdgeSum(const Polygon& polygon, const Vec3& n)
{
  long double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const Vec3 cross = Cross(p, q - p);
    const long double length = Length(cross);
    if (length > 0)
    {
      sum += std::atan2(length, Dot(p, q)) * Dot(n, cross) / length;
    }
  }
  return sum;
}

// The shadows that may hide some of a polygon of the light, the smallest first.
std::vector<Shadow> CastShadows(
  const Vec3& x, const Polygon& polygon, const std::vector<Triangle>& occluders)
{
  const Vec3 normal = AreaNormal(polygon);
  const Vec3 toPlane = (1 / Dot(normal, polygon[0])) * normal;
  const Box bounds = BoundsOf(polygon);
  const long double reach = Size(polygon);
  std::vector<Shadow> shadows;
  for (const Triangle& occluder : occluders)
  {
    const Box image = ImageBounds(x, occluder, toPlane, BoxMargin * reach);
    if (!Overlap(bounds, image))
    {
      continue;
    }
    const std::optional<ShadowVolume> volume = CastShadow(x, occluder, reach);
    if (volume && Meets(polygon, *volume))
    {
      shadows.push_back({ *volume, image });
    }
  }
  std::sort(shadows.begin(), shadows.end(),
    [](const Shadow& a, const Shadow& b)
    { return Size(a.Bounds.High - a.Bounds.Low) < Size(b.Bounds.High - b.Bounds.Low); });
  return shadows;
}

// The edge sum over what the shadows leave of a convex piece. The largest one cuts the piece, then
// each part goes on with those that still meet it, so that distant cuts do not multiply.
long double LitSum(const Polygon& piece, const Vec3& n, const std::vector<const Shadow*>& shadows)
{
  const Box bounds = BoundsOf(piece);
  std::vector<const Shadow*> meeting;
  std::copy_if(shadows.begin(), shadows.end(), std::back_inserter(meeting),
    [&](const Shadow* s) { return Overlap(bounds, s->Bounds) && Meets(piece, s->Volume); });
  if (meeting.empty())
  {
    return EdgeSum(piece, n);
  }
  const Shadow& largest = *meeting.back();
  meeting.pop_back();
  long double sum = 0;
  for (const Polygon& part : Subtract(piece, largest.Volume))
  {
    sum += LitSum(part, n, meeting);
  }
  return sum;
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
  const std::vector<Shadow> shadows = CastShadows(x, risen, occluders);
  std::vector<const Shadow*> all(shadows.size());
  std::transform(shadows.begin(), shadows.end(), all.begin(), [](const Shadow& s) { return &s; });
  const long double pi = std::acos(-1.0L);
  return std::abs(LitSum(risen, unitNormal, all)) / (2 * pi);
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

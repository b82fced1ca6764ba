// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ExactVisibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

namespace oracle
{

namespace
{

// Boxes only save time; this much wider than the light's reach, rounding cannot make one miss.
constexpr long double BoxMargin = 1e-6L;

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

// The shadows that may hide some of a polygon of the light, the smallest first.
std::vector<Shadow> CastShadows(
  const Vec3& x, const Polygon& polygon, Reach reach, const std::vector<Triangle>& occluders)
{
  const Vec3 normal = AreaNormal(polygon);
  const Vec3 toPlane = (1 / Dot(normal, polygon[0])) * normal;
  const Box bounds = BoundsOf(polygon);
  const long double size = Size(polygon);
  std::vector<Shadow> shadows;
  for (const Triangle& occluder : occluders)
  {
    const Box image = ImageBounds(x, occluder, toPlane, BoxMargin * size);
    if (!Overlap(bounds, image))
    {
      continue;
    }
    const std::optional<ShadowVolume> volume = CastShadow(x, occluder, reach, size);
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

// The integral over what the shadows leave of a convex piece. The largest one cuts the piece, then
// each part goes on with those that still meet it, so that distant cuts do not multiply.
long double LitSum(const Polygon& piece, const std::vector<const Shadow*>& shadows,
  const std::function<long double(const Polygon&)>& integral)
{
  const Box bounds = BoundsOf(piece);
  std::vector<const Shadow*> meeting;
  std::copy_if(shadows.begin(), shadows.end(), std::back_inserter(meeting),
    [&](const Shadow* s) { return Overlap(bounds, s->Bounds) && Meets(piece, s->Volume); });
  if (meeting.empty())
  {
    return integral(piece);
  }
  const Shadow& largest = *meeting.back();
  meeting.pop_back();
  long double sum = 0;
  for (const Polygon& part : Subtract(piece, largest.Volume))
  {
    sum += LitSum(part, meeting, integral);
  }
  return sum;
}

} // namespace

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

Vec3 AreaNormal(const Polygon& polygon)
{
  Vec3 normal = { 0, 0, 0 };
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    normal = normal + Cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return normal;
}

Polygon AboveHorizon(const Polygon& polygon, const Vec3& n)
{
  return Split(polygon, { n, 0, ArithmeticSlack * Size(n) * Size(polygon) }).first;
}

long double EdgeTerm(const Vec3& p, const Vec3& q, const Vec3& n)
{
  const Vec3 cross = Cross(p, q - p);
  const long double length = Length(cross);
  return length > 0 ? std::atan2(length, Dot(p, q)) * Dot(n, cross) / length : 0;
}

long double EdgeSum(const Polygon& polygon, const Vec3& n)
{
  long double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    sum += EdgeTerm(polygon[i], polygon[(i + 1) % polygon.size()], n);
  }
  return sum;
}

// In the base a, b, c of its corners a point w has the coordinates (b x c, c x a, a x b).w / det:
// it is in the cone if all are positive, and beyond the triangle if their sum is above 1.
std::optional<ShadowVolume> CastShadow(
  const Vec3& x, const Triangle& triangle, Reach reach, long double size)
{
  const Vec3 a = triangle.A - x;
  Vec3 b = triangle.B - x;
  Vec3 c = triangle.C - x;
  const Vec3 normal = Cross(b - a, c - a);
  const long double scale = Size(x) + std::max({ size, Size(a), Size(b), Size(c) });
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
  const auto side = [size](const Vec3& p, const Vec3& q)
  {
    const Vec3 sideNormal = Cross(p, q);
    return HalfSpace{ sideNormal, 0, ArithmeticSlack * Size(sideNormal) * size };
  };
  // Directions end beyond any triangle: their half-space is everything.
  const HalfSpace beyond = reach == Reach::ToInfinity
    ? HalfSpace{ { 0, 0, 0 }, -1, 0 }
    : HalfSpace{ det < 0 ? -1 * normal : normal, std::abs(det), slack };
  return ShadowVolume{ side(a, b), side(b, c), side(c, a), beyond };
}

bool Hides(const ShadowVolume& shadow, const Vec3& point)
{
  const auto isInside = [&](const HalfSpace& side) { return side.Height(point) >= -side.Slack; };
  const HalfSpace& beyond = shadow.back();
  return std::all_of(shadow.begin(), shadow.end() - 1, isInside) &&
    beyond.Height(point) > beyond.Slack;
}

long double SumOverVisible(const Vec3& x, const Polygon& polygon, Reach reach,
  const std::vector<Triangle>& occluders,
  const std::function<long double(const Polygon&)>& integral)
{
  const std::vector<Shadow> shadows = CastShadows(x, polygon, reach, occluders);
  std::vector<const Shadow*> all(shadows.size());
  std::transform(shadows.begin(), shadows.end(), all.begin(), [](const Shadow& s) { return &s; });
  return LitSum(polygon, all, integral);
}

} // namespace oracle

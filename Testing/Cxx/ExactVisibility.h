// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExactVisibility.h
 * @brief What triangles hide from a point, as half-spaces: the inside of the test oracle.
 *
 * Points of lights are given relative to the point x that looks at them, occluders are not.
 */

#ifndef ExactVisibility_h
#define ExactVisibility_h

#include "ExactRadiance.h"

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace oracle
{

/** A dot product of three terms is off by at most about 3 units of rounding; twice that and some.
 */
constexpr long double ArithmeticSlack = 8 * std::numeric_limits<long double>::epsilon();

/** A point that a caller computed in double to lie on a plane may miss it by a few roundings. */
constexpr long double InputSlack = 16 * std::numeric_limits<double>::epsilon();

struct HalfSpace
{
  Vec3 Normal;
  long double Offset;
  /** Heights up to this much from 0 are rounding: the point is taken to lie on the plane. */
  long double Slack;

  long double Height(const Vec3& v) const { return Dot(this->Normal, v) - this->Offset; }
};

/**
 * The points that a triangle hides from x: inside its three side planes and beyond its own plane.
 * The latter comes last, so that it only judges points that the triangle covers: the plane of a
 * small triangle is too uncertain elsewhere.
 */
using ShadowVolume = std::array<HalfSpace, 4>;

/** What a polygon as seen from x stands for: its own points, or directions to infinity. */
enum class Reach
{
  ToPolygon,
  ToInfinity
};

/** The largest coordinate: a bound on rounding that needs no square root. */
long double Size(const Vec3& v);
long double Size(const Polygon& polygon);

/** The sum over a fan of triangles: the unit normal times twice the area. */
Vec3 AreaNormal(const Polygon& polygon);

/** The part of a convex polygon above the plane through x with the given unit normal. */
Polygon AboveHorizon(const Polygon& polygon, const Vec3& n);

/**
 * Lambert's edge formula (Photometria, 1760): the projected solid angle of a polygon above the
 * horizon, twice and signed: the sum over its edges of angle * n.unit(v_i x v_i+1), for a unit n.
 */
long double EdgeSum(const Polygon& polygon, const Vec3& n);
/** One term of the edge formula: the edge from @a p to @a q. */
long double EdgeTerm(const Vec3& p, const Vec3& q, const Vec3& n);

/**
 * The shadow that a triangle casts on points up to @a size from @a x, or on all directions; nothing
 * if @a x lies in its plane.
 */
std::optional<ShadowVolume> CastShadow(
  const Vec3& x, const Triangle& triangle, Reach reach, long double size);

/** Whether a shadow hides one point; its outline does too, so that meshes have no cracks. */
bool Hides(const ShadowVolume& shadow, const Vec3& point);

/** The sum of an @a integral over convex pieces of a polygon that tile what @a x sees of it. */
long double SumOverVisible(const Vec3& x, const Polygon& polygon, Reach reach,
  const std::vector<Triangle>& occluders,
  const std::function<long double(const Polygon&)>& integral);

} // namespace oracle

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExactRadiance.h
 * @brief The exact radiance of a diffuse point under polygonal lights and triangular occluders.
 *
 * A test oracle. It shares no code with the product: it has its own vectors, works in long double,
 * and finds by clipping which part of each light a point sees, where the product samples. The part
 * that is left is a set of convex polygons, whose form factor Lambert's edge formula gives exactly.
 * What remains is rounding: some 1e-18 where long double has 80 bits.
 *
 * ExactLights.h has lights of other shapes.
 *
 * All points and vectors are in world coordinates, in any one unit of length.
 */

#ifndef ExactRadiance_h
#define ExactRadiance_h

#include <array>
#include <vector>

namespace oracle
{

struct Vec3
{
  long double X, Y, Z;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
  return { a.X + b.X, a.Y + b.Y, a.Z + b.Z };
}

inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
  return { a.X - b.X, a.Y - b.Y, a.Z - b.Z };
}

inline Vec3 operator*(long double s, const Vec3& a)
{
  return { s * a.X, s * a.Y, s * a.Z };
}

inline long double Dot(const Vec3& a, const Vec3& b)
{
  return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
}

inline Vec3 Cross(const Vec3& a, const Vec3& b)
{
  return { a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X };
}

long double Length(const Vec3& a);

/** The corners of a polygon in order; nothing repeats the first at the end. */
using Polygon = std::vector<Vec3>;

/** An occluder. Either winding blocks alike; one without an area blocks nothing. */
struct Triangle
{
  Vec3 A, B, C;
};

/**
 * A light of even radiance: a convex, planar polygon that emits towards the right-hand normal of
 * its vertex order, or to both sides. Lights do not block each other.
 */
struct Light
{
  Polygon Vertices;
  bool TwoSided = false;
  /** r, g, b in W sr^-1 m^-2. */
  std::array<double, 3> Radiance = { 1.0, 1.0, 1.0 };
};

/** Origin, point1, point1 + point2 - origin, point2: it faces (point1-origin) x (point2-origin). */
Polygon Parallelogram(const Vec3& origin, const Vec3& point1, const Vec3& point2);

/**
 * The form factor F = integral of cos t cos t' / (pi r^2) dA' from the point @a x with normal @a n
 * (of any length but 0) to the whole of @a light, in [0, 1]. Both cosines are clamped at 0. It is 0
 * for @a x in the light's plane, or behind that plane if the light is one-sided.
 */
long double FormFactor(const Vec3& x, const Vec3& n, const Light& light);

/**
 * The same integral over the part of @a light that @a x sees past @a occluders. Triangles block
 * only what lies strictly between: a triangle that holds @a x in its plane, or the light (both up
 * to a few roundings of a double, since that is what scenes are given in), blocks nothing.
 */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Light& light, const std::vector<Triangle>& occluders);

/**
 * The radiance L = rho (La + sum over lights of Le F) that a diffuse receiver of the given
 * @a reflectance (rho) reflects at @a x under the given @a ambient radiance (La). H&H 1997, eq. 1.
 */
std::array<double, 3> Radiance(const Vec3& x, const Vec3& n, const std::vector<Light>& lights,
  const std::vector<Triangle>& occluders, const std::array<double, 3>& reflectance,
  const std::array<double, 3>& ambient);

} // namespace oracle

#endif

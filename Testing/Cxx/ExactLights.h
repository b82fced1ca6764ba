// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExactLights.h
 * @brief The exact radiance of a diffuse point under lights of every kind and triangular occluders.
 *
 * The test oracle beyond polygons (ExactRadiance.h). Nothing here is sampled or iterated, but for
 * the arcs of ellipses:
 * - A disk and a sun are what is left of a square after clipping, cut to their circle. Its arcs
 *   stay arcs: the contour integral of Lambert's formula has an antiderivative along a circle.
 * - An ellipse is what is left of a parallelogram, likewise; along its arcs the contour integral is
 *   taken by Gauss and Legendre's rule, on halves of halves until these agree to rounding.
 * - A segment is a set of intervals, each with the closed form of its irradiance.
 * - A point and a sun of no size are one ray.
 *
 * What remains is rounding, some 1e-18 for lights as large as they are far. A light d across at
 * distance r sums terms of size d / r to a form factor of size (d / r)^2: it loses r / d of that.
 *
 * Each VisibleFormFactor returns the F of L = rho (La + Le F), with Le the light's radiance,
 * intensity or irradiance, for a point @a x with normal @a n of any length but 0. Occluders block
 * what lies strictly between, as in ExactRadiance.h.
 */

#ifndef ExactLights_h
#define ExactLights_h

#include "ExactRadiance.h"

#include <array>
#include <variant>
#include <vector>

namespace oracle
{

/** A diffuse disk that emits towards its normal (of any length but 0), or to both sides. */
struct Disk
{
  Vec3 Centre;
  long double Radius;
  Vec3 Normal;
  bool TwoSided = false;
  /** r, g, b in W sr^-1 m^-2. */
  std::array<double, 3> Radiance = { 1.0, 1.0, 1.0 };
};

/** A diffuse ellipse that emits towards A x B, or to both sides. */
struct Ellipse
{
  Vec3 Centre;
  /** Conjugate radii: the outline is Centre + cos t A + sin t B. */
  Vec3 A, B;
  bool TwoSided = false;
  /** r, g, b in W sr^-1 m^-2. */
  std::array<double, 3> Radiance = { 1.0, 1.0, 1.0 };
};

/** A line light: the limit of a thin diffuse cylinder (Nishita et al. 1985). */
struct Segment
{
  Vec3 A, B;
  /** r, g, b in W sr^-1 m^-1, at right angles to the segment. */
  std::array<double, 3> Radiance = { 1.0, 1.0, 1.0 };
};

/** A point that shines alike in all directions. */
struct Point
{
  Vec3 Position;
  /** r, g, b in W sr^-1. */
  std::array<double, 3> Intensity = { 1.0, 1.0, 1.0 };
};

/** A sun: a disc of even radiance at infinity, or a point there. */
struct Directional
{
  /** The way its light travels, of any length but 0. */
  Vec3 Direction;
  /** In degrees, from 0 up to but not including 180. */
  double AngularDiameter = 0.0;
  /** r, g, b in W m^-2, at normal incidence. */
  std::array<double, 3> Irradiance = { 1.0, 1.0, 1.0 };
};

/** Polygons that shine together, each with a radiance of its own. */
struct Surface
{
  std::vector<Light> Polygons;
};

using AnyLight = std::variant<Light, Disk, Segment, Point, Directional, Surface, Ellipse>;

/** The integral of cos t cos t' / (pi r^2) dA' over what is seen of the disk. */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Disk& light, const std::vector<Triangle>& occluders);

/** The same of an ellipse. */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Ellipse& light, const std::vector<Triangle>& occluders);

/**
 * 1 / pi times the integral of cos t sin u / r^2 dl over what is seen of the segment, u the angle
 * between the segment and the way to @a x. In m^-1.
 */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Segment& light, const std::vector<Triangle>& occluders);

/** cos t / (pi r^2) if the point is seen, or 0. In m^-2. */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Point& light, const std::vector<Triangle>& occluders);

/**
 * The irradiance by what is seen of the sun over pi times the irradiance at normal incidence. A sun
 * with angular diameter d and radiance L gives pi L sin^2(d / 2) at normal incidence.
 */
long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Directional& light, const std::vector<Triangle>& occluders);

/** The sum of Le F over the parts of a light: what it adds to La. */
std::array<long double, 3> ArrivingRadiance(
  const Vec3& x, const Vec3& n, const AnyLight& light, const std::vector<Triangle>& occluders);

/** Everything that a receiver sees and is. */
struct Scene
{
  std::vector<AnyLight> Lights;
  std::vector<Triangle> Occluders;
  std::array<double, 3> Reflectance = { 1.0, 1.0, 1.0 };
  /** r, g, b in W sr^-1 m^-2. */
  std::array<double, 3> Ambient = { 0.0, 0.0, 0.0 };
};

/** L = rho (La + sum over lights of Le F) at @a x. H&H 1997, eq. 1. */
std::array<double, 3> Radiance(const Vec3& x, const Vec3& n, const Scene& scene);

} // namespace oracle

#endif

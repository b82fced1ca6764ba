// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Area lights in the shape of convex polygons.
 */
#ifndef PolygonLight_h
#define PolygonLight_h

#include "LightShape.h"

namespace penumbra
{

/**
 * A planar convex polygon that emits diffusely, towards the side from which its vertices are seen
 * counter-clockwise, or to both sides. Parallelograms and triangles have maps of their own from the
 * unit square; what is left of them when a plane cuts them, and any other polygon, is sampled as a
 * fan of triangles. Radiance is in W sr^-1 m^-2.
 */
class PENUMBRARENDERING_EXPORT PolygonLight : public LightOfKind<PolygonLight>
{
public:
  /// Emits towards (point1 - origin) x (point2 - origin).
  static PolygonLight Parallelogram(
    const glm::dvec3& origin, const glm::dvec3& point1, const glm::dvec3& point2);
  /// Emits towards (point1 - origin) x (point2 - origin).
  static PolygonLight Triangle(
    const glm::dvec3& origin, const glm::dvec3& point1, const glm::dvec3& point2);

  /// Any convex polygon; emits to the side from which its vertices are seen counter-clockwise.
  static PolygonLight Convex(std::vector<glm::dvec3> vertices);

  /// The vertices, counter-clockwise seen from the front; fewer than three where nothing is left.
  const std::vector<glm::dvec3>& GetVertices() const { return this->Vertices; }
  /// Unit normal of the front.
  const glm::dvec3& GetNormal() const { return this->Normal; }
  double GetArea() const { return this->Area; }
  /// False for a light with no area (or with coordinates that are not finite): it emits nothing.
  bool IsValid() const override { return this->Area > 0.0; }

  PolygonLight Transformed(const glm::dmat4& matrix) const;

  /// By Sutherland and Hodgman 1974.
  PolygonLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  /// Maps the unit square onto the light so that equal areas get equal shares of it.
  glm::dvec3 Sample(const glm::dvec2& s) const;

  /**
   * The form factor of the unoccluded light at a point x with the unit normal `normal`, Lambert's
   * formula:  F = 1/(2 pi) sum over edges of angle_i normal . unit(v_i x v_{i+1}),  v_i = vertex_i
   * - x (for its derivation: Baum, Rushmeier, Winget 1989, eq. 6). In [0, 1]. The part of the light
   * below the horizon of x is clipped off first. 0 where x is not on a side that emits.
   */
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;

  bool Faces(const glm::dvec3& point) const override;
  LightHull GetHull() const override;
  double GetMeasure() const override { return this->Area; }
  double GetSolidAngleBound(const penumbra::Parallelogram& receiver) const override;
  double GetAspect() const override;
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Area; }
  glm::dvec3 GetAxis() const override { return this->Normal; }
  std::vector<EmittingPolygon> GetPolygons() const override;
  std::vector<double> GetKey() const override;

private:
  enum class SampleMap
  {
    Parallelogram,
    TriangleFan
  };

  PolygonLight(std::vector<glm::dvec3> vertices, SampleMap map);

  std::vector<glm::dvec3> Vertices;
  glm::dvec3 Normal{ 0.0, 0.0, 1.0 };
  double Area = 0.0;
  SampleMap Map = SampleMap::TriangleFan;
  std::vector<double> FanShares; ///< of the total area, summed up: triangle i ends at FanShares[i]
};

} // namespace penumbra

#endif

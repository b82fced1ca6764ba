// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Area lights of many cells.
 */
#ifndef SurfaceLight_h
#define SurfaceLight_h

#include "PolygonLight.h"

namespace penumbra
{

/// Whether the vertices, in order, go once around a planar convex polygon, but for the rounding of
/// single precision. Polygons without area do.
PENUMBRARENDERING_EXPORT bool IsPlanarAndConvex(const std::vector<glm::dvec3>& vertices);

/**
 * Polygons that each emit with a radiance of their own: a stained-glass window is a grid of
 * coloured cells. Radiance, a factor of theirs, has no unit; the cells' is in W sr^-1 m^-2. They do
 * not block each other.
 */
class PENUMBRARENDERING_EXPORT SurfaceLight : public LightOfKind<SurfaceLight>
{
public:
  /// The cells, in the order in which samples are spread over them; those that are not valid or not
  /// bright are left out.
  explicit SurfaceLight(const std::vector<PolygonLight>& cells);

  /// Each convex and of at most MaximumVertices.
  const std::vector<PolygonLight>& GetCells() const { return this->Cells; }

  SurfaceLight Transformed(const glm::dmat4& matrix) const;
  SurfaceLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  /**
   * The cells with the sides that the receiver sees. A cell of two sides is one that emits to one
   * side alone if all of the receiver is on that side, or two cells if the cell's plane cuts the
   * receiver: a sample then has a front, before which its own cell hides nothing.
   */
  std::unique_ptr<LightShape> Face(const Parallelogram& receiver) const override;

  bool IsValid() const override { return !this->Cells.empty(); }
  bool Faces(const glm::dvec3& point) const override;
  LightHull GetHull() const override;
  /// The mean of the components of Irradiance(), for a Radiance of 1.
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  glm::dvec3 Irradiance(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override; ///< the area
  double GetSolidAngleBound(const Parallelogram& receiver) const override;
  glm::dvec3 GetIrradianceBound(const Parallelogram& receiver) const override;

  /**
   * The cells are chosen by power, the mean of radiance's components times area: the first
   * dimension of the pattern runs through them in proportion to it, and where it falls within a
   * cell is used again. A sample stands for power / probability / n, so that nothing is biased, and
   * the means of their powers sum to what the surface emits.
   */
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Cells; }
  bool HasOneHue() const override;
  std::vector<EmittingPolygon> GetPolygons() const override;
  std::vector<double> GetKey() const override;

private:
  template <typename Change>
  SurfaceLight WithCells(const Change& change) const;

  std::vector<PolygonLight> Cells;
  std::vector<double> PowerEnds; ///< of the cells, summed up, as shares of the whole
};

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Area lights in the shape of disks.
 */
#ifndef DiskLight_h
#define DiskLight_h

#include "LightShape.h"

namespace penumbra
{

/**
 * A disk that emits diffusely, to the side of its normal or to both sides; a plane may have cut a
 * segment off it. Radiance is in W sr^-1 m^-2.
 */
class PENUMBRARENDERING_EXPORT DiskLight : public LightOfKind<DiskLight>
{
public:
  /// Not valid if the radius or the length of `normal` is not greater than 0.
  DiskLight(const glm::dvec3& centre, const glm::dvec3& normal, double radius);

  const glm::dvec3& GetCentre() const { return this->Centre; }
  const glm::dvec3& GetNormal() const { return this->Normal; }
  double GetRadius() const { return this->Radius; }

  /// Points on the rim, counter-clockwise seen from the front.
  std::vector<glm::dvec3> GetRim(int count) const;

  /// Turns the samples within the disk: where s.x of Sample() grows, from the centre along this
  /// direction, as far as it lies in the disk's plane.
  void SetFirstAxis(const glm::dvec3& direction);
  const glm::dvec3& GetFirstAxis() const { return this->CutDirection; }

  /// Where a plane has cut the disk: what lies at least so far from the centre along the first axis
  /// is left, in radii; -1 or less: all of it.
  double GetCutOffset() const { return this->CutOffset; }

  /// The samples go with the map. An affine map that is not a similarity makes an ellipse, for
  /// which a disk of the same area around the same centre is taken.
  DiskLight Transformed(const glm::dmat4& matrix) const;
  DiskLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  /**
   * Maps the unit square onto the disk so that equal areas get equal shares of it: the concentric
   * map of Shirley and Chiu 1997, or, on what a plane has left of a disk, chords at the quantiles
   * of the area.
   */
  glm::dvec3 Sample(const glm::dvec2& s) const;

  bool IsValid() const override { return this->GetMeasure() > 0.0; }
  bool Faces(const glm::dvec3& point) const override;
  LightHull GetHull() const override;

  /**
   * Where x sees the whole disk, the textbook form (Howell, A Catalog of Radiation Heat Transfer
   * Configuration Factors, B-13 to B-15), split into what arrives along the disk's axis and across
   * it. Where a horizon cuts it, Lambert's contour integral (PolygonLight::FormFactor) over the arc
   * that is left and over its chord, which is in elementary functions, too.
   */
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override; ///< the area
  double GetSolidAngleBound(const Parallelogram& receiver) const override;
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Area; }
  glm::dvec3 GetAxis() const override { return this->Normal; }
  std::vector<double> GetKey() const override;

private:
  glm::dvec3 Centre;
  glm::dvec3 Normal{ 0.0, 0.0, 1.0 };
  double Radius = 0.0;
  /// The disk is left where CutDirection . (p - Centre) >= CutOffset Radius; CutDirection is a unit
  /// vector in its plane, and CutOffset in [-1, 1], -1 if nothing is cut off.
  glm::dvec3 CutDirection{ 1.0, 0.0, 0.0 };
  double CutOffset = -1.0;
};

} // namespace penumbra

#endif

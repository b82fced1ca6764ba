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
 * A disk, or the ellipse that an affine map makes of it, that emits diffusely, to the side of its
 * normal or to both sides; a plane may have cut a segment off it. Radiance is in W sr^-1 m^-2.
 */
class PENUMBRARENDERING_EXPORT DiskLight : public LightOfKind<DiskLight>
{
public:
  /// Not valid if the radius or the length of `normal` is not greater than 0.
  DiskLight(const glm::dvec3& centre, const glm::dvec3& normal, double radius);

  const glm::dvec3& GetCentre() const { return this->Centre; }
  const glm::dvec3& GetNormal() const { return this->Normal; }
  double GetRadius() const { return this->Radius; } ///< of an ellipse, the longer semi-axis
  /// The shorter over the longer semi-axis: 1 for a circle.
  double GetRatio() const { return this->Ratio; }

  /// Points on the rim, counter-clockwise seen from the front.
  std::vector<glm::dvec3> GetRim(int count) const;

  /// Turns the samples within a circle: where s.x of Sample() grows, from the centre along this
  /// direction, as far as it lies in the circle's plane.
  void SetFirstAxis(const glm::dvec3& direction);
  const glm::dvec3& GetFirstAxis() const { return this->Axis; }

  /// Where a plane has cut a circle: what lies at least so far from the centre along the first axis
  /// is left, in radii; -1 or less: all of it.
  double GetCutOffset() const { return this->CutOffset; }

  /// The samples go with the map. A map that is no similarity, but for rounding, makes an ellipse.
  /// What lies on a line, but for rounding, is not valid.
  DiskLight Transformed(const glm::dmat4& matrix) const;
  DiskLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  /**
   * Maps the unit square onto the disk so that equal areas get equal shares of it: the concentric
   * map of Shirley and Chiu 1997, or, on what a plane has left of a disk, chords at the quantiles
   * of the area. An ellipse takes the places of a circle, which its affine map moves.
   */
  glm::dvec3 Sample(const glm::dvec2& s) const;

  bool IsValid() const override { return this->GetMeasure() > 0.0; }
  bool Faces(const glm::dvec3& point) const override;
  LightHull GetHull() const override;

  /**
   * Where x sees the whole disk, the textbook form (Howell, A Catalog of Radiation Heat Transfer
   * Configuration Factors, B-13 to B-15), split into what arrives along the disk's axis and across
   * it. Where a horizon cuts it, Lambert's contour integral (PolygonLight::FormFactor) over the arc
   * that is left and over its chord, which is in elementary functions, too. EllipseCone has both
   * for ellipses.
   */
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override; ///< the area
  double GetSolidAngleBound(const Parallelogram& receiver) const override;
  /// Of an ellipse, how many times as long as wide it becomes along the samples' first axis.
  double GetAspect() const override;
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Area; }
  glm::dvec3 GetAxis() const override { return this->Normal; }
  std::vector<double> GetKey() const override;

private:
  bool IsCircle() const { return this->Ratio == 1.0; }
  /// From the centre, in radii, to the place that a point of the unit disk has: the samples' first
  /// axis is x.
  glm::dvec3 FromUnitDisk(const glm::dvec2& p) const;
  /// Makes an ellipse of a circle, around the same centre, with these conjugate radii where the
  /// unit disk has x and y.
  void Stretch(const glm::dvec3& x, const glm::dvec3& y);
  double FormFactorOfCircle(const glm::dvec3& x, const glm::dvec3& normal) const;
  double FormFactorOfEllipse(const glm::dvec3& x, const glm::dvec3& normal) const;

  glm::dvec3 Centre;
  glm::dvec3 Normal{ 0.0, 0.0, 1.0 };
  double Radius = 0.0;
  glm::dvec3 Axis{ 1.0, 0.0, 0.0 }; ///< unit vector along the longer semi-axis; a circle's is any
  double Ratio = 1.0;
  /// In the unit disk that Axis and Normal x Axis span, the unit vector that is the x of samples
  /// and of what is cut off: the disk is left where x >= CutOffset, in [-1, 1], -1 if all of it is.
  /// A circle turns Axis instead.
  glm::dvec2 Turn{ 1.0, 0.0 };
  double CutOffset = -1.0;
};

} // namespace penumbra

#endif

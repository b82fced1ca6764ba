// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Lights at infinity.
 */
#ifndef DirectionalLight_h
#define DirectionalLight_h

#include "DiskLight.h"

namespace penumbra
{

/**
 * A light that is infinitely far away: a point, or a disk of even radiance such as the sun, whose
 * angular diameter is 0.53 degrees. Radiance is the irradiance at normal incidence, W m^-2.
 *
 * The directions to it make a cone; on the plane at distance 1 across the cone's axis they make a
 * disk, and the form factor of a disk knows only directions (Nusselt 1928): DiskLight does the
 * rest.
 */
class PENUMBRARENDERING_EXPORT DirectionalLight : public LightOfKind<DirectionalLight>
{
public:
  /// Shines along `direction`, from a disk of the given angular diameter in degrees, [0, 180). Not
  /// valid if the direction has no length.
  DirectionalLight(const glm::dvec3& direction, double angularDiameter);

  /// The unit vector towards the light's centre.
  const glm::dvec3& GetSource() const { return this->Source; }

  /// Turns the samples around the direction, as DiskLight does.
  void SetFirstAxis(const glm::dvec3& axis) { this->Disk.SetFirstAxis(axis); }

  /// Turns with the matrix, and the samples with it; the angular diameter stays.
  DirectionalLight Transformed(const glm::dmat4& matrix) const;
  DirectionalLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  bool IsValid() const override { return this->IsThere; }
  bool Faces(const glm::dvec3&) const override { return true; }
  LightHull GetHull() const override;
  /// 1/pi of the cosine to the light's centre, unless the horizon cuts it.
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override { return this->IsThere ? 1.0 : 0.0; }
  double GetSolidAngleBound(const Parallelogram& receiver) const override;
  glm::dvec3 GetIrradianceBound(const Parallelogram&) const override;
  /// Unit directions whose solid angles are alike if the light is wide (more than 60 degrees), else
  /// points of the disk whose areas are: that keeps the weights of samples within a factor of two
  /// of each other but for the receiver's cosine, at every diameter.
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override
  {
    return this->IsWide() ? Emission::Point : Emission::Area;
  }
  glm::dvec3 GetAxis() const override { return this->Source; }
  std::vector<double> GetKey() const override;

private:
  double GetRadius() const; ///< of the disk at distance 1
  bool IsWide() const;
  std::vector<LightSample> TakeDirections(const std::vector<glm::dvec2>& pattern) const;

  glm::dvec3 Source{ 0.0, 0.0, 1.0 };
  double AngularDiameter; ///< degrees
  bool IsThere = false;
  DiskLight Disk; ///< seen from the origin; not valid if AngularDiameter is 0
};

} // namespace penumbra

#endif

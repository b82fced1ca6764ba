// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Point lights.
 */
#ifndef PointLight_h
#define PointLight_h

#include "LightShape.h"

namespace penumbra
{

/// A point that emits the same in all directions: its shadows are hard, and one sample is enough.
/// Radiance is its radiant intensity, W sr^-1.
class PENUMBRARENDERING_EXPORT PointLight : public LightOfKind<PointLight>
{
public:
  explicit PointLight(const glm::dvec3& place);

  const glm::dvec3& GetPlace() const { return this->Place; }

  PointLight Transformed(const glm::dmat4& matrix) const;
  PointLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  bool IsValid() const override { return this->IsThere; }
  bool Faces(const glm::dvec3&) const override { return true; }
  LightHull GetHull() const override;
  /// cos t / (pi r^2), 1/m^2.
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override { return this->IsThere ? 1.0 : 0.0; }
  double GetSolidAngleBound(const Parallelogram&) const override { return 0.0; }
  glm::dvec3 GetIrradianceBound(const Parallelogram& receiver) const override;
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Point; }
  std::vector<double> GetKey() const override;

private:
  glm::dvec3 Place;
  bool IsThere;
};

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Line lights.
 */
#ifndef SegmentLight_h
#define SegmentLight_h

#include "LightShape.h"

namespace penumbra
{

/**
 * A segment that emits as a thin diffuse cylinder does: from a direction at the angle theta to it,
 * sin(theta) of what is emitted across it is seen (Nishita, Okamura, Nakamae 1985, "Shading Models
 * for Point and Linear Sources"). Radiance is in W sr^-1 m^-1, across the segment.
 */
class PENUMBRARENDERING_EXPORT SegmentLight : public LightOfKind<SegmentLight>
{
public:
  SegmentLight(const glm::dvec3& begin, const glm::dvec3& end);

  const glm::dvec3& GetBegin() const { return this->Begin; }
  const glm::dvec3& GetEnd() const { return this->End; }

  SegmentLight Transformed(const glm::dmat4& matrix) const;
  SegmentLight ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const;

  bool IsValid() const override { return this->GetMeasure() > 0.0; }
  bool Faces(const glm::dvec3& point) const override;
  LightHull GetHull() const override;
  /// The integral of cos t sin(theta) / (pi r^2) along the segment, in closed form (Heitz and Hill
  /// 2017, "Linear-Light Shading with Linearly Transformed Cosines"); 1/m.
  double FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const override;
  double GetMeasure() const override; ///< the length
  double GetSolidAngleBound(const Parallelogram&) const override { return 0.0; }
  glm::dvec3 GetIrradianceBound(const Parallelogram& receiver) const override;
  /// By the patterns' first dimension.
  std::vector<LightSample> TakeSamples(const std::vector<glm::dvec2>& pattern) const override;
  Emission GetEmission() const override { return Emission::Line; }
  glm::dvec3 GetAxis() const override;
  double GetAspect() const override;
  std::vector<double> GetKey() const override;

private:
  glm::dvec3 Begin, End;
};

} // namespace penumbra

#endif

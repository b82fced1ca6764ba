// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where the occluders are that matter.
 */
#ifndef BlockingRegion_h
#define BlockingRegion_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

#include <optional>
#include <vector>

namespace penumbra
{

/**
 * A convex region of a receiver's frame that holds every ray from the receiver to a light: what is
 * outside it blocks nothing. It is the union of the pyramids of H&H 1997, 3.2, with the receiver
 * for a base and an apex on the light, bounded by six planes:
 *
 *     low h <= (u, v) <= 1 + high h,    0 <= h <= top.
 *
 * On a ray from (u0, v0, 0) to the apex, u = u0 (1 - k.z h) + k.x h with k as in
 * RegisteredProjection, so low is the least k.x and high the greatest k.x - k.z.
 */
class PENUMBRARENDERING_EXPORT BlockingRegion
{
public:
  /// @param seen the light, clipped to the receiver's front
  BlockingRegion(const ReceiverFrame& frame, const LightShape& seen);

  /// Whether the triangle may have a point in the region: not if one plane has all three outside.
  bool MayHold(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;

  /// The unit normal, in the world, of the plane that a flat light lies in.
  const std::optional<glm::dvec3>& GetLightNormal() const { return this->LightNormal; }
  /// Whether the triangle lies in that plane, up to a distance in the world: then it blocks
  /// nothing, since rays meet the plane in the light alone.
  bool LiesInLight(
    const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double tolerance) const;

  /// Whether the point is so far away that single precision would move the edges that end there.
  static bool IsFar(const glm::dvec3& p);

  /// The part of a triangle that is inside: the vertices of a convex polygon, perhaps none.
  std::vector<glm::dvec3> Clip(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;

private:
  static constexpr int Planes = 6;
  /// How far inside the plane a point is.
  double GetDepth(int plane, const glm::dvec3& p) const;

  glm::dvec2 Low{ 0.0 }, High{ 0.0 };
  double Top = 0.0;
  std::optional<glm::dvec3> LightNormal;
  glm::dvec4 LightPlane{ 0.0 }; ///< (u, v, h, 1) to the distance from it in the world
};

} // namespace penumbra

#endif

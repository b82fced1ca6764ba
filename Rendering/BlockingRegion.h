// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where the occluders are that matter.
 */
#ifndef BlockingRegion_h
#define BlockingRegion_h

#include "ClusterTree.h"
#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

#include <optional>
#include <vector>

namespace penumbra
{

/**
 * A convex region of a receiver's frame that holds every ray from the receiver to a light: what is
 * outside it blocks nothing. It is the union of the pyramids of H&H 1997, 3.2, with the receiver,
 * or a part of it from `first` to `last` in (u, v), for a base and an apex on the light, bounded by
 * six planes:
 *
 *     first + low h <= (u, v) <= last + high h,    0 <= h <= top.
 *
 * On a ray from (u0, v0, 0) to the apex, u = u0 (1 - k.z h) + k.x h with k as in
 * RegisteredProjection, and 1 - k.z h >= 0 up to the apex, so low is the least k.x - first k.z and
 * high the greatest k.x - last k.z.
 */
class PENUMBRARENDERING_EXPORT BlockingRegion
{
public:
  /// @param seen the light, clipped to the receiver's front
  /// @param uvRange the part of the receiver, from (x, y) to (z, w) in (u, v), within [0, 1]
  BlockingRegion(const ReceiverFrame& frame, const LightShape& seen,
    const glm::dvec4& uvRange = { 0.0, 0.0, 1.0, 1.0 });

  /// Whether the triangle may have a point in the region: not if one plane has all of its part
  /// above the receiver outside.
  bool MayHold(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;

  /**
   * The region in the world, without a top if the light is infinitely far. It is a little wider
   * than this one: whatever MayHold() finds in it above the receiver is in that one, too, though
   * world coordinates round more.
   */
  ConvexRegion GetWorldPlanes() const;

  /// The unit normal, in the world, of the plane that a flat light lies in.
  const std::optional<glm::dvec3>& GetLightNormal() const { return this->LightNormal; }
  /// Whether the triangle lies in that plane, up to a distance in the world beside the rounding of
  /// the light: then it blocks nothing, since rays meet the plane in the light alone.
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

  glm::dmat4 FrameRows{ 1.0 }; ///< columns: u, v and h of homogeneous world points
  double CornerSize = 0.0;     ///< the largest coordinate of the receiver's corner
  glm::dvec2 First{ 0.0 }, Last{ 1.0 };
  glm::dvec2 Low{ 0.0 }, High{ 0.0 };
  double Top = 0.0;
  std::optional<glm::dvec3> LightNormal;
  double LightRounding = 0.0;   ///< of the distance from its plane, in the world
  glm::dvec4 LightPlane{ 0.0 }; ///< (u, v, h, 1) to the distance from it in the world
};

} // namespace penumbra

#endif

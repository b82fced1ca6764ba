// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where shadows may fall.
 */
#ifndef ShadowBounds_h
#define ShadowBounds_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"
#include "RegisteredProjection.h"
#include "TexelRectangle.h"

#include <limits>
#include <vector>

namespace penumbra
{

/// A rectangle of (u, v) that holds the shadows of some points, from all of a light.
struct PENUMBRARENDERING_EXPORT ShadowBounds
{
  glm::dvec2 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec2 High{ -std::numeric_limits<double>::infinity() };
  /// In u and v, how wide a penumbra may be.
  glm::dvec2 Penumbra{ 0.0 };
  /// What ShadowProjector has found of the points so far, to tell the penumbra by.
  glm::dvec2 LowSlope{ 0.0 }, HighSlope{ 0.0 };
  double Reach = 0.0;
  /// A point is as high as the light, or nearly: its shadow may fall anywhere.
  bool IsUnbounded = false;

  void Add(const ShadowBounds& other);
  /// Adds the shadow of another part of the same thing: the penumbra is as if its points had been
  /// added to this.
  void AddPart(const ShadowBounds& other);
  /// The texels of a receiver that the shadows may reach.
  TexelRectangle GetTexels(const glm::ivec2& texels) const;
  /// The greatest width of a penumbra, in texels.
  double GetPenumbraTexels(const glm::ivec2& texels) const;
};

/**
 * Projects points onto a receiver from all of a light at once: from the corners of a hull around
 * it.
 *
 * From all of a convex light, the projections of a point below it are the convex hull of those from
 * its corners.
 *
 * How far these are apart is not convex along an edge, unless all of the light is equally high: an
 * edge from right below an upright light to the receiver has no penumbra at its ends, but has one
 * between them. With k of a corner and c of the light's centre (RegisteredProjection), a point's
 * projections from the two differ by
 *
 *     h / (1 - c.z h) * (u (k.z - c.z) + c.x - k.x + h (k.x c.z - c.x k.z)) / (1 - k.z h)
 *
 * in u, and alike in v. The first factor, the reach, grows with h, and the second one, the slope,
 * is linear over linear, so that neither is larger anywhere in a triangle than at its corners.
 */
class PENUMBRARENDERING_EXPORT ShadowProjector
{
public:
  /// @param seen the light, clipped to the receiver's front
  ShadowProjector(const ReceiverFrame& frame, const LightShape& seen);

  /// Add the shadow of a point (u, v, h) that is a corner of something.
  void Add(const glm::dvec3& point, ShadowBounds& bounds) const;

  /// The shadow (u, v) of a point from the light's centre; 0 if it falls nowhere near.
  glm::dvec2 ProjectFromCentre(const glm::dvec3& point) const;

private:
  void AddPenumbra(const glm::dvec3& point, ShadowBounds& bounds) const;

  std::vector<RegisteredProjection> Projections;
  RegisteredProjection Centre;
};

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The affine frame of a planar receiver.
 */
#ifndef ReceiverFrame_h
#define ReceiverFrame_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

namespace penumbra
{

/// A point `Corner` and two edges that span the parallelogram around a receiver, in world units.
struct Parallelogram
{
  glm::dvec3 Corner{ 0.0 };
  glm::dvec3 EdgeX{ 1.0, 0.0, 0.0 };
  glm::dvec3 EdgeY{ 0.0, 1.0, 0.0 };
};

/**
 * Maps the world affinely to (u, v, h) of a receiver (DESIGN 3):
 *
 *     x = b + u ex + v ey + h s n,    n = +-unit(ex x ey),    s = sqrt(|ex x ey|).
 *
 * (u, v) runs over [0, 1]^2 on the receiver, and h is the height over it in units of its size s,
 * positive on the side that is lit. Everything is double, and every point is taken relative to b
 * before anything else is done with it, so that a scene far from the origin loses no more than its
 * own coordinates did.
 */
class PENUMBRARENDERING_EXPORT ReceiverFrame
{
public:
  enum class Side
  {
    Front, ///< lit from where ex x ey points
    Back   ///< lit from the opposite side
  };

  ReceiverFrame() = default;

  /// `base` must span an area: see IsValid().
  ReceiverFrame(const Parallelogram& base, Side side);

  /// False if the parallelogram spans no area or holds a coordinate that is not finite.
  bool IsValid() const { return this->Size > 0.0; }

  const Parallelogram& GetBase() const { return this->Base; }
  /// Unit normal, towards the side that is lit.
  const glm::dvec3& GetNormal() const { return this->Normal; }
  /// s, the square root of the parallelogram's area: the unit of h.
  double GetSize() const { return this->Size; }

  /// World point to (u, v, h).
  glm::dvec3 ToFrame(const glm::dvec3& world) const;
  /// The same for a direction.
  glm::dvec3 DirectionToFrame(const glm::dvec3& direction) const;
  /// (u, v, h) to world point.
  glm::dvec3 ToWorld(const glm::dvec3& uvh) const;

  /// The rows of the affine map ToFrame(), to be applied to homogeneous world points.
  glm::dmat4 GetWorldToFrame() const;

  /**
   * World point to a metric frame for the form factors: the origin in the parallelogram's centre,
   * the axes unit(ex), unit(n x ex) and n, lengths in units of s. Distances and angles are those of
   * the world, and numbers near 1 suit the single precision of shaders.
   */
  glm::dvec3 ToMetric(const glm::dvec3& world) const;
  /// The same for a direction: lengths still in units of s.
  glm::dvec3 DirectionToMetric(const glm::dvec3& direction) const;

private:
  Parallelogram Base;
  glm::dvec3 Normal{ 0.0, 0.0, 1.0 };
  double Size = 0.0;
  glm::dvec3 DualX{ 1.0, 0.0, 0.0 }; ///< u = DualX . (x - b)
  glm::dvec3 DualY{ 0.0, 1.0, 0.0 }; ///< v = DualY . (x - b)
  glm::dmat3 Axes{ 1.0 };            ///< columns: the metric frame's axes
};

} // namespace penumbra

#endif

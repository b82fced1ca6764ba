// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * H&H 1997, section 3.3, in the receiver's frame.
 */
#ifndef RegisteredProjection_h
#define RegisteredProjection_h

#include "Vectors.h"

namespace penumbra
{

/**
 * The registered projection from one light sample onto the receiver: the 4x4 matrix M of H&H 1997,
 * section 3.3, needs only three numbers once the world is in the receiver's frame (DESIGN 3):
 *
 *     x' = u - k.x h,    y' = v - k.y h,    w' = 1 - k.z h.
 *
 * (x'/w', y'/w') is where the ray from the sample through (u, v, h) meets the receiver, whatever
 * the sample: the projections are registered. What blocks is what lies at h > 0 with w' > 0, that
 * is, between the receiver and the plane through the sample that is parallel to it.
 */
struct RegisteredProjection
{
  glm::dvec3 K{ 0.0 };

  /// From a sample at (lu, lv, lh) in the receiver's frame; lh must be positive.
  static RegisteredProjection FromPoint(const glm::dvec3& sample)
  {
    return { { sample.x / sample.z, sample.y / sample.z, 1.0 / sample.z } };
  }

  /// From infinity, towards a direction (du, dv, dh) in the receiver's frame; dh must be positive.
  static RegisteredProjection FromDirection(const glm::dvec3& direction)
  {
    return { { direction.x / direction.z, direction.y / direction.z, 0.0 } };
  }

  /// (u, v, h) to homogeneous (x', y', w').
  glm::dvec3 Project(const glm::dvec3& uvh) const
  {
    return { uvh.x - this->K.x * uvh.z, uvh.y - this->K.y * uvh.z, 1.0 - this->K.z * uvh.z };
  }
};

} // namespace penumbra

#endif

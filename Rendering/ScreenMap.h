// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where a receiver is on the screen.
 */
#ifndef ScreenMap_h
#define ScreenMap_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

namespace penumbra
{

/**
 * Two projective maps of the screen, from window coordinates (x, y, 1) in pixels: one to where on a
 * receiver's plane the pixel looks, one to how deep the plane is there. A planar surface needs no
 * more to be textured.
 */
struct ScreenMap
{
  /// The rows of the matrix that gives (u q, v q, q).
  glm::dvec3 Rows[3];
  /// Its product with (x, y, 1) is what gl_FragCoord.z is on the plane, at OpenGL's default depth
  /// range.
  glm::dvec3 Depth;
};

/**
 * @param base the receiver
 * @param worldToView the camera's rigid motion; it is applied first, in double, so that scenes far
 * from the origin lose nothing
 * @param viewToClip the camera's projection, perspective or parallel
 * @param viewport x, y, width and height in pixels
 */
PENUMBRARENDERING_EXPORT ScreenMap MakeScreenMap(const Parallelogram& base,
  const glm::dmat4& worldToView, const glm::dmat4& viewToClip, const glm::ivec4& viewport);

} // namespace penumbra

#endif

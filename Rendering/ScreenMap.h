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

/// Of an actor's several receivers, a fragment belongs to the one that it is closest to. What a
/// plane stands for is above it by any height and counts as close, but not as close as what lies in
/// a planar receiver.
constexpr double ProxyHeight = 1e-3;

/**
 * The matrix that takes window coordinates, gl_FragCoord's (x, y, z, 1), to (u q, v q, h q, q): (u,
 * v) is where on the receiver's plane the pixel looks, and h is 0 for what lies on the plane.
 *
 * @param base the receiver
 * @param worldToView the camera's rigid motion; it is applied first, in double, so that scenes far
 * from the origin lose nothing
 * @param viewToClip the camera's projection, perspective or parallel
 * @param viewport x, y, width and height in pixels
 */
PENUMBRARENDERING_EXPORT glm::dmat4 MakeScreenMap(const Parallelogram& base,
  const glm::dmat4& worldToView, const glm::dmat4& viewToClip, const glm::ivec4& viewport);

/**
 * The matrix that takes view coordinates (x, y, z, 1) to (u, v, h, 1) of the receiver's frame. In
 * view coordinates numbers are as large as what is seen, wherever in the world that is: they may be
 * floats.
 */
PENUMBRARENDERING_EXPORT glm::dmat4 MakeViewMap(
  const Parallelogram& base, const glm::dmat4& worldToView);

/**
 * The matrix that takes window coordinates to homogeneous view coordinates. Depth has few digits:
 * what is far away is off along the ray to it.
 */
PENUMBRARENDERING_EXPORT glm::dmat4 MakeWindowToView(
  const glm::dmat4& viewToClip, const glm::ivec4& viewport);

///@{
/**
 * The receiver's two for a plane that stands for a surface (PlaceProxy): (u q, v q) is where the
 * point of the surface is projected to from `centre`, homogeneous, in the world; h is the same
 * small number for all. What lies between the camera and the plane counts here, so the second
 * inverts the camera's projection, depth and all.
 */
PENUMBRARENDERING_EXPORT glm::dmat4 MakeProxyViewMap(
  const Parallelogram& base, const glm::dvec4& centre, const glm::dmat4& worldToView);
PENUMBRARENDERING_EXPORT glm::dmat4 MakeProxyScreenMap(const Parallelogram& base,
  const glm::dvec4& centre, const glm::dmat4& worldToView, const glm::dmat4& viewToClip,
  const glm::ivec4& viewport);
///@}

} // namespace penumbra

#endif

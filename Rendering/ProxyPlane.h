// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * H&H 1997, figure 5: the plane that stands for a curved or many-faceted receiver.
 */
#ifndef ProxyPlane_h
#define ProxyPlane_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "PlanarRegions.h"
#include "ShadowSettings.h"

#include <string>

namespace penumbra
{

/// What FindProxyPlane() answers.
struct ProxyPlane
{
  /// The surface's centroid by area, on the plane.
  glm::dvec3 Origin{ 0.0 };
  /// Unit length, towards the front.
  glm::dvec3 Normal{ 0.0, 0.0, 1.0 };
  /// How far the surface's points are from Origin.
  double Extent = 0.0;
  /// Empty, or why there is no such plane and what is allowed.
  std::string Problem;
};

/**
 * The proxy plane of a mesh of finite points: the given one, whose front is where its normal
 * points; or the plane from which the surface's squared distance, integrated over its area, is
 * least. That one goes through the surface's centroid, and its front is where more of the area
 * points. A surface for which no plane is better than all others, like a cube or a ball, needs a
 * given one.
 */
PENUMBRARENDERING_EXPORT ProxyPlane FindProxyPlane(
  const PolygonMesh& mesh, const ReceiverSettings& settings);

/**
 * Whether a mesh is to receive by a proxy plane: the settings ask for it, and its polygons do not
 * lie in one plane. `found` is what FindPlanarRegions() says of it.
 */
PENUMBRARENDERING_EXPORT bool NeedsProxyPlane(
  const PolygonMesh& mesh, const PlanarRegions& found, const ReceiverSettings& settings);

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * H&H 1997, figure 5: shadows are computed on a plane and projected onto the receiving object.
 */
#ifndef ProxyReceiver_h
#define ProxyReceiver_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "PlanarRegions.h"
#include "ShadowScene.h"

#include <string>

namespace penumbra
{

/// What PlaceProxy() answers.
struct ProxyReceiver
{
  /// In the proxy plane, around the projections of all of the surface's points. Its front is the
  /// plane's.
  Parallelogram Base;
  /// The side that is lit: never Auto.
  ReceiverSide Side = ReceiverSide::Front;
  /// What points are projected from, homogeneous, in the world.
  glm::dvec4 Centre{ 0.0, 0.0, 1.0, 0.0 };
  /// Empty, or why the surface cannot receive and what is allowed.
  std::string Problem;
};

/**
 * Places the receiver that stands for a whole surface.
 *
 * A best-fitting plane (FindProxyPlane) is moved along its normal to the surface's point that is
 * deepest below the lit side: whatever stands on the surface is then above the plane, and so is
 * what lies between the two, such as a table below its cloth. A given plane stays where it is.
 *
 * A point of the surface shows the shadow at its projection from the light's centre (along the
 * direction of a directional light): the mean of the samples of what the plane can see of the
 * light. With h the height over the plane, that is RegisteredProjection with the centre as its
 * sample, and h k is how far from the point's foot the shadow is found. Of several lights the mean
 * k is taken, weighted by the light that each sends to the plane at the surface's centroid: of all
 * k it leaves the least weighted squared displacement.
 *
 * From lights so low that the projections would reach 16 times as far from the surface's centroid
 * as the surface does, or whose centre is not above the surface, nothing useful could be shown:
 * that is a problem, and so are lights that the plane is edge-on to.
 *
 * @param mesh the surface, of finite points
 * @param settings the receiver's; they must have no problem
 * @param scene its lights count
 */
PENUMBRARENDERING_EXPORT ProxyReceiver PlaceProxy(
  const PolygonMesh& mesh, const ReceiverSettings& settings, const ShadowScene& scene);

} // namespace penumbra

#endif

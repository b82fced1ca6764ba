// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The receivers in a polygonal surface.
 */
#ifndef PlanarRegions_h
#define PlanarRegions_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

#include <optional>
#include <string>
#include <vector>

namespace penumbra
{

/// Polygons over shared points; points at the same place must have been merged.
struct PolygonMesh
{
  std::vector<glm::dvec3> Points;
  /// Each polygon's points, in order. At least three each.
  std::vector<std::vector<int>> Polygons;
  /// How far the coordinates may be off by the rounding of their type.
  double Rounding = 0.0;
};

/// One receiver: a connected set of coplanar polygons.
struct PlanarRegion
{
  std::vector<int> Polygons;
  Parallelogram Base;
  bool IsTriangle = false; ///< it fills the lower left half of its base
};

/// The problem of a mesh with a coordinate that is not finite, or too large (Coordinates.h).
constexpr const char* NotFiniteProblem =
  "a point has a coordinate that is not finite (nan or inf) or beyond 1e75; allowed: finite "
  "coordinates of up to 1e75";

/// The problem of a mesh without a polygon that has an area.
constexpr const char* NoAreaProblem =
  "it has no polygon with an area; allowed: planar polygonal data";

/// Of a region's extent: how far its points may stray from its plane.
constexpr double PlanarityTolerance = 1e-5;

/// What FindPlanarRegions() answers.
struct PlanarRegions
{
  std::vector<PlanarRegion> Regions;
  /// Of each polygon, the index of its region; -1 for a polygon of no area.
  std::vector<int> RegionOfPolygon;
  /// Empty, or what makes the mesh unfit to receive shadows and what is allowed; then there are no
  /// regions.
  std::string Problem;
};

/**
 * Divides a mesh into receivers: polygons that share an edge and lie in one plane belong to the
 * same one. The winding of single polygons may differ: the receiver's front is where more of its
 * area points.
 *
 * Edges at which the surface bends by 30 degrees or more (vtkPolyDataNormals' default feature
 * angle) divide it, as those of a box do. A lesser bend means a curved surface, which is a problem,
 * and so is a region whose points stray from its plane by more than 1e-5 of its extent plus the
 * coordinates' rounding.
 */
PENUMBRARENDERING_EXPORT PlanarRegions FindPlanarRegions(const PolygonMesh& mesh);

/// A closed surface among the polygons: its bounds, and where its inside is.
struct ClosedSurface
{
  glm::dvec3 Low{ 0.0 }, High{ 0.0 };
  bool IsBehind = true; ///< the region's parallelogram, or in front of it
};

/**
 * Of each region, the closed surface that it is a part of, if it is: connected by edges, of which
 * each has two polygons, which are wound alike. Polygons of no area, whose points count as others
 * do, may be among them.
 */
PENUMBRARENDERING_EXPORT std::vector<std::optional<ClosedSurface>> FindClosedSurfaces(
  const PolygonMesh& mesh, const PlanarRegions& regions);

} // namespace penumbra

#endif

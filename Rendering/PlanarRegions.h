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
  /// How far a region's points may be off its plane; 0: AutomaticPlanarity of its extent. The
  /// rounding comes on top.
  double Tolerance = 0.0;
};

/// One receiver: a connected set of coplanar polygons.
struct PlanarRegion
{
  std::vector<int> Polygons;
  Parallelogram Base;
  bool IsTriangle = false; ///< it fills the lower left half of its base
  /// How far its points are off the plane of its base; 0 where ExactPlanarity explains it.
  double Deviation = 0.0;
};

/// The problem of a mesh with a coordinate that is not finite, or too large (Coordinates.h).
constexpr const char* NotFiniteProblem =
  "a point has a coordinate that is not finite (nan or inf) or beyond 1e75; allowed: finite "
  "coordinates of up to 1e75";

/// The problem of a mesh without a polygon that has an area.
constexpr const char* NoAreaProblem =
  "it has no polygon with an area; allowed: planar polygonal data";

/// Of a region's extent: how far its points may stray from its plane by default. A face of 10 m
/// whose coordinates are rounded to millimetres is planar.
constexpr double AutomaticPlanarity = 1e-4;
/// Of a region's extent: points that stray by less are in its plane, as far as shadows go.
constexpr double ExactPlanarity = 1e-5;

/// What FindPlanarRegions() answers.
struct PlanarRegions
{
  std::vector<PlanarRegion> Regions;
  /// Of each polygon, the index of its region; -1 for a polygon of no area or of a part that is not
  /// planar.
  std::vector<int> RegionOfPolygon;
  /// Empty, or what makes the mesh unfit to receive shadows and what is allowed; then there are no
  /// regions.
  std::string Problem;
  /// Empty, or what is wrong with the parts that are not planar, where others are.
  std::string Refused;
};

/**
 * Divides a mesh into receivers: polygons that share an edge and lie in one plane belong to the
 * same one. The winding of single polygons may differ: the receiver's front is where more of its
 * area points.
 *
 * Edges at which the surface bends by 30 degrees or more (vtkPolyDataNormals' default feature
 * angle) divide it, as those of a box do. A lesser bend means a curved surface, unless the
 * tolerance explains it: the smaller side's points lie in the plane of the larger one, and its
 * normal is as uncertain as that. Planes do not move while they grow, so that they do not creep
 * round a curve.
 *
 * Parts that are curved, and regions whose points stray from their plane by more than the mesh's
 * tolerance plus the coordinates' rounding, are refused. They are a problem if nothing else is
 * left. A region's extent is twice the distance of its farthest point from the mean of its points.
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

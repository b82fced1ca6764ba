// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What a point of a receiver sees of a polygonal light, without samples.
 */
#ifndef PolygonVisibility_h
#define PolygonVisibility_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra
{

class OccluderSelector;
class PolygonLight;
class ReceiverFrame;

/**
 * The exact share of a diffuse convex polygon that a point of a receiver sees: the polygon is cut
 * along the outlines of the triangles' shadows on it, as seen from the point, and Lambert's formula
 * adds up what no shadow covers (Nishita and Nakamae 1983). What that costs grows with the
 * triangles, as what samples cost grows with them.
 *
 * Points of the receiver are given by (u, v), as in ReceiverFrame; all else is in the metric frame,
 * in double.
 */
class PENUMBRARENDERING_EXPORT PolygonVisibility
{
public:
  /**
   * @param frame the receiver's
   * @param seen the light's part in front of the receiver, valid
   * @param occluders with what may block it selected, none of it translucent
   */
  PolygonVisibility(
    const ReceiverFrame& frame, const PolygonLight& seen, const OccluderSelector& occluders);

  /// Triangles, by their indices.
  using Indices = std::vector<std::uint32_t>;

  /// The triangles that may block the light from a part of the receiver, from `low` to `high`.
  Indices FindNear(const glm::dvec2& low, const glm::dvec2& high) const;

  /**
   * The share, in [0, 1], of what the light would send to a point of the receiver. None if rounding
   * decides that: the point touches a triangle, or the light is 1e8 times as far away as large, or
   * seen from its edge. None, too, if what is seen falls into more than MaximumPieces, or one of
   * these has many vertices.
   * @param near FindNear() of a part that holds the point
   */
  std::optional<double> FindShare(const glm::dvec2& place, const Indices& nearby) const;
  static constexpr std::size_t MaximumPieces = 64;

private:
  struct Triangle
  {
    std::array<glm::dvec3, 3> Corners;
    double Rounding; ///< a point that is no farther from its plane is in it
  };

  glm::dvec3 GetPlace(const glm::dvec2& uv) const;

  glm::dmat3 ToMetric{ 1.0 };       ///< (u, v, h) from the receiver's centre to the metric frame
  std::vector<glm::dvec3> Vertices; ///< the light's
  glm::dvec3 AxisX{ 0.0 }, AxisY{ 0.0 }; ///< unit vectors in its plane
  std::vector<glm::dvec2> Outline;       ///< the vertices along these, from the first one
  std::vector<Triangle> Triangles;
};

} // namespace penumbra

#endif

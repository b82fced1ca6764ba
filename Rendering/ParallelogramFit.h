// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * H&H 1997, section 3.4: the parallelogram around a receiver.
 */
#ifndef ParallelogramFit_h
#define ParallelogramFit_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"

#include <optional>
#include <vector>

namespace penumbra
{

/// What FitParallelogram() answers.
struct FittedParallelogram : Parallelogram
{
  /// The points fill its lower left half: corner, corner + EdgeX, corner + EdgeY.
  bool IsTriangle = false;
};

/**
 * Fits a parallelogram around coplanar points (H&H 1997, section 3.4), by the shape of their convex
 * hull:
 * - a rectangle or parallelogram is its own fit, whatever points lie inside it or on its edges;
 * - a triangle fills the lower left half of its parallelogram: corner, corner + EdgeX, corner +
 * EdgeY;
 * - anything else gets the smallest enclosing rectangle (Freeman and Shapira 1975: one of its sides
 * lies along an edge of the hull).
 *
 * EdgeX x EdgeY points along `normal` (unit length). The corner is the hull's vertex that comes
 * first in `points` (of an enclosing rectangle: the corner before its side along the hull), so that
 * the fit does not depend on where the points are. `rounding` is twice how far the points may be
 * off by the rounding of their type: their size times the type's epsilon. Nothing is returned for
 * points on a line, fewer than three, or coordinates that are not finite.
 */
PENUMBRARENDERING_EXPORT std::optional<FittedParallelogram> FitParallelogram(
  const std::vector<glm::dvec3>& points, const glm::dvec3& normal, double rounding = 0.0);

} // namespace penumbra

#endif

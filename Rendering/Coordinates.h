// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The coordinates that can be computed with.
 */
#ifndef Coordinates_h
#define Coordinates_h

#include "Vectors.h"

namespace penumbra
{

/// The largest coordinate: the square of an area of such edges, which makes a normal of it, is
/// still a double.
constexpr double MaximumCoordinate = 1e75;
/// Smaller areas are none: their squares are no longer good to all digits.
constexpr double SmallestArea = 1e-150;

/// What messages say is allowed.
constexpr const char* AllowedCoordinates = "finite coordinates of up to 1e75";

/// False for coordinates that are not finite, too.
inline bool IsInRange(const glm::dvec3& p)
{
  return glm::all(glm::lessThanEqual(glm::abs(p), glm::dvec3(MaximumCoordinate)));
}

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What a bake of a random scene must say, by an exact count of its own samples.
 */
#ifndef FuzzCount_h
#define FuzzCount_h

#include "FuzzedScene.h"

#include <vector>

/// Of each texel, between which values its irradiance is: rays that no rasteriser has to decide
/// leave a gap.
struct ExactCount
{
  std::vector<glm::dvec3> Low, High;
  /// The sum over all polygons of the lights of the largest irradiance that each alone sends to a
  /// texel: what roundings are relative to.
  double Peak = 0.0;
};

/**
 * The closed form in double times the share of the very samples of the bake that rays in long
 * double find unblocked (SampledVisibility), weighed by H&H 1997, eq. 1; for lights of all kinds.
 * Without Reconstruction and Supersampling; Side must be Front or Back.
 */
ExactCount CountExactly(const FuzzedScene& scene);

/// The same settings without what a count of samples does not have.
FuzzedScene WithoutFilters(FuzzedScene scene);

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Patterns of sample points on the unit square.
 */
#ifndef SamplingPattern_h
#define SamplingPattern_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra
{

/**
 * A pattern of points in [0, 1)^2 for sampling a light. The set is a pure function of the number
 * asked for and the seed, so that pictures and films repeat.
 *
 * The order is part of it: the first and the second half of the points (the first one more, if the
 * number is odd) are each spread over the whole square as well as the pattern can, since half the
 * difference of what they say estimates the error (DESIGN 3).
 */
struct SamplingPattern
{
  /// As the user chooses it: the name in ParaView's panel.
  std::string Name;
  /// Whether fewer points are the first ones of more: a bake in batches goes on where it was.
  bool Grows;
  std::vector<glm::dvec2> (*MakePoints)(int count, std::uint32_t seed, double aspect);

  /**
   * At least `count` points (> 0); the grids round up to full rows. `aspect` is how many times as
   * long as wide the square becomes on the light: the cells of grids become square there.
   */
  std::vector<glm::dvec2> Generate(int count, std::uint32_t seed, double aspect = 1.0) const
  {
    return this->MakePoints(count, seed, aspect);
  }
};

/// All patterns; the index is the value of the property SamplingPattern. The first is the default.
PENUMBRARENDERING_EXPORT const std::vector<SamplingPattern>& GetSamplingPatterns();

/**
 * The first two dimensions of Sobol's sequence (Sobol' 1967), scrambled as Owen (1995) proposed:
 * every bit is flipped by a hash of the bits before it. Strata of all aspects hold as many points
 * as they should, so the light's own does not matter.
 */
std::vector<glm::dvec2> GenerateSobol(int count, std::uint32_t seed, double aspect);

/// Kensler 2013, "Correlated Multi-Jittered Sampling": a jittered grid whose rows and columns are
/// stratified too. Rounded up to a full grid.
std::vector<glm::dvec2> GenerateCorrelatedMultiJittered(
  int count, std::uint32_t seed, double aspect);

/// One random point in every cell of a grid whose cells are as square as possible (H&H 1997, 3.7).
/// Rounded up.
std::vector<glm::dvec2> GenerateJitteredGrid(int count, std::uint32_t seed, double aspect);

/// The centres of the cells of such a grid. Rounded up. The seed changes nothing.
std::vector<glm::dvec2> GenerateUniformGrid(int count, std::uint32_t seed, double aspect);

/// Independent uniform points: the yardstick for the others.
std::vector<glm::dvec2> GenerateRandom(int count, std::uint32_t seed, double aspect);

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SamplingPattern.h"

#include "RandomHash.h"

namespace penumbra
{

std::vector<glm::dvec2> GenerateRandom(int count, std::uint32_t seed, double /*aspect*/)
{
  RandomStream random(seed);
  std::vector<glm::dvec2> points(static_cast<std::size_t>(count));
  for (glm::dvec2& point : points)
  {
    point.x = random.Next();
    point.y = random.Next();
  }
  return points;
}

} // namespace penumbra

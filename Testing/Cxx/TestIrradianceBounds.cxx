// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the planner takes for the most that a light may send is no less than what it sends.

#include "LargestDeviation.h"
#include "RandomPairs.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

// The largest ratio should be near 1: bounds that are far from what arrives would be of no use.
TEST(IrradianceBound, HoldsAnywhereOnTheReceiver)
{
  constexpr int Pairs = 3000, Points = 20;
  constexpr double Rounding = 1e-9;
  LargestDeviation largest;
  double tightest = 0.0;
  for (unsigned seed = 0; seed < Pairs; ++seed)
  {
    RandomGeometry random(seed);
    const RandomPair pair(random, seed % 2 == 0 ? RandomFrame : RandomNearFrame);
    const glm::dvec3 bound = pair.Seen->GetIrradianceBound(pair.Frame.GetBase());
    for (int i = 0; i < Points; ++i)
    {
      const double u = random.Between(0.0, 1.0), v = random.Between(0.0, 1.0);
      const glm::dvec3 light =
        pair.Seen->Irradiance(pair.Frame.ToWorld({ u, v, 0.0 }), pair.Frame.GetNormal());
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_LE(light[c], bound[c] * (1.0 + Rounding)) << seed;
        tightest = std::max(tightest, bound[c] > 0.0 ? light[c] / bound[c] : 0.0);
      }
    }
  }
  largest.Add(tightest);
  EXPECT_GT(tightest, 0.9);
}

} // namespace

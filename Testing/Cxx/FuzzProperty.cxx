// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzProperty.h"

#include "SeedOnCrash.h"
#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

namespace
{

constexpr const char* SeedVariable = "PENUMBRA_FUZZ_SEED";

std::string GetCommand(unsigned seed)
{
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::string(SeedVariable) + "=" + std::to_string(seed) +
    " bin/PenumbraFuzzTests --gtest_filter=" + test->test_suite_name() + "." + test->name();
}

void Report(
  const std::string& what, const FuzzedScene& scene, unsigned seed, const Property& property)
{
  const FuzzedScene small =
    Shrink(scene, [&](const FuzzedScene& s) { return !property(s, seed).Holds(); });
  const Deviation left = property(small, seed);
  ADD_FAILURE() << what << ": broken by seed " << seed << "\nTo repeat: " << GetCommand(seed)
                << "\nShrunk, with an error of " << left.Error << " and a bound of " << left.Bound
                << ":\n"
                << small;
}

} // namespace

bool Deviation::IsWorseThan(const Deviation& other) const
{
  if (this->Holds() != other.Holds())
  {
    return other.Holds();
  }
  // Without divisions: a bound may be 0.
  return this->Error * other.Bound > other.Error * this->Bound;
}

void ExpectProperty(const std::string& what, FuzzedKind kind, unsigned first, unsigned count,
  const Property& property)
{
  if (const char* seed = std::getenv(SeedVariable))
  {
    first = static_cast<unsigned>(std::strtoul(seed, nullptr, 10));
    count = 1;
  }
  Deviation worst;
  for (unsigned seed = first; seed < first + count && worst.Holds(); ++seed)
  {
    SeedOnCrash::Set(GetCommand(seed));
    const FuzzedScene scene = MakeFuzzedScene(seed, kind);
    const Deviation deviation = property(scene, seed);
    if (seed == first || deviation.IsWorseThan(worst))
    {
      worst = deviation;
    }
    if (!deviation.Holds())
    {
      Report(what, scene, seed, property);
    }
  }
  ExpectWithin(what + ", " + std::to_string(count) + " scenes", worst.Error, worst.Bound);
}

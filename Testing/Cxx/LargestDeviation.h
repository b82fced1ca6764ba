// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The largest of some deviations, kept with the test's results.
 */
#ifndef LargestDeviation_h
#define LargestDeviation_h

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

class LargestDeviation
{
public:
  LargestDeviation() = default;
  LargestDeviation(const LargestDeviation&) = delete;
  void operator=(const LargestDeviation&) = delete;
  ~LargestDeviation()
  {
    std::ostringstream text;
    text << this->Value;
    testing::Test::RecordProperty("LargestDeviation", text.str());
  }

  /// Adds a deviation of a value of some size; the answer is how large it is relative to that.
  double Add(long double deviation, long double size = 1.0L)
  {
    const auto relative = static_cast<double>(std::abs(deviation) / size);
    this->Value = std::max(this->Value, relative);
    return relative;
  }

private:
  double Value = 0.0;
};

#endif

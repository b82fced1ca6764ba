// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OracleTestTools.h
 * @brief What the tests of the oracle share: random numbers, and visibility by rays.
 */

#ifndef OracleTestTools_h
#define OracleTestTools_h

#include "ExactRadiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <vector>

namespace oracletest
{

inline const long double Pi = std::acos(-1.0L);

// Identities hold up to rounding. A form factor is a sum of under 1e3 edge terms of size below 1,
// each good to a few 1e-19 (long double), so 1e-15 of the unoccluded form factor leaves a margin.
constexpr long double Rounding = 1e-15L;

inline const oracle::Vec3 Origin = { 0, 0, 0 };
inline const oracle::Vec3 Up = { 0, 0, 1 };

using Occluders = std::vector<oracle::Triangle>;

class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {
  }

  long double Between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Engine);
  }

  oracle::Vec3 InBox(const oracle::Vec3& centre, double halfWidth)
  {
    const oracle::Vec3 offset = { this->Between(-halfWidth, halfWidth),
      this->Between(-halfWidth, halfWidth), this->Between(-halfWidth, halfWidth) };
    return centre + offset;
  }

  std::mt19937_64 Engine;
};

// The largest of some deviations, kept with the test's results.
class Largest
{
public:
  explicit Largest(const char* name)
    : Name(name)
  {
  }
  ~Largest()
  {
    std::ostringstream text;
    text << this->Value;
    testing::Test::RecordProperty(this->Name, text.str());
  }
  Largest(const Largest&) = delete;
  Largest& operator=(const Largest&) = delete;

  long double Add(long double deviation)
  {
    this->Value = std::max(this->Value, std::abs(deviation));
    return std::abs(deviation);
  }

private:
  const char* Name;
  long double Value = 0;
};

inline Occluders RandomTriangles(Random& random, int count)
{
  Occluders triangles;
  for (int i = 0; i < count; ++i)
  {
    const oracle::Vec3 centre = { random.Between(-0.6, 0.6), random.Between(-0.6, 0.6),
      random.Between(-0.2, 1.8) };
    triangles.push_back(
      { random.InBox(centre, 0.4), random.InBox(centre, 0.4), random.InBox(centre, 0.4) });
  }
  return triangles;
}

// Moeller and Trumbore 1997: whether the open segment from x to y passes through the triangle.
inline bool Blocks(const oracle::Triangle& triangle, const oracle::Vec3& x, const oracle::Vec3& y)
{
  const oracle::Vec3 edge1 = triangle.B - triangle.A;
  const oracle::Vec3 edge2 = triangle.C - triangle.A;
  const oracle::Vec3 direction = y - x;
  const oracle::Vec3 p = oracle::Cross(direction, edge2);
  const long double det = oracle::Dot(edge1, p);
  const oracle::Vec3 s = x - triangle.A;
  const oracle::Vec3 q = oracle::Cross(s, edge1);
  const long double u = oracle::Dot(s, p) / det;
  const long double v = oracle::Dot(direction, q) / det;
  const long double t = oracle::Dot(edge2, q) / det;
  return det != 0 && u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < 1;
}

// Whether any triangle blocks the open segment from x to y.
inline bool Blocks(const Occluders& occluders, const oracle::Vec3& x, const oracle::Vec3& y)
{
  return std::any_of(occluders.begin(), occluders.end(),
    [&](const oracle::Triangle& triangle) { return Blocks(triangle, x, y); });
}

// A square in the plane z = height around the axis, facing down.
inline oracle::Light Ceiling(long double halfWidth, long double height)
{
  oracle::Light light;
  light.Vertices = oracle::Parallelogram({ -halfWidth, -halfWidth, height },
    { -halfWidth, halfWidth, height }, { halfWidth, -halfWidth, height });
  return light;
}

// The square of Ceiling as two triangles.
inline Occluders Plate(long double halfWidth, long double height)
{
  const oracle::Polygon p = Ceiling(halfWidth, height).Vertices;
  return { { p[0], p[1], p[2] }, { p[0], p[2], p[3] } };
}

struct Estimate
{
  long double Mean, StandardError;
};

// Stratified quadrature over the unit square with two random points in each of n x n cells. The two
// are independent and alike, so (f - g)^2 / 4 is an unbiased estimate of the variance of their
// mean.
template <typename Function>
Estimate Quadrature(const Function& function, int n, Random& random)
{
  long double sum = 0;
  long double variance = 0;
  const auto sample = [&](int i, int j)
  { return function((i + random.Between(0, 1)) / n, (j + random.Between(0, 1)) / n); };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const long double f = sample(i, j);
      const long double g = sample(i, j);
      sum += (f + g) / 2;
      variance += (f - g) * (f - g) / 4;
    }
  }
  const long double cells = static_cast<long double>(n) * n;
  return { sum / cells, std::sqrt(variance) / cells };
}

} // namespace oracletest

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What ellipses send, where numbers are hard: small, far, near, low, thin and nearly round ones, by
// sums of positive terms in long double, limits, and the disk's own formulas. TestLightShapes has
// ellipses of everyday sizes.

#include "DiskLight.h"
#include "EllipseCone.h"
#include "ExactLights.h"
#include "LargestDeviation.h"
#include "OracleScene.h"
#include "RandomGeometry.h"

#include <glm/gtc/constants.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using penumbra::EllipseCone;

constexpr double Pi = glm::pi<double>();

// A hundred roundings of 1.1e-16.
constexpr double Rounding = 1.1e-14;

double Magnitude(RandomGeometry& random, double low, double high)
{
  return std::pow(10.0, random.Between(low, high));
}

/**
 * The form factor of an ellipse above the horizon: cos t cos t' / (pi r^2), added up over the
 * midpoints of rings and angles. For a periodic function and for these steps of the radius, by
 * Gauss and Legendre's rule of five nodes on eight pieces, the error falls faster than any power of
 * the number of steps where x is as far from the ellipse as that is wide; no term has another sign,
 * so that rounding is that of long double, relative to the sum.
 */
long double SumOverEllipse(const glm::dvec3& centre, double a, double b, const glm::dvec3& normal)
{
  constexpr std::array<long double, 5> nodes = { -0.906179845938663992798L,
    -0.538469310105683091036L, 0, 0.538469310105683091036L, 0.906179845938663992798L };
  constexpr std::array<long double, 5> weights = { 0.236926885056189087514L,
    0.478628670499366468041L, 0.568888888888888888889L, 0.478628670499366468041L,
    0.236926885056189087514L };
  constexpr int pieces = 8, angles = 128;
  const long double pi = std::acos(-1.0L);
  long double sum = 0;
  for (int i = 0; i < pieces * 5; ++i)
  {
    const auto node = static_cast<std::size_t>(i % 5);
    const long double radius = (2 * (i / 5) + 1 + nodes[node]) / (2 * pieces);
    for (int j = 0; j < angles; ++j)
    {
      const long double angle = 2 * pi * j / angles;
      const long double x = centre.x + a * radius * std::cos(angle);
      const long double y = centre.y + b * radius * std::sin(angle);
      const long double z = centre.z, squared = x * x + y * y + z * z;
      sum += weights[node] * radius * z * (normal.x * x + normal.y * y + normal.z * z) /
        (squared * squared);
    }
  }
  return sum * a * b / (pieces * angles);
}

// The unit normal of a receiver that has the whole ellipse in front of it.
glm::dvec3 RandomNormalBelow(const glm::dvec3& centre, double a, double b, RandomGeometry& random)
{
  for (;;)
  {
    const glm::dvec3 n = random.Direction();
    if (glm::dot(n, centre) > std::hypot(a * n.x, b * n.y))
    {
      return n;
    }
  }
}

} // namespace

// As far away as wide and up to 1e8 times as far, as thin as 1e-8, and of all sizes: as many digits
// as there are.
TEST(EllipseCone, LosesNothingWhereItIsFarAndThin)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < 300; ++seed)
  {
    RandomGeometry random(seed);
    const double size = Magnitude(random, -30.0, 30.0);
    const double a = size * Magnitude(random, -8.0, 0.0), b = a * Magnitude(random, -8.0, 0.0);
    glm::dvec3 centre = 2.0 * size * random.Direction();
    centre.z = std::abs(centre.z);
    const glm::dvec3 normal = RandomNormalBelow(centre, a, b, random);
    const bool isTurned = seed % 2 == 0; // the longer axis is the second one
    const double actual = isTurned ? EllipseCone({ centre.y, centre.x, centre.z }, b, a)
                                       .GetFormFactor({ normal.y, normal.x, normal.z })
                                   : EllipseCone(centre, a, b).GetFormFactor(normal);
    const auto exact = static_cast<double>(SumOverEllipse(centre, a, b, normal));
    // The cosine of a place that nearly lies in the receiver's plane has fewer digits.
    const double cosine = glm::dot(normal, centre) / glm::length(centre);
    EXPECT_LE(largest.Add(actual - exact, exact / cosine), Rounding) << "seed " << seed;
  }
}

// Where the ellipse is a circle, all is as of a disk, whole and cut. The disk's own formula for
// what the horizon cuts loses the square of the radius over the height: that is 1000 at most, so
// 1e6 roundings; the oracle judges what is lower (below).
TEST(EllipseCone, OfACircleIsADisks)
{
  LargestDeviation largest;
  int cut = 0;
  for (unsigned seed = 0; seed < 20000; ++seed)
  {
    RandomGeometry random(seed);
    const glm::dvec3 up(0.0, 0.0, 1.0), normal = random.Direction();
    const double radius = Magnitude(random, -3.0, 3.0);
    glm::dvec3 centre = random.InBox(2.0);
    centre.z = std::max(radius, 1.0) * Magnitude(random, -3.0, 1.0);
    const penumbra::DiskLight disk(centre, -up, radius);
    const double wanted = disk.FormFactor(glm::dvec3(0.0), normal);
    const bool isWhole = glm::dot(normal, centre) >= radius * std::hypot(normal.x, normal.y);
    const EllipseCone cone(centre, radius, radius);
    const double actual =
      isWhole ? cone.GetFormFactor(normal) : cone.GetFormFactorAboveHorizon(normal);
    cut += !isWhole && wanted > 0.0;
    EXPECT_LE(largest.Add(actual - wanted), 1.1e-10) << "seed " << seed;
  }
  EXPECT_GE(cut, 1000);
}

namespace
{

// An ellipse as seen from the origin, which is beside it or below: up to a million times as long as
// wide and from a millionth to a billion times as wide as far.
struct Ellipse
{
  explicit Ellipse(RandomGeometry& random)
    : A(Magnitude(random, -6.0, 3.0))
    , B(this->A * Magnitude(random, -6.0, 0.0))
    , Centre(random.InBox(2.0))
  {
    this->Centre.z = Magnitude(random, -6.0, 1.0);
  }
  double A, B;
  glm::dvec3 Centre;
};

} // namespace

// The oracle's own rounding is 5e-20 of a contour as long as the light is wide: 5e-14 of the light
// at most, where that is thinnest.
TEST(EllipseCone, IsTheOracles)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < 5000; ++seed)
  {
    RandomGeometry random(seed);
    const Ellipse ellipse(random);
    const glm::dvec3 normal = random.Direction();
    const oracle::Ellipse light = { ToOracle(ellipse.Centre), { 0, ellipse.B, 0 },
      { ellipse.A, 0, 0 } };
    const long double exact = oracle::VisibleFormFactor({ 0, 0, 0 }, ToOracle(normal), light, {});
    const double actual =
      EllipseCone(ellipse.Centre, ellipse.A, ellipse.B).GetFormFactorAboveHorizon(normal);
    EXPECT_LE(largest.Add(actual - exact), Rounding) << "seed " << seed;
  }
}

// What is above the horizon, less what is below it, is the vector form factor's part along the
// normal.
TEST(EllipseCone, HalvesAddUp)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < 20000; ++seed)
  {
    RandomGeometry random(seed);
    const auto [a, b, centre] = Ellipse(random);
    const glm::dvec3 normal = random.Direction();
    const EllipseCone cone(centre, a, b);
    const double above = cone.GetFormFactorAboveHorizon(normal);
    const double below = cone.GetFormFactorAboveHorizon(-normal);
    EXPECT_GE(above, -Rounding) << "seed " << seed;
    EXPECT_LE(above, 1.0 + Rounding) << "seed " << seed;
    const double excess = above - below - cone.GetFormFactor(normal);
    EXPECT_LE(largest.Add(excess), Rounding) << "seed " << seed;
  }
}

// An endless ellipse that faces the place fills half of the sky and of the place's cosine lobe
// (1 + cosine) / 2; from just below an ellipse it is as endless.
TEST(EllipseCone, FillsTheSkyFromNearby)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    RandomGeometry random(seed);
    const glm::dvec3 normal = random.Direction();
    const double wanted = 0.5 * (1.0 + normal.z);
    for (const double height : { 1e-3, 1e-9, 1e-15, 1e-200, 1e-310 })
    {
      // What is beyond the ellipse, 1e-2 away at least, is that high: up to height / 1e-2 of all.
      const glm::dvec3 centre(random.Between(-0.9, 0.9), random.Between(-0.03, 0.03), height);
      EXPECT_NEAR(EllipseCone(centre, 1.0, 0.1).GetFormFactorAboveHorizon(normal), wanted,
        100.0 * height + Rounding)
        << "seed " << seed << ", height " << height;
    }
  }
}

// A place in the ellipse's plane beside it sees nothing; nearly there, as much as its height is.
TEST(EllipseCone, FadesTowardsItsPlane)
{
  const glm::dvec3 normal(0.6, 0.0, 0.8);
  const double slope = EllipseCone({ 3.0, 0.5, 1e-6 }, 1.0, 1e-3).GetFormFactor(normal) / 1e-6;
  for (const double height : { 1e-9, 1e-15, 1e-30 })
  {
    const double actual = EllipseCone({ 3.0, 0.5, height }, 1.0, 1e-3).GetFormFactor(normal);
    EXPECT_NEAR(actual / height / slope, 1.0, 1e-5) << "height " << height;
  }
}

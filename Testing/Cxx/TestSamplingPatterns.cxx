// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sampling patterns, by the strata that define them and by how evenly they and their halves
// cover the square.

#include "SamplingPattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace
{

using penumbra::GetSamplingPatterns;
using penumbra::SamplingPattern;
using Points = std::vector<glm::dvec2>;

const std::vector<int> Counts{ 1, 2, 3, 4, 5, 7, 8, 11, 13, 16, 17, 31, 32, 64, 97, 100, 127, 128,
  251, 256, 257, 1000, 1024 };
const std::vector<std::uint32_t> Seeds{ 0u, 1u, 2u, 12345u, 0xffffffffu };

Points Generate(const std::string& name, int count, std::uint32_t seed)
{
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    if (pattern.Name == name)
    {
      return pattern.Generate(count, seed);
    }
  }
  ADD_FAILURE() << "no pattern has the name " << name;
  return {};
}

// The halves as SamplingPattern defines them: the first has one more, if the number is odd.
std::vector<Points> HalvesOf(const Points& points)
{
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>((points.size() + 1) / 2);
  return { Points(points.begin(), middle), Points(middle, points.end()) };
}

// Whether each of the columns x rows cells of the square holds exactly one of the points.
bool HasOneInEachCell(const Points& points, std::size_t columns, std::size_t rows)
{
  std::vector<int> held(columns * rows, 0);
  for (const glm::dvec2& p : points)
  {
    const auto i = static_cast<std::size_t>(p.x * static_cast<double>(columns));
    const auto j = static_cast<std::size_t>(p.y * static_cast<double>(rows));
    ++held[i + j * columns];
  }
  return std::all_of(held.begin(), held.end(), [](int n) { return n == 1; });
}

// A (0, k, 2)-net: 2^k points, of which every elementary interval of area 2^-k holds one, from the
// widest to the tallest (Niederreiter 1992, definition 4.1).
bool IsNet(const Points& points)
{
  for (std::size_t columns = 1; columns <= points.size(); columns *= 2)
  {
    if (!HasOneInEachCell(points, columns, points.size() / columns))
    {
      return false;
    }
  }
  return true;
}

// The star discrepancy: the largest error of the share of points in [0, x) x [0, y) as its area.
// It is attained at a box whose sides pass by points, with or without them (Niederreiter 1972).
double StarDiscrepancy(const Points& points)
{
  std::vector<double> xs{ 1.0 }, ys{ 1.0 };
  for (const glm::dvec2& p : points)
  {
    xs.push_back(p.x);
    ys.push_back(p.y);
  }
  double worst = 0.0;
  for (const double x : xs)
  {
    for (const double y : ys)
    {
      int open = 0, closed = 0;
      for (const glm::dvec2& p : points)
      {
        open += p.x < x && p.y < y ? 1 : 0;
        closed += p.x <= x && p.y <= y ? 1 : 0;
      }
      const auto n = static_cast<double>(points.size());
      worst = std::max({ worst, x * y - open / n, closed / n - x * y });
    }
  }
  return worst;
}

// Of the grids with that many cells, the one nearest to a square.
glm::ivec2 GridOf(std::size_t count)
{
  const auto n = static_cast<int>(count);
  int columns = static_cast<int>(std::sqrt(static_cast<double>(n)));
  while (n % columns != 0)
  {
    --columns;
  }
  return { columns, n / columns };
}

bool IsOnePerCell(const Points& points)
{
  const glm::ivec2 grid = GridOf(points.size());
  const auto a = static_cast<std::size_t>(grid.x);
  const auto b = static_cast<std::size_t>(grid.y);
  return HasOneInEachCell(points, a, b) || HasOneInEachCell(points, b, a);
}

TEST(SamplingPatterns, HaveTheContractsNamesInItsOrder)
{
  std::vector<std::string> names;
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    names.push_back(pattern.Name);
  }
  EXPECT_EQ(names,
    (std::vector<std::string>{
      "Sobol", "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid", "Random" }));
}

TEST(SamplingPatterns, HaveAtLeastAsManyPointsAsAskedForInTheSquare)
{
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    for (const int count : Counts)
    {
      for (const std::uint32_t seed : Seeds)
      {
        const Points points = pattern.Generate(count, seed);
        EXPECT_GE(points.size(), static_cast<std::size_t>(count)) << pattern.Name;
        for (const glm::dvec2& p : points)
        {
          EXPECT_TRUE(p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0)
            << pattern.Name << " " << p.x << " " << p.y;
        }
      }
    }
  }
}

// The grids round up to full rows: by less than a row, whose length is the number's root, rounded
// to an integer, and so no more than 1.5 times the root. The others need not round.
TEST(SamplingPatterns, HaveNotManyMorePointsThanAskedFor)
{
  for (int count = 1; count <= 2000; ++count)
  {
    EXPECT_EQ(Generate("Sobol", count, 1).size(), static_cast<std::size_t>(count));
    EXPECT_EQ(Generate("Random", count, 1).size(), static_cast<std::size_t>(count));
    for (const char* name : { "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid" })
    {
      const auto size = static_cast<double>(Generate(name, count, 1).size());
      EXPECT_LT(size, count + 1.5 * std::sqrt(count)) << name << " " << count;
    }
  }
}

TEST(SamplingPatterns, AreRepeatable)
{
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    for (const std::uint32_t seed : Seeds)
    {
      EXPECT_EQ(pattern.Generate(97, seed), pattern.Generate(97, seed)) << pattern.Name;
    }
  }
}

// Without a point in common: 32 random bits agree by chance in one of 4e9.
TEST(SamplingPatterns, DifferFromSeedToSeed)
{
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    const bool isRandom = pattern.Name != "Uniform Grid";
    for (std::uint32_t seed = 0; seed < 50; ++seed)
    {
      const Points a = pattern.Generate(16, seed);
      const Points b = pattern.Generate(16, seed + 1);
      for (const glm::dvec2& p : a)
      {
        EXPECT_EQ(std::find(b.begin(), b.end(), p) == b.end(), isRandom) << pattern.Name;
      }
    }
  }
}

TEST(SamplingPatterns, HaveNoPointTwice)
{
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    Points points = pattern.Generate(4096, 3);
    const auto isLess = [](const glm::dvec2& a, const glm::dvec2& b)
    { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    std::sort(points.begin(), points.end(), isLess);
    EXPECT_EQ(std::adjacent_find(points.begin(), points.end()), points.end()) << pattern.Name;
  }
}

// Over the seeds, the mean of what a pattern says of an area is the area: within five standard
// errors of that mean, which chance passes but once in two million.
TEST(SamplingPatterns, AreUnbiased)
{
  constexpr int seeds = 2000;
  const double area = 0.5 * 0.7 * 0.7;
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    if (pattern.Name == "Uniform Grid")
    {
      continue; // has no chance in it
    }
    for (const int count : { 1, 9, 16 })
    {
      double sum = 0.0, squares = 0.0;
      for (std::uint32_t seed = 0; seed < seeds; ++seed)
      {
        const Points points = pattern.Generate(count, seed);
        const auto inside = std::count_if(
          points.begin(), points.end(), [](const glm::dvec2& p) { return p.x + p.y < 0.7; });
        const double share = static_cast<double>(inside) / static_cast<double>(points.size());
        sum += share;
        squares += share * share;
      }
      const double mean = sum / seeds;
      const double error = std::sqrt((squares / seeds - mean * mean) / seeds);
      EXPECT_NEAR(mean, area, 5.0 * error) << pattern.Name << " " << count;
    }
  }
}

TEST(SobolPattern, PowerOfTwoPrefixesAreNets)
{
  for (const std::uint32_t seed : Seeds)
  {
    const Points points = Generate("Sobol", 16384, seed);
    for (std::size_t size = 1; size <= points.size(); size *= 2)
    {
      const Points prefix(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_TRUE(IsNet(prefix)) << size << " points, seed " << seed;
    }
  }
}

TEST(SobolPattern, HalvesOfPowersOfTwoAreNets)
{
  for (const std::uint32_t seed : Seeds)
  {
    for (int count = 2; count <= 16384; count *= 2)
    {
      for (const Points& half : HalvesOf(Generate("Sobol", count, seed)))
      {
        EXPECT_TRUE(IsNet(half)) << count << " points, seed " << seed;
      }
    }
  }
}

// A sequence: more points do not move those that are there.
TEST(SobolPattern, GrowsByAddingPoints)
{
  const Points many = Generate("Sobol", 1000, 7);
  for (const int count : Counts)
  {
    const Points few = Generate("Sobol", std::min(count, 1000), 7);
    EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin())) << count;
  }
}

// Owen's scramble flips every bit of a coordinate on its own: over the seeds each is set for half
// of them, within five standard deviations.
TEST(SobolPattern, ScramblesEveryBit)
{
  constexpr int seeds = 4000;
  constexpr int bits = 32;
  for (const std::size_t index : { 0u, 5u })
  {
    for (int axis = 0; axis < 2; ++axis)
    {
      std::vector<int> set(bits, 0);
      for (std::uint32_t seed = 0; seed < seeds; ++seed)
      {
        const double x = Generate("Sobol", 8, seed)[index][axis];
        const auto word = static_cast<std::uint32_t>(std::ldexp(x, bits));
        for (int bit = 0; bit < bits; ++bit)
        {
          set[static_cast<std::size_t>(bit)] += (word >> bit) & 1u;
        }
      }
      for (const int n : set)
      {
        EXPECT_NEAR(n, seeds / 2, 5.0 * std::sqrt(0.25 * seeds));
      }
    }
  }
}

TEST(GridPatterns, HaveOnePointInEachCell)
{
  for (const char* name : { "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid" })
  {
    for (const int root : { 1, 2, 3, 8, 11, 16, 32, 100 })
    {
      for (const std::uint32_t seed : Seeds)
      {
        const Points points = Generate(name, root * root, seed);
        EXPECT_EQ(points.size(), static_cast<std::size_t>(root * root)) << name;
        EXPECT_TRUE(IsOnePerCell(points)) << name << " " << root;
      }
    }
  }
}

// What is asked for between two squares gets a grid with a row more, or a column.
TEST(GridPatterns, HaveOnePointInEachCellOfOblongGrids)
{
  for (const char* name : { "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid" })
  {
    for (int root = 2; root < 20; ++root)
    {
      const Points points = Generate(name, root * (root + 1), 5);
      EXPECT_EQ(points.size(), static_cast<std::size_t>(root * (root + 1))) << name;
      EXPECT_TRUE(IsOnePerCell(points)) << name << " " << root;
    }
  }
}

// Primes have no grid of their own; some grid near a square must hold the pattern all the same.
TEST(GridPatterns, HaveOnePointInEachCellForPrimes)
{
  for (const char* name : { "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid" })
  {
    for (const int prime : { 2, 3, 5, 7, 13, 31, 97, 127, 251, 257, 1009 })
    {
      const Points points = Generate(name, prime, 5);
      bool isOnePerCell = false;
      for (std::size_t columns = 1; columns <= points.size(); ++columns)
      {
        const std::size_t rows = points.size() / columns;
        const bool isNearASquare = columns <= 2 * rows && rows <= 2 * columns;
        isOnePerCell = isOnePerCell ||
          (columns * rows == points.size() && isNearASquare &&
            HasOneInEachCell(points, columns, rows));
      }
      EXPECT_TRUE(isOnePerCell) << name << " " << prime;
    }
  }
}

TEST(GridPatterns, UniformGridHasTheCentres)
{
  const Points points = Generate("Uniform Grid", 16, 0);
  std::set<double> xs, ys;
  for (const glm::dvec2& p : points)
  {
    xs.insert(p.x);
    ys.insert(p.y);
  }
  const std::set<double> centres{ 0.125, 0.375, 0.625, 0.875 };
  EXPECT_EQ(xs, centres);
  EXPECT_EQ(ys, centres);
}

// Of n points, one in each of n columns and one in each of n rows: what Kensler's pattern adds to
// the jittered grid.
TEST(GridPatterns, CorrelatedMultiJitteredStratifiesRowsAndColumns)
{
  for (const int count : Counts)
  {
    for (const std::uint32_t seed : Seeds)
    {
      const Points points = Generate("Correlated Multi-Jittered", count, seed);
      EXPECT_TRUE(HasOneInEachCell(points, points.size(), 1)) << count << " seed " << seed;
      EXPECT_TRUE(HasOneInEachCell(points, 1, points.size())) << count << " seed " << seed;
    }
  }
}

// The star discrepancy times n of an aligned block of 2^k points of a (0, 2)-sequence is at most
// k + 1: a box [0, x) x [0, y) falls into at most k strips whose widths are different powers of two
// down to 2^-k, and a rest that is narrower; in each the net is wrong by at most one point. Any
// stretch of the sequence is made of aligned blocks, whose errors add up.
double SobolBound(std::size_t begin, std::size_t end)
{
  double errors = 0.0;
  for (std::size_t at = begin; at < end;)
  {
    std::size_t block = 1;
    double k = 0.0;
    while (at % (2 * block) == 0 && at + 2 * block <= end)
    {
      block *= 2;
      k += 1.0;
    }
    errors += k + 1.0;
    at += block;
  }
  return errors / static_cast<double>(end - begin);
}

// Odd and prime numbers, too, leave both halves of the sequence spread over the square.
TEST(HalvesOfPatterns, OfSobolCoverTheSquare)
{
  for (const int count : { 2, 3, 17, 31, 64, 97, 127, 128, 251, 256, 257 })
  {
    const Points points = Generate("Sobol", count, 11);
    const std::vector<Points> halves = HalvesOf(points);
    const std::size_t middle = halves[0].size();
    EXPECT_LE(StarDiscrepancy(points), SobolBound(0, points.size())) << count;
    EXPECT_LE(StarDiscrepancy(halves[0]), SobolBound(0, middle)) << count;
    EXPECT_LE(StarDiscrepancy(halves[1]), SobolBound(middle, points.size())) << count;
  }
}

// Half of a grid of c x r cells, its points in every second cell as on a chessboard: of the cells
// that lie within a box [0, x) x [0, y) half are taken, up to half a cell, and half of all are, up
// to half a cell; and its upper and right side cut at most c + r - 1 cells, half of which are
// taken, up to one. So the error is at most (c + r) / 2 + 2 points. A half in the order of the
// rows, which leaves half of the square empty, has a discrepancy of a half and more.
TEST(HalvesOfPatterns, OfGridsCoverTheSquare)
{
  for (const char* name : { "Correlated Multi-Jittered", "Jittered Grid", "Uniform Grid" })
  {
    for (const int count : { 64, 81, 97, 127, 128, 251, 256, 257 })
    {
      // As near to a square as they are, the sides sum up to no more than this.
      const double sides = 2.0 * std::sqrt(count) + 3.0;
      for (const Points& half : HalvesOf(Generate(name, count, 11)))
      {
        const double bound = (0.5 * sides + 2.0) / static_cast<double>(half.size());
        ASSERT_LT(bound, 0.5);
        EXPECT_LE(StarDiscrepancy(half), bound) << name << " " << count;
      }
    }
  }
}

// Of a smooth function that sees both axes, the error of each half over the seeds is well below
// that of as many independent points: a cell of width w is wrong by w / sqrt(12) of the slope where
// a random point is wrong by the function's own deviation, 1 / sqrt(12) of it. In 256 cells that is
// a factor of 16, of which this asks 2.
TEST(HalvesOfPatterns, IntegrateBetterThanChance)
{
  constexpr int seeds = 200;
  const auto f = [](const glm::dvec2& p) { return (p.x - 0.5) * (p.y - 0.5) + p.x; };
  const double deviation = std::sqrt(1.0 / 144.0 + 1.0 / 12.0); // of f, over the square
  for (const SamplingPattern& pattern : GetSamplingPatterns())
  {
    for (std::size_t half = 0; half < 2 && pattern.Name != "Random"; ++half)
    {
      double squares = 0.0;
      std::size_t size = 0;
      for (std::uint32_t seed = 0; seed < seeds; ++seed)
      {
        const Points points = HalvesOf(pattern.Generate(256, seed))[half];
        size = points.size();
        double sum = 0.0;
        for (const glm::dvec2& p : points)
        {
          sum += f(p);
        }
        const double error = sum / static_cast<double>(size) - 0.5;
        squares += error * error;
      }
      const double chance = deviation / std::sqrt(static_cast<double>(size));
      EXPECT_LT(std::sqrt(squares / seeds), 0.5 * chance) << pattern.Name << " half " << half;
    }
  }
}

} // namespace

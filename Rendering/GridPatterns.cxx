// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SamplingPattern.h"

#include "RandomHash.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra
{
namespace
{

/// The grid with the fewest cells, at least `count`, among those whose cells are as square as
/// possible on a light of that aspect.
glm::ivec2 GridSize(int count, double aspect)
{
  const int columns =
    static_cast<int>(std::lround(std::clamp(std::sqrt(count * aspect), 1.0, double(count))));
  return { columns, (count + columns - 1) / columns };
}

/// The point that place(i, j) gives for every cell of the grid, the white fields of the chessboard
/// first and the black ones after them: each half is spread over the whole square.
template <typename Place>
std::vector<glm::dvec2> PlaceInCells(const glm::ivec2& size, Place place)
{
  std::vector<glm::dvec2> white, black;
  for (int j = 0; j < size.y; ++j)
  {
    for (int i = 0; i < size.x; ++i)
    {
      ((i + j) % 2 == 0 ? white : black).push_back(place(i, j));
    }
  }
  white.insert(white.end(), black.begin(), black.end());
  return white;
}

/// Fisher and Yates' shuffle of 0 ... count - 1.
std::vector<int> Permutation(int count, RandomStream& random)
{
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
  {
    std::swap(
      order[i - 1], order[static_cast<std::size_t>(random.Next() * static_cast<double>(i))]);
  }
  return order;
}

} // namespace

std::vector<glm::dvec2> GenerateUniformGrid(int count, std::uint32_t /*seed*/, double aspect)
{
  const glm::ivec2 size = GridSize(count, aspect);
  return PlaceInCells(
    size, [&](int i, int j) { return glm::dvec2((i + 0.5) / size.x, (j + 0.5) / size.y); });
}

std::vector<glm::dvec2> GenerateJitteredGrid(int count, std::uint32_t seed, double aspect)
{
  const glm::ivec2 size = GridSize(count, aspect);
  RandomStream random(seed);
  return PlaceInCells(size,
    [&](int i, int j)
    {
      const double x = (i + random.Next()) / size.x;
      const double y = (j + random.Next()) / size.y;
      return glm::dvec2(x, y);
    });
}

std::vector<glm::dvec2> GenerateCorrelatedMultiJittered(
  int count, std::uint32_t seed, double aspect)
{
  // Cell (i, j) is split into a column for each j and a row for each i; the same shuffles serve all
  // columns and all rows, which is what "correlated" means.
  const glm::ivec2 size = GridSize(count, aspect);
  RandomStream random(seed);
  const std::vector<int> column = Permutation(size.y, random);
  const std::vector<int> row = Permutation(size.x, random);
  return PlaceInCells(size,
    [&](int i, int j)
    {
      const double x =
        (i + (column[static_cast<std::size_t>(j)] + random.Next()) / size.y) / size.x;
      const double y = (j + (row[static_cast<std::size_t>(i)] + random.Next()) / size.x) / size.y;
      return glm::dvec2(x, y);
    });
}

} // namespace penumbra

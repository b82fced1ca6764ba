// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Which receivers of a surface are near a point of it.
 */
#ifndef ReceiverGrid_h
#define ReceiverGrid_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "Vectors.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra
{

/**
 * Nested grids over the box around the receivers of a surface: a shader finds the receivers near a
 * point in a few reads, however many there are.
 *
 * A grid divides its cell into 4 x 4 x 4 smaller ones. Each of these either has a grid of its own,
 * or names the receivers that touch it, at least one. Cells of more than three receivers are
 * divided as long as that separates them; cells of two or three are, too, those with the largest
 * area first, as far as the size of the table allows. So most of a surface lies in cells of one
 * receiver.
 *
 * The table is an array of texels, of four floats each; indices are exact in floats up to 2^24.
 * First come the cells of the outermost grid, x fastest.
 * - A cell with a grid: (index of the grid's first cell, -, -, 0).
 * - Another one: (receiver, index of where the next receivers are, -, their number), the number
 * with the first one.
 * - A further receiver of a cell: (receiver, -, -, -).
 */
class PENUMBRARENDERING_EXPORT ReceiverGrid
{
public:
  /// How many cells a grid has along each axis, and how deep grids are nested at most: floats have
  /// no digits for more.
  static constexpr int Side = 4;
  static constexpr int MaximumDepth = 9;

  /// A receiver as a convex polygon in the world.
  using Polygon = std::vector<glm::dvec3>;

  /// Without polygons, the grid is not valid.
  ReceiverGrid() = default;

  /**
   * Makes the grid. A polygon without corners stands for a receiver that may be near any point.
   *
   * @param polygons the receivers; cells name them in this order
   * @param thickness how far points of the surface may be off their receivers, besides 1e-5 of the
   * box, which allows for single precision
   */
  explicit ReceiverGrid(const std::vector<Polygon>& polygons, double thickness = 0.0);

  /// The box: a point's place in the outermost grid is (x - low) / size, 0 to 1.
  const glm::dvec3& GetLow() const { return this->Low; }
  const glm::dvec3& GetSize() const { return this->Size; }

  const std::vector<glm::vec4>& GetTable() const { return this->Table; }

  /// The receivers near a point, as the shader finds them. Points outside the box count as points
  /// of its border.
  struct Answer
  {
    std::vector<std::size_t> Receivers;
    int Reads = 0; ///< of texels of the table
  };
  Answer Find(const glm::dvec3& point) const;

private:
  struct Piece;
  struct Cell;
  class Builder;

  glm::dvec3 Low{ 0.0 };
  glm::dvec3 Size{ 1.0 };
  std::vector<glm::vec4> Table;
};

} // namespace penumbra

#endif

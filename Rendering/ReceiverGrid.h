// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Which receivers of a surface are near a point of it.
 */
#ifndef ReceiverGrid_h
#define ReceiverGrid_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "Vectors.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra
{

/**
 * Nested grids over the box around the receivers of a surface: a shader finds the receivers near a
 * point in a few reads, however many there are.
 *
 * The outermost grid has a few cells for each receiver, as cubic as they can be. A cell names the
 * receivers that touch it, at least one, or has a grid of its own, of 4 x 4 x 4 cells. Cells of
 * more than three receivers are divided as long as that separates them; cells of two or three are,
 * too, those with the largest area first, as far as the size of the table allows. So most of a
 * surface lies in cells of one receiver.
 *
 * The table is an array of words. First come the cells of the outermost grid, x fastest. A word is
 * - a receiver: Receiver + its index, + MoreFollow if the next word is a further one of the cell;
 * - the place in the table where a cell's several receivers are: List + the place;
 * - the place in the table of the first cell of a grid.
 */
class PENUMBRARENDERING_EXPORT ReceiverGrid
{
public:
  /// How many cells an inner grid has along each axis, and how deep grids are nested at most:
  /// floats have no digits for more.
  static constexpr int Side = 4;
  static constexpr int MaximumDepth = 9;

  static constexpr std::uint32_t List = 0x40000000u;
  static constexpr std::uint32_t Receiver = 0x80000000u;
  static constexpr std::uint32_t MoreFollow = 0x40000000u;

  /// A receiver as a convex polygon in the world.
  using Polygon = std::vector<glm::dvec3>;

  /// Without receivers.
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
  /// How many cells the outermost grid has along each axis.
  const glm::ivec3& GetCells() const { return this->Cells; }

  const std::vector<std::uint32_t>& GetTable() const { return this->Table; }

  /// The receivers near a point, as the shader finds them. Points outside the box count as points
  /// of its border.
  struct Answer
  {
    std::vector<std::size_t> Receivers;
    int Reads = 0; ///< of words
  };
  Answer Find(const glm::dvec3& point) const;

private:
  struct Piece;
  struct Cell;
  class Builder;

  glm::dvec3 Low{ 0.0 };
  glm::dvec3 Size{ 1.0 };
  glm::ivec3 Cells{ 1 };
  std::vector<std::uint32_t> Table;
};

} // namespace penumbra

#endif

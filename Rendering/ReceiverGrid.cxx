// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReceiverGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace penumbra
{
namespace
{

/// What a shader's single precision may be off, as a share of the box: a few roundings of numbers
/// as large as the box.
constexpr double SinglePrecision = 1e-5;

/// Cells of more receivers are divided before all others.
constexpr std::size_t FewReceivers = 3;

/// A division must bring the mean number of receivers, by area, down to this share.
constexpr double WorthDividing = 0.75;

/// About how many cells the outermost grid has for each receiver, and how many at most, which keeps
/// its side below 2^10. Measured for 2 400 walls and roofs: eight have a third more reads, 128 save
/// a quarter of them and no time.
constexpr double CellsPerReceiver = 32.0;
constexpr double MostCells = 1 << 20;

/// The most words of all grids: some inner ones for each receiver; 64 MiB.
constexpr std::size_t WordsPerReceiver = 64;
constexpr std::size_t WordsAtMost = 1 << 24;

using Polygon = ReceiverGrid::Polygon;

/// The part of a convex polygon where `sign` times the coordinate is at most `limit`.
Polygon ClipToHalfSpace(const Polygon& polygon, int axis, double sign, double limit)
{
  Polygon clipped;
  clipped.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const glm::dvec3& from = polygon[i];
    const glm::dvec3& to = polygon[(i + 1) % polygon.size()];
    const double beyondFrom = sign * from[axis] - limit;
    const double beyondTo = sign * to[axis] - limit;
    if (beyondFrom <= 0.0)
    {
      clipped.push_back(from);
    }
    if ((beyondFrom <= 0.0) != (beyondTo <= 0.0))
    {
      clipped.push_back(from + (to - from) * (beyondFrom / (beyondFrom - beyondTo)));
    }
  }
  return clipped;
}

/// The smallest and the largest of a coordinate.
glm::dvec2 FindExtent(const Polygon& polygon, int axis)
{
  glm::dvec2 extent(std::numeric_limits<double>::infinity());
  extent.y = -extent.x;
  for (const glm::dvec3& corner : polygon)
  {
    extent.x = std::min(extent.x, corner[axis]);
    extent.y = std::max(extent.y, corner[axis]);
  }
  return extent;
}

double GetArea(const Polygon& polygon, const glm::dvec3& scale)
{
  glm::dvec3 area(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    area += glm::cross(
      scale * (polygon[i - 1] - polygon.front()), scale * (polygon[i] - polygon.front()));
  }
  return 0.5 * glm::length(area);
}

/// Whether two polygons have the same corners, but for rounding, in coordinates of the box.
bool IsSameShape(const Polygon& a, const Polygon& b)
{
  constexpr double Rounding = 1e-12;
  return a.size() == b.size() &&
    std::all_of(a.begin(), a.end(),
      [&](const glm::dvec3& p)
      {
        return std::any_of(b.begin(), b.end(),
          [&](const glm::dvec3& q)
          { return glm::all(glm::lessThanEqual(glm::abs(p - q), glm::dvec3(Rounding))); });
      });
}

/// The number of cells along each axis of a box: about so many in all, as cubic as they can be.
glm::ivec3 ChooseCells(const glm::dvec3& size, double count)
{
  glm::ivec3 cells(1);
  // Along what is shorter than a cell there is one; the others share all of them.
  std::array<int, 3> axes = { 0, 1, 2 };
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] < size[b]; });
  for (int i = 0; i < 3; ++i)
  {
    const int axis = axes[static_cast<std::size_t>(i)];
    double volume = 1.0; // in cubes of this axis' length
    for (int k = i; k < 3; ++k)
    {
      volume *= size[axes[static_cast<std::size_t>(k)]] / size[axis];
    }
    cells[axis] = std::max(1, static_cast<int>(std::pow(count / volume, 1.0 / (3 - i))));
    count /= cells[axis];
  }
  return cells;
}

} // namespace

/// What of a receiver is in a cell, in coordinates of the box.
struct ReceiverGrid::Piece
{
  std::size_t Receiver = 0;
  bool IsEverywhere = false;
  Polygon Shape;
  double Area = 0.0; ///< in the world
};

/// A cell that has no grid so far.
struct ReceiverGrid::Cell
{
  std::size_t Index = 0; ///< in the table
  int Depth = 0;
  glm::dvec3 Low{ 0.0 };
  glm::dvec3 Size{ 1.0 };
  std::vector<Piece> Pieces;
  double Area = 0.0; ///< of all pieces

  /// Not if all that is in the cell is the same place: a receiver, and a window of finer texels.
  bool MayBeSeparated() const
  {
    const Piece& first = this->Pieces.front();
    return !std::all_of(this->Pieces.begin() + 1, this->Pieces.end(),
      [&](const Piece& piece) {
        return piece.IsEverywhere == first.IsEverywhere && IsSameShape(piece.Shape, first.Shape);
      });
  }
  bool HasMany() const { return this->Pieces.size() > FewReceivers; }
  /// The more, the earlier it is divided.
  double GetWeight() const { return this->Area * (static_cast<double>(this->Pieces.size()) - 1.0); }
  bool operator<(const Cell& other) const
  {
    return this->HasMany() != other.HasMany() ? other.HasMany()
                                              : this->GetWeight() < other.GetWeight();
  }
};

class ReceiverGrid::Builder
{
public:
  Builder(ReceiverGrid& grid, const glm::dvec3& margin, std::size_t maximumWords)
    : Grid(grid)
    , Margin(margin)
    , MaximumWords(maximumWords)
  {
  }

  void Build(std::vector<Piece> pieces)
  {
    Cell box;
    box.Pieces = std::move(pieces);
    std::vector<Cell> cells = this->MakeOutermostCells(box);
    this->Place(std::move(cells), this->Grid.Cells);
    std::vector<Cell> left;
    while (!this->Queue.empty())
    {
      Cell cell = this->Queue.top();
      this->Queue.pop();
      if (!this->Divide(cell))
      {
        left.push_back(std::move(cell));
      }
    }
    for (const Cell& cell : left)
    {
      this->NameReceivers(cell);
    }
  }

private:
  /// Fewer cells where many receivers are at the same place: each names all of them.
  std::vector<Cell> MakeOutermostCells(const Cell& box)
  {
    const auto receivers = static_cast<double>(box.Pieces.size());
    double count = std::min(CellsPerReceiver * receivers, MostCells);
    for (;;)
    {
      this->Grid.Cells = ChooseCells(this->Grid.Size, count);
      std::vector<Cell> cells = this->MakeCells(box, this->Grid.Cells);
      std::size_t pieces = 0;
      for (const Cell& cell : cells)
      {
        pieces += cell.Pieces.size();
      }
      if (cells.size() == 1 || pieces <= this->MaximumWords)
      {
        return cells;
      }
      count = 0.25 * static_cast<double>(cells.size());
    }
  }

  bool Divide(const Cell& cell)
  {
    constexpr std::size_t words = Side * Side * Side;
    if (cell.Depth >= MaximumDepth || this->Grid.Table.size() + words > this->MaximumWords ||
      !cell.MayBeSeparated())
    {
      return false;
    }
    std::vector<Cell> cells = this->MakeCells(cell, glm::ivec3(Side));
    double area = 0.0, weighted = 0.0;
    for (const Cell& each : cells)
    {
      area += each.Area;
      weighted += each.Area * static_cast<double>(each.Pieces.size());
    }
    if (!(weighted <= WorthDividing * static_cast<double>(cell.Pieces.size()) * area))
    {
      return false;
    }
    this->Grid.Table[cell.Index] = static_cast<std::uint32_t>(this->Grid.Table.size());
    this->Place(std::move(cells), glm::ivec3(Side));
    return true;
  }

  /// The cells of a cell's grid, x fastest.
  std::vector<Cell> MakeCells(const Cell& parent, const glm::ivec3& count) const
  {
    std::vector<Cell> cells;
    cells.reserve(static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
      static_cast<std::size_t>(count.z));
    for (int z = 0; z < count.z; ++z)
    {
      for (int y = 0; y < count.y; ++y)
      {
        for (int x = 0; x < count.x; ++x)
        {
          Cell cell;
          cell.Depth = parent.Depth + 1;
          cell.Size = parent.Size / glm::dvec3(count);
          cell.Low = parent.Low + cell.Size * glm::dvec3(x, y, z);
          cells.push_back(cell);
        }
      }
    }
    for (const Piece& piece : parent.Pieces)
    {
      this->Distribute(piece, 2, 0, count, cells);
    }
    return cells;
  }

  /// Puts what of a piece is in a slice of cells, along an axis, into each of them.
  void Distribute(const Piece& piece, int axis, int first, const glm::ivec3& count,
    std::vector<Cell>& cells) const
  {
    if (axis < 0)
    {
      Cell& cell = cells[static_cast<std::size_t>(first)];
      cell.Pieces.push_back(piece);
      cell.Pieces.back().Area = GetArea(piece.Shape, this->Grid.Size);
      cell.Area += cell.Pieces.back().Area;
      return;
    }
    const int stride = axis == 0 ? 1 : axis == 1 ? count.x : count.x * count.y;
    const glm::dvec2 extent = FindExtent(piece.Shape, axis);
    const glm::ivec2 range =
      this->FindSlices(piece, extent, axis, cells[static_cast<std::size_t>(first)], count[axis]);
    for (int i = range.x; i <= range.y; ++i)
    {
      const int index = first + i * stride;
      const Cell& cell = cells[static_cast<std::size_t>(index)];
      const double low = cell.Low[axis] - this->Margin[axis];
      const double high = cell.Low[axis] + cell.Size[axis] + this->Margin[axis];
      if (piece.IsEverywhere || (extent.x >= low && extent.y <= high))
      {
        this->Distribute(piece, axis - 1, index, count, cells); // as it is: that copies nothing
        continue;
      }
      const Piece part{ piece.Receiver, false,
        ClipToHalfSpace(ClipToHalfSpace(piece.Shape, axis, -1.0, -low), axis, 1.0, high), 0.0 };
      if (!part.Shape.empty())
      {
        this->Distribute(part, axis - 1, index, count, cells);
      }
    }
  }

  /// The first and the last slice along an axis that a piece of an extent may be in.
  glm::ivec2 FindSlices(
    const Piece& piece, const glm::dvec2& extent, int axis, const Cell& first, int count) const
  {
    if (piece.IsEverywhere)
    {
      return { 0, count - 1 };
    }
    const auto slice = [&](double place)
    {
      const double found = std::floor((place - first.Low[axis]) / first.Size[axis]);
      return static_cast<int>(glm::clamp(found, 0.0, count - 1.0));
    };
    return { slice(extent.x - this->Margin[axis]), slice(extent.y + this->Margin[axis]) };
  }

  /// Adds the cells of a grid to the table; those of several receivers may be divided.
  void Place(std::vector<Cell> cells, const glm::ivec3& count)
  {
    this->FillEmptyCells(cells, count);
    const std::size_t first = this->Grid.Table.size();
    this->Grid.Table.resize(first + cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      Cell& cell = cells[i];
      cell.Index = first + i;
      if (cell.Pieces.size() > 1)
      {
        this->Queue.push(std::move(cell));
      }
      else
      {
        this->NameReceivers(cell);
      }
    }
  }

  /// No point of the surface is in an empty cell, but for what rounding does: it names a receiver
  /// of the closest cell that has one, in steps from cell to cell.
  static void FillEmptyCells(std::vector<Cell>& cells, const glm::ivec3& count)
  {
    std::vector<std::size_t> filled;
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      if (!cells[i].Pieces.empty())
      {
        filled.push_back(i);
      }
    }
    const glm::ivec3 stride(1, count.x, count.x * count.y);
    for (std::size_t k = 0; k < filled.size(); ++k)
    {
      const auto index = static_cast<int>(filled[k]);
      const Piece& piece = cells[filled[k]].Pieces.front();
      for (int axis = 0; axis < 3; ++axis)
      {
        const int place = index / stride[axis] % count[axis];
        for (const int step : { -1, 1 })
        {
          const auto neighbour = static_cast<std::size_t>(index + step * stride[axis]);
          if (place + step >= 0 && place + step < count[axis] && cells[neighbour].Pieces.empty())
          {
            cells[neighbour].Pieces.push_back({ piece.Receiver, piece.IsEverywhere, {}, 0.0 });
            filled.push_back(neighbour);
          }
        }
      }
    }
  }

  void NameReceivers(const Cell& cell)
  {
    std::vector<std::uint32_t>& table = this->Grid.Table;
    if (cell.Pieces.size() == 1)
    {
      table[cell.Index] = Receiver + static_cast<std::uint32_t>(cell.Pieces.front().Receiver);
      return;
    }
    table[cell.Index] = List + static_cast<std::uint32_t>(table.size());
    for (const Piece& piece : cell.Pieces)
    {
      table.push_back(Receiver + MoreFollow + static_cast<std::uint32_t>(piece.Receiver));
    }
    table.back() -= MoreFollow;
  }

  ReceiverGrid& Grid;
  glm::dvec3 Margin;
  std::size_t MaximumWords;
  std::priority_queue<Cell> Queue;
};

ReceiverGrid::ReceiverGrid(const std::vector<Polygon>& polygons, double thickness)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(infinity), high(-infinity);
  for (const Polygon& polygon : polygons)
  {
    for (const glm::dvec3& corner : polygon)
    {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  if (!(low.x <= high.x)) // no corner at all
  {
    low = glm::dvec3(0.0);
    high = glm::dvec3(1.0);
  }
  const glm::dvec3 extent = high - low;
  const double longest = std::max({ extent.x, extent.y, extent.z });
  const double margin =
    std::max(SinglePrecision * longest + thickness, std::numeric_limits<double>::min());
  this->Low = low - margin;
  this->Size = extent + 2.0 * margin;

  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    Piece piece{ i, polygons[i].empty(), {}, 0.0 };
    for (const glm::dvec3& corner : polygons[i])
    {
      piece.Shape.push_back((corner - this->Low) / this->Size);
    }
    pieces.push_back(piece);
  }
  if (!pieces.empty())
  {
    Builder(*this, margin / this->Size, std::min(WordsPerReceiver * pieces.size(), WordsAtMost))
      .Build(std::move(pieces));
  }
}

ReceiverGrid::Answer ReceiverGrid::Find(const glm::dvec3& point) const
{
  Answer answer;
  if (this->Table.empty())
  {
    return answer;
  }
  glm::ivec3 cells = this->Cells;
  glm::dvec3 place = glm::clamp((point - this->Low) / this->Size, 0.0, 1.0);
  std::size_t at = 0;
  std::uint32_t word = 0;
  while (word < Receiver)
  {
    place *= glm::dvec3(cells);
    const glm::ivec3 cell = glm::min(glm::ivec3(place), cells - 1);
    at = word < List ? word + cell.x + cells.x * (cell.y + cells.y * cell.z) : word - List;
    word = this->Table[at];
    ++answer.Reads;
    place -= glm::dvec3(cell);
    cells = glm::ivec3(Side);
  }
  answer.Receivers.push_back(word % List);
  while (word >= Receiver + MoreFollow)
  {
    word = this->Table[++at];
    ++answer.Reads;
    answer.Receivers.push_back(word % List);
  }
  return answer;
}

} // namespace penumbra

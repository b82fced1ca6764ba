// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReceiverGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace penumbra
{
namespace
{

constexpr int CellsPerGrid = ReceiverGrid::Side * ReceiverGrid::Side * ReceiverGrid::Side;

/// What a shader's single precision may be off, as a share of the box: a few roundings of numbers
/// as large as the box.
constexpr double SinglePrecision = 1e-5;

/// Cells of more receivers are divided before all others.
constexpr std::size_t FewReceivers = 3;

/// A division must bring the mean number of receivers, by area, down to this share.
constexpr double WorthDividing = 0.75;

/// The most texels of the table, besides lists: about two grids for each receiver, and 64 MiB.
constexpr std::size_t TexelsPerReceiver = 128;
constexpr std::size_t TexelsAtLeast = 1024;
constexpr std::size_t TexelsAtMost = 1 << 22;

using Polygon = ReceiverGrid::Polygon;

/// The part of a convex polygon where `sign` times the coordinate is at most `limit`.
Polygon ClipToHalfSpace(const Polygon& polygon, int axis, double sign, double limit)
{
  Polygon clipped;
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

glm::vec4 MakeInnerCell(std::size_t firstCell)
{
  return { static_cast<float>(firstCell), 0.0f, 0.0f, 0.0f };
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
  std::vector<Piece> Pieces;
  double Area = 0.0; ///< of all pieces

  double GetSide() const { return std::pow(1.0 / ReceiverGrid::Side, this->Depth); }
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
  Builder(ReceiverGrid& grid, const glm::dvec3& margin, std::size_t maximumTexels)
    : Grid(grid)
    , Margin(margin)
    , MaximumTexels(maximumTexels)
  {
  }

  void Build(std::vector<Piece> pieces)
  {
    Cell box;
    box.Pieces = std::move(pieces);
    this->Place(box, this->MakeCells(box));
    std::vector<Cell> left;
    while (!this->Queue.empty())
    {
      const Cell cell = this->Queue.top();
      this->Queue.pop();
      if (!this->Divide(cell))
      {
        left.push_back(cell);
      }
    }
    for (const Cell& cell : left)
    {
      this->NameReceivers(cell);
    }
  }

private:
  bool Divide(const Cell& cell)
  {
    if (cell.Depth >= MaximumDepth || this->Grid.Table.size() + CellsPerGrid > this->MaximumTexels)
    {
      return false;
    }
    const std::vector<Cell> cells = this->MakeCells(cell);
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
    this->Grid.Table[cell.Index] = MakeInnerCell(this->Grid.Table.size());
    this->Place(cell, cells);
    return true;
  }

  /// The cells of a cell's grid, x fastest.
  std::vector<Cell> MakeCells(const Cell& parent) const
  {
    std::vector<Cell> cells(CellsPerGrid);
    for (int i = 0; i < CellsPerGrid; ++i)
    {
      const glm::dvec3 place(i % Side, i / Side % Side, i / (Side * Side));
      cells[i].Depth = parent.Depth + 1;
      cells[i].Low = parent.Low + cells[i].GetSide() * place;
    }
    for (const Piece& piece : parent.Pieces)
    {
      this->Distribute(piece, 2, 0, cells);
    }
    return cells;
  }

  /// Puts what of a piece is in a slice of cells, along an axis, into each of them.
  void Distribute(const Piece& piece, int axis, int first, std::vector<Cell>& cells) const
  {
    if (axis < 0)
    {
      Cell& cell = cells[static_cast<std::size_t>(first)];
      cell.Pieces.push_back(piece);
      cell.Pieces.back().Area = GetArea(piece.Shape, this->Grid.Size);
      cell.Area += cell.Pieces.back().Area;
      return;
    }
    const int stride = axis == 0 ? 1 : axis == 1 ? Side : Side * Side;
    for (int i = 0; i < Side; ++i)
    {
      const int index = first + i * stride;
      const Cell& cell = cells[static_cast<std::size_t>(index)];
      Piece part = piece;
      if (!piece.IsEverywhere)
      {
        const double low = cell.Low[axis] - this->Margin[axis];
        const double high = cell.Low[axis] + cell.GetSide() + this->Margin[axis];
        part.Shape =
          ClipToHalfSpace(ClipToHalfSpace(piece.Shape, axis, -1.0, -low), axis, 1.0, high);
      }
      if (piece.IsEverywhere || !part.Shape.empty())
      {
        this->Distribute(part, axis - 1, index, cells);
      }
    }
  }

  /// Adds the cells to the table; those of several receivers may be divided.
  void Place(const Cell& parent, const std::vector<Cell>& cells)
  {
    const std::size_t first = this->Grid.Table.size();
    this->Grid.Table.resize(first + cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      Cell cell = cells[i];
      cell.Index = first + i;
      if (cell.Pieces.size() > 1)
      {
        this->Queue.push(cell);
        continue;
      }
      if (cell.Pieces.empty())
      {
        cell.Pieces.push_back(this->FindNearest(parent, cell));
      }
      this->NameReceivers(cell);
    }
  }

  /// No point of the surface is in an empty cell, but for what rounding does.
  Piece FindNearest(const Cell& parent, const Cell& cell) const
  {
    const glm::dvec3 middle = cell.Low + 0.5 * cell.GetSide();
    const Piece* nearest = &parent.Pieces.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : parent.Pieces)
    {
      for (const glm::dvec3& corner : piece.Shape)
      {
        const double distance = glm::length(this->Grid.Size * (corner - middle));
        if (distance < least)
        {
          least = distance;
          nearest = &piece;
        }
      }
    }
    return { nearest->Receiver, nearest->IsEverywhere, {}, 0.0 };
  }

  void NameReceivers(const Cell& cell)
  {
    std::vector<glm::vec4>& table = this->Grid.Table;
    table[cell.Index] = { static_cast<float>(cell.Pieces.front().Receiver),
      static_cast<float>(table.size()), 0.0f, static_cast<float>(cell.Pieces.size()) };
    for (std::size_t i = 1; i < cell.Pieces.size(); ++i)
    {
      table.emplace_back(static_cast<float>(cell.Pieces[i].Receiver), 0.0f, 0.0f, 0.0f);
    }
  }

  ReceiverGrid& Grid;
  glm::dvec3 Margin;
  std::size_t MaximumTexels;
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
    const std::size_t texels =
      std::min(TexelsAtLeast + TexelsPerReceiver * polygons.size(), TexelsAtMost);
    Builder(*this, margin / this->Size, texels).Build(std::move(pieces));
  }
}

ReceiverGrid::Answer ReceiverGrid::Find(const glm::dvec3& point) const
{
  Answer answer;
  if (this->Table.empty())
  {
    return answer;
  }
  constexpr double side = Side;
  glm::dvec3 place = glm::clamp((point - this->Low) / this->Size, 0.0, 1.0) * side;
  std::size_t grid = 0;
  for (;;)
  {
    const glm::dvec3 cell = glm::min(glm::floor(place), side - 1.0);
    const auto index = static_cast<std::size_t>(cell.x + side * (cell.y + side * cell.z));
    const glm::vec4& found = this->Table[grid + index];
    ++answer.Reads;
    if (found.w > 0.0f)
    {
      answer.Receivers.push_back(static_cast<std::size_t>(found.x));
      for (int i = 0; i < static_cast<int>(found.w) - 1; ++i)
      {
        const auto next = static_cast<std::size_t>(found.y) + static_cast<std::size_t>(i);
        answer.Receivers.push_back(static_cast<std::size_t>(this->Table[next].x));
        ++answer.Reads;
      }
      return answer;
    }
    grid = static_cast<std::size_t>(found.x);
    place = (place - cell) * side;
  }
}

} // namespace penumbra

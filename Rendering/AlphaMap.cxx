// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AlphaMap.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace penumbra
{
namespace
{

/// The lines between `count` texels, taken `step` at a time, of a texture from 0 to 1.
std::vector<double> MakeLines(int count, int step)
{
  std::vector<double> lines;
  for (int i = 0; i < count; i += step)
  {
    lines.push_back(static_cast<double>(i) / count);
  }
  lines.push_back(1.0);
  return lines;
}

/// The mean of the texels from `low` to before `high`, as far as there are any.
double GetMean(const AlphaTexels& texels, const glm::ivec2& low, const glm::ivec2& high)
{
  const glm::ivec2 end = glm::min(high, texels.Size);
  double sum = 0.0;
  for (int y = low.y; y < end.y; ++y)
  {
    for (int x = low.x; x < end.x; ++x)
    {
      sum += texels.Alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(texels.Size.x) +
        static_cast<std::size_t>(x)];
    }
  }
  return sum / (static_cast<double>(end.x - low.x) * (end.y - low.y));
}

/// Which of `count` cells lies at index i of a row: behind the last one the row comes back, of a
/// border there is one at each end.
int GetSource(int i, int count, TextureWrap wrap)
{
  switch (wrap)
  {
    case TextureWrap::Mirror:
      return i < count ? i : 2 * count - 1 - i;
    case TextureWrap::Border:
      return i - 1;
    default:
      return i;
  }
}

/// What two corners agree in stays the same to the last bit.
AlphaMap::Corner Mix(const AlphaMap::Corner& a, const AlphaMap::Corner& b, double t)
{
  return { a.Place + t * (b.Place - a.Place), a.Point + t * (b.Point - a.Point),
    a.Value + t * (b.Value - a.Value) };
}

/// Lines of a texture and what lies beyond its edges.
void AddWrap(std::vector<double>& lines, TextureWrap wrap)
{
  if (wrap == TextureWrap::Mirror)
  {
    for (std::size_t i = lines.size() - 1; i-- > 0;)
    {
      lines.push_back(2.0 - lines[i]);
    }
  }
  else if (wrap == TextureWrap::Border)
  {
    lines.insert(lines.begin(), -1.0);
    lines.push_back(2.0);
  }
}

} // namespace

AlphaMap::AlphaMap(const AlphaTexels& texels, int step, int levels)
{
  this->SetCells(texels, step);
  this->Round(levels);
  // Bands of rows or of columns, whichever are fewer rectangles.
  this->Build(glm::ivec2(0), this->GetSize(), 1);
  std::vector<Node> ofRows;
  ofRows.swap(this->Nodes);
  this->Build(glm::ivec2(0), this->GetSize(), 0);
  if (ofRows.size() <= this->Nodes.size())
  {
    ofRows.swap(this->Nodes);
  }
  this->FindSides();
}

glm::ivec2 AlphaMap::GetSize() const
{
  return { static_cast<int>(this->Lines[0].size()) - 1,
    static_cast<int>(this->Lines[1].size()) - 1 };
}

double AlphaMap::GetCell(const glm::ivec2& at) const
{
  return this->Cells[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(this->GetSize().x) +
    static_cast<std::size_t>(at.x)];
}

void AlphaMap::SetCells(const AlphaTexels& texels, int step)
{
  const bool repeats = texels.Wrap == TextureWrap::Repeat || texels.Wrap == TextureWrap::Mirror;
  this->Period = !repeats ? 0.0 : texels.Wrap == TextureWrap::Mirror ? 2.0 : 1.0;
  const glm::ivec2 size = (texels.Size + step - 1) / step;
  for (const int axis : { 0, 1 })
  {
    this->Lines[static_cast<std::size_t>(axis)] = MakeLines(texels.Size[axis], step);
    AddWrap(this->Lines[static_cast<std::size_t>(axis)], texels.Wrap);
  }
  for (int y = 0; y + 1 < static_cast<int>(this->Lines[1].size()); ++y)
  {
    for (int x = 0; x + 1 < static_cast<int>(this->Lines[0].size()); ++x)
    {
      const glm::ivec2 source(GetSource(x, size.x, texels.Wrap), GetSource(y, size.y, texels.Wrap));
      const bool isInside = glm::all(glm::greaterThanEqual(source, glm::ivec2(0))) &&
        glm::all(glm::lessThan(source, size));
      this->Cells.push_back(
        isInside ? GetMean(texels, step * source, step * (source + 1)) : texels.Border);
    }
  }
}

void AlphaMap::Round(int levels)
{
  const std::set<double> distinct(this->Cells.begin(), this->Cells.end());
  if (distinct.size() <= static_cast<std::size_t>(levels))
  {
    return;
  }
  for (double& alpha : this->Cells)
  {
    alpha = std::round(levels * alpha) / levels;
  }
  std::vector<double> sharp;
  sharp.reserve(this->Cells.size());
  for (glm::ivec2 at(0); at.y < this->GetSize().y; ++at.y)
  {
    for (at.x = 0; at.x < this->GetSize().x; ++at.x)
    {
      const double alpha = this->GetCell(at);
      sharp.push_back(alpha > 0.0 && alpha < 1.0 && this->IsEdge(at) ? std::round(alpha) : alpha);
    }
  }
  this->Cells = sharp;
}

bool AlphaMap::IsEdge(const glm::ivec2& at) const
{
  const glm::ivec2 low = glm::max(at - EdgeWidth, glm::ivec2(0));
  const glm::ivec2 high = glm::min(at + EdgeWidth + 1, this->GetSize());
  double least = 1.0, most = 0.0;
  for (glm::ivec2 cell = low; cell.y < high.y; ++cell.y)
  {
    for (cell.x = low.x; cell.x < high.x; ++cell.x)
    {
      least = std::min(least, this->GetCell(cell));
      most = std::max(most, this->GetCell(cell));
    }
  }
  return least <= 0.0 && most >= 1.0;
}

std::vector<int> AlphaMap::FindChanges(
  const glm::ivec2& low, const glm::ivec2& high, int axis) const
{
  std::vector<int> changes;
  glm::ivec2 step(0);
  step[axis] = 1;
  for (int i = low[axis] + 1; i < high[axis]; ++i)
  {
    glm::ivec2 at = low;
    at[axis] = i;
    while (at[1 - axis] < high[1 - axis] && this->GetCell(at) == this->GetCell(at - step))
    {
      ++at[1 - axis];
    }
    if (at[1 - axis] < high[1 - axis])
    {
      changes.push_back(i);
    }
  }
  return changes;
}

std::size_t AlphaMap::Build(const glm::ivec2& low, const glm::ivec2& high, int bands)
{
  const std::size_t index = this->Nodes.size();
  Node node;
  node.Low = low;
  node.High = high;
  node.Alpha = this->GetCell(low);
  this->Nodes.push_back(node);
  for (const int axis : { bands, 1 - bands })
  {
    const std::vector<int> changes = this->FindChanges(low, high, axis);
    if (!changes.empty())
    {
      const int at = changes[changes.size() / 2];
      glm::ivec2 end = high, begin = low;
      end[axis] = at;
      begin[axis] = at;
      node.Axis = axis;
      node.Line = this->Lines[static_cast<std::size_t>(axis)][static_cast<std::size_t>(at)];
      node.Children = { this->Build(low, end, bands), 0 };
      node.Children[1] = this->Build(begin, high, bands);
      this->Nodes[index] = node;
      break;
    }
  }
  return index;
}

std::vector<bool> AlphaMap::FindCorners() const
{
  const std::size_t columns = this->Lines[0].size(), rows = this->Lines[1].size();
  std::vector<bool> isCorner(columns * rows, false);
  // What lies on one end of a period lies on the other one, too.
  const auto findSame = [this](int i, std::size_t count)
  {
    const auto index = static_cast<std::size_t>(i);
    const bool isEnd = this->Period > 0.0 && (index == 0 || index == count - 1);
    return std::array<std::size_t, 2>{ index, isEnd ? count - 1 - index : index };
  };
  for (const Node& node : this->Nodes)
  {
    for (int i = 0; i < 4 && node.Axis < 0 && node.Alpha > 0.0; ++i)
    {
      for (const std::size_t x : findSame(i % 2 == 0 ? node.Low.x : node.High.x, columns))
      {
        for (const std::size_t y : findSame(i < 2 ? node.Low.y : node.High.y, rows))
        {
          isCorner[y * columns + x] = true;
        }
      }
    }
  }
  return isCorner;
}

void AlphaMap::FindSides()
{
  const std::vector<bool> isCorner = this->FindCorners();
  const std::size_t columns = this->Lines[0].size();
  for (Node& node : this->Nodes)
  {
    for (std::size_t side = 0; side < 4 && node.Axis < 0; ++side)
    {
      const int along = side < 2 ? 1 : 0;
      glm::ivec2 at = side % 2 == 0 ? node.Low : node.High;
      for (at[along] = node.Low[along] + 1; at[along] < node.High[along]; ++at[along])
      {
        if (isCorner[static_cast<std::size_t>(at.y) * columns + static_cast<std::size_t>(at.x)])
        {
          node.Sides[side].push_back(
            this->Lines[static_cast<std::size_t>(along)][static_cast<std::size_t>(at[along])]);
        }
      }
    }
  }
}

void AlphaMap::Split(const Polygon& polygon, int axis, double line, Polygon& below, Polygon& above)
{
  const auto [least, most] = std::minmax_element(polygon.begin(), polygon.end(),
    [axis](const Corner& a, const Corner& b) { return a.Place[axis] < b.Place[axis]; });
  // What lies in the line belongs to what is above it, as texels have their lower edge.
  if (least->Place[axis] >= line || most->Place[axis] <= line)
  {
    (least->Place[axis] >= line ? above : below) = polygon;
    return;
  }
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.Place[axis] <= line)
    {
      below.push_back(a);
    }
    if (a.Place[axis] >= line)
    {
      above.push_back(a);
    }
    if ((a.Place[axis] < line) != (b.Place[axis] < line) && a.Place[axis] != line &&
      b.Place[axis] != line)
    {
      // From below, whichever way round the polygon goes: neighbours get the same place.
      const Corner &from = a.Place[axis] < line ? a : b, &to = a.Place[axis] < line ? b : a;
      const double t = (line - from.Place[axis]) / (to.Place[axis] - from.Place[axis]);
      Corner cut = Mix(from, to, t);
      cut.Place[axis] = line;
      below.push_back(cut);
      above.push_back(cut);
    }
  }
}

bool AlphaMap::VisitPieces(const std::array<Corner, 3>& triangle, const Visitor& visit) const
{
  const Polygon polygon(triangle.begin(), triangle.end());
  if (this->Nodes.size() == 1 || this->Period == 0.0)
  {
    return this->VisitNode(Root, polygon, visit);
  }
  return this->VisitPeriods(polygon, 0, visit);
}

bool AlphaMap::VisitPeriods(const Polygon& polygon, int axis, const Visitor& visit) const
{
  const auto [least, most] = std::minmax_element(polygon.begin(), polygon.end(),
    [axis](const Corner& a, const Corner& b) { return a.Place[axis] < b.Place[axis]; });
  const double first = std::floor(least->Place[axis] / this->Period);
  const double last = std::max(std::ceil(most->Place[axis] / this->Period) - 1.0, first);
  Polygon rest = polygon;
  for (double i = first; i <= last; i += 1.0)
  {
    Polygon part, beyond;
    Split(rest, axis, (i + 1.0) * this->Period, part, beyond);
    for (Corner& corner : part)
    {
      corner.Place[axis] -= i * this->Period;
    }
    const bool goesOn = part.empty() ||
      (axis == 0 ? this->VisitPeriods(part, 1, visit) : this->VisitNode(Root, part, visit));
    if (!goesOn)
    {
      return false;
    }
    rest = beyond;
  }
  return true;
}

bool AlphaMap::VisitNode(std::size_t index, const Polygon& polygon, const Visitor& visit) const
{
  const Node& node = this->Nodes[index];
  if (node.Axis < 0)
  {
    return node.Alpha <= 0.0 || visit(this->MakePiece(node, polygon));
  }
  std::array<Polygon, 2> parts;
  Split(polygon, node.Axis, node.Line, parts[0], parts[1]);
  return (parts[0].empty() || this->VisitNode(node.Children[0], parts[0], visit)) &&
    (parts[1].empty() || this->VisitNode(node.Children[1], parts[1], visit));
}

AlphaMap::Piece AlphaMap::MakePiece(const Node& rectangle, const Polygon& polygon) const
{
  Piece piece;
  piece.Alpha = rectangle.Alpha;
  std::vector<bool> isBetween;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Polygon between = this->FindBetween(rectangle, a, b);
    piece.Corners.push_back(a);
    piece.Corners.insert(piece.Corners.end(), between.begin(), between.end());
    isBetween.push_back(false);
    isBetween.resize(piece.Corners.size(), true);
  }
  // A fan about a corner has all triangles if no other corner lies between those of its sides.
  const std::size_t count = piece.Corners.size();
  std::size_t apex = 0;
  while (apex < count && (isBetween[(apex + 1) % count] || isBetween[(apex + count - 1) % count]))
  {
    ++apex;
  }
  piece.IsAround = apex == count;
  if (!piece.IsAround)
  {
    std::rotate(piece.Corners.begin(), piece.Corners.begin() + static_cast<std::ptrdiff_t>(apex),
      piece.Corners.end());
    return piece;
  }
  Corner middle;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    middle = Mix(middle, polygon[i], 1.0 / static_cast<double>(i + 1));
  }
  piece.Corners.insert(piece.Corners.begin(), middle);
  return piece;
}

AlphaMap::Polygon AlphaMap::FindBetween(
  const Node& rectangle, const Corner& a, const Corner& b) const
{
  Polygon between;
  for (std::size_t side = 0; side < 4; ++side)
  {
    const int axis = side < 2 ? 0 : 1, along = 1 - axis;
    const int at = side % 2 == 0 ? rectangle.Low[axis] : rectangle.High[axis];
    const double line = this->Lines[side / 2][static_cast<std::size_t>(at)];
    if (a.Place[axis] != line || b.Place[axis] != line)
    {
      continue;
    }
    const auto [least, most] = std::minmax(a.Place[along], b.Place[along]);
    const std::vector<double>& places = rectangle.Sides[side];
    const auto from = std::upper_bound(places.begin(), places.end(), least);
    const auto to = std::lower_bound(from, places.end(), most);
    for (auto place = from; place != to; ++place)
    {
      between.push_back(Mix(a, b, (*place - a.Place[along]) / (b.Place[along] - a.Place[along])));
    }
    if (a.Place[along] > b.Place[along])
    {
      std::reverse(between.begin(), between.end());
    }
  }
  return between;
}

} // namespace penumbra

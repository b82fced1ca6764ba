// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FineWindows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace penumbra
{
namespace
{

/// Texels across a shadow's thickness: below the first it needs a window, which has the second.
constexpr double FewTexels = 16.0, WindowTexels = 32.0;
/// Shadows that are thinner than this part of their length are of lines or of surfaces that are
/// seen edge on: next to nothing is in shadow.
constexpr double ThinnestShare = 1.0 / 512.0;
/// The most texels around one shadow, before the limit of all: one that a thin shadow crosses
/// diagonally would take all of it.
constexpr double MostTexelsOfOne = 512.0 * 1024;
/// Each window takes some milliseconds for itself, to plan and begin it.
constexpr std::size_t MostWindows = 256;
/// Of windows that are too many to compare each with each other.
constexpr std::size_t ManyWindows = 1024;
/// A rasteriser may move an edge by a texel, and a window ends with a whole one.
constexpr double MarginTexels = 2.0;
/// The most texels of a window along an edge: textures have no more.
constexpr double MostSide = 8192.0;
/// Cells along each edge of a receiver; windows that lie in the same one are merged if they are too
/// many.
constexpr int MostCells = 32;
/// The most finer texels in a receiver's own, along each edge: their numbers fit into integers.
constexpr int MostFactor = 1 << 16;

/// A shadow's rectangle in (u, v), and the size of the texels that it is to have, in world units.
struct Area
{
  glm::dvec2 Low, High;
  double Size;

  bool Overlaps(const Area& other) const
  {
    return glm::all(glm::lessThan(this->Low, other.High)) &&
      glm::all(glm::lessThan(other.Low, this->High));
  }
  void Add(const Area& other)
  {
    this->Low = glm::min(this->Low, other.Low);
    this->High = glm::max(this->High, other.High);
    this->Size = std::min(this->Size, other.Size);
  }
};

/// The receiver's edges, in world units.
glm::dvec2 GetLengths(const ReceiverFrame& frame)
{
  return { glm::length(frame.GetBase().EdgeX), glm::length(frame.GetBase().EdgeY) };
}

/// How thick a shadow is, in world units: see NeedsWindow().
double GetThickness(const PartShadow& shadow, const ReceiverFrame& frame)
{
  const glm::dvec2 lengths = GetLengths(frame);
  const double length = glm::length((shadow.High - shadow.Low) * lengths);
  // Closed surfaces cross each ray twice.
  const double area = 0.5 * shadow.Area * frame.GetSize() * frame.GetSize();
  const glm::dvec2 widest = shadow.Bounds.Penumbra * lengths;
  const double everywhere =
    std::min(widest.x, widest.y) * std::max(shadow.Lowest, 0.0) / shadow.Highest;
  return std::max(area / length, ThinnestShare * length) + everywhere;
}

void MergeOverlapping(std::vector<Area>& areas)
{
  for (std::size_t i = 0; i < areas.size();)
  {
    std::size_t j = 0;
    while (j < areas.size() && (j == i || !areas[i].Overlaps(areas[j])))
    {
      ++j;
    }
    if (j == areas.size())
    {
      ++i;
      continue;
    }
    areas[i].Add(areas[j]);
    areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(j));
    i = 0; // it may overlap earlier ones now
  }
}

/// Merges those whose middles lie in the same of some cells along each edge.
std::vector<Area> MergeInCells(const std::vector<Area>& areas, int cells)
{
  std::map<std::pair<int, int>, Area> merged;
  for (const Area& area : areas)
  {
    const glm::ivec2 cell(
      glm::clamp(0.5 * (area.Low + area.High), glm::dvec2(0.0), glm::dvec2(1.0)) *
      static_cast<double>(cells));
    const auto [place, isNew] = merged.try_emplace({ cell.x, cell.y }, area);
    if (!isNew)
    {
      place->second.Add(area);
    }
  }
  std::vector<Area> result;
  for (const auto& [cell, area] : merged)
  {
    result.push_back(area);
  }
  return result;
}

/// Areas of which none overlaps another one, MostWindows of them at most.
std::vector<Area> Merge(std::vector<Area> areas)
{
  int cells = MostCells;
  if (areas.size() > ManyWindows)
  {
    areas = MergeInCells(areas, cells);
  }
  MergeOverlapping(areas);
  while (areas.size() > MostWindows)
  {
    cells /= 2;
    areas = MergeInCells(areas, cells);
    MergeOverlapping(areas);
  }
  return areas;
}

/// The area of whole texels.
Area Widen(const Area& area, const glm::ivec2& texels)
{
  // Whole ones stay as they are, but for rounding.
  constexpr double Rounding = 1e-6;
  const glm::dvec2 count(texels);
  return { glm::floor(area.Low * count + Rounding) / count,
    glm::ceil(area.High * count - Rounding) / count, area.Size };
}

FineWindow MakeWindow(
  const Area& area, double size, const ReceiverFrame& frame, const glm::ivec2& texels, bool isWhole)
{
  FineWindow window;
  const glm::dvec2 count(texels);
  const glm::dvec2 factor = glm::ceil(GetLengths(frame) / count / size);
  window.Factor = glm::ivec2(glm::clamp(factor, glm::dvec2(1.0), glm::dvec2(MostFactor)));
  window.IsWhole = isWhole;
  const glm::dvec2 fine = isWhole ? count : count * glm::dvec2(window.Factor);
  const Area whole = isWhole ? area : Widen(area, texels * window.Factor);
  window.Fine = { glm::ivec2(glm::round(whole.Low * fine)),
    glm::ivec2(glm::round(whole.High * fine)) };
  if (isWhole)
  {
    window.Fine = { window.Fine.Low * window.Factor, window.Fine.High * window.Factor };
  }
  return window;
}

} // namespace

TexelRectangle FineWindow::GetTexels() const
{
  return { this->Fine.Low / this->Factor, (this->Fine.High + this->Factor - 1) / this->Factor };
}

Receiver FineWindow::MakeReceiver(const Receiver& parent, ReceiverSide side) const
{
  Receiver window = parent;
  const glm::dvec2 all(parent.Texels * this->Factor);
  const glm::dvec2 low = glm::dvec2(this->Fine.Low) / all;
  const glm::dvec2 size = glm::dvec2(this->Fine.GetSize()) / all;
  window.Base.Corner += low.x * parent.Base.EdgeX + low.y * parent.Base.EdgeY;
  window.Base.EdgeX *= size.x;
  window.Base.EdgeY *= size.y;
  window.Texels = this->Fine.GetSize();
  window.IsTriangle = false;
  window.IsAutomatic = false;
  window.Settings.Side = side;
  window.Settings.PlannerTolerance = 0.0; // the parent has left out what is too faint
  return window;
}

std::vector<FineWindow> LimitWindows(std::vector<FineWindow> windows, double mostTexels)
{
  const auto count = [&]
  {
    double texels = 0.0;
    for (const FineWindow& window : windows)
    {
      texels += window.Fine.GetArea();
    }
    return texels;
  };
  bool canGrow = true;
  while (canGrow && count() > mostTexels)
  {
    canGrow = false;
    for (FineWindow& window : windows)
    {
      const glm::dvec2 before(window.Factor);
      window.Factor = (window.Factor + 1) / 2;
      const glm::dvec2 ratio = glm::dvec2(window.Factor) / before;
      window.Fine = { glm::ivec2(glm::floor(glm::dvec2(window.Fine.Low) * ratio)),
        glm::ivec2(glm::ceil(glm::dvec2(window.Fine.High) * ratio)) };
      canGrow = canGrow || window.Factor != glm::ivec2(1);
    }
  }
  return windows;
}

bool NeedsWindow(const PartShadow& shadow, const ReceiverFrame& frame, const glm::ivec2& texels)
{
  const ShadowBounds& bounds = shadow.Bounds;
  const bool isThere = !bounds.IsUnbounded && shadow.Highest > 0.0 &&
    bounds.Low.x < bounds.High.x && bounds.Low.y < bounds.High.y && bounds.High.x > 0.0 &&
    bounds.High.y > 0.0 && bounds.Low.x < 1.0 && bounds.Low.y < 1.0;
  if (!isThere)
  {
    return false;
  }
  const glm::dvec2 texel = GetLengths(frame) / glm::dvec2(texels);
  return GetThickness(shadow, frame) < FewTexels * std::max(texel.x, texel.y);
}

WindowPlan PlanWindows(const std::vector<PartShadow>& small, const std::vector<ShadowBounds>& large,
  const ReceiverFrame& frame, const glm::ivec2& texels)
{
  const glm::dvec2 lengths = GetLengths(frame);
  std::vector<Area> areas;
  for (const PartShadow& shadow : small)
  {
    const glm::dvec2 extent = (shadow.Bounds.High - shadow.Bounds.Low) * lengths;
    const double size = std::max(
      GetThickness(shadow, frame) / WindowTexels, std::sqrt(extent.x * extent.y / MostTexelsOfOne));
    const glm::dvec2 margin = MarginTexels * size / lengths;
    areas.push_back({ glm::max(shadow.Bounds.Low - margin, glm::dvec2(0.0)),
      glm::min(shadow.Bounds.High + margin, glm::dvec2(1.0)), size });
  }
  const glm::dvec2 texel = 1.0 / glm::dvec2(texels);
  const auto touchesLarge = [&](const Area& area)
  {
    return std::any_of(large.begin(), large.end(),
      [&](const ShadowBounds& b) {
        return b.IsUnbounded || area.Overlaps({ b.Low - 2.0 * texel, b.High + 2.0 * texel, 0.0 });
      });
  };
  for (std::size_t before = areas.size() + 1; areas.size() != before;)
  {
    before = areas.size();
    for (Area& area : areas)
    {
      area = touchesLarge(area) ? Widen(area, texels) : area;
    }
    areas = Merge(std::move(areas));
  }

  WindowPlan plan;
  for (const Area& area : areas)
  {
    const glm::dvec2 sides = (area.High - area.Low) * lengths / area.Size;
    plan.NeededTexels += sides.x * sides.y;
    plan.Growth = std::max({ plan.Growth, sides.x / MostSide, sides.y / MostSide });
  }
  plan.Growth = std::max(plan.Growth, std::sqrt(plan.NeededTexels / MostFineTexels));
  for (const Area& area : areas)
  {
    plan.Windows.push_back(
      MakeWindow(area, plan.Growth * area.Size, frame, texels, touchesLarge(area)));
  }
  return plan;
}

} // namespace penumbra

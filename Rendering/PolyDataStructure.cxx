// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolyDataStructure.h"

#include "vtkCellArray.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace penumbra
{
namespace
{

/// The place in the connectivity of the first id that is not in [0, points); -1 if there is none.
template <typename Array>
vtkIdType FindBadId(Array* connectivity, vtkIdType points)
{
  const auto* begin = connectivity->GetPointer(0);
  const auto* end = begin + connectivity->GetNumberOfValues();
  const auto* bad =
    std::find_if(begin, end, [points](vtkIdType id) { return id < 0 || id >= points; });
  return bad == end ? -1 : static_cast<vtkIdType>(bad - begin);
}

std::string DescribeBadId(vtkCellArray* cells, vtkIdType place, vtkIdType points, const char* kind)
{
  vtkIdType cell = 0;
  while (cells->GetOffset(cell + 1) <= place)
  {
    ++cell;
  }
  const double id = cells->GetConnectivityArray()->GetComponent(place, 0);
  return std::string(kind) + " " + std::to_string(cell) + " names point " +
    std::to_string(static_cast<vtkIdType>(id)) + "; allowed: " +
    (points > 0 ? "0 to " + std::to_string(points - 1) : "none, since there are no points");
}

std::string FindCellProblem(vtkCellArray* cells, vtkIdType points, const char* kind)
{
  if (!cells->IsValid())
  {
    return "where each " + std::string(kind) +
      " begins is not in order; allowed: offsets that begin with 0, never decrease, and end with "
      "the number of ids";
  }
  const vtkIdType bad = cells->IsStorage64Bit()
    ? FindBadId(cells->GetConnectivityArray64(), points)
    : FindBadId(cells->GetConnectivityArray32(), points);
  return bad < 0 ? "" : DescribeBadId(cells, bad, points, kind);
}

/// A strip begins with two points that it does not ask for.
std::string FindShortStrip(vtkCellArray* strips)
{
  constexpr vtkIdType least = 3;
  for (vtkIdType i = 0; i < strips->GetNumberOfCells(); ++i)
  {
    if (strips->GetCellSize(i) < least)
    {
      return "strip " + std::to_string(i) + " has " + std::to_string(strips->GetCellSize(i)) +
        " points; allowed: 3 and more";
    }
  }
  return "";
}

} // namespace

std::string FindStructureProblem(vtkPolyData* data)
{
  const vtkIdType points = data->GetNumberOfPoints();
  std::string problem;
  for (const auto& [cells, kind] :
    { std::make_pair(data->GetVerts(), "vertex"), std::make_pair(data->GetLines(), "line"),
      std::make_pair(data->GetPolys(), "polygon"), std::make_pair(data->GetStrips(), "strip") })
  {
    if (problem.empty())
    {
      problem = FindCellProblem(cells, points, kind);
    }
  }
  return problem.empty() ? FindShortStrip(data->GetStrips()) : problem;
}

} // namespace penumbra

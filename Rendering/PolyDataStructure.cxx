// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolyDataStructure.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <utility>

namespace penumbra
{
namespace
{

/// The place of the first id that is not in [0, points); -1 if there is none.
template <typename Get>
vtkIdType FindBadId(vtkIdType ids, vtkIdType points, Get&& get)
{
  for (vtkIdType i = 0; i < ids; ++i)
  {
    const auto id = static_cast<vtkIdType>(get(i));
    if (id < 0 || id >= points)
    {
      return i;
    }
  }
  return -1;
}

/// The same, of ids in whatever array a vtkCellArray keeps them: newer releases of VTK have more
/// kinds of storage than 32 and 64 bits.
vtkIdType FindBadId(vtkDataArray* ids, vtkIdType points)
{
  const vtkIdType count = ids->GetNumberOfValues();
  if (auto* ids64 = vtkArrayDownCast<vtkAOSDataArrayTemplate<vtkTypeInt64>>(ids))
  {
    return FindBadId(count, points, [ids64](vtkIdType i) { return ids64->GetValue(i); });
  }
  if (auto* ids32 = vtkArrayDownCast<vtkAOSDataArrayTemplate<vtkTypeInt32>>(ids))
  {
    return FindBadId(count, points, [ids32](vtkIdType i) { return ids32->GetValue(i); });
  }
  return FindBadId(count, points, [ids](vtkIdType i) { return ids->GetComponent(i, 0); });
}

std::string DescribeBadId(vtkCellArray* cells, vtkIdType place, vtkIdType points, const char* kind)
{
  vtkIdType cell = 0;
  for (vtkIdType end = cells->GetCellSize(0); end <= place; end += cells->GetCellSize(cell))
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
  const vtkIdType bad = FindBadId(cells->GetConnectivityArray(), points);
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
  const std::pair<vtkCellArray*, const char*> kinds[] = { { data->GetVerts(), "vertex" },
    { data->GetLines(), "line" }, { data->GetPolys(), "polygon" }, { data->GetStrips(), "strip" } };
  std::string problem;
  for (const auto& [cells, kind] : kinds)
  {
    if (problem.empty())
    {
      problem = FindCellProblem(cells, points, kind);
    }
  }
  return problem.empty() ? FindShortStrip(data->GetStrips()) : problem;
}

std::string FindStructureProblem(vtkUnstructuredGrid* grid)
{
  // Without cells, there is no array of them.
  return grid->GetCells() ? FindCellProblem(grid->GetCells(), grid->GetNumberOfPoints(), "cell")
                          : "";
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnOpacity.h"

#include "PolyDataStructure.h"
#include "PolygonCells.h"
#include "Vectors.h"
#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkMapper.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace penumbra
{
namespace
{

constexpr double LargestByte = 255.0;

/// The scalars that colour the data and whether they are of cells; nullptr if none do, or if they
/// are not of its cells or points.
vtkAbstractArray* GetScalars(vtkMapper* mapper, vtkDataSet* data, bool& areOfCells)
{
  int association = 0;
  vtkAbstractArray* scalars = mapper->GetScalarVisibility()
    ? vtkAbstractMapper::GetAbstractScalars(data, mapper->GetScalarMode(),
        mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), association)
    : nullptr;
  areOfCells = association != 0;
  const vtkIdType needed = areOfCells ? data->GetNumberOfCells() : data->GetNumberOfPoints();
  return scalars && scalars->GetNumberOfTuples() >= needed ? scalars : nullptr;
}

/// Whether the scalars are colours themselves.
bool AreColours(vtkMapper* mapper, vtkAbstractArray* scalars)
{
  return mapper->GetColorMode() == VTK_COLOR_MODE_DIRECT_SCALARS ||
    (mapper->GetColorMode() == VTK_COLOR_MODE_DEFAULT &&
      vtkUnsignedCharArray::SafeDownCast(scalars));
}

/// The opacities at the corners of a cell, 0 to 255.
struct Corner
{
  glm::dvec3 Point;
  double Opacity;
};

/// The part of a convex polygon where its opacity, times `sign`, is at least `sign * limit`.
std::vector<Corner> Cut(const std::vector<Corner>& polygon, double limit, double sign)
{
  std::vector<Corner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double fromA = sign * (a.Opacity - limit), fromB = sign * (b.Opacity - limit);
    if (fromA >= 0.0)
    {
      kept.push_back(a);
    }
    if ((fromA > 0.0 && fromB < 0.0) || (fromA < 0.0 && fromB > 0.0))
    {
      kept.push_back({ glm::mix(a.Point, b.Point, fromA / (fromA - fromB)), limit });
    }
  }
  return kept;
}

/// Gathers polygons by their opacity in bytes.
class OpacityParts
{
public:
  OpacityParts(vtkPolyData* data, bool isExact)
    : Data(data)
    , IsExact(isExact)
  {
  }

  void AddCell(vtkIdList* cell, double opacity)
  {
    if (vtkPolyData* part = this->GetPart(this->Round(opacity), false))
    {
      part->GetPolys()->InsertNextCell(cell);
    }
  }

  /// A triangle whose opacity is linear is cut halfway between the multiples that it is rounded to.
  void AddTriangle(const std::vector<Corner>& triangle)
  {
    const auto [least, most] = std::minmax_element(triangle.begin(), triangle.end(),
      [](const Corner& a, const Corner& b) { return a.Opacity < b.Opacity; });
    for (double level = this->Round(least->Opacity); level <= this->Round(most->Opacity);
         level += Step)
    {
      const std::vector<Corner> band =
        Cut(Cut(triangle, level - 0.5 * Step, 1.0), level + 0.5 * Step, -1.0);
      vtkPolyData* part = band.size() < 3 ? nullptr : this->GetPart(level, true);
      if (part)
      {
        part->GetPolys()->InsertNextCell(static_cast<int>(band.size()));
        for (const Corner& corner : band)
        {
          part->GetPolys()->InsertCellPoint(part->GetPoints()->InsertNextPoint(&corner.Point.x));
        }
      }
    }
  }

  /// Whole cells and cut ones of the same opacity have points of their own.
  std::multimap<double, vtkSmartPointer<vtkPolyData>> Parts;

private:
  static constexpr double Step = LargestByte / MostOpacities;

  double Round(double opacity) const
  {
    return this->IsExact ? opacity : Step * std::round(opacity / Step);
  }

  vtkPolyData* GetPart(double level, bool isCut)
  {
    if (level <= 0.0)
    {
      return nullptr;
    }
    vtkSmartPointer<vtkPolyData>& part = this->Found[{ level, isCut }];
    if (!part)
    {
      part = vtkSmartPointer<vtkPolyData>::New();
      part->SetFieldData(this->Data->GetFieldData());
      part->SetPolys(vtkNew<vtkCellArray>());
      vtkNew<vtkPoints> own;
      own->SetDataTypeToDouble();
      part->SetPoints(isCut ? own.Get() : this->Data->GetPoints());
      this->Parts.emplace(level / LargestByte, part);
    }
    return part;
  }

  vtkPolyData* Data;
  bool IsExact;
  std::map<std::pair<double, bool>, vtkSmartPointer<vtkPolyData>> Found;
};

/// Whether the opacities are few enough, and the same in all of each polygon, to be taken as they
/// are.
bool AreExact(vtkCellArray* polygons, vtkUnsignedCharArray* opacities, bool areOfPoints)
{
  std::set<unsigned char> distinct;
  for (vtkIdType i = 0; i < opacities->GetNumberOfTuples(); ++i)
  {
    distinct.insert(opacities->GetValue(i));
  }
  bool isExact = distinct.size() <= static_cast<std::size_t>(MostOpacities);
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; areOfPoints && isExact && i < polygons->GetNumberOfCells(); ++i)
  {
    polygons->GetCellAtId(i, cell);
    isExact = std::all_of(cell->begin(), cell->end(),
      [&](vtkIdType id) { return opacities->GetValue(id) == opacities->GetValue(cell->GetId(0)); });
  }
  return isExact;
}

} // namespace

vtkSmartPointer<vtkUnsignedCharArray> FindOpacities(
  vtkMapper* mapper, vtkDataSet* data, bool& areOfCells)
{
  vtkAbstractArray* scalars = GetScalars(mapper, data, areOfCells);
  if (!scalars)
  {
    return nullptr;
  }
  vtkScalarsToColors* table = mapper->GetLookupTable();
  if (table->IsOpaque(scalars, mapper->GetColorMode(), mapper->GetArrayComponent()))
  {
    return nullptr;
  }
  if (!mapper->GetUseLookupTableScalarRange())
  {
    table->SetRange(mapper->GetScalarRange()); // as the mapper does when it draws
  }
  const auto colours = vtkSmartPointer<vtkUnsignedCharArray>::Take(
    table->MapScalars(scalars, mapper->GetColorMode(), mapper->GetArrayComponent(), VTK_RGBA));
  auto opacities = vtkSmartPointer<vtkUnsignedCharArray>::New();
  opacities->SetName(OpacityArray);
  opacities->SetNumberOfTuples(colours->GetNumberOfTuples());
  for (vtkIdType i = 0; i < colours->GetNumberOfTuples(); ++i)
  {
    opacities->SetValue(i, colours->GetTypedComponent(i, 3));
  }
  return opacities;
}

vtkSmartPointer<vtkPolyData> WithOpacities(vtkMapper* mapper, vtkPolyData* data)
{
  bool areOfCells = false;
  const vtkSmartPointer<vtkUnsignedCharArray> opacities = FindOpacities(mapper, data, areOfCells);
  if (!opacities)
  {
    return data;
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(data);
  vtkDataSetAttributes* attributes = result->GetPointData();
  if (areOfCells)
  {
    attributes = result->GetCellData();
  }
  attributes->AddArray(opacities);
  return result;
}

void AppendOpacityState(std::vector<std::uint64_t>& words, vtkMapper* mapper, vtkDataSet* data)
{
  bool areOfCells = false;
  vtkAbstractArray* scalars = GetScalars(mapper, data, areOfCells);
  if (!scalars)
  {
    words.push_back(0);
    return;
  }
  const bool areColours = AreColours(mapper, scalars);
  const bool isTranslucent =
    areColours ? scalars->GetNumberOfComponents() % 2 == 0 : !mapper->GetLookupTable()->IsOpaque();
  words.push_back(isTranslucent ? 2 : 1);
  if (isTranslucent)
  {
    // What is mapped, and by what: times tell of all that can change.
    words.push_back(reinterpret_cast<std::uintptr_t>(scalars));
    words.push_back(static_cast<std::uint64_t>(scalars->GetMTime()));
    words.push_back(mapper->GetLookupTable()->GetMTime());
    words.push_back(static_cast<std::uint64_t>(mapper->GetColorMode()));
    words.push_back(static_cast<std::uint64_t>(mapper->GetArrayComponent()));
  }
}

std::multimap<double, vtkSmartPointer<vtkPolyData>> SplitByOpacity(vtkPolyData* data)
{
  auto* ofPoints = vtkUnsignedCharArray::SafeDownCast(data->GetPointData()->GetArray(OpacityArray));
  auto* ofCells = vtkUnsignedCharArray::SafeDownCast(data->GetCellData()->GetArray(OpacityArray));
  if ((!ofPoints && !ofCells) || !FindStructureProblem(data).empty())
  {
    return { { 1.0, data } };
  }
  vtkNew<vtkIdList> origins, cell;
  const vtkSmartPointer<vtkCellArray> polygons = JoinStrips(data, origins);
  const bool isExact = AreExact(polygons, ofPoints ? ofPoints : ofCells, ofPoints != nullptr);
  OpacityParts parts(data, isExact);
  for (vtkIdType i = 0; (!ofPoints || isExact) && i < polygons->GetNumberOfCells(); ++i)
  {
    polygons->GetCellAtId(i, cell);
    if (cell->GetNumberOfIds() > 0)
    {
      parts.AddCell(
        cell, ofPoints ? ofPoints->GetValue(cell->GetId(0)) : ofCells->GetValue(origins->GetId(i)));
    }
  }
  if (ofPoints && !isExact)
  {
    VisitTriangles(polygons, data->GetPoints(),
      [&](vtkIdType, const std::array<vtkIdType, 3>& ids)
      {
        std::vector<Corner> triangle;
        for (const vtkIdType id : ids)
        {
          Corner& corner = triangle.emplace_back();
          data->GetPoint(id, &corner.Point.x);
          corner.Opacity = ofPoints->GetValue(id);
        }
        parts.AddTriangle(triangle);
      });
  }
  return parts.Parts;
}

} // namespace penumbra

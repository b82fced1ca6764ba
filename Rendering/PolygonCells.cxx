// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonCells.h"

#include "Vectors.h"
#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkTriangleStrip.h"

namespace penumbra
{
namespace
{

constexpr vtkIdType TrianglePoints = 3;

glm::dvec3 GetPoint(const vtkPolygon* polygon, vtkIdType i)
{
  glm::dvec3 point;
  polygon->Points->GetPoint(i, &point.x);
  return point;
}

/// Twice the area of the triangle of these points of the polygon, along its normal.
glm::dvec3 GetDoubleArea(const vtkPolygon* polygon, vtkIdType a, vtkIdType b, vtkIdType c)
{
  const glm::dvec3 first = GetPoint(polygon, a);
  return glm::cross(GetPoint(polygon, b) - first, GetPoint(polygon, c) - first);
}

/// Whether ear cutting finds the polygon's triangles, as indices of its points.
bool CutEars(vtkPolygon* polygon, vtkIdList* triangles)
{
  if (!polygon->EarCutTriangulation(triangles))
  {
    return false;
  }
  double found = 0.0;
  for (vtkIdType i = 0; i + 2 < triangles->GetNumberOfIds(); i += TrianglePoints)
  {
    found += glm::length(GetDoubleArea(
      polygon, triangles->GetId(i), triangles->GetId(i + 1), triangles->GetId(i + 2)));
  }
  glm::dvec3 area(0.0);
  for (vtkIdType i = 2; i < polygon->GetNumberOfPoints(); ++i)
  {
    area += GetDoubleArea(polygon, 0, i - 1, i);
  }
  // Where repeated points leave three, it may take the repeated ones for a triangle: then next to
  // nothing of the area is found, else all of it.
  constexpr double most = 0.5;
  return found >= most * glm::length(area);
}

/// The triangles that VTK's mapper draws.
void MakeFan(vtkIdType points, vtkIdList* triangles)
{
  triangles->Reset();
  for (vtkIdType i = 2; i < points; ++i)
  {
    triangles->InsertNextId(0);
    triangles->InsertNextId(i - 1);
    triangles->InsertNextId(i);
  }
}

} // namespace

vtkSmartPointer<vtkCellArray> JoinStrips(vtkPolyData* data, vtkIdList* origins)
{
  // Cell data come in the order vertices, lines, polygons, strips.
  const vtkIdType first = data->GetNumberOfVerts() + data->GetNumberOfLines();
  const vtkIdType polygons = data->GetNumberOfPolys();
  for (vtkIdType i = 0; origins && i < polygons; ++i)
  {
    origins->InsertNextId(first + i);
  }
  if (data->GetNumberOfStrips() == 0)
  {
    return data->GetPolys();
  }
  auto joined = vtkSmartPointer<vtkCellArray>::New();
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < polygons; ++i)
  {
    data->GetPolys()->GetCellAtId(i, cell);
    joined->InsertNextCell(cell);
  }
  for (vtkIdType i = 0; i < data->GetNumberOfStrips(); ++i)
  {
    data->GetStrips()->GetCellAtId(i, cell);
    vtkTriangleStrip::DecomposeStrip(
      static_cast<int>(cell->GetNumberOfIds()), cell->GetPointer(0), joined);
    for (vtkIdType j = 2; origins && j < cell->GetNumberOfIds(); ++j)
    {
      origins->InsertNextId(first + polygons + i);
    }
  }
  return joined;
}

void VisitTriangles(vtkCellArray* polygons, vtkPoints* points,
  const std::function<void(vtkIdType, const std::array<vtkIdType, 3>&)>& visit)
{
  vtkNew<vtkPolygon> polygon;
  vtkNew<vtkIdList> cell, triangles;
  for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
  {
    polygons->GetCellAtId(i, cell);
    const vtkIdType size = cell->GetNumberOfIds();
    MakeFan(size, triangles); // of a triangle, it is the triangle
    if (size > TrianglePoints)
    {
      polygon->PointIds->SetNumberOfIds(size);
      polygon->Points->SetNumberOfPoints(size);
      for (vtkIdType j = 0; j < size; ++j)
      {
        double place[3];
        points->GetPoint(cell->GetId(j), place);
        polygon->PointIds->SetId(j, cell->GetId(j));
        polygon->Points->SetPoint(j, place);
      }
      if (!CutEars(polygon, triangles))
      {
        MakeFan(size, triangles);
      }
    }
    for (vtkIdType j = 0; j + 2 < triangles->GetNumberOfIds(); j += TrianglePoints)
    {
      visit(i,
        { cell->GetId(triangles->GetId(j)), cell->GetId(triangles->GetId(j + 1)),
          cell->GetId(triangles->GetId(j + 2)) });
    }
  }
}

} // namespace penumbra

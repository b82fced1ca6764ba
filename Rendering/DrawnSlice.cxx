// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnSlice.h"

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkImageData.h"
#include "vtkImageProperty.h"
#include "vtkImageSlice.h"
#include "vtkImageSliceMapper.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace penumbra
{
namespace
{

/// A slice in the image's continuous indices (i, j, k): the bounds of its rectangle, flat along
/// one.
using SliceExtent = std::array<double, 6>;

/// The rectangle in the coordinates of the image: its origin, spacing and directions are looked at.
vtkSmartPointer<vtkPolyData> MakeRectangle(vtkImageData* image, const SliceExtent& extent)
{
  const std::size_t axis = extent[0] == extent[1] ? 0 : extent[2] == extent[3] ? 1 : 2;
  const std::size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(4);
  for (const auto& [a, b] : { std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) })
  {
    std::array<double, 3> corner;
    corner[axis] = extent[2 * axis];
    corner[first] = extent[2 * first + static_cast<std::size_t>(a)];
    corner[second] = extent[2 * second + static_cast<std::size_t>(b)];
    std::array<double, 3> placed;
    image->TransformContinuousIndexToPhysicalPoint(corner.data(), placed.data());
    cells->InsertCellPoint(points->InsertNextPoint(placed.data()));
  }
  auto rectangle = vtkSmartPointer<vtkPolyData>::New();
  rectangle->SetPoints(points);
  rectangle->SetPolys(cells);
  return rectangle;
}

/// The rectangle of an image slice, in the coordinates of its prop.
vtkSmartPointer<vtkPolyData> MakeSlice(vtkImageSliceMapper* mapper)
{
  if (mapper->GetSliceFacesCamera() || mapper->GetSliceAtFocalPoint() || !mapper->GetInput())
  {
    return nullptr;
  }
  mapper->Update();
  SliceExtent extent;
  mapper->GetIndexBounds(extent.data()); // along its axis, those of all slices
  const auto axis = static_cast<std::size_t>(mapper->GetOrientation());
  extent[2 * axis] = extent[2 * axis + 1] = mapper->GetSliceNumber();
  return MakeRectangle(mapper->GetInput(), extent);
}

/// The slice that the mapper of ParaView's Slice representation draws: its data are the slice
/// alone.
vtkSmartPointer<vtkPolyData> MakeParaViewSlice(vtkMapper* mapper)
{
  if (!mapper || !mapper->IsA("vtkPVImageSliceMapper")) // of a library that plain VTK lacks
  {
    return nullptr;
  }
  mapper->Update();
  auto* image = vtkImageData::SafeDownCast(mapper->GetInputDataObject(0, 0));
  if (!image || image->GetDataDimension() != 2)
  {
    return nullptr;
  }
  SliceExtent extent;
  std::copy_n(image->GetExtent(), extent.size(), extent.begin());
  return MakeRectangle(image, extent);
}

/// A rectangle and how it is drawn.
struct Slice
{
  vtkSmartPointer<vtkPolyData> Rectangle;
  vtkAbstractMapper* Mapper = nullptr;
  double Opacity = 1.0;
};

Slice FindSlice(vtkProp* prop)
{
  Slice slice;
  if (auto* image = vtkImageSlice::SafeDownCast(prop))
  {
    if (auto* mapper = vtkImageSliceMapper::SafeDownCast(image->GetMapper()))
    {
      slice = { MakeSlice(mapper), mapper, image->GetProperty()->GetOpacity() };
    }
  }
  else if (auto* actor = vtkActor::SafeDownCast(prop))
  {
    vtkMapper* mapper = actor->vtkActor::GetMapper();
    slice = { MakeParaViewSlice(mapper), mapper, actor->GetProperty()->GetOpacity() };
  }
  return slice;
}

bool HaveSamePoints(vtkPolyData* a, vtkPolyData* b)
{
  bool areSame = a && b && a->GetNumberOfPoints() == b->GetNumberOfPoints();
  for (vtkIdType i = 0; areSame && i < a->GetNumberOfPoints(); ++i)
  {
    std::array<double, 3> p, q;
    a->GetPoint(i, p.data());
    b->GetPoint(i, q.data());
    areSame = p == q;
  }
  return areSame;
}

} // namespace

vtkActor* SliceActors::Find(vtkProp* prop)
{
  const Slice slice = FindSlice(prop);
  if (!slice.Rectangle)
  {
    return nullptr;
  }
  Entry& entry = this->Entries[prop];
  if (entry.Prop != prop)
  {
    entry.Prop = prop;
    entry.Actor = vtkSmartPointer<vtkActor>::New();
    entry.Actor->SetMapper(vtkNew<vtkPolyDataMapper>());
  }
  auto* mapper = vtkPolyDataMapper::SafeDownCast(entry.Actor->GetMapper());
  if (!HaveSamePoints(mapper->GetInput(), slice.Rectangle))
  {
    mapper->SetInputData(slice.Rectangle);
  }
  mapper->SetClippingPlanes(slice.Mapper->GetClippingPlanes());
  entry.Actor->GetProperty()->SetOpacity(slice.Opacity);
  return entry.Actor;
}

void SliceActors::Prune()
{
  for (auto it = this->Entries.begin(); it != this->Entries.end();)
  {
    it = it->second.Prop ? std::next(it) : this->Entries.erase(it);
  }
}

} // namespace penumbra

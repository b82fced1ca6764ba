// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceExtraction.h"

#include "PolyDataStructure.h"
#include "Vectors.h"
#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkExplicitStructuredGridSurfaceFilter.h"
#include "vtkFieldData.h"
#include "vtkGeometryFilter.h"
#include "vtkHyperTreeGrid.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkShadowFieldData.h"
#include "vtkStructuredGrid.h"
#include "vtkUniformGridAMR.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridGeometryFilter.h"
#include "vtkVersionMacros.h"
#if VTK_MODULE_ENABLE_VTK_FiltersHyperTree
#include "vtkHyperTreeGridGeometry.h"
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace penumbra
{
namespace
{

constexpr int Hidden = vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::DUPLICATECELL;

/// The ghost types of the cells; nullptr if there are none, or not one for each.
vtkUnsignedCharArray* GetGhosts(vtkPolyData* data)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    data->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return ghosts && ghosts->GetNumberOfComponents() == 1 &&
      ghosts->GetNumberOfTuples() >= data->GetNumberOfCells()
    ? ghosts
    : nullptr;
}

/// Appends the cells of one kind that are not hidden, and their numbers among all cells.
vtkNew<vtkCellArray> KeepVisible(
  vtkCellArray* cells, vtkUnsignedCharArray* ghosts, vtkIdType first, vtkIdList* kept)
{
  vtkNew<vtkCellArray> visible;
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i)
  {
    if ((ghosts->GetValue(first + i) & Hidden) == 0)
    {
      cells->GetCellAtId(i, cell);
      visible->InsertNextCell(cell);
      kept->InsertNextId(first + i);
    }
  }
  return visible;
}

/// VTK's filters copy the values of all arrays, whether they are there or not.
void RemoveShortArrays(vtkDataSetAttributes* values, vtkIdType count)
{
  for (int i = values->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    if (values->GetAbstractArray(i)->GetNumberOfTuples() < count)
    {
      values->RemoveArray(i);
    }
  }
}

/// Copies the values of these cells or points, in this order.
void CopyValues(
  vtkDataSetAttributes* from, vtkIdType count, vtkIdList* ids, vtkDataSetAttributes* to)
{
  vtkNew<vtkPointData> whole;
  whole->ShallowCopy(from);
  whole->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  RemoveShortArrays(whole, count);
  to->CopyAllOn(vtkDataSetAttributes::COPYTUPLE);
  to->CopyAllocate(whole, ids->GetNumberOfIds());
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    to->CopyData(whole, ids->GetId(i), i);
  }
}

/// Renumbers the points of the cells by use, those of earlier kinds first.
void RenumberPoints(vtkCellArray* cells, std::vector<vtkIdType>& numbers, vtkIdList* used)
{
  vtkNew<vtkIdList> cell;
  vtkNew<vtkCellArray> renumbered;
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i)
  {
    cells->GetCellAtId(i, cell);
    for (vtkIdType& id : *cell)
    {
      vtkIdType& number = numbers[static_cast<std::size_t>(id)];
      number = number >= 0 ? number : used->InsertNextId(id);
      id = number;
    }
    renumbered->InsertNextCell(cell);
  }
  cells->ShallowCopy(renumbered);
}

/// Leaves out the points that no cell uses.
void DropUnusedPoints(vtkPolyData* data)
{
  vtkPoints* points = data->GetPoints();
  if (!points)
  {
    return;
  }
  std::vector<vtkIdType> numbers(static_cast<std::size_t>(points->GetNumberOfPoints()), -1);
  vtkNew<vtkIdList> used;
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    RenumberPoints(cells, numbers, used);
  }
  vtkNew<vtkPoints> kept;
  kept->SetDataType(points->GetDataType());
  kept->SetNumberOfPoints(used->GetNumberOfIds());
  for (vtkIdType i = 0; i < used->GetNumberOfIds(); ++i)
  {
    double place[3];
    points->GetPoint(used->GetId(i), place);
    kept->SetPoint(i, place);
  }
  vtkNew<vtkPointData> values;
  CopyValues(data->GetPointData(), points->GetNumberOfPoints(), used, values);
  data->SetPoints(kept);
  data->GetPointData()->ShallowCopy(values);
}

/// A shallow copy that VTK's filters can read, and may change.
template <typename DataSet>
vtkSmartPointer<DataSet> CopyForFilter(DataSet* data)
{
  auto copy = vtkSmartPointer<DataSet>::Take(data->NewInstance());
  copy->ShallowCopy(data);
  RemoveShortArrays(copy->GetCellData(), copy->GetNumberOfCells());
  RemoveShortArrays(copy->GetPointData(), copy->GetNumberOfPoints());
  return copy;
}

vtkSmartPointer<vtkPolyData> Run(vtkAlgorithm* filter, vtkDataObject* data)
{
  filter->SetInputDataObject(data);
  filter->Update();
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkNew<vtkGeometryFilter> MakeGeometryFilter()
{
  vtkNew<vtkGeometryFilter> filter;
  filter->SetFastMode(true); // as ParaView draws
  return filter;
}

/// The surface of an image, a rectilinear or a structured grid; `faces` says which of the six sides
/// belong to it, or is nullptr: all.
vtkSmartPointer<vtkPolyData> ExtractStructured(vtkDataSet* data, int extent[6], bool* faces)
{
  const auto filter = MakeGeometryFilter();
  const vtkSmartPointer<vtkDataSet> copy = CopyForFilter(data);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230101)
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  filter->StructuredExecute(copy, surface, extent, faces);
  return surface;
#else
  // Releases 9.2.x have no such call but by a pipeline's information, which knows no sides.
  (void)extent;
  (void)faces;
  return Run(filter, copy);
#endif
}

vtkSmartPointer<vtkPolyData> ExtractUnstructured(vtkUnstructuredGridBase* grid)
{
  const std::unique_ptr<vtkGeometryFilterHelper> kinds(
    vtkGeometryFilterHelper::CharacterizeUnstructuredGrid(grid));
  if (kinds->IsLinear)
  {
    return Run(MakeGeometryFilter(), CopyForFilter(grid));
  }
  // Curved faces are found first, and then split into flat ones. Ghost cells stay until then:
  // there is no surface between them and others.
  vtkNew<vtkUnstructuredGridGeometryFilter> faces;
  faces->DuplicateGhostCellClippingOff();
  faces->MergingOff();
  faces->SetInputDataObject(CopyForFilter(grid));
  faces->Update();
  return Run(MakeGeometryFilter(), faces->GetOutputDataObject(0));
}

vtkSmartPointer<vtkPolyData> ExtractHyperTrees(vtkHyperTreeGrid* grid)
{
#if VTK_MODULE_ENABLE_VTK_FiltersHyperTree
  vtkNew<vtkHyperTreeGridGeometry> filter;
  auto copy = vtkSmartPointer<vtkHyperTreeGrid>::Take(grid->NewInstance());
  copy->ShallowCopy(grid);
  return Run(filter, copy);
#else
  (void)grid;
  return nullptr;
#endif
}

/// nullptr where there is nothing that a view could draw a surface of.
vtkSmartPointer<vtkPolyData> ExtractAny(vtkDataObject* data)
{
  if (auto* polygons = vtkPolyData::SafeDownCast(data))
  {
    return polygons;
  }
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    return ExtractStructured(image, image->GetExtent(), nullptr);
  }
  if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data))
  {
    return ExtractStructured(rectilinear, rectilinear->GetExtent(), nullptr);
  }
  if (auto* structured = vtkStructuredGrid::SafeDownCast(data))
  {
    return ExtractStructured(structured, structured->GetExtent(), nullptr);
  }
  if (auto* unstructured = vtkUnstructuredGridBase::SafeDownCast(data))
  {
    return ExtractUnstructured(unstructured);
  }
  if (auto* explicitGrid = vtkExplicitStructuredGrid::SafeDownCast(data))
  {
    vtkNew<vtkExplicitStructuredGridSurfaceFilter> filter;
    return Run(filter, CopyForFilter(explicitGrid));
  }
  if (auto* trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    return ExtractHyperTrees(trees);
  }
  return nullptr;
}

/// What would have VTK read what is not there.
std::string FindProblem(vtkDataObject* data)
{
  if (auto* polygons = vtkPolyData::SafeDownCast(data))
  {
    return FindStructureProblem(polygons);
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  return grid ? FindStructureProblem(grid) : "";
}

/// Collects the surfaces of leaves, and what is to be said of those that have none.
class Extraction
{
public:
  void AddLeaf(vtkDataObject* leaf)
  {
    ++this->Leaves;
    const std::string problem = FindProblem(leaf);
    auto* polygons = vtkPolyData::SafeDownCast(leaf);
    if (polygons && (!problem.empty() || polygons->GetNumberOfCells() == 0))
    {
      this->Surfaces.emplace_back(polygons); // who reads them says what is wrong
      return;
    }
    if (!problem.empty())
    {
      this->Refuse(std::string("is a ") + leaf->GetClassName() + " whose " + problem);
      return;
    }
    if (leaf->GetNumberOfElements(vtkDataObject::CELL) == 0 &&
      (vtkDataSet::SafeDownCast(leaf) || vtkHyperTreeGrid::SafeDownCast(leaf)))
    {
      return;
    }
    this->AddSurface(leaf, ExtractAny(leaf));
  }

  /// Of each block, the sides on the bounds of the whole, as ParaView draws them.
  void AddRefinedGrids(vtkUniformGridAMR* grids)
  {
    std::array<double, 6> whole;
    grids->GetBounds(whole.data());
    vtkSmartPointer<vtkCompositeDataIterator> it;
    it.TakeReference(grids->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      auto* block = vtkDataSet::SafeDownCast(it->GetCurrentDataObject());
      if (block && block->GetNumberOfCells() > 0)
      {
        this->AddRefinedGrid(block, whole);
      }
    }
  }

  ExtractedSurfaces Finish()
  {
    ExtractedSurfaces result;
    vtkNew<vtkMultiBlockDataSet> all;
    for (std::size_t i = 0; i < this->Surfaces.size(); ++i)
    {
      all->SetBlock(static_cast<unsigned int>(i), this->Surfaces[i]);
    }
    result.Data = all;
    if (this->Refused > 0)
    {
      result.Problem = this->Refused == 1 && this->Leaves == 1
        ? this->First
        : std::to_string(this->Refused) + " of its " + std::to_string(this->Leaves) +
          " blocks cannot be used; the first " + this->First;
      result.Problem +=
        "; allowed: polygons, grids of cells that have faces, hyper tree grids, and "
        "composite data of them";
    }
    return result;
  }

private:
  void AddRefinedGrid(vtkDataSet* block, const std::array<double, 6>& whole)
  {
    std::array<double, 6> bounds;
    block->GetBounds(bounds.data());
    int extent[6] = { 0, -1, 0, -1, 0, -1 };
    if (auto* image = vtkImageData::SafeDownCast(block))
    {
      image->GetExtent(extent);
    }
    else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(block))
    {
      rectilinear->GetExtent(extent);
    }
    glm::dvec3 cell(0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      const int cells = std::max(extent[2 * axis + 1] - extent[2 * axis], 1);
      cell[axis] = (bounds[static_cast<std::size_t>(2 * axis + 1)] -
                     bounds[static_cast<std::size_t>(2 * axis)]) /
        cells;
    }
    bool faces[6], hasFace = false;
    for (std::size_t i = 0; i < 6; ++i)
    {
      faces[i] = std::abs(bounds[i] - whole[i]) < glm::length(cell);
      hasFace = hasFace || faces[i];
    }
    ++this->Leaves;
    if (hasFace)
    {
      this->AddSurface(block, ExtractStructured(block, extent, faces));
    }
  }

  void AddSurface(vtkDataObject* from, vtkPolyData* surface)
  {
    if (!surface)
    {
      this->Refuse(std::string("is a ") + from->GetClassName() + ", which has no surface");
      return;
    }
    const bool isOfLight = vtkShadowFieldData::ReadLight(from->GetFieldData()).has_value();
    const bool isRefused = !vtkShadowFieldData::ReadRefusal(from->GetFieldData()).empty();
    if (surface->GetNumberOfPolys() + surface->GetNumberOfStrips() == 0 && !isOfLight && !isRefused)
    {
      if (surface->GetNumberOfCells() > 0)
      {
        this->Refuse(std::string("is a ") + from->GetClassName() + " of points or lines only");
      }
      return;
    }
    vtkSmartPointer<vtkPolyData> visible = WithoutHiddenCells(surface);
    if (visible != from)
    {
      visible->GetFieldData()->ShallowCopy(from->GetFieldData());
    }
    this->Surfaces.push_back(visible);
  }

  void Refuse(const std::string& what) { this->First = this->Refused++ == 0 ? what : this->First; }

  std::vector<vtkSmartPointer<vtkPolyData>> Surfaces;
  int Leaves = 0;
  int Refused = 0;
  std::string First; ///< of those that are refused, what the first is
};

void AddAll(vtkDataObject* data, Extraction& extraction)
{
  if (auto* grids = vtkUniformGridAMR::SafeDownCast(data))
  {
    extraction.AddRefinedGrids(grids);
  }
  else if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> it;
    it.TakeReference(composite->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      AddAll(it->GetCurrentDataObject(), extraction);
    }
  }
  else if (data)
  {
    extraction.AddLeaf(data);
  }
}

} // namespace

ExtractedSurfaces ExtractSurfaces(vtkDataObject* data)
{
  Extraction extraction;
  AddAll(data, extraction);
  return extraction.Finish();
}

vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* data)
{
  vtkUnsignedCharArray* ghosts = GetGhosts(data);
  const vtkIdType cells = data->GetNumberOfCells();
  const auto isHidden = [](unsigned char ghost) { return (ghost & Hidden) != 0; };
  if (!ghosts || std::none_of(ghosts->GetPointer(0), ghosts->GetPointer(0) + cells, isHidden))
  {
    return data;
  }
  auto visible = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkIdList> kept;
  vtkIdType first = 0;
  visible->SetVerts(KeepVisible(data->GetVerts(), ghosts, first, kept));
  visible->SetLines(KeepVisible(data->GetLines(), ghosts, first += data->GetNumberOfVerts(), kept));
  visible->SetPolys(KeepVisible(data->GetPolys(), ghosts, first += data->GetNumberOfLines(), kept));
  visible->SetStrips(
    KeepVisible(data->GetStrips(), ghosts, first + data->GetNumberOfPolys(), kept));
  CopyValues(data->GetCellData(), cells, kept, visible->GetCellData());
  visible->SetPoints(data->GetPoints());
  visible->GetPointData()->ShallowCopy(data->GetPointData());
  DropUnusedPoints(visible);
  visible->GetFieldData()->ShallowCopy(data->GetFieldData());
  return visible;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The surfaces of data of any type, and what is said of data that have none.

#include "SurfaceExtraction.h"
#include "vtkAMRBox.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkShadowSceneBuilder.h"
#include "vtkTable.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersionMacros.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace
{

/// The area of all triangles that the data are split into.
double FindArea(vtkDataObject* data)
{
  vtkNew<vtkShadowSceneBuilder> builder;
  builder->AddData(data, nullptr, vtkShadowSceneBuilder::Occluder, "surface");
  double area = 0.0;
  for (const penumbra::SharedSurface& shared : builder->GetScene().Surfaces)
  {
    const penumbra::Surface& surface = *shared;
    for (const auto& [a, b, c] : surface.Triangles)
    {
      const glm::dvec3 first = surface.Points[a];
      area += 0.5 * glm::length(glm::cross(surface.Points[b] - first, surface.Points[c] - first));
    }
  }
  return area;
}

/// 3 x 2 x 1 cells of size 1.
vtkNew<vtkImageData> MakeImage()
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 3, 2);
  return image;
}

/// A row of unit squares, each with the ghost type given, a number, and points of its own.
vtkNew<vtkPolyData> MakeSquares(std::initializer_list<int> types)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkUnsignedCharArray> ghosts;
  vtkNew<vtkIntArray> numbers, corners;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  numbers->SetName("Number");
  corners->SetName("Corner");
  for (const int type : types)
  {
    const auto x = static_cast<double>(ghosts->GetNumberOfTuples());
    const vtkIdType a = points->InsertNextPoint(x, 0, 0), b = points->InsertNextPoint(x + 1, 0, 0),
                    c = points->InsertNextPoint(x + 1, 1, 0), d = points->InsertNextPoint(x, 1, 0);
    polygons->InsertNextCell({ a, b, c, d });
    ghosts->InsertNextValue(static_cast<unsigned char>(type));
    numbers->InsertNextValue(static_cast<int>(x));
    for (const vtkIdType corner : { a, b, c, d })
    {
      corners->InsertNextValue(static_cast<int>(corner));
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polygons);
  data->GetCellData()->AddArray(ghosts);
  data->GetCellData()->AddArray(numbers);
  data->GetPointData()->AddArray(corners);
  return data;
}

void ExpectProblem(vtkDataObject* data, const std::string& words)
{
  const std::string problem = penumbra::ExtractSurfaces(data).Problem;
  EXPECT_NE(problem.find(words), std::string::npos) << problem;
  EXPECT_NE(problem.find("allowed: "), std::string::npos) << problem;
}

} // namespace

TEST(SurfaceExtraction, OuterSurfaceOfAnImage)
{
  const auto image = MakeImage();
  const penumbra::ExtractedSurfaces surfaces = penumbra::ExtractSurfaces(image);
  EXPECT_EQ(surfaces.Problem, "");
  EXPECT_NEAR(FindArea(surfaces.Data), 2 * (3 * 2 + 3 * 1 + 2 * 1), 1e-6);
}

TEST(SurfaceExtraction, FieldDataComeAlong)
{
  const auto image = MakeImage();
  vtkNew<vtkIntArray> setting;
  setting->SetName("Setting");
  image->GetFieldData()->AddArray(setting);
  const penumbra::ExtractedSurfaces surfaces = penumbra::ExtractSurfaces(image);
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(surfaces.Data);
  ASSERT_EQ(blocks->GetNumberOfBlocks(), 1u);
  EXPECT_TRUE(blocks->GetBlock(0)->GetFieldData()->HasArray("Setting"));
}

TEST(SurfaceExtraction, HiddenCellsAndTheirPointsAreLeftOut)
{
  const auto squares = MakeSquares({ vtkDataSetAttributes::HIDDENCELL, 0,
    vtkDataSetAttributes::DUPLICATECELL, vtkDataSetAttributes::HIGHCONNECTIVITYCELL });
  vtkNew<vtkDoubleArray> tooShort;
  tooShort->SetName("TooShort");
  tooShort->InsertNextValue(1.0);
  squares->GetCellData()->AddArray(tooShort);
  const vtkSmartPointer<vtkPolyData> visible = penumbra::WithoutHiddenCells(squares);
  ASSERT_EQ(visible->GetNumberOfCells(), 2);
  ASSERT_EQ(visible->GetNumberOfPoints(), 8);
  EXPECT_EQ(visible->GetCellData()->GetNumberOfArrays(), 1);
  for (vtkIdType i = 0; i < 2; ++i)
  {
    const double square = i == 0 ? 1.0 : 3.0;
    EXPECT_EQ(visible->GetCellData()->GetArray("Number")->GetTuple1(i), square);
    EXPECT_EQ(visible->GetPointData()->GetArray("Corner")->GetTuple1(4 * i), 4 * square);
    double bounds[6];
    visible->GetCellBounds(i, bounds);
    EXPECT_EQ(bounds[0], square);
  }
  EXPECT_NEAR(FindArea(penumbra::ExtractSurfaces(squares).Data), 2.0, 1e-12);
}

TEST(SurfaceExtraction, WhereNothingIsHiddenDataStayTheSame)
{
  const auto squares = MakeSquares({ 0, 0 });
  EXPECT_EQ(penumbra::WithoutHiddenCells(squares), squares.Get());
  const auto hidden = MakeSquares({ vtkDataSetAttributes::HIDDENCELL });
  EXPECT_EQ(penumbra::ExtractSurfaces(hidden).Problem, "");
  EXPECT_EQ(FindArea(penumbra::ExtractSurfaces(hidden).Data), 0.0);
}

TEST(SurfaceExtraction, BlocksWithinBlocks)
{
  const auto image = MakeImage();
  const auto squares = MakeSquares({ 0, vtkDataSetAttributes::HIDDENCELL });
  vtkNew<vtkMultiBlockDataSet> inner, outer;
  inner->SetBlock(0, image);
  inner->SetBlock(3, squares);
  outer->SetBlock(1, inner);
  const penumbra::ExtractedSurfaces surfaces = penumbra::ExtractSurfaces(outer);
  EXPECT_EQ(surfaces.Problem, "");
  EXPECT_NEAR(FindArea(surfaces.Data), 22.0 + 1.0, 1e-6);
}

// Only sides on the bounds of the whole, and nothing between blocks.
TEST(SurfaceExtraction, RefinedGrids)
{
  vtkNew<vtkOverlappingAMR> grids;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  grids->Initialize(std::vector<unsigned int>{ 2 });
#else
  const int blocks[] = { 2 };
  grids->Initialize(1, blocks);
#endif
  const double origin[] = { 0.0, 0.0, 0.0 }, spacing[] = { 1.0, 1.0, 1.0 };
  grids->SetOrigin(origin);
  grids->SetGridDescription(8); // three-dimensional (VTK_XYZ_GRID)
  grids->SetSpacing(0, spacing);
  for (unsigned int i = 0; i < 2; ++i)
  {
    const int low = 4 * static_cast<int>(i);
    const vtkAMRBox box(low, 0, 0, low + 3, 3, 3);
    grids->SetAMRBox(0, i, box);
    vtkNew<vtkUniformGrid> grid;
    grid->SetOrigin(low, 0, 0);
    grid->SetDimensions(5, 5, 5);
    grids->SetDataSet(0, i, grid);
  }
  const penumbra::ExtractedSurfaces surfaces = penumbra::ExtractSurfaces(grids);
  EXPECT_EQ(surfaces.Problem, "");
  EXPECT_NEAR(FindArea(surfaces.Data), 2 * (8 * 4 + 8 * 4 + 4 * 4), 1e-6);
}

TEST(SurfaceExtraction, WhatHasNoSurfaceIsSaid)
{
  vtkNew<vtkTable> table;
  ExpectProblem(table, "is a vtkTable, which has no surface");
  const auto lines = MakeSquares({});
  lines->GetPoints()->InsertNextPoint(0, 0, 0);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 0 });
  lines->SetVerts(verts);
  ExpectProblem(lines, "is a vtkPolyData of points or lines only");
  vtkNew<vtkMultiBlockDataSet> blocks;
  const auto image = MakeImage();
  blocks->SetBlock(0, table);
  blocks->SetBlock(1, image);
  ExpectProblem(blocks, "1 of its 2 blocks cannot be used; the first is a vtkTable");
  EXPECT_NEAR(FindArea(penumbra::ExtractSurfaces(blocks).Data), 22.0, 1e-6);
}

// VTK would read what is not there.
TEST(SurfaceExtraction, BrokenGrids)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(3);
  grid->SetPoints(points);
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 3 });
  grid->SetCells(VTK_TRIANGLE, cells);
  ExpectProblem(grid, "is a vtkUnstructuredGrid whose cell 0 names point 3; allowed: 0 to 2");
  const auto image = MakeImage();
  vtkNew<vtkDoubleArray> tooShort;
  tooShort->SetName("TooShort");
  tooShort->InsertNextValue(1.0);
  image->GetPointData()->AddArray(tooShort);
  image->GetCellData()->AddArray(tooShort);
  EXPECT_NEAR(FindArea(penumbra::ExtractSurfaces(image).Data), 22.0, 1e-6);
}

TEST(SurfaceExtraction, EmptyDataAreNoProblem)
{
  EXPECT_EQ(penumbra::ExtractSurfaces(nullptr).Problem, "");
  const vtkNew<vtkImageData> image;
  const vtkNew<vtkUnstructuredGrid> grid;
  const vtkNew<vtkPolyData> polygons;
  const vtkNew<vtkMultiBlockDataSet> blocks;
  for (vtkDataObject* data :
    { static_cast<vtkDataObject*>(image), static_cast<vtkDataObject*>(grid),
      static_cast<vtkDataObject*>(polygons), static_cast<vtkDataObject*>(blocks) })
  {
    EXPECT_EQ(penumbra::ExtractSurfaces(data).Problem, "") << data->GetClassName();
  }
}

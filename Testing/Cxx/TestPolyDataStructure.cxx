// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What VTK takes for granted of polygonal data.

#include "PolyDataStructure.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersionMacros.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace
{

/// Of `points` points, and cells that name them.
vtkNew<vtkPolyData> MakeData(vtkIdType points)
{
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPoints> places;
  places->SetNumberOfPoints(points);
  data->SetPoints(places);
  return data;
}

template <typename Array>
vtkNew<vtkCellArray> MakeCells(std::initializer_list<int> offsets, std::initializer_list<int> ids)
{
  vtkNew<Array> offsetArray, idArray;
  for (const int offset : offsets)
  {
    offsetArray->InsertNextValue(offset);
  }
  for (const int id : ids)
  {
    idArray->InsertNextValue(id);
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsetArray, idArray);
  return cells;
}

void ExpectProblem(vtkPolyData* data, const std::string& words)
{
  const std::string problem = penumbra::FindStructureProblem(data);
  EXPECT_NE(problem.find(words), std::string::npos) << problem;
  EXPECT_NE(problem.find("allowed: "), std::string::npos) << problem;
}

} // namespace

template <typename Array>
class PolyDataStructure : public testing::Test
{
};

using Storages = testing::Types<vtkTypeInt32Array, vtkTypeInt64Array>;
TYPED_TEST_SUITE(PolyDataStructure, Storages);

TYPED_TEST(PolyDataStructure, NothingIsWrongWithGoodData)
{
  const auto data = MakeData(4);
  EXPECT_EQ(penumbra::FindStructureProblem(data), "");
  data->SetVerts(MakeCells<TypeParam>({ 0, 1 }, { 3 }));
  data->SetLines(MakeCells<TypeParam>({ 0, 2 }, { 0, 3 }));
  data->SetPolys(MakeCells<TypeParam>({ 0, 3, 3, 7 }, { 0, 1, 2, 3, 2, 1, 0 }));
  data->SetStrips(MakeCells<TypeParam>({ 0, 3 }, { 0, 1, 2 }));
  EXPECT_EQ(penumbra::FindStructureProblem(data), "");
}

TYPED_TEST(PolyDataStructure, IdsOutOfRange)
{
  for (const int id : { 4, -1, 0x7fffffff, -0x7fffffff })
  {
    const auto cells = MakeCells<TypeParam>({ 0, 3, 3, 6 }, { 0, 1, 2, 3, id, 1 });
    const std::string words = " 2 names point " + std::to_string(id) + "; allowed: 0 to 3";
    const auto verts = MakeData(4), lines = MakeData(4), polys = MakeData(4), strips = MakeData(4);
    verts->SetVerts(cells);
    ExpectProblem(verts, "vertex" + words);
    lines->SetLines(cells);
    ExpectProblem(lines, "line" + words);
    polys->SetPolys(cells);
    ExpectProblem(polys, "polygon" + words);
    strips->SetStrips(cells);
    ExpectProblem(strips, "strip" + words);
  }
}

TYPED_TEST(PolyDataStructure, NoPoints)
{
  vtkNew<vtkPolyData> data;
  data->SetPolys(MakeCells<TypeParam>({ 0, 3 }, { 0, 0, 0 }));
  ExpectProblem(data, "polygon 0 names point 0; allowed: none");
}

TYPED_TEST(PolyDataStructure, OffsetsOutOfOrder)
{
  for (const auto& offsets : { std::initializer_list<int>{ 0, 3, 2, 3 }, { 1, 3 }, { 0, 4 },
         { 0, -1, 3 }, { 0, 0x7fffffff, 3 } })
  {
    const auto data = MakeData(4);
    data->SetPolys(MakeCells<TypeParam>(offsets, { 0, 1, 2 }));
    ExpectProblem(data, "never decrease");
  }
}

TYPED_TEST(PolyDataStructure, ShortStrips)
{
  const auto data = MakeData(4);
  data->SetStrips(MakeCells<TypeParam>({ 0, 3, 5 }, { 0, 1, 2, 3, 2 }));
  ExpectProblem(data, "strip 1 has 2 points");
}

TYPED_TEST(PolyDataStructure, Grids)
{
  vtkNew<vtkUnstructuredGrid> grid;
  EXPECT_EQ(penumbra::FindStructureProblem(grid), "");
  grid->SetPoints(MakeData(4)->GetPoints());
  grid->SetCells(VTK_TRIANGLE, MakeCells<TypeParam>({ 0, 3, 6 }, { 0, 1, 2, 3, 2, 1 }));
  EXPECT_EQ(penumbra::FindStructureProblem(grid), "");
  grid->SetCells(VTK_TRIANGLE, MakeCells<TypeParam>({ 0, 3, 6 }, { 0, 1, 2, 3, 4, 1 }));
  EXPECT_EQ(penumbra::FindStructureProblem(grid), "cell 1 names point 4; allowed: 0 to 3");
}

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
// What newer releases keep cells of one size in.
TEST(PolyDataStructureOfFixedSize, NamesWhatIsWrong)
{
  for (const bool is64Bit : { false, true })
  {
    vtkNew<vtkCellArray> cells;
    is64Bit ? cells->UseFixedSize64BitStorage(3) : cells->UseFixedSize32BitStorage(3);
    cells->InsertNextCell({ 0, 1, 2 });
    const auto data = MakeData(4);
    data->SetPolys(cells);
    EXPECT_EQ(penumbra::FindStructureProblem(data), "");
    cells->InsertNextCell({ 0, 4, 2 });
    EXPECT_EQ(penumbra::FindStructureProblem(data), "polygon 1 names point 4; allowed: 0 to 3");
  }
}
#endif

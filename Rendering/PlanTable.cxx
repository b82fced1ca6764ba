// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlanTable.h"

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

namespace penumbra
{
namespace
{

template <typename Array>
void AddColumn(vtkTable* table, const char* name)
{
  vtkNew<Array> column;
  column->SetName(name);
  table->AddColumn(column);
}

vtkVariant ToVariant(std::size_t value)
{
  return static_cast<vtkIdType>(value);
}

} // namespace

void MakePlanTable(vtkTable* table)
{
  table->Initialize();
  AddColumn<vtkIntArray>(table, "Receiver");
  AddColumn<vtkIntArray>(table, "Light");
  AddColumn<vtkStringArray>(table, "Effect");
  AddColumn<vtkStringArray>(table, "Reason");
  AddColumn<vtkIntArray>(table, "LightSamples");
  AddColumn<vtkIdTypeArray>(table, "Texels");
  AddColumn<vtkIdTypeArray>(table, "Triangles");
  AddColumn<vtkIdTypeArray>(table, "SceneTriangles");
  AddColumn<vtkDoubleArray>(table, "Milliseconds");
  AddColumn<vtkIdTypeArray>(table, "Bytes");
  AddColumn<vtkIdTypeArray>(table, "ExactTexels");
}

void AddToPlanTable(int receiver, const vtkRadianceBaker::Report& report, vtkTable* table)
{
  for (std::size_t light = 0; light < report.Pairs.size(); ++light)
  {
    const vtkRadianceBaker::PairReport& pair = report.Pairs[light];
    const vtkVariant values[] = { receiver, static_cast<int>(light), GetEffectName(pair.Effect),
      pair.Reason.c_str(), pair.LightSamples, ToVariant(pair.Texels), ToVariant(pair.Triangles),
      ToVariant(pair.SceneTriangles), pair.Milliseconds, ToVariant(pair.Bytes),
      ToVariant(pair.ExactTexels) };
    const vtkIdType row = table->InsertNextBlankRow();
    vtkIdType column = 0;
    for (const vtkVariant& value : values)
    {
      table->SetValue(row, column++, value);
    }
  }
}

} // namespace penumbra

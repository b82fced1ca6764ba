// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolyDataFromBytes.h"

#include "ShadowSettings.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkShadowFieldData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

namespace
{

constexpr int MostPoints = 24;
constexpr int MostCells = 8;
constexpr int MostCellPoints = 7;
/// Of the cells, the share that is broken in data that may be: the others get further.
constexpr int OneIdIn = 8;

vtkSmartPointer<vtkPoints> MakePoints(ByteReader& bytes)
{
  constexpr int types[] = { VTK_FLOAT, VTK_DOUBLE, VTK_DOUBLE, VTK_INT };
  const int type = types[bytes.Below(4)];
  const int count = bytes.Below(MostPoints + 1);
  if (count == 0 && bytes.Flag())
  {
    return nullptr;
  }
  vtkSmartPointer<vtkPoints> points = vtkSmartPointer<vtkPoints>::Take(vtkPoints::New(type));
  for (int i = 0; i < count; ++i)
  {
    double p[3];
    for (double& coordinate : p)
    {
      coordinate = bytes.Number();
      // What no number of the type is would be for the conversion to say, not for the product.
      const bool isInt = coordinate > -1e9 && coordinate < 1e9;
      const bool isFloat = !(coordinate > 3e38) && !(coordinate < -3e38);
      if ((type == VTK_INT && !isInt) || (type == VTK_FLOAT && !isFloat))
      {
        coordinate = type == VTK_INT ? 7.0 : std::numeric_limits<double>::infinity();
      }
    }
    points->InsertNextPoint(p);
  }
  return points;
}

/// Mostly the id of a point.
vtkTypeInt64 MakeId(ByteReader& bytes, vtkIdType points, bool mayBreak)
{
  const int choice = bytes.Byte();
  if (mayBreak && choice % OneIdIn == 0)
  {
    const vtkTypeInt64 broken[] = { -1, points, points + 1, 0x7fffffff, -0x7fffffff, 1 << 20 };
    return broken[bytes.Below(6)];
  }
  return points > 0 ? choice % points : 0;
}

template <typename Array>
vtkSmartPointer<vtkCellArray> MakeCells(ByteReader& bytes, vtkIdType points, bool mayBreak)
{
  vtkNew<Array> offsets, ids;
  vtkTypeInt64 offset = mayBreak && bytes.Below(OneIdIn) == 1 ? 1 : 0;
  offsets->InsertNextValue(static_cast<typename Array::ValueType>(offset));
  for (int cells = bytes.Below(MostCells); cells > 0; --cells)
  {
    const int size = bytes.Below(MostCellPoints + 1);
    for (int i = 0; i < size; ++i)
    {
      ids->InsertNextValue(static_cast<typename Array::ValueType>(MakeId(bytes, points, mayBreak)));
    }
    offset += size;
    const bool isBroken = mayBreak && bytes.Below(OneIdIn) == 1;
    offsets->InsertNextValue(
      static_cast<typename Array::ValueType>(isBroken ? MakeId(bytes, offset, true) : offset));
  }
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, ids);
  return array;
}

void SetCells(ByteReader& bytes, vtkPolyData* data)
{
  const int kinds = bytes.Byte();
  const bool mayBreak = (kinds & 0x30) == 0x30;
  const vtkIdType points = data->GetNumberOfPoints();
  const auto make = [&]
  {
    return (kinds & 0x40) != 0 ? MakeCells<vtkTypeInt32Array>(bytes, points, mayBreak)
                               : MakeCells<vtkTypeInt64Array>(bytes, points, mayBreak);
  };
  data->SetPolys(make());
  if ((kinds & 1) != 0)
  {
    data->SetStrips(make());
  }
  if ((kinds & 2) != 0)
  {
    data->SetVerts(make());
  }
  if ((kinds & 4) != 0)
  {
    data->SetLines(make());
  }
}

/// A numeric array, or at times one of strings, with any numbers in it.
vtkSmartPointer<vtkAbstractArray> MakeArray(
  ByteReader& bytes, const char* name, int components, vtkIdType tuples)
{
  vtkSmartPointer<vtkAbstractArray> array;
  switch (bytes.Below(8))
  {
    case 0:
      array = vtkSmartPointer<vtkStringArray>::New();
      break;
    case 1:
      array = vtkSmartPointer<vtkFloatArray>::New();
      break;
    default:
      array = vtkSmartPointer<vtkDoubleArray>::New();
  }
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  if (auto* numbers = vtkDataArray::SafeDownCast(array))
  {
    const bool isFloat = numbers->GetDataType() == VTK_FLOAT;
    for (vtkIdType i = 0; i < tuples * components; ++i)
    {
      const double value = bytes.Number();
      const bool isTooLarge = value > 3e38 || value < -3e38;
      numbers->SetComponent(i / components, static_cast<int>(i % components),
        isFloat && isTooLarge ? std::numeric_limits<double>::infinity() : value);
    }
  }
  return array;
}

void AddCellArrays(ByteReader& bytes, vtkPolyData* data)
{
  const char* const names[] = { FuzzedRadianceArray, vtkShadowFieldData::GetRadianceArrayName(),
    "PenumbraRegion", "Other" };
  for (const char* name : names)
  {
    const int kind = bytes.Byte();
    if (kind % 3 == 0)
    {
      continue;
    }
    constexpr int components[] = { 3, 1, 2, 4 };
    const vtkIdType cells = kind % 16 == 1 ? bytes.Below(MostCells) : data->GetNumberOfCells();
    data->GetCellData()->AddArray(
      MakeArray(bytes, name, components[kind % 16 < 12 ? kind % 2 : kind % 4], cells));
  }
}

/// Some cells, and at times more or fewer than there are, are hidden or copies.
void AddGhostTypes(ByteReader& bytes, vtkPolyData* data)
{
  if (bytes.Below(4) != 1)
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  const vtkIdType count =
    bytes.Below(OneIdIn) == 1 ? bytes.Below(MostCells) : data->GetNumberOfCells();
  for (vtkIdType i = 0; i < count; ++i)
  {
    ghosts->InsertNextValue(static_cast<unsigned char>(bytes.Byte()));
  }
  data->GetCellData()->AddArray(ghosts);
}

penumbra::ReceiverSettings MakeReceiverSettings(ByteReader& bytes)
{
  penumbra::ReceiverSettings settings;
  settings.TexelSize = bytes.Number();
  settings.LightSamples = 1 + bytes.Byte();
  settings.Supersampling = 1 << bytes.Below(4);
  settings.Side = static_cast<penumbra::ReceiverSide>(bytes.Below(5));
  settings.Reflectance.x = bytes.Number();
  settings.AmbientRadiance.y = bytes.Number();
  return settings;
}

penumbra::LightSettings MakeLightSettings(ByteReader& bytes)
{
  penumbra::LightSettings settings;
  settings.Shape = static_cast<penumbra::LightKind>(bytes.Below(9) - 1);
  settings.TwoSided = bytes.Flag();
  for (glm::dvec3* v : { &settings.Origin, &settings.Point1, &settings.Point2, &settings.Radiance })
  {
    for (int i = 0; i < 3; ++i)
    {
      (*v)[i] = bytes.Number();
    }
  }
  settings.AngularDiameter = bytes.Number();
  return settings;
}

void AddFieldData(ByteReader& bytes, vtkFieldData* fieldData)
{
  const int kinds = bytes.Byte();
  if ((kinds & 1) != 0)
  {
    vtkShadowFieldData::Write(MakeReceiverSettings(bytes), fieldData);
  }
  if ((kinds & 2) != 0)
  {
    vtkShadowFieldData::Write(MakeLightSettings(bytes), fieldData);
  }
  if ((kinds & 12) == 12)
  {
    vtkShadowFieldData::WriteRefusal("refused", fieldData);
  }
  // One setting of any size and value.
  if ((kinds & 16) != 0 && fieldData->GetNumberOfArrays() > 0)
  {
    const std::string name = fieldData->GetArrayName(bytes.Below(fieldData->GetNumberOfArrays()));
    fieldData->AddArray(MakeArray(bytes, name.c_str(), 1 + bytes.Below(4), bytes.Below(3)));
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> MakePolyData(ByteReader& bytes)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  AddFieldData(bytes, data->GetFieldData());
  data->SetPoints(MakePoints(bytes));
  SetCells(bytes, data);
  AddCellArrays(bytes, data);
  AddGhostTypes(bytes, data);
  return data;
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What makes no sense gets one clear message, and the rest of the scene is drawn.

#include "Messages.h"
#include "PassScene.h"

#include "vtkAreaLightFromSurface.h"
#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPolyData.h"
#include "vtkRadianceMap.h"
#include "vtkShadowFieldData.h"
#include "vtkSphereSource.h"
#include "vtkStructuredGrid.h"
#include "vtkTable.h"
#include "vtkTrivialProducer.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// A RadianceMap of a floor under a light, to which tests add what makes no sense.
struct FloorMap
{
  FloorMap()
  {
    this->Plane->SetOrigin(-1, -1, 0);
    this->Plane->SetPoint1(1, -1, 0);
    this->Plane->SetPoint2(-1, 1, 0);
    this->Receiver->SetInputConnection(this->Plane->GetOutputPort());
    this->Receiver->SetTexelSize(0.25);
    this->Light->SetOrigin(-0.5, 0.5, 2.0);
    this->Light->SetPoint1(0.5, 0.5, 2.0);
    this->Light->SetPoint2(-0.5, -0.5, 2.0);
    this->Map->AddInputConnection(vtkRadianceMap::RECEIVERS, this->Receiver->GetOutputPort());
    this->Map->AddInputConnection(vtkRadianceMap::LIGHTS, this->Light->GetOutputPort());
  }

  unsigned int CountBlocks()
  {
    this->Map->Update();
    return this->Map->GetOutput()->GetNumberOfBlocks();
  }

  /// All values of all texels of the first receiver.
  void ExpectFinite()
  {
    ASSERT_GE(this->CountBlocks(), 1u);
    auto* grid = vtkStructuredGrid::SafeDownCast(this->Map->GetOutput()->GetBlock(0));
    for (int i = 0; i < grid->GetCellData()->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = grid->GetCellData()->GetArray(i);
      for (vtkIdType j = 0; j < array->GetNumberOfValues(); ++j)
      {
        const int components = array->GetNumberOfComponents();
        ASSERT_TRUE(
          std::isfinite(array->GetComponent(j / components, static_cast<int>(j % components))));
      }
    }
  }

  vtkNew<vtkPlaneSource> Plane;
  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Light;
  vtkNew<vtkRadianceMap> Map;
};

vtkSmartPointer<vtkPolyData> MakeTriangle(double x)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(x, 0.0, 1.0);
  points->InsertNextPoint(0.5, 0.0, 1.0);
  points->InsertNextPoint(0.0, 0.5, 1.0);
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2 });
  data->SetPoints(points);
  data->SetPolys(polygons);
  return data;
}

} // namespace

TEST(BadInput, CurvedReceiver)
{
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(sphere->GetOutputPort());
  const Messages messages;
  receiver->Update();
  messages.ExpectOne({ "ShadowReceiver", "degrees", "allowed" });
  EXPECT_EQ(receiver->GetOutput()->GetNumberOfCells(), sphere->GetOutput()->GetNumberOfCells());
  vtkFieldData* fieldData = receiver->GetOutput()->GetFieldData();
  EXPECT_FALSE(vtkShadowFieldData::ReadReceiver(fieldData));
  EXPECT_NE(vtkShadowFieldData::ReadRefusal(fieldData), "");
}

TEST(BadInput, EmptyReceiver)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(empty);
  const Messages messages;
  receiver->Update();
  messages.ExpectOne({ "ShadowReceiver", "no polygon", "allowed" });
}

// In a parallel run, a process may hold none of the receiver, which is nothing wrong.
TEST(BadInput, EmptyPieceOfAReceiver)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(empty);
  const Messages messages;
  receiver->UpdatePiece(1, 2, 0);
  EXPECT_EQ(messages.GetText(), "");
}

TEST(BadInput, NaNInReceiver)
{
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(MakeTriangle(NaN));
  const Messages messages;
  receiver->Update();
  messages.ExpectOne({ "ShadowReceiver", "not finite", "allowed" });
}

// One message on the whole way: the filter has said it.
TEST(BadInput, NaNInReceiverOfAMap)
{
  FloorMap floor;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(MakeTriangle(NaN));
  floor.Map->AddInputConnection(vtkRadianceMap::RECEIVERS, receiver->GetOutputPort());
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, receiver->GetOutputPort());
  const Messages messages;
  EXPECT_EQ(floor.CountBlocks(), 1u);
  messages.ExpectOne({ "ShadowReceiver", "not finite", "allowed" });
}

// Data that never went through the filter are reported by the map, once.
TEST(BadInput, NaNInDataOfAMap)
{
  FloorMap floor;
  vtkNew<vtkTrivialProducer> receiver;
  receiver->SetOutput(MakeTriangle(NaN));
  floor.Map->AddInputConnection(vtkRadianceMap::RECEIVERS, receiver->GetOutputPort());
  const Messages messages;
  EXPECT_EQ(floor.CountBlocks(), 1u);
  messages.ExpectOne({ "Receivers[1]", "not finite", "allowed" });
}

// VTK takes it for granted that cells name points, and crashes.
TEST(BadInput, CellsThatNameNoPoints)
{
  FloorMap floor;
  vtkNew<vtkTrivialProducer> producer;
  const vtkSmartPointer<vtkPolyData> data = MakeTriangle(0.0);
  data->GetPolys()->InsertNextCell({ 0, 1, 3 });
  producer->SetOutput(data);
  vtkNew<vtkShadowReceiver> receiver;
  vtkNew<vtkAreaLightFromSurface> light;
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ receiver, light })
  {
    filter->SetInputConnection(producer->GetOutputPort());
    const Messages messages;
    filter->Update();
    messages.ExpectOne({ "polygon 1 names point 3; allowed: 0 to 2" });
    EXPECT_EQ(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
  }
  floor.Map->AddInputConnection(vtkRadianceMap::RECEIVERS, receiver->GetOutputPort());
  floor.Map->AddInputConnection(vtkRadianceMap::LIGHTS, light->GetOutputPort());
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, producer->GetOutputPort());
  const Messages messages;
  floor.ExpectFinite();
  messages.ExpectOne({ "Occluders[0]", "polygon 1 names point 3; allowed: 0 to 2" });
}

// Finite, and yet too large for the square of an area.
TEST(BadInput, HugeCoordinates)
{
  for (const double x : { 1e76, -1e200 })
  {
    vtkNew<vtkShadowReceiver> receiver;
    receiver->SetInputData(MakeTriangle(x));
    const Messages messages;
    receiver->Update();
    messages.ExpectOne({ "ShadowReceiver", "beyond 1e75", "allowed" });
  }
}

// What was refused for another reason, and has a NaN since, has two things to be said of it.
TEST(BadInput, NaNAfterARefusal)
{
  FloorMap floor;
  floor.Receiver->SetTexelSize(-1.0);
  const Messages messages;
  floor.Receiver->Update();
  messages.ExpectOne({ "TexelSize is -1" });
  vtkNew<vtkPolyData> changed;
  changed->ShallowCopy(floor.Receiver->GetOutput());
  changed->SetPoints(MakeTriangle(NaN)->GetPoints());
  changed->SetPolys(MakeTriangle(NaN)->GetPolys());
  vtkNew<vtkTrivialProducer> occluder;
  occluder->SetOutput(changed);
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, occluder->GetOutputPort());
  EXPECT_EQ(floor.CountBlocks(), 0u);
  EXPECT_EQ(messages.Count("ERROR:"), 2) << messages.GetText();
  EXPECT_EQ(messages.Count("Occluders[0]"), 1) << messages.GetText();
}

// The last filter on the way has the last word.
TEST(BadInput, RefusalIsNotInherited)
{
  FloorMap floor;
  vtkNew<vtkShadowReceiver> second;
  second->SetInputConnection(floor.Receiver->GetOutputPort());
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, second->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, floor.Light->GetOutputPort());
  const Messages messages;
  floor.Receiver->SetTexelSize(-1.0);
  second->SetTexelSize(0.25);
  map->Update();
  EXPECT_EQ(map->GetOutput()->GetNumberOfBlocks(), 1u);
  floor.Receiver->SetTexelSize(0.25);
  second->SetTexelSize(-1.0);
  map->Update();
  EXPECT_EQ(map->GetOutput()->GetNumberOfBlocks(), 0u);
  EXPECT_EQ(messages.Count("ERROR:"), 2) << messages.GetText();
}

TEST(BadInput, NaNInOccluder)
{
  FloorMap floor;
  vtkNew<vtkTrivialProducer> occluder;
  occluder->SetOutput(MakeTriangle(NaN));
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, occluder->GetOutputPort());
  const Messages messages;
  floor.ExpectFinite();
  messages.ExpectOne({ "Occluders[0]", "1 polygons", "not finite", "allowed" });
}

// The rest is baked, and one message names the input.
TEST(BadInput, OccluderWithoutSurface)
{
  FloorMap floor;
  vtkNew<vtkTrivialProducer> occluder;
  vtkNew<vtkTable> table;
  occluder->SetOutput(table);
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, occluder->GetOutputPort());
  const Messages messages;
  floor.ExpectFinite();
  messages.ExpectOne({ "Occluders[0]", "is a vtkTable, which has no surface", "allowed" });
}

// A hidden cell may be of any shape: nothing of it is seen.
TEST(BadInput, HiddenCellsOfAReceiverAndALight)
{
  const vtkSmartPointer<vtkPolyData> data = MakeTriangle(0.0);
  data->GetPoints()->InsertNextPoint(0.0, 0.0, 2.0);
  data->GetPolys()->InsertNextCell({ 0, 1, 2, 3 });
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->InsertNextValue(0);
  ghosts->InsertNextValue(vtkDataSetAttributes::HIDDENCELL);
  data->GetCellData()->AddArray(ghosts);
  vtkNew<vtkShadowReceiver> receiver;
  vtkNew<vtkAreaLightFromSurface> light;
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ receiver, light })
  {
    filter->SetInputDataObject(data);
    const Messages messages;
    filter->Update();
    EXPECT_EQ(messages.GetText(), "");
    EXPECT_EQ(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 1);
  }
}

TEST(BadInput, LightWithoutArea)
{
  FloorMap floor;
  floor.Light->SetPoint2(floor.Light->GetPoint1());
  const Messages messages;
  floor.Light->Update();
  messages.ExpectOne({ "AreaLight", "area", "allowed" });
}

TEST(BadInput, LightWithNaN)
{
  FloorMap floor;
  floor.Light->SetOrigin(NaN, 0.0, 0.0);
  const Messages messages;
  floor.Light->Update();
  messages.ExpectOne({ "AreaLight", "Origin is (nan, 0, 0)", "allowed" });
}

namespace
{

/// A source that makes no sense says so once and has nothing in its output, and the floor is baked
/// without it.
void ExpectRefused(vtkAreaLightSource* light, const std::vector<std::string>& words)
{
  FloorMap floor;
  const Messages messages;
  light->Update();
  messages.ExpectOne(words);
  EXPECT_EQ(light->GetOutput()->GetNumberOfCells(), 0);
  floor.Map->AddInputConnection(vtkRadianceMap::LIGHTS, light->GetOutputPort());
  floor.ExpectFinite();
}

} // namespace

TEST(BadInput, AngularDiameterOutOfRange)
{
  for (const double diameter : { 180.0, -1.0, NaN })
  {
    vtkNew<vtkAreaLightSource> light;
    light->SetShape(vtkAreaLightSource::DIRECTIONAL);
    light->SetAngularDiameter(diameter);
    ExpectRefused(light, { "AreaLight", "AngularDiameter is ", "less than 180" });
  }
}

TEST(BadInput, DiskWithoutRadius)
{
  vtkNew<vtkAreaLightSource> light;
  light->SetShape(vtkAreaLightSource::DISK);
  light->SetPoint1(light->GetOrigin());
  ExpectRefused(light, { "AreaLight", "area", "is 0", "allowed" });
}

TEST(BadInput, SegmentWithoutLength)
{
  vtkNew<vtkAreaLightSource> light;
  light->SetShape(vtkAreaLightSource::SEGMENT);
  light->SetPoint1(light->GetOrigin());
  ExpectRefused(light, { "AreaLight", "distance from Origin to Point1 is 0", "more than 0" });
}

TEST(BadInput, DirectionalWithoutDirection)
{
  vtkNew<vtkAreaLightSource> light;
  light->SetShape(vtkAreaLightSource::DIRECTIONAL);
  light->SetPoint1(light->GetOrigin());
  ExpectRefused(light, { "AreaLight", "distance from Origin to Point1 is 0", "more than 0" });
}

TEST(BadInput, UnknownShape)
{
  for (const int shape : { -1, 6 })
  {
    vtkNew<vtkAreaLightSource> light;
    light->SetShape(shape);
    ExpectRefused(light, { "AreaLight", "Shape is " + std::to_string(shape), "allowed: 0" });
  }
}

TEST(BadInput, RadianceOutOfRange)
{
  for (const double radiance : { -1.0, 1e31, NaN })
  {
    vtkNew<vtkAreaLightSource> light;
    light->SetShape(vtkAreaLightSource::POINT);
    light->SetRadiance(1.0, radiance, 1.0);
    ExpectRefused(light, { "AreaLight", "Radiance is (1, ", "0 to 1e30" });
  }
}

namespace
{

/// A pane whose corners tests move, under a filter that makes a light of it.
struct PaneLight
{
  PaneLight()
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->InsertNextPoint(-0.5, -0.5, 2.0);
    points->InsertNextPoint(-0.5, 0.5, 2.0);
    points->InsertNextPoint(0.5, 0.5, 2.0);
    points->InsertNextPoint(0.5, -0.5, 2.0);
    vtkNew<vtkCellArray> polygons;
    polygons->InsertNextCell({ 0, 1, 2, 3 });
    this->Pane->SetPoints(points);
    this->Pane->SetPolys(polygons);
    this->Filter->SetInputData(this->Pane);
  }

  void SetArray(std::initializer_list<double> values)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName("Glow");
    array->SetNumberOfComponents(static_cast<int>(values.size()));
    array->InsertNextTuple(values.begin());
    this->Pane->GetCellData()->AddArray(array);
    this->Filter->SetRadianceArray("Glow");
  }

  void ExpectRefused(const std::vector<std::string>& words)
  {
    FloorMap floor;
    const Messages messages;
    this->Filter->Update();
    messages.ExpectOne(words);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfCells(), 0);
    floor.Map->AddInputConnection(vtkRadianceMap::LIGHTS, this->Filter->GetOutputPort());
    floor.ExpectFinite();
  }

  vtkNew<vtkPolyData> Pane;
  vtkNew<vtkAreaLightFromSurface> Filter;
};

} // namespace

// What the cases below change is good before they do.
TEST(BadInput, NothingInAGoodPane)
{
  PaneLight light;
  light.SetArray({ 1.0, 0.0, 0.5 });
  FloorMap floor;
  floor.Map->AddInputConnection(vtkRadianceMap::LIGHTS, light.Filter->GetOutputPort());
  const Messages messages;
  floor.ExpectFinite();
  EXPECT_EQ(messages.GetText(), "");
  EXPECT_EQ(light.Filter->GetOutput()->GetNumberOfCells(), 1);
}

TEST(BadInput, ConcavePolygonAsLight)
{
  PaneLight light;
  light.Pane->GetPoints()->SetPoint(2, -0.3, -0.3, 2.0);
  light.ExpectRefused({ "AreaLightFromSurface", "polygon 0", "planar and convex", "allowed" });
}

TEST(BadInput, BentPolygonAsLight)
{
  PaneLight light;
  light.Pane->GetPoints()->SetPoint(2, 0.5, 0.5, 2.1);
  light.ExpectRefused({ "AreaLightFromSurface", "polygon 0", "planar and convex", "allowed" });
}

TEST(BadInput, NaNInPolygonAsLight)
{
  PaneLight light;
  light.Pane->GetPoints()->SetPoint(2, 0.5, NaN, 2.0);
  light.ExpectRefused({ "AreaLightFromSurface", "polygon 0", "not finite", "allowed" });
}

TEST(BadInput, NoPolygonAsLight)
{
  PaneLight light;
  light.Pane->Initialize();
  light.ExpectRefused({ "AreaLightFromSurface", "no polygon", "allowed" });
}

TEST(BadInput, PolygonWithoutAreaAsLight)
{
  PaneLight light;
  light.Pane->GetPoints()->SetPoint(1, -0.5, -0.5, 2.0);
  light.Pane->GetPoints()->SetPoint(2, 0.5, -0.5, 2.0);
  light.ExpectRefused({ "AreaLightFromSurface", "no polygon has an area", "allowed" });
}

TEST(BadInput, MissingRadianceArray)
{
  PaneLight light;
  light.Filter->SetRadianceArray("Glow");
  light.ExpectRefused({ "AreaLightFromSurface", "RadianceArray is 'Glow'", "allowed" });
}

TEST(BadInput, RadianceArrayOfTwoComponents)
{
  PaneLight light;
  light.SetArray({ 1.0, 2.0 });
  light.ExpectRefused({ "AreaLightFromSurface", "'Glow' has 2 components", "allowed: 1 or 3" });
}

TEST(BadInput, CellArrayOfAnotherSize)
{
  PaneLight light;
  light.SetArray({ 1.0, 1.0, 1.0 });
  light.Pane->GetCellData()->GetArray("Glow")->InsertNextTuple3(1.0, 1.0, 1.0);
  light.ExpectRefused({ "AreaLightFromSurface", "'Glow' has 2 values", "each of the 1 cells" });
}

// A refused surface emits nothing, even if its input was a light before.
TEST(BadInput, RefusedSurfaceOfALight)
{
  FloorMap floor;
  vtkNew<vtkAreaLightFromSurface> surface;
  surface->SetInputConnection(floor.Light->GetOutputPort());
  surface->SetRadiance(-1.0, 1.0, 1.0);
  const Messages messages;
  surface->Update();
  messages.ExpectOne({ "AreaLightFromSurface", "Radiance is (-1, " });
  EXPECT_FALSE(vtkShadowFieldData::ReadLight(surface->GetOutput()->GetFieldData()));
}

TEST(BadInput, RadianceArrayOutOfRange)
{
  for (const double value : { -1.0, 1e31, NaN })
  {
    PaneLight light;
    light.SetArray({ 1.0, value, 1.0 });
    light.ExpectRefused({ "AreaLightFromSurface", "'Glow' is ", "at cell 0", "0 to 1e30" });
  }
}

TEST(BadInput, DarkSurfaceAsLight)
{
  PaneLight byArray;
  byArray.SetArray({ 0.0, 0.0, 0.0 });
  byArray.ExpectRefused({ "AreaLightFromSurface", "radiance greater than 0", "allowed" });
  for (const double value : { -1.0, NaN })
  {
    PaneLight byFactor;
    byFactor.Filter->SetRadiance(1.0, 1.0, value);
    byFactor.ExpectRefused({ "AreaLightFromSurface", "Radiance is (1, 1, ", "0 to 1e30" });
  }
}

// Each value is good, and their product is not.
TEST(BadInput, RadianceOfSurfaceOverflows)
{
  PaneLight light;
  light.SetArray({ 1e30 });
  light.Filter->SetRadiance(1e30, 1e30, 1e30);
  light.ExpectRefused({ "AreaLightFromSurface", "1e30", "allowed" });
}

TEST(BadInput, AccuracyOutOfRange)
{
  const auto expectRefused =
    [](const std::function<void(vtkShadowReceiver*)>& set, const std::vector<std::string>& words)
  {
    FloorMap floor;
    set(floor.Receiver);
    const Messages messages;
    EXPECT_EQ(floor.CountBlocks(), 0u);
    messages.ExpectOne(words);
  };
  for (const double value : { 2.0, -1.0, NaN })
  {
    expectRefused([&](vtkShadowReceiver* r) { r->SetErrorTolerance(value); },
      { "ShadowReceiver", "ErrorTolerance is ", "0 (off) to 1" });
  }
  for (const double value : { -1.0, NaN, std::numeric_limits<double>::infinity() })
  {
    expectRefused([&](vtkShadowReceiver* r) { r->SetSolidAnglePerSample(value); },
      { "ShadowReceiver", "SolidAnglePerSample is ", "0 (off) or" });
  }
  for (const int value : { 0, -5, 65537 })
  {
    expectRefused([&](vtkShadowReceiver* r) { r->SetMaximumLightSamples(value); },
      { "ShadowReceiver", "MaximumLightSamples is ", "1 to 65536" });
  }
}

// Accuracies that nothing can reach end where they are said to.
TEST(BadInput, AccuracyOutOfReach)
{
  FloorMap floor;
  vtkNew<vtkTrivialProducer> occluder;
  occluder->SetOutput(MakeTriangle(0.0));
  floor.Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, occluder->GetOutputPort());
  floor.Receiver->SetErrorTolerance(1e-300);
  floor.Receiver->SetMaximumLightSamples(100);
  const Messages messages;
  floor.ExpectFinite();
  floor.Receiver->SetErrorTolerance(0.0);
  floor.Receiver->SetSolidAnglePerSample(1e-300);
  floor.ExpectFinite();
  EXPECT_EQ(messages.GetText(), "");
}

TEST(BadInput, SettingsOutOfRange)
{
  FloorMap floor;
  floor.Receiver->SetTexelSize(-1.0);
  {
    const Messages messages;
    floor.Receiver->Update();
    messages.ExpectOne({ "TexelSize is -1", "allowed" });
  }
  floor.Receiver->SetTexelSize(0.0);
  floor.Receiver->SetSupersampling(3);
  const Messages messages;
  floor.Receiver->Update();
  messages.ExpectOne({ "Supersampling is 3", "1, 2 or 4" });
}

TEST(BadInput, TexelSizeTooSmall)
{
  FloorMap floor;
  floor.Receiver->SetTexelSize(1e-6);
  floor.Receiver->SetLightSamples(1);
  const Messages messages;
  EXPECT_EQ(floor.CountBlocks(), 1u);
  messages.ExpectOne({ "TexelSize", "16384", "256 MiB" });
  int dimensions[3];
  vtkStructuredGrid::SafeDownCast(floor.Map->GetOutput()->GetBlock(0))->GetDimensions(dimensions);
  // 22 bytes a texel.
  EXPECT_LE(22.0 * (dimensions[0] - 1) * (dimensions[1] - 1), 256.0 * 1024 * 1024);
  EXPECT_GE(22.0 * (dimensions[0] - 1) * (dimensions[1] - 1), 250.0 * 1024 * 1024);
}

TEST(BadInput, NoOccludersAndNoLights)
{
  FloorMap floor;
  floor.Receiver->SetAmbientRadiance(0.25, 0.25, 0.25);
  const Messages messages;
  floor.ExpectFinite();
  floor.Map->RemoveAllLights();
  floor.ExpectFinite();
  auto* grid = vtkStructuredGrid::SafeDownCast(floor.Map->GetOutput()->GetBlock(0));
  EXPECT_EQ(grid->GetCellData()->GetArray("Radiance")->GetComponent(0, 0), 0.25);
  EXPECT_EQ(grid->GetCellData()->GetArray("Visibility")->GetComponent(0, 0), 1.0);
  EXPECT_EQ(messages.GetText(), "");
}

// In a view, what is bad is left out and the rest is drawn, with one message and not one a frame.
TEST(BadInput, InAView)
{
  PassScene scene;
  vtkNew<vtkShadowReceiver> floor;
  scene.AddReceiver({ -2, -2, 0 }, { 2, -2, 0 }, { -2, 2, 0 }, floor);
  vtkNew<vtkAreaLightSource> light;
  scene.AddLight(light, { -0.5, 0.5, 3 }, { 0.5, 0.5, 3 }, { -0.5, -0.5, 3 });
  vtkNew<vtkTrivialProducer> occluder;
  occluder->SetOutput(MakeTriangle(NaN));
  scene.Add(occluder);
  const Messages messages;
  scene.Render();
  scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 1);
  EXPECT_EQ(messages.Count("left out"), 1) << messages.GetText();
  light->SetRadiance(2.0, 2.0, 2.0); // the scene is collected anew
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 0); // nothing is left that blocks
  EXPECT_EQ(messages.Count("left out"), 1) << messages.GetText();
}

TEST(BadInput, NaNInReceiverOfAView)
{
  PassScene scene;
  vtkNew<vtkAreaLightSource> light;
  scene.AddLight(light, { -0.5, 0.5, 3 }, { 0.5, 0.5, 3 }, { -0.5, -0.5, 3 });
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputData(MakeTriangle(NaN));
  scene.Add(receiver);
  const Messages messages;
  scene.Render();
  light->SetRadiance(2.0, 2.0, 2.0);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 0);
  messages.ExpectOne({ "ShadowReceiver", "not finite", "allowed" });
}

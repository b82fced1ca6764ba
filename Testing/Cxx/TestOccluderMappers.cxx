// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What a mapper leaves out of its data, or draws translucent, casts as it is drawn.

#include "Messages.h"
#include "PassScene.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkClipPolyData.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCubeSource.h"
#include "vtkDataSetMapper.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkGlyph3DMapper.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkImageProperty.h"
#include "vtkImageSlice.h"
#include "vtkImageSliceMapper.h"
#include "vtkLineSource.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPointGaussianMapper.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkSkybox.h"
#include "vtkTexture.h"
#include "vtkTransform.h"
#include "vtkTransformPolyDataFilter.h"
#include "vtkTubeFilter.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVersionMacros.h"
#include "vtkVolume.h"
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#include "vtkCompositePolyDataMapper2.h"
using CompositeMapper = vtkCompositePolyDataMapper2;
#else
#include "vtkCompositePolyDataMapper.h"
using CompositeMapper = vtkCompositePolyDataMapper;
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace
{

constexpr int Side = 64;

/// A floor of 4 m and 64 texels a side under a lamp.
class LampScene : public PassScene
{
public:
  LampScene()
  {
    this->Receiver->SetTexelSize(4.0 / Side);
    this->Receiver->SetLightSamples(32);
    this->AddReceiver({ -2, -2, 0 }, { 2, -2, 0 }, { -2, 2, 0 }, this->Receiver);
    this->AddLight(this->Lamp, { -0.3, 0.3, 4 }, { 0.3, 0.3, 4 }, { -0.3, -0.3, 4 });
  }

  vtkSmartPointer<vtkActor> AddMapper(vtkMapper* mapper)
  {
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    this->Renderer->AddActor(actor);
    return actor;
  }

  /// The red component of the floor's texels.
  std::vector<float> GetTexels()
  {
    this->Render();
    const vtkSmartPointer<vtkFloatArray> array = this->Pass->GetTexels(0);
    std::vector<float> red;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
    {
      red.push_back(array->GetTypedComponent(i, 0));
    }
    return red;
  }

  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Lamp;
};

/// Of the light that an empty floor gets.
std::vector<float> GetLit()
{
  return LampScene().GetTexels();
}

void ExpectSame(const std::vector<float>& found, const std::vector<float>& right, float tolerance)
{
  ASSERT_FALSE(right.empty());
  ASSERT_EQ(found.size(), right.size());
  std::size_t worst = 0;
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    worst = std::abs(found[i] - right[i]) > std::abs(found[worst] - right[worst]) ? i : worst;
  }
  EXPECT_LE(std::abs(found[worst] - right[worst]), tolerance)
    << "texel (" << worst % Side << ", " << worst / Side << ") is " << found[worst] << ", right is "
    << right[worst];
}

vtkSmartPointer<vtkPolyData> MakeBox(double x)
{
  vtkNew<vtkCubeSource> box;
  box->SetBounds(x - 0.4, x + 0.4, -0.5, 0.5, 0.5, 1.0);
  box->Update();
  return box->GetOutput();
}

/// A pane over the floor of two cells, with opacities at its cells or at its points.
vtkSmartPointer<vtkPolyData> MakePane(const std::vector<double>& values, bool areOfCells)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-1, -1, 1);
  plane->SetPoint1(1, -1, 1);
  plane->SetPoint2(-1, 1, 1);
  plane->SetXResolution(2);
  plane->Update();
  vtkSmartPointer<vtkPolyData> data = plane->GetOutput();
  vtkNew<vtkDoubleArray> array;
  array->SetName("Value");
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  vtkDataSetAttributes* attributes = data->GetPointData();
  if (areOfCells)
  {
    attributes = data->GetCellData();
  }
  attributes->SetScalars(array);
  return data;
}

/// Maps 0 to 1 onto 256 opacities of 0 to 1.
vtkSmartPointer<vtkLookupTable> MakeOpacityTable()
{
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(256);
  for (int i = 0; i < 256; ++i)
  {
    table->SetTableValue(i, 1, 1, 1, i / 255.0);
  }
  table->SetRange(0.0, 1.0);
  return table;
}

vtkSmartPointer<vtkPolyDataMapper> MakeMapper(vtkPolyData* data)
{
  auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(data);
  return mapper;
}

std::vector<float> GetTexelsOf(vtkMapper* mapper, double opacity = 1.0)
{
  LampScene scene;
  scene.AddMapper(mapper)->GetProperty()->SetOpacity(opacity);
  return scene.GetTexels();
}

/// Two boxes as blocks.
class BlockScene : public LampScene
{
public:
  BlockScene()
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetBlock(0, this->Left);
    blocks->SetBlock(1, this->Right);
    this->Mapper->SetInputDataObject(blocks);
    this->Mapper->SetCompositeDataDisplayAttributes(this->Attributes);
    this->AddMapper(this->Mapper);
  }

  vtkSmartPointer<vtkPolyData> Left = MakeBox(-0.8), Right = MakeBox(0.8);
  vtkNew<CompositeMapper> Mapper;
  vtkNew<vtkCompositeDataDisplayAttributes> Attributes;
};

std::vector<float> GetTexelsOfBoxes(double leftOpacity)
{
  LampScene scene;
  if (leftOpacity > 0.0)
  {
    scene.AddMapper(MakeMapper(MakeBox(-0.8)))->GetProperty()->SetOpacity(leftOpacity);
  }
  scene.AddMapper(MakeMapper(MakeBox(0.8)));
  return scene.GetTexels();
}

// 32 weighted samples are added up in another order: a rounding each, of up to 1.
constexpr float Rounding = 32 * 1.2e-7f;

} // namespace

// Clipping planes are the world's: the actor is moved and scaled.
TEST(OccluderMappers, ClippingPlanesCut)
{
  const vtkSmartPointer<vtkPolyData> box = MakeBox(0.0);
  vtkNew<vtkPlane> plane;
  plane->SetNormal(1, 0, 1);
  plane->SetOrigin(0.25, 0, 0.75);
  LampScene clipped;
  const vtkSmartPointer<vtkPolyDataMapper> mapper = MakeMapper(box);
  mapper->AddClippingPlane(plane);
  const vtkSmartPointer<vtkActor> actor = clipped.AddMapper(mapper);
  actor->SetPosition(0.25, 0, 0);
  actor->SetScale(2, 1, 1);

  vtkNew<vtkPlane> own; // the same in the box's coordinates: x = 0.25 + 2 X
  own->SetNormal(2, 0, 1);
  own->SetOrigin(0, 0, 0.75);
  const auto getRight = [&](double z)
  {
    own->SetOrigin(0, 0, z);
    vtkNew<vtkClipPolyData> clip;
    clip->SetInputData(box);
    clip->SetClipFunction(own);
    clip->Update();
    LampScene scene;
    const vtkSmartPointer<vtkActor> part = scene.AddMapper(MakeMapper(clip->GetOutput()));
    part->SetPosition(0.25, 0, 0);
    part->SetScale(2, 1, 1);
    return scene.GetTexels();
  };
  ExpectSame(clipped.GetTexels(), getRight(0.75), Rounding);
  plane->SetOrigin(0.25, 0, 0.9); // a change of the plane alone
  ExpectSame(clipped.GetTexels(), getRight(0.9), Rounding);
}

TEST(OccluderMappers, SkyboxesCastNothing)
{
  LampScene scene;
  vtkNew<vtkImageData> image;
  image->SetDimensions(2, 2, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  image->GetPointData()->GetScalars()->Fill(200);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image);
  vtkNew<vtkSkybox> sky;
  sky->SetTexture(texture);
  sky->SetProjectionToSphere();
  scene.Renderer->AddActor(sky);
  ExpectSame(scene.GetTexels(), GetLit(), 0.0f);
}

TEST(OccluderMappers, BlocksHaveOpacities)
{
  BlockScene scene;
  for (const double opacity : { 0.0, 0.4, 1.0 })
  {
    scene.Attributes->SetBlockOpacity(scene.Left, opacity);
    ExpectSame(scene.GetTexels(), GetTexelsOfBoxes(opacity), Rounding);
  }
  scene.Attributes->SetBlockVisibility(scene.Left, false);
  ExpectSame(scene.GetTexels(), GetTexelsOfBoxes(0.0), Rounding);
}

TEST(OccluderMappers, CellsHaveOpacities)
{
  const vtkSmartPointer<vtkLookupTable> table = MakeOpacityTable();
  const vtkSmartPointer<vtkPolyDataMapper> mapper = MakeMapper(MakePane({ 0.0, 1.0 }, true));
  mapper->SetLookupTable(table);
  LampScene right;
  vtkNew<vtkPlaneSource> half;
  half->SetOrigin(0, -1, 1);
  half->SetPoint1(1, -1, 1);
  half->SetPoint2(0, 1, 1);
  half->Update();
  right.AddMapper(MakeMapper(half->GetOutput()));
  ExpectSame(GetTexelsOf(mapper), right.GetTexels(), Rounding);

  // 51 of 255 are exact.
  const vtkSmartPointer<vtkPolyDataMapper> faint = MakeMapper(MakePane({ 0.2, 0.2 }, true));
  faint->SetLookupTable(table);
  const vtkSmartPointer<vtkPolyDataMapper> plain = MakeMapper(MakePane({ 0.2, 0.2 }, true));
  plain->ScalarVisibilityOff();
  ExpectSame(GetTexelsOf(faint), GetTexelsOf(plain, 0.2), Rounding);
}

TEST(OccluderMappers, ColoursHaveOpacities)
{
  vtkSmartPointer<vtkPolyData> pane = MakePane({ 0.0, 0.0 }, true);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  colours->InsertNextTuple4(255, 0, 0, 0);
  colours->InsertNextTuple4(255, 0, 0, 0);
  pane->GetCellData()->SetScalars(colours);
  ExpectSame(GetTexelsOf(MakeMapper(pane)), GetLit(), 0.0f);
}

// Linear opacities are rounded to 1/16: by 1/32 of the light at most.
TEST(OccluderMappers, PointsHaveOpacities)
{
  const vtkSmartPointer<vtkPolyDataMapper> mapper =
    MakeMapper(MakePane({ 0.0, 0.5, 1.0, 0.0, 0.5, 1.0 }, false));
  mapper->SetLookupTable(MakeOpacityTable());
  LampScene scene;
  scene.AddMapper(mapper);
  scene.Lamp->SetShape(vtkAreaLightSource::POINT);
  scene.Lamp->SetOrigin(0, 0, 4);
  const std::vector<float> found = scene.GetTexels();
  LampScene empty;
  empty.Lamp->SetShape(vtkAreaLightSource::POINT);
  empty.Lamp->SetOrigin(0, 0, 4);
  const std::vector<float> lit = empty.GetTexels();
  ASSERT_EQ(found.size(), lit.size());
  for (std::size_t i = Side * Side / 2; i < Side * (Side / 2 + 1); ++i)
  {
    // The pane is 3 m below the lamp of 4 m: a texel at x sees it at 3/4 x, of opacity (1 + x) / 2.
    const double x = 0.75 * (static_cast<double>(i % Side) + 0.5 - Side / 2) * 4.0 / Side;
    const double passes = std::abs(x) < 0.97 ? 0.5 - 0.5 * x : found[i] / lit[i];
    EXPECT_NEAR(found[i] / lit[i], passes, 1.0 / 32 + 1.0 / 255) << "texel " << i % Side;
  }
}

// A quad whose edges cross is drawn as two triangles, and weakens as these do, whether the
// opacities at its points are the same or not.
TEST(OccluderMappers, CrossingPolygonsHaveOpacities)
{
  vtkNew<vtkPoints> points;
  for (const auto& [x, y] : { std::pair(-1, -1), { 1, 1 }, { 1, -1 }, { -1, 1 } })
  {
    points->InsertNextPoint(x, y, 1.0);
  }
  vtkNew<vtkCellArray> quad, fan;
  quad->InsertNextCell({ 0, 1, 2, 3 });
  fan->InsertNextCell({ 0, 1, 2 });
  fan->InsertNextCell({ 0, 2, 3 });
  for (const std::vector<double>& values :
    { std::vector<double>(4, 0.6), std::vector<double>{ 0.2, 0.6, 1.0, 0.4 } })
  {
    std::vector<float> texels[2];
    for (vtkCellArray* cells : { quad.Get(), fan.Get() })
    {
      vtkNew<vtkPolyData> data;
      data->SetPoints(points);
      data->SetPolys(cells);
      vtkNew<vtkDoubleArray> array;
      for (const double value : values)
      {
        array->InsertNextValue(value);
      }
      data->GetPointData()->SetScalars(array);
      const vtkSmartPointer<vtkPolyDataMapper> mapper = MakeMapper(data);
      mapper->SetLookupTable(MakeOpacityTable());
      mapper->UseLookupTableScalarRangeOn();
      texels[cells == quad ? 0 : 1] = GetTexelsOf(mapper);
    }
    const std::vector<float> lit = GetLit();
    EXPECT_LT(
      texels[1].at(Side / 2 * Side + Side / 2 + 10), lit.at(Side / 2 * Side + Side / 2 + 10));
    ExpectSame(texels[0], texels[1], Rounding);
  }
}

// Of two points, each with a source, a size and a direction of its own.
TEST(OccluderMappers, GlyphsCast)
{
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(-0.8, 0, 0.7);
  places->InsertNextPoint(0.8, 0.2, 0.9);
  vtkNew<vtkPolyData> points;
  points->SetPoints(places);
  const auto addArray = [&](const char* name, int components, const std::vector<double>& values)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(2);
    std::copy(values.begin(), values.end(), array->GetPointer(0));
    points->GetPointData()->AddArray(array);
  };
  addArray("Size", 3, { 1.0, 0.5, 2.0, 0.7, 1.5, 0.4 });
  addArray("Turn", 3, { 10, 20, 30, -40, 15, 60 });
  addArray("Kind", 1, { 0, 1 });
  vtkNew<vtkCubeSource> cube;
  cube->SetXLength(0.5);
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.4);
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(points);
  mapper->SetSourceConnection(0, cube->GetOutputPort());
  mapper->SetSourceConnection(1, ball->GetOutputPort());
  mapper->SetScaleModeToScaleByVectorComponents();
  mapper->SetScaleArray("Size");
  mapper->SetScaleFactor(0.6);
  mapper->SetOrientationModeToRotation();
  mapper->SetOrientationArray("Turn");
  mapper->SourceIndexingOn();
  mapper->SetSourceIndexArray("Kind");
  mapper->SetRange(0, 2);
  LampScene found;
  found.AddMapper(mapper);

  LampScene right;
  const auto addRight =
    [&](vtkAlgorithm* source, const double at[3], const double scale[3], const double turn[3])
  {
    vtkNew<vtkTransform> transform; // as vtkProp3D's orientation
    transform->Translate(at);
    transform->RotateZ(turn[2]);
    transform->RotateX(turn[0]);
    transform->RotateY(turn[1]);
    transform->Scale(0.6 * scale[0], 0.6 * scale[1], 0.6 * scale[2]);
    vtkNew<vtkTransformPolyDataFilter> moved;
    moved->SetTransform(transform);
    moved->SetInputConnection(source->GetOutputPort());
    moved->Update();
    right.AddMapper(MakeMapper(moved->GetOutput()));
  };
  const double at[][3] = { { -0.8, 0, 0.7 }, { 0.8, 0.2, 0.9 } };
  const double scale[][3] = { { 1.0, 0.5, 2.0 }, { 0.7, 1.5, 0.4 } };
  const double turn[][3] = { { 10, 20, 30 }, { -40, 15, 60 } };
  addRight(cube, at[0], scale[0], turn[0]);
  addRight(ball, at[1], scale[1], turn[1]);
  // The transformed points are floats: a sample may pass the other side of an edge. One of 32
  // samples weighs up to 1/32 of the light, and its texel's neighbours take a part of that.
  const std::vector<float> lit = GetLit();
  const float one = *std::max_element(lit.begin(), lit.end()) / 32 * 1.5f;
  ExpectSame(found.GetTexels(), right.GetTexels(), one);
  mapper->SetScaleFactor(0.0); // a change of the mapper alone
  ExpectSame(found.GetTexels(), lit, 0.0f);
}

// The whole shadow of a ball that is drawn as a point has the area of a fine ball's.
TEST(OccluderMappers, GaussianPointsCastAsBalls)
{
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(0.1, -0.1, 1.0);
  vtkNew<vtkPolyData> points;
  points->SetPoints(places);
  vtkNew<vtkPointGaussianMapper> mapper;
  mapper->SetInputData(points);
  mapper->SetScaleFactor(0.5);
  mapper->EmissiveOff();
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(0.1, -0.1, 1.0);
  ball->SetRadius(0.5);
  ball->SetThetaResolution(64);
  ball->SetPhiResolution(64);
  ball->Update();
  const std::vector<float> lit = GetLit(), found = GetTexelsOf(mapper),
                           right = GetTexelsOf(MakeMapper(ball->GetOutput()));
  double foundShadow = 0.0, rightShadow = 0.0;
  for (std::size_t i = 0; i < lit.size(); ++i)
  {
    foundShadow += lit[i] - found[i];
    rightShadow += lit[i] - right[i];
  }
  EXPECT_NEAR(foundShadow, rightShadow, 0.015 * rightShadow);
  vtkNew<vtkPointGaussianMapper> glow;
  glow->SetInputData(points);
  glow->SetScaleFactor(0.5);
  glow->EmissiveOn();
  ExpectSame(GetTexelsOf(glow), lit, 0.0f);
}

namespace
{

/// A view in which a pixel is 0.04 long: 8 high, 200 pixels.
class PixelScene : public LampScene
{
public:
  PixelScene()
  {
    this->Renderer->GetActiveCamera()->ParallelProjectionOn();
    this->Renderer->GetActiveCamera()->SetParallelScale(4.0);
  }
};

double GetShadow(const std::vector<float>& texels)
{
  const std::vector<float> lit = GetLit();
  double shadow = 0.0;
  for (std::size_t i = 0; i < lit.size(); ++i)
  {
    shadow += lit[i] - texels.at(i);
  }
  return shadow;
}

} // namespace

// 20 pixels are 0.8 across, also under an actor's matrix that scales unequally.
TEST(OccluderMappers, PointsDrawnAsSpheresCast)
{
  vtkNew<vtkPlaneSource> points;
  points->SetOrigin(-0.5, 0, 1);
  points->SetPoint1(0.5, 0, 1);
  points->SetPoint2(-0.5, 2, 1);
  points->SetXResolution(1);
  PixelScene found;
  const vtkSmartPointer<vtkActor> actor = found.Add(points);
  actor->SetScale(2.0, 0.5, 1.0);
  actor->GetProperty()->SetRepresentationToPoints();
  actor->GetProperty()->SetPointSize(20);
  EXPECT_EQ(GetShadow(found.GetTexels()), 0.0) << "flat points cast nothing";
  actor->GetProperty()->RenderPointsAsSpheresOn();
  LampScene right;
  for (const double x : { -1.0, 1.0 })
  {
    for (const double y : { 0.0, 1.0 })
    {
      vtkNew<vtkSphereSource> ball;
      ball->SetCenter(x, y, 1.0);
      ball->SetRadius(0.4);
      ball->SetThetaResolution(64);
      ball->SetPhiResolution(64);
      ball->Update();
      right.AddMapper(MakeMapper(ball->GetOutput()));
    }
  }
  const std::vector<float> before = found.GetTexels();
  const double shadow = GetShadow(right.GetTexels());
  EXPECT_NEAR(GetShadow(before), shadow, 0.015 * shadow); // as Gaussian points
  // A camera that moves changes nothing, one that is zoomed by more than 2 the size.
  found.Renderer->GetActiveCamera()->Azimuth(30.0);
  found.Renderer->GetActiveCamera()->SetParallelScale(2.5);
  ExpectSame(found.GetTexels(), before, 0.0f);
  found.Renderer->GetActiveCamera()->SetParallelScale(1.0); // balls of a sixteenth of the area
  EXPECT_LT(GetShadow(found.GetTexels()), shadow / 10.0);
}

// The prism's width is between 0.948 and 1.026 of the tube's, whichever way it is seen.
TEST(OccluderMappers, LinesDrawnAsTubesCast)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(-1, -0.5, 1);
  line->SetPoint2(1, 0.5, 1.2);
  PixelScene found;
  const vtkSmartPointer<vtkActor> actor = found.Add(line);
  actor->GetProperty()->SetLineWidth(10);
  EXPECT_EQ(GetShadow(found.GetTexels()), 0.0) << "flat lines cast nothing";
  actor->GetProperty()->RenderLinesAsTubesOn();
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputConnection(line->GetOutputPort());
  tube->SetRadius(0.2);
  tube->SetNumberOfSides(64);
  tube->CappingOn();
  tube->Update();
  const double shadow = GetShadow(GetTexelsOf(MakeMapper(tube->GetOutput())));
  EXPECT_NEAR(GetShadow(found.GetTexels()), shadow, 0.052 * shadow);
}

// As tubes, the edges of a polygon cast, and its inside does not.
TEST(OccluderMappers, WireframesOfTubesCast)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-1, -1, 0.5);
  plane->SetPoint1(1, -1, 0.5);
  plane->SetPoint2(-1, 1, 0.5);
  PixelScene scene;
  vtkProperty* property = scene.Add(plane)->GetProperty();
  property->SetRepresentationToWireframe();
  property->RenderLinesAsTubesOn();
  property->SetLineWidth(5);
  const std::vector<float> found = scene.GetTexels(), lit = GetLit();
  const std::size_t middle = Side / 2 * Side + Side / 2;
  EXPECT_EQ(found.at(middle), lit.at(middle));
  // Seen from the lamp at 4, an edge at height 0.5 is 8/7 as far out: 18 texels of 1/16.
  EXPECT_LT(found.at(middle + 18), 0.5f * lit.at(middle + 18));
  EXPECT_LT(found.at(middle - 18 * Side), 0.5f * lit.at(middle - 18 * Side));
}

// Without its border, a slice is the rectangle between the middles of its outermost voxels.
TEST(OccluderMappers, SlicesOfImagesCast)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(5, 3, 4);
  image->SetSpacing(0.3, 0.4, 0.5);
  image->SetOrigin(-0.6, -0.4, 0.0);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  vtkNew<vtkImageSliceMapper> mapper;
  mapper->SetInputData(image);
  mapper->SetOrientationToZ();
  mapper->SetSliceNumber(2);
  vtkNew<vtkImageSlice> slice;
  slice->SetMapper(mapper);
  slice->GetProperty()->SetOpacity(0.75);
  slice->SetPosition(0.2, 0.0, 0.0);
  LampScene found;
  found.Renderer->AddViewProp(slice);
  vtkNew<vtkPlaneSource> plane;
  plane->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  plane->SetOrigin(-0.4, -0.4, 1.0);
  plane->SetPoint1(0.8, -0.4, 1.0);
  plane->SetPoint2(-0.4, 0.4, 1.0);
  LampScene right;
  right.Add(plane)->GetProperty()->SetOpacity(0.75);
  const Messages messages;
  ExpectSame(found.GetTexels(), right.GetTexels(), Rounding);
  EXPECT_EQ(messages.Count("cast no shadow"), 0) << messages.GetText();
  mapper->SetSliceNumber(3);
  plane->SetCenter(0.2, 0.0, 1.5);
  ExpectSame(found.GetTexels(), right.GetTexels(), Rounding);
}

TEST(OccluderMappers, GridsCastAsTheirSurface)
{
  vtkNew<vtkImageData> grid;
  grid->SetDimensions(3, 3, 3);
  grid->SetSpacing(0.4, 0.4, 0.2);
  grid->SetOrigin(-0.4, -0.4, 0.5);
  vtkNew<vtkDataSetMapper> mapper;
  mapper->SetInputData(grid);
  vtkNew<vtkCubeSource> cube;
  cube->SetBounds(-0.4, 0.4, -0.4, 0.4, 0.5, 0.9);
  cube->Update();
  ExpectSame(GetTexelsOf(mapper), GetTexelsOf(MakeMapper(cube->GetOutput())), Rounding);
}

TEST(OccluderMappers, VolumesAreNamedOnce)
{
  LampScene scene;
  vtkNew<vtkVolume> volume; // VTK has its own error for one without a mapper
  scene.Renderer->AddVolume(volume);
  const Messages messages;
  scene.Render();
  scene.Render();
  EXPECT_EQ(messages.Count("volumes cast no shadow"), 1) << messages.GetText();
}

namespace
{

/// A texture of some texels a side, white, with alphas of 0 to 255 by column and row.
vtkSmartPointer<vtkTexture> MakeTexture(int side, const std::function<int(int, int)>& alpha)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(side, side, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      auto* texel = static_cast<unsigned char*>(image->GetScalarPointer(i, j, 0));
      std::fill_n(texel, 3, static_cast<unsigned char>(255));
      texel[3] = static_cast<unsigned char>(alpha(i, j));
    }
  }
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  return texture;
}

/// A plate over the floor, in cells, whose texture coordinates go from 0 to `repeats`.
vtkSmartPointer<vtkPolyData> MakePlate(int cells, double repeats = 1.0)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-1, -1, 1);
  plane->SetPoint1(1, -1, 1.25);
  plane->SetPoint2(-1, 1, 1);
  plane->SetResolution(cells, cells);
  plane->Update();
  vtkSmartPointer<vtkPolyData> plate = plane->GetOutput();
  vtkDataArray* coordinates = plate->GetPointData()->GetTCoords();
  for (vtkIdType i = 0; i < coordinates->GetNumberOfTuples(); ++i)
  {
    coordinates->SetComponent(i, 0, repeats * coordinates->GetComponent(i, 0));
    coordinates->SetComponent(i, 1, repeats * coordinates->GetComponent(i, 1));
  }
  return plate;
}

/// The plate cut by hand into one cell for each place where a texel lies: only those with alpha.
vtkSmartPointer<vtkPolyData> CutByHand(int cells, const std::function<bool(int, int)>& isThere)
{
  const vtkSmartPointer<vtkPolyData> plate = MakePlate(cells);
  vtkNew<vtkCellArray> kept;
  vtkNew<vtkIdList> cell;
  for (int i = 0; i < cells * cells; ++i)
  {
    if (isThere(i % cells, i / cells))
    {
      plate->GetPolys()->GetCellAtId(i, cell);
      kept->InsertNextCell(cell);
    }
  }
  plate->SetPolys(kept);
  plate->GetPointData()->SetTCoords(nullptr);
  return plate;
}

std::vector<float> GetTexelsOf(vtkPolyData* data, vtkTexture* texture, double opacity = 1.0)
{
  LampScene scene;
  const vtkSmartPointer<vtkActor> actor = scene.AddMapper(MakeMapper(data));
  actor->SetTexture(texture);
  actor->GetProperty()->SetOpacity(opacity);
  return scene.GetTexels();
}

/// Points of the same place that are computed otherwise differ by a rounding of floats, and then,
/// now and then, a sample passes an edge on the other side: it weighs 1/32 of the light, at
/// most 1.5 times after the filter.
void ExpectShadowsAlike(const std::vector<float>& found, const std::vector<float>& right)
{
  const std::vector<float> lit = GetLit();
  ExpectSame(found, right, *std::max_element(lit.begin(), lit.end()) / 32 * 1.5f);
  double differences = 0.0, shadow = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    differences += std::abs(found.at(i) - right[i]);
    shadow += lit.at(i) - right[i];
  }
  EXPECT_GT(shadow, 0.0);
  EXPECT_LE(differences, 1e-3 * shadow); // such samples are few
}

} // namespace

// A leaf that its texture cuts out casts the shadow of the leaf, whatever its polygons are, however
// the texture is repeated, and what a clipping plane leaves of both.
TEST(OccluderMappers, TexturesCutOut)
{
  const auto isLeaf = [](int i, int j)
  { return (i - 7.5) * (i - 7.5) + 3.0 * (j - 6.0) * (j - 6.0) < 40.0; };
  const vtkSmartPointer<vtkTexture> leaf =
    MakeTexture(16, [&](int i, int j) { return isLeaf(i, j) ? 255 : 0; });
  const std::vector<float> right = GetTexelsOf(MakeMapper(CutByHand(16, isLeaf)));
  ExpectShadowsAlike(GetTexelsOf(MakePlate(1), leaf), right);
  ExpectShadowsAlike(GetTexelsOf(MakePlate(3), leaf), right);
  const std::vector<float> twice =
    GetTexelsOf(MakeMapper(CutByHand(32, [&](int i, int j) { return isLeaf(i % 16, j % 16); })));
  ExpectShadowsAlike(GetTexelsOf(MakePlate(1, 2.0), leaf), twice);
  // What a clipping plane leaves has the texture as before.
  LampScene clipped;
  const vtkSmartPointer<vtkPolyDataMapper> half = MakeMapper(MakePlate(1));
  vtkNew<vtkPlane> plane;
  plane->SetNormal(1, 0, 0);
  half->AddClippingPlane(plane);
  clipped.AddMapper(half)->SetTexture(leaf);
  ExpectShadowsAlike(clipped.GetTexels(),
    GetTexelsOf(MakeMapper(CutByHand(16, [&](int i, int j) { return i >= 8 && isLeaf(i, j); }))));
  leaf->SetWrap(vtkTexture::MirroredRepeat);
  const auto mirror = [](int i) { return i < 16 ? i : 31 - i; };
  ExpectShadowsAlike(GetTexelsOf(MakePlate(1, 2.0), leaf),
    GetTexelsOf(
      MakeMapper(CutByHand(32, [&](int i, int j) { return isLeaf(mirror(i), mirror(j)); }))));
  leaf->SetWrap(vtkTexture::ClampToBorder);
  leaf->SetBorderColor(0, 0, 0, 0);
  ExpectShadowsAlike(GetTexelsOf(MakePlate(1, 2.0), leaf),
    GetTexelsOf(
      MakeMapper(CutByHand(32, [&](int i, int j) { return i < 16 && j < 16 && isLeaf(i, j); }))));
}

// Without texture coordinates a texture is not drawn, nor one of three components transparent; an
// opaque one changes no bit.
TEST(OccluderMappers, OnlyWhatIsDrawnTransparentIsCutOut)
{
  const vtkSmartPointer<vtkTexture> none = MakeTexture(2, [](int, int) { return 0; });
  const vtkSmartPointer<vtkTexture> opaque = MakeTexture(2, [](int, int) { return 255; });
  const std::vector<float> whole = GetTexelsOf(MakeMapper(MakePlate(1)));
  ExpectSame(GetTexelsOf(MakePlate(1), none), GetLit(), 0.0f);
  ExpectSame(GetTexelsOf(MakePlate(1), opaque), whole, 0.0f);
  const vtkSmartPointer<vtkPolyData> bare = MakePlate(1);
  bare->GetPointData()->SetTCoords(nullptr);
  ExpectSame(GetTexelsOf(bare, none), whole, 0.0f);
}

// Alphas weaken as an opacity does, exactly where they are few, and times the actor's.
TEST(OccluderMappers, TexturesWeaken)
{
  const vtkSmartPointer<vtkTexture> half = MakeTexture(2, [](int, int) { return 128; });
  LampScene scene;
  scene.AddMapper(MakeMapper(MakePlate(1)))->GetProperty()->SetOpacity(128 / 255.0);
  const std::vector<float> right = scene.GetTexels();
  ExpectSame(GetTexelsOf(MakePlate(1), half), right, Rounding);
  const double opacity = 0.25;
  LampScene product;
  product.AddMapper(MakeMapper(MakePlate(1)))->GetProperty()->SetOpacity(opacity * 128 / 255);
  ExpectSame(GetTexelsOf(MakePlate(1), half, opacity), product.GetTexels(), Rounding);

  // A ramp of 52 alphas is rounded to multiples of 1/16, so by 1/32 at most.
  constexpr int side = 52;
  const vtkSmartPointer<vtkTexture> ramp = MakeTexture(side, [](int i, int) { return 5 * i; });
  const vtkSmartPointer<vtkPolyData> columns = MakePlate(side);
  vtkNew<vtkDoubleArray> values;
  for (vtkIdType i = 0; i < columns->GetNumberOfCells(); ++i)
  {
    const double alpha = 5.0 * static_cast<double>(i % side) / 255;
    values->InsertNextValue(std::round(16 * alpha) / 16);
  }
  columns->GetCellData()->SetScalars(values);
  const vtkSmartPointer<vtkPolyDataMapper> mapper = MakeMapper(columns);
  mapper->SetLookupTable(MakeOpacityTable());
  mapper->UseLookupTableScalarRangeOn();
  ExpectShadowsAlike(GetTexelsOf(MakePlate(1), ramp), GetTexelsOf(mapper));
}

// Scalars with an alpha are multiplied by the texture's: at points and at cells.
TEST(OccluderMappers, TexturesWeakenScalars)
{
  const vtkSmartPointer<vtkTexture> half =
    MakeTexture(2, [](int i, int) { return i == 0 ? 0 : 255; });
  for (const bool areOfCells : { true, false })
  {
    const std::vector<double> values =
      areOfCells ? std::vector<double>{ 0.2, 0.6 } : std::vector<double>(6, 0.6);
    const auto makeMapper = [&](vtkPolyData* data)
    {
      const vtkSmartPointer<vtkPolyDataMapper> mapper = MakeMapper(data);
      mapper->SetLookupTable(MakeOpacityTable());
      mapper->UseLookupTableScalarRangeOn();
      return mapper;
    };
    LampScene found;
    found.AddMapper(makeMapper(MakePane(values, areOfCells)))->SetTexture(half);
    const vtkSmartPointer<vtkPolyData> right = MakePane(values, areOfCells);
    vtkNew<vtkCellArray> second; // the texture leaves the right half, which is the second cell
    vtkNew<vtkIdList> cell;
    right->GetPolys()->GetCellAtId(1, cell);
    second->InsertNextCell(cell);
    right->SetPolys(second);
    if (areOfCells)
    {
      vtkNew<vtkDoubleArray> value;
      value->InsertNextValue(values[1]);
      right->GetCellData()->SetScalars(value);
    }
    ExpectShadowsAlike(found.GetTexels(), GetTexelsOf(makeMapper(right)));
  }
}

// The base colour of physically based materials, and of nothing else; a turned texture; what
// changes.
TEST(OccluderMappers, TexturesAreWhatIsDrawn)
{
  const vtkSmartPointer<vtkTexture> left =
    MakeTexture(2, [](int i, int) { return i == 0 ? 255 : 0; });
  const std::vector<float> whole = GetTexelsOf(MakeMapper(MakePlate(1)));
  const std::vector<float> right =
    GetTexelsOf(MakeMapper(CutByHand(2, [](int i, int) { return i == 0; })));
  LampScene scene;
  const vtkSmartPointer<vtkActor> actor = scene.AddMapper(MakeMapper(MakePlate(1)));
  left->UseSRGBColorSpaceOn(); // VTK takes no other base colours
  actor->GetProperty()->SetBaseColorTexture(left);
  ExpectSame(scene.GetTexels(), whole, 0.0f);
  actor->GetProperty()->SetInterpolationToPBR();
  ExpectShadowsAlike(scene.GetTexels(), right);
  actor->GetProperty()->SetInterpolationToGouraud();
  actor->SetTexture(left);
  ExpectShadowsAlike(scene.GetTexels(), right);
  vtkNew<vtkTransform> turn; // u and v change places
  const double swap[16] = { 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
  turn->SetMatrix(swap);
  left->SetTransform(turn);
  ExpectShadowsAlike(
    scene.GetTexels(), GetTexelsOf(MakeMapper(CutByHand(2, [](int, int j) { return j == 0; }))));
  auto* alpha = vtkUnsignedCharArray::SafeDownCast(left->GetInput()->GetPointData()->GetScalars());
  alpha->FillComponent(3, 255);
  alpha->Modified();
  left->GetInput()->Modified();
  ExpectSame(scene.GetTexels(), whole, 0.0f);
}

// A texture that is repeated so often that its texels would be millions of triangles is taken by
// larger ones, and that is said once.
TEST(OccluderMappers, TooFineTexturesAreNamedOnce)
{
  const vtkSmartPointer<vtkTexture> checks =
    MakeTexture(64, [](int i, int j) { return (i + j) % 2 == 0 ? 255 : 0; });
  LampScene scene;
  const vtkSmartPointer<vtkActor> actor = scene.AddMapper(MakeMapper(MakePlate(1, 40.0)));
  actor->SetTexture(checks);
  const Messages messages;
  const std::vector<float> found = scene.GetTexels();
  actor->SetPosition(0.0, 0.0, 0.01);
  scene.GetTexels();
  EXPECT_EQ(messages.Count("means of 2 x 2 texels"), 1) << messages.GetText();
  // Half of all is there: as one sheet of half the opacity.
  LampScene even;
  even.AddMapper(MakeMapper(MakePlate(1)))->GetProperty()->SetOpacity(0.5);
  ExpectSame(found, even.GetTexels(), Rounding);
}

// What is drawn otherwise than its shadow says is said once for each actor, and of nothing else.
TEST(OccluderMappers, WhatIsUnlikeItsShadowIsNamedOnce)
{
  LampScene scene;
  const vtkSmartPointer<vtkTexture> leaf = MakeTexture(2, [](int, int) { return 100; });
  vtkNew<vtkPlaneSource> plate;
  scene.Add(plate)->SetTexture(leaf);
  vtkNew<vtkLineSource> line;
  const vtkSmartPointer<vtkActor> tube = scene.Add(line);
  const Messages messages;
  scene.Render();
  EXPECT_EQ(messages.GetText(), "") << "textures and plain lines are shown as they cast";

  // Glyphs that a texture cuts out.
  vtkNew<vtkGlyph3DMapper> glyphs;
  glyphs->SetInputConnection(plate->GetOutputPort());
  glyphs->SetSourceConnection(plate->GetOutputPort());
  scene.AddMapper(glyphs)->SetTexture(leaf);
  tube->GetProperty()->RenderLinesAsTubesOn();
  scene.Render();
  tube->SetPosition(0.0, 0.0, 0.1);
  scene.Render();
  EXPECT_EQ(messages.Count("transparency of its texture"), 1) << messages.GetText();
  EXPECT_EQ(messages.Count("tubes"), 0) << "they cast: " << messages.GetText();
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// A data set of many planar faces shows all of them, and looks as if it were several data sets, or
// one face where the faces lie in one plane.

#include "PassScene.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkTrivialProducer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace
{

/// Quads, each with points of its own.
class Quads
{
public:
  using Point = PassScene::Point;

  Quads() { this->Points->SetDataTypeToDouble(); }

  void Add(const Point& a, const Point& b, const Point& c, const Point& d)
  {
    this->Cells->InsertNextCell(4);
    for (const Point& point : { a, b, c, d })
    {
      this->Cells->InsertCellPoint(this->Points->InsertNextPoint(point.data()));
    }
  }

  /// The faces of a box, but for the one that it stands on.
  void AddBox(double x, double y, double side, double height)
  {
    const double x1 = x + side, y1 = y + side;
    this->Add({ x, y, height }, { x1, y, height }, { x1, y1, height }, { x, y1, height });
    this->Add({ x, y, 0 }, { x1, y, 0 }, { x1, y, height }, { x, y, height });
    this->Add({ x1, y, 0 }, { x1, y1, 0 }, { x1, y1, height }, { x1, y, height });
    this->Add({ x1, y1, 0 }, { x, y1, 0 }, { x, y1, height }, { x1, y1, height });
    this->Add({ x, y1, 0 }, { x, y, 0 }, { x, y, height }, { x, y1, height });
  }

  /// A producer of them as receivers.
  vtkSmartPointer<vtkShadowReceiver> MakeReceiver(double texelSize, int samples) const
  {
    vtkNew<vtkPolyData> data;
    data->SetPoints(this->Points);
    data->SetPolys(this->Cells);
    vtkNew<vtkTrivialProducer> producer;
    producer->SetOutput(data);
    auto receiver = vtkSmartPointer<vtkShadowReceiver>::New();
    receiver->SetInputConnection(producer->GetOutputPort());
    receiver->SetTexelSize(texelSize);
    receiver->SetLightSamples(samples);
    return receiver;
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Cells;
};

/// A town of boxes under a lamp, seen from above; as one data set, or as one for each box.
class Town : public PassScene
{
public:
  Town(int row, bool isOneDataSet)
    : PassScene(320, 240)
  {
    std::vector<Quads> parts(isOneDataSet ? 1 : static_cast<std::size_t>(row * row));
    for (int i = 0; i < row * row; ++i)
    {
      const double x = 2.0 * (i % row) - row, y = 2.0 * static_cast<int>(i / row) - row;
      parts[isOneDataSet ? 0 : static_cast<std::size_t>(i)].AddBox(
        x, y, 1.2, 0.5 + 0.1 * (7 * i % 11));
    }
    for (const Quads& part : parts)
    {
      this->Add(part.MakeReceiver(0.2, 16));
    }
    const double height = 4.0 * row;
    this->AddLight(
      this->Light, { -1.0, 2.0, height }, { 1.0, 2.0, height }, { -1.0, -2.0, height });
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(-0.9 * row, -1.8 * row, 1.5 * row);
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    camera->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCameraClippingRange();
  }

  vtkNew<vtkAreaLightSource> Light;
};

/// A ball over a floor of tiles that miss each other by so much; by 0, it is one tile.
class TiledFloor : public PassScene
{
public:
  explicit TiledFloor(double gap)
    : PassScene(400, 300)
  {
    Quads tiles;
    const int row = gap == 0.0 ? 1 : 5;
    const double side = 4.0 / row;
    for (int i = 0; i < row * row; ++i)
    {
      const double x = side * (i % row) - 2.0, y = side * static_cast<int>(i / row) - 2.0;
      const double x1 = x + side - gap, y1 = y + side - gap;
      tiles.Add({ x, y, 0 }, { x1, y, 0 }, { x1, y1, 0 }, { x, y1, 0 });
    }
    this->Add(tiles.MakeReceiver(0.02, 64));
    this->Sphere->SetCenter(0.1, 0.2, 0.7);
    this->Sphere->SetThetaResolution(24);
    this->Sphere->SetPhiResolution(24);
    this->Add(this->Sphere);
    this->AddLight(this->Light, { -0.5, 0.5, 3.0 }, { 0.5, 0.5, 3.0 }, { -0.5, -0.5, 3.0 });
  }

  Pixels RenderFrom(double x, double y, double z)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(x, y, z);
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    camera->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCameraClippingRange();
    return this->Render();
  }

  vtkNew<vtkSphereSource> Sphere;
  vtkNew<vtkAreaLightSource> Light;
};

/// How many pixels differ by more than some levels in any component.
std::size_t CountFar(const PassScene::Pixels& a, const PassScene::Pixels& b, int levels)
{
  std::size_t count = a.size() == b.size() ? 0 : a.size();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      most = std::max(most, std::abs(static_cast<int>(a[i][c]) - static_cast<int>(b[i][c])));
    }
    count += most > levels ? 1 : 0;
  }
  return count;
}

} // namespace

TEST(ManyReceivers, AllOfOneDataSetAreShown)
{
  constexpr int row = 22;
  Town town(row, true);
  const PassScene::Pixels shown = town.Render();
  EXPECT_EQ(town.Pass->GetNumberOfReceivers(), 5 * row * row);
  town.SetShadows(false);
  // Walls that face away from the lamp, and what boxes shade of others, are a third of the picture.
  EXPECT_GT(CountFar(shown, town.Render(), 6), shown.size() / 10);
}

TEST(ManyReceivers, LookAsInManyDataSets)
{
  constexpr int row = 6;
  Town one(row, true), many(row, false);
  for (const int shading : { vtkSoftShadowPass::SHADOW, vtkSoftShadowPass::RADIANCE })
  {
    one.Pass->SetShading(shading);
    many.Pass->SetShading(shading);
    const PassScene::Pixels a = one.Render(), b = many.Render();
    // Texels are the same. Atlases of several receivers have fewer mip levels than a single one's,
    // and these are of five either way: what is left is rounding, and a pixel here and there along
    // an edge between two faces, which belongs to either.
    EXPECT_LE(CountFar(a, b, 3), a.size() / 2000) << "shading " << shading;
  }
}

TEST(ManyReceivers, TilesShowNoLinesAtTheirJoints)
{
  TiledFloor whole(0.0), tiles(1e-6);
  for (const Quads::Point& eye : { Quads::Point{ 0, -5, 6 }, Quads::Point{ 2, -4, 3 },
         Quads::Point{ -3, -2, 1 }, Quads::Point{ 8, -12, 14 } })
  {
    const PassScene::Pixels a = whole.RenderFrom(eye[0], eye[1], eye[2]);
    const PassScene::Pixels b = tiles.RenderFrom(eye[0], eye[1], eye[2]);
    EXPECT_EQ(tiles.Pass->GetNumberOfReceivers(), 25);
    // Through the joints the background may be seen, as it is without shadows.
    tiles.SetShadows(false);
    whole.SetShadows(false);
    const std::size_t holes = CountFar(
      whole.RenderFrom(eye[0], eye[1], eye[2]), tiles.RenderFrom(eye[0], eye[1], eye[2]), 6);
    tiles.SetShadows(true);
    whole.SetShadows(true);
    EXPECT_LE(CountFar(a, b, 6), holes + 20)
      << "from " << eye[0] << ", " << eye[1] << ", " << eye[2] << "; " << holes << " holes";
    std::cout << "from " << eye[0] << ", " << eye[1] << ", " << eye[2] << ": " << CountFar(a, b, 6)
              << " pixels off, " << holes << " holes\n";
  }
}

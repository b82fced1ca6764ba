// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Each side of a receiver shows the light that arrives at it, and what none reaches the ambient.

#include "PassScene.h"
#include "PlanarRegions.h"

#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkCubeSource.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkProperty.h"
#include "vtkRadianceMap.h"
#include "vtkStructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace
{

constexpr int Top = 1, Bottom = 2;

/// A slab, if not tilted in the plane z = 0, with a white lamp over it, a red one under it, and a
/// ball under it; or with one of the lamps alone.
class Slab : public PassScene
{
public:
  explicit Slab(int lamps, double tilt = 0.0, bool isMirrored = false)
    : PassScene(160, 120)
  {
    this->Receiver->SetTexelSize(0.08);
    this->Receiver->SetLightSamples(64);
    this->Floor = this->AddReceiver({ -2, -2, 0 }, { 2, -2, 0 }, { -2, 2, 0 }, this->Receiver);
    this->Ball->SetCenter(0.2, 0.1, -0.7);
    std::vector<vtkSmartPointer<vtkActor>> actors{ this->Floor, this->Add(this->Ball) };
    if (lamps & Top)
    {
      actors.push_back(
        this->AddLight(this->Over, { -0.5, 0.5, 3 }, { 0.5, 0.5, 3 }, { -0.5, -0.5, 3 }));
    }
    if (lamps & Bottom)
    {
      this->Under->SetRadiance(1.0, 0.1, 0.1);
      actors.push_back(
        this->AddLight(this->Under, { -0.5, -0.5, -2 }, { 0.5, -0.5, -2 }, { -0.5, 0.5, -2 }));
    }
    for (vtkActor* actor : actors)
    {
      actor->SetScale(isMirrored ? -1.0 : 1.0, 1.0, 1.0);
      actor->RotateX(tilt);
    }
  }

  /// From a place such that the middle of the picture is the slab.
  Pixels RenderFrom(double z, bool isParallel)
  {
    return this->RenderFrom(1.0, -3.0, z, isParallel);
  }

  Pixels RenderFrom(double x, double y, double z, bool isParallel)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetParallelProjection(isParallel);
    camera->SetParallelScale(2.5);
    camera->SetPosition(x, y, z);
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
    this->Renderer->ResetCameraClippingRange();
    return this->Render();
  }

  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkAreaLightSource> Over, Under;
  vtkSmartPointer<vtkActor> Floor;
};

int FindFarthest(const PassScene::Pixels& a, const PassScene::Pixels& b)
{
  int most = a.size() == b.size() ? 0 : 255;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      most = std::max(most, std::abs(static_cast<int>(a[i][c]) - static_cast<int>(b[i][c])));
    }
  }
  return most;
}

/// The colour in the middle of a picture, where the slab is.
std::array<unsigned char, 3> GetMiddle(const PassScene::Pixels& pixels)
{
  return pixels[60 * 160 + 80];
}

/// The blocks of the slab's map, by the names that they have.
std::vector<std::pair<std::string, vtkSmartPointer<vtkStructuredGrid>>> BakeSlab(int side)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-2, -1, 0);
  plane->SetPoint1(2, -1, 0.5);
  plane->SetPoint2(-2, 2, 0);
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(plane->GetOutputPort());
  receiver->SetTexelSize(0.11); // not as many texels along one edge as along the other
  receiver->SetSide(side);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(0.2, 0.1, -0.7);
  vtkNew<vtkAreaLightSource> over, under;
  over->SetOrigin(-0.5, 0.5, 3);
  over->SetPoint1(0.5, 0.5, 3);
  over->SetPoint2(-0.5, -0.5, 3);
  under->SetOrigin(-0.5, -0.5, -2);
  under->SetPoint1(0.5, -0.5, -2);
  under->SetPoint2(-0.5, 0.5, -2);
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, ball->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, over->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, under->GetOutputPort());
  map->Update();
  std::vector<std::pair<std::string, vtkSmartPointer<vtkStructuredGrid>>> blocks;
  for (unsigned int b = 0; b < map->GetOutput()->GetNumberOfBlocks(); ++b)
  {
    vtkInformation* information =
      map->GetOutput()->HasMetaData(b) ? map->GetOutput()->GetMetaData(b) : nullptr;
    const char* name = information ? information->Get(vtkCompositeDataSet::NAME()) : nullptr;
    blocks.emplace_back(
      name ? name : "", vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(b)));
  }
  return blocks;
}

/// A value of a cell, found by its centre: that of the nearest cell of the grid.
double FindValue(vtkStructuredGrid* grid, const char* name, const double* centre)
{
  double nearest = 1e300, value = 0.0;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
  {
    double bounds[6], distance = 0.0;
    grid->GetCellBounds(i, bounds);
    for (int c = 0; c < 3; ++c)
    {
      const double d = 0.5 * (bounds[2 * c] + bounds[2 * c + 1]) - centre[c];
      distance += d * d;
    }
    if (distance < nearest)
    {
      nearest = distance;
      value = grid->GetCellData()->GetArray(name)->GetComponent(i, 0);
    }
  }
  return value;
}

/// The faces of a cube of side 2 around a point.
penumbra::PolygonMesh MakeCube(const glm::dvec3& centre, bool isInsideOut, bool isOpen)
{
  penumbra::PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
  {
    mesh.Points.push_back(centre + glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  mesh.Polygons = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
    { 1, 3, 7, 5 } };
  if (isOpen)
  {
    mesh.Polygons.pop_back();
  }
  for (std::vector<int>& polygon : mesh.Polygons)
  {
    if (isInsideOut)
    {
      std::reverse(polygon.begin(), polygon.end());
    }
  }
  return mesh;
}

} // namespace

// The view from each side is as without the lamp on the other one. Texels of both share an atlas,
// with other mip levels: a level of 255, and two where they are enlarged, are its rounding.
TEST(ReceiverSides, EachShowsItsOwnLamp)
{
  constexpr double X = 0.3, Y = -0.5; // the lamp of the other side is behind the slab
  for (const double tilt : { 0.0, 17.0 })
  {
    for (const bool isMirrored : { false, true })
    {
      Slab both(Top | Bottom, tilt, isMirrored);
      Slab over(Top, tilt, isMirrored), under(Bottom, tilt, isMirrored);
      for (const int shading : { vtkSoftShadowPass::RADIANCE, vtkSoftShadowPass::SHADOW })
      {
        for (Slab* slab : { &both, &over, &under })
        {
          slab->Pass->SetShading(shading);
        }
        for (const bool isParallel : { false, true })
        {
          const std::string what = "tilt " + std::to_string(tilt) + ", mirrored " +
            std::to_string(isMirrored) + ", shading " + std::to_string(shading) + ", parallel " +
            std::to_string(isParallel);
          const PassScene::Pixels below = both.RenderFrom(X, Y, -4.0, isParallel);
          EXPECT_LE(FindFarthest(below, under.RenderFrom(X, Y, -4.0, isParallel)), 2) << what;
          // The upper lamp's picture has no red lamp under the slab; from above both are alike.
          const PassScene::Pixels above = both.RenderFrom(X, Y, 4.0, isParallel);
          EXPECT_LE(FindFarthest(above, over.RenderFrom(X, Y, 4.0, isParallel)), 2) << what;
        }
      }
    }
  }
}

TEST(ReceiverSides, UnlitOnesShowTheAmbientAlone)
{
  Slab slab(Top);
  slab.Receiver->SetAmbientRadiance(0.2, 0.4, 0.1);
  slab.Receiver->SetReflectance(0.5, 0.5, 1.0);
  slab.Pass->SetShading(vtkSoftShadowPass::RADIANCE);
  for (const int side : { vtkShadowReceiver::AUTO, vtkShadowReceiver::FRONT })
  {
    slab.Receiver->SetSide(side);
    for (const bool isParallel : { false, true })
    {
      const auto middle = GetMiddle(slab.RenderFrom(-1.2, isParallel));
      constexpr double Wanted[] = { 0.1, 0.2, 0.1 };
      for (std::size_t c = 0; c < 3; ++c)
      {
        // A display's levels are linear here, of 255, and rounded.
        EXPECT_NEAR(middle[c], 255.0 * Wanted[c], 1.0) << "side " << side << ", component " << c;
      }
    }
  }
}

TEST(ReceiverSides, FrontAndBackShowTheirSideAlone)
{
  Slab slab(Top | Bottom);
  slab.Pass->SetShading(vtkSoftShadowPass::RADIANCE);
  const std::array<unsigned char, 3> black{ 0, 0, 0 };
  slab.Receiver->SetSideToFront();
  EXPECT_EQ(GetMiddle(slab.RenderFrom(-1.2, true)), black);
  EXPECT_NE(GetMiddle(slab.RenderFrom(1.2, true)), black);
  slab.Receiver->SetSideToBack();
  EXPECT_EQ(GetMiddle(slab.RenderFrom(1.2, true)), black);
  slab.Receiver->SetSideToBoth();
  EXPECT_NE(GetMiddle(slab.RenderFrom(1.2, true)), black);
  EXPECT_EQ(slab.Pass->GetNumberOfReceivers(), 2);
}

TEST(ReceiverSides, BothAreTwoBlocksOfData)
{
  const auto both = BakeSlab(vtkShadowReceiver::BOTH);
  const auto front = BakeSlab(vtkShadowReceiver::FRONT);
  const auto back = BakeSlab(vtkShadowReceiver::BACK);
  ASSERT_EQ(both.size(), 2u);
  ASSERT_EQ(front.size(), 1u);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(both[0].first, "Front");
  EXPECT_EQ(both[1].first, "Back");
  EXPECT_EQ(front[0].first, "");
  for (const char* name : { "Radiance", "Visibility", "Error" })
  {
    std::size_t shadowed = 0;
    for (int b = 0; b < 2; ++b)
    {
      vtkStructuredGrid* grid = both[static_cast<std::size_t>(b)].second;
      vtkStructuredGrid* alone = (b == 0 ? front : back)[0].second;
      ASSERT_EQ(grid->GetNumberOfCells(), alone->GetNumberOfCells());
      vtkDataArray* values = grid->GetCellData()->GetArray(name);
      if (!values)
      {
        continue; // no estimate of an error was asked for
      }
      for (vtkIdType i = 0; i < grid->GetNumberOfCells(); i += 7)
      {
        double bounds[6], centre[3];
        grid->GetCellBounds(i, bounds);
        for (int c = 0; c < 3; ++c)
        {
          centre[c] = 0.5 * (bounds[2 * c] + bounds[2 * c + 1]);
        }
        EXPECT_EQ(values->GetComponent(i, 0), FindValue(alone, name, centre))
          << name << " of cell " << i << " of block " << b;
        shadowed += std::string(name) == "Visibility" && values->GetComponent(i, 0) < 0.9 ? 1 : 0;
      }
      if (std::string(name) == "Visibility")
      {
        EXPECT_EQ(shadowed > 0, b == 1); // the ball is under the slab
      }
    }
  }
}

// A closed box has no texels inside for a lamp that is outside, on both sides of a face's plane, if
// no light passes the box. A lamp that is inside lights it.
TEST(ReceiverSides, InsidesOfClosedSurfacesAreLeftOut)
{
  PassScene scene(160, 120);
  scene.Pass->SetShading(vtkSoftShadowPass::RADIANCE);
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(cube->GetOutputPort());
  receiver->SetTexelSize(0.1);
  const vtkSmartPointer<vtkActor> actor = scene.Add(receiver);
  vtkNew<vtkAreaLightSource> lamp, inner;
  scene.AddLight(lamp, { 0.2, 1, 3 }, { 2.2, 1, 3 }, { 0.2, -1, 3 });
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  camera->SetPosition(0.0, -0.1, 0.0);
  camera->SetFocalPoint(0.5, 0.0, 0.0);
  camera->SetViewUp(0.0, 0.0, 1.0);
  camera->SetClippingRange(0.01, 10.0);
  const std::array<unsigned char, 3> black{ 0, 0, 0 };
  EXPECT_EQ(GetMiddle(scene.Render()), black);
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 6);
  const vtkTypeInt64 ofOpaque = scene.Pass->GetTextureBytes();
  actor->GetProperty()->SetOpacity(0.5);
  scene.Render();
  EXPECT_GT(scene.Pass->GetTextureBytes(), ofOpaque);
  actor->GetProperty()->SetOpacity(1.0);
  scene.AddLight(inner, { -0.1, 0.1, 0.4 }, { 0.1, 0.1, 0.4 }, { -0.1, -0.1, 0.4 });
  EXPECT_NE(GetMiddle(scene.Render()), black);
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 6);
}

TEST(ClosedSurfaces, AreFoundWithTheirInside)
{
  for (const glm::dvec3& centre : { glm::dvec3(0.0), glm::dvec3(85000.0, 447000.0, 10.0) })
  {
    for (const bool isInsideOut : { false, true })
    {
      const penumbra::PolygonMesh mesh = MakeCube(centre, isInsideOut, false);
      const penumbra::PlanarRegions regions = penumbra::FindPlanarRegions(mesh);
      const auto closed = penumbra::FindClosedSurfaces(mesh, regions);
      ASSERT_EQ(closed.size(), 6u);
      for (std::size_t i = 0; i < closed.size(); ++i)
      {
        ASSERT_TRUE(closed[i]) << "face " << i;
        EXPECT_EQ(closed[i]->Low, centre - 1.0);
        EXPECT_EQ(closed[i]->High, centre + 1.0);
        const penumbra::Parallelogram& base = regions.Regions[i].Base;
        const glm::dvec3 normal = glm::cross(base.EdgeX, base.EdgeY);
        const glm::dvec3 middle = base.Corner + 0.5 * (base.EdgeX + base.EdgeY);
        EXPECT_EQ(closed[i]->IsBehind, glm::dot(normal, centre - middle) < 0.0) << "face " << i;
      }
    }
    const penumbra::PolygonMesh open = MakeCube(centre, false, true);
    for (const auto& closed : penumbra::FindClosedSurfaces(open, penumbra::FindPlanarRegions(open)))
    {
      EXPECT_FALSE(closed);
    }
  }
}

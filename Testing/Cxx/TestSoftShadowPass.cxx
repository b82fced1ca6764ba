// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The pass in plain VTK: what it draws, when it bakes, what it leaves alone.

#include "PassScene.h"

#include "vtkAssembly.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCubeSource.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataGroupFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkProperty.h"
#include "vtkRadianceMap.h"
#include "vtkStripper.h"
#include "vtkStructuredGrid.h"
#include "vtkTransform.h"
#include "vtkTriangleFilter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

/// Notes the progress that a pass tells.
class ProgressNote : public vtkCommand
{
public:
  static ProgressNote* New() { return new ProgressNote; }
  void Execute(vtkObject* /*caller*/, unsigned long /*event*/, void* progress) override
  {
    this->Told->push_back(*static_cast<double*>(progress));
  }
  std::vector<double>* Told = nullptr;
};

std::vector<float> GetTexels(vtkSoftShadowPass* pass, int receiver)
{
  const vtkSmartPointer<vtkFloatArray> array = pass->GetTexels(receiver);
  return array
    ? std::vector<float>(array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues())
    : std::vector<float>();
}

} // namespace

TEST(SoftShadowPass, DarkensTheFloorOnly)
{
  FloorScene scene;
  const PassScene::Pixels shadowed = scene.Render();
  scene.SetShadows(false);
  const PassScene::Pixels plain = scene.Render();
  EXPECT_GT(CountDifferences(shadowed, plain), shadowed.size() / 100);
  scene.FloorActor->VisibilityOff();
  const PassScene::Pixels withoutFloor = scene.Render();
  for (std::size_t i = 0; i < plain.size(); ++i)
  {
    if (plain[i] == withoutFloor[i]) // no floor here
    {
      ASSERT_EQ(shadowed[i], plain[i]);
    }
    ASSERT_LE(shadowed[i][0], plain[i][0]); // a white light brightens nothing
  }
}

TEST(SoftShadowPass, WithoutLightsDrawsPlain)
{
  FloorScene scene;
  scene.LightActor->VisibilityOff();
  const PassScene::Pixels withPass = scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 0);
  scene.SetShadows(false);
  EXPECT_EQ(CountDifferences(withPass, scene.Render()), 0u);
}

TEST(SoftShadowPass, WithoutOccludersDrawsPlain)
{
  FloorScene scene;
  scene.SphereActor->VisibilityOff();
  const PassScene::Pixels withPass = scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 0); // there is no shadow to show
  EXPECT_EQ(scene.Pass->GetTextureBytes(), 0);
  scene.SetShadows(false);
  EXPECT_EQ(CountDifferences(withPass, scene.Render()), 0u);
}

// What is lit takes on a light's hue, whether or not there is a shadow somewhere.
TEST(SoftShadowPass, ShowsTheHueOfLightWithoutOccluders)
{
  FloorScene scene;
  scene.Light->SetRadiance(1.0, 0.8, 0.6);
  scene.Sphere->SetRadius(0.2);
  const PassScene::Pixels shadowed = scene.Render();
  scene.SphereActor->VisibilityOff();
  const PassScene::Pixels lit = scene.Render();
  EXPECT_GT(scene.Pass->GetTextureBytes(), 0);
  EXPECT_LT(CountDifferences(lit, shadowed), lit.size() / 4);
  scene.SetShadows(false);
  EXPECT_GT(CountDifferences(lit, scene.Render()), lit.size() / 4);
}

TEST(SoftShadowPass, CameraDoesNotBake)
{
  FloorScene scene;
  const PassScene::Pixels first = scene.Render();
  for (int i = 0; i < 12; ++i)
  {
    scene.Renderer->GetActiveCamera()->Azimuth(30.0);
    scene.Render();
  }
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
  scene.Window->SetSize(150, 100);
  scene.Render();
  scene.Window->SetSize(300, 200);
  EXPECT_LE(CountDifferences(scene.Render(), first), first.size() / 1000); // the camera's rounding
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
}

TEST(SoftShadowPass, ChangesBake)
{
  FloorScene scene;
  scene.Render();
  int bakes = 1;
  const auto expectBake = [&](const char* change)
  {
    scene.Render();
    EXPECT_EQ(scene.Pass->GetBakeCount(), ++bakes) << change;
    scene.Render();
    EXPECT_EQ(scene.Pass->GetBakeCount(), bakes) << "the frame after: " << change;
  };
  scene.SphereActor->SetPosition(0.2, 0.0, 0.0);
  expectBake("matrix");
  scene.Sphere->SetRadius(0.4);
  expectBake("input of a mapper");
  scene.SphereActor->VisibilityOff();
  expectBake("visibility");
  scene.SphereActor->VisibilityOn();
  expectBake("visibility again");
  scene.Light->SetRadiance(1.0, 0.5, 0.5);
  expectBake("light");
  scene.Receiver->SetLightSamples(16);
  expectBake("settings");
  scene.FloorActor->RotateX(5.0);
  expectBake("receiver's matrix");
}

TEST(SoftShadowPass, FinishesDraftsWhenNothingChanges)
{
  FloorScene scene;
  vtkNew<vtkShadowReceiver> wall;
  wall->SetTexelSize(4.0 / 64);
  scene.AddReceiver({ -2, 2, 0 }, { 2, 2, 0 }, { -2, 2, 3 }, wall);
  scene.Render();
  const std::vector<float> final = GetTexels(scene.Pass, 0);
  EXPECT_EQ(scene.Pass->GetBakeProgress(), 1.0);
  scene.Receiver->SetLightSamples(1);
  scene.Render();
  const std::vector<float> draft = GetTexels(scene.Pass, 0);
  ASSERT_NE(draft, final);

  std::vector<double> told;
  vtkNew<ProgressNote> note;
  note->Told = &told;
  scene.Pass->AddObserver(vtkCommand::ProgressEvent, note);
  scene.Receiver->SetLightSamples(64);
  scene.Pass->SetBakeMode(vtkSoftShadowPass::PROGRESSIVE);
  scene.Pass->SetBatchSeconds(0.0); // as little as there is
  for (double before = -1.0; before < 1.0; before = scene.Pass->GetBakeProgress())
  {
    scene.Render();
    const std::vector<float> shown = GetTexels(scene.Pass, 0);
    for (std::size_t i = 0; i < shown.size(); ++i)
    {
      ASSERT_TRUE(shown[i] == draft[i] || shown[i] == final[i]);
    }
    ASSERT_GT(scene.Pass->GetBakeProgress(), before);
    ASSERT_EQ(told.back(), scene.Pass->GetBakeProgress());
  }
  EXPECT_LT(told.front(), 1.0);
  EXPECT_GT(told.size(), 3u); // tiles of the floor, then of the wall
  EXPECT_EQ(GetTexels(scene.Pass, 0), final);

  scene.Sphere->SetRadius(0.4);
  scene.Pass->SetBakeMode(vtkSoftShadowPass::DRAFT);
  scene.Render();
  const double progress = scene.Pass->GetBakeProgress();
  EXPECT_LT(progress, 1.0); // what the sphere can shade
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeProgress(), progress);
  scene.Pass->SetBakeMode(vtkSoftShadowPass::COMPLETE);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeProgress(), 1.0);
}

TEST(SoftShadowPass, PropsOutOfSightCastShadows)
{
  FloorScene scene;
  scene.Render();
  const std::vector<float> texels = GetTexels(scene.Pass, 0);
  // From below the sphere, looking down: it is behind the camera.
  scene.Renderer->GetActiveCamera()->SetPosition(0.0, 0.1, 0.25);
  scene.Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
  scene.Renderer->ResetCameraClippingRange(-2, 2, -2, 2, 0, 0);
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), texels);
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
}

// RadianceMap bakes the same: bit for bit.
TEST(SoftShadowPass, TexelsAreThoseOfRadianceMap)
{
  FloorScene scene;
  vtkNew<vtkShadowReceiver> wall;
  wall->SetSupersampling(2);
  wall->SetTexelSize(0.1);
  scene.AddReceiver({ -2, 2, 0 }, { 2, 2, 0 }, { -2, 2, 2 }, wall);
  scene.Receiver->SetReflectance(0.5, 0.6, 0.7);
  scene.Receiver->SetAmbientRadiance(0.1, 0.2, 0.3);
  scene.Render();

  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, wall->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, scene.Sphere->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, scene.Light->GetOutputPort());
  map->Update();
  ASSERT_EQ(map->GetOutput()->GetNumberOfBlocks(), 2u);
  for (unsigned int block = 0; block < 2; ++block)
  {
    scene.Window->MakeCurrent();
    const std::vector<float> texels = GetTexels(scene.Pass, static_cast<int>(block));
    auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(block));
    auto* radiance = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Radiance"));
    ASSERT_EQ(texels.size(), 4u * static_cast<std::size_t>(radiance->GetNumberOfTuples()));
    const float reflectance[3] = { 0.5f, 0.6f, 0.7f };
    const float ambient[3] = { 0.1f, 0.2f, 0.3f };
    for (vtkIdType i = 0; i < radiance->GetNumberOfTuples(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        const float irradiance = texels[static_cast<std::size_t>(4 * i + c)];
        const float expected = block == 0 ? reflectance[c] * (ambient[c] + irradiance) : irradiance;
        ASSERT_EQ(radiance->GetTypedComponent(i, c), expected);
      }
    }
  }
}

// Polygons, triangles, strips, blocks of composite data and parts of assemblies are the same
// occluder.
// A shadow may come from anywhere: the first of several processes bakes all, the others nothing.
// A sphere gives each of them only a part of itself.
TEST(RadianceMap, TheFirstPieceIsEverything)
{
  FloorScene scene;
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, scene.Sphere->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, scene.Light->GetOutputPort());
  const auto bake = [&](int piece, int pieces)
  {
    std::vector<float> texels;
    map->UpdatePiece(piece, pieces, 0);
    for (unsigned int i = 0; i < map->GetOutput()->GetNumberOfBlocks(); ++i)
    {
      auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(i));
      if (!grid)
      {
        continue; // writers want the same blocks in all pieces
      }
      auto* radiance = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Radiance"));
      texels.insert(texels.end(), radiance->GetPointer(0),
        radiance->GetPointer(0) + radiance->GetNumberOfValues());
    }
    return texels;
  };
  const std::vector<float> all = bake(0, 1);
  EXPECT_EQ(all.size(), 3u * 64 * 64);
  EXPECT_EQ(bake(0, 2), all);
  EXPECT_EQ(bake(1, 2), std::vector<float>());
  EXPECT_EQ(map->GetOutput()->GetNumberOfBlocks(), 1u);
}

TEST(SoftShadowPass, AllKindsOfSurfacesBlockAlike)
{
  FloorScene scene;
  vtkNew<vtkCubeSource> cube;
  cube->SetBounds(-0.4, 0.5, -0.3, 0.4, 0.4, 0.9);
  scene.SphereActor->GetMapper()->SetInputConnection(cube->GetOutputPort());
  scene.Render();
  const std::vector<float> quads = GetTexels(scene.Pass, 0);

  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(cube->GetOutputPort());
  scene.SphereActor->GetMapper()->SetInputConnection(triangles->GetOutputPort());
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), quads) << "triangles";

  vtkNew<vtkStripper> strips;
  strips->SetInputConnection(triangles->GetOutputPort());
  scene.SphereActor->GetMapper()->SetInputConnection(strips->GetOutputPort());
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), quads) << "strips";

  scene.Renderer->RemoveActor(scene.SphereActor);
  vtkNew<vtkAssembly> inner, outer;
  cube->SetBounds(-0.4 - 1.0, 0.5 - 1.0, -0.3, 0.4, 0.4, 0.9);
  scene.SphereActor->SetPosition(0.5, 0.0, 0.0);
  inner->AddPart(scene.SphereActor);
  outer->AddPart(inner);
  outer->SetPosition(0.5, 0.0, 0.0);
  scene.Renderer->AddActor(outer);
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), quads) << "assembly";
}

// A lamp may be drawn as one likes; a grid of lines casts no shadow.
TEST(SoftShadowPass, LightsShineHoweverTheyAreDrawn)
{
  FloorScene scene;
  scene.Render();
  const std::vector<float> texels = GetTexels(scene.Pass, 0);
  scene.LightActor->GetProperty()->SetRepresentationToWireframe();
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), texels);
  scene.LightActor->GetProperty()->SetOpacity(0.0);
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), texels);

  scene.SphereActor->GetProperty()->SetRepresentationToWireframe();
  scene.Render();
  const std::vector<float> unshadowed = GetTexels(scene.Pass, 0);
  scene.SphereActor->VisibilityOff();
  scene.Render();
  EXPECT_EQ(GetTexels(scene.Pass, 0), unshadowed);
  EXPECT_NE(unshadowed, texels);
}

TEST(SoftShadowPass, ABoxIsSixReceivers)
{
  FloorScene scene;
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(cube->GetOutputPort());
  receiver->SetTexelSize(0.1);
  scene.Add(receiver);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 7);
}

TEST(SoftShadowPass, OnlyDesignatedReceive)
{
  FloorScene scene;
  scene.Pass->OnlyDesignatedOn();
  scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 0);
  vtkSoftShadowPass::Designate(scene.FloorActor, vtkSoftShadowPass::RADIANCE);
  const PassScene::Pixels radiance = scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 1);
  vtkSoftShadowPass::Designate(scene.FloorActor, vtkSoftShadowPass::SHADOW);
  EXPECT_GT(CountDifferences(scene.Render(), radiance), radiance.size() / 10);
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1); // how it is shown is not baked
}

// In RADIANCE mode a white actor shows the radiance itself: 8 bits of it.
TEST(SoftShadowPass, ShowsRadiance)
{
  FloorScene scene;
  scene.Pass->SetShading(vtkSoftShadowPass::RADIANCE);
  scene.SphereActor->SetPosition(0.0, 0.0, 0.5);
  scene.Light->SetRadiance(6.0, 6.0, 3.0);
  scene.Receiver->SetReflectance(0.5, 1.0, 1.0);
  scene.Renderer->GetActiveCamera()->SetPosition(0.0, 0.0, 40.0);
  scene.Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
  scene.Renderer->GetActiveCamera()->SetViewUp(0.0, 1.0, 0.0);
  scene.Renderer->GetActiveCamera()->ParallelProjectionOn();
  scene.Renderer->GetActiveCamera()->SetParallelScale(2.0); // the floor fills the height
  scene.Renderer->ResetCameraClippingRange();
  scene.Window->SetSize(64, 64); // a texel is a pixel
  const PassScene::Pixels pixels = scene.Render();
  const std::vector<float> texels = GetTexels(scene.Pass, 0);
  int compared = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    const std::size_t x = i % 64, y = i / 64;
    if (x > 4 && y > 4 && x < 20 && y < 20) // neither the sphere nor the light is there
    {
      const float expected[3] = { 0.5f * texels[4 * i], texels[4 * i + 1], texels[4 * i + 2] };
      for (int c = 0; c < 3; ++c)
      {
        ASSERT_NEAR(pixels[i][static_cast<std::size_t>(c)], 255.0f * expected[c], 1.0f);
      }
      ++compared;
    }
  }
  EXPECT_EQ(compared, 225);
}

// Near the horizon, a pixel shows a part of the texture that is about 14 times as long as wide. The
// truth is the mean of all that lies within it: of the pixels of a view eight times as large, each
// of which shows less than a texel.
TEST(SoftShadowPass, AnisotropyKeepsShadowsSharpAtGrazingAngles)
{
  constexpr int Width = 150, Height = 100, Finer = 8;
  FloorScene scene;
  scene.Receiver->SetTexelSize(4.0 / 512);
  scene.Sphere->SetCenter(-1.5, 0.0, 1.5); // beside the view, its shadow in the middle
  scene.Sphere->SetRadius(0.08);
  scene.Light->SetOrigin(-3.0, 0.0, 3.0);
  scene.Light->SetPoint1(-2.99, 0.0, 3.0);
  scene.Light->SetPoint2(-3.0, -0.01, 3.0);
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  camera->SetPosition(0.0, -2.2, 0.15); // nothing but the floor is seen
  camera->SetFocalPoint(0.0, -1.0, 0.0);
  camera->SetViewAngle(10.0);
  const auto render = [&](int finer, int anisotropy)
  {
    scene.Window->SetSize(finer * Width, finer * Height);
    scene.Renderer->ResetCameraClippingRange();
    scene.Pass->SetMaximumAnisotropy(anisotropy);
    return scene.Render();
  };
  const PassScene::Pixels fine = render(Finer, 1);
  std::vector<double> truth(static_cast<std::size_t>(Width) * Height, 0.0);
  for (std::size_t i = 0; i < fine.size(); ++i)
  {
    const std::size_t x = i % (Finer * Width) / Finer, y = i / (Finer * Width) / Finer;
    truth[y * Width + x] += fine[i][0] / static_cast<double>(Finer * Finer);
  }
  const auto error = [&](int anisotropy)
  {
    const PassScene::Pixels pixels = render(1, anisotropy);
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
      sum += (pixels[i][0] - truth[i]) * (pixels[i][0] - truth[i]);
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
  };
  const double blurred = error(1), sharp = error(16);
  RecordProperty("levels", std::to_string(blurred) + ", anisotropic " + std::to_string(sharp));
  const double rounding = std::sqrt(1.0 / 12.0); // of pixels to 8 bits
  EXPECT_GT(blurred, 3.0 * rounding);            // the view is one in which it matters
  EXPECT_LT(sharp, 0.5 * blurred);
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1); // how it is shown is not baked
}

// Another actor of the same mapper, and mostly at the same address, takes the place of a receiver.
TEST(SoftShadowPass, ShowsAnActorThatComesToAnothersAddress)
{
  FloorScene scene;
  const PassScene::Pixels before = scene.Render();
  vtkSmartPointer<vtkMapper> mapper = scene.FloorActor->GetMapper();
  constexpr int Actors = 20;
  for (int i = 0; i < Actors; ++i)
  {
    scene.Renderer->RemoveActor(scene.FloorActor);
    scene.FloorActor = nullptr;
    scene.FloorActor = vtkSmartPointer<vtkActor>::New();
    scene.FloorActor->SetMapper(mapper);
    scene.Renderer->AddActor(scene.FloorActor);
    ASSERT_EQ(CountDifferences(scene.Render(), before), 0u) << "actor " << i;
  }
}

TEST(SoftShadowPass, SurvivesReleaseOfItsResources)
{
  FloorScene scene;
  const PassScene::Pixels first = scene.Render();
  scene.Pass->ReleaseGraphicsResources(scene.Window);
  EXPECT_EQ(CountDifferences(scene.Render(), first), 0u);
  EXPECT_EQ(scene.Pass->GetBakeCount(), 2);
}

// The masks of a tile stay from batch to batch.
TEST(SoftShadowPass, SurvivesReleaseOfWhatABatchHasBegun)
{
  FloorScene scene;
  scene.Receiver->SetLightSamples(4096); // more than a batch without time draws
  const PassScene::Pixels final = scene.Render();
  const auto begin = [&]
  {
    scene.Receiver->Modified();
    scene.Pass->SetBakeMode(vtkSoftShadowPass::PROGRESSIVE);
    scene.Pass->SetBatchSeconds(0.0);
    scene.Render(); // a draft
    const vtkTypeInt64 bytes = scene.Pass->GetTextureBytes();
    while (scene.Pass->GetTextureBytes() == bytes && scene.Pass->GetBakeProgress() < 1.0)
    {
      scene.Render(); // tiles without shadows are done at once
    }
    EXPECT_LT(scene.Pass->GetBakeProgress(), 1.0);
    scene.Pass->SetBakeMode(vtkSoftShadowPass::COMPLETE);
  };
  begin();
  scene.Pass->ReleaseGraphicsResources(scene.Window);
  EXPECT_EQ(scene.Pass->GetTextureBytes(), 0);
  EXPECT_EQ(CountDifferences(scene.Render(), final), 0u);
  begin();
  scene.SphereActor->SetVisibility(false);
  scene.Render();
  scene.SphereActor->SetVisibility(true);
  EXPECT_EQ(CountDifferences(scene.Render(), final), 0u);
  begin();
  EXPECT_EQ(CountDifferences(scene.Render(), final), 0u) << "all at once, after all";
  EXPECT_EQ(scene.Pass->GetBakeProgress(), 1.0);
  begin(); // and then all goes
}

TEST(SoftShadowPass, AddsNoMemoryOverFrames)
{
  FloorScene scene;
  scene.Render();
  const vtkTypeInt64 bytes = scene.Pass->GetTextureBytes();
  for (int i = 0; i < 20; ++i)
  {
    scene.SphereActor->SetPosition(0.01 * i, 0.0, 0.0);
    scene.Render();
  }
  // What is kept of the light follows its shadow, within n/8 + 24 bytes a texel.
  EXPECT_LE(scene.Pass->GetTextureBytes(), 64 * 64 * (64 / 8 + 24));
  scene.SphereActor->SetPosition(0.0, 0.0, 0.0);
  scene.Receiver->Modified(); // a new surface: all is baked anew
  scene.Render();
  EXPECT_EQ(scene.Pass->GetTextureBytes(), bytes);
  EXPECT_EQ(scene.Pass->GetBakeCount(), 21); // the first of them had not moved
}

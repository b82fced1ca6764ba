// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Pictures, compared with baselines by VTK's regression machinery.

#include "PassScene.h"

#include "vtkCamera.h"
#include "vtkCubeSource.h"
#include "vtkPolyDataNormals.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkTesting.h"
#include "vtkXMLPolyDataReader.h"

#include <gtest/gtest.h>

#include <string>

namespace
{

/// vtkTesting's own default: the sum over pixels of what remains of the difference beyond 105
/// levels (of 765) after a shift by up to a pixel, in units of full intensity. Other versions of
/// Mesa move edges by less than a pixel, and leave nothing; shadows that are switched off leave
/// hundreds.
constexpr double Threshold = 10.0;

int CompareWithBaseline(
  vtkRenderWindow* window, const std::string& name, const char* temporaryFolder)
{
  vtkNew<vtkTesting> testing;
  testing->AddArgument("-V");
  testing->AddArgument((std::string(PENUMBRA_DATA_DIR "/Baseline/") + name + ".png").c_str());
  testing->AddArgument("-T");
  testing->AddArgument(temporaryFolder);
  testing->SetRenderWindow(window);
  return testing->RegressionTest(Threshold);
}

/// The scene must equal its baseline with shadows, and must not without them.
void CheckImage(PassScene& scene, const std::string& name)
{
  scene.Render();
  EXPECT_EQ(CompareWithBaseline(scene.Window, name, PENUMBRA_TEMPORARY_DIR), vtkTesting::PASSED);
  scene.SetShadows(false);
  scene.Render();
  testing::internal::CaptureStdout(); // of a comparison that is to fail
  EXPECT_EQ(CompareWithBaseline(scene.Window, name, PENUMBRA_TEMPORARY_DIR "/WithoutShadows"),
    vtkTesting::FAILED);
  const std::string comparison = testing::internal::GetCapturedStdout();
  EXPECT_NE(comparison.find("ImageError"), std::string::npos) << comparison;
}

void SetCamera(vtkRenderer* renderer, const PassScene::Point& from, const PassScene::Point& to)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetPosition(from.data());
  camera->SetFocalPoint(to.data());
  camera->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCameraClippingRange();
}

} // namespace

TEST(Images, FloorAndBunny)
{
  PassScene scene(400, 300);
  vtkNew<vtkShadowReceiver> floor;
  floor->SetTexelSize(24.0 / 256);
  scene.AddReceiver({ -12, -12, 0 }, { 12, -12, 0 }, { -12, 12, 0 }, floor)
    ->GetProperty()
    ->SetColor(1.0, 0.9, 0.8);
  vtkNew<vtkXMLPolyDataReader> bunny;
  bunny->SetFileName(PENUMBRA_DATA_DIR "/bunny.vtp");
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(bunny->GetOutputPort());
  scene.Add(normals);
  vtkNew<vtkAreaLightSource> light;
  scene.AddLight(light, { 6, -6, 20 }, { 6, -2, 20 }, { 10, -6, 20 });
  SetCamera(scene.Renderer, { -14, -20, 26 }, { -1, 0, 2 });
  CheckImage(scene, "FloorAndBunny");
}

TEST(Images, RoomWithThreeReceivers)
{
  PassScene scene(400, 300);
  vtkNew<vtkShadowReceiver> floor, back, side;
  for (vtkShadowReceiver* receiver : { floor.Get(), back.Get(), side.Get() })
  {
    receiver->SetTexelSize(4.0 / 128);
    receiver->SetAmbientRadiance(0.1, 0.1, 0.1);
  }
  scene.Pass->SetShading(vtkSoftShadowPass::RADIANCE);
  scene.AddReceiver({ 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, floor);
  scene.AddReceiver({ 0, 4, 0 }, { 4, 4, 0 }, { 0, 4, 3 }, back);
  scene.AddReceiver({ 0, 0, 0 }, { 0, 4, 0 }, { 0, 0, 3 }, side);
  vtkNew<vtkCubeSource> box;
  box->SetBounds(1.0, 2.0, 2.0, 3.0, 0.0, 1.0);
  scene.Add(box)->GetProperty()->SetColor(0.9, 0.5, 0.3);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(2.8, 1.8, 0.6);
  ball->SetRadius(0.6);
  ball->SetThetaResolution(48);
  ball->SetPhiResolution(48);
  scene.Add(ball)->GetProperty()->SetColor(0.4, 0.6, 0.9);
  vtkNew<vtkAreaLightSource> warm, cold;
  warm->SetRadiance(30.0, 26.0, 20.0);
  scene.AddLight(warm, { 2.6, 0.6, 2.9 }, { 3.6, 0.6, 2.9 }, { 2.6, 1.6, 2.9 });
  warm->TwoSidedOn();
  cold->SetShape(vtkAreaLightSource::TRIANGLE);
  cold->SetRadiance(6.0, 10.0, 18.0);
  scene.AddLight(cold, { 3.9, 0.2, 1.0 }, { 3.9, 1.4, 1.0 }, { 3.9, 0.2, 2.0 });
  cold->TwoSidedOn();
  SetCamera(scene.Renderer, { 8.5, -6.0, 5.0 }, { 1.5, 2.2, 1.0 });
  CheckImage(scene, "RoomWithThreeReceivers");
}

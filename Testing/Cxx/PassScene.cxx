// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PassScene.h"

#include "vtkCamera.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

PassScene::PassScene(int width, int height)
{
  this->Window->SetMultiSamples(0);
  this->Window->SetSize(width, height);
  this->Window->AddRenderer(this->Renderer);
  this->Renderer->SetBackground(0.3, 0.35, 0.4);
  this->SetShadows(true);
}

void PassScene::SetShadows(bool on)
{
  this->Renderer->SetPass(on ? this->Pass.Get() : nullptr);
}

vtkSmartPointer<vtkActor> PassScene::Add(vtkAlgorithm* algorithm)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(algorithm->GetOutputPort());
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  this->Renderer->AddActor(actor);
  return actor;
}

vtkSmartPointer<vtkActor> PassScene::AddReceiver(
  const Point& origin, const Point& point1, const Point& point2, vtkShadowReceiver* receiver)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(origin[0], origin[1], origin[2]);
  plane->SetPoint1(point1[0], point1[1], point1[2]);
  plane->SetPoint2(point2[0], point2[1], point2[2]);
  receiver->SetInputConnection(plane->GetOutputPort());
  return this->Add(receiver);
}

vtkSmartPointer<vtkActor> PassScene::AddLight(
  vtkAreaLightSource* light, const Point& origin, const Point& point1, const Point& point2)
{
  light->SetOrigin(origin[0], origin[1], origin[2]);
  light->SetPoint1(point1[0], point1[1], point1[2]);
  light->SetPoint2(point2[0], point2[1], point2[2]);
  return this->Add(light);
}

PassScene::Pixels PassScene::Render()
{
  return DrawFrame(this->Window);
}

FloorScene::FloorScene()
{
  this->Sphere->SetRadius(0.5);
  this->Sphere->SetCenter(0.0, 0.0, 0.8);
  this->Sphere->SetThetaResolution(24);
  this->Sphere->SetPhiResolution(24);
  this->Receiver->SetTexelSize(4.0 / 64);
  this->FloorActor = this->AddReceiver({ -2, -2, 0 }, { 2, -2, 0 }, { -2, 2, 0 }, this->Receiver);
  this->LightActor =
    this->AddLight(this->Light, { -0.5, 0.5, 3.0 }, { 0.5, 0.5, 3.0 }, { -0.5, -0.5, 3.0 });
  this->SphereActor = this->Add(this->Sphere);
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  camera->SetPosition(3.0, -6.0, 4.0);
  camera->SetFocalPoint(0.0, 0.0, 0.3);
  camera->SetViewUp(0.0, 0.0, 1.0);
  this->Renderer->ResetCameraClippingRange();
}

PassScene::Pixels DrawFrame(vtkRenderWindow* window)
{
  window->Render();
  const int* size = window->GetSize();
  vtkNew<vtkUnsignedCharArray> array;
  window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, array);
  PassScene::Pixels pixels(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTypedTuple(i, pixels[static_cast<std::size_t>(i)].data());
  }
  return pixels;
}

std::size_t CountDifferences(const PassScene::Pixels& a, const PassScene::Pixels& b)
{
  std::size_t count = a.size() == b.size() ? 0 : std::max(a.size(), b.size());
  for (std::size_t i = 0; count < a.size() && i < a.size(); ++i)
  {
    count += a[i] != b[i] ? 1 : 0;
  }
  return count;
}

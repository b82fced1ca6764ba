// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PassScene.h"

#include "vtkProperty.h"
#include "vtkUnsignedCharArray.h"

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
  this->Window->Render();
  const int* size = this->Window->GetSize();
  vtkNew<vtkUnsignedCharArray> array;
  this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, array);
  Pixels pixels(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTypedTuple(i, pixels[static_cast<std::size_t>(i)].data());
  }
  return pixels;
}

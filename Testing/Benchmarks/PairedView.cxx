// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PairedView.h"

#include "BenchmarkTools.h"

#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"

#include <ctime>
#include <vector>

vtkSmartPointer<vtkActor> MakeActor(vtkAlgorithm* algorithm)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(algorithm->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

PairedView::PairedView(vtkRenderWindow* window, const std::function<void(vtkRenderer*)>& fill)
  : Window(window)
{
  for (vtkRenderer* renderer : { this->Plain.Get(), this->Shadowed.Get() })
  {
    fill(renderer);
    renderer->SetActiveCamera(this->Camera);
    this->Window->AddRenderer(renderer);
  }
  this->Shadowed->SetPass(this->Pass);
}

PairedView::~PairedView()
{
  this->Window->RemoveRenderer(this->Plain);
  this->Window->RemoveRenderer(this->Shadowed);
}

void PairedView::ShowAll()
{
  this->Plain->ResetCamera();
  this->Shadowed->ResetCamera();
}

double PairedView::DrawFrame(bool shadows)
{
  this->Plain->SetDraw(!shadows);
  this->Shadowed->SetDraw(shadows);
  const std::clock_t start = std::clock();
  this->Window->Render();
  this->Window->WaitForCompletion();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

FrameResult PairedView::Measure(int count)
{
  // Frames that compile shaders and bake, and do not count.
  constexpr int WarmUpFrames = 4;
  this->Plain->ResetCameraClippingRange();
  this->Shadowed->ResetCameraClippingRange();
  std::vector<double> plain, shadows, ratios;
  for (int frame = -WarmUpFrames; frame < count; ++frame)
  {
    // Which one comes first changes.
    const bool first = frame % 2 == 0;
    const double a = this->DrawFrame(first);
    const double b = this->DrawFrame(!first);
    if (frame >= 0)
    {
      shadows.push_back(first ? a : b);
      plain.push_back(first ? b : a);
      ratios.push_back(shadows.back() / plain.back());
    }
    this->Camera->Azimuth(1.0);
  }
  return { GetMedian(plain), GetMedian(shadows), GetMedian(ratios), this->Pass->GetBakeCount(),
    static_cast<double>(this->Pass->GetTextureBytes()) };
}

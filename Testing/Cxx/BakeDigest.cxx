// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Bakes a scene by the filter and by the pass of a view, and prints a digest of all bits.
//   BakeDigest [ORDER [VIEWS]]
// ORDER: in which of the orders of its actors; VIEWS: how many other views are open and draw.

#include "vtkActor.h"
#include "vtkAreaLightSource.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkHeadlessFactory.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkRadianceMap.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkShadowReceiver.h"
#include "vtkSmartPointer.h"
#include "vtkSoftShadowPass.h"
#include "vtkSphereSource.h"
#include "vtkStructuredGrid.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <vector>

namespace
{

/// Fowler, Noll and Vo's hash, FNV-1a.
class Digest
{
public:
  void Add(const void* data, std::size_t bytes)
  {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i)
    {
      this->Value = (this->Value ^ byte[i]) * 0x100000001b3u;
    }
  }
  void Add(vtkDataArray* array)
  {
    this->Add(array->GetVoidPointer(0),
      static_cast<std::size_t>(array->GetNumberOfValues() * array->GetDataTypeSize()));
  }
  std::uint64_t Value = 0xcbf29ce484222325u;
};

struct Scene
{
  vtkNew<vtkPlaneSource> Plane;
  vtkNew<vtkShadowReceiver> Floor;
  vtkNew<vtkAreaLightSource> Lamp, Disk, Sun;
  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkCubeSource> Box;
  std::vector<vtkAlgorithm*> Others{ this->Lamp, this->Disk, this->Sun, this->Ball, this->Box };

  explicit Scene(int order)
  {
    this->Plane->SetOrigin(-2, -2, 0);
    this->Plane->SetPoint1(2, -2, 0);
    this->Plane->SetPoint2(-2, 2, 0);
    this->Floor->SetInputConnection(this->Plane->GetOutputPort());
    this->Floor->SetTexelSize(4.0 / 61);
    this->Lamp->SetOrigin(-0.5, 0.5, 2.0);
    this->Lamp->SetPoint1(0.5, 0.5, 2.0);
    this->Lamp->SetPoint2(-0.5, -0.5, 2.0);
    this->Lamp->SetRadiance(3.0, 2.0, 1.0);
    this->Disk->SetShape(2);
    this->Disk->SetOrigin(1.0, 0.3, 2.5);
    this->Disk->SetPoint1(1.0, 0.6, 2.5);
    this->Disk->SetPoint2(0.7, 0.3, 2.5);
    this->Disk->SetTwoSided(true);
    this->Sun->SetShape(5);
    this->Sun->SetOrigin(1.0, 1.0, 3.0);
    this->Sun->SetPoint1(0.0, 0.0, 0.0);
    this->Ball->SetCenter(-0.4, 0.2, 0.8);
    this->Box->SetCenter(0.6, -0.3, 0.25);
    this->Box->SetXLength(0.5);
    this->Box->SetYLength(0.5);
    this->Box->SetZLength(0.5);
    for (int i = 0; i < order; ++i)
    {
      std::next_permutation(this->Others.begin(), this->Others.end());
    }
  }
};

void AddFilter(const Scene& scene, Digest& digest)
{
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Floor->GetOutputPort());
  for (vtkAlgorithm* other : scene.Others)
  {
    const bool isLight = vtkAreaLightSource::SafeDownCast(other) != nullptr;
    map->AddInputConnection(
      isLight ? vtkRadianceMap::LIGHTS : vtkRadianceMap::OCCLUDERS, other->GetOutputPort());
  }
  map->Update();
  auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(0));
  for (const char* name : { "Radiance", "Visibility", "ErrorEstimate" })
  {
    digest.Add(grid->GetCellData()->GetArray(name));
  }
}

void AddActor(vtkRenderer* renderer, vtkAlgorithm* source)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  renderer->AddActor(actor);
}

/// A window with a view of the scene.
struct View
{
  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkSoftShadowPass> Pass;

  explicit View(const Scene& scene)
  {
    this->Window->SetSize(64, 48);
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->SetPass(this->Pass);
    for (vtkAlgorithm* other : scene.Others)
    {
      AddActor(this->Renderer, other);
    }
    AddActor(this->Renderer, scene.Floor);
    this->Window->Render();
  }
};

} // namespace

int main(int argc, char** argv)
{
  vtkHeadlessFactory::RegisterIfNoDisplay();
  const int order = argc > 1 ? std::atoi(argv[1]) : 0;
  const int others = argc > 2 ? std::atoi(argv[2]) : 0;
  const Scene scene(order);
  std::vector<std::unique_ptr<View>> views;
  for (int i = 0; i < others; ++i)
  {
    views.push_back(std::make_unique<View>(scene));
  }
  Digest digest;
  AddFilter(scene, digest);
  View view(scene);
  for (const std::unique_ptr<View>& other : views)
  {
    other->Window->Render();
  }
  view.Window->Render();
  view.Window->MakeCurrent();
  digest.Add(view.Pass->GetTexels(0));
  std::cout << std::hex << digest.Value << "\n";
  return 0;
}

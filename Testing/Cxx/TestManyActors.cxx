// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What a frame costs where there are many actors is what has changed in them, not how many they
// are. Counts tell of it, on any machine.

#include "PassScene.h"
#include "vtkShadowSceneCollector.h"

#include "vtkAssembly.h"
#include "vtkCamera.h"
#include "vtkCubeSource.h"
#include "vtkCullerCollection.h"
#include "vtkMatrix4x4.h"
#include "vtkProperty.h"
#include "vtkTransform.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace
{

/// A floor, a light, a ball, boxes of their own data, and two actors that are parts of an assembly.
class ManyActors : public FloorScene
{
public:
  explicit ManyActors(int boxes)
    : FloorScene()
  {
    this->Pass->SetBakeMode(vtkSoftShadowPass::DRAFT);
    this->Receiver->SetTexelSize(0.5);
    for (int i = 0; i < boxes; ++i)
    {
      this->Boxes.push_back(vtkSmartPointer<vtkCubeSource>::New());
      this->Boxes.back()->SetXLength(0.01);
      this->Actors.push_back(this->Add(this->Boxes.back()));
      this->Actors.back()->SetPosition(-1.0 + 2.0 * i / boxes, 0.5, 0.3);
    }
    for (const vtkSmartPointer<vtkActor>& part : { this->Actors[0], this->Actors[1] })
    {
      this->Renderer->RemoveActor(part);
      this->Parts->AddPart(part);
    }
    this->Renderer->AddActor(this->Parts);
  }

  /// Draws a frame, in which cullers bring data up to date, and looks at what has changed. The
  /// answer is whether anything has.
  bool Look()
  {
    this->Render();
    return this->Collector->Update(this->Renderer, false);
  }

  std::vector<vtkSmartPointer<vtkCubeSource>> Boxes;
  std::vector<vtkSmartPointer<vtkActor>> Actors;
  vtkNew<vtkAssembly> Parts;
  vtkNew<vtkShadowSceneCollector> Collector;
};

} // namespace

TEST(ManyActors, OnlyWhatHasChangedIsBuilt)
{
  for (const int boxes : { 10, 100, 1000 })
  {
    ManyActors scene(boxes);
    EXPECT_TRUE(scene.Look());
    const auto all = static_cast<std::size_t>(boxes) + 3;
    EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), all);
    const std::size_t own = static_cast<std::size_t>(boxes) / 2;
    vtkActor *actor = scene.Actors[own], *part = scene.Actors[0];
    vtkNew<vtkTransform> transform;
    transform->Translate(0.1, 0, 0);
    vtkNew<vtkMatrix4x4> matrix;
    const std::vector<std::pair<std::string, std::function<void()>>> edits{
      { "move", [&] { actor->AddPosition(0.1, 0, 0); } },
      { "user transform", [&] { actor->SetUserTransform(transform); } },
      { "move of a user transform", [&] { transform->Translate(0, 0.1, 0); } },
      { "user matrix",
        [&]
        {
          matrix->SetElement(0, 3, 0.2);
          actor->SetUserMatrix(matrix);
        } },
      { "data", [&] { scene.Boxes[own]->SetYLength(0.02); } },
      { "data of a part", [&] { scene.Boxes[0]->SetYLength(0.02); } },
      { "part", [&] { part->AddPosition(0.1, 0, 0); } },
      { "opacity", [&] { actor->GetProperty()->SetOpacity(0.5); } },
      { "representation", [&] { actor->GetProperty()->SetRepresentationToWireframe(); } },
    };
    for (const auto& [what, edit] : edits)
    {
      edit();
      EXPECT_TRUE(scene.Look()) << what << " among " << boxes;
      EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), 1u) << what << " among " << boxes;
      scene.Renderer->GetActiveCamera()->Azimuth(3.0);
      EXPECT_FALSE(scene.Look()) << "orbit after " << what << " among " << boxes;
      EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), 0u) << "orbit after " << what;
    }
    scene.Parts->AddPosition(0, 0.1, 0);
    EXPECT_TRUE(scene.Look());
    EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), 2u) << "both parts of an assembly";
    for (const bool isVisible : { false, true })
    {
      scene.Actors[2]->SetVisibility(isVisible);
      EXPECT_TRUE(scene.Look());
      EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), isVisible ? 1u : 0u)
        << "those behind one that comes or goes, among " << boxes;
    }
  }
}

// Without a culler nobody but the collector brings data up to date before it looks.
TEST(ManyActors, ChangedDataAreSeenWithoutCullers)
{
  ManyActors scene(10);
  scene.Renderer->GetCullers()->RemoveAllItems();
  EXPECT_TRUE(scene.Look());
  scene.Boxes[5]->SetYLength(0.02);
  EXPECT_TRUE(scene.Collector->Update(scene.Renderer, false));
  EXPECT_EQ(scene.Collector->GetNumberOfBuiltParts(), 1u);
}

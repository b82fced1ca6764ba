// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What has not changed is not baked, and what is baked in parts is, to the bit, what a whole bake
// gives.

#include "PassScene.h"

#include "vtkActor.h"
#include "vtkAreaLightSource.h"
#include "vtkCamera.h"
#include "vtkCubeSource.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkProperty.h"
#include "vtkShadowReceiver.h"
#include "vtkSoftShadowPass.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace
{

/// A floor with 7 x 7 boxes on it and over it, under two lights.
class BoxField : public PassScene
{
public:
  BoxField()
  {
    this->Receiver->SetTexelSize(10.0 / 128);
    this->Receiver->SetLightSamples(32);
    this->Floor = this->AddReceiver({ -5, -5, 0 }, { 5, -5, 0 }, { -5, 5, 0 }, this->Receiver);
    this->AddLight(this->Lamp, { -1, 1, 6 }, { 1, 1, 6 }, { -1, -1, 6 });
    this->AddLight(this->Other, { 3, 1, 8 }, { 4, 1, 8 }, { 3, 0, 8 });
    for (int i = 0; i < 49; ++i)
    {
      vtkNew<vtkCubeSource> box;
      box->SetXLength(0.5);
      box->SetYLength(0.6);
      box->SetZLength(0.7);
      vtkSmartPointer<vtkActor> actor = this->Add(box);
      actor->SetPosition(1.3 * (i % 7) - 4.0, 1.3 * (i / 7) - 4.0, 0.35 + 0.3 * (i % 3));
      this->Boxes.push_back(actor);
    }
  }

  std::vector<float> GetTexels()
  {
    const vtkSmartPointer<vtkFloatArray> array = this->Pass->GetTexels(0);
    return { array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues() };
  }

  /// The sum of a column of the plan.
  double Sum(const char* column)
  {
    vtkNew<vtkTable> plan;
    this->Pass->GetPlan(plan);
    double sum = 0.0;
    for (vtkIdType row = 0; row < plan->GetNumberOfRows(); ++row)
    {
      sum += plan->GetValueByName(row, column).ToDouble();
    }
    return sum;
  }

  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Lamp, Other;
  vtkSmartPointer<vtkActor> Floor;
  std::vector<vtkSmartPointer<vtkActor>> Boxes;
};

using Change = std::function<void(BoxField&)>;

/// Texels after a change of a scene that has been baked, and of a scene that was so from the start.
void ExpectSameAsWhole(const std::vector<Change>& changes)
{
  BoxField changed;
  changed.Render();
  for (const Change& change : changes)
  {
    change(changed);
    changed.Render();
  }
  BoxField whole;
  for (const Change& change : changes)
  {
    change(whole);
  }
  whole.Render();
  EXPECT_EQ(changed.GetTexels(), whole.GetTexels());
  EXPECT_EQ(changed.Render(), whole.Render());
}

} // namespace

TEST(IncrementalBake, OfAMovedObject)
{
  ExpectSameAsWhole({ [](BoxField& s) { s.Boxes[24]->AddPosition(0.4, 0.3, 0.1); } });
}

TEST(IncrementalBake, OfManyMoves)
{
  std::vector<Change> changes;
  for (int i = 0; i < 12; ++i)
  {
    changes.push_back([i](BoxField& s)
      { s.Boxes[4 * static_cast<std::size_t>(i)]->AddPosition(0.3, -0.2 * (i % 3), 0.2); });
  }
  ExpectSameAsWhole(changes);
}

TEST(IncrementalBake, OfObjectsThatComeAndGo)
{
  ExpectSameAsWhole({ [](BoxField& s) { s.Boxes[0]->VisibilityOff(); },
    [](BoxField& s) { s.Boxes[48]->VisibilityOff(); },
    [](BoxField& s) { s.Boxes[0]->VisibilityOn(); } });
}

TEST(IncrementalBake, OfLights)
{
  ExpectSameAsWhole({ [](BoxField& s) { s.Lamp->SetRadiance(0.5, 2.0, 1.0); },
    [](BoxField& s) { s.Boxes[10]->AddPosition(0.0, 0.5, 0.0); },
    [](BoxField& s) { s.Other->SetPoint1(5.0, 1.0, 8.0); },
    [](BoxField& s) { s.Other->SetRadiance(3.0, 0.5, 0.1); } });
}

TEST(IncrementalBake, OfSupersampledTexels)
{
  ExpectSameAsWhole({ [](BoxField& s) { s.Receiver->SetSupersampling(2); },
    [](BoxField& s) { s.Boxes[30]->AddPosition(0.4, 0.3, 0.1); } });
}

// From far away, when pixels show mip levels of the radiance itself.
TEST(IncrementalBake, OfRadianceSeenFromAfar)
{
  BoxField changed, whole;
  for (BoxField* scene : { &changed, &whole })
  {
    scene->Pass->SetShading(vtkSoftShadowPass::RADIANCE);
    scene->Lamp->SetRadiance(20.0, 20.0, 20.0);
    scene->Renderer->ResetCamera(-5, 5, -5, 5, 0, 1);
    scene->Renderer->GetActiveCamera()->Dolly(0.2);
    scene->Renderer->ResetCameraClippingRange();
  }
  const PassScene::Pixels before = changed.Render();
  for (BoxField* scene : { &changed, &whole })
  {
    for (const vtkSmartPointer<vtkActor>& box : scene->Boxes)
    {
      box->AddPosition(0.6, 0.5, 0.0);
    }
  }
  const PassScene::Pixels after = changed.Render();
  EXPECT_EQ(CountDifferences(after, whole.Render()), 0u);
  EXPECT_GT(CountDifferences(after, before), 0u);
}

// "Moving one of 50 objects re-bakes only the rectangle it can shade, before and after": its
// shadows here are below 3 x 3 of the floor's 10 x 10.
TEST(IncrementalBake, DrawsOnlyWhatAMoveCanShade)
{
  BoxField scene;
  scene.Render();
  const double all = scene.Sum("Texels");
  scene.Boxes[24]->AddPosition(0.2, 0.1, 0.0);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 2);
  EXPECT_GT(scene.Sum("Texels"), 0.0);
  EXPECT_LE(scene.Sum("Texels"), 0.09 * all);
}

TEST(IncrementalBake, DrawsNothingForRadiance)
{
  BoxField scene;
  scene.Receiver->SetLightSamples(256); // what both lights keep fits into n/8 + 24 bytes a texel
  scene.Render();
  EXPECT_GT(scene.Sum("LightSamples"), 0.0);
  scene.Lamp->SetRadiance(0.5, 2.0, 1.0);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 2);
  EXPECT_EQ(scene.Sum("LightSamples"), 0.0);
}

TEST(IncrementalBake, IsNotForColourAndOpacity)
{
  BoxField scene;
  scene.Render();
  scene.Boxes[24]->GetProperty()->SetColor(1.0, 0.0, 0.0);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
}

// What is beyond the light's and the receiver's pyramid is not looked at.
TEST(IncrementalBake, IsNotForObjectsElsewhere)
{
  BoxField scene;
  vtkNew<vtkCubeSource> box;
  const vtkSmartPointer<vtkActor> actor = scene.Add(box);
  actor->SetPosition(50.0, 0.0, 1.0);
  scene.Render();
  actor->SetPosition(60.0, 0.0, 1.0);
  scene.Render();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
}

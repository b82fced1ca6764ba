// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// How actors and data say what light they let through, and what a change of that bakes anew.

#include "PassScene.h"

#include "ShadowSettings.h"
#include "vtkActor.h"
#include "vtkAreaLightSource.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkElevationFilter.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRadianceMap.h"
#include "vtkShadowCaster.h"
#include "vtkShadowReceiver.h"
#include "vtkSoftShadowPass.h"
#include "vtkStructuredGrid.h"
#include "vtkTable.h"
#include "vtkTestErrorObserver.h"
#include "vtkVariant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace
{

/// A floor under a lamp, with a box and a pane between.
class PaneScene : public PassScene
{
public:
  PaneScene()
  {
    this->Receiver->SetTexelSize(10.0 / 64);
    this->Receiver->SetLightSamples(32);
    this->Floor = this->AddReceiver({ -5, -5, 0 }, { 5, -5, 0 }, { -5, 5, 0 }, this->Receiver);
    this->AddLight(this->Lamp, { -1, 1, 6 }, { 1, 1, 6 }, { -1, -1, 6 });
    this->Cube->SetCenter(1.0, 1.0, 0.6);
    this->Box = this->Add(this->Cube);
    this->Plane->SetOrigin(-1.5, -1.5, 1.0);
    this->Plane->SetPoint1(1.0, -1.5, 1.0);
    this->Plane->SetPoint2(-1.5, 1.0, 1.2);
    this->Caster->SetInputConnection(this->Plane->GetOutputPort());
    this->Pane = this->Add(this->Caster);
  }

  std::vector<float> GetTexels()
  {
    this->Render();
    const vtkSmartPointer<vtkFloatArray> array = this->Pass->GetTexels(0);
    return { array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues() };
  }

  std::string GetReason()
  {
    vtkNew<vtkTable> plan;
    this->Pass->GetPlan(plan);
    return plan->GetValueByName(0, "Reason").ToString();
  }

  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Lamp;
  vtkNew<vtkCubeSource> Cube;
  vtkNew<vtkPlaneSource> Plane;
  vtkNew<vtkShadowCaster> Caster;
  vtkSmartPointer<vtkActor> Floor, Box, Pane;
};

using Change = std::function<void(PaneScene&)>;

std::vector<float> GetTexelsOf(const Change& change)
{
  PaneScene scene;
  change(scene);
  return scene.GetTexels();
}

void LeaveOut(PaneScene& scene)
{
  scene.Pane->VisibilityOff();
}

void Nothing(PaneScene&) {}

Change SetOpacity(double opacity)
{
  return [=](PaneScene& scene) { scene.Pane->GetProperty()->SetOpacity(opacity); };
}

/// The middle of the floor's texels, behind the pane from all of the lamp.
double GetMiddle(const std::vector<float>& texels, int component)
{
  constexpr std::size_t Side = 64;
  return static_cast<double>(
    texels[4 * (Side * (Side / 2 - 5) + Side / 2 - 5) + static_cast<std::size_t>(component)]);
}

} // namespace

// What passes adds up linearly: where the pane covers all of the lamp, to a rounding of the
// weights' sum (32 + 1 additions, of 6e-8 each).
TEST(TranslucentActors, WeakenByOpacity)
{
  const double lit = GetMiddle(GetTexelsOf(LeaveOut), 0);
  ASSERT_GT(lit, 0.0);
  ASSERT_EQ(GetMiddle(GetTexelsOf(Nothing), 0), 0.0);
  for (const double opacity : { 0.25, 0.5, 0.9 })
  {
    EXPECT_NEAR(GetMiddle(GetTexelsOf(SetOpacity(opacity)), 0), (1.0 - opacity) * lit, 2e-6 * lit);
  }
}

TEST(TranslucentActors, TintByColour)
{
  PaneScene scene;
  SetOpacity(0.5)(scene);
  scene.Pane->GetProperty()->SetColor(0.2, 0.1, 0.0);
  const std::vector<float> tinted = scene.GetTexels();
  const double lit = GetMiddle(GetTexelsOf(LeaveOut), 0);
  const double expected[] = { 0.5, 0.375, 0.25 };
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(GetMiddle(tinted, c), expected[c] * lit, 2e-6 * lit);
  }
}

// What is coloured by scalars has no colour of its own.
TEST(TranslucentActors, DoNotTintByScalars)
{
  PaneScene scene;
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(scene.Plane->GetOutputPort());
  scene.Caster->SetInputConnection(elevation->GetOutputPort());
  SetOpacity(0.5)(scene);
  scene.Pane->GetProperty()->SetColor(1.0, 0.0, 0.0);
  EXPECT_NE(scene.GetTexels(), GetTexelsOf(SetOpacity(0.5)));
  scene.Pane->GetMapper()->ScalarVisibilityOn();
  EXPECT_EQ(scene.GetTexels(), GetTexelsOf(SetOpacity(0.5)));
}

TEST(TranslucentActors, AreOpaqueOrAbsentAtTheEnds)
{
  EXPECT_EQ(GetTexelsOf(SetOpacity(0.0)), GetTexelsOf(LeaveOut));
  EXPECT_EQ(GetTexelsOf(SetOpacity(1.0)), GetTexelsOf(Nothing));
  EXPECT_NE(GetTexelsOf(LeaveOut), GetTexelsOf(Nothing));
}

TEST(TranslucentActors, AreWeighedAlone)
{
  PaneScene scene;
  scene.GetTexels();
  EXPECT_EQ(scene.GetReason().find("translucent"), std::string::npos) << scene.GetReason();
  SetOpacity(0.5)(scene);
  scene.GetTexels();
  EXPECT_NE(scene.GetReason().find("1 translucent surface"), std::string::npos)
    << scene.GetReason();
}

// By the prop, by the data, or by the receiver that the data are.
TEST(CastShadow, OffIsAbsent)
{
  const std::vector<float> without = GetTexelsOf(LeaveOut);
  EXPECT_EQ(GetTexelsOf([](PaneScene& s) { s.Caster->CastShadowOff(); }), without);
  PaneScene scene;
  scene.GetTexels();
  EXPECT_TRUE(vtkSoftShadowPass::GetCastShadow(scene.Pane));
  vtkSoftShadowPass::SetCastShadow(scene.Pane, false);
  EXPECT_FALSE(vtkSoftShadowPass::GetCastShadow(scene.Pane));
  EXPECT_EQ(scene.GetTexels(), without);
  vtkSoftShadowPass::SetCastShadow(scene.Pane, true);
  EXPECT_EQ(scene.GetTexels(), GetTexelsOf(Nothing));
}

TEST(CastShadow, OffIsForReceiversToo)
{
  const auto add = [](PaneScene& scene, vtkShadowReceiver* receiver) {
    return scene.AddReceiver({ -3, 2, 0.5 }, { 1, 2, 0.5 }, { -3, 4, 0.5 }, receiver);
  };
  const std::vector<float> without = GetTexelsOf(Nothing);
  PaneScene scene;
  vtkNew<vtkShadowReceiver> receiver;
  const vtkSmartPointer<vtkActor> table = add(scene, receiver);
  EXPECT_NE(scene.GetTexels(), without);
  const vtkSmartPointer<vtkFloatArray> before = scene.Pass->GetTexels(1);
  receiver->CastShadowOff();
  EXPECT_EQ(scene.GetTexels(), without);
  // It receives as it did.
  ASSERT_EQ(scene.Pass->GetNumberOfReceivers(), 2);
  const vtkSmartPointer<vtkFloatArray> after = scene.Pass->GetTexels(1);
  ASSERT_EQ(after->GetNumberOfValues(), before->GetNumberOfValues());
  for (vtkIdType i = 0; i < after->GetNumberOfValues(); ++i)
  {
    ASSERT_EQ(after->GetValue(i), before->GetValue(i));
  }
  receiver->CastShadowOn();
  vtkSoftShadowPass::SetCastShadow(table, false);
  EXPECT_EQ(scene.GetTexels(), without);
}

// The blocks of one actor are one object: where two overlap, light is weakened once.
TEST(TranslucentActors, WeakenOnceForAllBlocks)
{
  PaneScene scene;
  SetOpacity(0.5)(scene);
  scene.Plane->Update();
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, scene.Plane->GetOutput());
  blocks->SetBlock(1, scene.Plane->GetOutput());
  vtkNew<vtkShadowCaster> caster;
  caster->SetInputData(blocks);
  caster->SetUseTransmittance(true);
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, scene.Lamp->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, scene.Cube->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, caster->GetOutputPort());
  map->Update();
  // Transmittance is 0.5 by default: the view with that opacity shows the same, to the bit.
  auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(0));
  auto* radiance = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Radiance"));
  const std::vector<float> shown = scene.GetTexels();
  for (vtkIdType i = 0; i < radiance->GetNumberOfValues(); ++i)
  {
    ASSERT_EQ(radiance->GetValue(i), shown[static_cast<std::size_t>(4 * (i / 3) + i % 3)]);
  }
}

// What the data say goes before the actor.
TEST(ShadowCaster, OverridesTheActor)
{
  PaneScene scene;
  SetOpacity(0.9)(scene);
  scene.Caster->SetUseTransmittance(true);
  EXPECT_EQ(scene.GetTexels(), GetTexelsOf(SetOpacity(0.5)));
  scene.Caster->SetTransmittance(0.0, 0.0, 0.0);
  EXPECT_EQ(scene.GetTexels(), GetTexelsOf(Nothing));
  scene.Caster->SetTransmittance(1.0, 1.0, 1.0);
  EXPECT_EQ(scene.GetTexels(), GetTexelsOf(LeaveOut));
}

TEST(ShadowCaster, RefusesWhatIsNoShare)
{
  vtkNew<vtkPlaneSource> plane;
  vtkNew<vtkShadowCaster> caster;
  caster->SetInputConnection(plane->GetOutputPort());
  caster->SetUseTransmittance(true);
  caster->SetTransmittance(0.5, 1.5, 0.5);
  vtkNew<vtkTest::ErrorObserver> errors;
  caster->AddObserver(vtkCommand::ErrorEvent, errors);
  caster->Update();
  EXPECT_NE(errors->GetErrorMessage().find(
              "Transmittance is (0.5, 1.5, 0.5); allowed: 0 to 1 for each component"),
    std::string::npos);
  EXPECT_FALSE(caster->GetOutputDataObject(0)->GetFieldData()->HasArray("Transmittance"));
}

// Whatever becomes of a translucent object, what is baked of the change is a whole bake's. There
// are enough samples that all shares are kept, also three of a tinted light.
TEST(TranslucentActors, BakeChangesAsAWhole)
{
  const std::vector<Change> changes{ [](PaneScene& s) { s.Receiver->SetLightSamples(256); },
    SetOpacity(0.5), SetOpacity(0.7),
    [](PaneScene& s) { s.Pane->GetProperty()->SetColor(1.0, 0.3, 0.1); },
    [](PaneScene& s) { s.Pane->AddPosition(0.4, 0.3, 0.1); },
    [](PaneScene& s) { s.Box->GetProperty()->SetOpacity(0.4); },
    [](PaneScene& s) { s.Box->AddPosition(-0.4, 0.3, 0.1); },
    [](PaneScene& s) { s.Pane->GetProperty()->SetColor(0.3, 0.3, 0.3); },
    [](PaneScene& s) { s.Lamp->SetRadiance(2.0, 1.0, 0.5); }, SetOpacity(1.0) };
  std::vector<std::vector<float>> wholes;
  for (std::size_t i = 1; i <= changes.size(); ++i)
  {
    wholes.push_back(GetTexelsOf(
      [&](PaneScene& scene)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          changes[j](scene);
        }
      }));
  }
  PaneScene changed;
  changed.GetTexels();
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    changes[i](changed);
    EXPECT_EQ(changed.GetTexels(), wholes[i]) << "change " << i;
  }
}

TEST(TranslucentActors, BakeAnewForColourOnlyIfTranslucent)
{
  PaneScene scene;
  scene.GetTexels();
  scene.Pane->GetProperty()->SetColor(1.0, 0.3, 0.1);
  scene.GetTexels();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 1);
  SetOpacity(0.5)(scene);
  scene.GetTexels();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 2);
  scene.Pane->GetProperty()->SetColor(0.3, 1.0, 0.1);
  scene.GetTexels();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 3);
  scene.Pane->GetProperty()->SetSpecular(0.5);
  scene.GetTexels();
  EXPECT_EQ(scene.Pass->GetBakeCount(), 3);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// MaximumTextureMemory in a view.

#include "Messages.h"
#include "PassScene.h"

#include "vtkFloatArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

constexpr int Side = 256;

/// Two floors with a plate over each: close to the first, far above the second.
class TwoFloors : public PassScene
{
public:
  TwoFloors()
  {
    for (const double x : { -6.0, 1.0 })
    {
      vtkNew<vtkShadowReceiver> receiver;
      receiver->SetTexelSize(5.0 / Side);
      this->AddReceiver({ x, -2.5, 0 }, { x + 5, -2.5, 0 }, { x, 2.5, 0 }, receiver);
    }
    this->AddLight(this->Lamp, { -1, 1, 8 }, { 1, 1, 8 }, { -1, -1, 8 });
    this->AddPlate(this->Low, -4.5, 0.2);
    this->AddPlate(this->High, 2.5, 2.0);
  }

  int CountTexels(int receiver) const
  {
    return static_cast<int>(this->Pass->GetTexels(receiver)->GetNumberOfTuples());
  }

  vtkNew<vtkAreaLightSource> Lamp;
  vtkNew<vtkPlaneSource> Low, High;

private:
  void AddPlate(vtkPlaneSource* plate, double x, double height)
  {
    plate->SetOrigin(x, -0.7, height);
    plate->SetPoint1(x + 1.5, -0.7, height);
    plate->SetPoint2(x, 0.7, height);
    this->Add(plate);
  }
};

constexpr vtkTypeInt64 MiB = 1024 * 1024;

} // namespace

TEST(TextureBudgetOfAView, IsKeptWhereItHurtsLeast)
{
  TwoFloors scene;
  scene.Render();
  const vtkTypeInt64 all = scene.Pass->GetTextureBytes();
  // 21.3 bytes a texel of both, and no kept share of a texel is larger than 8.
  EXPECT_GE(all, 2 * 21 * Side * Side);
  ASSERT_EQ(scene.CountTexels(0), Side * Side);
  const Messages messages;
  scene.Pass->SetMaximumTextureMemory(2.0);
  scene.Render();
  EXPECT_LE(scene.Pass->GetTextureBytes(), 2 * MiB);
  EXPECT_EQ(scene.CountTexels(0), Side * Side) << "narrow penumbrae keep their texels";
  EXPECT_LT(scene.CountTexels(1), Side * Side / 2);
  messages.ExpectOne({ "MaximumTextureMemory (2 MiB)", "1 of 2 receivers", "TexelSize" });

  // What moves changes no texel's size, and is no news.
  const int texels = scene.CountTexels(1);
  scene.High->SetOrigin(2.6, -0.7, 0.1);
  scene.Render();
  EXPECT_EQ(scene.CountTexels(1), texels);
  EXPECT_EQ(messages.Count("MaximumTextureMemory"), 1);

  scene.Pass->SetMaximumTextureMemory(256.0);
  scene.Render();
  EXPECT_EQ(scene.CountTexels(1), Side * Side);
  EXPECT_EQ(messages.Count("MaximumTextureMemory"), 1);
}

// What is kept to bake less the next time goes first: texels need not grow for it.
TEST(TextureBudgetOfAView, LetsGoOfWhatIsKept)
{
  TwoFloors scene;
  scene.Render();
  const vtkTypeInt64 all = scene.Pass->GetTextureBytes();
  const Messages messages;
  // Of the two textures alone: 16 bytes a texel, and 4 with mip levels.
  const auto textures = static_cast<vtkTypeInt64>(2 * Side * Side * (16.0 + 4.0 * 4.0 / 3.0));
  ASSERT_GT(all, textures + 1000) << "nothing is kept";
  scene.Pass->SetMaximumTextureMemory(static_cast<double>(textures + 1000) / MiB);
  scene.Render();
  EXPECT_EQ(messages.GetText(), "");
  EXPECT_LE(scene.Pass->GetTextureBytes(), textures + 1000);
  EXPECT_EQ(scene.CountTexels(1), Side * Side);
}

TEST(TextureBudgetOfAView, SaysWhatIsAllowed)
{
  vtkNew<vtkSoftShadowPass> pass;
  for (const double memory : { 0.5, -3.0, std::numeric_limits<double>::quiet_NaN() })
  {
    const Messages messages;
    pass->SetMaximumTextureMemory(memory);
    messages.ExpectOne({ "MaximumTextureMemory", "allowed: 1 MiB" });
    EXPECT_EQ(pass->GetMaximumTextureMemory(), 256.0);
  }
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Translucent occluders weaken light, once each, by what they let through.

#include "DirectionalLight.h"
#include "PointLight.h"
#include "SurfaceLight.h"
#include "TestScenes.h"
#include "vtkVisibilityMask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <utility>

namespace
{

const glm::dvec3 Grey(0.5);
const glm::dvec3 Red(0.8, 0.3, 0.1);
const glm::dvec3 Opaque(0.0);
const glm::dvec3 Absent(1.0);

/// A lamp over a floor; two plates between that overlap in the lamp's view, and what they let
/// through.
struct Panes
{
  TestScene Scene; ///< without occluders
  std::vector<oracle::Triangle> First, Second;

  explicit Panes(bool reconstruction = true)
  {
    this->Scene.AddLight({ -0.4, 0.4, 3.0 }, { 0.4, 0.4, 3.0 }, { -0.4, -0.4, 3.0 });
    this->Scene.Settings.LightSamples = 256;
    this->Scene.Settings.Reconstruction = reconstruction;
    TestScene plates;
    plates.AddPlate({ -0.8, -0.4, 0.7 }, { 1.2, 0.2, 0.1 }, { -0.1, 0.5, 0.1 });
    this->First.swap(plates.Occluders);
    plates.AddPlate({ -0.1, -0.7, 1.0 }, { 0.4, 0.1, 0.0 }, { 0.1, 1.1, -0.1 });
    this->Second.swap(plates.Occluders);
  }

  /// The plates as surfaces of what they let through.
  penumbra::ShadowScene Make(const glm::dvec3& first, const glm::dvec3& second) const
  {
    penumbra::ShadowScene scene = this->Scene.MakeScene();
    scene.Surfaces.pop_back();
    this->Add(this->First, first, scene);
    this->Add(this->Second, second, scene);
    return scene;
  }

  /// Adds triangles to a scene as a surface of what they let through.
  void Add(const std::vector<oracle::Triangle>& triangles, const glm::dvec3& transmittance,
    penumbra::ShadowScene& scene) const
  {
    TestScene one = this->Scene;
    one.Occluders = triangles;
    penumbra::Surface surface = *one.MakeScene().Surfaces.back();
    surface.Transmittance = transmittance;
    scene.Surfaces.emplace_back(surface);
  }

  /// The scene with opaque plates, one of them or both.
  TestScene WithOpaque(bool first, bool second) const
  {
    TestScene scene = this->Scene;
    if (first)
    {
      scene.Occluders = this->First;
    }
    if (second)
    {
      scene.Occluders.insert(scene.Occluders.end(), this->Second.begin(), this->Second.end());
    }
    return scene;
  }
};

/// What a texel gets with no plate, the first, the second, and both, all opaque.
struct Quarters
{
  glm::dvec3 None, First, Second, Both;

  /// The same with plates that let light through: of each sample, b1 and b2 being 1 where a plate
  /// is in its way, (1 - (1 - t1) b1) (1 - (1 - t2) b2). Multiplied out, sums over samples are
  /// these four.
  glm::dvec3 Weaken(const glm::dvec3& t1, const glm::dvec3& t2) const
  {
    const glm::dvec3 behindFirst = this->None - this->First;
    const glm::dvec3 behindSecond = this->None - this->Second;
    const glm::dvec3 behindBoth = behindFirst + behindSecond - (this->None - this->Both);
    return this->None - (1.0 - t1) * behindFirst - (1.0 - t2) * behindSecond +
      (1.0 - t1) * (1.0 - t2) * behindBoth;
  }
};

/// How far a bake is from what is expected of each texel, as shares of the peak of that.
TestError Compare(const TestBake& bake, const std::vector<glm::dvec3>& expected)
{
  double peak = 0.0, largest = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const glm::dvec3 error = glm::dvec3(bake.Texels.Irradiance.at(i)) - expected[i];
    for (int c = 0; c < 3; ++c)
    {
      peak = std::max(peak, expected[i][c]);
      largest = std::max(largest, std::abs(error[c]));
      squares += error[c] * error[c];
    }
  }
  return { std::sqrt(squares / (3.0 * static_cast<double>(expected.size()))) / peak,
    largest / peak };
}

/// What is expected of the texels by four answers to the scenes of opaque plates.
std::vector<glm::dvec3> WeakenAll(const Panes& panes, const glm::dvec3& t1, const glm::dvec3& t2,
  const std::function<std::vector<glm::dvec3>(const TestScene&)>& answer)
{
  const std::vector<glm::dvec3> none = answer(panes.WithOpaque(false, false)),
                                first = answer(panes.WithOpaque(true, false)),
                                second = answer(panes.WithOpaque(false, true)),
                                both = answer(panes.WithOpaque(true, true));
  std::vector<glm::dvec3> weakened;
  for (std::size_t i = 0; i < none.size(); ++i)
  {
    weakened.push_back(Quarters{ none[i], first[i], second[i], both[i] }.Weaken(t1, t2));
  }
  return weakened;
}

std::vector<glm::dvec3> GetExact(const TestScene& scene)
{
  std::vector<glm::dvec3> exact;
  for (int i = 0; i < scene.Texels.x * scene.Texels.y; ++i)
  {
    exact.push_back(scene.GetExact(i % scene.Texels.x, i / scene.Texels.x));
  }
  return exact;
}

std::vector<glm::dvec3> GetBaked(const TestScene& scene)
{
  const TestBake bake = BakeReceiver(scene.MakeScene());
  return { bake.Texels.Irradiance.begin(), bake.Texels.Irradiance.end() };
}

const vtkRadianceBaker::PairReport& GetPair(const TestBake& bake)
{
  return bake.Reports.front().Pairs.front();
}

bool IsWeighed(const TestBake& bake)
{
  return GetPair(bake).Reason.find("translucent") != std::string::npos;
}

struct PanesCase
{
  const char* Name;
  glm::dvec3 First, Second;
};

void PrintTo(const PanesCase& panes, std::ostream* os)
{
  *os << panes.Name;
}

const PanesCase Cases[] = { { "OneGrey", Grey, Absent }, { "OneTinted", Red, Absent },
  { "TwoGrey", Grey, glm::dvec3(0.3) }, { "TintedAndGrey", Red, Grey },
  { "TwoTinted", Red, glm::dvec3(0.0, 0.5, 1.0) }, { "OpaqueAndGrey", Opaque, Grey },
  { "TintedAndOpaque", Red, Opaque } };

} // namespace

class Translucent : public testing::TestWithParam<PanesCase>
{
};

// A pane's share is estimated from the same samples as an opaque plate's, whose bounds at 256
// samples these are; here less than all of a sample is at stake.
TEST_P(Translucent, IsWithinBoundsOfTheExactAnswer)
{
  const Panes panes;
  const auto& [name, first, second] = this->GetParam();
  const TestError error =
    Compare(BakeReceiver(panes.Make(first, second)), WeakenAll(panes, first, second, GetExact));
  std::cout << name << ": RMS " << error.RootMeanSquare << ", maximum " << error.Maximum
            << " of the peak\n";
  EXPECT_LE(error.RootMeanSquare, 2e-3);
  EXPECT_LE(error.Maximum, 2.5e-2);
}

// The same samples give the same bits. Of 256 weights, 32 are added at a time and then 8 sums: 40
// roundings of a sum, 42 with the division and the product with the closed form, in each of the
// five bakes with coefficients that add up to less than 7. Half of an ulp of single precision is
// 6e-8 of a number: 42 x 7 x 6e-8 = 1.8e-5.
TEST_P(Translucent, IsTheWeightedSumOfBakesOfOpaqueOnes)
{
  const Panes panes(false);
  const auto& [name, first, second] = this->GetParam();
  EXPECT_LE(
    Compare(BakeReceiver(panes.Make(first, second)), WeakenAll(panes, first, second, GetBaked))
      .Maximum,
    1.8e-5);
}

INSTANTIATE_TEST_SUITE_P(Panes, Translucent, testing::ValuesIn(Cases),
  [](const testing::TestParamInfo<PanesCase>& panes) { return panes.param.Name; });

// Whatever the light: one that takes a sample alone, one of directions, one of cells that differ in
// hue.
TEST(TranslucentOccluders, WeakenAllKindsOfLight)
{
  std::vector<penumbra::PolygonLight> cells;
  for (int i = 0; i < 4; ++i)
  {
    const double x = 0.2 * i - 0.4;
    cells.push_back(penumbra::PolygonLight::Parallelogram(
      { x, 0.4, 3.0 }, { x + 0.2, 0.4, 3.0 }, { x, -0.4, 3.0 }));
    cells.back().Radiance = { 0.2 + i, 1.0, 4.0 - i };
  }
  const penumbra::Light lights[] = { penumbra::PointLight({ 0.1, 0.2, 3.0 }),
    penumbra::DirectionalLight({ 0.1, 0.2, -1.0 }, 10.0), penumbra::SurfaceLight(cells) };
  for (const penumbra::Light& light : lights)
  {
    Panes panes(false);
    panes.Scene.Lights = { light };
    EXPECT_LE(
      Compare(BakeReceiver(panes.Make(Red, Grey)), WeakenAll(panes, Red, Grey, GetBaked)).Maximum,
      1.8e-5);
  }
}

// A box is crossed twice and weakens once: behind it is what an opaque one blocks.
TEST(TranslucentOccluders, WeakenOnceEach)
{
  Panes panes(false);
  panes.First.clear();
  TestScene box;
  box.AddBox({ -0.4, -0.3, 0.3 }, { 0.3, 0.4, 0.9 });
  panes.First.swap(box.Occluders);
  EXPECT_LE(
    Compare(BakeReceiver(panes.Make(Grey, Absent)), WeakenAll(panes, Grey, Absent, GetBaked))
      .Maximum,
    1.8e-5);
}

TEST(TranslucentOccluders, ThatLetAllThroughAreAbsent)
{
  const Panes panes;
  const TestBake without = BakeReceiver(panes.WithOpaque(false, true).MakeScene());
  const TestBake with = BakeReceiver(panes.Make(Absent, Opaque));
  EXPECT_EQ(with.Texels.Irradiance, without.Texels.Irradiance);
  EXPECT_EQ(GetPair(with).Triangles, 2u);
  const TestBake neither = BakeReceiver(panes.Make(Absent, Absent));
  EXPECT_EQ(GetPair(neither).Effect, penumbra::Effect::Unoccluded);
}

TEST(TranslucentOccluders, ThatLetNothingThroughAreOpaque)
{
  const Panes panes;
  const TestBake opaque = BakeReceiver(panes.WithOpaque(true, true).MakeScene());
  const TestBake same = BakeReceiver(panes.Make(Opaque, Opaque));
  EXPECT_EQ(same.Texels.Irradiance, opaque.Texels.Irradiance);
  EXPECT_FALSE(IsWeighed(same));
}

// As transparency goes to 0, so does the difference to an opaque one: by at most what passes.
TEST(TranslucentOccluders, AreNearlyOpaqueIfLittlePasses)
{
  const Panes panes(false);
  const TestBake opaque = BakeReceiver(panes.Make(Opaque, Opaque));
  const std::vector<glm::dvec3> expected(
    opaque.Texels.Irradiance.begin(), opaque.Texels.Irradiance.end());
  const double passing = 1e-4;
  const TestBake nearly = BakeReceiver(panes.Make(glm::dvec3(passing), glm::dvec3(passing)));
  EXPECT_TRUE(IsWeighed(nearly));
  EXPECT_LE(Compare(nearly, expected).Maximum, passing + 1.8e-5);
}

// Elsewhere nothing is weighed, and no bit is another.
TEST(TranslucentOccluders, AreWeighedOnlyWhereTheyCanShade)
{
  Panes panes;
  const TestBake alone = BakeReceiver(panes.Make(Absent, Opaque));
  for (oracle::Triangle& t : panes.First)
  {
    for (oracle::Vec3* p : { &t.A, &t.B, &t.C })
    {
      p->X += 50.0;
    }
  }
  const TestBake beside = BakeReceiver(panes.Make(Grey, Opaque));
  EXPECT_FALSE(IsWeighed(beside));
  EXPECT_EQ(beside.Texels.Irradiance, alone.Texels.Irradiance);
  EXPECT_EQ(GetPair(beside).Bytes, GetPair(alone).Bytes);
  EXPECT_TRUE(IsWeighed(BakeReceiver(Panes().Make(Grey, Opaque))));
}

// A ceiling of glass hides the light from no one.
TEST(TranslucentOccluders, MakeNoUmbra)
{
  Panes panes(false);
  TestScene ceiling;
  ceiling.AddPlate({ -9, -9, 2 }, { 18, 0, 0 }, { 0, 18, 0 });
  panes.First.swap(ceiling.Occluders);
  EXPECT_EQ(GetPair(BakeReceiver(panes.Make(Opaque, Grey))).Effect, penumbra::Effect::Umbra);
  const TestBake glass = BakeReceiver(panes.Make(Grey, Opaque));
  EXPECT_EQ(GetPair(glass).Effect, penumbra::Effect::Soft);
  EXPECT_LE(Compare(glass, WeakenAll(panes, Grey, Opaque, GetBaked)).Maximum, 1.8e-5);
}

TEST(TranslucentOccluders, AreTheSameWithoutThePlanner)
{
  Panes panes;
  const TestBake planned = BakeReceiver(panes.Make(Red, Grey));
  panes.Scene.Settings.Planner = false;
  EXPECT_EQ(BakeReceiver(panes.Make(Red, Grey)).Texels.Irradiance, planned.Texels.Irradiance);
}

TEST(TranslucentOccluders, AreTheSameInBandsOfMasks)
{
  const Panes panes;
  const penumbra::ShadowScene scene = panes.Make(Red, Grey);
  const TestBake whole = BakeReceiver(scene);
  vtkNew<vtkRadianceBaker> baker;
  baker->SetMaximumMaskBytes(10000); // a row of 40 texels takes 3840
  vtkNew<vtkRadianceTexture> texture;
  baker->Bake(scene, { 0 }, GetTestWindow(), texture);
  EXPECT_EQ(texture->Download(texture->GetRegions().front()).Irradiance, whole.Texels.Irradiance);
  texture->ReleaseGraphicsResources();
}

// More surfaces than masks of so many samples have room for: then fewer samples are taken, and
// said.
TEST(TranslucentOccluders, ShareTheRoomForSamples)
{
  constexpr int Count = 40;
  const double transmittance = 0.99;
  Panes panes;
  panes.Scene.Texels = { 8, 8 };
  panes.Scene.Settings.HardPenumbra = 0.0;
  panes.Scene.Settings.LightSamples = 4096;
  penumbra::ShadowScene scene = panes.Make(glm::dvec3(transmittance), Opaque);
  const penumbra::SharedSurface pane = scene.Surfaces[1];
  scene.Surfaces.insert(scene.Surfaces.end(), Count - 1, pane);
  const int room = vtkVisibilityMask::GetMaximumSamples(GetTestWindow(), 1 + Count);
  ASSERT_LT(room, 4096);
  const TestBake bake = BakeReceiver(scene);
  EXPECT_TRUE(bake.Reports.front().IsComplete);
  EXPECT_EQ(GetPair(bake).LightSamples, room);
  const glm::dvec3 passing(std::pow(transmittance, Count));
  EXPECT_LE(Compare(bake, WeakenAll(panes, passing, Opaque, GetExact)).RootMeanSquare, 2e-3);
}

// A tolerance is met with weights as with counts.
TEST(TranslucentOccluders, MeetAnErrorTolerance)
{
  Panes panes;
  panes.Scene.Settings.ErrorTolerance = 1e-3;
  const TestBake bake = BakeReceiver(panes.Make(Red, Grey));
  EXPECT_EQ(bake.Reports.front().StoppedBy, "ErrorTolerance");
  EXPECT_LE(Compare(bake, WeakenAll(panes, Red, Grey, GetExact)).RootMeanSquare, 1e-3);
}

// With a tolerance that cannot be met, samples come in batches until there are as many as are
// allowed. The sums go on where a texel is weakened, so the answer is that of all samples at once.
// Numbers that are no multiples of 32 end a batch within a layer of masks.
TEST(TranslucentOccluders, AreTheSameInBatchesOfSamples)
{
  for (const int samples : { 130, 333, 1024 })
  {
    Panes once, inBatches;
    once.Scene.Settings.LightSamples = samples;
    inBatches.Scene.Settings.ErrorTolerance = 1e-9;
    inBatches.Scene.Settings.MaximumLightSamples = samples;
    for (const auto& [first, second] : { std::make_pair(Red, Grey), std::make_pair(Grey, Opaque) })
    {
      const TestBake expected = BakeReceiver(once.Make(first, second));
      const TestBake bake = BakeReceiver(inBatches.Make(first, second));
      EXPECT_EQ(GetPair(bake).LightSamples, samples);
      EXPECT_EQ(bake.Reports.front().StoppedBy, "MaximumLightSamples");
      EXPECT_EQ(bake.Texels.Irradiance, expected.Texels.Irradiance) << samples << " samples";
      EXPECT_EQ(bake.Texels.Variance, expected.Texels.Variance) << samples << " samples";
    }
  }
}

// (1 - o) (1 - o + o h): continuous from absent to opaque.
TEST(Transmittance, IsOfOpacityAndHue)
{
  EXPECT_EQ(penumbra::GetTransmittance(0.0, Red), Absent);
  EXPECT_EQ(penumbra::GetTransmittance(1.0, Red), Opaque);
  EXPECT_EQ(penumbra::GetTransmittance(0.5, { 0.2, 0.2, 0.2 }), Grey);
  EXPECT_EQ(penumbra::GetTransmittance(0.5, Opaque), Grey);
  EXPECT_EQ(penumbra::GetTransmittance(0.5, { 2.0, 1.0, 0.0 }), glm::dvec3(0.5, 0.375, 0.25));
}

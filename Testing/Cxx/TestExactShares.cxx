// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Where few triangles decide, many samples are not counted: shares within penumbras are found from
// the triangles, and what is baked is exact.

#include "DiskLight.h"
#include "LargestDeviation.h"
#include "OracleScene.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace
{

/// More than enough for all of these scenes: eight for each triangle, and no fewer than 512.
constexpr int ManySamples = 1024;

TestScene MakeBoxScene()
{
  TestScene scene;
  scene.Name = "Box";
  scene.Settings.Side = penumbra::ReceiverSide::Front;
  scene.Settings.LightSamples = ManySamples;
  scene.AddLight({ -0.5, 0.5, 2.0 }, { 0.5, 0.5, 2.0 }, { -0.5, -0.5, 2.0 });
  scene.AddBox({ -0.5, -0.3, 0.0 }, { 0.2, 0.4, 0.6 });
  return scene;
}

std::size_t CountExactTexels(const TestScene& scene)
{
  return ::CountExactTexels(BakeReceiver(scene.MakeScene()));
}

} // namespace

// But for the rounding of single precision, which is what the unoccluded light has, too.
TEST(ExactShares, AreExact)
{
  for (TestScene scene : GetOccludedScenes())
  {
    scene.Settings.LightSamples = ManySamples;
    const TestError error = CompareWithOracle(scene);
    std::cout << scene.Name << ": RMS " << error.RootMeanSquare << ", maximum " << error.Maximum
              << " of the peak\n";
    EXPECT_LE(error.Maximum, 1e-5) << scene.Name;
    EXPECT_GT(CountExactTexels(scene), 0u) << scene.Name;
  }
}

// Random scenes, with lights of all kinds: those whose lights all have exact shares, or no samples.
// A gap between occluders may be seen from one texel alone, and all samples miss it: that is less
// than one sample stands for, and rare.
TEST(ExactShares, AreExactInRandomScenes)
{
  constexpr unsigned Scenes = 60;
  const glm::ivec2 texels(16, 16);
  LargestDeviation largest;
  int compared = 0, missed = 0;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    const oracle::RandomScene random = oracle::MakeRandomScene(seed);
    penumbra::ReceiverSettings settings;
    settings.LightSamples = ManySamples;
    settings.PlannerTolerance = settings.HardPenumbra = 0.0;
    const penumbra::ShadowScene scene = MakeShadowScene(random, settings, texels);
    const TestBake bake = BakeReceiver(scene);
    const bool isExact =
      std::all_of(bake.Reports.front().Pairs.begin(), bake.Reports.front().Pairs.end(),
        [](const vtkRadianceBaker::PairReport& pair)
        { return pair.LightSamples == 0 || pair.ExactTexels > 0; });
    if (!isExact || CountExactTexels(bake) == 0)
    {
      continue;
    }
    ++compared;
    const penumbra::ReceiverSettings& used = scene.Receivers.front().Settings;
    const std::vector<glm::dvec3> exact = GetExactRadiance(random, texels);
    double peak = 0.0;
    glm::dvec3 error(0.0);
    for (std::size_t i = 0; i < exact.size(); ++i)
    {
      const glm::dvec3 baked =
        used.Reflectance * (used.AmbientRadiance + glm::dvec3(bake.Texels.Irradiance.at(i)));
      error = glm::max(error, glm::abs(baked - exact[i]));
      peak = std::max({ peak, exact[i].x, exact[i].y, exact[i].z });
    }
    const double deviation = largest.Add(std::max({ error.x, error.y, error.z }), peak);
    EXPECT_LE(deviation, 1.0 / ManySamples) << "seed " << seed;
    missed += deviation > 1e-5 ? 1 : 0;
  }
  EXPECT_GE(compared, 10);
  EXPECT_LE(missed, 1);
  std::cout << compared << " of " << Scenes << " scenes have exact shares alone\n";
}

TEST(ExactShares, HaveNoError)
{
  const TestBake bake = BakeReceiver(MakeBoxScene().MakeScene());
  EXPECT_EQ(*std::max_element(bake.Texels.Variance.begin(), bake.Texels.Variance.end()), 0.0f);
}

// The finer texels of a supersampled bake are those of a bake of so many.
TEST(ExactShares, AreOfSupersampledTexels)
{
  TestScene fine = MakeBoxScene();
  fine.Texels *= 2;
  const std::vector<glm::vec4> texels = BakeReceiver(fine.MakeScene()).Texels.Irradiance;
  TestScene scene = MakeBoxScene();
  scene.Settings.Supersampling = 2;
  const TestBake bake = BakeReceiver(scene.MakeScene());
  EXPECT_GT(CountExactTexels(bake), 0u);
  const auto at = [&](int i, int j)
  {
    const glm::ivec2 t = glm::clamp(glm::ivec2(i, j), glm::ivec2(0), fine.Texels - 1);
    return glm::dvec3(texels[static_cast<std::size_t>(t.y * fine.Texels.x + t.x)]);
  };
  double largest = 0.0;
  for (int j = 1; j + 1 < scene.Texels.y; ++j)
  {
    for (int i = 1; i + 1 < scene.Texels.x; ++i)
    {
      // A tent that reaches the neighbours' centres: of 4 x 4 finer texels.
      constexpr double Weights[] = { 0.125, 0.375, 0.375, 0.125 };
      glm::dvec3 sum(0.0);
      for (int k = 0; k < 16; ++k)
      {
        sum += Weights[k % 4] * Weights[k / 4] * at(2 * i - 1 + k % 4, 2 * j - 1 + k / 4);
      }
      const glm::vec4& baked =
        bake.Texels.Irradiance[static_cast<std::size_t>(j * scene.Texels.x + i)];
      largest = std::max(largest, glm::length(glm::dvec3(baked) - sum) / glm::length(at(0, 0)));
    }
  }
  EXPECT_LE(largest, 1e-5);
}

// Who asks for few samples asks for speed.
TEST(ExactShares, AreOfManySamplesAlone)
{
  TestScene scene = MakeBoxScene();
  EXPECT_GT(CountExactTexels(scene), 0u);
  scene.Settings.LightSamples = 511;
  EXPECT_EQ(CountExactTexels(scene), 0u);
  scene.Settings.LightSamples = ManySamples;
  scene.Settings.ExactShares = false;
  EXPECT_EQ(CountExactTexels(scene), 0u);
  scene.Settings.ExactShares = true;
  scene.Settings.Reconstruction = false;
  EXPECT_EQ(CountExactTexels(scene), 0u);
}

TEST(ExactShares, AreOfFewTrianglesAlone)
{
  TestScene scene = MakeBoxScene();
  for (int i = 0; i < 129; ++i)
  {
    scene.AddPlate({ -1.0 + 0.01 * i, 0.5, 0.5 }, { 0.005, 0.0, 0.0 }, { 0.0, 0.2, 0.1 });
  }
  EXPECT_EQ(CountExactTexels(scene), 0u);
  scene.Settings.LightSamples = 4096;
  EXPECT_GT(CountExactTexels(scene), 0u);
}

TEST(ExactShares, AreOfPolygonsAlone)
{
  TestScene scene = MakeBoxScene();
  scene.Lights = { penumbra::DiskLight({ 0, 0, 2 }, { 0, 0, -1 }, 0.5) };
  EXPECT_EQ(CountExactTexels(scene), 0u);
}

TEST(ExactShares, AreNotOfTranslucentOccluders)
{
  penumbra::ShadowScene scene = MakeBoxScene().MakeScene();
  penumbra::Surface box = *scene.Surfaces[1];
  box.Transmittance = glm::dvec3(0.5);
  scene.Surfaces[1] = penumbra::SharedSurface(box);
  EXPECT_EQ(CountExactTexels(BakeReceiver(scene)), 0u);
}

// A box whose walls stand right on texels' centres: these are under it or beside it, as samples
// say.
TEST(ExactShares, FollowSamplesWhereTexelsTouchOccluders)
{
  TestScene scene = MakeBoxScene();
  scene.Texels = glm::ivec2(40); // centres at odd multiples of 0.05
  scene.Occluders.clear();
  scene.AddBox({ -0.55, -0.35, 0.0 }, { 0.25, 0.45, 0.6 });
  const TestBake exact = BakeReceiver(scene.MakeScene());
  scene.Settings.Reconstruction = false;
  const TestBake counted = BakeReceiver(scene.MakeScene());
  EXPECT_GT(CountExactTexels(exact), 0u);
  float largest = 0.0f, peak = 0.0f;
  for (std::size_t i = 0; i < counted.Texels.Irradiance.size(); ++i)
  {
    const glm::vec4 &a = exact.Texels.Irradiance[i], &b = counted.Texels.Irradiance[i];
    largest = std::max(largest, std::abs(a.r - b.r));
    peak = std::max(peak, b.r);
  }
  EXPECT_LE(largest, 0.02f * peak); // 1024 samples miss 1e-2 at an edge, of which a corner has two
}

// Lights that arrive nowhere have none, whatever others have.
TEST(ExactShares, AreCountedForEachLight)
{
  TestScene scene = MakeBoxScene();
  scene.AddLight({ -0.5, 0.5, -2.0 }, { 0.5, 0.5, -2.0 }, { -0.5, -0.5, -2.0 });
  const TestBake bake = BakeReceiver(scene.MakeScene());
  EXPECT_GT(bake.Reports.front().Pairs[0].ExactTexels, 0u);
  EXPECT_EQ(bake.Reports.front().Pairs[1].ExactTexels, 0u);
}

// With an accuracy that no number of samples reaches, they are taken up to where shares are exact.
TEST(ExactShares, EndErrorTolerance)
{
  TestScene scene = MakeBoxScene();
  scene.Settings.ErrorTolerance = 1e-7;
  scene.Settings.MaximumLightSamples = 4096;
  const TestBake bake = BakeReceiver(scene.MakeScene());
  EXPECT_EQ(bake.Reports.front().StoppedBy, "ErrorTolerance");
  EXPECT_EQ(bake.Reports.front().Pairs.front().LightSamples, 512);
  EXPECT_GT(CountExactTexels(bake), 0u);
  EXPECT_LE(CountExactTexels(bake), bake.Texels.Irradiance.size());
  EXPECT_LE(CompareWithOracle(scene).Maximum, 1e-5);
}

// A sliver that all samples miss is found next to what they see.
TEST(ExactShares, AreFoundWhereSamplesSeeAllOfTheLight)
{
  TestScene scene = MakeBoxScene();
  scene.Settings.Reconstruction = false;
  const TestBake counted = BakeReceiver(scene.MakeScene());
  const auto isPartial = [](const glm::vec4& texel) { return texel.r > 0.0f && texel.a > 0.0f; };
  const auto partial = static_cast<std::size_t>(
    std::count_if(counted.Texels.Irradiance.begin(), counted.Texels.Irradiance.end(), isPartial));
  scene.Settings.Reconstruction = true;
  EXPECT_GT(CountExactTexels(scene), partial);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What is baked, against the exact answer: clipping in long double that shares no code with the
// product.

#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace
{

void Report(const std::string& name, int samples, const TestError& error)
{
  std::cout << name << ", n = " << samples << ": RMS " << error.RootMeanSquare << ", maximum "
            << error.Maximum << " of the peak\n";
}

/// Lights over the receiver, beside it, facing it from the side, cut by its plane, and tilted so
/// that part of the receiver is behind them; parallelograms and triangles, one- and two-sided.
std::vector<TestScene> GetUnoccludedScenes()
{
  struct Placement
  {
    const char* Name;
    glm::dvec3 Origin, Point1, Point2;
  };
  const std::vector<Placement> placements{
    { "Over", { -0.5, 0.5, 1.5 }, { 0.5, 0.5, 1.5 }, { -0.5, -0.5, 1.5 } },
    { "OverAndTilted", { -1.0, 0.5, 1.0 }, { 0.5, 0.6, 2.0 }, { -1.0, -0.5, 1.2 } },
    { "Beside", { 4.0, 1.0, 0.5 }, { 4.0, -1.0, 0.5 }, { 4.0, 1.0, 2.0 } },
    { "CutByThePlane", { 3.0, 1.0, -1.0 }, { 3.0, -1.0, -0.5 }, { 3.0, 1.0, 2.0 } },
    { "ReceiverPartlyBehind", { 0.0, 1.0, 0.5 }, { 0.2, -1.0, 0.5 }, { 0.0, 1.0, 1.5 } },
    { "FarAndSmall", { 40.0, -30.0, 60.0 }, { 40.3, -30.0, 60.0 }, { 40.0, -30.4, 60.1 } },
    { "CloseAndWide", { -8.0, 8.0, 0.1 }, { 8.0, 8.0, 0.1 }, { -8.0, -8.0, 0.1 } },
  };
  std::vector<TestScene> scenes;
  for (const Placement& p : placements)
  {
    for (const bool isTriangle : { false, true })
    {
      for (const bool twoSided : { false, true })
      {
        TestScene scene;
        scene.Name = std::string(p.Name) + (isTriangle ? "Triangle" : "Parallelogram") +
          (twoSided ? "TwoSided" : "");
        scene.Settings.Side = penumbra::ReceiverSide::Front;
        scene.Lights.push_back(isTriangle
            ? penumbra::PolygonLight::Triangle(p.Origin, p.Point1, p.Point2)
            : penumbra::PolygonLight::Parallelogram(p.Origin, p.Point1, p.Point2));
        scene.Lights.back()->TwoSided = twoSided;
        scenes.push_back(scene);
      }
    }
  }
  return scenes;
}

std::string GetName(const testing::TestParamInfo<TestScene>& info)
{
  return info.param.Name;
}

} // namespace

void PrintTo(const TestScene& scene, std::ostream* os)
{
  *os << scene.Name;
}

class Unoccluded : public testing::TestWithParam<TestScene>
{
};

TEST_P(Unoccluded, EqualsLambertsFormula)
{
  const TestError error = CompareWithOracle(this->GetParam());
  Report(this->GetParam().Name, 0, error);
  EXPECT_LE(error.Maximum, 1e-5);
}

TEST_P(Unoccluded, TakesNoSamples)
{
  for (const vtkRadianceBaker::Report& report : BakeReceiver(this->GetParam().MakeScene()).Reports)
  {
    EXPECT_EQ(report.Pairs.front().LightSamples, 0);
    EXPECT_EQ(report.Pairs.front().Effect, penumbra::Effect::Unoccluded);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, Unoccluded, testing::ValuesIn(GetUnoccludedScenes()), GetName);

class Occluded : public testing::TestWithParam<TestScene>
{
protected:
  TestError Measure(int samples) const
  {
    TestScene scene = this->GetParam();
    scene.Settings.LightSamples = samples;
    const TestError error = CompareWithOracle(scene);
    Report(scene.Name, samples, error);
    return error;
  }
};

// The bounds are the issue's.
TEST_P(Occluded, IsWithinBoundsAt256Samples)
{
  const TestError error = this->Measure(256);
  EXPECT_LE(error.RootMeanSquare, 2e-3);
  EXPECT_LE(error.Maximum, 2.5e-2);
}

TEST_P(Occluded, IsWithinBoundsAt1024Samples)
{
  EXPECT_LE(this->Measure(1024).RootMeanSquare, 7e-4);
}

// On texels so small that neighbours have something to say: across creases, too, filters bring
// shares nearer to the truth than counts alone.
TEST_P(Occluded, IsNearerWithReconstruction)
{
  TestScene scene = this->GetParam();
  scene.Texels = glm::ivec2(80, 80);
  scene.Settings.LightSamples = 256;
  const TestError filtered = CompareWithOracle(scene);
  scene.Settings.Reconstruction = false;
  const TestError counted = CompareWithOracle(scene);
  Report(scene.Name, scene.Settings.LightSamples, filtered);
  Report(scene.Name + " without reconstruction", scene.Settings.LightSamples, counted);
  EXPECT_LT(filtered.RootMeanSquare, counted.RootMeanSquare);
}

// Without the occluders, the same scenes are far out: the bounds above would notice.
TEST_P(Occluded, IsFarFromUnoccluded)
{
  TestScene scene = this->GetParam();
  const TestBake shadowed = BakeReceiver(scene.MakeScene());
  scene.Occluders.clear();
  const TestBake lit = BakeReceiver(scene.MakeScene());
  double squares = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < lit.Texels.Irradiance.size(); ++i)
  {
    const double difference =
      lit.Texels.Irradiance[i].r - static_cast<double>(shadowed.Texels.Irradiance[i].r);
    squares += difference * difference;
    peak = std::max(peak, static_cast<double>(lit.Texels.Irradiance[i].r));
  }
  EXPECT_GT(std::sqrt(squares / static_cast<double>(lit.Texels.Irradiance.size())) / peak, 0.05);
}

// The estimate is one difference of two halves per texel: over many texels its mean square must be
// that of the true error to within the factor that a few effective degrees of freedom allow.
TEST_P(Occluded, EstimatesItsError)
{
  TestScene scene = this->GetParam();
  scene.Settings.LightSamples = 256;
  const TestBake bake = BakeReceiver(scene.MakeScene());
  double estimated = 0.0, actual = 0.0;
  for (int j = 0; j < scene.Texels.y; ++j)
  {
    for (int i = 0; i < scene.Texels.x; ++i)
    {
      const auto texel = static_cast<std::size_t>(j * scene.Texels.x + i);
      const glm::dvec3 exact = scene.GetExact(i, j);
      const glm::dvec3 error = glm::dvec3(bake.Texels.Irradiance[texel]) - exact;
      const double mean = (error.x + error.y + error.z) / 3.0;
      actual += mean * mean;
      estimated += bake.Texels.Variance[texel];
    }
  }
  const double ratio = std::sqrt(estimated / actual);
  std::cout << scene.Name << ": estimated over true RMS error " << ratio << "\n";
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 4.0); // halves are worse than half as good: the estimate is on the safe side
}

INSTANTIATE_TEST_SUITE_P(Scenes, Occluded, testing::ValuesIn(GetOccludedScenes()), GetName);

// An occluder that covers the light everywhere leaves nothing, to the bit.
TEST(Umbra, IsExactlyDark)
{
  TestScene scene;
  scene.AddLight({ -0.5, 0.5, 2.0 }, { 0.5, 0.5, 2.0 }, { -0.5, -0.5, 2.0 });
  scene.AddPlate({ -50, -50, 1.0 }, { 100, 0, 0 }, { 0, 100, 0 });
  for (const glm::vec4& texel : BakeReceiver(scene.MakeScene()).Texels.Irradiance)
  {
    ASSERT_EQ(glm::vec3(texel), glm::vec3(0.0f));
    ASSERT_GT(texel.a, 0.0f);
  }
}

// Sums over lights, and masks, do not depend on the order of what they come from.
TEST(Order, DoesNotChangeABit)
{
  const TestScene scene = GetOccludedScenes().back();
  TestScene reversed = scene;
  std::reverse(reversed.Lights.begin(), reversed.Lights.end());
  std::reverse(reversed.Occluders.begin(), reversed.Occluders.end());
  const TestBake a = BakeReceiver(scene.MakeScene());
  const TestBake b = BakeReceiver(reversed.MakeScene());
  EXPECT_EQ(a.Texels.Irradiance, b.Texels.Irradiance);
  EXPECT_EQ(a.Texels.Variance, b.Texels.Variance);
}

// A texel filtered from finer ones lies between the least and the greatest of those that the tent
// reaches.
TEST(Supersampling, FiltersFinerTexels)
{
  TestScene fine = GetOccludedScenes().front();
  fine.Settings.LightSamples = 1; // hard shadows
  TestScene coarse = fine;
  coarse.Texels = { 20, 20 };
  coarse.Settings.Supersampling = 2;
  const auto fineTexels = BakeReceiver(fine.MakeScene()).Texels.Irradiance;
  const auto coarseTexels = BakeReceiver(coarse.MakeScene()).Texels.Irradiance;
  int between = 0;
  for (int j = 0; j < 20; ++j)
  {
    for (int i = 0; i < 20; ++i)
    {
      float low = 1e30f, high = 0.0f;
      for (int y = std::max(0, 2 * j - 1); y <= std::min(39, 2 * j + 2); ++y)
      {
        for (int x = std::max(0, 2 * i - 1); x <= std::min(39, 2 * i + 2); ++x)
        {
          const float value = fineTexels[static_cast<std::size_t>(40 * y + x)].r;
          low = std::min(low, value);
          high = std::max(high, value);
        }
      }
      const float value = coarseTexels[static_cast<std::size_t>(20 * j + i)].r;
      // 16 weighted values round by at most 16 units in the last place.
      EXPECT_GE(value, low * (1.0f - 2e-6f));
      EXPECT_LE(value, high * (1.0f + 2e-6f));
      between += value > 1.2f * low && value < 0.8f * high ? 1 : 0;
    }
  }
  // The edge of the shadow is smooth. The first texel beyond one that is wholly dark shares with it
  // the half of its fine texels that weighs 1/8 + 3/8, so it is at most half lit, and it is not
  // dark: one such at each end of a row. From the light, 2.9 to 3.1 high, the top of the box, 0.7
  // wide and 0.9 high, covers 0.7 * 3.1 / (3.1 - 0.9) or more: at least 9 fine texels of 0.1 each
  // way. 3 rows reach over 4 of those each.
  EXPECT_GE(between, 2 * 3);
}

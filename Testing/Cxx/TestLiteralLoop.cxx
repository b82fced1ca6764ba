// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Visibility masks against the loop of H&H 1997, section 3.5, texel by texel.

#include "LiteralLoop.h"
#include "SamplingPattern.h"
#include "TestScenes.h"

#include "vtkOpenGLRenderWindow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace
{

/// Of the peak. Both sum in single precision: the loop, one sample after the other, is off by some
/// n^(1/2) roundings (2e-6 at n = 1021), the masks and their closed form by less.
constexpr double Tolerance = 1e-5;

/// How close, in texels, an occluder's edge must pass to a texel's centre for the two routes to
/// disagree on it. Their matrices round differently, so that a vertex which falls between two steps
/// of the rasteriser's grid of 1/256 texel may be put on either. Each route's edge is then within
/// sqrt(2) / 512 of the true one; what is left to 1/256 is for single precision: 1e-3 texel.
constexpr double EdgeTolerance = 1.0 / 256;

/// The share of the texels at which that may happen. A vertex is torn if its rounding error, some
/// 1e-5 texel, spans a border of the grid: 1 in 400, and vertices that clipping makes are. Of the
/// texels along its edges, 1 in 500 has its centre in between. So some 1e-5 of the penumbra's
/// texels differ for each sample and edge: at a thousand samples, a few in a thousand.
constexpr double TossUpShare = 4e-3;

/// The root mean square error of n = 1024 Sobol points, of the peak: the bound that issue 2 sets.
constexpr double ConvergedError = 7e-4;

/// Every kind of receiver and light, with enough texels for penumbrae of many.
std::vector<TestScene> GetScenes()
{
  std::vector<TestScene> scenes = GetOccludedScenes();

  TestScene triangle = scenes.front();
  triangle.Name = "TriangleLight";
  triangle.Lights = { penumbra::PolygonLight::Triangle(
    { -0.5, 0.8, 2.7 }, { 0.9, 0.4, 3.0 }, { -0.2, -0.7, 2.9 }) };
  triangle.Lights[0]->Radiance = { 0.3, 2.0, 1.0 };
  scenes.push_back(triangle);

  // The receiver is lit from behind, and its plane cuts the light.
  TestScene cut = scenes.front();
  cut.Name = "BackLitAndCut";
  std::swap(cut.Base.EdgeX, cut.Base.EdgeY);
  cut.Settings.Side = penumbra::ReceiverSide::Back;
  cut.Lights.clear();
  cut.AddLight({ 3.0, -0.7, -0.5 }, { 3.1, 0.8, -0.4 }, { 2.6, -0.6, 2.0 });
  cut.Lights[0]->TwoSided = true;
  scenes.push_back(cut);

  for (TestScene& scene : scenes)
  {
    scene.Texels = { 64, 56 };
    scene.Settings.Reconstruction = false; // the loop has none
  }
  return scenes;
}

/// The weight of a sample at a point of the receiver, up to a factor: H&H 1997, eq. 1.
double GetWeight(const glm::dvec3& sample, const penumbra::PolygonLight& light, const glm::dvec3& x,
  const glm::dvec3& normal)
{
  const glm::dvec3 d = sample - x;
  const double r2 = glm::dot(d, d);
  return glm::dot(normal, d) * std::abs(glm::dot(light.GetNormal(), d)) / (r2 * r2);
}

/// How far the projection of an edge from a sample onto the receiver, all in the receiver's frame,
/// passes from a point of it, in texels.
double GetDistance(glm::dvec3 a, glm::dvec3 b, const glm::dvec3& sample, const glm::dvec2& point,
  const glm::dvec2& texels)
{
  // Only what is between the receiver and just under the sample has a projection.
  const double highest = sample.z * (1.0 - 1e-6);
  if (a.z > b.z)
  {
    std::swap(a, b);
  }
  if (b.z <= 0.0 || a.z >= highest)
  {
    return HUGE_VAL;
  }
  const glm::dvec3 edge = b - a;
  const glm::dvec3 low = a.z < 0.0 ? a - edge * (a.z / edge.z) : a;
  const glm::dvec3 high = b.z > highest ? a + edge * ((highest - a.z) / edge.z) : b;
  const auto project = [&](const glm::dvec3& p) {
    return texels * (glm::dvec2(sample) + glm::dvec2(p - sample) * (sample.z / (sample.z - p.z)));
  };
  const glm::dvec2 start = project(low);
  const glm::dvec2 along = project(high) - start;
  const glm::dvec2 offset = texels * point - start;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(offset, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(offset - t * along);
}

bool IsTossUp(const penumbra::Surface& occluders, const penumbra::ReceiverFrame& frame,
  const glm::dvec3& sample, const glm::dvec2& point, const glm::dvec2& texels)
{
  const auto isClose = [&](std::uint32_t a, std::uint32_t b)
  {
    return GetDistance(frame.ToFrame(occluders.Points[a]), frame.ToFrame(occluders.Points[b]),
             frame.ToFrame(sample), point, texels) <= EdgeTolerance;
  };
  return std::any_of(occluders.Triangles.begin(), occluders.Triangles.end(),
    [&](const penumbra::Surface::Triangle& t)
    { return isClose(t[0], t[1]) || isClose(t[1], t[2]) || isClose(t[2], t[0]); });
}

/// The most that the irradiance over pi of a texel can change with the samples that are a toss-up
/// there.
glm::dvec3 GetTossUp(const penumbra::ShadowScene& scene, int i, int j)
{
  const penumbra::Receiver& receiver = scene.Receivers.front();
  const penumbra::ReceiverFrame frame = scene.MakeFrame(receiver);
  const glm::dvec2 texels(receiver.Texels);
  const glm::dvec2 point = glm::dvec2(i + 0.5, j + 0.5) / texels;
  const glm::dvec3 x = frame.ToWorld({ point, 0.0 });
  const auto pattern =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(receiver.Settings.SamplingPattern)];
  glm::dvec3 change(0.0);
  for (const penumbra::Light& anyLight : scene.Lights)
  {
    const auto& light = dynamic_cast<const penumbra::PolygonLight&>(*anyLight);
    const penumbra::PolygonLight seen = light.ClippedToFront(x, frame.GetNormal());
    double doubtful = 0.0, all = 0.0;
    for (const glm::dvec2& s : pattern.Generate(receiver.Settings.GetSampleCount(),
           static_cast<std::uint32_t>(receiver.Settings.Seed), seen.GetAspect()))
    {
      const glm::dvec3 sample = seen.Sample(s);
      const double weight = GetWeight(sample, seen, x, frame.GetNormal());
      all += weight;
      doubtful += IsTossUp(*scene.Surfaces[1], frame, sample, point, texels) ? weight : 0.0;
    }
    change += light.Radiance * (light.FormFactor(x, frame.GetNormal()) * doubtful / all);
  }
  return change;
}

double GetLargest(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

/// Whether what was baked is the reference at every texel.
void ExpectEqual(const penumbra::ShadowScene& scene, const std::vector<glm::vec4>& baked,
  const std::vector<glm::dvec3>& reference)
{
  ASSERT_EQ(baked.size(), reference.size());
  double peak = 0.0;
  for (const glm::dvec3& value : reference)
  {
    peak = std::max(peak, GetLargest(value));
  }
  ASSERT_GT(peak, 0.0);
  const int width = scene.Receivers.front().Texels.x;
  int tossUps = 0;
  for (std::size_t t = 0; t < baked.size(); ++t)
  {
    const glm::dvec3 difference = glm::abs(glm::dvec3(baked[t]) - reference[t]);
    if (!(GetLargest(difference) <= Tolerance * peak))
    {
      ++tossUps;
      const int i = static_cast<int>(t) % width;
      const int j = static_cast<int>(t) / width;
      const glm::dvec3 allowed = GetTossUp(scene, i, j) + Tolerance * peak;
      EXPECT_TRUE(glm::all(glm::lessThanEqual(difference, allowed)))
        << "texel (" << i << ", " << j << "): off by " << GetLargest(difference) / peak
        << " of the peak; samples on an edge explain " << GetLargest(allowed) / peak;
    }
  }
  EXPECT_LE(tossUps, TossUpShare * static_cast<double>(baked.size()));
}

/// Of a scene and a pattern.
using Choice = std::tuple<std::size_t, std::size_t>;

std::string GetName(const testing::TestParamInfo<Choice>& info)
{
  std::string name = GetScenes()[std::get<0>(info.param)].Name +
    penumbra::GetSamplingPatterns()[std::get<1>(info.param)].Name;
  name.erase(std::remove_if(name.begin(), name.end(),
               [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }),
    name.end());
  return name;
}

} // namespace

class LiteralLoopTest : public testing::TestWithParam<Choice>
{
};

TEST_P(LiteralLoopTest, EqualsMasks)
{
  TestScene description = GetScenes()[std::get<0>(this->GetParam())];
  description.Settings.SamplingPattern = static_cast<int>(std::get<1>(this->GetParam()));
  // A single sample, half a mask, two masks, many, and a number that fills neither masks nor grids.
  for (const int samples : { 1, 16, 64, 256, 1021 })
  {
    SCOPED_TRACE("n = " + std::to_string(samples));
    description.Settings.LightSamples = samples;
    const penumbra::ShadowScene scene = description.MakeScene();
    const TestBake bake = BakeReceiver(scene);
    LiteralLoop loop;
    ASSERT_TRUE(loop.Bake(scene, 0, GetTestWindow(), LiteralLoop::Estimator::Ratio));
    ExpectEqual(scene, bake.Texels.Irradiance, loop.GetIrradiance());

    // There are shadows to be compared; a single sample may throw its own beside the receiver.
    const std::vector<float> shares = loop.GetVisibleShares(0);
    EXPECT_GT(*std::max_element(shares.begin(), shares.end()), 0.999f);
    EXPECT_TRUE(samples == 1 || *std::min_element(shares.begin(), shares.end()) < 0.5f);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, LiteralLoopTest,
  testing::Combine(testing::Range(std::size_t{ 0 }, GetScenes().size()),
    testing::Range(std::size_t{ 0 }, penumbra::GetSamplingPatterns().size())),
  GetName);

/// The reference itself is right: with many samples, either estimator nears the exact answer.
class LiteralLoopEstimator : public testing::TestWithParam<LiteralLoop::Estimator>
{
};

TEST_P(LiteralLoopEstimator, NearsTheExactAnswer)
{
  for (TestScene& description : GetScenes())
  {
    SCOPED_TRACE(description.Name);
    if (description.Settings.Side == penumbra::ReceiverSide::Back)
    {
      continue; // TestScene asks the oracle for the front
    }
    description.Texels = { 24, 20 };
    description.Settings.LightSamples = 1024;
    LiteralLoop loop;
    ASSERT_TRUE(loop.Bake(description.MakeScene(), 0, GetTestWindow(), this->GetParam()));
    const std::vector<glm::dvec3> irradiance = loop.GetIrradiance();
    double peak = 0.0, squares = 0.0;
    for (std::size_t t = 0; t < irradiance.size(); ++t)
    {
      const int i = static_cast<int>(t) % description.Texels.x;
      const int j = static_cast<int>(t) / description.Texels.x;
      const glm::dvec3 exact = description.GetExact(i, j);
      const glm::dvec3 error = irradiance[t] - exact;
      peak = std::max(peak, GetLargest(exact));
      squares += glm::dot(error, error);
    }
    const double count = 3.0 * static_cast<double>(irradiance.size());
    EXPECT_LE(std::sqrt(squares / count), ConvergedError * peak);
  }
}

INSTANTIATE_TEST_SUITE_P(PlainSumAndRatio, LiteralLoopEstimator,
  testing::Values(LiteralLoop::Estimator::PlainSum, LiteralLoop::Estimator::Ratio));

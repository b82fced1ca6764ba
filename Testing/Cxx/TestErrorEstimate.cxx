// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The error estimate is calibrated: over random scenes with exact answers it is about the true
// error, and an accuracy that is asked for is kept.
//
// Why it is on the safe side. The halves of a scrambled net of n points are nets themselves. Where
// the error of a net falls as n^-3/4 (Owen 1997, for what an edge cuts), and those of the halves
// are independent, half their difference is expected to be 1/2 sqrt(2) (n/2)^-3/4, which is 2^1/4
// times n^-3/4: the true error is 0.84 of the estimate. Halves of one net do better together than
// independent ones would, and shares that are filtered across texels have errors that are less
// alike than their halves'. Measured over these scenes: 0.78 in the middle by 64 samples and 0.89
// by 1024, and 0.57 to 1.2 for nine in ten of them. That is without ExactShares, which by 512
// samples begin to leave nothing to be estimated in some of these scenes.
//
// Other patterns, measured in the same way: by 64 and by 1024 samples, the estimate is within the
// bounds for 88 % and 95 % of the scenes by correlated multi-jittered samples, 95 % and 98 % by the
// jittered grid, 62 % and 57 % by the uniform grid, whose error is no chance and repeats in its
// halves, and 82 % by random samples, which are the same for all texels: their halves agree or not
// by chance, and all texels with them.
//
// Where it cannot be right. A point and a sun of no size have hard shadows, which no sample betrays
// if the texel's centre is on the wrong side of an edge. OpenGL rounds an occluder's corners on the
// receiver to 1/256 of a texel, so a few texels of an outline are on the wrong side; of 200 scenes
// that decides the error in two.

#include "OracleScene.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace
{

constexpr int Scenes = 200;
const glm::ivec2 Texels(48, 48);

double GetMean(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

/// Root mean squares over a receiver, of the mean of radiance's components, as shares of its peak.
struct Errors
{
  double Actual = 0.0, Estimated = 0.0;
  vtkRadianceBaker::Report Report;

  double GetRatio() const { return this->Actual / this->Estimated; }
  int GetSamples() const
  {
    int most = 0;
    for (const vtkRadianceBaker::PairReport& pair : this->Report.Pairs)
    {
      most = std::max(most, pair.LightSamples);
    }
    return most;
  }
};

/// The exact answer, which is found once for all tests of a process.
const std::vector<glm::dvec3>& GetExact(unsigned seed)
{
  static std::map<unsigned, std::vector<glm::dvec3>> known;
  std::vector<glm::dvec3>& exact = known[seed];
  if (exact.empty())
  {
    exact = GetExactRadiance(oracle::MakeRandomScene(seed), Texels);
  }
  return exact;
}

Errors MeasureErrors(unsigned seed, const penumbra::ReceiverSettings& settings)
{
  const oracle::RandomScene random = oracle::MakeRandomScene(seed);
  const std::vector<glm::dvec3>& exact = GetExact(seed);
  const penumbra::ShadowScene scene = MakeShadowScene(random, settings, Texels);
  const penumbra::ReceiverSettings& used = scene.Receivers.front().Settings;
  const TestBake bake = BakeReceiver(scene);
  double actual = 0.0, estimated = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const glm::dvec3 baked =
      used.Reflectance * (used.AmbientRadiance + glm::dvec3(bake.Texels.Irradiance.at(i)));
    const double error = GetMean(baked - exact[i]);
    actual += error * error;
    estimated += static_cast<double>(bake.Texels.Variance.at(i));
    peak = std::max(peak, GetMean(exact[i]));
  }
  const auto count = static_cast<double>(exact.size());
  return { std::sqrt(actual / count) / peak, std::sqrt(estimated / count) / peak,
    bake.Reports.front() };
}

std::vector<Errors> MeasureAll(const penumbra::ReceiverSettings& settings)
{
  std::vector<Errors> all;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    all.push_back(MeasureErrors(seed, settings));
  }
  return all;
}

template <typename Predicate>
double GetShare(const std::vector<Errors>& all, const Predicate& is)
{
  return static_cast<double>(std::count_if(all.begin(), all.end(), is)) /
    static_cast<double>(all.size());
}

bool IsCalibrated(const Errors& e)
{
  return e.GetRatio() >= 0.5 && e.GetRatio() <= 2.0;
}

void PrintRatios(const std::string& name, const std::vector<Errors>& all)
{
  std::vector<double> ratios;
  for (std::size_t seed = 0; seed < all.size(); ++seed)
  {
    ratios.push_back(all[seed].GetRatio());
    if (!IsCalibrated(all[seed]))
    {
      std::cout << "  scene " << seed << ": RMS error " << all[seed].Actual << ", estimated "
                << all[seed].Estimated << "\n";
    }
  }
  std::sort(ratios.begin(), ratios.end());
  std::cout << name << ": true over estimated RMS error:";
  for (const int percent : { 0, 5, 25, 50, 75, 95, 100 })
  {
    const auto i = static_cast<std::size_t>(percent) * (ratios.size() - 1) / 100;
    std::cout << " " << percent << " %: " << ratios[i] << (percent < 100 ? "," : "\n");
  }
}

/// The issue's: 19 of 20 scenes.
constexpr double Most = 0.95;

} // namespace

// By the default settings, 64 samples with reconstruction, and by four times as many.
class ErrorEstimate : public testing::TestWithParam<int>
{
};

TEST_P(ErrorEstimate, IsAboutTheError)
{
  penumbra::ReceiverSettings settings;
  settings.LightSamples = this->GetParam();
  const std::vector<Errors> all = MeasureAll(settings);
  PrintRatios(std::to_string(this->GetParam()) + " samples", all);
  EXPECT_GE(GetShare(all, IsCalibrated), Most);
}

INSTANTIATE_TEST_SUITE_P(
  Samples, ErrorEstimate, testing::Values(64, 256), testing::PrintToStringParamName());

TEST(ErrorTolerance, IsKept)
{
  penumbra::ReceiverSettings settings;
  settings.ErrorTolerance = 1.0 / 255.0;
  const std::vector<Errors> all = MeasureAll(settings);
  PrintRatios("ErrorTolerance 1/255", all);
  const auto isBelow = [&](const Errors& e) { return e.Actual < settings.ErrorTolerance; };
  const auto isStopped = [](const Errors& e) { return e.Report.StoppedBy == "ErrorTolerance"; };
  std::vector<Errors> stopped;
  std::copy_if(all.begin(), all.end(), std::back_inserter(stopped), isStopped);
  std::cout << GetShare(all, isBelow) << " of the scenes are below it; " << stopped.size()
            << " report it, " << GetShare(stopped, isBelow) << " of them rightly\n";
  EXPECT_GE(GetShare(all, isBelow), Most);
  EXPECT_GE(GetShare(stopped, isBelow), Most);
  for (std::size_t seed = 0; seed < all.size(); ++seed)
  {
    // What is said of the end is so, and no more was taken than was needed.
    const Errors& e = all[seed];
    EXPECT_EQ(e.Report.StoppedBy == "MaximumLightSamples",
      e.GetSamples() >= settings.MaximumLightSamples && e.Estimated > settings.ErrorTolerance)
      << "scene " << seed;
  }
  // Some scenes need more than the first batch, or nothing was asked of the batches.
  EXPECT_LT(GetShare(all, [](const Errors& e) { return e.GetSamples() <= 64; }), 0.9);
}

// With too few samples allowed, the report says that they were what ended the bake.
TEST(ErrorTolerance, SaysWhereSamplesRanOut)
{
  penumbra::ReceiverSettings settings;
  settings.ErrorTolerance = 1e-5;
  settings.MaximumLightSamples = 200;
  const Errors errors = MeasureErrors(1, settings);
  EXPECT_EQ(errors.Report.StoppedBy, "MaximumLightSamples");
  EXPECT_EQ(errors.GetSamples(), 200);
  EXPECT_GT(errors.Estimated, settings.ErrorTolerance);
}

// One sample of a light that has a size tells nothing of its error: no accuracy may be claimed.
TEST(ErrorTolerance, IsNotClaimedByOneSample)
{
  penumbra::ReceiverSettings settings;
  settings.ErrorTolerance = 1e-3;
  settings.MaximumLightSamples = 1;
  const Errors errors = MeasureErrors(1, settings);
  EXPECT_EQ(errors.GetSamples(), 1);
  EXPECT_GT(errors.Actual, settings.ErrorTolerance);
  EXPECT_EQ(errors.Report.StoppedBy, "MaximumLightSamples");
}

// The fine texels' variance arrives in the coarse ones, and their refinement ends.
TEST(ErrorTolerance, IsKeptBySupersampledTexels)
{
  penumbra::ReceiverSettings settings;
  settings.Supersampling = 2;
  EXPECT_GT(MeasureErrors(1, settings).Estimated, 0.0);
  settings.ErrorTolerance = 1e-3;
  const Errors errors = MeasureErrors(1, settings);
  EXPECT_EQ(errors.Report.StoppedBy, "ErrorTolerance");
  EXPECT_GT(errors.GetSamples(), 64);
  EXPECT_GT(errors.Estimated, 0.0);
  EXPECT_LE(errors.Estimated, 1e-3);
}

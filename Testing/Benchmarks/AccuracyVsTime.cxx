// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What accuracy costs in time, beside the loop of H&H 1997 and rays. See README.md.

#include "AccuracyCurves.h"
#include "AccuracyPlots.h"
#include "BenchmarkTools.h"
#include "LiteralLoop.h"
#include "SamplingPattern.h"
#include "StudyScenes.h"

#ifdef PENUMBRA_EMBREE_VERSION
#include "EmbreePeer.h"
#endif

#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace
{

/// How much is done.
struct Plan
{
  int Texels = 256; ///< along each edge
  int MostSamples = 4096;
  int SamplePowers = 1; ///< of two, from one n to the next
  int Runs = 3;
  int SphereRings = 14; ///< 8 736 triangles
  int MostSphereSamples = 1024;
  std::vector<int> EdgeTexels{ 16, 32, 64, 128, 256 };
  std::vector<double> Tolerances{ 0.03, 0.01, 1.0 / 255.0, 0.002, 0.001 };
  bool IsWhole = true; ///< else only what must hold of any plan is judged
};

/// CI's: some seconds.
Plan MakeSmallestPlan()
{
  return { 48, 1024, 2, 1, 4, 64, { 12, 24 }, { 0.03 }, false };
}

/// What the study of texel sizes is made with: enough samples for texels to matter.
constexpr int EdgeSamples = 1024;
const std::vector<int> Supersamplings{ 1, 2, 4 };

/// One point of the study's axes.
struct Case
{
  int Pattern = 0;
  int Texels = 0; ///< along each edge
  int Supersampling = 1;
  int Samples = 1;
  bool ExactShares = true;
  bool Reconstruction = true;
  double Tolerance = 0.0; ///< 0: Samples are taken
};

/// One bake.
struct Baked
{
  std::vector<double> Texels; ///< irradiance over pi, i fastest
  int Samples = 0;            ///< that were taken
  double Seconds = 0.0;
  double BuildSeconds = 0.0;
};

/// What makes shadows, from geometry in main memory to finished texels.
class Technique
{
public:
  virtual ~Technique() = default;
  virtual Baked Bake(const StudyScene& scene, const Case& point, int seed) = 0;
};

penumbra::ShadowScene MakeShadowScene(const StudyScene& scene, const Case& point, int seed)
{
  penumbra::ShadowScene result = scene.Baked;
  penumbra::Receiver& receiver = result.Receivers.front();
  receiver.Texels = glm::ivec2(point.Texels);
  receiver.Settings.LightSamples = point.Samples;
  receiver.Settings.SamplingPattern = point.Pattern;
  receiver.Settings.Supersampling = point.Supersampling;
  receiver.Settings.Seed = seed;
  receiver.Settings.ExactShares = point.ExactShares;
  receiver.Settings.Reconstruction = point.Reconstruction;
  receiver.Settings.ErrorTolerance = point.Tolerance;
  return result;
}

/// The product.
class Masks : public Technique
{
public:
  ~Masks() override { this->Texture->ReleaseGraphicsResources(); }

  Baked Bake(const StudyScene& scene, const Case& point, int seed) override
  {
    const penumbra::ShadowScene shadowScene = MakeShadowScene(scene, point, seed);
    vtkOpenGLRenderWindow* window = GetTestWindow();
    const double start = GetTime();
    const auto reports = this->Baker->Bake(shadowScene, { 0 }, window, this->Texture);
    window->WaitForCompletion();
    Baked baked;
    baked.Seconds = GetTime() - start;
    baked.Samples = reports.at(0).Pairs.at(0).LightSamples;
    const auto texels = this->Texture->Download(this->Texture->GetRegions().front());
    for (const glm::vec4& texel : texels.Irradiance)
    {
      baked.Texels.push_back(static_cast<double>(texel.r));
    }
    return baked;
  }

private:
  vtkNew<vtkRadianceBaker> Baker;
  vtkNew<vtkRadianceTexture> Texture;
};

/// H&H 1997, section 3.5, as it was published.
class Literal : public Technique
{
public:
  Baked Bake(const StudyScene& scene, const Case& point, int seed) override
  {
    this->Loop.Bake(
      MakeShadowScene(scene, point, seed), 0, GetTestWindow(), LiteralLoop::Estimator::PlainSum);
    Baked baked;
    baked.Seconds = this->Loop.GetSeconds();
    baked.Samples = point.Samples;
    for (const glm::dvec3& texel : this->Loop.GetIrradiance())
    {
      baked.Texels.push_back(texel.r);
    }
    return baked;
  }

private:
  LiteralLoop Loop;
};

#ifdef PENUMBRA_EMBREE_VERSION
class Rays : public Technique
{
public:
  Baked Bake(const StudyScene& scene, const Case& point, int seed) override
  {
    std::vector<penumbra::Surface> occluders;
    for (std::size_t i = 1; i < scene.Baked.Surfaces.size(); ++i)
    {
      occluders.push_back(*scene.Baked.Surfaces[i]);
    }
    const std::vector<float> texels = this->Peer.Bake({ occluders, scene.Light, scene.Exact.Base,
      glm::ivec2(point.Texels), point.Samples, static_cast<std::uint32_t>(seed) });
    return { { texels.begin(), texels.end() }, point.Samples, this->Peer.GetSeconds(),
      this->Peer.GetBuildSeconds() };
  }

private:
  EmbreePeer Peer;
};
#endif

/// A technique at a point of the axes, and what it is called.
struct Trial
{
  std::string TechniqueName;
  Technique* Maker;
  Case Point;
};

/// The truth about a scene's texels, by their number along an edge and by its name in the CSV.
using Truths = std::map<int, std::map<std::string, std::vector<double>>>;

/// The sums over the runs of a trial against one truth.
struct ErrorSum
{
  double Squares = 0.0;
  double Largest = 0.0;
  std::size_t Count = 0;

  void Add(const std::vector<double>& texels, const std::vector<double>& truth)
  {
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
      const double error = std::abs(texels.at(i) - truth[i]);
      this->Squares += error * error;
      this->Largest = std::max(this->Largest, error);
    }
    this->Count += truth.size();
  }
};

/// Those of a scene, bakes in turn, so that what disturbs the machine disturbs all. Each run has a
/// seed of its own: errors are over all of them.
class Series
{
public:
  Series(const StudyScene& scene, const Truths& truths, const std::vector<Trial>& trials)
    : Scene(scene)
    , KnownTruths(truths)
    , Trials(trials)
    , Seconds(trials.size())
    , BuildSeconds(trials.size())
    , Samples(trials.size())
    , Errors(trials.size())
  {
  }

  void Run(int runs);
  Measurements GetMeasurements() const;

private:
  void WarmUp();

  const StudyScene& Scene;
  const Truths& KnownTruths;
  const std::vector<Trial>& Trials;
  // Of each trial, in their order.
  std::vector<std::vector<double>> Seconds, BuildSeconds;
  std::vector<int> Samples;
  std::vector<std::map<std::string, ErrorSum>> Errors;
};

/// Compiles shaders, which depend on no more than whether there are many samples.
void Series::WarmUp()
{
  constexpr int enough = 256;
  for (const Trial& trial : this->Trials)
  {
    if (trial.Point.Samples <= enough)
    {
      trial.Maker->Bake(this->Scene, trial.Point, 0);
    }
  }
}

void Series::Run(int runs)
{
  this->WarmUp();
  for (int run = 0; run < runs; ++run)
  {
    for (std::size_t i = 0; i < this->Trials.size(); ++i)
    {
      const Trial& trial = this->Trials[i];
      const Baked baked = trial.Maker->Bake(this->Scene, trial.Point, run);
      this->Seconds[i].push_back(baked.Seconds);
      this->BuildSeconds[i].push_back(baked.BuildSeconds);
      this->Samples[i] = baked.Samples;
      for (const auto& [name, truth] : this->KnownTruths.at(trial.Point.Texels))
      {
        this->Errors[i][name].Add(baked.Texels, truth);
      }
    }
  }
}

Measurements Series::GetMeasurements() const
{
  const std::vector<double>& centres = this->KnownTruths.begin()->second.at(CentreTruth);
  const double peak = *std::max_element(centres.begin(), centres.end());
  Measurements measurements;
  for (std::size_t i = 0; i < this->Trials.size(); ++i)
  {
    const Case& point = this->Trials[i].Point;
    for (const auto& [name, error] : this->Errors[i])
    {
      Measurement m;
      m.Scene = this->Scene.Name;
      m.Technique = this->Trials[i].TechniqueName;
      m.Pattern = penumbra::GetSamplingPatterns()[static_cast<std::size_t>(point.Pattern)].Name;
      m.Texels = point.Texels;
      m.Supersampling = point.Supersampling;
      m.Tolerance = point.Tolerance;
      m.Samples = this->Samples[i];
      m.Seconds = GetMedian(this->Seconds[i]);
      m.RootMeanSquare = std::sqrt(error.Squares / static_cast<double>(error.Count)) / peak;
      m.Maximum = error.Largest / peak;
      m.Truth = name;
      m.Triangles = this->Scene.GetTriangles();
      m.BuildSeconds = GetMedian(this->BuildSeconds[i]);
      measurements.push_back(m);
    }
  }
  return measurements;
}

/// All that is compared.
struct Techniques
{
  Masks Product;
  Literal Loop;
#ifdef PENUMBRA_EMBREE_VERSION
  Rays Peer;
#endif
};

/// The axis n: powers of two for the default pattern, of four for the others, since grids round
/// what is between up to full rows.
std::vector<Trial> MakeSampleTrials(
  const Plan& plan, Techniques& techniques, int patterns, int mostSamples)
{
  std::vector<Trial> trials;
  for (int power = 0; 1 << power <= mostSamples; power += plan.SamplePowers)
  {
    const int n = 1 << power;
    for (int pattern = 0; pattern < (power % 2 == 0 ? patterns : 1); ++pattern)
    {
      trials.push_back({ SamplesName, &techniques.Product, { pattern, plan.Texels, 1, n, false } });
    }
    trials.push_back({ MasksName, &techniques.Product, { 0, plan.Texels, 1, n } });
    trials.push_back({ CountsName, &techniques.Product, { 0, plan.Texels, 1, n, false, false } });
    trials.push_back({ LiteralName, &techniques.Loop, { 0, plan.Texels, 1, n } });
#ifdef PENUMBRA_EMBREE_VERSION
    trials.push_back({ RaysName, &techniques.Peer, { 0, plan.Texels, 1, n } });
#endif
  }
  for (const double tolerance : plan.Tolerances)
  {
    trials.push_back(
      { ToleranceName, &techniques.Product, { 0, plan.Texels, 1, 1, true, true, tolerance } });
  }
  return trials;
}

/// The axes of texel sizes and supersampling.
std::vector<Trial> MakeTexelTrials(const Plan& plan, Techniques& techniques)
{
  std::vector<Trial> trials;
  for (const int texels : plan.EdgeTexels)
  {
    for (const int supersampling : Supersamplings)
    {
      trials.push_back(
        { MasksName, &techniques.Product, { 0, texels, supersampling, EdgeSamples } });
    }
  }
  return trials;
}

Measurements MeasureScene(
  const StudyScene& scene, const std::vector<Trial>& trials, const Truths& truths, int runs)
{
  Series series(scene, truths, trials);
  series.Run(runs);
  return series.GetMeasurements();
}

/// The scene with error against the size of texels.
Measurements MeasureTexels(const Plan& plan, Techniques& techniques, const StudyScene& scene)
{
  const std::vector<double> averages = GetExactAverages(scene, plan.EdgeTexels.back());
  Truths truths;
  for (const int texels : plan.EdgeTexels)
  {
    truths[texels] = { { CentreTruth, GetExactCentres(scene, texels) },
      { AreaTruth, MergeCells(averages, texels) } };
  }
  return MeasureScene(scene, MakeTexelTrials(plan, techniques), truths, plan.Runs);
}

/// Everything that was measured.
struct Study
{
  std::vector<StudyScene> Scenes;           ///< the first three are judged by their errors
  std::vector<std::vector<double>> Centres; ///< of each: exact, at the texels' centres
  Measurements Samples;                     ///< error against n and time
  Measurements Texels;                      ///< error against the size of texels
};

Study Measure(const Plan& plan)
{
  Techniques techniques;
  Study study;
  study.Scenes = { MakeContactScene(), MakePenumbraScene(), MakeOverlapScene(),
    MakeSpheresScene(plan.SphereRings) };
  for (const StudyScene& scene : study.Scenes)
  {
    const bool isLast = &scene == &study.Scenes.back();
    const int patterns = isLast ? 1 : static_cast<int>(penumbra::GetSamplingPatterns().size());
    const int mostSamples = isLast ? plan.MostSphereSamples : plan.MostSamples;
    std::fprintf(stderr, "%s ...\n", scene.Title.c_str());
    study.Centres.push_back(GetExactCentres(scene, plan.Texels));
    const Measurements measured =
      MeasureScene(scene, MakeSampleTrials(plan, techniques, patterns, mostSamples),
        { { plan.Texels, { { CentreTruth, study.Centres.back() } } } }, plan.Runs);
    study.Samples.insert(study.Samples.end(), measured.begin(), measured.end());
  }
  for (std::size_t i : { 0, 1 })
  {
    const Measurements measured = MeasureTexels(plan, techniques, study.Scenes[i]);
    study.Texels.insert(study.Texels.end(), measured.begin(), measured.end());
  }
  return study;
}

/// What issue 3 asks for: errors on the first scenes, times on all.
constexpr std::size_t JudgedScenes = 3;
constexpr int JudgedSamples = 1024;
constexpr double LargestRootMeanSquare = 6e-4;
constexpr double LargestMaximum = 5e-3;
constexpr double SlowestExponent = -0.75;
constexpr double JudgedRootMeanSquare = 1e-3;
/// What random points would do.
constexpr double RandomExponent = -0.5;
/// Printed beside the exponent over all n, which is the one that is judged: with fewer samples,
/// whole occluders come and go.
constexpr int FewestSettled = 16;

/// The curve of a technique with the default pattern.
Measurements GetCurve(const Study& study, const StudyScene& scene, const char* technique)
{
  const std::string& pattern = penumbra::GetSamplingPatterns().front().Name;
  return Select(study.Samples,
    [&](const Measurement& m)
    { return m.Scene == scene.Name && m.Technique == technique && m.Pattern == pattern; });
}

void PrintTables(const Plan& plan, const Study& study)
{
  std::printf(
    "%d x %d texels; medians and errors of %d runs, each with its seed; errors as shares "
    "of the peak\n\n| scene | triangles | technique | pattern | tolerance | n | seconds | "
    "(hierarchy) | RMS | maximum |\n|---|---|---|---|---|---|---|---|---|---|\n",
    plan.Texels, plan.Texels, plan.Runs);
  for (const Measurement& m : study.Samples)
  {
    std::printf("| %s | %zu | %s | %s | %.4f | %d | %.4f | %.4f | %.2e | %.2e |\n", m.Scene.c_str(),
      m.Triangles, m.Technique.c_str(), m.Pattern.c_str(), m.Tolerance, m.Samples, m.Seconds,
      m.BuildSeconds, m.RootMeanSquare, m.Maximum);
  }
  std::printf(
    "\n| scene | technique | exponent of RMS against n | from n = %d on | seconds at RMS %.0e |\n"
    "|---|---|---|---|---|\n",
    FewestSettled, JudgedRootMeanSquare);
  for (const StudyScene& scene : study.Scenes)
  {
    for (const char* technique : { SamplesName, CountsName, LiteralName, RaysName })
    {
      const Measurements curve = GetCurve(study, scene, technique);
      const std::optional<double> seconds = GetSecondsAt(curve, JudgedRootMeanSquare);
      if (!curve.empty())
      {
        std::printf("| %s | %s | %.3f | %.3f | %s |\n", scene.Name.c_str(), technique,
          FitRootMeanSquare(curve).Exponent, FitRootMeanSquare(curve, FewestSettled).Exponent,
          seconds ? std::to_string(*seconds).c_str() : "not reached");
      }
    }
  }
}

bool WriteFiles(const std::string& folder, const Study& study)
{
  Measurements all = study.Samples;
  all.insert(all.end(), study.Texels.begin(), study.Texels.end());
  std::vector<SceneTitle> titles;
  for (const StudyScene& scene : study.Scenes)
  {
    titles.push_back(
      { scene.Name, scene.Title + ", " + std::to_string(scene.GetTriangles()) + " triangles" });
  }
  const std::vector<SceneTitle> edges{ { titles[0].Name, "Hard edges" },
    { titles[1].Name, "Soft edges" } };
  return WriteCsv(folder + "/accuracy.csv", all) &&
    PlotErrorAgainstTime(folder + "/error-against-time.png", titles, study.Samples) &&
    PlotErrorAgainstSamples(folder + "/error-against-samples.png", titles, study.Samples) &&
    PictureScenes(folder + "/scenes.png", study.Centres) &&
    PlotErrorAgainstTexels(folder + "/error-against-texel-size.png", edges, study.Texels);
}

/// Errors at n = 1024, and how fast those of samples fall.
bool JudgeErrors(const Study& study, const StudyScene& scene)
{
  const double exponent = FitRootMeanSquare(GetCurve(study, scene, SamplesName)).Exponent;
  bool good = Require(exponent <= SlowestExponent,
    scene.Name + ": RMS must fall with n^-0.75 or faster, it falls with n^" +
      std::to_string(exponent));
  for (const Measurement& m : GetCurve(study, scene, MasksName))
  {
    if (m.Samples == JudgedSamples)
    {
      good &= Require(m.RootMeanSquare <= LargestRootMeanSquare,
        scene.Name + ": the RMS error at n = 1024 must be at most 6e-4, it is " +
          std::to_string(m.RootMeanSquare));
      good &= Require(m.Maximum <= LargestMaximum,
        scene.Name + ": the maximum error at n = 1024 must be at most 5e-3, it is " +
          std::to_string(m.Maximum));
    }
  }
  return good;
}

/// The least RMS error of a curve.
double GetLeastError(const Measurements& curve)
{
  return std::min_element(curve.begin(), curve.end(),
    [](const Measurement& a, const Measurement& b) { return a.RootMeanSquare < b.RootMeanSquare; })
    ->RootMeanSquare;
}

/// Masks against rays: at the RMS that is asked for, or the least that both reach. Samples alone
/// reach it; between the numbers of them that were measured, shares are not exact by halves.
bool JudgeTimes(const Study& study, const StudyScene& scene)
{
  const Measurements masks = GetCurve(study, scene, SamplesName);
  const Measurements rays = GetCurve(study, scene, RaysName);
  if (rays.empty())
  {
    std::printf("%s: no Embree to compare times with\n", scene.Name.c_str());
    return true;
  }
  const double error =
    std::max({ JudgedRootMeanSquare, GetLeastError(masks), GetLeastError(rays) });
  const double seconds = *GetSecondsAt(masks, error);
  const double raySeconds = *GetSecondsAt(rays, error);
  std::printf("%s: an RMS of %.2e takes masks %.4f s, Embree %.4f s, %.2f times as long\n",
    scene.Name.c_str(), error, seconds, raySeconds, raySeconds / seconds);
  return Require(seconds < raySeconds, scene.Name + ": masks must take less time than Embree");
}

bool Judge(const Plan& plan, const Study& study)
{
  bool good = true;
  for (const StudyScene& scene : study.Scenes)
  {
    const bool isJudged = &scene < &study.Scenes[JudgedScenes];
    good &=
      Require(FitRootMeanSquare(GetCurve(study, scene, SamplesName)).Exponent < RandomExponent,
        scene.Name + ": the default pattern must do better than random points");
    good &= !plan.IsWhole || !isJudged || JudgeErrors(study, scene);
    good &= !plan.IsWhole || JudgeTimes(study, scene);
  }
  return good;
}

int Run(const Plan& plan, const std::string& folder)
{
  if (!GetTestWindow()->SupportsOpenGL())
  {
    std::fprintf(stderr, "AccuracyVsTime: no OpenGL: %s\n", GetTestWindow()->ReportCapabilities());
    return 1;
  }
  const Study study = Measure(plan);
  PrintTables(plan, study);
  if (!WriteFiles(folder, study))
  {
    std::fprintf(stderr, "AccuracyVsTime: cannot write into %s\n", folder.c_str());
    return 1;
  }
  return Judge(plan, study) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  Plan plan;
  std::string folder;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--smallest")
    {
      plan = MakeSmallestPlan();
    }
    else if (argument[0] != '-' && folder.empty())
    {
      folder = argument;
    }
    else
    {
      folder.clear();
      break;
    }
  }
  if (folder.empty())
  {
    std::fprintf(stderr, "usage: AccuracyVsTime [--smallest] folder\n");
    return 2;
  }
  const int result = Run(plan, folder);
  ReleaseTestWindow();
  return result;
}

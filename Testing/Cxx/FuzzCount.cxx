// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzCount.h"

#include "OracleScene.h"
#include "PolygonLight.h"
#include "SampledVisibility.h"
#include "SamplingPattern.h"
#include "StabilityTools.h"

#include <algorithm>
#include <cmath>

namespace
{

/// A light as the receiver sees it, and rays to its samples.
class CountedLight
{
public:
  CountedLight(const FuzzedScene& scene, const penumbra::ShadowScene& made, std::size_t light);

  /// Adds what arrives at a texel.
  void Add(int i, int j, ExactCount& count) const;
  /// The sum of the peaks of its polygons, or its own.
  double GetPeak() const;

private:
  static std::vector<oracle::Vec3> GetPlaces(const std::vector<penumbra::LightSample>& samples);
  std::vector<penumbra::LightSample> TakeSamples(const FuzzedScene& scene) const;
  long double GetWeight(std::size_t sample, const oracle::Vec3& d, int channel) const;
  glm::dvec3 GetPlace(int i, int j) const { return FromOracle(this->Grid.GetCentre(i, j)); }

  oracle::TexelGrid Grid;
  glm::dvec3 Normal;
  penumbra::Light Seen;
  std::vector<penumbra::LightSample> Samples;
  oracle::SampledVisibility Visibility;
};

oracle::TexelGrid MakeGrid(const FuzzedScene& scene)
{
  return { ToOracle(scene.Base.Corner), ToOracle(scene.Base.EdgeX), ToOracle(scene.Base.EdgeY),
    scene.Texels.x, scene.Texels.y, scene.Settings.Side == penumbra::ReceiverSide::Back };
}

/// What lies in the receiver's plane, but for the rounding of its coordinates, blocks nothing:
/// vtkOccluderGeometry. Triangles that are meant to be above it are so by far more.
bool LiesInPlane(const FuzzedScene& scene, const FuzzedTriangle& triangle)
{
  constexpr double rounding = 1e-12;
  const penumbra::ReceiverFrame frame(scene.Base, penumbra::ReceiverFrame::Side::Front);
  return std::all_of(triangle.begin(), triangle.end(),
    [&](const glm::dvec3& p) { return std::abs(frame.ToFrame(p).z) < rounding; });
}

std::vector<oracle::Triangle> GetTriangles(const FuzzedScene& scene)
{
  std::vector<oracle::Triangle> triangles;
  for (const FuzzedTriangle& t : scene.Occluders)
  {
    if (LiesInPlane(scene, t))
    {
      continue;
    }
    triangles.push_back({ ToOracle(t[0]), ToOracle(t[1]), ToOracle(t[2]) });
  }
  return triangles;
}

CountedLight::CountedLight(
  const FuzzedScene& scene, const penumbra::ShadowScene& made, std::size_t light)
  : Grid(MakeGrid(scene))
  , Normal(made.MakeFrame(made.Receivers.front()).GetNormal())
  , Seen(made.Lights[light]->Clip(scene.Base.Corner, this->Normal)->Face(scene.Base))
  , Samples(this->TakeSamples(scene))
  , Visibility(this->Grid, GetTriangles(scene), GetPlaces(this->Samples),
      this->Seen->GetHull().AreDirections, GetRayTolerance(scene.Base, this->Seen))
{
}

std::vector<penumbra::LightSample> CountedLight::TakeSamples(const FuzzedScene& scene) const
{
  const penumbra::ReceiverSettings& s = scene.Settings;
  const penumbra::SamplingPattern& pattern =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(s.SamplingPattern)];
  return this->Seen->IsValid() ? this->Seen->TakeSamples(pattern.Generate(s.GetSampleCount(),
                                   static_cast<std::uint32_t>(s.Seed), this->Seen->GetAspect()))
                               : std::vector<penumbra::LightSample>();
}

std::vector<oracle::Vec3> CountedLight::GetPlaces(const std::vector<penumbra::LightSample>& samples)
{
  std::vector<oracle::Vec3> places;
  for (const penumbra::LightSample& sample : samples)
  {
    places.push_back(ToOracle(sample.Place));
  }
  return places;
}

/// H&H 1997, eq. 1, up to what all samples share.
long double CountedLight::GetWeight(std::size_t sample, const oracle::Vec3& d, int channel) const
{
  const long double r2 = Dot(d, d);
  const long double cosine = std::max(Dot(ToOracle(this->Normal), d), 0.0L);
  const oracle::Vec3 axis = ToOracle(this->Seen->GetAxis());
  switch (this->Seen->GetEmission())
  {
    case penumbra::Emission::Area:
      return cosine * std::abs(Dot(axis, d)) / (r2 * r2);
    case penumbra::Emission::Line:
      return cosine * Length(Cross(axis, d)) / (r2 * r2);
    case penumbra::Emission::Point:
      return cosine / (r2 * std::sqrt(r2));
    case penumbra::Emission::Cells:
      break;
  }
  const penumbra::LightSample& s = this->Samples[sample];
  const long double away = -Dot(ToOracle(s.Normal), d);
  const double power =
    this->Seen->HasOneHue() ? s.Power.x + s.Power.y + s.Power.z : s.Power[channel];
  return power * cosine * (this->Seen->TwoSided ? std::abs(away) : std::max(away, 0.0L)) /
    (r2 * r2);
}

void CountedLight::Add(int i, int j, ExactCount& count) const
{
  if (!this->Seen->IsValid())
  {
    return;
  }
  const auto texel = static_cast<std::size_t>(j * this->Grid.CountX + i);
  const glm::dvec3 unblocked = this->Seen->Irradiance(this->GetPlace(i, j), this->Normal);
  for (int c = 0; c < 3; ++c)
  {
    const oracle::SeenShare share = this->Visibility.GetShare(i, j,
      [&](std::size_t sample, const oracle::Vec3& d) { return this->GetWeight(sample, d, c); });
    count.Low[texel][c] += unblocked[c] * static_cast<double>(share.Low);
    count.High[texel][c] += unblocked[c] * static_cast<double>(share.High);
  }
}

double CountedLight::GetPeak() const
{
  if (!this->Seen->IsValid())
  {
    return 0.0;
  }
  const std::vector<penumbra::EmittingPolygon> polygons = this->Seen->GetPolygons();
  double sum = 0.0;
  for (std::size_t part = 0; part < std::max(polygons.size(), std::size_t{ 1 }); ++part)
  {
    double peak = 0.0;
    for (int texel = 0; texel < this->Grid.CountX * this->Grid.CountY; ++texel)
    {
      const glm::dvec3 x = this->GetPlace(texel % this->Grid.CountX, texel / this->Grid.CountX);
      const glm::dvec3 light = polygons.empty()
        ? this->Seen->Irradiance(x, this->Normal)
        : polygons[part].Radiance * polygons[part].Polygon->FormFactor(x, this->Normal);
      peak = std::max({ peak, light.x, light.y, light.z });
    }
    sum += peak;
  }
  return sum;
}

} // namespace

ExactCount CountExactly(const FuzzedScene& scene)
{
  const penumbra::ShadowScene made = scene.Make();
  ExactCount count;
  count.Low.resize(static_cast<std::size_t>(scene.Texels.x * scene.Texels.y), glm::dvec3(0.0));
  count.High = count.Low;
  for (std::size_t light = 0; light < made.Lights.size(); ++light)
  {
    const CountedLight counted(scene, made, light);
    for (int j = 0; j < scene.Texels.y; ++j)
    {
      for (int i = 0; i < scene.Texels.x; ++i)
      {
        counted.Add(i, j, count);
      }
    }
    count.Peak += counted.GetPeak();
  }
  return count;
}

FuzzedScene WithoutFilters(FuzzedScene scene)
{
  scene.Settings.Reconstruction = false;
  scene.Settings.HardPenumbra = 0.0; // all samples, of all lights
  scene.Settings.PlannerTolerance = 0.0;
  scene.Settings.Supersampling = 1;
  if (scene.Settings.Side == penumbra::ReceiverSide::Auto)
  {
    scene.Settings.Side = penumbra::ReceiverSide::Front;
  }
  return scene;
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StabilityTools.h"

#include "SampledVisibility.h"
#include "SamplingPattern.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace
{

oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

/// The product's samples and what the exact count says of them.
struct CountedLight
{
  oracle::Light Exact;
  oracle::SampledVisibility Visibility;
  oracle::Vec3 Normal, LightNormal;
};

} // namespace

/// OpenGL has at least 4 bits below a texel, Mesa's software renderer 8. Vertices are put on that
/// grid by the shader, and those that clipping then makes by the rasteriser, each time by up to
/// half a step in x and y: the edges between them move by less than two steps twice. Occluders that
/// reach further than 64 receivers are clipped in double to what lies between receiver and light:
/// the light's distance in units of the receiver's edges.
oracle::RayTolerance GetRayTolerance(
  const penumbra::Parallelogram& base, const penumbra::Light& light)
{
  const double area = glm::length(glm::cross(base.EdgeX, base.EdgeY));
  double distance = 0.0;
  for (const glm::dvec3& p : light->GetHull().Points)
  {
    distance = std::max(distance, glm::length(p - base.Corner));
  }
  return { 4.0L / 256, 0x1p-24L, std::max(64.0, distance * glm::length(base.EdgeY) / area),
    std::max(64.0, distance * glm::length(base.EdgeX) / area) };
}

namespace
{

CountedLight CountLight(
  const TestScene& scene, const oracle::TexelGrid& grid, const penumbra::Light& light)
{
  const double side = grid.IsBack ? -1.0 : 1.0;
  const glm::dvec3 normal = side * glm::normalize(glm::cross(scene.Base.EdgeX, scene.Base.EdgeY));
  const penumbra::Light seen(light->Clip(scene.Base.Corner, normal));
  std::vector<oracle::Vec3> samples;
  const penumbra::ReceiverSettings& s = scene.Settings;
  const penumbra::SamplingPattern& pattern =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(s.SamplingPattern)];
  if (seen->IsValid())
  {
    for (const penumbra::LightSample& sample : seen->TakeSamples(pattern.Generate(
           s.GetSampleCount(), static_cast<std::uint32_t>(s.Seed), seen->GetAspect())))
    {
      samples.push_back(ToOracle(sample.Place));
    }
  }
  oracle::Light exact;
  for (const glm::dvec3& vertex : light->GetPolygons().front().Polygon->GetVertices())
  {
    exact.Vertices.push_back(ToOracle(vertex));
  }
  exact.TwoSided = light->TwoSided;
  exact.Radiance = { light->Radiance.x, light->Radiance.y, light->Radiance.z };
  return { exact, { grid, scene.Occluders, samples, false, GetRayTolerance(scene.Base, light) },
    ToOracle(normal), ToOracle(light->GetAxis()) };
}

} // namespace

double GetRadianceBound(int samples)
{
  return (48.0 + 2.0 * (48.0 + samples / 32.0)) * FloatRounding;
}

std::vector<glm::vec4> BakeTexels(TestScene scene)
{
  scene.Settings.Reconstruction = false;
  scene.Settings.HardPenumbra = 0.0; // all samples, of all lights
  scene.Settings.PlannerTolerance = 0.0;
  return BakeReceiver(scene.MakeScene()).Texels.Irradiance;
}

std::vector<glm::vec4> BakeInBands(const TestScene& scene, std::size_t maskBytes)
{
  vtkNew<vtkRadianceBaker> baker;
  vtkNew<vtkRadianceTexture> texture;
  baker->SetMaximumMaskBytes(maskBytes);
  baker->Bake(scene.MakeScene(), { 0 }, GetTestWindow(), texture);
  std::vector<glm::vec4> texels = texture->Download(texture->GetRegions().front()).Irradiance;
  texture->ReleaseGraphicsResources();
  return texels;
}

CountError CompareWithCount(TestScene scene)
{
  scene.Settings.Side = penumbra::ReceiverSide::Front;
  return CompareWithCount(scene, scene.MakeScene());
}

CountError CompareWithCount(const TestScene& scene, penumbra::ShadowScene made)
{
  penumbra::Receiver& receiver = made.Receivers.front();
  receiver.Texels = scene.Texels;
  receiver.IsAutomatic = false; // these texels, by their centres: no means of finer ones
  receiver.Settings = scene.Settings;
  receiver.Settings.Reconstruction = false;
  receiver.Settings.HardPenumbra = 0.0; // all samples, of all lights
  receiver.Settings.PlannerTolerance = 0.0;
  const std::vector<glm::vec4> texels = BakeReceiver(made).Texels.Irradiance;
  const oracle::TexelGrid grid{ ToOracle(scene.Base.Corner), ToOracle(scene.Base.EdgeX),
    ToOracle(scene.Base.EdgeY), scene.Texels.x, scene.Texels.y,
    scene.Settings.Side == penumbra::ReceiverSide::Back };
  std::vector<CountedLight> lights;
  for (const penumbra::Light& light : scene.Lights)
  {
    lights.push_back(CountLight(scene, grid, light));
  }
  long double peak = 0, largest = 0, open = 0;
  for (int j = 0; j < scene.Texels.y; ++j)
  {
    for (int i = 0; i < scene.Texels.x; ++i)
    {
      const oracle::Vec3 x = grid.GetCentre(i, j);
      const glm::vec4 texel = texels.at(static_cast<std::size_t>(j * scene.Texels.x + i));
      std::array<long double, 3> unblocked{}, low{}, high{};
      for (const CountedLight& light : lights)
      {
        const long double form = oracle::FormFactor(x, light.Normal, light.Exact);
        const oracle::SeenShare share = light.Visibility.GetShare(i, j,
          [&](std::size_t, const oracle::Vec3& d)
          {
            const long double r2 = Dot(d, d);
            return Dot(light.Normal, d) * std::abs(Dot(light.LightNormal, d)) / (r2 * r2);
          });
        for (std::size_t c = 0; c < 3; ++c)
        {
          unblocked[c] += light.Exact.Radiance[c] * form;
          low[c] += light.Exact.Radiance[c] * form * share.Low;
          high[c] += light.Exact.Radiance[c] * form * share.High;
        }
      }
      for (std::size_t c = 0; c < 3; ++c)
      {
        const long double value = texel[static_cast<int>(c)];
        if (!std::isfinite(value))
        {
          return { std::numeric_limits<double>::quiet_NaN(), 0.0 };
        }
        peak = std::max(peak, unblocked[c]);
        largest = std::max({ largest, low[c] - value, value - high[c] });
        open += high[c] - low[c];
      }
    }
  }
  const auto size = static_cast<double>(peak > 0 ? peak : 1.0L);
  return { static_cast<double>(largest) / size,
    static_cast<double>(open) / size / (3.0 * scene.Texels.x * scene.Texels.y) };
}

void ExpectWithin(const std::string& what, double error, double bound)
{
  std::cout << what << ": largest error " << error << ", bound " << bound << "\n";
  EXPECT_LE(error, bound) << what;
}

void ExpectExactCount(const TestScene& scene, double open)
{
  const CountError error = CompareWithCount(scene);
  ExpectWithin(scene.Name, error.Largest, GetRadianceBound(scene.Settings.GetSampleCount()));
  EXPECT_LE(error.Open, open) << scene.Name << ": the count leaves too much open to test anything";
}

TestScene MakeLampScene()
{
  TestScene scene;
  scene.Texels = { 32, 32 };
  scene.AddLight({ -0.5, 0.5, 2.0 }, { 0.5, 0.5, 2.0 }, { -0.5, -0.5, 2.0 });
  return scene;
}

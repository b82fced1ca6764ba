// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What holds for every scene, to the bit: in nasty ones, too.

#include "FuzzProperty.h"
#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace
{

using Texels = vtkRadianceTexture::Texels;

/// The part of the seeds that a test of its own takes.
class FuzzScenes : public testing::TestWithParam<unsigned>
{
protected:
  /// Each property has scenes of its own.
  unsigned GetFirst(unsigned property, unsigned count) const
  {
    return 100000 * property + this->GetParam() * count;
  }
};

Texels Bake(const FuzzedScene& scene)
{
  return BakeReceiver(scene.Make()).Texels;
}

FuzzedScene WithoutOccluders(FuzzedScene scene)
{
  scene.Occluders.clear();
  return scene;
}

/// By how much some component of some texel is more than the other's, of the other's largest; NaN
/// if one is not finite.
double GetExcess(const Texels& texels, const Texels& most)
{
  float excess = 0.0f, largest = std::numeric_limits<float>::min();
  for (std::size_t i = 0; i < texels.Irradiance.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const float value = texels.Irradiance[i][c], limit = most.Irradiance.at(i)[c];
      if (!std::isfinite(value) || !std::isfinite(limit))
      {
        return std::numeric_limits<double>::quiet_NaN();
      }
      excess = std::max(excess, value - limit);
      largest = std::max(largest, limit);
    }
  }
  return static_cast<double>(excess) / static_cast<double>(largest);
}

/// How many texels are not what they should be: finite, not below 0 (the ambient light comes on
/// top), with a visibility from 0 to 1.
Deviation CountBadTexels(const Texels& texels)
{
  Deviation result;
  for (std::size_t i = 0; i < texels.Irradiance.size(); ++i)
  {
    const glm::vec4& t = texels.Irradiance[i];
    const float variance = texels.Variance[i];
    const float seen = glm::dot(glm::vec3(t), glm::vec3(1.0f / 3.0f)), blocked = t.a;
    const float visibility = blocked > 0.0f ? seen / (seen + blocked) : 1.0f;
    const bool isGood = std::isfinite(seen) && std::isfinite(blocked) && std::isfinite(variance) &&
      std::min({ t.r, t.g, t.b, blocked, variance }) >= 0.0f && visibility >= 0.0f &&
      visibility <= 1.0f;
    result.Error += isGood ? 0.0 : 1.0;
  }
  return result;
}

} // namespace

TEST_P(FuzzScenes, FiniteAndVisibilityFromZeroToOne)
{
  constexpr unsigned count = 1500;
  ExpectProperty("texels that are not finite or out of range", FuzzedKind::Nasty,
    this->GetFirst(1, count), count,
    [](const FuzzedScene& scene, unsigned) { return CountBadTexels(Bake(scene)); });
}

// The same where shares are cut out of lights.
TEST_P(FuzzScenes, FiniteWithExactShares)
{
  constexpr unsigned count = 200;
  std::size_t exact = 0;
  ExpectProperty("texels with exact shares that are not finite or out of range", FuzzedKind::Nasty,
    this->GetFirst(7, count), count,
    [&](FuzzedScene scene, unsigned)
    {
      scene.Settings.LightSamples = 512;
      scene.Settings.Reconstruction = true;
      const TestBake bake = BakeReceiver(scene.Make());
      exact += CountExactTexels(bake);
      return CountBadTexels(bake.Texels);
    });
  EXPECT_GT(exact, count);
}

/**
 * What is cut out of lights and what their samples say, by ways that have nothing in common, in
 * scenes whose triangles touch everything. 1024 Sobol points miss no part of a light that a line
 * cuts off by more than about 1e-2, and 2048 by 0.6 of that (Rendering/README.md); the shadows of a
 * dozen triangles leave three or four such edges to be seen at once.
 */
TEST_P(FuzzScenes, ExactSharesAgreeWithSamples)
{
  constexpr unsigned count = 100;
  std::size_t found = 0;
  ExpectProperty("exact shares off what samples say", FuzzedKind::NastyOccluders,
    this->GetFirst(8, count), count,
    [&](FuzzedScene scene, unsigned)
    {
      scene.Settings.LightSamples = 2048;
      scene.Settings.SamplingPattern = 0;
      scene.Settings.Supersampling = 1;
      scene.Settings.Reconstruction = true;
      const TestBake bake = BakeReceiver(scene.Make());
      const Texels& exact = bake.Texels;
      found += CountExactTexels(bake);
      scene.Settings.Reconstruction = false;
      const Texels counted = Bake(scene);
      const Texels lit = Bake(WithoutOccluders(scene));
      Deviation result{ 0.0, 2e-2 };
      float largest = std::numeric_limits<float>::min();
      for (std::size_t i = 0; i < lit.Irradiance.size(); ++i)
      {
        for (int c = 0; c < 3; ++c)
        {
          largest = std::max(largest, lit.Irradiance[i][c]);
          result.Error = std::max(result.Error,
            static_cast<double>(std::abs(exact.Irradiance[i][c] - counted.Irradiance[i][c])));
        }
      }
      result.Error /= static_cast<double>(largest);
      return result;
    });
  EXPECT_GT(found, count);
}

// Both have one closed form, a share is at most 1, and sums of floats round in order.
TEST_P(FuzzScenes, FromAmbientToTheClosedForm)
{
  constexpr unsigned count = 500;
  ExpectProperty("brighter than without occluders", FuzzedKind::Nasty, this->GetFirst(2, count),
    count,
    [](const FuzzedScene& scene, unsigned) {
      return Deviation{ GetExcess(Bake(scene), Bake(WithoutOccluders(scene))), 0.0 };
    });
}

// Sample by sample: a mask's bits are never cleared, and a sum of floats that lacks terms is not
// larger. Filters across texels (Reconstruction) know nothing of that. A surface of its own: how
// far coordinates may be off is a surface's own.
TEST_P(FuzzScenes, AnOccluderNeverBrightens)
{
  constexpr unsigned count = 500;
  ExpectProperty("brighter with an occluder more", FuzzedKind::Nasty, this->GetFirst(3, count),
    count,
    [](FuzzedScene scene, unsigned seed)
    {
      scene.Settings.Reconstruction = false;
      penumbra::ShadowScene more = scene.Make();
      FuzzedScene only = scene;
      if (!scene.Lights.empty())
      {
        only.Occluders = { MakeFuzzedTriangle(scene, seed, FuzzedKind::Nasty) };
        more.Surfaces.push_back(only.Make().Surfaces.back());
      }
      return Deviation{ GetExcess(BakeReceiver(more).Texels, Bake(scene)), 0.0 };
    });
}

// Each light's part is the same with and without others, and a sum of floats with one term more is
// not smaller. Which side is lit must not depend on the lights.
TEST_P(FuzzScenes, ALightNeverDarkens)
{
  constexpr unsigned count = 500;
  ExpectProperty("darker with a light more", FuzzedKind::Nasty, this->GetFirst(4, count), count,
    [](FuzzedScene scene, unsigned)
    {
      if (scene.Settings.Side == penumbra::ReceiverSide::Auto)
      {
        scene.Settings.Side = penumbra::ReceiverSide::Front;
      }
      FuzzedScene less = scene;
      if (!less.Lights.empty())
      {
        less.Lights.pop_back();
      }
      return Deviation{ GetExcess(Bake(less), Bake(scene)), 0.0 };
    });
}

// To a power of two, nothing is rounded otherwise.
TEST_P(FuzzScenes, LinearInTheRadianceOfAllLights)
{
  constexpr unsigned count = 500;
  ExpectProperty("off by a factor of all radiances", FuzzedKind::Tame, this->GetFirst(5, count),
    count,
    [](const FuzzedScene& scene, unsigned)
    {
      constexpr float factor = 8.0f;
      FuzzedScene bright = scene;
      for (FuzzedLight& light : bright.Lights)
      {
        light.Settings.Radiance *= static_cast<double>(factor);
      }
      Texels texels = Bake(scene);
      for (glm::vec4& t : texels.Irradiance)
      {
        t *= factor;
      }
      const Texels scaled = Bake(bright);
      return Deviation{ std::max(GetExcess(texels, scaled), GetExcess(scaled, texels)), 0.0 };
    });
}

/**
 * The sum of bakes with one light each is the bake with all: both add the same floats, the bake in
 * the order of the lights' keys. A sum of n terms that are not negative is off by at most n
 * roundings of itself, whatever the order; here both are, and this test adds in double.
 */
TEST_P(FuzzScenes, LightsAddUp)
{
  constexpr unsigned count = 300;
  ExpectProperty("off the sum of the lights' bakes", FuzzedKind::Tame, this->GetFirst(6, count),
    count,
    [](FuzzedScene scene, unsigned)
    {
      scene.Settings.Supersampling = 1; // its filter has roundings of its own
      const Texels all = Bake(scene);
      std::vector<glm::dvec3> sums(all.Irradiance.size(), glm::dvec3(0.0));
      for (const FuzzedLight& light : scene.Lights)
      {
        FuzzedScene one = scene;
        one.Lights = { light };
        const Texels texels = Bake(one);
        for (std::size_t i = 0; i < sums.size(); ++i)
        {
          sums[i] += glm::dvec3(texels.Irradiance[i]);
        }
      }
      Deviation result{ 0.0, static_cast<double>(scene.Lights.size()) * FloatRounding };
      for (std::size_t i = 0; i < sums.size(); ++i)
      {
        const glm::dvec3 off = glm::abs(glm::dvec3(all.Irradiance[i]) - sums[i]);
        const glm::dvec3 size = glm::max(sums[i], static_cast<double>(FLT_MIN));
        result.Error = std::max({ result.Error, off.x / size.x, off.y / size.y, off.z / size.z });
      }
      return result;
    });
}

INSTANTIATE_TEST_SUITE_P(Shards, FuzzScenes, testing::Range(0u, 2u));

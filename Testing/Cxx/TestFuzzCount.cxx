// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What holds for every scene up to the rounding of floats and to rays that no rasteriser has to
// decide: those that pass an edge by less than 1/128 of a texel (SampledVisibility).

#include "FuzzCount.h"
#include "FuzzProperty.h"
#include "RandomGeometry.h"
#include "SamplingPattern.h"
#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace
{

class FuzzCount : public testing::TestWithParam<unsigned>
{
protected:
  /// Each property has scenes of its own.
  unsigned GetFirst(unsigned property, unsigned count) const
  {
    return 100000 * property + this->GetParam() * count;
  }
};

using Texels = std::vector<glm::vec4>;

Texels Bake(const penumbra::ShadowScene& scene)
{
  return BakeReceiver(scene).Texels.Irradiance;
}

/// How far texels are beyond what the count says, of its peak.
double GetError(const Texels& texels, const ExactCount& count)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < texels.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double value = texels[i][c];
      if (!std::isfinite(value))
      {
        return std::numeric_limits<double>::quiet_NaN();
      }
      largest = std::max({ largest, count.Low[i][c] - value, value - count.High[i][c] });
    }
  }
  return largest / std::max(count.Peak, static_cast<double>(FLT_MIN));
}

Deviation CompareWithCount(const FuzzedScene& scene)
{
  return { GetError(Bake(scene.Make()), CountExactly(scene)),
    GetRadianceBound(scene.Settings.GetSampleCount()) };
}

glm::dmat4 MakeMotion(unsigned seed)
{
  RandomGeometry random(seed);
  const glm::dvec3 by = random.InBox(3.0), axis = random.Direction();
  return glm::rotate(glm::translate(glm::dmat4(1.0), by), random.Between(0.0, 6.0), axis);
}

penumbra::ShadowScene Move(penumbra::ShadowScene scene, const glm::dmat4& motion)
{
  const auto move = [&](glm::dvec3& p) { p = glm::dvec3(motion * glm::dvec4(p, 1.0)); };
  for (penumbra::SharedSurface& shared : scene.Surfaces)
  {
    penumbra::Surface surface = *shared;
    std::for_each(surface.Points.begin(), surface.Points.end(), move);
    shared = surface;
  }
  penumbra::Parallelogram& base = scene.Receivers.front().Base;
  move(base.Corner);
  base.EdgeX = glm::dmat3(motion) * base.EdgeX;
  base.EdgeY = glm::dmat3(motion) * base.EdgeY;
  for (penumbra::Light& light : scene.Lights)
  {
    light = penumbra::Light(light->Transform(motion));
  }
  return scene;
}

/// The user's points are moved instead of an actor.
std::vector<penumbra::Light> MoveByPoints(std::vector<FuzzedLight> lights, const glm::dmat4& motion)
{
  const auto move = [&](glm::dvec3& p) { p = glm::dvec3(motion * glm::dvec4(p, 1.0)); };
  std::vector<penumbra::Light> moved;
  for (FuzzedLight& light : lights)
  {
    move(light.Settings.Origin);
    move(light.Settings.Point1);
    move(light.Settings.Point2);
    for (FuzzedCell& cell : light.Cells)
    {
      std::for_each(cell.Vertices.begin(), cell.Vertices.end(), move);
    }
    moved.push_back(light.Make());
  }
  return moved;
}

/// Each triangle as four: three around a point within, one of them halved.
FuzzedScene Split(FuzzedScene scene, unsigned seed)
{
  RandomGeometry random(seed);
  std::vector<FuzzedTriangle> parts;
  for (const auto& [a, b, c] : scene.Occluders)
  {
    const double u = random.Between(0.1, 0.5), v = random.Between(0.1, 0.4);
    const glm::dvec3 inside = a + u * (b - a) + v * (c - a);
    const glm::dvec3 middle = 0.5 * (a + b);
    parts.insert(parts.end(),
      { { a, middle, inside }, { middle, b, inside }, { b, c, inside }, { c, a, inside } });
  }
  scene.Occluders = parts;
  return scene;
}

} // namespace

TEST_P(FuzzCount, ExactCount)
{
  constexpr unsigned count = 400;
  ExpectProperty("beyond the exact count", FuzzedKind::NastyOccluders, this->GetFirst(11, count),
    count,
    [](const FuzzedScene& scene, unsigned) { return CompareWithCount(WithoutFilters(scene)); });
}

// Before and after, a bake is within what the count of the scene as it was allows: only rays that
// are open may change. The pattern must not depend on a light's aspect, which rounds.
TEST_P(FuzzCount, RigidMotion)
{
  constexpr unsigned count = 300;
  ExpectProperty("changed by a motion", FuzzedKind::NastyOccluders, this->GetFirst(12, count),
    count,
    [](FuzzedScene scene, unsigned seed)
    {
      scene = WithoutFilters(scene);
      scene.Settings.SamplingPattern = 0;
      const glm::dmat4 motion = MakeMotion(seed);
      penumbra::ShadowScene moved = Move(scene.Make(), motion);
      if (seed % 2 == 0)
      {
        moved.Lights = MoveByPoints(scene.Lights, motion);
      }
      return Deviation{ GetError(Bake(moved), CountExactly(scene)),
        GetRadianceBound(scene.Settings.GetSampleCount()) };
    });
}

// The edges between the parts are shared: rasterisers leave no gap, and none of their rays is open.
TEST_P(FuzzCount, SplitTriangles)
{
  constexpr unsigned count = 300;
  ExpectProperty("changed by splitting triangles", FuzzedKind::NastyOccluders,
    this->GetFirst(13, count), count,
    [](FuzzedScene scene, unsigned seed)
    {
      scene = WithoutFilters(scene);
      return Deviation{ GetError(Bake(Split(scene, seed).Make()), CountExactly(scene)),
        GetRadianceBound(scene.Settings.GetSampleCount()) };
    });
}

namespace
{

/// A lamp as a receiver, lit by the receiver as a lamp: what either sends the other is the same.
struct Pair
{
  FuzzedScene Lit;       ///< the scene's receiver, lit by the lamp
  FuzzedScene LampIsLit; ///< the lamp as a receiver, lit by the scene's
};

/// The texels of a lamp that are the cells of its uniform grid.
glm::ivec2 GetGrid(const penumbra::Light& lamp, int samples)
{
  const double aspect = lamp->GetAspect();
  const int columns =
    static_cast<int>(std::lround(std::clamp(std::sqrt(samples * aspect), 1.0, double(samples))));
  return { columns, (samples + columns - 1) / columns };
}

FuzzedLight MakeLamp(const penumbra::Parallelogram& base)
{
  FuzzedLight lamp;
  lamp.Settings.Origin = base.Corner;
  lamp.Settings.Point1 = base.Corner + base.EdgeX;
  lamp.Settings.Point2 = base.Corner + base.EdgeY;
  return lamp;
}

/// The receiver of a scene, and over it a lamp that faces it, wholly in front, as it is of the
/// lamp.
Pair MakePair(FuzzedScene scene, unsigned seed)
{
  constexpr int uniformGrid = 3;
  RandomGeometry random(seed);
  const penumbra::ReceiverFrame frame(scene.Base, penumbra::ReceiverFrame::Side::Front);
  const double size = frame.GetSize();
  penumbra::Parallelogram& base = scene.Base;
  const double u = random.Between(-0.3, 0.8), v = random.Between(-0.3, 0.8);
  const glm::dvec3 up = frame.GetNormal();
  const glm::dvec3 x = glm::normalize(base.EdgeX), y = glm::cross(up, x);
  // Less than 1 in 8 down over its length, at least half its size above the receiver.
  const auto tilted = [&](const glm::dvec3& edge)
  { return edge + random.Between(-0.1, 0.1) * glm::length(edge) * up; };
  penumbra::Parallelogram lamp;
  lamp.Corner =
    base.Corner + u * base.EdgeX + v * base.EdgeY + random.Between(1.0, 3.0) * size * up;
  lamp.EdgeX = tilted(size * random.Between(0.2, 0.8) * (y + random.Between(-0.5, 0.5) * x));
  lamp.EdgeY = tilted(size * random.Between(0.2, 0.8) * x);

  scene.Settings.SamplingPattern = uniformGrid;
  scene.Settings.Side = penumbra::ReceiverSide::Front;
  scene.Lights = { MakeLamp(lamp) };
  Pair pair{ WithoutFilters(scene), WithoutFilters(scene) };
  pair.LampIsLit.Base = lamp;
  pair.LampIsLit.Lights = { MakeLamp(base) };
  // Each samples the other at the centres of its texels.
  pair.Lit.Texels = GetGrid(pair.LampIsLit.Lights[0].Make(), scene.Settings.LightSamples);
  pair.LampIsLit.Texels = GetGrid(pair.Lit.Lights[0].Make(), scene.Settings.LightSamples);
  return pair;
}

/// An integral over a receiver.
struct Integral
{
  double Sum = 0.0;
  double Open = 0.0;     ///< how much of it open rays leave undecided
  double Rounding = 0.0; ///< how much of it may be the roundings of floats
};

/// The sum over all texels of their area times their irradiance, as the samples alone have it: the
/// bake's closed form is divided out, and the samples' mean put in its place.
Integral IntegrateSamples(const FuzzedScene& scene)
{
  const penumbra::ShadowScene made = scene.Make();
  const Texels texels = Bake(made);
  const ExactCount count = CountExactly(scene);
  const penumbra::Light& light = made.Lights.front();
  const penumbra::ReceiverFrame frame = made.MakeFrame(made.Receivers.front());
  const std::vector<penumbra::LightSample> samples =
    light->TakeSamples(penumbra::GetSamplingPatterns()[3].Generate(
      scene.Settings.LightSamples, 0, light->GetAspect()));
  const double area = frame.GetSize() * frame.GetSize() / (scene.Texels.x * scene.Texels.y);
  const double rounding = count.Peak * GetRadianceBound(scene.Settings.LightSamples);
  Integral result;
  for (int i = 0; i < scene.Texels.x * scene.Texels.y; ++i)
  {
    const glm::dvec2 uv =
      (glm::dvec2(i % scene.Texels.x, i / scene.Texels.x) + 0.5) / glm::dvec2(scene.Texels);
    const glm::dvec3 x = frame.ToWorld({ uv, 0.0 });
    double mean = 0.0;
    for (const penumbra::LightSample& sample : samples)
    {
      const glm::dvec3 d = sample.Place - x;
      const double r2 = glm::dot(d, d);
      mean += glm::dot(frame.GetNormal(), d) * std::abs(glm::dot(light->GetAxis(), d)) / (r2 * r2) *
        light->GetMeasure() / (glm::pi<double>() * static_cast<double>(samples.size()));
    }
    const double factor = area * mean / light->FormFactor(x, frame.GetNormal());
    const auto texel = static_cast<std::size_t>(i);
    result.Sum += factor * static_cast<double>(texels[texel].r);
    result.Open += factor * (count.High[texel].r - count.Low[texel].r);
    result.Rounding += factor * rounding;
  }
  return result;
}

} // namespace

/**
 * What a surface A gets of B is what B gets of A: the integral over both of cosines over pi r^2,
 * where they see each other. With the texels of each at the samples of the other, both bakes take
 * the same sum over the same rays, but for the closed form that each puts in place of its samples'
 * mean; that is divided out in double. What is left are rays that are open on either side, and the
 * roundings of every texel.
 */
TEST_P(FuzzCount, Reciprocity)
{
  constexpr unsigned count = 200;
  ExpectProperty("not reciprocal, beyond open rays", FuzzedKind::NastyOccluders,
    this->GetFirst(14, count), count,
    [](const FuzzedScene& scene, unsigned seed)
    {
      const Pair pair = MakePair(scene, seed);
      const Integral lit = IntegrateSamples(pair.Lit), lamp = IntegrateSamples(pair.LampIsLit);
      const double off = std::abs(lit.Sum - lamp.Sum) - lit.Open - lamp.Open;
      const double size = std::max({ lit.Sum, lamp.Sum, static_cast<double>(FLT_MIN) });
      return Deviation{ std::max(off, 0.0) / size, (lit.Rounding + lamp.Rounding) / size };
    });
}

INSTANTIATE_TEST_SUITE_P(Shards, FuzzCount, testing::Range(0u, 2u));

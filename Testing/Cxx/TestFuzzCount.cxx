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
  unsigned GetFirst(unsigned count) const { return 1 + this->GetParam() * count; }
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
  for (penumbra::Surface& surface : scene.Surfaces)
  {
    std::for_each(surface.Points.begin(), surface.Points.end(), move);
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
  ExpectProperty("beyond the exact count", FuzzedKind::Tame, this->GetFirst(count), count,
    [](const FuzzedScene& scene, unsigned) { return CompareWithCount(WithoutFilters(scene)); });
}

// Before and after, a bake is within what the count of the scene as it was allows: only rays that
// are open may change. The pattern must not depend on a light's aspect, which rounds.
TEST_P(FuzzCount, RigidMotion)
{
  constexpr unsigned count = 300;
  ExpectProperty("changed by a motion", FuzzedKind::Tame, this->GetFirst(count), count,
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
  ExpectProperty("changed by splitting triangles", FuzzedKind::Tame, this->GetFirst(count), count,
    [](FuzzedScene scene, unsigned seed)
    {
      scene = WithoutFilters(scene);
      return Deviation{ GetError(Bake(Split(scene, seed).Make()), CountExactly(scene)),
        GetRadianceBound(scene.Settings.GetSampleCount()) };
    });
}

INSTANTIATE_TEST_SUITE_P(Shards, FuzzCount, testing::Range(0u, 2u));

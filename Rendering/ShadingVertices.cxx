// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShadingVertices.h"

#include <algorithm>
#include <vector>

namespace penumbra
{
namespace
{

constexpr int MostVertices = 33;

/// What arrives at the vertices of a grid, and in the last component what is blocked, in the mean.
std::vector<glm::dvec4> EvaluateGrid(const ReceiverPlan& plan, int side)
{
  std::vector<glm::dvec4> values;
  for (int i = 0; i < side * side; ++i)
  {
    const glm::dvec2 uv = glm::dvec2(i % side, i / side) / static_cast<double>(side - 1);
    glm::dvec4 value(0.0);
    for (std::size_t l = 0; l < plan.Lights.size(); ++l)
    {
      const Effect effect = plan.Pairs[l].Needed;
      if (effect != Effect::None)
      {
        const glm::dvec3 light =
          plan.Lights[l]->Irradiance(plan.Frame.ToWorld({ uv, 0.0 }), plan.Frame.GetNormal());
        value += effect == Effect::Umbra
          ? glm::dvec4(0.0, 0.0, 0.0, (light.x + light.y + light.z) / 3.0)
          : glm::dvec4(light, 0.0);
      }
    }
    values.push_back(value);
  }
  return values;
}

double GetLargest(const glm::dvec4& v)
{
  return std::max({ v.x, v.y, v.z, v.w });
}

/// By how much the points of a grid differ from interpolation between every second one.
double FindDeviation(const std::vector<glm::dvec4>& grid, int side)
{
  double largest = 0.0;
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * side + i)]; };
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const int left = i - i % 2, right = i + i % 2, low = j - j % 2, high = j + j % 2;
      const glm::dvec4 mean =
        0.25 * (at(left, low) + at(right, low) + at(left, high) + at(right, high));
      largest = std::max(largest, GetLargest(glm::abs(at(i, j) - mean)));
    }
  }
  return largest;
}

} // namespace

bool IsSmooth(const ReceiverPlan& plan)
{
  return std::none_of(plan.Pairs.begin(), plan.Pairs.end(),
    [](const PairPlan& pair)
    { return pair.Needed == Effect::Soft || pair.Needed == Effect::Hard; });
}

bool IsUnshadowed(const ReceiverPlan& plan)
{
  return std::all_of(plan.Pairs.begin(), plan.Pairs.end(),
    [](const PairPlan& pair)
    { return pair.Needed == Effect::None || pair.Needed == Effect::Unoccluded; });
}

bool IsPlain(const ReceiverPlan& plan, const ReceiverSettings& settings)
{
  const auto isGrey = [](const glm::dvec3& v) { return v.x == v.y && v.x == v.z; };
  bool isPlain = IsUnshadowed(plan) && isGrey(settings.AmbientRadiance);
  for (std::size_t i = 0; i < plan.Lights.size() && isPlain; ++i)
  {
    const std::vector<EmittingPolygon> polygons = plan.Lights[i]->GetPolygons();
    const bool areGrey = polygons.empty()
      ? isGrey(plan.Lights[i]->Radiance)
      : std::all_of(polygons.begin(), polygons.end(),
          [&](const EmittingPolygon& polygon) { return isGrey(polygon.Radiance); });
    isPlain = plan.Pairs[i].Needed == Effect::None || areGrey;
  }
  return isPlain;
}

int CountShadingVertices(const ReceiverPlan& plan, const ReceiverSettings& settings)
{
  if (!IsSmooth(plan) || !settings.Planner || settings.PlannerTolerance <= 0.0)
  {
    return 0;
  }
  for (int vertices = 2; vertices <= MostVertices; vertices = 2 * vertices - 1)
  {
    const int side = 2 * vertices - 1;
    const std::vector<glm::dvec4> grid = EvaluateGrid(plan, side);
    double peak = 0.0;
    for (const glm::dvec4& value : grid)
    {
      peak = std::max(peak, GetLargest(value));
    }
    if (FindDeviation(grid, side) <= 0.5 * settings.PlannerTolerance * peak)
    {
      return vertices;
    }
  }
  return 0;
}

ReceiverPlan PlanVertices(const ReceiverPlan& plan, int vertices)
{
  ReceiverPlan result = plan;
  Parallelogram base = plan.Frame.GetBase();
  const bool isFront = glm::dot(glm::cross(base.EdgeX, base.EdgeY), plan.Frame.GetNormal()) > 0.0;
  const double steps = vertices - 1;
  base.Corner -= 0.5 / steps * (base.EdgeX + base.EdgeY);
  base.EdgeX *= vertices / steps;
  base.EdgeY *= vertices / steps;
  result.Frame =
    ReceiverFrame(base, isFront ? ReceiverFrame::Side::Front : ReceiverFrame::Side::Back);
  result.Texels = glm::ivec2(vertices);
  result.Supersampling = 1;
  return result;
}

} // namespace penumbra

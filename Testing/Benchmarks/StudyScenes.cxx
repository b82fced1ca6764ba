// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "StudyScenes.h"

#include "Spheres.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

namespace
{

/// A light that faces down, centred, turned about the vertical by an angle in radians.
penumbra::Parallelogram MakeLight(
  const glm::dvec3& centre, double width, double depth, double angle)
{
  const glm::dvec3 x = width * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
  const glm::dvec3 y = depth * glm::dvec3(std::sin(angle), -std::cos(angle), 0.0);
  return { centre - 0.5 * (x + y), x, y };
}

StudyScene MakeScene(
  const std::string& name, const std::string& title, const penumbra::Parallelogram& light)
{
  StudyScene scene;
  scene.Name = name;
  scene.Title = title;
  scene.Light = light;
  scene.Exact.Name = name;
  scene.Exact.AddLight(light.Corner, light.Corner + light.EdgeX, light.Corner + light.EdgeY);
  return scene;
}

/// Adds occluders turned about the vertical axis through the origin by an angle in radians.
void AddTurned(TestScene& scene, const TestScene& occluders, double angle)
{
  const long double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const oracle::Vec3& v)
  {
    // Rounded to double, so that the oracle and the bake get the same.
    return oracle::Vec3{ static_cast<double>(c * v.X - s * v.Y),
      static_cast<double>(s * v.X + c * v.Y), v.Z };
  };
  for (const oracle::Triangle& t : occluders.Occluders)
  {
    scene.Occluders.push_back({ turn(t.A), turn(t.B), turn(t.C) });
  }
}

/// Calls the function with 0 ... rows - 1, on all cores.
void ForEachRow(int rows, const std::function<void(int)>& function)
{
  std::atomic<int> next{ 0 };
  std::vector<std::thread> threads;
  for (unsigned int i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
  {
    threads.emplace_back(
      [&]
      {
        for (int row = next++; row < rows; row = next++)
        {
          function(row);
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

/// What the oracle takes of a scene.
struct ExactScene
{
  penumbra::Parallelogram Base;
  oracle::Vec3 Normal;
  oracle::Light Light;
  const std::vector<oracle::Triangle>& Occluders;

  explicit ExactScene(const StudyScene& scene);
  double GetIrradiance(double u, double v) const;
};

oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

ExactScene::ExactScene(const StudyScene& scene)
  : Base(scene.Exact.Base)
  , Normal(ToOracle(glm::cross(scene.Exact.Base.EdgeX, scene.Exact.Base.EdgeY)))
  , Occluders(scene.Exact.Occluders)
{
  const penumbra::Parallelogram& light = scene.Light;
  this->Light.Vertices = oracle::Parallelogram(ToOracle(light.Corner),
    ToOracle(light.Corner + light.EdgeX), ToOracle(light.Corner + light.EdgeY));
}

double ExactScene::GetIrradiance(double u, double v) const
{
  const glm::dvec3 x = this->Base.Corner + u * this->Base.EdgeX + v * this->Base.EdgeY;
  return static_cast<double>(
    oracle::VisibleFormFactor(ToOracle(x), this->Normal, this->Light, this->Occluders));
}

// Of the peak. A smooth penumbra passes, an edge does not.
constexpr double LargestContrast = 0.02;
constexpr int Divisions = 5;

/// The mean over the square with the given low corner and side.
double GetMean(
  const ExactScene& scene, double peak, const glm::dvec2& low, double side, int divisions)
{
  const double gauss = 0.5 / std::sqrt(3.0);
  std::array<double, 4> values;
  for (std::size_t i = 0; i < 4; ++i)
  {
    values[i] = scene.GetIrradiance(low.x + side * (0.5 + (i % 2 == 0 ? -gauss : gauss)),
      low.y + side * (0.5 + (i / 2 == 0 ? -gauss : gauss)));
  }
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  if (divisions == 0 || *greatest - *least <= LargestContrast * peak)
  {
    return (values[0] + values[1] + values[2] + values[3]) / 4;
  }
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    const glm::dvec2 corner = low + 0.5 * side * glm::dvec2(i % 2, i / 2);
    sum += GetMean(scene, peak, corner, 0.5 * side, divisions - 1);
  }
  return sum / 4;
}

} // namespace

StudyScene MakeContactScene()
{
  StudyScene scene = MakeScene(
    "contact", "Contact: a box on the floor", MakeLight({ -0.9, 0.7, 3.0 }, 0.24, 0.2, 0.4));
  TestScene box;
  box.AddBox({ -0.5, -0.4, 0.0 }, { 0.4, 0.5, 0.8 });
  AddTurned(scene.Exact, box, 0.13);
  scene.Baked = scene.Exact.MakeScene();
  return scene;
}

StudyScene MakePenumbraScene()
{
  StudyScene scene = MakeScene(
    "penumbra", "Penumbra: a table, a wide light", MakeLight({ 0.3, 0.2, 2.2 }, 1.4, 1.2, 0.4));
  TestScene table;
  table.AddBox({ -0.8, -0.6, 0.70 }, { 0.8, 0.6, 0.76 });
  for (const double x : { -0.76, 0.70 })
  {
    for (const double y : { -0.56, 0.50 })
    {
      table.AddBox({ x, y, 0.0 }, { x + 0.06, y + 0.06, 0.70 });
    }
  }
  AddTurned(scene.Exact, table, -0.21);
  scene.Baked = scene.Exact.MakeScene();
  return scene;
}

StudyScene MakeOverlapScene()
{
  constexpr int Rows = 6;
  StudyScene scene = MakeScene(
    "overlap", "Overlap: 36 plates at six heights", MakeLight({ 0.1, -0.1, 3.0 }, 1.0, 0.9, 0.4));
  TestScene plates;
  for (int j = 0; j < Rows; ++j)
  {
    for (int i = 0; i < Rows; ++i)
    {
      // No two neighbours at the same height, and tilts of all signs.
      const double height = 0.3 + 0.15 * ((7 * i + 3 * j) % Rows);
      plates.AddPlate({ 0.5 * i - 1.5, 0.5 * j - 1.5, height },
        { 0.22, 0.05 * ((i + j) % 3), 0.03 }, { -0.03, 0.2, 0.02 * (i % 3) });
    }
  }
  AddTurned(scene.Exact, plates, 0.0);
  scene.Baked = scene.Exact.MakeScene();
  return scene;
}

StudyScene MakeSpheresScene(int rings)
{
  StudyScene scene = MakeScene("spheres", "Spheres: 12, tessellated",
    { { 4.0, 4.0, 8.0 }, { 0.0, 2.0, 0.0 }, { 2.0, 0.0, 0.0 } });
  scene.Exact.Base = { glm::dvec3(0.0), { 10.0, 0.0, 0.0 }, { 0.0, 10.0, 0.0 } };
  const penumbra::Surface spheres = MakeSpheres(rings);
  for (const penumbra::Surface::Triangle& t : spheres.Triangles)
  {
    scene.Exact.Occluders.push_back({ ToOracle(spheres.Points[t[0]]),
      ToOracle(spheres.Points[t[1]]), ToOracle(spheres.Points[t[2]]) });
  }
  // The bake gets triangles that share their corners.
  scene.Baked = scene.Exact.MakeScene();
  scene.Baked.Surfaces[1] = spheres;
  return scene;
}

std::vector<double> GetExactCentres(const StudyScene& scene, int texels)
{
  const ExactScene exact(scene);
  std::vector<double> centres(static_cast<std::size_t>(texels * texels));
  ForEachRow(texels,
    [&](int j)
    {
      for (int i = 0; i < texels; ++i)
      {
        centres[static_cast<std::size_t>(j * texels + i)] =
          exact.GetIrradiance((i + 0.5) / texels, (j + 0.5) / texels);
      }
    });
  return centres;
}

std::vector<double> GetExactAverages(const StudyScene& scene, int cells)
{
  const std::vector<double> centres = GetExactCentres(scene, cells);
  const double peak = *std::max_element(centres.begin(), centres.end());
  const ExactScene exact(scene);
  std::vector<double> averages(centres.size());
  ForEachRow(cells,
    [&](int j)
    {
      for (int i = 0; i < cells; ++i)
      {
        averages[static_cast<std::size_t>(j * cells + i)] = GetMean(
          exact, peak, glm::dvec2(i, j) / static_cast<double>(cells), 1.0 / cells, Divisions);
      }
    });
  return averages;
}

std::vector<double> MergeCells(const std::vector<double>& averages, int texels)
{
  const int cells = static_cast<int>(std::lround(std::sqrt(static_cast<double>(averages.size()))));
  const int factor = cells / texels;
  std::vector<double> merged(static_cast<std::size_t>(texels * texels));
  for (int j = 0; j < cells; ++j)
  {
    for (int i = 0; i < cells; ++i)
    {
      merged[static_cast<std::size_t>(j / factor * texels + i / factor)] +=
        averages[static_cast<std::size_t>(j * cells + i)] / (factor * factor);
    }
  }
  return merged;
}

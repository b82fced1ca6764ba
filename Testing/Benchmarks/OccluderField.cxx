// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// How the cost of one receiver grows with the number of objects in the scene: H&H 1997, section
// 3.9, hope for s^0.3. See README.md.

#include "BenchmarkTools.h"
#include "BlockingRegion.h"
#include "OccluderSelector.h"
#include "PolygonLight.h"
#include "RandomGeometry.h"
#include "ShadowScene.h"

#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace
{

/// How much is done.
struct Plan
{
  int Texels = 256; ///< along each side of the receiver
  int Samples = 64;
  int Runs = 5;
  std::vector<int> Objects{ 100, 1000, 10000, 100000 };
  bool JudgesTimes = true;
};

/// CI's: enough for counts, too little for times.
Plan MakeSmallestPlan()
{
  return { 32, 8, 1, { 100, 1000 }, false };
}

/// What stays the same while objects are added.
enum class Fixed
{
  Density, ///< one object on each unit of area: the plain grows
  Extent   ///< the field's: objects shrink, as their distances do
};

/// How the scene has the objects.
enum class Layout
{
  OneSurface,
  ManySurfaces ///< each object is one
};

// ---- The scene ----

/// The receiver, around the origin.
constexpr double TileEdge = 4.0;
/// The field of a hundred objects, and of any number where the extent is fixed. All that can block
/// is in it.
constexpr double FieldEdge = 10.0;

/// Each object has a cell of a square grid.
double GetCellEdge(int objects, Fixed fixed)
{
  return fixed == Fixed::Density ? 1.0 : FieldEdge / std::sqrt(objects);
}

/// The first cells of a spiral around (0, 0): at any number, they fill about a square.
std::vector<glm::dvec2> MakeSpiral(std::size_t count)
{
  std::vector<glm::dvec2> cells;
  glm::dvec2 cell(0.0), step(1.0, 0.0);
  for (int length = 1; cells.size() < count; ++length)
  {
    for (int i = 0; i < 2 * length; ++i)
    {
      cells.push_back(cell);
      cell += step;
      if (i % length == length - 1)
      {
        step = { -step.y, step.x };
      }
    }
  }
  cells.resize(count);
  return cells;
}

/// A box on the plain in the cell around `middle`, turned at random: 12 triangles.
penumbra::Surface MakeBox(const glm::dvec2& middle, double cellEdge, RandomGeometry& random)
{
  const glm::dvec2 halfSize(random.Between(0.1, 0.25), random.Between(0.1, 0.25));
  const double height = random.Between(0.3, 1.5);
  const double angle = random.Between(0.0, std::acos(-1.0));
  const double room = 0.5 - glm::length(halfSize);
  const glm::dvec2 place(random.Between(-room, room), random.Between(-room, room));
  const glm::dvec2 axisX(std::cos(angle), std::sin(angle)), axisY(-axisX.y, axisX.x);
  penumbra::Surface box;
  for (int corner = 0; corner < 8; ++corner)
  {
    const double x = corner & 1 ? halfSize.x : -halfSize.x;
    const double y = corner & 2 ? halfSize.y : -halfSize.y;
    const glm::dvec2 p = middle + cellEdge * (place + x * axisX + y * axisY);
    box.Points.push_back({ p, corner & 4 ? cellEdge * height : 0.0 });
  }
  box.Triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
    { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  return box;
}

/// Boxes in no order: neighbours in the field are not neighbours in memory.
std::vector<penumbra::Surface> MakeBoxes(int count, Fixed fixed)
{
  const double cellEdge = GetCellEdge(count, fixed);
  RandomGeometry random(1);
  std::vector<penumbra::Surface> boxes;
  for (const glm::dvec2& cell : MakeSpiral(static_cast<std::size_t>(count)))
  {
    boxes.push_back(MakeBox(cellEdge * cell, cellEdge, random));
  }
  random.Shuffle(boxes);
  return boxes;
}

penumbra::Surface Join(const std::vector<penumbra::Surface>& boxes)
{
  penumbra::Surface all;
  for (const penumbra::Surface& box : boxes)
  {
    const auto first = static_cast<std::uint32_t>(all.Points.size());
    all.Points.insert(all.Points.end(), box.Points.begin(), box.Points.end());
    for (const auto& [a, b, c] : box.Triangles)
    {
      all.Triangles.push_back({ first + a, first + b, first + c });
    }
  }
  return all;
}

/// The receiver, a tile of the plain, with the plain's other eight parts around it.
penumbra::Surface MakePlain(double edge)
{
  constexpr std::uint32_t Side = 4;
  const double lines[Side] = { -0.5 * edge, -0.5 * TileEdge, 0.5 * TileEdge, 0.5 * edge };
  penumbra::Surface plain;
  for (std::uint32_t i = 0; i < Side * Side; ++i)
  {
    plain.Points.push_back({ lines[i % Side], lines[i / Side], 0.0 });
  }
  for (std::uint32_t j = 0; j + 1 < Side; ++j)
  {
    for (std::uint32_t i = 0; i + 1 < Side; ++i)
    {
      const std::uint32_t first = Side * j + i;
      const int region = i == 1 && j == 1 ? 0 : 1;
      plain.Triangles.push_back({ first, first + 1, first + Side });
      plain.Triangles.push_back({ first + 1, first + Side + 1, first + Side });
      plain.Regions.insert(plain.Regions.end(), { region, region });
    }
  }
  return plain;
}

/// Without the boxes. The light of 2 x 2 stands aside, so that rays slant.
penumbra::ShadowScene MakeScene(const Plan& plan, int objects, Fixed fixed)
{
  penumbra::Receiver tile;
  tile.Base = { { -0.5 * TileEdge, -0.5 * TileEdge, 0.0 }, { TileEdge, 0.0, 0.0 },
    { 0.0, TileEdge, 0.0 } };
  tile.Settings.LightSamples = plan.Samples;
  tile.Texels = glm::ivec2(plan.Texels);
  // One cell more on each side, for the spiral's last turn.
  const double edge = GetCellEdge(objects, fixed) * (std::sqrt(objects) + 2.0);
  penumbra::ShadowScene scene;
  scene.Surfaces.emplace_back(MakePlain(edge));
  scene.Receivers = { tile };
  scene.Lights = { penumbra::PolygonLight::Parallelogram({ 1, 0, 6 }, { 1, 2, 6 }, { 3, 0, 6 }) };
  return scene;
}

// ---- Measuring ----

/**
 * Seconds of a call, of all processors together: what else the machine does hardly adds to it. As
 * many calls as the clock needs, and for short ones their data stay in the cache.
 */
template <typename Call>
double GetSeconds(const Call& call)
{
  constexpr double LongEnough = 0.01;
  for (int calls = 1;; calls *= 2)
  {
    const std::clock_t start = std::clock();
    for (int i = 0; i < calls; ++i)
    {
      call();
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (seconds >= LongEnough)
    {
      return seconds / calls;
    }
  }
}

template <typename Call>
double GetMedianSeconds(const Plan& plan, const Call& call)
{
  std::vector<double> seconds;
  for (int run = 0; run < plan.Runs; ++run)
  {
    seconds.push_back(GetSeconds(call));
  }
  return GetMedian(seconds);
}

/// What was found of one field.
struct Result
{
  int Objects = 0;
  Layout As = Layout::OneSurface;
  // Triangles that may block the light.
  std::size_t Selected = 0;
  std::size_t Planned = 0; ///< by the bake's report
  std::size_t Tested = 0;  ///< all triangles, one by one
  // Medians.
  double QuerySeconds = 0.0;
  double BakeSeconds = 0.0;
  double SurfaceTreesSeconds = 0.0; ///< of their triangles
  double SceneTreeSeconds = 0.0;    ///< of the surfaces
  double TestSeconds = 0.0;
};

/// The triangles that BlockingRegion finds among all of the boxes. Their bases lie in the receiver,
/// where they block nothing.
std::size_t CountByTesting(const std::vector<penumbra::Surface>& boxes,
  const penumbra::ReceiverFrame& frame, const penumbra::LightShape& seen)
{
  const penumbra::BlockingRegion region(frame, seen);
  std::size_t count = 0;
  for (const penumbra::Surface& box : boxes)
  {
    for (const auto& [i, j, k] : box.Triangles)
    {
      const glm::dvec3 a = frame.ToFrame(box.Points[i]);
      const glm::dvec3 b = frame.ToFrame(box.Points[j]);
      const glm::dvec3 c = frame.ToFrame(box.Points[k]);
      count += std::max({ a.z, b.z, c.z }) > 0.0 && region.MayHold(a, b, c) ? 1 : 0;
    }
  }
  return count;
}

/// The query, the scene's tree, which it needs, and the same without trees.
void MeasureQuery(const Plan& plan, const penumbra::ShadowScene& scene,
  const std::vector<penumbra::Surface>& boxes, Result& result)
{
  const penumbra::Receiver& tile = scene.Receivers.front();
  const penumbra::ReceiverFrame frame = scene.MakeFrame(tile);
  const auto seen = scene.Lights.front()->Clip(frame.GetBase().Corner, frame.GetNormal());
  penumbra::OccluderSelector selector;
  result.SceneTreeSeconds = GetMedianSeconds(plan, [&]() { selector.SetScene(scene); });
  result.QuerySeconds = GetMedianSeconds(plan,
    [&]()
    {
      selector.SetReceiver(tile, frame);
      selector.Select(*seen);
    });
  result.Selected = selector.GetTriangles().size();
  result.TestSeconds =
    GetMedianSeconds(plan, [&]() { result.Tested = CountByTesting(boxes, frame, *seen); });
}

/// The planning and baking of the receiver, with all trees given.
bool MeasureBake(const Plan& plan, const penumbra::ShadowScene& scene, vtkRadianceBaker* baker,
  vtkOpenGLRenderWindow* window, Result& result)
{
  vtkOpenGLState* state = window->GetState();
  state->Push();
  vtkNew<vtkRadianceTexture> texture;
  const glm::ivec2 texels = scene.Receivers.front().Texels;
  bool isComplete = texture->Allocate(window, { texels });
  vtkRadianceBaker::Part whole;
  whole.Rectangle = penumbra::WholeRectangle(texels);
  const auto bake = [&]()
  {
    const auto report = baker->BakePart(baker->Plan(0), 0, window, texture, 0, whole);
    result.Planned = report.Pairs.front().Triangles;
    isComplete = isComplete && report.IsComplete;
  };
  baker->SetScene(scene);
  bake(); // untimed: shaders are compiled
  result.BakeSeconds = GetMedianSeconds(plan, bake);
  baker->ReleaseGraphicsResources();
  state->Pop();
  texture->ReleaseGraphicsResources();
  return isComplete;
}

bool Measure(const Plan& plan, int objects, Fixed fixed, Layout layout,
  vtkOpenGLRenderWindow* window, Result& result)
{
  result.Objects = objects;
  result.As = layout;
  std::vector<penumbra::Surface> surfaces = MakeBoxes(objects, fixed);
  if (layout == Layout::OneSurface)
  {
    surfaces = { Join(surfaces) };
  }
  result.SurfaceTreesSeconds = GetMedianSeconds(plan,
    [&]()
    {
      std::vector<penumbra::ClusterTree> trees;
      for (const penumbra::Surface& surface : surfaces)
      {
        trees.emplace_back(surface.Points, surface.Triangles);
      }
    });
  penumbra::ShadowScene scene = MakeScene(plan, objects, fixed);
  scene.Surfaces.insert(scene.Surfaces.end(), surfaces.begin(), surfaces.end());
  MeasureQuery(plan, scene, surfaces, result);
  vtkNew<vtkRadianceBaker> baker;
  return Require(MeasureBake(plan, scene, baker, window, result), "OpenGL must bake the receiver");
}

// ---- Tables ----

/// What has an exponent: its name in tables and in JSON, how it is printed, and how it is got.
struct Column
{
  const char* Title;
  const char* Key;
  double Scale; ///< of its unit
  int Digits;
  double (*Get)(const Result&);
};

const Column Columns[] = {
  { "selected triangles", "selected", 1.0, 6,
    [](const Result& r) { return static_cast<double>(r.Selected); } },
  { "query, ms", "querySeconds", 1e3, 4, [](const Result& r) { return r.QuerySeconds; } },
  { "bake, ms", "bakeSeconds", 1e3, 4, [](const Result& r) { return r.BakeSeconds; } },
  { "trees of surfaces, ms", "surfaceTreesSeconds", 1e3, 4,
    [](const Result& r) { return r.SurfaceTreesSeconds; } },
  { "tree of the scene, ms", "sceneTreeSeconds", 1e3, 4,
    [](const Result& r) { return r.SceneTreeSeconds; } },
  { "all triangles tested, ms", "testSeconds", 1e3, 4,
    [](const Result& r) { return r.TestSeconds; } },
};

constexpr Layout Layouts[] = { Layout::OneSurface, Layout::ManySurfaces };

const char* GetName(Layout layout)
{
  return layout == Layout::OneSurface ? "one surface" : "s surfaces";
}

/// The fields of one kind.
struct Table
{
  Fixed Kept = Fixed::Density;
  std::vector<Result> Results;

  const char* GetTitle() const
  {
    return this->Kept == Fixed::Density ? "fixed density" : "fixed extent";
  }

  /// The exponent of s that fits a column of a layout best: least squares in log-log.
  double FitExponent(const Column& column, Layout layout) const
  {
    double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const Result& r : this->Results)
    {
      if (r.As == layout)
      {
        const double logS = std::log(r.Objects), logValue = std::log(column.Get(r));
        count += 1.0;
        x += logS;
        y += logValue;
        xx += logS * logS;
        xy += logS * logValue;
      }
    }
    return (count * xy - x * y) / (count * xx - x * x);
  }
};

void PrintTable(const Plan& plan, const Table& table)
{
  std::printf("A field of %s, %d x %d texels, n = %d, medians of %d runs\n\n| objects | as |",
    table.GetTitle(), plan.Texels, plan.Texels, plan.Samples, plan.Runs);
  for (const Column& column : Columns)
  {
    std::printf(" %s |", column.Title);
  }
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  for (const Layout layout : Layouts)
  {
    for (const Result& r : table.Results)
    {
      if (r.As == layout)
      {
        std::printf("| %d | %s |", r.Objects, GetName(layout));
        for (const Column& column : Columns)
        {
          std::printf(" %.*g |", column.Digits, column.Scale * column.Get(r));
        }
        std::printf("\n");
      }
    }
    std::printf("| exponent | %s |", GetName(layout));
    for (const Column& column : Columns)
    {
      std::printf(" %.2f |", table.FitExponent(column, layout));
    }
    std::printf("\n");
  }
  std::printf("\n");
}

void WriteTable(std::ostream& file, const Table& table)
{
  file << "    { \"field\": \"" << table.GetTitle() << "\",\n      \"results\": [";
  const char* separator = "\n";
  for (const Result& r : table.Results)
  {
    file << separator << "        { \"objects\": " << r.Objects << ", \"as\": \"" << GetName(r.As)
         << "\"";
    for (const Column& column : Columns)
    {
      file << ", \"" << column.Key << "\": " << column.Get(r);
    }
    file << " }";
    separator = ",\n";
  }
  file << "\n      ],\n      \"exponents\": [";
  separator = "\n";
  for (const Layout layout : Layouts)
  {
    file << separator << "        { \"as\": \"" << GetName(layout) << "\"";
    for (const Column& column : Columns)
    {
      file << ", \"" << column.Key << "\": " << table.FitExponent(column, layout);
    }
    file << " }";
    separator = ",\n";
  }
  file << "\n      ] }";
}

bool WriteJson(const std::string& path, const Plan& plan, const std::vector<Table>& tables)
{
  std::ofstream file(path);
  file << "{\n  \"texels\": " << plan.Texels << ", \"samples\": " << plan.Samples
       << ", \"runs\": " << plan.Runs << ",\n  \"tables\": [";
  const char* separator = "\n";
  for (const Table& table : tables)
  {
    file << separator;
    WriteTable(file, table);
    separator = ",\n";
  }
  file << "\n  ]\n}\n";
  file.close();
  return !file.fail();
}

// ---- Judging ----

/// What H&H hope for.
constexpr double LargestExponent = 0.3;

bool Judge(const Plan& plan, const Table& table)
{
  bool good = true;
  const std::size_t first = table.Results.front().Selected;
  for (const Result& r : table.Results)
  {
    const std::string name = std::string(table.GetTitle()) + ", " + std::to_string(r.Objects) +
      " objects as " + GetName(r.As) + ": ";
    good &= Require(r.Selected > 0 && r.Selected == r.Tested,
      name + std::to_string(r.Selected) + " triangles were selected, but " +
        std::to_string(r.Tested) + " by testing all");
    good &= Require(r.Planned == r.Selected, name + "the bake must report what was selected");
    good &= Require(table.Kept != Fixed::Density || r.Selected == first,
      name + "the number of selected triangles must not grow");
  }
  for (const Layout layout : Layouts)
  {
    for (const Column& column : { Columns[1], Columns[2] })
    {
      good &= Require(!plan.JudgesTimes || table.Kept != Fixed::Density ||
          table.FitExponent(column, layout) <= LargestExponent,
        std::string(column.Key) + " as " + GetName(layout) + " must grow no faster than s^0.3");
    }
  }
  return good;
}

int Run(const Plan& plan, const std::string& jsonPath)
{
  const vtkSmartPointer<vtkOpenGLRenderWindow> window = MakeWindow();
  window->Render();
  if (!window->SupportsOpenGL())
  {
    std::fprintf(stderr, "OccluderField: no OpenGL: %s\n", window->ReportCapabilities());
    return 1;
  }
  bool good = true;
  std::vector<Table> tables;
  for (const Fixed fixed : { Fixed::Density, Fixed::Extent })
  {
    Table table{ fixed, {} };
    for (const int objects : plan.Objects)
    {
      for (const Layout layout : Layouts)
      {
        good &= Measure(plan, objects, fixed, layout, window, table.Results.emplace_back());
      }
    }
    PrintTable(plan, table);
    good &= Judge(plan, table);
    tables.push_back(std::move(table));
  }
  if (!jsonPath.empty() && !WriteJson(jsonPath, plan, tables))
  {
    std::fprintf(stderr, "OccluderField: cannot write %s\n", jsonPath.c_str());
    return 1;
  }
  return good ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  return RunBenchmark(argc, argv, "OccluderField", Plan(), MakeSmallestPlan(), Run);
}

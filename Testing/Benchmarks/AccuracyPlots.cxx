// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AccuracyPlots.h"

#include "ChartPage.h"

#include "vtkPen.h"
#include "vtkPlotPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

namespace
{

// Okabe and Ito 2008: colours that people with any kind of colour vision tell apart.
const vtkColor3ub Black(0, 0, 0);
const vtkColor3ub Orange(230, 159, 0);
const vtkColor3ub SkyBlue(86, 180, 233);
const vtkColor3ub Green(0, 158, 115);
const vtkColor3ub Yellow(240, 228, 66);
const vtkColor3ub Blue(0, 114, 178);
const vtkColor3ub Vermilion(213, 94, 0);
const vtkColor3ub Purple(204, 121, 167);

/// A curve of the measurements: who made it, what it is called, how it is drawn.
struct Maker
{
  std::string Technique, Pattern; ///< an empty pattern is any
  std::string Label;
  CurveStyle Style;
};

const std::vector<Maker>& GetMakers()
{
  static const std::vector<Maker> makers{
    { MasksName, "Random", "masks, random", { SkyBlue, vtkPlotPoints::CROSS } },
    { MasksName, "Uniform Grid", "masks, uniform grid", { Purple, vtkPlotPoints::PLUS } },
    { MasksName, "Jittered Grid", "masks, jittered grid", { Green, vtkPlotPoints::DIAMOND } },
    { MasksName, "Correlated Multi-Jittered", "masks, multi-jittered",
      { Orange, vtkPlotPoints::SQUARE } },
    { LiteralName, "", "literal loop, Sobol",
      { Vermilion, vtkPlotPoints::SQUARE, vtkPen::DASH_LINE } },
    { RaysName, "", "Embree, a Sobol set a texel",
      { Black, vtkPlotPoints::DIAMOND, vtkPen::DASH_LINE } },
    { MasksName, "Sobol", "masks, Sobol",
      { Blue, vtkPlotPoints::CIRCLE, vtkPen::SOLID_LINE, 3.0f } },
  };
  return makers;
}

Measurements SelectMaker(
  const Measurements& measurements, const std::string& scene, const Maker& maker)
{
  return Select(measurements,
    [&](const Measurement& m)
    {
      return m.Scene == scene && m.Technique == maker.Technique &&
        (maker.Pattern.empty() || m.Pattern == maker.Pattern);
    });
}

std::vector<double> GetColumn(const Measurements& measurements, double (*get)(const Measurement&))
{
  std::vector<double> column;
  for (const Measurement& m : measurements)
  {
    column.push_back(get(m));
  }
  return column;
}

double GetSeconds(const Measurement& m)
{
  return m.Seconds;
}

double GetSamples(const Measurement& m)
{
  return m.Samples;
}

double GetRootMeanSquare(const Measurement& m)
{
  return m.RootMeanSquare;
}

/// Powers of ten around all values.
std::array<double, 2> GetDecades(const std::vector<double>& values)
{
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return { std::pow(10.0, std::floor(std::log10(*least))),
    std::pow(10.0, std::ceil(std::log10(*greatest))) };
}

std::string Format(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

constexpr const char* ErrorTitle = "RMS error, share of the peak";

} // namespace

bool PlotErrorAgainstTime(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements)
{
  ChartPage page(2);
  for (const SceneTitle& scene : scenes)
  {
    const Measurements all =
      Select(measurements, [&](const Measurement& m) { return m.Scene == scene.Name; });
    Chart chart{ scene.Title, "seconds from geometry to texels", ErrorTitle,
      GetDecades(GetColumn(all, GetSeconds)), GetDecades(GetColumn(all, GetRootMeanSquare)), {} };
    const Measurements front = GetParetoFront(all);
    chart.Curves.push_back(
      { "Pareto front", { Yellow, vtkPlotPoints::NONE, vtkPen::SOLID_LINE, 14.0f },
        GetColumn(front, GetSeconds), GetColumn(front, GetRootMeanSquare) });
    for (const Maker& maker : GetMakers())
    {
      const Measurements curve = SelectMaker(measurements, scene.Name, maker);
      chart.Curves.push_back({ maker.Label, maker.Style, GetColumn(curve, GetSeconds),
        GetColumn(curve, GetRootMeanSquare) });
    }
    page.Add(chart);
  }
  return page.Write(path);
}

bool PlotErrorAgainstSamples(const std::string& path, const std::vector<SceneTitle>& scenes,
  const Measurements& measurements, int fewestFitted)
{
  ChartPage page(2);
  for (const SceneTitle& scene : scenes)
  {
    const Measurements all =
      Select(measurements, [&](const Measurement& m) { return m.Scene == scene.Name; });
    Chart chart{ scene.Title, "n, samples of the light", ErrorTitle,
      GetDecades(GetColumn(all, GetSamples)), GetDecades(GetColumn(all, GetRootMeanSquare)), {} };
    for (const Maker& maker : GetMakers())
    {
      const Measurements curve = SelectMaker(measurements, scene.Name, maker);
      if (curve.empty())
      {
        continue;
      }
      const PowerLaw law = FitRootMeanSquare(curve, fewestFitted);
      const double first = fewestFitted, last = curve.back().Samples;
      CurveStyle line = maker.Style;
      line.Marker = vtkPlotPoints::NONE;
      CurveStyle points = maker.Style;
      points.Line = vtkPen::NO_PEN;
      chart.Curves.push_back({ "", line, { first, last },
        { law.Factor * std::pow(first, law.Exponent),
          law.Factor * std::pow(last, law.Exponent) } });
      chart.Curves.push_back({ maker.Label + Format(", n^%.2f", law.Exponent), points,
        GetColumn(curve, GetSamples), GetColumn(curve, GetRootMeanSquare) });
    }
    page.Add(chart);
  }
  return page.Write(path);
}

bool PlotErrorAgainstTexels(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements)
{
  const std::vector<std::pair<int, CurveStyle>> supersamplings{
    { 1, { Vermilion, vtkPlotPoints::SQUARE } }, { 2, { Green, vtkPlotPoints::DIAMOND } },
    { 4, { Blue, vtkPlotPoints::CIRCLE } }
  };
  ChartPage page(static_cast<int>(scenes.size()));
  for (const std::string truth : { AreaTruth, CentreTruth })
  {
    for (const SceneTitle& scene : scenes)
    {
      Chart chart{ scene.Title +
          (truth == AreaTruth ? ", against the texel's average" : ", against the texel's centre"),
        "texel size, share of the floor's edge", ErrorTitle, { 1e-3, 1e-1 }, { 1e-4, 1.0 }, {} };
      for (const auto& [supersampling, style] : supersamplings)
      {
        const Measurements curve = Select(measurements,
          [&, s = supersampling](const Measurement& m)
          { return m.Scene == scene.Name && m.Truth == truth && m.Supersampling == s; });
        chart.Curves.push_back({ "Supersampling " + std::to_string(supersampling), style,
          GetColumn(curve, [](const Measurement& m) { return 1.0 / m.Texels; }),
          GetColumn(curve, GetRootMeanSquare) });
      }
      page.Add(chart);
    }
  }
  return page.Write(path);
}

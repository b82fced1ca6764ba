// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AccuracyPlots.h"

#include "ChartPage.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
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
    { SamplesName, "Random", "masks, random", { SkyBlue, vtkPlotPoints::CROSS } },
    { SamplesName, "Uniform Grid", "masks, uniform grid", { Purple, vtkPlotPoints::PLUS } },
    { SamplesName, "Jittered Grid", "masks, jittered grid", { Green, vtkPlotPoints::DIAMOND } },
    { SamplesName, "Correlated Multi-Jittered", "masks, multi-jittered",
      { Orange, vtkPlotPoints::SQUARE } },
    { LiteralName, "", "H&H loop, Sobol", { Vermilion, vtkPlotPoints::SQUARE, vtkPen::DASH_LINE } },
    { RaysName, "", "Embree rays, Sobol", { Black, vtkPlotPoints::DIAMOND, vtkPen::DASH_LINE } },
    { CountsName, "", "masks, Sobol, no reconstruction", { Blue, vtkPlotPoints::CROSS } },
    { ToleranceName, "", "masks, ErrorTolerance",
      { Vermilion, vtkPlotPoints::CIRCLE, vtkPen::SOLID_LINE, 1.0f } },
    { MasksName, "", "masks, and exact shares",
      { Vermilion, vtkPlotPoints::DIAMOND, vtkPen::SOLID_LINE, 2.0f } },
    { SamplesName, "Sobol", "masks, Sobol",
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

double GetTexelSize(const Measurement& m)
{
  return 1.0 / m.Texels;
}

double GetRootMeanSquare(const Measurement& m)
{
  return m.RootMeanSquare;
}

/// The range of the values and some decades more below and above, for what is drawn there.
std::array<double, 2> GetRange(const std::vector<double>& values, double below, double above)
{
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return { *least * std::pow(10.0, -below), *greatest * std::pow(10.0, above) };
}

// Decades beyond what is drawn: an axis's ends, and the legend's place, above errors that grow and
// to the left of times.
constexpr double AxisEnd = 0.15;
constexpr double LegendPlace = 0.6;
constexpr double WideLegendPlace = 1.1;

/// A chart of the errors in `shown` with nothing in it yet.
Chart MakeChart(const std::string& title, const std::string& xTitle, const Measurements& shown,
  double (*getX)(const Measurement&))
{
  return { title, xTitle, "RMS error, share of the peak",
    GetRange(GetColumn(shown, getX), AxisEnd, AxisEnd),
    GetRange(GetColumn(shown, GetRootMeanSquare), AxisEnd, AxisEnd), {}, {} };
}

std::string Format(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

} // namespace

bool PlotErrorAgainstTime(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements)
{
  ChartPage page(2);
  for (const SceneTitle& scene : scenes)
  {
    const Measurements all =
      Select(measurements, [&](const Measurement& m) { return m.Scene == scene.Name; });
    Chart chart = MakeChart(scene.Title, "seconds from geometry to texels", all, GetSeconds);
    chart.XRange[0] *= std::pow(10.0, -WideLegendPlace);
    const Measurements front = GetParetoFront(all);
    chart.Curves.push_back(
      { "Pareto front", { Yellow, vtkPlotPoints::NONE, vtkPen::SOLID_LINE, 10.0f },
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

bool PlotErrorAgainstSamples(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements)
{
  ChartPage page(2);
  for (const SceneTitle& scene : scenes)
  {
    // The n of ErrorTolerance is an answer, and exact shares follow no power of n.
    const Measurements all = Select(measurements,
      [&](const Measurement& m) {
        return m.Scene == scene.Name && m.Technique != ToleranceName && m.Technique != MasksName;
      });
    Chart chart = MakeChart(scene.Title, "n, samples of the light", all, GetSamples);
    for (int n = 1; n <= all.back().Samples; n *= 4)
    {
      chart.XTicks.emplace_back(n, std::to_string(n));
    }
    for (const Maker& maker : GetMakers())
    {
      const Measurements curve = SelectMaker(all, scene.Name, maker);
      if (curve.empty())
      {
        continue;
      }
      const PowerLaw law = FitRootMeanSquare(curve);
      const double first = curve.front().Samples, last = curve.back().Samples;
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
  std::set<int> sizes;
  for (const Measurement& m : measurements)
  {
    sizes.insert(m.Texels);
  }
  ChartPage page(static_cast<int>(scenes.size()));
  for (const std::string truth : { AreaTruth, CentreTruth })
  {
    const Measurements shown =
      Select(measurements, [&](const Measurement& m) { return m.Truth == truth; });
    for (const SceneTitle& scene : scenes)
    {
      Chart chart = MakeChart(scene.Title +
          (truth == AreaTruth ? ", against texels' averages" : ", against texels' centres"),
        "texel size, floor's edge = 1", shown, GetTexelSize);
      chart.Legend = LegendCorner::TopLeft;
      chart.YRange[1] *= std::pow(10.0, LegendPlace);
      for (const int texels : sizes)
      {
        chart.XTicks.emplace_back(1.0 / texels, "1/" + std::to_string(texels));
      }
      for (const auto& [supersampling, style] : supersamplings)
      {
        const Measurements curve = Select(shown,
          [&, s = supersampling](const Measurement& m)
          { return m.Scene == scene.Name && m.Supersampling == s; });
        chart.Curves.push_back({ "Supersampling " + std::to_string(supersampling), style,
          GetColumn(curve, GetTexelSize), GetColumn(curve, GetRootMeanSquare) });
      }
      page.Add(chart);
    }
  }
  return page.Write(path);
}

bool PictureScenes(const std::string& path, const std::vector<std::vector<double>>& images)
{
  const auto texels =
    static_cast<int>(std::lround(std::sqrt(static_cast<double>(images.front().size()))));
  vtkNew<vtkImageData> picture;
  picture->SetDimensions(texels * static_cast<int>(images.size()), texels, 1);
  picture->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  for (std::size_t image = 0; image < images.size(); ++image)
  {
    const double peak = *std::max_element(images[image].begin(), images[image].end());
    for (int j = 0; j < texels; ++j)
    {
      for (int i = 0; i < texels; ++i)
      {
        const double share = images[image][static_cast<std::size_t>(j * texels + i)] / peak;
        picture->SetScalarComponentFromDouble(static_cast<int>(image) * texels + i, j, 0, 0,
          std::round(255.0 * std::pow(share, 1.0 / 2.2)));
      }
    }
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(picture);
  writer->SetFileName(path.c_str());
  writer->Write();
  return writer->GetErrorCode() == 0;
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ChartPage.h"

#include "vtkAxis.h"
#include "vtkChartLegend.h"
#include "vtkChartXY.h"
#include "vtkContextActor.h"
#include "vtkContextScene.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPen.h"
#include "vtkPlotLine.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTextProperty.h"
#include "vtkWindowToImageFilter.h"

#include <cmath>
#include <cstdio>

namespace
{

// Pixels.
constexpr int ChartWidth = 720;
constexpr int ChartHeight = 560;
constexpr int Margin = 12;
constexpr int TitleSize = 20;
constexpr int TextSize = 16;
constexpr float MarkerSize = 9.0f;

using Ticks = std::vector<std::pair<double, std::string>>;

/// Every decade, 2 and 5 times as much; all of them labelled, or only the decades.
Ticks MakeTicks(const std::array<double, 2>& range, bool labelsAll)
{
  Ticks ticks;
  const int first = static_cast<int>(std::floor(std::log10(range[0])));
  const int last = static_cast<int>(std::ceil(std::log10(range[1])));
  for (int exponent = first; exponent <= last; ++exponent)
  {
    for (const double factor : { 1.0, 2.0, 5.0 })
    {
      const double value = factor * std::pow(10.0, exponent);
      char label[32];
      std::snprintf(label, sizeof(label), "%g", value);
      ticks.emplace_back(value, labelsAll || factor == 1.0 ? label : "");
    }
  }
  return ticks;
}

void SetTicks(vtkAxis* axis, const Ticks& ticks)
{
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (const auto& [value, label] : ticks)
  {
    positions->InsertNextValue(std::log10(value));
    labels->InsertNextValue(label);
  }
  axis->SetCustomTickPositions(positions, labels);
}

void StyleAxis(
  vtkAxis* axis, const std::string& title, const std::array<double, 2>& range, const Ticks& ticks)
{
  axis->SetTitle(title);
  axis->SetLogScale(true);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetUnscaledRange(range[0], range[1]);
  SetTicks(axis, ticks);
  axis->GetTitleProperties()->SetFontSize(TextSize);
  axis->GetTitleProperties()->SetBold(0);
  axis->GetLabelProperties()->SetFontSize(TextSize);
  axis->GetGridPen()->SetColor(225, 225, 225, 255);
}

void AddCurve(vtkChartXY* chart, const Curve& curve)
{
  vtkNew<vtkTable> table;
  for (const std::vector<double>* values : { &curve.X, &curve.Y })
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(values == &curve.X ? "x" : "y");
    for (const double value : *values)
    {
      column->InsertNextValue(value);
    }
    table->AddColumn(column);
  }
  auto* plot = vtkPlotLine::SafeDownCast(chart->AddPlot(vtkChart::LINE));
  plot->SetInputData(table, 0, 1);
  plot->SetLabel(curve.Label);
  const vtkColor3ub& color = curve.Style.Color;
  plot->SetColor(color.GetRed(), color.GetGreen(), color.GetBlue(), 255);
  plot->SetWidth(curve.Style.Width);
  plot->GetPen()->SetLineType(curve.Style.Line);
  plot->SetMarkerStyle(curve.Style.Marker);
  plot->SetMarkerSize(MarkerSize);
}

void AddChart(vtkContextScene* scene, const Chart& chart, const vtkRectf& place)
{
  vtkNew<vtkChartXY> item;
  scene->AddItem(item);
  item->SetAutoSize(false);
  item->SetSize(place);
  item->SetTitle(chart.Title);
  item->GetTitleProperties()->SetFontSize(TitleSize);
  StyleAxis(item->GetAxis(vtkAxis::BOTTOM), chart.XTitle, chart.XRange,
    chart.XTicks.empty() ? MakeTicks(chart.XRange, false) : chart.XTicks);
  StyleAxis(
    item->GetAxis(vtkAxis::LEFT), chart.YTitle, chart.YRange, MakeTicks(chart.YRange, true));
  for (const Curve& curve : chart.Curves)
  {
    if (!curve.X.empty())
    {
      AddCurve(item, curve);
    }
  }
  item->SetShowLegend(true);
  item->GetLegend()->SetLabelSize(TextSize);
  item->GetLegend()->SetSymbolWidth(40);
  item->GetLegend()->SetHorizontalAlignment(vtkChartLegend::LEFT);
  item->GetLegend()->SetVerticalAlignment(
    chart.Legend == LegendCorner::TopLeft ? vtkChartLegend::TOP : vtkChartLegend::BOTTOM);
}

} // namespace

bool ChartPage::Write(const std::string& path) const
{
  const int rows = (static_cast<int>(this->Charts.size()) + this->Columns - 1) / this->Columns;
  vtkNew<vtkContextActor> actor;
  for (std::size_t i = 0; i < this->Charts.size(); ++i)
  {
    const int row = static_cast<int>(i) / this->Columns,
              column = static_cast<int>(i) % this->Columns;
    const auto left = static_cast<float>(ChartWidth * column + Margin);
    const auto bottom = static_cast<float>(ChartHeight * (rows - 1 - row) + Margin);
    AddChart(actor->GetScene(), this->Charts[i],
      { left, bottom, ChartWidth - 2 * Margin, ChartHeight - 2 * Margin });
  }
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->AddActor(actor);
  actor->GetScene()->SetRenderer(renderer);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0); // text comes out doubled with more
  window->SetSize(ChartWidth * this->Columns, ChartHeight * rows);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(image->GetOutputPort());
  writer->SetFileName(path.c_str());
  writer->Write();
  return writer->GetErrorCode() == 0;
}

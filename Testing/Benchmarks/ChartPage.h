// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Pictures of charts with logarithmic axes, by VTK's charts.
 */
#ifndef ChartPage_h
#define ChartPage_h

#include "vtkColor.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

/// How a curve is drawn.
struct CurveStyle
{
  vtkColor3ub Color;
  int Marker = 0; ///< of vtkPlotPoints
  int Line = 1;   ///< of vtkPen
  float Width = 2.0f;
};

struct Curve
{
  std::string Label;
  CurveStyle Style;
  std::vector<double> X, Y; ///< positive; a curve with none is not drawn
};

/// Where the curves of a chart leave room for its legend.
enum class LegendCorner
{
  BottomLeft,
  TopLeft
};

/// A chart; the first curve is drawn first.
struct Chart
{
  std::string Title, XTitle, YTitle;
  std::array<double, 2> XRange, YRange;
  /// Where the x axis is labelled, and with what; if empty, at every decade.
  std::vector<std::pair<double, std::string>> XTicks;
  std::vector<Curve> Curves;
  LegendCorner Legend = LegendCorner::BottomLeft;
};

/// A grid of charts, row by row from the top.
class ChartPage
{
public:
  explicit ChartPage(int columns)
    : Columns(columns)
  {
  }

  void Add(const Chart& chart) { this->Charts.push_back(chart); }

  /// Draws all into a PNG file; false if it cannot be written.
  bool Write(const std::string& path) const;

private:
  int Columns;
  std::vector<Chart> Charts;
};

#endif

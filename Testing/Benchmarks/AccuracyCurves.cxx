// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AccuracyCurves.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

Measurements Select(
  const Measurements& measurements, const std::function<bool(const Measurement&)>& holds)
{
  Measurements selected;
  std::copy_if(measurements.begin(), measurements.end(), std::back_inserter(selected), holds);
  std::stable_sort(selected.begin(), selected.end(),
    [](const Measurement& a, const Measurement& b) { return a.Samples < b.Samples; });
  return selected;
}

PowerLaw FitRootMeanSquare(const Measurements& curve, int fewest)
{
  double count = 0.0, sumX = 0.0, sumY = 0.0, sumXX = 0.0, sumXY = 0.0;
  for (const Measurement& m : curve)
  {
    if (m.Samples >= fewest)
    {
      const double x = std::log(m.Samples), y = std::log(m.RootMeanSquare);
      count += 1.0;
      sumX += x;
      sumY += y;
      sumXX += x * x;
      sumXY += x * y;
    }
  }
  const double exponent = (count * sumXY - sumX * sumY) / (count * sumXX - sumX * sumX);
  return { std::exp((sumY - exponent * sumX) / count), exponent };
}

std::optional<double> GetSecondsAt(const Measurements& curve, double rootMeanSquare)
{
  const auto below = std::find_if(curve.begin(), curve.end(),
    [=](const Measurement& m) { return m.RootMeanSquare <= rootMeanSquare; });
  if (below == curve.end())
  {
    return std::nullopt;
  }
  if (below == curve.begin())
  {
    return below->Seconds;
  }
  const Measurement& above = *std::prev(below);
  const double share = std::log(above.RootMeanSquare / rootMeanSquare) /
    std::log(above.RootMeanSquare / below->RootMeanSquare);
  return above.Seconds * std::pow(below->Seconds / above.Seconds, share);
}

Measurements GetParetoFront(Measurements measurements)
{
  std::sort(measurements.begin(), measurements.end(),
    [](const Measurement& a, const Measurement& b) { return a.Seconds < b.Seconds; });
  Measurements front;
  for (const Measurement& m : measurements)
  {
    if (front.empty() || m.RootMeanSquare < front.back().RootMeanSquare)
    {
      front.push_back(m);
    }
  }
  return front;
}

bool WriteCsv(const std::string& path, const Measurements& measurements)
{
  std::ofstream file(path);
  file << "scene,technique,pattern,texels,supersampling,tolerance,n,seconds,rms,maximum,truth,"
          "triangles,build_seconds\n";
  for (const Measurement& m : measurements)
  {
    file << m.Scene << ',' << m.Technique << ',' << m.Pattern << ',' << m.Texels << ','
         << m.Supersampling << ',' << m.Tolerance << ',' << m.Samples << ',' << m.Seconds << ','
         << m.RootMeanSquare << ',' << m.Maximum << ',' << m.Truth << ',' << m.Triangles << ','
         << m.BuildSeconds << '\n';
  }
  file.close();
  return !file.fail();
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What the accuracy study measures, and what it reads off it.
 */
#ifndef AccuracyCurves_h
#define AccuracyCurves_h

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What Measurement::Technique says.
constexpr const char* MasksName = "masks";
constexpr const char* SamplesName = "samples";     ///< masks without ExactShares
constexpr const char* CountsName = "counts";       ///< and without Reconstruction
constexpr const char* ToleranceName = "tolerance"; ///< masks until ErrorTolerance is met
constexpr const char* LiteralName = "literal";
constexpr const char* RaysName = "embree";

/// What Measurement::Truth says: a texel's value is compared with the exact one at its centre, or
/// with the exact average over its area.
constexpr const char* CentreTruth = "centre";
constexpr const char* AreaTruth = "area";

/// One row of accuracy.csv.
struct Measurement
{
  std::string Scene;
  std::string Technique;
  std::string Pattern;
  int Texels = 0; ///< along each edge
  int Supersampling = 1;
  double Tolerance = 0.0; ///< asked for; 0: n was
  int Samples = 0;        ///< n
  double Seconds = 0.0;   ///< median
  double RootMeanSquare = 0.0;
  double Maximum = 0.0;
  std::string Truth; ///< of a texel: CentreTruth or AreaTruth
  std::size_t Triangles = 0;
  double BuildSeconds = 0.0; ///< of Seconds, what went into a hierarchy over the triangles
};

using Measurements = std::vector<Measurement>;

/// Those that hold, ordered by n.
Measurements Select(
  const Measurements& measurements, const std::function<bool(const Measurement&)>& holds);

/// error = factor n^exponent.
struct PowerLaw
{
  double Factor = 0.0;
  double Exponent = 0.0;
};

/// Least squares of log(RMS) against log(n), over the measurements with n >= `fewest`.
PowerLaw FitRootMeanSquare(const Measurements& curve, int fewest = 1);

/// The seconds at which a curve (in the order of n) first comes down to an RMS, interpolated in
/// log-log; nothing if it never does.
std::optional<double> GetSecondsAt(const Measurements& curve, double rootMeanSquare);

/// Those that no other beats in both time and RMS, in the order of time.
Measurements GetParetoFront(Measurements measurements);

bool WriteCsv(const std::string& path, const Measurements& measurements);

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The pictures of the accuracy study.
 */
#ifndef AccuracyPlots_h
#define AccuracyPlots_h

#include "AccuracyCurves.h"

#include <string>
#include <vector>

/// A scene's name in the measurements, and what people read.
struct SceneTitle
{
  std::string Name, Title;
};

/// Error against time, a chart a scene, with the Pareto front.
bool PlotErrorAgainstTime(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements);

/// Error against n with fitted power laws, a chart a scene.
bool PlotErrorAgainstSamples(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements);

/// Error against the size of texels, a row a truth, a column a scene.
bool PlotErrorAgainstTexels(
  const std::string& path, const std::vector<SceneTitle>& scenes, const Measurements& measurements);

/// The exact images of scenes, squares of the same number of texels, in a row: the peak of each is
/// white, and what is dark is raised by a gamma of 2.2, as on the screen.
bool PictureScenes(const std::string& path, const std::vector<std::vector<double>>& images);

#endif

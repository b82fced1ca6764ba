// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What the user says of receivers and lights.
 */
#ifndef ShadowSettings_h
#define ShadowSettings_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "PolygonLight.h"

#include <string>

namespace penumbra
{

/// Which side of a receiver is lit; the values are those of the property Side.
enum class ReceiverSide
{
  Auto = 0, ///< the side that gets more light
  Front = 1,
  Back = 2
};

/// The settings of a receiver: the properties of vtkShadowReceiver, which documents them.
struct PENUMBRARENDERING_EXPORT ReceiverSettings
{
  double TexelSize = 0.0;
  int LightSamples = 64;
  double SampleMultiplier = 1.0;
  int SamplingPattern = 0;
  int Supersampling = 1;
  glm::dvec3 Reflectance{ 1.0 };
  glm::dvec3 AmbientRadiance{ 0.0 };
  ReceiverSide Side = ReceiverSide::Auto;
  int Seed = 0;

  /// The largest number of samples of one light.
  static constexpr int MaximumLightSamples = 65536;

  /// Empty if every value makes sense; otherwise names the first that does not and what is allowed.
  std::string FindProblem() const;

  /// LightSamples x SampleMultiplier, at least 1, at most MaximumLightSamples.
  int GetSampleCount() const;
};

/// The shapes a light can have; the values are those of the property Shape.
enum class LightShape
{
  Parallelogram = 0,
  Triangle = 1
};

/// The settings of a light: the properties of vtkAreaLightSource, which documents them.
struct PENUMBRARENDERING_EXPORT LightSettings
{
  LightShape Shape = LightShape::Parallelogram;
  glm::dvec3 Origin{ -0.5, -0.5, 0.0 };
  glm::dvec3 Point1{ 0.5, -0.5, 0.0 };
  glm::dvec3 Point2{ -0.5, 0.5, 0.0 };
  glm::dvec3 Radiance{ 1.0 };
  bool TwoSided = false;

  /// Empty if every value makes sense; otherwise names the first that does not and what is allowed.
  std::string FindProblem() const;

  /// The light itself; the settings must have no problem.
  PolygonLight MakeLight() const;
};

} // namespace penumbra

#endif

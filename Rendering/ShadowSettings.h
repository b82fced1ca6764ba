// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What the user says of receivers and lights.
 */
#ifndef ShadowSettings_h
#define ShadowSettings_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro

#include <optional>
#include <string>

namespace penumbra
{

/// Which side of a receiver is lit; the values are those of the property Side.
enum class ReceiverSide
{
  Auto = 0, ///< the side that gets more light
  Front = 1,
  Back = 2,
  Both = 3 ///< each is a receiver of its own
};

/// Which plane stands for a surface that is not planar; the values are those of the property
/// ProxyPlaneMode.
enum class ProxyPlaneMode
{
  BestFit = 0,
  Given = 1 ///< by ProxyOrigin and ProxyNormal
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
  double SolidAnglePerSample = 0.0;
  double ErrorTolerance = 0.0;
  int MaximumLightSamples = 4096;
  bool Reconstruction = true;
  bool ExactShares = true;
  bool Planner = true;
  double PlannerTolerance = 1.0 / 1024.0;
  double HardPenumbra = 1.0;
  double PlanarityTolerance = 0.0;

  bool operator==(const ReceiverSettings& other) const;
  bool ProxyPlane = false;
  ProxyPlaneMode ProxyMode = ProxyPlaneMode::BestFit;
  glm::dvec3 ProxyOrigin{ 0.0 };
  glm::dvec3 ProxyNormal{ 0.0, 0.0, 1.0 };

  /// The largest number of samples of one light.
  static constexpr int MostLightSamples = 65536;

  /// Empty if every value makes sense; otherwise names the first that does not and what is allowed.
  std::string FindProblem() const;

  /// The same for data that an affine map moves: the given proxy plane goes with them.
  ReceiverSettings Transformed(const glm::dmat4& matrix) const;

  /// LightSamples x SampleMultiplier, at least 1, at most MostLightSamples.
  int GetSampleCount() const;

  /**
   * The samples of a light with the given bound of its solid angle (LightShape): with
   * SolidAnglePerSample, as many as keep each one's share below it, at most MaximumLightSamples
   * (H&H 1997, 3.7); else, and for lights without solid angle, GetSampleCount().
   */
  int GetSampleCount(double solidAngle) const;

private:
  std::string FindProxyProblem() const;
};

/// How a surface casts shadows: the properties of vtkShadowCaster, which documents them.
struct PENUMBRARENDERING_EXPORT CasterSettings
{
  bool CastShadow = true;
  /// Without a value, that of what shows the surface; nothing passes where nothing does.
  std::optional<glm::dvec3> Transmittance;

  /// Empty if every value makes sense; otherwise names the first that does not and what is allowed.
  std::string FindProblem() const;

  /// What applies to a surface with settings of its own.
  CasterSettings Overridden(const CasterSettings& own) const;

  /// What passes: all of it, if no shadow is cast.
  glm::dvec3 GetTransmittance() const;
};

/**
 * The light that passes a surface of an opacity o and a diffuse colour, as it is drawn:
 * (1 - o) (1 - o + o h), where h is the colour over its largest component. Grey surfaces, black
 * ones among them, let 1 - o pass, as they do of what is behind them in the picture; others keep
 * less of the light that is not of their hue, the more so the more opaque they are.
 */
PENUMBRARENDERING_EXPORT glm::dvec3 GetTransmittance(double opacity, const glm::dvec3& colour);

/// The kinds of lights; the values are those of the property Shape.
enum class LightKind
{
  Parallelogram = 0,
  Triangle = 1,
  Disk = 2,
  Segment = 3,
  Point = 4,
  Directional = 5,
  Surface = 6 ///< every polygon of the data emits: vtkAreaLightFromSurface, not a property's value
};

/// The settings of a light: the properties of vtkAreaLightSource, which documents them.
struct PENUMBRARENDERING_EXPORT LightSettings
{
  LightKind Shape = LightKind::Parallelogram;
  glm::dvec3 Origin{ -0.5, -0.5, 0.0 };
  glm::dvec3 Point1{ 0.5, -0.5, 0.0 };
  glm::dvec3 Point2{ -0.5, 0.5, 0.0 };
  glm::dvec3 Radiance{ 1.0 };
  bool TwoSided = false;
  double AngularDiameter = 0.53; ///< degrees

  /// The largest radiance: sums over many lights stay finite in single precision.
  static constexpr double MaximumRadiance = 1e30;

  /// Empty if every value makes sense; otherwise names the first that does not and what is allowed.
  std::string FindProblem() const;

  /// The light itself; the settings must have no problem, and Surface needs data instead.
  Light MakeLight() const;

private:
  Light MakeShape() const;
};

} // namespace penumbra

#endif

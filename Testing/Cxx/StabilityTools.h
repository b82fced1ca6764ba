// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What the tests labelled `stability` share: bakes against an exact count of the same samples, and
 * the bounds for single precision.
 */
#ifndef StabilityTools_h
#define StabilityTools_h

#include "SampledVisibility.h"
#include "TestScenes.h"

#include <string>

/// Half a unit in the last place of a float.
constexpr double FloatRounding = 0x1p-24;

/**
 * The rounding of a radiance, as a share of the peak. The closed form of a polygon with up to eight
 * vertices takes some 16 roundings for each of its terms, which add up in eight steps; terms and
 * sums are below twice the form factor where the light is not wholly below a grazing angle: 48
 * roundings. A share is two sums of 32-sample words, each with 32 additions of terms with 16
 * roundings, added up in n / 32 steps, and their quotient: 2 (48 + n / 32).
 */
double GetRadianceBound(int samples);

/// How far rays must pass an edge on the way to a light for a rasteriser to be sure of them.
oracle::RayTolerance GetRayTolerance(
  const penumbra::Parallelogram& base, const penumbra::Light& light);

/// What a bake may be off by.
struct CountError
{
  /// Beyond what the exact count allows, of the peak. NaN if a texel is not finite.
  double Largest = 0.0;
  /// How much the rays that no rasteriser has to decide leave open, on average.
  double Open = 0.0;
};

/**
 * Bakes the scene, whose lights are polygons, without reconstruction, and compares it with the
 * exact form factor times the exact count of the same samples (SampledVisibility).
 */
CountError CompareWithCount(TestScene scene);
/// The same for the first receiver of a scene that was made otherwise: `scene` says where its
/// texels are, and what is around them.
CountError CompareWithCount(const TestScene& scene, penumbra::ShadowScene made);

/// Prints an error beside its bound, and expects it to be no larger.
void ExpectWithin(const std::string& what, double error, double bound);

/// Both, with the bound of GetRadianceBound(); at most `open` may be left open.
void ExpectExactCount(const TestScene& scene, double open = 0.02);

/// The irradiance of a bake without reconstruction.
std::vector<glm::vec4> BakeTexels(TestScene scene);

/// The irradiance, with masks of at most so many bytes at a time.
std::vector<glm::vec4> BakeInBands(const TestScene& scene, std::size_t maskBytes);

/// A light 1 x 1 in the plane z = 2, facing down, over the middle of the receiver of TestScene; 64
/// samples, 32 x 32 texels.
TestScene MakeLampScene();

#endif

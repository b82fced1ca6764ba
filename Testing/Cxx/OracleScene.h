// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The oracle's lights and scenes as the product's.
 */
#ifndef OracleScene_h
#define OracleScene_h

#include "LightShape.h"
#include "RandomScenes.h"
#include "ShadowScene.h"

inline oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

inline glm::dvec3 FromOracle(const oracle::Vec3& v)
{
  return { static_cast<double>(v.X), static_cast<double>(v.Y), static_cast<double>(v.Z) };
}

/// The product's light that is the oracle's.
penumbra::Light MakeLight(const oracle::AnyLight& light);

/// A receiver of some texels and settings, whose reflectance and ambient light are the scene's, and
/// the scene's lights and occluders: surface 0 is the receiver, surface 1 the occluders.
penumbra::ShadowScene MakeShadowScene(
  const oracle::RandomScene& scene, penumbra::ReceiverSettings settings, const glm::ivec2& texels);

/// The oracle's radiance at the texels' centres, i (along Edge1) fastest; by all processors.
std::vector<glm::dvec3> GetExactRadiance(
  const oracle::RandomScene& scene, const glm::ivec2& texels);

#endif

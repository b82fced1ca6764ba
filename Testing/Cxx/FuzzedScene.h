// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Random scenes, among them nasty ones, and how one that breaks a property is made small.
 */
#ifndef FuzzedScene_h
#define FuzzedScene_h

#include "ShadowScene.h"

#include <array>
#include <functional>
#include <iosfwd>
#include <vector>

/// A convex polygon that emits, of a light of many.
struct FuzzedCell
{
  std::vector<glm::dvec3> Vertices;
  glm::dvec3 Radiance{ 1.0 };
};

/// A light as the user describes it.
struct FuzzedLight
{
  penumbra::LightSettings Settings;
  std::vector<FuzzedCell> Cells; ///< of LightKind::Surface

  penumbra::Light Make() const;
};

using FuzzedTriangle = std::array<glm::dvec3, 3>;

/// One receiver, lights over it and triangles between.
struct FuzzedScene
{
  penumbra::Parallelogram Base;
  glm::ivec2 Texels{ 1 };
  penumbra::ReceiverSettings Settings;
  std::vector<FuzzedLight> Lights;
  std::vector<FuzzedTriangle> Occluders;

  /// Surface 0 is the receiver, surface 1 the occluders, if there are any.
  penumbra::ShadowScene Make() const;
};

/// Whether the settings, the receiver and the lights are such as the product takes.
bool MakesSense(const FuzzedScene& scene);

/// All of it, in few lines.
std::ostream& operator<<(std::ostream& os, const FuzzedScene& scene);

/// What a generator may put into a scene.
enum class FuzzedKind
{
  /// Lights well above the receiver, occluders of its size.
  Tame,
  /// Also triangles that rest on the receiver, lie in it, cross it, are a hair above it, touch the
  /// light, are behind it, enormous, slivers, without area, or there twice.
  NastyOccluders,
  /// Also lights that are cut by the receiver's plane, touch it, are a hair above it, right over a
  /// texel's centre, 1e15 sizes away, or behind it; receivers of 1 degree and of 1 : 100.
  Nasty
};

/// The same on every machine: one to three lights of all kinds, up to 12 triangles or so, 1 x 1 to
/// 12 x 12 texels, 1 to 64 samples of any pattern.
FuzzedScene MakeFuzzedScene(unsigned seed, FuzzedKind kind);

/// A triangle anywhere between the receiver and the first light, or where Nasty ones are.
FuzzedTriangle MakeFuzzedTriangle(const FuzzedScene& scene, unsigned seed, FuzzedKind kind);

/**
 * The smallest scene that can be found that still fails, from one that does: triangles, lights and
 * cells go, first half of them at a time (Zeller and Hildebrandt 2002, "Simplifying and Isolating
 * Failure-Inducing Input"), then samples and texels become fewer, settings their defaults, and
 * coordinates round. What makes no sense is not tried.
 */
FuzzedScene Shrink(FuzzedScene scene, const std::function<bool(const FuzzedScene&)>& fails);

#endif

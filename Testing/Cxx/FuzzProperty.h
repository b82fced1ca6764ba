// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Properties that hold for all scenes, tried on many.
 */
#ifndef FuzzProperty_h
#define FuzzProperty_h

#include "FuzzedScene.h"

#include <functional>
#include <string>

/// How far a scene is from a property, and how far it may be.
struct Deviation
{
  double Error = 0.0;
  double Bound = 0.0;

  bool Holds() const { return this->Error <= this->Bound; } // not with a NaN
  /// Whether this is nearer to its bound, or further beyond, than the other.
  bool IsWorseThan(const Deviation& other) const;
};

/// What a property says of a scene; the seed is for what else it draws at random.
using Property = std::function<Deviation(const FuzzedScene& scene, unsigned seed)>;

/**
 * Tries the property on the scenes of `count` seeds from `first` on, and prints the largest error
 * beside its bound. A scene that breaks it is shrunk and printed, with the command that repeats it:
 * PENUMBRA_FUZZ_SEED in the environment is the one seed to try.
 */
void ExpectProperty(const std::string& what, FuzzedKind kind, unsigned first, unsigned count,
  const Property& property);

#endif

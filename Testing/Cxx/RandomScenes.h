// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomScenes.h
 * @brief Random scenes with exact answers, for studies of the error: the same on every machine.
 *
 * Pure data in the oracle's types. Corners of occluders are floats, so that what keeps them in
 * single precision sees the very same scene; those of lights and receivers are doubles.
 */

#ifndef RandomScenes_h
#define RandomScenes_h

#include "ExactLights.h"

namespace oracle
{

/** A rectangular receiver in the plane z = 0, which faces up, with lights and occluders over it. */
struct RandomScene
{
  /** A corner and the two edges that meet there, 2 to 4 long. */
  Vec3 Origin, Edge1, Edge2;
  Scene Contents;

  Vec3 Normal() const { return Cross(this->Edge1, this->Edge2); }
  /** The point at @a u, @a v in [0, 1]^2 of the receiver. */
  Vec3 At(long double u, long double v) const
  {
    return this->Origin + u * this->Edge1 + v * this->Edge2;
  }
};

/**
 * The scene of a seed: one or two lights, mostly overhead, some near and some tilted, and one to
 * six boxes, plates and tetrahedra, some of which stand on the receiver. The first light has an
 * extent; the second may also be a point or a sun of no size. Kinds, sizes and places are random.
 * 5 % to 60 % of the receiver are penumbral, or 0.5 % to 60 % for seeds that 8 divides.
 */
RandomScene MakeRandomScene(unsigned seed);

/**
 * The share of the centres of @a side x @a side cells of the receiver at which some light is
 * hidden by more than 0.1 % and less than 99.9 %.
 */
double PenumbralShare(const RandomScene& scene, int side);

} // namespace oracle

#endif

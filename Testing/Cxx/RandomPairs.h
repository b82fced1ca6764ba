// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Random receivers, and random lights that shine on them.
 */
#ifndef RandomPairs_h
#define RandomPairs_h

#include "LightShape.h"
#include "RandomGeometry.h"
#include "ReceiverFrame.h"

/// A receiver of any attitude and size, up to 1e6 times as long as wide; it is around the origin or
/// up to 1e4 of its sizes away.
penumbra::ReceiverFrame RandomFrame(RandomGeometry& random);

/// A skewed receiver of about unit size near the origin.
penumbra::ReceiverFrame RandomNearFrame(RandomGeometry& random);

/// A light of any kind. It is given in the receiver's frame, some of it perhaps below the receiver.
penumbra::Light RandomLight(RandomGeometry& random, const penumbra::ReceiverFrame& frame);

/// A light that sends something to the receiver, and the part of that which gets it.
struct RandomPair
{
  using MakeFrame = penumbra::ReceiverFrame (*)(RandomGeometry&);
  explicit RandomPair(RandomGeometry& random, MakeFrame makeFrame = RandomFrame);

  penumbra::ReceiverFrame Frame;
  penumbra::Light Seen; ///< clipped to the receiver's front
  glm::dvec4 Range{ 0.0, 0.0, 1.0, 1.0 };
};

/// A place on the light.
penumbra::LightSample RandomSample(RandomGeometry& random, const penumbra::LightShape& light);

/// A point in the frame, on the way from the range to a point of the light.
glm::dvec3 RandomPointOnRay(RandomGeometry& random, const RandomPair& pair);

#endif

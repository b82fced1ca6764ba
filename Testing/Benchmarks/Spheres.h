// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * An occluder of any number of triangles.
 */
#ifndef Spheres_h
#define Spheres_h

#include "ShadowScene.h"

/// Twelve spheres over the floor [0, 10]^2, each of `rings` rings of 2 `rings` quads, those at the
/// poles triangles: 48 `rings` (`rings` - 1) triangles. The same on every machine.
penumbra::Surface MakeSpheres(int rings);

#endif

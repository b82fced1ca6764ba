// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Scenes in which there is much that does not matter. The same on every machine.
 */
#ifndef GainScenes_h
#define GainScenes_h

#include "ShadowScene.h"

/// Ten rooms in a row, with doors between them: 50 receivers (floors and walls), 12 lamps. In each
/// there are a table and two pillars.
penumbra::ShadowScene MakeHall(int texels, int samples);

/// A plain of 200 x 200 under the sun, 40 degrees high and 0.53 wide, with so many boxes of up
/// to 3.
penumbra::ShadowScene MakePlain(int texels, int samples, int boxes);

/// A floor of 10 x 10 under two lamps, and 50 boxes over it.
penumbra::ShadowScene MakeBoxes(int texels, int samples);

/// The surface, moved.
penumbra::SharedSurface Moved(const penumbra::SharedSurface& surface, const glm::dvec3& step);

#endif

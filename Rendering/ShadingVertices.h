// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Receivers that a few vertices shade.
 */
#ifndef ShadingVertices_h
#define ShadingVertices_h

#include "EffectPlanner.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"

namespace penumbra
{

/// Whether samples decide nowhere on the receiver: its light is smooth.
PENUMBRARENDERING_EXPORT bool IsSmooth(const ReceiverPlan& plan);

/// Whether no light is blocked anywhere on the receiver.
PENUMBRARENDERING_EXPORT bool IsUnshadowed(const ReceiverPlan& plan);

/// Whether 'Shadow' shading (vtkShadowFactors) changes nothing: no light is blocked, and all that
/// arrives is grey, so that no hue is taken on either.
PENUMBRARENDERING_EXPORT bool IsPlain(const ReceiverPlan& plan, const ReceiverSettings& settings);

/**
 * How many vertices along each edge, 2 to 33, shade a smooth receiver (H&H 1997, 3.8) by bilinear
 * interpolation to within its PlannerTolerance, of the light that arrives and of the light that is
 * blocked; 0 if that takes more, or is not allowed. Half of the tolerance is allowed at the points
 * of a grid twice as fine; what lies between those is left the other half.
 */
PENUMBRARENDERING_EXPORT int CountShadingVertices(
  const ReceiverPlan& plan, const ReceiverSettings& settings);

/**
 * The plan of a smooth receiver's vertices: they are the centres of the texels of a parallelogram
 * that reaches beyond the receiver by half of the distance between them.
 */
PENUMBRARENDERING_EXPORT ReceiverPlan PlanVertices(const ReceiverPlan& plan, int vertices);

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What was decided and done, as a table.
 */
#ifndef PlanTable_h
#define PlanTable_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkRadianceBaker.h"        // for its reports

class vtkTable;

namespace penumbra
{

/**
 * Makes the columns of a table of plans, without rows: Receiver (index), Light (index), Effect,
 * Reason, LightSamples, Texels (that masks were drawn for), Triangles (that could block the light),
 * SceneTriangles (of all surfaces), Milliseconds, Bytes (of masks and what comes between them and
 * the texture), ExactTexels (whose shares were cut out of the light).
 */
PENUMBRARENDERING_EXPORT void MakePlanTable(vtkTable* table);

/// Adds a row for each light.
PENUMBRARENDERING_EXPORT void AddToPlanTable(
  int receiver, const vtkRadianceBaker::Report& report, vtkTable* table);

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Whether polygonal data, and unstructured grids, are what VTK takes them for.
 */
#ifndef PolyDataStructure_h
#define PolyDataStructure_h

#include "PenumbraRenderingModule.h" // for the export macro

#include <string>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace penumbra
{

/**
 * What in the data would have VTK read what is not there, and what is allowed: offsets of cells
 * that are out of order, cells that name points that the data do not have, strips of fewer than
 * three points. Empty if all is well.
 *
 * VTK's own filters and mappers take this for granted, and crash where it is not so: to be asked
 * before they see the data.
 */
PENUMBRARENDERING_EXPORT std::string FindStructureProblem(vtkPolyData* data);

/**
 * The same of a grid: offsets of cells that are out of order, cells that name points that it does
 * not have.
 */
PENUMBRARENDERING_EXPORT std::string FindStructureProblem(vtkUnstructuredGrid* grid);

} // namespace penumbra

#endif

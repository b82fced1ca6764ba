// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The surfaces that a view draws of data of any type.
 */
#ifndef SurfaceExtraction_h
#define SurfaceExtraction_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkSmartPointer.h"         // for vtkSmartPointer

#include <string>

class vtkDataObject;
class vtkPolyData;

namespace penumbra
{

/// What ExtractSurfaces() finds.
struct ExtractedSurfaces
{
  vtkSmartPointer<vtkDataObject> Data; ///< polygonal data, or composite data of them; nullptr: none
  std::string Problem; ///< which of the data have no surface, and what is allowed; empty: all have
};

/**
 * Extracts what ParaView's render view draws of the data as 'Surface'. Polygonal data are their own
 * surface. Of unstructured, structured, rectilinear, image and explicit structured grids, and of
 * hyper tree grids, it is the outer surface (vtkGeometryFilter and its kin, with the settings of
 * vtkPVGeometryFilter); of each block of adaptively refined grids, its faces on the bounds of the
 * whole. Of composite data, it is those of all leaves, in one vtkMultiBlockDataSet. Each keeps the
 * field data of what it comes from. Cells that are hidden are left out (WithoutHiddenCells()).
 *
 * Data without cells have no surface, and no problem.
 */
PENUMBRARENDERING_EXPORT ExtractedSurfaces ExtractSurfaces(vtkDataObject* data);

/**
 * Leaves out the cells whose vtkGhostType has HIDDENCELL or DUPLICATECELL, as ParaView's render
 * view does, and the points that only they use. The answer is the data themselves where there is no
 * such cell. The data pass FindStructureProblem(). Arrays that have not a value for each cell, or
 * each point, are left out, too.
 */
PENUMBRARENDERING_EXPORT vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* data);

} // namespace penumbra

#endif

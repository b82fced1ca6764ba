// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What VTK draws of polygonal data as a surface: polygons, and the triangles that they are split
 * into.
 */
#ifndef PolygonCells_h
#define PolygonCells_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkSmartPointer.h"         // for vtkSmartPointer
#include "vtkType.h"                 // for vtkIdType

#include <array>
#include <functional>

class vtkCellArray;
class vtkIdList;
class vtkPoints;
class vtkPolyData;

namespace penumbra
{

/**
 * Joins the polygons of the data and, after them, the triangles of its strips. `origins` (may be
 * nullptr) becomes, of each, the index of the cell of the data that it comes from. The data pass
 * FindStructureProblem().
 */
PENUMBRARENDERING_EXPORT vtkSmartPointer<vtkCellArray> JoinStrips(
  vtkPolyData* data, vtkIdList* origins = nullptr);

/**
 * Calls visit(polygon, corners) for each triangle of each polygon, in their order.
 *
 * Polygons are split by VTK's ear cutting (vtkPolygon), which gets concave ones right. It gives up,
 * or loses most of the area, where outlines cross themselves, touch themselves (a bridge to a hole)
 * or repeat points. VTK's mapper draws those nevertheless: each as the fan of triangles about its
 * first point (vtkOpenGLIndexBufferObject of VTK 9.2 to 9.6), and so they are split here.
 */
PENUMBRARENDERING_EXPORT void VisitTriangles(vtkCellArray* polygons, vtkPoints* points,
  const std::function<void(vtkIdType polygon, const std::array<vtkIdType, 3>& corners)>& visit);

} // namespace penumbra

#endif

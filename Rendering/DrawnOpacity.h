// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Opacities of single cells and points, and polygons divided by them.
 */
#ifndef DrawnOpacity_h
#define DrawnOpacity_h

#include "vtkSmartPointer.h"

#include <cstdint>
#include <map>
#include <vector>

class vtkDataSet;
class vtkMapper;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace penumbra
{

/// Of polygonal data, the array of opacities, 0 to 255, at their cells or their points.
constexpr const char* OpacityArray = "PenumbraOpacity";

/// A surface of more opacities than this is divided by multiples of one over it.
constexpr int MostOpacities = 16;

/// The opacities that the mapper's scalars give to the data's cells or points, 0 to 255; nullptr if
/// they are all opaque.
vtkSmartPointer<vtkUnsignedCharArray> FindOpacities(
  vtkMapper* mapper, vtkDataSet* data, bool& areOfCells);

/// The data with the OpacityArray by which the mapper's scalars make them translucent; the data
/// themselves where nothing does.
vtkSmartPointer<vtkPolyData> WithOpacities(vtkMapper* mapper, vtkPolyData* data);

/// Appends words that differ if the opacities that the mapper gives to the data do.
void AppendOpacityState(std::vector<std::uint64_t>& words, vtkMapper* mapper, vtkDataSet* data);

/**
 * The polygons by their opacity, 0 to 1, without those of opacity 0. Opacities are exact where they
 * are at most MostOpacities and none changes within a polygon; else they are rounded to multiples
 * of 1 / MostOpacities, and polygons are cut where linear opacities pass from one to the next.
 */
std::multimap<double, vtkSmartPointer<vtkPolyData>> SplitByOpacity(vtkPolyData* data);

} // namespace penumbra

#endif

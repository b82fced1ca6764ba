// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The polygons of what mappers draw at points: glyphs (vtkGlyph3DMapper) and balls
 * (vtkPointGaussianMapper).
 */
#ifndef DrawnGlyphs_h
#define DrawnGlyphs_h

#include "vtkSmartPointer.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkDataSet;
class vtkMapper;
class vtkPolyData;

namespace penumbra
{

/// The most triangles that the glyphs of one data set may have; more of them cast no shadow.
constexpr double MostGlyphTriangles = 4e6;

/// Whether the mapper draws something at each point, instead of its data.
bool DrawsGlyphs(vtkMapper* mapper);

/**
 * What the mapper draws at the points of the data, as triangles in the data's coordinates, with the
 * OpacityArray if opacities differ. A ball has 320 triangles between spheres of 0.977 and 1.016
 * radii, and the mean silhouette of a ball to 1 %. Where it cannot be made, `problem` says why.
 */
vtkSmartPointer<vtkPolyData> MakeGlyphs(vtkMapper* mapper, vtkDataSet* data, std::string& problem);

/// Appends words that differ if the glyphs at the data do, but for the data themselves.
void AppendGlyphState(std::vector<std::uint64_t>& words, vtkMapper* mapper, vtkDataSet* data);

} // namespace penumbra

#endif

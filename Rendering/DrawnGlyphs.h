// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The polygons of what mappers draw at points and along lines: glyphs (vtkGlyph3DMapper), balls
 * (vtkPointGaussianMapper), points drawn as spheres and lines drawn as tubes.
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

struct DrawnActor;

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

/// Whether the actor draws points as spheres or lines as tubes.
bool DrawsPixelSolids(const DrawnActor& drawn);

/**
 * The points that the actor draws as spheres, as balls, and the lines that it draws as tubes, as
 * prisms of 8 sides with flat ends between cylinders of 0.948 and 1.026 radii, in the coordinates
 * of the data. Their diameters are the actor's point size and line width, in pixels of
 * DrawnActor::PixelLength each. nullptr if there are none. Where they cannot be made, `problem`
 * says why.
 */
vtkSmartPointer<vtkPolyData> MakePixelSolids(
  const DrawnActor& drawn, vtkPolyData* data, std::string& problem);

/// Appends words that differ if the solids do, but for the data and the matrix.
void AppendPixelSolidState(std::vector<std::uint64_t>& words, const DrawnActor& drawn);

/// Appends words that differ if the glyphs at the data do, but for the data themselves.
void AppendGlyphState(std::vector<std::uint64_t>& words, vtkMapper* mapper, vtkDataSet* data);

} // namespace penumbra

#endif

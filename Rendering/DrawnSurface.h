// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The polygons that an actor's mapper draws, where they are other than those of its data.
 */
#ifndef DrawnSurface_h
#define DrawnSurface_h

#include "Vectors.h"
#include "vtkSmartPointer.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class vtkActor;
class vtkCompositeDataDisplayAttributes;
class vtkDataObject;
class vtkMapper;
class vtkMatrix4x4;

namespace penumbra
{

/// An actor, the mapper of its data themselves, and what that mapper draws them with.
struct DrawnActor
{
  vtkActor* Actor = nullptr;
  vtkMapper* Mapper = nullptr;
  vtkMatrix4x4* Matrix = nullptr; ///< from the data to the world; nullptr if they are the same
  vtkDataObject* Data = nullptr;
  vtkCompositeDataDisplayAttributes* Attributes = nullptr;
  double PixelLength = 0.0; ///< in the world, of what has a size in pixels; 0 if it is not known
};

/// Polygons of an actor that are drawn alike.
struct DrawnPart
{
  vtkSmartPointer<vtkDataObject> Data; ///< polygonal data, or a tree of them
  double Opacity = 1.0;
  std::optional<glm::dvec3> Colour; ///< what they are drawn in, unless an array colours them
};

/// Whether the mapper draws polygons of its data as they are, all with the actor's own opacity and
/// colour.
bool IsDrawnAsItIs(const DrawnActor& drawn);

/**
 * The polygons that the mapper draws: what its clipping planes leave of its visible blocks, in
 * parts by their opacity and colour. Opacities of cells and points are those of the lookup table or
 * of colours with an alpha (SplitByOpacity), times the alpha of the texture (SplitByTexture). What
 * is wholly transparent is left out. Points drawn as spheres and lines drawn as tubes are among
 * them (MakePixelSolids); the polygons themselves are so only if they are drawn as such. Data with
 * receiver settings stay one part for each block, with the block's opacity, if `mayReceive`. What
 * is drawn but left out is said by `problem`.
 */
std::vector<DrawnPart> FindDrawnParts(
  const DrawnActor& drawn, bool mayReceive, std::string& problem);

/// Tells of glyphs that the actor's texture cuts out, though their shadow does not show that; empty
/// if there is no such thing.
std::string DescribeUnlikeShadow(const DrawnActor& drawn);

/// Whether mappers like this one draw polygons that can be found.
bool IsKnown(vtkMapper* mapper);

/**
 * Appends all that FindDrawnParts() depends on but for the data, their blocks' visibility and the
 * matrix: words that differ if anything of it does.
 */
void AppendDrawnState(std::vector<std::uint64_t>& words, const DrawnActor& drawn);

} // namespace penumbra

#endif

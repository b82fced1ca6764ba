// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What the alpha of an actor's texture leaves of its polygons.
 */
#ifndef DrawnTexture_h
#define DrawnTexture_h

#include "vtkSmartPointer.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

class vtkActor;
class vtkPolyData;

namespace penumbra
{

/// The most triangles that a texture's alpha may add to those of a data set: of more of them,
/// coarser texels are taken.
constexpr std::size_t MostTexturedTriangles = 1000000;

/// Texels are taken together until there are at most so many along each side of a texture.
constexpr int MostAlphaTexels = 256;

/// Whether the actor's polygons are drawn with a texture that has texels that are not opaque.
bool HasTransparentTexture(vtkActor* actor);

/**
 * The polygons in parts by the alpha of the actor's texture there, 0 to 1, without those of alpha
 * 0. Alphas are exact where they are at most MostOpacities in all, else rounded to multiples of 1 /
 * MostOpacities. Parts have the OpacityArray of the data, if these have one. Data without texture
 * coordinates, of one or two components, are drawn without the texture: they are one part. Where
 * texels are taken together to keep MostTexturedTriangles, `problem` says so.
 */
std::multimap<double, vtkSmartPointer<vtkPolyData>> SplitByTexture(
  vtkActor* actor, vtkPolyData* data, std::string& problem);

/// Appends words that differ if the texture's alpha, or how it lies on the polygons, does.
void AppendTextureState(std::vector<std::uint64_t>& words, vtkActor* actor);

} // namespace penumbra

#endif

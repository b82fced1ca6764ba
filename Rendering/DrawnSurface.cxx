// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnSurface.h"

#include "DrawnGlyphs.h"
#include "DrawnOpacity.h"
#include "DrawnTexture.h"
#include "ShadowSettings.h"
#include "vtkActor.h"
#include "vtkClipPolyData.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDataSet.h"
#include "vtkDataSetMapper.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkGlyph3DMapper.h"
#include "vtkMapper.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkShadowFieldData.h"

#include <array>
#include <cstring>
#include <map>
#include <tuple>

namespace penumbra
{
namespace
{

/// How a block is drawn: what is said of it, or else of the block that it is in.
struct BlockStyle
{
  bool IsVisible = true;
  double Opacity = 1.0;
  std::optional<glm::dvec3> Colour; ///< instead of the actor's colour, and of scalars
};

BlockStyle GetStyle(
  vtkDataObject* block, vtkCompositeDataDisplayAttributes* attributes, BlockStyle style)
{
  if (attributes && attributes->HasBlockVisibility(block))
  {
    style.IsVisible = attributes->GetBlockVisibility(block);
  }
  if (attributes && attributes->HasBlockOpacity(block))
  {
    style.Opacity = attributes->GetBlockOpacity(block);
  }
  if (attributes && attributes->HasBlockColor(block))
  {
    style.Colour.emplace();
    attributes->GetBlockColor(block, &style.Colour->x);
  }
  return style;
}

/// Calls visit(leaf, style) for the data or each leaf of their tree.
template <typename Visitor>
void VisitLeaves(vtkDataObject* data, vtkCompositeDataDisplayAttributes* attributes,
  const BlockStyle& above, Visitor&& visit)
{
  const BlockStyle style = GetStyle(data, attributes, above);
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    vtkSmartPointer<vtkDataObjectTreeIterator> it;
    it.TakeReference(tree->NewTreeIterator());
    it->VisitOnlyLeavesOff();
    it->TraverseSubTreeOff();
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      VisitLeaves(it->GetCurrentDataObject(), attributes, style, visit);
    }
  }
  else if (auto* leaf = vtkDataSet::SafeDownCast(data))
  {
    visit(leaf, style);
  }
}

template <typename Visitor>
void VisitLeaves(const DrawnActor& drawn, Visitor&& visit)
{
  BlockStyle style;
  style.Opacity = drawn.Actor->GetProperty()->GetOpacity();
  VisitLeaves(drawn.Data, drawn.Attributes, style, visit);
}

/// A clipping plane in the data's coordinates: what is kept has a value of 0 or more.
using Plane = std::array<double, 4>;

std::vector<Plane> GetClippingPlanes(const DrawnActor& drawn)
{
  std::vector<Plane> planes;
  if (drawn.Mapper->GetNumberOfClippingPlanes() == 0)
  {
    return planes; // nearly always, in each frame
  }
  vtkNew<vtkMatrix4x4> matrix;
  if (drawn.Matrix)
  {
    matrix->DeepCopy(drawn.Matrix);
  }
  for (int i = 0; i < drawn.Mapper->GetNumberOfClippingPlanes(); ++i)
  {
    drawn.Mapper->GetClippingPlaneInDataCoords(matrix, i, planes.emplace_back().data());
  }
  return planes;
}

vtkSmartPointer<vtkPolyData> Clip(
  vtkSmartPointer<vtkPolyData> data, const std::vector<Plane>& planes)
{
  for (const Plane& plane : planes)
  {
    const glm::dvec3 normal(plane[0], plane[1], plane[2]);
    const glm::dvec3 origin = -plane[3] / glm::dot(normal, normal) * normal;
    vtkNew<vtkPlane> function;
    function->SetOrigin(origin.x, origin.y, origin.z);
    function->SetNormal(normal.x, normal.y, normal.z);
    vtkNew<vtkClipPolyData> clip;
    clip->SetInputData(data);
    clip->SetClipFunction(function);
    clip->Update();
    vtkNew<vtkPolyData> kept;
    kept->ShallowCopy(clip->GetOutput());
    kept->SetFieldData(data->GetFieldData());
    data = kept;
  }
  return data;
}

/// The polygons that the mapper draws of a data set, before they are clipped; nullptr if none.
vtkSmartPointer<vtkPolyData> MakePolygons(vtkMapper* mapper, vtkDataSet* leaf, std::string& problem)
{
  if (DrawsGlyphs(mapper))
  {
    return MakeGlyphs(mapper, leaf, problem);
  }
  vtkSmartPointer<vtkPolyData> polygons = vtkPolyData::SafeDownCast(leaf);
  if (!polygons && vtkDataSetMapper::SafeDownCast(mapper))
  {
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputData(leaf);
    surface->Update();
    polygons = surface->GetOutput();
  }
  return polygons;
}

/// What a part is drawn in: nothing certain where scalars or a texture colour it.
std::optional<glm::dvec3> GetColour(
  const DrawnActor& drawn, vtkDataSet* leaf, const BlockStyle& style)
{
  if (style.Colour || drawn.Actor->GetTexture())
  {
    return drawn.Actor->GetTexture() ? std::nullopt : style.Colour;
  }
  vtkMapper* mapper = drawn.Mapper;
  int association = 0;
  if (mapper->GetScalarVisibility() &&
    vtkAbstractMapper::GetAbstractScalars(leaf, mapper->GetScalarMode(),
      mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), association))
  {
    return std::nullopt;
  }
  glm::dvec3 colour;
  drawn.Actor->GetProperty()->GetDiffuseColor(&colour.x);
  return colour;
}

/// Brings data that are drawn alike together.
class DrawnParts
{
public:
  void Add(vtkPolyData* data, double opacity, const std::optional<glm::dvec3>& colour)
  {
    const glm::dvec3 shown = colour.value_or(glm::dvec3(-1.0));
    vtkSmartPointer<vtkMultiBlockDataSet>& blocks =
      this->Blocks[{ opacity, shown.x, shown.y, shown.z }];
    if (!blocks)
    {
      blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
      this->Parts.push_back({ blocks, opacity, colour });
    }
    blocks->SetBlock(blocks->GetNumberOfBlocks(), data);
  }

  std::vector<DrawnPart> Parts;

private:
  std::map<std::tuple<double, double, double, double>, vtkSmartPointer<vtkMultiBlockDataSet>>
    Blocks;
};

/// Adds polygons by the opacities that they carry, times another one.
void AddByOpacity(
  DrawnParts& parts, vtkPolyData* polygons, double opacity, const std::optional<glm::dvec3>& colour)
{
  for (const auto& [own, part] : SplitByOpacity(polygons))
  {
    if (own * opacity > 0.0)
    {
      parts.Add(part, own * opacity, colour);
    }
  }
}

void AppendWord(std::vector<std::uint64_t>& words, double value)
{
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof(value));
  words.push_back(word);
}

} // namespace

std::string DescribeUnlikeShadow(const DrawnActor& drawn)
{
  if (DrawsGlyphs(drawn.Mapper) && HasTransparentTexture(drawn.Actor))
  {
    return "the transparency of its texture is not looked at: its whole glyphs cast shadows";
  }
  return "";
}

bool IsDrawnAsItIs(const DrawnActor& drawn)
{
  bool isAsItIs = drawn.Mapper->GetNumberOfClippingPlanes() == 0 && !DrawsGlyphs(drawn.Mapper) &&
    !DrawsPixelSolids(drawn) && !HasTransparentTexture(drawn.Actor);
  const double opacity = drawn.Actor->GetProperty()->GetOpacity();
  VisitLeaves(drawn,
    [&](vtkDataSet* leaf, const BlockStyle& style)
    {
      std::vector<std::uint64_t> words; // one word: no cell has an opacity of its own
      AppendOpacityState(words, drawn.Mapper, leaf);
      isAsItIs = isAsItIs && vtkPolyData::SafeDownCast(leaf) && style.Opacity == opacity &&
        !(style.Colour && opacity < 1.0) && words.size() == 1;
    });
  return isAsItIs;
}

bool IsKnown(vtkMapper* mapper)
{
  return vtkPolyDataMapper::SafeDownCast(mapper) || vtkDataSetMapper::SafeDownCast(mapper) ||
    vtkGlyph3DMapper::SafeDownCast(mapper);
}

std::vector<DrawnPart> FindDrawnParts(
  const DrawnActor& drawn, bool mayReceive, std::string& problem)
{
  const std::vector<Plane> planes = GetClippingPlanes(drawn);
  DrawnParts parts;
  VisitLeaves(drawn,
    [&](vtkDataSet* leaf, const BlockStyle& style)
    {
      vtkSmartPointer<vtkPolyData> polygons =
        style.IsVisible ? MakePolygons(drawn.Mapper, leaf, problem) : nullptr;
      if (!polygons)
      {
        return;
      }
      const std::optional<glm::dvec3> colour = GetColour(drawn, leaf, style);
      const bool receives = mayReceive && vtkShadowFieldData::ReadReceiver(leaf->GetFieldData());
      if (const auto solids = MakePixelSolids(drawn, polygons, problem))
      {
        if (receives)
        {
          solids->SetFieldData(nullptr); // the solids themselves show no shadows
        }
        AddByOpacity(parts, Clip(solids, planes), style.Opacity, colour);
      }
      if (drawn.Actor->GetProperty()->GetRepresentation() != VTK_SURFACE)
      {
        return;
      }
      if (receives)
      {
        parts.Add(Clip(polygons, planes), style.Opacity, colour);
        return;
      }
      if (!style.Colour && !DrawsGlyphs(drawn.Mapper))
      {
        polygons = WithOpacities(drawn.Mapper, polygons);
      }
      for (const auto& [alpha, piece] :
        SplitByTexture(drawn.Actor, Clip(polygons, planes), problem))
      {
        AddByOpacity(parts, piece, alpha * style.Opacity, colour);
      }
    });
  return parts.Parts;
}

void AppendDrawnState(std::vector<std::uint64_t>& words, const DrawnActor& drawn)
{
  for (const Plane& plane : GetClippingPlanes(drawn))
  {
    for (const double coefficient : plane)
    {
      AppendWord(words, coefficient);
    }
  }
  AppendTextureState(words, drawn.Actor);
  AppendPixelSolidState(words, drawn);
  VisitLeaves(drawn,
    [&](vtkDataSet* leaf, const BlockStyle& style)
    {
      AppendWord(words, style.Opacity);
      for (int i = 0; style.Colour && style.Opacity < 1.0 && i < 3; ++i)
      {
        AppendWord(words, (*style.Colour)[i]);
      }
      AppendOpacityState(words, drawn.Mapper, leaf);
      AppendGlyphState(words, drawn.Mapper, leaf);
    });
}

} // namespace penumbra

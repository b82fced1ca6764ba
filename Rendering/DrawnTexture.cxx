// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnTexture.h"

#include "AlphaMap.h"
#include "DrawnOpacity.h"
#include "PolyDataStructure.h"
#include "PolygonCells.h"
#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace penumbra
{
namespace
{

/// The texture that VTK's shaders take the opacity from: of physically based materials, that of the
/// base colour.
vtkTexture* FindTexture(vtkActor* actor)
{
  vtkProperty* property = actor->GetProperty();
  return property->GetInterpolation() == VTK_PBR ? property->GetTexture("albedoTex")
                                                 : actor->GetTexture();
}

/// The picture of a texture, up to date, and its colours, or what a lookup table makes these of.
struct Picture
{
  vtkImageData* Image = nullptr;
  vtkDataArray* Scalars = nullptr; ///< nullptr: there is no picture
  glm::ivec2 Size{ 0 };
};

/// As vtkOpenGLTexture finds it: the scalars of points or else of cells; one of three sizes is 1.
Picture FindPicture(vtkTexture* texture)
{
  if (!texture || texture->GetCubeMap() || !texture->GetInputAlgorithm())
  {
    return {};
  }
  texture->GetInputAlgorithm()->Update();
  Picture picture;
  picture.Image = texture->GetInput();
  if (!picture.Image)
  {
    return {};
  }
  glm::ivec3 size;
  picture.Image->GetDimensions(&size.x);
  picture.Scalars = picture.Image->GetPointData()->GetScalars();
  if (!picture.Scalars)
  {
    picture.Scalars = picture.Image->GetCellData()->GetScalars();
    size = glm::max(size - 1, glm::ivec3(1));
  }
  picture.Size = size.x == 1 ? glm::ivec2(size.y, size.z)
    : size.y == 1            ? glm::ivec2(size.x, size.z)
                             : glm::ivec2(size.x, size.y);
  const vtkIdType texels = static_cast<vtkIdType>(picture.Size.x) * picture.Size.y;
  const bool isFlat = static_cast<vtkIdType>(size.x) * size.y * size.z == texels && texels > 0;
  if (!isFlat || !picture.Scalars || picture.Scalars->GetNumberOfTuples() < texels)
  {
    return {};
  }
  return picture;
}

/// Whether the scalars are colours, and not values for the lookup table.
bool AreColours(vtkTexture* texture, vtkDataArray* scalars)
{
  return texture->GetColorMode() == VTK_COLOR_MODE_DIRECT_SCALARS ||
    (texture->GetColorMode() == VTK_COLOR_MODE_DEFAULT &&
      scalars->GetDataType() == VTK_UNSIGNED_CHAR);
}

/// What stands for opaque in the last component of colours; 0 if they have no alpha.
double GetLargestAlpha(vtkDataArray* colours)
{
  if (colours->GetNumberOfComponents() % 2 != 0)
  {
    return 0.0; // grey, or red, green and blue
  }
  switch (colours->GetDataType())
  {
    case VTK_UNSIGNED_CHAR:
      return VTK_UNSIGNED_CHAR_MAX;
    case VTK_UNSIGNED_SHORT:
      return VTK_UNSIGNED_SHORT_MAX;
    case VTK_FLOAT:
    case VTK_DOUBLE:
      return 1.0;
    default:
      return 0.0;
  }
}

TextureWrap GetWrap(vtkTexture* texture)
{
  switch (texture->GetWrap())
  {
    case vtkTexture::Repeat:
      return TextureWrap::Repeat;
    case vtkTexture::MirroredRepeat:
      return TextureWrap::Mirror;
    case vtkTexture::ClampToBorder:
      return TextureWrap::Border;
    default:
      return TextureWrap::Edge;
  }
}

/// The alpha of a texture that HasTransparentTexture().
AlphaTexels ReadAlpha(vtkTexture* texture)
{
  const Picture picture = FindPicture(texture);
  vtkSmartPointer<vtkDataArray> colours = picture.Scalars;
  if (!AreColours(texture, picture.Scalars))
  {
    constexpr int allComponents = -1;
    colours = vtkSmartPointer<vtkDataArray>::Take(texture->GetLookupTable()->MapScalars(
      picture.Scalars, texture->GetColorMode(), allComponents, VTK_RGBA));
  }
  AlphaTexels texels;
  texels.Size = picture.Size;
  texels.Wrap = GetWrap(texture);
  // What is not a number is transparent.
  const auto clamp = [](double alpha) { return alpha > 0.0 ? std::min(alpha, 1.0) : 0.0; };
  texels.Border = clamp(texture->GetBorderColor()[3]);
  const double largest = GetLargestAlpha(colours);
  const vtkIdType count = static_cast<vtkIdType>(picture.Size.x) * picture.Size.y;
  texels.Alpha.reserve(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double alpha = colours->GetComponent(i, colours->GetNumberOfComponents() - 1);
    texels.Alpha.push_back(clamp(alpha / largest));
  }
  return texels;
}

/// The matrix that vtkOpenGLActor applies to all texture coordinates; nullptr if there is none.
const double* GetTextureMatrix(vtkActor* actor)
{
  vtkTexture* texture = actor->GetTexture();
  vtkTransform* transform = texture ? texture->GetTransform() : nullptr;
  return transform ? transform->GetMatrix()->GetData() : nullptr;
}

/// Texture coordinates as the shaders have them at each point.
std::vector<glm::dvec2> FindPlaces(vtkActor* actor, vtkDataArray* coordinates)
{
  const double* matrix = GetTextureMatrix(actor);
  std::vector<glm::dvec2> places;
  for (vtkIdType i = 0; i < coordinates->GetNumberOfTuples(); ++i)
  {
    glm::dvec2& place = places.emplace_back(0.0);
    place.x = coordinates->GetComponent(i, 0);
    place.y = coordinates->GetNumberOfComponents() > 1 ? coordinates->GetComponent(i, 1) : 0.0;
    if (matrix)
    {
      const auto row = [&](int r)
      { return matrix[4 * r] * place.x + matrix[4 * r + 1] * place.y + matrix[4 * r + 3]; };
      place = glm::dvec2(row(0), row(1)) / row(3);
    }
  }
  return places;
}

/// Triangles that wear a texture, with the opacities of their data.
class TexturedTriangles
{
public:
  TexturedTriangles(vtkActor* actor, vtkPolyData* data)
    : Data(data)
    , Polygons(JoinStrips(data, this->Origins))
    , Places(FindPlaces(actor, data->GetPointData()->GetTCoords()))
    , OfPoints(data->GetPointData()->GetArray(OpacityArray))
    , OfCells(data->GetCellData()->GetArray(OpacityArray))
  {
  }

  /// Calls visit(piece, opacity of its cell) for all that the map leaves, until that is false.
  template <typename Visitor>
  bool Visit(const AlphaMap& map, Visitor&& visit) const
  {
    bool goesOn = true;
    VisitTriangles(this->Polygons, this->Data->GetPoints(),
      [&](vtkIdType polygon, const std::array<vtkIdType, 3>& ids)
      {
        if (!goesOn)
        {
          return;
        }
        std::array<AlphaMap::Corner, 3> triangle;
        bool isInRange = true;
        for (std::size_t i = 0; i < ids.size(); ++i)
        {
          triangle[i] = this->GetCorner(ids[i]);
          isInRange = isInRange && IsInRange(triangle[i].Place);
        }
        const double opacity =
          this->OfCells ? this->OfCells->GetComponent(this->Origins->GetId(polygon), 0) : 0.0;
        const auto visitPiece = [&](const AlphaMap::Piece& piece) { return visit(piece, opacity); };
        goesOn = isInRange ? map.VisitPieces(triangle, visitPiece)
                           : visitPiece({ 1.0, { triangle.begin(), triangle.end() } });
      });
    return goesOn;
  }

  std::size_t Count() const
  {
    std::size_t count = 0;
    VisitTriangles(this->Polygons, this->Data->GetPoints(),
      [&count](vtkIdType, const std::array<vtkIdType, 3>&) { ++count; });
    return count;
  }

  bool HasPointOpacities() const { return this->OfPoints != nullptr; }
  bool HasCellOpacities() const { return this->OfCells != nullptr; }

private:
  /// Texture coordinates that floats, which shaders have, place in the texture at all.
  static bool IsInRange(const glm::dvec2& place)
  {
    constexpr double largest = 1 << 24;
    return std::abs(place.x) <= largest && std::abs(place.y) <= largest;
  }

  AlphaMap::Corner GetCorner(vtkIdType id) const
  {
    AlphaMap::Corner corner;
    this->Data->GetPoint(id, &corner.Point.x);
    corner.Place = this->Places[static_cast<std::size_t>(id)];
    corner.Value = this->OfPoints ? this->OfPoints->GetComponent(id, 0) : 0.0;
    return corner;
  }

  vtkPolyData* Data;
  vtkNew<vtkIdList> Origins;
  vtkSmartPointer<vtkCellArray> Polygons;
  std::vector<glm::dvec2> Places;
  vtkDataArray* OfPoints;
  vtkDataArray* OfCells;
};

/// Polygonal data of one alpha, as they grow.
class TexturedPart
{
public:
  TexturedPart(vtkPolyData* data, const TexturedTriangles& triangles)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    this->Part->SetPoints(points);
    this->Part->SetPolys(vtkNew<vtkCellArray>());
    this->Part->SetFieldData(data->GetFieldData());
    this->Opacities->SetName(OpacityArray);
    this->AreOfPoints = triangles.HasPointOpacities();
    if (this->AreOfPoints)
    {
      this->Part->GetPointData()->AddArray(this->Opacities);
    }
    else if (triangles.HasCellOpacities())
    {
      this->Part->GetCellData()->AddArray(this->Opacities);
    }
  }

  void Add(const AlphaMap::Piece& piece, double cellOpacity)
  {
    const auto toByte = [](double value) { return static_cast<unsigned char>(std::lround(value)); };
    const vtkIdType first = this->Part->GetNumberOfPoints();
    for (const AlphaMap::Corner& corner : piece.Corners)
    {
      this->Part->GetPoints()->InsertNextPoint(&corner.Point.x);
      if (this->AreOfPoints)
      {
        this->Opacities->InsertNextValue(toByte(corner.Value));
      }
    }
    const auto count = static_cast<vtkIdType>(piece.Corners.size());
    for (std::size_t i = 0; i < piece.CountTriangles(); ++i)
    {
      const auto second = static_cast<vtkIdType>(i + 1), third = second + 1;
      this->Part->GetPolys()->InsertNextCell(
        { first, first + second, first + (third < count ? third : 1) });
      if (!this->AreOfPoints)
      {
        this->Opacities->InsertNextValue(toByte(cellOpacity));
      }
    }
  }

  vtkNew<vtkPolyData> Part;

private:
  vtkNew<vtkUnsignedCharArray> Opacities;
  bool AreOfPoints;
};

/// The finest map that adds at most MostTexturedTriangles; `step` becomes the texels that it takes
/// together.
AlphaMap FindMap(const TexturedTriangles& triangles, const AlphaTexels& texels, int& step)
{
  const std::size_t most = triangles.Count() + MostTexturedTriangles;
  for (;; step *= 2)
  {
    AlphaMap map(texels, step, MostOpacities);
    std::size_t count = 0;
    const bool isAll = triangles.Visit(map,
      [&](const AlphaMap::Piece& piece, double)
      {
        count += piece.CountTriangles();
        return count <= most;
      });
    if (isAll || step >= std::max(texels.Size.x, texels.Size.y))
    {
      return map;
    }
  }
}

} // namespace

bool HasTransparentTexture(vtkActor* actor)
{
  vtkTexture* texture = FindTexture(actor);
  const Picture picture = FindPicture(texture);
  if (!picture.Scalars)
  {
    return false;
  }
  if (!AreColours(texture, picture.Scalars))
  {
    vtkScalarsToColors* table = texture->GetLookupTable();
    return table && !table->IsOpaque();
  }
  const double largest = GetLargestAlpha(picture.Scalars);
  double range[2] = { 0.0, 0.0 };
  if (largest > 0.0)
  {
    picture.Scalars->GetRange(range, picture.Scalars->GetNumberOfComponents() - 1);
  }
  return range[0] < largest;
}

std::multimap<double, vtkSmartPointer<vtkPolyData>> SplitByTexture(
  vtkActor* actor, vtkPolyData* data, std::string& problem)
{
  vtkDataArray* coordinates = data->GetPointData()->GetTCoords();
  const int components = coordinates ? coordinates->GetNumberOfComponents() : 0;
  const bool isDrawnWith = HasTransparentTexture(actor) && (components == 1 || components == 2) &&
    coordinates->GetNumberOfTuples() >= data->GetNumberOfPoints();
  if (!isDrawnWith || !FindStructureProblem(data).empty())
  {
    return { { 1.0, data } };
  }
  const AlphaTexels texels = ReadAlpha(FindTexture(actor));
  const int least =
    (std::max(texels.Size.x, texels.Size.y) + MostAlphaTexels - 1) / MostAlphaTexels;
  int step = least;
  const TexturedTriangles triangles(actor, data);
  const AlphaMap map = FindMap(triangles, texels, step);
  if (step > least)
  {
    problem = "the alpha of its texture is taken in means of " + std::to_string(step) + " x " +
      std::to_string(step) + " texels: finer ones would cut its polygons into more than " +
      std::to_string(MostTexturedTriangles) + " triangles besides their own";
  }
  std::map<double, TexturedPart> parts;
  triangles.Visit(map,
    [&](const AlphaMap::Piece& piece, double cellOpacity)
    {
      parts.try_emplace(piece.Alpha, data, triangles).first->second.Add(piece, cellOpacity);
      return true;
    });
  std::multimap<double, vtkSmartPointer<vtkPolyData>> result;
  for (const auto& [alpha, part] : parts)
  {
    result.emplace(alpha, part.Part);
  }
  return result;
}

void AppendTextureState(std::vector<std::uint64_t>& words, vtkActor* actor)
{
  if (!HasTransparentTexture(actor))
  {
    words.push_back(0);
    return;
  }
  vtkTexture* texture = FindTexture(actor);
  const Picture picture = FindPicture(texture);
  vtkScalarsToColors* table = texture->GetLookupTable();
  words.push_back(reinterpret_cast<std::uintptr_t>(picture.Image));
  words.push_back(picture.Image->GetMTime());
  words.push_back(reinterpret_cast<std::uintptr_t>(picture.Scalars));
  words.push_back(picture.Scalars->GetMTime());
  words.push_back(table ? table->GetMTime() : 0);
  words.push_back(static_cast<std::uint64_t>(texture->GetWrap()));
  words.push_back(static_cast<std::uint64_t>(texture->GetColorMode()));
  const auto append = [&words](double value)
  { std::memcpy(&words.emplace_back(), &value, sizeof(value)); };
  append(static_cast<double>(texture->GetBorderColor()[3]));
  const double* matrix = GetTextureMatrix(actor);
  for (int i = 0; matrix && i < 16; ++i)
  {
    append(matrix[i]);
  }
}

} // namespace penumbra

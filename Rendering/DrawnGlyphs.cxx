// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnGlyphs.h"

#include "DrawnOpacity.h"
#include "DrawnSurface.h"
#include "PolyDataStructure.h"
#include "Vectors.h"
#include "vtkActor.h"
#include "vtkBitArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkGlyph3DMapper.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPointGaussianMapper.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkQuaternion.h"
#include "vtkTriangleFilter.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <utility>

namespace penumbra
{
namespace
{

using Triangle = std::array<std::size_t, 3>;

/// A glyph in its own coordinates.
struct Shape
{
  std::vector<glm::dvec3> Points;
  std::vector<Triangle> Triangles;
};

/// Where and how a shape is drawn.
struct Instance
{
  std::size_t Shape = 0;
  vtkIdType Point = 0;
  glm::dmat3 Axes{ 1.0 };
};

/// What vtkGlyph3DMapper tells its subclasses alone. A pointer to the member, which a subclass may
/// form, can be applied to any mapper.
struct GlyphArrays : public vtkGlyph3DMapper
{
  static std::array<vtkDataArray*, 4> Get(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return { mapper->GetMasking() ? (mapper->*(&GlyphArrays::GetMaskArray))(data) : nullptr,
      (mapper->*(&GlyphArrays::GetSourceIndexArray))(data),
      (mapper->*(&GlyphArrays::GetOrientationArray))(data),
      (mapper->*(&GlyphArrays::GetScaleArray))(data) };
  }
};

void AddTriangles(vtkPolyData* data, Shape& shape)
{
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(data);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  vtkPolyData* triangles = triangulate->GetOutput();
  const std::size_t first = shape.Points.size();
  for (vtkIdType i = 0; i < triangles->GetNumberOfPoints(); ++i)
  {
    triangles->GetPoint(i, &shape.Points.emplace_back().x);
  }
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < triangles->GetNumberOfPolys(); ++i)
  {
    triangles->GetPolys()->GetCellAtId(i, cell);
    if (cell->GetNumberOfIds() == 3)
    {
      shape.Triangles.push_back({ first + static_cast<std::size_t>(cell->GetId(0)),
        first + static_cast<std::size_t>(cell->GetId(1)),
        first + static_cast<std::size_t>(cell->GetId(2)) });
    }
  }
}

/// A source of glyphs, polygonal data or a tree of them.
Shape MakeShape(vtkDataObject* source)
{
  Shape shape;
  if (auto* polygons = vtkPolyData::SafeDownCast(source))
  {
    AddTriangles(polygons, shape);
  }
  else if (auto* tree = vtkCompositeDataSet::SafeDownCast(source))
  {
    const auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      if (auto* leaf = vtkPolyData::SafeDownCast(it->GetCurrentDataObject()))
      {
        AddTriangles(leaf, shape);
      }
    }
  }
  return shape;
}

std::vector<vtkDataObject*> GetSources(vtkGlyph3DMapper* mapper)
{
  std::vector<vtkDataObject*> sources;
  vtkDataObjectTree* tree =
    mapper->GetUseSourceTableTree() ? mapper->GetSourceTableTree() : nullptr;
  if (tree)
  {
    const auto it = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(tree->NewTreeIterator());
    it->TraverseSubTreeOff();
    it->VisitOnlyLeavesOff();
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      sources.push_back(it->GetCurrentDataObject());
    }
    return sources;
  }
  for (int i = 0; i < mapper->GetNumberOfInputConnections(1); ++i)
  {
    sources.push_back(mapper->GetSource(i));
  }
  return sources;
}

/// The turn that an orientation stands for, as vtkOpenGLGlyph3DMapper applies it.
glm::dmat3 MakeTurn(int mode, double orientation[4])
{
  vtkQuaterniond turn;
  const auto turnAbout = [](double degrees, const glm::dvec3& axis)
  {
    const double half = 0.5 * vtkMath::RadiansFromDegrees(degrees);
    const glm::dvec3 v = std::sin(half) * axis;
    return vtkQuaterniond(std::cos(half), v.x, v.y, v.z);
  };
  if (mode == vtkGlyph3DMapper::QUATERNION)
  {
    turn.Set(orientation);
  }
  else if (mode == vtkGlyph3DMapper::ROTATION)
  {
    turn = turnAbout(orientation[2], { 0, 0, 1 }) * turnAbout(orientation[0], { 1, 0, 0 }) *
      turnAbout(orientation[1], { 0, 1, 0 });
  }
  else if (orientation[1] != 0.0 || orientation[2] != 0.0)
  {
    // Half a turn about the line halfway between x and the direction.
    const glm::dvec3 to(orientation[0], orientation[1], orientation[2]);
    const glm::dvec3 half = glm::normalize(to + glm::dvec3(glm::length(to), 0, 0));
    turn.Set(0.0, half.x, half.y, half.z);
  }
  else if (orientation[0] < 0.0)
  {
    turn.Set(0.0, 0.0, 1.0, 0.0);
  }
  double rows[3][3];
  turn.ToMatrix3x3(rows);
  glm::dmat3 matrix;
  for (int i = 0; i < 9; ++i)
  {
    matrix[i % 3][i / 3] = rows[i / 3][i % 3];
  }
  return matrix;
}

double GetRangeWidth(vtkGlyph3DMapper* mapper)
{
  const double width = mapper->GetRange()[1] - mapper->GetRange()[0];
  return width == 0.0 ? 1.0 : width;
}

/// The scales along the glyph's axes at a point.
glm::dvec3 MakeScale(vtkGlyph3DMapper* mapper, vtkDataArray* array, vtkIdType point)
{
  glm::dvec3 scale(1.0);
  if (!mapper->GetScaling())
  {
    return scale;
  }
  if (array && mapper->GetScaleMode() == vtkGlyph3DMapper::SCALE_BY_MAGNITUDE)
  {
    std::vector<double> tuple(static_cast<std::size_t>(array->GetNumberOfComponents()));
    array->GetTuple(point, tuple.data());
    scale = glm::dvec3(vtkMath::Norm(tuple.data(), array->GetNumberOfComponents()));
  }
  else if (array && mapper->GetScaleMode() == vtkGlyph3DMapper::SCALE_BY_COMPONENTS &&
    array->GetNumberOfComponents() == 3)
  {
    array->GetTuple(point, &scale.x);
  }
  if (array && mapper->GetClamping() && mapper->GetScaleMode() != vtkGlyph3DMapper::NO_DATA_SCALING)
  {
    const double* range = mapper->GetRange();
    scale = (glm::clamp(scale, range[0], std::max(range[0], range[1])) - range[0]) /
      GetRangeWidth(mapper);
  }
  return scale * mapper->GetScaleFactor();
}

std::size_t ChooseShape(
  vtkGlyph3DMapper* mapper, vtkDataArray* array, vtkIdType point, std::size_t shapes)
{
  if (!array || shapes < 2)
  {
    return 0;
  }
  std::vector<double> tuple(static_cast<std::size_t>(array->GetNumberOfComponents()));
  array->GetTuple(point, tuple.data());
  const double value = vtkMath::Norm(tuple.data(), array->GetNumberOfComponents());
  const double place =
    (value - mapper->GetRange()[0]) * static_cast<double>(shapes) / GetRangeWidth(mapper);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(shapes - 1)));
}

std::vector<Instance> PlaceGlyphs(vtkGlyph3DMapper* mapper, vtkDataSet* data, std::size_t shapes)
{
  const auto [masks, indices, orientations, scales] = GlyphArrays::Get(mapper, data);
  std::vector<Instance> instances;
  for (vtkIdType i = 0; shapes > 0 && i < data->GetNumberOfPoints(); ++i)
  {
    if (vtkBitArray::SafeDownCast(masks) && masks->GetComponent(i, 0) == 0.0)
    {
      continue;
    }
    Instance& instance = instances.emplace_back();
    instance.Shape = ChooseShape(mapper, indices, i, shapes);
    instance.Point = i;
    const int components = mapper->GetOrientationMode() == vtkGlyph3DMapper::QUATERNION ? 4 : 3;
    if (orientations && orientations->GetNumberOfComponents() == components)
    {
      double orientation[4];
      orientations->GetTuple(i, orientation);
      instance.Axes = MakeTurn(mapper->GetOrientationMode(), orientation);
    }
    const glm::dvec3 scale = MakeScale(mapper, scales, i);
    for (int axis = 0; axis < 3; ++axis)
    {
      instance.Axes[axis] *= scale[axis];
    }
  }
  return instances;
}

/// An icosahedron whose triangles are divided into 16.
Shape MakeBall()
{
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Shape ball;
  for (const double a : { -1.0, 1.0 })
  {
    for (const double b : { -g, g })
    {
      ball.Points.insert(ball.Points.end(), { { a, b, 0 }, { 0, a, b }, { b, 0, a } });
    }
  }
  // Its faces are the triples of points that are 2 apart.
  const auto areNear = [&](std::size_t i, std::size_t j)
  { return std::abs(glm::distance(ball.Points[i], ball.Points[j]) - 2.0) < 0.1; };
  for (std::size_t i = 0; i < 12; ++i)
  {
    for (std::size_t j = i + 1; j < 12; ++j)
    {
      for (std::size_t k = j + 1; k < 12; ++k)
      {
        if (areNear(i, j) && areNear(j, k) && areNear(i, k))
        {
          ball.Triangles.push_back({ i, j, k });
        }
      }
    }
  }
  for (int division = 0; division < 2; ++division)
  {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto getMiddle = [&](std::size_t i, std::size_t j)
    {
      const auto [at, isNew] = middles.emplace(std::minmax(i, j), ball.Points.size());
      if (isNew)
      {
        const glm::dvec3 middle = 0.5 * (ball.Points[i] + ball.Points[j]);
        ball.Points.push_back(middle / glm::length(middle) * glm::length(ball.Points[0]));
      }
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [i, j, k] : ball.Triangles)
    {
      const std::size_t a = getMiddle(i, j), b = getMiddle(j, k), c = getMiddle(k, i);
      finer.insert(finer.end(), { { i, a, c }, { a, j, b }, { c, b, k }, { a, b, c } });
    }
    ball.Triangles = finer;
  }
  // Corners lie as far out as makes up for the flat triangles between them.
  constexpr double CornerRadius = 1.016;
  for (glm::dvec3& point : ball.Points)
  {
    point = glm::normalize(point) * CornerRadius;
  }
  return ball;
}

/// The array that the mapper's balls are scaled by, if it is there.
vtkDataArray* GetRadii(vtkPointGaussianMapper* mapper, vtkDataSet* data)
{
  return mapper->GetScaleArray() ? data->GetPointData()->GetArray(mapper->GetScaleArray())
                                 : nullptr;
}

std::vector<Instance> PlaceBalls(vtkPointGaussianMapper* mapper, vtkPolyData* data)
{
  std::vector<Instance> instances;
  if (mapper->GetEmissive()) // what only adds light blocks none
  {
    return instances;
  }
  vtkDataArray* radii = GetRadii(mapper, data);
  const auto place = [&](vtkIdType point)
  {
    double radius = radii
      ? radii->GetComponent(point,
          std::clamp(mapper->GetScaleArrayComponent(), 0, radii->GetNumberOfComponents() - 1))
      : 1.0;
    if (radii && mapper->GetScaleFunction())
    {
      radius = mapper->GetScaleFunction()->GetValue(radius);
    }
    radius *= mapper->GetScaleFactor();
    if (radius > 0.0)
    {
      instances.push_back({ 0, point, glm::dmat3(radius) });
    }
  };
  if (data->GetNumberOfVerts() == 0)
  {
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      place(i);
    }
    return instances;
  }
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < data->GetNumberOfVerts(); ++i)
  {
    data->GetVerts()->GetCellAtId(i, cell);
    std::for_each(cell->begin(), cell->end(), place);
  }
  return instances;
}

vtkSmartPointer<vtkPolyData> Assemble(const std::vector<Shape>& shapes,
  const std::vector<Instance>& instances, vtkMapper* mapper, vtkDataSet* data)
{
  bool areOfCells = false;
  const vtkSmartPointer<vtkUnsignedCharArray> shown = FindOpacities(mapper, data, areOfCells);
  auto result = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkUnsignedCharArray> opacities;
  opacities->SetName(OpacityArray);
  for (const Instance& instance : instances)
  {
    const Shape& shape = shapes[instance.Shape];
    const vtkIdType first = points->GetNumberOfPoints();
    glm::dvec3 centre;
    data->GetPoint(instance.Point, &centre.x);
    for (const glm::dvec3& point : shape.Points)
    {
      const glm::dvec3 placed = centre + instance.Axes * point;
      points->InsertNextPoint(&placed.x);
    }
    for (const Triangle& triangle : shape.Triangles)
    {
      const vtkIdType ids[] = { first + static_cast<vtkIdType>(triangle[0]),
        first + static_cast<vtkIdType>(triangle[1]), first + static_cast<vtkIdType>(triangle[2]) };
      triangles->InsertNextCell(3, ids);
      if (shown && !areOfCells)
      {
        opacities->InsertNextValue(shown->GetValue(instance.Point));
      }
    }
  }
  result->SetPoints(points);
  result->SetPolys(triangles);
  result->SetFieldData(data->GetFieldData());
  if (shown && !areOfCells)
  {
    result->GetCellData()->AddArray(opacities);
  }
  return result;
}

/// The glyphs, unless they are too many.
vtkSmartPointer<vtkPolyData> AssembleIfFew(const std::vector<Shape>& shapes,
  const std::vector<Instance>& instances, vtkMapper* mapper, vtkDataSet* data, std::string& problem)
{
  double triangles = 0.0;
  for (const Instance& instance : instances)
  {
    triangles += static_cast<double>(shapes[instance.Shape].Triangles.size());
  }
  if (triangles > MostGlyphTriangles)
  {
    problem = std::to_string(instances.size()) + " glyphs have " +
      std::to_string(static_cast<long long>(triangles)) +
      " triangles; allowed: 4000000. They cast no shadow";
    return vtkSmartPointer<vtkPolyData>::New();
  }
  return Assemble(shapes, instances, mapper, data);
}

/// A closed prism about the x axis, from 0 to 1.
Shape MakePrism()
{
  constexpr std::size_t Sides = 8;
  // By Cauchy's formula, the mean width of the prism's section is its perimeter over pi; this is
  // the radius of its corners at which that is the diameter of a circle of radius 1.
  const double step = 2.0 * vtkMath::Pi() / Sides;
  const double cornerRadius = vtkMath::Pi() / (Sides * std::sin(0.5 * step));
  Shape prism;
  for (const double x : { 0.0, 1.0 })
  {
    for (std::size_t i = 0; i < Sides; ++i)
    {
      const double angle = step * static_cast<double>(i);
      prism.Points.push_back({ x, cornerRadius * std::cos(angle), cornerRadius * std::sin(angle) });
    }
  }
  for (std::size_t i = 0; i < Sides; ++i)
  {
    const std::size_t j = (i + 1) % Sides;
    prism.Triangles.push_back({ i, j, j + Sides });
    prism.Triangles.push_back({ i, j + Sides, i + Sides });
    if (i > 0 && j > 0)
    {
      prism.Triangles.push_back({ 0, j, i });
      prism.Triangles.push_back({ Sides, i + Sides, j + Sides });
    }
  }
  return prism;
}

/// Calls visit(ids) for each cell of the array.
template <typename Visitor>
void VisitCells(vtkCellArray* cells, Visitor&& visit)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i)
  {
    cells->GetCellAtId(i, ids);
    visit(ids.Get());
  }
}

bool DrawsBalls(vtkProperty* property)
{
  return property->GetRenderPointsAsSpheres();
}

bool DrawsTubes(vtkProperty* property)
{
  return property->GetRenderLinesAsTubes() && property->GetLineWidth() > 1.0 && // as VTK does
    property->GetRepresentation() != VTK_POINTS;
}

/// The points that are drawn as points.
std::set<vtkIdType> FindPoints(vtkProperty* property, vtkPolyData* data)
{
  std::vector<vtkCellArray*> drawn = { data->GetVerts() };
  if (property->GetRepresentation() == VTK_POINTS || property->GetVertexVisibility())
  {
    drawn.insert(drawn.end(), { data->GetLines(), data->GetPolys(), data->GetStrips() });
  }
  std::set<vtkIdType> points;
  for (vtkCellArray* cells : drawn)
  {
    VisitCells(cells, [&](vtkIdList* ids) { points.insert(ids->begin(), ids->end()); });
  }
  return points;
}

/// The pairs of points between which lines are drawn.
std::set<std::pair<vtkIdType, vtkIdType>> FindLines(vtkProperty* property, vtkPolyData* data)
{
  std::set<std::pair<vtkIdType, vtkIdType>> lines;
  const auto addLines = [&](vtkIdList* ids, vtkIdType step)
  {
    for (vtkIdType i = step; i < ids->GetNumberOfIds(); ++i)
    {
      lines.insert(std::minmax(ids->GetId(i - step), ids->GetId(i)));
    }
  };
  VisitCells(data->GetLines(), [&](vtkIdList* ids) { addLines(ids, 1); });
  if (property->GetRepresentation() != VTK_WIREFRAME)
  {
    return lines;
  }
  VisitCells(data->GetPolys(),
    [&](vtkIdList* ids)
    {
      addLines(ids, 1);
      addLines(
        ids, std::max<vtkIdType>(ids->GetNumberOfIds() - 1, 1)); // from the last to the first
    });
  VisitCells(data->GetStrips(),
    [&](vtkIdList* ids)
    {
      addLines(ids, 1);
      addLines(ids, 2);
    });
  return lines;
}

glm::dmat3 GetAxes(vtkMatrix4x4* matrix)
{
  glm::dmat3 axes(1.0);
  for (int i = 0; matrix && i < 9; ++i)
  {
    axes[i % 3][i / 3] = matrix->GetElement(i / 3, i % 3);
  }
  return axes;
}

/// Axes in the world of a prism from 0 along the line.
glm::dmat3 AlignPrism(const glm::dvec3& line, double radius)
{
  const glm::dvec3 size = glm::abs(line);
  const glm::dvec3 away = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
    : size.y <= size.z                                         ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  const glm::dvec3 side = glm::normalize(glm::cross(line, away));
  return { line, radius * side, radius * glm::normalize(glm::cross(line, side)) };
}

void AppendValue(std::vector<std::uint64_t>& words, double value)
{
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof(value));
  words.push_back(word);
}

void AppendObject(std::vector<std::uint64_t>& words, vtkObject* object)
{
  words.push_back(reinterpret_cast<std::uintptr_t>(object));
  words.push_back(object ? object->GetMTime() : 0);
}

} // namespace

bool DrawsGlyphs(vtkMapper* mapper)
{
  return vtkGlyph3DMapper::SafeDownCast(mapper) || vtkPointGaussianMapper::SafeDownCast(mapper);
}

vtkSmartPointer<vtkPolyData> MakeGlyphs(vtkMapper* mapper, vtkDataSet* data, std::string& problem)
{
  std::vector<Shape> shapes;
  std::vector<Instance> instances;
  if (auto* glyphs = vtkGlyph3DMapper::SafeDownCast(mapper))
  {
    for (vtkDataObject* source : GetSources(glyphs))
    {
      shapes.push_back(MakeShape(source));
    }
    instances = PlaceGlyphs(glyphs, data, shapes.size());
  }
  else if (auto* points = vtkPolyData::SafeDownCast(data))
  {
    shapes.push_back(MakeBall());
    instances = PlaceBalls(vtkPointGaussianMapper::SafeDownCast(mapper), points);
  }
  return AssembleIfFew(shapes, instances, mapper, data, problem);
}

bool DrawsPixelSolids(const DrawnActor& drawn)
{
  vtkProperty* property = drawn.Actor->GetProperty();
  return !DrawsGlyphs(drawn.Mapper) && (DrawsBalls(property) || DrawsTubes(property));
}

vtkSmartPointer<vtkPolyData> MakePixelSolids(
  const DrawnActor& drawn, vtkPolyData* data, std::string& problem)
{
  const glm::dmat3 toWorld = GetAxes(drawn.Matrix);
  if (!DrawsPixelSolids(drawn) || !FindStructureProblem(data).empty() ||
    glm::determinant(toWorld) == 0.0 || drawn.PixelLength <= 0.0)
  {
    return nullptr;
  }
  vtkProperty* property = drawn.Actor->GetProperty();
  const glm::dmat3 toData = glm::inverse(toWorld);
  std::vector<Instance> instances;
  if (DrawsBalls(property))
  {
    const double radius = 0.5 * property->GetPointSize() * drawn.PixelLength;
    for (const vtkIdType point : FindPoints(property, data))
    {
      instances.push_back({ 0, point, radius * toData });
    }
  }
  if (DrawsTubes(property))
  {
    const double radius = 0.5 * property->GetLineWidth() * drawn.PixelLength;
    for (const auto& [from, to] : FindLines(property, data))
    {
      glm::dvec3 start, end;
      data->GetPoint(from, &start.x);
      data->GetPoint(to, &end.x);
      const glm::dvec3 line = toWorld * (end - start);
      if (glm::length(line) > 0.0)
      {
        instances.push_back({ 1, from, toData * AlignPrism(line, radius) });
      }
    }
  }
  return instances.empty()
    ? nullptr
    : AssembleIfFew({ MakeBall(), MakePrism() }, instances, drawn.Mapper, data, problem);
}

void AppendPixelSolidState(std::vector<std::uint64_t>& words, const DrawnActor& drawn)
{
  if (!DrawsPixelSolids(drawn))
  {
    return;
  }
  vtkProperty* property = drawn.Actor->GetProperty();
  for (const double value : { static_cast<double>(property->GetRepresentation()),
         static_cast<double>(property->GetVertexVisibility()),
         DrawsBalls(property) ? static_cast<double>(property->GetPointSize()) : 0.0,
         DrawsTubes(property) ? static_cast<double>(property->GetLineWidth()) : 0.0 })
  {
    AppendValue(words, value);
  }
}

void AppendGlyphState(std::vector<std::uint64_t>& words, vtkMapper* mapper, vtkDataSet* data)
{
  if (auto* glyphs = vtkGlyph3DMapper::SafeDownCast(mapper))
  {
    for (vtkDataObject* source : GetSources(glyphs))
    {
      AppendObject(words, source);
    }
    for (vtkDataArray* array : GlyphArrays::Get(glyphs, data))
    {
      AppendObject(words, array);
    }
    for (const double value :
      { static_cast<double>(glyphs->GetScaling()), static_cast<double>(glyphs->GetScaleMode()),
        glyphs->GetScaleFactor(), static_cast<double>(glyphs->GetOrientationMode()),
        static_cast<double>(glyphs->GetClamping()), glyphs->GetRange()[0], glyphs->GetRange()[1] })
    {
      AppendValue(words, value);
    }
  }
  else if (auto* balls = vtkPointGaussianMapper::SafeDownCast(mapper))
  {
    AppendObject(words, GetRadii(balls, data));
    AppendObject(words, balls->GetScaleFunction());
    AppendValue(words, balls->GetScaleFactor());
    AppendValue(words, balls->GetScaleArrayComponent());
    AppendValue(words, balls->GetEmissive());
  }
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShadowSceneBuilder.h"

#include "Coordinates.h"
#include "PlanarRegions.h"
#include "PolyDataStructure.h"
#include "PolygonCells.h"
#include "ProxyPlane.h"
#include "ProxyReceiver.h"
#include "SurfaceLight.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkShadowFieldData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <tuple>

vtkStandardNewMacro(vtkShadowSceneBuilder);

namespace
{

/// Of each cell, the receiver region that it belongs to.
constexpr const char* RegionArray = "PenumbraRegion";

glm::dmat4 ToGlm(vtkMatrix4x4* matrix)
{
  glm::dmat4 result(1.0);
  for (int row = 0; matrix && row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = matrix->GetElement(row, column);
    }
  }
  return result;
}

/// How far the points may be off by the rounding of their type, along each axis.
glm::dvec3 GetRounding(vtkPoints* points)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return glm::dvec3(0.0);
  }
  double bounds[6];
  points->GetBounds(bounds);
  const glm::dvec3 largest = glm::max(glm::abs(glm::dvec3(bounds[0], bounds[2], bounds[4])),
    glm::abs(glm::dvec3(bounds[1], bounds[3], bounds[5])));
  const bool isDouble = points->GetDataType() == VTK_DOUBLE;
  return largest * (isDouble ? DBL_EPSILON : static_cast<double>(FLT_EPSILON));
}

/// Fills the surface's points, in world coordinates, and how far the rounding of their type puts
/// them off.
void TransformPoints(vtkPolyData* data, const glm::dmat4& matrix, penumbra::Surface& surface)
{
  vtkPoints* points = data->GetPoints();
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return;
  }
  surface.Points.resize(static_cast<std::size_t>(points->GetNumberOfPoints()));
  vtkSMPTools::For(0, points->GetNumberOfPoints(),
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        double p[3];
        points->GetPoint(i, p); // thread safe, unlike the overload that returns a pointer
        surface.Points[static_cast<std::size_t>(i)] =
          glm::dvec3(matrix * glm::dvec4(p[0], p[1], p[2], 1.0));
      }
    });
  const glm::dmat3 size(glm::abs(glm::dvec3(matrix[0])), glm::abs(glm::dvec3(matrix[1])),
    glm::abs(glm::dvec3(matrix[2])));
  surface.Rounding = size * GetRounding(points);
}

/// Of each point, the first one at the same place.
std::vector<int> MergePoints(const std::vector<glm::dvec3>& points)
{
  const auto isBefore = [&](int a, int b)
  {
    const glm::dvec3 &p = points[static_cast<std::size_t>(a)],
                     &q = points[static_cast<std::size_t>(b)];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  };
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  vtkSMPTools::Sort(order.begin(), order.end(), isBefore);
  std::vector<int> merged(points.size());
  int first = 0;
  for (const int i : order)
  {
    const auto at = static_cast<std::size_t>(i);
    first = points[at] == points[static_cast<std::size_t>(first)] && first < i ? first : i;
    merged[at] = first;
  }
  return merged;
}

/// The polygons over the surface's points, of which those at the same place become one.
/// A mirror turns their winding round: fronts stay fronts.
penumbra::PolygonMesh MakePolygonMesh(vtkPolyData* polygons, const penumbra::Surface& surface,
  const penumbra::ReceiverSettings& settings, bool isMirrored)
{
  penumbra::PolygonMesh mesh;
  mesh.Points = surface.Points;
  mesh.Rounding = glm::length(surface.Rounding);
  mesh.Tolerance = settings.PlanarityTolerance;
  if (!std::all_of(mesh.Points.begin(), mesh.Points.end(), penumbra::IsInRange))
  {
    return mesh; // a problem of its own
  }
  const std::vector<int> merged = MergePoints(mesh.Points);
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < polygons->GetNumberOfPolys(); ++i)
  {
    polygons->GetPolys()->GetCellAtId(i, cell);
    std::vector<int>& polygon = mesh.Polygons.emplace_back();
    for (vtkIdType j = 0; j < cell->GetNumberOfIds(); ++j)
    {
      polygon.push_back(merged[static_cast<std::size_t>(cell->GetId(j))]);
    }
    if (isMirrored)
    {
      std::reverse(polygon.begin(), polygon.end());
    }
  }
  return mesh;
}

/// All polygons as the one region of a receiver in a proxy plane.
penumbra::PlanarRegions PlaceOnProxy(const penumbra::PolygonMesh& mesh,
  const penumbra::ShadowScene& scene, penumbra::Receiver& receiver)
{
  const penumbra::ProxyReceiver proxy = penumbra::PlaceProxy(mesh, receiver.Settings, scene);
  receiver.Settings.Side = proxy.Side;
  receiver.ProxyCentre = proxy.Centre;
  penumbra::PlanarRegions region;
  region.RegionOfPolygon.assign(mesh.Polygons.size(), 0);
  region.Regions.emplace_back().Base = proxy.Base;
  region.Problem = proxy.Problem;
  return region;
}

/// Adds the receiver, or one for each of both sides.
void AddSides(penumbra::Receiver receiver, std::vector<penumbra::Receiver>& receivers)
{
  if (receiver.Settings.Side != penumbra::ReceiverSide::Both)
  {
    receivers.push_back(receiver);
    return;
  }
  receiver.IsOneOfBoth = true;
  receiver.Settings.Side = penumbra::ReceiverSide::Front;
  receivers.push_back(receiver);
  receiver.Settings.Side = penumbra::ReceiverSide::Back;
  receiver.IsTurned = true;
  receivers.push_back(receiver);
}

/// Only polygons: vertices and lines neither block nor receive, and strips become triangles.
vtkSmartPointer<vtkPolyData> WithoutStrips(vtkPolyData* data)
{
  auto polygons = vtkSmartPointer<vtkPolyData>::New();
  polygons->SetPoints(data->GetPoints());
  polygons->SetPolys(penumbra::JoinStrips(data));
  return polygons;
}

/// Fills the surface's triangles, and their regions if the data have RegionArray.
void Triangulate(vtkPolyData* polygons, penumbra::Surface& surface)
{
  auto* regions = vtkIntArray::SafeDownCast(polygons->GetCellData()->GetArray(RegionArray));
  penumbra::VisitTriangles(polygons->GetPolys(), polygons->GetPoints(),
    [&](vtkIdType polygon, const std::array<vtkIdType, 3>& corners)
    {
      surface.Triangles.push_back({ static_cast<std::uint32_t>(corners[0]),
        static_cast<std::uint32_t>(corners[1]), static_cast<std::uint32_t>(corners[2]) });
      if (regions)
      {
        surface.Regions.push_back(regions->GetValue(polygon));
      }
    });
}

/// Drops polygons with a point out of range; the answer is how many there were. They go
/// before they are triangulated: VTK may drop them silently.
vtkIdType DropInfinitePolygons(const penumbra::Surface& surface, vtkPolyData* polygons)
{
  if (std::all_of(surface.Points.begin(), surface.Points.end(), penumbra::IsInRange))
  {
    return 0;
  }
  vtkNew<vtkCellArray> kept;
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < polygons->GetNumberOfPolys(); ++i)
  {
    polygons->GetPolys()->GetCellAtId(i, cell);
    if (std::all_of(cell->begin(), cell->end(),
          [&](vtkIdType id)
          { return penumbra::IsInRange(surface.Points[static_cast<std::size_t>(id)]); }))
    {
      kept->InsertNextCell(cell);
    }
  }
  const vtkIdType dropped = polygons->GetNumberOfPolys() - kept->GetNumberOfCells();
  polygons->SetPolys(kept);
  return dropped;
}

std::vector<glm::dvec3> GetVertices(vtkPolyData* data, vtkIdType polygon)
{
  vtkNew<vtkIdList> cell;
  data->GetPolys()->GetCellAtId(polygon, cell);
  std::vector<glm::dvec3> vertices;
  for (const vtkIdType id : *cell)
  {
    glm::dvec3& vertex = vertices.emplace_back();
    data->GetPoint(id, &vertex.x);
  }
  return vertices;
}

/// The radiance of a light's cells is read by cell: what is wrong with it, or nothing.
std::string FindRadianceArrayProblem(vtkPolyData* data)
{
  const char* name = vtkShadowFieldData::GetRadianceArrayName();
  vtkDataArray* radiance = data->GetCellData()->GetArray(name);
  if (!radiance || radiance->GetNumberOfTuples() >= data->GetNumberOfCells())
  {
    return "";
  }
  return std::string(name) + " has " + std::to_string(radiance->GetNumberOfTuples()) +
    " values; allowed: one for each of the " + std::to_string(data->GetNumberOfCells()) + " cells";
}

/// The polygons as the cells of a light, with the radiance that their array gives them.
penumbra::SurfaceLight MakeSurfaceLight(vtkPolyData* data, const penumbra::LightSettings& settings)
{
  vtkDataArray* radiance =
    data->GetCellData()->GetArray(vtkShadowFieldData::GetRadianceArrayName());
  const vtkIdType first = data->GetNumberOfVerts() + data->GetNumberOfLines();
  std::vector<penumbra::PolygonLight> cells;
  for (vtkIdType i = 0; i < data->GetNumberOfPolys(); ++i)
  {
    cells.push_back(penumbra::PolygonLight::Convex(GetVertices(data, i)));
    cells.back().TwoSided = settings.TwoSided;
    if (radiance && radiance->GetNumberOfComponents() == 3)
    {
      radiance->GetTuple(first + i, &cells.back().Radiance.x);
    }
  }
  penumbra::SurfaceLight light(cells);
  light.Radiance = settings.Radiance;
  light.TwoSided = settings.TwoSided;
  light.Rounding = GetRounding(data->GetPoints());
  return light;
}

/// Calls visit() for each leaf that is visible; a block's own visibility overrides its parents'.
template <typename Visitor>
void VisitVisibleLeaves(
  vtkDataObject* data, vtkCompositeDataDisplayAttributes* attributes, bool visible, Visitor&& visit)
{
  if (data && attributes && attributes->HasBlockVisibility(data))
  {
    visible = attributes->GetBlockVisibility(data);
  }
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    vtkSmartPointer<vtkDataObjectTreeIterator> it;
    it.TakeReference(tree->NewTreeIterator());
    it->VisitOnlyLeavesOff();
    it->TraverseSubTreeOff();
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      VisitVisibleLeaves(it->GetCurrentDataObject(), attributes, visible, visit);
    }
  }
  else if (auto* leaf = vtkPolyData::SafeDownCast(data); leaf && visible)
  {
    visit(leaf);
  }
}

} // namespace

vtkShadowSceneBuilder::vtkShadowSceneBuilder() = default;
vtkShadowSceneBuilder::~vtkShadowSceneBuilder() = default;

void vtkShadowSceneBuilder::AddData(vtkDataObject* data, vtkMatrix4x4* matrix, int roles,
  const std::string& name, vtkCompositeDataDisplayAttributes* attributes)
{
  VisitVisibleLeaves(data, attributes, true,
    [&](vtkPolyData* leaf) { this->AddPolyData(leaf, matrix, roles, name); });
  for (penumbra::Surface& surface : this->Translucent)
  {
    this->Scene.Surfaces.push_back(std::move(surface));
  }
  this->Translucent.clear();
}

void vtkShadowSceneBuilder::AddPolyData(
  vtkPolyData* data, vtkMatrix4x4* matrix, int roles, const std::string& name)
{
  if (const auto light = vtkShadowFieldData::ReadLight(data->GetFieldData()))
  {
    if (roles & Role::Light)
    {
      this->AddLight(data, *light, matrix, name);
    }
    return;
  }
  const std::string refusal = vtkShadowFieldData::ReadRefusal(data->GetFieldData());
  std::optional<penumbra::ReceiverSettings> settings;
  if (refusal.empty() && (roles & (Role::Receiver | Role::DefaultReceiver)))
  {
    settings = vtkShadowFieldData::ReadReceiver(data->GetFieldData());
  }
  if (refusal.empty() && !settings && (roles & Role::DefaultReceiver))
  {
    settings.emplace();
  }
  if (settings || (roles & Role::Occluder))
  {
    this->AddSurface(data, matrix, settings ? &*settings : nullptr, name, refusal);
  }
}

void vtkShadowSceneBuilder::AddLight(vtkPolyData* data, const penumbra::LightSettings& settings,
  vtkMatrix4x4* matrix, const std::string& name)
{
  const bool isSurface = settings.Shape == penumbra::LightKind::Surface;
  const std::string problem =
    isSurface ? FindSurfaceLightProblem(data, settings) : settings.FindProblem();
  if (!problem.empty())
  {
    this->ReportError("Light '" + name + "': " + problem + ". It is left out.");
    return;
  }
  const penumbra::Light light =
    isSurface ? penumbra::Light(MakeSurfaceLight(data, settings)) : settings.MakeLight();
  penumbra::Light placed(light->Transform(ToGlm(matrix)));
  const std::vector<glm::dvec3> hull = placed->GetHull().Points;
  if (!placed->IsValid() || !std::all_of(hull.begin(), hull.end(), penumbra::IsInRange))
  {
    this->ReportError("Light '" + name +
      "': by its actor's matrix, nothing is left of it, or it is out of range; allowed: a matrix "
      "that keeps its extent, with " +
      penumbra::AllowedCoordinates + ". It is left out.");
    return;
  }
  this->Scene.Lights.push_back(std::move(placed));
}

std::string vtkShadowSceneBuilder::FindSurfaceLightProblem(
  vtkPolyData* data, const penumbra::LightSettings& settings)
{
  std::string problem = penumbra::FindStructureProblem(data);
  if (problem.empty())
  {
    problem = FindRadianceArrayProblem(data);
  }
  if (problem.empty())
  {
    problem = settings.FindProblem();
  }
  for (vtkIdType i = 0; i < data->GetNumberOfPolys() && problem.empty(); ++i)
  {
    const std::vector<glm::dvec3> vertices = GetVertices(data, i);
    if (!std::all_of(vertices.begin(), vertices.end(), penumbra::IsInRange))
    {
      problem = "polygon " + std::to_string(i) +
        " has a coordinate that is not finite or beyond 1e75; allowed: " +
        penumbra::AllowedCoordinates;
    }
    else if (!penumbra::IsPlanarAndConvex(vertices))
    {
      problem = "polygon " + std::to_string(i) +
        " is not planar and convex; allowed: planar convex polygons (Triangulate makes them)";
    }
  }
  if (!problem.empty())
  {
    return problem;
  }
  const penumbra::SurfaceLight light = MakeSurfaceLight(data, settings);
  if (!light.IsValid())
  {
    return "no polygon has an area and a radiance greater than 0; allowed: at least one";
  }
  double brightest = 0.0;
  for (const penumbra::PolygonLight& cell : light.GetCells())
  {
    const glm::dvec3 radiance = light.Radiance * cell.Radiance;
    brightest = std::max({ brightest, radiance.x, radiance.y, radiance.z });
  }
  if (!(brightest <= penumbra::LightSettings::MaximumRadiance))
  {
    std::ostringstream text;
    text << "Radiance times that of a polygon is " << brightest << "; allowed: 0 to 1e30";
    return text.str();
  }
  return "";
}

void vtkShadowSceneBuilder::AddSurface(vtkPolyData* data, vtkMatrix4x4* matrix,
  const penumbra::ReceiverSettings* receiver, const std::string& name, std::string problem)
{
  const std::string structure = penumbra::FindStructureProblem(data);
  if (!structure.empty())
  {
    this->ReportError("Surface '" + name + "': " + structure + ". It is left out.");
    return;
  }
  vtkSmartPointer<vtkPolyData> polygons = WithoutStrips(data);
  penumbra::Surface surface;
  surface.Transmittance = this->FindTransmittance(data, name);
  if (!receiver && (polygons->GetNumberOfPolys() == 0 || !surface.CastsShadow()))
  {
    return;
  }
  TransformPoints(polygons, ToGlm(matrix), surface);
  if (receiver)
  {
    const bool isMirrored = glm::determinant(glm::dmat3(ToGlm(matrix))) < 0.0;
    problem =
      this->AddReceivers(polygons, receiver->Transformed(ToGlm(matrix)), surface, isMirrored, name);
  }
  const vtkIdType dropped = DropInfinitePolygons(surface, polygons);
  if (dropped > 0 && problem != penumbra::NotFiniteProblem)
  {
    this->ReportError("Surface '" + name + "': " + std::to_string(dropped) +
      " polygons have a coordinate that is not finite or beyond 1e75; allowed: " +
      penumbra::AllowedCoordinates + ". They are left out.");
  }
  Triangulate(polygons, surface);
  if (surface.IsTranslucent() && !receiver)
  {
    this->AddTranslucent(std::move(surface));
    return;
  }
  this->Scene.Surfaces.push_back(std::move(surface));
}

glm::dvec3 vtkShadowSceneBuilder::FindTransmittance(vtkPolyData* data, const std::string& name)
{
  const penumbra::CasterSettings own = vtkShadowFieldData::ReadCaster(data->GetFieldData());
  const std::string problem = own.FindProblem();
  if (!problem.empty())
  {
    this->ReportError("Surface '" + name + "': " + problem + ". It is taken for opaque.");
    return glm::dvec3(0.0);
  }
  return this->Caster.Overridden(own).GetTransmittance();
}

void vtkShadowSceneBuilder::AddTranslucent(penumbra::Surface surface)
{
  const auto same = std::find_if(this->Translucent.begin(), this->Translucent.end(),
    [&](const penumbra::Surface& other) { return other.Transmittance == surface.Transmittance; });
  if (same == this->Translucent.end())
  {
    this->Translucent.push_back(std::move(surface));
    return;
  }
  const auto first = static_cast<std::uint32_t>(same->Points.size());
  same->Points.insert(same->Points.end(), surface.Points.begin(), surface.Points.end());
  for (const auto& [a, b, c] : surface.Triangles)
  {
    same->Triangles.push_back({ first + a, first + b, first + c });
  }
  same->Rounding = glm::max(same->Rounding, surface.Rounding);
}

std::string vtkShadowSceneBuilder::AddReceivers(vtkPolyData* polygons,
  const penumbra::ReceiverSettings& settings, const penumbra::Surface& surface, bool isMirrored,
  const std::string& name)
{
  std::string problem = settings.FindProblem();
  penumbra::PlanarRegions found;
  std::vector<std::optional<penumbra::ClosedSurface>> closed;
  penumbra::Receiver receiver;
  receiver.Surface = this->Scene.Surfaces.size();
  receiver.Settings = settings;
  if (problem.empty())
  {
    const penumbra::PolygonMesh mesh = MakePolygonMesh(polygons, surface, settings, isMirrored);
    found = penumbra::FindPlanarRegions(mesh);
    if (penumbra::NeedsProxyPlane(mesh, found, settings))
    {
      penumbra::ShadowScene lit;
      lit.Lights = this->OtherLights;
      lit.Lights.insert(lit.Lights.end(), this->Scene.Lights.begin(), this->Scene.Lights.end());
      found = PlaceOnProxy(mesh, lit, receiver);
      this->HasProxy = true;
    }
    else if (!surface.IsTranslucent())
    {
      closed = penumbra::FindClosedSurfaces(mesh, found);
    }
    problem = found.Problem;
  }
  if (!problem.empty())
  {
    this->ReportError("Receiver '" + name + "': " + problem + ". It is drawn without shadows.");
    return problem;
  }

  if (!found.Refused.empty())
  {
    this->ReportError("Receiver '" + name + "': " + found.Refused +
      ". That is drawn without shadows, and the rest with them.");
  }
  const std::size_t first = this->Scene.Receivers.size();
  for (std::size_t i = 0; i < found.Regions.size(); ++i)
  {
    receiver.Region = static_cast<int>(i);
    receiver.Base = found.Regions[i].Base;
    receiver.IsTriangle = found.Regions[i].IsTriangle;
    receiver.Deviation = found.Regions[i].Deviation;
    receiver.Enclosed = closed.empty() ? std::nullopt : closed[i];
    AddSides(receiver, this->Scene.Receivers);
  }
  const double growth = this->Scene.ChooseTexels(first);
  if (growth > 1.0)
  {
    std::ostringstream text;
    text << "Receiver '" << name << "': TexelSize is too small; its textures would pass "
         << penumbra::ShadowScene::MaximumTextureSide << " texels a side or 256 MiB. Texels "
         << growth << " times as large are used.";
    this->ReportWarning(text.str());
  }

  vtkNew<vtkIntArray> regions;
  regions->SetName(RegionArray);
  for (const int region : found.RegionOfPolygon)
  {
    regions->InsertNextValue(region);
  }
  polygons->GetCellData()->AddArray(regions);
  return "";
}

void vtkShadowSceneBuilder::ReportError(const std::string& message)
{
  if (this->IsNew(message))
  {
    vtkErrorMacro(<< message);
  }
}

void vtkShadowSceneBuilder::ReportWarning(const std::string& message)
{
  if (this->IsNew(message))
  {
    vtkWarningMacro(<< message);
  }
}

bool vtkShadowSceneBuilder::IsNew(const std::string& message)
{
  return this->Messages.insert(message).second && this->EarlierMessages.count(message) == 0;
}

std::string vtkShadowSceneBuilder::FindReceiverProblem(
  vtkPolyData* data, const penumbra::ReceiverSettings& settings)
{
  std::string problem = penumbra::FindStructureProblem(data);
  if (problem.empty())
  {
    problem = settings.FindProblem();
  }
  if (!problem.empty())
  {
    return problem;
  }
  vtkSmartPointer<vtkPolyData> polygons = WithoutStrips(data);
  penumbra::Surface surface;
  TransformPoints(polygons, glm::dmat4(1.0), surface);
  const penumbra::PolygonMesh mesh = MakePolygonMesh(polygons, surface, settings, false);
  const penumbra::PlanarRegions found = penumbra::FindPlanarRegions(mesh);
  return penumbra::NeedsProxyPlane(mesh, found, settings)
    ? penumbra::FindProxyPlane(mesh, settings).Problem
    : found.Problem;
}

void vtkShadowSceneBuilder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Surfaces: " << this->Scene.Surfaces.size() << "\n";
  os << indent << "Receivers: " << this->Scene.Receivers.size() << "\n";
  os << indent << "Lights: " << this->Scene.Lights.size() << "\n";
  os << indent << "Messages: " << this->Messages.size() << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProxyReceiver.h"

#include "ParallelogramFit.h"
#include "ProxyPlane.h"
#include "RegisteredProjection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

namespace penumbra
{
namespace
{

/// In extents of the surface. Most texels of a larger rectangle would be shown nowhere.
constexpr double MostReach = 16.0;

const char* const AllowedPlanes =
  "; allowed: lights that are higher over the plane, or another plane";

double GetSum(const glm::dvec3& v)
{
  return v.x + v.y + v.z;
}

/// The mean of a light's samples on a grid: a point, or a direction.
LightSample FindCentre(const LightShape& light)
{
  constexpr int Side = 16; // symmetric lights need no more than one; others err by 1/Side^2
  std::vector<glm::dvec2> grid;
  for (int i = 0; i < Side * Side; ++i)
  {
    grid.push_back((glm::dvec2(i % Side, i / Side) + 0.5) / static_cast<double>(Side));
  }
  const std::vector<LightSample> samples = light.TakeSamples(grid);
  LightSample centre = samples.front();
  glm::dvec3 offset(0.0);
  for (const LightSample& sample : samples)
  {
    offset += sample.Place - centre.Place;
  }
  centre.Place += offset / static_cast<double>(samples.size());
  return centre;
}

RegisteredProjection ProjectFrom(const LightSample& centre, const ReceiverFrame& frame)
{
  return centre.IsDirection
    ? RegisteredProjection::FromDirection(frame.DirectionToFrame(centre.Place))
    : RegisteredProjection::FromPoint(frame.ToFrame(centre.Place));
}

bool Shines(const Light& light)
{
  return light->IsValid() && GetSum(light->Radiance) > 0.0;
}

/// The mean k of the lights in front of the frame; nothing if there are none.
std::optional<RegisteredProjection> FindMeanProjection(
  const ShadowScene& scene, const ReceiverFrame& frame)
{
  // Of each light, what arrives; and its power, for where nothing does.
  glm::dvec3 arrivingK(0.0), powerK(0.0);
  double arriving = 0.0, power = 0.0;
  for (const std::size_t i : scene.GetLightOrder())
  {
    const glm::dvec3& origin = frame.GetBase().Corner;
    const Light seen(scene.Lights[i]->Clip(origin, frame.GetNormal()));
    if (Shines(seen))
    {
      const glm::dvec3 k = ProjectFrom(FindCentre(*seen), frame).K;
      const double irradiance = GetSum(seen->Irradiance(origin, frame.GetNormal()));
      const double radiance = seen->GetMeasure() * GetSum(seen->Radiance);
      arriving += irradiance;
      arrivingK += irradiance * k;
      power += radiance;
      powerK += radiance * k;
    }
  }
  if (arriving > 0.0)
  {
    return RegisteredProjection{ arrivingK / arriving };
  }
  return power > 0.0 ? std::optional(RegisteredProjection{ powerK / power }) : std::nullopt;
}

/// Whether lights shine, but to neither side of the frame.
bool IsEdgeOn(const ShadowScene& scene, const ReceiverFrame& frame)
{
  bool isEdgeOn = false;
  for (const Light& light : scene.Lights)
  {
    if (Shines(light))
    {
      isEdgeOn = true;
      for (const glm::dvec3& normal : { frame.GetNormal(), -frame.GetNormal() })
      {
        if (light->Clip(frame.GetBase().Corner, normal)->IsValid())
        {
          return false;
        }
      }
    }
  }
  return isEdgeOn;
}

/// Calls visit() for the points of all polygons, in order; a point may come more than once.
template <typename Visitor>
void VisitPoints(const PolygonMesh& mesh, Visitor&& visit)
{
  for (const std::vector<int>& polygon : mesh.Polygons)
  {
    for (const int point : polygon)
    {
      visit(mesh.Points[static_cast<std::size_t>(point)]);
    }
  }
}

/// A square in the plane, as large as the surface, with its corner in the plane's origin.
Parallelogram MakeSquare(const ProxyPlane& plane)
{
  const glm::dvec3& n = plane.Normal;
  const glm::dvec3 axis =
    std::abs(n.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, n));
  return { plane.Origin, plane.Extent * x, plane.Extent * glm::cross(n, x) };
}

/// The side that Settings.Side says, or gets more light at the plane's origin.
ReceiverFrame::Side FindLitSide(
  const ProxyPlane& plane, const ReceiverSettings& settings, const ShadowScene& scene)
{
  Receiver probe;
  probe.Settings = settings;
  probe.Base = MakeSquare(plane);
  probe.Base.Corner -= 0.5 * (probe.Base.EdgeX + probe.Base.EdgeY);
  const bool isFront = glm::dot(scene.MakeFrame(probe).GetNormal(), plane.Normal) > 0.0;
  return isFront ? ReceiverFrame::Side::Front : ReceiverFrame::Side::Back;
}

/// The frame of the plane's square, at the depth that PlaceProxy() speaks of.
ReceiverFrame MakeFrame(const PolygonMesh& mesh, const ProxyPlane& plane, ReceiverFrame::Side side,
  const ReceiverSettings& settings)
{
  Parallelogram square = MakeSquare(plane);
  const ReceiverFrame frame(square, side);
  if (settings.ProxyMode == ProxyPlaneMode::BestFit)
  {
    double deepest = 0.0;
    VisitPoints(mesh,
      [&](const glm::dvec3& p)
      { deepest = std::min(deepest, glm::dot(p - plane.Origin, frame.GetNormal())); });
    square.Corner += deepest * frame.GetNormal();
  }
  return ReceiverFrame(square, side);
}

/// The projections of the mesh's points; the answer is empty or what forbids it.
std::string ProjectPoints(const PolygonMesh& mesh, const ReceiverFrame& frame,
  const RegisteredProjection& projection, std::vector<glm::dvec3>& projected)
{
  double farthest = 0.0; // in units of the frame's size, the surface's extent
  VisitPoints(mesh,
    [&](const glm::dvec3& p)
    {
      const glm::dvec3 xyw = projection.Project(frame.ToFrame(p));
      const glm::dvec2 uv = glm::dvec2(xyw) / xyw.z;
      const double reach = std::hypot(uv.x, uv.y); // the square's edges are of the same length
      farthest = std::max(farthest, xyw.z > 0.0 ? reach : HUGE_VAL);
      projected.push_back(frame.ToWorld({ uv, 0.0 }));
    });
  if (farthest <= MostReach)
  {
    return "";
  }
  std::ostringstream text;
  text << "its proxy plane is nearly edge-on to the lights, or they are not above it: projections "
          "from them reach "
       << farthest << " times the surface's extent; allowed: " << MostReach << " times"
       << AllowedPlanes;
  return text.str();
}

} // namespace

ProxyReceiver PlaceProxy(
  const PolygonMesh& mesh, const ReceiverSettings& settings, const ShadowScene& scene)
{
  ProxyReceiver result;
  const ProxyPlane plane = FindProxyPlane(mesh, settings);
  result.Problem = plane.Problem;
  if (!result.Problem.empty())
  {
    return result;
  }
  const ReceiverFrame::Side side = FindLitSide(plane, settings, scene);
  const ReceiverFrame frame = MakeFrame(mesh, plane, side, settings);
  const auto found = FindMeanProjection(scene, frame);
  if (!found && IsEdgeOn(scene, frame))
  {
    result.Problem = std::string("its proxy plane is edge-on to the lights") + AllowedPlanes;
    return result;
  }
  // Where no light arrives, there is nothing to be shifted.
  const RegisteredProjection projection = found.value_or(RegisteredProjection());
  std::vector<glm::dvec3> projected;
  result.Problem = ProjectPoints(mesh, frame, projection, projected);
  if (!result.Problem.empty())
  {
    return result;
  }
  const auto base = FitParallelogram(projected, plane.Normal, mesh.Rounding);
  if (!base)
  {
    result.Problem =
      std::string("its projection onto its proxy plane spans no area") + AllowedPlanes;
    return result;
  }
  result.Base = *base;
  result.Side = side == ReceiverFrame::Side::Front ? ReceiverSide::Front : ReceiverSide::Back;
  // (kx, ky, 1, kz) in the frame's homogeneous coordinates.
  const glm::dvec3& k = projection.K;
  const glm::dvec3 direction = frame.ToWorld({ k.x, k.y, 1.0 }) - frame.GetBase().Corner;
  result.Centre = glm::dvec4(direction + k.z * frame.GetBase().Corner, k.z);
  return result;
}

} // namespace penumbra

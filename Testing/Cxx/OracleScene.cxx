// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OracleScene.h"

#include "DirectionalLight.h"
#include "DiskLight.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "SegmentLight.h"
#include "SurfaceLight.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace
{

glm::dvec3 ToColour(const std::array<double, 3>& colour)
{
  return { colour[0], colour[1], colour[2] };
}

penumbra::PolygonLight MakePolygon(const oracle::Light& light)
{
  std::vector<glm::dvec3> v;
  for (const oracle::Vec3& vertex : light.Vertices)
  {
    v.push_back(FromOracle(vertex));
  }
  // The oracle's parallelograms have their fourth corner where the product puts it, but for the
  // rounding of long doubles to doubles.
  const auto isParallelogram = [&]
  {
    const glm::dvec3 fourth = v[0] + (v[2] - v[1]);
    return glm::length(v[3] - fourth) <= 1e-12 * glm::length(v[2] - v[0]);
  };
  penumbra::PolygonLight polygon = v.size() == 4 && isParallelogram()
    ? penumbra::PolygonLight::Parallelogram(v[0], v[1], v[3])
    : penumbra::PolygonLight::Convex(v);
  polygon.Radiance = ToColour(light.Radiance);
  polygon.TwoSided = light.TwoSided;
  return polygon;
}

struct LightMaker
{
  penumbra::Light operator()(const oracle::Light& light) const { return MakePolygon(light); }

  penumbra::Light operator()(const oracle::Disk& light) const
  {
    penumbra::DiskLight disk(
      FromOracle(light.Centre), FromOracle(light.Normal), static_cast<double>(light.Radius));
    disk.Radiance = ToColour(light.Radiance);
    disk.TwoSided = light.TwoSided;
    return disk;
  }

  penumbra::Light operator()(const oracle::Ellipse& light) const
  {
    penumbra::DiskLight disk(glm::dvec3(0.0), { 0.0, 0.0, 1.0 }, 1.0);
    disk.SetFirstAxis({ 1.0, 0.0, 0.0 });
    disk.Radiance = ToColour(light.Radiance);
    disk.TwoSided = light.TwoSided;
    const glm::dvec3 a = FromOracle(light.A), b = FromOracle(light.B);
    return disk.Transformed(
      { glm::dvec4(a, 0.0), glm::dvec4(b, 0.0), glm::dvec4(glm::normalize(glm::cross(a, b)), 0.0),
        glm::dvec4(FromOracle(light.Centre), 1.0) });
  }

  penumbra::Light operator()(const oracle::Segment& light) const
  {
    penumbra::SegmentLight segment(FromOracle(light.A), FromOracle(light.B));
    segment.Radiance = ToColour(light.Radiance);
    return segment;
  }

  penumbra::Light operator()(const oracle::Point& light) const
  {
    penumbra::PointLight point(FromOracle(light.Position));
    point.Radiance = ToColour(light.Intensity);
    return point;
  }

  penumbra::Light operator()(const oracle::Directional& light) const
  {
    penumbra::DirectionalLight sun(FromOracle(light.Direction), light.AngularDiameter);
    sun.Radiance = ToColour(light.Irradiance);
    return sun;
  }

  penumbra::Light operator()(const oracle::Surface& light) const
  {
    std::vector<penumbra::PolygonLight> cells;
    for (const oracle::Light& polygon : light.Polygons)
    {
      cells.push_back(MakePolygon(polygon));
    }
    penumbra::SurfaceLight surface(cells);
    surface.TwoSided = light.Polygons.front().TwoSided;
    return surface;
  }
};

} // namespace

penumbra::Light MakeLight(const oracle::AnyLight& light)
{
  return std::visit(LightMaker{}, light);
}

penumbra::ShadowScene MakeShadowScene(
  const oracle::RandomScene& scene, penumbra::ReceiverSettings settings, const glm::ivec2& texels)
{
  const glm::dvec3 corner = FromOracle(scene.Origin);
  const glm::dvec3 x = FromOracle(scene.Edge1), y = FromOracle(scene.Edge2);
  penumbra::Surface floor;
  floor.Points = { corner, corner + x, corner + x + y, corner + y };
  floor.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  floor.Regions = { 0, 0 };

  penumbra::Surface occluders;
  for (const oracle::Triangle& t : scene.Contents.Occluders)
  {
    const auto first = static_cast<std::uint32_t>(occluders.Points.size());
    occluders.Points.insert(
      occluders.Points.end(), { FromOracle(t.A), FromOracle(t.B), FromOracle(t.C) });
    occluders.Triangles.push_back({ first, first + 1, first + 2 });
  }

  penumbra::Receiver receiver;
  receiver.Base = { corner, x, y };
  receiver.Texels = texels;
  receiver.Settings = settings;
  receiver.Settings.Side = penumbra::ReceiverSide::Front;
  receiver.Settings.Reflectance = ToColour(scene.Contents.Reflectance);
  receiver.Settings.AmbientRadiance = ToColour(scene.Contents.Ambient);
  penumbra::ShadowScene result;
  result.Surfaces = { floor, occluders };
  result.Receivers = { receiver };
  for (const oracle::AnyLight& light : scene.Contents.Lights)
  {
    result.Lights.push_back(MakeLight(light));
  }
  return result;
}

std::vector<glm::dvec3> GetExactRadiance(const oracle::RandomScene& scene, const glm::ivec2& texels)
{
  std::vector<glm::dvec3> radiance(static_cast<std::size_t>(texels.x * texels.y));
  std::atomic<int> nextRow{ 0 };
  const auto work = [&]
  {
    for (int j = nextRow++; j < texels.y; j = nextRow++)
    {
      for (int i = 0; i < texels.x; ++i)
      {
        const oracle::Vec3 x = scene.At((i + 0.5L) / texels.x, (j + 0.5L) / texels.y);
        radiance[static_cast<std::size_t>(j * texels.x + i)] =
          ToColour(oracle::Radiance(x, scene.Normal(), scene.Contents));
      }
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(std::thread::hardware_concurrency(), 1u); ++i)
  {
    threads.emplace_back(work);
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  return radiance;
}

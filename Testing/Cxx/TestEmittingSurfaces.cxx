// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces that emit and block: what rounding hides of a cell behind itself does not count, and
// what the surface really hides does.

#include "StabilityTools.h"
#include "SurfaceLight.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <functional>
#include <string>
#include <vector>

namespace
{

/// Polygons over points.
struct Mesh
{
  std::vector<glm::dvec3> Points;
  std::vector<std::vector<std::uint32_t>> Polygons;
};

/// How a mesh becomes light and occluder.
struct Options
{
  bool IsFloat = true;
  bool TwoSided = false;
  bool OtherDiagonal = false; ///< of quadrilaterals, in the occluder
  double Scale = 1.0;
  glm::dvec3 Offset{ 0.0 };

  std::string GetName() const
  {
    return std::string(IsFloat ? "float" : "double") + (TwoSided ? ", two sides" : "") +
      (OtherDiagonal ? ", other diagonals" : "") + ", scale " + std::to_string(Scale) +
      ", offset " + std::to_string(Offset.x);
  }
};

/// A grid of n x n cells over the unit square of a map.
Mesh MakeGrid(int n, const std::function<glm::dvec3(const glm::dvec2&)>& map)
{
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      mesh.Points.push_back(map(glm::dvec2(i, j) / static_cast<double>(n)));
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      mesh.Polygons.push_back({ at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j) });
    }
  }
  return mesh;
}

/// A panel that emits downwards, turned by so many degrees about the y axis.
Mesh MakePanel(int cells, double degrees)
{
  const double a = glm::radians(degrees);
  return MakeGrid(cells,
    [a](const glm::dvec2& s)
    {
      const double x = s.x - 0.5;
      return glm::dvec3(x * std::cos(a), s.y - 0.5, 2.0 - x * std::sin(a));
    });
}

/// Triangles of a sphere of radius 0.6, from the pole that is above to the polar angle `end`, with
/// their fronts outside.
Mesh MakeSphere(int rings, double end)
{
  constexpr double Radius = 0.6;
  const int around = 2 * rings;
  Mesh mesh;
  for (int j = 0; j <= rings; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const double polar = end * j / rings, angle = glm::two_pi<double>() * i / around;
      mesh.Points.push_back(glm::dvec3(0.0, 0.0, 1.8) +
        Radius *
          glm::dvec3(
            std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)));
    }
  }
  const auto at = [around](int i, int j)
  { return static_cast<std::uint32_t>(j * around + i % around); };
  for (int j = 0; j < rings; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      mesh.Polygons.push_back({ at(i, j), at(i, j + 1), at(i + 1, j + 1) });
      mesh.Polygons.push_back({ at(i, j), at(i + 1, j + 1), at(i + 1, j) });
    }
  }
  return mesh;
}

Mesh TurnInsideOut(Mesh mesh)
{
  for (std::vector<std::uint32_t>& polygon : mesh.Polygons)
  {
    std::reverse(polygon.begin(), polygon.end());
  }
  return mesh;
}

glm::dvec3 Place(const glm::dvec3& p, const Options& options)
{
  const glm::dvec3 placed = options.Scale * p + options.Offset;
  return options.IsFloat ? glm::dvec3(glm::vec3(placed)) : placed;
}

TestScene MakeGround(const Options& options)
{
  TestScene scene;
  scene.Base = { options.Scale * glm::dvec3(-3.0, -3.0, 0.0) + options.Offset,
    options.Scale * glm::dvec3(6.0, 0.0, 0.0), options.Scale * glm::dvec3(0.0, 6.0, 0.0) };
  scene.Texels = { 24, 24 };
  scene.Settings.LightSamples = 256;
  scene.Settings.Reconstruction = false;
  return scene;
}

penumbra::SurfaceLight MakeLight(
  const Mesh& mesh, const Options& options, const glm::dvec3& rounding)
{
  std::vector<penumbra::PolygonLight> cells;
  for (const std::vector<std::uint32_t>& polygon : mesh.Polygons)
  {
    std::vector<glm::dvec3> vertices;
    for (const std::uint32_t i : polygon)
    {
      vertices.push_back(Place(mesh.Points[i], options));
    }
    cells.push_back(penumbra::PolygonLight::Convex(vertices));
    cells.back().TwoSided = options.TwoSided;
  }
  penumbra::SurfaceLight light(cells);
  light.TwoSided = options.TwoSided;
  light.Rounding = rounding;
  return light;
}

penumbra::Surface MakeOccluder(const Mesh& mesh, const Options& options)
{
  penumbra::Surface surface;
  glm::dvec3 largest(0.0);
  for (const glm::dvec3& p : mesh.Points)
  {
    surface.Points.push_back(Place(p, options));
    largest = glm::max(largest, glm::abs(surface.Points.back()));
  }
  surface.Rounding = largest * (options.IsFloat ? static_cast<double>(FLT_EPSILON) : DBL_EPSILON);
  for (const std::vector<std::uint32_t>& p : mesh.Polygons)
  {
    const std::size_t first = options.OtherDiagonal ? 1 : 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i)
    {
      surface.Triangles.push_back(
        { p[first], p[(first + i) % p.size()], p[(first + i + 1) % p.size()] });
    }
  }
  return surface;
}

/// The irradiance of the texels, with a surface as light and perhaps one as occluder.
std::vector<glm::vec4> Bake(
  const Mesh& emitter, const Mesh* blocker, const Options& options, int samples = 256)
{
  TestScene ground = MakeGround(options);
  ground.Settings.LightSamples = samples;
  penumbra::ShadowScene scene = ground.MakeScene();
  scene.Lights.emplace_back(MakeLight(emitter, options, MakeOccluder(emitter, options).Rounding));
  if (blocker)
  {
    scene.Surfaces.emplace_back(MakeOccluder(*blocker, options));
  }
  return BakeReceiver(scene).Texels.Irradiance;
}

/// The largest difference of two bakes, of the second one's peak; it notes the texel.
void ExpectAlike(const std::string& what, const std::vector<glm::vec4>& texels,
  const std::vector<glm::vec4>& right, double bound)
{
  ASSERT_EQ(texels.size(), right.size());
  double peak = 0.0, largest = -1.0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    peak = std::max(peak, static_cast<double>(right[i].x));
    const double difference = std::abs(texels[i].x - right[i].x);
    worst = difference > largest ? i : worst;
    largest = std::max(largest, difference);
  }
  ASSERT_GT(peak, 0.0) << what;
  EXPECT_LE(largest, bound * peak) << what << ": texel " << worst << " is " << texels[worst].x
                                   << ", right is " << right[worst].x << ", the peak " << peak;
}

/// Of the peak, where 1024 samples say which half of a light is seen: three standard errors of
/// independent samples, 1 / sqrt(4 * 1024), over that half.
constexpr double ShareBound = 3.0 * 2.0 / 64.0;

std::vector<Options> GetPlaces()
{
  std::vector<Options> places;
  for (const bool isFloat : { true, false })
  {
    for (const double scale : { 1e-6, 1.0, 1e6 })
    {
      places.push_back({ isFloat, false, false, scale, glm::dvec3(0.0) });
    }
    for (const double offset : { 1e3, 1e5, 1e6 })
    {
      places.push_back({ isFloat, false, false, 1.0, glm::dvec3(offset, -offset, 0.7 * offset) });
    }
  }
  return places;
}

} // namespace

// Where nothing but rounding hides a light, it is as bright as without an occluder.
TEST(StabilityEmittingSurfaces, PanelsHideNothingOfThemselves)
{
  for (Options options : GetPlaces())
  {
    for (const double degrees : { 0.0, 20.0, 45.0, 77.0 })
    {
      for (const int cells : { 1, 3 })
      {
        options.TwoSided = cells == 3 && degrees > 30.0;
        options.OtherDiagonal = cells == 3;
        const Mesh mesh = MakePanel(cells, degrees);
        ExpectAlike(options.GetName() + ", " + std::to_string(degrees) + " degrees, " +
            std::to_string(cells) + " cells",
          Bake(mesh, &mesh, options), Bake(mesh, nullptr, options), GetRadianceBound(256));
      }
    }
  }
}

// The same where the occluder has other points than the light: rounding takes both out of their
// plane.
TEST(StabilityEmittingSurfaces, OtherCellsOfThePlaneHideNothing)
{
  const Mesh light = MakePanel(3, 20.0), occluder = MakePanel(5, 20.0);
  for (const Options& options : GetPlaces())
  {
    ExpectAlike(options.GetName(), Bake(light, &occluder, options), Bake(light, nullptr, options),
      GetRadianceBound(256));
  }
}

// A convex body hides nothing of the sides that face a texel.
TEST(StabilityEmittingSurfaces, ConvexFrontsAreSeen)
{
  for (Options options : GetPlaces())
  {
    if (options.IsFloat && glm::length(options.Offset) > 1e4)
    {
      continue; // steps of floats make it bumpy
    }
    for (const int rings : { 4, 10 })
    {
      const Mesh mesh = MakeSphere(rings, glm::pi<double>());
      ExpectAlike(options.GetName() + ", " + std::to_string(rings) + " rings",
        Bake(mesh, &mesh, options), Bake(mesh, nullptr, options), GetRadianceBound(256));
    }
  }
}

// Seen from outside, a closed body of two sides is as bright as one that emits outwards alone. The
// share that samples say is that of half of the light: of 1024, on a Sobol net, its standard error
// is below that of independent ones, 1 / sqrt(4 * 1024), of which the bound is three.
TEST(StabilityEmittingSurfaces, BallsHideTheirFarSides)
{
  Options one, two;
  two.TwoSided = true;
  for (const int rings : { 4, 12 })
  {
    const Mesh mesh = MakeSphere(rings, glm::pi<double>());
    const Mesh turned = TurnInsideOut(mesh);
    const std::vector<glm::vec4> right = Bake(mesh, nullptr, one);
    const std::string name = std::to_string(rings) + " rings, two sides, fronts ";
    ExpectAlike(name + "outside", Bake(mesh, &mesh, two, 1024), right, ShareBound);
    ExpectAlike(name + "inside", Bake(turned, &mesh, two, 1024), right, ShareBound);
  }
}

// From below, the inside of a dome is as bright as a disk in its opening (Lambert 1760), whatever
// its cells hide of each other.
TEST(StabilityEmittingSurfaces, DomesShineAsTheirOpenings)
{
  for (const int rings : { 4, 24 })
  {
    const Mesh mesh = TurnInsideOut(MakeSphere(rings, 0.5 * glm::pi<double>()));
    Mesh opening;
    opening.Points.assign(mesh.Points.end() - 2 * rings, mesh.Points.end());
    opening.Polygons.emplace_back();
    for (std::uint32_t i = 0; i < opening.Points.size(); ++i)
    {
      opening.Polygons.front().insert(opening.Polygons.front().begin(), i);
    }
    ExpectAlike(std::to_string(rings) + " rings", Bake(mesh, &mesh, {}, 1024),
      Bake(opening, nullptr, {}), ShareBound);
  }
}

// What is really before a light hides it: a plate 1e-4 and 1e-5 of its height away. The two middle
// texels, right below, see nothing of a light in whose plane the plate, a tenth larger, nearly is.
TEST(StabilityEmittingSurfaces, PlatesThatAreCloseHideTheLight)
{
  Options options;
  options.IsFloat = false;
  for (const double degrees : { 0.0, 20.0, 45.0 })
  {
    for (const double distance : { 2e-4, 2e-5 })
    {
      const double a = glm::radians(degrees);
      const Mesh light = MakePanel(3, degrees);
      Mesh plate = light;
      for (glm::dvec3& p : plate.Points)
      {
        p = glm::dvec3(0.0, 0.0, 2.0) + 1.1 * (p - glm::dvec3(0.0, 0.0, 2.0)) -
          distance * glm::dvec3(std::sin(a), 0.0, std::cos(a));
      }
      const std::vector<glm::vec4> texels = Bake(light, &plate, options);
      EXPECT_EQ(texels[24 * 11 + 11].x, 0.0f) << degrees << " degrees, " << distance << " away";
      EXPECT_EQ(texels[24 * 12 + 12].x, 0.0f) << degrees << " degrees, " << distance << " away";
    }
  }
}

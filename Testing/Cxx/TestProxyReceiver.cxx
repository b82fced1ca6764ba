// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the receiver that stands for a curved surface lies (H&H 1997, figure 5): against rays.

#include "DirectionalLight.h"
#include "LargestDeviation.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "ProxyPlane.h"
#include "ProxyReceiver.h"
#include "RandomGeometry.h"
#include "ScreenMap.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{

using penumbra::DirectionalLight;
using penumbra::Light;
using penumbra::PlaceProxy;
using penumbra::PointLight;
using penumbra::PolygonLight;
using penumbra::PolygonMesh;
using penumbra::ProxyReceiver;
using penumbra::ReceiverFrame;
using penumbra::ReceiverSettings;
using penumbra::ReceiverSide;
using penumbra::ShadowScene;

// A dozen operations on numbers up to 10, divided by differences of 0.1 and more: some hundred
// roundings of 1e-16, and a margin of ten.
constexpr double Rounding = 1e-12;

/// A grid of quads over [-2, 2]^2, bumpy, turned about a random axis.
struct BumpyFloor
{
  explicit BumpyFloor(unsigned seed, bool isTurned = true)
  {
    RandomGeometry random(seed);
    this->Turn = isTurned
      ? glm::dmat3(glm::rotate(glm::dmat4(1.0), random.Between(0.0, 6.0), random.Direction()))
      : glm::dmat3(1.0);
    constexpr int Side = 6;
    for (int i = 0; i <= Side; ++i)
    {
      for (int j = 0; j <= Side; ++j)
      {
        this->Mesh.Points.push_back(
          this->ToWorld({ 4.0 * i / Side - 2.0, 4.0 * j / Side - 2.0, random.Between(-0.2, 0.2) }));
      }
    }
    for (int i = 0; i < Side * (Side + 1); ++i)
    {
      if (i % (Side + 1) != Side)
      {
        this->Mesh.Polygons.push_back({ i, i + Side + 1, i + Side + 2, i + 1 });
      }
    }
  }
  glm::dvec3 ToWorld(const glm::dvec3& p) const { return this->Turn * p; }

  PolygonMesh Mesh;
  glm::dmat3 Turn{ 1.0 };
};

ReceiverSettings OnProxy(ReceiverSide side = ReceiverSide::Auto)
{
  ReceiverSettings settings;
  settings.ProxyPlane = true;
  settings.Side = side;
  return settings;
}

ShadowScene WithLights(const std::vector<Light>& lights)
{
  ShadowScene scene;
  scene.Lights = lights;
  return scene;
}

Light Sun(const glm::dvec3& direction)
{
  return DirectionalLight(direction, 0.0);
}

/// Where the ray from the light (w = 0: from infinity) through the point meets the plane of the
/// receiver, as (u, v) on it: in long double, from the plane's equation.
glm::dvec2 TraceToPlane(
  const penumbra::Parallelogram& base, const glm::dvec4& light, const glm::dvec3& point)
{
  using Long3 = glm::tvec3<long double>;
  const Long3 b(base.Corner), x(base.EdgeX), y(base.EdgeY), p(point);
  const Long3 n = glm::cross(x, y);
  const Long3 d = Long3(glm::dvec3(light)) - p * static_cast<long double>(light.w);
  const Long3 hit = p - d * (glm::dot(n, p - b) / glm::dot(n, d)) - b;
  const long double area = glm::dot(n, n);
  return { static_cast<double>(glm::dot(glm::cross(hit, y), n) / area),
    static_cast<double>(glm::dot(glm::cross(x, hit), n) / area) };
}

/// The place of a world point by the map of the pass's shader, with no camera.
glm::dvec2 LookUp(const ProxyReceiver& proxy, const glm::dvec3& point)
{
  const glm::dvec4 uvhq =
    penumbra::MakeProxyViewMap(proxy.Base, proxy.Centre, glm::dmat4(1.0)) * glm::dvec4(point, 1.0);
  return glm::dvec2(uvhq) / uvhq.w;
}

TEST(ProxyReceiver, CoversWhatRaysThroughTheSurfaceMeet)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    const BumpyFloor floor(seed);
    RandomGeometry random(seed + 1000);
    const bool isSun = seed % 2 == 0;
    const glm::dvec3 place = floor.ToWorld(
      { random.Between(-3.0, 3.0), random.Between(-3.0, 3.0), random.Between(1.5, 4.0) });
    const Light light = isSun ? Sun(-place) : Light(PointLight(place));
    const ProxyReceiver proxy = PlaceProxy(floor.Mesh, OnProxy(), WithLights({ light }));
    ASSERT_EQ(proxy.Problem, "") << seed;
    const glm::dvec4 source(place, isSun ? 0.0 : 1.0);
    for (const glm::dvec3& point : floor.Mesh.Points)
    {
      const glm::dvec2 uv = TraceToPlane(proxy.Base, source, point);
      EXPECT_LE(largest.Add(glm::length(LookUp(proxy, point) - uv)), Rounding) << seed;
      for (int axis = 0; axis < 2; ++axis)
      {
        // FitParallelogram() lets corners stick out by 1e-5 of the extent.
        EXPECT_GE(uv[axis], -1e-5);
        EXPECT_LE(uv[axis], 1.0 + 1e-5);
      }
    }
  }
}

// All of the surface is on the lit side of the plane, or in it.
TEST(ProxyReceiver, LiesInTheDeepestPoint)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const BumpyFloor floor(seed);
    for (const double side : { 1.0, -1.0 })
    {
      const Light light = PointLight(floor.ToWorld({ 0.3, -0.4, 3.0 * side }));
      const ProxyReceiver proxy = PlaceProxy(floor.Mesh, OnProxy(), WithLights({ light }));
      ASSERT_EQ(proxy.Problem, "");
      EXPECT_EQ(proxy.Side, side > 0.0 ? ReceiverSide::Front : ReceiverSide::Back);
      const ReceiverFrame frame(
        proxy.Base, side > 0.0 ? ReceiverFrame::Side::Front : ReceiverFrame::Side::Back);
      double deepest = 1.0;
      for (const glm::dvec3& point : floor.Mesh.Points)
      {
        deepest = std::min(deepest, frame.ToFrame(point).z);
      }
      EXPECT_NEAR(deepest, 0.0, Rounding);
      EXPECT_GT(frame.ToFrame(floor.ToWorld({ 0.3, -0.4, 3.0 * side })).z, 0.0);
    }
  }
}

TEST(ProxyReceiver, GivenPlanesStayWhereTheyAre)
{
  const BumpyFloor floor(1, false);
  ReceiverSettings settings = OnProxy();
  settings.ProxyMode = penumbra::ProxyPlaneMode::Given;
  settings.ProxyOrigin = { 7.0, 8.0, 0.5 };
  const ProxyReceiver proxy =
    PlaceProxy(floor.Mesh, settings, WithLights({ Light(PointLight({ 0, 0, 3 })) }));
  ASSERT_EQ(proxy.Problem, "");
  EXPECT_NEAR(proxy.Base.Corner.z, 0.5, Rounding);
  EXPECT_NEAR(proxy.Base.EdgeX.z, 0.0, Rounding);
  EXPECT_NEAR(proxy.Base.EdgeY.z, 0.0, Rounding);
}

// The centre of an area light is its own: symmetric shapes, whose samples' mean it is.
TEST(ProxyReceiver, ProjectsFromTheLightsCentre)
{
  const BumpyFloor floor(2, false);
  const std::vector<Light> lights{ PolygonLight::Parallelogram(
                                     { -1, 1, 3 }, { 1, 1, 3 }, { -1, 0, 3.5 }),
    DirectionalLight({ 1, 2, -4 }, 3.0) };
  const std::vector<glm::dvec4> wanted{ { 0.0, 0.5, 3.25, 1.0 }, { -1.0, -2.0, 4.0, 0.0 } };
  for (std::size_t i = 0; i < lights.size(); ++i)
  {
    const ProxyReceiver proxy = PlaceProxy(floor.Mesh, OnProxy(), WithLights({ lights[i] }));
    ASSERT_EQ(proxy.Problem, "");
    // Homogeneous: of any scale.
    const glm::dvec4 centre = proxy.Centre * (wanted[i].z / proxy.Centre.z);
    EXPECT_LE(glm::length(centre - wanted[i]), 10.0 * Rounding) << i;
  }
}

// Equal lights at both sides of a symmetric surface: the mean is in the middle, in any order.
TEST(ProxyReceiver, TakesTheMeanOfSeveralLights)
{
  PolygonMesh roof;
  roof.Points = { { -2, -1, 0 }, { 0, -1, 0.3 }, { 2, -1, 0 }, { 2, 1, 0 }, { 0, 1, 0.3 },
    { -2, 1, 0 } };
  roof.Polygons = { { 0, 1, 4, 5 }, { 1, 2, 3, 4 } };
  const Light left = PointLight({ -2, 0, 4 }), right = PointLight({ 2, 0, 4 });
  const ProxyReceiver proxy = PlaceProxy(roof, OnProxy(), WithLights({ left, right }));
  ASSERT_EQ(proxy.Problem, "");
  EXPECT_LE(glm::length(proxy.Centre / proxy.Centre.w - glm::dvec4(0, 0, 4, 1)), Rounding);
  const ProxyReceiver swapped = PlaceProxy(roof, OnProxy(), WithLights({ right, left }));
  EXPECT_EQ(proxy.Centre, swapped.Centre);
  EXPECT_EQ(proxy.Base.Corner, swapped.Base.Corner);
  // A light that is dark or behind says nothing.
  Light dark = PointLight({ 1, 1, 3 });
  dark->Radiance = glm::dvec3(0.0);
  const ProxyReceiver alone = PlaceProxy(roof, OnProxy(), WithLights({ left }));
  const ProxyReceiver withOthers = PlaceProxy(
    roof, OnProxy(ReceiverSide::Front), WithLights({ left, dark, PointLight({ 0, 0, -3 }) }));
  EXPECT_EQ(alone.Centre, withOthers.Centre);
  // Of two lights, the one that sends more counts for more.
  Light bright = right;
  bright->Radiance = glm::dvec3(3.0);
  const ProxyReceiver uneven = PlaceProxy(roof, OnProxy(), WithLights({ left, bright }));
  // k is (x, 0, 1) / 4, its mean (3 - 1) / 4 of that at the right.
  EXPECT_NEAR(uneven.Centre.x / uneven.Centre.w, 1.0, Rounding);
}

// Without light there is nothing to be shifted: the rectangle is below the surface.
TEST(ProxyReceiver, WithoutLightsIsBelowTheSurface)
{
  const BumpyFloor floor(3, false);
  for (const ShadowScene& scene :
    { ShadowScene(), WithLights({ Light(PointLight({ 0, 0, -3 })) }) })
  {
    const ProxyReceiver proxy = PlaceProxy(floor.Mesh, OnProxy(ReceiverSide::Front), scene);
    ASSERT_EQ(proxy.Problem, "");
    const glm::dvec3 normal = glm::normalize(glm::cross(proxy.Base.EdgeX, proxy.Base.EdgeY));
    EXPECT_LE(glm::length(glm::cross(glm::dvec3(proxy.Centre), normal)), Rounding);
    EXPECT_EQ(proxy.Centre.w, 0.0);
  }
}

TEST(ProxyReceiver, NamesLightsThatItCannotProjectFrom)
{
  const BumpyFloor floor(4, false);
  ReceiverSettings settings = OnProxy();
  settings.ProxyMode = penumbra::ProxyPlaneMode::Given;
  const std::vector<Light> lights{
    Sun({ 1, 0, 0 }),              // in the plane
    Sun({ 1, 0, -0.001 }),         // nearly
    PointLight({ 0, 0, 0 }),       // in the plane
    PointLight({ 0.1, 0.1, 0.05 }) // below the bumps
  };
  for (std::size_t i = 0; i < lights.size(); ++i)
  {
    const std::string problem = PlaceProxy(floor.Mesh, settings, WithLights({ lights[i] })).Problem;
    EXPECT_NE(problem.find("edge-on"), std::string::npos) << i << ": " << problem;
    EXPECT_NE(problem.find("allowed"), std::string::npos) << i << ": " << problem;
  }
}

// From a fragment's window coordinates, depth and all, to the same place as from the view.
TEST(ProxyReceiver, IsFoundFromTheScreen)
{
  const BumpyFloor floor(5);
  const glm::dvec3 place = floor.ToWorld({ 1.0, -0.5, 3.0 });
  const ProxyReceiver proxy =
    PlaceProxy(floor.Mesh, OnProxy(), WithLights({ Light(PointLight(place)) }));
  const glm::dmat4 toView =
    glm::lookAt(floor.ToWorld({ 3, -6, 4 }), glm::dvec3(0.0), floor.ToWorld({ 0, 0, 1 }));
  const glm::ivec4 viewport(10, 20, 300, 200);
  for (const glm::dmat4& toClip :
    { glm::perspective(0.5, 1.5, 3.0, 15.0), glm::ortho(-3.0, 3.0, -2.0, 2.0, 3.0, 15.0) })
  {
    const glm::dmat4 screen =
      penumbra::MakeProxyScreenMap(proxy.Base, proxy.Centre, toView, toClip, viewport);
    for (const glm::dvec3& point : floor.Mesh.Points)
    {
      const glm::dvec3 window = glm::project(point, toView, toClip, viewport);
      const glm::dvec4 uvhq = screen * glm::dvec4(window, 1.0);
      const glm::dvec2 uv = TraceToPlane(proxy.Base, glm::dvec4(place, 1.0), point);
      // Depths in [0, 1] stand for 3 to 15: a hundred times the rounding.
      EXPECT_LE(glm::length(glm::dvec2(uvhq) / uvhq.w - uv), 100.0 * Rounding);
    }
  }
}

} // namespace

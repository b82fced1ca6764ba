// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Bakes of lights of every kind, against the exact answer.

#include "OracleScene.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace
{

using oracle::AnyLight;
using oracle::RandomScene;
using oracle::Vec3;

constexpr int Side = 40;
const glm::ivec2 Texels(Side, Side);

/// A floor of 4 x 4 under lights.
struct Case
{
  std::string Name;
  std::vector<AnyLight> Lights;
  RandomScene MakeScene() const
  {
    RandomScene scene;
    scene.Origin = { -2, -2, 0 };
    scene.Edge1 = { 4, 0, 0 };
    scene.Edge2 = { 0, 4, 0 };
    scene.Contents.Lights = this->Lights;
    return scene;
  }
};

void PrintTo(const Case& c, std::ostream* os)
{
  *os << c.Name;
}

std::string GetName(const testing::TestParamInfo<Case>& c)
{
  return c.param.Name;
}

oracle::Light MakePane(
  const Vec3& origin, const Vec3& point1, const Vec3& point2, const std::array<double, 3>& radiance)
{
  oracle::Light pane;
  pane.Vertices = oracle::Parallelogram(origin, point1, point2);
  pane.Radiance = radiance;
  return pane;
}

/// A window of 3 x 3 panes in the wall x = 2.5, which shines towards -x: each row of panes is of
/// one primary colour, so that what blocks a row takes away a colour.
oracle::Surface MakeWindow()
{
  oracle::Surface window;
  for (int row = 0; row < 3; ++row)
  {
    std::array<double, 3> colour{ 0.1, 0.1, 0.1 };
    colour[static_cast<std::size_t>(row)] = 2.0;
    for (int column = 0; column < 3; ++column)
    {
      const long double y = -0.75L + 0.5L * column, z = 0.8L + 0.5L * row;
      window.Polygons.push_back(
        MakePane({ 2.5L, y, z }, { 2.5L, y, z + 0.5L }, { 2.5L, y + 0.5L, z }, colour));
    }
  }
  return window;
}

/// A polygon of twelve corners, which is more than a shader takes at a time.
oracle::Light MakeDodecagon()
{
  oracle::Light light;
  for (int i = 0; i < 12; ++i)
  {
    const long double angle = -std::acos(-1.0L) * i / 6;
    light.Vertices.push_back({ 0.6L * std::cos(angle), 0.4L * std::sin(angle), 2 });
  }
  light.Radiance = { 1.0, 0.7, 0.4 };
  return light;
}

/// Lights over the floor, beside it and cut by its plane, with more than one hue.
std::vector<Case> MakeLights()
{
  const std::array<double, 3> warm{ 1.5, 1.0, 0.5 };
  const oracle::Directional sun{ { 0.4L, 0.3L, -1 }, 0.53, warm };
  const oracle::Directional wideSun{ { 0.4L, 0.3L, -1 }, 20.0, warm };
  const oracle::Directional lowSun{ { 1, 0.2L, -0.1L }, 30.0, warm };
  oracle::Surface greenWindow = MakeWindow();
  for (oracle::Light& pane : greenWindow.Polygons)
  {
    pane.Radiance = { 0.0, 1.0, 0.0 };
  }
  std::vector<Case> cases{
    { "DiskOver", { oracle::Disk{ { 0.2L, 0.1L, 2 }, 0.5L, { 0, 0, -1 }, false, warm } } },
    { "DiskTilted",
      { oracle::Disk{ { 0.2L, -0.5L, 1.8L }, 0.6L, { 0.4L, 0.5L, -1 }, true, warm } } },
    { "DiskCutByThePlane",
      { oracle::Disk{ { 2.5L, 0, 0.3L }, 0.8L, { -1, 0.1L, 0.2L }, false, warm } } },
    { "DiskPartlyBehind", { oracle::Disk{ { 0.3L, 0, 1 }, 0.7L, { -1, 0.1L, 0 }, false, warm } } },
    { "EllipseOver",
      { oracle::Ellipse{
        { 0.2L, 0.1L, 2 }, { 0.9L, 0.2L, 0 }, { 0.2L, -0.3L, 0.1L }, false, warm } } },
    { "EllipseCutByThePlane",
      { oracle::Ellipse{ { 2.5L, 0, 0.3L }, { 0, 1, 0.4L }, { 0, -0.1L, 0.7L }, true, warm } } },
    { "SegmentOver", { oracle::Segment{ { -1, -0.3L, 1.5L }, { 0.8L, 0.4L, 1.8L }, warm } } },
    { "SegmentBeside", { oracle::Segment{ { 2.5L, -1, 0.4L }, { 2.4L, 1, 0.7L }, warm } } },
    { "SegmentCutByThePlane", { oracle::Segment{ { 2.5L, 1, -1 }, { 2.2L, 0.5L, 1.5L }, warm } } },
    { "PointOver", { oracle::Point{ { 0.3L, -0.2L, 1.7L }, warm } } },
    { "PointBeside", { oracle::Point{ { 3, 1, 0.5L }, warm } } },
    { "SunOfNoSize", { oracle::Directional{ { 0.4L, 0.3L, -1 }, 0.0, warm } } },
    { "Sun", { sun } },
    { "WideSun", { wideSun } },
    { "SunCutByTheHorizon", { lowSun } },
    { "Window", { MakeWindow() } },
    { "GreenWindow", { greenWindow } },
    { "Dodecagon", { MakeDodecagon() } },
    { "ManyCorneredPane", { oracle::Surface{ { MakeDodecagon() } } } },
  };
  cases.push_back({ "Several",
    { cases[0].Lights[0], cases[7].Lights[0], cases[10].Lights[0], wideSun, MakeWindow() } });
  return cases;
}

/// Of all components of all texels, as shares of the exact peak.
TestError Compare(const RandomScene& scene, const penumbra::ReceiverSettings& settings)
{
  const std::vector<glm::dvec3> exact = GetExactRadiance(scene, Texels);
  const TestBake bake = BakeReceiver(MakeShadowScene(scene, settings, Texels));
  double peak = 0.0, largest = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const glm::dvec3 error = glm::dvec3(bake.Texels.Irradiance.at(i)) - exact[i];
    for (int c = 0; c < 3; ++c)
    {
      peak = std::max(peak, exact[i][c]);
      largest = std::max(largest, std::abs(error[c]));
      squares += error[c] * error[c];
    }
  }
  return { std::sqrt(squares / (3.0 * static_cast<double>(exact.size()))) / peak, largest / peak };
}

void AddPlate(RandomScene& scene, const Vec3& corner, const Vec3& edge1, const Vec3& edge2)
{
  const Vec3 a = corner, b = corner + edge1, c = corner + edge1 + edge2, d = corner + edge2;
  scene.Contents.Occluders.push_back({ a, b, c });
  scene.Contents.Occluders.push_back({ a, c, d });
}

/// A table top, a board that leans over it and one before the lights beside the floor: their
/// corners are floats.
RandomScene AddOccluders(RandomScene scene)
{
  AddPlate(scene, { -0.5L, -0.75L, 0.5L }, { 1, 0.25L, 0 }, { -0.25L, 1, 0.125L });
  AddPlate(scene, { 0.5L, -0.5L, 0.25L }, { 0.25L, 1.25L, 0 }, { 0.25L, 0, 0.75L });
  AddPlate(scene, { 1.5L, -0.75L, 0.25L }, { -0.25L, 1.25L, 0 }, { 0.125L, 0, 0.5L });
  return scene;
}

/**
 * A bound of a component's RMS error by n samples of a light, as a share of its peak. A net of n
 * points has one in each of sqrt(n) x sqrt(n) cells. The outline of a convex occluder crosses each
 * of their rows and columns twice at most, that is 4 sqrt(n) cells, and each of these adds the
 * variance a (1 - a) / n^2 of its part a that is seen: 1 / 6 of 1 / n^2 in the mean. So the share
 * of the light that is seen has a standard error of sqrt(2/3) n^-3/4 in penumbras, and none
 * elsewhere.
 */
glm::dvec3 BoundError(
  const std::vector<glm::dvec3>& open, const std::vector<glm::dvec3>& exact, double n)
{
  glm::dvec3 squares(0.0), peak(0.0);
  for (std::size_t i = 0; i < open.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const bool isPenumbral = exact[i][c] > 0.0 && exact[i][c] < open[i][c];
      squares[c] += isPenumbral ? open[i][c] * open[i][c] : 0.0;
      peak[c] = std::max(peak[c], exact[i][c]);
    }
  }
  return std::sqrt(2.0 / 3.0) * std::pow(n, -0.75) *
    glm::sqrt(squares / static_cast<double>(open.size())) /
    glm::max(peak, glm::dvec3(std::numeric_limits<double>::min()));
}

bool IsHard(const AnyLight& light)
{
  const auto* sun = std::get_if<oracle::Directional>(&light);
  return std::holds_alternative<oracle::Point>(light) || (sun && sun->AngularDiameter == 0.0);
}

/**
 * A bound of the RMS error by rounding, as a share of the peak: OpenGL moves an occluder's corners
 * on the receiver to multiples of 1/256 of a texel (by GL_SUBPIXEL_BITS, which is 8 in Mesa), so
 * edges move by less than that. It is felt where a penumbra is narrower than a texel, as the sun's
 * are.
 */
double BoundRounding(const RandomScene& scene, const std::vector<glm::dvec3>& exact)
{
  std::vector<glm::dvec3> differences(exact.size(), glm::dvec3(0.0));
  for (const Vec3& edge : { scene.Edge1, scene.Edge2 })
  {
    for (const long double sign : { -1.0L, 1.0L })
    {
      RandomScene moved = scene;
      moved.Origin = scene.Origin + (sign / (256 * Side)) * edge;
      const std::vector<glm::dvec3> beside = GetExactRadiance(moved, Texels);
      for (std::size_t i = 0; i < exact.size(); ++i)
      {
        differences[i] = glm::max(differences[i], glm::abs(beside[i] - exact[i]));
      }
    }
  }
  double squares = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    squares += glm::dot(differences[i], differences[i]);
    peak = std::max({ peak, exact[i].x, exact[i].y, exact[i].z });
  }
  return std::sqrt(squares / (3.0 * static_cast<double>(exact.size()))) / peak;
}

std::vector<Case> SelectLights(bool hard)
{
  std::vector<Case> cases = MakeLights();
  cases.erase(std::remove_if(cases.begin(), cases.end(),
                [&](const Case& c)
                {
                  return hard != std::all_of(c.Lights.begin(), c.Lights.end(), IsHard) ||
                    (!hard && std::any_of(c.Lights.begin(), c.Lights.end(), IsHard));
                }),
    cases.end());
  return cases;
}

} // namespace

class UnoccludedShape : public testing::TestWithParam<Case>
{
};

// The bound for single precision.
TEST_P(UnoccludedShape, IsExact)
{
  const TestError error = Compare(this->GetParam().MakeScene(), {});
  std::cout << this->GetParam().Name << ": maximum " << error.Maximum << " of the peak\n";
  EXPECT_LE(error.Maximum, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Lights, UnoccludedShape, testing::ValuesIn(MakeLights()), GetName);

class OccludedShape : public testing::TestWithParam<Case>
{
};

TEST_P(OccludedShape, IsWithinBoundsAt1024Samples)
{
  penumbra::ReceiverSettings settings;
  settings.LightSamples = 1024;
  settings.HardPenumbra = 0.0; // samples are judged, however narrow the penumbra is
  const RandomScene open = this->GetParam().MakeScene(), scene = AddOccluders(open);
  const std::vector<glm::dvec3> exact = GetExactRadiance(scene, Texels);
  const glm::dvec3 bounds = BoundError(GetExactRadiance(open, Texels), exact, 1024.0);
  const double bound = std::max({ bounds.x, bounds.y, bounds.z }) + BoundRounding(scene, exact);
  const TestError error = Compare(scene, settings);
  std::cout << this->GetParam().Name << ": RMS " << error.RootMeanSquare << " (bound " << bound
            << "), maximum " << error.Maximum << " of the peak\n";
  EXPECT_LE(error.RootMeanSquare, bound);
}

// The bounds, 4e-3 at most, would notice if nothing were blocked.
TEST_P(OccludedShape, IsFarFromUnoccluded)
{
  const RandomScene scene = this->GetParam().MakeScene();
  const std::vector<glm::dvec3> open = GetExactRadiance(scene, Texels);
  const std::vector<glm::dvec3> shadowed = GetExactRadiance(AddOccluders(scene), Texels);
  double squares = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < open.size(); ++i)
  {
    squares += glm::dot(open[i] - shadowed[i], open[i] - shadowed[i]) / 3.0;
    peak = std::max({ peak, shadowed[i].x, shadowed[i].y, shadowed[i].z });
  }
  EXPECT_GT(std::sqrt(squares / static_cast<double>(open.size())) / peak, 7e-3);
}

INSTANTIATE_TEST_SUITE_P(Lights, OccludedShape, testing::ValuesIn(SelectLights(false)), GetName);

class HardShape : public testing::TestWithParam<Case>
{
};

// A hard shadow is right but where an edge passes so close by a texel's centre that OpenGL may take
// it to be on the other side: it rounds corners to 1/256 of a texel (by GL_SUBPIXEL_BITS, which is
// 8 in Mesa). Around those centres, the exact answer has both values.
TEST_P(HardShape, IsExactAwayFromEdges)
{
  const RandomScene scene = AddOccluders(this->GetParam().MakeScene());
  const std::vector<glm::dvec3> exact = GetExactRadiance(scene, Texels);
  const TestBake bake = BakeReceiver(MakeShadowScene(scene, {}, Texels));
  const double peak = std::max_element(exact.begin(), exact.end(),
    [](const glm::dvec3& a, const glm::dvec3& b) {
      return a.x < b.x;
    })->x;
  constexpr long double rounding = 1.0L / 256;
  int byEdges = 0;
  for (int i = 0; i < Side * Side; ++i)
  {
    const auto texel = static_cast<std::size_t>(i);
    const double baked = bake.Texels.Irradiance.at(texel).r;
    if (std::abs(baked - exact[texel].x) <= 1e-5 * peak)
    {
      continue;
    }
    ++byEdges;
    bool isNearEdge = false;
    for (int j = 0; j < 9; ++j)
    {
      const long double u = (i % Side + 0.5L + rounding * (j % 3 - 1)) / Side;
      const long double v = (i / Side + 0.5L + rounding * (j / 3 - 1)) / Side;
      const double nearby = oracle::Radiance(scene.At(u, v), scene.Normal(), scene.Contents)[0];
      // From one corner of the neighbourhood to another, radiance itself changes less than 1e-2.
      isNearEdge = isNearEdge || std::abs(nearby - baked) <= 1e-2 * peak;
    }
    EXPECT_TRUE(isNearEdge) << "texel " << i % Side << ", " << i / Side;
  }
  std::cout << this->GetParam().Name << ": " << byEdges << " texels on edges\n";
  // Outlines of some 400 texels have 400 x 2/256 centres that near, 3 in the mean, and hardly ever
  // three times as many.
  EXPECT_LE(byEdges, 9);
}

// One sample says all.
TEST_P(HardShape, TakesOneSample)
{
  const RandomScene scene = AddOccluders(this->GetParam().MakeScene());
  EXPECT_EQ(
    BakeReceiver(MakeShadowScene(scene, {}, Texels)).Reports.front().Pairs.front().LightSamples, 1);
}

INSTANTIATE_TEST_SUITE_P(Lights, HardShape, testing::ValuesIn(SelectLights(true)), GetName);

// A board across the lowest row of panes takes away red and leaves blue: each component is blocked
// by itself. A third of the samples decides for each.
TEST(StainedGlass, IsBlockedColourByColour)
{
  RandomScene scene = Case{ "", { MakeWindow() } }.MakeScene();
  const std::vector<glm::dvec3> open = GetExactRadiance(scene, Texels);
  AddPlate(scene, { 2, -1, 0.5L }, { 0, 2, 0 }, { 0, 0, 0.625L });
  const std::vector<glm::dvec3> exact = GetExactRadiance(scene, Texels);
  penumbra::ReceiverSettings settings;
  settings.LightSamples = 1024;
  const TestBake bake = BakeReceiver(MakeShadowScene(scene, settings, Texels));
  glm::dvec3 peak(0.0), squares(0.0);
  double mostApart = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const glm::dvec3 error = glm::dvec3(bake.Texels.Irradiance.at(i)) - exact[i];
    squares += error * error;
    peak = glm::max(peak, exact[i]);
    const glm::dvec3 share = exact[i] / open[i];
    mostApart = std::max(mostApart, std::abs(share.x - share.z));
  }
  EXPECT_GT(mostApart, 0.5); // the colours' shares are not alike
  const glm::dvec3 errors = glm::sqrt(squares / static_cast<double>(exact.size())) / peak;
  const glm::dvec3 bounds = BoundError(open, exact, 1024.0 / 3.0);
  for (int c = 0; c < 3; ++c)
  {
    std::cout << "component " << c << ": RMS " << errors[c] << " (bound " << bounds[c]
              << ") of its peak\n";
    EXPECT_LE(errors[c], bounds[c]);
  }
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lights of every kind: the closed form against the exact oracle, samples by where they land and by
// what they add up to, and how lights are moved, bounded and told apart. TestLightKinds and
// TestPolygonLight have what is particular to a kind.

#include "DirectionalLight.h"
#include "DiskLight.h"
#include "LargestDeviation.h"
#include "OracleScene.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "RandomGeometry.h"
#include "SamplingPattern.h"
#include "SegmentLight.h"
#include "ShadowSettings.h"
#include "SurfaceLight.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace
{

using oracle::AnyLight;
using penumbra::Light;
using penumbra::LightSample;

constexpr int Lights = 1000;
constexpr double Pi = glm::pi<double>();

// Lengths and heights of coordinates of size 10 and less: some 100 roundings of 1.1e-16 times 10.
constexpr double Rounding = 1e-12;

// ---- Random lights ----

std::array<double, 3> RandomColour(RandomGeometry& random)
{
  const double r = random.Between(0.1, 2.0), g = random.Between(0.1, 2.0);
  return { r, g, random.Between(0.1, 2.0) };
}

glm::dvec3 Above(RandomGeometry& random)
{
  return glm::dvec3(0.0, 0.0, 1.2) + random.InBox(0.5);
}

// A convex polygon: corners on an ellipse in any attitude.
oracle::Light RandomPolygon(RandomGeometry& random, int corners)
{
  const glm::dvec3 centre = Above(random), u = random.Direction();
  const glm::dvec3 v = glm::normalize(glm::cross(u, random.Direction()));
  const double a = random.Between(0.1, 0.8), b = random.Between(0.1, 0.8);
  oracle::Light light;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 2.0 * Pi * i / corners;
    light.Vertices.push_back(ToOracle(centre + a * std::cos(angle) * u + b * std::sin(angle) * v));
  }
  light.TwoSided = random.Below(2) == 0;
  light.Radiance = RandomColour(random);
  return light;
}

AnyLight RandomPolygonLight(RandomGeometry& random)
{
  return RandomPolygon(random, 3 + static_cast<int>(random.Below(12)));
}

AnyLight RandomDisk(RandomGeometry& random)
{
  oracle::Disk disk;
  disk.Centre = ToOracle(Above(random));
  disk.Radius = random.Between(0.05, 0.8);
  disk.Normal = ToOracle(random.Direction());
  disk.TwoSided = random.Below(2) == 0;
  disk.Radiance = RandomColour(random);
  return disk;
}

// Of any conjugate radii, some of them nearly a circle's or nearly along a line.
AnyLight RandomEllipse(RandomGeometry& random)
{
  oracle::Ellipse ellipse;
  ellipse.Centre = ToOracle(Above(random));
  const glm::dvec3 a = random.Between(0.05, 0.8) * random.Direction();
  glm::dvec3 b = random.Between(0.05, 0.8) * random.Direction();
  if (random.Below(3) == 0)
  {
    const glm::dvec3 across = glm::normalize(glm::cross(a, b));
    const double off = std::pow(10.0, random.Between(-6.0, 0.0));
    b = random.Below(2) == 0 ? glm::cross(across, a) + off * b : a + off * b;
  }
  ellipse.A = ToOracle(a);
  ellipse.B = ToOracle(b);
  ellipse.TwoSided = random.Below(2) == 0;
  ellipse.Radiance = RandomColour(random);
  return ellipse;
}

AnyLight RandomSegment(RandomGeometry& random)
{
  const glm::dvec3 a = Above(random);
  return oracle::Segment{ ToOracle(a), ToOracle(a + random.InBox(1.0)), RandomColour(random) };
}

AnyLight RandomPoint(RandomGeometry& random)
{
  return oracle::Point{ ToOracle(Above(random)), RandomColour(random) };
}

AnyLight RandomSun(RandomGeometry& random)
{
  const glm::dvec3 direction = random.Direction();
  const double diameter = random.Below(4) == 0 ? 0.0 : random.Between(0.5, 60.0);
  return oracle::Directional{ ToOracle(direction), diameter, RandomColour(random) };
}

AnyLight RandomSurface(RandomGeometry& random)
{
  oracle::Surface surface;
  const bool twoSided = random.Below(2) == 0;
  for (std::size_t i = 0; i < 1 + random.Below(6); ++i)
  {
    surface.Polygons.push_back(RandomPolygon(random, 3 + static_cast<int>(random.Below(12))));
    surface.Polygons.back().TwoSided = twoSided;
  }
  return surface;
}

struct Kind
{
  const char* Name;
  AnyLight (*Make)(RandomGeometry& random);
};

void PrintTo(const Kind& kind, std::ostream* os)
{
  *os << kind.Name;
}

const std::vector<Kind> Kinds{
  { "Polygon", RandomPolygonLight },
  { "Disk", RandomDisk },
  { "Ellipse", RandomEllipse },
  { "Segment", RandomSegment },
  { "Point", RandomPoint },
  { "Sun", RandomSun },
  { "Surface", RandomSurface },
};

// A place of the receiver and its unit normal, any way round: it looks past many lights, and its
// horizon cuts others.
struct Place
{
  explicit Place(RandomGeometry& random)
    : X(random.InBox(0.4))
    , N(random.Direction())
  {
  }
  glm::dvec3 X, N;
};

glm::dvec3 GetExact(const Place& place, const AnyLight& light)
{
  const auto e = oracle::ArrivingRadiance(ToOracle(place.X), ToOracle(place.N), light, {});
  return { static_cast<double>(e[0]), static_cast<double>(e[1]), static_cast<double>(e[2]) };
}

// The size of what a closed form adds up: 1 for form factors and suns; 1 / d for a segment, d the
// distance from its line, and 1 / d^2 for a point; times the brightest radiance.
struct SizeOf
{
  const glm::dvec3& X;

  static double Most(const std::array<double, 3>& c) { return std::max({ c[0], c[1], c[2] }); }
  double operator()(const oracle::Light& light) const { return Most(light.Radiance); }
  // Terms as large as the radius over the distance come out as its square.
  double operator()(const oracle::Disk& light) const { return Most(light.Radiance); }
  double operator()(const oracle::Ellipse& light) const { return Most(light.Radiance); }
  double operator()(const oracle::Segment& light) const
  {
    const glm::dvec3 a = FromOracle(light.A);
    const glm::dvec3 axis = glm::normalize(FromOracle(light.B) - a);
    return Most(light.Radiance) / glm::length(glm::cross(this->X - a, axis));
  }
  double operator()(const oracle::Point& light) const
  {
    const glm::dvec3 d = FromOracle(light.Position) - this->X;
    return Most(light.Intensity) / glm::dot(d, d);
  }
  double operator()(const oracle::Directional& light) const
  {
    // A sun's form factor is divided by that of the whole, and its terms are of the radius' size.
    const double radius = std::tan(glm::radians(0.5 * light.AngularDiameter));
    return Most(light.Irradiance) * (radius > 0.0 ? std::max(1.0, 1.0 / radius) : 1.0);
  }
  double operator()(const oracle::Surface& light) const
  {
    double sum = 0.0;
    for (const oracle::Light& polygon : light.Polygons)
    {
      sum += Most(polygon.Radiance);
    }
    return sum;
  }
};

double GetSize(const glm::dvec3& x, const AnyLight& light)
{
  return std::visit(SizeOf{ x }, light);
}

// Some 20 roundings of 1.1e-16 an edge or an arc, and up to 30 of them, made larger by the distance
// over the height where the horizon clips them or over the radius where arcs cancel: a factor of a
// hundred is left for that.
constexpr double Tolerance = 1e-12;

void ExpectNear(const glm::dvec3& actual, const glm::dvec3& expected, double size,
  LargestDeviation& largest, unsigned seed)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_LE(largest.Add(actual[c] - expected[c], size), Tolerance) << "seed " << seed;
  }
}

} // namespace

class LightKinds : public testing::TestWithParam<Kind>
{
};

TEST_P(LightKinds, ArrivesAsInTheOracle)
{
  LargestDeviation largest;
  int lit = 0;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    const Place place(random);
    const glm::dvec3 exact = GetExact(place, light);
    const glm::dvec3 actual = MakeLight(light)->Irradiance(place.X, place.N);
    ExpectNear(actual, exact, GetSize(place.X, light), largest, seed);
    lit += exact.x > 0.0;
  }
  EXPECT_GE(lit, Lights / 5);
}

// What a receiver's plane leaves of a light sends to the places of the plane what the whole does.
TEST_P(LightKinds, ClippedSendsTheSame)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    Place place(random);
    const Light seen(MakeLight(light)->Clip(place.X, place.N));
    place.X += 0.5 * glm::cross(place.N, random.Direction()); // to elsewhere in the plane
    const glm::dvec3 exact = GetExact(place, light);
    if (!seen->IsValid())
    {
      ExpectNear(glm::dvec3(0.0), exact, GetSize(place.X, light), largest, seed);
      continue;
    }
    ExpectNear(seen->Irradiance(place.X, place.N), exact, GetSize(place.X, light), largest, seed);
  }
}

TEST_P(LightKinds, ClippedHasItsSamplesInFront)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const Light light = MakeLight(this->GetParam().Make(random));
    const Place place(random);
    const Light seen(light->Clip(place.X, place.N));
    if (!seen->IsValid())
    {
      continue;
    }
    const penumbra::LightHull hull = seen->GetHull();
    double highest = 0.0;
    for (const glm::dvec3& p : hull.Points)
    {
      const glm::dvec3 origin = hull.AreDirections ? glm::dvec3(0.0) : place.X;
      highest = std::max(highest, glm::dot(p - origin, place.N));
    }
    for (const LightSample& sample : seen->TakeSamples(penumbra::GenerateSobol(64, seed, 1.0)))
    {
      const glm::dvec3 origin = sample.IsDirection ? glm::dvec3(0.0) : place.X;
      const double height = glm::dot(sample.Place - origin, place.N);
      EXPECT_GE(height, -Rounding) << "seed " << seed;
      EXPECT_LE(height, highest + Rounding) << "seed " << seed;
    }
  }
}

namespace
{

// What a sample sends to a place, by what Emission says of it, apart from its share.
double GetWeight(const penumbra::LightShape& light, const LightSample& sample, const Place& place)
{
  const glm::dvec3 d = sample.IsDirection ? sample.Place : sample.Place - place.X;
  const double r = glm::length(d), cosine = std::max(glm::dot(place.N, d) / r, 0.0);
  switch (light.GetEmission())
  {
    case penumbra::Emission::Area:
      return cosine * std::abs(glm::dot(light.GetAxis(), d)) / (Pi * r * r * r);
    case penumbra::Emission::Line:
      return cosine * glm::length(glm::cross(light.GetAxis(), d)) / (Pi * r * r * r);
    case penumbra::Emission::Point:
      return cosine / (Pi * r * r);
    default:
      break;
  }
  const double leaving = -glm::dot(sample.Normal, d);
  return cosine * (light.TwoSided ? std::abs(leaving) : std::max(leaving, 0.0)) / (Pi * r * r * r);
}

// The light that the samples send to a place, in front of which the light is.
glm::dvec3 Estimate(const penumbra::LightShape& light, double measure,
  const std::vector<LightSample>& samples, const Place& place)
{
  glm::dvec3 sum(0.0);
  for (const LightSample& sample : samples)
  {
    const bool isOfCells = light.GetEmission() == penumbra::Emission::Cells;
    sum += GetWeight(light, sample, place) * (isOfCells ? sample.Power : light.Radiance * measure);
  }
  return light.Faces(place.X) ? sum / static_cast<double>(samples.size()) : glm::dvec3(0.0);
}

// What the weights of a light's samples add up to per share: its measure; for a sun, whose radiance
// is the irradiance at normal incidence, the disk's area over pi sin^2 of its angular radius.
double GetSampledMeasure(const AnyLight& light, const penumbra::LightShape& seen)
{
  const auto* sun = std::get_if<oracle::Directional>(&light);
  if (!sun || sun->AngularDiameter == 0.0)
  {
    return seen.GetMeasure();
  }
  const double cosine = std::cos(glm::radians(0.5 * sun->AngularDiameter));
  return 1.0 / (cosine * cosine);
}

} // namespace

// Averaged over many scrambles, each of which is unbiased, the samples send what the light does:
// within five standard errors, which one in two million passes.
TEST_P(LightKinds, SamplesAreUnbiased)
{
  constexpr int scrambles = 100;
  int tested = 0;
  for (unsigned seed = 0; tested < 30; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    const Place place(random);
    const Light whole = MakeLight(light);
    const Light seen(whole->Clip(place.X, place.N));
    const glm::dvec3 exact = GetExact(place, light);
    // The measure of what is left of a sun is not known.
    const bool isCutSun =
      std::holds_alternative<oracle::Directional>(light) && seen->GetKey() != whole->GetKey();
    if (!seen->IsValid() || exact.x == 0.0 || isCutSun)
    {
      continue;
    }
    ++tested;
    const double measure = GetSampledMeasure(light, *seen);
    glm::dvec3 sum(0.0), squares(0.0);
    for (unsigned scramble = 0; scramble < scrambles; ++scramble)
    {
      const auto samples = seen->TakeSamples(penumbra::GenerateSobol(16, scramble, 1.0));
      const glm::dvec3 estimate = Estimate(*seen, measure, samples, place);
      sum += estimate;
      squares += (estimate - exact) * (estimate - exact);
    }
    const glm::dvec3 mean = sum / static_cast<double>(scrambles);
    for (int c = 0; c < 3; ++c)
    {
      const double standardError = std::sqrt(squares[c]) / scrambles;
      EXPECT_LE(std::abs(mean[c] - exact[c]), 5.0 * standardError + Tolerance * exact[c])
        << "seed " << seed;
    }
  }
}

// More samples send what the light does, ever more closely: by 4096 of a net to 1 %.
TEST_P(LightKinds, SamplesConverge)
{
  const auto points = penumbra::GenerateSobol(4096, 0, 1.0);
  int tested = 0;
  for (unsigned seed = 0; tested < 30; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    Place place(random);
    place.X -= place.N; // away from lights, whose weights are even from there
    const Light whole = MakeLight(light);
    const Light seen(whole->Clip(place.X, place.N));
    const glm::dvec3 exact = GetExact(place, light);
    const bool isCut = seen->GetKey() != whole->GetKey();
    if (!seen->IsValid() || exact.x < 1e-3 || isCut)
    {
      continue;
    }
    ++tested;
    const glm::dvec3 estimate =
      Estimate(*seen, GetSampledMeasure(light, *seen), seen->TakeSamples(points), place);
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(estimate[c], exact[c], 1e-2 * exact[c]) << "seed " << seed;
    }
  }
}

namespace
{

glm::dmat4 RandomSimilarity(RandomGeometry& random, double scale, bool isMirror)
{
  glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), random.InBox(3.0));
  matrix = glm::rotate(matrix, random.Between(0.0, 2.0 * Pi), random.Direction());
  return glm::scale(matrix, scale * glm::dvec3(isMirror ? -1.0 : 1.0, 1.0, 1.0));
}

// How an amount of light at a place changes if everything is scaled.
double GetScaleFactor(const AnyLight& light, double scale)
{
  return std::holds_alternative<oracle::Segment>(light) ? 1.0 / scale
    : std::holds_alternative<oracle::Point>(light)      ? 1.0 / (scale * scale)
                                                        : 1.0;
}

} // namespace

// Where all is turned, scaled and mirrored, light and receiver, what arrives is the same; per
// length of a segment, and by the square of the distance of a point.
TEST_P(LightKinds, MovedSendsTheSame)
{
  LargestDeviation largest;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    const Place place(random);
    const double scale = random.Between(0.5, 2.0);
    const glm::dmat4 matrix = RandomSimilarity(random, scale, seed % 2 == 0);
    Place moved = place;
    moved.X = glm::dvec3(matrix * glm::dvec4(place.X, 1.0));
    moved.N = glm::normalize(glm::dmat3(matrix) * place.N);
    const glm::dvec3 exact = GetScaleFactor(light, scale) * GetExact(place, light);
    // Coordinates that are ten times as large round ten times as much.
    ExpectNear(Light(MakeLight(light)->Transform(matrix))->Irradiance(moved.X, moved.N), exact,
      10.0 * GetSize(place.X, light), largest, seed);
  }
}

TEST_P(LightKinds, KeysTellLightsApart)
{
  std::vector<std::vector<double>> keys;
  for (const Kind& kind : Kinds)
  {
    for (unsigned seed = 0; seed < 20; ++seed)
    {
      RandomGeometry random(seed), again(seed);
      const Light light = MakeLight(kind.Make(random));
      EXPECT_EQ(light->GetKey(), MakeLight(kind.Make(again))->GetKey());
      Light brighter = light, twoSided = light;
      brighter->Radiance.y += 0.5;
      twoSided->TwoSided = !light->TwoSided;
      const Place place(random);
      keys.insert(keys.end(), { light->GetKey(), brighter->GetKey(), twoSided->GetKey() });
    }
  }
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

namespace
{

// Van Oosterom and Strackee 1983.
double GetSolidAngle(const std::vector<glm::dvec3>& polygon, const glm::dvec3& x)
{
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
  {
    const glm::dvec3 a = glm::normalize(polygon[0] - x), b = glm::normalize(polygon[i] - x);
    const glm::dvec3 c = glm::normalize(polygon[i + 1] - x);
    sum += 2.0 *
      std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
        1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  }
  return sum;
}

// The solid angle of the largest sample of n, seen from x, or at least nine tenths of it: of a disk
// by a polygon of 64 corners in it.
double GetLargestSample(const penumbra::LightShape& light, const glm::dvec3& x, int n)
{
  if (const auto* disk = dynamic_cast<const penumbra::DiskLight*>(&light))
  {
    return GetSolidAngle(disk->GetRim(64), x) / n;
  }
  if (const auto* surface = dynamic_cast<const penumbra::SurfaceLight*>(&light))
  {
    double whole = 0.0, largest = 0.0;
    const auto power = [](const penumbra::PolygonLight& cell)
    { return (cell.Radiance.x + cell.Radiance.y + cell.Radiance.z) * cell.GetArea(); };
    for (const penumbra::PolygonLight& cell : surface->GetCells())
    {
      whole += power(cell);
    }
    for (const penumbra::PolygonLight& cell : surface->GetCells())
    {
      const double share = power(cell) / whole;
      largest = std::max(largest, GetSolidAngle(cell.GetVertices(), x) / (share * n));
    }
    return largest;
  }
  const auto& polygon = dynamic_cast<const penumbra::PolygonLight&>(light);
  return GetSolidAngle(polygon.GetVertices(), x) / n;
}

} // namespace

// The bound of a light's solid angle is one, from anywhere on the receiver, so that no sample's
// share passes SolidAnglePerSample.
TEST_P(LightKinds, SamplesAreAsManyAsTheirSolidAngleAsks)
{
  penumbra::ReceiverSettings settings;
  settings.SolidAnglePerSample = 0.01;
  settings.MaximumLightSamples = penumbra::ReceiverSettings::MostLightSamples;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const AnyLight light = this->GetParam().Make(random);
    const Light shape = MakeLight(light);
    const penumbra::Parallelogram receiver{ random.InBox(0.5) - glm::dvec3(0.0, 0.0, 1.0),
      random.InBox(0.5), random.InBox(0.5) };
    const double bound = shape->GetSolidAngleBound(receiver);
    const int count = settings.GetSampleCount(bound);
    if (std::holds_alternative<oracle::Segment>(light) ||
      std::holds_alternative<oracle::Point>(light))
    {
      EXPECT_EQ(bound, 0.0);
      EXPECT_EQ(count, settings.LightSamples);
      continue;
    }
    if (const auto* sun = std::get_if<oracle::Directional>(&light))
    {
      const double cosine = std::cos(glm::radians(0.5 * sun->AngularDiameter));
      EXPECT_NEAR(bound, 2.0 * Pi * (1.0 - cosine), Rounding);
      EXPECT_EQ(count,
        sun->AngularDiameter > 0.0 ? static_cast<int>(std::ceil(bound / 0.01))
                                   : settings.LightSamples);
      continue;
    }
    for (int i = 0; i < 8; ++i)
    {
      const double u = random.Between(0.0, 1.0);
      const glm::dvec3 x =
        receiver.Corner + u * receiver.EdgeX + random.Between(0.0, 1.0) * receiver.EdgeY;
      EXPECT_LE(GetLargestSample(*shape, x, 1), bound * (1.0 + Rounding)) << "seed " << seed;
      if (count < settings.MaximumLightSamples)
      {
        EXPECT_LE(GetLargestSample(*shape, x, count), settings.SolidAnglePerSample * (1 + Rounding))
          << "seed " << seed;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, LightKinds, testing::ValuesIn(Kinds),
  [](const testing::TestParamInfo<Kind>& kind) { return std::string(kind.param.Name); });

// ---- Surfaces ----

// Cells are split so that shaders can take them, even where a plane adds a corner.
TEST(SurfaceLight, HasPolygonsOfFewCorners)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const Light light = MakeLight(RandomSurface(random));
    const Place place(random);
    const Light seen(light->Clip(place.X, place.N));
    for (const penumbra::EmittingPolygon& polygon : seen->GetPolygons())
    {
      EXPECT_LE(polygon.Polygon->GetVertices().size(),
        std::size_t{ penumbra::LightShape::MaximumVertices });
    }
  }
}

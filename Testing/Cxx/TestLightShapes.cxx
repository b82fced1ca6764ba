// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lights of every kind: the closed form against the exact oracle, samples by where they land and by
// what they add up to, and how lights are moved, bounded and told apart. TestPolygonLight has more
// on polygons.

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
#include <limits>
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

// ---- Disks ----

namespace
{

// A disk, some of which a plane has cut.
struct RandomCutDisk
{
  explicit RandomCutDisk(unsigned seed)
    : RandomCutDisk(RandomGeometry(seed))
  {
  }

  penumbra::DiskLight Whole, Seen;

private:
  explicit RandomCutDisk(RandomGeometry random)
    : Whole(random.InBox(0.5), random.Direction(), random.Between(0.1, 1.0))
    , Seen(this->Whole.ClippedToFront(
        this->Whole.GetCentre() + random.InBox(0.5 * this->Whole.GetRadius()), random.Direction()))
  {
  }
};

} // namespace

TEST(DiskLight, SamplesLandOnIt)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomCutDisk disk(seed);
    for (const penumbra::DiskLight& light : { disk.Whole, disk.Seen })
    {
      for (const glm::dvec2& s : penumbra::GenerateSobol(light.IsValid() ? 32 : 0, seed, 1.0))
      {
        const glm::dvec3 d = light.Sample(s) - light.GetCentre();
        EXPECT_LE(glm::length(d), light.GetRadius() + Rounding);
        EXPECT_NEAR(glm::dot(d, light.GetNormal()), 0.0, Rounding);
      }
    }
  }
}

// The map stretches all areas alike, by the light's area: its Jacobian, by central differences,
// whose error is h^2 times third derivatives. Those are below 1e3 away from the ends, where chords
// are short, and from the diagonals, where the concentric map has its folds.
TEST(DiskLight, StretchesAreasAlike)
{
  constexpr double h = 1e-5;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomCutDisk disk(seed);
    RandomGeometry random(seed + Lights);
    for (const penumbra::DiskLight& light : { disk.Whole, disk.Seen })
    {
      const glm::dvec2 s(random.Between(0.1, 0.9), random.Between(0.1, 0.9));
      if (!light.IsValid() || std::abs(s.x - s.y) < 0.01 || std::abs(s.x + s.y - 1.0) < 0.01)
      {
        continue;
      }
      const glm::dvec3 x = light.Sample({ s.x + h, s.y }) - light.Sample({ s.x - h, s.y });
      const glm::dvec3 y = light.Sample({ s.x, s.y + h }) - light.Sample({ s.x, s.y - h });
      EXPECT_NEAR(glm::length(glm::cross(x, y)) / (4.0 * h * h), light.GetMeasure(), 1e-6)
        << "seed " << seed;
    }
  }
}

// Samples cover all of it: their mean is the centroid, and what they scatter is the disk's moment.
// The midpoints of n x n cells know both to some 1 / n^2.
TEST(DiskLight, SamplesHaveItsMoments)
{
  constexpr int n = 64;
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    const RandomCutDisk disk(seed);
    glm::dvec3 mean(0.0);
    glm::dmat3 scatter(0.0);
    for (const glm::dvec2& s : penumbra::GenerateUniformGrid(n * n, 0, 1.0))
    {
      const glm::dvec3 d =
        (disk.Whole.Sample(s) - disk.Whole.GetCentre()) / (disk.Whole.GetRadius() * n);
      mean += d / double(n);
      scatter += glm::outerProduct(d, d);
    }
    const glm::dvec3 w = disk.Whole.GetNormal();
    const glm::dmat3 exact = 0.25 * (glm::dmat3(1.0) - glm::outerProduct(w, w));
    EXPECT_LE(glm::length(mean), 1.0 / n);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_LE(glm::length(scatter[i] - exact[i]), 1.0 / (n * n)) << "seed " << seed;
    }
  }
}

// The area that a chord leaves, and its centroid: 2/3 sin^3 a over a - sin a cos a, for half an arc
// of a.
TEST(DiskLight, KeepsTheSegmentBeyondAChord)
{
  const penumbra::DiskLight disk({ 1.0, 2.0, 3.0 }, { 0.0, 0.0, -2.0 }, 1.0);
  for (const double offset : { -0.9, -0.5, 0.0, 0.3, 0.95 })
  {
    const penumbra::DiskLight seen =
      disk.ClippedToFront({ 1.0 + offset, 0.0, 0.0 }, { 1.0, 0.0, 0.0 });
    const double a = std::acos(offset), area = a - std::sin(a) * offset;
    EXPECT_NEAR(seen.GetMeasure(), area, Rounding);
    constexpr int n = 64;
    glm::dvec3 mean(0.0);
    for (const glm::dvec2& s : penumbra::GenerateUniformGrid(n * n, 0, 1.0))
    {
      mean += (seen.Sample(s) - disk.GetCentre()) / double(n * n);
    }
    // The quantile's slope has no end at the ends: midpoints know it to some 1 / n^(5/3).
    EXPECT_NEAR(mean.x, 2.0 / 3.0 * std::pow(std::sin(a), 3.0) / area, 2e-3);
    EXPECT_NEAR(mean.y, 0.0, Rounding);
  }
}

// An ellipse is taken as the disk of its area, around its centre.
TEST(DiskLight, StretchedHasTheEllipsesArea)
{
  penumbra::DiskLight disk({ 1.0, 2.0, 3.0 }, { 0.0, 0.0, 1.0 }, 0.5);
  disk.Radiance = { 1.0, 2.0, 3.0 };
  disk.TwoSided = true;
  const penumbra::DiskLight stretched =
    disk.Transformed(glm::scale(glm::dmat4(1.0), { 4.0, 1.0, -3.0 }));
  EXPECT_NEAR(stretched.GetMeasure(), Pi * 2.0 * 0.5, Rounding);
  EXPECT_NEAR(glm::length(stretched.GetCentre() - glm::dvec3(4.0, 2.0, -9.0)), 0.0, Rounding);
  EXPECT_NEAR(stretched.GetNormal().z, -1.0, Rounding); // the front goes with the surface
  EXPECT_EQ(stretched.Radiance, disk.Radiance);
  EXPECT_TRUE(stretched.TwoSided);
}

TEST(DiskLight, KeysTellHalvesApart)
{
  const penumbra::DiskLight disk({ 0.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0 }, 1.0);
  const penumbra::DirectionalLight sun({ 0.0, 0.0, -1.0 }, 30.0);
  const glm::dvec3 origin(0.0), left(-1.0, 0.0, 0.0), right(1.0, 0.0, 0.0);
  EXPECT_NE(disk.GetKey(), disk.ClippedToFront(origin, left).GetKey());
  EXPECT_NE(
    disk.ClippedToFront(origin, right).GetKey(), disk.ClippedToFront(origin, left).GetKey());
  EXPECT_NE(sun.GetKey(), sun.ClippedToFront(origin, left).GetKey());
}

// The oracle loses digits where a disk is small or far; the product does not: its form factor is
// cos t cos t' r^2 / d^2 up to r^2 / d^2 of it.
TEST(DiskLight, IsExactWhereItIsSmallOrFills)
{
  const glm::dvec3 centre(0.3, 0.1, 1.0), normal = glm::normalize(glm::dvec3(0.2, -0.1, -1.0));
  const glm::dvec3 x(0.0), n(0.0, 0.0, 1.0);
  const double distance = glm::length(centre);
  const double cosines = centre.z * -glm::dot(centre, normal) / (distance * distance);
  for (const double radius : { 1e-9, 1e-8, 1e-7 })
  {
    const double share = radius * radius / (distance * distance);
    EXPECT_NEAR(penumbra::DiskLight(centre, normal, radius).FormFactor(x, n) / (cosines * share),
      1.0, 10.0 * share + 1e-14);
  }
  // An endless ceiling that faces the place fills half of the sky and of the place's cosine lobe
  // (1 + cosine) / 2.
  for (const double radius : { 1e6, 1e9 })
  {
    EXPECT_NEAR(penumbra::DiskLight(centre, normal, radius).FormFactor(x, n),
      0.5 * (1.0 - normal.z), 10.0 / radius);
  }
}

// ---- Segments, points, suns ----

TEST(SegmentLight, SamplesAreSpreadEvenlyAlongIt)
{
  const glm::dvec3 a(1.0, 2.0, 3.0), b(-2.0, 0.5, 4.0);
  const penumbra::SegmentLight segment(a, b);
  const auto pattern = penumbra::GenerateUniformGrid(64, 0, segment.GetAspect());
  EXPECT_EQ(pattern.size(), 64u); // all of them along it
  std::vector<double> along;
  for (const LightSample& sample : segment.TakeSamples(pattern))
  {
    const double t = glm::dot(sample.Place - a, b - a) / glm::dot(b - a, b - a);
    EXPECT_NEAR(glm::length(a + t * (b - a) - sample.Place), 0.0, Rounding);
    along.push_back(t);
  }
  std::sort(along.begin(), along.end());
  for (std::size_t i = 0; i < along.size(); ++i)
  {
    EXPECT_NEAR(along[i], (static_cast<double>(i) + 0.5) / 64.0, Rounding);
  }
}

TEST(SegmentLight, ShowsNothingAlongItsLine)
{
  const penumbra::SegmentLight segment({ 0.0, 0.0, 1.0 }, { 0.0, 0.0, 2.0 });
  EXPECT_EQ(segment.FormFactor({ 0.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0 }), 0.0);
  EXPECT_FALSE(segment.Faces({ 0.0, 0.0, 0.0 }));
}

TEST(SunLight, SamplesLieWithinItsDiameter)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const double diameter = random.Between(0.1, 150.0);
    const penumbra::DirectionalLight sun(random.Direction(), diameter);
    for (const LightSample& sample : sun.TakeSamples(penumbra::GenerateSobol(16, seed, 1.0)))
    {
      EXPECT_TRUE(sample.IsDirection);
      const double cosine = glm::dot(glm::normalize(sample.Place), sun.GetSource());
      EXPECT_GE(cosine, std::cos(glm::radians(0.5 * diameter)) - Rounding);
    }
  }
}

TEST(HardLights, TakeOneSample)
{
  const auto pattern = penumbra::GenerateSobol(64, 0, 1.0);
  EXPECT_EQ(penumbra::PointLight({ 1.0, 2.0, 3.0 }).TakeSamples(pattern).size(), 1u);
  EXPECT_EQ(penumbra::DirectionalLight({ 1.0, 2.0, 3.0 }, 0.0).TakeSamples(pattern).size(), 1u);
}

TEST(InvalidLights, AreThoseWithoutExtentOrWithNaN)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 zero(0.0), up(0.0, 0.0, 1.0);
  EXPECT_FALSE(penumbra::DiskLight(zero, up, 0.0).IsValid());
  EXPECT_FALSE(penumbra::DiskLight(zero, zero, 1.0).IsValid());
  EXPECT_FALSE(penumbra::SegmentLight(up, up).IsValid());
  EXPECT_FALSE(penumbra::DirectionalLight(zero, 1.0).IsValid());
  EXPECT_FALSE(penumbra::SurfaceLight({}).IsValid());
  for (const double bad : { nan, infinity })
  {
    EXPECT_FALSE(penumbra::DiskLight({ bad, 0.0, 0.0 }, up, 1.0).IsValid());
    EXPECT_FALSE(penumbra::DiskLight(zero, up, bad).IsValid());
    EXPECT_FALSE(penumbra::SegmentLight(zero, { 0.0, bad, 0.0 }).IsValid());
    EXPECT_FALSE(penumbra::PointLight({ 0.0, 0.0, bad }).IsValid());
    EXPECT_FALSE(penumbra::DirectionalLight({ bad, 0.0, 0.0 }, 1.0).IsValid());
  }
}

// ---- Surfaces ----

namespace
{

// A row of quads of random widths and powers from 1e-6 to 1, dark ones among them.
penumbra::SurfaceLight RandomCells(unsigned seed, int count)
{
  RandomGeometry random(seed);
  std::vector<penumbra::PolygonLight> cells;
  double x = 0.0;
  for (int i = 0; i < count; ++i)
  {
    const double width = random.Between(0.1, 1.0);
    cells.push_back(penumbra::PolygonLight::Parallelogram(
      { x, 0.0, 1.0 }, { x, 1.0, 1.0 }, { x + width, 0.0, 1.0 }));
    const auto colour = RandomColour(random);
    const double strength = i % 5 == 4 ? 0.0 : std::pow(10.0, random.Between(-6.0, 0.0));
    cells.back().Radiance = strength * glm::dvec3(colour[0], colour[1], colour[2]);
    x += width;
  }
  return penumbra::SurfaceLight(cells);
}

double GetPower(const penumbra::PolygonLight& cell)
{
  return (cell.Radiance.x + cell.Radiance.y + cell.Radiance.z) / 3.0 * cell.GetArea();
}

} // namespace

// The means of the samples' powers sum to what is emitted, whatever the pattern, and each component
// does so in the mean over patterns.
TEST(SurfaceLight, SamplesHaveItsPower)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    const penumbra::SurfaceLight light = RandomCells(seed, 20);
    double emitted = 0.0;
    for (const penumbra::PolygonLight& cell : light.GetCells())
    {
      emitted += GetPower(cell);
    }
    for (const penumbra::SamplingPattern& pattern : penumbra::GetSamplingPatterns())
    {
      for (const int count : { 1, 7, 64 })
      {
        const std::vector<LightSample> samples = light.TakeSamples(pattern.Generate(count, seed));
        double sum = 0.0;
        for (const LightSample& sample : samples)
        {
          const double mean = (sample.Power.x + sample.Power.y + sample.Power.z) / 3.0;
          sum += mean / static_cast<double>(samples.size());
        }
        // A cell's share is a difference of sums of size 1, and the smallest is some 1e-7 of them.
        EXPECT_NEAR(sum, emitted, 1e-8 * emitted) << pattern.Name;
      }
    }
  }
}

// A cell is hit by the points whose first coordinate lies in its share of the power, and only by
// those; the sample lies on it and has its normal.
TEST(SurfaceLight, EveryCellWithPowerIsHit)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    const penumbra::SurfaceLight light = RandomCells(seed, 20);
    EXPECT_EQ(light.GetCells().size(), 16u); // dark cells are left out
    double whole = 0.0, before = 0.0;
    for (const penumbra::PolygonLight& cell : light.GetCells())
    {
      whole += GetPower(cell);
    }
    for (const penumbra::PolygonLight& cell : light.GetCells())
    {
      for (const double part : { 0.01, 0.5, 0.99 })
      {
        const double s = (before + part * GetPower(cell)) / whole;
        const LightSample sample = light.TakeSamples({ { s, 0.5 } }).front();
        const double low = cell.GetVertices().front().x;
        const double high = cell.GetVertices().back().x;
        EXPECT_GE(sample.Place.x, low);
        EXPECT_LE(sample.Place.x, high);
        EXPECT_EQ(sample.Normal, cell.GetNormal());
        // The hue is the cell's.
        EXPECT_LE(glm::length(glm::cross(sample.Power, cell.Radiance)),
          Rounding * glm::length(sample.Power) * glm::length(cell.Radiance));
      }
      before += GetPower(cell);
    }
  }
}

TEST(SurfaceLight, HasOneHueIfItsCellsDo)
{
  std::vector<penumbra::PolygonLight> cells = RandomCells(0, 3).GetCells();
  EXPECT_FALSE(penumbra::SurfaceLight(cells).HasOneHue());
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    cells[i].Radiance = glm::dvec3(0.0, 0.3, 0.7) * (1.0 + static_cast<double>(i));
  }
  EXPECT_TRUE(penumbra::SurfaceLight(cells).HasOneHue());
}

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

namespace
{

std::vector<glm::dvec3> MakeStar(int corners, int step, double radius, const glm::dvec3& centre)
{
  std::vector<glm::dvec3> vertices;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 2.0 * Pi * i * step / corners;
    const glm::dvec3 d(std::cos(angle), std::sin(angle), 0.5 * std::cos(angle));
    vertices.push_back(glm::dvec3(glm::vec3(centre + radius * d))); // floats, as most data are
  }
  return vertices;
}

} // namespace

TEST(IsPlanarAndConvex, AcceptsConvexPolygonsInSinglePrecision)
{
  for (const double radius : { 1e-3, 1.0, 1e3 })
  {
    for (int corners = 3; corners < 40; ++corners)
    {
      for (const double away : { 0.0, 100.0 })
      {
        EXPECT_TRUE(penumbra::IsPlanarAndConvex(
          MakeStar(corners, 1, radius, away * radius * glm::dvec3(1.0, -1.0, 0.3))))
          << corners << " corners, " << radius;
      }
    }
  }
  // Corners that repeat or lie on an edge.
  EXPECT_TRUE(penumbra::IsPlanarAndConvex(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 0, 1, 0 } }));
}

TEST(IsPlanarAndConvex, RefusesWhatIsNot)
{
  // A dart, a saddle, a bow tie, a pentagram.
  EXPECT_FALSE(
    penumbra::IsPlanarAndConvex({ { 0, 0, 0 }, { 2, 0, 0 }, { 0.5, 0.5, 0 }, { 0, 2, 0 } }));
  EXPECT_FALSE(
    penumbra::IsPlanarAndConvex({ { 0, 0, 0 }, { 1, 0, 0.1 }, { 1, 1, 0 }, { 0, 1, 0.1 } }));
  EXPECT_FALSE(
    penumbra::IsPlanarAndConvex({ { 0, 0, 0 }, { 2, 0, 0 }, { 0.5, 1, 0 }, { 1, -0.5, 0 } }));
  EXPECT_FALSE(penumbra::IsPlanarAndConvex(MakeStar(5, 2, 1.0, glm::dvec3(0.0))));
  EXPECT_FALSE(penumbra::IsPlanarAndConvex(MakeStar(7, 3, 1.0, glm::dvec3(0.0))));
  // A notch of a thousandth, far more than single precision rounds.
  EXPECT_FALSE(penumbra::IsPlanarAndConvex(
    { { 0, 0, 0 }, { 1, 0.001, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 0, 1, 0 } }));
}

// ---- Grids that follow a light's aspect ----

// On a light a times as long as wide, a grid of c columns and r rows has cells a / c by 1 / r.
// Where c is sqrt(n a) to the next whole number and r is rounded up, those are square up to the
// roundings.
TEST(AspectGrids, HaveCellsAboutSquare)
{
  for (const penumbra::SamplingPattern& pattern : penumbra::GetSamplingPatterns())
  {
    if (pattern.Name != "Uniform Grid")
    {
      continue;
    }
    for (const double aspect : { 0.1, 0.5, 1.0, 3.0, 10.0 })
    {
      for (const int count : { 64, 256, 1000 })
      {
        std::vector<double> xs, ys;
        const auto points = pattern.Generate(count, 0, aspect);
        for (const glm::dvec2& p : points)
        {
          xs.push_back(p.x);
          ys.push_back(p.y);
        }
        const auto countDistinct = [](std::vector<double>& v)
        {
          std::sort(v.begin(), v.end());
          return static_cast<double>(std::unique(v.begin(), v.end()) - v.begin());
        };
        const double columns = countDistinct(xs), rows = countDistinct(ys);
        EXPECT_EQ(columns * rows, static_cast<double>(points.size()));
        const double squareness = (aspect / columns) * rows;
        const double most = (1.0 + 0.5 / std::min(columns, rows)) * (1.0 + 1.0 / rows);
        EXPECT_LE(squareness, most * (1.0 + 0.5 / columns)) << aspect << ", " << count;
        EXPECT_GE(squareness, 1.0 / (most * (1.0 + 0.5 / columns))) << aspect << ", " << count;
      }
    }
  }
}

TEST(AspectGrids, FollowTheLight)
{
  const auto tube =
    penumbra::PolygonLight::Parallelogram({ 0.0, 0.0, 1.0 }, { 10.0, 0.0, 1.0 }, { 0.0, 1.0, 1.0 });
  EXPECT_NEAR(tube.GetAspect(), 10.0, Rounding);
  EXPECT_NEAR(
    tube.Transformed(glm::scale(glm::dmat4(1.0), { 0.1, 1.0, 1.0 })).GetAspect(), 1.0, Rounding);
}

// Each half of the points has one of every two neighbouring cells, so both are spread over all.
TEST(AspectGrids, HaveHalvesSpreadOverAll)
{
  for (const double aspect : { 0.1, 10.0, std::numeric_limits<double>::infinity() })
  {
    for (const penumbra::SamplingPattern& pattern : penumbra::GetSamplingPatterns())
    {
      if (pattern.Name == "Sobol" || pattern.Name == "Random")
      {
        continue; // which do not know of the aspect
      }
      const auto grid = penumbra::GenerateUniformGrid(64, 0, aspect);
      double columns = 0.0, rows = 0.0;
      for (const glm::dvec2& p : grid)
      {
        columns = std::max(columns, std::round(0.5 / (1.0 - p.x)));
        rows = std::max(rows, std::round(0.5 / (1.0 - p.y)));
      }
      const auto points = pattern.Generate(64, 3, aspect);
      ASSERT_EQ(points.size(), grid.size());
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        const auto column = static_cast<int>(points[i].x * columns);
        const auto row = static_cast<int>(points[i].y * rows);
        EXPECT_EQ((column + row) % 2 == 0, i < (points.size() + 1) / 2) << pattern.Name;
      }
    }
  }
}

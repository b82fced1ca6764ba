// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is particular to each kind of light: where its samples land, their moments, its power. What
// all kinds share is in TestLightShapes.

#include "DirectionalLight.h"
#include "DiskLight.h"
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
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using penumbra::LightSample;

constexpr int Lights = 1000;
constexpr double Pi = glm::pi<double>();

// Lengths and heights of coordinates of size 10 and less: some 100 roundings of 1.1e-16 times 10.
constexpr double Rounding = 1e-12;

} // namespace

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

// Along the axes: the area, the centre and the front.
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

namespace
{

// A disk and the ellipse that a map makes of it, which a plane has cut or not: up to a thousand
// times as long as wide.
struct RandomEllipse
{
  explicit RandomEllipse(RandomGeometry random)
    : Circle(random.InBox(0.5), random.Direction(), random.Between(0.1, 1.0))
  {
    for (int i = 0; i < 3; ++i)
    {
      this->Map[i] =
        glm::dvec4(std::pow(10.0, random.Between(-3.0, 0.0)) * random.Direction(), 0.0);
    }
    this->Map[3] = glm::dvec4(random.InBox(2.0), 1.0);
    this->Whole = this->Circle.Transformed(this->Map);
    this->Point = this->Whole.Sample({ random.Between(0.0, 1.0), random.Between(0.0, 1.0) });
    this->Horizon = random.Direction();
    this->Seen = this->Whole.ClippedToFront(this->Point, this->Horizon);
  }

  // The plane, taken back to the circle.
  penumbra::DiskLight CutCircle() const
  {
    const glm::dvec3 normal = glm::transpose(glm::dmat3(this->Map)) * this->Horizon;
    return this->Circle.ClippedToFront(this->TakeBack(this->Point), glm::normalize(normal));
  }
  glm::dvec3 TakeBack(const glm::dvec3& p) const
  {
    return glm::dvec3(glm::inverse(this->Map) * glm::dvec4(p, 1.0));
  }

  glm::dmat4 Map{ 1.0 };
  penumbra::DiskLight Circle;
  penumbra::DiskLight Whole{ glm::dvec3(0.0), glm::dvec3(0.0), 0.0 };
  penumbra::DiskLight Seen = this->Whole;
  glm::dvec3 Point{ 0.0 }, Horizon{ 0.0 }; // of the plane that cuts it
};

// What inverse maps that shrink lengths a thousandfold along two axes make of rounding.
constexpr double InverseRounding = 1e6 * Rounding;

} // namespace

// Taken back, all samples of an ellipse are the circle's (a mirror turns them round), and its rim
// is the circle's.
TEST(EllipseLight, IsTheMappedDisk)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomEllipse ellipse{ RandomGeometry(seed) };
    const penumbra::DiskLight& circle = ellipse.Circle;
    const double turns = glm::determinant(ellipse.Map) < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 first = circle.GetFirstAxis();
    for (const glm::dvec2& s : penumbra::GenerateSobol(16, seed, 1.0))
    {
      const glm::dvec3 place = ellipse.TakeBack(ellipse.Whole.Sample(s)) - circle.GetCentre();
      const glm::dvec3 wanted = circle.Sample(s) - circle.GetCentre();
      const glm::dvec3 across = glm::cross(circle.GetNormal(), first);
      EXPECT_NEAR(glm::dot(place, first), glm::dot(wanted, first), InverseRounding)
        << "seed " << seed;
      EXPECT_NEAR(glm::dot(place, across), turns * glm::dot(wanted, across), InverseRounding)
        << "seed " << seed;
    }
    for (const glm::dvec3& p : ellipse.Whole.GetRim(16))
    {
      const glm::dvec3 d = ellipse.TakeBack(p) - circle.GetCentre();
      EXPECT_NEAR(glm::length(d), circle.GetRadius(), InverseRounding) << "seed " << seed;
      EXPECT_NEAR(glm::dot(d, circle.GetNormal()), 0.0, InverseRounding) << "seed " << seed;
    }
  }
}

// The front goes with the surface; the semi-axes are those of the rim.
TEST(EllipseLight, HasTheMapsAxes)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomEllipse ellipse{ RandomGeometry(seed) };
    const glm::dmat3 toNormals = glm::transpose(glm::inverse(glm::dmat3(ellipse.Map)));
    const glm::dvec3 normal = glm::normalize(toNormals * ellipse.Circle.GetNormal());
    EXPECT_NEAR(glm::length(ellipse.Whole.GetNormal() - normal), 0.0, InverseRounding)
      << "seed " << seed;
    double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
    constexpr int count = 1000;
    for (const glm::dvec3& p : ellipse.Whole.GetRim(count))
    {
      const double d = glm::length(p - ellipse.Whole.GetCentre());
      longest = std::max(longest, d);
      shortest = std::min(shortest, d);
    }
    // Some place of the rim is half of 2 pi / count from the end of an axis, in the unit disk.
    const double off = Pi / count, radius = ellipse.Whole.GetRadius();
    EXPECT_LE(longest, radius + Rounding) << "seed " << seed;
    EXPECT_GE(longest, radius * std::cos(off)) << "seed " << seed;
    EXPECT_GE(shortest, radius * ellipse.Whole.GetRatio() - Rounding) << "seed " << seed;
    EXPECT_LE(shortest, radius * (ellipse.Whole.GetRatio() + off)) << "seed " << seed;
  }
}

// A plane leaves what it leaves of the circle, and the samples are there, in equal shares of it:
// all areas that the map stretches are stretched alike (as of disks, above).
TEST(EllipseLight, IsCutAsTheDisk)
{
  int cut = 0;
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomEllipse ellipse{ RandomGeometry(seed) };
    const penumbra::DiskLight circle = ellipse.CutCircle();
    const double stretch = ellipse.Whole.GetMeasure() / ellipse.Circle.GetMeasure();
    const double area = ellipse.Seen.GetMeasure();
    EXPECT_NEAR(area / stretch, circle.GetMeasure(), InverseRounding) << "seed " << seed;
    cut += circle.GetCutOffset() > -1.0;
    for (const glm::dvec2& s : penumbra::GenerateSobol(area > 0.0 ? 16 : 0, seed, 1.0))
    {
      const glm::dvec3 place = ellipse.Seen.Sample(s);
      EXPECT_LE(glm::length(ellipse.TakeBack(place) - circle.GetCentre()),
        circle.GetRadius() + InverseRounding)
        << "seed " << seed;
      EXPECT_GE(glm::dot(place - ellipse.Point, ellipse.Horizon), -Rounding) << "seed " << seed;
    }
    RandomGeometry random(seed + Lights);
    constexpr double h = 1e-5;
    const glm::dvec2 s(random.Between(0.1, 0.9), random.Between(0.1, 0.9));
    if (area > 0.0)
    {
      const glm::dvec3 x =
        ellipse.Seen.Sample({ s.x + h, s.y }) - ellipse.Seen.Sample({ s.x - h, s.y });
      const glm::dvec3 y =
        ellipse.Seen.Sample({ s.x, s.y + h }) - ellipse.Seen.Sample({ s.x, s.y - h });
      EXPECT_NEAR(
        glm::length(glm::cross(x, y)) / (4.0 * h * h) / stretch, circle.GetMeasure(), 1e-5)
        << "seed " << seed;
    }
  }
  EXPECT_GE(cut, Lights / 2);
}

// The convex hull of the points that a light names holds it: in the plane, taken back to the
// circle, no side of the octagon passes through the circle.
TEST(EllipseLight, LiesInItsHull)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    const RandomEllipse ellipse{ RandomGeometry(seed) };
    const glm::dvec3 centre = ellipse.Circle.GetCentre();
    const std::vector<glm::dvec3> hull = ellipse.Whole.GetHull().Points;
    for (std::size_t i = 0; i < hull.size(); ++i)
    {
      const glm::dvec3 a = ellipse.TakeBack(hull[i]) - centre;
      const glm::dvec3 b = ellipse.TakeBack(hull[(i + 1) % hull.size()]) - centre;
      EXPECT_GE(glm::length(glm::cross(a, b)) / glm::length(b - a),
        ellipse.Circle.GetRadius() - InverseRounding)
        << "seed " << seed;
    }
  }
}

// A similarity leaves a circle, though its matrix is rounded; a map that flattens leaves nothing.
TEST(EllipseLight, KnowsCirclesAndLines)
{
  for (unsigned seed = 0; seed < Lights; ++seed)
  {
    RandomGeometry random(seed);
    const penumbra::DiskLight disk(random.InBox(0.5), random.Direction(), random.Between(0.1, 1.0));
    glm::dmat4 similar(1.0);
    for (int i = 0; i < 5; ++i)
    {
      similar = glm::rotate(similar, random.Between(0.0, 2.0 * Pi), random.Direction());
      similar = glm::scale(similar, glm::dvec3(random.Between(0.5, 2.0)));
    }
    EXPECT_EQ(disk.Transformed(similar).GetRatio(), 1.0) << "seed " << seed;
    // Both radii of a disk across z, and with it the disk's two sides, on one line.
    glm::dmat4 toLine(1.0);
    toLine[0] = glm::dvec4(random.Direction(), 0.0);
    toLine[1] = random.Between(0.1, 2.0) * toLine[0];
    const penumbra::DiskLight level({ 1.0, 2.0, 3.0 }, { 0.0, 0.0, 1.0 }, 0.5);
    EXPECT_FALSE(level.Transformed(toLine).IsValid()) << "seed " << seed;
  }
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

namespace
{

/// Directions that a long wall hides from a place beside it: across the wall, up to an angle.
struct LongWall
{
  double Elevation;
  bool Hides(const glm::dvec3& d) const { return d.x > 0.0 && d.z < d.x * std::tan(Elevation); }
};

/// The cosine-weighted share of a sun that is seen past the wall, by midpoints of a million cells
/// of equal solid angle: an edge crosses some 2000 of them, which leaves less than 1e-4.
double IntegrateSeenShare(
  const glm::dvec3& axis, double diameter, const glm::dvec3& normal, const LongWall& wall)
{
  constexpr int Cells = 1000;
  const glm::dvec3 t = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.9, 0.2)));
  const glm::dvec3 b = glm::cross(axis, t);
  double seen = 0.0, all = 0.0;
  for (int i = 0; i < Cells; ++i)
  {
    const double level = (i + 0.5) / Cells * (1.0 - std::cos(glm::radians(0.5 * diameter)));
    const double sine = std::sqrt(level * (2.0 - level));
    for (int j = 0; j < Cells; ++j)
    {
      const double azimuth = 2.0 * Pi * (j + 0.5) / Cells;
      const glm::dvec3 d =
        (1.0 - level) * axis + sine * (std::cos(azimuth) * t + std::sin(azimuth) * b);
      const double weight = std::max(glm::dot(d, normal), 0.0);
      all += weight;
      seen += wall.Hides(d) ? 0.0 : weight;
    }
  }
  return seen / all;
}

/// The same by the light's own samples: the ratio estimator (Heitz, Hill and McGuire 2018).
double EstimateSeenShare(const penumbra::DirectionalLight& sun, const glm::dvec3& normal,
  const LongWall& wall, std::size_t count, unsigned seed)
{
  const penumbra::DirectionalLight seen = sun.ClippedToFront(glm::dvec3(0.0), normal);
  const bool isByArea = seen.GetEmission() == penumbra::Emission::Area;
  double shown = 0.0, all = 0.0;
  for (const LightSample& sample :
    seen.TakeSamples(penumbra::GenerateSobol(static_cast<int>(count), seed, 1.0)))
  {
    const glm::dvec3& d = sample.Place;
    const double r = glm::length(d);
    const double weight = std::max(glm::dot(d, normal), 0.0) / (r * r * r) *
      (isByArea ? std::abs(glm::dot(d, seen.GetAxis())) / r : 1.0);
    all += weight;
    shown += wall.Hides(d) ? 0.0 : weight;
  }
  return shown / all;
}

} // namespace

// A sky is as good as a sun: at every diameter, whether the horizon cuts it or not, 1024 samples
// miss the share beside a long wall by at most what they miss of any convex part of the unit square
// (some 9.4e-3: Rendering/README.md), times the largest weight over the mean one, 2.
TEST(SunLight, SamplesSeeAsMuchPastAWallAtEveryDiameter)
{
  constexpr double Bound = 2.0 * 9.4e-3;
  const glm::dvec3 up(0.0, 0.0, 1.0);
  unsigned seed = 0;
  for (const double diameter : { 0.53, 30.0, 59.0, 61.0, 90.0, 120.0, 150.0, 170.0, 179.0, 179.99 })
  {
    for (const glm::dvec3& axis : { up, glm::normalize(glm::dvec3(0.4, 0.2, 1.0)),
           glm::normalize(glm::dvec3(1.0, 0.3, 0.1)), glm::normalize(glm::dvec3(0.2, 1.0, -0.1)) })
    {
      const penumbra::DirectionalLight sun(-axis, diameter);
      if (!sun.ClippedToFront(glm::dvec3(0.0), up).IsValid())
      {
        continue; // below the horizon
      }
      const LongWall wall{ glm::radians(40.0) };
      const double right = IntegrateSeenShare(axis, diameter, up, wall);
      EXPECT_NEAR(EstimateSeenShare(sun, up, wall, 1024, ++seed), right, Bound)
        << "diameter " << diameter << ", axis " << axis.x << ", " << axis.y << ", " << axis.z;
    }
  }
}

// Beside a long wall, all but all of the sky is seen as (1 + cosine of the wall's elevation) / 2.
TEST(SunLight, SkyBesideALongWall)
{
  const glm::dvec3 up(0.0, 0.0, 1.0);
  for (const double elevation : { 10.0, 45.0, 70.0, 89.0 })
  {
    const LongWall wall{ glm::radians(elevation) };
    EXPECT_NEAR(EstimateSeenShare(penumbra::DirectionalLight(-up, 179.999), up, wall, 4096, 1),
      0.5 * (1.0 + std::cos(glm::radians(elevation))), 5e-3)
      << "elevation " << elevation;
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
    const double r = random.Between(0.1, 2.0), g = random.Between(0.1, 2.0);
    const glm::dvec3 colour(r, g, random.Between(0.1, 2.0));
    const double strength = i % 5 == 4 ? 0.0 : std::pow(10.0, random.Between(-6.0, 0.0));
    cells.back().Radiance = strength * colour;
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

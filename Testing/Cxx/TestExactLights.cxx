// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Proves the oracle's other lights by means that are not its own: textbook values, quadrature that
// casts rays, polygons that enclose a disk, the limits in which one light becomes another, and
// identities that any exact answer obeys.

#include "ExactLights.h"
#include "OracleTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace
{

using oracle::AnyLight;
using oracle::Cross;
using oracle::Directional;
using oracle::Disk;
using oracle::Dot;
using oracle::Length;
using oracle::Light;
using oracle::Parallelogram;
using oracle::Point;
using oracle::Polygon;
using oracle::Segment;
using oracle::Triangle;
using oracle::Vec3;
using oracle::VisibleFormFactor;

using namespace oracletest;

constexpr long double Degree = 0.017453292519943295769L;

Vec3 Unit(const Vec3& a)
{
  return (1 / Length(a)) * a;
}

// Two unit vectors at right angles to a third.
std::array<Vec3, 2> Frame(const Vec3& w)
{
  const Vec3 u = Unit(Cross(w, std::abs(w.X) < 0.5L ? Vec3{ 1, 0, 0 } : Vec3{ 0, 1, 0 }));
  return { u, Cross(w, u) };
}

// One of each kind with occluders that reach through the receiver's plane and through the lights.
// The normal leans so far that the horizon cuts many of the lights.
struct Scene
{
  explicit Scene(unsigned seed)
  {
    Random random(seed);
    this->X = random.InBox(Origin, 0.3);
    this->N = random.InBox(Up, 1.0);
    this->Round.Centre = random.InBox({ 0, 0, 1 }, 0.3);
    this->Round.Radius = random.Between(0.1, 0.6);
    this->Round.Normal = random.InBox(-1 * Up, 1.0);
    this->Round.TwoSided = seed % 2 == 0;
    this->Line = { random.InBox({ -0.5, 0, 1 }, 0.4), random.InBox({ 0.5, 0, 1 }, 0.4) };
    this->Sun.Direction = random.InBox(-1 * Up, 0.9);
    this->Sun.AngularDiameter = static_cast<double>(random.Between(0.5, 40));
    this->Spot.Position = random.InBox({ 0, 0, 1 }, 0.5);
    this->Blockers = RandomTriangles(random, 1 + static_cast<int>(seed % 12));
  }

  Vec3 X, N;
  Disk Round;
  Segment Line;
  Directional Sun;
  Point Spot;
  Occluders Blockers;

  template <typename Emitter>
  long double Exact(const Emitter& light, const Occluders& occluders) const
  {
    return VisibleFormFactor(this->X, this->N, light, occluders);
  }

  // The cosine at the receiver, clamped, or 0 if the way is blocked.
  long double SeenCosine(const Vec3& y) const
  {
    const Vec3 r = y - this->X;
    const long double cosine = Dot(Unit(this->N), Unit(r));
    return cosine > 0 && !Blocks(this->Blockers, this->X, y) ? cosine : 0;
  }
};

using Integrand = std::function<long double(long double, long double)>;

// Each integrand of a form factor times the Jacobian of its map from the unit square.

Integrand DiskIntegrand(const Scene& scene)
{
  return [&scene](long double s, long double t)
  {
    const Disk& disk = scene.Round;
    const Vec3 w = Unit(disk.Normal);
    const auto [u, v] = Frame(w);
    const long double r = disk.Radius * std::sqrt(s);
    const Vec3 y = disk.Centre + r * (std::cos(2 * Pi * t) * u + std::sin(2 * Pi * t) * v);
    const Vec3 d = scene.X - y;
    const long double facing = Dot(Unit(d), w);
    if (facing < 0 && !disk.TwoSided)
    {
      return 0.0L;
    }
    return disk.Radius * disk.Radius * scene.SeenCosine(y) * std::abs(facing) / Dot(d, d);
  };
}

// By Archimedes, heights on the sphere are as the areas below them.
Integrand SunIntegrand(const Scene& scene)
{
  return [&scene](long double s, long double t)
  {
    constexpr long double beyondAll = 1000;
    const Vec3 w = -1 * Unit(scene.Sun.Direction);
    const auto [u, v] = Frame(w);
    const long double radius = scene.Sun.AngularDiameter / 2 * Degree;
    const long double height = 1 - s * (1 - std::cos(radius));
    const long double r = std::sqrt(1 - height * height);
    const Vec3 to = height * w + r * (std::cos(2 * Pi * t) * u + std::sin(2 * Pi * t) * v);
    const long double solidAngle = 2 * Pi * (1 - std::cos(radius));
    const long double normalIncidence = Pi * std::sin(radius) * std::sin(radius);
    return solidAngle * scene.SeenCosine(scene.X + beyondAll * to) / (Pi * normalIncidence);
  };
}

// The integrand along the segment, which jumps where the segment is hidden or sets.
long double AlongSegment(const Scene& scene, long double s)
{
  const Vec3 along = scene.Line.B - scene.Line.A;
  const Vec3 y = scene.Line.A + s * along;
  const Vec3 d = scene.X - y;
  return scene.SeenCosine(y) * Length(Cross(along, Unit(d))) / Dot(d, d) / Pi;
}

// Gauss-Legendre quadrature with five nodes, halving where some nodes and ends are lit and others
// are not, down to where a jump is worth nothing.
long double Adaptive(const Scene& scene, long double low, long double high)
{
  constexpr long double finest = 1e-15L;
  constexpr std::array<long double, 7> nodes = { -1, -0.906179845938663992798L,
    -0.538469310105683091036L, 0, 0.538469310105683091036L, 0.906179845938663992798L, 1 };
  constexpr std::array<long double, 7> weights = { 0, 0.236926885056189087514L,
    0.478628670499366468041L, 0.568888888888888888889L, 0.478628670499366468041L,
    0.236926885056189087514L, 0 };
  long double sum = 0;
  int lit = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const long double f = AlongSegment(scene, (low + high) / 2 + nodes[i] * (high - low) / 2);
    sum += weights[i] * f;
    lit += f > 0;
  }
  if (lit == 0 || lit == 7 || high - low < finest)
  {
    return sum * (high - low) / 2;
  }
  const long double middle = (low + high) / 2;
  return Adaptive(scene, low, middle) + Adaptive(scene, middle, high);
}

// The tolerance is 5 standard errors, as in TestExactRadiance.cxx, and so is the mean square.
template <typename Emitter>
void CompareWithQuadrature(Emitter Scene::*light, Integrand (*integrand)(const Scene&))
{
  constexpr int scenes = 120;
  constexpr int cellsPerSide = 100;
  Random random(5);
  Largest largest("LargestDeviation"), largestError("LargestStandardError");
  long double sumOfSquares = 0;
  int compared = 0, partlyHidden = 0;
  for (unsigned seed = 0; seed < scenes; ++seed)
  {
    const Scene scene(seed);
    const Estimate estimate = Quadrature(integrand(scene), cellsPerSide, random);
    const long double exact = scene.Exact(scene.*light, scene.Blockers);
    const long double whole = scene.Exact(scene.*light, {});
    const long double deviation = largest.Add(exact - estimate.Mean);
    largestError.Add(estimate.StandardError);
    EXPECT_LE(deviation, 5 * estimate.StandardError + Rounding) << "scene " << seed;
    partlyHidden += exact > 0.01L * whole && exact < 0.99L * whole;
    if (estimate.StandardError > 0)
    {
      sumOfSquares += std::pow(deviation / estimate.StandardError, 2.0L);
      ++compared;
    }
  }
  EXPECT_GE(partlyHidden, scenes / 4);
  EXPECT_GT(compared, scenes / 2);
  EXPECT_LT(sumOfSquares / compared, 1 + 5 * std::sqrt(2.0L / compared));
}

} // namespace

// ---- Textbook values ----

// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-12 and B-13: an element at
// distance a from the axis of a disk, parallel to it at distance h, or at right angles to it, below
// the disk's plane by h and facing the axis from outside. On the axis the former is
// R^2 / (R^2 + h^2).
TEST(ExactLights, DiskAboveElement)
{
  Random random(1);
  Largest largest("LargestDeviation");
  for (int i = 0; i < 200; ++i)
  {
    const long double a = i % 4 == 0 ? 0 : random.Between(0, 3);
    const long double h = random.Between(0.1, 3), r = random.Between(0.1, 3);
    const long double z = a * a + h * h + r * r;
    const long double root = std::sqrt(z * z - 4 * a * a * r * r);
    const Disk disk = { { a, 0, h }, r, -7 * Up };
    const long double parallel = (1 - (a * a + h * h - r * r) / root) / 2;
    EXPECT_LE(largest.Add(VisibleFormFactor(Origin, Up, disk, {}) - parallel), Rounding);
    if (a > r)
    {
      const long double perpendicular = h / (2 * a) * (z / root - 1);
      EXPECT_LE(
        largest.Add(VisibleFormFactor(Origin, { 1, 0, 0 }, disk, {}) - perpendicular), Rounding);
    }
  }
}

// A sun that is wholly up gives the cosine of its centre, however large it is.
TEST(ExactLights, WholeSunGivesCosine)
{
  Random random(2);
  Largest largest("LargestRelativeDeviation");
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 to = Unit(random.InBox(Up, 0.9));
    const long double elevation = std::asin(to.Z) / Degree;
    Directional sun;
    sun.Direction = -3 * to;
    sun.AngularDiameter = static_cast<double>(random.Between(0, 2) * elevation);
    const long double f = VisibleFormFactor(Origin, Up, sun, {});
    // A sun d across loses 2 / d, and none is below 0.01 here.
    EXPECT_LE(largest.Add(f * Pi / to.Z - 1), 1000 * Rounding);
    sun.AngularDiameter = 0;
    EXPECT_LE(std::abs(VisibleFormFactor(Origin, Up, sun, {}) * Pi / to.Z - 1), Rounding);
  }
}

// Howell's B-42: a sphere of half angle s, its centre at angle w from an element's normal, cut by
// the element's plane.
TEST(ExactLights, HorizonCutsSun)
{
  Random random(3);
  Largest largest("LargestDeviation");
  for (int i = 0; i < 200; ++i)
  {
    Directional sun;
    sun.AngularDiameter = static_cast<double>(random.Between(1, 120));
    const long double s = sun.AngularDiameter / 2 * Degree;
    const long double w = Pi / 2 + s * random.Between(-0.99, 0.99);
    sun.Direction = { -std::sin(w), 0, -std::cos(w) };
    const long double x = 1 / std::tan(s), sine = std::sin(s);
    const long double y = -x / std::tan(w);
    const long double root = std::sin(w) * std::sqrt(1 - y * y);
    const long double sphere =
      sine * sine * (std::cos(w) * std::acos(y) - x * root) / Pi + std::atan(root / x) / Pi;
    const long double f = VisibleFormFactor(Origin, Up, sun, {});
    EXPECT_LE(largest.Add(f * Pi * sine * sine - sphere), Rounding);
  }
}

// A tube over an element: from its foot up to the angle p it gives (p + sin p cos p) / (2 h), and
// pi / (2 h) if it is endless both ways.
TEST(ExactLights, SegmentAboveElement)
{
  Random random(4);
  Largest largest("LargestRelativeDeviation");
  for (int i = 0; i < 100; ++i)
  {
    const long double h = random.Between(0.1, 3), p = random.Between(0.01, 1.5);
    const Segment tube = { { 0, 0, h }, { h * std::tan(p), 0, h } };
    const long double expected = (p + std::sin(p) * std::cos(p)) / (2 * Pi * h);
    EXPECT_LE(largest.Add(VisibleFormFactor(Origin, Up, tube, {}) / expected - 1), Rounding);
    const Segment endless = { { -1e9L * h, 0, h }, { 1e9L * h, 0, h } };
    EXPECT_LE(largest.Add(VisibleFormFactor(Origin, Up, endless, {}) * 2 * h - 1), Rounding);
  }
  // On the tube's own line nothing arrives.
  EXPECT_EQ(VisibleFormFactor(Origin, Up, Segment{ Up, 2 * Up }, {}), 0);
}

TEST(ExactLights, PointFollowsInverseSquare)
{
  EXPECT_LE(
    std::abs(VisibleFormFactor(Origin, Up, Point{ { 3, 0, 4 } }, {}) - 4 / (125 * Pi)), Rounding);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, Point{ { 3, 0, -4 } }, {}), 0);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, Point{ { 3, 0, 0 } }, {}), 0);
}

TEST(ExactLights, SidesOfDisk)
{
  Disk disk = { Up, 0.5L, -1 * Up };
  const Vec3 above = { 0, 0, 2 }, down = { 0, 0, -3 };
  EXPECT_GT(VisibleFormFactor(Origin, Up, disk, {}), 0);
  EXPECT_EQ(VisibleFormFactor(above, down, disk, {}), 0);
  EXPECT_EQ(VisibleFormFactor(Origin, down, disk, {}), 0);
  disk.TwoSided = true;
  EXPECT_LE(std::abs(VisibleFormFactor(above, down, disk, {}) - 0.2L), Rounding);
  EXPECT_EQ(VisibleFormFactor({ 0.1L, 0, 1 }, Up, disk, {}), 0);
}

// ---- Other means: rays, and polygons ----

TEST(ExactLights, DiskAgreesWithQuadrature)
{
  CompareWithQuadrature(&Scene::Round, DiskIntegrand);
}

TEST(ExactLights, SunAgreesWithQuadrature)
{
  CompareWithQuadrature(&Scene::Sun, SunIntegrand);
}

// Only a part narrower than a seventh of a piece, here 3e-4, could slip through.
TEST(ExactLights, SegmentAgreesWithQuadrature)
{
  constexpr int scenes = 300;
  constexpr int pieces = 500;
  Largest largest("LargestDeviation");
  int partlyHidden = 0;
  for (unsigned seed = 0; seed < scenes; ++seed)
  {
    const Scene scene(seed);
    long double sum = 0;
    for (int i = 0; i < pieces; ++i)
    {
      sum += Adaptive(scene, i / (1.0L * pieces), (i + 1) / (1.0L * pieces));
    }
    const long double exact = scene.Exact(scene.Line, scene.Blockers);
    const long double whole = scene.Exact(scene.Line, {});
    // Each of up to 26 jumps is off by 1e-15 of the whole, and the rule by (1 / pieces)^10.
    EXPECT_LE(largest.Add(exact - sum), 100 * Rounding) << "scene " << seed;
    partlyHidden += exact > 0.01L * whole && exact < 0.99L * whole;
  }
  EXPECT_GE(partlyHidden, scenes / 4);
}

TEST(ExactLights, PointAgreesWithRays)
{
  int hidden = 0, seen = 0;
  for (unsigned seed = 0; seed < 2000; ++seed)
  {
    const Scene scene(seed);
    const bool isBlocked = Blocks(scene.Blockers, scene.X, scene.Spot.Position);
    const long double whole = scene.Exact(scene.Spot, {});
    EXPECT_EQ(scene.Exact(scene.Spot, scene.Blockers), isBlocked ? 0 : whole) << "scene " << seed;
    (isBlocked ? hidden : seen) += whole > 0;
    Directional star = scene.Sun;
    star.AngularDiameter = 0;
    const Vec3 distant = scene.X - 1000 * star.Direction;
    EXPECT_EQ(scene.Exact(star, scene.Blockers),
      Blocks(scene.Blockers, scene.X, distant) ? 0 : scene.Exact(star, {}))
      << "scene " << seed;
  }
  EXPECT_GT(hidden, 200);
  EXPECT_GT(seen, 200);
}

// Whatever hides and cuts them, polygons inside and around the disk give less and more than it. The
// two differ by (pi / sides)^2 of its area, and so they close in on it.
TEST(ExactLights, PolygonsEncloseDisk)
{
  Largest largest("LargestGap");
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    const Scene scene(seed);
    const auto [u, v] = Frame(Unit(scene.Round.Normal));
    const auto polygon = [&, &u = u, &v = v](long double radius, int sides)
    {
      Light light;
      light.TwoSided = scene.Round.TwoSided;
      for (int i = 0; i < sides; ++i)
      {
        const long double t = 2 * Pi * i / sides;
        light.Vertices.push_back(scene.Round.Centre + radius * (std::cos(t) * u + std::sin(t) * v));
      }
      return scene.Exact(light, scene.Blockers);
    };
    const long double disk = scene.Exact(scene.Round, scene.Blockers);
    for (const int sides : { 50, 500 })
    {
      const long double inside = polygon(scene.Round.Radius, sides);
      const long double around = polygon(scene.Round.Radius / std::cos(Pi / sides), sides);
      EXPECT_LE(inside, disk + Rounding) << "scene " << seed;
      EXPECT_GE(around, disk - Rounding) << "scene " << seed;
      if (sides == 500)
      {
        largest.Add(around - inside);
      }
    }
  }
}

// A plate inside the cone of a light takes from it what the plate would emit in its stead.
TEST(ExactLights, PlateTakesItsOwnFormFactor)
{
  const Disk disk = { Up, 1, -1 * Up };
  const long double plate = oracle::FormFactor(Origin, Up, Ceiling(0.3L, 0.5L));
  EXPECT_LE(
    std::abs(VisibleFormFactor(Origin, Up, disk, Plate(0.3L, 0.5L)) - (0.5L - plate)), Rounding);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, disk, Plate(0.6L, 0.5L)), 0);
  // The sun behind the same cone, and a plate that is as far as it is large.
  Directional sun;
  sun.Direction = -1 * Up;
  sun.AngularDiameter = 90;
  for (const long double scale : { 1e-3L, 1.0L, 1e9L })
  {
    const Occluders blockers = Plate(0.3L * scale, 0.5L * scale);
    const long double f = VisibleFormFactor(Origin, Up, sun, blockers);
    EXPECT_LE(std::abs(f * Pi / 2 - (0.5L - plate)), Rounding);
  }
}

// ---- One light as the limit of another ----

// A disk that spans the sun's cone, beyond all occluders, is the sun.
TEST(ExactLights, SunIsDiskBeyondAll)
{
  constexpr long double distance = 1000;
  Largest largest("LargestRelativeDeviation");
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const Scene scene(seed);
    const long double radius = scene.Sun.AngularDiameter / 2 * Degree;
    const Vec3 way = Unit(scene.Sun.Direction);
    const Disk disk = { scene.X - distance * way, distance * std::tan(radius), way };
    const long double expected =
      scene.Exact(disk, scene.Blockers) / (Pi * std::sin(radius) * std::sin(radius));
    // Suns of half a degree lose a factor of 1e2 or so.
    EXPECT_LE(largest.Add(scene.Exact(scene.Sun, scene.Blockers) - expected), 100 * Rounding);
  }
}

// A disk of radius r acts as a point of its area: r^2 / d^2 is the next order.
TEST(ExactLights, TinyDiskIsPoint)
{
  constexpr long double radius = 1e-5L;
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    Scene scene(seed);
    scene.Round.Radius = radius;
    const Vec3 d = scene.X - scene.Round.Centre;
    const long double facing = Dot(Unit(d), Unit(scene.Round.Normal));
    const long double up = -Dot(Unit(d), Unit(scene.N));
    const long double whole = scene.Exact(scene.Round, {});
    const long double disk = scene.Exact(scene.Round, scene.Blockers);
    if (facing < 0.1L || up < 0.1L || (disk > 0 && disk < whole))
    {
      continue;
    }
    const Point point = { scene.Round.Centre };
    const long double expected = scene.Exact(point, scene.Blockers) * Pi * radius * radius * facing;
    EXPECT_LE(std::abs(disk - expected), 10 * radius * radius / Dot(d, d) * whole);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

// A polygon of area A that faces the point from the distance D gives A / D^2 at normal incidence;
// its edges are off by its width over D.
TEST(ExactLights, FarPolygonIsDirectional)
{
  constexpr long double distance = 1e6L;
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    Scene scene(seed);
    scene.Sun.AngularDiameter = 0;
    const Vec3 way = Unit(scene.Sun.Direction);
    const auto [u, v] = Frame(way);
    const Vec3 corner = scene.X - distance * way - 0.5L * u - 0.5L * v;
    Light light;
    light.Vertices = Parallelogram(corner, corner + u, corner + v);
    const long double whole = scene.Exact(light, {});
    const long double polygon = scene.Exact(light, scene.Blockers);
    if (-Dot(way, Unit(scene.N)) < 0.01L || (polygon > 0 && polygon < whole))
    {
      continue;
    }
    const long double expected = scene.Exact(scene.Sun, scene.Blockers) / (distance * distance);
    EXPECT_LE(std::abs(polygon - expected), 100 / distance * whole);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(ExactLights, SmallSunIsPointAtInfinity)
{
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    Scene scene(seed);
    scene.Sun.AngularDiameter = 1e-4;
    const long double whole = scene.Exact(scene.Sun, {});
    const long double small = scene.Exact(scene.Sun, scene.Blockers);
    scene.Sun.AngularDiameter = 0;
    const long double star = scene.Exact(scene.Sun, scene.Blockers);
    if (Dot(scene.Sun.Direction, scene.N) < -0.01L && (small == 0 || small == whole))
    {
      // The small sun is 2e-6 across, and loses as much.
      EXPECT_LE(std::abs(small - star), 1e6L * Rounding);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

// A prism of many sides around the segment, without ends: its radiance is the segment's over its
// width, which is 2 r less up to (pi / sides)^2 / 2 of it, 1e-4. Its near side is nearer by r,
// which shifts its ends: that is an error of order r, which halves with r.
TEST(ExactLights, ThinCylinderIsSegment)
{
  constexpr int sides = 256;
  Random random(8);
  Largest largest("LargestRelativeDeviation");
  for (int i = 0; i < 20; ++i)
  {
    const Segment tube = { random.InBox({ -1, 0, 1.5 }, 0.3), random.InBox({ 1, 0, 1.5 }, 0.3) };
    const Vec3 x = random.InBox(Origin, 0.3);
    const auto [u, v] = Frame(Unit(tube.B - tube.A));
    const auto cylinder = [&, &u = u, &v = v](long double r)
    {
      long double sum = 0;
      for (int side = 0; side < sides; ++side)
      {
        const auto at = [&](int k)
        {
          const long double t = 2 * Pi * k / sides;
          return r * (std::cos(t) * u + std::sin(t) * v);
        };
        Light light;
        light.Vertices = Parallelogram(tube.A + at(side), tube.A + at(side + 1), tube.B + at(side));
        sum += VisibleFormFactor(x, Up, light, {}) / (2 * r);
      }
      return sum;
    };
    const long double segment = VisibleFormFactor(x, Up, tube, {});
    const long double coarse = cylinder(1e-2L), fine = cylinder(5e-3L);
    // The order r cancels; left are (r / distance)^2, 1e-4 at 1, and the sides. Twice that.
    EXPECT_LE(largest.Add((2 * fine - coarse) / segment - 1), 4e-4L);
  }
}

// ---- Identities ----

// Two plates that meet along a line, each alone, leave the two parts of what is seen without them.
TEST(ExactLights, PartsOfViewSumToWhole)
{
  constexpr long double wide = 1e4L;
  Random random(9);
  Largest largest("LargestRelativeDeviation");
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    Scene scene(seed);
    scene.X.Z = 0;
    scene.N = random.InBox(Up, 0.5);
    scene.Sun.Direction = random.InBox(-1 * Up, 0.5);
    const long double cut = random.Between(-0.3, 0.3);
    const auto half = [&](long double end)
    {
      const Vec3 a = { cut, -wide, 0.05L }, b = { cut, wide, 0.05L };
      const Vec3 c = { end, -wide, 0.05L }, d = { end, wide, 0.05L };
      Occluders all = scene.Blockers;
      all.insert(all.end(), { { a, b, c }, { b, c, d } });
      return all;
    };
    const Occluders left = half(-wide), right = half(wide);
    const auto expectSum = [&](const auto& light)
    {
      const long double parts = scene.Exact(light, left) + scene.Exact(light, right);
      const long double whole = scene.Exact(light, {});
      if (whole > 0)
      {
        const long double deviation = parts - scene.Exact(light, scene.Blockers);
        // Small suns lose a factor of 1e2 or so.
        EXPECT_LE(largest.Add(deviation / whole), 100 * Rounding) << "scene " << seed;
      }
    };
    expectSum(scene.Round);
    expectSum(scene.Line);
    expectSum(scene.Sun);
  }
}

// Splitting occluders, drawing them twice, turning them round and shuffling them all change
// nothing.
TEST(ExactLights, OccludersAreASetOfPoints)
{
  Random random(7);
  Largest largest("LargestRelativeDeviation");
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const Scene scene(seed);
    Occluders same;
    for (const Triangle& t : scene.Blockers)
    {
      const Vec3 cut = t.A + random.Between(0.1, 0.9) * (t.B - t.A);
      same.insert(same.end(), { { t.A, cut, t.C }, { cut, t.C, t.B }, { t.B, t.A, t.C } });
    }
    std::shuffle(same.begin(), same.end(), random.Engine);
    const auto expectSame = [&](const auto& light)
    {
      const long double deviation = scene.Exact(light, same) - scene.Exact(light, scene.Blockers);
      const long double whole = scene.Exact(light, {});
      if (whole > 0)
      {
        EXPECT_LE(largest.Add(deviation / whole), 100 * Rounding) << "scene " << seed;
      }
    };
    expectSame(scene.Round);
    expectSame(scene.Line);
    expectSame(scene.Sun);
    expectSame(scene.Spot);
  }
}

TEST(ExactLights, WhatIsNotBetweenBlocksNothing)
{
  const Disk disk = { Up, 0.5L, -1 * Up };
  const Segment tube = { { -1, 0, 1 }, { 1, 0, 1 } };
  const Point point = { Up };
  for (const long double height : { 1.5L, 1.0L, 1 - 1e-16L, 1e-16L, 0.0L, -0.5L })
  {
    const Occluders plate = Plate(5, height);
    EXPECT_EQ(VisibleFormFactor(Origin, Up, disk, plate), VisibleFormFactor(Origin, Up, disk, {}));
    EXPECT_EQ(VisibleFormFactor(Origin, Up, tube, plate), VisibleFormFactor(Origin, Up, tube, {}));
    EXPECT_EQ(
      VisibleFormFactor(Origin, Up, point, plate), VisibleFormFactor(Origin, Up, point, {}));
  }
}

// A ray through the diagonal of a plate is blocked: meshes have no cracks.
TEST(ExactLights, MeshesHaveNoCracks)
{
  const Occluders plate = Plate(0.3L, 0.5L);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, Point{ Up }, plate), 0);
  EXPECT_EQ(VisibleFormFactor(Origin, Up, Directional{ -1 * Up }, plate), 0);
}

// ---- Radiance ----

// H&H 1997, eq. 1, channel by channel: one light of each kind, each with a colour of its own.
TEST(ExactLights, RadianceSumsAllKinds)
{
  const std::array<double, 3> colour = { 1.0, 2.0, 4.0 };
  const Disk disk = { Up, 0.5L, -1 * Up, false, colour };
  const Segment tube = { { -1, 0, 1 }, { 1, 0, 1 }, colour };
  const Point point = { { 0, 1, 2 }, colour };
  const Directional sun = { { 0, 0.5L, -1 }, 0.53, colour };
  Light first = Ceiling(0.5L, 2), second = Ceiling(0.5L, 3);
  first.Radiance = { 1.0, 0.0, 0.0 };
  second.Radiance = { 0.0, 0.0, 1.0 };
  oracle::Scene scene;
  scene.Occluders = Plate(0.1L, 0.5L);
  scene.Reflectance = { 0.5, 0.25, 1.0 };
  scene.Ambient = { 0.125, 0.0, 0.5 };
  scene.Lights = { disk, tube, point, sun, oracle::Surface{ { first, second } }, first };
  const auto f = [&](const auto& light)
  { return VisibleFormFactor(Origin, Up, light, scene.Occluders); };
  const long double sum = f(disk) + f(tube) + f(point) + f(sun);
  const std::array<double, 3> radiance = oracle::Radiance(Origin, Up, scene);
  EXPECT_DOUBLE_EQ(radiance[0], static_cast<double>(0.5L * (0.125L + sum + 2 * f(first))));
  EXPECT_DOUBLE_EQ(radiance[1], static_cast<double>(0.25L * 2 * sum));
  EXPECT_DOUBLE_EQ(radiance[2], static_cast<double>(0.5L + 4 * sum + f(second)));
  // Polygons are what they always were.
  scene.Lights = { first };
  EXPECT_EQ(oracle::Radiance(Origin, Up, scene),
    oracle::Radiance(Origin, Up, { first }, scene.Occluders, scene.Reflectance, scene.Ambient));
}

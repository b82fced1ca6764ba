// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "RandomScenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <variant>
#include <vector>

namespace oracle
{

namespace
{

const long double Pi = std::acos(-1.0L);
const Vec3 Up = { 0, 0, 1 };

// The engine's numbers are laid down by the standard; those of its distributions are not.
class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {
  }

  double Between(double low, double high)
  {
    // 53 random bits are a double in [0, 1).
    const double unit = std::ldexp(static_cast<double>(this->Engine() >> 11), -53);
    return low + unit * (high - low);
  }

  // Alike on a logarithmic scale.
  double Scale(double low, double high)
  {
    return std::exp(this->Between(std::log(low), std::log(high)));
  }

  // A whole number below count.
  int Below(int count) { return static_cast<int>(this->Between(0, count)); }

  bool OneIn(int count) { return this->Below(count) == 0; }

  Vec3 InCube(double halfWidth)
  {
    const double x = this->Between(-halfWidth, halfWidth);
    const double y = this->Between(-halfWidth, halfWidth);
    return { x, y, this->Between(-halfWidth, halfWidth) };
  }

  std::array<double, 3> Colour(double low, double high)
  {
    const double r = this->Between(low, high), g = this->Between(low, high);
    return { r, g, this->Between(low, high) };
  }

private:
  std::mt19937_64 Engine;
};

Vec3 Unit(const Vec3& a)
{
  return (1 / Length(a)) * a;
}

Vec3 ToFloat(const Vec3& v)
{
  return { static_cast<float>(v.X), static_cast<float>(v.Y), static_cast<float>(v.Z) };
}

Vec3 ToDouble(const Vec3& v)
{
  return { static_cast<double>(v.X), static_cast<double>(v.Y), static_cast<double>(v.Z) };
}

// Three unit vectors at right angles.
struct Frame
{
  Vec3 U, V, W;
};

// A frame with the given third axis, turned around it at random.
Frame FrameAround(const Vec3& w, Random& random)
{
  const Vec3 u = Unit(Cross(w, random.InCube(1)));
  return { u, Cross(w, u), w };
}

// ---- Lights ----

// Where a light is and how it lies: it looks along W.
struct Place
{
  Vec3 Centre;
  Frame Axes;

  Vec3 At(long double u, long double v) const
  {
    return ToDouble(this->Centre + u * this->Axes.U + v * this->Axes.V);
  }
};

// Mostly a storey above the receiver, one in five near it; one in five much tilted.
Place RandomPlace(const RandomScene& scene, Random& random)
{
  const double height = random.OneIn(5) ? random.Between(0.5, 1) : random.Between(1, 3);
  const double tilt = random.OneIn(5) ? 1.0 : 0.3;
  const double u = random.Between(-0.1, 1.1);
  const Vec3 foot = scene.At(u, random.Between(-0.1, 1.1));
  const Vec3 down = Unit(random.InCube(tilt) - Up);
  return { ToDouble(foot + height * Up), FrameAround(down, random) };
}

// The radiance of a light whose area is about size^2, so that lights of all sizes count alike.
std::array<double, 3> RandomRadiance(double size, Random& random)
{
  const double strength = 1 / (size * size);
  return random.Colour(0.5 * strength, 5 * strength);
}

// From squares to 10 : 1 tubes, with some skew; or half of one.
AnyLight RandomParallelogram(const Place& place, bool isTriangle, Random& random)
{
  const double width = random.Scale(0.3, 1.5);
  const double height = width * random.Scale(0.1, 1);
  const double skew = random.Between(-0.3, 0.3);
  const Vec3 corner = place.At(-width / 2, -height / 2);
  const Vec3 point1 = place.At(width / 2, -height / 2);
  const Vec3 point2 = place.At(-width / 2 + skew * height, height / 2);
  Light light;
  light.Vertices =
    isTriangle ? Polygon{ corner, point1, point2 } : Parallelogram(corner, point1, point2);
  light.TwoSided = random.OneIn(2);
  light.Radiance = RandomRadiance(std::sqrt(width * height), random);
  return light;
}

// An ellipse of five to eight corners.
AnyLight RandomPolygon(const Place& place, Random& random)
{
  const int corners = 5 + random.Below(4);
  const double width = random.Scale(0.15, 0.7);
  const double height = width * random.Scale(0.3, 1);
  Light light;
  for (int i = 0; i < corners; ++i)
  {
    const long double angle = 2 * Pi * i / corners;
    light.Vertices.push_back(place.At(width * std::cos(angle), height * std::sin(angle)));
  }
  light.TwoSided = random.OneIn(2);
  light.Radiance = RandomRadiance(2 * std::sqrt(width * height), random);
  return light;
}

AnyLight RandomDisk(const Place& place, Random& random)
{
  Disk disk;
  disk.Centre = place.Centre;
  disk.Radius = random.Scale(0.15, 0.7);
  disk.Normal = ToDouble(place.Axes.W);
  disk.TwoSided = random.OneIn(2);
  disk.Radiance = RandomRadiance(2 * static_cast<double>(disk.Radius), random);
  return disk;
}

AnyLight RandomSegment(const Place& place, Random& random)
{
  const double length = random.Scale(0.3, 2);
  return Segment{ place.At(-length / 2, 0), place.At(length / 2, 0),
    random.Colour(0.5 / length, 5 / length) };
}

// A sun of some size, up to 20 degrees, or of none.
AnyLight RandomSun(bool hasSize, Random& random)
{
  Directional sun;
  sun.Direction = ToDouble(random.InCube(0.7) - Up);
  sun.AngularDiameter = hasSize ? random.Scale(0.5, 20) : 0;
  sun.Irradiance = random.Colour(0.3, 3);
  return sun;
}

// A window of coloured panes.
AnyLight RandomWindow(const Place& place, Random& random)
{
  const int panes = 2 + random.Below(2);
  const double pane = random.Scale(0.1, 0.4);
  const bool isTwoSided = random.OneIn(2);
  Surface window;
  for (int i = 0; i < panes; ++i)
  {
    for (int j = 0; j < panes; ++j)
    {
      const double u = (i - panes / 2.0) * pane, v = (j - panes / 2.0) * pane;
      Light light;
      light.Vertices = Parallelogram(place.At(u, v), place.At(u + pane, v), place.At(u, v + pane));
      light.TwoSided = isTwoSided;
      light.Radiance = RandomRadiance(panes * pane, random);
      window.Polygons.push_back(light);
    }
  }
  return window;
}

// A lantern: a box whose six sides shine outwards, each in its own colour.
AnyLight RandomLantern(const Place& place, Random& random)
{
  const double size = random.Scale(0.15, 0.6);
  const std::array<Vec3, 3> axes = { place.Axes.U, place.Axes.V, place.Axes.W };
  Surface lantern;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (const long double sign : { -0.5L, 0.5L })
    {
      const Vec3 w = (sign * size) * axes[axis];
      const Vec3 u = size * axes[(axis + 1) % 3];
      const Vec3 v = (2 * sign * size) * axes[(axis + 2) % 3];
      const Vec3 corner = place.Centre + w - 0.5L * u - 0.5L * v;
      Light light;
      light.Vertices = Parallelogram(ToDouble(corner), ToDouble(corner + u), ToDouble(corner + v));
      light.Radiance = RandomRadiance(size, random);
      lantern.Polygons.push_back(light);
    }
  }
  return lantern;
}

AnyLight RandomLight(const RandomScene& scene, bool hasExtent, Random& random)
{
  constexpr int kindsWithExtent = 8, allKinds = 10;
  const Place place = RandomPlace(scene, random);
  switch (random.Below(hasExtent ? kindsWithExtent : allKinds))
  {
    case 0:
      return RandomParallelogram(place, false, random);
    case 1:
      return RandomParallelogram(place, true, random);
    case 2:
      return RandomPolygon(place, random);
    case 3:
      return RandomDisk(place, random);
    case 4:
      return RandomSegment(place, random);
    case 5:
      return RandomSun(true, random);
    case 6:
      return RandomWindow(place, random);
    case 7:
      return RandomLantern(place, random);
    case 8:
      return Point{ place.Centre, random.Colour(0.5, 5) };
    default:
      return RandomSun(false, random);
  }
}

// ---- Occluders ----

// Somewhere in the light, as seen from a point of the receiver.
struct PlaceOf
{
  const Vec3& From;

  Vec3 operator()(const Light& light) const { return light.Vertices[0]; }
  Vec3 operator()(const Disk& light) const { return light.Centre; }
  Vec3 operator()(const Ellipse& light) const { return light.Centre; }
  Vec3 operator()(const Segment& light) const { return light.A; }
  Vec3 operator()(const Point& light) const { return light.Position; }
  Vec3 operator()(const Surface& light) const { return (*this)(light.Polygons[0]); }
  Vec3 operator()(const Directional& light) const
  {
    constexpr long double distance = 2;
    return this->From - distance * Unit(light.Direction);
  }
};

// On the way from the receiver to a light.
Vec3 RandomPlaceBetween(const RandomScene& scene, Random& random)
{
  const double u = random.Between(0.1, 0.9);
  const Vec3 from = scene.At(u, random.Between(0.1, 0.9));
  const std::vector<AnyLight>& lights = scene.Contents.Lights;
  const auto light = static_cast<std::size_t>(random.Below(static_cast<int>(lights.size())));
  const Vec3 to = std::visit(PlaceOf{ from }, lights[light]);
  return from + random.Between(0.1, 0.6) * (to - from);
}

void AddParallelogram(
  std::vector<Triangle>& triangles, const Vec3& corner, const Vec3& u, const Vec3& v)
{
  const Vec3 a = ToFloat(corner), b = ToFloat(corner + u);
  const Vec3 c = ToFloat(corner + u + v), d = ToFloat(corner + v);
  triangles.insert(triangles.end(), { { a, b, c }, { a, c, d } });
}

// In any attitude, or upright on the receiver.
void AddBox(std::vector<Triangle>& triangles, const Vec3& centre, Random& random)
{
  const bool isUpright = random.OneIn(2);
  const Frame axes = FrameAround(isUpright ? Up : Unit(random.InCube(1)), random);
  const Vec3 u = random.Scale(0.1, 0.7) * axes.U;
  const Vec3 v = random.Scale(0.1, 0.7) * axes.V;
  const Vec3 w = random.Scale(0.1, 0.7) * axes.W;
  Vec3 low = centre - 0.5L * u - 0.5L * v - 0.5L * w;
  if (isUpright)
  {
    low.Z = 0;
  }
  for (const auto& [a, b, c] :
    { std::array{ u, v, w }, std::array{ v, w, u }, std::array{ w, u, v } })
  {
    AddParallelogram(triangles, low, a, b);
    AddParallelogram(triangles, low + c, a, b);
  }
}

void AddPlate(std::vector<Triangle>& triangles, const Vec3& centre, Random& random)
{
  const Frame axes = FrameAround(Unit(random.InCube(0.7) - Up), random);
  const Vec3 u = random.Scale(0.15, 1) * axes.U;
  const Vec3 v = random.Scale(0.15, 1) * axes.V;
  AddParallelogram(triangles, centre - 0.5L * u - 0.5L * v, u, v);
}

void AddTetrahedron(std::vector<Triangle>& triangles, const Vec3& centre, Random& random)
{
  const double size = random.Scale(0.1, 0.5);
  std::array<Vec3, 4> p;
  std::generate(p.begin(), p.end(), [&] { return ToFloat(centre + random.InCube(size)); });
  triangles.insert(triangles.end(),
    { { p[0], p[1], p[2] }, { p[0], p[1], p[3] }, { p[0], p[2], p[3] }, { p[1], p[2], p[3] } });
}

void AddOccluder(RandomScene& scene, Random& random)
{
  constexpr std::array kinds = { AddBox, AddPlate, AddTetrahedron };
  const auto kind = static_cast<std::size_t>(random.Below(kinds.size()));
  kinds[kind](scene.Contents.Occluders, RandomPlaceBetween(scene, random), random);
}

RandomScene MakeCandidate(Random& random)
{
  RandomScene scene;
  const double width = random.Between(2, 4), height = random.Between(2, 4);
  scene.Origin = { -width / 2, -height / 2, 0 };
  scene.Edge1 = { width, 0, 0 };
  scene.Edge2 = { 0, height, 0 };
  scene.Contents.Reflectance = random.Colour(0.2, 1);
  scene.Contents.Ambient = random.Colour(0, 0.1);
  scene.Contents.Lights.push_back(RandomLight(scene, true, random));
  if (random.OneIn(2))
  {
    scene.Contents.Lights.push_back(RandomLight(scene, false, random));
  }
  for (int count = 1 + random.Below(6); count > 0; --count)
  {
    AddOccluder(scene, random);
  }
  return scene;
}

// ---- Penumbrae ----

long double Total(const std::array<long double, 3>& colour)
{
  return std::accumulate(colour.begin(), colour.end(), 0.0L);
}

bool IsPenumbral(const RandomScene& scene, const Vec3& x)
{
  constexpr long double few = 0.001L;
  const Scene& contents = scene.Contents;
  const auto isPartlyHidden = [&](const AnyLight& light)
  {
    const long double whole = Total(ArrivingRadiance(x, scene.Normal(), light, {}));
    const long double seen = Total(ArrivingRadiance(x, scene.Normal(), light, contents.Occluders));
    return seen > few * whole && seen < (1 - few) * whole;
  };
  return std::any_of(contents.Lights.begin(), contents.Lights.end(), isPartlyHidden);
}

} // namespace

double PenumbralShare(const RandomScene& scene, int side)
{
  int penumbral = 0;
  for (int i = 0; i < side; ++i)
  {
    for (int j = 0; j < side; ++j)
    {
      penumbral += IsPenumbral(scene, scene.At((i + 0.5L) / side, (j + 0.5L) / side));
    }
  }
  return static_cast<double>(penumbral) / (side * side);
}

RandomScene MakeRandomScene(unsigned seed)
{
  // Enough points to tell 0.5 % from nothing.
  constexpr int side = 20;
  Random random(seed);
  const double least = seed % 8 == 0 ? 0.005 : 0.05;
  for (;;)
  {
    RandomScene scene = MakeCandidate(random);
    const double share = PenumbralShare(scene, side);
    if (share >= least && share <= 0.6)
    {
      return scene;
    }
  }
}

} // namespace oracle

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzedScene.h"

#include "PolygonLight.h"
#include "RandomGeometry.h"
#include "SamplingPattern.h"
#include "SurfaceLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>

using penumbra::LightKind;

penumbra::Light FuzzedLight::Make() const
{
  if (this->Settings.Shape != LightKind::Surface)
  {
    return this->Settings.MakeLight();
  }
  std::vector<penumbra::PolygonLight> cells;
  for (const FuzzedCell& cell : this->Cells)
  {
    cells.push_back(penumbra::PolygonLight::Convex(cell.Vertices));
    cells.back().Radiance = cell.Radiance;
    cells.back().TwoSided = this->Settings.TwoSided;
  }
  penumbra::SurfaceLight light(cells);
  light.Radiance = this->Settings.Radiance;
  light.TwoSided = this->Settings.TwoSided;
  return light;
}

penumbra::ShadowScene FuzzedScene::Make() const
{
  penumbra::ShadowScene scene;
  const penumbra::Parallelogram& b = this->Base;
  penumbra::Surface floor;
  floor.Points = { b.Corner, b.Corner + b.EdgeX, b.Corner + b.EdgeX + b.EdgeY, b.Corner + b.EdgeY };
  floor.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  floor.Regions = { 0, 0 };
  scene.Surfaces.push_back(floor);
  penumbra::Surface occluders;
  for (const FuzzedTriangle& triangle : this->Occluders)
  {
    const auto first = static_cast<std::uint32_t>(occluders.Points.size());
    occluders.Points.insert(occluders.Points.end(), triangle.begin(), triangle.end());
    occluders.Triangles.push_back({ first, first + 1, first + 2 });
  }
  if (!this->Occluders.empty())
  {
    scene.Surfaces.push_back(occluders);
  }
  penumbra::Receiver receiver;
  receiver.Base = b;
  receiver.Texels = this->Texels;
  receiver.Settings = this->Settings;
  scene.Receivers.push_back(receiver);
  for (const FuzzedLight& light : this->Lights)
  {
    scene.Lights.push_back(light.Make());
  }
  return scene;
}

bool MakesSense(const FuzzedScene& scene)
{
  const penumbra::ReceiverFrame frame(scene.Base, penumbra::ReceiverFrame::Side::Front);
  return frame.IsValid() && scene.Settings.FindProblem().empty() &&
    std::all_of(scene.Lights.begin(), scene.Lights.end(),
      [](const FuzzedLight& light)
      { return light.Settings.FindProblem().empty() && light.Make()->IsValid(); });
}

namespace
{

void Print(std::ostream& os, const char* name, const glm::dvec3& v)
{
  os << " " << name << " (" << v.x << ", " << v.y << ", " << v.z << ")";
}

} // namespace

std::ostream& operator<<(std::ostream& os, const FuzzedScene& scene)
{
  const penumbra::ReceiverSettings& s = scene.Settings;
  os << std::setprecision(std::numeric_limits<double>::max_digits10) << "receiver";
  Print(os, "Corner", scene.Base.Corner);
  Print(os, "EdgeX", scene.Base.EdgeX);
  Print(os, "EdgeY", scene.Base.EdgeY);
  os << " Texels " << scene.Texels.x << " x " << scene.Texels.y << " LightSamples "
     << s.LightSamples << " SamplingPattern " << s.SamplingPattern << " Supersampling "
     << s.Supersampling << " Side " << static_cast<int>(s.Side) << " Seed " << s.Seed
     << " Reconstruction " << s.Reconstruction << "\n";
  for (const FuzzedLight& light : scene.Lights)
  {
    os << "light Shape " << static_cast<int>(light.Settings.Shape);
    Print(os, "Origin", light.Settings.Origin);
    Print(os, "Point1", light.Settings.Point1);
    Print(os, "Point2", light.Settings.Point2);
    Print(os, "Radiance", light.Settings.Radiance);
    os << " TwoSided " << light.Settings.TwoSided << " AngularDiameter "
       << light.Settings.AngularDiameter << "\n";
    for (const FuzzedCell& cell : light.Cells)
    {
      os << "  cell";
      Print(os, "Radiance", cell.Radiance);
      for (const glm::dvec3& v : cell.Vertices)
      {
        Print(os, "", v);
      }
      os << "\n";
    }
  }
  for (const FuzzedTriangle& triangle : scene.Occluders)
  {
    os << "triangle";
    for (const glm::dvec3& v : triangle)
    {
      Print(os, "", v);
    }
    os << "\n";
  }
  return os;
}

namespace
{

/// The generator of one scene.
class Maker
{
public:
  Maker(unsigned seed, FuzzedKind kind)
    : Random(seed)
    , IsNasty(kind == FuzzedKind::Nasty)
    , HasNastyOccluders(kind != FuzzedKind::Tame)
  {
  }

  FuzzedScene MakeScene();
  FuzzedTriangle MakeTriangle(const FuzzedScene& scene);

private:
  bool OneIn(std::size_t count) { return this->Random.Below(count) == 0; }
  /// Now and then, in nasty scenes.
  bool NastyOneIn(std::size_t count) { return this->OneIn(count) && this->IsNasty; }
  double Scale(double low, double high)
  {
    return std::exp(this->Random.Between(std::log(low), std::log(high)));
  }
  glm::dvec3 Colour()
  {
    const double r = this->Random.Between(0.0, 5.0), g = this->Random.Between(0.0, 5.0);
    return { r, g, this->Random.Between(0.0, 5.0) };
  }
  /// A unit vector across another.
  glm::dvec3 Across(const glm::dvec3& axis)
  {
    return glm::normalize(glm::cross(axis, this->Random.Direction()));
  }

  void MakeReceiver(FuzzedScene& scene);
  void MakeSettings(FuzzedScene& scene);
  FuzzedLight MakeLight(const FuzzedScene& scene);
  double GetHeight();
  void MakeCells(FuzzedLight& light, const glm::dvec3& centre, const glm::dvec3& normal);
  void AddOccluder(FuzzedScene& scene);
  glm::dvec3 At(const FuzzedScene& scene, double u, double v, double h)
  {
    const glm::dvec3 area = glm::cross(scene.Base.EdgeX, scene.Base.EdgeY);
    // In the plane z = 0, heights are exact.
    return scene.Base.Corner + u * scene.Base.EdgeX + v * scene.Base.EdgeY +
      h * std::sqrt(glm::length(area)) * glm::normalize(area);
  }
  glm::dvec3 Anywhere(const FuzzedScene& scene, double low, double high, double h)
  {
    const double u = this->Random.Between(low, high);
    return this->At(scene, u, this->Random.Between(low, high), h);
  }

  /// Right over a texel's centre.
  glm::dvec3 OverTexel(const FuzzedScene& scene, double h)
  {
    const auto i = this->Random.Below(static_cast<std::size_t>(scene.Texels.x));
    const auto j = this->Random.Below(static_cast<std::size_t>(scene.Texels.y));
    return this->At(scene, (static_cast<double>(i) + 0.5) / scene.Texels.x,
      (static_cast<double>(j) + 0.5) / scene.Texels.y, h);
  }

  RandomGeometry Random;
  bool IsNasty;
  bool HasNastyOccluders;
};

void Maker::MakeReceiver(FuzzedScene& scene)
{
  const bool isLevel = this->OneIn(2);
  const glm::dvec3 normal = isLevel ? glm::dvec3(0, 0, 1) : this->Random.Direction();
  const glm::dvec3 x = isLevel ? glm::dvec3(1, 0, 0) : this->Across(normal);
  const double least = this->NastyOneIn(4) ? 1.0 : 30.0;
  const double angle = glm::radians(this->OneIn(2) ? 90.0 : this->Random.Between(least, 150.0));
  const double most = this->NastyOneIn(4) ? 100.0 : 4.0;
  const double length = this->Scale(1.0, 4.0);
  scene.Base.Corner = isLevel ? glm::dvec3(-1, -1, 0) : this->Random.InBox(2.0);
  scene.Base.EdgeX = length * x;
  scene.Base.EdgeY = length / this->Scale(1.0, most) *
    (std::cos(angle) * x + std::sin(angle) * glm::cross(normal, x));
  if (angle == glm::radians(90.0) && isLevel)
  {
    scene.Base.EdgeY.x = 0.0;
  }
}

void Maker::MakeSettings(FuzzedScene& scene)
{
  constexpr std::size_t mostTexels = 12, mostSamples = 64, sides = 3;
  penumbra::ReceiverSettings& s = scene.Settings;
  const int width = 1 + static_cast<int>(this->Random.Below(mostTexels));
  scene.Texels = { width, 1 + static_cast<int>(this->Random.Below(mostTexels)) };
  s.HardPenumbra = 0.0; // all samples, of all lights
  s.PlannerTolerance = 0.0;
  s.LightSamples = 1 + static_cast<int>(this->Random.Below(mostSamples));
  s.SamplingPattern = static_cast<int>(this->Random.Below(penumbra::GetSamplingPatterns().size()));
  s.Supersampling = this->OneIn(8) ? 2 : 1;
  s.Seed = static_cast<int>(this->Random.Below(1000));
  s.Reconstruction = this->OneIn(2);
  s.Side = penumbra::ReceiverSide::Front;
  if (this->NastyOneIn(4))
  {
    s.Side = static_cast<penumbra::ReceiverSide>(this->Random.Below(sides));
  }
}

/// Over the receiver, in units of its size.
double Maker::GetHeight()
{
  if (!this->NastyOneIn(3))
  {
    return this->Scale(0.3, 4.0);
  }
  switch (this->Random.Below(4))
  {
    case 0:
      return std::pow(10.0, this->Random.Between(-15.0, -1.0));
    case 1:
      return 0.0;
    case 2:
      return this->Scale(10.0, 1e15);
    default:
      return this->Random.Between(-1.0, 0.2);
  }
}

/// Panes of a window, and one polygon of many corners.
void Maker::MakeCells(FuzzedLight& light, const glm::dvec3& centre, const glm::dvec3& normal)
{
  const glm::dvec3 x = this->Across(normal), y = glm::cross(normal, x);
  const double pane = this->Scale(0.05, 0.3);
  for (std::size_t i = 0; i < 1 + this->Random.Below(3); ++i)
  {
    const glm::dvec3 corner = centre + pane * static_cast<double>(i) * x;
    light.Cells.push_back(
      { { corner, corner + pane * x, corner + pane * x + pane * y, corner + pane * y },
        this->Colour() });
  }
  if (this->OneIn(2))
  {
    FuzzedCell& round = light.Cells.emplace_back();
    const std::size_t corners = 3 + this->Random.Below(9);
    for (std::size_t i = 0; i < corners; ++i)
    {
      const double angle =
        glm::two_pi<double>() * static_cast<double>(i) / static_cast<double>(corners);
      round.Vertices.push_back(centre + pane * ((std::cos(angle) - 1.5) * x + std::sin(angle) * y));
    }
    round.Radiance = this->Colour();
  }
}

FuzzedLight Maker::MakeLight(const FuzzedScene& scene)
{
  constexpr std::size_t kinds = 7;
  FuzzedLight light;
  penumbra::LightSettings& s = light.Settings;
  s.Shape = static_cast<LightKind>(this->Random.Below(kinds));
  const double size = std::sqrt(glm::length(glm::cross(scene.Base.EdgeX, scene.Base.EdgeY)));
  const glm::dvec3 up = glm::normalize(glm::cross(scene.Base.EdgeX, scene.Base.EdgeY));
  const glm::dvec3 centre = this->NastyOneIn(4)
    ? this->OverTexel(scene, this->GetHeight())
    : this->Anywhere(scene, -0.3, 1.3, this->GetHeight());
  // Tame lights do not reach the receiver's plane.
  const double tilt = this->IsNasty && this->OneIn(3) ? 1.0 : 0.3;
  const double extent = size * this->Scale(0.02, 0.25);
  const glm::dvec3 normal = glm::normalize(tilt * this->Random.Direction() - up);
  const bool isFlat = this->OneIn(3);
  const glm::dvec3 axis = isFlat ? -up : normal;
  const glm::dvec3 x = isFlat ? glm::normalize(scene.Base.EdgeX) : this->Across(axis);
  s.Origin = centre;
  s.Point1 = centre + extent * x;
  s.Point2 = centre +
    extent * this->Scale(0.1, 2.0) * (glm::cross(axis, x) + this->Random.Between(-0.5, 0.5) * x);
  s.TwoSided = this->OneIn(3);
  s.Radiance = this->Colour();
  if (this->NastyOneIn(4))
  {
    s.Radiance *= std::pow(10.0, this->Random.Between(-12.0, 12.0));
  }
  if (s.Shape == LightKind::Directional)
  {
    s.Point1 = s.Origin + axis;
    s.AngularDiameter = this->OneIn(3) ? 0.0 : this->Scale(0.1, this->IsNasty ? 120.0 : 20.0);
  }
  else if (s.Shape == LightKind::Surface)
  {
    this->MakeCells(light, centre, normal);
  }
  return light;
}

FuzzedTriangle Maker::MakeTriangle(const FuzzedScene& scene)
{
  const double size = std::sqrt(glm::length(glm::cross(scene.Base.EdgeX, scene.Base.EdgeY)));
  const penumbra::LightSettings& light = scene.Lights.front().Settings;
  const glm::dvec3 to = light.Shape == LightKind::Directional
    ? light.Origin + 2.0 * size * glm::normalize(light.Origin - light.Point1)
    : light.Origin;
  const glm::dvec3 from = this->Anywhere(scene, 0.0, 1.0, 0.0);
  const glm::dvec3 place = from + this->Random.Between(0.2, 0.7) * (to - from);
  const double extent = size * this->Scale(0.1, 0.8);
  FuzzedTriangle t;
  std::generate(t.begin(), t.end(), [&] { return place + this->Random.InBox(extent); });
  if (!this->HasNastyOccluders || this->OneIn(2))
  {
    return t;
  }
  switch (this->Random.Below(9))
  {
    case 0: // resting on the receiver
      t[0] = this->Anywhere(scene, 0.0, 1.0, 0.0);
      t[1] = this->Anywhere(scene, 0.0, 1.0, 0.0);
      break;
    case 1: // in it
      std::generate(t.begin(), t.end(), [&] { return this->Anywhere(scene, 0.0, 1.0, 0.0); });
      break;
    case 2: // crossing it
      t[0] = this->Anywhere(scene, 0.0, 1.0, -this->Scale(0.01, 1.0));
      break;
    case 3: // touching the light
      t[this->Random.Below(3)] = light.Origin;
      break;
    case 4: // behind the light, or through its plane
      t[0] = to + this->Random.Between(-0.5, 2.0) * (to - from);
      break;
    case 5: // enormous
      std::generate(t.begin(), t.end(),
        [&]
        { return place + this->Random.InBox(size * std::pow(10.0, 2.0 + 4.0 * this->OneIn(2))); });
      break;
    case 6: // a sliver
      t[2] = t[0] + this->Random.Between(0.0, 1.0) * (t[1] - t[0]) + this->Random.InBox(1e-8);
      break;
    case 7: // without area
      t[2] = this->OneIn(2) ? t[0] : 0.5 * (t[0] + t[1]);
      break;
    default: // a hair above the receiver
      std::generate(t.begin(), t.end(),
        [&]
        { return this->Anywhere(scene, 0.0, 1.0, std::pow(10.0, -this->Random.Between(3, 6))); });
  }
  return t;
}

/// A triangle, a quadrangle, or a tetrahedron.
void Maker::AddOccluder(FuzzedScene& scene)
{
  const FuzzedTriangle t = this->MakeTriangle(scene);
  scene.Occluders.push_back(t);
  if (this->OneIn(3))
  {
    scene.Occluders.push_back({ t[0], t[2], t[0] + t[2] - t[1] });
  }
  else if (this->OneIn(3))
  {
    const glm::dvec3 top = this->MakeTriangle(scene)[0];
    for (std::size_t i = 0; i < 3; ++i)
    {
      scene.Occluders.push_back({ t[i], t[(i + 1) % 3], top });
    }
  }
  if (this->OneIn(8) && this->HasNastyOccluders)
  {
    scene.Occluders.push_back(scene.Occluders.back());
  }
}

FuzzedScene Maker::MakeScene()
{
  constexpr std::size_t mostLights = 3, mostOccluders = 6;
  FuzzedScene scene;
  this->MakeReceiver(scene);
  this->MakeSettings(scene);
  for (std::size_t left = 1 + this->Random.Below(mostLights); left > 0; --left)
  {
    scene.Lights.push_back(this->MakeLight(scene));
  }
  for (std::size_t left = this->Random.Below(mostOccluders + 1); left > 0; --left)
  {
    this->AddOccluder(scene);
  }
  return scene;
}

} // namespace

FuzzedScene MakeFuzzedScene(unsigned seed, FuzzedKind kind)
{
  return Maker(seed, kind).MakeScene();
}

FuzzedTriangle MakeFuzzedTriangle(const FuzzedScene& scene, unsigned seed, FuzzedKind kind)
{
  return Maker(seed, kind).MakeTriangle(scene);
}

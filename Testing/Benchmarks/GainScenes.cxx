// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GainScenes.h"

#include "DirectionalLight.h"
#include "PolygonLight.h"

#include <array>
#include <cmath>
#include <random>

namespace
{

using penumbra::Parallelogram;
using penumbra::ShadowScene;
using penumbra::Surface;

void AddQuad(Surface& surface, const glm::dvec3& corner, const glm::dvec3& x, const glm::dvec3& y)
{
  const auto first = static_cast<std::uint32_t>(surface.Points.size());
  surface.Points.insert(surface.Points.end(), { corner, corner + x, corner + x + y, corner + y });
  surface.Triangles.push_back({ first, first + 1, first + 2 });
  surface.Triangles.push_back({ first, first + 2, first + 3 });
}

Surface MakeBox(const glm::dvec3& low, const glm::dvec3& high)
{
  Surface box;
  const glm::dvec3 size = high - low;
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 across(0.0), x(0.0), y(0.0);
    across[axis] = size[axis];
    x[(axis + 1) % 3] = size[(axis + 1) % 3];
    y[(axis + 2) % 3] = size[(axis + 2) % 3];
    AddQuad(box, low, x, y);
    AddQuad(box, low + across, x, y);
  }
  return box;
}

/// A receiver of its own surface, lit from where EdgeX x EdgeY points.
void AddReceiver(
  ShadowScene& scene, Surface surface, const Parallelogram& base, double texelSize, int samples)
{
  surface.Regions.assign(surface.Triangles.size(), 0);
  penumbra::Receiver receiver;
  receiver.Surface = scene.Surfaces.size();
  receiver.Base = base;
  receiver.Settings.LightSamples = samples;
  receiver.Settings.Side = penumbra::ReceiverSide::Front;
  receiver.Texels = { static_cast<int>(std::ceil(glm::length(base.EdgeX) / texelSize)),
    static_cast<int>(std::ceil(glm::length(base.EdgeY) / texelSize)) };
  scene.Surfaces.emplace_back(surface);
  scene.Receivers.push_back(receiver);
}

void AddPlainReceiver(ShadowScene& scene, const Parallelogram& base, double texelSize, int samples)
{
  Surface surface;
  AddQuad(surface, base.Corner, base.EdgeX, base.EdgeY);
  AddReceiver(scene, surface, base, texelSize, samples);
}

/// A square that shines down.
penumbra::PolygonLight MakeLamp(const glm::dvec3& centre, double edge)
{
  const glm::dvec3 corner = centre - glm::dvec3(0.5 * edge, 0.5 * edge, 0.0);
  return penumbra::PolygonLight::Parallelogram(
    corner, corner + glm::dvec3(0, edge, 0), corner + glm::dvec3(edge, 0, 0));
}

constexpr double RoomEdge = 6.0, RoomHeight = 3.0, WallThickness = 0.2, Door = 1.0,
                 DoorHeight = 2.0;

/// A wall across the hall that faces along `facing` the x axis, with a door in its middle.
void AddWallWithDoor(ShadowScene& scene, double x, double facing, double texelSize, int samples)
{
  const double door = 0.5 * (RoomEdge - Door);
  Surface wall;
  AddQuad(wall, { x, 0, 0 }, { 0, door, 0 }, { 0, 0, RoomHeight });
  AddQuad(wall, { x, door + Door, 0 }, { 0, door, 0 }, { 0, 0, RoomHeight });
  AddQuad(wall, { x, door, DoorHeight }, { 0, Door, 0 }, { 0, 0, RoomHeight - DoorHeight });
  const Parallelogram base = facing > 0.0
    ? Parallelogram{ { x, 0, 0 }, { 0, RoomEdge, 0 }, { 0, 0, RoomHeight } }
    : Parallelogram{ { x, RoomEdge, 0 }, { 0, -RoomEdge, 0 }, { 0, 0, RoomHeight } };
  AddReceiver(scene, wall, base, texelSize, samples);
}

void AddRoom(ShadowScene& scene, double x, double texelSize, int samples)
{
  AddPlainReceiver(
    scene, { { x, 0, 0 }, { RoomEdge, 0, 0 }, { 0, RoomEdge, 0 } }, texelSize, samples);
  AddPlainReceiver(scene, { { x + RoomEdge, 0, 0 }, { -RoomEdge, 0, 0 }, { 0, 0, RoomHeight } },
    texelSize, samples);
  AddPlainReceiver(
    scene, { { x, RoomEdge, 0 }, { RoomEdge, 0, 0 }, { 0, 0, RoomHeight } }, texelSize, samples);
  AddWallWithDoor(scene, x, 1.0, texelSize, samples);
  AddWallWithDoor(scene, x + RoomEdge, -1.0, texelSize, samples);
  scene.Surfaces.emplace_back(MakeBox({ x + 2, 2, 0.8 }, { x + 4, 3, 0.9 }));
  scene.Surfaces.emplace_back(MakeBox({ x + 1, 4, 0 }, { x + 1.4, 4.4, RoomHeight }));
  scene.Surfaces.emplace_back(MakeBox({ x + 4.6, 4, 0 }, { x + 5, 4.4, RoomHeight }));
  scene.Lights.push_back(MakeLamp({ x + 3, 3.2, RoomHeight - 0.05 }, 0.6));
}

} // namespace

ShadowScene MakeHall(int texels, int samples)
{
  constexpr int Rooms = 10;
  constexpr double Pitch = RoomEdge + WallThickness;
  ShadowScene scene;
  for (int room = 0; room < Rooms; ++room)
  {
    AddRoom(scene, Pitch * room, RoomEdge / texels, samples);
  }
  // Two more, in the first and the last room.
  scene.Lights.push_back(MakeLamp({ 1.0, 1.0, 2.5 }, 0.2));
  scene.Lights.push_back(MakeLamp({ Pitch * (Rooms - 1) + 1.0, 1.0, 2.5 }, 0.2));
  return scene;
}

ShadowScene MakePlain(int texels, int samples, int boxes)
{
  constexpr double Edge = 200.0, LargestBox = 3.0;
  ShadowScene scene;
  AddPlainReceiver(scene, { {}, { Edge, 0, 0 }, { 0, Edge, 0 } }, Edge / texels, samples);
  std::mt19937 random(1);
  const auto next = [&]() { return random() / 4294967296.0; };
  for (int i = 0; i < boxes; ++i)
  {
    const double x = 0.97 * Edge * next(), y = 0.97 * Edge * next();
    const double width = LargestBox * next(), depth = LargestBox * next();
    scene.Surfaces.emplace_back(
      MakeBox({ x, y, 0 }, { x + width, y + depth, LargestBox * next() }));
  }
  const double elevation = std::acos(-1.0) * 40.0 / 180.0;
  scene.Lights.push_back(
    penumbra::DirectionalLight({ std::cos(elevation), 0.3, -std::sin(elevation) }, 0.53));
  return scene;
}

ShadowScene MakeBoxes(int texels, int samples)
{
  constexpr double Edge = 10.0;
  constexpr int Columns = 10, Rows = 5;
  ShadowScene scene;
  AddPlainReceiver(scene, { {}, { Edge, 0, 0 }, { 0, Edge, 0 } }, Edge / texels, samples);
  for (int i = 0; i < Columns * Rows; ++i)
  {
    const glm::dvec3 low(
      0.3 + i % Columns, 0.7 + 2.0 * static_cast<double>(i / Columns), 0.3 * (i % 3));
    scene.Surfaces.emplace_back(MakeBox(low, low + glm::dvec3(0.4, 0.6, 0.7)));
  }
  scene.Lights = { MakeLamp({ 4, 6, 6 }, 2.0), MakeLamp({ 8, 5, 8 }, 1.0) };
  return scene;
}

penumbra::SharedSurface Moved(const penumbra::SharedSurface& surface, const glm::dvec3& step)
{
  Surface moved = *surface;
  for (glm::dvec3& p : moved.Points)
  {
    p += step;
  }
  return moved;
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * A small scene to be planned, without OpenGL.
 */
#ifndef PlanScene_h
#define PlanScene_h

#include "EffectPlanner.h"
#include "OccluderSelector.h"
#include "PolygonLight.h"
#include "ShadowScene.h"

#include <array>
#include <vector>

/// A receiver of 2 x 2 around the origin, lit from above, with 100 x 100 texels.
struct PlanScene : penumbra::ShadowScene
{
  static constexpr int Side = 100;
  static constexpr double Edge = 2.0;

  PlanScene()
  {
    penumbra::Receiver receiver;
    receiver.Base = { { -1, -1, 0 }, { Edge, 0, 0 }, { 0, Edge, 0 } };
    receiver.Settings.Side = penumbra::ReceiverSide::Front;
    receiver.Texels = glm::ivec2(Side);
    penumbra::Surface floor = MakePlate({ -1, -1, 0 }, { Edge, 0, 0 }, { 0, Edge, 0 });
    floor.Regions = { 0, 0 };
    this->Surfaces = { floor };
    this->Receivers = { receiver };
  }

  /// A parallelogram of n x n parts, each of two triangles.
  static penumbra::Surface MakePlate(
    const glm::dvec3& corner, const glm::dvec3& edge1, const glm::dvec3& edge2, int n = 1)
  {
    penumbra::Surface plate;
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; j <= n; ++j)
      {
        plate.Points.push_back(
          corner + (static_cast<double>(i) / n) * edge1 + (static_cast<double>(j) / n) * edge2);
      }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < n; ++j)
      {
        plate.Triangles.push_back({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
        plate.Triangles.push_back({ at(i, j), at(i + 1, j + 1), at(i, j + 1) });
      }
    }
    return plate;
  }

  /// A square at a height, parallel to the receiver.
  static penumbra::Surface MakeSquare(double x, double y, double height, double edge, int n = 1)
  {
    return MakePlate({ x - 0.5 * edge, y - 0.5 * edge, height }, { edge, 0, 0 }, { 0, edge, 0 }, n);
  }

  /// A square lamp that shines down.
  static penumbra::PolygonLight MakeLamp(double x, double y, double height, double edge)
  {
    const double h = 0.5 * edge;
    return penumbra::PolygonLight::Parallelogram(
      { x - h, y - h, height }, { x - h, y + h, height }, { x + h, y - h, height });
  }

  penumbra::ReceiverSettings& GetSettings() { return this->Receivers.front().Settings; }

  penumbra::ReceiverPlan Plan() const
  {
    penumbra::OccluderSelector occluders;
    occluders.SetScene(*this);
    return penumbra::PlanReceiver(*this, this->Receivers.front(), occluders);
  }
  /// Of the first light.
  penumbra::PairPlan PlanFirst() const { return this->Plan().Pairs.front(); }
};

#endif

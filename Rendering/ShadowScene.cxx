// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShadowScene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace penumbra
{
namespace
{

/// Texels along the longest edge where TexelSize is 0.
constexpr double AutomaticTexels = 512.0;
/// An edge may be this share longer than its texels: it is rounding.
constexpr double CountTolerance = 1e-6;
/// Far past any limit, and finite whatever the texel size.
constexpr double MostTexels = 1e9;

/// Texels of the given size, grown by `growth`, along an edge of the receiver.
double CountTexels(const Receiver& receiver, const glm::dvec3& edge, double growth)
{
  const double longest =
    std::max(glm::length(receiver.Base.EdgeX), glm::length(receiver.Base.EdgeY));
  const double wanted = receiver.Settings.TexelSize;
  const double size = growth *
    (wanted > 0.0 ? std::max(wanted, std::numeric_limits<double>::min())
                  : longest / AutomaticTexels);
  const double length = glm::length(edge) * (1.0 - CountTolerance);
  return std::clamp(std::ceil(length / size), 1.0, MostTexels);
}

/// Sets that are joined, each known by its smallest member (union-find).
class Groups
{
public:
  explicit Groups(std::size_t count)
    : Parents(count)
  {
    std::iota(this->Parents.begin(), this->Parents.end(), std::uint32_t{ 0 });
  }
  std::uint32_t Find(std::uint32_t i)
  {
    while (this->Parents[i] != i)
    {
      this->Parents[i] = this->Parents[this->Parents[i]];
      i = this->Parents[i];
    }
    return i;
  }
  void Join(std::uint32_t a, std::uint32_t b)
  {
    const std::uint32_t first = this->Find(a), second = this->Find(b);
    this->Parents[std::max(first, second)] = std::min(first, second);
  }

private:
  std::vector<std::uint32_t> Parents;
};

/// What a light sends to the receiver's centre, summed over its components; how much of it is in
/// front where the centre sees nothing of it.
glm::dvec2 LightOnSide(const LightShape& light, const ReceiverFrame& frame)
{
  const glm::dvec3 centre = frame.ToWorld({ 0.5, 0.5, 0.0 });
  const glm::dvec3 arriving = light.Irradiance(centre, frame.GetNormal());
  const glm::dvec3 power = light.Clip(centre, frame.GetNormal())->GetMeasure() * light.Radiance;
  return { arriving.x + arriving.y + arriving.z, power.x + power.y + power.z };
}

} // namespace

std::vector<std::uint32_t> FindConnectedParts(
  const std::vector<glm::dvec3>& points, const std::vector<Surface::Triangle>& triangles)
{
  Groups groups(points.size());
  for (const Surface::Triangle& t : triangles)
  {
    groups.Join(t[0], t[1]);
    groups.Join(t[0], t[2]);
  }
  const auto isOne = [&]
  {
    return std::all_of(triangles.begin(), triangles.end(),
      [&](const Surface::Triangle& t)
      { return groups.Find(t[0]) == groups.Find(triangles.front()[0]); });
  };
  if (!isOne())
  {
    // Normals and file formats divide points: a box of VTK has 24.
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), std::uint32_t{ 0 });
    const auto key = [&](std::uint32_t i)
    { return std::tie(points[i].x, points[i].y, points[i].z); };
    order.erase(
      std::remove_if(order.begin(), order.end(),
        [&](std::uint32_t i) { return std::isnan(points[i].x + points[i].y + points[i].z); }),
      order.end());
    std::sort(order.begin(), order.end(),
      [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i)
    {
      if (key(order[i - 1]) == key(order[i]))
      {
        groups.Join(order[i - 1], order[i]);
      }
    }
  }
  std::vector<std::uint32_t> parts;
  parts.reserve(triangles.size());
  for (const Surface::Triangle& t : triangles)
  {
    parts.push_back(groups.Find(t[0]));
  }
  return parts;
}

SharedSurface::Indexed::Indexed(Surface&& surface)
  : Contents(std::move(surface))
  , Clusters(Contents.Points, Contents.Triangles)
{
}

SharedSurface::SharedSurface(Surface surface)
  : Shared(std::make_shared<const Indexed>(std::move(surface)))
{
}

const std::vector<std::uint32_t>& SharedSurface::GetParts() const
{
  const Indexed& shared = *this->Shared;
  std::call_once(shared.PartsAreFound,
    [&] { shared.Parts = FindConnectedParts(shared.Contents.Points, shared.Contents.Triangles); });
  return shared.Parts;
}

double Receiver::GetBakedTexels() const
{
  const double side = this->Settings.Supersampling;
  return side * side * this->Texels.x * this->Texels.y;
}

Parallelogram Receiver::GetDataBase() const
{
  const Parallelogram& base = this->Base;
  return this->IsTurned ? Parallelogram{ base.Corner, base.EdgeY, base.EdgeX } : base;
}

glm::ivec2 Receiver::GetDataTexels() const
{
  return this->IsTurned ? glm::ivec2(this->Texels.y, this->Texels.x) : this->Texels;
}

std::size_t Receiver::GetTexelOfData(std::size_t i) const
{
  const glm::uvec2 size(this->Texels);
  return this->IsTurned ? i / size.y + size.x * (i % size.y) : i;
}

double ShadowScene::ChooseTexels(std::size_t first)
{
  double growth = 1.0;
  while (true)
  {
    double largestSide = 0.0;
    bool canGrow = false; // one texel a receiver is the least
    double bytes = 0.0;
    for (std::size_t i = first; i < this->Receivers.size(); ++i)
    {
      const Receiver& receiver = this->Receivers[i];
      const double supersampling = receiver.Settings.Supersampling;
      const double x = supersampling * CountTexels(receiver, receiver.Base.EdgeX, growth);
      const double y = supersampling * CountTexels(receiver, receiver.Base.EdgeY, growth);
      largestSide = std::max({ largestSide, x, y });
      bytes += BytesPerTexel * x * y;
      canGrow = canGrow || x > supersampling || y > supersampling;
    }
    if (!canGrow || (largestSide <= MaximumTextureSide && bytes <= MaximumTextureBytes))
    {
      break;
    }
    // One step is nearly exact; a texel too many by rounding up takes another.
    growth *=
      1.0001 * std::max(largestSide / MaximumTextureSide, std::sqrt(bytes / MaximumTextureBytes));
  }
  for (std::size_t i = first; i < this->Receivers.size(); ++i)
  {
    Receiver& receiver = this->Receivers[i];
    receiver.IsAutomatic =
      receiver.Settings.TexelSize <= 0.0 && receiver.Settings.Supersampling == 1;
    receiver.Texels = { static_cast<int>(CountTexels(receiver, receiver.Base.EdgeX, growth)),
      static_cast<int>(CountTexels(receiver, receiver.Base.EdgeY, growth)) };
  }
  return growth;
}

void ShadowScene::Append(const ShadowScene& other)
{
  const std::size_t first = this->Surfaces.size();
  this->Surfaces.insert(this->Surfaces.end(), other.Surfaces.begin(), other.Surfaces.end());
  for (Receiver receiver : other.Receivers)
  {
    receiver.Surface += first;
    this->Receivers.push_back(receiver);
  }
  this->Lights.insert(this->Lights.end(), other.Lights.begin(), other.Lights.end());
}

ReceiverFrame ShadowScene::MakeFrame(const Receiver& receiver) const
{
  const ReceiverFrame front(receiver.Base, ReceiverFrame::Side::Front);
  const ReceiverFrame back(receiver.Base, ReceiverFrame::Side::Back);
  if (receiver.Settings.Side == ReceiverSide::Front || receiver.Settings.Side == ReceiverSide::Back)
  {
    return receiver.Settings.Side == ReceiverSide::Front ? front : back;
  }
  glm::dvec2 atFront(0.0), atBack(0.0);
  for (const std::size_t i : this->GetLightOrder())
  {
    atFront += LightOnSide(*this->Lights[i], front);
    atBack += LightOnSide(*this->Lights[i], back);
  }
  const bool backWins = atFront.x != atBack.x ? atBack.x > atFront.x : atBack.y > atFront.y;
  return backWins ? back : front;
}

std::vector<std::size_t> ShadowScene::GetLightOrder() const
{
  std::vector<std::size_t> order(this->Lights.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [this](std::size_t a, std::size_t b)
    { return this->Lights[a]->GetKey() < this->Lights[b]->GetKey(); });
  return order;
}

} // namespace penumbra

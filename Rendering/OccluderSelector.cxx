// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OccluderSelector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace penumbra
{
namespace
{

constexpr std::uint32_t NoPlace = std::numeric_limits<std::uint32_t>::max();
/// Points of a PlaceTable's page: 4 KiB, as much as a page of memory.
constexpr std::size_t PageSize = 1024;
/// A point outside of a receiver is judged by a plane through points within it.
constexpr double RoundingsOfPlane = 3.0;
/// Rays start at texels' centres. The outermost are 1/2 of 1/16384 inside the receiver
/// (ShadowScene::MaximumTextureSide), so what touches its border, but for rounding, blocks none of
/// them: the walls of a room, which stand on its floor.
constexpr double Inset = 1e-6;

/// How far the points of a surface may be off, along each axis: the rounding of the coordinates in
/// their own type, and that of the arithmetic in double. A frame takes differences and products of
/// three terms, a plane three points: 16 roundings of the largest number that occurs. The normal of
/// edges that are nearly parallel is that much less certain.
glm::dvec3 GetUncertainty(const SharedSurface& surface, const Parallelogram& receiver)
{
  constexpr double Roundings = 16.0;
  glm::dvec3 largest =
    glm::abs(receiver.Corner) + glm::abs(receiver.EdgeX) + glm::abs(receiver.EdgeY);
  if (!surface->Triangles.empty())
  {
    const Box bounds = surface.GetClusters().GetBounds();
    largest = glm::max(largest, glm::max(glm::abs(bounds.Low), glm::abs(bounds.High)));
  }
  const double skew = glm::length(receiver.EdgeX) * glm::length(receiver.EdgeY) /
    glm::length(glm::cross(receiver.EdgeX, receiver.EdgeY));
  return surface->Rounding +
    Roundings * std::numeric_limits<double>::epsilon() * skew * glm::length(largest);
}

/// The height above the receiver's plane that no point of a box is above.
double GetTop(const Box& box, const ReceiverFrame& frame)
{
  double top = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 p((corner & 1) != 0 ? box.High.x : box.Low.x,
      (corner & 2) != 0 ? box.High.y : box.Low.y, (corner & 4) != 0 ? box.High.z : box.Low.z);
    top = std::max(top, frame.ToFrame(p).z);
  }
  return top;
}

/// Whether the triangle is as thin as the rounding of its points: its area is nothing else.
bool IsDegenerate(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  constexpr double Roundings = 16.0;
  const glm::dvec3 largest = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  const double length = std::max({ glm::length(b - a), glm::length(c - b), glm::length(a - c) });
  return glm::length(glm::cross(b - a, c - a)) <= Roundings *
    std::numeric_limits<double>::epsilon() * glm::length(largest + glm::dvec3(1.0)) * length;
}

} // namespace

void OccluderSelector::PlaceTable::Resize(std::size_t points)
{
  this->Size = points;
  this->Pages.assign((points + PageSize - 1) / PageSize, {});
}

std::uint32_t& OccluderSelector::PlaceTable::operator[](std::uint32_t point)
{
  const std::size_t index = point / PageSize;
  std::vector<std::uint32_t>& page = this->Pages[index];
  if (page.empty())
  {
    page.assign(std::min(PageSize, this->Size - index * PageSize), NoPlace);
  }
  return page[point % PageSize];
}

void OccluderSelector::SetScene(const ShadowScene& scene)
{
  this->Clear();
  this->Scene = &scene;
  std::vector<Box> boxes;
  for (const SharedSurface& surface : scene.Surfaces)
  {
    boxes.push_back(surface.GetClusters().GetBounds());
  }
  this->Surfaces = ClusterTree(boxes, 1);
}

void OccluderSelector::SetReceiver(const Receiver& receiver, const ReceiverFrame& frame)
{
  this->Clear();
  this->Base = &receiver;
  this->Frame = frame;
}

void OccluderSelector::Clear()
{
  this->Parts.clear();
  this->Points.clear();
  this->Tops.clear();
  this->NotedBy.clear();
  this->Selected.clear();
  this->Translucent.clear();
  this->Casters.clear();
}

OccluderSelector::Part& OccluderSelector::GetPart(std::size_t surface)
{
  const auto [entry, isNew] = this->Parts.try_emplace(surface);
  Part& part = entry->second;
  if (isNew)
  {
    const SharedSurface& shared = this->Scene->Surfaces[surface];
    part.Places.Resize(shared->Points.size());
    part.Uncertainty = GetUncertainty(shared, this->Frame.GetBase());
    const glm::dvec3 ownRounding = this->Scene->Surfaces[this->Base->Surface]->Rounding;
    part.Contact = glm::dot(glm::abs(this->Frame.GetNormal()),
                     part.Uncertainty + RoundingsOfPlane * ownRounding) /
      this->Frame.GetSize();
    if (surface == this->Base->Surface)
    {
      part.Contact += this->Base->Deviation / this->Frame.GetSize(); // of edges that both share
    }
    part.Top = GetTop(shared.GetClusters().GetBounds(), this->Frame) + part.Contact;
  }
  return part;
}

std::uint32_t OccluderSelector::AddPoint(const glm::dvec3& point, const Part& part)
{
  this->Points.push_back(point);
  this->Tops.push_back(part.Top);
  return static_cast<std::uint32_t>(this->Points.size() - 1);
}

std::uint32_t OccluderSelector::GetPlace(Part& part, const Surface& surface, std::uint32_t point)
{
  std::uint32_t& place = part.Places[point];
  if (place == NoPlace)
  {
    place = this->AddPoint(this->Frame.ToFrame(surface.Points[point]), part);
  }
  return place;
}

OccluderSelector::Search OccluderSelector::MakeSearch(
  const LightShape& seen, const glm::dvec4& range) const
{
  const glm::dvec4 inside = range + glm::dvec4(Inset, Inset, -Inset, -Inset);
  Search search{ BlockingRegion(this->Frame, seen, inside), BlockingRegion(this->Frame, seen),
    ShadowProjector(this->Frame, seen), {}, {} };
  search.LightNormal = glm::abs(search.Region.GetLightNormal().value_or(glm::dvec3(0.0)));
  return search;
}

void OccluderSelector::Select(const LightShape& seen, const glm::dvec4& range)
{
  Search search = this->MakeSearch(seen, range);
  search.Planes = search.Region.GetWorldPlanes();
  this->Run(search);
}

void OccluderSelector::SelectAll(const LightShape& seen)
{
  this->Run(this->MakeSearch(seen, { 0.0, 0.0, 1.0, 1.0 }));
}

void OccluderSelector::Run(const Search& search)
{
  this->Selected.clear();
  this->Translucent.clear();
  this->Casters.clear();
  this->PartShadows.clear();
  ++this->Selections;
  this->Surfaces.Visit(search.Planes,
    [&](const ClusterTree::Items& surfaces)
    {
      for (const std::uint32_t s : surfaces)
      {
        this->SelectFrom(s, search);
      }
    });
  // In the scene's order, whatever the tree's is.
  std::sort(this->Casters.begin(), this->Casters.end(),
    [](const Caster& a, const Caster& b) { return a.Surface < b.Surface; });
}

std::vector<Caster> OccluderSelector::GetTranslucentCasters() const
{
  std::vector<Caster> casters;
  std::copy_if(this->Casters.begin(), this->Casters.end(), std::back_inserter(casters),
    [this](const Caster& caster)
    { return this->Scene->Surfaces[caster.Surface]->IsTranslucent(); });
  return casters;
}

void OccluderSelector::SelectFrom(std::size_t index, const Search& search)
{
  const SharedSurface& shared = this->Scene->Surfaces[index];
  const Surface& surface = *shared;
  const bool isReceivers = index == this->Base->Surface;
  if (!surface.CastsShadow())
  {
    return;
  }
  std::vector<Triangle>& selected = surface.IsTranslucent() ? this->Translucent : this->Selected;
  Caster caster;
  caster.Surface = index;
  caster.First = selected.size();
  this->PartPlaces.clear();
  const std::size_t firstPart = this->PartShadows.size();
  shared.GetClusters().Visit(search.Planes,
    [&](const ClusterTree::Items& triangles)
    {
      Part& part = this->GetPart(index);
      caster.Rounding = glm::length(part.Uncertainty) / this->Frame.GetSize();
      for (const std::uint32_t t : triangles)
      {
        if (isReceivers && surface.Regions[t] == this->Base->Region)
        {
          continue;
        }
        const auto& [a, b, c] = surface.Triangles[t];
        const Triangle placed = { this->GetPlace(part, surface, a),
          this->GetPlace(part, surface, b), this->GetPlace(part, surface, c) };
        if (this->MayBlock(placed, part, search))
        {
          const std::uint32_t hanging = this->FindsParts ? shared.GetParts()[t] : 0;
          const std::size_t first = selected.size();
          this->AddTriangle(placed, part, search, selected,
            this->FindsParts ? this->GetPartShadow(hanging).Bounds : caster.Shadow);
          if (this->FindsParts)
          {
            this->NotePart(hanging, first, search, selected);
          }
        }
      }
    });
  caster.Triangles = selected.size() - caster.First;
  for (std::size_t i = firstPart; i < this->PartShadows.size(); ++i)
  {
    caster.Shadow.AddPart(this->PartShadows[i].Bounds);
  }
  if (caster.Triangles > 0)
  {
    this->Casters.push_back(caster);
  }
}

bool OccluderSelector::MayBlock(
  const Triangle& triangle, const Part& part, const Search& search) const
{
  const glm::dvec3 &a = this->Points[triangle[0]], &b = this->Points[triangle[1]],
                   &c = this->Points[triangle[2]];
  return std::max({ a.z, b.z, c.z }) > part.Contact &&
    (search.Planes.empty() || search.Region.MayHold(a, b, c)) && !IsDegenerate(a, b, c) &&
    !search.Region.LiesInLight(a, b, c, glm::dot(search.LightNormal, part.Uncertainty));
}

void OccluderSelector::AddTriangle(const Triangle& triangle, const Part& part, const Search& search,
  std::vector<Triangle>& selected, ShadowBounds& shadow)
{
  const glm::dvec3 a = this->Points[triangle[0]], b = this->Points[triangle[1]],
                   c = this->Points[triangle[2]];
  if (!BlockingRegion::IsFar(a) && !BlockingRegion::IsFar(b) && !BlockingRegion::IsFar(c))
  {
    selected.push_back(triangle);
    for (const std::uint32_t place : triangle)
    {
      this->NotePoint(place, search, shadow);
    }
    return;
  }
  const std::vector<glm::dvec3> polygon = search.Whole.Clip(a, b, c);
  const auto first = static_cast<std::uint32_t>(this->Points.size());
  for (std::uint32_t i = 0; i < polygon.size(); ++i)
  {
    this->NotePoint(this->AddPoint(polygon[i], part), search, shadow);
    if (i > 0 && i + 1 < polygon.size())
    {
      selected.push_back({ first, first + i, first + i + 1 });
    }
  }
}

void OccluderSelector::NotePoint(std::uint32_t place, const Search& search, ShadowBounds& shadow)
{
  this->NotedBy.resize(this->Points.size(), 0);
  if (this->NotedBy[place] != this->Selections)
  {
    this->NotedBy[place] = this->Selections;
    search.Projector.Add(this->Points[place], shadow);
  }
}

PartShadow& OccluderSelector::GetPartShadow(std::uint32_t part)
{
  const auto [place, isNew] = this->PartPlaces.try_emplace(part, this->PartShadows.size());
  if (isNew)
  {
    this->PartShadows.emplace_back();
  }
  return this->PartShadows[place->second];
}

void OccluderSelector::NotePart(std::uint32_t part, std::size_t first, const Search& search,
  const std::vector<Triangle>& selected)
{
  PartShadow& shadow = this->GetPartShadow(part);
  for (std::size_t i = first; i < selected.size(); ++i)
  {
    std::array<glm::dvec2, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const glm::dvec3& point = this->Points[selected[i][c]];
      corners[c] = search.Projector.ProjectFromCentre(point);
      shadow.Low = glm::min(shadow.Low, corners[c]);
      shadow.High = glm::max(shadow.High, corners[c]);
      shadow.Lowest = std::min(shadow.Lowest, point.z);
      shadow.Highest = std::max(shadow.Highest, point.z);
    }
    const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    shadow.Area += 0.5 * std::abs(a.x * b.y - a.y * b.x);
  }
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonVisibility.h"

#include "OccluderSelector.h"
#include "PolygonLight.h"
#include "ReceiverFrame.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra
{
namespace
{

/// What is this near to a plane, as a part of the numbers that its distance is computed of, is on
/// it: slivers of rounding are no pieces.
constexpr double Slack = 1e-13;

/// A form factor that is a smaller part of what it is summed up from has lost half of its digits:
/// the light is too far away for its size, or seen from its edge.
constexpr double SmallestSum = 1e-8;

/// The sum of the components' sizes: a bound on the length that needs no root.
double GetBound(const glm::dvec3& v)
{
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/**
 * What a triangle hides from a point: what is inside the three planes through its edges and the
 * point, and beyond its own plane. In the base of its corners, as seen from the point, d has the
 * coordinates (b x c . d, c x a . d, a x b . d) / (a . b x c).
 */
class ShadowVolume
{
public:
  static constexpr int Planes = 4;

  ShadowVolume(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& point)
    : Corners{ triangle[0] - point, triangle[1] - point, triangle[2] - point }
    , First(glm::cross(this->Corners[1], this->Corners[2]))
    , Determinant(glm::dot(this->Corners[0], this->First))
  {
  }

  /// Positive or negative for the two sides that the point may see of the triangle; 0 if it is no
  /// farther from the triangle's plane than `rounding`, or than these numbers round.
  double GetSide(double rounding) const
  {
    const auto& [a, b, c] = this->Corners;
    const double inPlane = std::max(
      Slack * GetBound(a) * GetBound(this->First), rounding * GetBound(glm::cross(b - a, c - a)));
    return std::abs(this->Determinant) > inPlane ? this->Determinant : 0.0;
  }

  /// Of a point in the triangle's plane: whether it is no farther than that from the triangle.
  bool IsTouched(double rounding) const
  {
    const auto& [a, b, c] = this->Corners;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const auto isInside = [&](const glm::dvec3& p, const glm::dvec3& q)
    {
      const double size = rounding * GetBound(q - p) + Slack * GetBound(p) * GetBound(q);
      return glm::dot(glm::cross(p, q), normal) >= -size * GetBound(normal);
    };
    return isInside(a, b) && isInside(b, c) && isInside(c, a);
  }

  /// The normal of a plane, to the inside, times a size that all points share.
  glm::dvec3 GetNormal(int plane) const
  {
    const auto& [a, b, c] = this->Corners;
    glm::dvec3 normal = this->First;
    switch (plane)
    {
      case 0:
        break;
      case 1:
        normal = glm::cross(c, a);
        break;
      case 2:
        normal = glm::cross(a, b);
        break;
      default:
        normal = glm::cross(b - a, c - a);
        break;
    }
    return this->Determinant < 0.0 ? -normal : normal;
  }

  /// How far inside the point that looks is, in that size: 0 but for the triangle's own plane.
  double GetOwnDepth(int plane) const
  {
    return plane + 1 < Planes ? 0.0 : -std::abs(this->Determinant);
  }

private:
  std::array<glm::dvec3, 3> Corners;
  glm::dvec3 First;
  double Determinant;
};

/// A convex piece of the light, in its plane. The planner cuts polygons, too, of any number of
/// vertices, once for a light and a receiver; here a texel does it, so that nothing is allocated.
struct Piece
{
  static constexpr std::size_t Capacity = 12;
  std::size_t Count = 0; ///< greater than Capacity: the piece is too complex, and not there
  std::array<glm::dvec2, Capacity> Vertices;

  void Add(const glm::dvec2& vertex)
  {
    if (this->Count < Capacity)
    {
      this->Vertices[this->Count] = vertex;
    }
    ++this->Count;
  }
};

/// Where a linear form of the points of a plane is positive.
struct HalfPlane
{
  double Offset;
  glm::dvec2 Slope;
  double OnLine; ///< up to this much from 0 is 0

  double At(const glm::dvec2& p) const { return this->Offset + glm::dot(this->Slope, p); }
};
using Shadow = std::array<HalfPlane, ShadowVolume::Planes>;

/// Whether the piece has vertices inside and outside.
std::pair<bool, bool> FindSides(const Piece& piece, const HalfPlane& half)
{
  bool inside = false, outside = false;
  for (std::size_t i = 0; i < piece.Count; ++i)
  {
    const double depth = half.At(piece.Vertices[i]);
    inside = inside || depth > half.OnLine;
    outside = outside || depth < -half.OnLine;
  }
  return { inside, outside };
}

/// The parts of a piece inside and outside (Sutherland and Hodgman 1974).
std::pair<Piece, Piece> Split(const Piece& piece, const HalfPlane& half)
{
  std::pair<Piece, Piece> parts;
  auto& [inside, outside] = parts;
  glm::dvec2 p = piece.Vertices[piece.Count - 1];
  double depthOfP = half.At(p);
  for (std::size_t i = 0; i < piece.Count; ++i)
  {
    const glm::dvec2 q = piece.Vertices[i];
    const double depth = half.At(q);
    if ((depthOfP < 0.0 && depth > 0.0) || (depthOfP > 0.0 && depth < 0.0))
    {
      const glm::dvec2 cut = p + depthOfP / (depthOfP - depth) * (q - p);
      inside.Add(cut);
      outside.Add(cut);
    }
    if (depth >= 0.0)
    {
      inside.Add(q);
    }
    if (depth <= 0.0)
    {
      outside.Add(q);
    }
    p = q;
    depthOfP = depth;
  }
  return parts;
}

/// What is left of the light.
class Pieces
{
public:
  explicit Pieces(const Piece& whole)
    : All{ whole }
  {
  }

  const std::vector<Piece>& Get() const { return this->All; }

  /// False if what the shadow leaves is too complex.
  bool Subtract(const Shadow& shadow)
  {
    for (std::size_t i = this->All.size(); i > 0; --i)
    {
      if (!this->SubtractFrom(i - 1, shadow))
      {
        return false;
      }
    }
    return this->All.size() <= PolygonVisibility::MaximumPieces;
  }

private:
  /// Replaces a piece by what the shadow leaves of it, up to four pieces; those after it stay, but
  /// for their order.
  bool SubtractFrom(std::size_t index, const Shadow& shadow)
  {
    std::array<bool, ShadowVolume::Planes> cuts{};
    for (std::size_t plane = 0; plane < shadow.size(); ++plane)
    {
      const auto [hasInside, hasOutside] = FindSides(this->All[index], shadow[plane]);
      if (!hasInside)
      {
        return true;
      }
      cuts[plane] = hasOutside;
    }
    const std::size_t before = this->All.size();
    Piece rest = this->All[index];
    for (std::size_t plane = 0; plane < shadow.size(); ++plane)
    {
      const auto [hasInside, hasOutside] =
        cuts[plane] ? FindSides(rest, shadow[plane]) : std::pair(true, false);
      if (!hasInside)
      {
        this->All.resize(before); // the shadow passes the piece after all
        return true;
      }
      if (hasOutside)
      {
        const auto [inside, outside] = Split(rest, shadow[plane]);
        if (std::max(inside.Count, outside.Count) > Piece::Capacity)
        {
          return false;
        }
        this->All.push_back(outside);
        rest = inside;
      }
    }
    this->All[index] = this->All.back();
    this->All.pop_back();
    return true;
  }

  std::vector<Piece> All;
};

/// A light as seen from a point of the receiver.
struct View
{
  glm::dvec3 Origin, AxisX, AxisY; ///< of the light's plane
  std::vector<glm::dvec3> Vertices;
  double Reach = 0.0; ///< of the vertices, in GetBound()'s sense

  /// The shadow on the light's plane; none if it misses the light.
  std::optional<Shadow> Cast(const ShadowVolume& volume) const
  {
    Shadow shadow;
    for (int plane = 0; plane < ShadowVolume::Planes; ++plane)
    {
      const glm::dvec3 normal = volume.GetNormal(plane);
      const double own = volume.GetOwnDepth(plane);
      const double onPlane = Slack * GetBound(normal) * this->Reach;
      const bool isInside = std::any_of(this->Vertices.begin(), this->Vertices.end(),
        [&](const glm::dvec3& d) { return glm::dot(normal, d) + own > onPlane; });
      if (!isInside)
      {
        return std::nullopt;
      }
      shadow[static_cast<std::size_t>(plane)] = { glm::dot(normal, this->Origin) + own,
        { glm::dot(normal, this->AxisX), glm::dot(normal, this->AxisY) }, onPlane };
    }
    return shadow;
  }

  /// Lambert's formula (Photometria, 1760), up to a factor: the form factor of a piece, and what it
  /// is rounded as a part of, the angles of the piece's edges.
  std::pair<double, double> SumOverEdges(const Piece& piece) const
  {
    const auto at = [&](std::size_t i) {
      return this->Origin + piece.Vertices[i].x * this->AxisX + piece.Vertices[i].y * this->AxisY;
    };
    double sum = 0.0, angles = 0.0;
    glm::dvec3 p = at(piece.Count - 1);
    for (std::size_t i = 0; i < piece.Count; ++i)
    {
      const glm::dvec3 q = at(i);
      const glm::dvec3 cross = glm::cross(p, q - p);
      const double length = glm::length(cross);
      if (length > 0.0)
      {
        const double angle = std::atan2(length, glm::dot(p, q));
        sum += angle * cross.z / length;
        angles += angle;
      }
      p = q;
    }
    return { std::abs(sum), angles };
  }
};

} // namespace

PolygonVisibility::PolygonVisibility(
  const ReceiverFrame& frame, const PolygonLight& seen, const OccluderSelector& occluders)
{
  const Parallelogram& base = frame.GetBase();
  this->ToMetric = glm::dmat3(frame.DirectionToMetric(base.EdgeX),
    frame.DirectionToMetric(base.EdgeY), glm::dvec3(0.0, 0.0, 1.0));
  for (const glm::dvec3& vertex : seen.GetVertices())
  {
    this->Vertices.push_back(frame.ToMetric(vertex));
  }
  // Where a plane cut a corner off, an edge may be mere rounding.
  glm::dvec3 longest(0.0);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    const glm::dvec3 edge = this->Vertices[(i + 1) % this->Vertices.size()] - this->Vertices[i];
    longest = glm::length(edge) > glm::length(longest) ? edge : longest;
  }
  const glm::dvec3 normal = glm::normalize(frame.DirectionToMetric(seen.GetNormal()));
  this->AxisX = glm::normalize(longest);
  this->AxisY = glm::cross(normal, this->AxisX);
  for (const glm::dvec3& vertex : this->Vertices)
  {
    const glm::dvec3 d = vertex - this->Vertices[0];
    this->Outline.emplace_back(glm::dot(d, this->AxisX), glm::dot(d, this->AxisY));
  }
  // In the scene's order: that of the selection depends on what else there is.
  const std::vector<glm::dvec3>& points = occluders.GetPoints();
  const auto place = [&](std::uint32_t i)
  { return this->ToMetric * (points[i] - glm::dvec3(0.5, 0.5, 0.0)); };
  for (const Caster& caster : occluders.GetCasters())
  {
    for (std::size_t t = 0; t < caster.Triangles; ++t)
    {
      const auto& [a, b, c] = occluders.GetTriangles()[caster.First + t];
      this->Triangles.push_back({ { place(a), place(b), place(c) }, caster.Rounding });
    }
  }
}

glm::dvec3 PolygonVisibility::GetPlace(const glm::dvec2& uv) const
{
  return this->ToMetric * glm::dvec3(uv - 0.5, 0.0);
}

PolygonVisibility::Indices PolygonVisibility::FindNear(
  const glm::dvec2& low, const glm::dvec2& high) const
{
  const std::array<glm::dvec3, 4> corners = { this->GetPlace(low),
    this->GetPlace({ high.x, low.y }), this->GetPlace({ low.x, high.y }), this->GetPlace(high) };
  // For one point of the light, how far inside a plane it is is an affine function of the point
  // that looks, as long as that sees the same side of the triangle: what is outside for all
  // corners is so for all points between them. From within the triangle's plane, no side is seen.
  const auto mayBlock = [&](const Triangle& triangle)
  {
    std::array<bool, ShadowVolume::Planes> isInside{};
    double side = 0.0;
    for (const glm::dvec3& corner : corners)
    {
      const ShadowVolume volume(triangle.Corners, corner);
      const double own = volume.GetSide(triangle.Rounding);
      if (own == 0.0 || own * side < 0.0)
      {
        return true;
      }
      side = own;
      for (int plane = 0; plane < ShadowVolume::Planes; ++plane)
      {
        bool& inside = isInside[static_cast<std::size_t>(plane)];
        const glm::dvec3 normal = volume.GetNormal(plane);
        const double ownDepth = volume.GetOwnDepth(plane);
        inside = inside ||
          std::any_of(this->Vertices.begin(), this->Vertices.end(),
            [&](const glm::dvec3& vertex)
            {
              const glm::dvec3 d = vertex - corner;
              return glm::dot(normal, d) + ownDepth > -Slack * GetBound(normal) * GetBound(d);
            });
      }
    }
    return std::all_of(isInside.begin(), isInside.end(), [](bool inside) { return inside; });
  };
  Indices nearby;
  for (std::uint32_t i = 0; i < this->Triangles.size(); ++i)
  {
    if (mayBlock(this->Triangles[i]))
    {
      nearby.push_back(i);
    }
  }
  return nearby;
}

std::optional<double> PolygonVisibility::FindShare(
  const glm::dvec2& place, const Indices& nearby) const
{
  const glm::dvec3 x = this->GetPlace(place);
  View view{ this->Vertices[0] - x, this->AxisX, this->AxisY, {}, 0.0 };
  Piece whole;
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    view.Vertices.push_back(this->Vertices[i] - x);
    view.Reach = std::max(view.Reach, GetBound(view.Vertices.back()));
    whole.Add(this->Outline[i]);
  }
  const auto [all, angles] =
    whole.Count <= Piece::Capacity ? view.SumOverEdges(whole) : std::pair(0.0, 0.0);
  if (!(all > SmallestSum * angles))
  {
    return std::nullopt;
  }
  Pieces pieces(whole);
  for (const std::uint32_t i : nearby)
  {
    const auto& [corners, rounding] = this->Triangles[i];
    const ShadowVolume volume(corners, x);
    if (volume.GetSide(rounding) == 0.0)
    {
      if (volume.IsTouched(rounding))
      {
        return std::nullopt; // is the point under a box or beside it?
      }
      continue; // what is seen from its edge hides nothing
    }
    const std::optional<Shadow> shadow = view.Cast(volume);
    if (shadow && !pieces.Subtract(*shadow))
    {
      return std::nullopt;
    }
  }
  double visible = 0.0;
  for (const Piece& piece : pieces.Get())
  {
    visible += view.SumOverEdges(piece).first;
  }
  return std::min(visible / all, 1.0);
}

} // namespace penumbra

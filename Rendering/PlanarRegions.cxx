// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarRegions.h"

#include "Coordinates.h"
#include "ParallelogramFit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <tuple>

namespace penumbra
{
namespace
{

/// Neighbours that bend by less are meant to be coplanar, if their points say so too.
const double CoplanarAngle = glm::radians(1.0);
const double FeatureAngle = glm::radians(29.99); // 30 degrees, if rounded
/// A polygon that is thinner than this share of its length has no normal worth comparing.
constexpr double SliverTolerance = 1e-4;

/// Newell's method: the vector area of a polygon, planar or not; 0 if it is too small to tell.
glm::dvec3 AreaVector(const PolygonMesh& mesh, const std::vector<int>& polygon)
{
  const auto point = [&](std::size_t i)
  { return mesh.Points[static_cast<std::size_t>(polygon[i % polygon.size()])]; };
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
  {
    sum += 0.5 * glm::cross(point(i) - point(0), point(i + 1) - point(0));
  }
  return glm::length(sum) >= SmallestArea ? sum : glm::dvec3(0.0);
}

double LongestEdge(const PolygonMesh& mesh, const std::vector<int>& polygon)
{
  double longest = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const auto a = static_cast<std::size_t>(polygon[i]);
    const auto b = static_cast<std::size_t>(polygon[(i + 1) % polygon.size()]);
    longest = std::max(longest, glm::length(mesh.Points[b] - mesh.Points[a]));
  }
  return longest;
}

/// Disjoint sets of polygons, each with the polygon of the largest area to stand for it.
class DisjointSets
{
public:
  explicit DisjointSets(const std::vector<glm::dvec3>& areas)
    : Areas(areas)
    , Parent(areas.size())
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  int Find(int i)
  {
    while (this->At(i) != i)
    {
      this->At(i) = this->At(this->At(i));
      i = this->At(i);
    }
    return i;
  }
  void Unite(int a, int b)
  {
    a = this->Find(a);
    b = this->Find(b);
    const bool aIsLarger = this->GetArea(a) >= this->GetArea(b);
    this->At(aIsLarger ? b : a) = aIsLarger ? a : b;
  }

private:
  int& At(int i) { return this->Parent[static_cast<std::size_t>(i)]; }
  double GetArea(int i) const { return glm::length(this->Areas[static_cast<std::size_t>(i)]); }
  const std::vector<glm::dvec3>& Areas;
  std::vector<int> Parent;
};

/// An edge of a polygon: its points, the lower first.
struct Edge
{
  std::pair<int, int> Points;
  int Polygon;
};

/// The edges of all polygons that have an area and are no copies; those between the same points
/// stand side by side.
std::vector<Edge> FindEdges(
  const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, const std::vector<int>& originals)
{
  std::vector<Edge> edges;
  for (std::size_t p = 0; p < mesh.Polygons.size(); ++p)
  {
    const std::vector<int>& polygon = mesh.Polygons[p];
    const bool counts = glm::length(areas[p]) > 0.0 && originals[p] == static_cast<int>(p);
    for (std::size_t i = 0; i < polygon.size() && counts; ++i)
    {
      const std::pair<int, int> ends = std::minmax(polygon[i], polygon[(i + 1) % polygon.size()]);
      edges.push_back({ ends, static_cast<int>(p) });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const Edge& a, const Edge& b)
    { return std::tie(a.Points, a.Polygon) < std::tie(b.Points, b.Polygon); });
  return edges;
}

/// How far a polygon's normal may be off by the rounding of its points, in radians.
double NormalError(const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, int p)
{
  const auto i = static_cast<std::size_t>(p);
  return 2.0 * mesh.Rounding * LongestEdge(mesh, mesh.Polygons[i]) / glm::length(areas[i]);
}

bool IsSliver(const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, int p)
{
  const auto i = static_cast<std::size_t>(p);
  const double length = LongestEdge(mesh, mesh.Polygons[i]);
  return glm::length(areas[i]) < (SliverTolerance * length + mesh.Rounding) * length;
}

/// The angle between two polygons' planes, whichever way they are wound, that rounding does not
/// explain; 0 where one is a sliver.
double BendAngle(const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, int a, int b)
{
  if (IsSliver(mesh, areas, a) || IsSliver(mesh, areas, b))
  {
    return 0.0;
  }
  const glm::dvec3& areaA = areas[static_cast<std::size_t>(a)];
  const glm::dvec3& areaB = areas[static_cast<std::size_t>(b)];
  const double angle =
    std::atan2(glm::length(glm::cross(areaA, areaB)), std::abs(glm::dot(areaA, areaB)));
  return std::max(0.0, angle - NormalError(mesh, areas, a) - NormalError(mesh, areas, b));
}

std::string DescribeBend(int a, int b, double angle)
{
  std::ostringstream text;
  text << "polygons " << a << " and " << b << " meet at an angle of " << glm::degrees(angle)
       << " degrees; allowed: coplanar neighbours, or edges of 30 degrees and more as a box has; "
          "or ProxyPlane on, which approximates";
  return text.str();
}

/// Calls visit() for all pairs of polygons that share an edge.
template <typename Visitor>
void VisitNeighbours(const std::vector<Edge>& edges, Visitor&& visit)
{
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    for (std::size_t j = i + 1; j < edges.size() && edges[j].Points == edges[i].Points; ++j)
    {
      visit(edges[i].Polygon, edges[j].Polygon);
    }
  }
}

/// A polygon's points from the lowest one on, towards the lower neighbour: the same for all copies
/// of a polygon, wherever they begin and whichever way they go.
std::vector<int> GetCanonicalOrder(std::vector<int> polygon)
{
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  if (polygon.size() > 2 && polygon.back() < polygon[1])
  {
    std::reverse(polygon.begin() + 1, polygon.end());
  }
  return polygon;
}

/// Of each polygon, the first one that it is a copy of: mostly itself. Edges of copies alone would
/// meet each other in k^2 pairs.
std::vector<int> FindOriginals(const PolygonMesh& mesh)
{
  std::vector<int> originals;
  std::map<std::vector<int>, int> first;
  for (const std::vector<int>& polygon : mesh.Polygons)
  {
    const int index = static_cast<int>(originals.size());
    originals.push_back(first.emplace(GetCanonicalOrder(polygon), index).first->second);
  }
  return originals;
}

/// Two polygons that meet at an edge, and the angle at which they do.
struct Bend
{
  int A, B;
  double Angle;
};

/// Puts coplanar polygons with a common edge into one set; the answer is the bends that are left.
std::vector<Bend> UniteCoplanarNeighbours(
  const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, DisjointSets& sets)
{
  const std::vector<int> originals = FindOriginals(mesh);
  for (std::size_t p = 0; p < originals.size(); ++p)
  {
    sets.Unite(originals[p], static_cast<int>(p));
  }
  const std::vector<Edge> edges = FindEdges(mesh, areas, originals);
  std::vector<std::pair<int, int>> slivers;
  std::vector<Bend> bends;
  VisitNeighbours(edges,
    [&](int a, int b)
    {
      const double angle = BendAngle(mesh, areas, a, b);
      if (IsSliver(mesh, areas, a) || IsSliver(mesh, areas, b))
      {
        slivers.emplace_back(a, b);
      }
      else if (angle <= CoplanarAngle)
      {
        sets.Unite(a, b);
      }
      else
      {
        bends.push_back({ a, b, angle });
      }
    });
  // A sliver goes with whatever it touches, but does not join a floor to a wall.
  for (const auto& [a, b] : slivers)
  {
    if (BendAngle(mesh, areas, sets.Find(a), sets.Find(b)) <= CoplanarAngle)
    {
      sets.Unite(a, b);
    }
  }
  return bends;
}

/// The unit normal of the side to which more of the region's area points.
glm::dvec3 RegionNormal(const std::vector<glm::dvec3>& areas, const std::vector<int>& polygons)
{
  const auto area = [&](int p) { return areas[static_cast<std::size_t>(p)]; };
  const int largest = *std::max_element(polygons.begin(), polygons.end(),
    [&](int a, int b) { return glm::length(area(a)) < glm::length(area(b)); });
  glm::dvec3 sum(0.0);
  double balance = 0.0;
  for (const int p : polygons)
  {
    const double sign = glm::dot(area(p), area(largest)) < 0.0 ? -1.0 : 1.0;
    sum += sign * area(p);
    balance += sign * glm::length(area(p));
  }
  return glm::normalize(balance < 0.0 ? -sum : sum);
}

/// The polygons' points, each once.
std::vector<glm::dvec3> GetPoints(const PolygonMesh& mesh, const std::vector<int>& polygons)
{
  std::vector<int> ids;
  for (const int p : polygons)
  {
    const std::vector<int>& polygon = mesh.Polygons[static_cast<std::size_t>(p)];
    ids.insert(ids.end(), polygon.begin(), polygon.end());
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<glm::dvec3> points;
  for (const int id : ids)
  {
    points.push_back(mesh.Points[static_cast<std::size_t>(id)]);
  }
  return points;
}

/// The plane of some polygons.
struct Plane
{
  glm::dvec3 Mean{ 0.0 }; ///< of the points
  glm::dvec3 Normal{ 0.0 };
  double Extent = 0.0;
  double Stray = 0.0; ///< how far the farthest of its own points is off

  double GetHeight(const glm::dvec3& p) const { return std::abs(glm::dot(p - Mean, Normal)); }
};

Plane FindPlane(
  const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, const std::vector<int>& polygons)
{
  const std::vector<glm::dvec3> points = GetPoints(mesh, polygons);
  Plane plane;
  for (const glm::dvec3& point : points)
  {
    plane.Mean += (point - points.front()) / static_cast<double>(points.size());
  }
  plane.Mean += points.front();
  plane.Normal = RegionNormal(areas, polygons);
  for (const glm::dvec3& point : points)
  {
    plane.Extent = std::max(plane.Extent, 2.0 * glm::length(point - plane.Mean));
    plane.Stray = std::max(plane.Stray, plane.GetHeight(point));
  }
  return plane;
}

double GetTolerance(const PolygonMesh& mesh, const Plane& plane)
{
  return 2.0 * mesh.Rounding +
    (mesh.Tolerance > 0.0 ? mesh.Tolerance : AutomaticPlanarity * plane.Extent);
}

/// The polygons of a plane, or what remains of one that another has taken in.
struct Part
{
  std::vector<int> Polygons;
  Plane Shape;
  std::vector<std::size_t> Neighbours; ///< those that it bends to by less than a box does
  bool IsTaken = false;
};

/// Whether `part` lies in the plane, and has a normal that is no surer than what it differs by.
bool Explains(const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, const Plane& plane,
  const Part& part)
{
  const double tolerance = GetTolerance(mesh, plane);
  const double cosine = std::abs(glm::dot(plane.Normal, part.Shape.Normal));
  const double angle = std::acos(std::min(1.0, cosine));
  double area = 0.0;
  for (const int p : part.Polygons)
  {
    area += glm::length(areas[static_cast<std::size_t>(p)]);
  }
  const double uncertainty = 2.0 * tolerance * part.Shape.Extent / area;
  if (angle - uncertainty > CoplanarAngle)
  {
    return false;
  }
  const std::vector<glm::dvec3> points = GetPoints(mesh, part.Polygons);
  return std::all_of(points.begin(), points.end(),
    [&](const glm::dvec3& p) { return plane.GetHeight(p) <= tolerance; });
}

/// Lets the largest parts take in neighbours that the tolerance explains. On a curve the parts that
/// are left still bend to each other, by which it is known as one (FindCurved).
void TakeInNeighbours(
  const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, std::vector<Part>& parts)
{
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return parts[a].Shape.Extent > parts[b].Shape.Extent; });
  for (const std::size_t seed : order)
  {
    const Plane plane = parts[seed].Shape;
    if (parts[seed].IsTaken || plane.Stray > GetTolerance(mesh, plane))
    {
      continue;
    }
    std::vector<std::size_t> open = parts[seed].Neighbours;
    while (!open.empty())
    {
      const std::size_t next = open.back();
      open.pop_back();
      Part& part = parts[next];
      if (next == seed || part.IsTaken || part.Shape.Extent > plane.Extent ||
        !Explains(mesh, areas, plane, part))
      {
        continue;
      }
      part.IsTaken = true;
      std::vector<int>& all = parts[seed].Polygons;
      all.insert(all.end(), part.Polygons.begin(), part.Polygons.end());
      open.insert(open.end(), part.Neighbours.begin(), part.Neighbours.end());
    }
    std::sort(parts[seed].Polygons.begin(), parts[seed].Polygons.end());
  }
}

/// Fits the region's parallelogram; the answer is empty or what is wrong with it.
std::string FitRegion(
  const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas, PlanarRegion& region)
{
  const Plane plane = FindPlane(mesh, areas, region.Polygons);
  const double tolerance = GetTolerance(mesh, plane);
  if (plane.Stray > tolerance)
  {
    std::ostringstream text;
    text << "it is not planar: the points of the region around polygon " << region.Polygons.front()
         << " stray by " << plane.Stray << " from its plane; allowed: " << tolerance
         << "; or a larger PlanarityTolerance, or ProxyPlane on, which approximates";
    return text.str();
  }
  const std::vector<glm::dvec3> points = GetPoints(mesh, region.Polygons);
  const std::optional<FittedParallelogram> base =
    FitParallelogram(points, plane.Normal, mesh.Rounding);
  if (!base)
  {
    return "its points lie on a line; allowed: polygons that span an area";
  }
  region.Base = *base;
  region.IsTriangle = base->IsTriangle;
  if (plane.Stray > ExactPlanarity * plane.Extent + 2.0 * mesh.Rounding)
  {
    const glm::dvec3 normal = glm::normalize(glm::cross(base->EdgeX, base->EdgeY));
    for (const glm::dvec3& point : points)
    {
      region.Deviation =
        std::max(region.Deviation, std::abs(glm::dot(point - base->Corner, normal)));
    }
  }
  return "";
}

/// The sets of coplanar polygons, in the order of their first ones; `partOf` gets that of each
/// polygon that has an area.
std::vector<Part> MakeParts(const PolygonMesh& mesh, const std::vector<glm::dvec3>& areas,
  DisjointSets& sets, std::vector<std::size_t>& partOf)
{
  std::vector<Part> parts;
  std::map<int, std::size_t> partOfSet;
  partOf.assign(mesh.Polygons.size(), 0);
  for (std::size_t p = 0; p < mesh.Polygons.size(); ++p)
  {
    if (glm::length(areas[p]) > 0.0)
    {
      partOf[p] = partOfSet.emplace(sets.Find(static_cast<int>(p)), parts.size()).first->second;
      parts.resize(std::max(parts.size(), partOf[p] + 1));
      parts[partOf[p]].Polygons.push_back(static_cast<int>(p));
    }
  }
  for (Part& part : parts)
  {
    part.Shape = FindPlane(mesh, areas, part.Polygons);
  }
  return parts;
}

/// Of each polygon, the bend that makes its part curved, or -1.
std::vector<int> FindCurved(
  const std::vector<Bend>& bends, const std::vector<Part>& parts, std::size_t polygons)
{
  std::vector<int> owner(polygons, -1);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    for (const int p : parts[i].Polygons)
    {
      owner[static_cast<std::size_t>(p)] =
        parts[i].IsTaken ? owner[static_cast<std::size_t>(p)] : static_cast<int>(i);
    }
  }
  std::vector<int> curvedBy(parts.size(), -1);
  for (std::size_t i = 0; i < bends.size(); ++i)
  {
    const int a = owner[static_cast<std::size_t>(bends[i].A)];
    const int b = owner[static_cast<std::size_t>(bends[i].B)];
    if (bends[i].Angle < FeatureAngle && a != b)
    {
      curvedBy[static_cast<std::size_t>(a)] = static_cast<int>(i);
      curvedBy[static_cast<std::size_t>(b)] = static_cast<int>(i);
    }
  }
  return curvedBy;
}

/// An edge of a polygon: its points, the lower first, and whether it runs from the lower.
struct HalfEdge
{
  std::pair<int, int> Points;
  bool IsForward;
  int Polygon;
};

/// The edges of all polygons; those between the same points stand side by side.
std::vector<HalfEdge> FindHalfEdges(const PolygonMesh& mesh)
{
  std::vector<HalfEdge> edges;
  for (std::size_t p = 0; p < mesh.Polygons.size(); ++p)
  {
    const std::vector<int>& polygon = mesh.Polygons[p];
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const int a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if (a != b)
      {
        edges.push_back({ std::minmax(a, b), a < b, static_cast<int>(p) });
      }
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const HalfEdge& a, const HalfEdge& b)
    { return std::tie(a.Points, a.Polygon) < std::tie(b.Points, b.Polygon); });
  return edges;
}

/// A connected part of a mesh: its bounds, and the volume inside it if it is closed.
struct SurfacePart
{
  glm::dvec3 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec3 High{ -std::numeric_limits<double>::infinity() };
  glm::dvec3 Origin{ 0.0 }; ///< one of its points: volumes far from the world's lose nothing
  double Volume = 0.0;      ///< positive if the polygons' fronts are outside
  bool IsEmpty = true;
  bool IsClosed = true;

  void Add(const PolygonMesh& mesh, const std::vector<int>& polygon)
  {
    for (const int i : polygon)
    {
      const glm::dvec3& point = mesh.Points[static_cast<std::size_t>(i)];
      this->Origin = this->IsEmpty ? point : this->Origin;
      this->IsEmpty = false;
      this->Low = glm::min(this->Low, point);
      this->High = glm::max(this->High, point);
    }
    if (!polygon.empty())
    {
      const glm::dvec3& point = mesh.Points[static_cast<std::size_t>(polygon.front())];
      this->Volume += glm::dot(point - this->Origin, AreaVector(mesh, polygon));
    }
  }
};

/// The parts of a mesh whose polygons are connected by edges.
class SurfaceParts
{
public:
  explicit SurfaceParts(const PolygonMesh& mesh)
    : Parents(mesh.Polygons.size())
    , Parts(mesh.Polygons.size())
  {
    std::iota(this->Parents.begin(), this->Parents.end(), 0);
    const std::vector<HalfEdge> edges = FindHalfEdges(mesh);
    for (std::size_t i = 1; i < edges.size(); ++i)
    {
      if (edges[i].Points == edges[i - 1].Points)
      {
        this->Parents[this->Find(edges[i].Polygon)] =
          static_cast<int>(this->Find(edges[i - 1].Polygon));
      }
    }
    for (std::size_t p = 0; p < mesh.Polygons.size(); ++p)
    {
      this->Parts[this->Find(static_cast<int>(p))].Add(mesh, mesh.Polygons[p]);
    }
    this->FindOpenOnes(edges);
  }

  const SurfacePart& Get(int polygon) { return this->Parts[this->Find(polygon)]; }

private:
  std::size_t Find(int polygon)
  {
    auto i = static_cast<std::size_t>(polygon);
    while (static_cast<std::size_t>(this->Parents[i]) != i)
    {
      this->Parents[i] = this->Parents[static_cast<std::size_t>(this->Parents[i])];
      i = static_cast<std::size_t>(this->Parents[i]);
    }
    return i;
  }

  /// Those with an edge that does not have two polygons, one along each of its directions.
  void FindOpenOnes(const std::vector<HalfEdge>& edges)
  {
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end)
    {
      int forward = 0;
      for (end = begin; end < edges.size() && edges[end].Points == edges[begin].Points; ++end)
      {
        forward += edges[end].IsForward ? 1 : 0;
      }
      SurfacePart& part = this->Parts[this->Find(edges[begin].Polygon)];
      part.IsClosed = part.IsClosed && end - begin == 2 && forward == 1;
    }
  }

  std::vector<int> Parents;
  std::vector<SurfacePart> Parts;
};

} // namespace

PlanarRegions FindPlanarRegions(const PolygonMesh& mesh)
{
  PlanarRegions result;
  result.RegionOfPolygon.assign(mesh.Polygons.size(), -1);
  for (const glm::dvec3& point : mesh.Points)
  {
    if (!IsInRange(point))
    {
      result.Problem = NotFiniteProblem;
      return result;
    }
  }
  std::vector<glm::dvec3> areas;
  for (const std::vector<int>& polygon : mesh.Polygons)
  {
    areas.push_back(AreaVector(mesh, polygon));
  }
  DisjointSets sets(areas);
  const std::vector<Bend> bends = UniteCoplanarNeighbours(mesh, areas, sets);
  std::vector<std::size_t> partOf;
  std::vector<Part> parts = MakeParts(mesh, areas, sets, partOf);
  for (const Bend& bend : bends)
  {
    const std::size_t a = partOf[static_cast<std::size_t>(bend.A)];
    const std::size_t b = partOf[static_cast<std::size_t>(bend.B)];
    if (bend.Angle < FeatureAngle)
    {
      parts[a].Neighbours.push_back(b);
      parts[b].Neighbours.push_back(a);
    }
  }
  for (Part& part : parts)
  {
    std::vector<std::size_t>& all = part.Neighbours;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
  TakeInNeighbours(mesh, areas, parts);
  const std::vector<int> curvedBy = FindCurved(bends, parts, mesh.Polygons.size());

  std::string problem;
  std::size_t refused = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    if (parts[i].IsTaken)
    {
      continue;
    }
    PlanarRegion region;
    region.Polygons = parts[i].Polygons;
    const int curved = curvedBy[i];
    const Bend bend = curved < 0 ? Bend{} : bends[static_cast<std::size_t>(curved)];
    const std::string found =
      curved < 0 ? FitRegion(mesh, areas, region) : DescribeBend(bend.A, bend.B, bend.Angle);
    if (!found.empty())
    {
      problem = problem.empty() ? found : problem;
      ++refused;
      continue;
    }
    for (const int p : region.Polygons)
    {
      result.RegionOfPolygon[static_cast<std::size_t>(p)] = static_cast<int>(result.Regions.size());
    }
    result.Regions.push_back(std::move(region));
  }
  if (result.Regions.empty())
  {
    result.Problem = problem.empty() ? NoAreaProblem : problem;
  }
  else if (refused > 0)
  {
    result.Refused = problem +
      (refused > 1 ? " (and " + std::to_string(refused - 1) + " more parts are refused)" : "");
  }
  return result;
}

std::vector<std::optional<ClosedSurface>> FindClosedSurfaces(
  const PolygonMesh& mesh, const PlanarRegions& regions)
{
  SurfaceParts parts(mesh);
  std::vector<std::optional<ClosedSurface>> result;
  for (const PlanarRegion& region : regions.Regions)
  {
    result.emplace_back();
    const int first = region.Polygons.front();
    const SurfacePart& part = parts.Get(first);
    if (part.IsClosed && part.Volume != 0.0)
    {
      const glm::dvec3 area = AreaVector(mesh, mesh.Polygons[static_cast<std::size_t>(first)]);
      const bool isTurned = glm::dot(area, glm::cross(region.Base.EdgeX, region.Base.EdgeY)) < 0.0;
      result.back() = { part.Low, part.High, (part.Volume > 0.0) != isTurned };
    }
  }
  return result;
}

} // namespace penumbra

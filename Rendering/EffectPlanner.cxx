// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EffectPlanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

namespace penumbra
{
namespace
{

/// Points along each edge of a receiver where the peak of its light is looked for.
constexpr int PeakPoints = 5;

constexpr std::array<glm::dvec2, 4> Corners{ { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } };

/// The lights as the receiver sees them: what lies in front of it, with the sides that face it.
std::vector<Light> ClipLights(const std::vector<Light>& lights, const ReceiverFrame& frame)
{
  std::vector<Light> seen;
  for (const Light& light : lights)
  {
    const auto front = light->Clip(frame.GetBase().Corner, frame.GetNormal());
    seen.emplace_back(front->Face(frame.GetBase()));
  }
  return seen;
}

double GetMean(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

/// A lower bound of the peak of the unoccluded radiance, but for the reflectance: the greatest at
/// some points.
double FindPeak(const ReceiverPlan& plan, const ReceiverSettings& settings)
{
  double peak = 0.0;
  for (int i = 0; i < PeakPoints * PeakPoints; ++i)
  {
    const glm::dvec2 uv =
      glm::dvec2(i % PeakPoints, i / PeakPoints) / static_cast<double>(PeakPoints - 1);
    glm::dvec3 arriving = settings.AmbientRadiance;
    for (const Light& light : plan.Lights)
    {
      arriving += light->Irradiance(plan.Frame.ToWorld({ uv, 0.0 }), plan.Frame.GetNormal());
    }
    peak = std::max(peak, GetMean(arriving));
  }
  return peak;
}

/// Leaves out lights that add up to less than the tolerance, the faintest first.
void LeaveOutFaintLights(ReceiverPlan& plan, const ReceiverSettings& settings)
{
  std::vector<double> bounds;
  for (const Light& light : plan.Lights)
  {
    const glm::dvec3 bound = light->GetIrradianceBound(plan.Frame.GetBase());
    bounds.push_back(std::max({ bound.x, bound.y, bound.z }));
  }
  std::vector<std::size_t> order(bounds.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return bounds[a] < bounds[b]; });
  const double allowed = settings.PlannerTolerance * FindPeak(plan, settings);
  double sum = 0.0;
  for (const std::size_t i : order)
  {
    PairPlan& pair = plan.Pairs[i];
    sum += pair.Needed == Effect::None ? 0.0 : bounds[i];
    if (sum > allowed)
    {
      return;
    }
    if (pair.Needed != Effect::None)
    {
      pair = PairPlan();
      pair.Reason = "too faint to matter";
    }
  }
}

// ---- Umbra ----

using Polygon = std::vector<glm::dvec2>;

double GetArea(const Polygon& p)
{
  double area = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i)
  {
    const glm::dvec2 &a = p[i], &b = p[(i + 1) % p.size()];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return area;
}

/// The convex hull, counter-clockwise (Andrew 1979).
Polygon GetHull(Polygon points)
{
  std::sort(points.begin(), points.end(),
    [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  Polygon hull;
  for (int side = 0; side < 2; ++side)
  {
    const std::size_t first = hull.size();
    for (const glm::dvec2& p : points)
    {
      while (hull.size() >= first + 2)
      {
        const glm::dvec2 a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
        if (a.x * b.y - a.y * b.x > 0.0)
        {
          break;
        }
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The part of a convex polygon on one side of the line from a to b: to the left of it, or not.
Polygon CutByLine(const Polygon& polygon, const glm::dvec2& a, const glm::dvec2& b, bool left)
{
  const auto side = [&](const glm::dvec2& p)
  {
    const glm::dvec2 edge = b - a, to = p - a;
    return (left ? 1.0 : -1.0) * (edge.x * to.y - edge.y * to.x);
  };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double atP = side(p), atQ = side(q);
    if (atP >= 0.0)
    {
      kept.push_back(p);
    }
    if ((atP > 0.0 && atQ < 0.0) || (atP < 0.0 && atQ > 0.0))
    {
      kept.push_back(glm::mix(p, q, atP / (atP - atQ)));
    }
  }
  return kept;
}

/// Takes a counter-clockwise triangle away from convex polygons. What is left and has no area, but
/// for rounding, is gone, too.
std::vector<Polygon> Subtract(
  const std::vector<Polygon>& polygons, const Polygon& triangle, double smallestArea)
{
  std::vector<Polygon> left;
  for (const Polygon& polygon : polygons)
  {
    Polygon inside = polygon;
    for (std::size_t i = 0; i < 3 && inside.size() >= 3; ++i)
    {
      const glm::dvec2 &a = triangle[i], &b = triangle[(i + 1) % 3];
      Polygon outside = CutByLine(inside, a, b, false);
      if (outside.size() >= 3 && GetArea(outside) > smallestArea)
      {
        left.push_back(std::move(outside));
      }
      inside = CutByLine(inside, a, b, true);
    }
  }
  return left;
}

/// A plane of triangles, with coordinates of its own.
struct BlockingPlane
{
  glm::dvec3 Origin, Normal, AxisX, AxisY;

  explicit BlockingPlane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    : Origin(a)
    , Normal(glm::normalize(glm::cross(b - a, c - a)))
    , AxisX(glm::normalize(b - a))
    , AxisY(glm::cross(Normal, AxisX))
  {
  }
  double GetSide(const glm::dvec3& p) const { return glm::dot(p - this->Origin, this->Normal); }
  glm::dvec2 GetPlace(const glm::dvec3& p) const
  {
    return { glm::dot(p - this->Origin, this->AxisX), glm::dot(p - this->Origin, this->AxisY) };
  }
};

/// Where the rays between all corners of receiver and light meet the plane; empty if one does not,
/// between its ends.
Polygon FindCrossings(
  const BlockingPlane& plane, const std::vector<glm::dvec3>& lightCorners, bool areDirections)
{
  Polygon crossings;
  for (const glm::dvec2& uv : Corners)
  {
    const glm::dvec3 from(uv, 0.0);
    const double atFrom = plane.GetSide(from);
    for (const glm::dvec3& corner : lightCorners)
    {
      const double step =
        areDirections ? glm::dot(corner, plane.Normal) : plane.GetSide(corner) - atFrom;
      const double t = -atFrom / step;
      if (!(t > 0.0) || !(areDirections ? std::isfinite(t) : t < 1.0))
      {
        return {};
      }
      crossings.push_back(
        plane.GetPlace(areDirections ? from + t * corner : glm::mix(from, corner, t)));
    }
  }
  return crossings;
}

// ---- Reasons ----

std::string Describe(double penumbraTexels)
{
  std::ostringstream text;
  text << "penumbrae up to " << std::ceil(penumbraTexels) << " texels wide";
  return text.str();
}

/// What the reason of an effect that takes samples adds if they are weighed.
std::string DescribeTranslucent(const PairPlan& pair)
{
  return pair.Translucent > 0 ? ", through " + std::to_string(pair.Translucent) +
      " translucent surface" + (pair.Translucent > 1 ? "s" : "")
                              : "";
}

// ---- Occluders ----

/// Notes a surface that may shade the pair.
void AddCaster(const SharedSurface& surface, const TexelRectangle& shadow, PairPlan& pair)
{
  pair.Casters.push_back({ surface, shadow });
  if (surface->IsTranslucent())
  {
    const glm::dvec3& passing = surface->Transmittance;
    ++pair.Translucent;
    pair.IsTinted = pair.IsTinted || passing.x != passing.y || passing.x != passing.z;
  }
}

/// From how many samples on to cut the light along the shadows of the selected occluders: see
/// PairPlan.
int FindExactFrom(
  const LightShape& seen, const ReceiverSettings& settings, const OccluderSelector& occluders)
{
  // Cutting takes some 0.2 to 0.4 us for each triangle near a texel, which are a half of those that
  // may block, or fewer; counting takes 0.01 us for each sample. Who asks for few samples asks for
  // speed.
  constexpr std::size_t SamplesPerTriangle = 8, FewSamples = 512;
  const bool isPossible = settings.Reconstruction && settings.ExactShares &&
    seen.GetEmission() == Emission::Area && seen.GetPolygons().size() == 1 &&
    occluders.GetTranslucent().empty();
  const std::size_t from =
    std::max(SamplesPerTriangle * occluders.GetTriangles().size(), FewSamples);
  constexpr auto Most = static_cast<std::size_t>(ReceiverSettings::MostLightSamples);
  return isPossible && from <= Most ? static_cast<int>(from) : 0;
}

/// What the selected occluders ask for.
void PlanOccluded(const ReceiverPlan& plan, const LightShape& seen, const ShadowScene& scene,
  const ReceiverSettings& settings, const OccluderSelector& occluders, PairPlan& pair)
{
  // Where an accuracy is asked for, nothing is taken for less than it is.
  const double hardTexels = settings.ErrorTolerance > 0.0 ? 0.0 : settings.HardPenumbra;
  ShadowBounds shadow;
  for (const Caster& caster : occluders.GetCasters())
  {
    const TexelRectangle texels = caster.Shadow.GetTexels(plan.Texels);
    AddCaster(scene.Surfaces[caster.Surface], texels, pair);
    pair.Triangles += caster.Triangles;
    shadow.Add(caster.Shadow);
  }
  pair.Shaded = shadow.GetTexels(plan.Texels);
  pair.PenumbraTexels = shadow.GetPenumbraTexels(plan.Texels);
  pair.IsUnbounded = shadow.IsUnbounded;
  if (pair.Shaded.IsEmpty())
  {
    pair.Needed = Effect::Unoccluded;
    pair.Reason = "no shadow reaches the receiver";
  }
  else if (pair.Shaded == WholeRectangle(plan.Texels) &&
    IsWhollyBlocked(plan.Frame, seen, occluders))
  {
    pair.Needed = Effect::Umbra;
    pair.Reason = "an occluder hides all of the light";
  }
  else if (pair.PenumbraTexels <= hardTexels)
  {
    pair.Needed = Effect::Hard;
    pair.Reason = pair.PenumbraTexels > 0.0 ? "no penumbra is wider than HardPenumbra"
                                            : "the light has no extent";
    pair.Reason += DescribeTranslucent(pair);
  }
  else
  {
    pair.Needed = Effect::Soft;
    pair.ExactFrom = FindExactFrom(seen, settings, occluders);
    pair.Reason =
      pair.IsUnbounded ? "an occluder reaches the light's height" : Describe(pair.PenumbraTexels);
    pair.Reason += DescribeTranslucent(pair);
  }
}

/// The shadows of connected parts that a receiver's texels are too large for, and the others.
struct ShadowParts
{
  std::vector<PartShadow> Small;
  std::vector<ShadowBounds> Large;
};

/// Has the small ones among a pair's shadows left to windows.
void TakeSmallParts(
  const ReceiverPlan& plan, const OccluderSelector& occluders, PairPlan& pair, ShadowParts& parts)
{
  if (pair.Needed != Effect::Hard && pair.Needed != Effect::Soft)
  {
    return;
  }
  const std::size_t before = parts.Small.size();
  ShadowBounds large;
  for (const PartShadow& part : occluders.GetParts())
  {
    if (NeedsWindow(part, plan.Frame, plan.Texels))
    {
      parts.Small.push_back(part);
    }
    else
    {
      parts.Large.push_back(part.Bounds);
      large.Add(part.Bounds);
    }
  }
  if (parts.Small.size() > before)
  {
    pair.Shaded = large.GetTexels(plan.Texels);
  }
}

/// All samples on all texels, from all triangles.
void PlanEverything(const ReceiverPlan& plan, const LightShape& seen, const ShadowScene& scene,
  const ReceiverSettings& settings, OccluderSelector& occluders, PairPlan& pair)
{
  occluders.SelectAll(seen);
  pair.Needed = Effect::Soft;
  pair.Shaded = WholeRectangle(plan.Texels);
  pair.IsUnbounded = true;
  for (const Caster& caster : occluders.GetCasters())
  {
    AddCaster(scene.Surfaces[caster.Surface], pair.Shaded, pair);
    pair.Triangles += caster.Triangles;
  }
  pair.Reason = "the planner is off" + DescribeTranslucent(pair);
  occluders.Select(seen);
  pair.ExactFrom = FindExactFrom(seen, settings, occluders);
}

PairPlan PlanPair(const ReceiverPlan& plan, const LightShape& seen, const ShadowScene& scene,
  const Receiver& receiver, OccluderSelector& occluders)
{
  const ReceiverSettings& settings = receiver.Settings;
  PairPlan pair;
  pair.Needed = PlanEffect(plan.Frame, seen, true);
  if (pair.Needed == Effect::None)
  {
    pair.Reason = !seen.IsValid()        ? "the light is behind the receiver"
      : seen.Radiance == glm::dvec3(0.0) ? "the light is dark"
                                         : "the light faces away";
    return pair;
  }
  pair.Samples = settings.GetSampleCount(seen.GetSolidAngleBound(receiver.Base));
  if (!settings.Planner)
  {
    PlanEverything(plan, seen, scene, settings, occluders, pair);
    return pair;
  }
  occluders.Select(seen);
  if (occluders.GetCasters().empty())
  {
    pair.Needed = Effect::Unoccluded;
    pair.Reason = "no occluder is between them";
    return pair;
  }
  PlanOccluded(plan, seen, scene, settings, occluders, pair);
  return pair;
}

/// Whether a part of a light may be in a box: by the bounds of its hull.
bool MayTouch(const LightShape& light, const ClosedSurface& box)
{
  const LightHull hull = light.GetHull();
  if (hull.AreDirections)
  {
    return false;
  }
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& p : hull.Points)
  {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return glm::all(glm::lessThanEqual(low, box.High)) &&
    glm::all(glm::greaterThanEqual(high, box.Low));
}

} // namespace

const char* GetEffectName(Effect effect)
{
  constexpr const char* names[] = { "None", "Unoccluded", "Umbra", "Hard", "Soft" };
  return names[static_cast<int>(effect)];
}

Effect PlanEffect(const ReceiverFrame& frame, const LightShape& seen, bool hasOccluders)
{
  if (!seen.IsValid() || seen.Radiance == glm::dvec3(0.0))
  {
    return Effect::None;
  }
  // H&H 1997, 3.6, first test: is the receiver's parallelogram entirely behind the light?
  const bool facesReceiver = std::any_of(Corners.begin(), Corners.end(),
    [&](const glm::dvec2& c) {
      return seen.Faces(frame.ToWorld({ c, 0.0 }));
    });
  if (!facesReceiver)
  {
    return Effect::None;
  }
  return hasOccluders ? Effect::Soft : Effect::Unoccluded;
}

bool IsWhollyBlocked(
  const ReceiverFrame& frame, const LightShape& seen, const OccluderSelector& occluders)
{
  const std::vector<glm::dvec3>& points = occluders.GetPoints();
  const std::vector<Surface::Triangle>& triangles = occluders.GetTriangles();
  if (triangles.empty())
  {
    return false;
  }
  const auto isSmaller = [&](const Surface::Triangle& s, const Surface::Triangle& t)
  {
    const auto twiceArea = [&](const Surface::Triangle& u)
    { return glm::length(glm::cross(points[u[1]] - points[u[0]], points[u[2]] - points[u[0]])); };
    return twiceArea(s) < twiceArea(t);
  };
  const Surface::Triangle& largest =
    *std::max_element(triangles.begin(), triangles.end(), isSmaller);
  const BlockingPlane plane(points[largest[0]], points[largest[1]], points[largest[2]]);

  const LightHull hull = seen.GetHull();
  std::vector<glm::dvec3> lightCorners;
  for (const glm::dvec3& p : hull.Points)
  {
    lightCorners.push_back(hull.AreDirections ? frame.DirectionToFrame(p) : frame.ToFrame(p));
  }
  const Polygon places = FindCrossings(plane, lightCorners, hull.AreDirections);
  const Polygon crossings = places.empty() ? Polygon() : GetHull(places);
  if (crossings.size() < 3)
  {
    return false;
  }
  // What is left of a share of a billionth is rounding; many pieces mean a plane full of holes.
  const double smallestArea = 1e-9 * GetArea(crossings);
  constexpr double Rounding = 1e-12;
  constexpr std::size_t MostPieces = 64;
  std::vector<Polygon> open{ crossings };
  for (const Surface::Triangle& t : triangles)
  {
    Polygon corners;
    bool isInPlane = true;
    for (const std::uint32_t i : t)
    {
      isInPlane = isInPlane &&
        std::abs(plane.GetSide(points[i])) <= Rounding * (1.0 + glm::length(points[i]));
      corners.push_back(plane.GetPlace(points[i]));
    }
    if (isInPlane)
    {
      if (GetArea(corners) < 0.0)
      {
        std::reverse(corners.begin(), corners.end());
      }
      open = Subtract(open, corners, smallestArea);
      if (open.empty() || open.size() > MostPieces)
      {
        break;
      }
    }
  }
  return open.empty();
}

ReceiverSide ReceiverPlan::GetSide() const
{
  const Parallelogram& base = this->Frame.GetBase();
  return glm::dot(this->Frame.GetNormal(), glm::cross(base.EdgeX, base.EdgeY)) > 0.0
    ? ReceiverSide::Front
    : ReceiverSide::Back;
}

ReceiverPlan PlanWindow(const ShadowScene& scene, const Receiver& window,
  const ReceiverPlan& parent, OccluderSelector& occluders)
{
  ReceiverPlan plan = PlanReceiver(scene, window, occluders);
  for (std::size_t i = 0; i < plan.Pairs.size(); ++i)
  {
    if (parent.Pairs[i].Needed == Effect::None)
    {
      plan.Pairs[i] = parent.Pairs[i];
    }
  }
  return plan;
}

ReceiverPlan PlanReceiver(
  const ShadowScene& scene, const Receiver& receiver, OccluderSelector& occluders)
{
  ReceiverPlan plan;
  plan.Frame = scene.MakeFrame(receiver);
  plan.Supersampling = receiver.Settings.Supersampling;
  plan.Texels = receiver.Texels * plan.Supersampling;
  plan.Lights = ClipLights(scene.Lights, plan.Frame);
  occluders.SetReceiver(receiver, plan.Frame);
  occluders.SetFindsParts(receiver.IsAutomatic && receiver.Settings.Planner);
  ShadowParts parts;
  for (const Light& light : plan.Lights)
  {
    plan.Pairs.push_back(PlanPair(plan, *light, scene, receiver, occluders));
    TakeSmallParts(plan, occluders, plan.Pairs.back(), parts);
  }
  occluders.SetFindsParts(false);
  plan.Fine = PlanWindows(parts.Small, parts.Large, plan.Frame, plan.Texels);
  if (receiver.Settings.Planner && receiver.Settings.PlannerTolerance > 0.0 &&
    plan.Lights.size() > 1)
  {
    LeaveOutFaintLights(plan, receiver.Settings);
  }
  return plan;
}

std::optional<Receiver> FindOtherSide(
  const ShadowScene& scene, std::size_t receiver, const ReceiverPlan& plan)
{
  Receiver other = scene.Receivers[receiver];
  if (other.Settings.Side != ReceiverSide::Auto || other.ProxyCentre)
  {
    return std::nullopt;
  }
  const bool isBack = plan.GetSide() == ReceiverSide::Front;
  const ReceiverFrame frame(
    other.Base, isBack ? ReceiverFrame::Side::Back : ReceiverFrame::Side::Front);
  const bool isInside = other.Enclosed && other.Enclosed->IsBehind == isBack;
  const std::vector<Light> seen = ClipLights(scene.Lights, frame);
  const bool isLit = std::any_of(seen.begin(), seen.end(),
    [&](const Light& light)
    {
      return PlanEffect(frame, *light, false) != Effect::None &&
        (!isInside || MayTouch(*light, *other.Enclosed));
    });
  if (!isLit)
  {
    return std::nullopt;
  }
  other.Settings.Side = isBack ? ReceiverSide::Back : ReceiverSide::Front;
  other.OtherSideOf = receiver;
  return other;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ExactLights.h"

#include "ExactVisibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace oracle
{

namespace
{

const long double Pi = std::acos(-1.0L);

Vec3 Unit(const Vec3& a)
{
  return (1 / Length(a)) * a;
}

// A vector at right angles to a unit vector: its cross product with the axis farthest from it.
Vec3 Perpendicular(const Vec3& w)
{
  const Vec3 axis = std::abs(w.X) < 0.6L ? Vec3{ 1, 0, 0 } : Vec3{ 0, 1, 0 };
  return Unit(Cross(w, axis));
}

// ---- Disks ----

// A point in the plane of an outline, which is the unit circle there.
struct Vec2
{
  long double X, Y;
};

// A circle as seen from x: Centre + Radius (cos t U + sin t V), where U x V = W.
struct Circle
{
  Circle(const Vec3& centre, long double radius, const Vec3& unitNormal)
    : Centre(centre)
    , Radius(radius)
    , U(Perpendicular(unitNormal))
    , V(Cross(unitNormal, U))
    , W(unitNormal)
  {
  }

  Vec3 Centre;
  long double Radius;
  Vec3 U, V, W;

  // The square around the circle, in the circle's sense of rotation.
  Polygon Square() const
  {
    const Vec3 u = this->Radius * this->U, v = this->Radius * this->V;
    const Vec3& c = this->Centre;
    return { c - u - v, c + u - v, c + u + v, c - u + v };
  }

  Vec2 Flatten(const Vec3& p) const
  {
    const Vec3 d = p - this->Centre;
    return { Dot(d, this->U) / this->Radius, Dot(d, this->V) / this->Radius };
  }
};

// An ellipse as seen from x: Centre + cos t A + sin t B.
struct Oval
{
  Oval(const Vec3& centre, const Vec3& a, const Vec3& b)
    : Centre(centre)
    , A(a)
    , B(b)
    , W(Cross(a, b))
  {
  }

  Vec3 Centre, A, B;
  Vec3 W; // along the normal

  // The parallelogram around the ellipse, in the ellipse's sense of rotation.
  Polygon Square() const
  {
    const Vec3& c = this->Centre;
    return { c - this->A - this->B, c + this->A - this->B, c + this->A + this->B,
      c - this->A + this->B };
  }

  Vec2 Flatten(const Vec3& p) const
  {
    const Vec3 d = p - this->Centre;
    const long double w2 = Dot(this->W, this->W);
    return { Dot(Cross(d, this->B), this->W) / w2, Dot(Cross(this->A, d), this->W) / w2 };
  }
};

// The contour integral of Lambert's formula, n.(p x dp) / p.p, along arcs of a circle. With
// p = c + r (cos t u + sin t v) the integrand is
//   (r^2 n.w + r n.(c x v) cos t - r n.(c x u) sin t) / (c.c + r^2 + 2 r c.u cos t + 2 r c.v sin t)
// and t is counted from where the denominator is largest, which leaves 1 + h cos t there.
class ArcIntegral
{
public:
  ArcIntegral(const Circle& circle, const Vec3& n)
  {
    const Vec3& c = circle.Centre;
    const long double r = circle.Radius;
    const long double e = 2 * r * Dot(c, circle.U), f = 2 * r * Dot(c, circle.V);
    const long double h = std::hypot(e, f);
    const long double d = Dot(c, c) + r * r;
    const long double b = r * Dot(n, Cross(c, circle.V)) / d;
    const long double g = -r * Dot(n, Cross(c, circle.U)) / d;
    this->Phase = std::atan2(f, e);
    this->H = h / d;
    this->S = std::sqrt((d - h) * (d + h)) / d;
    this->One = r * r * Dot(n, circle.W) / d;
    this->Cosine = b * std::cos(this->Phase) + g * std::sin(this->Phase);
    this->Sine = g * std::cos(this->Phase) - b * std::sin(this->Phase);
  }

  // From angle t on over an angle of either sign.
  long double Over(long double t, long double sweep) const
  {
    const long double start = t - this->Phase;
    return this->Antiderivative(start + sweep) - this->Antiderivative(start);
  }

private:
  // With s = sqrt(1 - h^2), b = h / (1 + s) and the smooth a(t) = atan(b sin t / (1 + b cos t)),
  // the integrals of 1, cos t and sin t over 1 + h cos t are (t - 2 a) / s, (2 a / h - b t) / s and
  // -log(1 + h cos t) / h. The quotients by h are written so that they hold for h = 0 as well.
  long double Antiderivative(long double t) const
  {
    const long double cosine = std::cos(t), sine = std::sin(t);
    const long double b = this->H / (1 + this->S);
    const long double ofH = sine / ((1 + this->S) * (1 + b * cosine));
    const long double z = this->H * ofH;
    const long double aOverH = (z == 0 ? 1 : std::atan(z) / z) * ofH;
    const long double y = this->H * cosine;
    const long double logOverH = (y == 0 ? 1 : std::log1p(y) / y) * cosine;
    return this->One * (t - 2 * this->H * aOverH) / this->S +
      this->Cosine * (2 * aOverH - b * t) / this->S - this->Sine * logOverH;
  }

  long double Phase, H, S;
  // The integrand's coefficients of 1, cos t and sin t.
  long double One, Cosine, Sine;
};

// The same along arcs of an ellipse. With p = c + cos t a + sin t b, p x dp / dt is
// a x b + cos t (c x b) - sin t (c x a).
class OvalIntegral
{
public:
  OvalIntegral(const Oval& oval, const Vec3& n)
    : Outline(oval)
    , One(Dot(n, oval.W))
    , Cosine(Dot(n, Cross(oval.Centre, oval.B)))
    , Sine(-Dot(n, Cross(oval.Centre, oval.A)))
  {
  }

  // From angle t on over an angle of either sign.
  long double Over(long double t, long double sweep) const
  {
    return this->Adapt(t, t + sweep, this->ByGauss(t, t + sweep), MostHalvings);
  }

private:
  // The integrand has poles as near to the outline as x is, in parts of its own length. A piece of
  // the rule gains digits where it is shorter than that: places 2^-40 of the outline away from it.
  static constexpr int MostHalvings = 40;

  long double At(long double t) const
  {
    const long double cosine = std::cos(t), sine = std::sin(t);
    const Vec3 p = this->Outline.Centre + cosine * this->Outline.A + sine * this->Outline.B;
    return (this->One + this->Cosine * cosine + this->Sine * sine) / Dot(p, p);
  }

  // Gauss and Legendre's rule with ten nodes.
  long double ByGauss(long double low, long double high) const
  {
    static constexpr std::array<long double, 5> nodes = { 0.148874338981631210885L,
      0.433395394129247190799L, 0.679409568299024406234L, 0.865063366688984510732L,
      0.973906528517171720078L };
    static constexpr std::array<long double, 5> weights = { 0.295524224714752870174L,
      0.269266719309996355091L, 0.219086362515982043996L, 0.149451349150580593146L,
      0.066671344308688137594L };
    const long double middle = (low + high) / 2, half = (high - low) / 2;
    long double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      sum += weights[i] * (this->At(middle - half * nodes[i]) + this->At(middle + half * nodes[i]));
    }
    return half * sum;
  }

  long double Adapt(long double low, long double high, long double whole, int halvings) const
  {
    const long double middle = (low + high) / 2;
    const long double left = this->ByGauss(low, middle), right = this->ByGauss(middle, high);
    // The rule's error falls with the 20th power of the length: both halves' is a millionth of what
    // they differ from the whole by.
    constexpr long double agreed = 1e-12L;
    if (halvings == 0 || std::abs(left + right - whole) <= agreed)
    {
      return left + right;
    }
    return this->Adapt(low, middle, left, halvings - 1) +
      this->Adapt(middle, high, right, halvings - 1);
  }

  Oval Outline;
  // The integrand's coefficients of 1, cos t and sin t.
  long double One, Cosine, Sine;
};

// The arc under an edge outside the outline, as seen from the centre.
template <typename Arcs>
long double ArcBelow(const Vec2& p, const Vec2& q, const Arcs& arcs)
{
  const long double sweep = std::atan2(p.X * q.Y - p.Y * q.X, p.X * q.X + p.Y * q.Y);
  return arcs.Over(std::atan2(p.Y, p.X), sweep);
}

// The part of the contour that the edge from p to q makes when its polygon is cut to the outline:
// what is inside stays, what is outside becomes the arc below it.
template <typename Outline, typename Arcs>
long double CutEdgeTerm(
  const Vec3& p, const Vec3& q, const Outline& outline, const Vec3& n, const Arcs& arcs)
{
  const Vec2 a = outline.Flatten(p), b = outline.Flatten(q);
  const Vec2 d = { b.X - a.X, b.Y - a.Y };
  // |a + s d|^2 = 1.
  const long double dd = d.X * d.X + d.Y * d.Y;
  const long double ad = a.X * d.X + a.Y * d.Y;
  const long double across = a.X * d.Y - a.Y * d.X;
  const long double root = std::sqrt(std::max(0.0L, dd - across * across));
  const long double first = std::max(0.0L, (-ad - root) / dd);
  const long double last = std::min(1.0L, (-ad + root) / dd);
  if (!(first < last))
  {
    return dd > 0 ? ArcBelow(a, b, arcs) : 0;
  }
  const Vec3 enter = first > 0 ? p + first * (q - p) : p;
  const Vec3 leave = last < 1 ? p + last * (q - p) : q;
  long double sum = EdgeTerm(enter, leave, n);
  if (first > 0)
  {
    sum += ArcBelow(a, outline.Flatten(enter), arcs);
  }
  if (last < 1)
  {
    sum += ArcBelow(outline.Flatten(leave), b, arcs);
  }
  return sum;
}

// The projected solid angle over pi of what x sees of a disk or an ellipse above the horizon.
template <typename Outline, typename Arcs>
long double VisibleOutline(const Vec3& x, const Vec3& unitNormal, const Outline& outline,
  const Arcs& arcs, Reach reach, const std::vector<Triangle>& occluders)
{
  const Polygon risen = AboveHorizon(outline.Square(), unitNormal);
  if (risen.empty())
  {
    return 0;
  }
  const auto cutSum = [&](const Polygon& piece)
  {
    long double sum = 0;
    for (std::size_t i = 0; i < piece.size(); ++i)
    {
      sum += CutEdgeTerm(piece[i], piece[(i + 1) % piece.size()], outline, unitNormal, arcs);
    }
    return sum;
  };
  return std::abs(SumOverVisible(x, risen, reach, occluders, cutSum)) / (2 * Pi);
}

long double VisibleCircle(const Vec3& x, const Vec3& unitNormal, const Circle& circle, Reach reach,
  const std::vector<Triangle>& occluders)
{
  return VisibleOutline(x, unitNormal, circle, ArcIntegral(circle, unitNormal), reach, occluders);
}

// ---- Segments ----

struct Interval
{
  long double Low, High;
  bool IsEmpty() const { return !(this->Low < this->High); }
};

// The part of an interval of the line a + s (b - a) inside a half-space.
Interval Clip(const Interval& interval, const Vec3& a, const Vec3& b, const HalfSpace& space)
{
  const long double ha = space.Height(a), hb = space.Height(b);
  if (std::max(ha, hb) <= space.Slack)
  {
    return { 0, 0 };
  }
  if (std::min(ha, hb) >= -space.Slack)
  {
    return interval;
  }
  const long double cut = ha / (ha - hb);
  return ha < hb ? Interval{ std::max(interval.Low, cut), interval.High }
                 : Interval{ interval.Low, std::min(interval.High, cut) };
}

// What occluders hide of the segment from a to b, both relative to x, in the order of the starts.
std::vector<Interval> HiddenIntervals(
  const Vec3& x, const Vec3& a, const Vec3& b, const std::vector<Triangle>& occluders)
{
  std::vector<Interval> hidden;
  for (const Triangle& occluder : occluders)
  {
    const auto shadow = CastShadow(x, occluder, Reach::ToPolygon, std::max(Size(a), Size(b)));
    if (!shadow)
    {
      continue;
    }
    Interval interval = { 0, 1 };
    for (auto space = shadow->begin(); space != shadow->end() && !interval.IsEmpty(); ++space)
    {
      interval = Clip(interval, a, b, *space);
    }
    if (!interval.IsEmpty())
    {
      hidden.push_back(interval);
    }
  }
  std::sort(hidden.begin(), hidden.end(),
    [](const Interval& i, const Interval& j) { return i.Low < j.Low; });
  return hidden;
}

// The integral of cos t sin u / r^2 along a segment above the horizon. With h the distance of its
// line, d the unit vector from x to that line at right angles, w along it and p the angle at x from
// d, it is that of (n.d cos p + n.w sin p) cos p dp / h. The differences of the antiderivative are
// written as products, so that short segments lose nothing.
long double SegmentIrradiance(const Vec3& a, const Vec3& b, const Vec3& n)
{
  const Vec3 w = Unit(b - a);
  const Vec3 foot = a - Dot(a, w) * w;
  const long double h = Length(foot);
  if (h == 0)
  {
    return 0;
  }
  const long double la = Dot(a, w), lb = Dot(b, w);
  const long double difference = std::atan2(h * (lb - la), h * h + la * lb);
  const long double sum = std::atan2(la, h) + std::atan2(lb, h);
  const long double sine = std::sin(difference);
  return (Dot(n, foot) / h * (difference + sine * std::cos(sum)) +
           Dot(n, w) * sine * std::sin(sum)) /
    (2 * h);
}

// ---- Points ----

bool IsHidden(const Vec3& x, const Vec3& point, Reach reach, const std::vector<Triangle>& occluders)
{
  return std::any_of(occluders.begin(), occluders.end(),
    [&](const Triangle& triangle)
    {
      const auto shadow = CastShadow(x, triangle, reach, Size(point));
      return shadow && Hides(*shadow, point);
    });
}

// ---- Sums of lights ----

std::array<long double, 3> Scale(const std::array<double, 3>& colour, long double factor)
{
  return { factor * colour[0], factor * colour[1], factor * colour[2] };
}

void Add(std::array<long double, 3>& sum, const std::array<long double, 3>& term)
{
  std::transform(sum.begin(), sum.end(), term.begin(), sum.begin(), std::plus<>());
}

// The strength of a light, whatever it is called and measured in.
template <typename Emitter>
const std::array<double, 3>& Strength(const Emitter& light)
{
  return light.Radiance;
}

const std::array<double, 3>& Strength(const Point& light)
{
  return light.Intensity;
}

const std::array<double, 3>& Strength(const Directional& light)
{
  return light.Irradiance;
}

template <typename Emitter>
std::array<long double, 3> Arriving(
  const Vec3& x, const Vec3& n, const Emitter& light, const std::vector<Triangle>& occluders)
{
  return Scale(Strength(light), VisibleFormFactor(x, n, light, occluders));
}

std::array<long double, 3> Arriving(
  const Vec3& x, const Vec3& n, const Surface& light, const std::vector<Triangle>& occluders)
{
  std::array<long double, 3> sum = { 0, 0, 0 };
  for (const Light& polygon : light.Polygons)
  {
    Add(sum, Arriving(x, n, polygon, occluders));
  }
  return sum;
}

} // namespace

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Disk& light, const std::vector<Triangle>& occluders)
{
  const Circle circle(light.Centre - x, light.Radius, Unit(light.Normal));
  const long double side = -Dot(circle.W, circle.Centre);
  if (side == 0 || (side < 0 && !light.TwoSided))
  {
    return 0;
  }
  return VisibleCircle(x, Unit(n), circle, Reach::ToPolygon, occluders);
}

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Ellipse& light, const std::vector<Triangle>& occluders)
{
  const Oval oval(light.Centre - x, light.A, light.B);
  const long double side = -Dot(oval.W, oval.Centre);
  if (side == 0 || (side < 0 && !light.TwoSided))
  {
    return 0;
  }
  const Vec3 unitNormal = Unit(n);
  return VisibleOutline(
    x, unitNormal, oval, OvalIntegral(oval, unitNormal), Reach::ToPolygon, occluders);
}

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Segment& light, const std::vector<Triangle>& occluders)
{
  const Vec3 unitNormal = Unit(n);
  const Vec3 a = light.A - x, b = light.B - x;
  const HalfSpace sky = { unitNormal, 0, ArithmeticSlack * std::max(Size(a), Size(b)) };
  const Interval risen = Clip({ 0, 1 }, a, b, sky);
  long double sum = 0;
  const auto addLit = [&](long double low, long double high)
  {
    if (low < high)
    {
      sum += SegmentIrradiance(a + low * (b - a), a + high * (b - a), unitNormal);
    }
  };
  long double lit = risen.Low;
  for (const Interval& hidden : HiddenIntervals(x, a, b, occluders))
  {
    addLit(lit, std::min(hidden.Low, risen.High));
    lit = std::max(lit, hidden.High);
  }
  addLit(lit, risen.High);
  return sum / Pi;
}

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Point& light, const std::vector<Triangle>& occluders)
{
  const Vec3 to = light.Position - x;
  const long double up = Dot(Unit(n), to);
  if (!(up > 0) || IsHidden(x, to, Reach::ToPolygon, occluders))
  {
    return 0;
  }
  const long double r2 = Dot(to, to);
  return up / (Pi * r2 * std::sqrt(r2));
}

long double VisibleFormFactor(
  const Vec3& x, const Vec3& n, const Directional& light, const std::vector<Triangle>& occluders)
{
  const Vec3 to = -1 * Unit(light.Direction);
  const long double radius = Pi / 360 * light.AngularDiameter;
  if (radius > 0)
  {
    // The sun's outline is the circle in which its cone cuts the unit sphere.
    const long double sine = std::sin(radius);
    const Circle circle(std::cos(radius) * to, sine, to);
    return VisibleCircle(x, Unit(n), circle, Reach::ToInfinity, occluders) / (Pi * sine * sine);
  }
  const long double up = Dot(Unit(n), to);
  return up > 0 && !IsHidden(x, to, Reach::ToInfinity, occluders) ? up / Pi : 0;
}

std::array<long double, 3> ArrivingRadiance(
  const Vec3& x, const Vec3& n, const AnyLight& light, const std::vector<Triangle>& occluders)
{
  return std::visit([&](const auto& kind) { return Arriving(x, n, kind, occluders); }, light);
}

std::array<double, 3> Radiance(const Vec3& x, const Vec3& n, const Scene& scene)
{
  std::array<long double, 3> arriving = Scale(scene.Ambient, 1);
  for (const AnyLight& light : scene.Lights)
  {
    Add(arriving, ArrivingRadiance(x, n, light, scene.Occluders));
  }
  std::array<double, 3> reflected;
  for (std::size_t i = 0; i < 3; ++i)
  {
    reflected[i] = static_cast<double>(scene.Reflectance[i] * arriving[i]);
  }
  return reflected;
}

} // namespace oracle

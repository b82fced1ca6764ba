// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DiskLight.h"

#include "EllipseCone.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra
{
namespace
{

constexpr double Pi = glm::pi<double>();

/// Semi-axes whose squares differ by less than this share of their sum are a circle's: some
/// hundreds of roundings, what a product of several rotations comes to.
constexpr double Roundness = 1e-13;

/// Of the unit disk, the area on the side x >= c of a chord: angle - sine cosine of half its arc.
double SegmentArea(double c)
{
  const double angle = std::acos(c);
  return angle - std::sin(angle) * c;
}

/// The chord beyond which the unit disk has the given area. Newton's method within a bracket: the
/// area's derivative is minus the chord's length.
double ChordOfArea(double area)
{
  double low = -1.0, high = 1.0, c = 0.0;
  constexpr int MostSteps = 60; // bisection alone takes them to the last bit
  for (int i = 0; i < MostSteps; ++i)
  {
    const double excess = SegmentArea(c) - area;
    (excess > 0.0 ? low : high) = c;
    const double chord = 2.0 * std::sqrt(std::max(1.0 - c * c, 0.0));
    const double next = c + excess / chord;
    const double previous = c;
    c = next > low && next < high ? next : 0.5 * (low + high);
    if (c == previous)
    {
      break;
    }
  }
  return c;
}

/// Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square".
glm::dvec2 SquareToDisk(const glm::dvec2& s)
{
  const glm::dvec2 p = 2.0 * s - 1.0;
  if (p == glm::dvec2(0.0))
  {
    return p;
  }
  const bool isWide = std::abs(p.x) > std::abs(p.y);
  const double radius = isWide ? p.x : p.y;
  const double angle = isWide ? 0.25 * Pi * p.y / p.x : 0.5 * Pi - 0.25 * Pi * p.x / p.y;
  return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// A unit vector across a unit vector.
glm::dvec3 FindAcross(const glm::dvec3& v)
{
  const glm::dvec3 a = glm::abs(v);
  const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
    : a.y <= a.z                                   ? glm::dvec3(0, 1, 0)
                                                   : glm::dvec3(0, 0, 1);
  return glm::normalize(glm::cross(v, axis));
}

/// The unit vector along v, which is across a unit vector `axis` but for its rounding; `fallback`
/// where v is no more than that.
glm::dvec3 NormalizeAcross(const glm::dvec3& v, const glm::dvec3& axis, const glm::dvec3& fallback)
{
  const double length = glm::length(v);
  if (!(length > 0.0))
  {
    return fallback;
  }
  const glm::dvec3 across = v / length - glm::dot(v / length, axis) * axis;
  const double left = glm::length(across); // 1 but for rounding, unless v is nothing else
  return left > 0.5 ? across / left : fallback;
}

/**
 * Lambert's contour integral over the arc of a circle of radius r around the origin, from angle
 * `from` to `to`, seen from (rho, 0, -h):  the integral of p x dp / |p|^2 with p = (r cos t - rho,
 * r sin t, h) and |p|^2 = a - b cos t.
 */
glm::dvec3 IntegrateArc(double rho, double h, double r, double from, double to)
{
  const double a = rho * rho + h * h + r * r;
  const double b = 2.0 * rho * r;
  const double root = std::sqrt(std::max((a - b) * (a + b), 0.0));
  // The integral of 1 / (a - b cos t): 2 / root atan(sqrt((a + b) / (a - b)) tan(t / 2)), made
  // continuous over half turns.
  const double slope = (a + b) / root;
  const auto inverse = [&](double t)
  {
    const double turns = std::round(t / (2.0 * Pi));
    const double half = 0.5 * t - turns * Pi;
    return 2.0 / root * (std::atan2(slope * std::sin(half), std::cos(half)) + turns * Pi);
  };
  const double plain = inverse(to) - inverse(from);
  // Of cos t and of sin t over a - b cos t; series in b / a where the quotient loses its digits.
  const double length = to - from;
  double withCosine = 0.0, withSine = 0.0;
  if (b > 1e-4 * a)
  {
    withCosine = (a * plain - length) / b;
    withSine = std::log((a - b * std::cos(to)) / (a - b * std::cos(from))) / b;
  }
  else
  {
    const double q = b / a;
    const auto powers = [&](double t)
    {
      const double s = std::sin(t), c = std::cos(t);
      // Integrals of cos t (1 + q cos t + q^2 cos^2 t) and of sin t (the same).
      return glm::dvec2(s + q * 0.5 * (t + s * c) + q * q * (s - s * s * s / 3.0),
        -c - q * 0.5 * c * c - q * q * c * c * c / 3.0);
    };
    const glm::dvec2 difference = (powers(to) - powers(from)) / a;
    withCosine = difference.x;
    withSine = difference.y;
  }
  return { -h * r * withCosine, -h * r * withSine, r * r * plain - rho * r * withCosine };
}

} // namespace

DiskLight::DiskLight(const glm::dvec3& centre, const glm::dvec3& normal, double radius)
  : Centre(centre)
{
  const double length = glm::length(normal);
  const bool isFinite = std::isfinite(glm::length(centre)) && std::isfinite(length);
  if (isFinite && length > 0.0 && radius > 0.0 && std::isfinite(radius * radius))
  {
    this->Normal = normal / length;
    this->Radius = radius;
    this->Axis = FindAcross(this->Normal);
  }
}

void DiskLight::SetFirstAxis(const glm::dvec3& direction)
{
  this->Axis = NormalizeAcross(direction, this->Normal, this->Axis);
}

glm::dvec3 DiskLight::FromUnitDisk(const glm::dvec2& p) const
{
  const double x = this->Turn.x * p.x - this->Turn.y * p.y;
  const double y = this->Turn.y * p.x + this->Turn.x * p.y;
  return x * this->Axis + this->Ratio * y * glm::cross(this->Normal, this->Axis);
}

std::vector<glm::dvec3> DiskLight::GetRim(int count) const
{
  std::vector<glm::dvec3> rim;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    rim.push_back(
      this->Centre + this->Radius * this->FromUnitDisk({ std::cos(angle), std::sin(angle) }));
  }
  return rim;
}

void DiskLight::Stretch(const glm::dvec3& x, const glm::dvec3& y)
{
  const double area = glm::length(glm::cross(x, y));
  // The squares of the semi-axes, as a sum and a difference.
  const double sum = glm::dot(x, x) + glm::dot(y, y);
  const double along = glm::dot(x - y, x + y), across = 2.0 * glm::dot(x, y);
  const double difference = std::hypot(along, across);
  if (difference <= Roundness * sum)
  {
    return;
  }
  const double both = std::sqrt(sum + 2.0 * area); // the sum of the semi-axes
  const double longer = 0.5 * (both + difference / both);
  const double angle = 0.5 * std::atan2(across, along);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  this->Axis = glm::normalize(cosine * x + sine * y);
  this->Normal = NormalizeAcross(
    glm::cross(this->Axis, cosine * y - sine * x), this->Axis, FindAcross(this->Axis));
  this->Turn = { cosine, -sine };
  this->Ratio = area / (longer * longer);
  // What spans no more than the rounding of both products lies on a line.
  const bool isFlat = area <= 4.0 * std::numeric_limits<double>::epsilon() * sum;
  this->Radius = isFlat ? 0.0 : longer;
}

DiskLight DiskLight::Transformed(const glm::dmat4& matrix) const
{
  const glm::dmat3 linear(matrix);
  // Where a mirror turns x and y round, the normal goes with the surface.
  const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 x = linear * this->FromUnitDisk({ 1.0, 0.0 });
  const glm::dvec3 y = side * (linear * this->FromUnitDisk({ 0.0, 1.0 }));
  const glm::dvec3 area = glm::cross(x, y);
  DiskLight result(glm::dvec3(matrix * glm::dvec4(this->Centre, 1.0)), area,
    this->Radius * std::sqrt(glm::length(area)));
  result.SetFirstAxis(x);
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  if (result.IsValid())
  {
    result.Stretch(this->Radius * x, this->Radius * y);
  }
  return result;
}

DiskLight DiskLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  DiskLight result = *this;
  const double height = glm::dot(this->Centre - point, normal);
  const glm::dvec3 across = normal - glm::dot(normal, this->Normal) * this->Normal;
  // The heights of both semi-axes of an ellipse, in radii.
  const glm::dvec2 slope(glm::dot(normal, this->Axis),
    this->Ratio * glm::dot(normal, glm::cross(this->Normal, this->Axis)));
  // Of the heights around the centre's.
  const double reach = this->Radius * (this->IsCircle() ? glm::length(across) : glm::length(slope));
  // As of a polygon: what is no higher than the rounding of the coordinates lies in the plane.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() *
    (std::max(glm::length(point), glm::length(this->Centre)) + this->Radius);
  if (height + reach <= rounding)
  {
    result.Radius = 0.0; // below the plane or in it
  }
  else if (height < reach && reach > rounding)
  {
    result.CutOffset = -height / reach;
    if (this->IsCircle())
    {
      result.Axis = glm::normalize(across);
    }
    else
    {
      result.Turn = glm::normalize(slope);
    }
  }
  return result;
}

glm::dvec3 DiskLight::Sample(const glm::dvec2& s) const
{
  glm::dvec2 p;
  if (this->CutOffset <= -1.0)
  {
    p = SquareToDisk(s);
  }
  else
  {
    p.x = std::clamp(ChordOfArea(s.x * SegmentArea(this->CutOffset)), this->CutOffset, 1.0);
    p.y = (2.0 * s.y - 1.0) * std::sqrt(std::max(1.0 - p.x * p.x, 0.0));
  }
  return this->Centre + this->Radius * this->FromUnitDisk(p);
}

bool DiskLight::Faces(const glm::dvec3& point) const
{
  const double side = glm::dot(point - this->Centre, this->Normal);
  return side > 0.0 || (side < 0.0 && this->TwoSided);
}

LightHull DiskLight::GetHull() const
{
  // Around the outline, an octagon.
  DiskLight around = *this;
  around.Radius = this->Radius / std::cos(Pi / 8.0);
  return { around.GetRim(8), false };
}

double DiskLight::FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const
{
  const DiskLight seen = this->ClippedToFront(x, normal);
  if (!seen.IsValid() || !this->Faces(x))
  {
    return 0.0;
  }
  return std::clamp(
    this->IsCircle() ? seen.FormFactorOfCircle(x, normal) : seen.FormFactorOfEllipse(x, normal),
    0.0, 1.0);
}

double DiskLight::FormFactorOfEllipse(const glm::dvec3& x, const glm::dvec3& normal) const
{
  // Along the semi-axes, and away from x.
  const glm::dvec3 d = this->Centre - x;
  const glm::dvec3 side = glm::dot(d, this->Normal) > 0.0 ? this->Normal : -this->Normal;
  const glm::dmat3 axes(this->Axis, glm::cross(side, this->Axis), side);
  const EllipseCone cone(d * axes, this->Radius, this->Ratio * this->Radius);
  return this->CutOffset <= -1.0 ? cone.GetFormFactor(normal * axes)
                                 : cone.GetFormFactorAboveHorizon(normal * axes);
}

double DiskLight::FormFactorOfCircle(const glm::dvec3& x, const glm::dvec3& normal) const
{
  const glm::dvec3 d = this->Centre - x;
  const double r = this->Radius;
  const double h = std::abs(glm::dot(d, this->Normal));
  const glm::dvec3 side = glm::dot(d, this->Normal) > 0.0 ? this->Normal : -this->Normal;
  const glm::dvec3 inPlane = d - h * side;
  const double rho = glm::length(inPlane);
  if (this->CutOffset <= -1.0)
  {
    const double q = rho * rho + h * h - r * r;
    const double root = std::hypot(q, 2.0 * h * r);
    // Written so that nothing is lost where the disk is small or far.
    const double along =
      q > 0.0 ? 2.0 * h * h * r * r / (root * (root + q)) : 0.5 * (1.0 - q / root);
    const double across =
      2.0 * h * rho * r * r / (root * (rho * rho + h * h + r * r + root)); // towards the centre
    const glm::dvec3 towards = rho > 0.0 ? inPlane / rho : glm::dvec3(0.0);
    return glm::dot(normal, along * side) + glm::dot(normal, across * towards);
  }

  // In the disk's plane: the first axis from the centre to x, the third away from x.
  const glm::dvec3 e1 = NormalizeAcross(-inPlane, side, this->Axis);
  const glm::dvec3 e2 = glm::cross(side, e1);
  const double middle = std::atan2(glm::dot(this->Axis, e2), glm::dot(this->Axis, e1));
  const double half = std::acos(std::clamp(this->CutOffset, -1.0, 1.0));
  const glm::dvec3 arc = IntegrateArc(rho, h, r, middle - half, middle + half);
  const glm::dvec3 world = arc.x * e1 + arc.y * e2 + arc.z * side;
  const auto onRim = [&](double t) { return d + r * (std::cos(t) * e1 + std::sin(t) * e2); };
  const glm::dvec3 a = onRim(middle + half), b = onRim(middle - half);
  const glm::dvec3 c = glm::cross(a, b);
  const double sine = glm::length(c);
  const glm::dvec3 chord =
    sine > 0.0 ? std::atan2(sine, glm::dot(a, b)) / sine * c : glm::dvec3(0.0);
  return glm::dot(normal, world + chord) / (2.0 * Pi);
}

double DiskLight::GetMeasure() const
{
  return this->Radius * this->Radius * this->Ratio * SegmentArea(this->CutOffset);
}

double DiskLight::GetSolidAngleBound(const Parallelogram& receiver) const
{
  const glm::dvec3 major = this->Axis;
  const glm::dvec3 minor = this->Ratio * glm::cross(this->Normal, this->Axis);
  const glm::dvec3 reach = this->Radius * glm::sqrt(major * major + minor * minor);
  return BoundSolidAngle(this->GetMeasure(), this->Centre - reach, this->Centre + reach, receiver);
}

double DiskLight::GetAspect() const
{
  return this->IsCircle()
    ? 1.0
    : glm::length(this->FromUnitDisk({ 1.0, 0.0 })) / glm::length(this->FromUnitDisk({ 0.0, 1.0 }));
}

std::vector<LightSample> DiskLight::TakeSamples(const std::vector<glm::dvec2>& pattern) const
{
  std::vector<LightSample> samples(pattern.size());
  for (std::size_t i = 0; i < pattern.size(); ++i)
  {
    samples[i].Place = this->Sample(pattern[i]);
  }
  return samples;
}

std::vector<double> DiskLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(1);
  key.insert(key.end(),
    { this->Centre.x, this->Centre.y, this->Centre.z, this->Normal.x, this->Normal.y,
      this->Normal.z, this->Radius, this->CutOffset, this->Axis.x, this->Axis.y, this->Axis.z,
      this->Ratio, this->Turn.x, this->Turn.y });
  return key;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DiskLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra
{
namespace
{

constexpr double Pi = glm::pi<double>();

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
    this->CutDirection = FindAcross(this->Normal);
  }
}

void DiskLight::SetFirstAxis(const glm::dvec3& direction)
{
  this->CutDirection = NormalizeAcross(direction, this->Normal, this->CutDirection);
}

std::vector<glm::dvec3> DiskLight::GetRim(int count) const
{
  const glm::dvec3 y = glm::cross(this->Normal, this->CutDirection);
  std::vector<glm::dvec3> rim;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    rim.push_back(
      this->Centre + this->Radius * (std::cos(angle) * this->CutDirection + std::sin(angle) * y));
  }
  return rim;
}

DiskLight DiskLight::Transformed(const glm::dmat4& matrix) const
{
  const glm::dmat3 linear(matrix);
  const glm::dvec3 x = linear * this->CutDirection;
  const glm::dvec3 y = linear * glm::cross(this->Normal, this->CutDirection);
  // Where a mirror turns x and y round, the normal goes with the surface.
  const glm::dvec3 area = glm::cross(x, y) * (glm::determinant(linear) < 0.0 ? -1.0 : 1.0);
  DiskLight result(glm::dvec3(matrix * glm::dvec4(this->Centre, 1.0)), area,
    this->Radius * std::sqrt(glm::length(area)));
  result.SetFirstAxis(x);
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  return result;
}

DiskLight DiskLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  DiskLight result = *this;
  const double height = glm::dot(this->Centre - point, normal);
  const glm::dvec3 across = normal - glm::dot(normal, this->Normal) * this->Normal;
  const double reach = this->Radius * glm::length(across); // of the heights around the centre's
  // As of a polygon: what is no higher than the rounding of the coordinates lies in the plane.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() *
    (std::max(glm::length(point), glm::length(this->Centre)) + this->Radius);
  if (height + reach <= rounding)
  {
    result.Radius = 0.0; // below the plane or in it
  }
  else if (height < reach && reach > rounding)
  {
    result.CutDirection = glm::normalize(across);
    result.CutOffset = -height / reach;
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
  return this->Centre +
    this->Radius * (p.x * this->CutDirection + p.y * glm::cross(this->Normal, this->CutDirection));
}

bool DiskLight::Faces(const glm::dvec3& point) const
{
  const double side = glm::dot(point - this->Centre, this->Normal);
  return side > 0.0 || (side < 0.0 && this->TwoSided);
}

LightHull DiskLight::GetHull() const
{
  // Around the circle, an octagon.
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
  const glm::dvec3 d = this->Centre - x;
  const double r = this->Radius;
  const double h = std::abs(glm::dot(d, this->Normal));
  const glm::dvec3 side = glm::dot(d, this->Normal) > 0.0 ? this->Normal : -this->Normal;
  const glm::dvec3 inPlane = d - h * side;
  const double rho = glm::length(inPlane);
  if (seen.CutOffset <= -1.0)
  {
    const double q = rho * rho + h * h - r * r;
    const double root = std::hypot(q, 2.0 * h * r);
    // Written so that nothing is lost where the disk is small or far.
    const double along =
      q > 0.0 ? 2.0 * h * h * r * r / (root * (root + q)) : 0.5 * (1.0 - q / root);
    const double across =
      2.0 * h * rho * r * r / (root * (rho * rho + h * h + r * r + root)); // towards the centre
    const glm::dvec3 towards = rho > 0.0 ? inPlane / rho : glm::dvec3(0.0);
    return std::clamp(
      glm::dot(normal, along * side) + glm::dot(normal, across * towards), 0.0, 1.0);
  }

  // In the disk's plane: the first axis from the centre to x, the third away from x.
  const glm::dvec3 e1 = NormalizeAcross(-inPlane, side, seen.CutDirection);
  const glm::dvec3 e2 = glm::cross(side, e1);
  const double middle =
    std::atan2(glm::dot(seen.CutDirection, e2), glm::dot(seen.CutDirection, e1));
  const double half = std::acos(std::clamp(seen.CutOffset, -1.0, 1.0));
  const glm::dvec3 arc = IntegrateArc(rho, h, r, middle - half, middle + half);
  const glm::dvec3 world = arc.x * e1 + arc.y * e2 + arc.z * side;
  const auto onRim = [&](double t) { return d + r * (std::cos(t) * e1 + std::sin(t) * e2); };
  const glm::dvec3 a = onRim(middle + half), b = onRim(middle - half);
  const glm::dvec3 c = glm::cross(a, b);
  const double sine = glm::length(c);
  const glm::dvec3 chord =
    sine > 0.0 ? std::atan2(sine, glm::dot(a, b)) / sine * c : glm::dvec3(0.0);
  return std::clamp(glm::dot(normal, world + chord) / (2.0 * Pi), 0.0, 1.0);
}

double DiskLight::GetMeasure() const
{
  return this->Radius * this->Radius * SegmentArea(this->CutOffset);
}

double DiskLight::GetSolidAngleBound(const Parallelogram& receiver) const
{
  const glm::dvec3 reach =
    this->Radius * glm::sqrt(glm::max(1.0 - this->Normal * this->Normal, glm::dvec3(0.0)));
  return BoundSolidAngle(this->GetMeasure(), this->Centre - reach, this->Centre + reach, receiver);
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
      this->Normal.z, this->Radius, this->CutOffset, this->CutDirection.x, this->CutDirection.y,
      this->CutDirection.z });
  return key;
}

} // namespace penumbra

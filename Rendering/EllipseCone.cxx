// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
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

/// The least height over the ellipse's plane, in sizes of all: lower places see the same to the
/// last bit, and the powers of this one are normal numbers.
constexpr double LeastHeight = 1e-60;

/**
 * The largest root nu of the sum s of c_i^2 / (D_i + nu) = 1. Newton's method for 1 / s = 1, whose
 * left side is a harmonic sum of linear functions and so concave: from below it climbs to the root,
 * in some five steps, from where no term alone passes 1.
 */
double FindLargestRoot(const glm::dvec3& c, const glm::dvec3& d)
{
  const glm::dvec3 squares = c * c;
  const glm::dvec3 lowest = squares - d;
  double nu = std::max({ lowest.x, lowest.y, lowest.z });
  constexpr int MostSteps = 50; // more than any needs
  for (int i = 0; i < MostSteps; ++i)
  {
    const glm::dvec3 terms = squares / (d + nu);
    const double sum = terms.x + terms.y + terms.z;
    const glm::dvec3 slopes = terms / (d + nu);
    const double step = sum * (sum - 1.0) / (slopes.x + slopes.y + slopes.z);
    nu += std::max(step, 0.0);
    if (step <= std::numeric_limits<double>::epsilon() * nu)
    {
      break;
    }
  }
  return nu;
}

/// f(x) / x for the inverse of a function that is x near 0.
double OverItself(double (*f)(double), double x)
{
  return x == 0.0 ? 1.0 : f(x) / x;
}

/// An angle: its sine and cosine, taken once, and the full turns in it. So the integrals up to it
/// and the point of the outline at it are those of the same angle to the last bit: on a long
/// outline, a bit is a long way.
struct Turned
{
  explicit Turned(double t)
    : Turns(std::round(t / (2.0 * Pi)))
    , Sine(std::sin(t - 2.0 * Pi * this->Turns))
    , Cosine(std::cos(t - 2.0 * Pi * this->Turns))
  {
  }
  double Turns, Sine, Cosine;
};

/**
 * The integrals of 1, cos t and sin t over a cos^2 t + b sin^2 t, from 0 (of sin t, from a quarter
 * turn) to t, where a >= b > 0 and k = a - b.
 */
glm::dvec3 IntegrateOutline(double a, double b, double k, const Turned& t)
{
  const double angle =
    std::atan2(std::sqrt(b) * t.Sine, std::sqrt(a) * t.Cosine) + 2.0 * Pi * t.Turns;
  const double root = std::sqrt(a * t.Cosine * t.Cosine + b * t.Sine * t.Sine);
  const double ofCosine = t.Sine / (std::sqrt(a) * root) *
    OverItself([](double x) { return std::asinh(x); }, std::sqrt(k) * t.Sine / root);
  const double ofSine =
    -t.Cosine / b * OverItself([](double x) { return std::atan(x); }, std::sqrt(k / b) * t.Cosine);
  return { angle / (std::sqrt(a) * std::sqrt(b)), ofCosine, ofSine };
}

} // namespace

EllipseCone::EllipseCone(const glm::dvec3& centre, double a, double b)
{
  const double size = std::max({ glm::length(centre), a, b });
  this->Centre = centre / size;
  this->Centre.z = std::max(this->Centre.z, LeastHeight);
  this->SemiAxes = glm::dvec2(a, b) / size;
  const glm::dvec3 squares(this->SemiAxes * this->SemiAxes, 0.0);
  this->Nu = FindLargestRoot(this->Centre, squares);
  // (D + nu)^-1 d, times nu.
  this->Axis = glm::dvec3(
    glm::dvec2(this->Centre) * this->Nu / (glm::dvec2(squares) + this->Nu), this->Centre.z);
}

double EllipseCone::GetFormFactor(const glm::dvec3& normal) const
{
  const glm::dvec2 roots = glm::sqrt(this->SemiAxes * this->SemiAxes + this->Nu);
  const double along = this->SemiAxes.x / roots.x * (this->SemiAxes.y / roots.y);
  return along * glm::dot(normal, this->Axis) * this->Centre.z / glm::dot(this->Axis, this->Axis);
}

EllipseCone::Outline EllipseCone::FindOutline() const
{
  const double a = this->SemiAxes.x, b = this->SemiAxes.y, root = std::sqrt(this->Nu);
  const glm::dvec3 axis = glm::normalize(this->Axis);
  // The outline a cos t, b sin t around the centre is what a hyperbolic turn of (cos t, sin t, 1)
  // makes of an ellipse around the axis; its conjugate radii are those at right angles to it.
  const double x = -a * axis.x / root, y = -b * axis.y / root;
  const double once = 1.0 + std::sqrt(1.0 + x * x + y * y);
  const glm::dvec3 first =
    glm::dvec3(a * (1.0 + x * x / once), b * x * y / once, 0.0) + x * this->Centre;
  const glm::dvec3 second =
    glm::dvec3(a * x * y / once, b * (1.0 + y * y / once), 0.0) + y * this->Centre;
  const double turn =
    0.5 * std::atan2(2.0 * glm::dot(first, second), glm::dot(first - second, first + second));
  const glm::dvec3 longest = std::cos(turn) * first + std::sin(turn) * second;
  const double length = glm::length(longest);
  // The product of both is known without a difference.
  const double shortest = a * b * this->Centre.z / (root * length);
  const glm::dvec3 across = longest / length;
  return { glm::dmat3(across, glm::cross(axis, across), axis), length / root,
    std::min(shortest, length) / root };
}

double EllipseCone::GetFormFactorAboveHorizon(const glm::dvec3& normal) const
{
  const auto [axes, alpha, beta] = this->FindOutline();
  const glm::dvec3 n = normal * axes;
  // Above the horizon: alpha n.x cos t + beta n.y sin t + n.z >= 0.
  const double reach = std::hypot(alpha * n.x, beta * n.y);
  if (!(reach > std::abs(n.z)))
  {
    return n.z > 0.0 ? this->GetFormFactor(normal) : 0.0;
  }
  const double middle = std::atan2(beta * n.y, alpha * n.x);
  const double half = std::acos(-n.z / reach);
  const double a = 1.0 + alpha * alpha, b = 1.0 + beta * beta;
  const double k = (alpha - beta) * (alpha + beta);
  const Turned first(middle - half), last(middle + half);
  const glm::dvec3 arc = IntegrateOutline(a, b, k, last) - IntegrateOutline(a, b, k, first);
  const glm::dvec3 from(alpha * last.Cosine, beta * last.Sine, 1.0);
  const glm::dvec3 to(alpha * first.Cosine, beta * first.Sine, 1.0);
  // The chord lies in the horizon: its integral is the angle of its ends' azimuths, 0 to pi but for
  // rounding, however much the rounding of an end lifts that off the horizon.
  const double angle = std::atan2(
    glm::dot(n, glm::cross(from, to)), glm::dot(from, to) - glm::dot(n, from) * glm::dot(n, to));
  const double chord = angle < -0.5 * Pi ? angle + 2.0 * Pi : angle;
  return (alpha * beta * n.z * arc.x - beta * n.x * arc.y - alpha * n.y * arc.z + chord) /
    (2.0 * Pi);
}

} // namespace penumbra

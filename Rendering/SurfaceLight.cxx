// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceLight.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace penumbra
{
namespace
{

double GetMean(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

/// Fans of at most `most` vertices that make up a convex polygon.
std::vector<PolygonLight> SplitIntoFans(const PolygonLight& cell, std::size_t most)
{
  const std::vector<glm::dvec3>& v = cell.GetVertices();
  if (v.size() <= most)
  {
    return { cell };
  }
  std::vector<PolygonLight> fans;
  for (std::size_t first = 1; first + 1 < v.size(); first += most - 2)
  {
    const std::size_t last = std::min(first + most - 2, v.size() - 1);
    std::vector<glm::dvec3> fan{ v[0] };
    fan.insert(fan.end(), v.begin() + static_cast<std::ptrdiff_t>(first),
      v.begin() + static_cast<std::ptrdiff_t>(last + 1));
    fans.push_back(PolygonLight::Convex(fan));
    fans.back().Radiance = cell.Radiance;
    fans.back().TwoSided = cell.TwoSided;
  }
  return fans;
}

/// The same polygon, which emits to the other side.
PolygonLight TurnRound(const PolygonLight& cell)
{
  std::vector<glm::dvec3> vertices = cell.GetVertices();
  std::reverse(vertices.begin() + 1, vertices.end());
  PolygonLight turned = PolygonLight::Convex(vertices);
  turned.Radiance = cell.Radiance;
  turned.TwoSided = cell.TwoSided;
  return turned;
}

/// Whether the polygon emits to any of the receiver: to one of its corners.
bool FacesAny(const PolygonLight& cell, const Parallelogram& receiver)
{
  const glm::dvec3 &x = receiver.EdgeX, &y = receiver.EdgeY;
  const std::array<glm::dvec3, 4> corners{ receiver.Corner, receiver.Corner + x,
    receiver.Corner + y, receiver.Corner + x + y };
  return std::any_of(
    corners.begin(), corners.end(), [&](const glm::dvec3& corner) { return cell.Faces(corner); });
}

/// How far two triangulations of a polygon may be apart, where its vertices are not in one plane.
double GetUnevenness(const PolygonLight& cell)
{
  double low = 0.0, high = 0.0; // of the vertices, along the normal
  for (const glm::dvec3& vertex : cell.GetVertices())
  {
    const double height = glm::dot(vertex - cell.GetVertices().front(), cell.GetNormal());
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return high - low;
}

} // namespace

bool IsPlanarAndConvex(const std::vector<glm::dvec3>& vertices)
{
  const std::size_t count = vertices.size();
  glm::dvec3 area(0.0);
  double extent = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::dvec3 a = vertices[i] - vertices[0];
    area += glm::cross(a, vertices[(i + 1) % count] - vertices[0]);
    extent = std::max(extent, glm::length(a));
    largest = std::max(largest, glm::length(vertices[i]));
  }
  const double rounding = 8.0 * static_cast<double>(FLT_EPSILON) * std::max(largest, extent);
  if (glm::length(area) <= rounding * extent)
  {
    return true;
  }
  const glm::dvec3 normal = glm::normalize(area);
  double turned = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::dvec3 before = vertices[(i + 1) % count] - vertices[i];
    const glm::dvec3 after = vertices[(i + 2) % count] - vertices[(i + 1) % count];
    const double sine = glm::dot(normal, glm::cross(before, after));
    turned += std::atan2(sine, glm::dot(before, after));
    if (sine < -rounding * extent ||
      std::abs(glm::dot(normal, vertices[i] - vertices[0])) > rounding)
    {
      return false;
    }
  }
  return turned < 3.0 * glm::pi<double>(); // a star goes round twice
}

SurfaceLight::SurfaceLight(const std::vector<PolygonLight>& cells)
{
  double power = 0.0;
  for (const PolygonLight& cell : cells)
  {
    // A plane that cuts a fan adds a vertex.
    for (const PolygonLight& fan : SplitIntoFans(cell, MaximumVertices - 1))
    {
      if (fan.IsValid() && GetMean(fan.Radiance) > 0.0)
      {
        power += GetMean(fan.Radiance) * fan.GetArea();
        this->Cells.push_back(fan);
        this->PowerEnds.push_back(power);
      }
    }
  }
  for (double& end : this->PowerEnds)
  {
    end /= power;
  }
}

template <typename Change>
SurfaceLight SurfaceLight::WithCells(const Change& change) const
{
  std::vector<PolygonLight> cells;
  for (const PolygonLight& cell : this->Cells)
  {
    cells.push_back(change(cell));
  }
  SurfaceLight result(cells);
  result.Radiance = this->Radiance;
  result.TwoSided = this->TwoSided;
  result.Rounding = this->Rounding;
  return result;
}

SurfaceLight SurfaceLight::Transformed(const glm::dmat4& matrix) const
{
  SurfaceLight result =
    this->WithCells([&](const PolygonLight& cell) { return cell.Transformed(matrix); });
  const glm::dmat3 size(glm::abs(glm::dvec3(matrix[0])), glm::abs(glm::dvec3(matrix[1])),
    glm::abs(glm::dvec3(matrix[2])));
  result.Rounding = size * this->Rounding;
  return result;
}

std::unique_ptr<LightShape> SurfaceLight::Face(const penumbra::Parallelogram& receiver) const
{
  if (!this->TwoSided)
  {
    return this->Clone();
  }
  std::vector<PolygonLight> cells;
  for (const PolygonLight& cell : this->Cells)
  {
    PolygonLight front = cell;
    front.TwoSided = false;
    PolygonLight back = TurnRound(front);
    for (PolygonLight& side : std::array<PolygonLight, 2>{ front, back })
    {
      if (FacesAny(side, receiver))
      {
        cells.push_back(side);
      }
    }
  }
  SurfaceLight result(cells);
  result.Radiance = this->Radiance;
  result.Rounding = this->Rounding;
  return std::make_unique<SurfaceLight>(result);
}

SurfaceLight SurfaceLight::ClippedToFront(const glm::dvec3& point, const glm::dvec3& normal) const
{
  return this->WithCells(
    [&](const PolygonLight& cell) { return cell.ClippedToFront(point, normal); });
}

bool SurfaceLight::Faces(const glm::dvec3& point) const
{
  return std::any_of(this->Cells.begin(), this->Cells.end(),
    [&](const PolygonLight& cell) { return cell.Faces(point); });
}

LightHull SurfaceLight::GetHull() const
{
  LightHull hull;
  for (const PolygonLight& cell : this->Cells)
  {
    const std::vector<glm::dvec3>& vertices = cell.GetVertices();
    hull.Points.insert(hull.Points.end(), vertices.begin(), vertices.end());
  }
  return hull;
}

double SurfaceLight::FormFactor(const glm::dvec3& x, const glm::dvec3& normal) const
{
  double sum = 0.0;
  for (const PolygonLight& cell : this->Cells)
  {
    sum += GetMean(cell.Radiance) * cell.FormFactor(x, normal);
  }
  return sum;
}

glm::dvec3 SurfaceLight::Irradiance(const glm::dvec3& x, const glm::dvec3& normal) const
{
  glm::dvec3 sum(0.0);
  for (const PolygonLight& cell : this->Cells)
  {
    sum += cell.Irradiance(x, normal);
  }
  return this->Radiance * sum;
}

double SurfaceLight::GetMeasure() const
{
  double area = 0.0;
  for (const PolygonLight& cell : this->Cells)
  {
    area += cell.GetArea();
  }
  return area;
}

double SurfaceLight::GetSolidAngleBound(const Parallelogram& receiver) const
{
  // Samples are spread by power: a dim cell has fewer of them than its area's share, and the sample
  // that stands for the largest area decides.
  double largest = 0.0;
  for (std::size_t i = 0; i < this->Cells.size(); ++i)
  {
    const double share = this->PowerEnds[i] - (i > 0 ? this->PowerEnds[i - 1] : 0.0);
    largest = std::max(largest, this->Cells[i].GetSolidAngleBound(receiver) / share);
  }
  return largest;
}

glm::dvec3 SurfaceLight::GetIrradianceBound(const Parallelogram& receiver) const
{
  glm::dvec3 sum(0.0);
  for (const PolygonLight& cell : this->Cells)
  {
    sum += cell.GetIrradianceBound(receiver);
  }
  return this->Radiance * sum;
}

std::vector<LightSample> SurfaceLight::TakeSamples(const std::vector<glm::dvec2>& pattern) const
{
  std::vector<LightSample> samples;
  for (const glm::dvec2& s : pattern)
  {
    const auto end = std::upper_bound(this->PowerEnds.begin(), this->PowerEnds.end() - 1, s.x);
    const auto i = static_cast<std::size_t>(end - this->PowerEnds.begin());
    const double begin = i > 0 ? this->PowerEnds[i - 1] : 0.0;
    const double share = *end - begin;
    const PolygonLight& cell = this->Cells[i];
    LightSample& sample = samples.emplace_back();
    sample.Place = cell.Sample({ std::clamp((s.x - begin) / share, 0.0, 1.0), s.y });
    sample.Normal = cell.GetNormal();
    sample.Power = this->Radiance * cell.Radiance * cell.GetArea() / share;
    sample.Unevenness = GetUnevenness(cell);
  }
  return samples;
}

bool SurfaceLight::HasOneHue() const
{
  constexpr double Parallel = 1e-12;
  const glm::dvec3 hue = glm::normalize(this->Cells.front().Radiance);
  return std::all_of(this->Cells.begin(), this->Cells.end(),
    [&](const PolygonLight& cell) {
      return glm::length(glm::cross(hue, cell.Radiance)) <= Parallel * glm::length(cell.Radiance);
    });
}

std::vector<EmittingPolygon> SurfaceLight::GetPolygons() const
{
  std::vector<EmittingPolygon> polygons;
  for (const PolygonLight& cell : this->Cells)
  {
    polygons.push_back({ &cell, this->Radiance * cell.Radiance });
  }
  return polygons;
}

std::vector<double> SurfaceLight::GetKey() const
{
  std::vector<double> key = this->MakeKey(5);
  key.insert(key.end(), { this->Rounding.x, this->Rounding.y, this->Rounding.z });
  for (const PolygonLight& cell : this->Cells)
  {
    const std::vector<double> cellKey = cell.GetKey();
    key.insert(key.end(), cellKey.begin(), cellKey.end());
  }
  return key;
}

} // namespace penumbra

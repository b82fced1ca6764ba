// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkOccluderGeometry.h"

#include "OpenGLErrors.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkSMPTools.h"
#include "vtkShaderProgram.h"

#include <algorithm>
#include <limits>

vtkStandardNewMacro(vtkOccluderGeometry);

namespace
{

/// A point outside of a receiver is judged by a plane through points within it.
constexpr double RoundingsOfPlane = 3.0;

/// How far the points of a surface may be off, along each axis: the rounding of the coordinates in
/// their own type, and that of the arithmetic in double. A frame takes differences and products of
/// three terms, a plane three points: 16 roundings of the largest number that occurs. The normal of
/// edges that are nearly parallel is that much less certain.
glm::dvec3 GetUncertainty(const penumbra::Surface& surface, const penumbra::Parallelogram& receiver)
{
  constexpr double Roundings = 16.0;
  glm::dvec3 largest =
    glm::abs(receiver.Corner) + glm::abs(receiver.EdgeX) + glm::abs(receiver.EdgeY);
  for (const glm::dvec3& p : surface.Points)
  {
    largest = glm::max(largest, glm::abs(p));
  }
  const double skew = glm::length(receiver.EdgeX) * glm::length(receiver.EdgeY) /
    glm::length(glm::cross(receiver.EdgeX, receiver.EdgeY));
  return surface.Rounding +
    Roundings * std::numeric_limits<double>::epsilon() * skew * glm::length(largest);
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

/// Appends the surface's points in the receiver's frame.
void AppendVertices(const penumbra::Surface& surface, const penumbra::ReceiverFrame& frame,
  std::vector<glm::dvec3>& vertices)
{
  const std::size_t first = vertices.size();
  vertices.resize(first + surface.Points.size());
  vtkSMPTools::For(0, static_cast<vtkIdType>(surface.Points.size()),
    [&](vtkIdType begin, vtkIdType end)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        vertices[first + i] = frame.ToFrame(surface.Points[i]);
      }
    });
}

} // namespace

vtkOccluderGeometry::vtkOccluderGeometry()
{
  this->Vertices->SetType(vtkOpenGLBufferObject::ArrayBuffer);
  this->Indices->SetType(vtkOpenGLBufferObject::ElementArrayBuffer);
}

vtkOccluderGeometry::~vtkOccluderGeometry() = default;

void vtkOccluderGeometry::SetReceiver(const penumbra::ShadowScene& scene,
  const penumbra::Receiver& receiver, const penumbra::ReceiverFrame& frame)
{
  const glm::dvec3 normal = glm::abs(frame.GetNormal());
  const glm::dvec3 ownRounding = scene.Surfaces[receiver.Surface].Rounding;
  this->Points.clear();
  this->Parts.assign(scene.Surfaces.size(), Part());
  for (std::size_t s = 0; s < scene.Surfaces.size(); ++s)
  {
    const penumbra::Surface& surface = scene.Surfaces[s];
    const auto first = static_cast<std::uint32_t>(this->Points.size());
    AppendVertices(surface, frame, this->Points);
    Part& part = this->Parts[s];
    part.Uncertainty = GetUncertainty(surface, frame.GetBase());
    const double contact =
      glm::dot(normal, part.Uncertainty + RoundingsOfPlane * ownRounding) / frame.GetSize();
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      const auto& [a, b, c] = surface.Triangles[t];
      const bool isReceiver = s == receiver.Surface && surface.Regions[t] == receiver.Region;
      const glm::dvec3 &p = this->Points[first + a], &q = this->Points[first + b],
                       &r = this->Points[first + c];
      if (!isReceiver && std::max({ p.z, q.z, r.z }) > contact && !IsDegenerate(p, q, r))
      {
        part.Triangles.push_back({ first + a, first + b, first + c });
      }
    }
  }
  this->ScenePoints = this->Points.size();
}

std::size_t vtkOccluderGeometry::Select(const penumbra::BlockingRegion& region)
{
  this->Points.resize(this->ScenePoints);
  this->Selected.clear();
  const glm::dvec3 lightNormal = glm::abs(region.GetLightNormal().value_or(glm::dvec3(0.0)));
  for (const Part& part : this->Parts)
  {
    const double tolerance = glm::dot(lightNormal, part.Uncertainty);
    for (const Triangle& triangle : part.Triangles)
    {
      const glm::dvec3 &a = this->Points[triangle[0]], &b = this->Points[triangle[1]],
                       &c = this->Points[triangle[2]];
      if (!region.MayHold(a, b, c) || region.LiesInLight(a, b, c, tolerance))
      {
        continue;
      }
      if (region.IsFar(a) || region.IsFar(b) || region.IsFar(c))
      {
        this->AddClipped(triangle, region);
      }
      else
      {
        this->Selected.push_back(triangle);
      }
    }
  }
  return this->Selected.size();
}

void vtkOccluderGeometry::AddClipped(
  const Triangle& triangle, const penumbra::BlockingRegion& region)
{
  const std::vector<glm::dvec3> polygon =
    region.Clip(this->Points[triangle[0]], this->Points[triangle[1]], this->Points[triangle[2]]);
  const auto first = static_cast<std::uint32_t>(this->Points.size());
  for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i)
  {
    this->Selected.push_back({ first, first + i, first + i + 1 });
  }
  this->Points.insert(this->Points.end(), polygon.begin(), polygon.end());
}

bool vtkOccluderGeometry::Upload()
{
  this->IndexCount = 3 * this->Selected.size();
  if (this->IndexCount == 0)
  {
    return true;
  }
  std::vector<glm::vec3> vertices(this->Points.size());
  std::transform(this->Points.begin(), this->Points.end(), vertices.begin(),
    [](const glm::dvec3& p) { return glm::vec3(p); });
  penumbra::ForgetOpenGLErrors();
  if (!this->Vertices->Upload(
        vertices.data(), vertices.size(), vtkOpenGLBufferObject::ArrayBuffer) ||
    !this->Indices->Upload(
      this->Selected.front().data(), this->IndexCount, vtkOpenGLBufferObject::ElementArrayBuffer) ||
    penumbra::HasOpenGLError())
  {
    vtkErrorMacro("OpenGL refused buffers for " << this->Selected.size()
                                                << " triangles that may cast shadows; use fewer.");
    return false;
  }
  return true;
}

void vtkOccluderGeometry::Draw(vtkShaderProgram* program, int instances)
{
  if (this->IndexCount == 0)
  {
    return;
  }
  vtkNew<vtkOpenGLVertexArrayObject> arrays;
  arrays->Bind();
  arrays->AddAttributeArray(
    program, this->Vertices, "vertexUVH", 0, sizeof(glm::vec3), VTK_FLOAT, 3, false);
  this->Indices->Bind();
  glDrawElementsInstanced(
    GL_TRIANGLES, static_cast<GLsizei>(this->IndexCount), GL_UNSIGNED_INT, nullptr, instances);
  this->Indices->Release();
  arrays->ReleaseGraphicsResources();
}

void vtkOccluderGeometry::ReleaseGraphicsResources()
{
  this->Vertices->ReleaseGraphicsResources();
  this->Indices->ReleaseGraphicsResources();
  this->IndexCount = 0;
  this->Points.clear();
  this->Parts.clear();
  this->Selected.clear();
}

void vtkOccluderGeometry::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Triangles: " << this->GetNumberOfTriangles() << "\n";
}

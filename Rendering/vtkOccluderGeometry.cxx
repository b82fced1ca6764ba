// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkOccluderGeometry.h"

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

/// In units of the receiver's size; a texel is some thousand times as large.
constexpr double SmallestContactTolerance = 1e-6;
constexpr double RoundingsInContact = 4.0;

/// Appends the surface's points in the receiver's frame.
void AppendVertices(const penumbra::Surface& surface, const penumbra::ReceiverFrame& frame,
  std::vector<glm::vec3>& vertices)
{
  const std::size_t first = vertices.size();
  vertices.resize(first + surface.Points.size());
  vtkSMPTools::For(0, static_cast<vtkIdType>(surface.Points.size()),
    [&](vtkIdType begin, vtkIdType end)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        vertices[first + i] = glm::vec3(frame.ToFrame(surface.Points[i]));
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

void vtkOccluderGeometry::Build(const penumbra::ShadowScene& scene,
  const penumbra::Receiver& receiver, const penumbra::ReceiverFrame& frame, double maximumHeight)
{
  double rounding = 0.0;
  for (const penumbra::Surface& surface : scene.Surfaces)
  {
    rounding = std::max(rounding, surface.Rounding);
  }
  this->ContactTolerance =
    std::max(SmallestContactTolerance, RoundingsInContact * rounding / frame.GetSize());
  const auto low = static_cast<float>(this->ContactTolerance);
  const auto high = static_cast<float>(maximumHeight);

  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t s = 0; s < scene.Surfaces.size(); ++s)
  {
    const penumbra::Surface& surface = scene.Surfaces[s];
    const auto first = static_cast<std::uint32_t>(vertices.size());
    AppendVertices(surface, frame, vertices);
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      const auto& [a, b, c] = surface.Triangles[t];
      const bool isReceiver = s == receiver.Surface && surface.Regions[t] == receiver.Region;
      const glm::vec3 h(vertices[first + a].z, vertices[first + b].z, vertices[first + c].z);
      if (!isReceiver && std::max({ h.x, h.y, h.z }) > low && std::min({ h.x, h.y, h.z }) < high)
      {
        indices.insert(indices.end(), { first + a, first + b, first + c });
      }
    }
  }
  this->IndexCount = indices.size();
  if (!indices.empty())
  {
    this->Vertices->Upload(vertices.data(), vertices.size(), vtkOpenGLBufferObject::ArrayBuffer);
    this->Indices->Upload(
      indices.data(), indices.size(), vtkOpenGLBufferObject::ElementArrayBuffer);
  }
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
}

void vtkOccluderGeometry::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Triangles: " << this->GetNumberOfTriangles() << "\n";
  os << indent << "ContactTolerance: " << this->ContactTolerance << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkOccluderGeometry.h"

#include "OpenGLErrors.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkShaderProgram.h"

#include <algorithm>
#include <vector>

vtkStandardNewMacro(vtkOccluderGeometry);

vtkOccluderGeometry::vtkOccluderGeometry()
{
  this->Vertices->SetType(vtkOpenGLBufferObject::ArrayBuffer);
  this->Indices->SetType(vtkOpenGLBufferObject::ElementArrayBuffer);
}

vtkOccluderGeometry::~vtkOccluderGeometry() = default;

bool vtkOccluderGeometry::Upload(const penumbra::OccluderSelector& occluders)
{
  const auto& triangles = occluders.GetTriangles();
  this->IndexCount = 3 * triangles.size();
  if (this->IndexCount == 0)
  {
    return true;
  }
  const std::vector<glm::dvec3>& points = occluders.GetPoints();
  std::vector<glm::vec4> vertices(points.size());
  std::transform(points.begin(), points.end(), occluders.GetTops().begin(), vertices.begin(),
    [](const glm::dvec3& p, double top) { return glm::vec4(p, top); });
  penumbra::ForgetOpenGLErrors();
  if (!this->Vertices->Upload(
        vertices.data(), vertices.size(), vtkOpenGLBufferObject::ArrayBuffer) ||
    !this->Indices->Upload(
      triangles.front().data(), this->IndexCount, vtkOpenGLBufferObject::ElementArrayBuffer) ||
    penumbra::HasOpenGLError())
  {
    vtkErrorMacro("OpenGL refused buffers for " << triangles.size()
                                                << " triangles that may cast shadows; use fewer.");
    this->IndexCount = 0;
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
    program, this->Vertices, "vertexUVHT", 0, sizeof(glm::vec4), VTK_FLOAT, 4, false);
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
  os << indent << "Triangles: " << this->IndexCount / 3 << "\n";
}

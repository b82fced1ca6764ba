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
  std::vector<penumbra::OccluderSelector::Triangle> triangles = occluders.GetTriangles();
  this->Sets = { { 0, 3 * triangles.size() } };
  for (const penumbra::Caster& caster : occluders.GetTranslucentCasters())
  {
    this->Sets.push_back({ 3 * (triangles.size() + caster.First), 3 * caster.Triangles });
  }
  const auto& translucent = occluders.GetTranslucent();
  triangles.insert(triangles.end(), translucent.begin(), translucent.end());
  if (triangles.empty())
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
      triangles.front().data(), 3 * triangles.size(), vtkOpenGLBufferObject::ElementArrayBuffer) ||
    penumbra::HasOpenGLError())
  {
    vtkErrorMacro("OpenGL refused buffers for " << triangles.size()
                                                << " triangles that may cast shadows; use fewer.");
    this->Sets.clear();
    return false;
  }
  return true;
}

void vtkOccluderGeometry::Draw(std::size_t set, vtkShaderProgram* program, int instances)
{
  const Range range = set < this->Sets.size() ? this->Sets[set] : Range();
  if (range.Count == 0)
  {
    return;
  }
  vtkNew<vtkOpenGLVertexArrayObject> arrays;
  arrays->Bind();
  arrays->AddAttributeArray(
    program, this->Vertices, "vertexUVHT", 0, sizeof(glm::vec4), VTK_FLOAT, 4, false);
  this->Indices->Bind();
  // OpenGL takes the place in the buffer, in bytes, as a pointer.
  penumbra::ForgetOpenGLErrors();
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(range.Count), GL_UNSIGNED_INT,
    reinterpret_cast<const void*>(range.First * sizeof(GLuint)), instances);
  penumbra::NoteDrawingError();
  this->Indices->Release();
  arrays->ReleaseGraphicsResources();
}

void vtkOccluderGeometry::ReleaseGraphicsResources()
{
  this->Vertices->ReleaseGraphicsResources();
  this->Indices->ReleaseGraphicsResources();
  this->Sets.clear();
}

void vtkOccluderGeometry::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Sets: " << this->Sets.size() << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceResolver.h"

#include "FullScreenTriangle.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkPolygonFormFactor.h"
#include "vtkRadianceResolveFS.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#include "vtkTextureUnitManager.h"
#include "vtkVisibilityMask.h"

#include <array>
#include <string>

vtkStandardNewMacro(vtkRadianceResolver);

namespace
{

/// As in vtkPolygonFormFactor.glsl: a quadrilateral that a plane cuts has five.
constexpr std::size_t MaximumLightVertices = 8;

using UniformVectors = std::array<glm::vec3, MaximumLightVertices>;

void SetVectors(vtkShaderProgram* program, const char* name, const UniformVectors& vectors)
{
  program->SetUniform3fv(name, static_cast<int>(vectors.size()), &vectors.front().x);
}

/// The shader with the light's shape put in.
std::string MakeShader()
{
  std::string source = vtkRadianceResolveFS;
  vtkShaderProgram::Substitute(source, "//Penumbra::LightShape::Dec", vtkPolygonFormFactor);
  return source;
}

} // namespace

vtkRadianceResolver::vtkRadianceResolver() = default;
vtkRadianceResolver::~vtkRadianceResolver() = default;

bool vtkRadianceResolver::Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
  const glm::dvec3& reflectance, const penumbra::PolygonLight& seen,
  const std::vector<glm::dvec3>& samples)
{
  this->Window = window;
  if (seen.GetVertices().size() > MaximumLightVertices)
  {
    vtkErrorMacro("A light has " << seen.GetVertices().size()
                                 << " vertices; allowed: " << MaximumLightVertices);
    return false;
  }
  this->Program = penumbra::ReadyFullScreenProgram(window, MakeShader().c_str());
  if (!this->Program)
  {
    vtkErrorMacro("The shader that resolves visibility masks did not compile.");
    return false;
  }
  this->SetLightUniforms(frame, seen);
  const glm::vec3 share(reflectance);
  this->Program->SetUniform3f("reflectance", &share.x);
  return samples.empty() || this->UploadSamples(frame, samples);
}

void vtkRadianceResolver::SetLightUniforms(
  const penumbra::ReceiverFrame& frame, const penumbra::PolygonLight& seen)
{
  // Edges and spokes are differences of doubles: differences of floats would have few digits left
  // for a small light that is far away.
  const std::vector<glm::dvec3>& v = seen.GetVertices();
  UniformVectors vertices{}, edges{}, spokes{};
  for (std::size_t i = 0; i < v.size(); ++i)
  {
    vertices[i] = glm::vec3(frame.ToMetric(v[i]));
    edges[i] = glm::vec3(frame.DirectionToMetric(v[(i + 1) % v.size()] - v[i]));
    spokes[i] = glm::vec3(frame.DirectionToMetric(v[i] - v[0]));
  }
  vtkShaderProgram* program = this->Program;
  program->SetUniformi("lightVertexCount", static_cast<int>(v.size()));
  SetVectors(program, "lightVertices", vertices);
  SetVectors(program, "lightEdges", edges);
  SetVectors(program, "lightSpokes", spokes);
  const glm::vec3 normal(glm::normalize(frame.DirectionToMetric(seen.GetNormal())));
  program->SetUniform3f("lightNormal", &normal.x);
  program->SetUniformi("lightTwoSided", seen.TwoSided ? 1 : 0);
  const glm::vec3 radiance(seen.Radiance);
  program->SetUniform3f("lightRadiance", &radiance.x);

  const glm::vec3 x(frame.DirectionToMetric(frame.GetBase().EdgeX));
  const glm::vec3 y(frame.DirectionToMetric(frame.GetBase().EdgeY));
  const float edgesInPlane[4] = { x.x, x.y, y.x, y.y };
  program->SetUniform4f("metricEdges", edgesInPlane);
}

bool vtkRadianceResolver::UploadSamples(
  const penumbra::ReceiverFrame& frame, const std::vector<glm::dvec3>& samples)
{
  std::vector<glm::vec4> texels;
  for (const glm::dvec3& sample : samples)
  {
    texels.emplace_back(glm::vec3(frame.ToMetric(sample)), 1.0f);
  }
  this->SampleBuffer->Upload(texels.data(), texels.size(), vtkOpenGLBufferObject::TextureBuffer);
  this->Samples->SetContext(this->Window);
  return this->Samples->CreateTextureBuffer(
    static_cast<unsigned int>(texels.size()), 4, VTK_FLOAT, this->SampleBuffer);
}

void vtkRadianceResolver::Resolve(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, int firstRow, int lastRow, vtkVisibilityMask* masks)
{
  vtkOpenGLState* state = this->Window->GetState();
  vtkTextureUnitManager* units = state->GetTextureUnitManager();
  vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(this->Program);

  // Samplers of different kinds must not share a unit, even if the shader uses neither.
  const int maskUnit = units->Allocate();
  const int sampleUnit = units->Allocate();
  state->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(maskUnit));
  glBindTexture(GL_TEXTURE_2D_ARRAY, masks ? masks->GetTexture() : 0);
  state->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(sampleUnit));
  glBindTexture(GL_TEXTURE_BUFFER, masks ? this->Samples->GetHandle() : 0);
  program->SetUniformi("masks", maskUnit);
  program->SetUniformi("samples", sampleUnit);

  const int count = masks ? static_cast<int>(this->Samples->GetWidth()) : 0;
  program->SetUniformi("sampleCount", count);
  program->SetUniformi("firstHalfCount", (count + 1) / 2);
  program->SetUniform2i("regionOrigin", &region.Origin.x);
  program->SetUniform2i("regionSize", &region.Size.x);
  program->SetUniformi("firstRow", firstRow);

  target->BindAsTarget(region, firstRow, lastRow, true);
  penumbra::DrawFullScreenTriangle();

  glBindTexture(GL_TEXTURE_BUFFER, 0);
  state->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(maskUnit));
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
  units->Free(sampleUnit);
  units->Free(maskUnit);
}

void vtkRadianceResolver::ReleaseGraphicsResources()
{
  if (this->Window)
  {
    this->Samples->ReleaseGraphicsResources(this->Window);
    this->SampleBuffer->ReleaseGraphicsResources();
  }
  this->Program = nullptr;
}

void vtkRadianceResolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Samples: " << this->Samples->GetWidth() << "\n";
}

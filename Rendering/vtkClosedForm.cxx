// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkClosedForm.h"

#include "FullScreenTriangle.h"
#include "PolygonLight.h"
#include "ReceiverTexels.h"
#include "vtkClosedFormFS.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkPolygonFormFactor.h"
#include "vtkSMPTools.h"
#include "vtkShaderProgram.h"
#include "vtkStageTexture.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

vtkStandardNewMacro(vtkClosedForm);

namespace
{

using UniformVectors = std::array<glm::vec3, penumbra::LightShape::MaximumVertices>;

void SetVectors(vtkShaderProgram* program, const char* name, const UniformVectors& vectors)
{
  program->SetUniform3fv(name, static_cast<int>(vectors.size()), &vectors.front().x);
}

void SetPolygonUniforms(vtkShaderProgram* program, const penumbra::ReceiverFrame& frame,
  const penumbra::EmittingPolygon& emitting)
{
  // Edges and spokes are differences of doubles: differences of floats would have few digits left
  // for a small light that is far away.
  const std::vector<glm::dvec3>& v = emitting.Polygon->GetVertices();
  UniformVectors vertices{}, edges{}, spokes{};
  for (std::size_t i = 0; i < v.size(); ++i)
  {
    vertices[i] = glm::vec3(frame.ToMetric(v[i]));
    edges[i] = glm::vec3(frame.DirectionToMetric(v[(i + 1) % v.size()] - v[i]));
    spokes[i] = glm::vec3(frame.DirectionToMetric(v[i] - v[0]));
  }
  program->SetUniformi("lightVertexCount", static_cast<int>(v.size()));
  SetVectors(program, "lightVertices", vertices);
  SetVectors(program, "lightEdges", edges);
  SetVectors(program, "lightSpokes", spokes);
  const glm::vec3 normal(glm::normalize(frame.DirectionToMetric(emitting.Polygon->GetNormal())));
  program->SetUniform3f("lightNormal", &normal.x);
  program->SetUniformi("lightTwoSided", emitting.Polygon->TwoSided ? 1 : 0);
  const glm::vec3 radiance(emitting.Radiance);
  program->SetUniform3f("lightRadiance", &radiance.x);
}

/// Which of the two arrangements of vtkPolygonFormFactor.glsl keeps more digits where most light
/// arrives. A light whose extent, as seen from the distance r, is d / r, and that rises to z / r,
/// gives at most its area's share of that: of it, the first loses the inverse of z / r, and the
/// second that of d / z.
bool IsLow(const penumbra::ReceiverFrame& frame, const penumbra::PolygonLight& polygon)
{
  const glm::dvec3 x = frame.DirectionToMetric(frame.GetBase().EdgeX);
  const glm::dvec3 y = frame.DirectionToMetric(frame.GetBase().EdgeY);
  const glm::dvec3 reach = 0.5 * (glm::abs(x) + glm::abs(y));
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& vertex : polygon.GetVertices())
  {
    const glm::dvec3 v = frame.ToMetric(vertex);
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  const glm::dvec3 gap = glm::max(glm::max(low - reach, -reach - high), glm::dvec3(0.0));
  const double nearest = std::max(glm::length(gap), high.z);
  return high.z * high.z < glm::length(high - low) * nearest;
}

} // namespace

vtkClosedForm::vtkClosedForm() = default;
vtkClosedForm::~vtkClosedForm() = default;

bool vtkClosedForm::Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
  const penumbra::LightShape& seen, const glm::ivec2& texels, const glm::ivec2& largest)
{
  this->Window = window;
  this->Frame = frame;
  this->Seen = &seen;
  this->Texels = texels;
  this->Programs.fill(nullptr);
  for (const penumbra::EmittingPolygon& polygon : seen.GetPolygons())
  {
    if (!this->PrepareProgram(IsLow(frame, *polygon.Polygon)))
    {
      vtkErrorMacro("The shader of unoccluded lights did not compile. There is no bake; update the "
                    "OpenGL driver.");
      return false;
    }
  }
  return this->Texture->Allocate(window, largest, 4);
}

bool vtkClosedForm::PrepareProgram(bool isLow)
{
  vtkShaderProgram*& program = this->Programs[isLow ? 1 : 0];
  if (!program)
  {
    std::string source = penumbra::WithReceiverTexels(vtkClosedFormFS);
    vtkShaderProgram::Substitute(source, "//Penumbra::FormFactor::Dec", vtkPolygonFormFactor);
    vtkShaderProgram::Substitute(source, "//Penumbra::LightIsLow::Dec",
      std::string("#define LIGHT_IS_LOW ") + (isLow ? "1" : "0"));
    program = penumbra::ReadyFullScreenProgram(this->Window, source.c_str());
  }
  return program;
}

void vtkClosedForm::Draw(const penumbra::TexelRectangle& rectangle)
{
  if (this->Programs[0] || this->Programs[1])
  {
    this->DrawPolygons(rectangle);
  }
  else
  {
    this->Evaluate(rectangle);
  }
}

void vtkClosedForm::DrawPolygons(const penumbra::TexelRectangle& rectangle)
{
  bool add = false; // the first polygon replaces what is there
  for (const penumbra::EmittingPolygon& polygon : this->Seen->GetPolygons())
  {
    vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(
      this->Programs[IsLow(this->Frame, *polygon.Polygon) ? 1 : 0]);
    penumbra::SetReceiverTexels(program, this->Frame, this->Texels, rectangle.Low);
    SetPolygonUniforms(program, this->Frame, polygon);
    this->Texture->BindAsTarget(penumbra::WholeRectangle(rectangle.GetSize()), add);
    penumbra::DrawFullScreenTriangle();
    add = true;
  }
}

void vtkClosedForm::Evaluate(const penumbra::TexelRectangle& rectangle)
{
  const glm::ivec2 size = rectangle.GetSize();
  std::vector<glm::vec4> values(
    static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  const glm::dvec3 normal = this->Frame.GetNormal();
  vtkSMPTools::For(0, size.y,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType row = begin; row < end; ++row)
      {
        for (int i = 0; i < size.x; ++i)
        {
          const glm::dvec2 texel = glm::dvec2(rectangle.Low) + glm::dvec2(i, row) + 0.5;
          const glm::dvec3 x = this->Frame.ToWorld({ texel / glm::dvec2(this->Texels), 0.0 });
          values[static_cast<std::size_t>(row * size.x + i)] =
            glm::vec4(this->Seen->Irradiance(x, normal), 0.0);
        }
      }
    });
  this->Texture->Upload(size, &values.front().x);
}

void vtkClosedForm::ReleaseGraphicsResources()
{
  this->Texture->ReleaseGraphicsResources();
  this->Programs.fill(nullptr);
  this->Seen = nullptr;
}

void vtkClosedForm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Texels: " << this->Texels.x << " x " << this->Texels.y << "\n";
}

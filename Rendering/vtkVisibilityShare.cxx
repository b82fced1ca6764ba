// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkVisibilityShare.h"

#include "FullScreenTriangle.h"
#include "OpenGLErrors.h"
#include "PolygonLight.h"
#include "ReceiverTexels.h"
#include "ScopedTexture.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"
#include "vtkStageTexture.h"
#include "vtkTextureObject.h"
#include "vtkVisibilityMask.h"
#include "vtkVisibilityShareFS.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

vtkStandardNewMacro(vtkVisibilityShare);

namespace
{

/// The unit in which the shader measures distances to a light, in those of the metric frame: the
/// power of two below the light's distance, so that the fourth power of a distance is in the range
/// of floats wherever the light is; 1 for what is close. Powers of two change no bit of a share.
double GetLengthUnit(const penumbra::LightShape& light, const penumbra::ReceiverFrame& frame)
{
  const penumbra::LightHull hull = light.GetHull();
  double farthest = 1.0;
  for (const glm::dvec3& point : hull.AreDirections ? std::vector<glm::dvec3>() : hull.Points)
  {
    const glm::dvec3 place = glm::abs(frame.ToMetric(point));
    farthest = std::max({ farthest, place.x, place.y, place.z });
  }
  return std::exp2(std::floor(std::log2(farthest)));
}

/// The radiance times area of a light of cells, by which that of the samples is divided: only
/// ratios count, and floats must hold them.
glm::dvec3 GetPower(const penumbra::LightShape& light)
{
  glm::dvec3 power(0.0);
  for (const penumbra::EmittingPolygon& cell : light.GetPolygons())
  {
    power += cell.Radiance * cell.Polygon->GetArea();
  }
  return power;
}

} // namespace

vtkVisibilityShare::vtkVisibilityShare() = default;
vtkVisibilityShare::~vtkVisibilityShare() = default;

std::vector<int> vtkVisibilityShare::GetBatchEnds(int samples)
{
  constexpr int SmallestBatch = 64; // fewer say little of their error
  std::vector<int> ends{ samples };
  for (int count = (samples + 1) / 2; count >= SmallestBatch; count = (count + 1) / 2)
  {
    ends.insert(ends.begin(), count);
  }
  return ends;
}

bool vtkVisibilityShare::Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
  const penumbra::LightShape& seen, const glm::ivec2& texels, const glm::ivec2& size,
  bool inBatches, bool translucent)
{
  this->Window = window;
  this->Frame = frame;
  this->Texels = texels;
  this->IsTranslucent = translucent;
  this->TranslucentCount = 0;
  this->HasCells = seen.GetEmission() == penumbra::Emission::Cells;
  this->Power = this->HasCells ? GetPower(seen) : glm::dvec3(0.0);
  std::string source = penumbra::WithReceiverTexels(vtkVisibilityShareFS);
  vtkShaderProgram::Substitute(source, "//Penumbra::Emission::Dec",
    "#define EMISSION " + std::to_string(static_cast<int>(seen.GetEmission())));
  vtkShaderProgram::Substitute(source, "//Penumbra::Translucent::Dec",
    std::string("#define TRANSLUCENT ") + (translucent ? "1" : "0"));
  this->Program = penumbra::ReadyFullScreenProgram(window, source.c_str());
  if (!this->Program)
  {
    vtkErrorMacro(
      "The shader that counts visibility masks did not compile. There is no bake; update "
      "the OpenGL driver.");
    return false;
  }
  const glm::vec3 axis(glm::normalize(frame.DirectionToMetric(seen.GetAxis())));
  this->Program->SetUniform3f("lightAxis", &axis.x);
  this->LengthUnit = GetLengthUnit(seen, frame);
  this->Program->SetUniformi("lightTwoSided", seen.TwoSided ? 1 : 0);
  this->Components = inBatches ? 4 : 2; // with the sums to go on from
  return this->Textures[this->Current]->Allocate(window, size, this->Components);
}

bool vtkVisibilityShare::SetSamples(
  const std::vector<penumbra::LightSample>& samples, const glm::dvec3& channels, int previousCount)
{
  this->SampleCount = static_cast<int>(samples.size());
  this->PreviousCount = previousCount;
  std::vector<glm::vec4> places, cells;
  const double power = glm::dot(channels, this->Power);
  for (const penumbra::LightSample& sample : samples)
  {
    glm::dvec3 place = sample.IsDirection
      ? this->Frame.DirectionToMetric(sample.Place) * this->Frame.GetSize()
      : this->Frame.ToMetric(sample.Place);
    // What is below the plane is rounding; a weight below 0 would take shares out of [0, 1].
    place.z = std::max(place.z, 0.0);
    place = sample.IsDirection ? place : place / this->LengthUnit;
    places.emplace_back(place, sample.IsDirection ? 0.0 : 1.0);
    const glm::dvec3 normal = this->Frame.DirectionToMetric(sample.Normal) * this->Frame.GetSize();
    cells.emplace_back(
      glm::vec3(normal), power > 0.0 ? glm::dot(channels, sample.Power) / power : 0.0);
  }
  if (!this->UploadBuffer(this->SampleBuffer, this->Samples, places) ||
    (this->HasCells && !this->UploadBuffer(this->CellBuffer, this->Cells, cells)))
  {
    vtkErrorMacro("OpenGL refused a buffer of " << samples.size() << " samples; ask for fewer.");
    return false;
  }
  if (previousCount > 0)
  {
    const glm::ivec2 size = this->Textures[this->Current]->GetSize();
    this->Current = 1 - this->Current;
    return this->Textures[this->Current]->Allocate(this->Window, size, this->Components);
  }
  return true;
}

bool vtkVisibilityShare::SetTransmittances(const std::vector<double>& transmittances)
{
  this->TranslucentCount = static_cast<int>(transmittances.size());
  std::vector<glm::vec4> values;
  for (const double transmittance : transmittances)
  {
    values.emplace_back(transmittance);
  }
  if (!values.empty() &&
    !this->UploadBuffer(this->TransmittanceBuffer, this->Transmittances, values))
  {
    vtkErrorMacro("OpenGL refused a buffer of " << values.size()
                                                << " transmittances; hide translucent surfaces.");
    return false;
  }
  return true;
}

bool vtkVisibilityShare::UploadBuffer(
  vtkOpenGLBufferObject* buffer, vtkTextureObject* texture, const std::vector<glm::vec4>& values)
{
  penumbra::ForgetOpenGLErrors();
  return buffer->Upload(values.data(), values.size(), vtkOpenGLBufferObject::TextureBuffer) &&
    !penumbra::HasOpenGLError() &&
    penumbra::MakeTextureOfBuffer(texture, this->Window, buffer, static_cast<int>(values.size()));
}

void vtkVisibilityShare::Count(vtkVisibilityMask* masks, const glm::ivec2& maskFirstTexel,
  const penumbra::TexelRectangle& rectangle, const glm::ivec2& firstTexel)
{
  vtkOpenGLState* state = this->Window->GetState();
  vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(this->Program);
  const penumbra::ScopedTexture maskTexture(
    state, program, "masks", GL_TEXTURE_2D_ARRAY, masks->GetTexture());
  const penumbra::ScopedTexture sampleTexture(
    state, program, "samples", GL_TEXTURE_BUFFER, this->Samples->GetHandle());
  const penumbra::ScopedTexture cellTexture(state, program, "cells", GL_TEXTURE_BUFFER,
    this->HasCells ? this->Cells->GetHandle() : this->Samples->GetHandle());
  const penumbra::ScopedTexture previous(state, program, "previous", GL_TEXTURE_2D,
    this->PreviousCount > 0 ? this->Textures[1 - this->Current]->GetHandle() : 0);
  std::optional<penumbra::ScopedTexture> transmittances;
  if (this->IsTranslucent)
  {
    transmittances.emplace(state, program, "transmittances", GL_TEXTURE_BUFFER,
      this->TranslucentCount > 0 ? this->Transmittances->GetHandle() : 0);
    program->SetUniformi("translucentCount", this->TranslucentCount);
  }

  program->SetUniform2i("maskFirstTexel", &maskFirstTexel.x);
  program->SetUniformi("sampleCount", this->SampleCount);
  program->SetUniformi("halvings", static_cast<int>(GetBatchEnds(this->SampleCount).size()));
  program->SetUniformf("lengthUnit", static_cast<float>(this->LengthUnit));
  program->SetUniformi("previousCount", this->PreviousCount);
  program->SetUniformi("maskFirstWord", this->PreviousCount / vtkVisibilityMask::SamplesPerLayer);
  penumbra::SetReceiverTexels(program, this->Frame, this->Texels, firstTexel);
  this->GetTexture()->BindAsTarget(
    { rectangle.Low - firstTexel, rectangle.High - firstTexel }, false);
  penumbra::DrawFullScreenTriangle();
}

bool vtkVisibilityShare::Extend(
  const penumbra::TexelRectangle& from, const penumbra::TexelRectangle& to)
{
  vtkStageTexture* old = this->Textures[this->Current];
  vtkStageTexture* extended = this->Textures[1 - this->Current];
  if (!extended->Allocate(this->Window, to.GetSize(), this->Components))
  {
    return false;
  }
  const penumbra::TexelRectangle both = from.Intersection(to);
  extended->FillAndCopy(glm::vec4(1.0f, 0.0f, 0.0f, 0.0f), old,
    { both.Low - from.Low, both.High - from.Low }, both.Low - to.Low);
  old->ReleaseGraphicsResources();
  this->Current = 1 - this->Current;
  return true;
}

vtkStageTexture* vtkVisibilityShare::GetTexture()
{
  return this->Textures[this->Current];
}

std::size_t vtkVisibilityShare::GetBytes() const
{
  return this->Textures[0]->GetBytes() + this->Textures[1]->GetBytes();
}

void vtkVisibilityShare::ReleaseSamples()
{
  if (this->Window)
  {
    this->Samples->ReleaseGraphicsResources(this->Window);
    this->SampleBuffer->ReleaseGraphicsResources();
    this->Cells->ReleaseGraphicsResources(this->Window);
    this->CellBuffer->ReleaseGraphicsResources();
    this->Transmittances->ReleaseGraphicsResources(this->Window);
    this->TransmittanceBuffer->ReleaseGraphicsResources();
  }
}

void vtkVisibilityShare::ReleaseGraphicsResources()
{
  this->ReleaseSamples();
  this->Textures[0]->ReleaseGraphicsResources();
  this->Textures[1]->ReleaseGraphicsResources();
  this->Program = nullptr;
}

void vtkVisibilityShare::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Samples: " << this->SampleCount << "\n";
  os << indent << "PreviousCount: " << this->PreviousCount << "\n";
  os << indent << "Translucent: " << this->TranslucentCount << "\n";
}

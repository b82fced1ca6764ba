// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceResolver.h"

#include "FullScreenTriangle.h"
#include "ScopedTexture.h"
#include "vtkClosedForm.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkRadianceResolveFS.h"
#include "vtkShaderProgram.h"
#include "vtkStageTexture.h"
#include "vtkVisibilityShare.h"

#include <algorithm>
#include <memory>
#include <string>

vtkStandardNewMacro(vtkRadianceResolver);

namespace
{

/// An eighth of the receiver at a time: what the stages hand on then takes 3 bytes a texel.
constexpr int Strips = 8;
constexpr int MostStripRows = 64;
/// How far vtkRadianceResolveFS.glsl looks across texels.
constexpr int ReconstructionRadius = 3;

} // namespace

vtkRadianceResolver::vtkRadianceResolver() = default;
vtkRadianceResolver::~vtkRadianceResolver() = default;

bool vtkRadianceResolver::Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
  const penumbra::LightShape& seen, const glm::ivec2& texels, const Options& options)
{
  this->Window = window;
  this->Chosen = options;
  this->Texels = texels;
  this->StripRows = std::clamp(texels.y / Strips, 1, MostStripRows);
  this->ShareCount = seen.HasOneHue() ? 1 : 3;
  std::string source = vtkRadianceResolveFS;
  vtkShaderProgram::Substitute(
    source, "//Penumbra::Shares::Dec", "#define SHARES " + std::to_string(this->ShareCount));
  this->Program = penumbra::ReadyFullScreenProgram(window, source.c_str());
  if (!this->Program)
  {
    vtkErrorMacro("The shader that resolves shadows did not compile. There is no bake; update the "
                  "OpenGL driver.");
    return false;
  }
  const int shareRows = options.InBatches ? texels.y : this->StripRows + 2 * this->GetHalo();
  bool isReady = this->ClosedForm->Begin(window, frame, seen, texels, this->StripRows);
  for (int i = 0; i < this->ShareCount; ++i)
  {
    isReady =
      isReady && this->Share[i]->Begin(window, frame, seen, texels, shareRows, options.InBatches);
  }
  return isReady;
}

bool vtkRadianceResolver::SetSamples(
  const std::vector<penumbra::LightSample>& samples, int previousCount)
{
  bool isReady = true;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    isReady = isReady && this->Share[i]->SetSamples(samples, this->GetChannels(i), previousCount);
  }
  return isReady;
}

glm::dvec3 vtkRadianceResolver::GetChannels(int share) const
{
  glm::dvec3 channels(this->ShareCount > 1 ? 0.0 : 1.0);
  channels[share] = 1.0;
  return channels;
}

int vtkRadianceResolver::GetHalo() const
{
  return this->Chosen.Reconstruction ? ReconstructionRadius : 0;
}

void vtkRadianceResolver::ResolveUnblocked(
  vtkRadianceTexture* target, const vtkRadianceTexture::Region& region)
{
  for (int row = 0; row < this->Texels.y; row += this->StripRows)
  {
    const int end = std::min(row + this->StripRows, this->Texels.y);
    this->ResolveStrip(target, region, row, end, Shares::None, true);
  }
}

void vtkRadianceResolver::ResolveMasks(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, int firstRow, int lastRow, vtkVisibilityMask* masks,
  int maskFirstRow)
{
  for (int row = firstRow; row < lastRow; row += this->StripRows)
  {
    const int end = std::min(row + this->StripRows, lastRow);
    const int first = std::max(row - this->GetHalo(), 0);
    const int last = std::min(end + this->GetHalo(), this->Texels.y);
    for (int i = 0; i < this->ShareCount; ++i)
    {
      this->Share[i]->Count(masks, maskFirstRow, first, last, 0);
    }
    this->ResolveStrip(target, region, row, end, Shares::Strip, true);
  }
}

void vtkRadianceResolver::CountMasks(
  vtkVisibilityMask* masks, int maskFirstRow, int firstRow, int lastRow)
{
  for (int i = 0; i < this->ShareCount; ++i)
  {
    this->Share[i]->Count(masks, maskFirstRow, firstRow, lastRow, firstRow);
  }
}

void vtkRadianceResolver::ResolveCounts(
  vtkRadianceTexture* target, const vtkRadianceTexture::Region& region, bool add)
{
  for (int row = 0; row < this->Texels.y; row += this->StripRows)
  {
    const int end = std::min(row + this->StripRows, this->Texels.y);
    this->ResolveStrip(target, region, row, end, Shares::All, add);
  }
}

void vtkRadianceResolver::ResolveStrip(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, int firstRow, int lastRow, Shares shares, bool add)
{
  this->ClosedForm->Draw(firstRow, lastRow);
  vtkOpenGLState* state = this->Window->GetState();
  vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(this->Program);
  const penumbra::ScopedTexture closedForm(
    state, program, "closedForm", GL_TEXTURE_2D, this->ClosedForm->GetTexture()->GetHandle());
  program->SetUniformi("firstRow", firstRow);
  program->SetUniformi("reconstruction", this->Chosen.Reconstruction ? 1 : 0);
  program->SetUniformi("hasShares", shares == Shares::None ? 0 : 1);
  program->SetUniformi(
    "sharesFirstRow", shares == Shares::Strip ? std::max(firstRow - this->GetHalo(), 0) : 0);
  program->SetUniform2i("regionOrigin", &region.Origin.x);
  program->SetUniform2i("regionSize", &region.Size.x);
  const glm::vec3 reflectance(this->Chosen.Reflectance);
  program->SetUniform3f("reflectance", &reflectance.x);
  target->BindAsTarget(region, firstRow, lastRow, add);
  constexpr const char* samplers[] = { "shares", "greenShares", "blueShares" };
  std::vector<std::unique_ptr<penumbra::ScopedTexture>> textures;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    textures.push_back(std::make_unique<penumbra::ScopedTexture>(state, program, samplers[i],
      GL_TEXTURE_2D, shares == Shares::None ? 0 : this->Share[i]->GetTexture()->GetHandle()));
  }
  penumbra::DrawFullScreenTriangle();
}

std::size_t vtkRadianceResolver::GetBytes() const
{
  std::size_t bytes = this->ClosedForm->GetTexture()->GetBytes();
  for (int i = 0; i < this->ShareCount; ++i)
  {
    bytes += this->Share[i]->GetBytes();
  }
  return bytes;
}

void vtkRadianceResolver::ReleaseGraphicsResources()
{
  this->ClosedForm->ReleaseGraphicsResources();
  for (const vtkNew<vtkVisibilityShare>& share : this->Share)
  {
    share->ReleaseGraphicsResources();
  }
  this->Program = nullptr;
}

void vtkRadianceResolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "StripRows: " << this->StripRows << "\n";
}

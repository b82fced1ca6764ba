// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceResolver.h"

#include "FullScreenTriangle.h"
#include "ScopedTexture.h"
#include "vtkClosedForm.h"
#include "vtkExactShare.h"
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

std::size_t vtkRadianceResolver::KeptShares::GetBytes() const
{
  std::size_t bytes = 0;
  for (const vtkSmartPointer<vtkVisibilityShare>& share : this->Shares)
  {
    bytes += share ? share->GetBytes() : 0;
  }
  return bytes;
}

int vtkRadianceResolver::KeptShares::GetCount() const
{
  return static_cast<int>(std::count_if(this->Shares.begin(), this->Shares.end(),
    [](const vtkSmartPointer<vtkVisibilityShare>& share) { return share != nullptr; }));
}

void vtkRadianceResolver::KeptShares::Release()
{
  for (vtkSmartPointer<vtkVisibilityShare>& share : this->Shares)
  {
    if (share)
    {
      share->ReleaseGraphicsResources();
    }
    share = nullptr;
  }
  this->Stored = {};
}

bool vtkRadianceResolver::KeptShares::Extend(const penumbra::TexelRectangle& needed)
{
  const penumbra::TexelRectangle extended = this->Stored.Union(needed);
  bool isDone = true;
  for (const vtkSmartPointer<vtkVisibilityShare>& share : this->Shares)
  {
    isDone = isDone && (!share || share->Extend(this->Stored, extended));
  }
  this->Stored = extended;
  return isDone;
}

vtkRadianceResolver::vtkRadianceResolver() = default;
vtkRadianceResolver::~vtkRadianceResolver() = default;

bool vtkRadianceResolver::Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
  const penumbra::LightShape& seen, const glm::ivec2& texels,
  const penumbra::TexelRectangle& resolved, const penumbra::TexelRectangle& shaded,
  const Options& options)
{
  this->Window = window;
  this->Chosen = options;
  this->Texels = texels;
  this->Shaded = shaded;
  this->StripSize = { resolved.GetSize().x, std::clamp(texels.y / Strips, 1, MostStripRows) };
  this->ShareCount = CountShares(seen, options.Tinted);
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
  this->SetExact(nullptr);
  if (!this->ClosedForm->Begin(window, frame, seen, texels, this->StripSize))
  {
    return false;
  }
  this->Stored = this->GetMaskRectangle(resolved);
  if (this->Stored.IsEmpty())
  {
    return true;
  }
  glm::ivec2 size = this->Stored.GetSize();
  if (options.Kept)
  {
    if (options.Kept->Stored.IsEmpty())
    {
      options.Kept->Stored = this->Stored;
    }
    this->Stored = options.Kept->Stored;
    size = this->Stored.GetSize();
  }
  else if (!options.InBatches)
  {
    size.y = std::min(size.y, this->StripSize.y + 2 * this->GetHalo());
  }
  bool isReady = true;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    isReady = isReady &&
      this->GetShare(i)->Begin(
        window, frame, seen, texels, size, options.InBatches, options.Translucent);
  }
  return isReady;
}

vtkVisibilityShare* vtkRadianceResolver::GetShare(int index)
{
  const auto i = static_cast<std::size_t>(index);
  if (!this->Chosen.Kept)
  {
    return this->Share[i];
  }
  vtkSmartPointer<vtkVisibilityShare>& kept = this->Chosen.Kept->Shares[i];
  if (!kept)
  {
    kept = vtkSmartPointer<vtkVisibilityShare>::New();
  }
  return kept;
}

bool vtkRadianceResolver::SetSamples(
  const std::vector<penumbra::LightSample>& samples, int previousCount)
{
  bool isReady = true;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    isReady =
      isReady && this->GetShare(i)->SetSamples(samples, this->GetChannels(i), previousCount);
  }
  return isReady;
}

bool vtkRadianceResolver::SetTransmittances(const std::vector<glm::dvec3>& transmittances)
{
  bool isReady = true;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    std::vector<double> own;
    for (const glm::dvec3& transmittance : transmittances)
    {
      own.push_back(transmittance[i]); // without tint all components are alike
    }
    isReady = isReady && this->GetShare(i)->SetTransmittances(own);
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

int vtkRadianceResolver::GetReconstructionHalo()
{
  return ReconstructionRadius;
}

int vtkRadianceResolver::CountShares(const penumbra::LightShape& light, bool tinted)
{
  return light.HasOneHue() && !tinted ? 1 : 3;
}

std::size_t vtkRadianceResolver::GetKeptBytesPerTexel(
  const penumbra::LightShape& light, bool tinted)
{
  return static_cast<std::size_t>(CountShares(light, tinted)) * sizeof(glm::vec2);
}

penumbra::TexelRectangle vtkRadianceResolver::GetMaskRectangle(
  const penumbra::TexelRectangle& resolved) const
{
  return GetMaskRectangle(resolved, this->Shaded, this->Chosen.Reconstruction, this->Texels);
}

penumbra::TexelRectangle vtkRadianceResolver::GetMaskRectangle(
  const penumbra::TexelRectangle& resolved, const penumbra::TexelRectangle& shaded,
  bool reconstruction, const glm::ivec2& texels)
{
  const int halo = reconstruction ? ReconstructionRadius : 0;
  return shaded.Grown(halo)
    .Intersection(resolved.Grown(halo))
    .Intersection(penumbra::WholeRectangle(texels));
}

template <typename Use>
void vtkRadianceResolver::ForEachStrip(const penumbra::TexelRectangle& rectangle, const Use& use)
{
  for (int row = rectangle.Low.y; row < rectangle.High.y && !rectangle.IsEmpty();
       row += this->StripSize.y)
  {
    use(rectangle.Rows(row, std::min(row + this->StripSize.y, rectangle.High.y)));
  }
}

void vtkRadianceResolver::ResolveUniform(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, const penumbra::TexelRectangle& rectangle, float share)
{
  StripShares shares;
  shares.Uniform = share;
  this->ForEachStrip(rectangle,
    [&](const penumbra::TexelRectangle& strip)
    { this->ResolveStrip(target, region, strip, shares, true); });
}

void vtkRadianceResolver::ResolveMasks(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, const penumbra::TexelRectangle& rectangle,
  vtkVisibilityMask* masks, const glm::ivec2& maskFirstTexel)
{
  StripShares shares;
  shares.HasTextures = true;
  this->ForEachStrip(rectangle,
    [&](const penumbra::TexelRectangle& strip)
    {
      const penumbra::TexelRectangle around = this->GetMaskRectangle(strip);
      shares.FirstTexel = around.Low;
      for (int i = 0; i < this->ShareCount; ++i)
      {
        this->GetShare(i)->Count(masks, maskFirstTexel, around, around.Low);
      }
      this->ResolveStrip(target, region, strip, shares, true);
    });
}

void vtkRadianceResolver::CountMasks(vtkVisibilityMask* masks, const glm::ivec2& maskFirstTexel,
  const penumbra::TexelRectangle& rectangle)
{
  for (int i = 0; i < this->ShareCount; ++i)
  {
    this->GetShare(i)->Count(masks, maskFirstTexel, rectangle, this->Stored.Low);
  }
}

void vtkRadianceResolver::ResolveCounts(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, const penumbra::TexelRectangle& rectangle, bool add)
{
  StripShares shares;
  shares.HasTextures = true;
  shares.FirstTexel = this->Stored.Low;
  this->ForEachStrip(rectangle,
    [&](const penumbra::TexelRectangle& strip)
    { this->ResolveStrip(target, region, strip, shares, add); });
}

void vtkRadianceResolver::ResolveStrip(vtkRadianceTexture* target,
  const vtkRadianceTexture::Region& region, const penumbra::TexelRectangle& strip,
  const StripShares& shares, bool add)
{
  const bool hasExact = shares.HasTextures &&
    this->Exact->Find(
      this->GetShare(0)->GetTexture(), shares.FirstTexel, this->GetMaskRectangle(strip), strip);
  this->ClosedForm->Draw(strip);
  vtkOpenGLState* state = this->Window->GetState();
  vtkShaderProgram* program = this->Window->GetShaderCache()->ReadyShaderProgram(this->Program);
  const penumbra::ScopedTexture closedForm(
    state, program, "closedForm", GL_TEXTURE_2D, this->ClosedForm->GetTexture()->GetHandle());
  program->SetUniform2i("firstTexel", &strip.Low.x);
  program->SetUniformi("reconstruction", this->Chosen.Reconstruction ? 1 : 0);
  program->SetUniformi("hasShares", shares.HasTextures ? 1 : 0);
  program->SetUniformf("uniformShare", shares.Uniform);
  program->SetUniformi("hasExact", hasExact ? 1 : 0);
  const penumbra::ScopedTexture exact(state, program, "exactShares", GL_TEXTURE_2D,
    hasExact ? this->Exact->GetTexture()->GetHandle() : 0);
  program->SetUniform2i("sharesFirstTexel", &shares.FirstTexel.x);
  const glm::vec3 reflectance(this->Chosen.Reflectance);
  program->SetUniform3f("reflectance", &reflectance.x);
  constexpr const char* samplers[] = { "shares", "greenShares", "blueShares" };
  std::vector<std::unique_ptr<penumbra::ScopedTexture>> textures;
  for (int i = 0; i < this->ShareCount; ++i)
  {
    textures.push_back(std::make_unique<penumbra::ScopedTexture>(state, program, samplers[i],
      GL_TEXTURE_2D, shares.HasTextures ? this->GetShare(i)->GetTexture()->GetHandle() : 0));
  }
  target->Draw(program, region, strip, add);
}

bool vtkRadianceResolver::SetExact(const penumbra::PolygonVisibility* exact)
{
  return this->Exact->Begin(exact, this->Window, this->Texels, this->StripSize);
}

std::size_t vtkRadianceResolver::GetExactCount() const
{
  return this->Exact->GetCount();
}

std::size_t vtkRadianceResolver::GetBytes() const
{
  std::size_t bytes =
    this->ClosedForm->GetTexture()->GetBytes() + this->Exact->GetTexture()->GetBytes();
  for (const vtkNew<vtkVisibilityShare>& share : this->Share)
  {
    bytes += share->GetBytes();
  }
  return bytes;
}

void vtkRadianceResolver::ReleaseGraphicsResources()
{
  this->ClosedForm->ReleaseGraphicsResources();
  this->Exact->ReleaseGraphicsResources();
  for (const vtkNew<vtkVisibilityShare>& share : this->Share)
  {
    share->ReleaseGraphicsResources();
  }
  this->Program = nullptr;
}

void vtkRadianceResolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "StripRows: " << this->StripSize.y << "\n";
}

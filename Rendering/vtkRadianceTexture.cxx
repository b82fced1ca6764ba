// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkRadianceTexture.h"

#include "FullScreenTriangle.h"
#include "OpenGLErrors.h"
#include "ScopedTexture.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceDownsampleFS.h"
#include "vtkRadianceMeanFS.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

vtkStandardNewMacro(vtkRadianceTexture);

namespace
{

constexpr int AllMipLevels = 1000; // OpenGL's own default

/// What graphics processors have offered for decades.
constexpr int HardwareAnisotropy = 16;

/// Whether OpenGL is known to run on the central processor.
bool IsSoftwareOpenGL()
{
  const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string renderer = text ? text : "";
  const auto names = { "llvmpipe", "softpipe", "SWR", "SwiftShader", "Software Rasterizer" };
  return std::any_of(names.begin(), names.end(),
    [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

vtkSmartPointer<vtkTextureObject> MakeTexture()
{
  auto texture = vtkSmartPointer<vtkTextureObject>::New();
  texture->SetWrapS(vtkTextureObject::ClampToEdge);
  texture->SetWrapT(vtkTextureObject::ClampToEdge);
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  return texture;
}

} // namespace

vtkRadianceTexture::vtkRadianceTexture()
  : Irradiance(MakeTexture())
  , Variance(MakeTexture())
{
}

vtkRadianceTexture::~vtkRadianceTexture() = default;

bool vtkRadianceTexture::Allocate(vtkOpenGLRenderWindow* window,
  const std::vector<penumbra::AtlasReceiver>& receivers, bool withVariance)
{
  this->ReleaseGraphicsResources();
  this->Window = window;
  const int largestSide = vtkTextureObject::GetMaximumTextureSize(window);
  this->Layout = penumbra::AtlasLayout(receivers, largestSide);
  const glm::ivec2 size = this->Layout.Size;
  if (size.x > largestSide || size.y > largestSide)
  {
    vtkErrorMacro("The " << receivers.size() << " receivers of a surface need a texture of "
                         << size.x << " x " << size.y << " texels; OpenGL allows " << largestSide
                         << " a side. Use a larger TexelSize.");
    return false;
  }
  if (!penumbra::AllocateTexture(this->Irradiance, window, size, 4, VTK_FLOAT) ||
    (withVariance && !penumbra::AllocateTexture(this->Variance, window, size, 1, VTK_FLOAT)))
  {
    vtkErrorMacro("OpenGL refused a texture of " << size.x << " x " << size.y
                                                 << " texels. Use a larger TexelSize.");
    this->ReleaseGraphicsResources();
    return false;
  }
  this->HasVariance = withVariance;
  this->Clear({ glm::ivec2(0), size }, penumbra::WholeRectangle(size));
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
  {
    vtkErrorMacro("OpenGL does not draw into textures of floats. There is no bake; update the "
                  "OpenGL driver.");
    this->ReleaseGraphicsResources();
    return false;
  }
  return true;
}

void vtkRadianceTexture::Swap(vtkRadianceTexture* other)
{
  std::swap(this->Window, other->Window);
  std::swap(this->Irradiance, other->Irradiance);
  std::swap(this->Variance, other->Variance);
  std::swap(this->Layout, other->Layout);
  std::swap(this->HasVariance, other->HasVariance);
  std::swap(this->HasMipmaps, other->HasMipmaps);
}

void vtkRadianceTexture::CopyRegion(
  vtkRadianceTexture* source, const Region& from, const Region& to)
{
  source->BindAsTarget(false);
  const glm::ivec2 low = from.Origin - from.GutterLow, target = to.Origin - to.GutterLow;
  const glm::ivec2 size = from.GutterLow + from.Size + from.GutterHigh;
  const auto copy = [&](unsigned int attachment, vtkTextureObject* texture)
  {
    source->Framebuffer->ActivateReadBuffer(attachment);
    texture->Activate();
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, target.x, target.y, low.x, low.y, size.x, size.y);
    texture->Deactivate();
  };
  copy(0, this->Irradiance);
  if (this->HasVariance)
  {
    copy(1, this->Variance);
  }
  // The source may go next. OpenGL would unbind its framebuffer, and vtkOpenGLState not know of it.
  this->BindAsTarget(false);
}

void vtkRadianceTexture::Clear(const Region& region, const penumbra::TexelRectangle& rectangle)
{
  vtkOpenGLState* state = this->Window->GetState();
  const vtkOpenGLState::ScopedglClearColor savedColor(state);
  this->BindAsTarget(false);
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  this->ForEachPart(region, rectangle, [&] { state->vtkglClear(GL_COLOR_BUFFER_BIT); });
}

template <typename Action>
void vtkRadianceTexture::ForEachPart(
  const Region& region, const penumbra::TexelRectangle& rectangle, const Action& action)
{
  for (const penumbra::TexelRectangle& part : region.Place(rectangle))
  {
    const glm::ivec2 size = part.GetSize();
    this->Window->GetState()->vtkglScissor(part.Low.x, part.Low.y, size.x, size.y);
    action();
  }
}

void vtkRadianceTexture::Draw(vtkShaderProgram* program, const Region& region,
  const penumbra::TexelRectangle& rectangle, bool add)
{
  this->BindAsTarget(add);
  const glm::ivec2 first = region.GetFirst();
  program->SetUniform2i("regionFirst", &first.x);
  program->SetUniformi("regionStep", region.GetStep());
  program->SetUniform2i("regionSize", &region.Size.x);
  this->ForEachPart(region, rectangle, [] { penumbra::DrawFullScreenTriangle(); });
}

void vtkRadianceTexture::BindAsTarget(bool add)
{
  vtkOpenGLState* state = this->Window->GetState();
  this->Framebuffer->SetContext(this->Window);
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
  this->Framebuffer->AddColorAttachment(0, this->Irradiance);
  if (this->HasVariance)
  {
    this->Framebuffer->AddColorAttachment(1, this->Variance);
  }
  const int count = this->HasVariance ? 2 : 1;
  this->Framebuffer->ActivateDrawBuffers(static_cast<unsigned int>(count));
  // vtkOpenGLState takes the draw buffers of the framebuffer that was bound before for those of
  // this one, and may not have set them.
  constexpr GLenum buffers[] = { GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1 };
  glDrawBuffers(count, buffers);

  for (unsigned int capability : { GL_DEPTH_TEST, GL_CULL_FACE })
  {
    state->vtkglDisable(capability);
  }
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->SetEnumState(GL_BLEND, add);
  state->vtkglBlendEquation(GL_FUNC_ADD);
  state->vtkglBlendFunc(GL_ONE, GL_ONE);
  state->vtkglViewport(0, 0, this->Layout.Size.x, this->Layout.Size.y);
  state->vtkglEnable(GL_SCISSOR_TEST);
}

bool vtkRadianceTexture::Downsample(vtkRadianceTexture* fine, const glm::ivec2& fineFirst,
  const Region& region, const penumbra::TexelRectangle& rectangle, int factor)
{
  vtkShaderProgram* program =
    penumbra::ReadyFullScreenProgram(this->Window, vtkRadianceDownsampleFS);
  if (!program)
  {
    vtkErrorMacro(
      "The shader that filters radiance textures did not compile. There is no bake; use "
      "Supersampling 1, or update the OpenGL driver.");
    return false;
  }
  fine->Irradiance->Activate();
  fine->Variance->Activate();
  program->SetUniformi("radiance", fine->Irradiance->GetTextureUnit());
  program->SetUniformi("variance", fine->Variance->GetTextureUnit());
  program->SetUniformi("factor", factor);
  program->SetUniform2i("fineFirst", &fineFirst.x);
  this->Draw(program, region, rectangle, false);
  fine->Variance->Deactivate();
  fine->Irradiance->Deactivate();
  return true;
}

bool vtkRadianceTexture::AddMeans(vtkRadianceTexture* texels, vtkRadianceTexture* without,
  const glm::ivec2& factor, const penumbra::TexelRectangle& fine, const Region& region,
  const penumbra::TexelRectangle& rectangle)
{
  const penumbra::TexelRectangle rows{ { rectangle.Low.x, fine.Low.y },
    { rectangle.High.x, fine.High.y } };
  vtkNew<vtkRadianceTexture> sums;
  if (!sums->Allocate(this->Window, { rows.GetSize() }))
  {
    return false;
  }
  vtkShaderProgram* program = penumbra::ReadyFullScreenProgram(this->Window, vtkRadianceMeanFS);
  if (!program)
  {
    vtkErrorMacro("The shader that adds up finer texels did not compile. There is no bake; set a "
                  "TexelSize, or update the OpenGL driver.");
    return false;
  }
  vtkOpenGLState* state = this->Window->GetState();
  program->SetUniform2i("factor", &factor.x);
  program->SetUniform2i("fineLow", &fine.Low.x);
  program->SetUniform2i("fineHigh", &fine.High.x);
  program->SetUniform2i("withoutFirst", &rectangle.Low.x);
  const penumbra::ScopedTexture scopedWithout(state, program, "without", GL_TEXTURE_2D,
    without ? without->Irradiance->GetHandle() : texels->Irradiance->GetHandle());
  const auto addUp = [&](int axis, vtkRadianceTexture* source, const glm::ivec2& first,
                       vtkRadianceTexture* target, const Region& place,
                       const penumbra::TexelRectangle& drawn)
  {
    const penumbra::ScopedTexture radiance(
      state, program, "radiance", GL_TEXTURE_2D, source->Irradiance->GetHandle());
    const penumbra::ScopedTexture variance(
      state, program, "variance", GL_TEXTURE_2D, source->Variance->GetHandle());
    program->SetUniform2i("sourceFirst", &first.x);
    program->SetUniformi("axis", axis);
    program->SetUniformi("hasWithout", axis == 1 && without ? 1 : 0);
    target->Draw(program, place, drawn, axis == 1);
  };
  addUp(0, texels, fine.Low, sums, { -rows.Low, rows.High }, rows);
  addUp(1, sums, rows.Low, this, region, rectangle);
  sums->ReleaseGraphicsResources();
  return true;
}

bool vtkRadianceTexture::GenerateMipmaps()
{
  const bool isDone = this->GenerateMipmaps(this->Irradiance);
  this->HasMipmaps = this->HasMipmaps || isDone;
  return isDone;
}

void vtkRadianceTexture::SetMaximumAnisotropy(int ratio)
{
  this->MaximumAnisotropy = ratio;
}

bool vtkRadianceTexture::GenerateMipmaps(vtkTextureObject* texture)
{
  penumbra::ForgetOpenGLErrors();
  // On software OpenGL, blending two levels and anisotropy would double a frame's time.
  const int anisotropy = this->MaximumAnisotropy > 0 ? this->MaximumAnisotropy
    : IsSoftwareOpenGL()                             ? 1
                                                     : HardwareAnisotropy;
  texture->SetMinificationFilter(
    anisotropy > 1 ? vtkTextureObject::LinearMipmapLinear : vtkTextureObject::LinearMipmapNearest);
  // An atlas has none: a long footprint would reach past the gutter.
  texture->SetMaximumAnisotropicFiltering(
    this->Layout.Gutter > 0 ? 1.0f : static_cast<float>(anisotropy));
  texture->SetMagnificationFilter(vtkTextureObject::Linear);
  texture->SetMaxLevel(this->Layout.Gutter > 0 ? penumbra::AtlasLayout::MipLevels : AllMipLevels);
  texture->Activate();
  texture->SendParameters();
  glGenerateMipmap(GL_TEXTURE_2D);
  const bool isDone = !penumbra::HasOpenGLError();
  if (!isDone)
  {
    // Without levels, a texture that is to have them cannot be read.
    texture->SetMinificationFilter(vtkTextureObject::Nearest);
    texture->SendParameters();
    vtkErrorMacro("OpenGL refused the mip levels of a texture of "
      << this->Layout.Size.x << " x " << this->Layout.Size.y << " texels. Use a larger TexelSize.");
  }
  texture->Deactivate();
  return isDone;
}

void vtkRadianceTexture::ReleaseMipmaps()
{
  // OpenGL frees no single levels. Without room for a copy, they stay.
  vtkSmartPointer<vtkTextureObject> copy = MakeTexture();
  if (!this->HasMipmaps ||
    !penumbra::AllocateTexture(copy, this->Window, this->Layout.Size, 4, VTK_FLOAT))
  {
    copy->ReleaseGraphicsResources(this->Window);
    return;
  }
  this->Framebuffer->SetContext(this->Window);
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
  this->Framebuffer->AddColorAttachment(0, this->Irradiance);
  this->Framebuffer->ActivateReadBuffer(0);
  copy->Activate();
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, this->Layout.Size.x, this->Layout.Size.y);
  copy->Deactivate();
  this->Framebuffer->RemoveColorAttachment(0);
  this->Irradiance->ReleaseGraphicsResources(this->Window);
  this->Irradiance = copy;
  this->HasMipmaps = false;
}

vtkRadianceTexture::Texels vtkRadianceTexture::Download(const Region& region)
{
  const auto count =
    static_cast<std::size_t>(region.Size.x) * static_cast<std::size_t>(region.Size.y);
  Texels texels;
  vtkOpenGLState* state = this->Window->GetState();
  state->Push();
  state->vtkglPixelStorei(GL_PACK_ALIGNMENT, 4);
  this->Framebuffer->SetContext(this->Window);
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
  const auto read = [&](vtkTextureObject* texture, unsigned int format, float* to)
  {
    this->Framebuffer->AddColorAttachment(0, texture);
    this->Framebuffer->ActivateReadBuffer(0);
    glReadPixels(
      region.Origin.x, region.Origin.y, region.Size.x, region.Size.y, format, GL_FLOAT, to);
    this->Framebuffer->RemoveColorAttachment(0);
  };
  texels.Irradiance.resize(count);
  read(this->Irradiance, GL_RGBA, &texels.Irradiance.front().x);
  if (this->HasVariance)
  {
    texels.Variance.resize(count);
    read(this->Variance, GL_RED, texels.Variance.data());
  }
  state->Pop();
  if (region.GetStep() < 0) // turned: the last one comes first
  {
    std::reverse(texels.Irradiance.begin(), texels.Irradiance.end());
    std::reverse(texels.Variance.begin(), texels.Variance.end());
  }
  return texels;
}

bool vtkRadianceTexture::IsAllocated() const
{
  return this->Window && this->Irradiance->GetHandle() != 0;
}

vtkTextureObject* vtkRadianceTexture::GetIrradiance()
{
  return this->Irradiance;
}

std::size_t vtkRadianceTexture::CountTexels(bool withMipmaps) const
{
  return this->Layout.CountTexels(withMipmaps);
}

std::size_t vtkRadianceTexture::GetBytes() const
{
  return this->CountTexels(this->HasMipmaps) * sizeof(glm::vec4) +
    (this->HasVariance ? this->CountTexels(false) * sizeof(float) : 0);
}

void vtkRadianceTexture::ReleaseGraphicsResources()
{
  if (this->Window)
  {
    // VTK remembers what is bound by name, and OpenGL gives names again.
    this->Window->GetState()->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
    this->Irradiance->ReleaseGraphicsResources(this->Window);
    this->Variance->ReleaseGraphicsResources(this->Window);
    this->Framebuffer->ReleaseGraphicsResources(this->Window);
  }
  this->Irradiance = MakeTexture(); // its filter may be that of mip levels
  this->Layout = {};
  this->HasVariance = false;
  this->HasMipmaps = false;
}

void vtkRadianceTexture::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Layout.Size.x << " x " << this->Layout.Size.y << "\n";
  os << indent << "Regions: " << this->Layout.Regions.size() << "\n";
  os << indent << "MaximumAnisotropy: " << this->MaximumAnisotropy << "\n";
}

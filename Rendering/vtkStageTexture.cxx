// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkStageTexture.h"

#include "OpenGLErrors.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkTextureObject.h"

vtkStandardNewMacro(vtkStageTexture);

namespace
{

/// OpenGL's names of so many components, less one.
constexpr GLenum Formats[] = { GL_RED, GL_RG, GL_RGB, GL_RGBA };

} // namespace

vtkStageTexture::vtkStageTexture()
{
  this->Texture->SetMinificationFilter(vtkTextureObject::Nearest);
  this->Texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  this->Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Texture->SetWrapT(vtkTextureObject::ClampToEdge);
}

vtkStageTexture::~vtkStageTexture() = default;

bool vtkStageTexture::Allocate(
  vtkOpenGLRenderWindow* window, const glm::ivec2& size, int components)
{
  if (this->Window == window && this->Size == size && this->Components == components)
  {
    return true;
  }
  this->ReleaseGraphicsResources();
  this->Window = window;
  if (!penumbra::AllocateTexture(this->Texture, window, size, components, VTK_FLOAT))
  {
    vtkErrorMacro("OpenGL refused a texture of " << size.x << " x " << size.y
                                                 << " texels. Use a larger TexelSize.");
    this->ReleaseGraphicsResources();
    return false;
  }
  this->Size = size;
  this->Components = components;
  return true;
}

void vtkStageTexture::BindAsTarget(const penumbra::TexelRectangle& rectangle, bool add)
{
  vtkOpenGLState* state = this->Window->GetState();
  this->Framebuffer->SetContext(this->Window);
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
  this->Framebuffer->AddColorAttachment(0, this->Texture);
  this->Framebuffer->ActivateDrawBuffers(1);
  for (unsigned int capability : { GL_DEPTH_TEST, GL_CULL_FACE })
  {
    state->vtkglDisable(capability);
  }
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->SetEnumState(GL_BLEND, add);
  state->vtkglBlendEquation(GL_FUNC_ADD);
  state->vtkglBlendFunc(GL_ONE, GL_ONE);
  state->vtkglViewport(0, 0, this->Size.x, this->Size.y);
  state->vtkglEnable(GL_SCISSOR_TEST);
  const glm::ivec2 size = rectangle.GetSize();
  state->vtkglScissor(rectangle.Low.x, rectangle.Low.y, size.x, size.y);
}

void vtkStageTexture::Upload(const glm::ivec2& size, const float* values)
{
  vtkOpenGLState* state = this->Window->GetState();
  this->Texture->Activate();
  state->vtkglPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(
    GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, Formats[this->Components - 1], GL_FLOAT, values);
  this->Texture->Deactivate();
}

std::vector<float> vtkStageTexture::Download(const penumbra::TexelRectangle& rectangle)
{
  const glm::ivec2 size = rectangle.GetSize();
  std::vector<float> values(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
    static_cast<std::size_t>(this->Components));
  this->BindAsTarget(rectangle, false);
  this->Framebuffer->ActivateReadBuffer(0);
  this->Window->GetState()->vtkglPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(rectangle.Low.x, rectangle.Low.y, size.x, size.y, Formats[this->Components - 1],
    GL_FLOAT, values.data());
  return values;
}

void vtkStageTexture::FillAndCopy(const glm::vec4& values, vtkStageTexture* source,
  const penumbra::TexelRectangle& rectangle, const glm::ivec2& to)
{
  this->BindAsTarget(penumbra::WholeRectangle(this->Size), false);
  glClearBufferfv(GL_COLOR, 0, &values.x);
  if (rectangle.IsEmpty())
  {
    return;
  }
  source->BindAsTarget(rectangle, false);
  source->Framebuffer->ActivateReadBuffer(0);
  const glm::ivec2 size = rectangle.GetSize();
  this->Texture->Activate();
  glCopyTexSubImage2D(
    GL_TEXTURE_2D, 0, to.x, to.y, rectangle.Low.x, rectangle.Low.y, size.x, size.y);
  this->Texture->Deactivate();
  // The source may go next. OpenGL would unbind its framebuffer, and vtkOpenGLState not know of it.
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
}

unsigned int vtkStageTexture::GetHandle()
{
  return this->Texture->GetHandle();
}

std::size_t vtkStageTexture::GetBytes() const
{
  return static_cast<std::size_t>(this->Size.x) * static_cast<std::size_t>(this->Size.y) *
    static_cast<std::size_t>(this->Components) * sizeof(float);
}

void vtkStageTexture::ReleaseGraphicsResources()
{
  if (this->Window)
  {
    // VTK remembers what is bound by name, and OpenGL gives names again.
    this->Window->GetState()->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
    this->Texture->ReleaseGraphicsResources(this->Window);
    this->Framebuffer->ReleaseGraphicsResources(this->Window);
  }
  this->Window = nullptr;
  this->Size = glm::ivec2(0);
  this->Components = 0;
}

void vtkStageTexture::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size.x << " x " << this->Size.y << "\n";
  os << indent << "Components: " << this->Components << "\n";
}

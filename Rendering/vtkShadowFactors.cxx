// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkShadowFactors.h"

#include "FullScreenTriangle.h"
#include "OpenGLErrors.h"
#include "ScopedTexture.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceTexture.h"
#include "vtkShaderProgram.h"
#include "vtkShadowFactorsFS.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkShadowFactors);

namespace
{

constexpr double HighestValue = 1023.0; // of ten bits
constexpr std::size_t BytesPerTexel = 4;

} // namespace

vtkShadowFactors::vtkShadowFactors()
{
  this->Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Texture->SetWrapT(vtkTextureObject::ClampToEdge);
}

vtkShadowFactors::~vtkShadowFactors() = default;

double vtkShadowFactors::GetLargestFactor(const glm::dvec3& light)
{
  const double sum = light.x + light.y + light.z;
  return sum > 0.0 ? 3.0 * std::max({ light.x, light.y, light.z }) / sum : 1.0;
}

bool vtkShadowFactors::Make(vtkOpenGLRenderWindow* window, vtkRadianceTexture* radiance,
  const std::vector<glm::dvec3>& ambient, double largest)
{
  this->ReleaseGraphicsResources();
  this->Window = window;
  const glm::ivec2& size = radiance->GetSize();
  this->Texture->SetContext(window); // it forgets the format
  this->Texture->SetInternalFormat(GL_RGB10_A2);
  this->Texture->SetFormat(GL_RGBA);
  this->Texture->SetDataType(GL_UNSIGNED_INT_2_10_10_10_REV);
  if (!penumbra::AllocateTexture(this->Texture, window, size, 4, VTK_UNSIGNED_CHAR))
  {
    vtkErrorMacro("OpenGL refused a texture of " << size.x << " x " << size.y
                                                 << " texels to show shadows. Use a larger "
                                                    "TexelSize.");
    this->ReleaseGraphicsResources();
    return false;
  }
  vtkShaderProgram* program = penumbra::ReadyFullScreenProgram(window, vtkShadowFactorsFS);
  if (!program)
  {
    vtkErrorMacro("The shader that makes factors of radiance did not compile. No shadow is shown; "
                  "update the OpenGL driver.");
    this->ReleaseGraphicsResources();
    return false;
  }
  // One of the values stands for 1: what has no shadow looks as without any, to the bit.
  this->Scale = static_cast<float>(HighestValue / std::floor(HighestValue / largest));
  this->BindAsTarget(size);
  {
    const penumbra::ScopedTexture source(window->GetState(), program, "radiance", GL_TEXTURE_2D,
      radiance->GetIrradiance()->GetHandle());
    program->SetUniformf("scale", this->Scale);
    for (std::size_t i = 0; i < ambient.size(); ++i)
    {
      const vtkRadianceTexture::Region& region = radiance->GetRegions()[i];
      const glm::vec3 incoming(ambient[i]);
      program->SetUniform3f("ambient", &incoming.x);
      for (const penumbra::TexelRectangle& part :
        region.Place(penumbra::WholeRectangle(region.Size)))
      {
        const glm::ivec2 partSize = part.GetSize();
        window->GetState()->vtkglScissor(part.Low.x, part.Low.y, partSize.x, partSize.y);
        penumbra::DrawFullScreenTriangle();
      }
    }
  }
  if (penumbra::TakeDrawingError())
  {
    vtkErrorMacro("OpenGL refused to draw factors of radiance. No shadow is shown; use a larger "
                  "TexelSize, or update the OpenGL driver.");
    this->ReleaseGraphicsResources();
    return false;
  }
  if (!radiance->GenerateMipmaps(this->Texture))
  {
    this->ReleaseGraphicsResources();
    return false;
  }
  this->Bytes = BytesPerTexel * radiance->CountTexels(true);
  return true;
}

void vtkShadowFactors::BindAsTarget(const glm::ivec2& size)
{
  vtkOpenGLState* state = this->Window->GetState();
  this->Framebuffer->SetContext(this->Window);
  this->Framebuffer->Bind(GL_FRAMEBUFFER);
  this->Framebuffer->AddColorAttachment(0, this->Texture);
  this->Framebuffer->ActivateDrawBuffers(1);
  // As in vtkRadianceTexture: vtkOpenGLState may not have set them.
  constexpr GLenum buffer = GL_COLOR_ATTACHMENT0;
  glDrawBuffers(1, &buffer);
  for (unsigned int capability : { GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND })
  {
    state->vtkglDisable(capability);
  }
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglViewport(0, 0, size.x, size.y);
  state->vtkglEnable(GL_SCISSOR_TEST);
}

void vtkShadowFactors::ReleaseGraphicsResources()
{
  if (this->Window)
  {
    // VTK remembers what is bound by name, and OpenGL gives names again.
    this->Window->GetState()->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
    this->Texture->ReleaseGraphicsResources(this->Window);
    this->Framebuffer->ReleaseGraphicsResources(this->Window);
  }
  this->Window = nullptr;
  this->Bytes = 0;
}

void vtkShadowFactors::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "Bytes: " << this->Bytes << "\n";
}

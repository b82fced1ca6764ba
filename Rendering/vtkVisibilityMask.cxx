// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkVisibilityMask.h"

#include "FullScreenTriangle.h"
#include "OpenGLErrors.h"
#include "vtkObjectFactory.h"
#include "vtkOccluderGeometry.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"
#include "vtkVisibilityMaskFS.h"
#include "vtkVisibilityMaskVS.h"

#include <algorithm>
#include <array>
#include <limits>

vtkStandardNewMacro(vtkVisibilityMask);

namespace
{

/// The logic op and the clip planes are not part of vtkOpenGLState.
class ScopedMaskState
{
public:
  ScopedMaskState()
  {
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_OR);
    glEnable(GL_CLIP_DISTANCE0);
    glEnable(GL_CLIP_DISTANCE1);
  }
  ~ScopedMaskState()
  {
    glDisable(GL_CLIP_DISTANCE1);
    glDisable(GL_CLIP_DISTANCE0);
    glLogicOp(GL_COPY);
    glDisable(GL_COLOR_LOGIC_OP);
  }
};

/// Sends the projections of samples of one layer, from its bit `firstBit` on.
void SetProjections(
  vtkShaderProgram* program, const penumbra::RegisteredProjection* first, int firstBit, int count)
{
  std::array<glm::vec3, vtkVisibilityMask::SamplesPerLayer> k{};
  std::transform(first, first + count, k.begin() + firstBit,
    [](const penumbra::RegisteredProjection& projection)
    {
      // A height that no float holds is that of a direction: occluders are 0 high against it.
      const glm::dvec3& exact = projection.K;
      const bool isDirection = exact.z < 1.0 / std::numeric_limits<float>::max();
      return glm::vec3(exact.x, exact.y, isDirection ? 0.0 : 1.0 / exact.z);
    });
  program->SetUniformi("firstBit", firstBit);
  program->SetUniform3fv("registration", vtkVisibilityMask::SamplesPerLayer, &k.front().x);
}

} // namespace

vtkVisibilityMask::vtkVisibilityMask() = default;
vtkVisibilityMask::~vtkVisibilityMask()
{
  // Masks that are drawn little by little go with their prop, whatever context is current then.
  if (this->Window && (this->Texture != 0 || this->Framebuffer != 0))
  {
    this->Window->PushContext();
    this->ReleaseGraphicsResources();
    this->Window->PopContext();
  }
}

int vtkVisibilityMask::GetMaximumSamples(vtkOpenGLRenderWindow* window, std::size_t sets)
{
  GLint layers = 0;
  window->GetState()->vtkglGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  return layers / static_cast<int>(sets) * SamplesPerLayer;
}

bool vtkVisibilityMask::Allocate(
  vtkOpenGLRenderWindow* window, const glm::ivec2& size, int samples, std::size_t sets)
{
  this->ReleaseGraphicsResources();
  this->Window = window;
  this->Size = size;
  this->Sets = static_cast<int>(sets);
  this->LayersOfSet = (samples + SamplesPerLayer - 1) / SamplesPerLayer;
  const int layers = this->Sets * this->LayersOfSet;
  penumbra::ForgetOpenGLErrors();
  glGenTextures(1, &this->Texture);
  glBindTexture(GL_TEXTURE_2D_ARRAY, this->Texture);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32UI, size.x, size.y, layers, 0, GL_RED_INTEGER,
    GL_UNSIGNED_INT, nullptr);
  // Integer textures cannot be filtered, and there is but one level.
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
  if (penumbra::HasOpenGLError())
  {
    vtkErrorMacro("OpenGL refused a mask of " << size.x << " x " << size.y << " texels for "
                                              << samples << " samples of " << sets
                                              << " sets of occluders (one for all that are "
                                                 "opaque, one for each that is translucent); "
                                                 "ask for fewer of any.");
    this->ReleaseGraphicsResources();
    return false;
  }
  glGenFramebuffers(1, &this->Framebuffer);
  return true;
}

bool vtkVisibilityMask::Draw(vtkOccluderGeometry* occluders,
  const std::vector<penumbra::RegisteredProjection>& projections, const glm::ivec2& texels,
  const glm::ivec2& firstTexel, int firstSample, int endSample)
{
  vtkOpenGLState* state = this->Window->GetState();
  vtkShaderProgram* program =
    penumbra::ReadyProgram(this->Window, vtkVisibilityMaskVS, vtkVisibilityMaskFS);
  if (!program)
  {
    vtkErrorMacro(
      "The shader of the visibility masks did not compile. There is no bake; update the "
      "OpenGL driver.");
    return false;
  }
  const glm::vec2 grid(texels);
  program->SetUniform2f("receiverTexels", &grid.x);

  state->vtkglBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffer);
  // Texel t of the receiver is texel t - firstTexel of the target. The viewport is the whole
  // receiver's, so that nothing is clipped otherwise for one rectangle than for another.
  state->vtkglViewport(-firstTexel.x, -firstTexel.y, texels.x, texels.y);
  for (unsigned int capability : { GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE })
  {
    state->vtkglDisable(capability);
  }
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  const ScopedMaskState maskState;
  for (int set = 0; set < this->Sets; ++set)
  {
    for (int sample = firstSample, end; sample < endSample; sample = end)
    {
      const int layer = sample / SamplesPerLayer, bit = sample % SamplesPerLayer;
      end = std::min((layer + 1) * SamplesPerLayer, endSample);
      glFramebufferTextureLayer(
        GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, this->Texture, 0, set * this->LayersOfSet + layer);
      if (bit == 0)
      {
        const GLuint unblocked[4] = { 0, 0, 0, 0 };
        glClearBufferuiv(GL_COLOR, 0, unblocked);
      }
      SetProjections(program, &projections[static_cast<std::size_t>(sample)], bit, end - sample);
      occluders->Draw(static_cast<std::size_t>(set), program, end - sample);
    }
  }
  return true;
}

std::size_t vtkVisibilityMask::GetBytes() const
{
  const auto texels =
    static_cast<std::size_t>(this->Size.x) * static_cast<std::size_t>(this->Size.y);
  return this->Texture == 0
    ? 0
    : texels * static_cast<std::size_t>(this->Sets * this->LayersOfSet) * sizeof(GLuint);
}

void vtkVisibilityMask::ReleaseGraphicsResources()
{
  if (!this->Window) // it has taken them with it
  {
    this->Texture = 0;
    this->Framebuffer = 0;
  }
  if (this->Texture != 0)
  {
    glDeleteTextures(1, &this->Texture);
    this->Texture = 0;
  }
  if (this->Framebuffer != 0)
  {
    // VTK remembers what is bound by name, and OpenGL gives names again.
    this->Window->GetState()->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &this->Framebuffer);
    this->Framebuffer = 0;
  }
}

void vtkVisibilityMask::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size.x << " x " << this->Size.y << "\n";
  os << indent << "Sets: " << this->Sets << "\n";
}

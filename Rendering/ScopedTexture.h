// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Textures for the time of a drawing.
 */
#ifndef ScopedTexture_h
#define ScopedTexture_h

#include "OpenGLErrors.h"
#include "OpenGLLoader.h"

#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"
#include "vtkTextureUnitManager.h"

namespace penumbra
{

/// Gives a texture (0: none) to a shader's sampler, on a unit of its own while this lives: samplers
/// of different kinds must not share a unit, even if the shader uses neither. If no unit is free,
/// what is drawn counts as refused (OpenGLErrors.h).
class ScopedTexture
{
public:
  ScopedTexture(vtkOpenGLState* state, vtkShaderProgram* program, const char* sampler,
    unsigned int kind, unsigned int texture)
    : State(state)
    , Kind(kind)
    , Unit(state->GetTextureUnitManager()->Allocate())
  {
    if (this->Unit < 0)
    {
      RefuseDrawing();
      return;
    }
    this->Bind(texture);
    program->SetUniformi(sampler, this->Unit);
  }
  ~ScopedTexture()
  {
    if (this->Unit >= 0)
    {
      this->Bind(0);
      this->State->GetTextureUnitManager()->Free(this->Unit);
    }
  }
  ScopedTexture(const ScopedTexture&) = delete;
  ScopedTexture& operator=(const ScopedTexture&) = delete;

private:
  void Bind(unsigned int texture)
  {
    this->State->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(this->Unit));
    glBindTexture(this->Kind, texture);
  }

  vtkOpenGLState* State;
  unsigned int Kind;
  int Unit;
};

} // namespace penumbra

#endif

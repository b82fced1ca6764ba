// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "OpenGLErrors.h"

#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkTextureObject.h"

#include <utility>

namespace penumbra
{

namespace
{

/// VTK prints no messages while it lives.
class ScopedSilence
{
public:
  ScopedSilence()
    : Before(vtkObject::GetGlobalWarningDisplay())
  {
    vtkObject::SetGlobalWarningDisplay(0);
  }
  ~ScopedSilence() { vtkObject::SetGlobalWarningDisplay(this->Before); }
  ScopedSilence(const ScopedSilence&) = delete;
  ScopedSilence& operator=(const ScopedSilence&) = delete;

private:
  vtkTypeBool Before;
};

/// Of the thread's contexts, as OpenGL's own errors are.
thread_local bool HasRefusedToDraw = false;

/// Whether the texture has that width.
bool HasWidth(vtkTextureObject* texture, int width)
{
  GLint actual = 0;
  texture->Activate();
  glGetTexLevelParameteriv(texture->GetTarget(), 0, GL_TEXTURE_WIDTH, &actual);
  texture->Deactivate();
  return actual == width;
}

} // namespace

bool HasOpenGLContext()
{
  return glGetString(GL_VERSION) != nullptr;
}

void ForgetOpenGLErrors()
{
  // OpenGL remembers one error of each kind, and there are not as many kinds. A context that has
  // been lost answers with an error whenever it is asked.
  constexpr int MostErrors = 16;
  for (int i = 0; i < MostErrors && glGetError() != GL_NO_ERROR; ++i)
  {
  }
}

bool HasOpenGLError()
{
  const bool hasError = glGetError() != GL_NO_ERROR;
  ForgetOpenGLErrors();
  return hasError;
}

void NoteDrawingError()
{
  HasRefusedToDraw = HasOpenGLError() || HasRefusedToDraw;
}

void RefuseDrawing()
{
  HasRefusedToDraw = true;
}

bool TakeDrawingError()
{
  return std::exchange(HasRefusedToDraw, false);
}

bool AllocateTexture(vtkTextureObject* texture, vtkOpenGLRenderWindow* window,
  const glm::ivec2& size, int components, int vtkType)
{
  ForgetOpenGLErrors();
  const ScopedSilence silence;
  texture->SetContext(window);
  return texture->Allocate2D(static_cast<unsigned int>(size.x), static_cast<unsigned int>(size.y),
           components, vtkType) &&
    !HasOpenGLError() && HasWidth(texture, size.x);
}

bool MakeTextureOfBuffer(vtkTextureObject* texture, vtkOpenGLRenderWindow* window,
  vtkOpenGLBufferObject* buffer, int texels, int vtkType)
{
  ForgetOpenGLErrors();
  const ScopedSilence silence;
  texture->SetContext(window); // it forgets the format
  const bool isInteger = vtkType == VTK_UNSIGNED_INT;
  texture->SetInternalFormat(isInteger ? GL_R32UI : GL_RGBA32F);
  return texture->CreateTextureBuffer(
           static_cast<unsigned int>(texels), isInteger ? 1 : 4, vtkType, buffer) &&
    !HasOpenGLError() && HasWidth(texture, texels);
}

} // namespace penumbra

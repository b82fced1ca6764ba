// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "FullScreenTriangle.h"

#include "OpenGLErrors.h"
#include "vtkFullScreenTriangleVS.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

#include <string>

namespace penumbra
{

vtkShaderProgram* ReadyProgram(
  vtkOpenGLRenderWindow* window, const char* vertexShader, const char* fragmentShader)
{
  // VTK keeps programs by their source, and one that failed fails for ever: its vertex shader,
  // which has been compiled, is not compiled again. So the source is another one after each
  // failure.
  static int failures = 0;
  std::string source = fragmentShader;
  if (failures > 0)
  {
    source += "// " + std::to_string(failures) + "\n";
  }
  vtkShaderProgram* program =
    window->GetShaderCache()->ReadyShaderProgram(vertexShader, source.c_str(), "");
  if (program && program->GetCompiled())
  {
    return program;
  }
  ++failures;
  return nullptr;
}

vtkShaderProgram* ReadyFullScreenProgram(vtkOpenGLRenderWindow* window, const char* fragmentShader)
{
  return ReadyProgram(window, vtkFullScreenTriangleVS, fragmentShader);
}

void DrawFullScreenTriangle()
{
  GLuint vertexArray = 0; // core profiles draw nothing without one
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  ForgetOpenGLErrors();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  NoteDrawingError();
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &vertexArray);
}

} // namespace penumbra

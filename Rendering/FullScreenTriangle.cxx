// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "FullScreenTriangle.h"

#include "vtkFullScreenTriangleVS.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkShaderProgram.h"

namespace penumbra
{

vtkShaderProgram* ReadyFullScreenProgram(vtkOpenGLRenderWindow* window, const char* fragmentShader)
{
  vtkShaderProgram* program =
    window->GetShaderCache()->ReadyShaderProgram(vtkFullScreenTriangleVS, fragmentShader, "");
  return program && program->GetCompiled() ? program : nullptr;
}

void DrawFullScreenTriangle()
{
  GLuint vertexArray = 0; // core profiles draw nothing without one
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &vertexArray);
}

} // namespace penumbra

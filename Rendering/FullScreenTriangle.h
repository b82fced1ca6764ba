// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Shader programs, and drawing with a fragment shader alone.
 */
#ifndef FullScreenTriangle_h
#define FullScreenTriangle_h

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace penumbra
{

/**
 * The window's program of those shaders, ready for uniforms; nullptr if they do not compile, which
 * VTK reports. The next time they are compiled anew. The window owns it.
 */
vtkShaderProgram* ReadyProgram(
  vtkOpenGLRenderWindow* window, const char* vertexShader, const char* fragmentShader);

/**
 * The window's program of that fragment shader, ready for uniforms; nullptr if it does not compile.
 * The window owns it. vtkOpenGLQuadHelper insists on texture coordinates, which such shaders have
 * no use for.
 */
vtkShaderProgram* ReadyFullScreenProgram(vtkOpenGLRenderWindow* window, const char* fragmentShader);

/// Runs the current program for every pixel of the viewport that the scissor leaves.
void DrawFullScreenTriangle();

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Drawing with a fragment shader alone.
 */
#ifndef FullScreenTriangle_h
#define FullScreenTriangle_h

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace penumbra
{

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

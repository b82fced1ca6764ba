// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What VTK's surface shaders get to show shadows: vtkSoftShadowFS.glsl, and its uniforms.
 */
#ifndef ReceiverShader_h
#define ReceiverShader_h

#include "Vectors.h"
#include "vtkBakedProp.h" // for entries

#include <string>
#include <vector>

class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkShaderProgram;

namespace penumbra
{

/// How many receivers the shader of one prop can tell apart.
std::size_t GetMaximumReceivers(vtkOpenGLRenderWindow* window);

/// Whether OpenGL compiles what the shaders of props with so many receivers get: VTK crashes on
/// shaders that do not compile.
bool CompilesShadowCode(std::size_t receivers, vtkOpenGLRenderWindow* window);

/// What a shader has to show.
struct ShadowCode
{
  std::size_t Receivers = 1;
  std::size_t Windows = 0;    ///< of these, windows of others
  bool HasProxy = false;      ///< does a plane stand for a surface?
  bool ShowsRadiance = false; ///< or shadows
  bool IsMatte = false;       ///< the material has no specular part
};

/// Adds the code to the shaders that a mapper has made.
void AddShadowCode(const ShadowCode& code, std::string& vertexShader,
  const std::string& geometryShader, std::string& fragmentShader);

/// What takes places to the screen, in a frame.
struct ScreenMatrices
{
  glm::dmat4 WorldToView{ 1.0 };
  glm::dmat4 ViewToClip{ 1.0 };
  glm::ivec4 Viewport{ 0 };

  /// The matrices that the mappers use.
  explicit ScreenMatrices(vtkRenderer* renderer);
};

/// Sets the uniforms of the program, which has the code, for a prop with a texture.
void SetReceiverUniforms(
  vtkShaderProgram* program, vtkBakedProp* baked, const ScreenMatrices& matrices);

} // namespace penumbra

#endif

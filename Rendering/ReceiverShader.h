// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What VTK's surface shaders get to show shadows: vtkSoftShadowFS.glsl, and its uniforms.
 */
#ifndef ReceiverShader_h
#define ReceiverShader_h

#include "Vectors.h"
#include "vtkBakedProp.h"     // for entries
#include "vtkReceiverTable.h" // for records

#include <string>
#include <vector>

class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkShaderProgram;

namespace penumbra
{

/// What a shader has to show.
struct ShadowCode
{
  bool HasSeveral = false;    ///< receivers, of which a vtkReceiverTable knows the fragment's own
  bool HasProxy = false;      ///< does a plane stand for a surface?
  bool ShowsRadiance = false; ///< or shadows
  bool IsMatte = false;       ///< the material has no specular part
};

/// Whether OpenGL compiles what shaders get: VTK crashes on shaders that do not compile.
bool CompilesShadowCode(const ShadowCode& code, vtkOpenGLRenderWindow* window);

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

  bool AreRaysParallel() const { return this->ViewToClip[2][3] == 0.0; }
};

///@{
/// Sets the uniforms of the program, which has the code: for the only receiver of a prop; or for
/// several, but for the textures of their table.
void SetReceiverUniforms(
  vtkShaderProgram* program, const vtkBakedProp::Entry& entry, const ScreenMatrices& matrices);
void SetReceiverUniforms(
  vtkShaderProgram* program, vtkReceiverTable* table, const ScreenMatrices& matrices);
///@}

/// What a table has to say of the receivers of a prop with a texture.
std::vector<vtkReceiverTable::Record> MakeReceiverRecords(vtkBakedProp* baked);

} // namespace penumbra

#endif

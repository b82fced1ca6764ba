// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The shader code vtkReceiverTexel.glsl and its uniforms.
 */
#ifndef ReceiverTexels_h
#define ReceiverTexels_h

#include "ReceiverFrame.h"

#include <string>

class vtkShaderProgram;

namespace penumbra
{

/// The shader with vtkReceiverTexel.glsl in its place.
std::string WithReceiverTexels(const char* fragmentShader);

/// Sets the uniforms; the receiver's texel `firstTexel` is texel (0, 0) of the target.
void SetReceiverTexels(vtkShaderProgram* program, const ReceiverFrame& frame,
  const glm::ivec2& texels, const glm::ivec2& firstTexel);

} // namespace penumbra

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Whether OpenGL did what it was asked for.
 */
#ifndef OpenGLErrors_h
#define OpenGLErrors_h

#include "Vectors.h"
#include "vtkType.h" // for VTK_FLOAT

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkTextureObject;

namespace penumbra
{

/// Whether any context is current in this thread. Without one, OpenGL's functions do nothing, or
/// crash.
bool HasOpenGLContext();

/// Forgets the errors of others, which must not be taken for a refusal of what comes next.
void ForgetOpenGLErrors();

/// Whether there was an error since they were last asked for or forgotten.
bool HasOpenGLError();

///@{
/**
 * Whether OpenGL refused to draw: noted after a draw call, before which errors of others are to be
 * forgotten, since VTK's state, if VTK was built to report errors, takes them away; and asked for,
 * once, where a stage is done. An incomplete framebuffer is such an error.
 */
void NoteDrawingError();
bool TakeDrawingError();
///@}

/// What is drawn for the stage would be wrong: it counts as refused.
void RefuseDrawing();

///@{
/**
 * Make room for a texture, of a VTK type such as VTK_FLOAT; or make a texture of what a buffer
 * holds, four floats or an unsigned integer (VTK_UNSIGNED_INT) a texel. False if OpenGL refuses.
 * VTK, if it was built to report errors, reports this one and forgets it, but says that all went
 * well: here it is silent, and OpenGL is asked for what there is.
 */
bool AllocateTexture(vtkTextureObject* texture, vtkOpenGLRenderWindow* window,
  const glm::ivec2& size, int components, int vtkType);
bool MakeTextureOfBuffer(vtkTextureObject* texture, vtkOpenGLRenderWindow* window,
  vtkOpenGLBufferObject* buffer, int texels, int vtkType = VTK_FLOAT);
///@}

} // namespace penumbra

#endif

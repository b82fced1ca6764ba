// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Declares OpenGL by the loader that this VTK was built with.
 */
#ifndef OpenGLLoader_h
#define OpenGLLoader_h

#if __has_include("vtk_glad.h") // VTK 9.4 and later
#define PENUMBRA_OPENGL_BY_GLAD 1
#include "vtk_glad.h"
#else
#define PENUMBRA_OPENGL_BY_GLAD 0
#include "vtk_glew.h"
#endif

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Declares OpenGL by the loader that this VTK was built with.
 */
#ifndef OpenGLLoader_h
#define OpenGLLoader_h

#if VTK_MODULE_ENABLE_VTK_glad // VTK 9.4 and later
#include "vtk_glad.h"
#else
#include "vtk_glew.h"
#endif

#endif

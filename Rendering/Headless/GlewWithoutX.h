// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// A GLEW that was built for GLX (Debian's is) loads the OpenGL functions, then looks for an X
// display and reports an error if there is none. That is no error where windows do without X: by
// then every function that VTK calls has been loaded.
//
// The headless windows forgive it by themselves. But pvbatch and pvserver draw in windows of their
// own, which borrow a headless window's context and call glewInit; these print an error at each
// render, and draw nevertheless. So this library also defines a glewInit that forgives. It takes
// effect where the library comes before libGLEW: in programs that are linked to
// PenumbraHeadlessOSMesa, and where PenumbraHeadless or PenumbraHeadlessOSMesa is in LD_PRELOAD.

#ifndef GlewWithoutX_h
#define GlewWithoutX_h

#include "vtk_glew.h"

namespace penumbra
{
/**
 * Load the OpenGL functions of the current context. Returns GLEW_OK, also if only GLX is missing,
 * or GLEW's error.
 */
GLenum LoadOpenGLFunctions();
}

#endif

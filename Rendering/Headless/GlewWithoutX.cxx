// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GlewWithoutX.h"

#include "PenumbraHeadlessModule.h" // for the export macro

#include <dlfcn.h>

namespace penumbra
{
//------------------------------------------------------------------------------
GLenum LoadOpenGLFunctions()
{
  // GLEW's own, which comes after the one that is defined below.
  static const auto load = reinterpret_cast<GLenum (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  const GLenum result = load ? load() : GLEW_ERROR_NO_GL_VERSION;
  const bool onlyGlxIsMissing =
    result == GLEW_ERROR_NO_GLX_DISPLAY || result == GLEW_ERROR_GLX_VERSION_11_ONLY;
  return onlyGlxIsMissing ? GLEW_OK : result;
}
}

//------------------------------------------------------------------------------
extern "C" PENUMBRAHEADLESS_EXPORT GLenum glewInit()
{
  return penumbra::LoadOpenGLFunctions();
}

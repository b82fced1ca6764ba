// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// VTK calls OpenGL in two ways, and both must reach OSMesa. The functions of OpenGL 1.1 are linked
// by name: libOSMesa defines them, and need only come before the system's libOpenGL. All later ones
// are pointers that GLEW fetches; a GLEW that was built for GLX (Debian's is) fetches them from
// glXGetProcAddressARB, which libOSMesa does not define. The system's would return functions of the
// system's OpenGL, where no context is current. This one, which precedes it for the same reason as
// libOSMesa does, returns OSMesa's.

#include <GL/osmesa.h>

#include <cstring>

#define PENUMBRA_GLX_EXPORT extern "C" __attribute__((visibility("default")))

//------------------------------------------------------------------------------
PENUMBRA_GLX_EXPORT OSMESAproc glXGetProcAddressARB(const GLubyte* name)
{
  const char* text = reinterpret_cast<const char*>(name);
  // Without a function of GLX, GLEW concludes that there is no GLX, which is true.
  return std::strncmp(text, "glX", 3) == 0 ? nullptr : OSMesaGetProcAddress(text);
}

//------------------------------------------------------------------------------
PENUMBRA_GLX_EXPORT OSMESAproc glXGetProcAddress(const GLubyte* name)
{
  return glXGetProcAddressARB(name);
}

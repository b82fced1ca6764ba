// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHeadlessEGLRenderWindow.h"

#include "vtkObjectFactory.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace
{
// The window's surface is only a token, so that framebuffer 0, which parts of VTK query, exists.
constexpr EGLint SurfaceEdge = 16;
// More EGL devices than any machine has.
constexpr EGLint MaximumDevices = 64;

std::string WithError(const std::string& what)
{
  std::ostringstream text;
  text << what << " (EGL error 0x" << std::hex << eglGetError() << ")";
  return text.str();
}

template <typename Function>
Function GetFunction(const char* name)
{
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool HasClientExtension(const std::string& name)
{
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return extensions &&
    (" " + std::string(extensions) + " ").find(" " + name + " ") != std::string::npos;
}

// The displays to try, best first. None is initialized yet.
std::vector<EGLDisplay> GetCandidates()
{
  std::vector<EGLDisplay> displays;
  const auto getPlatformDisplay =
    GetFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (getPlatformDisplay && HasClientExtension("EGL_MESA_platform_surfaceless"))
  {
    displays.push_back(
      getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  const auto queryDevices = GetFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (getPlatformDisplay && queryDevices && HasClientExtension("EGL_EXT_platform_device"))
  {
    std::array<EGLDeviceEXT, MaximumDevices> devices;
    EGLint count = 0;
    queryDevices(MaximumDevices, devices.data(), &count);
    for (EGLint i = 0; i < count; ++i)
    {
      displays.push_back(getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

struct DisplayAndConfig
{
  EGLDisplay Display = EGL_NO_DISPLAY;
  EGLConfig Config = nullptr;
};

// The first display that offers desktop OpenGL and a surface without a window; or EGL_NO_DISPLAY.
DisplayAndConfig FindDisplay()
{
  const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
    EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8, EGL_DEPTH_SIZE, 24,
    EGL_NONE };
  for (EGLDisplay display : GetCandidates())
  {
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) &&
      eglChooseConfig(display, wanted, &config, 1, &count) && count > 0)
    {
      return { display, config };
    }
  }
  return {};
}

// Found once. EGL hands out the same display to everyone in the process who asks, so a window must
// not terminate it: that would destroy the contexts of all the others.
const DisplayAndConfig& GetSharedDisplay()
{
  static const DisplayAndConfig shared = FindDisplay();
  return shared;
}
}

vtkStandardNewMacro(vtkHeadlessEGLRenderWindow);

//------------------------------------------------------------------------------
vtkHeadlessEGLRenderWindow::vtkHeadlessEGLRenderWindow() = default;

//------------------------------------------------------------------------------
vtkHeadlessEGLRenderWindow::~vtkHeadlessEGLRenderWindow()
{
  this->Finalize();
}

//------------------------------------------------------------------------------
std::string vtkHeadlessEGLRenderWindow::CreateContext()
{
  const std::string needed =
    "; an EGL driver with desktop OpenGL 3.2 is needed, for instance Mesa's"
    " (Debian packages libegl1 and libgl1-mesa-dri)";
  const DisplayAndConfig& shared = GetSharedDisplay();
  if (shared.Display == EGL_NO_DISPLAY)
  {
    return "EGL has no surfaceless platform, device or default display that offers OpenGL" + needed;
  }
  this->Display = shared.Display;
  // The current API belongs to the thread, hence once for each window.
  if (!eglBindAPI(EGL_OPENGL_API))
  {
    return WithError("EGL has no desktop OpenGL") + needed;
  }
  const EGLint size[] = { EGL_WIDTH, SurfaceEdge, EGL_HEIGHT, SurfaceEdge, EGL_NONE };
  this->Surface = eglCreatePbufferSurface(this->Display, shared.Config, size);
  const EGLint version[] = { EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2,
    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE };
  this->Context = eglCreateContext(this->Display, shared.Config, EGL_NO_CONTEXT, version);
  if (!this->Surface || !this->Context ||
    !eglMakeCurrent(this->Display, this->Surface, this->Surface, this->Context))
  {
    const std::string problem = WithError("EGL gave no OpenGL 3.2 core context") + needed;
    this->DestroyContext();
    return problem;
  }
  return {};
}

//------------------------------------------------------------------------------
void vtkHeadlessEGLRenderWindow::DestroyContext()
{
  this->ReleaseCurrent();
  if (this->Context)
  {
    eglDestroyContext(this->Display, this->Context);
  }
  if (this->Surface)
  {
    eglDestroySurface(this->Display, this->Surface);
  }
  this->Context = nullptr;
  this->Surface = nullptr;
}

//------------------------------------------------------------------------------
std::function<void()> vtkHeadlessEGLRenderWindow::RememberCurrentContext()
{
  const EGLContext context = eglGetCurrentContext();
  if (context == EGL_NO_CONTEXT)
  {
    return {};
  }
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLSurface draw = eglGetCurrentSurface(EGL_DRAW);
  const EGLSurface read = eglGetCurrentSurface(EGL_READ);
  return [=]() { eglMakeCurrent(display, draw, read, context); };
}

//------------------------------------------------------------------------------
void vtkHeadlessEGLRenderWindow::MakeCurrent()
{
  if (this->Context && !this->IsCurrent() &&
    !eglMakeCurrent(this->Display, this->Surface, this->Surface, this->Context))
  {
    vtkErrorMacro(<< WithError("eglMakeCurrent failed") << "; is the context of this window current"
                  << " in another thread?");
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessEGLRenderWindow::ReleaseCurrent()
{
  if (this->IsCurrent())
  {
    eglMakeCurrent(this->Display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

//------------------------------------------------------------------------------
bool vtkHeadlessEGLRenderWindow::IsCurrent()
{
  return this->Context && eglGetCurrentContext() == this->Context;
}

//------------------------------------------------------------------------------
void vtkHeadlessEGLRenderWindow::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Display: " << this->Display << "\n";
  os << indent << "Surface: " << this->Surface << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHeadlessFactory.h"

#include "vtkGenericRenderWindowInteractor.h"
#include "vtkRenderWindow.h"
#include "vtkRenderingOpenGLConfigure.h"
#include "vtkVersion.h"
#if PENUMBRA_HEADLESS_WINDOWS
#include "vtkDynamicLoader.h"
#include "vtkHeadlessEGLRenderWindow.h"
#include "vtkObjectFactoryCollection.h"
#endif

#include <cstdlib> // also for setenv(), which POSIX adds
#include <string>

namespace
{
VTK_CREATE_CREATE_FUNCTION(vtkGenericRenderWindowInteractor);

#if PENUMBRA_HEADLESS_WINDOWS
VTK_CREATE_CREATE_FUNCTION(vtkHeadlessEGLRenderWindow);

// The class of what vtkRenderWindow::New() returns now; empty if no factory makes windows. Asking
// does not make a window.
std::string GetWindowClass()
{
  vtkObjectFactoryCollection* factories = vtkObjectFactory::GetRegisteredFactories();
  vtkCollectionSimpleIterator cookie;
  factories->InitTraversal(cookie);
  while (vtkObjectFactory* factory = factories->GetNextObjectFactory(cookie))
  {
    for (int i = 0; i < factory->GetNumberOfOverrides(); ++i)
    {
      if (factory->GetEnableFlag(i) &&
        std::string("vtkRenderWindow") == factory->GetClassOverrideName(i))
      {
        return factory->GetClassOverrideWithName(i);
      }
    }
  }
  return {};
}

// Asks the server itself, since DISPLAY may well name one that is gone. libX11 is looked up only
// here, so that this library does not need it.
bool CanOpenXDisplay()
{
  const char* name = std::getenv("DISPLAY");
  if (!name || !*name)
  {
    return false;
  }
  const vtkLibHandle x11 = vtkDynamicLoader::OpenLibrary("libX11.so.6");
  if (!x11)
  {
    return false;
  }
  const auto openDisplay = reinterpret_cast<void* (*)(const char*)>(
    vtkDynamicLoader::GetSymbolAddress(x11, "XOpenDisplay"));
  const auto closeDisplay =
    reinterpret_cast<int (*)(void*)>(vtkDynamicLoader::GetSymbolAddress(x11, "XCloseDisplay"));
  void* display = openDisplay && closeDisplay ? openDisplay(nullptr) : nullptr;
  if (display)
  {
    closeDisplay(display);
  }
  vtkDynamicLoader::CloseLibrary(x11);
  return display != nullptr;
}
#endif
}

//------------------------------------------------------------------------------
vtkHeadlessFactory::vtkHeadlessFactory() = default;

//------------------------------------------------------------------------------
vtkHeadlessFactory::~vtkHeadlessFactory() = default;

//------------------------------------------------------------------------------
vtkHeadlessFactory* vtkHeadlessFactory::NewFor(const char* className, CreateFunction create)
{
  auto* factory = new vtkHeadlessFactory;
  factory->InitializeObjectBase();
  if (create)
  {
    // The first factory with an enabled override wins, and VTK's own have come first: they register
    // themselves when VTK's libraries are loaded, on which this one depends.
    vtkObjectFactory::GetRegisteredFactories(); // makes the list if there is none yet
    vtkObjectFactory::SetAllEnableFlags(0, "vtkRenderWindow");
    vtkObjectFactory::SetAllEnableFlags(0, "vtkRenderWindowInteractor");
    factory->RegisterOverride(
      "vtkRenderWindow", className, "A window without a display", 1, create);
    factory->RegisterOverride("vtkRenderWindowInteractor", "vtkGenericRenderWindowInteractor",
      "An interactor without a display", 1, vtkObjectFactoryCreatevtkGenericRenderWindowInteractor);
  }
  return factory;
}

//------------------------------------------------------------------------------
vtkHeadlessFactory* vtkHeadlessFactory::New()
{
#if PENUMBRA_HEADLESS_WINDOWS
  return vtkHeadlessFactory::NewFor(
    "vtkHeadlessEGLRenderWindow", vtkObjectFactoryCreatevtkHeadlessEGLRenderWindow);
#else
  return vtkHeadlessFactory::NewFor(nullptr, nullptr);
#endif
}

//------------------------------------------------------------------------------
void vtkHeadlessFactory::RegisterWindow(const char* className, CreateFunction create)
{
  vtkObjectFactory::RegisterFactory(
    vtkSmartPointer<vtkHeadlessFactory>::Take(vtkHeadlessFactory::NewFor(className, create)));
}

//------------------------------------------------------------------------------
bool vtkHeadlessFactory::IsDisplayMissing()
{
#if PENUMBRA_HEADLESS_WINDOWS
  const std::string windowClass = GetWindowClass();
  return (windowClass.empty() || windowClass == "vtkXOpenGLRenderWindow") && !CanOpenXDisplay();
#else
  return false;
#endif
}

//------------------------------------------------------------------------------
void vtkHeadlessFactory::RegisterIfNoDisplay()
{
#if PENUMBRA_HEADLESS_WINDOWS
  if (vtkHeadlessFactory::IsDisplayMissing())
  {
    vtkHeadlessFactory::RegisterWindow(
      "vtkHeadlessEGLRenderWindow", vtkObjectFactoryCreatevtkHeadlessEGLRenderWindow);
  }
#elif defined(VTK_USE_X) && defined(VTK_OPENGL_HAS_EGL)
  // VTK finds EGL by itself, but tries X first and says of each window that there is no X server.
  const char* display = std::getenv("DISPLAY");
  if (!display || !*display)
  {
    constexpr int keepIfSet = 0;
    setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow", keepIfSet);
  }
#endif
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkRenderWindow> vtkHeadlessFactory::NewOffScreenWindow()
{
#if PENUMBRA_HEADLESS_WINDOWS
  if (vtkHeadlessFactory::IsDisplayMissing())
  {
    return vtkSmartPointer<vtkRenderWindow>::Take(vtkHeadlessEGLRenderWindow::New());
  }
#endif
  auto window = vtkSmartPointer<vtkRenderWindow>::New();
  if (window)
  {
    window->SetOffScreenRendering(true);
  }
  return window;
}

//------------------------------------------------------------------------------
const char* vtkHeadlessFactory::GetVTKSourceVersion() VTK_FUTURE_CONST
{
  return VTK_SOURCE_VERSION;
}

//------------------------------------------------------------------------------
const char* vtkHeadlessFactory::GetDescription() VTK_FUTURE_CONST
{
  return "Penumbra: OpenGL windows without a display";
}

//------------------------------------------------------------------------------
void vtkHeadlessFactory::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHeadlessOSMesaRenderWindow.h"

#include "vtkHeadlessFactory.h"
#include "vtkObjectFactory.h"

#include <GL/osmesa.h>

vtkStandardNewMacro(vtkHeadlessOSMesaRenderWindow);

namespace
{
VTK_CREATE_CREATE_FUNCTION(vtkHeadlessOSMesaRenderWindow);

// Whoever links or preloads this library wants its windows: there is no other reason to load it.
// The program's own code need not know.
[[maybe_unused]] const bool isRegistered = []()
{
  vtkHeadlessFactory::RegisterWindow(
    "vtkHeadlessOSMesaRenderWindow", vtkObjectFactoryCreatevtkHeadlessOSMesaRenderWindow);
  return true;
}();
}

//------------------------------------------------------------------------------
vtkHeadlessOSMesaRenderWindow::vtkHeadlessOSMesaRenderWindow() = default;

//------------------------------------------------------------------------------
vtkHeadlessOSMesaRenderWindow::~vtkHeadlessOSMesaRenderWindow()
{
  this->Finalize();
}

//------------------------------------------------------------------------------
std::string vtkHeadlessOSMesaRenderWindow::CreateContext()
{
  const int attributes[] = { OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_STENCIL_BITS,
    8, OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION, 3,
    OSMESA_CONTEXT_MINOR_VERSION, 2, 0 };
  this->Context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!this->Context)
  {
    return "OSMesa gave no OpenGL 3.2 core context; Mesa 11.2 or later with llvmpipe or softpipe "
           "is "
           "needed (Debian package libosmesa6)";
  }
  this->MakeCurrent();
  if (!glGetString(GL_VERSION))
  {
    this->DestroyContext();
    return "the OpenGL functions of this process are not OSMesa's; PenumbraHeadlessOSMesa and "
           "libOSMesa must be linked before all other libraries, or named in LD_PRELOAD";
  }
  return {};
}

//------------------------------------------------------------------------------
void vtkHeadlessOSMesaRenderWindow::DestroyContext()
{
  this->ReleaseCurrent();
  OSMesaDestroyContext(static_cast<OSMesaContext>(this->Context));
  this->Context = nullptr;
}

//------------------------------------------------------------------------------
std::function<void()> vtkHeadlessOSMesaRenderWindow::RememberCurrentContext()
{
  const OSMesaContext context = OSMesaGetCurrentContext();
  if (!context)
  {
    return {};
  }
  GLint width = 0;
  GLint height = 0;
  GLint format = 0;
  void* buffer = nullptr;
  OSMesaGetColorBuffer(context, &width, &height, &format, &buffer);
  return [=]() { OSMesaMakeCurrent(context, buffer, GL_UNSIGNED_BYTE, width, height); };
}

//------------------------------------------------------------------------------
void vtkHeadlessOSMesaRenderWindow::MakeCurrent()
{
  if (this->Context && !this->IsCurrent() &&
    !OSMesaMakeCurrent(static_cast<OSMesaContext>(this->Context), this->Buffer, GL_UNSIGNED_BYTE,
      BufferEdge, BufferEdge))
  {
    vtkErrorMacro("OSMesaMakeCurrent failed.");
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessOSMesaRenderWindow::ReleaseCurrent()
{
  if (this->IsCurrent())
  {
    OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  }
}

//------------------------------------------------------------------------------
bool vtkHeadlessOSMesaRenderWindow::IsCurrent()
{
  return this->Context && OSMesaGetCurrentContext() == this->Context;
}

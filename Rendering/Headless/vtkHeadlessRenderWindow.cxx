// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHeadlessRenderWindow.h"

#include "GlewWithoutX.h"
#include "vtkRect.h"
#include "vtkRenderer.h"
#include "vtkRendererCollection.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>

namespace
{
// As large as a texture may be on common drivers, so that nobody clamps a screenshot to the screen.
constexpr int ScreenEdge = 16384;
// What vtkRenderWindow takes when no size was set.
constexpr int DefaultEdge = 300;

// Load the OpenGL functions of the current context. Returns what went wrong, or an empty string.
std::string PrepareContext()
{
  const GLenum result = penumbra::LoadOpenGLFunctions();
  if (result != GLEW_OK)
  {
    return std::string("GLEW could not load the OpenGL functions: ") +
      reinterpret_cast<const char*>(glewGetErrorString(result));
  }
  if (!GLEW_VERSION_3_2)
  {
    const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    return std::string("OpenGL 3.2 or later is needed, this context offers ") +
      (version ? version : "none");
  }
  return {};
}

// The windows that have a context. Never destroyed: windows may outlive all static objects.
std::set<vtkHeadlessRenderWindow*>& GetWindowsWithContext()
{
  static auto* windows = new std::set<vtkHeadlessRenderWindow*>;
  return *windows;
}

bool IsProcessEnding = false;

void FinalizeAllWindows()
{
  IsProcessEnding = true;
  const std::set<vtkHeadlessRenderWindow*> windows = GetWindowsWithContext();
  for (vtkHeadlessRenderWindow* window : windows)
  {
    window->Finalize();
  }
}

// When a process ends, the functions given to atexit() run first, the last one first, and then the
// libraries' static objects are destroyed. Mesa gives atexit() its own tear-down with the first
// context, and ParaView holds windows in a static object. So windows are finalized by a function
// that comes after Mesa's, once for each class, as each brings a library of its own.
void FinalizeAtExit(const std::string& windowClass)
{
  static auto* classes = new std::set<std::string>;
  if (classes->insert(windowClass).second)
  {
    std::atexit(FinalizeAllWindows);
  }
}
}

//------------------------------------------------------------------------------
vtkHeadlessRenderWindow::vtkHeadlessRenderWindow()
{
  this->ScreenSize[0] = ScreenEdge;
  this->ScreenSize[1] = ScreenEdge;
  this->ShowWindow = false;
  this->UseOffScreenBuffers = true;
  this->FrameBlitMode = NoBlit;
  this->DoubleBuffer = 0;
}

//------------------------------------------------------------------------------
vtkHeadlessRenderWindow::~vtkHeadlessRenderWindow()
{
  vtkCollectionSimpleIterator cookie;
  this->Renderers->InitTraversal(cookie);
  while (vtkRenderer* renderer = this->Renderers->GetNextRenderer(cookie))
  {
    renderer->SetRenderWindow(nullptr);
  }
}

//------------------------------------------------------------------------------
bool vtkHeadlessRenderWindow::HasContext()
{
  this->Initialize();
  return this->Context != nullptr;
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::Initialize()
{
  if (!this->Context && this->Problem.empty() && !IsProcessEnding)
  {
    this->CreateAWindow();
  }
  else if (this->Context && !this->Initialized)
  {
    // ReleaseGraphicsResources() has thrown away VTK's picture of the OpenGL state.
    this->MakeCurrent();
    this->OpenGLInit();
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::CreateAWindow()
{
  this->Problem = this->CreateContext();
  if (this->Context)
  {
    this->Mapped = 0;
    this->Size[0] = this->Size[0] > 0 ? this->Size[0] : DefaultEdge;
    this->Size[1] = this->Size[1] > 0 ? this->Size[1] : DefaultEdge;
    this->OpenGLInit();
    GetWindowsWithContext().insert(this);
    FinalizeAtExit(this->GetClassName());
  }
  if (!this->Problem.empty())
  {
    if (this->Context)
    {
      GetWindowsWithContext().erase(this);
      this->DestroyContext();
    }
    vtkErrorMacro("No OpenGL context, nothing will be drawn: " << this->Problem << ".");
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::OpenGLInitContext()
{
  this->ContextCreationTime.Modified();
  if (this->Initialized)
  {
    return;
  }
  this->Problem = PrepareContext();
  this->Initialized = this->Problem.empty();
  this->GlewInitValid = this->Initialized;
  if (this->Initialized)
  {
    GLfloat range[2] = { 1.f, 1.f };
    glGetFloatv(
      this->LineSmoothing ? GL_SMOOTH_LINE_WIDTH_RANGE : GL_ALIASED_LINE_WIDTH_RANGE, range);
    this->MaximumHardwareLineWidth = range[1];
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::Finalize()
{
  this->DestroyWindow();
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::DestroyWindow()
{
  this->Problem.clear();
  if (!this->Context)
  {
    return;
  }
  GetWindowsWithContext().erase(this);
  this->PushContext();
  this->ReleaseGraphicsResources(this);
  this->PopContext();
  this->DestroyContext();
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::WindowRemap()
{
  this->Finalize();
  this->Initialize();
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::PushContext()
{
  this->RememberedContexts.push_back(this->RememberCurrentContext());
  this->MakeCurrent();
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::PopContext()
{
  if (this->RememberedContexts.empty())
  {
    return;
  }
  const std::function<void()> makeCurrent = this->RememberedContexts.back();
  this->RememberedContexts.pop_back();
  if (makeCurrent)
  {
    makeCurrent();
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::Render()
{
  if (this->HasContext())
  {
    this->Superclass::Render();
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::Start()
{
  if (this->HasContext())
  {
    this->Superclass::Start();
  }
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::Frame()
{
  if (this->HasContext())
  {
    this->MakeCurrent();
    this->Superclass::Frame();
  }
}

//------------------------------------------------------------------------------
int vtkHeadlessRenderWindow::ReadPixels(
  const vtkRecti& rect, int front, int glFormat, int glType, void* data, int right)
{
  if (!this->HasContext())
  {
    // The callers allocate memory and do not look at what this returns: give them black. They ask
    // for nothing but RGB and RGBA, as bytes or floats.
    const std::size_t channels = glFormat == GL_RGBA ? 4 : 3;
    const std::size_t bytes = glType == GL_FLOAT ? sizeof(float) : 1;
    std::memset(data, 0, bytes * channels * rect.GetWidth() * rect.GetHeight());
    return VTK_ERROR;
  }
  return this->Superclass::ReadPixels(rect, front, glFormat, glType, data, right);
}

//------------------------------------------------------------------------------
int vtkHeadlessRenderWindow::GetZbufferData(int x1, int y1, int x2, int y2, float* z)
{
  if (!this->HasContext())
  {
    const float farthest = 1.f;
    std::fill_n(z, (std::abs(x2 - x1) + 1) * (std::abs(y2 - y1) + 1), farthest);
    return VTK_ERROR;
  }
  return this->Superclass::GetZbufferData(x1, y1, x2, y2, z);
}

//------------------------------------------------------------------------------
int vtkHeadlessRenderWindow::SupportsOpenGL()
{
  const bool supported = this->HasContext();
  this->OpenGLSupportTested = true;
  this->OpenGLSupportResult = supported ? 1 : 0;
  this->OpenGLSupportMessage =
    supported ? "This window has a context of OpenGL 3.2 or later" : this->Problem;
  return this->OpenGLSupportResult;
}

//------------------------------------------------------------------------------
const char* vtkHeadlessRenderWindow::ReportCapabilities()
{
  if (this->HasContext())
  {
    return this->Superclass::ReportCapabilities();
  }
  const std::string report = "No OpenGL context: " + this->Problem + "\n";
  delete[] this->Capabilities;
  this->Capabilities = new char[report.size() + 1];
  std::copy_n(report.c_str(), report.size() + 1, this->Capabilities);
  return this->Capabilities;
}

//------------------------------------------------------------------------------
void vtkHeadlessRenderWindow::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Context: " << this->Context << "\n";
  os << indent << "Problem: " << (this->Problem.empty() ? "(none)" : this->Problem) << "\n";
  os << indent << "Remembered contexts: " << this->RememberedContexts.size() << "\n";
}

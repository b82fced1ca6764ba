// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHeadlessRenderWindow
 * @brief   an OpenGL render window that is never shown
 *
 * vtkHeadlessRenderWindow is the common part of the render windows that need no display: everything
 * but the making of an OpenGL context, which a subclass does for one library
 * (vtkHeadlessEGLRenderWindow, vtkHeadlessOSMesaRenderWindow). All drawing goes to VTK's own
 * framebuffer objects, so a subclass's context needs no more than a token surface, and the window's
 * size is independent of it.
 *
 * An OpenGL 3.2 core context is asked for; drivers give the newest version that is compatible. If
 * there is none, the first use of the window reports one vtkErrorMacro that says what failed and
 * what is needed. The window then has no context: SupportsOpenGL() is 0, GetOpenGLSupportMessage()
 * says why, Render() draws nothing, and reading pixels gives black and VTK_ERROR. What draws
 * without Render(), as vtkHardwareSelector does, must ask SupportsOpenGL() first. Finalize()
 * forgets the failure, so that a later Render() tries again.
 *
 * A window that still has a context when the process ends is finalized by then, before the OpenGL
 * library is torn down; after that it gets no context any more.
 *
 * Only VTK before 9.4 needs these classes; later ones choose between X11, EGL and OSMesa
 * themselves.
 *
 * @sa vtkHeadlessFactory
 */

#ifndef vtkHeadlessRenderWindow_h
#define vtkHeadlessRenderWindow_h

#include "PenumbraHeadlessModule.h" // for the export macro
#include "vtkOpenGLRenderWindow.h"

#include <functional> // for std::function
#include <string>     // for std::string
#include <vector>     // for std::vector

class PENUMBRAHEADLESS_EXPORT vtkHeadlessRenderWindow : public vtkOpenGLRenderWindow
{
public:
  vtkAbstractTypeMacro(vtkHeadlessRenderWindow, vtkOpenGLRenderWindow)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Make the context if there is none yet, and load the OpenGL functions.
   */
  void Initialize() override;

  /**
   * Release every OpenGL resource of the window, then the context. The window may be used again.
   */
  void Finalize() override;

  /**
   * Draw. Draws nothing if the window could not get a context.
   */
  void Render() override;

  ///@{
  /**
   * Remember which context is current and make this window's current; make the remembered one
   * current again (if there was one). Calls nest. Use them around work in a window of one's own
   * that may be done while another window renders.
   */
  void PushContext() override;
  void PopContext() override;
  ///@}

  /**
   * 1 if this window has an OpenGL context of version 3.2 or later (it is made if need be), else 0.
   */
  int SupportsOpenGL() override;

  /**
   * The OpenGL vendor, renderer, version and extensions, one a line; or, without a context, the
   * reason why there is none.
   */
  const char* ReportCapabilities() override;

  /**
   * The size of a screen that is not there, in pixels: 16384 x 16384, so as to limit nothing.
   */
  int* GetScreenSize() VTK_SIZEHINT(2) override { return this->ScreenSize; }

  /**
   * The context (an EGLContext or OSMesaContext), or nullptr.
   */
  void* GetGenericContext() override { return this->Context; }

  ///@{
  /**
   * A headless window is never shown and always draws into its own buffers: these do nothing.
   */
  void SetShowWindow(bool) override {}
  void SetUseOffScreenBuffers(bool) override {}
  void SetFullScreen(vtkTypeBool) override {}
  void HideCursor() override {}
  void ShowCursor() override {}
  ///@}

  ///@{
  /**
   * There is no window system, hence no display, parent or window to name: the getters return
   * nullptr and the setters do nothing.
   */
  void* GetGenericDisplayId() override { return nullptr; }
  void* GetGenericWindowId() override { return nullptr; }
  void* GetGenericParentId() override { return nullptr; }
  void* GetGenericDrawable() override { return nullptr; }
  void SetDisplayId(void*) override {}
  void SetWindowId(void*) override {}
  void SetParentId(void*) override {}
  void SetNextWindowId(void*) override {}
  void SetNextWindowInfo(const char*) override {}
  void SetWindowInfo(const char*) override {}
  void SetParentInfo(const char*) override {}
  vtkTypeBool GetEventPending() override { return 0; }
  ///@}

  /**
   * Destroy the context and make a new one.
   */
  void WindowRemap() override;

protected:
  vtkHeadlessRenderWindow();

  /**
   * A subclass's destructor must call Finalize(): here it is too late to destroy its context.
   */
  ~vtkHeadlessRenderWindow() override;

  /**
   * Make an OpenGL 3.2 core context, set Context, and make it current. Returns an empty string, or
   * else says what failed and what is needed, in which case Context is nullptr.
   */
  virtual std::string CreateContext() = 0;

  /**
   * Destroy Context, which may or may not be current, and set it to nullptr.
   */
  virtual void DestroyContext() = 0;

  /**
   * A function that makes the context that is current now current again; empty if there is none.
   */
  virtual std::function<void()> RememberCurrentContext() = 0;

  void CreateAWindow() override;
  void DestroyWindow() override;
  void OpenGLInitContext() override;
  void Start() override;
  void Frame() override;
  int ReadPixels(
    const vtkRecti& rect, int front, int glFormat, int glType, void* data, int right = 0) override;

  using Superclass::GetZbufferData;
  int GetZbufferData(int x1, int y1, int x2, int y2, float* z) override;

  void* Context = nullptr;

private:
  vtkHeadlessRenderWindow(const vtkHeadlessRenderWindow&) = delete;
  void operator=(const vtkHeadlessRenderWindow&) = delete;

  bool HasContext();

  /// Why there is no context; empty if there is one or if none was asked for yet.
  std::string Problem;

  std::vector<std::function<void()>> RememberedContexts;
};

#endif

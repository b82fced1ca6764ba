// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHeadlessEGLRenderWindow
 * @brief   a headless render window whose OpenGL context comes from EGL
 *
 * EGL needs no window system. The first of these that offers desktop OpenGL is used, for all
 * windows of the process: Mesa's surfaceless platform (a GPU with a Mesa driver, or Mesa's software
 * renderer), EGL's devices in their own order (this finds NVIDIA's driver), EGL's default display.
 *
 * @sa vtkHeadlessRenderWindow vtkHeadlessFactory
 */

#ifndef vtkHeadlessEGLRenderWindow_h
#define vtkHeadlessEGLRenderWindow_h

#include "PenumbraHeadlessModule.h" // for the export macro
#include "vtkHeadlessRenderWindow.h"

class PENUMBRAHEADLESS_EXPORT vtkHeadlessEGLRenderWindow : public vtkHeadlessRenderWindow
{
public:
  static vtkHeadlessEGLRenderWindow* New();
  vtkTypeMacro(vtkHeadlessEGLRenderWindow, vtkHeadlessRenderWindow)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Make this window's context current in the calling thread, release it, or ask if it is current.
   */
  void MakeCurrent() override;
  void ReleaseCurrent() override;
  bool IsCurrent() override;
  ///@}

  /**
   * 1: EGL talks to the driver without a server in between.
   */
  vtkTypeBool IsDirect() override { return 1; }

protected:
  vtkHeadlessEGLRenderWindow();
  ~vtkHeadlessEGLRenderWindow() override;

  std::string CreateContext() override;
  void DestroyContext() override;
  std::function<void()> RememberCurrentContext() override;

private:
  vtkHeadlessEGLRenderWindow(const vtkHeadlessEGLRenderWindow&) = delete;
  void operator=(const vtkHeadlessEGLRenderWindow&) = delete;

  void* Display = nullptr; // EGLDisplay, shared by all windows, not owned
  void* Surface = nullptr; // EGLSurface
};

#endif

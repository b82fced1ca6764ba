// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHeadlessFactory
 * @brief   gives render windows to processes that have no display
 *
 * VTK before 9.4, built for X11, aborts when a render window is made and no X display can be
 * opened. This object factory makes vtkRenderWindow::New() return headless windows instead. Three
 * ways to use it:
 *
 * - RegisterIfNoDisplay(), called for instance by a ParaView plugin when it is loaded, does so only
 *   where VTK would abort.
 * - The folder of the library PenumbraHeadlessAutoload, named in the environment variable
 *   VTK_AUTOLOAD_PATH, makes the windows of any VTK program headless, display or not.
 * - NewOffScreenWindow() is for code that needs an OpenGL context of its own.
 *
 * It also overrides vtkRenderWindowInteractor with vtkGenericRenderWindowInteractor, since the X11
 * interactor aborts likewise.
 *
 * VTK 9.4 and later do all that themselves: there this factory overrides nothing,
 * RegisterIfNoDisplay() names EGL's windows to VTK (by its variable VTK_DEFAULT_OPENGL_WINDOW,
 * unless that is set), so that no X server is looked for, and NewOffScreenWindow() returns what VTK
 * gives.
 */

#ifndef vtkHeadlessFactory_h
#define vtkHeadlessFactory_h

#include "PenumbraHeadlessModule.h" // for the export macro
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h" // for the return type

class vtkRenderWindow;

class PENUMBRAHEADLESS_EXPORT vtkHeadlessFactory : public vtkObjectFactory
{
public:
  /**
   * A factory whose windows are vtkHeadlessEGLRenderWindows, to be registered at once: the
   * overrides of those that have been registered before are switched off.
   */
  static vtkHeadlessFactory* New();
  vtkTypeMacro(vtkHeadlessFactory, vtkObjectFactory)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * True if vtkRenderWindow::New() gives an X11 window, or nothing, and no X display can be opened
   * (DISPLAY is not set, or names a server that does not answer). A display is never kept open.
   */
  static bool IsDisplayMissing();

  /**
   * If IsDisplayMissing(), let vtkRenderWindow::New() return vtkHeadlessEGLRenderWindows from now
   * on; from VTK 9.4 on, VTK's own windows of EGL where DISPLAY is not set. May be called any
   * number of times.
   */
  static void RegisterIfNoDisplay();

  /**
   * A window to draw in without showing it, of the kind that the process's views have, so that both
   * use the same OpenGL; but a vtkHeadlessEGLRenderWindow if IsDisplayMissing(). It has no context
   * before its first use; ask SupportsOpenGL(). Never nullptr where VTK has render windows at all.
   */
  static vtkSmartPointer<vtkRenderWindow> NewOffScreenWindow();

#ifndef __VTK_WRAP__
  /**
   * Let vtkRenderWindow::New() return what `create` makes, a vtkRenderWindow of class `className`,
   * whichever factories have been registered before.
   */
  static void RegisterWindow(const char* className, CreateFunction create);
#endif

  ///@{
  /**
   * See vtkObjectFactory.
   */
  const char* GetVTKSourceVersion() VTK_FUTURE_CONST override;
  const char* GetDescription() VTK_FUTURE_CONST override;
  ///@}

protected:
  vtkHeadlessFactory();
  ~vtkHeadlessFactory() override;

private:
  vtkHeadlessFactory(const vtkHeadlessFactory&) = delete;
  void operator=(const vtkHeadlessFactory&) = delete;

  static vtkHeadlessFactory* NewFor(const char* className, CreateFunction create);
};

#endif

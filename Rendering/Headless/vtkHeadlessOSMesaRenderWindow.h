// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHeadlessOSMesaRenderWindow
 * @brief   a headless render window whose OpenGL context comes from OSMesa
 *
 * OSMesa is Mesa's software renderer as a plain library: no display, no device, no driver to
 * choose, so a test gets the same pixels everywhere. It is in a library of its own,
 * PenumbraHeadlessOSMesa, which must come before the system's OpenGL in the process: either link a
 * program to the CMake target PenumbraHeadlessOSMesa (which arranges the order), or name the
 * library in LD_PRELOAD. Once it is loaded, vtkRenderWindow::New() makes windows of this class.
 *
 * @sa vtkHeadlessRenderWindow vtkHeadlessFactory
 */

#ifndef vtkHeadlessOSMesaRenderWindow_h
#define vtkHeadlessOSMesaRenderWindow_h

#include "penumbraheadlessosmesa_export.h" // for the export macro
#include "vtkHeadlessRenderWindow.h"

class PENUMBRAHEADLESSOSMESA_EXPORT vtkHeadlessOSMesaRenderWindow : public vtkHeadlessRenderWindow
{
public:
  static vtkHeadlessOSMesaRenderWindow* New();
  vtkTypeMacro(vtkHeadlessOSMesaRenderWindow, vtkHeadlessRenderWindow)

  ///@{
  /**
   * Make this window's context current in the calling thread, release it, or ask if it is current.
   */
  void MakeCurrent() override;
  void ReleaseCurrent() override;
  bool IsCurrent() override;
  ///@}

  /**
   * 0: OSMesa uses no hardware.
   */
  vtkTypeBool IsDirect() override { return 0; }

protected:
  vtkHeadlessOSMesaRenderWindow();
  ~vtkHeadlessOSMesaRenderWindow() override;

  std::string CreateContext() override;
  void DestroyContext() override;
  std::function<void()> RememberCurrentContext() override;

private:
  vtkHeadlessOSMesaRenderWindow(const vtkHeadlessOSMesaRenderWindow&) = delete;
  void operator=(const vtkHeadlessOSMesaRenderWindow&) = delete;

  /// OSMesa draws framebuffer 0 into memory of the caller's. It is only a token, so that
  /// framebuffer 0, which parts of VTK query, exists: RGBA bytes.
  static constexpr int BufferEdge = 16;
  unsigned char Buffer[4 * BufferEdge * BufferEdge] = {};
};

#endif

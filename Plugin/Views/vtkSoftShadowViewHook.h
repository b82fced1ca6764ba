// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSoftShadowViewHook
 * @brief puts a vtkSoftShadowViewPass into a ParaView render view
 *
 * The pass becomes the one that draws the geometry in the view's vtkPVSynchronizedRenderer. There
 * it survives what the view puts around it: ambient occlusion, FXAA, tone mapping, selection,
 * translucency. A pass given to the renderer itself would not, since the view sets that anew.
 */
#ifndef vtkSoftShadowViewHook_h
#define vtkSoftShadowViewHook_h

#include "vtkObject.h"

class vtkPVRenderView;
class vtkSoftShadowViewPass;

class vtkSoftShadowViewHook : public vtkObject
{
public:
  static vtkSoftShadowViewHook* New();
  vtkTypeMacro(vtkSoftShadowViewHook, vtkObject)

  /**
   * The view's pass, which is made if there is none yet. nullptr if the view has no place for one:
   * it draws on another process, or by ray tracing.
   */
  static vtkSoftShadowViewPass* GetPass(vtkPVRenderView* view);

protected:
  vtkSoftShadowViewHook() = default;
  ~vtkSoftShadowViewHook() override = default;

private:
  vtkSoftShadowViewHook(const vtkSoftShadowViewHook&) = delete;
  void operator=(const vtkSoftShadowViewHook&) = delete;
};

#endif

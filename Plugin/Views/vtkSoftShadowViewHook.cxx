// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSoftShadowViewHook.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDefaultPass.h"
#include "vtkPVRenderView.h"
#include "vtkPVSynchronizedRenderer.h"
#include "vtkSoftShadowViewPass.h"

vtkStandardNewMacro(vtkSoftShadowViewHook);

namespace
{

/// vtkPVRenderView keeps its synchronized renderers to itself and its subclasses. A pointer to the
/// member, which a subclass may form, can be applied to any view.
struct SynchronizedRenderersOf : public vtkPVRenderView
{
  static vtkPVSynchronizedRenderer* Get(vtkPVRenderView* view)
  {
    return view->*(&SynchronizedRenderersOf::SynchronizedRenderers);
  }
};

} // namespace

vtkSoftShadowViewPass* vtkSoftShadowViewHook::GetPass(vtkPVRenderView* view)
{
  vtkPVSynchronizedRenderer* renderers = SynchronizedRenderersOf::Get(view);
  if (!renderers)
  {
    return nullptr;
  }
  vtkRenderPass* current = renderers->GetRenderPass();
  if (auto* pass = vtkSoftShadowViewPass::SafeDownCast(current))
  {
    return pass;
  }
  if (current && current->IsA("vtkOSPRayPass"))
  {
    return nullptr; // the ray tracer draws everything, with shadows of its own
  }
  vtkNew<vtkSoftShadowViewPass> pass;
  pass->OnlyDesignatedOn(); // by the representation, not by the data
  if (current)
  {
    pass->SetDelegatePass(current);
  }
  else
  {
    vtkNew<vtkPVDefaultPass> drawScene;
    pass->SetDelegatePass(drawScene);
  }
  renderers->SetRenderPass(pass);
  return pass;
}

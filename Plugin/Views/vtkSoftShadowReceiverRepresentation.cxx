// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSoftShadowReceiverRepresentation.h"

#include "vtkInformation.h"
#include "vtkInformationRequestKey.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVLODActor.h"
#include "vtkPVRenderView.h"
#include "vtkSoftShadowViewHook.h"
#include "vtkSoftShadowViewPass.h"

vtkStandardNewMacro(vtkSoftShadowReceiverRepresentation);

vtkSoftShadowReceiverRepresentation::vtkSoftShadowReceiverRepresentation() = default;
vtkSoftShadowReceiverRepresentation::~vtkSoftShadowReceiverRepresentation() = default;

namespace
{

/// Whether each of several processes draws its own part of the view's data.
bool IsDistributed(vtkPVRenderView* view)
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return view->GetUseDistributedRenderingForRender() && controller &&
    controller->GetNumberOfProcesses() > 1;
}

} // namespace

void vtkSoftShadowReceiverRepresentation::SetMaximumTextureMemory(double memory)
{
  if (!(memory >= 1.0)) // nor NaN
  {
    vtkErrorMacro(
      "Soft Shadow Receiver: MaximumTextureMemory is " << memory << "; allowed: 1 MiB or more.");
  }
  else if (memory != this->MaximumTextureMemory)
  {
    this->MaximumTextureMemory = memory;
    this->Modified();
  }
}

int vtkSoftShadowReceiverRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* input, vtkInformation* output)
{
  // Composite representations add all their parts to the view, active or not, so AddToView() is the
  // wrong place for the pass; but the superclass answers 0 here for those that are not visible.
  if (!this->Superclass::ProcessViewRequest(request, input, output))
  {
    return 0;
  }
  if (request == vtkPVView::REQUEST_RENDER())
  {
    auto* view = vtkPVRenderView::SafeDownCast(input->Get(vtkPVView::VIEW()));
    vtkSoftShadowViewPass* pass = view ? vtkSoftShadowViewHook::GetPass(view) : nullptr;
    if (pass)
    {
      if (!this->HasWarned && IsDistributed(view))
      {
        vtkWarningMacro(
          "Soft Shadow Receiver: several processes draw this view, each the shadows of "
          "its own part of the data. For all shadows, raise the view's "
          "RemoteRenderThreshold, or let one process draw.");
        this->HasWarned = true;
      }
      pass->PrepareFrame(view, this, this->ProgressiveRefinement, this->MaximumTextureMemory);
      vtkSoftShadowPass::Designate(this->GetActor(), this->ShadowShading);
    }
  }
  return 1;
}

bool vtkSoftShadowReceiverRepresentation::RemoveFromView(vtkView* view)
{
  vtkSoftShadowPass::Undesignate(this->GetActor());
  return this->Superclass::RemoveFromView(view);
}

void vtkSoftShadowReceiverRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ShadowShading: " << this->ShadowShading << "\n";
  os << indent << "ProgressiveRefinement: " << this->ProgressiveRefinement << "\n";
  os << indent << "MaximumTextureMemory: " << this->MaximumTextureMemory << "\n";
}

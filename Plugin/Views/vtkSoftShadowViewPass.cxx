// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSoftShadowViewPass.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkPVSession.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSmartPointer.h"

#include <algorithm>

vtkStandardNewMacro(vtkSoftShadowViewPass);

namespace
{

/// vtkPVRenderView asks its window for 5 frames a second before an interactive frame, and for 0.002
/// before a still one; ParaView itself tells them apart at 1 (pqInteractiveViewLink).
constexpr double SlowestInteractiveRate = 1.0;

/// All rests when no frame has been asked for in this time: while something is dragged, or an
/// animation plays, they come faster.
constexpr unsigned long MillisecondsToRest = 100;

/// Between two batches: what the user has done since, Qt handles before it.
constexpr unsigned long MillisecondsBetweenBatches = 10;

/// What vtkPVView tells only its subclasses. A pointer to the member, which a subclass may form,
/// can be applied to any view.
struct ViewParts : public vtkPVRenderView
{
  static bool IsCapturing(vtkPVRenderView* view)
  {
    return (view->*(&ViewParts::GetInCaptureScreenshot))();
  }
  static vtkPVSession* GetSessionOf(vtkPVRenderView* view)
  {
    return (view->*(&ViewParts::GetSession))();
  }
};

} // namespace

vtkSoftShadowViewPass::vtkSoftShadowViewPass() = default;
vtkSoftShadowViewPass::~vtkSoftShadowViewPass() = default;

void vtkSoftShadowViewPass::PrepareFrame(vtkPVRenderView* view, vtkAlgorithm* representation,
  bool progressiveRefinement, double maximumTextureMemory)
{
  this->View = view;
  this->Representation = representation;
  this->MayRefine = progressiveRefinement && (this->MayRefine || !this->IsPrepared);
  this->SetMaximumTextureMemory(this->IsPrepared
      ? std::min(maximumTextureMemory, this->GetMaximumTextureMemory())
      : maximumTextureMemory);
  this->IsPrepared = true;
  this->ChooseBakeMode();
}

void vtkSoftShadowViewPass::ChooseBakeMode()
{
  const bool isStill =
    this->View->GetRenderWindow()->GetDesiredUpdateRate() < SlowestInteractiveRate;
  const bool isComplete =
    !this->MayRefine || ViewParts::IsCapturing(this->View) || (isStill && !this->GetTimerSource());
  this->GoesOn = isStill && !isComplete;
  this->SetBakeMode(isComplete ? COMPLETE : this->IsBatch ? PROGRESSIVE : DRAFT);
}

vtkRenderWindowInteractor* vtkSoftShadowViewPass::GetTimerSource() const
{
  // Only ParaView's window asks for such render windows. Elsewhere, nobody may be there to see a
  // second frame, or no loop of events runs to draw one.
  return this->View && vtkPVView::GetUseGenericOpenGLRenderWindow() ? this->View->GetInteractor()
                                                                    : nullptr;
}

void vtkSoftShadowViewPass::Render(const vtkRenderState* s)
{
  this->Superclass::Render(s);
  this->IsPrepared = false;
  if (this->GoesOn && this->GetBakeProgress() < 1.0)
  {
    this->StartTimer();
  }
}

void vtkSoftShadowViewPass::StartTimer()
{
  vtkRenderWindowInteractor* interactor = this->GetTimerSource();
  if (!interactor)
  {
    return;
  }
  if (interactor != this->Interactor)
  {
    this->Interactor = interactor;
    interactor->AddObserver(vtkCommand::TimerEvent, this, &vtkSoftShadowViewPass::OnTimer);
  }
  else if (this->Timer)
  {
    interactor->DestroyTimer(this->Timer);
  }
  this->Timer =
    interactor->CreateOneShotTimer(this->IsBatch ? MillisecondsBetweenBatches : MillisecondsToRest);
}

void vtkSoftShadowViewPass::OnTimer(vtkObject* caller, unsigned long /*event*/, void* timer)
{
  if (caller != this->Interactor || !this->Timer || *static_cast<int*>(timer) != this->Timer)
  {
    return;
  }
  this->Timer = 0;
  if (!this->View || !this->GoesOn)
  {
    return; // a still frame will come after the interaction
  }
  // Events that are handled while the frame is drawn may close the view, and end its session.
  const vtkSmartPointer<vtkSoftShadowViewPass> self = this;
  const vtkSmartPointer<vtkPVSession> session = ViewParts::GetSessionOf(this->View);
  if (session->GetPendingProgress())
  {
    this->StartTimer();
    return;
  }
  // Progress is told between frames: to show it, Qt takes the OpenGL context.
  session->PrepareProgress();
  if (this->Representation)
  {
    this->Representation->SetProgressText("Soft shadows");
    this->Representation->UpdateProgress(this->GetBakeProgress());
  }
  this->IsBatch = true;
  this->View->StillRender();
  this->IsBatch = false;
  session->CleanupPendingProgress();
}

void vtkSoftShadowViewPass::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "View: " << this->View << "\n";
  os << indent << "MayRefine: " << this->MayRefine << "\n";
  os << indent << "Timer: " << this->Timer << "\n";
}

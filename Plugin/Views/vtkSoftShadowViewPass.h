// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSoftShadowViewPass
 * @brief the pass of a ParaView render view: chooses how much each frame bakes, and goes on later
 *
 * | frame | bakes |
 * |---|---|
 * | for a screenshot or a film, or with ProgressiveRefinement off | all |
 * | interactive | drafts |
 * | still, in ParaView's window | drafts; then timers draw frames with a batch each, until all is
 * done | | still, in scripts and on servers | all |
 *
 * The timers are those of the view's interactor, so that whatever the user does comes between two
 * batches. They rest while the view is interacted with; the still frame after that goes on. Their
 * progress is that of a receiver's representation, which ParaView shows in its status bar as it
 * does a filter's.
 */
#ifndef vtkSoftShadowViewPass_h
#define vtkSoftShadowViewPass_h

#include "vtkSoftShadowPass.h"
#include "vtkWeakPointer.h" // for what is not ours

class vtkAlgorithm;
class vtkPVRenderView;
class vtkRenderWindowInteractor;

class vtkSoftShadowViewPass : public vtkSoftShadowPass
{
public:
  static vtkSoftShadowViewPass* New();
  vtkTypeMacro(vtkSoftShadowViewPass, vtkSoftShadowPass)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * To be called by the representation of each receiver before a frame. A single one without
   * ProgressiveRefinement makes the frame complete; the least MaximumTextureMemory is the pass's.
   */
  void PrepareFrame(vtkPVRenderView* view, vtkAlgorithm* representation, bool progressiveRefinement,
    double maximumTextureMemory);

  void Render(const vtkRenderState* s) override;

protected:
  vtkSoftShadowViewPass();
  ~vtkSoftShadowViewPass() override;

private:
  vtkSoftShadowViewPass(const vtkSoftShadowViewPass&) = delete;
  void operator=(const vtkSoftShadowViewPass&) = delete;

  void ChooseBakeMode();
  vtkRenderWindowInteractor* GetTimerSource() const;
  /// Anew, if one runs already: batches begin when all rests.
  void StartTimer();
  void OnTimer(vtkObject* caller, unsigned long event, void* timer);

  vtkWeakPointer<vtkPVRenderView> View;
  vtkWeakPointer<vtkAlgorithm> Representation;          ///< speaks for all receivers' progress
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< whose timers are observed
  bool IsPrepared = false;
  bool MayRefine = true; ///< all receivers let it
  bool GoesOn = false;   ///< once the frame is drawn, by a timer
  bool IsBatch = false;  ///< the frame is drawn for a timer
  int Timer = 0;         ///< 0 if none runs
};

#endif

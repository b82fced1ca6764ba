// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSoftShadowReceiverRepresentation
 * @brief a surface that shows the soft shadows that fall on it
 *
 * The representation 'Soft Shadow Receiver' of ShadowReceiver's output: a surface like any other,
 * which installs a vtkSoftShadowPass in the render view and names its actor a receiver. The pass
 * finds lights and occluders among whatever else the view shows.
 */
#ifndef vtkSoftShadowReceiverRepresentation_h
#define vtkSoftShadowReceiverRepresentation_h

#include "PenumbraViewsModule.h" // for the export macro
#include "vtkGeometryRepresentationWithFaces.h"

class PENUMBRAVIEWS_EXPORT vtkSoftShadowReceiverRepresentation
  : public vtkGeometryRepresentationWithFaces
{
public:
  static vtkSoftShadowReceiverRepresentation* New();
  vtkTypeMacro(vtkSoftShadowReceiverRepresentation, vtkGeometryRepresentationWithFaces)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * How the receiver shows its radiance, a vtkSoftShadowPass::ShadingMode. Default is SHADOW.
   */
  vtkSetMacro(ShadowShading, int);
  vtkGetMacro(ShadowShading, int);
  ///@}

  ///@{
  /**
   * Whether interactive frames, and still ones in ParaView's window, first show shadows with one
   * sample a light, to be refined when all rests. Default is on.
   */
  vtkSetMacro(ProgressiveRefinement, bool);
  vtkGetMacro(ProgressiveRefinement, bool);
  vtkBooleanMacro(ProgressiveRefinement, bool);
  ///@}

  ///@{
  /**
   * The most memory in MiB, 1 or more, for the textures of the whole view, of which the receiver
   * that allows the least decides (vtkSoftShadowPass::SetMaximumTextureMemory). Any other number is
   * an error, and changes nothing. Default is 256.
   */
  void SetMaximumTextureMemory(double memory);
  vtkGetMacro(MaximumTextureMemory, double);
  ///@}

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* input, vtkInformation* output) override;

protected:
  vtkSoftShadowReceiverRepresentation();
  ~vtkSoftShadowReceiverRepresentation() override;

  bool RemoveFromView(vtkView* view) override;

private:
  vtkSoftShadowReceiverRepresentation(const vtkSoftShadowReceiverRepresentation&) = delete;
  void operator=(const vtkSoftShadowReceiverRepresentation&) = delete;

  int ShadowShading = 0;
  bool ProgressiveRefinement = true;
  double MaximumTextureMemory = 256.0;
  bool HasWarned = false; ///< that shadows are missing, once
};

#endif

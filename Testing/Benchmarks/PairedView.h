// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What shadows cost a frame.
 */
#ifndef PairedView_h
#define PairedView_h

#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkSoftShadowPass.h"

#include <functional>

class vtkActor;
class vtkAlgorithm;
class vtkRenderWindow;

/// An actor of whatever the algorithm makes.
vtkSmartPointer<vtkActor> MakeActor(vtkAlgorithm* algorithm);

/// What was found of the display.
struct FrameResult
{
  double PlainSeconds = 0.0;  ///< median
  double ShadowSeconds = 0.0; ///< median
  double Ratio = 0.0;         ///< median of the ratios of neighbouring frames
  int Bakes = 0;
  double TextureBytes = 0.0;
};

/// A scene twice, with the pass and without, by renderers that fill the same window in turn: a
/// renderer whose pass came and went would build its shaders anew each time.
class PairedView
{
public:
  /// `fill` puts the scene into a renderer; both have this object's camera.
  PairedView(vtkRenderWindow* window, const std::function<void(vtkRenderer*)>& fill);
  ~PairedView();
  PairedView(const PairedView&) = delete;
  void operator=(const PairedView&) = delete;

  vtkCamera* GetCamera() { return this->Camera; }
  /// As vtkRenderer::ResetCamera frames it.
  void ShowAll();

  /// So many frames of each kind in turn, while the camera moves.
  FrameResult Measure(int frames);

private:
  /// Seconds of a frame, of all processors together: what else the machine does hardly adds to it.
  double DrawFrame(bool shadows);

  vtkRenderWindow* Window;
  vtkNew<vtkCamera> Camera;
  vtkNew<vtkRenderer> Plain;
  vtkNew<vtkRenderer> Shadowed;
  vtkNew<vtkSoftShadowPass> Pass;
};

#endif

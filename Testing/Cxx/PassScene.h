// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * A view in plain VTK with a light, a floor and an occluder.
 */
#ifndef PassScene_h
#define PassScene_h

#include "vtkActor.h"
#include "vtkAreaLightSource.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkShadowReceiver.h"
#include "vtkSmartPointer.h"
#include "vtkSoftShadowPass.h"
#include "vtkSphereSource.h"

#include <array>
#include <vector>

/// Everything by its VTK object, so that tests can change what they like.
class PassScene
{
public:
  using Point = std::array<double, 3>;
  using Pixels = std::vector<std::array<unsigned char, 3>>;

  PassScene(int width = 300, int height = 200);

  /// Adds an actor of whatever the algorithm makes.
  vtkSmartPointer<vtkActor> Add(vtkAlgorithm* algorithm);
  /// Adds a planar receiver; its settings are those of `Receiver`, if it is to be the floor, or the
  /// defaults.
  vtkSmartPointer<vtkActor> AddReceiver(
    const Point& origin, const Point& point1, const Point& point2, vtkShadowReceiver* receiver);
  vtkSmartPointer<vtkActor> AddLight(
    vtkAreaLightSource* light, const Point& origin, const Point& point1, const Point& point2);

  /// Draws a frame and reads it.
  Pixels Render();

  /// With the pass, or by the renderer's own means.
  void SetShadows(bool on);

  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkSoftShadowPass> Pass;
};

/// A floor with a sphere over it, under a square light.
class FloorScene : public PassScene
{
public:
  FloorScene();

  vtkNew<vtkSphereSource> Sphere;
  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Light;
  vtkSmartPointer<vtkActor> FloorActor, LightActor, SphereActor;
};

/// Draws a frame of a window and reads it.
PassScene::Pixels DrawFrame(vtkRenderWindow* window);

/// How many pixels differ in any component.
std::size_t CountDifferences(const PassScene::Pixels& a, const PassScene::Pixels& b);

#endif

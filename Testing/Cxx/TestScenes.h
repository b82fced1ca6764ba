// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Scenes that both the product and the oracle understand, and the window that tests bake in.
 */
#ifndef TestScenes_h
#define TestScenes_h

#include "ExactRadiance.h"
#include "PolygonLight.h"
#include "ShadowScene.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"

#include <string>
#include <vector>

class vtkOpenGLRenderWindow;

/// One OSMesa window for all tests of the program: made at the first call.
vtkOpenGLRenderWindow* GetTestWindow();
/// Frees it: to be called before main() ends and VTK's own statics go.
void ReleaseTestWindow();

/// A receiver, lights and occluding triangles.
struct TestScene
{
  std::string Name;
  penumbra::Parallelogram Base{ { -2, -2, 0 }, { 4, 0, 0 }, { 0, 4, 0 } };
  penumbra::ReceiverSettings Settings;
  glm::ivec2 Texels{ 40, 40 };
  std::vector<penumbra::Light> Lights;
  std::vector<oracle::Triangle> Occluders;

  void AddLight(const glm::dvec3& origin, const glm::dvec3& point1, const glm::dvec3& point2,
    const glm::dvec3& radiance = glm::dvec3(1.0));
  /// A rectangle or any other parallelogram.
  void AddPlate(const glm::dvec3& corner, const glm::dvec3& edge1, const glm::dvec3& edge2);
  /// An axis-aligned box.
  void AddBox(const glm::dvec3& low, const glm::dvec3& high);

  /// As the product takes it: surface 0 is the receiver, surface 1 the occluders.
  penumbra::ShadowScene MakeScene() const;
  /// The oracle's answer at the centre of a texel, without reflectance and ambient.
  glm::dvec3 GetExact(int i, int j) const;
};

/// What was baked for a scene.
struct TestBake
{
  std::vector<vtkRadianceBaker::Report> Reports;
  vtkRadianceTexture::Texels Texels;
};

/// Bakes one receiver of a scene.
TestBake BakeReceiver(const penumbra::ShadowScene& scene, std::size_t receiver = 0);

/// How many texels got exact shares, light by light.
std::size_t CountExactTexels(const TestBake& bake);

/// How far baked texels are from the oracle, as shares of the peak of the oracle's values.
struct TestError
{
  double RootMeanSquare = 0.0;
  double Maximum = 0.0;
};

TestError CompareWithOracle(const TestScene& scene);

/// The scenes of the issue: a convex occluder, several that overlap in the light's view, a slanted
/// receiver, a skewed parallelogram receiver, a coloured pair of lights.
std::vector<TestScene> GetOccludedScenes();

#endif

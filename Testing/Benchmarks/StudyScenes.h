// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The scenes of the accuracy study, and the truth about them.
 */
#ifndef StudyScenes_h
#define StudyScenes_h

#include "TestScenes.h"

#include <string>
#include <vector>

/// A floor under one parallelogram light of radiance 1, with occluders between them.
struct StudyScene
{
  std::string Name;
  std::string Title;           ///< for people
  TestScene Exact;             ///< as the oracle takes it
  penumbra::ShadowScene Baked; ///< as the bake takes it: surface 0 is the floor
  penumbra::Parallelogram Light;

  std::size_t GetTriangles() const { return this->Exact.Occluders.size(); }
};

/**
 * In all of them the light is turned by an angle of no special value against the occluders' edges,
 * since edges along the rows of a sampling pattern are a case of their own.
 *
 * Contact: a box that stands on the floor under a small light; its edges lie in the floor.
 */
StudyScene MakeContactScene();
/// Penumbra: a table under a light as wide as itself, close above.
StudyScene MakePenumbraScene();
/// Overlap: 36 tilted plates at six heights, so that several cover one another in the light's view.
StudyScene MakeOverlapScene();
/// Spheres: those of MakeSpheres(rings), for what many triangles cost.
StudyScene MakeSpheresScene(int rings);

/// The exact irradiance over pi at the centres of `texels` x `texels` texels, i fastest.
std::vector<double> GetExactCentres(const StudyScene& scene, int texels);

/**
 * The exact irradiance over pi as the average over each of `cells` x `cells` texels, i fastest: by
 * 2 x 2 Gauss points, with cells divided by four where these differ by more than a share of the
 * unoccluded light, down to 1/32 of a cell's edge. An edge of full contrast is then found to within
 * 1/64 of a cell.
 */
std::vector<double> GetExactAverages(const StudyScene& scene, int cells);

/// The averages over `texels` x `texels` texels from those over a multiple of so many.
std::vector<double> MergeCells(const std::vector<double>& averages, int texels);

#endif

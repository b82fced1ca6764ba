// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LiteralLoop.h
 * @brief The soft shadow algorithm as it was published: H&H 1997, section 3.5, with OpenGL.
 *
 * The reference that visibility masks are compared with. It draws, sample by sample, the receiver
 * with what the sample sends to it, the occluders in black over it, and adds the picture to an
 * accumulator in single precision. With the product it shares the scene, the points on the lights
 * (PolygonLight::Sample() and the patterns) and the choice of the lit side, for both must sample
 * alike; matrices, shaders and framebuffers are its own.
 */

#ifndef LiteralLoop_h
#define LiteralLoop_h

#include "PolygonLight.h"
#include "ShadowScene.h"

#include <cstddef>
#include <vector>

class vtkOpenGLRenderWindow;

/**
 * Bakes one receiver, without supersampling. Texels come i (along EdgeX) fastest.
 */
class LiteralLoop
{
public:
  /// What is made of the hard shadow images.
  enum class Estimator
  {
    PlainSum, ///< their sum, H&H 1997, eq. 1
    Ratio     ///< the exact form factor times the sum over what it would be without occluders
  };

  /**
   * Bake a receiver of the scene; `window` must be current. Leaves the textures of the window alone
   * and its vtkOpenGLState as it was. False if a shader does not compile or OpenGL refuses a
   * framebuffer.
   */
  bool Bake(const penumbra::ShadowScene& scene, std::size_t receiver, vtkOpenGLRenderWindow* window,
    Estimator estimator);

  /// Seconds that the bake took until OpenGL had finished, reading back excluded.
  double GetSeconds() const { return this->Seconds; }

  /**
   * The irradiance over pi of each texel from one light, or from all of them: the estimator's.
   */
  std::vector<glm::dvec3> GetIrradiance(std::size_t light) const;
  std::vector<glm::dvec3> GetIrradiance() const;

  /**
   * Of what a light would send to each texel without occluders, the share that arrives, in [0, 1];
   * 0 where it would send nothing. Only after Estimator::Ratio.
   */
  std::vector<float> GetVisibleShares(std::size_t light) const;

private:
  struct Bakery;
  bool BakeLight(const Bakery& bakery, const penumbra::PolygonLight& light, std::size_t index);

  Estimator Kind = Estimator::PlainSum;
  double Seconds = 0.0;
  std::vector<glm::dvec3> Radiance; ///< of each light
  /// Of each light, by texel: (sum a w v Le, sum a w), w as in eq. 1; empty if it sends nothing.
  std::vector<std::vector<glm::vec4>> Sums;
  /// Of each light, by texel: the exact form factor of the unoccluded light. Only for the ratio.
  std::vector<std::vector<double>> FormFactors;
};

#endif

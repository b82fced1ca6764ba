// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EmbreePeer.h
 * @brief Soft shadows by ray tracing on the processor: what visibility masks have to beat.
 *
 * Embree's occlusion rays, 16 at a time and coherent, on all cores. Each texel has Owen-scrambled
 * Sobol points of its own, so that errors of neighbours are independent; a packet holds 16 of them
 * that are close together on the light, which is several times as fast on many triangles as one of
 * each of 4 x 4 texels. The estimator is the product's: the closed form times the visible share of
 * the samples' weights (Heitz, Hill, McGuire 2018). With the product it shares nothing but the
 * scene.
 */
#ifndef EmbreePeer_h
#define EmbreePeer_h

#include "ReceiverFrame.h"
#include "ShadowScene.h"

#include <cstdint>
#include <memory>
#include <vector>

/**
 * Bakes one receiver under one parallelogram light that lies wholly in front of it and that all of
 * it is in front of. The light's radiance is 1.
 */
class EmbreePeer
{
public:
  struct Input
  {
    const std::vector<penumbra::Surface>& Occluders;
    penumbra::Parallelogram Light; ///< emits towards EdgeX x EdgeY
    penumbra::Parallelogram Base;  ///< lit from where EdgeX x EdgeY points
    glm::ivec2 Texels{ 1 };
    int Samples = 1;
    std::uint32_t Seed = 0;
  };

  EmbreePeer();
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  void operator=(const EmbreePeer&) = delete;

  /// From triangles in main memory to irradiance over pi, by texel, i (along EdgeX) fastest.
  std::vector<float> Bake(const Input& input);

  /// Seconds of the last bake, and of them those that went into the bounding volume hierarchy.
  double GetSeconds() const { return this->Seconds; }
  double GetBuildSeconds() const { return this->BuildSeconds; }

private:
  struct Device;
  std::unique_ptr<Device> Rays;
  double Seconds = 0.0;
  double BuildSeconds = 0.0;
};

#endif

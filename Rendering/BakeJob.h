// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * One receiver's bake.
 */
#ifndef BakeJob_h
#define BakeJob_h

#include "SamplingPattern.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkVisibilityMask.h"
#include "vtkVisibilityShare.h"

#include <algorithm>
#include <vector>

/// What the stages of one receiver's bake share.
struct vtkRadianceBaker::Job
{
  const penumbra::ReceiverPlan& Plan;
  const penumbra::Receiver& Receiver;
  const Part& Wanted;
  vtkOpenGLRenderWindow* Window;
  vtkRadianceTexture* Target = nullptr;
  vtkRadianceTexture::Region Region; ///< in Target, of the texels that are baked
  penumbra::TexelRectangle Resolved; ///< of these
  std::size_t KeptBytes = 0;         ///< that are left of Wanted's
  Report Result;

  bool HasTolerance() const
  {
    return this->Receiver.Settings.ErrorTolerance > 0.0 && this->Wanted.MostSamples == 0;
  }

  /// The texels that are baked, finer ones where there is Supersampling, for those that are wanted.
  penumbra::TexelRectangle FindResolved() const
  {
    const int factor = this->Plan.Supersampling;
    const penumbra::TexelRectangle& wanted = this->Wanted.Rectangle;
    return factor == 1 ? wanted
                       : penumbra::TexelRectangle{ wanted.Low * factor, wanted.High * factor }
                           .Grown(factor / 2)
                           .Intersection(penumbra::WholeRectangle(this->Plan.Texels));
  }

  /// How many samples of a light the receiver's settings ask for, without ErrorTolerance.
  int CountSamples(std::size_t light) const
  {
    const int count = this->Plan.Pairs[light].Samples;
    return this->Wanted.MostSamples > 0 ? std::min(count, this->Wanted.MostSamples) : count;
  }

  /// How many samples of a light there are after each batch, with ErrorTolerance.
  std::vector<int> GetBatchEnds(std::size_t light) const
  {
    return vtkVisibilityShare::GetBatchEnds(
      std::min(this->Receiver.Settings.MaximumLightSamples, this->GetMaximumSamples(light)));
  }

  /// The most samples that OpenGL has room for. OpenGL 3.2 promises it for 8192; Mesa and most
  /// drivers have it for all. Translucent surfaces share it: they leave room for one layer at
  /// least, or OpenGL refuses it with an error.
  int GetMaximumSamples(std::size_t light) const
  {
    return std::max(vtkVisibilityMask::SamplesPerLayer,
      vtkVisibilityMask::GetMaximumSamples(this->Window, 1 + this->Plan.Pairs[light].Translucent));
  }

  /// A pattern's points for a light.
  std::vector<penumbra::LightSample> TakeSamples(std::size_t light, int count) const
  {
    if (this->Plan.Pairs[light].Needed == penumbra::Effect::Hard)
    {
      return this->Plan.Lights[light]->TakeSamples({ glm::dvec2(0.5) });
    }
    const penumbra::ReceiverSettings& settings = this->Receiver.Settings;
    const penumbra::SamplingPattern& pattern =
      penumbra::GetSamplingPatterns()[static_cast<std::size_t>(settings.SamplingPattern)];
    const int most = this->GetMaximumSamples(light);
    std::vector<glm::dvec2> points = pattern.Generate(std::min(count, most),
      static_cast<std::uint32_t>(settings.Seed), this->Plan.Lights[light]->GetAspect());
    points.resize(std::min(points.size(), static_cast<std::size_t>(most)));
    return this->Plan.Lights[light]->TakeSamples(points);
  }

  /// The texels whose shares of a light are kept, if they are: all that a bake may read.
  penumbra::TexelRectangle GetKeptRectangle(std::size_t light) const
  {
    const int halo =
      this->Receiver.Settings.Reconstruction ? vtkRadianceResolver::GetReconstructionHalo() : 0;
    return this->Plan.Pairs[light].Shaded.Grown(halo).Intersection(
      penumbra::WholeRectangle(this->Plan.Texels));
  }

  void NoteBytes(std::size_t light, std::size_t bytes)
  {
    PairReport& pair = this->Result.Pairs[light];
    pair.Bytes = std::max(pair.Bytes, bytes);
    this->Result.PeakBytes = std::max(this->Result.PeakBytes, bytes + this->Target->GetBytes());
  }
};

#endif

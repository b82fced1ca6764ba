// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "PartMasks.h"

#include "vtkOccluderGeometry.h"
#include "vtkTimerLog.h"
#include "vtkVisibilityMask.h"

#include <algorithm>

namespace penumbra
{
namespace
{

/// What a clock tells apart.
constexpr double ShortestSeconds = 1e-4;

} // namespace

std::size_t PartMasks::GetBytes() const
{
  std::size_t bytes = 0;
  for (const LightMasks& light : this->Lights)
  {
    bytes += light.Masks ? light.Masks->GetBytes() : 0;
  }
  return bytes;
}

double PartMasks::GetShare() const
{
  double share = 0.0;
  for (const LightMasks& light : this->Lights)
  {
    share += light.Count > 0 ? static_cast<double>(light.Drawn) / light.Count : 0.0;
  }
  return this->Lights.empty() ? 0.0 : share / static_cast<double>(this->Lights.size());
}

void PartMasks::Release()
{
  for (LightMasks& light : this->Lights)
  {
    if (light.Masks)
    {
      light.Masks->ReleaseGraphicsResources();
    }
  }
  this->Lights.clear();
}

DrawProgress TimedDrawing::Draw(double until, PartMasks::LightMasks& masks,
  vtkOccluderGeometry* occluders, std::size_t triangles,
  const std::vector<RegisteredProjection>& projections, const glm::ivec2& texels,
  const glm::ivec2& firstTexel, double size)
{
  const double work = static_cast<double>(triangles) + size;
  double now = vtkTimerLog::GetUniversalTime();
  do
  {
    const double start = now;
    const double fitting = 0.5 * this->WorkPerSecond * (until - start) / work;
    const auto samples =
      static_cast<int>(std::clamp(fitting, 1.0, static_cast<double>(masks.Count - masks.Drawn)));
    const int end = masks.Drawn + samples;
    if (!masks.Masks->Draw(occluders, projections, texels, firstTexel, masks.Drawn, end))
    {
      return DrawProgress::Failed;
    }
    glFinish();
    masks.Drawn = end;
    now = vtkTimerLog::GetUniversalTime();
    this->WorkPerSecond = samples * work / std::max(now - start, ShortestSeconds);
  } while (masks.Drawn < masks.Count && now < until);
  return masks.Drawn < masks.Count ? DrawProgress::OutOfTime : DrawProgress::Done;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Visibility masks that are drawn little by little.
 */
#ifndef PartMasks_h
#define PartMasks_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "RegisteredProjection.h"
#include "vtkSmartPointer.h"

#include "Vectors.h"

#include <cstddef>
#include <vector>

class vtkOccluderGeometry;
class vtkVisibilityMask;

namespace penumbra
{

/// The masks of a part of a receiver, of each light of the scene.
struct PENUMBRARENDERING_EXPORT PartMasks
{
  struct LightMasks
  {
    vtkSmartPointer<vtkVisibilityMask> Masks; ///< nullptr: none yet, or none are needed
    int Drawn = 0;                            ///< how many samples are
    int Count = 0;                            ///< and how many are to be
  };
  std::vector<LightMasks> Lights;

  /// About how much of them is drawn, from 0 to 1.
  double GetShare() const;
  std::size_t GetBytes() const;
  /// The window must be current.
  void Release();
};

/// How far drawing came in its time.
enum class DrawProgress
{
  Done,
  OutOfTime,
  Failed ///< after vtkErrorMacro
};

/// Draws masks some samples at a time, as many as the time left allows by what was drawn before.
class PENUMBRARENDERING_EXPORT TimedDrawing
{
public:
  /**
   * Draw samples of masks that have been allocated until all are drawn, or it is late: at least
   * one. `until` is in vtkTimerLog::GetUniversalTime()'s seconds; a sample takes its time for
   * `triangles` and for `size`, the masks' texels. The rest is what vtkVisibilityMask::Draw() asks.
   */
  DrawProgress Draw(double until, PartMasks::LightMasks& masks, vtkOccluderGeometry* occluders,
    std::size_t triangles, const std::vector<RegisteredProjection>& projections,
    const glm::ivec2& texels, const glm::ivec2& firstTexel, double size);

private:
  /// Triangles and texels, of as many samples, that were drawn; at first, as many as any machine
  /// draws.
  double WorkPerSecond = 1e6;
};

} // namespace penumbra

#endif

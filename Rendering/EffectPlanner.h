// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What each (receiver, light) pair needs, before any texel is drawn.
 */
#ifndef EffectPlanner_h
#define EffectPlanner_h

#include "FineWindows.h"
#include "LightShape.h"
#include "OccluderSelector.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ReceiverFrame.h"
#include "ShadowScene.h"
#include "TexelRectangle.h"

#include <optional>
#include <string>
#include <vector>

namespace penumbra
{

/// What has to be computed for a light on a receiver (DESIGN 6).
enum class Effect
{
  None, ///< no light arrives: the light is behind the receiver, or dark, or shines away from it, or
        ///< is too faint to matter
  Unoccluded, ///< nothing can block: the closed form alone, no samples
  Umbra,      ///< an occluder hides all of the light from all of the receiver
  Hard,       ///< no penumbra is wider than HardPenumbra, by default a texel: one sample
  Soft        ///< samples decide how much of the light is seen
};

/// The effect's name, as RadianceMap's field data give it.
PENUMBRARENDERING_EXPORT const char* GetEffectName(Effect effect);

/**
 * Plans one pair from bounds alone: None, Unoccluded or Soft.
 *
 * @param frame the receiver
 * @param seen the light, clipped to the receiver's lit side (LightShape::Clip)
 * @param hasOccluders whether any triangle reaches between the receiver and the light
 */
PENUMBRARENDERING_EXPORT Effect PlanEffect(
  const ReceiverFrame& frame, const LightShape& seen, bool hasOccluders);

/**
 * Whether one plane of the selected triangles, of opaque surfaces, hides all of a light from all of
 * a receiver: every ray from a corner of the one to a corner of the other meets it, and so all
 * between them do, since where rays meet a plane is a convex combination of where their neighbours
 * do. The triangles of a plane count together.
 */
PENUMBRARENDERING_EXPORT bool IsWhollyBlocked(
  const ReceiverFrame& frame, const LightShape& seen, const OccluderSelector& occluders);

/// A surface that may shade a receiver from a light, and where.
struct PlannedCaster
{
  SharedSurface Surface;
  TexelRectangle Shadow;
};

/// What was decided for a light on a receiver.
struct PairPlan
{
  Effect Needed = Effect::None;
  std::string Reason;
  /// Where samples decide: the texels (of those that are baked, finer ones where there is
  /// Supersampling) that some occluder may shade from some place on the light.
  TexelRectangle Shaded;
  double PenumbraTexels = 0.0; ///< the greatest width that a penumbra may have
  bool IsUnbounded = false;  ///< an occluder reaches the light's height: shadows may fall anywhere
  std::size_t Triangles = 0; ///< that may block
  std::vector<PlannedCaster> Casters; ///< in the scene's order
  std::size_t Translucent = 0; ///< how many of them are: if any, samples are weighed, not counted
  bool IsTinted = false;       ///< whether one of these weakens components differently
  /// From so many samples on, what penumbras see is cut out of the light instead
  /// (PolygonVisibility); 0: never.
  int ExactFrom = 0;
  int Samples = 0; ///< that the receiver's settings ask for, without ErrorTolerance

  bool IsExact(int samples) const { return this->ExactFrom > 0 && samples >= this->ExactFrom; }
};

/// What was decided for a receiver.
struct PENUMBRARENDERING_EXPORT ReceiverPlan
{
  ReceiverFrame Frame;
  glm::ivec2 Texels{ 1 }; ///< that are baked: the receiver's times Supersampling
  int Supersampling = 1;
  std::vector<Light> Lights;   ///< the scene's, in its order, clipped to the receiver's front
  std::vector<PairPlan> Pairs; ///< of each light
  /// Where finer texels are baked, of which the receiver's are the mean: of all lights, what texels
  /// are too large for (Receiver::IsAutomatic). What Shaded says is without it.
  WindowPlan Fine;

  /// The side that is lit: not Auto.
  ReceiverSide GetSide() const;
};

/**
 * Plans a window of a receiver that has been planned: what is too faint there is so here.
 * `occluders` is given the window, as `window` is by FineWindow::MakeReceiver().
 */
PENUMBRARENDERING_EXPORT ReceiverPlan PlanWindow(const ShadowScene& scene, const Receiver& window,
  const ReceiverPlan& parent, OccluderSelector& occluders);

/**
 * Plans a receiver. `occluders` has taken up the scene; it is given this receiver.
 *
 * All decisions are conservative. Those that are not exact differ from a bake of all samples
 * - by at most PlannerTolerance of the receiver's unoccluded peak, where lights are left out that
 * are too faint;
 * - where no penumbra is wider than HardPenumbra: texels that one crosses are wholly lit or dark.
 *
 * With the receiver's setting Planner off, nothing is decided: every light that can arrive takes
 * its samples, on all texels.
 */
PENUMBRARENDERING_EXPORT ReceiverPlan PlanReceiver(
  const ShadowScene& scene, const Receiver& receiver, OccluderSelector& occluders);

/**
 * The other side of a receiver that has been planned, if it is to be shown with it: the receiver's
 * Side is Auto, some light reaches the other side, and that is not the inside of a closed surface
 * whose bounds no light touches.
 */
PENUMBRARENDERING_EXPORT std::optional<Receiver> FindOtherSide(
  const ShadowScene& scene, std::size_t receiver, const ReceiverPlan& plan);

} // namespace penumbra

#endif

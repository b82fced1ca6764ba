// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BakeChange.h"

#include <algorithm>

namespace penumbra
{
namespace
{

/// All that tells lights apart but their radiance, with which keys begin.
std::vector<double> GetShapeKey(const LightShape& light)
{
  std::vector<double> key = light.GetKey();
  key.erase(key.begin(), key.begin() + 3);
  return key;
}

/// The shadows of surfaces that are not among `others`.
TexelRectangle FindShadowsOfOthers(
  const std::vector<PlannedCaster>& casters, const std::vector<PlannedCaster>& others)
{
  TexelRectangle shadows;
  for (const PlannedCaster& caster : casters)
  {
    const bool isThere = std::any_of(others.begin(), others.end(),
      [&](const PlannedCaster& other) { return other.Surface == caster.Surface; });
    shadows = isThere ? shadows : shadows.Union(caster.Shadow);
  }
  return shadows;
}

/// Whether all texels change if an effect becomes another: those that are the same everywhere have
/// no shadow whose bounds could tell.
bool IsUniform(Effect effect)
{
  return effect == Effect::None || effect == Effect::Umbra;
}

/// Where shares of the same masks are found in another way now: exactly, or no longer so.
TexelRectangle FindOtherwise(const PairPlan& before, const PairPlan& now)
{
  const bool areSoft = before.Needed == Effect::Soft && now.Needed == Effect::Soft;
  return areSoft && before.IsExact(before.Samples) != now.IsExact(now.Samples)
    ? before.Shaded.Union(now.Shaded)
    : TexelRectangle{};
}

/// Where what blocks the light has changed.
TexelRectangle FindStale(const PairPlan& before, const PairPlan& now, const TexelRectangle& whole)
{
  if (before.Needed != now.Needed && (IsUniform(before.Needed) || IsUniform(now.Needed)))
  {
    return whole;
  }
  // One sample instead of many.
  const bool isSampledOtherwise = before.Needed != now.Needed &&
    before.Needed != Effect::Unoccluded && now.Needed != Effect::Unoccluded;
  TexelRectangle stale = isSampledOtherwise
    ? before.Shaded.Union(now.Shaded)
    : FindShadowsOfOthers(before.Casters, now.Casters)
        .Union(FindShadowsOfOthers(now.Casters, before.Casters));
  // Bits are the same in any part of a receiver only where no occluder is as high as the light.
  if (!stale.IsEmpty() && (before.IsUnbounded || now.IsUnbounded))
  {
    stale = whole;
  }
  return stale;
}

} // namespace

BakeChange FindBakeChange(const ReceiverPlan& before, const ReceiverPlan& now, int halo)
{
  const TexelRectangle whole = WholeRectangle(now.Texels);
  BakeChange change;
  std::vector<bool> isMatched(before.Lights.size(), false);
  for (std::size_t i = 0; i < now.Lights.size(); ++i)
  {
    LightChange light;
    const std::vector<double> key = GetShapeKey(*now.Lights[i]);
    for (std::size_t j = 0; j < before.Lights.size() && light.Before == LightChange::New; ++j)
    {
      if (!isMatched[j] && GetShapeKey(*before.Lights[j]) == key)
      {
        light.Before = static_cast<int>(j);
        isMatched[j] = true;
        light.Stale = FindStale(before.Pairs[j], now.Pairs[i], whole);
        const bool isDimmed = before.Lights[j]->Radiance != now.Lights[i]->Radiance &&
          now.Pairs[i].Needed != Effect::None;
        const TexelRectangle stale =
          light.Stale.Union(FindOtherwise(before.Pairs[j], now.Pairs[i]));
        change.Resolved = change.Resolved.Union(isDimmed ? whole : stale.Grown(halo));
      }
    }
    if (light.Before == LightChange::New && now.Pairs[i].Needed != Effect::None)
    {
      change.Resolved = whole;
    }
    change.Lights.push_back(light);
  }
  for (std::size_t j = 0; j < before.Lights.size(); ++j)
  {
    if (!isMatched[j] && before.Pairs[j].Needed != Effect::None)
    {
      change.Resolved = whole;
    }
  }
  change.Resolved = change.Resolved.Intersection(whole);
  return change;
}

} // namespace penumbra

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzedScene.h"

#include <algorithm>
#include <cmath>

namespace
{

/// Scenes tried at most: a bake takes milliseconds.
constexpr int MostTries = 2000;

class Shrinker
{
public:
  Shrinker(FuzzedScene scene, const std::function<bool(const FuzzedScene&)>& fails)
    : Smallest(std::move(scene))
    , Fails(fails)
  {
  }

  FuzzedScene Run()
  {
    do
    {
      this->HasChanged = false;
      this->DropFrom([](FuzzedScene & s) -> auto& { return s.Occluders; });
      this->DropFrom([](FuzzedScene & s) -> auto& { return s.Lights; });
      for (std::size_t i = 0; i < this->Smallest.Lights.size(); ++i)
      {
        this->DropFrom([i](FuzzedScene & s) -> auto& { return s.Lights[i].Cells; });
      }
      this->SimplifySettings();
      this->RoundCoordinates();
    } while (this->HasChanged && this->Tries < MostTries);
    return this->Smallest;
  }

private:
  /// Whether the scene after `change` fails, too: then it is the smallest.
  template <typename Change>
  bool Try(const Change& change)
  {
    if (this->Tries >= MostTries)
    {
      return false;
    }
    FuzzedScene scene = this->Smallest;
    change(scene);
    ++this->Tries;
    if (!MakesSense(scene) || !this->Fails(scene))
    {
      return false;
    }
    this->Smallest = std::move(scene);
    this->HasChanged = true;
    return true;
  }

  /// Drops parts of a list, ever smaller ones.
  template <typename List>
  void DropFrom(const List& list)
  {
    for (std::size_t part = list(this->Smallest).size(); part > 0; part /= 2)
    {
      for (std::size_t first = 0; first + part <= list(this->Smallest).size();)
      {
        const bool isDropped = this->Try(
          [&](FuzzedScene& s)
          {
            const auto begin = list(s).begin() + static_cast<std::ptrdiff_t>(first);
            list(s).erase(begin, begin + static_cast<std::ptrdiff_t>(part));
          });
        first += isDropped ? 0 : part;
      }
    }
  }

  /// Sets a value, unless it is so already.
  template <typename Member, typename Value>
  bool Set(const Member& member, const Value& value)
  {
    return !(member(this->Smallest) == value) &&
      this->Try([&](FuzzedScene& s) { member(s) = value; });
  }

  /// Down to 1, by halves, and then one by one.
  template <typename Member>
  void Lower(const Member& member)
  {
    const auto lower = [&](int value) { return value >= 1 && this->Set(member, value); };
    while (lower(member(this->Smallest) / 2) || lower(member(this->Smallest) - 1))
    {
    }
  }

  void SimplifySettings()
  {
    this->Set(
      [](FuzzedScene & s) -> auto& { return s.Settings.Supersampling; }, 1);
    this->Set(
      [](FuzzedScene & s) -> auto& { return s.Settings.Reconstruction; }, false);
    this->Set(
      [](FuzzedScene & s) -> auto& { return s.Settings.SamplingPattern; }, 0);
    this->Set(
      [](FuzzedScene & s) -> auto& { return s.Settings.Seed; }, 0);
    this->Set(
      [](FuzzedScene & s) -> auto& { return s.Settings.Side; }, penumbra::ReceiverSide::Front);
    this->Lower([](FuzzedScene & s) -> auto& { return s.Settings.LightSamples; });
    this->Lower([](FuzzedScene & s) -> auto& { return s.Texels.x; });
    this->Lower([](FuzzedScene & s) -> auto& { return s.Texels.y; });
    for (std::size_t i = 0; i < this->Smallest.Lights.size(); ++i)
    {
      this->Set(
        [i](FuzzedScene & s) -> auto& { return s.Lights[i].Settings.TwoSided; }, false);
      this->Set(
        [i](FuzzedScene & s) -> auto& { return s.Lights[i].Settings.Radiance; }, glm::dvec3(1.0));
    }
  }

  /// Each point on its own, to ever more decimals.
  void RoundCoordinates()
  {
    std::vector<std::function<glm::dvec3&(FuzzedScene&)>> points = {
      [](FuzzedScene & s) -> auto& { return s.Base.Corner;
  }
  , [](FuzzedScene& s) -> auto& { return s.Base.EdgeX; }
  , [](FuzzedScene& s) -> auto& { return s.Base.EdgeY; }
  ,
};
for (std::size_t i = 0; i < this->Smallest.Lights.size(); ++i)
{
  points.emplace_back([i](FuzzedScene & s) -> auto& { return s.Lights[i].Settings.Origin; });
  points.emplace_back([i](FuzzedScene & s) -> auto& { return s.Lights[i].Settings.Point1; });
  points.emplace_back([i](FuzzedScene & s) -> auto& { return s.Lights[i].Settings.Point2; });
}
for (std::size_t i = 0; i < 3 * this->Smallest.Occluders.size(); ++i)
{
  points.emplace_back([i](FuzzedScene & s) -> auto& { return s.Occluders[i / 3][i % 3]; });
}
for (const auto& point : points)
{
  for (const double steps : { 1.0, 10.0, 1000.0 })
  {
    if (this->Set(point, glm::round(steps * point(this->Smallest)) / steps))
    {
      break;
    }
  }
}
}

FuzzedScene Smallest;
const std::function<bool(const FuzzedScene&)>& Fails;
int Tries = 0;
bool HasChanged = false;
}
;

} // namespace

FuzzedScene Shrink(FuzzedScene scene, const std::function<bool(const FuzzedScene&)>& fails)
{
  return fails(scene) ? Shrinker(std::move(scene), fails).Run() : scene;
}

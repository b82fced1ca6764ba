// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomPairs.h"

#include "DirectionalLight.h"
#include "DiskLight.h"
#include "PointLight.h"
#include "PolygonLight.h"
#include "SegmentLight.h"
#include "SurfaceLight.h"

#include <cmath>

namespace
{

using penumbra::Light;
using penumbra::PolygonLight;
using penumbra::ReceiverFrame;
using Side = ReceiverFrame::Side;

glm::dvec4 RandomRange(RandomGeometry& random)
{
  const double u0 = random.Between(0.0, 1.0), v0 = random.Between(0.0, 1.0);
  return { u0, v0, random.Between(u0, 1.0), random.Between(v0, 1.0) };
}

glm::dvec3 RandomColour(RandomGeometry& random)
{
  const double r = random.Between(0.0, 3.0), g = random.Between(0.0, 3.0);
  return { r, g, random.Between(0.1, 3.0) };
}

Light RandomShape(RandomGeometry& random, const ReceiverFrame& frame)
{
  const auto place = [&]() { return frame.ToWorld(random.InBox(2.0) + glm::dvec3(0.5, 0.5, 1.5)); };
  const glm::dvec3 a = place(), b = place(), c = place();
  switch (random.Below(7))
  {
    case 0:
      return PolygonLight::Triangle(a, b, c);
    case 1:
      return PolygonLight::Parallelogram(a, b, c);
    case 2:
      return penumbra::DiskLight(a, random.Direction(), random.Between(0.1, 1.0) * frame.GetSize());
    case 3:
      return penumbra::SegmentLight(a, b);
    case 4:
      return penumbra::PointLight(a);
    case 5:
    {
      PolygonLight first = PolygonLight::Triangle(a, b, c),
                   second = PolygonLight::Triangle(b, c, place());
      first.Radiance = RandomColour(random);
      second.Radiance = RandomColour(random);
      return penumbra::SurfaceLight({ first, second });
    }
    default:
      return penumbra::DirectionalLight(
        random.Direction(), random.Below(2) == 0 ? 0.0 : random.Between(0.5, 60.0));
  }
}

// Pairs without light are tried again.
Light RandomSeen(RandomGeometry& random, ReceiverFrame& frame, RandomPair::MakeFrame makeFrame)
{
  while (true)
  {
    frame = makeFrame(random);
    const Light light = RandomLight(random, frame);
    Light seen(light->Clip(frame.GetBase().Corner, frame.GetNormal()));
    if (seen->IsValid())
    {
      return seen;
    }
  }
}

} // namespace

ReceiverFrame RandomFrame(RandomGeometry& random)
{
  const double size = std::pow(10.0, random.Between(-3.0, 3.0));
  const double aspect = std::pow(10.0, random.Between(-1.0, 6.0));
  const glm::dvec3 x = random.Direction();
  const glm::dvec3 y =
    glm::normalize(glm::cross(x, random.Direction())) + random.Between(-1.0, 1.0) * x;
  penumbra::Parallelogram base{ {}, size * x, size * aspect * y };
  const glm::dvec3 away = std::pow(10.0, random.Between(-1.0, 4.0)) * random.InBox(size);
  base.Corner = random.Below(2) == 0 ? away : -0.5 * (base.EdgeX + base.EdgeY);
  return { base, random.Below(2) == 0 ? Side::Front : Side::Back };
}

ReceiverFrame RandomNearFrame(RandomGeometry& random)
{
  const glm::dvec3 x = random.Direction();
  const glm::dvec3 y =
    glm::normalize(glm::cross(x, random.Direction())) + random.Between(-1.0, 1.0) * x;
  return { { random.InBox(1.0), x, y }, random.Below(2) == 0 ? Side::Front : Side::Back };
}

Light RandomLight(RandomGeometry& random, const ReceiverFrame& frame)
{
  Light light = RandomShape(random, frame);
  light->Radiance = RandomColour(random);
  light->TwoSided = random.Below(2) == 0;
  return light;
}

RandomPair::RandomPair(RandomGeometry& random, MakeFrame makeFrame)
  : Seen(RandomSeen(random, this->Frame, makeFrame))
{
  if (random.Below(3) != 0)
  {
    this->Range = RandomRange(random);
  }
}

penumbra::LightSample RandomSample(RandomGeometry& random, const penumbra::LightShape& light)
{
  const double x = random.Between(0.0, 1.0);
  return light.TakeSamples({ { x, random.Between(0.0, 1.0) } }).front();
}

glm::dvec3 RandomPointOnRay(RandomGeometry& random, const RandomPair& pair)
{
  const penumbra::LightSample sample = RandomSample(random, *pair.Seen);
  const glm::dvec4& r = pair.Range;
  const glm::dvec3 start(random.Between(r.x, r.z), random.Between(r.y, r.w), 0.0);
  if (sample.IsDirection)
  {
    return start +
      random.Between(0.0, 10.0) * pair.Frame.DirectionToFrame(sample.Place) * pair.Frame.GetSize();
  }
  return glm::mix(start, pair.Frame.ToFrame(sample.Place), random.Between(0.0, 0.999));
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ScreenMap.h"

namespace penumbra
{
glm::dmat4 MakeScreenMap(const Parallelogram& base, const glm::dmat4& worldToView,
  const glm::dmat4& viewToClip, const glm::ivec4& viewport)
{
  // (u, v, 1) to clip coordinates is linear; its part for x, y and w is to be inverted.
  const glm::dvec4 corner = viewToClip * (worldToView * glm::dvec4(base.Corner, 1.0));
  const glm::dvec4 x = viewToClip * (worldToView * glm::dvec4(base.EdgeX, 0.0));
  const glm::dvec4 y = viewToClip * (worldToView * glm::dvec4(base.EdgeY, 0.0));
  const glm::dmat3 toScreen(
    glm::dvec3(x.x, x.y, x.w), glm::dvec3(y.x, y.y, y.w), glm::dvec3(corner.x, corner.y, corner.w));

  glm::dmat3 pixelToDevice(1.0);
  for (int i = 0; i < 2; ++i)
  {
    pixelToDevice[i][i] = 2.0 / viewport[2 + i];
    pixelToDevice[2][i] = -1.0 - 2.0 * viewport[i] / viewport[2 + i];
  }
  const glm::dmat3 fromPixel = glm::inverse(toScreen) * pixelToDevice;
  // clip.z / clip.w is linear in (u q, v q, q); OpenGL maps it from [-1, 1] to [0, 1].
  const glm::dvec3 depth =
    0.5 * (glm::dvec3(x.z, y.z, corner.z) * fromPixel) + glm::dvec3(0.0, 0.0, 0.5);
  const auto column = [&](int i)
  { return glm::dvec4(fromPixel[i].x, fromPixel[i].y, -depth[i], fromPixel[i].z); };
  return glm::dmat4(column(0), column(1), glm::dvec4(0.0, 0.0, 1.0, 0.0), column(2));
}

glm::dmat4 MakeViewMap(const Parallelogram& base, const glm::dmat4& worldToView)
{
  const glm::dmat3 turn(worldToView);
  const Parallelogram seen{ glm::dvec3(worldToView * glm::dvec4(base.Corner, 1.0)),
    turn * base.EdgeX, turn * base.EdgeY };
  return ReceiverFrame(seen, ReceiverFrame::Side::Front).GetWorldToFrame();
}

glm::dmat4 MakeProxyViewMap(
  const Parallelogram& base, const glm::dvec4& centre, const glm::dmat4& worldToView)
{
  const glm::dmat4 toFrame = MakeViewMap(base, worldToView);
  const glm::dvec4 sample = toFrame * (worldToView * centre);
  const glm::dvec3 k = glm::dvec3(sample.x, sample.y, sample.w) / sample.z;
  glm::dmat4 project(1.0); // RegisteredProjection
  project[2] = { -k.x, -k.y, -k.z * ProxyHeight, -k.z };
  project[3].z = ProxyHeight;
  return project * toFrame;
}

glm::dmat4 MakeWindowToView(const glm::dmat4& viewToClip, const glm::ivec4& viewport)
{
  glm::dmat4 windowToDevice(1.0);
  for (int i = 0; i < 2; ++i)
  {
    windowToDevice[i][i] = 2.0 / viewport[2 + i];
    windowToDevice[3][i] = -1.0 - 2.0 * viewport[i] / viewport[2 + i];
  }
  windowToDevice[2][2] = 2.0; // depth is [0, 1]
  windowToDevice[3][2] = -1.0;
  return glm::inverse(viewToClip) * windowToDevice;
}

glm::dmat4 MakeProxyScreenMap(const Parallelogram& base, const glm::dvec4& centre,
  const glm::dmat4& worldToView, const glm::dmat4& viewToClip, const glm::ivec4& viewport)
{
  return MakeProxyViewMap(base, centre, worldToView) * MakeWindowToView(viewToClip, viewport);
}

} // namespace penumbra

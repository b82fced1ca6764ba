// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Where the texels of a receiver are.

uniform ivec2 regionSize; // the receiver's texels
uniform ivec2 firstTexel; // the receiver's texel that is the target's (0, 0)
uniform vec4 metricEdges; // ex and ey in the metric frame's plane (penumbra::ReceiverFrame)

// The texel's centre in the metric frame.
vec3 texelPlace(ivec2 texel)
{
  vec2 uv = (vec2(texel) + 0.5) / vec2(regionSize) - 0.5;
  return vec3(uv.x * metricEdges.xy + uv.y * metricEdges.zw, 0.0);
}

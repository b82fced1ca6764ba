//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Adds up what a window of finer texels (penumbra::FineWindow) changes in a receiver's texels, along one axis:
// first its rows, then the columns of what that gives. In the end a texel gets the window's part of it, in place
// of as much of what it holds without the window.

uniform sampler2D radiance; // of the window, or of its rows' sums
uniform sampler2D variance;
uniform ivec2 sourceFirst;  // the texel that is (0, 0) of them, in their own grid
uniform sampler2D without;  // the receiver's texels without the window
uniform ivec2 withoutFirst; // the receiver's texel that is (0, 0) of these
uniform int hasWithout;     // 0: they count for nothing
uniform ivec2 regionFirst;  // where the receiver's texel (0, 0) lies in the target
uniform int regionStep;     // -1 if the receiver is turned by 180 degrees there, else 1
uniform ivec2 regionSize;
uniform int axis;           // that is added up along: 0 or 1
uniform ivec2 factor;       // of finer texels
uniform ivec2 fineLow;      // that the window has
uniform ivec2 fineHigh;

void main()
{
  ivec2 texel = clamp(regionStep * (ivec2(gl_FragCoord.xy) - regionFirst), ivec2(0), regionSize - 1);
  ivec2 low = max(texel * factor, fineLow);
  ivec2 high = min((texel + 1) * factor, fineHigh);
  vec4 radianceSum = vec4(0.0);
  float errorSum = 0.0;
  // No component is chosen by its number: with a loop that counted fine[axis], bakes on an NVIDIA H200 (driver 580) took
  // many seconds, and the finer texels were all 0.
  bool isRow = axis == 0;
  int first = isRow ? low.x : low.y;
  int last = isRow ? high.x : high.y;
  for (int i = first; i < last; ++i)
  {
    ivec2 fine = isRow ? ivec2(i, texel.y) : ivec2(texel.x, i);
    radianceSum += texelFetch(radiance, fine - sourceFirst, 0);
    // All texels share the light's samples, so their errors add up like the errors of one.
    errorSum += sqrt(texelFetch(variance, fine - sourceFirst, 0).r);
  }
  float count = float(isRow ? factor.x : factor.y);
  vec4 mean = radianceSum / count;
  float error = errorSum / count;
  if (hasWithout != 0)
  {
    vec2 part = vec2(max(high - low, 0)) / vec2(factor);
    mean.rgb -= part.x * part.y * texelFetch(without, texel - withoutFirst, 0).rgb;
  }
  gl_FragData[0] = mean;
  gl_FragData[1] = vec4(error * error, 0.0, 0.0, 0.0);
}

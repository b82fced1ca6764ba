//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Filters a radiance texture down by a whole factor with a tent that reaches from a texel's centre to its
// neighbours': its weights are positive and sum to 1, and unlike a box it lets no edge jump as it crosses
// from one texel to the next. At the receiver's border the weights inside it are normalised.

uniform sampler2D radiance; // of the factor's size
uniform sampler2D variance;
uniform ivec2 regionFirst;  // where the receiver's texel (0, 0) lies in the target
uniform int regionStep;     // -1 if the receiver is turned by 180 degrees there, else 1
uniform ivec2 regionSize;
uniform int factor;
uniform ivec2 fineFirst;    // the receiver's finer texel that is (0, 0) of the sources

void main()
{
  ivec2 texel = clamp(regionStep * (ivec2(gl_FragCoord.xy) - regionFirst), ivec2(0), regionSize - 1);
  vec4 radianceSum = vec4(0.0);
  float errorSum = 0.0;
  float weightSum = 0.0;
  for (int j = -factor / 2; j < factor + factor / 2; ++j)
  {
    for (int i = -factor / 2; i < factor + factor / 2; ++i)
    {
      ivec2 fine = texel * factor + ivec2(i, j);
      if (all(greaterThanEqual(fine, ivec2(0))) && all(lessThan(fine, regionSize * factor)))
      {
        vec2 tent = 1.0 - abs((vec2(i, j) + 0.5) / float(factor) - 0.5);
        float weight = tent.x * tent.y;
        radianceSum += weight * texelFetch(radiance, fine - fineFirst, 0);
        // All texels share the light's samples, so their errors add up like the errors of one.
        errorSum += weight * sqrt(texelFetch(variance, fine - fineFirst, 0).r);
        weightSum += weight;
      }
    }
  }
  float error = errorSum / weightSum;
  gl_FragData[0] = radianceSum / weightSum;
  gl_FragData[1] = vec4(error * error, 0.0, 0.0, 0.0);
}

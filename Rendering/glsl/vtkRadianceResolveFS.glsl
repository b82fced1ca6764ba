//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Adds what one light sends to each texel: the closed form times the share of the light that is seen (Heitz,
// Hill and McGuire 2018), and the variance of that share.
// Output 0: irradiance / pi in rgb, and in a the mean of its components if nothing were blocked.
// Output 1: in r, the variance of the mean of rgb once they are reflected.

uniform sampler2D closedForm; // irradiance / pi of the unoccluded light, in rows from firstRow on
uniform int firstRow;
uniform sampler2D shares;     // vtkVisibilityShareFS.glsl, in rows from sharesFirstRow on
uniform int sharesFirstRow;
uniform int hasShares;        // 0: nothing blocks
uniform ivec2 regionOrigin;   // where the receiver's texels lie in the target
uniform ivec2 regionSize;
uniform vec3 channels;        // 1 for the components that the share is of
uniform float varianceFactor; // 3 if the components' shares come one by one: their errors may be alike
uniform vec3 reflectance;     // for the variance alone

void main()
{
  // Around the receiver, its edge's texels are repeated: see vtkRadianceTexture.
  ivec2 texel = clamp(ivec2(gl_FragCoord.xy) - regionOrigin, ivec2(0), regionSize - 1);
  vec2 seen = hasShares != 0 ? texelFetch(shares, ivec2(texel.x, texel.y - sharesFirstRow), 0).rg : vec2(1.0, 0.0);
  vec3 unblocked = channels * texelFetch(closedForm, ivec2(texel.x, texel.y - firstRow), 0).rgb;
  gl_FragData[0] = vec4(unblocked * seen.r, dot(unblocked, vec3(1.0 / 3.0)));
  float error = dot(unblocked * reflectance, vec3(1.0 / 3.0)) * seen.g;
  gl_FragData[1] = vec4(varianceFactor * error * error, 0.0, 0.0, 0.0);
}

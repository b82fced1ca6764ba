//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Adds what one light sends to each texel: the closed form times the share of the light that is seen (Heitz,
// Hill and McGuire 2018), and the variance of that share.
// Output 0: irradiance / pi in rgb, and in a what is blocked, in the mean of the components: 0, to the bit,
// where nothing is.
// Output 1: in r, the variance of the mean of rgb once they are reflected. The components' errors are added
// with their signs: they come of the same samples, and may be alike or cancel.

uniform sampler2D closedForm; // irradiance / pi of the unoccluded light, in rows from firstRow on
uniform int firstRow;
// SHARES says how many: 1 if the components have one share, 3 if each has its own.
//Penumbra::Shares::Dec
uniform sampler2D shares;     // vtkVisibilityShareFS.glsl, in rows from sharesFirstRow on
#if SHARES == 3
uniform sampler2D greenShares; // those above are of red
uniform sampler2D blueShares;
#endif
uniform int sharesFirstRow;
uniform int hasShares;        // 0: nothing blocks
uniform int reconstruction;   // are shares filtered across texels?
uniform ivec2 regionOrigin;   // where the receiver's texels lie in the target
uniform ivec2 regionSize;
uniform vec3 reflectance;     // for the variance alone

// What a texel sees of the light, and half the difference of what the halves of the samples say.
vec2 seenShare(sampler2D source, ivec2 texel)
{
  return texelFetch(source, ivec2(texel.x, texel.y - sharesFirstRow), 0).rg;
}

// Neighbouring texels see an occluder's edge cross different samples, so their errors partly cancel. Within
// penumbras, where all texels of a window are partly lit, shares are filtered by the window's best quadratic
// (Savitzky and Golay 1964, in two dimensions; weights for 5x5 and 3x3), which keeps slope and curvature. A
// wider window is trusted as far as it agrees with the narrower one to within the standard error that the
// halves of the samples give: where it does not, there is a crease, and it would be smeared.
vec2 reconstructShare(sampler2D source, ivec2 texel)
{
  vec2 one = seenShare(source, texel);
  if (one.r <= 0.0 || one.r >= 1.0 || any(lessThan(texel, ivec2(2))) ||
    any(greaterThanEqual(texel, regionSize - 2)))
  {
    return one;
  }
  vec2 nine = vec2(0.0);
  vec2 all = vec2(0.0);
  vec2 variances = vec2(0.0); // sums over the 3x3 and over the 5x5 window
  bvec2 isPenumbra = bvec2(true);
  for (int j = -2; j <= 2; ++j)
  {
    for (int i = -2; i <= 2; ++i)
    {
      vec2 s = seenShare(source, texel + ivec2(i, j));
      bool isPartial = s.r > 0.0 && s.r < 1.0;
      bool isInner = max(abs(i), abs(j)) < 2;
      float r2 = float(i * i + j * j);
      all += (27.0 - 5.0 * r2) / 175.0 * s;
      nine += isInner ? (5.0 - 3.0 * r2) / 9.0 * s : vec2(0.0);
      variances += s.g * s.g * vec2(isInner ? 1.0 : 0.0, 1.0);
      isPenumbra = bvec2((isPenumbra.x && isPartial) || (isPenumbra.x && !isInner), isPenumbra.y && isPartial);
    }
  }
  vec2 errors = max(sqrt(variances / vec2(9.0, 25.0)), 1e-9);
  float trustNine = isPenumbra.x ? 1.0 - smoothstep(0.5, 2.0, abs(nine.r - one.r) / errors.x) : 0.0;
  float trustAll = isPenumbra.y ? 1.0 - smoothstep(0.5, 1.5, abs(all.r - nine.r) / errors.y) : 0.0;
  vec2 share = mix(mix(one, nine, trustNine), all, trustAll);
  return vec2(clamp(share.r, 0.0, 1.0), share.g);
}

vec2 findShare(sampler2D source, ivec2 texel)
{
  return reconstruction != 0 ? reconstructShare(source, texel) : seenShare(source, texel);
}

void main()
{
  // Around the receiver, its edge's texels are repeated: see vtkRadianceTexture.
  ivec2 texel = clamp(ivec2(gl_FragCoord.xy) - regionOrigin, ivec2(0), regionSize - 1);
  vec3 seen = vec3(1.0);
  vec3 halves = vec3(0.0);
  if (hasShares != 0)
  {
    vec2 red = findShare(shares, texel);
#if SHARES == 3
    vec2 green = findShare(greenShares, texel);
    vec2 blue = findShare(blueShares, texel);
#else
    vec2 green = red;
    vec2 blue = red;
#endif
    seen = vec3(red.r, green.r, blue.r);
    halves = vec3(red.g, green.g, blue.g);
  }
  vec3 unblocked = texelFetch(closedForm, ivec2(texel.x, texel.y - firstRow), 0).rgb;
  gl_FragData[0] = vec4(unblocked * seen, dot(unblocked * (1.0 - seen), vec3(1.0 / 3.0)));
  float error = dot(unblocked * reflectance * halves, vec3(1.0 / 3.0));
  gl_FragData[1] = vec4(error * error, 0.0, 0.0, 0.0);
}

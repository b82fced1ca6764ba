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

uniform sampler2D closedForm;   // irradiance / pi of the unoccluded light
uniform ivec2 firstTexel;       // the receiver's texel that is (0, 0) of closedForm
// SHARES says how many: 1 if the components have one share, 3 if each has its own.
//Penumbra::Shares::Dec
uniform sampler2D shares;       // vtkVisibilityShareFS.glsl
#if SHARES == 3
uniform sampler2D greenShares; // those above are of red
uniform sampler2D blueShares;
#endif
uniform ivec2 sharesFirstTexel; // the receiver's texel that is (0, 0) of the shares
uniform int hasShares;          // 0: all texels see uniformShare
uniform float uniformShare;
uniform int reconstruction;     // are shares filtered across texels?
uniform ivec2 regionFirst;      // where the receiver's texel (0, 0) lies in the target
uniform int regionStep;         // -1 if the receiver is turned by 180 degrees there, else 1
uniform ivec2 regionSize;
uniform vec3 reflectance;       // for the variance alone

// What a texel sees of the light, and half the difference of what the halves of the samples say.
vec2 seenShare(sampler2D source, ivec2 texel)
{
  return texelFetch(source, texel - sharesFirstTexel, 0).rg;
}

// The quadratic that fits the shares of a window of texels best, by least squares (Savitzky and Golay 1964, in
// two dimensions): what it is at the centre.
struct Fit
{
  vec2 share;       // as seenShare()
  float residual;   // root mean square of what the quadratic leaves of the shares, for its degrees of freedom
  float error;      // root mean square of the texels' own standard errors
  bool isPenumbra;  // are all texels partly lit?
};

Fit fitWindow(sampler2D source, ivec2 texel, int radius, vec2 centre)
{
  // The basis 1, x, y, xy, x^2 - m2, y^2 - m2 is orthogonal over the window; m2 and m4 are the means of x^2
  // and x^4 over a row.
  float r = float(radius);
  float n = (2.0 * r + 1.0) * (2.0 * r + 1.0);
  float m2 = r * (r + 1.0) / 3.0;
  float m4 = m2 * (3.0 * r * r + 3.0 * r - 1.0) / 5.0;
  vec2 sum = vec2(0.0);
  vec2 curvature = vec2(0.0);
  vec4 others = vec4(0.0); // x, y, x^2 - m2, y^2 - m2
  float twist = 0.0;
  float squares = 0.0;
  float variances = 0.0;
  bool isPenumbra = true;
  for (int j = -radius; j <= radius; ++j)
  {
    for (int i = -radius; i <= radius; ++i)
    {
      vec2 s = seenShare(source, texel + ivec2(i, j));
      isPenumbra = isPenumbra && s.r > 0.0 && s.r < 1.0;
      variances += s.g * s.g;
      s.r -= centre.r; // squares of small numbers lose fewer digits
      vec2 p = vec2(float(i), float(j));
      vec2 q = p * p - m2;
      sum += s;
      curvature += (q.x + q.y) * s;
      others += vec4(p, q) * s.r;
      twist += p.x * p.y * s.r;
      squares += s.r * s.r;
    }
  }
  float bend = n * (m4 - m2 * m2);
  squares -= sum.r * sum.r / n + dot(others.xy, others.xy) / (n * m2) + dot(others.zw, others.zw) / bend +
    twist * twist / (n * m2 * m2);
  vec2 share = sum / n - m2 * curvature / bend;
  return Fit(vec2(centre.r + share.r, share.g), sqrt(max(squares, 0.0) / (n - 6.0)),
    max(sqrt(variances / n), 1e-9), isPenumbra);
}

// The part of a fit to be taken whose residual is that much of its error: where the quadratic explains the
// shares to within their own errors there is nothing that it could smear, such as the crease where a penumbra
// begins. Half the difference of two halves overestimates the error by about 1.5, hence limits near 1.
float getTrust(Fit fit, float low, float high)
{
  return fit.isPenumbra ? 1.0 - smoothstep(low, high, fit.residual / fit.error) : 0.0;
}

// Neighbouring texels see an occluder's edge cross different samples, so their errors partly cancel: within
// penumbras, shares are fitted in windows as wide as a quadratic explains. Measured on 256 x 256 texels at n =
// 1024, this takes the RMS error from 1.1e-3 to 4e-4 in a wide penumbra, for a tenth more time.
vec2 reconstructShare(sampler2D source, ivec2 texel)
{
  vec2 share = seenShare(source, texel);
  int room = min(min(texel.x, texel.y), min(regionSize.x - 1 - texel.x, regionSize.y - 1 - texel.y));
  if (share.r <= 0.0 || share.r >= 1.0 || room < 1)
  {
    return share;
  }
  vec2 centre = share;
  // The three degrees of freedom that 3x3 texels leave say little; what the fit changes says more.
  Fit fit = fitWindow(source, texel, 1, centre);
  float change = abs(fit.share.r - centre.r) / fit.error;
  share = mix(share, fit.share, fit.isPenumbra ? 1.0 - smoothstep(0.5, 2.0, change) : 0.0);
  if (room >= 2)
  {
    fit = fitWindow(source, texel, 2, centre);
    share = mix(share, fit.share, getTrust(fit, 1.0, 1.3));
  }
  if (room >= 3)
  {
    fit = fitWindow(source, texel, 3, centre);
    share = mix(share, fit.share, getTrust(fit, 0.9, 1.1));
  }
  return vec2(clamp(share.r, 0.0, 1.0), share.g);
}

vec2 findShare(sampler2D source, ivec2 texel)
{
  return reconstruction != 0 ? reconstructShare(source, texel) : seenShare(source, texel);
}

void main()
{
  // Around the receiver, its edge's texels are repeated: see vtkRadianceTexture.
  ivec2 texel = clamp(regionStep * (ivec2(gl_FragCoord.xy) - regionFirst), ivec2(0), regionSize - 1);
  vec3 seen = vec3(uniformShare);
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
  vec3 unblocked = texelFetch(closedForm, texel - firstTexel, 0).rgb;
  gl_FragData[0] = vec4(unblocked * seen, dot(unblocked * (1.0 - seen), vec3(1.0 / 3.0)));
  float error = dot(unblocked * reflectance * halves, vec3(1.0 / 3.0));
  gl_FragData[1] = vec4(error * error, 0.0, 0.0, 0.0);
}

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
// Where hasExact is not 0: shares that are known exactly, and -1 elsewhere; of firstTexel, as closedForm.
uniform sampler2D exactShares;
uniform int hasExact;
uniform ivec2 sharesFirstTexel; // the receiver's texel that is (0, 0) of the shares
uniform int hasShares;          // 0: all texels see uniformShare
uniform float uniformShare;
uniform int reconstruction;     // are shares filtered across texels?
uniform ivec2 regionFirst;      // where the receiver's texel (0, 0) lies in the target
uniform int regionStep;         // -1 if the receiver is turned by 180 degrees there, else 1
uniform ivec2 regionSize;
uniform vec3 reflectance;       // for the variance alone

int windows = 0; // 1: the texel's share is filtered, and windows around it are added up; else 0

// What a texel sees of the light, and half the difference of what the halves of the samples say.
vec2 seenShare(sampler2D source, ivec2 texel)
{
  return texelFetch(source, texel - sharesFirstTexel, 0).rg;
}

// Neighbouring texels see an occluder's edge cross different samples, so their errors partly cancel. Within
// penumbras, the shares of a window of texels are fitted by a quadratic, by least squares (Savitzky and Golay
// 1964, in two dimensions). From the window's middle, its basis is orthogonal: 1, x, y, x^2 - m2, y^2 - m2, xy.
struct Window
{
  ivec2 first; // texel of the receiver
  ivec2 size;
  vec2 middle; // from the first texel
  vec2 m2;     // means over the window: of x^2 and y^2,
  vec2 b;      // and of the squares of x^2 - m2 and y^2 - m2
};

Window makeWindow(ivec2 first, ivec2 size)
{
  vec2 s = vec2(size);
  vec2 m2 = (s * s - 1.0) / 12.0;
  return Window(first, size, 0.5 * (s - 1.0), m2, m2 * ((3.0 * s * s - 7.0) / 20.0 - m2));
}

// The shares, as seenShare() gives them, times the basis, added up.
struct Sums
{
  vec2 ones;
  mat2 slopes;     // a column for x, one for y
  mat2 bends;      // a column for x^2 - m2, one for y^2 - m2
  vec2 twist;      // for xy
  float squares;   // of the shares themselves
  float variances; // squares of standard errors
  bool isPenumbra; // are all texels partly lit? If not, the sums are unfinished
};

// `own` is taken from all shares: squares of small numbers lose fewer digits.
Sums addUp(sampler2D source, Window window, float own)
{
  Sums sums = Sums(vec2(0.0), mat2(0.0), mat2(0.0), vec2(0.0), 0.0, 0.0, true);
  // Software OpenGL also executes what a condition spares a texel, but for loops that it cannot unroll.
  ivec2 size = windows * window.size;
  for (int j = 0; j < size.y && sums.isPenumbra; ++j)
  {
    for (int i = 0; i < size.x && sums.isPenumbra; ++i)
    {
      vec2 share = seenShare(source, window.first + ivec2(i, j));
      sums.isPenumbra = share.r > 0.0 && share.r < 1.0;
      share.r -= own;
      vec2 p = vec2(float(i), float(j)) - window.middle;
      sums.ones += share;
      sums.slopes += outerProduct(share, p);
      sums.bends += outerProduct(share, p * p - window.m2);
      sums.twist += p.x * p.y * share;
      sums.squares += share.r * share.r;
      sums.variances += share.g * share.g;
    }
  }
  return sums;
}

// A window's quadratic.
struct Fit
{
  vec2 share;       // at a texel, as seenShare()
  float variance;   // what is left there of the variance of a count, were the texels' errors independent
  float residual;   // root mean square of what the quadratic leaves of the shares, for its degrees of freedom
  float error;      // root mean square of the texels' own standard errors
  bool isPenumbra;  // is the window on the receiver, and are all of its texels partly lit?
};

// The window has `size` texels from texel + first on; `own` is the texel's share.
Fit fitWindow(sampler2D source, ivec2 texel, ivec2 first, ivec2 size, vec2 own)
{
  Window w = makeWindow(texel + first, size);
  if (any(lessThan(w.first, ivec2(0))) || any(greaterThan(w.first + size, regionSize)))
  {
    return Fit(own, 1.0, 0.0, 1.0, false);
  }
  Sums s = addUp(source, w, own.r);
  float n = float(size.x * size.y);
  float m22 = w.m2.x * w.m2.y; // the mean of (xy)^2
  vec2 slopes = vec2(s.slopes[0].r, s.slopes[1].r);
  vec2 bends = vec2(s.bends[0].r, s.bends[1].r);
  float explained = (s.ones.r * s.ones.r + dot(slopes, slopes / w.m2) + dot(bends, bends / w.b) +
    s.twist.r * s.twist.r / m22) / n;
  // The basis at the texel.
  vec2 p = -vec2(first) - w.middle;
  vec2 q = p * p - w.m2;
  float pq = p.x * p.y;
  vec2 share = (s.ones + s.slopes * (p / w.m2) + s.bends * (q / w.b) + s.twist * pq / m22) / n;
  float variance = (1.0 + dot(p, p / w.m2) + dot(q, q / w.b) + pq * pq / m22) / n;
  return Fit(vec2(own.r + share.r, share.g), variance, sqrt(max(s.squares - explained, 0.0) / (n - 6.0)),
    max(sqrt(s.variances / n), 1e-9), s.isPenumbra);
}

// The part of a fit to be taken whose residual is that much of its error: where the quadratic explains the
// shares to within their own errors there is nothing that it could smear, such as the crease where a penumbra
// begins. Half the difference of two halves overestimates the error by about 1.5, hence limits near 1.
float getTrust(Fit fit, float low, float high)
{
  return fit.isPenumbra ? 1.0 - smoothstep(low, high, fit.residual / fit.error) : 0.0;
}

// Adds a fit to a sum of shares and their weights, the inverse of their variances.
void addFit(inout vec3 sum, Fit fit, float trust)
{
  sum += trust / fit.variance * vec3(fit.share, 1.0);
}

// At a crease: the mean of the texel's own count and of what the windows say that lie to one side of it, halves
// of 5x5 texels. Those that the crease cuts are not trusted.
vec2 averageSides(sampler2D source, ivec2 texel, vec2 own)
{
  vec3 sum = vec3(own, 1.0);
  // The three degrees of freedom that 3x3 texels leave say little; what the fit changes says more.
  Fit fit = fitWindow(source, texel, ivec2(-1), ivec2(3), own);
  float change = abs(fit.share.r - own.r) / fit.error;
  addFit(sum, fit, fit.isPenumbra ? 1.0 - smoothstep(0.8, 2.5, change) : 0.0);
  for (int side = -2; side <= 0; side += 2)
  {
    fit = fitWindow(source, texel, ivec2(side, -2), ivec2(3, 5), own);
    addFit(sum, fit, getTrust(fit, 0.8, 1.4));
    fit = fitWindow(source, texel, ivec2(-2, side), ivec2(5, 3), own);
    addFit(sum, fit, getTrust(fit, 0.8, 1.4));
  }
  return sum.xy / sum.z;
}

// Within penumbras, what windows as wide as a quadratic explains say. Rendering/README.md tells what that brings,
// and where the limits come from.
vec2 reconstructShare(sampler2D source, ivec2 texel)
{
  vec2 own = seenShare(source, texel);
  if (own.r <= 0.0 || own.r >= 1.0)
  {
    return own;
  }
  Fit fit = fitWindow(source, texel, ivec2(-2), ivec2(5), own);
  float trust = getTrust(fit, 1.1, 1.4);
  vec2 share = fit.share;
  if (trust < 1.0)
  {
    share = mix(averageSides(source, texel, own), share, trust);
  }
  if (trust > 0.0)
  {
    fit = fitWindow(source, texel, ivec2(-3), ivec2(7), own);
    share = mix(share, fit.share, getTrust(fit, 0.7, 1.3));
  }
  return vec2(clamp(share.r, 0.0, 1.0), share.g);
}

vec2 findShare(sampler2D source, ivec2 texel)
{
  float exact = hasExact != 0 ? texelFetch(exactShares, texel - firstTexel, 0).r : -1.0;
  windows = exact < 0.0 ? reconstruction : 0;
  vec2 share = reconstruction != 0 ? reconstructShare(source, texel) : seenShare(source, texel);
  return exact < 0.0 ? share : vec2(exact, 0.0);
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

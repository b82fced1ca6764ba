//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Adds what one light sends to each texel: the closed form times the share of the samples that is seen,
// weighted by what each would contribute (Heitz, Hill and McGuire 2018), and the variance of that share.
// Output 0: irradiance / pi in rgb, and in a what is blocked, in the mean of the components: 0, to
// the bit, where nothing is.
// Output 1: in r, the variance of the mean of rgb once they are reflected.

//Penumbra::LightShape::Dec

uniform usampler2DArray masks; // bit s % 32 of layer s / 32: is sample s blocked?
uniform samplerBuffer samples; // xyz: place in the metric frame; w: area, relative to the other samples'
uniform int sampleCount;       // 0: nothing blocks
uniform int firstHalfCount;    // the samples before this one are a stratified set, and so are the others
uniform ivec2 regionOrigin; // where the receiver's texels lie in the target
uniform ivec2 regionSize;
uniform int firstRow;          // the receiver's row that is row 0 of the masks
uniform vec4 metricEdges;      // ex and ey in the metric frame's plane
uniform vec3 lightRadiance;
uniform vec3 reflectance;      // for the variance alone

uint blockedBits(ivec2 texel, int word)
{
  return texelFetch(masks, ivec3(texel.x, texel.y - firstRow, word), 0).r;
}

// All bits of the samples that the word holds.
uint allBits(int word)
{
  int count = sampleCount - 32 * word;
  return count >= 32 ? 0xffffffffu : (1u << uint(count)) - 1u;
}

// What a sample would contribute to the receiver at x, up to a factor that all samples share: H&H 1997,
// eq. 1. The receiver's normal is the z axis.
float sampleWeight(int i, vec3 x)
{
  vec4 s = texelFetch(samples, i);
  vec3 d = s.xyz - x;
  float r2 = dot(d, d);
  return s.w * d.z * abs(dot(lightNormal, d)) / (r2 * r2);
}

// The weights of the samples that are seen (x) and of all (y), in [begin, end), which is within one word:
// its bits from begin on are `blocked`. A loop without branches, for software OpenGL's vectors.
vec2 sumWord(uint blocked, int begin, int end, vec3 x)
{
  vec2 part = vec2(0.0);
  for (int i = begin; i < end; ++i)
  {
    float w = sampleWeight(i, x);
    part += vec2((blocked & 1u) == 0u ? w : 0.0, w);
    blocked >>= 1;
  }
  return part;
}

// The same in any range. Sums of words go into the total, so that rounding grows with n / 32 and not with n.
vec2 sumWeights(int begin, int end, ivec2 texel, vec3 x)
{
  vec2 total = vec2(0.0);
  for (int i = begin; i < end;)
  {
    int stop = min(end, (i | 31) + 1);
    total += sumWord(blockedBits(texel, i >> 5) >> uint(i & 31), i, stop, x);
    i = stop;
  }
  return total;
}

// The share of the light that is seen from x (x), and its variance (y) from what the halves say of it.
vec2 seenShare(ivec2 texel, vec3 x)
{
  bool someBlocked = false;
  bool someSeen = sampleCount == 0;
  for (int word = 0; 32 * word < sampleCount; ++word)
  {
    uint bits = blockedBits(texel, word);
    someBlocked = someBlocked || bits != 0u;
    someSeen = someSeen || bits != allBits(word);
  }
  if (!someBlocked || !someSeen)
  {
    return vec2(someSeen ? 1.0 : 0.0, 0.0);
  }
  vec2 a = sumWeights(0, firstHalfCount, texel, x);
  vec2 b = sumWeights(firstHalfCount, sampleCount, texel, x);
  vec2 both = a + b;
  float share = both.y > 0.0 ? both.x / both.y : 1.0;
  float halfDifference = a.y > 0.0 && b.y > 0.0 ? 0.5 * (a.x / a.y - b.x / b.y) : 0.0;
  return vec2(share, halfDifference * halfDifference);
}

void main()
{
  // Around the receiver, its edge's texels are repeated: see vtkRadianceTexture.
  ivec2 texel = clamp(ivec2(gl_FragCoord.xy) - regionOrigin, ivec2(0), regionSize - 1);
  vec2 uv = (vec2(texel) + 0.5) / vec2(regionSize) - 0.5;
  vec3 x = vec3(uv.x * metricEdges.xy + uv.y * metricEdges.zw, 0.0);

  float side = lightSide(x);
  float form = side > 0.0 || (side < 0.0 && lightTwoSided != 0) ? formFactor(x) : 0.0;
  vec2 seen = form > 0.0 ? seenShare(texel, x) : vec2(0.0);
  float mean = dot(lightRadiance, vec3(1.0 / 3.0)) * form;
  gl_FragData[0] = vec4(lightRadiance * (form * seen.x), mean * (1.0 - seen.x));
  float reflected = dot(lightRadiance * reflectance, vec3(1.0 / 3.0)) * form;
  gl_FragData[1] = vec4(reflected * reflected * seen.y, 0.0, 0.0, 0.0);
}

//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Counts the masks of one light: the share of its samples that each texel sees, weighted by what each would
// contribute (Heitz, Hill and McGuire 2018).
// Output 0: in r the share, in g half of what the two halves of the samples differ by: a standard error. Of
// independent samples it would be that of their mean. Halves of a scrambled net, whose errors fall as n^-3/4,
// are each 2^3/4 times as far out as the whole: it is then 2^1/4 too large, or more (TestErrorEstimate).

//Penumbra::Texel::Dec

// EMISSION is penumbra::Emission: how a sample's light depends on its direction.
#define EMISSION_AREA 0
#define EMISSION_LINE 1
#define EMISSION_POINT 2
#define EMISSION_CELLS 3
//Penumbra::Emission::Dec
// TRANSLUCENT: whether translucent surfaces may weaken samples, too.
//Penumbra::Translucent::Dec

uniform usampler2DArray masks; // bit s % 32 of layer s / 32: is sample s blocked by what is opaque?
uniform ivec2 maskFirstTexel;  // the receiver's texel that is (0, 0) of the masks
uniform samplerBuffer samples; // xyz: place in the metric frame; w: 0 for a direction, else 1
uniform samplerBuffer cells;   // of EMISSION_CELLS: xyz: the cell's normal; w: the power of the sample
uniform int sampleCount;
uniform int firstHalfCount;    // the samples before this one are a stratified set, and so are the others
uniform vec3 lightAxis;        // in the metric frame
uniform int lightTwoSided;
uniform sampler2D previous;    // the answer of earlier samples
uniform int previousCount;     // how many they were
#if TRANSLUCENT
// The masks of each translucent surface follow those of what is opaque, in as many layers.
uniform samplerBuffer transmittances; // x: what each lets through
uniform int translucentCount;
#endif

uint blockedBits(ivec2 texel, int word)
{
  return texelFetch(masks, ivec3(texel - maskFirstTexel, word), 0).r;
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
  vec3 d = s.xyz - s.w * x;
  float r2 = dot(d, d);
#if EMISSION == EMISSION_AREA
  return d.z * abs(dot(lightAxis, d)) / (r2 * r2);
#elif EMISSION == EMISSION_LINE
  return d.z * length(cross(lightAxis, d)) / (r2 * r2);
#elif EMISSION == EMISSION_POINT
  return d.z / (r2 * sqrt(r2));
#else
  vec4 cell = texelFetch(cells, i);
  float cosine = -dot(cell.xyz, d);
  return cell.w * d.z * (lightTwoSided != 0 ? abs(cosine) : max(cosine, 0.0)) / (r2 * r2);
#endif
}

#if TRANSLUCENT
uint translucentBits(ivec2 texel, int surface, int word)
{
  return blockedBits(texel, (surface + 1) * ((sampleCount + 31) >> 5) + word);
}

// The bits of the samples that any translucent surface weakens.
uint weakenedBits(ivec2 texel, int word)
{
  uint bits = 0u;
  for (int surface = 0; surface < translucentCount; ++surface)
  {
    bits |= translucentBits(texel, surface, word);
  }
  return bits;
}

// What the translucent surfaces let through of a sample: the product over those that it passes.
float passingShare(ivec2 texel, int i)
{
  float share = 1.0;
  for (int surface = 0; surface < translucentCount; ++surface)
  {
    uint bit = translucentBits(texel, surface, i >> 5) >> uint(i & 31) & 1u;
    share *= bit != 0u ? texelFetch(transmittances, surface).x : 1.0;
  }
  return share;
}

// As sumWord(), where samples are weakened.
vec2 sumWeakenedWord(uint blocked, int begin, int end, ivec2 texel, vec3 x)
{
  vec2 part = vec2(0.0);
  for (int i = begin; i < end; ++i)
  {
    float w = sampleWeight(i, x);
    part += vec2((blocked & 1u) == 0u ? w * passingShare(texel, i) : 0.0, w);
    blocked >>= 1;
  }
  return part;
}
#endif

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
    uint blocked = blockedBits(texel, i >> 5) >> uint(i & 31);
#if TRANSLUCENT
    total += weakenedBits(texel, i >> 5) != 0u ? sumWeakenedWord(blocked, i, stop, texel, x)
                                               : sumWord(blocked, i, stop, x);
#else
    total += sumWord(blocked, i, stop, x);
#endif
    i = stop;
  }
  return total;
}

// The share of these samples that is seen from x, and half the difference of the halves.
vec2 seenShare(ivec2 texel, vec3 x)
{
  bool someBlocked = false; // or weakened
  bool someSeen = false;
  for (int word = 0; 32 * word < sampleCount; ++word)
  {
    uint bits = blockedBits(texel, word);
    someBlocked = someBlocked || bits != 0u;
#if TRANSLUCENT
    someBlocked = someBlocked || weakenedBits(texel, word) != 0u;
#endif
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
  return vec2(share, a.y > 0.0 && b.y > 0.0 ? 0.5 * (a.x / a.y - b.x / b.y) : 0.0);
}

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy) + firstTexel;
  vec2 seen = seenShare(texel, texelPlace(texel));
  if (previousCount > 0)
  {
    // Earlier samples are one half, these the other.
    float before = texelFetch(previous, ivec2(gl_FragCoord.xy), 0).r;
    float part = float(sampleCount) / float(previousCount + sampleCount);
    seen = vec2(mix(before, seen.r, part), 0.5 * (before - seen.r));
  }
  gl_FragData[0] = vec4(seen, 0.0, 0.0);
}

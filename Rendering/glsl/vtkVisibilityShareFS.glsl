//VTK::System::Dec
//VTK::Output::Dec

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Counts the masks of one light: the share of its samples that each texel sees, weighted by what each would
// contribute (Heitz, Hill and McGuire 2018).
// Output 0: in x the share, in y half of what the two halves of the samples differ by: a standard error. Of
// independent samples it would be that of their mean. Halves of a scrambled net, whose errors fall as n^-3/4,
// are each 2^3/4 times as far out as the whole: it is then 2^1/4 too large, or more (TestErrorEstimate).
// In z and w the sums of weights that more samples go on from: of those that are seen, and of all; 0 where
// none is blocked or weakened, or all are blocked.
//
// n samples are added up in blocks that end at ceil(n / 2^k): those before ceil(n / 2) are one half, the block
// after it is the other. That half is all of the samples of the bake with ceil(n / 2) of them, in the same
// order. So the sums are the same to the bit whether the samples come at once or the blocks come one by one.

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
uniform samplerBuffer samples; // xyz: place in the metric frame, in lengthUnits; w: 0 for a direction, else 1
uniform float lengthUnit;      // a power of two: the fourth power of a far light's distance would overflow
uniform samplerBuffer cells;   // of EMISSION_CELLS: xyz: the cell's normal; w: the power of the sample
uniform int sampleCount;
uniform int halvings;          // the first block ends at sampleCount / 2^halvings, rounded up
uniform vec3 lightAxis;        // in the metric frame
uniform int lightTwoSided;
uniform sampler2D previous;    // the answer of earlier samples
uniform int previousCount;     // how many they were: the end of a block
uniform int maskFirstWord;     // samples from 32 times this one on have masks
#if TRANSLUCENT
// The masks of each translucent surface follow those of what is opaque, in as many layers.
uniform samplerBuffer transmittances; // x: what each lets through
uniform int translucentCount;
#endif

// The bits of 32 samples; `earlier` are those of all that have no masks any more.
uint blockedBits(ivec2 texel, int word, uint earlier)
{
  return word < maskFirstWord ? earlier
                              : texelFetch(masks, ivec3(texel - maskFirstTexel, word - maskFirstWord), 0).r;
}

// All bits of the samples that the word holds.
uint allBits(int word)
{
  int count = sampleCount - 32 * word;
  return count >= 32 ? 0xffffffffu : (1u << uint(count)) - 1u;
}

// What a sample would contribute to the receiver at x, up to a factor that all samples share: H&H 1997,
// eq. 1. The receiver's normal is the z axis. x is in lengthUnits, as the sample is.
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
// Of samples that have no masks any more, none is weakened: their sums are known, or none reaches the texel.
uint translucentBits(ivec2 texel, int surface, int word)
{
  int layers = ((sampleCount + 31) >> 5) - maskFirstWord;
  return word < maskFirstWord ? 0u : blockedBits(texel, (surface + 1) * layers + word, 0u);
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
vec2 sumWeights(int begin, int end, ivec2 texel, vec3 x, uint earlier)
{
  vec2 total = vec2(0.0);
  for (int i = begin; i < end;)
  {
    int stop = min(end, (i | 31) + 1);
    uint blocked = blockedBits(texel, i >> 5, earlier) >> uint(i & 31);
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

// What all samples say, as the output has it.
vec4 countSamples(ivec2 texel, vec3 x)
{
  vec4 before = previousCount > 0 ? texelFetch(previous, ivec2(gl_FragCoord.xy), 0) : vec4(0.0);
  bool isMixed = before.w > 0.0;
  bool someBlocked = previousCount > 0 && (isMixed || before.x < 1.0); // or weakened
  bool someSeen = previousCount > 0 && (isMixed || before.x > 0.0);
  uint earlier = someSeen ? 0u : 0xffffffffu; // unless they are mixed: their sums are known
  for (int word = maskFirstWord; 32 * word < sampleCount; ++word)
  {
    uint bits = blockedBits(texel, word, earlier);
    someBlocked = someBlocked || bits != 0u;
#if TRANSLUCENT
    someBlocked = someBlocked || weakenedBits(texel, word) != 0u;
#endif
    someSeen = someSeen || bits != allBits(word);
  }
  if (!someBlocked || !someSeen)
  {
    return vec4(someSeen ? 1.0 : 0.0, 0.0, 0.0, 0.0);
  }
  int begin = isMixed ? previousCount : 0;
  vec2 both = isMixed ? before.zw : vec2(0.0);
  vec2 a = both;
  vec2 b = vec2(0.0);
  for (int k = halvings; k >= 0; --k)
  {
    int end = (sampleCount + (1 << k) - 1) >> k;
    if (end > begin)
    {
      a = both;
      b = sumWeights(begin, end, texel, x, earlier);
      both = a + b;
      begin = end;
    }
  }
  float share = both.y > 0.0 ? both.x / both.y : 1.0;
  float difference = a.y > 0.0 && b.y > 0.0 ? 0.5 * (a.x / a.y - b.x / b.y) : 0.0;
  return vec4(share, difference, both);
}

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy) + firstTexel;
  gl_FragData[0] = countSamples(texel, texelPlace(texel) / lengthUnit);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SamplingPattern.h"

#include "RandomHash.h"

namespace penumbra
{
namespace
{

constexpr int Bits = 32;

/// The van der Corput sequence: Sobol's first dimension.
std::uint32_t SobolFirst(std::uint32_t index)
{
  std::uint32_t result = 0;
  for (int bit = 0; bit < Bits; ++bit, index >>= 1)
  {
    result = (result << 1) | (index & 1u);
  }
  return result;
}

/// Sobol's second dimension: its direction numbers come from the primitive polynomial x + 1, each
/// from the one before it by v ^ (v >> 1).
std::uint32_t SobolSecond(std::uint32_t index)
{
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << (Bits - 1); index != 0;
       index >>= 1, direction ^= direction >> 1)
  {
    if (index & 1u)
    {
      result ^= direction;
    }
  }
  return result;
}

/// Owen 1995: the nested uniform scramble; a bit is flipped or not for all points that share the
/// bits above it, which keeps every stratum of the sequence.
std::uint32_t OwenScramble(std::uint32_t x, std::uint32_t seed)
{
  std::uint32_t flips = 0;
  for (int bit = Bits - 1; bit >= 0; --bit)
  {
    // The bits above this one, led by a 1 that tells prefixes of different lengths apart.
    const std::uint32_t prefix = bit == Bits - 1 ? 1u : (x >> (bit + 1)) | (1u << (Bits - 1 - bit));
    flips |= (Hash(seed, prefix) & 1u) << bit;
  }
  return x ^ flips;
}

} // namespace

std::vector<glm::dvec2> GenerateSobol(int count, std::uint32_t seed, double /*aspect*/)
{
  // Any block of a power of two of a (0, 2)-sequence is a net, so both halves are stratified in
  // order.
  std::vector<glm::dvec2> points;
  points.reserve(static_cast<std::size_t>(count));
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i)
  {
    points.emplace_back(ToUnit(OwenScramble(SobolFirst(i), Hash(seed, 0u))),
      ToUnit(OwenScramble(SobolSecond(i), Hash(seed, 1u))));
  }
  return points;
}

} // namespace penumbra

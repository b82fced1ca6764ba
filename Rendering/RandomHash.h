// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Repeatable random numbers.
 */
#ifndef RandomHash_h
#define RandomHash_h

#include <cstdint>

namespace penumbra
{

/// Mixes 32 bits so that each bit of the result depends on all of them; a bijection (constants
/// found by Wellons 2018, "Prospecting for Hash Functions").
inline std::uint32_t Hash(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

inline std::uint32_t Hash(std::uint32_t a, std::uint32_t b)
{
  return Hash(a ^ Hash(b + 0x9e3779b9u));
}

/// 32 random bits as a number in [0, 1).
inline double ToUnit(std::uint32_t bits)
{
  return bits * (1.0 / 4294967296.0);
}

/// A stream of random numbers that is the same on every platform (the standard distributions are
/// not).
class RandomStream
{
public:
  explicit RandomStream(std::uint32_t seed)
    : Seed(Hash(seed))
  {
  }
  std::uint32_t NextBits() { return Hash(this->Seed, this->Counter++); }
  double Next() { return ToUnit(this->NextBits()); }

private:
  std::uint32_t Seed;
  std::uint32_t Counter = 0;
};

} // namespace penumbra

#endif

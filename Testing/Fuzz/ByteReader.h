// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * A fuzzer's bytes as numbers.
 */
#ifndef ByteReader_h
#define ByteReader_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

/// Reads from front to back; after the end, all is 0.
class ByteReader
{
public:
  ByteReader(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Left(size)
  {
  }

  std::uint8_t Byte() { return this->Raw<std::uint8_t>(); }
  bool Flag() { return (this->Byte() & 1) != 0; }
  /// In [0, count).
  int Below(int count) { return this->Byte() % count; }

  template <typename Number>
  Number Raw()
  {
    Number number{};
    const std::size_t size = sizeof(Number) < this->Left ? sizeof(Number) : this->Left;
    if (size > 0)
    {
      std::memcpy(&number, this->Data, size);
    }
    this->Data += size;
    this->Left -= size;
    return number;
  }

  /// One byte chooses between places on a grid, those a hair off it, numbers that break formulas,
  /// and any eight bytes.
  double Number()
  {
    using Limits = std::numeric_limits<double>;
    constexpr std::array special = { Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(),
      Limits::max(), -Limits::max(), Limits::min(), Limits::denorm_min(), -0.0, 1e154, 1e-154,
      -1e100, 1e75, 1e-75, 3e38, 1e30, 1e-30, -1e16, 1e9, 1e-9, 65536.0 };
    const int choice = this->Byte();
    constexpr int gridEnd = 200, hairEnd = 224, specialEnd = 250;
    if (choice < gridEnd)
    {
      return 0.25 * (choice % 40 - 20);
    }
    if (choice < hairEnd)
    {
      return 0.25 * (choice % 8) + 1e-9 * this->Raw<std::int8_t>();
    }
    if (choice < specialEnd)
    {
      return special[static_cast<std::size_t>(choice) % special.size()];
    }
    return this->Raw<double>();
  }

private:
  const std::uint8_t* Data;
  std::size_t Left;
};

#endif

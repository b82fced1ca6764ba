// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The fuzzer's target without libFuzzer, for any compiler:
//   PenumbraFuzzReplay COUNT [FIRST]   inputs of random bytes, of the seeds FIRST, FIRST + 1, ...
//   PenumbraFuzzReplay FILE...         inputs that a fuzzer found

#include "SeedOnCrash.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace
{

/// As long as most of what a target reads.
constexpr unsigned MostBytes = 600;

std::vector<std::uint8_t> MakeInput(unsigned seed)
{
  std::mt19937 engine(seed);
  std::vector<std::uint8_t> input(engine() % MostBytes);
  for (std::uint8_t& byte : input)
  {
    byte = static_cast<std::uint8_t>(engine() >> 24);
  }
  return input;
}

int ReplayFiles(int count, char** names)
{
  for (int i = 0; i < count; ++i)
  {
    std::ifstream file(names[i], std::ios::binary);
    if (!file)
    {
      std::cerr << names[i] << " cannot be read\n";
      return EXIT_FAILURE;
    }
    const std::string bytes{ std::istreambuf_iterator<char>(file), {} };
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::cout << count << " files\n";
  return EXIT_SUCCESS;
}

} // namespace

int main(int argc, char** argv)
{
  const unsigned long count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 0;
  if (count == 0)
  {
    return ReplayFiles(argc - 1, argv + 1);
  }
  const auto first = static_cast<unsigned>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1);
  for (unsigned seed = first; seed < first + count; ++seed)
  {
    SeedOnCrash::Set("PenumbraFuzzReplay 1 " + std::to_string(seed));
    const std::vector<std::uint8_t> input = MakeInput(seed);
    LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  std::cout << count << " random inputs from seed " << first << "\n";
  return EXIT_SUCCESS;
}

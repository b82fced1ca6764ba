// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SamplingPattern.h"

namespace penumbra
{

const std::vector<SamplingPattern>& GetSamplingPatterns()
{
  static const std::vector<SamplingPattern> patterns{
    { "Sobol", true, GenerateSobol },
    { "Correlated Multi-Jittered", false, GenerateCorrelatedMultiJittered },
    { "Jittered Grid", false, GenerateJitteredGrid },
    { "Uniform Grid", false, GenerateUniformGrid },
    { "Random", true, GenerateRandom },
  };
  return patterns;
}

} // namespace penumbra

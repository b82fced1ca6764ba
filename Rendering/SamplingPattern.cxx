// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SamplingPattern.h"

namespace penumbra
{

const std::vector<SamplingPattern>& GetSamplingPatterns()
{
  static const std::vector<SamplingPattern> patterns{
    { "Sobol", GenerateSobol },
    { "Correlated Multi-Jittered", GenerateCorrelatedMultiJittered },
    { "Jittered Grid", GenerateJitteredGrid },
    { "Uniform Grid", GenerateUniformGrid },
    { "Random", GenerateRandom },
  };
  return patterns;
}

} // namespace penumbra

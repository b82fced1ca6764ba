// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReceiverTexels.h"

#include "vtkReceiverTexel.h"
#include "vtkShaderProgram.h"

namespace penumbra
{

std::string WithReceiverTexels(const char* fragmentShader)
{
  std::string source = fragmentShader;
  vtkShaderProgram::Substitute(source, "//Penumbra::Texel::Dec", vtkReceiverTexel);
  return source;
}

void SetReceiverTexels(vtkShaderProgram* program, const ReceiverFrame& frame,
  const glm::ivec2& texels, const glm::ivec2& firstTexel)
{
  const glm::vec3 x(frame.DirectionToMetric(frame.GetBase().EdgeX));
  const glm::vec3 y(frame.DirectionToMetric(frame.GetBase().EdgeY));
  const float edges[4] = { x.x, x.y, y.x, y.y };
  program->SetUniform4f("metricEdges", edges);
  program->SetUniform2i("regionSize", &texels.x);
  program->SetUniform2i("firstTexel", &firstTexel.x);
}

} // namespace penumbra

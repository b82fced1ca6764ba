// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Spheres.h"

#include <cmath>
#include <random>

namespace
{

constexpr int Spheres = 12;

} // namespace

penumbra::Surface MakeSpheres(int rings)
{
  std::mt19937 random(1);
  const auto next = [&]() { return random() / 4294967296.0; };
  const double pi = std::acos(-1.0);
  const int columns = 2 * rings;
  penumbra::Surface surface;
  for (int s = 0; s < Spheres; ++s)
  {
    const double x = 1.5 + 7.0 * next(), y = 1.5 + 7.0 * next(), z = 1.0 + 3.0 * next();
    const double radius = 0.5 + 0.4 * next();
    const auto first = static_cast<std::uint32_t>(surface.Points.size());
    const auto index = [&](int ring, int column)
    { return first + static_cast<std::uint32_t>(ring * columns + column % columns); };
    for (int j = 0; j <= rings; ++j)
    {
      for (int i = 0; i < columns; ++i)
      {
        const double theta = pi * j / rings, phi = 2.0 * pi * i / columns;
        surface.Points.push_back(glm::dvec3(x, y, z) +
          radius *
            glm::dvec3(
              std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
      }
    }
    for (int j = 0; j < rings; ++j)
    {
      for (int i = 0; i < columns; ++i)
      {
        if (j > 0)
        {
          surface.Triangles.push_back({ index(j, i), index(j + 1, i), index(j, i + 1) });
        }
        if (j < rings - 1)
        {
          surface.Triangles.push_back({ index(j, i + 1), index(j + 1, i), index(j + 1, i + 1) });
        }
      }
    }
  }
  return surface;
}

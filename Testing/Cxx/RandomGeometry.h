// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Random numbers, points and directions: the same on every machine, unlike those of the standard
 * library's distributions.
 */
#ifndef RandomGeometry_h
#define RandomGeometry_h

#include "Vectors.h"

#include <cstddef>
#include <random>
#include <utility>
#include <vector>

class RandomGeometry
{
public:
  explicit RandomGeometry(unsigned seed)
    : Engine(seed)
  {
  }

  double Between(double low, double high)
  {
    return low + (high - low) * static_cast<double>(this->Engine() >> 11) * 0x1p-53;
  }

  std::size_t Below(std::size_t count) { return this->Engine() % count; }

  /// In a cube around the origin.
  glm::dvec3 InBox(double halfWidth)
  {
    const double x = this->Between(-halfWidth, halfWidth);
    const double y = this->Between(-halfWidth, halfWidth);
    return { x, y, this->Between(-halfWidth, halfWidth) };
  }

  /// A unit vector, all directions alike: a point in a ball.
  glm::dvec3 Direction()
  {
    glm::dvec3 d(0.0);
    while (glm::length(d) < 0.1 || glm::length(d) > 1.0)
    {
      d = this->InBox(1.0);
    }
    return glm::normalize(d);
  }

  template <typename T>
  void Shuffle(std::vector<T>& items)
  {
    for (std::size_t i = items.size(); i > 1; --i)
    {
      std::swap(items[i - 1], items[this->Below(i)]);
    }
  }

private:
  std::mt19937_64 Engine;
};

#endif

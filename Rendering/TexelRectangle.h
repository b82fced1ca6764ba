// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Rectangles of texels.
 */
#ifndef TexelRectangle_h
#define TexelRectangle_h

#include "Vectors.h"

namespace penumbra
{

/// The texels from Low (inclusive) to High (exclusive). Empty where High is not greater.
struct TexelRectangle
{
  glm::ivec2 Low{ 0 };
  glm::ivec2 High{ 0 };

  bool IsEmpty() const { return this->High.x <= this->Low.x || this->High.y <= this->Low.y; }
  glm::ivec2 GetSize() const { return glm::max(this->High - this->Low, glm::ivec2(0)); }
  /// How many texels it has.
  double GetArea() const
  {
    const glm::dvec2 size(this->GetSize());
    return size.x * size.y;
  }

  TexelRectangle Intersection(const TexelRectangle& other) const
  {
    return { glm::max(this->Low, other.Low), glm::min(this->High, other.High) };
  }
  /// The smallest that holds both; an empty one counts for nothing.
  TexelRectangle Union(const TexelRectangle& other) const
  {
    if (this->IsEmpty() || other.IsEmpty())
    {
      return this->IsEmpty() ? other : *this;
    }
    return { glm::min(this->Low, other.Low), glm::max(this->High, other.High) };
  }
  /// With so many texels more on each side; an empty one stays empty.
  TexelRectangle Grown(int margin) const
  {
    return this->IsEmpty() ? TexelRectangle{}
                           : TexelRectangle{ this->Low - margin, this->High + margin };
  }
  /// Its rows from `first` to before `last`.
  TexelRectangle Rows(int first, int last) const
  {
    return { { this->Low.x, first }, { this->High.x, last } };
  }
  bool Holds(const TexelRectangle& other) const
  {
    return other.IsEmpty() || this->Intersection(other) == other;
  }

  bool operator==(const TexelRectangle& other) const
  {
    return this->Low == other.Low && this->High == other.High;
  }
  bool operator!=(const TexelRectangle& other) const { return !(*this == other); }
};

/// All texels of a receiver.
inline TexelRectangle WholeRectangle(const glm::ivec2& texels)
{
  return { glm::ivec2(0), texels };
}

} // namespace penumbra

#endif

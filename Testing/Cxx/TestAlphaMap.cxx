// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles cut along the alpha of a texture: each place is covered once, by its texel's alpha,
// which is looked up here as OpenGL's nearest filter does; and no corner lies within another part's
// edge.

#include "AlphaMap.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace
{

using penumbra::AlphaMap;
using penumbra::AlphaTexels;
using penumbra::TextureWrap;

using Triangle = std::array<AlphaMap::Corner, 3>;

constexpr int Seeds = 400;
constexpr int Levels = 16;

/// Few alphas, so that texels go together; 0 is one of them, unless `isSolid`.
AlphaTexels RandomTexels(RandomGeometry& random, bool isSolid)
{
  AlphaTexels texels;
  texels.Size = { 1 + static_cast<int>(random.Below(12)), 1 + static_cast<int>(random.Below(12)) };
  const bool isBlocky = random.Below(2) == 0;
  for (int i = 0; i < texels.Size.x * texels.Size.y; ++i)
  {
    const double alpha = 0.25 * static_cast<double>(random.Below(isSolid ? 4 : 5) + isSolid);
    const bool isSame = isBlocky && i > 0 && random.Below(4) > 0;
    texels.Alpha.push_back(isSame ? texels.Alpha.back() : alpha);
  }
  texels.Wrap = static_cast<TextureWrap>(random.Below(4));
  texels.Border = 0.25 * static_cast<double>(random.Below(4) + isSolid);
  return texels;
}

/// Its points are its texture coordinates, which may pass the texture's edges.
Triangle RandomTriangle(RandomGeometry& random)
{
  const double size = random.Below(2) == 0 ? 0.3 : 2.0;
  const glm::dvec3 middle = random.InBox(1.5);
  Triangle triangle;
  for (AlphaMap::Corner& corner : triangle)
  {
    // Half of them on the texels' lines of a texture of 8 texels.
    corner.Place = glm::dvec2(middle + random.InBox(size));
    corner.Place = random.Below(2) == 0 ? corner.Place : glm::round(8.0 * corner.Place) / 8.0;
    corner.Point = glm::dvec3(corner.Place, 0.0);
    corner.Value = 3.0 * corner.Place.x - corner.Place.y;
  }
  return triangle;
}

/// OpenGL 3.2, table 3.22: the coordinate of a texel that a wrap mode makes of any.
int WrapIndex(int i, int size, TextureWrap wrap)
{
  const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
  switch (wrap)
  {
    case TextureWrap::Repeat:
      return modulo(i, size);
    case TextureWrap::Mirror:
    {
      const int rest = modulo(i, 2 * size);
      return rest < size ? rest : 2 * size - 1 - rest;
    }
    case TextureWrap::Edge:
      return std::clamp(i, 0, size - 1);
    default:
      return i < 0 || i >= size ? -1 : i;
  }
}

double LookUp(const AlphaTexels& texels, const glm::dvec2& place)
{
  const glm::dvec2 texel = glm::floor(place * glm::dvec2(texels.Size));
  const int x = WrapIndex(static_cast<int>(texel.x), texels.Size.x, texels.Wrap);
  const int y = WrapIndex(static_cast<int>(texel.y), texels.Size.y, texels.Wrap);
  return x < 0 || y < 0 ? texels.Border
                        : texels.Alpha.at(static_cast<std::size_t>(y * texels.Size.x + x));
}

double Cross(const glm::dvec2& a, const glm::dvec2& b)
{
  return a.x * b.y - a.y * b.x;
}

/// A triangle of a piece.
struct Covered
{
  double Alpha;
  std::array<AlphaMap::Corner, 3> Corners;

  glm::dvec2 At(std::size_t i) const { return glm::dvec2(this->Corners[i % 3].Point); }
  /// How far inside of all edges a place is; less than 0 outside.
  double GetDepth(const glm::dvec2& place) const
  {
    const double turn = Cross(this->At(1) - this->At(0), this->At(2) - this->At(0));
    double depth = 1e30;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const glm::dvec2 edge = this->At(i + 1) - this->At(i);
      const double distance = Cross(edge, place - this->At(i)) / glm::length(edge);
      depth = std::min(depth, turn < 0.0 ? -distance : distance);
    }
    return depth;
  }
};

std::vector<Covered> Cut(const AlphaMap& map, const Triangle& triangle)
{
  std::vector<Covered> all;
  EXPECT_TRUE(map.VisitPieces(triangle,
    [&all](const AlphaMap::Piece& piece)
    {
      const std::size_t count = piece.Corners.size();
      for (std::size_t i = 0; i < piece.CountTriangles(); ++i)
      {
        const std::size_t third = i + 2 < count ? i + 2 : 1;
        all.push_back(
          { piece.Alpha, { piece.Corners[0], piece.Corners[i + 1], piece.Corners[third] } });
      }
      return true;
    }));
  return all;
}

} // namespace

TEST(AlphaMap, CoversEachPlaceOnceByItsTexel)
{
  constexpr double tooNear = 1e-9; // to an edge: not judged
  int judged = 0;
  for (unsigned seed = 0; seed < Seeds; ++seed)
  {
    RandomGeometry random(seed);
    const AlphaTexels texels = RandomTexels(random, false);
    const Triangle triangle = RandomTriangle(random);
    const std::vector<Covered> pieces = Cut(AlphaMap(texels, 1, Levels), triangle);
    const Covered whole{ 1.0, triangle };
    for (int i = 0; i < 50; ++i)
    {
      const double a = random.Between(-0.1, 1.1), b = random.Between(-0.1, 1.1);
      const glm::dvec2 place = glm::mix(glm::mix(whole.At(0), whole.At(1), a), whole.At(2), b);
      double found = 0.0;
      int times = 0, edges = 0;
      for (const Covered& piece : pieces)
      {
        const double depth = piece.GetDepth(place);
        times += depth > tooNear;
        edges += std::abs(depth) <= tooNear;
        found = depth > tooNear ? piece.Alpha : found;
      }
      if (edges > 0 || std::abs(whole.GetDepth(place)) <= tooNear)
      {
        continue;
      }
      const double right = whole.GetDepth(place) > 0.0 ? LookUp(texels, place) : 0.0;
      ASSERT_EQ(found, right) << "seed " << seed << ", at " << place.x << ", " << place.y;
      ASSERT_EQ(times, right > 0.0 ? 1 : 0) << "seed " << seed;
      ++judged;
    }
  }
  EXPECT_GT(judged, 30 * Seeds);
}

// What is linear on the triangle is so on its parts: the points are the places, but for the period.
TEST(AlphaMap, CornersKeepWhatIsLinear)
{
  for (unsigned seed = 0; seed < Seeds; ++seed)
  {
    RandomGeometry random(seed);
    const AlphaTexels texels = RandomTexels(random, false);
    const bool repeats = texels.Wrap == TextureWrap::Repeat || texels.Wrap == TextureWrap::Mirror;
    for (const Covered& piece : Cut(AlphaMap(texels, 1, Levels), RandomTriangle(random)))
    {
      for (const AlphaMap::Corner& corner : piece.Corners)
      {
        const glm::dvec2 periods = glm::dvec2(corner.Point) - corner.Place;
        const glm::dvec2 off = periods - (repeats ? glm::round(periods) : glm::dvec2(0.0));
        EXPECT_NEAR(glm::length(off), 0.0, 1e-13) << "seed " << seed;
        EXPECT_NEAR(corner.Value, 3.0 * corner.Point.x - corner.Point.y, 1e-13) << "seed " << seed;
      }
    }
  }
}

// A rasteriser moves corners a little: were one within another part's edge, there would be a gap.
TEST(AlphaMap, LeavesNoCornerWithinAnEdge)
{
  int joints = 0;
  for (unsigned seed = 0; seed < Seeds; ++seed)
  {
    RandomGeometry random(seed);
    const AlphaTexels texels = RandomTexels(random, true);
    const Covered whole{ 1.0, RandomTriangle(random) };
    if (Cross(whole.At(1) - whole.At(0), whole.At(2) - whole.At(0)) == 0.0)
    {
      continue; // all on one line
    }
    const std::vector<Covered> pieces = Cut(AlphaMap(texels, 1, Levels), whole.Corners);
    for (const Covered& piece : pieces)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        const glm::dvec2 a = piece.At(i), edge = piece.At(i + 1) - a;
        const double length = glm::length(edge);
        for (const Covered& other : pieces)
        {
          const glm::dvec2 to = other.At(i) - a;
          const double along = glm::dot(to, edge) / length;
          const bool isWithin = along > 1e-6 && along < length - 1e-6;
          EXPECT_FALSE(isWithin && std::abs(Cross(to, edge)) <= 1e-12 * length)
            << "seed " << seed << ": (" << other.At(i).x << ", " << other.At(i).y
            << ") lies within " << a.x << ", " << a.y << " to " << piece.At(i + 1).x << ", "
            << piece.At(i + 1).y;
        }
        ++joints;
      }
    }
  }
  EXPECT_GT(joints, 50 * Seeds);
}

// Texels of one alpha go together, and a triangle in them is one piece.
TEST(AlphaMap, TakesTexelsTogether)
{
  AlphaTexels texels;
  texels.Size = { 64, 32 };
  texels.Alpha.assign(64 * 32, 0.5);
  RandomGeometry random(1);
  const Triangle triangle = RandomTriangle(random);
  EXPECT_EQ(Cut(AlphaMap(texels, 1, Levels), triangle).size(), 1u);
  // One texel in a corner, the rest of its row, and all other rows.
  texels.Alpha[0] = 1.0;
  texels.Wrap = TextureWrap::Edge;
  std::size_t pieces = 0;
  const Triangle corner{ { { { 0, 0 }, { 0, 0, 0 } }, { { 1, 0 }, { 1, 0, 0 } },
    { { 0, 1 }, { 0, 1, 0 } } } };
  AlphaMap(texels, 1, Levels)
    .VisitPieces(corner, [&pieces](const AlphaMap::Piece&) { return ++pieces > 0; });
  EXPECT_EQ(pieces, 3u);
}

// A triangle of which all corners lie on a line of the texture, or in a place, has the alphas
// there; on the line between two texels, the upper one's.
TEST(AlphaMap, ShowsLinesAndPlacesOfATexture)
{
  AlphaTexels texels;
  texels.Size = { 2, 2 };
  texels.Alpha = { 0.25, 0.5, 0.75, 1.0 };
  const AlphaMap map(texels, 1, Levels);
  const auto cut = [&map](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
  {
    double areas[5] = { 0, 0, 0, 0, 0 }; // by the alpha
    for (const Covered& piece :
      Cut(map, { { { a, { 0, 0, 0 } }, { b, { 1, 0, 0 } }, { c, { 0, 1, 0 } } } }))
    {
      areas[std::lround(4.0 * piece.Alpha)] +=
        std::abs(Cross(piece.At(1) - piece.At(0), piece.At(2) - piece.At(0)));
    }
    return std::vector<double>(areas + 1, areas + 5);
  };
  const auto expectNear = [](const std::vector<double>& found, const std::vector<double>& right)
  {
    for (std::size_t i = 0; i < right.size(); ++i)
    {
      EXPECT_NEAR(found[i], right[i], 1e-15) << "alpha " << 0.25 * static_cast<double>(i + 1);
    }
  };
  // u = x: up to a half is three quarters of the triangle.
  expectNear(cut({ 0, 0 }, { 1, 0 }, { 0, 0 }), { 0.75, 0.25, 0, 0 });
  expectNear(cut({ 0, 0.5 }, { 1, 0.5 }, { 0, 0.5 }), { 0, 0, 0.75, 0.25 });
  expectNear(cut({ 0, 1 }, { 1, 1 }, { 0, 1 }), { 0.75, 0.25, 0, 0 });
  expectNear(cut({ 0.7, -0.3 }, { 0.7, -0.3 }, { 0.7, -0.3 }), { 0, 0, 0, 1 });
}

// Coarser maps have the mean of as many texels as there are; many alphas are rounded to levels.
TEST(AlphaMap, TakesMeansAndRounds)
{
  AlphaTexels texels;
  texels.Size = { 3, 1 };
  texels.Alpha = { 0.0, 0.5, 0.75 };
  texels.Wrap = TextureWrap::Edge;
  const Triangle triangle{ { { { 0, 0 }, { 0, 0, 0 } }, { { 1, 0 }, { 1, 0, 0 } },
    { { 0, 1 }, { 0, 1, 0 } } } };
  std::vector<Covered> pieces = Cut(AlphaMap(texels, 2, Levels), triangle);
  ASSERT_GE(pieces.size(), 2u);
  for (const Covered& piece : pieces)
  {
    const double middle = (piece.At(0).x + piece.At(1).x + piece.At(2).x) / 3.0;
    EXPECT_EQ(piece.Alpha, middle < 2.0 / 3.0 ? 0.25 : 0.75);
  }
  texels.Alpha[0] = 0.3;
  pieces = Cut(AlphaMap(texels, 1, 2), triangle); // 1/2, 1/2 and, of 3/4, 1: halves round up
  for (const Covered& piece : pieces)
  {
    const double middle = (piece.At(0).x + piece.At(1).x + piece.At(2).x) / 3.0;
    EXPECT_EQ(piece.Alpha, middle < 2.0 / 3.0 ? 0.5 : 1.0);
  }
}

// A disc whose edge is smoothed over two texels is as sharp as one that is not, to a texel; a
// soft ramp, wider than an edge, stays soft.
TEST(AlphaMap, SharpensSmoothedEdges)
{
  constexpr int side = 64;
  AlphaTexels disc, ramp;
  disc.Size = ramp.Size = { side, side };
  for (int i = 0; i < side * side; ++i)
  {
    const double x = i % side + 0.5 - side / 2, y = i / side + 0.5 - side / 2;
    disc.Alpha.push_back(std::clamp((25.0 - std::hypot(x, y)) / 2.0 + 0.5, 0.0, 1.0));
    ramp.Alpha.push_back(std::clamp((25.0 - std::hypot(x, y)) / 20.0 + 0.5, 0.0, 1.0));
  }
  disc.Wrap = ramp.Wrap = TextureWrap::Edge;
  const double size = 1.0 / side;
  const Triangle triangle{ { { { 0, 0 }, { 0, 0, 0 } }, { { 2, 0 }, { 2, 0, 0 } },
    { { 0, 2 }, { 0, 2, 0 } } } };
  double area = 0.0;
  for (const Covered& piece : Cut(AlphaMap(disc, 1, Levels), triangle))
  {
    EXPECT_EQ(piece.Alpha, 1.0);
    const glm::dvec2 middle = (piece.At(0) + piece.At(1) + piece.At(2)) / 3.0;
    EXPECT_LE(glm::length(middle - 0.5), 26.0 * size);
    area += 0.5 * std::abs(Cross(piece.At(1) - piece.At(0), piece.At(2) - piece.At(0)));
  }
  EXPECT_NEAR(
    area, std::acos(-1.0) * 25 * 25 * size * size, 2 * std::acos(-1.0) * 25 * size * size);
  int translucent = 0;
  for (const Covered& piece : Cut(AlphaMap(ramp, 1, Levels), triangle))
  {
    translucent += piece.Alpha < 1.0;
  }
  EXPECT_GT(translucent, 100);
}

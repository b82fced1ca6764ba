// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampledVisibility.h
 * @brief Which of a light's samples a texel sees, by exact ray tests.
 *
 * The second test oracle: a ray from each texel's centre to each sample, in long double, against
 * every triangle. It says what a bake with these very samples must say, so that errors of numbers
 * show without the noise of sampling. It shares no code with the product.
 *
 * No rasteriser decides rays that pass through an edge as exact numbers do. Rays that pass an edge
 * by less than RayTolerance says are left open: the answer is an interval.
 */

#ifndef SampledVisibility_h
#define SampledVisibility_h

#include "ExactRadiance.h"

#include <functional>
#include <vector>

namespace oracle
{

/** The texels of a parallelogram, lit from where EdgeX x EdgeY points, or from the other side. */
struct TexelGrid
{
  Vec3 Corner, EdgeX, EdgeY;
  int CountX, CountY;
  bool IsBack = false;

  /** Towards the lit side. */
  Vec3 GetNormal() const { return (this->IsBack ? -1.0L : 1.0L) * Cross(this->EdgeX, this->EdgeY); }
  /** The centre of texel (i, j). */
  Vec3 GetCentre(int i, int j) const;
};

/** How far a ray must pass an edge's image on the receiver to be decided. */
struct RayTolerance
{
  /** In texels, wherever the edge is: what a rasteriser snaps vertices to. */
  long double Texels;
  /** The relative rounding of the numbers that go into a projection. */
  long double Rounding;
  /** Coordinates, in units of the receiver's edges, are rounded as numbers of this size. */
  long double ReachX, ReachY;
};

/** The share of the samples' weight that is seen: between these, by open rays. */
struct SeenShare
{
  long double Low, High;
};

class SampledVisibility
{
public:
  /** The samples are points, or directions to points at infinity. */
  SampledVisibility(const TexelGrid& texels, const std::vector<Triangle>& occluders,
    const std::vector<Vec3>& samples, bool areDirections, const RayTolerance& tolerance);

  /** The weight of a sample is a function of its index and of the vector from the texel's centre.
   */
  SeenShare GetShare(
    int i, int j, const std::function<long double(std::size_t, const Vec3&)>& weight) const;

private:
  /** A corner of a triangle's image: in texels, and how far edges that end there may be off. */
  struct Corner
  {
    long double X, Y, SlackX, SlackY;
  };
  /** What of a triangle lies between the receiver and a sample, projected on the receiver. */
  struct Image
  {
    std::size_t Triangle;
    std::vector<Corner> Corners;
    long double LowX, HighX, LowY, HighY; ///< a box around it, slack included
  };

  void AddImage(std::size_t triangle, const Vec3& sample, std::vector<Image>& images) const;
  Vec3 ToFrame(const Vec3& direction) const;
  bool IsBlocked(const Vec3& x, const Vec3& sample, const Triangle& triangle) const;

  TexelGrid Texels;
  std::vector<Triangle> Occluders;
  std::vector<Vec3> Samples;
  bool AreDirections;
  RayTolerance Tolerance;
  std::vector<std::vector<Image>> Images; ///< of each sample
};

} // namespace oracle

#endif

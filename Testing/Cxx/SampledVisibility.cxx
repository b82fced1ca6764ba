// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampledVisibility.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace oracle
{
namespace
{

/// Nearer to the sample than this share of its height, an image is further away than any texel.
constexpr long double NearestToSample = 1e-12L;

using Points = std::vector<Vec3>;

/// The part of a convex polygon where depth(), which is affine, is not negative.
template <typename Depth>
Points ClipBy(const Points& polygon, const Depth& depth)
{
  Points inside;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const long double atP = depth(p), atQ = depth(q);
    if (atP >= 0)
    {
      inside.push_back(p);
    }
    if ((atP > 0 && atQ < 0) || (atP < 0 && atQ > 0))
    {
      inside.push_back(p + (atP / (atP - atQ)) * (q - p));
    }
  }
  return inside;
}

} // namespace

Vec3 TexelGrid::GetCentre(int i, int j) const
{
  return this->Corner + ((i + 0.5L) / this->CountX) * this->EdgeX +
    ((j + 0.5L) / this->CountY) * this->EdgeY;
}

SampledVisibility::SampledVisibility(const TexelGrid& texels,
  const std::vector<Triangle>& occluders, const std::vector<Vec3>& samples, bool areDirections,
  const RayTolerance& tolerance)
  : Texels(texels)
  , Occluders(occluders)
  , Samples(samples)
  , AreDirections(areDirections)
  , Tolerance(tolerance)
  , Images(samples.size())
{
  for (std::size_t s = 0; s < samples.size(); ++s)
  {
    const Vec3 sample = this->ToFrame(areDirections ? samples[s] : samples[s] - texels.Corner);
    for (std::size_t t = 0; t < occluders.size(); ++t)
    {
      this->AddImage(t, sample, this->Images[s]);
    }
  }
}

Vec3 SampledVisibility::ToFrame(const Vec3& d) const
{
  const Vec3 n = Cross(this->Texels.EdgeX, this->Texels.EdgeY);
  const long double square = Dot(n, n);
  return { Dot(Cross(d, this->Texels.EdgeY), n) / square,
    Dot(Cross(this->Texels.EdgeX, d), n) / square,
    Dot(d, this->Texels.GetNormal()) / std::pow(square, 0.75L) };
}

void SampledVisibility::AddImage(
  std::size_t triangle, const Vec3& sample, std::vector<Image>& images) const
{
  const Triangle& t = this->Occluders[triangle];
  const Vec3 corner = this->Texels.Corner;
  const long double kz = this->AreDirections ? 0 : 1 / sample.Z;
  Points polygon = { this->ToFrame(t.A - corner), this->ToFrame(t.B - corner),
    this->ToFrame(t.C - corner) };
  polygon = ClipBy(polygon, [](const Vec3& p) { return p.Z; });
  polygon = ClipBy(polygon, [&](const Vec3& p) { return 1 - kz * p.Z - NearestToSample; });
  if (polygon.empty())
  {
    return;
  }
  Image image{ triangle, {}, INFINITY, -INFINITY, INFINITY, -INFINITY };
  for (const Vec3& p : polygon)
  {
    const long double w = 1 - kz * p.Z;
    const std::array<long double, 2> at = { p.X, p.Y };
    const std::array<long double, 2> shift = { sample.X / sample.Z * p.Z,
      sample.Y / sample.Z * p.Z };
    const std::array<int, 2> counts = { this->Texels.CountX, this->Texels.CountY };
    std::array<long double, 2> place, slack;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      // u and k h are rounded; k h has three roundings (of k, of h, of the product), and so has w'.
      // What w' is off by counts as far as the image is from the origin: where texels are, that is
      // at most 1. What is beyond reach is clipped before it is rounded.
      const long double reach = axis == 0 ? this->Tolerance.ReachX : this->Tolerance.ReachY;
      const long double numerator = at[axis] - shift[axis];
      const long double error = this->Tolerance.Rounding *
        (reach + 3 * std::min(std::abs(shift[axis]), reach) + std::min(std::abs(numerator), reach) +
          3 * kz * p.Z);
      place[axis] = numerator / w * counts[axis];
      slack[axis] = error / w * counts[axis] + this->Tolerance.Texels;
    }
    image.Corners.push_back({ place[0], place[1], slack[0], slack[1] });
    image.LowX = std::min(image.LowX, place[0] - slack[0]);
    image.HighX = std::max(image.HighX, place[0] + slack[0]);
    image.LowY = std::min(image.LowY, place[1] - slack[1]);
    image.HighY = std::max(image.HighY, place[1] + slack[1]);
  }
  if (image.HighX >= 0 && image.LowX <= this->Texels.CountX && image.HighY >= 0 &&
    image.LowY <= this->Texels.CountY)
  {
    images.push_back(image);
  }
}

// Moeller and Trumbore 1997.
bool SampledVisibility::IsBlocked(const Vec3& x, const Vec3& sample, const Triangle& triangle) const
{
  const Vec3 edge1 = triangle.B - triangle.A;
  const Vec3 edge2 = triangle.C - triangle.A;
  const Vec3 direction = this->AreDirections ? sample : sample - x;
  const Vec3 p = Cross(direction, edge2);
  const long double det = Dot(edge1, p);
  const Vec3 s = x - triangle.A;
  const Vec3 q = Cross(s, edge1);
  const long double u = Dot(s, p) / det;
  const long double v = Dot(direction, q) / det;
  const long double t = Dot(edge2, q) / det;
  return det != 0 && u >= 0 && v >= 0 && u + v <= 1 && t > 0 && (this->AreDirections || t < 1);
}

SeenShare SampledVisibility::GetShare(
  int i, int j, const std::function<long double(std::size_t, const Vec3&)>& weight) const
{
  const Vec3 centre = this->Texels.GetCentre(i, j);
  const long double x = i + 0.5L, y = j + 0.5L;
  const auto isNearEdge = [&](const Image& image)
  {
    for (std::size_t e = 0; e < image.Corners.size(); ++e)
    {
      const Corner &a = image.Corners[e], &b = image.Corners[(e + 1) % image.Corners.size()];
      const long double dx = b.X - a.X, dy = b.Y - a.Y, square = dx * dx + dy * dy;
      const long double along =
        square > 0 ? std::clamp(((x - a.X) * dx + (y - a.Y) * dy) / square, 0.0L, 1.0L) : 0.0L;
      // 1 / w' is affine on the receiver, and so is the slack that it brings. Across the edge,
      // slack along it does not count.
      const long double slackX = a.SlackX + along * (b.SlackX - a.SlackX);
      const long double slackY = a.SlackY + along * (b.SlackY - a.SlackY);
      const long double awayX = std::abs(a.X + along * dx - x);
      const long double awayY = std::abs(a.Y + along * dy - y);
      const bool isBeside = along > 0 && along < 1;
      if (isBeside ? std::hypot(awayX, awayY) * std::sqrt(square) <=
            std::abs(dy) * slackX + std::abs(dx) * slackY
                   : awayX <= slackX && awayY <= slackY)
      {
        return true;
      }
    }
    return false;
  };
  long double all = 0, seen = 0, open = 0;
  for (std::size_t s = 0; s < this->Samples.size(); ++s)
  {
    const Vec3& sample = this->Samples[s];
    const long double w = weight(s, this->AreDirections ? sample : sample - centre);
    bool isBlocked = false, isOpen = false;
    for (const Image& image : this->Images[s])
    {
      if (x < image.LowX || x > image.HighX || y < image.LowY || y > image.HighY)
      {
        continue;
      }
      if (isNearEdge(image))
      {
        isOpen = true;
      }
      else if (this->IsBlocked(centre, sample, this->Occluders[image.Triangle]))
      {
        isBlocked = true;
        break;
      }
    }
    all += w;
    seen += isBlocked || isOpen ? 0 : w;
    open += !isBlocked && isOpen ? w : 0;
  }
  if (!(all > 0))
  {
    return { 0, 1 };
  }
  return { seen / all, (seen + open) / all };
}

} // namespace oracle

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ClusterTree.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>

namespace penumbra
{
namespace
{

/// Boxes that a thread makes at a time: some 0.1 ms, against which starting it is little.
constexpr vtkIdType BoxesAtATime = 16384;

double MaxNorm(const glm::dvec3& v)
{
  return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

/// glm::min() would lose some NaNs, so that each point is looked at.
bool IsFinite(const glm::dvec3& p)
{
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::vector<Box> MakeBoxes(
  const std::vector<glm::dvec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles)
{
  std::vector<Box> boxes(triangles.size());
  vtkSMPTools::For(0, static_cast<vtkIdType>(triangles.size()), BoxesAtATime,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        const auto& [a, b, c] = triangles[i];
        if (IsFinite(points[a]) && IsFinite(points[b]) && IsFinite(points[c]))
        {
          boxes[i].Add(points[a]);
          boxes[i].Add(points[b]);
          boxes[i].Add(points[c]);
        }
      }
    });
  return boxes;
}

} // namespace

bool Box::IsValid() const
{
  return IsFinite(this->Low) && IsFinite(this->High) &&
    glm::all(glm::lessThanEqual(this->Low, this->High));
}

/// Splits items at the median of their centres along the longest side of the centres' box.
class ClusterTree::Builder
{
public:
  Builder(ClusterTree& tree, const std::vector<Box>& boxes, std::size_t largestCluster)
    : Tree(tree)
    , Boxes(boxes)
    , LargestCluster(std::max<std::size_t>(largestCluster, 1))
  {
    Box all;
    for (const Box& box : boxes)
    {
      all.Add(box.IsValid() ? box : Box());
    }
    // Halves, since the sum of large numbers is not finite.
    const glm::dvec3 origin = 0.5 * all.Low + 0.5 * all.High;
    const double halfSize = MaxNorm(0.5 * all.High - 0.5 * all.Low);
    const double unit = halfSize > 0.0 ? halfSize : 1.0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      if (boxes[i].IsValid())
      {
        const glm::dvec3 centre = 0.5 * boxes[i].Low + 0.5 * boxes[i].High;
        this->Entries.push_back(
          { glm::vec3((centre - origin) / unit), static_cast<std::uint32_t>(i) });
      }
    }
  }

  void Build()
  {
    if (this->Entries.empty())
    {
      return;
    }
    this->AddNode(0, this->Entries.size());
    for (const Entry& entry : this->Entries)
    {
      this->Tree.Order.push_back(entry.Item);
    }
  }

private:
  /// Sorting moves these instead of the boxes. The centre is relative to all boxes, from -1 to 1,
  /// where floats do: they decide how good the tree is, not whether it is right.
  struct Entry
  {
    glm::vec3 Centre;
    std::uint32_t Item;
  };

  Box AddNode(std::size_t first, std::size_t last)
  {
    const std::size_t index = this->Tree.Nodes.size();
    this->Tree.Nodes.emplace_back();
    Box bounds;
    if (last - first <= this->LargestCluster)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        bounds.Add(this->Boxes[this->Entries[i].Item]);
      }
    }
    else
    {
      const std::size_t middle = this->Split(first, last);
      bounds = this->AddNode(first, middle);
      bounds.Add(this->AddNode(middle, last));
    }
    this->Tree.Nodes[index] = { bounds, static_cast<std::uint32_t>(first),
      static_cast<std::uint32_t>(last), static_cast<std::uint32_t>(this->Tree.Nodes.size()) };
    return bounds;
  }

  std::size_t Split(std::size_t first, std::size_t last)
  {
    glm::vec3 low = this->Entries[first].Centre, high = low;
    for (std::size_t i = first; i < last; ++i)
    {
      low = glm::min(low, this->Entries[i].Centre);
      high = glm::max(high, this->Entries[i].Centre);
    }
    const glm::vec3 size = high - low;
    const int longer = size.x >= size.y ? 0 : 1;
    const int axis = size[longer] >= size.z ? longer : 2;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i)
    { return this->Entries.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last),
      [axis](const Entry& a, const Entry& b) { return a.Centre[axis] < b.Centre[axis]; });
    return middle;
  }

  ClusterTree& Tree;
  const std::vector<Box>& Boxes;
  std::size_t LargestCluster;
  std::vector<Entry> Entries;
};

ClusterTree::ClusterTree(
  const std::vector<glm::dvec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles)
  : ClusterTree(MakeBoxes(points, triangles))
{
}

ClusterTree::ClusterTree(const std::vector<Box>& boxes, std::size_t largestCluster)
{
  Builder(*this, boxes, largestCluster).Build();
}

// Let u = 2^-53, |n| the sum of the sizes of a normal's coefficients and |p| the largest
// coordinate. dot(n, p) + d rounds each term at most four times: 4 u (|n| |p| + |d|). Coefficients
// that are off by 12 u |n| in all, as those of BlockingRegion::GetWorldPlanes(), add 12 u |n| |p|,
// and a depth that another class computes of transformed points, as BlockingRegion::MayHold(), is
// off by up to 17 u |n| |p|. In all that is 33 u; 64 u = 32 epsilon leave a margin for the slack's
// own rounding.
ClusterTree::Place ClusterTree::Locate(const Box& box, const ConvexRegion& region)
{
  constexpr double Roundings = 32.0;
  constexpr double Unit = Roundings * std::numeric_limits<double>::epsilon();
  const double size = std::max(MaxNorm(box.Low), MaxNorm(box.High));
  Place place = Place::Inside;
  for (const glm::dvec4& plane : region)
  {
    const glm::dvec3 normal(plane);
    const glm::bvec3 isAscending = glm::greaterThanEqual(normal, glm::dvec3(0.0));
    const double reach = glm::dot(glm::abs(normal), glm::dvec3(size));
    const double slack = Unit * (reach + std::abs(plane.w));
    if (glm::dot(normal, glm::mix(box.Low, box.High, isAscending)) + plane.w < -slack)
    {
      return Place::Outside;
    }
    if (!(glm::dot(normal, glm::mix(box.High, box.Low, isAscending)) + plane.w >= 0.0))
    {
      place = Place::Crossing;
    }
  }
  return place;
}

} // namespace penumbra

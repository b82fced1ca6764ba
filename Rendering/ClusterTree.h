// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where things are, so that those that are elsewhere cost nothing.
 */
#ifndef ClusterTree_h
#define ClusterTree_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace penumbra
{

/// An axis-aligned box in world coordinates; it starts empty.
struct PENUMBRARENDERING_EXPORT Box
{
  glm::dvec3 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec3 High{ -std::numeric_limits<double>::infinity() };

  void Add(const glm::dvec3& point)
  {
    this->Low = glm::min(this->Low, point);
    this->High = glm::max(this->High, point);
  }
  void Add(const Box& box)
  {
    this->Low = glm::min(this->Low, box.Low);
    this->High = glm::max(this->High, box.High);
  }
  /// Whether it holds a point and all of its coordinates are finite.
  bool IsValid() const;
};

/**
 * A convex region of the world, given by planes: p is inside where dot(plane, (p, 1)) >= 0 for all
 * of them. A normal's coefficients may be off by their rounding, 12 * 2^-53 of the sum of their
 * sizes: queries allow for it.
 */
using ConvexRegion = std::vector<glm::dvec4>;

/**
 * A tree of boxes over items in clusters: the triangles of a surface, or the surfaces of a scene,
 * each by its box. It knows the items by their indices alone, and keeps no coordinates of theirs.
 *
 * For the surfaces of a scene, the boxes of their own trees make the tree above:
 *
 *     const ClusterTree scene(boxesOfSurfaces, 1);
 *     scene.Visit(region, [&](const ClusterTree::Items& surfaces) {
 *       for (const std::uint32_t s : surfaces)
 *       {
 *         trees[s].Visit(region, [&](const ClusterTree::Items& triangles) { ... });
 *       }
 *     });
 *
 * A surface that moves rebuilds its own tree and the one of the scene.
 */
class PENUMBRARENDERING_EXPORT ClusterTree
{
public:
  /**
   * Triangles in a cluster, at most. Smaller ones follow a region's border more closely, but need
   * more nodes: two of 64 bytes for a cluster, which has 32 triangles or more in a large mesh, are
   * 4 bytes a triangle, a third of its indices.
   */
  static constexpr std::size_t LargestCluster = 64;

  /// Indices of items, for a range-based for.
  class Items
  {
  public:
    Items(const std::uint32_t* first, const std::uint32_t* last)
      : First(first)
      , Last(last)
    {
    }
    const std::uint32_t* begin() const { return this->First; }
    const std::uint32_t* end() const { return this->Last; }
    std::size_t size() const { return static_cast<std::size_t>(this->Last - this->First); }

  private:
    const std::uint32_t* First;
    const std::uint32_t* Last;
  };

  /// Of nothing.
  ClusterTree() = default;

  /// Of triangles, which index the points. Those with a coordinate that is not finite are left out.
  ClusterTree(const std::vector<glm::dvec3>& points,
    const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// Of items with these boxes, in clusters of at most so many. Invalid boxes are left out.
  explicit ClusterTree(const std::vector<Box>& boxes, std::size_t largestCluster = LargestCluster);

  /// The box of all items; invalid if there are none.
  Box GetBounds() const { return this->Nodes.empty() ? Box() : this->Nodes.front().Bounds; }

  /**
   * Calls visit(Items) with every cluster whose box may have a point in the region, and perhaps
   * with some more. Clusters whose boxes are inside together come together. No item comes twice.
   */
  template <typename Visitor>
  void Visit(const ConvexRegion& region, Visitor&& visit) const
  {
    for (std::uint32_t i = 0; i < this->Nodes.size();)
    {
      const Node& node = this->Nodes[i];
      const Place place = Locate(node.Bounds, region);
      const bool isLeaf = node.Next == i + 1;
      if (place == Place::Inside || (place == Place::Crossing && isLeaf))
      {
        const std::uint32_t* items = this->Order.data();
        visit(Items(items + node.First, items + node.Last));
      }
      i = place == Place::Crossing ? i + 1 : node.Next;
    }
  }

private:
  /// Nodes come in depth-first order: a node's first child follows it.
  struct Node
  {
    Box Bounds;
    std::uint32_t First = 0, Last = 0; ///< its part of Order
    std::uint32_t Next = 0;            ///< the node after all that are below this one
  };

  enum class Place
  {
    Outside,
    Crossing,
    Inside
  };
  static Place Locate(const Box& box, const ConvexRegion& region);

  class Builder;

  std::vector<Node> Nodes;
  std::vector<std::uint32_t> Order; ///< items, those of a cluster side by side
};

} // namespace penumbra

#endif

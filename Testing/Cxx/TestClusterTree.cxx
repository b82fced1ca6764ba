// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The tree over clusters of triangles: what a query finds, against a look at every box in long
// double.

#include "ClusterTree.h"
#include "RandomGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using penumbra::Box;
using penumbra::ClusterTree;
using penumbra::ConvexRegion;
using Triangle = std::array<std::uint32_t, 3>;
using Long3 = glm::vec<3, long double>;

constexpr int Rounds = 300;
const ConvexRegion Everywhere;

struct Mesh
{
  std::vector<glm::dvec3> Points;
  std::vector<Triangle> Triangles;

  void Add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
  {
    const auto first = static_cast<std::uint32_t>(this->Points.size());
    for (const glm::dvec3& p : { a, b, c })
    {
      this->Points.push_back(p);
    }
    this->Triangles.push_back({ first, first + 1, first + 2 });
  }
  void AddPoint(const glm::dvec3& p) { this->Add(p, p, p); }

  ClusterTree MakeTree() const { return { this->Points, this->Triangles }; }

  std::vector<Box> MakeBoxes() const
  {
    std::vector<Box> boxes(this->Triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      for (const std::uint32_t corner : this->Triangles[i])
      {
        boxes[i].Add(this->Points[corner]);
      }
    }
    return boxes;
  }
};

// Triangles in a cube around the origin, some in swarms, of sizes from 1e-6 to 1 of its own.
Mesh RandomMesh(RandomGeometry& random, std::size_t count)
{
  Mesh mesh;
  glm::dvec3 swarm(0.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    swarm = random.Below(50) == 0 ? random.InBox(1.0) : swarm;
    const glm::dvec3 centre = random.Below(2) == 0 ? random.InBox(1.0) : swarm + random.InBox(0.05);
    const double size = std::pow(10.0, random.Between(-6.0, 0.0));
    mesh.Add(centre + random.InBox(size), centre + random.InBox(size), centre + random.InBox(size));
  }
  return mesh;
}

// Some planes that all have the same point inside, by up to `depth`.
ConvexRegion RandomRegion(RandomGeometry& random, double depth)
{
  ConvexRegion region;
  const glm::dvec3 centre = random.InBox(1.0);
  const std::size_t planes = 1 + random.Below(8);
  for (std::size_t i = 0; i < planes; ++i)
  {
    const glm::dvec3 normal = std::pow(10.0, random.Between(-3.0, 3.0)) * random.Direction();
    const double distance = random.Between(0.0, depth) * glm::length(normal);
    region.push_back({ normal, distance - glm::dot(normal, centre) });
  }
  return region;
}

// The largest depth that a point of the box has below a plane.
long double GetDepth(const Box& box, const glm::dvec4& plane)
{
  long double depth = plane.w;
  for (int i = 0; i < 3; ++i)
  {
    const long double a = plane[i];
    depth += std::max(a * box.Low[i], a * box.High[i]);
  }
  return depth;
}

bool Touches(const Box& box, const ConvexRegion& region)
{
  return std::all_of(region.begin(), region.end(),
    [&](const glm::dvec4& plane) { return GetDepth(box, plane) >= 0.0L; });
}

// How often each item is found.
std::vector<int> Count(const ClusterTree& tree, const ConvexRegion& region, std::size_t items)
{
  std::vector<int> counts(items, 0);
  tree.Visit(region,
    [&](const ClusterTree::Items& found)
    {
      for (const std::uint32_t i : found)
      {
        ++counts.at(i);
      }
    });
  return counts;
}

std::size_t CountAll(const ClusterTree& tree, const ConvexRegion& region)
{
  std::size_t count = 0;
  tree.Visit(region, [&](const ClusterTree::Items& found) { count += found.size(); });
  return count;
}

bool Finds(const glm::dvec3& point, const ConvexRegion& region)
{
  Mesh mesh;
  mesh.AddPoint(point);
  return CountAll(mesh.MakeTree(), region) == 1;
}

// The shape of space between two planes at a point, thinner than anything there.
ConvexRegion Slab(const glm::dvec3& point, const glm::dvec3& normal)
{
  const double distance = glm::dot(normal, point);
  return { { normal, -distance }, { -normal, distance } };
}

// A triangle with a point in the region has a box with a point in it, which is inside that of its
// cluster: so none of those that touch may be missing.
TEST(ClusterTree, MissesNoTriangle)
{
  std::size_t touching = 0, found = 0, all = 0;
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const Mesh mesh = RandomMesh(random, 1 + random.Below(3000));
    const std::vector<Box> boxes = mesh.MakeBoxes();
    const ConvexRegion region = RandomRegion(random, 0.3);
    const std::vector<int> counts = Count(mesh.MakeTree(), region, boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      EXPECT_LE(counts[i], 1) << seed;
      EXPECT_TRUE(counts[i] == 1 || !Touches(boxes[i], region)) << seed << " " << i;
      touching += Touches(boxes[i], region) ? 1 : 0;
      found += static_cast<std::size_t>(counts[i]);
    }
    all += boxes.size();
  }
  // Neither nothing nor all.
  EXPECT_GT(touching, all / 20);
  EXPECT_LT(found, all - all / 20);
}

// With one item to a cluster, the cluster's box is its own.
TEST(ClusterTree, IsExactForSingleBoxes)
{
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const std::vector<Box> boxes = RandomMesh(random, 1 + random.Below(1000)).MakeBoxes();
    const ConvexRegion region = RandomRegion(random, 0.3);
    const std::vector<int> counts = Count(ClusterTree(boxes, 1), region, boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      EXPECT_EQ(counts[i], Touches(boxes[i], region) ? 1 : 0) << seed << " " << i;
    }
  }
}

TEST(ClusterTree, HoldsEachTriangleOnce)
{
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const Mesh mesh = RandomMesh(random, 1 + random.Below(3000));
    const std::size_t size = mesh.Triangles.size();
    const ClusterTree tree = mesh.MakeTree();
    EXPECT_EQ(Count(tree, Everywhere, size), std::vector<int>(size, 1)) << seed;
    Box all;
    for (const Box& box : mesh.MakeBoxes())
    {
      all.Add(box);
    }
    EXPECT_EQ(tree.GetBounds().Low, all.Low);
    EXPECT_EQ(tree.GetBounds().High, all.High);
  }
}

// A slab that is thinner than all boxes has none inside, so that clusters come one by one.
TEST(ClusterTree, KeepsClustersSmall)
{
  RandomGeometry random(1);
  const Mesh mesh = RandomMesh(random, 5000);
  const ClusterTree tree = mesh.MakeTree();
  for (std::uint32_t i = 0; i < mesh.Triangles.size(); ++i)
  {
    bool isFound = false;
    tree.Visit(Slab(mesh.Points[mesh.Triangles[i][0]], random.Direction()),
      [&](const ClusterTree::Items& items)
      {
        EXPECT_LE(items.size(), ClusterTree::LargestCluster);
        isFound = isFound || std::find(items.begin(), items.end(), i) != items.end();
      });
    EXPECT_TRUE(isFound) << i;
  }
}

// On a plain of 256 x 256 specks, medians make clusters of 8 x 8 or of 8 x 4: tiles whose sides are
// longer than a region that reaches from one speck to the next, so that it touches four at most.
TEST(ClusterTree, FindsLittleMoreThanThereIs)
{
  Mesh mesh;
  for (int i = 0; i < 256 * 256; ++i)
  {
    mesh.AddPoint({ i % 256, i / 256, 0.0 });
  }
  const ClusterTree tree = mesh.MakeTree();
  RandomGeometry random(1);
  for (int round = 0; round < Rounds; ++round)
  {
    const double x = random.Between(0.0, 254.0), y = random.Between(0.0, 254.0);
    const ConvexRegion region{ { 1.0, 0.0, 0.0, -x }, { -1.0, 0.0, 0.0, x + 1.0 },
      { 0.0, 1.0, 0.0, -y }, { 0.0, -1.0, 0.0, y + 1.0 } };
    const std::size_t found = CountAll(tree, region);
    EXPECT_GE(found, 1u);
    EXPECT_LE(found, 4 * ClusterTree::LargestCluster);
  }
}

TEST(ClusterTree, MayBeOfNothing)
{
  const std::vector<Box> noBoxes;
  for (const ClusterTree& tree :
    { ClusterTree(), Mesh().MakeTree(), ClusterTree(noBoxes), ClusterTree({ Box(), Box() }, 1) })
  {
    EXPECT_FALSE(tree.GetBounds().IsValid());
    EXPECT_EQ(CountAll(tree, Everywhere), 0u);
    EXPECT_EQ(CountAll(tree, { { 0.0, 0.0, 1.0, 0.0 } }), 0u);
  }
}

TEST(ClusterTree, LeavesOutWhatIsNotFinite)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  RandomGeometry random(1);
  Mesh mesh = RandomMesh(random, 1000);
  std::vector<int> expected(mesh.Triangles.size(), 1);
  for (const double bad : { nan, infinity, -infinity })
  {
    for (int i = 0; i < 9; ++i)
    {
      const std::size_t t = random.Below(mesh.Triangles.size());
      mesh.Points[mesh.Triangles[t][static_cast<std::size_t>(i / 3)]][i % 3] = bad;
      expected[t] = 0;
    }
  }
  const ClusterTree tree = mesh.MakeTree();
  EXPECT_TRUE(tree.GetBounds().IsValid());
  EXPECT_LE(glm::length(tree.GetBounds().High), 10.0);
  EXPECT_EQ(Count(tree, Everywhere, expected.size()), expected);

  Mesh worse;
  worse.AddPoint({ 0.0, nan, 0.0 });
  EXPECT_EQ(CountAll(worse.MakeTree(), Everywhere), 0u);
}

TEST(ClusterTree, TakesPointsThatAreTheSame)
{
  Mesh mesh;
  const glm::dvec3 p(0.1, -0.7, 0.3);
  for (int i = 0; i < 1000; ++i)
  {
    mesh.AddPoint(p);
  }
  const ClusterTree tree = mesh.MakeTree();
  EXPECT_EQ(CountAll(tree, { { 1.0, 0.0, 0.0, 0.0 } }), 1000u);
  EXPECT_EQ(CountAll(tree, { { -1.0, 0.0, 0.0, 0.0 } }), 0u);
  EXPECT_EQ(CountAll(tree, Slab(p, { 0.6, 0.0, 0.8 })), 1000u);
}

// Powers of two scale without a rounding, so that nothing changes at all: a millionth, a million
// times, and sizes whose squares are not finite.
TEST(ClusterTree, IsTheSameAtAllSizes)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    RandomGeometry random(seed);
    const Mesh mesh = RandomMesh(random, 2000);
    const ConvexRegion region = RandomRegion(random, 0.3);
    const std::vector<int> expected = Count(mesh.MakeTree(), region, mesh.Triangles.size());
    for (const double scale : { 0x1p-600, 0x1p-20, 0x1p20, 0x1p600 })
    {
      Mesh scaledMesh = mesh;
      for (glm::dvec3& p : scaledMesh.Points)
      {
        p *= scale;
      }
      ConvexRegion scaledRegion = region;
      for (glm::dvec4& plane : scaledRegion)
      {
        plane.w *= scale;
      }
      EXPECT_EQ(Count(scaledMesh.MakeTree(), scaledRegion, expected.size()), expected)
        << seed << " " << scale;
    }
  }
}

TEST(ClusterTree, TakesTheLargestNumbers)
{
  constexpr double largest = std::numeric_limits<double>::max();
  Mesh mesh;
  for (int i = 0; i < 200; ++i)
  {
    mesh.AddPoint(glm::dvec3(i % 2 == 0 ? largest : -largest));
  }
  const ClusterTree tree = mesh.MakeTree();
  EXPECT_EQ(CountAll(tree, Everywhere), 200u);
  // Depths that are not finite are no reason to leave anything out.
  EXPECT_EQ(CountAll(tree, { { 2.0, 2.0, -2.0, largest } }), 200u);
}

// One over their size is not finite. Halves of halves of 200 are clusters of 50.
TEST(ClusterTree, TakesTheSmallestNumbers)
{
  Mesh mesh;
  for (int i = 0; i < 200; ++i)
  {
    mesh.AddPoint(glm::dvec3(i * std::numeric_limits<double>::denorm_min()));
  }
  const ClusterTree tree = mesh.MakeTree();
  EXPECT_EQ(Count(tree, Everywhere, 200), std::vector<int>(200, 1));
  EXPECT_EQ(CountAll(tree, Slab(mesh.Points.back(), { 1.0, 0.0, 0.0 })), 50u);
}

// A plane through a point has it inside, whatever rounding says: planes are rounded to doubles, and
// their coefficients are off by as much as a region's may be.
TEST(ClusterTree, FindsWhatTouchesWithinRounding)
{
  constexpr double Unit = 0x1p-53;
  for (unsigned seed = 0; seed < 100 * Rounds; ++seed)
  {
    RandomGeometry random(seed);
    const glm::dvec3 p = std::pow(10.0, random.Between(-7.0, 7.0)) * random.InBox(1.0);
    const glm::dvec3 normal = std::pow(10.0, random.Between(-7.0, 7.0)) * random.Direction();
    const long double distance = glm::dot(Long3(normal), Long3(p));
    const glm::dvec3 sizes = glm::abs(normal);
    const glm::dvec3 off = random.InBox(1.0) * (12.0 / 3.0) * Unit * (sizes.x + sizes.y + sizes.z);
    EXPECT_TRUE(Finds(p, { glm::dvec4(normal + off, static_cast<double>(-distance)) })) << seed;
  }
}

// As the header shows it: the boxes of surfaces' trees make the tree of the scene.
TEST(ClusterTree, MissesNoSurface)
{
  for (unsigned seed = 0; seed < Rounds; ++seed)
  {
    RandomGeometry random(seed);
    std::vector<Mesh> surfaces;
    std::vector<ClusterTree> trees;
    std::vector<Box> bounds;
    for (int i = 0; i < 200; ++i)
    {
      surfaces.push_back(RandomMesh(random, random.Below(20)));
      const glm::dvec3 place = random.InBox(1.0);
      for (glm::dvec3& p : surfaces.back().Points)
      {
        p = place + 0.1 * p;
      }
      trees.push_back(surfaces.back().MakeTree());
      bounds.push_back(trees.back().GetBounds());
    }
    const ConvexRegion region = RandomRegion(random, 0.3);
    std::vector<std::vector<int>> counts;
    for (const Mesh& surface : surfaces)
    {
      counts.emplace_back(surface.Triangles.size(), 0);
    }
    ClusterTree(bounds, 1).Visit(region,
      [&](const ClusterTree::Items& found)
      {
        for (const std::uint32_t s : found)
        {
          counts[s] = Count(trees[s], region, counts[s].size());
        }
      });
    for (std::size_t s = 0; s < surfaces.size(); ++s)
    {
      EXPECT_EQ(counts[s], Count(trees[s], region, counts[s].size())) << seed << " " << s;
    }
  }
}

} // namespace

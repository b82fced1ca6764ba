// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomGeometry.h"
#include "ReceiverGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

namespace
{

using penumbra::ReceiverGrid;
using Polygons = std::vector<ReceiverGrid::Polygon>;

ReceiverGrid::Polygon MakeParallelogram(
  const glm::dvec3& corner, const glm::dvec3& edgeX, const glm::dvec3& edgeY)
{
  return { corner, corner + edgeX, corner + edgeX + edgeY, corner + edgeY };
}

/// The six faces of a box.
void AddBox(const glm::dvec3& low, const glm::dvec3& size, Polygons& polygons)
{
  const glm::dvec3 x(size.x, 0.0, 0.0), y(0.0, size.y, 0.0), z(0.0, 0.0, size.z);
  for (const double side : { 0.0, 1.0 })
  {
    polygons.push_back(MakeParallelogram(low + side * z, x, y));
    polygons.push_back(MakeParallelogram(low + side * y, x, z));
    polygons.push_back(MakeParallelogram(low + side * x, y, z));
  }
}

/// Boxes of many sizes in rows, as a city has them.
Polygons MakeCity(std::size_t boxes)
{
  RandomGeometry random(7);
  Polygons polygons;
  const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(boxes))));
  for (std::size_t i = 0; i < boxes; ++i)
  {
    const glm::dvec3 low(
      20.0 * static_cast<double>(i % row), 20.0 * static_cast<double>(i / row), 0.0);
    AddBox(low, { random.Between(3.0, 15.0), random.Between(3.0, 15.0), random.Between(2.0, 40.0) },
      polygons);
  }
  return polygons;
}

/// A random point of a convex polygon.
glm::dvec3 PickPoint(const ReceiverGrid::Polygon& polygon, RandomGeometry& random)
{
  glm::dvec3 point(0.0);
  double sum = 0.0;
  for (const glm::dvec3& corner : polygon)
  {
    const double weight = random.Between(0.0, 1.0);
    point += weight * corner;
    sum += weight;
  }
  return point / sum;
}

/// What look-ups of random points of all receivers read.
struct Reads
{
  double Mean = 0.0;
  int Most = 0;
};

/// Each point of a receiver, and each that is off it by what single precision may be off, finds it.
Reads ExpectFound(const Polygons& polygons, int points, const std::string& what)
{
  const ReceiverGrid grid(polygons);
  RandomGeometry random(3);
  Reads reads;
  double tries = 0.0;
  // A tenth of what the grid allows for, along any axis.
  const glm::dvec3& size = grid.GetSize();
  const double off = 1e-6 * std::max({ size.x, size.y, size.z });
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    for (int k = 0; k < points; ++k)
    {
      const glm::dvec3 point = PickPoint(polygons[i], random) + random.InBox(off);
      const ReceiverGrid::Answer answer = grid.Find(point);
      EXPECT_EQ(std::count(answer.Receivers.begin(), answer.Receivers.end(), i), 1)
        << what << ": receiver " << i << " is not found, or twice, at " << point.x << ", "
        << point.y << ", " << point.z;
      reads.Mean += answer.Reads;
      reads.Most = std::max(reads.Most, answer.Reads);
      tries += 1.0;
    }
  }
  reads.Mean /= tries;
  std::cout << what << ": " << polygons.size() << " receivers, " << reads.Mean
            << " reads in the mean, at most " << reads.Most << ", table of "
            << grid.GetTable().size() << " texels\n";
  return reads;
}

} // namespace

TEST(ReceiverGrid, FindsReceiversInFewReads)
{
  // Most points are in a cell of the outermost grid or of one in it; near edges, there is a list of
  // two or three.
  for (const std::size_t boxes : { 1, 6, 90, 400, 1700 })
  {
    const Reads reads = ExpectFound(MakeCity(boxes), 20, "city");
    EXPECT_LE(reads.Mean, 2.5) << boxes << " boxes";
    EXPECT_LE(reads.Most, 8) << boxes << " boxes";
  }
}

TEST(ReceiverGrid, TinyBesideHuge)
{
  // 20 km of ground with windows of a metre in it, and one of a centimetre.
  RandomGeometry random(5);
  Polygons polygons = { MakeParallelogram(
    glm::dvec3(-1e4, -1e4, 0.0), { 2e4, 0.0, 0.0 }, { 0.0, 2e4, 0.0 }) };
  for (int i = 0; i < 200; ++i)
  {
    polygons.push_back(
      MakeParallelogram(glm::dvec3(random.Between(-9e3, 9e3), random.Between(-9e3, 9e3), 0.0),
        { i == 0 ? 0.01 : 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }));
  }
  const Reads reads = ExpectFound(polygons, 10, "ground with windows");
  EXPECT_LE(reads.Most, ReceiverGrid::MaximumDepth + 4);
}

TEST(ReceiverGrid, ReceiversAtTheSamePlace)
{
  // No division separates these: a cell names all of them, and the table stays small.
  const Polygons polygons(
    60, MakeParallelogram(glm::dvec3(0.0), { 1.0, 0.0, 0.0 }, { 0.2, 1.0, 0.3 }));
  const Reads reads = ExpectFound(polygons, 2, "one place");
  EXPECT_EQ(reads.Most, 61); // where the list is, too
  EXPECT_LE(ReceiverGrid(polygons).GetTable().size(), 100u * polygons.size());
}

TEST(ReceiverGrid, ManyThatMeetInAPoint)
{
  Polygons polygons;
  constexpr int sectors = 100;
  for (int i = 0; i < sectors; ++i)
  {
    const auto corner = [](int k)
    {
      const double angle = 2.0 * 3.14159265358979 * k / sectors;
      return glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    };
    polygons.push_back({ glm::dvec3(0.0), corner(i), corner(i + 1) });
  }
  const Reads reads = ExpectFound(polygons, 20, "fan");
  EXPECT_LE(reads.Mean, 8.0);
}

TEST(ReceiverGrid, AnyScaleAndPlace)
{
  for (const double scale : { 1e-9, 1.0, 1e9 })
  {
    Polygons polygons;
    AddBox(glm::dvec3(3e3 * scale), glm::dvec3(scale, 2.0 * scale, 0.5 * scale), polygons);
    ExpectFound(polygons, 50, "box");
  }
  // On a line with an axis, and no extent at all along two.
  ExpectFound({ MakeParallelogram(glm::dvec3(1.0), { 1.0, 0.0, 0.0 }, { 0.0, 1e-7, 0.0 }),
                MakeParallelogram({ 2.0, 1.0, 1.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1e-7, 0.0 }) },
    50, "strips");
}

TEST(ReceiverGrid, WhatMayBeAnywhereIsFoundAnywhere)
{
  Polygons polygons = MakeCity(4);
  polygons.emplace_back();
  const ReceiverGrid grid(polygons);
  RandomGeometry random(11);
  for (int i = 0; i < 1000; ++i)
  {
    const std::vector<std::size_t> found = grid.Find(random.InBox(100.0)).Receivers;
    EXPECT_EQ(std::count(found.begin(), found.end(), polygons.size() - 1), 1);
  }
  EXPECT_TRUE(ReceiverGrid().Find(glm::dvec3(0.0)).Receivers.empty());
  EXPECT_EQ(ReceiverGrid(Polygons(1)).Find(glm::dvec3(7.0)).Receivers.size(), 1u);
}

TEST(ReceiverGrid, PointsOutsideFindAReceiver)
{
  const ReceiverGrid grid(MakeCity(9));
  RandomGeometry random(13);
  for (int i = 0; i < 1000; ++i)
  {
    EXPECT_FALSE(grid.Find(random.InBox(300.0)).Receivers.empty());
  }
}

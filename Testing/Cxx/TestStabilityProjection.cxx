// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Triangles that are hard to project or to draw, and sums of very many or very different numbers.

#include "RandomGeometry.h"
#include "SamplingPattern.h"
#include "SegmentLight.h"
#include "StabilityTools.h"
#include "SurfaceLight.h"

#include "vtkAreaLightSource.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkRadianceMap.h"
#include "vtkShadowReceiver.h"
#include "vtkStructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace
{

using Texels = std::vector<glm::vec4>;

oracle::Vec3 ToOracle(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

void AddTriangle(TestScene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  scene.Occluders.push_back({ ToOracle(a), ToOracle(b), ToOracle(c) });
}

/// How many texels differ in any bit.
double CountDifferences(const Texels& a, const Texels& b)
{
  double count = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    count += a[i] != b.at(i) ? 1.0 : 0.0;
  }
  return count;
}

/// A lamp whose shadows have penumbras of all widths, by a box and a needle.
TestScene MakeBatchScene()
{
  TestScene scene = MakeLampScene();
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  scene.AddPlate({ -1.9, 0.9, 0.5 }, { 1.5, 0.3, 0.2 }, { 0.0, 0.01, 0.0 });
  scene.Settings.Reconstruction = false;
  scene.Settings.HardPenumbra = 0.0; // all samples, of all lights
  scene.Settings.PlannerTolerance = 0.0;
  return scene;
}

/// Of each light.
std::vector<int> GetSampleCounts(const TestBake& bake)
{
  std::vector<int> counts;
  for (const vtkRadianceBaker::PairReport& pair : bake.Reports.front().Pairs)
  {
    counts.push_back(pair.LightSamples);
  }
  return counts;
}

/// Bakes with ErrorTolerance, by default one that is never met, and with as many samples at once.
void ExpectBatchesChangeNothing(TestScene scene, int most)
{
  if (scene.Settings.ErrorTolerance == 0.0)
  {
    scene.Settings.ErrorTolerance = 1e-12;
  }
  scene.Settings.MaximumLightSamples = most;
  scene.Settings.HardPenumbra = 0.0; // as with a tolerance
  const TestBake inBatches = BakeReceiver(scene.MakeScene());
  const std::vector<int> counts = GetSampleCounts(inBatches);
  scene.Settings.ErrorTolerance = 0.0;
  scene.Settings.LightSamples = *std::max_element(counts.begin(), counts.end());
  const TestBake once = BakeReceiver(scene.MakeScene());
  ASSERT_EQ(GetSampleCounts(once), counts);
  double differences = CountDifferences(once.Texels.Irradiance, inBatches.Texels.Irradiance);
  for (std::size_t i = 0; i < once.Texels.Variance.size(); ++i)
  {
    differences += once.Texels.Variance[i] != inBatches.Texels.Variance.at(i) ? 1.0 : 0.0;
  }
  ExpectWithin("texels that batches change, " + std::to_string(scene.Settings.LightSamples) +
      " samples by pattern " + std::to_string(scene.Settings.SamplingPattern),
    differences, 0.0);
}

} // namespace

TEST(StabilityProjection, TrianglesThatCrossTheSamplesHeight)
{
  TestScene scene = MakeLampScene();
  scene.Name = "triangles across w' = 0";
  AddTriangle(scene, { -1.5, -0.7, 0.3 }, { -1.1, 0.9, 0.2 }, { -0.9, 0.1, 5.0 });
  AddTriangle(scene, { 0.8, 0.2, -0.5 }, { 1.3, 1.2, 9.0 }, { 1.1, -0.6, 7.0 });
  AddTriangle(scene, { 0.1, 0.7, 1.0 }, { 0.4, 0.8, 2.6 }, { -0.2, 0.9, 2.5 });
  ExpectExactCount(scene);
}

TEST(StabilityProjection, RandomTrianglesAcrossEverything)
{
  RandomGeometry random(4);
  for (int i = 0; i < 20; ++i)
  {
    TestScene scene = MakeLampScene();
    scene.Name = "random triangles " + std::to_string(i);
    for (int t = 0; t < 3; ++t)
    {
      const glm::dvec3 centre = random.InBox(1.5) + glm::dvec3(0.0, 0.0, 1.0);
      AddTriangle(
        scene, centre + random.InBox(2.5), centre + random.InBox(2.5), centre + random.InBox(2.5));
    }
    ExpectExactCount(scene, 0.05);
  }
}

// A million times the receiver: upright with an edge over the floor, lying, and leaning.
TEST(StabilityProjection, EnormousTriangles)
{
  for (const double size : { 1e2, 1e4, 4e6 })
  {
    TestScene scene = MakeLampScene();
    std::ostringstream name;
    name << "triangles of size " << size;
    scene.Name = name.str();
    AddTriangle(
      scene, { 0.9, -size, -0.3 * size }, { 1.0, size, -0.2 * size }, { 0.95, 0.3, size });
    AddTriangle(scene, { -size, 0.61, 0.8 }, { size, 0.63, 0.9 }, { 0.2 * size, size, 1.3 });
    AddTriangle(
      scene, { -0.7, -size, -size }, { -0.9, size, -size }, { -0.8, -0.7 * size, 0.8 * size });
    ExpectExactCount(scene);
  }
}

// The wide ones' images are as long as slivers in space; both kinds have an aspect of 1e8.
TEST(StabilityProjection, Slivers)
{
  RandomGeometry random(8);
  TestScene scene = MakeLampScene();
  scene.Name = "slivers of aspect 1e8";
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  const Texels without = BakeTexels(scene);
  for (int i = 0; i < 100; ++i)
  {
    const glm::dvec3 a = random.InBox(1.5) + glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 along = random.InBox(1.5);
    AddTriangle(scene, a, a + along, a + 0.5 * along + 1e-8 * random.InBox(1.5));
  }
  // They cover so little that no ray meets one; an edge that is open to a rasteriser's choice is
  // never wider than what the count leaves open.
  ExpectExactCount(scene, 0.05);
}

// Cut into slivers, a plate is what it was: no cracks between them.
TEST(StabilityProjection, PlateOfSliversHasNoCracks)
{
  TestScene whole = MakeLampScene();
  whole.AddPlate({ -30.0, -30.0, 1.0 }, { 60.0, 0.0, 0.0 }, { 0.0, 60.0, 0.0 });
  TestScene cut = MakeLampScene();
  const int fans = 4000;
  for (int i = 0; i < fans; ++i)
  {
    const auto at = [&](int k)
    { return glm::dvec3(-30.0 + 60.0 * k / fans, k % 2 ? 30.0 : -30.0, 1.0); };
    AddTriangle(cut, { at(i).x, -30.0, 1.0 }, { at(i + 1).x, -30.0, 1.0 }, { at(i).x, 30.0, 1.0 });
    AddTriangle(
      cut, { at(i).x, 30.0, 1.0 }, { at(i + 1).x, -30.0, 1.0 }, { at(i + 1).x, 30.0, 1.0 });
  }
  ExpectWithin("texels with a crack", CountDifferences(BakeTexels(whole), BakeTexels(cut)), 0.0);
}

TEST(StabilityProjection, ZeroAreaAndDuplicateTrianglesChangeNothing)
{
  TestScene scene = MakeLampScene();
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  const Texels once = BakeTexels(scene);
  const std::vector<oracle::Triangle> copies = scene.Occluders;
  scene.Occluders.insert(scene.Occluders.end(), copies.begin(), copies.end());
  for (const double z : { 0.0, 0.5, 2.0, 3.0 })
  {
    const glm::dvec3 a(0.1, 0.2, z), b(0.4, 0.3, 0.5 * z);
    AddTriangle(scene, a, a, a);
    AddTriangle(scene, a, b, a);
    AddTriangle(scene, a, b, a + 3.0 * (b - a));
  }
  ExpectWithin("texels that duplicates change", CountDifferences(once, BakeTexels(scene)), 0.0);
}

// 1e5 triangles that make up a plate of half a texel.
TEST(StabilityProjection, AHundredThousandTrianglesInOneTexel)
{
  TestScene scene = MakeLampScene();
  scene.Name = "1e5 triangles in a texel";
  scene.AddPlate({ 0.2001, 0.1502, 0.002 }, { 0.0625, 0.0, 0.0 }, { 0.0, 0.0625, 0.0 });
  const std::vector<oracle::Triangle> plate = scene.Occluders;
  ExpectExactCount(scene);
  const Texels whole = BakeTexels(scene);
  scene.Occluders.clear();
  const int n = 224; // 2 n^2 triangles
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const glm::dvec3 a(0.2001 + 0.0625 * i / n, 0.1502 + 0.0625 * j / n, 0.002);
      scene.AddPlate(a, { 0.0625 / n, 0.0, 0.0 }, { 0.0, 0.0625 / n, 0.0 });
    }
  }
  const Texels pieces = BakeTexels(scene);
  // Vertices along the plate's edge are each snapped on their own, by up to half of 1/256 texel:
  // texels that no edge passes so closely are the same to the bit.
  ExpectWithin("texels that the pieces change", CountDifferences(whole, pieces), 0.0);
}

// Ambient light alone, to the bit, by the filter itself.
TEST(StabilityProjection, UmbraIsExactlyAmbient)
{
  vtkNew<vtkPlaneSource> plane, lid;
  plane->SetOrigin(-2, -2, 0);
  plane->SetPoint1(2, -2, 0);
  plane->SetPoint2(-2, 2, 0);
  lid->SetOrigin(-20, -20, 1);
  lid->SetPoint1(20, -20, 1);
  lid->SetPoint2(-20, 20, 1);
  vtkNew<vtkShadowReceiver> receiver;
  receiver->SetInputConnection(plane->GetOutputPort());
  receiver->SetTexelSize(0.1);
  receiver->SetReflectance(0.7, 0.3, 0.9);
  receiver->SetAmbientRadiance(0.013, 0.17, 1.9);
  vtkNew<vtkAreaLightSource> light;
  light->SetOrigin(-0.5, 0.5, 2.0);
  light->SetPoint1(0.5, 0.5, 2.0);
  light->SetPoint2(-0.5, -0.5, 2.0);
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, lid->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, light->GetOutputPort());
  map->Update();
  auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(0));
  vtkDataArray* radiance = grid->GetCellData()->GetArray("Radiance");
  const glm::vec3 reflectance(0.7, 0.3, 0.9), ambient(0.013, 0.17, 1.9);
  double wrong = 0.0;
  for (vtkIdType i = 0; i < radiance->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const auto value = static_cast<float>(radiance->GetComponent(i, c));
      wrong += value != reflectance[c] * ambient[c] ? 1.0 : 0.0;
    }
  }
  ASSERT_EQ(radiance->GetNumberOfTuples(), 1600);
  ExpectWithin("texels of the umbra that are not ambient", wrong, 0.0);
}

// A sun straight above: the edge between two halves goes through the centres of a column of texels.
// Each is covered by one of the halves: no crack, and nothing is drawn twice.
TEST(StabilityProjection, EdgeThroughTexelCentres)
{
  TestScene left = MakeLampScene();
  left.Lights.clear();
  left.AddLight({ -1e-6, 1e-6, 2.0 }, { 1e-6, 1e-6, 2.0 }, { -1e-6, -1e-6, 2.0 });
  left.Settings.LightSamples = 1;
  left.Settings.SamplingPattern = 3; // the light's centre
  TestScene right = left, both = left;
  const double x = 0.5 * 0.0625; // half as high as the light: of the first column right of the axis
  left.AddPlate({ -9.0, -9.0, 1.0 }, { 9.0 + x, 0.0, 0.0 }, { 0.0, 18.0, 0.0 });
  right.AddPlate({ x, -9.0, 1.0 }, { 9.0 - x, 0.0, 0.0 }, { 0.0, 18.0, 0.0 });
  both.AddPlate({ -9.0, -9.0, 1.0 }, { 9.0 + x, 0.0, 0.0 }, { 0.0, 18.0, 0.0 });
  both.AddPlate({ x, -9.0, 1.0 }, { 9.0 - x, 0.0, 0.0 }, { 0.0, 18.0, 0.0 });
  double lit = 0.0, twice = 0.0;
  const Texels byLeft = BakeTexels(left), byRight = BakeTexels(right), byBoth = BakeTexels(both);
  for (std::size_t i = 0; i < byBoth.size(); ++i)
  {
    lit += byBoth[i].r > 0.0f ? 1.0 : 0.0;
    twice += byLeft[i].r == 0.0f && byRight[i].r == 0.0f ? 1.0 : 0.0;
  }
  ExpectWithin("texels lit through the seam", lit, 0.0);
  ExpectWithin("texels covered by both halves", twice, 0.0);
}

TEST(StabilityAccumulation, SixtyFiveThousandSamples)
{
  TestScene scene = MakeLampScene();
  scene.Name = "65 536 samples";
  scene.Texels = { 12, 12 };
  scene.Settings.LightSamples = 65536;
  scene.AddPlate({ -0.9, -0.8, 0.7 }, { 1.3, 0.2, 0.1 }, { -0.1, 1.2, 0.1 });
  ExpectExactCount(scene);
}

// The brightest light is elsewhere in the spectrum: each component keeps its own digits.
TEST(StabilityAccumulation, RadianceOverTwentyFourPowersOfTen)
{
  TestScene all = MakeLampScene();
  all.Lights.clear();
  std::vector<TestScene> alone;
  const std::vector<glm::dvec3> radiances{ { 1e-12, 0.0, 0.0 }, { 0.0, 1.0, 0.0 },
    { 0.0, 0.0, 1e12 } };
  for (std::size_t i = 0; i < radiances.size(); ++i)
  {
    const double x = -0.5 + 0.3 * static_cast<double>(i);
    TestScene one = MakeLampScene();
    one.Lights.clear();
    for (TestScene* scene : { &one, &all })
    {
      scene->AddLight({ x, 0.5, 2.0 }, { x + 1.0, 0.5, 2.0 }, { x, -0.5, 2.0 }, radiances[i]);
      scene->Occluders.clear();
      scene->AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
    }
    one.Name = "radiance " + std::to_string(radiances[i][static_cast<int>(i)]);
    ExpectExactCount(one);
    alone.push_back(one);
  }
  const Texels together = BakeTexels(all);
  double differences = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const Texels one = BakeTexels(alone[static_cast<std::size_t>(c)]);
    for (std::size_t i = 0; i < one.size(); ++i)
    {
      differences += one[i][c] != together[i][c] ? 1.0 : 0.0;
    }
  }
  ExpectWithin("texels that other lights change", differences, 0.0);
}

// Lights of one hue, 24 powers of ten apart: where the bright one is hidden, the dim one keeps all
// its digits.
TEST(StabilityAccumulation, DimLightInTheUmbraOfABrightOne)
{
  TestScene dim = MakeLampScene(), both = MakeLampScene();
  dim.Lights.clear();
  both.Lights.clear();
  both.AddLight({ -1.5, 0.3, 2.0 }, { -0.9, 0.3, 2.0 }, { -1.5, -0.3, 2.0 }, glm::dvec3(1e12));
  for (TestScene* scene : { &dim, &both })
  {
    scene->AddLight({ 0.9, 0.5, 2.0 }, { 1.9, 0.5, 2.0 }, { 0.9, -0.5, 2.0 }, glm::dvec3(1e-12));
    scene->AddPlate({ -0.2, -0.9, 0.0 }, { 0.0, 1.8, 0.0 }, { 0.0, 0.0, 1.2 });
  }
  dim.Name = "the dim light alone";
  ExpectExactCount(dim);
  both.Name = "the dim light and the bright one";
  ExpectExactCount(both);
  const Texels alone = BakeTexels(dim), together = BakeTexels(both);
  double hidden = 0.0, differences = 0.0;
  for (std::size_t i = 0; i < alone.size(); ++i)
  {
    // A form factor is at most 1; one sample of the bright light gives more than that of the dim
    // one.
    const bool isHidden = together[i].r <= 1e-12f;
    hidden += isHidden ? 1.0 : 0.0;
    differences += isHidden && glm::vec3(alone[i]) != glm::vec3(together[i]) ? 1.0 : 0.0;
  }
  EXPECT_GT(hidden, 10.0);
  ExpectWithin("texels of the umbra that the bright light changes", differences, 0.0);
}

TEST(StabilityAccumulation, TwoHundredLights)
{
  RandomGeometry random(200);
  TestScene scene = MakeLampScene();
  scene.Name = "200 lights";
  scene.Texels = { 12, 12 };
  scene.Settings.LightSamples = 16;
  scene.Lights.clear();
  for (int i = 0; i < 200; ++i)
  {
    const glm::dvec3 at(random.Between(-2.0, 2.0), random.Between(-2.0, 2.0), random.Between(1, 3));
    scene.AddLight(at, at + glm::dvec3(0.0, 0.2, 0.0), at + glm::dvec3(0.2, 0.0, 0.0),
      glm::dvec3(std::pow(10.0, random.Between(-12.0, 12.0))));
  }
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  const CountError error = CompareWithCount(scene);
  // Each light's own bound, and a rounding of the sum for each light.
  ExpectWithin(scene.Name, error.Largest, GetRadianceBound(16) + 200.0 * FloatRounding);
}

// With a tolerance that cannot be met, samples come in batches until there are as many as are
// allowed; with one that can, until it is met. The texels and their errors are those of as many
// samples at once. Numbers that are no multiples of 32 end a batch within a layer of masks.
TEST(StabilityAccumulation, BatchesOfSamplesChangeNoBit)
{
  TestScene scene = MakeBatchScene();
  for (const int samples : { 1, 50, 100, 127, 128, 129, 333, 1000, 1024, 4096 })
  {
    ExpectBatchesChangeNothing(scene, samples);
  }
  for (const double tolerance : { 0.005, 0.001, 0.0002 })
  {
    scene.Settings.ErrorTolerance = tolerance;
    ExpectBatchesChangeNothing(scene, 4096);
  }
}

TEST(StabilityAccumulation, BatchesChangeNoBitOfAnyPattern)
{
  TestScene scene = MakeBatchScene();
  for (std::size_t i = 0; i < penumbra::GetSamplingPatterns().size(); ++i)
  {
    scene.Settings.SamplingPattern = static_cast<int>(i);
    ExpectBatchesChangeNothing(scene, 400);
  }
}

TEST(StabilityAccumulation, BatchesChangeNoBitOfFilteredTexels)
{
  TestScene scene = MakeBatchScene();
  scene.Settings.Supersampling = 2;
  ExpectBatchesChangeNothing(scene, 500);
  scene.Settings.Reconstruction = true;
  ExpectBatchesChangeNothing(scene, 500);
}

// A light of cells, by how they share its power: red, green and blue have shares of their own.
TEST(StabilityAccumulation, BatchesChangeNoBitOfSeveralLights)
{
  TestScene scene = MakeBatchScene();
  std::vector<penumbra::PolygonLight> cells;
  for (const glm::dvec3 hue : { glm::dvec3(3.0, 0.0, 1e-6), glm::dvec3(0.0, 0.7, 0.1) })
  {
    const double x = cells.empty() ? -1.0 : 0.3;
    penumbra::PolygonLight cell = penumbra::PolygonLight::Parallelogram(
      { x, 0.5, 2.5 }, { x + 0.7, 0.5, 2.4 }, { x, 0.1, 2.5 });
    cell.Radiance = hue;
    cells.push_back(cell);
  }
  scene.Lights.push_back(penumbra::SurfaceLight(cells));
  scene.Lights.push_back(penumbra::SegmentLight({ -1.0, -0.5, 1.0 }, { 1.0, 0.2, 1.4 }));
  ExpectBatchesChangeNothing(scene, 700);
}

// Texels that the first batch sees all of the light from, or nothing, and a later one does not, are
// among those that must not change.
TEST(StabilityAccumulation, LaterBatchesMeetWhatTheFirstOneMissed)
{
  TestScene scene = MakeBatchScene();
  const auto countMixed = [&](int samples)
  {
    scene.Settings.LightSamples = samples;
    const Texels texels = BakeTexels(scene);
    return std::count_if(
      texels.begin(), texels.end(), [](const glm::vec4& t) { return t.r > 0.0f && t.a > 0.0f; });
  };
  const auto first = countMixed(64);
  const auto last = countMixed(1024);
  EXPECT_GT(first, 0);
  EXPECT_GT(last, first + 10);
  ExpectBatchesChangeNothing(scene, 1024);
}

// Bands of rows, each with masks of its own, against all at once.
TEST(StabilityAccumulation, BandsOfRowsChangeNoBit)
{
  TestScene scene = MakeLampScene();
  scene.Texels = { 33, 47 };
  scene.Settings.LightSamples = 100;
  scene.AddPlate({ -0.9, -0.8, 0.7 }, { 1.3, 0.2, 0.1 }, { -0.1, 1.2, 0.1 });
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  for (const bool reconstruction : { false, true })
  {
    scene.Settings.Reconstruction = reconstruction;
    const Texels whole = BakeInBands(scene, vtkRadianceBaker::DefaultMaskBytes);
    double differences = 0.0;
    const std::size_t row = 33 * 4 * 4; // bytes: 100 samples take four layers of 4 bytes
    for (const std::size_t rows : { 1, 5, 6, 7, 16, 31, 46 })
    {
      differences += CountDifferences(whole, BakeInBands(scene, rows * row));
    }
    ExpectWithin(
      reconstruction ? "texels that bands change, reconstructed" : "texels that bands change",
      differences, 0.0);
  }
}

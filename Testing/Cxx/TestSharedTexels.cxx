// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Triangles share rectangles of texels in pairs. Nothing of that is to be seen but the memory that
// it saves: texels are those of triangles that are baked alone, to the bit, and what is shown of
// one triangle does not depend on the other.

#include "PassScene.h"
#include "RandomGeometry.h"
#include "TestScenes.h"
#include "vtkBakedProp.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRadianceMap.h"
#include "vtkStructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace
{

using penumbra::AtlasHalf;
using penumbra::ShadowScene;
using penumbra::Surface;
using Triangle = std::array<glm::dvec3, 3>;

constexpr std::size_t Triangles = 5;

/// A plate of two triangles that lies flat.
Surface MakePlate(const glm::dvec3& corner, double width, double depth)
{
  Surface plate;
  plate.Points = { corner, corner + glm::dvec3(width, 0.0, 0.0),
    corner + glm::dvec3(width, depth, 0.0), corner + glm::dvec3(0.0, depth, 0.0) };
  plate.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  return plate;
}

/// A surface of triangles of two sizes, slanted at random, and a square: an odd number of
/// triangles. A plate hangs over each: surfaces 1 and so on.
ShadowScene MakeFacets(unsigned seed, const penumbra::ReceiverSettings& settings)
{
  RandomGeometry random(seed);
  ShadowScene scene;
  Surface facets;
  std::vector<Surface> plates;
  for (std::size_t i = 0; i <= Triangles; ++i)
  {
    const glm::dvec3 corner(
      3.0 * static_cast<double>(i % 4), 3.0 * static_cast<double>(i / 4), 0.0);
    penumbra::Receiver receiver;
    receiver.IsTriangle = i < Triangles;
    receiver.Base = { corner, glm::dvec3(2.5, 0.0, 0.0) + random.InBox(0.4),
      glm::dvec3(0.0, 2.5, 0.0) + random.InBox(0.4) };
    receiver.Region = static_cast<int>(i);
    receiver.Settings = settings;
    receiver.Texels = i % 3 == 0 ? glm::ivec2(70, 41) : glm::ivec2(44, 57);
    receiver.Texels += glm::ivec2(random.Below(4), random.Below(4));
    scene.Receivers.push_back(receiver);
    const auto first = static_cast<std::uint32_t>(facets.Points.size());
    const penumbra::Parallelogram& base = receiver.Base;
    facets.Points.insert(facets.Points.end(),
      { base.Corner, base.Corner + base.EdgeX, base.Corner + base.EdgeY,
        base.Corner + base.EdgeX + base.EdgeY });
    facets.Triangles.push_back({ first, first + 1, first + 2 });
    facets.Regions.push_back(receiver.Region);
    if (!receiver.IsTriangle)
    {
      facets.Triangles.push_back({ first + 1, first + 3, first + 2 });
      facets.Regions.push_back(receiver.Region);
    }
    plates.push_back(MakePlate(corner + glm::dvec3(0.4, 0.5, 0.6), 0.9, 0.7));
  }
  scene.Surfaces.emplace_back(facets);
  scene.Surfaces.insert(scene.Surfaces.end(), plates.begin(), plates.end());
  scene.Lights.emplace_back(
    penumbra::PolygonLight::Parallelogram({ 4, 4, 8 }, { 4, 5, 8 }, { 5, 4, 8 }));
  scene.Lights.emplace_back(
    penumbra::PolygonLight::Triangle({ 1, 6, 7 }, { 1, 8, 7 }, { 3, 6, 7.5 }));
  scene.Lights.back()->Radiance = { 3.0, 1.0, 0.2 };
  return scene;
}

/// A surface whose radiance is kept up to date.
class BakedFacets
{
public:
  ~BakedFacets() { this->Prop->ReleaseGraphicsResources(); }
  BakedFacets() = default;
  BakedFacets(const BakedFacets&) = delete;
  void operator=(const BakedFacets&) = delete;

  void Update(const ShadowScene& scene, bool draft = false)
  {
    vtkOpenGLRenderWindow* window = GetTestWindow();
    window->GetState()->Push();
    this->Baker->SetScene(scene);
    std::vector<std::size_t> receivers(scene.Receivers.size());
    std::iota(receivers.begin(), receivers.end(), std::size_t{ 0 });
    std::vector<penumbra::ReceiverPlan> plans;
    for (const std::size_t i : receivers)
    {
      plans.push_back(this->Baker->Plan(i));
    }
    const vtkBakedProp::Outcome outcome =
      this->Prop->Update(this->Baker, scene, receivers, plans, window, true, draft);
    window->GetState()->Pop();
    ASSERT_NE(outcome, vtkBakedProp::Outcome::Failed);
  }

  void FinishByTiles()
  {
    constexpr double Seconds = 2e-3; // many tiles
    vtkOpenGLState* state = GetTestWindow()->GetState();
    state->Push();
    while (this->Prop->CountDraftTexels() > 0.0)
    {
      this->Prop->Finish(this->Baker, Seconds);
    }
    state->Pop();
  }

  const std::vector<vtkRadianceTexture::Region>& GetRegions() const
  {
    return this->Prop->GetTexture()->GetRegions();
  }

  /// The whole texture, with all gutters.
  std::vector<glm::vec4> GetAll() const
  {
    vtkRadianceTexture* texture = this->Prop->GetTexture();
    return texture->Download({ glm::ivec2(0), texture->GetSize() }).Irradiance;
  }

  vtkNew<vtkRadianceBaker> Baker;
  vtkNew<vtkBakedProp> Prop;
};

std::vector<penumbra::ReceiverSettings> MakeSettings()
{
  std::vector<penumbra::ReceiverSettings> settings(4);
  settings[1].Supersampling = 2;
  settings[1].LightSamples = 16;
  settings[2].Reconstruction = false;
  settings[2].LightSamples = 256; // shares are kept
  settings[3].ErrorTolerance = 2e-3;
  return settings;
}

std::size_t CountShared(const std::vector<vtkRadianceTexture::Region>& regions)
{
  return static_cast<std::size_t>(std::count_if(regions.begin(), regions.end(),
    [](const vtkRadianceTexture::Region& region) { return region.Half != AtlasHalf::Whole; }));
}

void MoveSurface(ShadowScene& scene, std::size_t index, const glm::dvec3& step)
{
  Surface moved = *scene.Surfaces[index];
  for (glm::dvec3& point : moved.Points)
  {
    point += step;
  }
  scene.Surfaces[index] = moved;
}

/// One of several changes.
void Change(ShadowScene& scene, std::size_t step)
{
  switch (step)
  {
    case 0:
      MoveSurface(scene, 1, { 0.3, -0.2, 0.1 });
      break;
    case 1:
      scene.Lights[1]->Radiance *= glm::dvec3(0.5, 2.0, 1.0);
      break;
    case 2:
      scene.Surfaces.erase(scene.Surfaces.begin() + 2);
      break;
    default:
      scene.Surfaces.emplace_back(MakePlate({ 3.2, 1.0, 0.9 }, 0.5, 1.5));
  }
}

} // namespace

TEST(SharedTexels, AreThoseOfTrianglesAlone)
{
  unsigned seed = 0;
  for (const penumbra::ReceiverSettings& settings : MakeSettings())
  {
    const ShadowScene scene = MakeFacets(++seed, settings);
    BakedFacets facets;
    facets.Update(scene);
    const auto& regions = facets.GetRegions();
    EXPECT_EQ(CountShared(regions), Triangles - 1);
    for (std::size_t r = 0; r < scene.Receivers.size(); ++r)
    {
      const std::vector<glm::vec4> alone = BakeReceiver(scene, r).Texels.Irradiance;
      const std::vector<glm::vec4> texels =
        facets.Prop->GetTexture()->Download(regions[r]).Irradiance;
      ASSERT_EQ(texels.size(), alone.size());
      const glm::ivec2 size = regions[r].Size;
      int shown = 0, own = 0, differing = 0, missing = 0;
      for (int i = 0; i < size.x * size.y; ++i)
      {
        const glm::ivec2 texel(i % size.x, i / size.x);
        const glm::dvec2 uv = (glm::dvec2(texel) + 0.5) / glm::dvec2(size);
        const bool isOwn = regions[r].Owns(texel);
        const bool isShown = scene.Receivers[r].IsTriangle ? uv.x + uv.y <= 1.0 : true;
        shown += isShown ? 1 : 0;
        own += isOwn ? 1 : 0;
        missing += isShown && !isOwn ? 1 : 0;
        const auto index = static_cast<std::size_t>(i);
        differing += isOwn && texels[index] != alone[index] ? 1 : 0;
      }
      EXPECT_EQ(missing, 0) << "settings " << seed << ", receiver " << r;
      EXPECT_EQ(differing, 0) << "settings " << seed << ", receiver " << r << " of " << own;
      EXPECT_GT(shown, size.x * size.y / 3);
      EXPECT_TRUE(facets.Prop->Download(scene, r, GetTestWindow()) == alone) << "receiver " << r;
    }
  }
}

TEST(SharedTexels, ChangeAsWholeBakesDo)
{
  unsigned seed = 10;
  for (const penumbra::ReceiverSettings& settings : MakeSettings())
  {
    ShadowScene scene = MakeFacets(++seed, settings);
    BakedFacets facets;
    facets.Update(scene);
    std::vector<glm::vec4> before = facets.GetAll();
    for (std::size_t step = 0; step < 4; ++step)
    {
      Change(scene, step);
      facets.Update(scene);
      BakedFacets whole;
      whole.Update(scene);
      const std::vector<glm::vec4> texels = facets.GetAll();
      EXPECT_TRUE(texels != before) << "settings " << seed << ", step " << step;
      EXPECT_TRUE(texels == whole.GetAll()) << "settings " << seed << ", step " << step;
      before = texels;
    }
  }
}

TEST(SharedTexels, AreFinishedByTiles)
{
  unsigned seed = 20;
  for (const penumbra::ReceiverSettings& settings : MakeSettings())
  {
    ShadowScene scene = MakeFacets(++seed, settings);
    BakedFacets facets;
    facets.Update(scene, true);
    Change(scene, 0);
    facets.Update(scene, true);
    EXPECT_GT(facets.Prop->CountDraftTexels(), 0.0);
    facets.FinishByTiles();
    BakedFacets whole;
    whole.Update(scene);
    EXPECT_TRUE(facets.GetAll() == whole.GetAll()) << "settings " << seed;
  }
}

// Four triangles alike in two slots, one over the other: what triangles that have a slot of their
// own take for two.
TEST(SharedTexels, TakeHalfOfTheMemory)
{
  penumbra::ReceiverSettings settings;
  settings.LightSamples = 1;
  settings.Supersampling = 2; // so that nothing else is kept
  ShadowScene scene = MakeFacets(31, settings);
  scene.Receivers.resize(4);
  for (penumbra::Receiver& receiver : scene.Receivers)
  {
    receiver.Texels = { 256, 200 };
  }
  BakedFacets facets;
  facets.Update(scene);
  EXPECT_EQ(CountShared(facets.GetRegions()), 4u);
  constexpr std::size_t TexelBytes = 16;
  EXPECT_LE(facets.Prop->GetBytes(), 2u * (256 + 4 * 8) * (200 + 4 * 8) * TexelBytes);
}

namespace
{

/// Triangles as one surface.
vtkSmartPointer<vtkPolyData> MakeSurface(const std::vector<Triangle>& triangles)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  for (const Triangle& triangle : triangles)
  {
    polygons->InsertNextCell(3);
    for (const glm::dvec3& point : triangle)
    {
      polygons->InsertCellPoint(points->InsertNextPoint(&point.x));
    }
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(polygons);
  return surface;
}

/// Triangles seen from above, by a camera that shows `scale` units above and below the middle.
class TriangleView : public PassScene
{
public:
  static constexpr int Side = 200;

  /// `together`: as one surface, or each as one of its own.
  TriangleView(const std::vector<Triangle>& triangles, bool together)
    : PassScene(Side, Side)
  {
    std::vector<std::vector<Triangle>> surfaces(together ? 1 : triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      surfaces[together ? 0 : i].push_back(triangles[i]);
    }
    for (const std::vector<Triangle>& surface : surfaces)
    {
      auto receiver = vtkSmartPointer<vtkShadowReceiver>::New();
      this->Receivers.push_back(receiver);
      receiver->SetInputData(MakeSurface(surface));
      receiver->SetTexelSize(4.0 / 256);
      receiver->SetLightSamples(16);
      this->Add(receiver);
    }
    this->AddLight(this->Lamp, { -0.3, 0.3, 9 }, { 0.3, 0.3, 9 }, { -0.3, -0.3, 9 });
    this->Lamp->SetRadiance(500.0, 500.0, 500.0); // radiance is up to 0.7
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(0.0, 0.0, 0.2); // below the plates: they are not in the picture
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    camera->ParallelProjectionOn();
    this->Renderer->ResetCameraClippingRange();
  }

  vtkSmartPointer<vtkActor> AddPlate(double x, double y, double width, double depth)
  {
    vtkNew<vtkPlaneSource> plate;
    plate->SetOrigin(x, y, 0.4);
    plate->SetPoint1(x + width, y, 0.4);
    plate->SetPoint2(x, y + depth, 0.4);
    this->Plates.push_back(this->Add(plate));
    return this->Plates.back();
  }

  Pixels Render(double scale)
  {
    this->Renderer->GetActiveCamera()->SetParallelScale(scale);
    this->Renderer->ResetCameraClippingRange();
    return this->PassScene::Render();
  }

  std::vector<float> GetTexels(int receiver)
  {
    const vtkSmartPointer<vtkFloatArray> array = this->Pass->GetTexels(receiver);
    return { array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues() };
  }

  vtkNew<vtkAreaLightSource> Lamp;
  std::vector<vtkSmartPointer<vtkShadowReceiver>> Receivers;
  std::vector<vtkSmartPointer<vtkActor>> Plates;
};

/// Two that share a slot, one on either side of x = 0.
const Triangle LeftTriangle = { { { -4.2, -2.0, 0.0 }, { -0.2, -2.0, 0.0 }, { -4.2, 2.0, 0.0 } } };
const Triangle RightTriangle = { { { 0.2, -2.0, 0.0 }, { 4.2, -2.0, 0.0 }, { 0.2, 2.0, 0.0 } } };

/// How many pixels of the left half differ, or of the right one.
std::size_t CountDifferences(const PassScene::Pixels& a, const PassScene::Pixels& b, bool right)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const bool isRight = i % TriangleView::Side >= TriangleView::Side / 2;
    count += isRight == right && a[i] != b[i] ? 1 : 0;
  }
  return count;
}

} // namespace

TEST(SharedTexels, AreThoseOfRadianceMap)
{
  TriangleView view({ LeftTriangle, RightTriangle }, true);
  view.AddPlate(-3.6, -1.4, 0.5, 0.6);
  view.AddPlate(0.8, -1.4, 0.4, 0.4);
  view.Render(4.0);
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, view.Receivers[0]->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, view.Lamp->GetOutputPort());
  for (const vtkSmartPointer<vtkActor>& plate : view.Plates)
  {
    map->AddInputConnection(
      vtkRadianceMap::OCCLUDERS, plate->GetMapper()->GetInputConnection(0, 0));
  }
  map->Update();
  ASSERT_EQ(map->GetOutput()->GetNumberOfBlocks(), 2u);
  for (unsigned int block = 0; block < 2; ++block)
  {
    view.Window->MakeCurrent();
    const std::vector<float> texels = view.GetTexels(static_cast<int>(block));
    auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(block));
    auto* radiance = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Radiance"));
    ASSERT_EQ(texels.size(), 4u * static_cast<std::size_t>(radiance->GetNumberOfTuples()));
    int differing = 0;
    for (vtkIdType i = 0; i < radiance->GetNumberOfTuples(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        const float shown = texels[static_cast<std::size_t>(4 * i + c)];
        differing += radiance->GetTypedComponent(i, c) == shown ? 0 : 1;
      }
    }
    EXPECT_EQ(differing, 0) << "receiver " << block;
  }
}

TEST(SharedTexels, ShowChangesAsWholeBakesDo)
{
  const auto addPlates = [](TriangleView& view)
  {
    view.AddPlate(-3.6, -1.4, 0.5, 0.6);
    view.AddPlate(0.8, -1.4, 0.4, 0.4);
    view.AddPlate(-2.5, -1.3, 0.5, 0.3);
  };
  TriangleView changed({ LeftTriangle, RightTriangle }, true);
  TriangleView whole({ LeftTriangle, RightTriangle }, true);
  addPlates(changed);
  addPlates(whole);
  const PassScene::Pixels before = changed.Render(4.0);
  for (TriangleView* view : { &changed, &whole })
  {
    view->Plates[2]->AddPosition(0.4, 0.3, 0.1);
    view->Plates[1]->AddPosition(0.2, 0.2, 0.0);
  }
  const PassScene::Pixels after = changed.Render(4.0);
  EXPECT_EQ(::CountDifferences(after, whole.Render(4.0)), 0u);
  EXPECT_GT(::CountDifferences(after, before), 0u);
  for (const int receiver : { 0, 1 })
  {
    EXPECT_TRUE(changed.GetTexels(receiver) == whole.GetTexels(receiver)) << receiver;
  }
}

// A plate leaves nothing lit of one triangle but its corner: of the other one no pixel changes, at
// whatever mip level, whichever half it has.
TEST(SharedTexels, ShowNothingOfTheOtherTriangle)
{
  for (const int shading : { vtkSoftShadowPass::SHADOW, vtkSoftShadowPass::RADIANCE })
  {
    for (const bool swapped : { false, true })
    {
      std::vector<Triangle> triangles = { LeftTriangle, RightTriangle };
      if (swapped)
      {
        std::swap(triangles[0], triangles[1]);
      }
      TriangleView view(triangles, true);
      view.Pass->SetShading(shading);
      view.AddPlate(-3.6, -1.4, 0.5, 0.6);
      view.AddPlate(0.8, -1.4, 0.4, 0.4); // both have texels
      const vtkSmartPointer<vtkActor> plate = view.AddPlate(0.5, -1.6, 5.0, 5.0);
      for (const int anisotropy : { 1, 2 }) // the nearest mip level, and two of them blended
      {
        view.Pass->SetMaximumAnisotropy(anisotropy);
        // A pixel is 0.64 of a texel, 1.3, 2.6 and so on.
        for (double scale = 1.0; scale < 100.0; scale *= 2.0)
        {
          plate->VisibilityOn();
          const PassScene::Pixels dark = view.Render(scale);
          EXPECT_EQ(view.Pass->GetNumberOfReceivers(), 2);
          plate->VisibilityOff();
          const PassScene::Pixels lit = view.Render(scale);
          EXPECT_EQ(CountDifferences(dark, lit, false), 0u)
            << "shading " << shading << ", swapped " << swapped << ", scale " << scale;
          EXPECT_GT(CountDifferences(dark, lit, true), 0u) << "scale " << scale;
        }
      }
    }
  }
}

// Where no mip levels differ, that is: seen from near by. Texture coordinates are rounded another
// way, and with them the weights of texels, to 1/256: a level at most.
TEST(SharedTexels, ShowWhatTrianglesAloneShow)
{
  // The second pair is a square that is cut along its diagonal: each lies in the other one's
  // parallelogram, and only (u, v) say which a fragment belongs to.
  const Triangle low = { { { -2.0, -2.0, 0.0 }, { 1.95, -2.0, 0.0 }, { -2.0, 1.95, 0.0 } } };
  const Triangle high = { { { 2.0, 2.0, 0.0 }, { -1.95, 2.0, 0.0 }, { 2.0, -1.95, 0.0 } } };
  for (const std::vector<Triangle>& triangles :
    { std::vector<Triangle>{ LeftTriangle, RightTriangle }, std::vector<Triangle>{ low, high } })
  {
    PassScene::Pixels pixels[2], plain;
    for (const bool together : { false, true })
    {
      TriangleView view(triangles, together);
      view.AddPlate(-3.4, -1.2, 0.5, 0.6);
      view.AddPlate(-1.4, -1.2, 0.5, 0.6);
      view.AddPlate(0.8, 0.3, 0.6, 0.4);
      view.AddPlate(1.0, -1.4, 0.4, 0.4);
      pixels[together ? 1 : 0] = view.Render(1.5);
      view.SetShadows(false);
      plain = view.Render(1.5);
    }
    EXPECT_GT(::CountDifferences(pixels[1], plain), plain.size() / 100);
    int largest = 0;
    for (std::size_t i = 0; i < plain.size(); ++i)
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        largest = std::max(largest, std::abs(int{ pixels[0][i][c] } - int{ pixels[1][i][c] }));
      }
    }
    EXPECT_LE(largest, 1);
  }
}

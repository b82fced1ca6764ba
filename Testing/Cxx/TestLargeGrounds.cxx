// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Without a TexelSize, a receiver's texels hold the mean of what is in shadow in them, however
// small the shadow is against the receiver: its area is that of geometry.

#include "DirectionalLight.h"
#include "PassScene.h"
#include "RandomGeometry.h"
#include "TestScenes.h"
#include "vtkBakedProp.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceMap.h"
#include "vtkStructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace
{

using penumbra::ShadowScene;
using penumbra::Surface;

constexpr double Pi = 3.14159265358979323846;
/// What the issue of a shadow's area asks for. A shadow has 32 texels across its thickness at
/// least, so that each of its two pairs of edges, were it a square, costs up to 1/64 where it is
/// hard.
constexpr double AllowedShare = 0.03;

/// Adds a box with four points a face, as VTK's has.
void AddBox(const glm::dvec3& low, const glm::dvec3& high, Surface& surface)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double side : { low[axis], high[axis] })
    {
      const auto first = static_cast<std::uint32_t>(surface.Points.size());
      for (int corner = 0; corner < 4; ++corner)
      {
        glm::dvec3 point(side);
        point[(axis + 1) % 3] = (corner & 1) != 0 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
        point[(axis + 2) % 3] = (corner & 2) != 0 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
        surface.Points.push_back(point);
      }
      surface.Triangles.push_back({ first, first + 1, first + 2 });
      surface.Triangles.push_back({ first + 1, first + 3, first + 2 });
    }
  }
}

void AddBall(const glm::dvec3& centre, double radius, Surface& surface)
{
  constexpr int Around = 24, Up = 12;
  const auto first = static_cast<std::uint32_t>(surface.Points.size());
  const auto at = [&](int i, int j)
  { return first + static_cast<std::uint32_t>(j * Around + i % Around); };
  for (int j = 0; j <= Up; ++j)
  {
    for (int i = 0; i < Around; ++i)
    {
      const double theta = Pi * j / Up, phi = 2.0 * Pi * i / Around;
      surface.Points.push_back(centre +
        radius *
          glm::dvec3(
            std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
      if (j < Up)
      {
        surface.Triangles.push_back({ at(i, j), at(i + 1, j), at(i, j + 1) });
        surface.Triangles.push_back({ at(i + 1, j), at(i + 1, j + 1), at(i, j + 1) });
      }
    }
  }
}

/// The area that a convex surface hides from a direction, across it: half of what its triangles
/// have there.
double GetAreaAcross(const Surface& surface, const glm::dvec3& direction)
{
  double area = 0.0;
  for (const Surface::Triangle& t : surface.Triangles)
  {
    const glm::dvec3& a = surface.Points[t[0]];
    area += 0.25 *
      std::abs(glm::dot(direction, glm::cross(surface.Points[t[1]] - a, surface.Points[t[2]] - a)));
  }
  return area;
}

/// The area of a convex surface's shadow: the integral of the share of the light, weighed by the
/// cosine, that does not arrive.
double GetShadowArea(const Surface& surface, const glm::dvec3& source, double diameter)
{
  constexpr int Samples = 400;
  const glm::dvec3 axis = std::abs(source.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(source, axis)), e2 = glm::cross(source, e1);
  double hidden = 0.0, all = 0.0;
  for (int i = 0; i < Samples; ++i)
  {
    // Even over the disk of directions, in a spiral of the golden angle.
    const double radius = std::sin(0.5 * diameter * Pi / 180.0) * std::sqrt((i + 0.5) / Samples);
    const double angle = i * Pi * (3.0 - std::sqrt(5.0));
    const glm::dvec3 direction = std::sqrt(1.0 - radius * radius) * source +
      radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    hidden += GetAreaAcross(surface, direction);
    all += direction.z;
  }
  return hidden / all;
}

/// A ground whose plane is that of x and y, and what stands on it.
struct GroundScene
{
  penumbra::Parallelogram Base;
  std::vector<Surface> Things{ 1 };
  glm::dvec3 Source{ 0, 0, 1 };
  double Diameter = 0.53;

  ShadowScene Make() const
  {
    ShadowScene scene;
    Surface ground;
    ground.Points = { this->Base.Corner, this->Base.Corner + this->Base.EdgeX,
      this->Base.Corner + this->Base.EdgeX + this->Base.EdgeY,
      this->Base.Corner + this->Base.EdgeY };
    ground.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
    ground.Regions = { 0, 0 };
    scene.Surfaces.emplace_back(ground);
    for (const Surface& thing : this->Things)
    {
      scene.Surfaces.emplace_back(thing);
    }
    penumbra::Receiver receiver;
    receiver.Base = this->Base;
    scene.Receivers.push_back(receiver);
    scene.Lights.emplace_back(penumbra::DirectionalLight(-this->Source, this->Diameter));
    scene.ChooseTexels(0);
    return scene;
  }

  void SetBase(const glm::dvec2& middle, const glm::dvec2& lengths, double angle)
  {
    this->Base.EdgeX = lengths.x * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    this->Base.EdgeY = lengths.y * glm::dvec3(-std::sin(angle), std::cos(angle), 0.0);
    this->Base.Corner = glm::dvec3(middle, 0.0) - 0.5 * (this->Base.EdgeX + this->Base.EdgeY);
  }

  void SetSun(double height, double azimuth)
  {
    this->Source = { std::cos(height) * std::cos(azimuth), std::cos(height) * std::sin(azimuth),
      std::sin(height) };
  }
};

std::ostream& operator<<(std::ostream& os, const GroundScene& scene)
{
  return os << "ground of " << glm::length(scene.Base.EdgeX) << " x "
            << glm::length(scene.Base.EdgeY) << ", sun from " << scene.Source.x << " "
            << scene.Source.y << " " << scene.Source.z << ", diameter " << scene.Diameter;
}

/// The area of what is in shadow, from a receiver's texels.
double SumShadow(const ShadowScene& scene, const std::vector<glm::vec4>& texels)
{
  const penumbra::Receiver& receiver = scene.Receivers.front();
  const double area = glm::length(glm::cross(receiver.Base.EdgeX, receiver.Base.EdgeY)) /
    receiver.Texels.x / receiver.Texels.y;
  double sum = 0.0;
  for (const glm::vec4& texel : texels)
  {
    const double seen = (texel.r + texel.g + texel.b) / 3.0;
    const double blocked = texel.a;
    EXPECT_TRUE(std::isfinite(seen + blocked) && seen >= -1e-5 && blocked >= 0.0)
      << "seen " << seen << ", blocked " << blocked;
    sum += blocked > 0.0 ? area * blocked / (seen + blocked) : 0.0;
  }
  return sum;
}

void ExpectArea(const GroundScene& ground, double right, const std::string& what)
{
  const ShadowScene scene = ground.Make();
  const TestBake bake = BakeReceiver(scene);
  ASSERT_EQ(bake.Reports.size(), 1u);
  ASSERT_TRUE(bake.Reports.front().IsComplete);
  EXPECT_NEAR(SumShadow(scene, bake.Texels.Irradiance), right, AllowedShare * right)
    << what << ", " << ground;
}

/// A thing of a size of about 1, and what it is.
std::string AddThing(std::size_t kind, RandomGeometry& random, Surface& surface)
{
  const double size = random.Between(0.3, 1.5), up = random.Below(2) == 0 ? 0.0 : 1.0;
  switch (kind % 4)
  {
    case 0:
      AddBall({ 0, 0, size + up }, size, surface);
      return "ball";
    case 1:
      AddBox({ -size, -size / 2, up }, { size, size / 2, size + up }, surface);
      return "box";
    case 2:
      AddBox({ -0.03, -0.03, 0 }, { 0.03, 0.03, 3.0 * size }, surface);
      return "pole";
    default:
      AddBox({ -size, -size, up + 0.5 }, { size, size, up + 0.51 }, surface);
      return "plate";
  }
}

/// A view from above on a ground with a ball of 1 m under the sun.
class GroundView : public PassScene
{
public:
  explicit GroundView(double halfSide)
    : PassScene(200, 200)
  {
    this->Ball->SetRadius(0.5);
    this->Ball->SetThetaResolution(32);
    this->Ball->SetPhiResolution(32);
    this->Ball->SetCenter(0.0, 0.0, 0.5);
    this->Add(this->Ball);
    this->AddReceiver({ -halfSide, -halfSide, 0 }, { halfSide, -halfSide, 0 },
      { -halfSide, halfSide, 0 }, this->Receiver);
    this->Sun->SetShape(vtkAreaLightSource::DIRECTIONAL);
    this->AddLight(this->Sun, { 1, 0, 0.8 }, { 0, 0, 0 }, { 0, 1, 0 });
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(0.0, 0.0, 40.0);
    camera->SetFocalPoint(0.0, 0.0, 0.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
    camera->ParallelProjectionOn();
    camera->SetParallelScale(2.0);
    this->Renderer->ResetCameraClippingRange();
  }

  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Sun;
};

/// What an edit may change of a view of several balls, and of a roof whose shadow is large.
struct ThingsOnGround
{
  struct Ball
  {
    std::array<double, 3> Centre{ 0.0, 0.0, 0.5 };
    bool IsVisible = true;
  };
  std::vector<Ball> Balls;
  bool HasRoof = false;
  double Radiance = 1.0;
};

/// A view of them.
class ThingsView : public GroundView
{
public:
  explicit ThingsView(const ThingsOnGround& things)
    : GroundView(250.0)
  {
    this->Renderer->GetActiveCamera()->SetParallelScale(9.0);
    this->Ball->SetCenter(0.0, 0.0, -5.0); // below the ground
    for (std::size_t i = 0; i < things.Balls.size(); ++i)
    {
      this->Spheres.push_back(vtkSmartPointer<vtkSphereSource>::New());
      this->Actors.push_back(this->Add(this->Spheres.back()));
    }
    this->Roof->SetOrigin(-8, 2, 4);
    this->Roof->SetPoint1(4, 2, 4);
    this->Roof->SetPoint2(-8, 9, 4);
    this->RoofActor = this->Add(this->Roof);
    this->Show(things);
  }

  void Show(const ThingsOnGround& things)
  {
    for (std::size_t i = 0; i < things.Balls.size(); ++i)
    {
      const ThingsOnGround::Ball& ball = things.Balls[i];
      this->Spheres[i]->SetCenter(ball.Centre[0], ball.Centre[1], ball.Centre[2]);
      this->Actors[i]->SetVisibility(ball.IsVisible);
    }
    this->RoofActor->SetVisibility(things.HasRoof);
    this->Sun->SetRadiance(things.Radiance, things.Radiance, things.Radiance);
  }

  vtkNew<vtkPlaneSource> Roof;
  std::vector<vtkSmartPointer<vtkSphereSource>> Spheres;
  std::vector<vtkSmartPointer<vtkActor>> Actors;
  vtkSmartPointer<vtkActor> RoofActor;
};

int GetBrightness(const std::array<unsigned char, 3>& pixel)
{
  return pixel[0] + pixel[1] + pixel[2];
}

} // namespace

TEST(LargeGrounds, AShadowLooksAsOnASmallGround)
{
  GroundView small(5.0);
  const PassScene::Pixels right = small.Render();
  small.SetShadows(false);
  const std::size_t shadow = CountDifferences(right, small.Render());
  ASSERT_GT(shadow, 1000u);
  for (const double halfSide : { 50.0, 250.0, 2000.0 })
  {
    GroundView large(halfSide);
    const PassScene::Pixels shown = large.Render();
    // A pixel is as large as a texel of the small ground, 2 cm: the edge, 3.7 m long, may lie in
    // another one, or one more beside it, by the reconstruction. A third of full brightness tells
    // the shadow from the ground.
    std::size_t other = 0;
    for (std::size_t i = 0; i < right.size(); ++i)
    {
      other += std::abs(GetBrightness(right[i]) - GetBrightness(shown[i])) > 255 ? 1 : 0;
    }
    EXPECT_LT(other, 2u * 185u) << "ground of " << 2.0 * halfSide << ", shadow of " << shadow;
  }
}

TEST(LargeGrounds, TheViewGivesTheTexelsOfTheData)
{
  GroundView view(250.0);
  view.Render();
  const vtkSmartPointer<vtkFloatArray> shown = view.Pass->GetTexels(0);
  EXPECT_EQ(view.Pass->GetNumberOfReceivers(), 1);
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, view.Receiver->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, view.Sun->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::OCCLUDERS, view.Ball->GetOutputPort());
  map->Update();
  auto* output =
    vtkMultiBlockDataSet::SafeDownCast(map->GetOutputDataObject(vtkRadianceMap::RADIANCE));
  ASSERT_EQ(output->GetNumberOfBlocks(), 1u);
  auto* radiance = vtkFloatArray::SafeDownCast(
    vtkStructuredGrid::SafeDownCast(output->GetBlock(0))->GetCellData()->GetArray("Radiance"));
  ASSERT_EQ(radiance->GetNumberOfTuples(), shown->GetNumberOfTuples());
  for (vtkIdType i = 0; i < shown->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_EQ(radiance->GetTypedComponent(i, c), shown->GetTypedComponent(i, c))
        << "texel " << i << ", component " << c;
    }
  }
}

TEST(LargeGrounds, AMovedBallIsShownAsInAFreshView)
{
  GroundView moved(250.0);
  moved.Render();
  for (const double x : { 0.7, -0.4, -0.4003 })
  {
    moved.Ball->SetCenter(x, 0.3, 0.5);
    GroundView fresh(250.0);
    fresh.Ball->SetCenter(x, 0.3, 0.5);
    EXPECT_EQ(CountDifferences(moved.Render(), fresh.Render()), 0u) << "ball at " << x;
  }
}

// Windows come, go, merge and divide: those that stay are copied, and no edit shows in their
// texels.
TEST(LargeGrounds, EditsAreShownAsInAFreshView)
{
  constexpr int Balls = 8, Edits = 24;
  RandomGeometry random(20);
  ThingsOnGround things;
  things.Balls.resize(Balls);
  const auto move = [&](ThingsOnGround::Ball& ball)
  {
    ball.Centre = { random.Between(-7.0, 7.0), random.Between(-7.0, 7.0),
      random.Between(0.2, 2.0) };
  };
  for (ThingsOnGround::Ball& ball : things.Balls)
  {
    move(ball);
  }
  ThingsView edited(things);
  edited.Render();
  for (int edit = 0; edit < Edits; ++edit)
  {
    ThingsOnGround::Ball& ball = things.Balls[static_cast<std::size_t>(random.Below(Balls))];
    const int kind = static_cast<int>(random.Below(8));
    if (kind < 4)
    {
      move(ball);
    }
    else if (kind < 6)
    {
      ball.IsVisible = !ball.IsVisible;
    }
    else if (kind == 6)
    {
      things.HasRoof = !things.HasRoof;
    }
    else
    {
      things.Radiance = random.Between(0.5, 2.0);
    }
    edited.Show(things);
    const PassScene::Pixels shown = edited.Render();
    ThingsView fresh(things);
    EXPECT_EQ(CountDifferences(shown, fresh.Render()), 0u) << "edit " << edit << ", kind " << kind;
  }
}

TEST(LargeGrounds, ABallHasItsShadowOnGroundsOfEachSize)
{
  for (const double side : { 10.0, 30.0, 100.0, 500.0, 2000.0, 20000.0 })
  {
    GroundScene ground;
    AddBall({ 0, 0, 0.5 }, 0.5, ground.Things.front());
    ground.SetBase({ 0, 0 }, glm::dvec2(side), 0.0);
    ground.SetSun(std::atan(1.2), 0.0);
    ExpectArea(
      ground, GetShadowArea(ground.Things.front(), ground.Source, ground.Diameter), "ball");
  }
}

TEST(LargeGrounds, ShadowsHaveTheAreaOfGeometry)
{
  constexpr unsigned Scenes = 48;
  for (unsigned seed = 0; seed < Scenes; ++seed)
  {
    RandomGeometry random(seed);
    GroundScene ground;
    const std::string what = AddThing(seed, random, ground.Things.front());
    const double side = 30.0 * std::pow(10.0, random.Between(0.0, 2.8));
    const glm::dvec2 lengths(side, std::max(side * random.Between(0.01, 1.0), 30.0));
    // Somewhere on it, where all of the shadow falls on it.
    const glm::dvec2 room = 0.5 * (lengths - 26.0);
    const double angle = random.Below(3) == 0 ? 0.0 : random.Between(0.0, 3.0);
    const glm::dvec2 at(random.Between(-room.x, room.x), random.Between(-room.y, room.y));
    ground.SetBase({ std::cos(angle) * at.x - std::sin(angle) * at.y,
                     std::sin(angle) * at.x + std::cos(angle) * at.y },
      lengths, angle);
    ground.SetSun(
      random.Between(0.5, 1.5), random.Below(3) == 0 ? Pi / 4 : random.Between(0.0, 6.0));
    ground.Diameter = random.Below(2) == 0 ? 0.53 : random.Between(0.0, 12.0);
    ExpectArea(ground, GetShadowArea(ground.Things.front(), ground.Source, ground.Diameter),
      what + ", seed " + std::to_string(seed));
  }
}

TEST(LargeGrounds, ThingsOfOneSurfaceHaveAShadowEach)
{
  // Bollards along a road; in rows on a square; so many that windows are merged.
  const struct
  {
    glm::ivec2 Count;
    double Step;
    glm::dvec2 Lengths;
  } fields[] = { { { 40, 1 }, 50.0, { 2000.0, 7.0 } }, { { 8, 8 }, 100.0, { 1000.0, 1000.0 } },
    { { 36, 36 }, 40.0, { 1500.0, 1500.0 } } };
  for (const auto& field : fields)
  {
    GroundScene ground;
    constexpr double Width = 0.3, Height = 2.0;
    double right = 0.0;
    for (int i = 0; i < field.Count.x * field.Count.y; ++i)
    {
      const glm::dvec2 at = field.Step *
          (glm::dvec2(i % field.Count.x, i / field.Count.x) - 0.5 * glm::dvec2(field.Count - 1)) +
        glm::dvec2(0.3 * (i % 7), -1.5);
      AddBox({ at - 0.5 * Width, 0.0 }, { at + 0.5 * Width, Height }, ground.Things.front());
      right += Width * (Width + Height);
    }
    ground.SetBase({ 0, 0 }, field.Lengths, 0.0);
    ground.SetSun(Pi / 4, -Pi / 2);
    ExpectArea(ground, right, std::to_string(field.Count.x * field.Count.y) + " bollards");
  }
}

TEST(LargeGrounds, ALargeShadowBesideASmallOneKeepsBoth)
{
  // The ball's shadow is 5 m from the box's, in a corner of the rectangle around that.
  GroundScene ground;
  AddBox({ -60, -60, 0 }, { 60, 60, 20 }, ground.Things.front());
  ground.SetBase({ 0, 0 }, glm::dvec2(500.0), 0.2);
  ground.SetSun(1.1, Pi / 4 + 0.05);
  const ShadowScene alone = ground.Make();
  ground.Things.emplace_back();
  AddBall({ -66.0, 62.0, 0.6 }, 0.6, ground.Things.back());
  const ShadowScene both = ground.Make();
  const double with = SumShadow(both, BakeReceiver(both).Texels.Irradiance);
  const double without = SumShadow(alone, BakeReceiver(alone).Texels.Irradiance);
  const double right = GetShadowArea(ground.Things.back(), ground.Source, ground.Diameter);
  EXPECT_NEAR(with - without, right, AllowedShare * right)
    << "with the ball " << with << ", without " << without;
}

TEST(LargeGrounds, TexelsOfASizeAreSamplesOfTheirCentres)
{
  GroundScene ground;
  AddBall({ 0, 0, 0.5 }, 0.5, ground.Things.front());
  ground.SetBase({ 0, 0 }, glm::dvec2(500.0), 0.0);
  ShadowScene scene = ground.Make();
  EXPECT_TRUE(scene.Receivers.front().IsAutomatic);
  scene.Receivers.front().Settings.TexelSize = 500.0 / 512.0;
  scene.ChooseTexels(0);
  EXPECT_FALSE(scene.Receivers.front().IsAutomatic);
  EXPECT_EQ(scene.Receivers.front().Texels, glm::ivec2(512));
  penumbra::OccluderSelector occluders;
  occluders.SetScene(scene);
  EXPECT_TRUE(PlanReceiver(scene, scene.Receivers.front(), occluders).Fine.Windows.empty());
}

TEST(LargeGrounds, WhatChangesIsBakedAsAWhole)
{
  // A ball beside others goes, comes and moves, with drafts and tiles between: each time the texels
  // are those of a whole bake, to the bit.
  vtkOpenGLRenderWindow* window = GetTestWindow();
  vtkNew<vtkBakedProp> prop;
  vtkNew<vtkRadianceBaker> baker;
  RandomGeometry random(7);
  GroundScene ground;
  ground.SetBase({ 0, 0 }, glm::dvec2(300.0), 0.3);
  ground.SetSun(0.9, 0.4);
  ShadowScene scene = ground.Make();
  scene.Surfaces.pop_back();
  const auto makeBall = [&]
  {
    Surface ball;
    AddBall({ random.Between(-90, 90), random.Between(-90, 90), 0.7 }, 0.6, ball);
    return penumbra::SharedSurface(ball);
  };
  scene.Surfaces.push_back(makeBall());
  for (int step = 0; step < 14; ++step)
  {
    const std::size_t chosen = 1 + random.Below(scene.Surfaces.size() - 1);
    if (step % 3 == 0)
    {
      scene.Surfaces.push_back(makeBall());
    }
    else if (step % 3 == 1)
    {
      scene.Surfaces[chosen] = makeBall();
    }
    else
    {
      scene.Surfaces.erase(scene.Surfaces.begin() + static_cast<std::ptrdiff_t>(chosen));
    }
    const bool isDraft = step % 2 == 1;
    window->GetState()->Push();
    baker->SetScene(scene);
    const std::vector<penumbra::ReceiverPlan> plans{ baker->Plan(0) };
    ASSERT_NE(prop->Update(baker, scene, { 0 }, plans, window, false, isDraft),
      vtkBakedProp::Outcome::Failed);
    for (int batch = 0; batch < 1000 && prop->CountDraftTexels() > 0.0; ++batch)
    {
      ASSERT_NE(prop->Finish(baker, step % 4 == 1 ? 0.0 : 0.01), vtkBakedProp::Outcome::Failed);
    }
    window->GetState()->Pop();
    EXPECT_EQ(prop->CountDraftTexels(), 0.0);
    const std::vector<glm::vec4> shown = prop->Download(scene, 0, window);
    const std::vector<glm::vec4> whole = BakeReceiver(scene).Texels.Irradiance;
    ASSERT_EQ(shown.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
      ASSERT_EQ(shown[i], whole[i])
        << "texel " << i << " after step " << step << ": shown " << shown[i].r << ", " << shown[i].a
        << "; whole " << whole[i].r << ", " << whole[i].a;
    }
  }
  prop->ReleaseGraphicsResources();
  baker->ReleaseGraphicsResources();
}

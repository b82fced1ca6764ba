// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Curved and faceted receivers by a plane (H&H 1997, figure 5), as the pass shows them and the map
// bakes them: where a ray from the light through a point of the surface passes the occluder, the
// point is dark.

#include "OracleTestTools.h"
#include "PassScene.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataGroupFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRadianceMap.h"
#include "vtkStructuredGrid.h"
#include "vtkTrivialProducer.h"
#include "vtkVersionMacros.h"
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#include "vtkCompositePolyDataMapper2.h"
#else
#include "vtkCompositePolyDataMapper.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace
{

#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0) // the two became one
using CompositeMapper = vtkCompositePolyDataMapper2;
#else
using CompositeMapper = vtkCompositePolyDataMapper;
#endif

using oracle::Vec3;
using oracletest::Occluders;

constexpr double TexelSize = 0.05;
// A pixel's bilinear look-up takes texels whose centres are within a texel of its place, along each
// axis. Each is wholly dark or wholly lit: the light is a point. On the occluder, which is nearer
// to the light than the plane is, all that is smaller. The thousandth is for the rasteriser, which
// decides within 1/256 of a texel, and for the rounding of floats.
const long double Blur = std::sqrt(2.0L) * TexelSize + 1e-3L;

const Vec3 Lamp{ 0.9L, 0.5L, 3.0L };

/// A horizontal rectangle that hovers over the floor.
struct Plate
{
  long double X0 = -0.6L, X1 = 0.5L, Y0 = -0.5L, Y1 = 0.4L, Z = 1.2L;

  /// Where the ray from the lamp through the point passes the plate: how far inside its outline,
  /// negative outside.
  long double GetDepth(const Vec3& point) const
  {
    const long double t = (Lamp.Z - this->Z) / (Lamp.Z - point.Z);
    const Vec3 q = Lamp + t * (point - Lamp);
    return std::min({ q.X - this->X0, this->X1 - q.X, q.Y - this->Y0, this->Y1 - q.Y });
  }
  Occluders GetTriangles() const
  {
    const Vec3 a{ this->X0, this->Y0, this->Z }, b{ this->X1, this->Y0, this->Z },
      c{ this->X1, this->Y1, this->Z }, d{ this->X0, this->Y1, this->Z };
    return { { a, b, c }, { a, c, d } };
  }
};

/// A bowl of 16 x 16 cells over [-2, 2]^2.
Occluders Bowl()
{
  constexpr int Side = 16;
  const auto point = [](int i, int j)
  {
    const long double x = 4.0L * i / Side - 2.0L, y = 4.0L * j / Side - 2.0L;
    return Vec3{ x, y, 0.15L * (x * x + y * y) };
  };
  Occluders triangles;
  for (int i = 0; i < Side; ++i)
  {
    for (int j = 0; j < Side; ++j)
    {
      triangles.push_back({ point(i, j), point(i + 1, j), point(i + 1, j + 1) });
      triangles.push_back({ point(i, j), point(i + 1, j + 1), point(i, j + 1) });
    }
  }
  return triangles;
}

/// What a line in the plane y = 0 sweeps over from y = -2 to 2: its points are (x, z).
Occluders Extrude(const std::vector<std::array<long double, 2>>& outline)
{
  Occluders triangles;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
  {
    const auto& [x0, z0] = outline[i];
    const auto& [x1, z1] = outline[i + 1];
    const Vec3 a{ x0, -2, z0 }, b{ x1, -2, z1 }, c{ x1, 2, z1 }, d{ x0, 2, z0 };
    triangles.push_back({ a, b, c });
    triangles.push_back({ a, c, d });
  }
  return triangles;
}

/// Three steps along x, with what is upright between them.
Occluders Stairs()
{
  return Extrude({ { -2, 0.4L }, { -1, 0.4L }, { -1, 0.2L }, { 0, 0.2L }, { 0, 0 }, { 2, 0 } });
}

vtkSmartPointer<vtkTrivialProducer> MakeSurface(const Occluders& triangles)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const oracle::Triangle& triangle : triangles)
  {
    cells->InsertNextCell(3);
    for (const Vec3& p : { triangle.A, triangle.B, triangle.C })
    {
      cells->InsertCellPoint(points->InsertNextPoint(
        static_cast<double>(p.X), static_cast<double>(p.Y), static_cast<double>(p.Z)));
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  auto producer = vtkSmartPointer<vtkTrivialProducer>::New();
  producer->SetOutput(data);
  return producer;
}

/// A floor that receives by a proxy plane, the plate over it and the lamp, seen from one side.
class ProxyScene : public PassScene
{
public:
  explicit ProxyScene(const Occluders& floor)
    : PassScene(240, 200)
    , Floor(floor)
  {
    this->Receiver->SetInputConnection(MakeSurface(floor)->GetOutputPort());
    this->Receiver->SetTexelSize(TexelSize);
    this->Receiver->ProxyPlaneOn();
    this->FloorActor = this->Add(this->Receiver);
    this->PlateActor = this->Add(MakeSurface(this->Occluder.GetTriangles()));
    this->Light->SetShape(vtkAreaLightSource::POINT);
    const double lamp[3] = { 0.9, 0.5, 3.0 };
    this->Light->SetOrigin(lamp);
    this->LightActor = this->Add(this->Light);
    this->LightActor->GetProperty()->SetOpacity(0.0);
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(-2.0, -5.0, 7.0);
    camera->SetFocalPoint(-0.4, -0.2, 0.0);
    camera->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCameraClippingRange();
  }

  /// The point of the floor that a pixel shows; none if it shows anything else.
  std::optional<Vec3> FindPoint(int x, int y)
  {
    const auto [eye, ray] = this->GetRay(x, y);
    const auto floor = FindHit(this->Floor, eye, ray);
    const auto plate = FindHit(this->Occluder.GetTriangles(), eye, ray);
    const bool isFloor = floor && !(plate && *plate < *floor);
    return isFloor ? std::optional<Vec3>(eye + *floor * ray) : std::nullopt;
  }

  Occluders Floor;
  Plate Occluder;
  vtkNew<vtkShadowReceiver> Receiver;
  vtkNew<vtkAreaLightSource> Light;
  vtkSmartPointer<vtkActor> FloorActor, PlateActor, LightActor;

private:
  static Vec3 ToVec3(const double v[3]) { return { v[0], v[1], v[2] }; }
  static Vec3 Unit(const Vec3& v) { return (1.0L / std::sqrt(oracle::Dot(v, v))) * v; }

  /// The ray through the centre of a pixel.
  std::pair<Vec3, Vec3> GetRay(int x, int y)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    const int* size = this->Window->GetSize();
    const Vec3 eye = ToVec3(camera->GetPosition());
    const Vec3 forward = Unit(ToVec3(camera->GetFocalPoint()) - eye);
    const Vec3 right = Unit(oracle::Cross(forward, ToVec3(camera->GetViewUp())));
    const Vec3 up = oracle::Cross(right, forward);
    const long double half =
      std::tan(static_cast<long double>(camera->GetViewAngle()) * oracletest::Pi / 360);
    const long double across = half * (2 * (x + 0.5L) - size[0]) / size[1];
    const long double along = half * (2 * (y + 0.5L) - size[1]) / size[1];
    return { eye, forward + across * right + along * up };
  }

  /// How far along the ray the first triangle is, in units of the ray.
  static std::optional<long double> FindHit(
    const Occluders& triangles, const Vec3& eye, const Vec3& ray)
  {
    std::optional<long double> nearest;
    for (const oracle::Triangle& triangle : triangles)
    {
      if (oracletest::Blocks(triangle, eye, eye + 100.0L * ray))
      {
        const Vec3 n = oracle::Cross(triangle.B - triangle.A, triangle.C - triangle.A);
        const long double t = oracle::Dot(n, triangle.A - eye) / oracle::Dot(n, ray);
        nearest = nearest ? std::min(*nearest, t) : t;
      }
    }
    return nearest;
  }
};

/// What a pixel must be: -1 undecided, 0 dark, 1 lit.
int Judge(const ProxyScene& scene, const std::optional<Vec3>& point)
{
  const long double depth = point ? scene.Occluder.GetDepth(*point) : 0.0L;
  return std::abs(depth) <= Blur ? -1 : depth < 0.0L ? 1 : 0;
}

/// The same where blocks along x shade each other, by rays around the point: all must agree.
int JudgeAmongBlocks(
  const ProxyScene& scene, const std::vector<Occluders>& blocks, const Vec3& point)
{
  Occluders occluders = scene.Occluder.GetTriangles();
  const std::size_t own = point.X < -0.82L ? 0 : point.X > 0.3L ? 2 : 1;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    if (i != own)
    {
      occluders.insert(occluders.end(), blocks[i].begin(), blocks[i].end());
    }
  }
  const bool isDark = oracletest::Blocks(occluders, point, Lamp);
  for (int i = 0; i < 8; ++i)
  {
    const long double angle = oracletest::Pi * i / 4;
    const Vec3 offset{ Blur * std::cos(angle), Blur * std::sin(angle), 0.0L };
    if (oracletest::Blocks(occluders, point + offset, Lamp) != isDark)
    {
      return -1;
    }
  }
  return isDark ? 0 : 1;
}

/// What the pixel would be if the point's foot on the plane z = 0 were looked up.
int JudgeFoot(const ProxyScene& scene, std::optional<Vec3> point)
{
  if (point)
  {
    point->Z = 0.0L;
  }
  return Judge(scene, point);
}

/// Compares all pixels, whose neighbours are decided as they are, with the rays; the answer is how
/// many there were.
template <typename Judgement>
void ExpectShadowsByRays(
  ProxyScene& scene, const Judgement& judge, int& dark, int& lit, int& displaced)
{
  const PassScene::Pixels shadowed = scene.Render();
  scene.SetShadows(false);
  const PassScene::Pixels plain = scene.Render();
  const int width = scene.Window->GetSize()[0], height = scene.Window->GetSize()[1];
  std::vector<std::optional<Vec3>> points;
  std::vector<int> wanted;
  for (int i = 0; i < width * height; ++i)
  {
    points.push_back(scene.FindPoint(i % width, i / width));
    wanted.push_back(judge(points.back()));
  }
  dark = lit = displaced = 0;
  for (int y = 1; y + 1 < height; ++y)
  {
    for (int x = 1; x + 1 < width; ++x)
    {
      const auto at = [&](int dx, int dy)
      { return static_cast<std::size_t>((y + dy) * width + x + dx); };
      bool isDecided = wanted[at(0, 0)] >= 0;
      for (int n = 0; n < 9; ++n)
      {
        isDecided = isDecided && wanted[at(n % 3 - 1, n / 3 - 1)] == wanted[at(0, 0)];
      }
      if (isDecided)
      {
        const bool isLit = wanted[at(0, 0)] == 1;
        const int foot = JudgeFoot(scene, points[at(0, 0)]);
        ++(isLit ? lit : dark);
        displaced += foot >= 0 && foot != wanted[at(0, 0)] ? 1 : 0;
        // The diffuse shade is all there is; its factor has ten bits.
        const int shade = isLit ? plain[at(0, 0)][0] : 0;
        ASSERT_NEAR(shadowed[at(0, 0)][0], shade, 1) << x << ", " << y;
      }
    }
  }
}

void ExpectShadowsByRays(ProxyScene& scene, int& dark, int& lit, int& displaced)
{
  const auto judge = [&](const std::optional<Vec3>& point) { return Judge(scene, point); };
  ExpectShadowsByRays(scene, judge, dark, lit, displaced);
}

void ExpectManyPixels(int dark, int lit, int displaced)
{
  testing::Test::RecordProperty("Dark", dark);
  testing::Test::RecordProperty("Lit", lit);
  testing::Test::RecordProperty("Displaced", displaced);
  EXPECT_GT(dark, 1000);
  EXPECT_GT(lit, 10000);
  EXPECT_GT(displaced, 0) << "looking up the foot of a point would pass as well";
}

} // namespace

TEST(ProxyShadows, LieOnABowlWhereRaysSay)
{
  ProxyScene scene(Bowl());
  int dark, lit, displaced;
  ExpectShadowsByRays(scene, dark, lit, displaced);
  ExpectManyPixels(dark, lit, displaced);
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 1);
}

// Of an actor's several receivers, each pixel finds its own. The lower floor is in the proxy plane,
// within the rectangle that the steps are projected to; the upper step is in the upper floor's
// plane, and closer to it than to its own.
TEST(ProxyShadows, LieOnBlocksWhereRaysSay)
{
  const std::vector<Occluders> blocks{ Extrude({ { -2, 0 }, { -0.85L, 0 } }),
    Extrude({ { -0.8L, 0.6L }, { -0.3L, 0.6L }, { -0.3L, 0 }, { 0.2L, 0 } }),
    Extrude({ { 0.4L, 0.6L }, { 2, 0.6L } }) };
  Occluders all;
  vtkNew<vtkMultiBlockDataGroupFilter> group;
  for (const std::size_t i : { 1, 0, 2 }) // the steps come first
  {
    all.insert(all.end(), blocks[i].begin(), blocks[i].end());
    vtkNew<vtkShadowReceiver> receiver;
    receiver->SetInputConnection(MakeSurface(blocks[i])->GetOutputPort());
    receiver->SetTexelSize(TexelSize);
    receiver->ProxyPlaneOn();
    receiver->SetProxyPlaneMode(vtkShadowReceiver::GIVEN); // z = 0
    group->AddInputConnection(receiver->GetOutputPort());
  }
  ProxyScene scene(all);
  vtkNew<CompositeMapper> mapper;
  mapper->SetInputConnection(group->GetOutputPort());
  scene.FloorActor->SetMapper(mapper);
  const auto judge = [&](const std::optional<Vec3>& point)
  { return point ? JudgeAmongBlocks(scene, blocks, *point) : -1; };
  for (const bool isLit : { true, false })
  {
    scene.FloorActor->GetProperty()->SetLighting(isLit);
    scene.SetShadows(true);
    int dark, lit, displaced;
    ExpectShadowsByRays(scene, judge, dark, lit, displaced);
    EXPECT_GT(dark, 1000);
    EXPECT_GT(lit, 10000);
    EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 3);
  }
}

TEST(ProxyShadows, LieOnStairsWhereRaysSay)
{
  ProxyScene scene(Stairs());
  int dark, lit, displaced;
  ExpectShadowsByRays(scene, dark, lit, displaced);
  ExpectManyPixels(dark, lit, displaced);
}

// Without VTK's lights the shader does not know the position in the view: it starts from the
// screen.
TEST(ProxyShadows, LieOnUnlitActorsWhereRaysSay)
{
  ProxyScene scene(Bowl());
  scene.FloorActor->GetProperty()->LightingOff();
  int dark, lit, displaced;
  ExpectShadowsByRays(scene, dark, lit, displaced);
  ExpectManyPixels(dark, lit, displaced);
}

// The actor's matrix moves a given plane with the data: the picture of a scene that is turned as a
// whole is the same.
TEST(ProxyShadows, GivenPlanesMoveWithTheActor)
{
  ProxyScene scene(Bowl());
  scene.Receiver->SetProxyPlaneMode(vtkShadowReceiver::GIVEN);
  scene.Receiver->SetProxyOrigin(0.0, 0.0, -0.1);
  scene.Receiver->SetProxyNormal(0.1, 0.0, 1.0);
  const PassScene::Pixels before = scene.Render();
  for (vtkActor* actor : { scene.FloorActor, scene.PlateActor, scene.LightActor })
  {
    actor->RotateX(90.0);
    actor->AddPosition(3.0, 2.0, 1.0);
  }
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  const auto move = [](const double p[3], double offset, double result[3])
  {
    result[0] = p[0] + 3.0 * offset;
    result[1] = -p[2] + 2.0 * offset;
    result[2] = p[1] + 1.0 * offset;
  };
  double eye[3], focus[3], up[3];
  move(camera->GetPosition(), 1.0, eye);
  move(camera->GetFocalPoint(), 1.0, focus);
  move(camera->GetViewUp(), 0.0, up);
  camera->SetPosition(eye);
  camera->SetFocalPoint(focus);
  camera->SetViewUp(up);
  scene.Renderer->ResetCameraClippingRange();
  const PassScene::Pixels after = scene.Render();
  std::size_t differences = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
  {
    differences += std::abs(before[i][0] - after[i][0]) > 1 ? 1 : 0;
  }
  EXPECT_LE(differences, before.size() / 1000); // the camera's rounding, at edges
}

TEST(ProxyShadows, MapBakesThePlane)
{
  ProxyScene scene(Bowl());
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Receiver->GetOutputPort());
  map->AddInputConnection(
    vtkRadianceMap::OCCLUDERS, MakeSurface(scene.Occluder.GetTriangles())->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, scene.Light->GetOutputPort());
  map->Update();
  ASSERT_EQ(map->GetOutput()->GetNumberOfBlocks(), 1u);
  auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(0));
  auto* visibility = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Visibility"));
  int dark = 0;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    double bounds[6];
    grid->GetCellBounds(cell, bounds);
    // The lowest point of the bowl.
    ASSERT_NEAR(bounds[4], 0.0, 1e-12);
    ASSERT_NEAR(bounds[5], 0.0, 1e-12);
    const Vec3 centre{ (bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2, 0 };
    const long double depth = scene.Occluder.GetDepth(centre);
    if (std::abs(depth) > 1e-3L) // the rasteriser decides within 1/256 of a texel
    {
      ASSERT_EQ(visibility->GetValue(cell), depth > 0.0L ? 0.0f : 1.0f);
      dark += depth > 0.0L ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 300);
}

// Two bakes of the same scene, by the pass and by the map, to the same bits.
TEST(ProxyShadows, PassAndMapBakeTheSame)
{
  ProxyScene scene(Stairs());
  scene.Light->SetShape(vtkAreaLightSource::DISK);
  scene.Light->SetPoint1(1.2, 0.5, 3.0);
  scene.Light->SetPoint2(0.9, 0.2, 3.0);
  scene.Render();
  vtkNew<vtkRadianceMap> map;
  map->AddInputConnection(vtkRadianceMap::RECEIVERS, scene.Receiver->GetOutputPort());
  map->AddInputConnection(
    vtkRadianceMap::OCCLUDERS, MakeSurface(scene.Occluder.GetTriangles())->GetOutputPort());
  map->AddInputConnection(vtkRadianceMap::LIGHTS, scene.Light->GetOutputPort());
  map->Update();
  scene.Window->MakeCurrent();
  const vtkSmartPointer<vtkFloatArray> texels = scene.Pass->GetTexels(0);
  auto* grid = vtkStructuredGrid::SafeDownCast(map->GetOutput()->GetBlock(0));
  auto* radiance = vtkFloatArray::SafeDownCast(grid->GetCellData()->GetArray("Radiance"));
  ASSERT_EQ(texels->GetNumberOfTuples(), radiance->GetNumberOfTuples());
  for (vtkIdType i = 0; i < radiance->GetNumberOfTuples(); ++i)
  {
    ASSERT_EQ(texels->GetTypedComponent(i, 0), radiance->GetTypedComponent(i, 0));
  }
}

// No self-shadowing, as documented: without the plate all is lit, whatever stands out.
TEST(ProxyShadows, TheSurfaceDoesNotShadowItself)
{
  ProxyScene scene(Stairs());
  scene.PlateActor->VisibilityOff();
  const PassScene::Pixels shadowed = scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 1);
  scene.SetShadows(false);
  EXPECT_EQ(shadowed, scene.Render());
}

TEST(ProxyShadows, PlanarReceiversDoNotChange)
{
  PassScene::Pixels pictures[2];
  for (int i = 0; i < 2; ++i)
  {
    ProxyScene scene({ { { -2, -2, 0 }, { 2, -2, 0 }, { 2, 2, 0 } },
      { { -2, -2, 0 }, { 2, 2, 0 }, { -2, 2, 0 } } });
    scene.Receiver->SetProxyPlane(i == 1);
    pictures[i] = scene.Render();
    EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 1);
  }
  EXPECT_EQ(pictures[0], pictures[1]);
}

// Without the property, stairs are receivers of their own, upright parts and all.
TEST(ProxyShadows, FacetsAreReceiversOfTheirOwnWithoutIt)
{
  ProxyScene scene(Stairs());
  scene.Receiver->ProxyPlaneOff();
  scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 5);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Fronts go with their surfaces, as normals do, also where an actor's matrix mirrors them.

#include "vtkShadowFieldData.h"
#include "vtkShadowSceneBuilder.h"

#include "vtkCellArray.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{

const std::array<glm::dvec3, 4> Scales{ glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1),
  glm::dvec3(1, 2, -0.5), glm::dvec3(-3, -1, -2) };

/// Scales, then turns around the x axis.
vtkSmartPointer<vtkMatrix4x4> MakeMatrix(const glm::dvec3& scale)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  const double cosine = std::cos(0.4), sine = std::sin(0.4);
  const double rows[3][3] = { { 1, 0, 0 }, { 0, cosine, -sine }, { 0, sine, cosine } };
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      matrix->SetElement(i, j, rows[i][j] * scale[j]);
    }
  }
  return matrix;
}

/// Where the normal (0, 0, 1) goes: by the inverse transpose.
glm::dvec3 GetMovedNormal(const glm::dvec3& scale)
{
  const double side = scale.z < 0.0 ? -1.0 : 1.0;
  return side * glm::dvec3(0.0, -std::sin(0.4), std::cos(0.4));
}

vtkSmartPointer<vtkPolyData> MakeSquare()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(1, 1, 0);
  points->InsertNextPoint(0, 1, 0);
  vtkNew<vtkCellArray> polys;
  const vtkIdType ids[] = { 0, 1, 2, 3 };
  polys->InsertNextCell(4, ids);
  auto square = vtkSmartPointer<vtkPolyData>::New();
  square->SetPoints(points);
  square->SetPolys(polys);
  return square;
}

void ExpectNormal(const glm::dvec3& normal, const glm::dvec3& scale)
{
  EXPECT_NEAR(glm::length(normal - GetMovedNormal(scale)), 0.0, 1e-12)
    << "scale " << scale.x << ", " << scale.y << ", " << scale.z << ": normal " << normal.x << ", "
    << normal.y << ", " << normal.z;
}

} // namespace

TEST(MirroredActors, ReceiversKeepTheirFront)
{
  for (const glm::dvec3& scale : Scales)
  {
    const vtkSmartPointer<vtkPolyData> square = MakeSquare();
    penumbra::ReceiverSettings settings;
    settings.Side = penumbra::ReceiverSide::Front;
    vtkShadowFieldData::Write(settings, square->GetFieldData());
    vtkNew<vtkShadowSceneBuilder> builder;
    builder->AddData(square, MakeMatrix(scale), vtkShadowSceneBuilder::Receiver, "square");
    const penumbra::ShadowScene& scene = builder->GetScene();
    ASSERT_EQ(scene.Receivers.size(), 1u);
    ExpectNormal(scene.MakeFrame(scene.Receivers.front()).GetNormal(), scale);
  }
}

TEST(MirroredActors, LightsKeepTheirFront)
{
  for (const auto shape : { penumbra::LightKind::Parallelogram, penumbra::LightKind::Triangle,
         penumbra::LightKind::Disk, penumbra::LightKind::Surface })
  {
    for (const glm::dvec3& scale : Scales)
    {
      const vtkSmartPointer<vtkPolyData> square = MakeSquare();
      penumbra::LightSettings settings; // faces (0, 0, 1)
      settings.Shape = shape;
      vtkShadowFieldData::Write(settings, square->GetFieldData());
      vtkNew<vtkShadowSceneBuilder> builder;
      builder->AddData(square, MakeMatrix(scale), vtkShadowSceneBuilder::Light, "light");
      const penumbra::ShadowScene& scene = builder->GetScene();
      ASSERT_EQ(scene.Lights.size(), 1u);
      const glm::dvec3 middle = scene.Lights[0]->GetHull().Points.front();
      const glm::dvec3 normal = GetMovedNormal(scale);
      EXPECT_TRUE(scene.Lights[0]->Faces(middle + normal))
        << "shape " << static_cast<int>(shape) << ", scale " << scale.x << ", " << scale.y << ", "
        << scale.z;
      EXPECT_FALSE(scene.Lights[0]->Faces(middle - normal))
        << "shape " << static_cast<int>(shape) << ", scale " << scale.x << ", " << scale.y << ", "
        << scale.z;
    }
  }
}

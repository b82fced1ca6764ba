// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAreaLightSource.h"

#include "DiskLight.h"
#include "ShadowSettings.h"
#include "vtkCellArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkShadowFieldData.h"

#include <glm/gtc/type_ptr.hpp>

#include <string>
#include <vector>

vtkStandardNewMacro(vtkAreaLightSource);

namespace
{

/// A disk is shown with as many sides.
constexpr int DiskSides = 64;

/// The points of a light's outline, and where they belong: polygon, line or vertex.
void MakeOutline(const penumbra::LightSettings& settings, vtkPolyData* output)
{
  std::vector<glm::dvec3> outline;
  vtkNew<vtkCellArray> cells;
  switch (settings.Shape)
  {
    case penumbra::LightKind::Parallelogram:
      outline = { settings.Origin, settings.Point1,
        settings.Point1 + (settings.Point2 - settings.Origin), settings.Point2 };
      output->SetPolys(cells);
      break;
    case penumbra::LightKind::Triangle:
      outline = { settings.Origin, settings.Point1, settings.Point2 };
      output->SetPolys(cells);
      break;
    case penumbra::LightKind::Disk:
      outline = penumbra::DiskLight(settings.Origin,
        glm::cross(settings.Point1 - settings.Origin, settings.Point2 - settings.Origin),
        glm::length(settings.Point1 - settings.Origin))
                  .GetRim(DiskSides);
      output->SetPolys(cells);
      break;
    case penumbra::LightKind::Point:
      outline = { settings.Origin };
      output->SetVerts(cells);
      break;
    default:
      outline = { settings.Origin, settings.Point1 };
      output->SetLines(cells);
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  cells->InsertNextCell(static_cast<int>(outline.size()));
  for (const glm::dvec3& vertex : outline)
  {
    cells->InsertCellPoint(points->InsertNextPoint(vertex.x, vertex.y, vertex.z));
  }
  output->SetPoints(points);
}

} // namespace

vtkAreaLightSource::vtkAreaLightSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkAreaLightSource::~vtkAreaLightSource() = default;

int vtkAreaLightSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  penumbra::LightSettings settings;
  settings.Shape = static_cast<penumbra::LightKind>(this->Shape);
  settings.Origin = glm::make_vec3(this->Origin);
  settings.Point1 = glm::make_vec3(this->Point1);
  settings.Point2 = glm::make_vec3(this->Point2);
  settings.Radiance = glm::make_vec3(this->Radiance);
  settings.TwoSided = this->TwoSided;
  settings.AngularDiameter = this->AngularDiameter;
  const std::string problem = this->Shape > DIRECTIONAL
    ? "Shape is " + std::to_string(this->Shape) + "; allowed: 0 to 5"
    : settings.FindProblem();
  if (!problem.empty())
  {
    vtkErrorMacro("AreaLight: " << problem << ".");
    return 1; // with an empty output; the executive's own error would only repeat it
  }

  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  MakeOutline(settings, output);
  vtkShadowFieldData::Write(settings, output->GetFieldData());
  return 1;
}

void vtkAreaLightSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [&](const char* name, const double v[3])
  { os << indent << name << ": (" << v[0] << ", " << v[1] << ", " << v[2] << ")\n"; };
  os << indent << "Shape: " << this->Shape << "\n";
  print("Origin", this->Origin);
  print("Point1", this->Point1);
  print("Point2", this->Point2);
  print("Radiance", this->Radiance);
  os << indent << "TwoSided: " << this->TwoSided << "\n";
  os << indent << "AngularDiameter: " << this->AngularDiameter << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAreaLightSource.h"

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

vtkStandardNewMacro(vtkAreaLightSource);

vtkAreaLightSource::vtkAreaLightSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkAreaLightSource::~vtkAreaLightSource() = default;

int vtkAreaLightSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  penumbra::LightSettings settings;
  settings.Shape = static_cast<penumbra::LightShape>(this->Shape);
  settings.Origin = glm::make_vec3(this->Origin);
  settings.Point1 = glm::make_vec3(this->Point1);
  settings.Point2 = glm::make_vec3(this->Point2);
  settings.Radiance = glm::make_vec3(this->Radiance);
  settings.TwoSided = this->TwoSided;
  const std::string problem = settings.FindProblem();
  if (!problem.empty())
  {
    vtkErrorMacro("AreaLight: " << problem << ".");
    return 1; // with an empty output; the executive's own error would only repeat it
  }

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell(0);
  const penumbra::PolygonLight light = settings.MakeLight();
  for (const glm::dvec3& vertex : light.GetVertices())
  {
    polygons->InsertCellPoint(points->InsertNextPoint(vertex.x, vertex.y, vertex.z));
  }
  polygons->UpdateCellCount(static_cast<int>(points->GetNumberOfPoints()));
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  output->SetPoints(points);
  output->SetPolys(polygons);
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
}

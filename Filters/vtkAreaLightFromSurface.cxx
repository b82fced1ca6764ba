// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAreaLightFromSurface.h"

#include "PolyDataStructure.h"
#include "PolygonCells.h"
#include "ShadowSettings.h"
#include "SurfaceExtraction.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkShadowFieldData.h"
#include "vtkShadowSceneBuilder.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkAreaLightFromSurface);

namespace
{

/// The input's polygons, and its strips as triangles, with their cell data.
vtkSmartPointer<vtkPolyData> MakePolygons(vtkPolyData* input)
{
  auto polygons = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkIdList> origins;
  polygons->SetPoints(input->GetPoints());
  polygons->SetPolys(penumbra::JoinStrips(input, origins));
  polygons->GetCellData()->CopyAllocate(input->GetCellData(), origins->GetNumberOfIds());
  for (vtkIdType i = 0; i < origins->GetNumberOfIds(); ++i)
  {
    polygons->GetCellData()->CopyData(input->GetCellData(), origins->GetId(i), i);
  }
  return polygons;
}

/// VTK copies the values of all cell arrays, cell by cell.
std::string FindCountProblem(vtkPolyData* input)
{
  vtkCellData* cellData = input->GetCellData();
  for (int i = 0; i < cellData->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = cellData->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != input->GetNumberOfCells())
    {
      return "cell array '" + std::string(array->GetName() ? array->GetName() : "") + "' has " +
        std::to_string(array->GetNumberOfTuples()) + " values; allowed: one for each of the " +
        std::to_string(input->GetNumberOfCells()) + " cells";
    }
  }
  return "";
}

std::string FindArrayProblem(vtkDataArray* array, const std::string& name)
{
  if (!array)
  {
    return "RadianceArray is '" + name +
      "'; allowed: the name of a numeric cell array of the input";
  }
  const int components = array->GetNumberOfComponents();
  if (components != 1 && components != 3)
  {
    return "RadianceArray '" + name + "' has " + std::to_string(components) +
      " components; allowed: 1 or 3";
  }
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      const double value = array->GetComponent(i, c);
      if (!(value >= 0.0 && value <= penumbra::LightSettings::MaximumRadiance))
      {
        std::ostringstream text;
        text << "RadianceArray '" << name << "' is " << value << " at cell " << i
             << "; allowed: 0 to 1e30";
        return text.str();
      }
    }
  }
  return "";
}

} // namespace

vtkAreaLightFromSurface::vtkAreaLightFromSurface() = default;
vtkAreaLightFromSurface::~vtkAreaLightFromSurface() = default;

void vtkAreaLightFromSurface::SetRadianceArray(const std::string& name)
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, name.c_str());
}

std::string vtkAreaLightFromSurface::GetRadianceArray()
{
  const char* name = this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  return name ? name : "";
}

int vtkAreaLightFromSurface::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  penumbra::LightSettings settings;
  settings.Shape = penumbra::LightKind::Surface;
  settings.Radiance = glm::make_vec3(this->Radiance);
  settings.TwoSided = this->TwoSided;
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  const std::string name = this->GetRadianceArray();
  const bool hasArray = !name.empty() && name != "None";
  std::string problem = settings.FindProblem();
  if (problem.empty())
  {
    problem = penumbra::FindStructureProblem(input);
  }
  if (problem.empty())
  {
    problem = FindCountProblem(input);
  }
  if (problem.empty() && hasArray)
  {
    problem = FindArrayProblem(input->GetCellData()->GetArray(name.c_str()), name);
  }
  vtkSmartPointer<vtkPolyData> polygons;
  if (problem.empty())
  {
    polygons = MakePolygons(penumbra::WithoutHiddenCells(input));
    vtkDataArray* array = hasArray ? polygons->GetCellData()->GetArray(name.c_str()) : nullptr;
    vtkNew<vtkDoubleArray> radiance;
    radiance->SetName(vtkShadowFieldData::GetRadianceArrayName());
    radiance->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < polygons->GetNumberOfPolys(); ++i)
    {
      const int last = array ? array->GetNumberOfComponents() - 1 : 0;
      const auto get = [&](int c)
      { return array ? array->GetComponent(i, std::min(c, last)) : 1.0; };
      radiance->InsertNextTuple3(get(0), get(1), get(2));
    }
    polygons->GetCellData()->AddArray(radiance);
    problem = vtkShadowSceneBuilder::FindSurfaceLightProblem(polygons, settings);
  }
  if (!problem.empty())
  {
    vtkErrorMacro("AreaLightFromSurface: " << problem << ".");
    output->Initialize(); // the executive has passed on what made a light of the input
    return 1;             // its own error would only repeat this one
  }
  output->ShallowCopy(polygons);
  vtkShadowFieldData::Write(settings, output->GetFieldData());
  return 1;
}

void vtkAreaLightFromSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RadianceArray: " << this->GetRadianceArray() << "\n";
  os << indent << "Radiance: (" << this->Radiance[0] << ", " << this->Radiance[1] << ", "
     << this->Radiance[2] << ")\n";
  os << indent << "TwoSided: " << this->TwoSided << "\n";
}

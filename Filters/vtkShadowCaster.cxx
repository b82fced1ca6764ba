// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShadowCaster.h"

#include "PolyDataStructure.h"
#include "ShadowSettings.h"
#include "SurfaceExtraction.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkShadowFieldData.h"
#include "vtkSmartPointer.h"

#include <glm/gtc/type_ptr.hpp>

vtkStandardNewMacro(vtkShadowCaster);

namespace
{

/// A shallow copy with the settings, without hidden cells of polygons: where ParaView leaves them
/// out of what it draws, it leaves out the settings, too.
vtkSmartPointer<vtkDataObject> MakeCaster(
  vtkDataObject* data, const penumbra::CasterSettings& settings)
{
  auto copy = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
  auto* polygons = vtkPolyData::SafeDownCast(data);
  const bool isSound = polygons && penumbra::FindStructureProblem(polygons).empty();
  copy->ShallowCopy(isSound ? penumbra::WithoutHiddenCells(polygons) : data);
  vtkShadowFieldData::Write(settings, copy->GetFieldData());
  return copy;
}

} // namespace

vtkShadowCaster::vtkShadowCaster() = default;
vtkShadowCaster::~vtkShadowCaster() = default;

int vtkShadowCaster::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkShadowCaster::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  penumbra::CasterSettings settings;
  settings.CastShadow = this->CastShadow;
  if (this->UseTransmittance)
  {
    settings.Transmittance = glm::make_vec3(this->Transmittance);
  }
  const std::string problem = settings.FindProblem();
  if (!problem.empty())
  {
    vtkErrorMacro("ShadowCaster: " << problem << ".");
    settings.Transmittance.reset();
  }
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    output->ShallowCopy(MakeCaster(input, settings));
    return 1;
  }
  auto* copies = vtkCompositeDataSet::SafeDownCast(output);
  copies->CopyStructure(composite);
  copies->GetFieldData()->ShallowCopy(composite->GetFieldData());
  vtkSmartPointer<vtkCompositeDataIterator> it;
  it.TakeReference(composite->NewIterator());
  for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
  {
    copies->SetDataSet(it, MakeCaster(it->GetCurrentDataObject(), settings));
  }
  return 1;
}

void vtkShadowCaster::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const double* t = this->Transmittance;
  os << indent << "CastShadow: " << this->CastShadow << "\n";
  os << indent << "UseTransmittance: " << this->UseTransmittance << "\n";
  os << indent << "Transmittance: (" << t[0] << ", " << t[1] << ", " << t[2] << ")\n";
}

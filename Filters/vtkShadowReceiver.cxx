// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShadowReceiver.h"

#include "PolyDataStructure.h"
#include "ShadowSettings.h"
#include "SurfaceExtraction.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkShadowFieldData.h"
#include "vtkShadowSceneBuilder.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <glm/gtc/type_ptr.hpp>

vtkStandardNewMacro(vtkShadowReceiver);

vtkShadowReceiver::vtkShadowReceiver() = default;
vtkShadowReceiver::~vtkShadowReceiver() = default;

int vtkShadowReceiver::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkSmartPointer<vtkPolyData> input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  const std::string structure = penumbra::FindStructureProblem(input);
  if (!structure.empty())
  {
    // VTK could not draw it either: the output stays empty, but for what was said of it.
    vtkErrorMacro("ShadowReceiver: " << structure << ".");
    vtkShadowFieldData::WriteRefusal(structure, output->GetFieldData());
    return 1;
  }
  // ParaView would leave hidden cells out only of what it draws, and the settings with them.
  input = penumbra::WithoutHiddenCells(input);
  output->ShallowCopy(input);

  penumbra::ReceiverSettings settings;
  settings.TexelSize = this->TexelSize;
  settings.LightSamples = this->LightSamples;
  settings.SampleMultiplier = this->SampleMultiplier;
  settings.SamplingPattern = this->SamplingPattern;
  settings.Supersampling = this->Supersampling;
  settings.Reflectance = glm::make_vec3(this->Reflectance);
  settings.AmbientRadiance = glm::make_vec3(this->AmbientRadiance);
  settings.Side = static_cast<penumbra::ReceiverSide>(this->Side);
  settings.Seed = this->Seed;
  settings.SolidAnglePerSample = this->SolidAnglePerSample;
  settings.ErrorTolerance = this->ErrorTolerance;
  settings.MaximumLightSamples = this->MaximumLightSamples;
  settings.Reconstruction = this->Reconstruction;
  settings.ExactShares = this->ExactShares;
  settings.Planner = this->Planner;
  settings.PlannerTolerance = this->PlannerTolerance;
  settings.HardPenumbra = this->HardPenumbra;
  settings.PlanarityTolerance = this->PlanarityTolerance;
  settings.ProxyPlane = this->ProxyPlane;
  settings.ProxyMode = static_cast<penumbra::ProxyPlaneMode>(this->ProxyPlaneMode);
  settings.ProxyOrigin = glm::make_vec3(this->ProxyOrigin);
  settings.ProxyNormal = glm::make_vec3(this->ProxyNormal);
  penumbra::CasterSettings caster;
  caster.CastShadow = this->CastShadow;
  vtkFieldData* fieldData = output->GetFieldData();
  vtkShadowFieldData::Write(
    vtkShadowFieldData::ReadCaster(fieldData).Overridden(caster), fieldData);
  // Of data that are spread over processes, some may hold nothing.
  const int pieces = outputVector->GetInformationObject(0)->Get(
    vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES());
  if (pieces > 1 && input->GetNumberOfCells() == 0)
  {
    vtkShadowFieldData::WriteRefusal("this process holds none of it", fieldData);
    return 1;
  }
  const std::string problem = vtkShadowSceneBuilder::FindReceiverProblem(input, settings);
  if (!problem.empty())
  {
    vtkErrorMacro("ShadowReceiver: " << problem << ".");
    vtkShadowFieldData::WriteRefusal(problem, fieldData);
    return 1; // the input goes on, to be drawn plain
  }
  vtkShadowFieldData::Write(settings, fieldData);
  return 1;
}

void vtkShadowReceiver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [&](const char* name, const double v[3])
  { os << indent << name << ": (" << v[0] << ", " << v[1] << ", " << v[2] << ")\n"; };
  os << indent << "TexelSize: " << this->TexelSize << "\n";
  os << indent << "LightSamples: " << this->LightSamples << "\n";
  os << indent << "SampleMultiplier: " << this->SampleMultiplier << "\n";
  os << indent << "SamplingPattern: " << this->SamplingPattern << "\n";
  os << indent << "Supersampling: " << this->Supersampling << "\n";
  print("Reflectance", this->Reflectance);
  print("AmbientRadiance", this->AmbientRadiance);
  os << indent << "Side: " << this->Side << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "SolidAnglePerSample: " << this->SolidAnglePerSample << "\n";
  os << indent << "ErrorTolerance: " << this->ErrorTolerance << "\n";
  os << indent << "MaximumLightSamples: " << this->MaximumLightSamples << "\n";
  os << indent << "Reconstruction: " << this->Reconstruction << "\n";
  os << indent << "ExactShares: " << this->ExactShares << "\n";
  os << indent << "Planner: " << this->Planner << "\n";
  os << indent << "PlannerTolerance: " << this->PlannerTolerance << "\n";
  os << indent << "HardPenumbra: " << this->HardPenumbra << "\n";
  os << indent << "PlanarityTolerance: " << this->PlanarityTolerance << "\n";
  os << indent << "ProxyPlane: " << this->ProxyPlane << "\n";
  os << indent << "ProxyPlaneMode: " << this->ProxyPlaneMode << "\n";
  print("ProxyOrigin", this->ProxyOrigin);
  print("ProxyNormal", this->ProxyNormal);
  os << indent << "CastShadow: " << this->CastShadow << "\n";
}

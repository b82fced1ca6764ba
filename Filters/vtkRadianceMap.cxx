// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRadianceMap.h"

#include "PlanTable.h"
#include "SurfaceExtraction.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkHeadlessFactory.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkPoints.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkShadowSceneBuilder.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkStructuredGrid.h"
#include "vtkTable.h"

#include <cmath>
#include <string>

vtkStandardNewMacro(vtkRadianceMap);

namespace
{

/// The corners of the texels.
void AddPoints(const penumbra::Receiver& receiver, vtkStructuredGrid* grid)
{
  const glm::ivec2 texels = receiver.GetDataTexels();
  const penumbra::Parallelogram base = receiver.GetDataBase();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(
    (static_cast<vtkIdType>(texels.x) + 1) * (static_cast<vtkIdType>(texels.y) + 1));
  vtkIdType id = 0;
  for (int j = 0; j <= texels.y; ++j)
  {
    for (int i = 0; i <= texels.x; ++i)
    {
      const double u = static_cast<double>(i) / texels.x;
      const double v = static_cast<double>(j) / texels.y;
      const glm::dvec3 point = base.Corner + u * base.EdgeX + v * base.EdgeY;
      points->SetPoint(id++, &point.x);
    }
  }
  grid->SetDimensions(texels.x + 1, texels.y + 1, 1);
  grid->SetPoints(points);
}

vtkNew<vtkFloatArray> MakeArray(const char* name, int components, vtkIdType tuples)
{
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// The texels as cell arrays.
void AddCells(const penumbra::Receiver& receiver, const vtkRadianceTexture::Texels& texels,
  vtkStructuredGrid* grid)
{
  const auto count = static_cast<vtkIdType>(texels.Irradiance.size());
  const vtkNew<vtkFloatArray> radiance = MakeArray("Radiance", 3, count);
  const vtkNew<vtkFloatArray> visibility = MakeArray("Visibility", 1, count);
  const vtkNew<vtkFloatArray> error = MakeArray("ErrorEstimate", 1, count);
  const glm::vec3 reflectance(receiver.Settings.Reflectance);
  const glm::vec3 ambient(receiver.Settings.AmbientRadiance);
  const glm::vec3 third(1.0f / 3.0f);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const std::size_t texel = receiver.GetTexelOfData(static_cast<std::size_t>(i));
    const glm::vec4& arriving = texels.Irradiance[texel];
    const glm::vec3 reflected = reflectance * (ambient + glm::vec3(arriving));
    radiance->SetTypedTuple(i, &reflected.x);
    const float seen = glm::dot(glm::vec3(arriving), third);
    const float blocked = arriving.a;
    visibility->SetValue(i, blocked > 0.0f ? seen / (seen + blocked) : 1.0f);
    error->SetValue(i, std::sqrt(texels.Variance[texel]));
  }
  grid->GetCellData()->AddArray(radiance);
  grid->GetCellData()->AddArray(visibility);
  grid->GetCellData()->AddArray(error);
}

void AddReport(const vtkRadianceBaker::Report& report, vtkStructuredGrid* grid)
{
  vtkNew<vtkIntArray> samples;
  samples->SetName("LightSamples");
  vtkNew<vtkStringArray> effects;
  effects->SetName("Effect");
  for (const vtkRadianceBaker::PairReport& pair : report.Pairs)
  {
    samples->InsertNextValue(pair.LightSamples);
    effects->InsertNextValue(penumbra::GetEffectName(pair.Effect));
  }
  vtkNew<vtkDoubleArray> seconds;
  seconds->SetName("BakeSeconds");
  seconds->InsertNextValue(report.Seconds);
  vtkNew<vtkStringArray> stoppedBy;
  stoppedBy->SetName("StoppedBy");
  stoppedBy->InsertNextValue(report.StoppedBy);
  grid->GetFieldData()->AddArray(samples);
  grid->GetFieldData()->AddArray(stoppedBy);
  grid->GetFieldData()->AddArray(effects);
  grid->GetFieldData()->AddArray(seconds);
}

/// Adds the surfaces of all inputs of a port; the answer is where each one's receivers end.
std::vector<std::size_t> AddInputs(vtkRadianceMap* self, vtkShadowSceneBuilder* builder,
  vtkInformationVector* inputs, const std::string& portName, int roles)
{
  std::vector<std::size_t> ends;
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    const std::string name = portName + "[" + std::to_string(i) + "]";
    const penumbra::ExtractedSurfaces surfaces =
      penumbra::ExtractSurfaces(vtkDataObject::GetData(inputs, i));
    if (!surfaces.Problem.empty())
    {
      vtkWarningWithObjectMacro(
        self, "RadianceMap: " << name << " " << surfaces.Problem << ". The rest is used.");
    }
    builder->AddData(surfaces.Data, nullptr, roles, name);
    ends.push_back(builder->GetScene().Receivers.size());
  }
  return ends;
}

} // namespace

vtkRadianceMap::vtkRadianceMap()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

vtkRadianceMap::~vtkRadianceMap() = default;

int vtkRadianceMap::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  if (port != RECEIVERS)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkRadianceMap::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == PLAN ? "vtkTable" : "vtkMultiBlockDataSet");
  return 1;
}

vtkOpenGLRenderWindow* vtkRadianceMap::GetOpenGLWindow()
{
  if (!this->Window)
  {
    this->Window = vtkHeadlessFactory::NewOffScreenWindow();
  }
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(this->Window);
  if (!window || !window->SupportsOpenGL())
  {
    vtkErrorMacro("RadianceMap: there is no OpenGL 3.2, which the bake needs. A display, EGL or "
                  "OSMesa provides it.");
    this->Window = nullptr;
    return nullptr;
  }
  window->Initialize();
  return window;
}

int vtkRadianceMap::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* input = inputVector[port]->GetInformationObject(i);
      input->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
      input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
  return 1;
}

int vtkRadianceMap::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkNew<vtkShadowSceneBuilder> builder;
  using Builder = vtkShadowSceneBuilder;
  AddInputs(this, builder, inputVector[LIGHTS], "Lights", Builder::Light);
  const std::vector<std::size_t> ends = AddInputs(this, builder, inputVector[RECEIVERS],
    "Receivers", Builder::Receiver | Builder::DefaultReceiver | Builder::Occluder);
  AddInputs(this, builder, inputVector[OCCLUDERS], "Occluders", Builder::Occluder);

  vtkMultiBlockDataSet* output = vtkMultiBlockDataSet::GetData(outputVector, RADIANCE);
  vtkTable* plan = vtkTable::GetData(outputVector, PLAN);
  penumbra::MakePlanTable(plan);
  const penumbra::ShadowScene& scene = builder->GetScene();
  if (scene.Receivers.empty())
  {
    return 1;
  }
  if (outputVector->GetInformationObject(0)->Get(
        vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0)
  {
    // The first piece is everything; writers want the same blocks in all of them.
    output->SetNumberOfBlocks(static_cast<unsigned int>(scene.Receivers.size()));
    return 1;
  }
  vtkOpenGLRenderWindow* window = this->GetOpenGLWindow();
  if (!window)
  {
    return 0;
  }
  window->PushContext(); // a view may be in the middle of its rendering
  std::size_t first = 0;
  for (const std::size_t end : ends)
  {
    std::vector<std::size_t> receivers;
    for (; first < end; ++first)
    {
      receivers.push_back(first);
    }
    vtkNew<vtkRadianceBaker> baker;
    vtkNew<vtkRadianceTexture> texture;
    const auto reports = baker->Bake(scene, receivers, window, texture);
    for (std::size_t i = 0; i < reports.size(); ++i)
    {
      if (!reports[i].IsComplete)
      {
        continue;
      }
      penumbra::AddToPlanTable(static_cast<int>(reports[i].Receiver), reports[i], plan);
      const penumbra::Receiver& receiver = scene.Receivers[reports[i].Receiver];
      vtkNew<vtkStructuredGrid> grid;
      AddPoints(receiver, grid);
      AddCells(receiver, texture->Download(texture->GetRegions()[i]), grid);
      AddReport(reports[i], grid);
      const unsigned int block = output->GetNumberOfBlocks();
      output->SetBlock(block, grid);
      if (receiver.IsOneOfBoth)
      {
        output->GetMetaData(block)->Set(
          vtkCompositeDataSet::NAME(), receiver.IsTurned ? "Back" : "Front");
      }
    }
    texture->ReleaseGraphicsResources();
  }
  window->PopContext();
  return 1;
}

void vtkRadianceMap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Window: " << this->Window << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShadowFieldData.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"

#include <limits>

vtkStandardNewMacro(vtkShadowFieldData);

namespace
{

/// Visits every setting with its name: one list serves reading and writing.
template <typename Settings, typename Visitor>
void VisitReceiver(Settings& settings, Visitor&& visit)
{
  visit("TexelSize", settings.TexelSize);
  visit("LightSamples", settings.LightSamples);
  visit("SampleMultiplier", settings.SampleMultiplier);
  visit("SamplingPattern", settings.SamplingPattern);
  visit("Supersampling", settings.Supersampling);
  visit("Reflectance", settings.Reflectance);
  visit("AmbientRadiance", settings.AmbientRadiance);
  visit("Side", settings.Side);
  visit("Seed", settings.Seed);
  visit("SolidAnglePerSample", settings.SolidAnglePerSample);
  visit("ErrorTolerance", settings.ErrorTolerance);
  visit("MaximumLightSamples", settings.MaximumLightSamples);
  visit("Reconstruction", settings.Reconstruction);
  visit("ExactShares", settings.ExactShares);
  visit("Planner", settings.Planner);
  visit("PlannerTolerance", settings.PlannerTolerance);
  visit("HardPenumbra", settings.HardPenumbra);
  visit("ProxyPlane", settings.ProxyPlane);
  visit("ProxyPlaneMode", settings.ProxyMode);
  visit("ProxyOrigin", settings.ProxyOrigin);
  visit("ProxyNormal", settings.ProxyNormal);
}

template <typename Settings, typename Visitor>
void VisitLight(Settings& settings, Visitor&& visit)
{
  visit("Shape", settings.Shape);
  visit("Origin", settings.Origin);
  visit("Point1", settings.Point1);
  visit("Point2", settings.Point2);
  visit("Radiance", settings.Radiance);
  visit("TwoSided", settings.TwoSided);
  visit("AngularDiameter", settings.AngularDiameter);
}

constexpr const char* CastShadowArray = "CastShadow";
constexpr const char* TransmittanceArray = "Transmittance";

/// Of data that were refused as a receiver, why.
constexpr const char* RefusalArray = "ShadowReceiverProblem";

/// Adds an array for each setting.
struct Writer
{
  vtkFieldData* FieldData;

  void operator()(const char* name, double value) { this->Add<vtkDoubleArray>(name, &value, 1); }
  void operator()(const char* name, int value) { this->Add<vtkIntArray>(name, &value, 1); }
  void operator()(const char* name, bool value) { (*this)(name, value ? 1 : 0); }
  void operator()(const char* name, penumbra::ReceiverSide value)
  {
    (*this)(name, static_cast<int>(value));
  }
  void operator()(const char* name, penumbra::ProxyPlaneMode value)
  {
    (*this)(name, static_cast<int>(value));
  }
  void operator()(const char* name, penumbra::LightKind value)
  {
    (*this)(name, static_cast<int>(value));
  }
  void operator()(const char* name, const glm::dvec3& value)
  {
    this->Add<vtkDoubleArray>(name, &value.x, 3);
  }

  template <typename Array, typename Value>
  void Add(const char* name, const Value* values, int components)
  {
    vtkNew<Array> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    for (int i = 0; i < components; ++i)
    {
      array->InsertNextValue(values[i]);
    }
    this->FieldData->AddArray(array);
  }
};

/// Takes each setting from its array; Complete ends up false if one is missing.
struct Reader
{
  vtkFieldData* FieldData;
  bool Complete = true;

  double Get(const char* name, int component, int components)
  {
    vtkDataArray* array = this->FieldData->GetArray(name);
    if (!array || array->GetNumberOfTuples() < 1 || array->GetNumberOfComponents() != components)
    {
      this->Complete = false;
      return 0.0;
    }
    return array->GetComponent(0, component);
  }
  /// What no int holds becomes the least one, which no setting allows but the seed.
  int GetInt(const char* name)
  {
    using Limits = std::numeric_limits<int>;
    const double value = this->Get(name, 0, 1);
    return value > Limits::min() && value <= Limits::max() ? static_cast<int>(value)
                                                           : Limits::min();
  }
  void operator()(const char* name, double& value) { value = this->Get(name, 0, 1); }
  void operator()(const char* name, int& value) { value = this->GetInt(name); }
  void operator()(const char* name, bool& value) { value = this->Get(name, 0, 1) != 0.0; }
  void operator()(const char* name, penumbra::ReceiverSide& value)
  {
    value = static_cast<penumbra::ReceiverSide>(this->GetInt(name));
  }
  void operator()(const char* name, penumbra::ProxyPlaneMode& value)
  {
    value = static_cast<penumbra::ProxyPlaneMode>(this->Get(name, 0, 1));
  }
  void operator()(const char* name, penumbra::LightKind& value)
  {
    value = static_cast<penumbra::LightKind>(this->GetInt(name));
  }
  void operator()(const char* name, glm::dvec3& value)
  {
    value = { this->Get(name, 0, 3), this->Get(name, 1, 3), this->Get(name, 2, 3) };
  }
};

} // namespace

void vtkShadowFieldData::Write(const penumbra::ReceiverSettings& settings, vtkFieldData* fieldData)
{
  fieldData->RemoveArray(RefusalArray);
  VisitReceiver(settings, Writer{ fieldData });
}

void vtkShadowFieldData::Write(const penumbra::LightSettings& settings, vtkFieldData* fieldData)
{
  VisitLight(settings, Writer{ fieldData });
}

void vtkShadowFieldData::Write(const penumbra::CasterSettings& settings, vtkFieldData* fieldData)
{
  fieldData->RemoveArray(CastShadowArray);
  fieldData->RemoveArray(TransmittanceArray);
  Writer write{ fieldData };
  if (!settings.CastShadow)
  {
    write(CastShadowArray, settings.CastShadow);
  }
  if (settings.Transmittance)
  {
    write(TransmittanceArray, *settings.Transmittance);
  }
}

penumbra::CasterSettings vtkShadowFieldData::ReadCaster(vtkFieldData* fieldData)
{
  penumbra::CasterSettings settings;
  if (fieldData && fieldData->HasArray(CastShadowArray))
  {
    Reader{ fieldData }(CastShadowArray, settings.CastShadow);
  }
  if (fieldData && fieldData->HasArray(TransmittanceArray))
  {
    Reader{ fieldData }(TransmittanceArray, settings.Transmittance.emplace());
  }
  return settings;
}

void vtkShadowFieldData::WriteRefusal(const std::string& reason, vtkFieldData* fieldData)
{
  const penumbra::ReceiverSettings settings;
  VisitReceiver(settings, [&](const char* name, const auto&) { fieldData->RemoveArray(name); });
  vtkNew<vtkStringArray> array;
  array->SetName(RefusalArray);
  array->InsertNextValue(reason);
  fieldData->AddArray(array);
}

std::string vtkShadowFieldData::ReadRefusal(vtkFieldData* fieldData)
{
  auto* array =
    fieldData ? vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(RefusalArray)) : nullptr;
  return array && array->GetNumberOfValues() > 0 ? array->GetValue(0) : std::string();
}

std::optional<penumbra::ReceiverSettings> vtkShadowFieldData::ReadReceiver(vtkFieldData* fieldData)
{
  penumbra::ReceiverSettings settings;
  Reader reader{ fieldData };
  if (!fieldData)
  {
    return std::nullopt;
  }
  VisitReceiver(settings, reader);
  return reader.Complete ? std::make_optional(settings) : std::nullopt;
}

std::optional<penumbra::LightSettings> vtkShadowFieldData::ReadLight(vtkFieldData* fieldData)
{
  penumbra::LightSettings settings;
  Reader reader{ fieldData };
  if (!fieldData)
  {
    return std::nullopt;
  }
  VisitLight(settings, reader);
  return reader.Complete ? std::make_optional(settings) : std::nullopt;
}

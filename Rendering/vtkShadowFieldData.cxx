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
#include <type_traits>

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
  visit("PlanarityTolerance", settings.PlanarityTolerance);
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

/// The versions of the settings' arrays: data that carry one of them have settings, whatever of
/// their arrays is missing or unknown. Files of before have none.
constexpr const char* ReceiverVersionArray = "ShadowReceiverVersion";
constexpr const char* LightVersionArray = "AreaLightVersion";
constexpr int CurrentVersion = 1;

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

/// Takes each setting from its array, and leaves the default where there is none. A value that is
/// no such thing becomes one that no setting allows: NaN, or the least int.
struct Reader
{
  vtkFieldData* FieldData;

  bool Has(const char* name) const { return this->FieldData->GetAbstractArray(name) != nullptr; }

  double Get(const char* name, int component, int components) const
  {
    vtkDataArray* array = this->FieldData->GetArray(name);
    const bool isFit =
      array && array->GetNumberOfTuples() >= 1 && array->GetNumberOfComponents() == components;
    return isFit ? array->GetComponent(0, component) : std::numeric_limits<double>::quiet_NaN();
  }
  int GetInt(const char* name) const
  {
    using Limits = std::numeric_limits<int>;
    const double value = this->Get(name, 0, 1);
    return value > Limits::min() && value <= Limits::max() ? static_cast<int>(value)
                                                           : Limits::min();
  }

  template <typename Setting>
  void operator()(const char* name, Setting& value) const
  {
    if (this->Has(name))
    {
      this->Take(name, value);
    }
  }

private:
  void Take(const char* name, double& value) const { value = this->Get(name, 0, 1); }
  void Take(const char* name, int& value) const { value = this->GetInt(name); }
  void Take(const char* name, bool& value) const { value = this->Get(name, 0, 1) != 0.0; }
  void Take(const char* name, glm::dvec3& value) const
  {
    value = { this->Get(name, 0, 3), this->Get(name, 1, 3), this->Get(name, 2, 3) };
  }
  template <typename Enumeration>
  void Take(const char* name, Enumeration& value) const
  {
    static_assert(std::is_same_v<std::underlying_type_t<Enumeration>, int>, "it holds any int");
    value = static_cast<Enumeration>(this->GetInt(name));
  }
};

/// Whether field data have settings: by their version or, of a file of before, by most of their
/// arrays.
template <typename Settings, typename Visit>
bool HasSettings(vtkFieldData* fieldData, const char* version, Visit&& visitSettings)
{
  if (!fieldData)
  {
    return false;
  }
  Settings settings;
  int there = 0, all = 0;
  visitSettings(settings,
    [&](const char* name, const auto&)
    {
      ++all;
      there += fieldData->GetAbstractArray(name) ? 1 : 0;
    });
  return fieldData->GetAbstractArray(version) || 2 * there > all;
}

} // namespace

void vtkShadowFieldData::Write(const penumbra::ReceiverSettings& settings, vtkFieldData* fieldData)
{
  fieldData->RemoveArray(RefusalArray);
  Writer write{ fieldData };
  write(ReceiverVersionArray, CurrentVersion);
  VisitReceiver(settings, write);
}

void vtkShadowFieldData::Write(const penumbra::LightSettings& settings, vtkFieldData* fieldData)
{
  Writer write{ fieldData };
  write(LightVersionArray, CurrentVersion);
  VisitLight(settings, write);
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
  fieldData->RemoveArray(ReceiverVersionArray);
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
  const auto visit = [](auto& settings, auto&& visitor) { VisitReceiver(settings, visitor); };
  if (!HasSettings<penumbra::ReceiverSettings>(fieldData, ReceiverVersionArray, visit))
  {
    return std::nullopt;
  }
  penumbra::ReceiverSettings settings;
  VisitReceiver(settings, Reader{ fieldData });
  return settings;
}

std::optional<penumbra::LightSettings> vtkShadowFieldData::ReadLight(vtkFieldData* fieldData)
{
  const auto visit = [](auto& settings, auto&& visitor) { VisitLight(settings, visitor); };
  if (!HasSettings<penumbra::LightSettings>(fieldData, LightVersionArray, visit))
  {
    return std::nullopt;
  }
  penumbra::LightSettings settings;
  VisitLight(settings, Reader{ fieldData });
  return settings;
}

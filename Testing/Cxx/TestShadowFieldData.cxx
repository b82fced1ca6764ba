// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Settings in files: what is missing has its default, what is unknown is ignored, and what is no
// such thing is said.

#include "vtkShadowFieldData.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace
{

penumbra::ReceiverSettings MakeReceiver()
{
  penumbra::ReceiverSettings settings;
  settings.TexelSize = 0.25;
  settings.LightSamples = 17;
  settings.Reflectance = { 0.1, 0.2, 0.3 };
  settings.Side = penumbra::ReceiverSide::Back;
  settings.Seed = 5;
  settings.ErrorTolerance = 0.01;
  settings.Reconstruction = false;
  settings.PlanarityTolerance = 0.03;
  return settings;
}

penumbra::LightSettings MakeLight()
{
  penumbra::LightSettings settings;
  settings.Shape = penumbra::LightKind::Disk;
  settings.Origin = { 1.0, 2.0, 3.0 };
  settings.Point1 = { 2.0, 2.0, 3.0 };
  settings.Point2 = { 1.0, 3.0, 3.0 };
  settings.Radiance = { 4.0, 5.0, 6.0 };
  settings.TwoSided = true;
  return settings;
}

std::vector<std::string> GetNames(vtkFieldData* fieldData)
{
  std::vector<std::string> names;
  for (int i = 0; i < fieldData->GetNumberOfArrays(); ++i)
  {
    names.emplace_back(fieldData->GetArrayName(i));
  }
  return names;
}

bool IsVersion(const std::string& name)
{
  return name.find("Version") != std::string::npos;
}

/// A stranger's arrays, and a version of later.
void AddUnknown(vtkFieldData* fieldData)
{
  vtkNew<vtkDoubleArray> unknown;
  unknown->SetName("SomethingOfLater");
  unknown->InsertNextValue(3.0);
  fieldData->AddArray(unknown);
  for (const std::string& name : GetNames(fieldData))
  {
    if (IsVersion(name))
    {
      fieldData->GetArray(name.c_str())->SetComponent(0, 0, 99.0);
    }
  }
}

} // namespace

// One array less changes its own setting at most, and that to its default.
TEST(ShadowFieldData, EachMissingArrayOfAReceiverHasItsDefault)
{
  vtkNew<vtkFieldData> all;
  vtkShadowFieldData::Write(MakeReceiver(), all);
  for (const std::string& name : GetNames(all))
  {
    vtkNew<vtkFieldData> fewer;
    vtkShadowFieldData::Write(MakeReceiver(), fewer);
    fewer->RemoveArray(name.c_str());
    const auto read = vtkShadowFieldData::ReadReceiver(fewer);
    ASSERT_TRUE(read) << "without " << name;
    penumbra::ReceiverSettings right = MakeReceiver();
    const penumbra::ReceiverSettings byDefault;
    right.TexelSize = name == "TexelSize" ? byDefault.TexelSize : right.TexelSize;
    right.LightSamples = name == "LightSamples" ? byDefault.LightSamples : right.LightSamples;
    right.Reflectance = name == "Reflectance" ? byDefault.Reflectance : right.Reflectance;
    right.Side = name == "Side" ? byDefault.Side : right.Side;
    right.Seed = name == "Seed" ? byDefault.Seed : right.Seed;
    right.ErrorTolerance =
      name == "ErrorTolerance" ? byDefault.ErrorTolerance : right.ErrorTolerance;
    right.Reconstruction =
      name == "Reconstruction" ? byDefault.Reconstruction : right.Reconstruction;
    right.PlanarityTolerance =
      name == "PlanarityTolerance" ? byDefault.PlanarityTolerance : right.PlanarityTolerance;
    EXPECT_TRUE(*read == right) << "without " << name;
    EXPECT_EQ(read->FindProblem(), "") << "without " << name;
  }
}

TEST(ShadowFieldData, EachMissingArrayOfALightHasItsDefault)
{
  vtkNew<vtkFieldData> all;
  vtkShadowFieldData::Write(MakeLight(), all);
  const penumbra::LightSettings byDefault;
  for (const std::string& name : GetNames(all))
  {
    vtkNew<vtkFieldData> fewer;
    vtkShadowFieldData::Write(MakeLight(), fewer);
    fewer->RemoveArray(name.c_str());
    const auto read = vtkShadowFieldData::ReadLight(fewer);
    ASSERT_TRUE(read) << "without " << name;
    const penumbra::LightSettings right = MakeLight();
    EXPECT_EQ(read->Shape, name == "Shape" ? byDefault.Shape : right.Shape) << "without " << name;
    EXPECT_EQ(read->Origin, name == "Origin" ? byDefault.Origin : right.Origin)
      << "without " << name;
    EXPECT_EQ(read->Radiance, name == "Radiance" ? byDefault.Radiance : right.Radiance)
      << "without " << name;
    EXPECT_EQ(read->TwoSided, name == "TwoSided" ? byDefault.TwoSided : right.TwoSided)
      << "without " << name;
  }
}

TEST(ShadowFieldData, FilesOfBeforeAndOfLaterAreRead)
{
  for (const bool isOfLater : { false, true })
  {
    vtkNew<vtkFieldData> receiver, light;
    vtkShadowFieldData::Write(MakeReceiver(), receiver);
    vtkShadowFieldData::Write(MakeLight(), light);
    for (vtkFieldData* fieldData : { receiver.Get(), light.Get() })
    {
      if (isOfLater)
      {
        AddUnknown(fieldData);
        continue;
      }
      for (const std::string& name : GetNames(fieldData))
      {
        if (IsVersion(name))
        {
          fieldData->RemoveArray(name.c_str());
        }
      }
    }
    ASSERT_TRUE(vtkShadowFieldData::ReadReceiver(receiver)) << "of later: " << isOfLater;
    EXPECT_TRUE(*vtkShadowFieldData::ReadReceiver(receiver) == MakeReceiver());
    ASSERT_TRUE(vtkShadowFieldData::ReadLight(light)) << "of later: " << isOfLater;
    EXPECT_EQ(vtkShadowFieldData::ReadLight(light)->Point1, MakeLight().Point1);
    EXPECT_FALSE(vtkShadowFieldData::ReadLight(receiver));
    EXPECT_FALSE(vtkShadowFieldData::ReadReceiver(light));
  }
}

// A name that others use, too, makes no receiver and no light.
TEST(ShadowFieldData, AStrangersArraysAreNoSettings)
{
  vtkNew<vtkFieldData> fieldData;
  EXPECT_FALSE(vtkShadowFieldData::ReadReceiver(nullptr));
  EXPECT_FALSE(vtkShadowFieldData::ReadLight(nullptr));
  for (const char* name : { "Seed", "Origin", "Radiance", "Side" })
  {
    vtkNew<vtkIntArray> array;
    array->SetName(name);
    array->InsertNextValue(1);
    fieldData->AddArray(array);
  }
  EXPECT_FALSE(vtkShadowFieldData::ReadReceiver(fieldData));
  EXPECT_FALSE(vtkShadowFieldData::ReadLight(fieldData));
}

// Text, two values instead of one, and numbers that no setting holds are problems that name their
// array.
TEST(ShadowFieldData, WhatIsNoSuchThingIsSaid)
{
  for (const std::string name : { "TexelSize", "LightSamples", "Reflectance", "Side" })
  {
    vtkNew<vtkStringArray> text;
    vtkNew<vtkDoubleArray> pair, nan;
    text->InsertNextValue("one");
    pair->SetNumberOfComponents(2);
    pair->InsertNextTuple2(1.0, 1.0);
    nan->InsertNextValue(std::numeric_limits<double>::quiet_NaN());
    for (vtkAbstractArray* wrong : std::initializer_list<vtkAbstractArray*>{ text, pair, nan })
    {
      vtkNew<vtkFieldData> fieldData;
      vtkShadowFieldData::Write(MakeReceiver(), fieldData);
      wrong->SetName(name.c_str());
      fieldData->AddArray(wrong);
      const auto read = vtkShadowFieldData::ReadReceiver(fieldData);
      ASSERT_TRUE(read) << name;
      EXPECT_EQ(read->FindProblem().compare(0, name.size(), name), 0)
        << name << " as " << wrong->GetClassName() << ": " << read->FindProblem();
    }
  }
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowFieldData
 * @brief the settings of lights, receivers and casters as field data
 *
 * Lights, receivers and casters of shadows carry their settings as field data, so that they travel
 * with the data through filters, to a server and into files. Each property of vtkAreaLightSource,
 * vtkShadowReceiver or vtkShadowCaster is an array of its own name. So is what vtkShadowReceiver
 * has refused.
 */
#ifndef vtkShadowFieldData_h
#define vtkShadowFieldData_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowSettings.h"
#include "vtkObject.h"

#include <optional> // for return values
#include <string>   // for reasons

class vtkFieldData;

class PENUMBRARENDERING_EXPORT vtkShadowFieldData : public vtkObject
{
public:
  static vtkShadowFieldData* New();
  vtkTypeMacro(vtkShadowFieldData, vtkObject)

  ///@{
  /**
   * Write the settings into the field data, replacing those that are there.
   */
  static void Write(const penumbra::ReceiverSettings& settings, vtkFieldData* fieldData);
  static void Write(const penumbra::LightSettings& settings, vtkFieldData* fieldData);
  /// What is as it is by default leaves no array.
  static void Write(const penumbra::CasterSettings& settings, vtkFieldData* fieldData);
  ///@}

  ///@{
  /**
   * Write and read why data that were meant to be a receiver are none, which has been reported:
   * they are never taken for one, and nobody need report it again. They lose their settings.
   * Without an entry, the reason is empty.
   */
  static void WriteRefusal(const std::string& reason, vtkFieldData* fieldData);
  static std::string ReadRefusal(vtkFieldData* fieldData);
  ///@}

  ///@{
  /**
   * Read settings; nothing is returned if the field data (which may be nullptr) have none. They
   * have if there is an array of their version, or, in files of before, most of their arrays. What
   * is missing has its default, and unknown arrays are ignored. An array of another type or size
   * gives a value that is not allowed: ask the settings for FindProblem().
   */
  static std::optional<penumbra::ReceiverSettings> ReadReceiver(vtkFieldData* fieldData);
  static std::optional<penumbra::LightSettings> ReadLight(vtkFieldData* fieldData);
  ///@}

  /**
   * Read how a surface casts shadows; the defaults where the field data (which may be nullptr) say
   * nothing.
   */
  static penumbra::CasterSettings ReadCaster(vtkFieldData* fieldData);

  /**
   * The cell array of the radiance that the cells of a light of many cells emit: double, three
   * components, W sr^-1 m^-2.
   */
  static const char* GetRadianceArrayName() { return "PenumbraRadiance"; }

protected:
  vtkShadowFieldData() = default;
  ~vtkShadowFieldData() override = default;

private:
  vtkShadowFieldData(const vtkShadowFieldData&) = delete;
  void operator=(const vtkShadowFieldData&) = delete;
};

#endif

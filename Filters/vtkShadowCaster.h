// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowCaster
 * @brief says how data cast soft shadows
 *
 * The output is the input, whatever its type, with the properties below as field data of each leaf,
 * by which vtkSoftShadowPass and vtkRadianceMap know them. What they say goes before the opacity
 * and the colour that an actor has.
 *
 * A Transmittance out of range is an error, and is not written.
 *
 * @sa vtkShadowReceiver, vtkRadianceMap, vtkSoftShadowPass
 */
#ifndef vtkShadowCaster_h
#define vtkShadowCaster_h

#include "PenumbraFiltersModule.h" // for the export macro
#include "vtkPassInputTypeAlgorithm.h"

class PENUMBRAFILTERS_EXPORT vtkShadowCaster : public vtkPassInputTypeAlgorithm
{
public:
  static vtkShadowCaster* New();
  vtkTypeMacro(vtkShadowCaster, vtkPassInputTypeAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the data cast shadows. Default is on.
   */
  vtkSetMacro(CastShadow, bool);
  vtkGetMacro(CastShadow, bool);
  vtkBooleanMacro(CastShadow, bool);
  ///@}

  ///@{
  /**
   * Whether Transmittance says how much light passes. Off, in a view, the actor's opacity and
   * colour do; for vtkRadianceMap, the data are opaque. Default is off.
   */
  vtkSetMacro(UseTransmittance, bool);
  vtkGetMacro(UseTransmittance, bool);
  vtkBooleanMacro(UseTransmittance, bool);
  ///@}

  ///@{
  /**
   * The share of light that passes (red, green, blue), 0 to 1 each. Data weaken a ray once, also
   * where it enters and leaves them. Default is (0.5, 0.5, 0.5).
   */
  vtkSetVector3Macro(Transmittance, double);
  vtkGetVector3Macro(Transmittance, double);
  ///@}

protected:
  vtkShadowCaster();
  ~vtkShadowCaster() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkShadowCaster(const vtkShadowCaster&) = delete;
  void operator=(const vtkShadowCaster&) = delete;

  bool CastShadow = true;
  bool UseTransmittance = false;
  double Transmittance[3] = { 0.5, 0.5, 0.5 };
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAreaLightSource
 * @brief makes an area light: a polygon that emits diffusely
 *
 * The output is the light's polygon with its properties as field data, by which vtkSoftShadowPass
 * and vtkRadianceMap know it. Light leaves it towards (Point1 - Origin) x (Point2 - Origin), or
 * both ways if TwoSided. The light's own surface blocks no light.
 *
 * A light without area, or with a coordinate that is not finite, is an error and gives an empty
 * output.
 *
 * @sa vtkShadowReceiver, vtkRadianceMap, vtkSoftShadowPass
 */
#ifndef vtkAreaLightSource_h
#define vtkAreaLightSource_h

#include "PenumbraFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

class PENUMBRAFILTERS_EXPORT vtkAreaLightSource : public vtkPolyDataAlgorithm
{
public:
  static vtkAreaLightSource* New();
  vtkTypeMacro(vtkAreaLightSource, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The light's outline.
  enum Shapes
  {
    PARALLELOGRAM = 0, ///< Origin, Point1, Point1 + Point2 - Origin, Point2
    TRIANGLE = 1       ///< Origin, Point1, Point2
  };

  ///@{
  /**
   * The light's outline. Default is PARALLELOGRAM.
   */
  vtkSetMacro(Shape, int);
  vtkGetMacro(Shape, int);
  ///@}

  ///@{
  /**
   * The corner of the light from which its edges go to Point1 and Point2, in world units. Defaults
   * are
   * (-0.5, -0.5, 0), (0.5, -0.5, 0) and (-0.5, 0.5, 0).
   */
  vtkSetVector3Macro(Origin, double);
  vtkGetVector3Macro(Origin, double);
  vtkSetVector3Macro(Point1, double);
  vtkGetVector3Macro(Point1, double);
  vtkSetVector3Macro(Point2, double);
  vtkGetVector3Macro(Point2, double);
  ///@}

  ///@{
  /**
   * Emitted radiance (red, green, blue), W sr^-1 m^-2, 0 to 1e30 each. Default is (1, 1, 1).
   */
  vtkSetVector3Macro(Radiance, double);
  vtkGetVector3Macro(Radiance, double);
  ///@}

  ///@{
  /**
   * Whether the light emits to both sides. Default is off.
   */
  vtkSetMacro(TwoSided, bool);
  vtkGetMacro(TwoSided, bool);
  vtkBooleanMacro(TwoSided, bool);
  ///@}

protected:
  vtkAreaLightSource();
  ~vtkAreaLightSource() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkAreaLightSource(const vtkAreaLightSource&) = delete;
  void operator=(const vtkAreaLightSource&) = delete;

  int Shape = PARALLELOGRAM;
  double Origin[3] = { -0.5, -0.5, 0.0 };
  double Point1[3] = { 0.5, -0.5, 0.0 };
  double Point2[3] = { -0.5, 0.5, 0.0 };
  double Radiance[3] = { 1.0, 1.0, 1.0 };
  bool TwoSided = false;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAreaLightSource
 * @brief makes a light: a surface, a line, a point or a sun
 *
 * The output is the light's outline with its properties as field data, by which vtkSoftShadowPass
 * and vtkRadianceMap know it. A surface (parallelogram, triangle or disk) emits diffusely, towards
 * (Point1 - Origin) x (Point2 - Origin), or both ways if TwoSided; a segment as a thin diffuse
 * cylinder does; a point the same in all directions; a directional light shines along Point1 -
 * Origin, from infinity. The light's own outline blocks no light.
 *
 * A light without extent (or, if directional, without a direction), or with a coordinate that is
 * not finite, is an error and gives an empty output.
 *
 * @sa vtkAreaLightFromSurface, vtkShadowReceiver, vtkRadianceMap, vtkSoftShadowPass
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
    TRIANGLE = 1,      ///< Origin, Point1, Point2
    DISK = 2,          ///< around Origin, through Point1, in the plane of Origin, Point1 and Point2
    SEGMENT = 3,       ///< Origin to Point1
    POINT = 4,         ///< Origin
    DIRECTIONAL = 5    ///< from Origin towards Point1, everywhere
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
   * The points that Shapes speaks of, in world units. Defaults are (-0.5, -0.5, 0), (0.5, -0.5, 0)
   * and (-0.5, 0.5, 0).
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
   * What is emitted (red, green, blue), 0 to 1e30 each: radiance, W sr^-1 m^-2, of a surface;
   * W sr^-1 m^-1, across it, of a segment; radiant intensity, W sr^-1, of a point; irradiance at
   * normal incidence, W m^-2, of a directional light. Default is (1, 1, 1).
   */
  vtkSetVector3Macro(Radiance, double);
  vtkGetVector3Macro(Radiance, double);
  ///@}

  ///@{
  /**
   * Whether a surface emits to both sides. Default is off.
   */
  vtkSetMacro(TwoSided, bool);
  vtkGetMacro(TwoSided, bool);
  vtkBooleanMacro(TwoSided, bool);
  ///@}

  ///@{
  /**
   * The angle in degrees that a directional light fills in the sky, 0 (a point at infinity) to less
   * than 180. Default is 0.53: the sun.
   */
  vtkSetMacro(AngularDiameter, double);
  vtkGetMacro(AngularDiameter, double);
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
  double AngularDiameter = 0.53;
};

#endif

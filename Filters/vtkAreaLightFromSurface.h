// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAreaLightFromSurface
 * @brief makes an area light of the polygons of a surface
 *
 * Every polygon of the input emits diffusely, to the side from which its points are seen
 * counter-clockwise, or to both sides; triangle strips emit as triangles. A cell array may give
 * each its own radiance: a stained-glass window is a grid of coloured cells. The surface is one
 * light: its samples are spread over the cells by power, without bias. It blocks no light itself.
 * Cells that vtkGhostType hides emit nothing.
 *
 * Polygons must be planar and convex; one that is not is an error, which names it, and gives an
 * empty output. So do cells that name points that are not there, and an array that is missing, is
 * of another size than the cells, or has values out of range. Polygons without area or radiance
 * emit nothing; a surface of nothing else is an error, too.
 *
 * The output is the polygons, with the cell array PenumbraRadiance (double, 3 components: W sr^-1
 * m^-2) and the light's settings as field data.
 *
 * @sa vtkAreaLightSource, vtkShadowReceiver, vtkRadianceMap
 */
#ifndef vtkAreaLightFromSurface_h
#define vtkAreaLightFromSurface_h

#include "PenumbraFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <string> // for the array's name

class PENUMBRAFILTERS_EXPORT vtkAreaLightFromSurface : public vtkPolyDataAlgorithm
{
public:
  static vtkAreaLightFromSurface* New();
  vtkTypeMacro(vtkAreaLightFromSurface, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The cell array of emitted radiance, W sr^-1 m^-2, with one component (grey) or three (red,
   * green, blue), 0 to 1e30 each. Default is empty (as is "None"): all cells emit Radiance.
   *
   * It is SetInputArrayToProcess() of index 0, of which only the name counts: where ParaView's
   * scripts give none, they associate a name with points.
   */
  void SetRadianceArray(const std::string& name);
  std::string GetRadianceArray();
  ///@}

  ///@{
  /**
   * Emitted radiance (red, green, blue), W sr^-1 m^-2; with a RadianceArray, a factor of its
   * values. 0 to 1e30 each. Default is (1, 1, 1).
   */
  vtkSetVector3Macro(Radiance, double);
  vtkGetVector3Macro(Radiance, double);
  ///@}

  ///@{
  /**
   * Whether the surface emits to both sides. Default is off.
   */
  vtkSetMacro(TwoSided, bool);
  vtkGetMacro(TwoSided, bool);
  vtkBooleanMacro(TwoSided, bool);
  ///@}

protected:
  vtkAreaLightFromSurface();
  ~vtkAreaLightFromSurface() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkAreaLightFromSurface(const vtkAreaLightFromSurface&) = delete;
  void operator=(const vtkAreaLightFromSurface&) = delete;

  double Radiance[3] = { 1.0, 1.0, 1.0 };
  bool TwoSided = false;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceMap
 * @brief bakes the radiance of receivers as data, without a view
 *
 * Computes what vtkSoftShadowPass shows, by the same bake and to the same bits, and gives it as
 * data. Inputs are polygonal data, grids of any type, of which the outer surface counts, as a view
 * shows it, and composite data of them. Cells that vtkGhostType hides are left out, as ParaView's
 * view does (HIDDENCELL, DUPLICATECELL). What has no surface, such as a table, gets a warning:
 * - port 0, Receivers (one or more): vtkShadowReceiver's output; other planar data get its
 * defaults. They block light from each other, too;
 * - port 1, Occluders (any number): surfaces that block light, or let some
 * of it pass (vtkShadowCaster);
 * - port 2, Lights (any number): output of vtkAreaLightSource or vtkAreaLightFromSurface.
 *
 * A surface that receives by a proxy plane (vtkShadowReceiver::ProxyPlane) is one receiver: the
 * plane.
 *
 * The output has a vtkStructuredGrid for each receiver, in the order of the inputs and of the
 * polygons in each. Where vtkShadowReceiver's Side is BOTH there are two, named "Front" and "Back":
 * first the front's, then the back's, with the edges exchanged, so that ex x ey points to the side
 * that is lit; a cell has the same values, to the bit, as with Side BACK alone. Its cells are the
 * texels: points (double) at b + i/sx ex + j/sy ey, i fastest, and the cell arrays
 * - Radiance (float, 3 components): reflected radiance at the cell's centre, W sr^-1 m^-2
 *   (Heckbert and Herf 1997, eq. 1);
 * - Visibility (float): of the light that would arrive unoccluded, ambient radiance aside, the
 * share that does, in the mean of the components; 1 where none would arrive;
 * - ErrorEstimate (float): standard error of the mean of the radiance's components, from the
 * difference of two halves of the samples (0 by one sample, which has none, and where shares are
 * exact: vtkShadowReceiver::SetExactShares()); and the field data
 * - LightSamples (int, one tuple a light): samples taken; 0 where none were needed;
 * - Effect (string, one a light): "None", "Unoccluded", "Umbra", "Hard" or "Soft";
 * - StoppedBy (string): the property that decided how many samples were taken: "LightSamples",
 *   "SolidAnglePerSample", "ErrorTolerance" or "MaximumLightSamples";
 * - BakeSeconds (double).
 *
 * A second output, a vtkTable, says what was decided and done for each receiver and light, a row
 * each: Receiver and Light (indices), Effect, Reason, LightSamples, Texels (that samples were taken
 * for), Triangles (that could block the light) of SceneTriangles, Milliseconds, Bytes (of masks),
 * ExactTexels (whose shares were found without samples).
 *
 * The bake needs OpenGL 3.2, on any machine: without a display, a headless window serves. A missing
 * OpenGL is an error, and so is every input that the bake leaves out; the rest is baked.
 *
 * @sa vtkAreaLightSource, vtkShadowReceiver, vtkSoftShadowPass
 */
#ifndef vtkRadianceMap_h
#define vtkRadianceMap_h

#include "PenumbraFiltersModule.h" // for the export macro
#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer

class vtkOpenGLRenderWindow;
class vtkRenderWindow;

class PENUMBRAFILTERS_EXPORT vtkRadianceMap : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkRadianceMap* New();
  vtkTypeMacro(vtkRadianceMap, vtkMultiBlockDataSetAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The input ports.
  enum Ports
  {
    RECEIVERS = 0,
    OCCLUDERS = 1,
    LIGHTS = 2
  };

  /// The output ports.
  enum Outputs
  {
    RADIANCE = 0,
    PLAN = 1
  };

  ///@{
  /**
   * Disconnect all inputs of a port, as RemoveAllInputConnections() with the port's number:
   * ParaView wants a name without arguments. Inputs are connected by AddInputConnection(port,
   * output).
   */
  void RemoveAllReceivers() { this->RemoveAllInputConnections(RECEIVERS); }
  void RemoveAllOccluders() { this->RemoveAllInputConnections(OCCLUDERS); }
  void RemoveAllLights() { this->RemoveAllInputConnections(LIGHTS); }
  ///@}

protected:
  vtkRadianceMap();
  ~vtkRadianceMap() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  /// Whatever piece is asked for, all of the scene: a shadow may come from anywhere.
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkRadianceMap(const vtkRadianceMap&) = delete;
  void operator=(const vtkRadianceMap&) = delete;

  vtkOpenGLRenderWindow* GetOpenGLWindow();

  vtkSmartPointer<vtkRenderWindow> Window;
};

#endif

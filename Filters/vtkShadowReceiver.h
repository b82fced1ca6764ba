// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowReceiver
 * @brief designates polygonal data as receivers of soft shadows
 *
 * The output is the input with the properties below as field data, by which vtkSoftShadowPass and
 * vtkRadianceMap know it. Connected coplanar polygons form one receiver: a plane at any resolution
 * is one, a box is six. Each gets a radiance texture on the parallelogram that is fitted around it
 * (Heckbert and Herf 1997, 3.4): exactly for parallelograms; a triangle fills the lower left half
 * of it; anything else lies in the smallest rectangle around it.
 *
 * A surface that is curved all over, or has no polygon with an area, is an error and passes without
 * settings, but with the error as field data: it will be drawn plain, not baked, and nobody reports
 * it again. So is a property out of its range. With ProxyPlane, a curved surface receives by a
 * plane that stands for it. Data whose cells name points that are not there, which VTK cannot draw
 * either, give an empty output.
 *
 * @sa vtkAreaLightSource, vtkRadianceMap, vtkSoftShadowPass
 */
#ifndef vtkShadowReceiver_h
#define vtkShadowReceiver_h

#include "PenumbraFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

class PENUMBRAFILTERS_EXPORT vtkShadowReceiver : public vtkPolyDataAlgorithm
{
public:
  static vtkShadowReceiver* New();
  vtkTypeMacro(vtkShadowReceiver, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Patterns of light samples. The first halves and the second halves are stratified too.
  enum SamplingPatterns
  {
    SOBOL = 0, ///< Owen-scrambled
    CORRELATED_MULTI_JITTERED = 1,
    JITTERED_GRID = 2,
    UNIFORM_GRID = 3,
    RANDOM = 4
  };

  /// Which side of the receiver is lit.
  enum Sides
  {
    AUTO = 0,  ///< the side that gets more light
    FRONT = 1, ///< the side from which its polygons are seen counter-clockwise
    BACK = 2,
    BOTH = 3 ///< each by the light that arrives there: two receivers, the front first
  };

  /// Planes that may stand for a surface.
  enum ProxyPlaneModes
  {
    BEST_FIT = 0, ///< of least squared distance, moved to the surface's deepest point below the
                  ///< lit side; its front is where more of the surface's area points
    GIVEN = 1     ///< by ProxyOrigin and ProxyNormal
  };

  ///@{
  /**
   * The size of texels in world units; 0 makes 512 texels along the longest edge, which hold the
   * mean of finer ones around shadows that are small against them. Texels grow, with a warning,
   * where a texture would pass 16 384 texels a side or 256 MiB. Default is 0.
   */
  vtkSetMacro(TexelSize, double);
  vtkGetMacro(TexelSize, double);
  ///@}

  ///@{
  /**
   * How many samples each light gets, 1 to 65536. The grids round up to full rows. Default is 64.
   */
  vtkSetMacro(LightSamples, int);
  vtkGetMacro(LightSamples, int);
  ///@}

  ///@{
  /**
   * A factor of LightSamples, greater than 0 (Heckbert and Herf 1997, 5); the product is rounded,
   * and at least 1. Default is 1.
   */
  vtkSetMacro(SampleMultiplier, double);
  vtkGetMacro(SampleMultiplier, double);
  ///@}

  ///@{
  /**
   * How the samples are spread over a light: see SamplingPatterns. Default is SOBOL.
   */
  vtkSetMacro(SamplingPattern, int);
  vtkGetMacro(SamplingPattern, int);
  ///@}

  ///@{
  /**
   * 1, 2 or 4: how many times finer, along each edge, texels are computed before they are filtered
   * down by a tent that reaches to the neighbours' centres. Default is 1.
   */
  vtkSetMacro(Supersampling, int);
  vtkGetMacro(Supersampling, int);
  ///@}

  ///@{
  /**
   * The share of light that is reflected (red, green, blue), 0 to 1 each. Default is (1, 1, 1).
   */
  vtkSetVector3Macro(Reflectance, double);
  vtkGetVector3Macro(Reflectance, double);
  ///@}

  ///@{
  /**
   * The radiance that arrives from everywhere, shadow or not (red, green, blue), W sr^-1 m^-2, 0 to
   * 1e30 each. Default is (0, 0, 0).
   */
  vtkSetVector3Macro(AmbientRadiance, double);
  vtkGetVector3Macro(AmbientRadiance, double);
  ///@}

  ///@{
  /**
   * Which side is lit: see Sides. Default is AUTO. In a view, the other side shows the light that
   * arrives there with AUTO, and the ambient radiance alone with FRONT and BACK. What stands for a
   * surface that is not planar (ProxyPlane) has one side: BOTH is AUTO there.
   */
  vtkSetMacro(Side, int);
  vtkGetMacro(Side, int);
  void SetSideToAuto() { this->SetSide(AUTO); }
  void SetSideToFront() { this->SetSide(FRONT); }
  void SetSideToBack() { this->SetSide(BACK); }
  void SetSideToBoth() { this->SetSide(BOTH); }
  ///@}

  ///@{
  /**
   * The seed of random patterns: the same seed gives the same texels. Default is 0.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * With a value > 0, in steradians: each light gets, instead of LightSamples, as many samples as
   * keep the solid angle that one stands for, seen from the receiver's nearest point, below it
   * (Heckbert and Herf 1997, 3.7); at most MaximumLightSamples. Segments, points and lights of one
   * direction have no solid angle and keep LightSamples. Default is 0: off.
   */
  vtkSetMacro(SolidAnglePerSample, double);
  vtkGetMacro(SolidAnglePerSample, double);
  ///@}

  ///@{
  /**
   * With a value > 0, up to 1: samples are added in batches until the estimated standard error,
   * root mean square over the receiver, is below this share of the receiver's peak radiance, or
   * MaximumLightSamples is reached. LightSamples then says nothing. Default is 0: off.
   */
  vtkSetMacro(ErrorTolerance, double);
  vtkGetMacro(ErrorTolerance, double);
  ///@}

  ///@{
  /**
   * The most samples of a light that SolidAnglePerSample or ErrorTolerance may take, 1 to 65536.
   * Default is 4096.
   */
  vtkSetMacro(MaximumLightSamples, int);
  vtkGetMacro(MaximumLightSamples, int);
  ///@}

  ///@{
  /**
   * Whether visibility is filtered across texels within penumbras: neighbours see an occluder's
   * edge cross different samples, so that their errors partly cancel. Default is on.
   */
  vtkSetMacro(Reconstruction, bool);
  vtkGetMacro(Reconstruction, bool);
  vtkBooleanMacro(Reconstruction, bool);
  ///@}

  ///@{
  /**
   * Whether, with Reconstruction, what texels in penumbras see of a polygonal light is cut out of
   * it, along the shadows of the triangles that block it (Nishita and Nakamae 1983), where few may
   * and none of them is translucent: from 512 samples on, and from 8 for each of these triangles.
   * That takes about as long again as the samples, which only tell where penumbras are. The error
   * that is left is rounding, but for slivers of the light that all samples miss: less than one
   * sample stands for. What falls into many pieces is left to the samples. Default is on.
   */
  vtkSetMacro(ExactShares, bool);
  vtkGetMacro(ExactShares, bool);
  vtkBooleanMacro(ExactShares, bool);
  ///@}

  ///@{
  /**
   * Whether a planner decides what each light needs before it is computed: nothing, the closed form
   * alone, one sample, or all samples where a shadow may fall. Off, every light that can arrive
   * takes all its samples on all texels: to check the planner by. Default is on.
   */
  vtkSetMacro(Planner, bool);
  vtkGetMacro(Planner, bool);
  vtkBooleanMacro(Planner, bool);
  ///@}

  ///@{
  /**
   * How much of the receiver's unoccluded peak the planner may leave out, 0 to 1: lights that add
   * up to less. Default is 1/1024, a quarter of a level of an 8-bit picture.
   */
  vtkSetMacro(PlannerTolerance, double);
  vtkGetMacro(PlannerTolerance, double);
  ///@}

  ///@{
  /**
   * In texels: where no penumbra of a light can be wider, the planner takes one sample of it. A
   * texel that such a penumbra crosses is then wholly lit or dark. 0 leaves that to lights without
   * extent, as does an ErrorTolerance. Default is 1.
   */
  vtkSetMacro(HardPenumbra, double);
  vtkGetMacro(HardPenumbra, double);
  ///@}

  ///@{
  /**
   * How far, in world units, a face's points may be off its plane: coordinates that are rounded to
   * centimetres need 0.02. With 0, what the type of the coordinates rounds, or 1e-4 of the face's
   * extent, whichever is more. A face that is not planar is named in an error and drawn plain; the
   * others receive. Allowed: 0 or more. Default is 0.
   */
  vtkSetMacro(PlanarityTolerance, double);
  vtkGetMacro(PlanarityTolerance, double);
  ///@}

  ///@{
  /**
   * Whether a surface that is not planar receives by a plane that stands for it (Heckbert and Herf
   * 1997, figure 5): shadows are computed on the plane, and each point of the surface shows the one
   * at its projection from the light's centre. The whole surface is then one receiver. That is an
   * approximation:
   * - the surface casts no shadow on itself;
   * - penumbras are as wide as on the plane, and radiance is that of the plane, its cosine too;
   * - of several lights, the projection is from the mean of their centres, weighted by the light
   *   that each sends: on what stands out from the plane, the shadows of each are displaced;
   * - what lies between the surface and the plane, such as a table below its cloth, casts shadows
   *   too: give a plane above it.
   *
   * On planar surfaces it changes nothing. A surface that is closed, or as thick as wide, needs a
   * given plane if none fits best. Lights must be above the surface, on one side of the plane, and
   * not so low that the projections reach 16 times its extent; otherwise it is drawn plain, with an
   * error. Default is off.
   */
  vtkSetMacro(ProxyPlane, bool);
  vtkGetMacro(ProxyPlane, bool);
  vtkBooleanMacro(ProxyPlane, bool);
  ///@}

  ///@{
  /**
   * Which plane stands for the surface: see ProxyPlaneModes. Default is BEST_FIT.
   */
  vtkSetMacro(ProxyPlaneMode, int);
  vtkGetMacro(ProxyPlaneMode, int);
  ///@}

  ///@{
  /**
   * A point of the given plane and its normal, of any length but 0, towards its front; in the
   * coordinates of the data. Defaults are (0, 0, 0) and (0, 0, 1).
   */
  vtkSetVector3Macro(ProxyOrigin, double);
  vtkGetVector3Macro(ProxyOrigin, double);
  vtkSetVector3Macro(ProxyNormal, double);
  vtkGetVector3Macro(ProxyNormal, double);
  ///@}

  ///@{
  /**
   * Whether the surface casts shadows, on other receivers and its own other faces, unless what it
   * is made of says already that it casts none (vtkShadowCaster). Default is on.
   */
  vtkSetMacro(CastShadow, bool);
  vtkGetMacro(CastShadow, bool);
  vtkBooleanMacro(CastShadow, bool);
  ///@}

protected:
  vtkShadowReceiver();
  ~vtkShadowReceiver() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkShadowReceiver(const vtkShadowReceiver&) = delete;
  void operator=(const vtkShadowReceiver&) = delete;

  double TexelSize = 0.0;
  int LightSamples = 64;
  double SampleMultiplier = 1.0;
  int SamplingPattern = SOBOL;
  int Supersampling = 1;
  double Reflectance[3] = { 1.0, 1.0, 1.0 };
  double AmbientRadiance[3] = { 0.0, 0.0, 0.0 };
  int Side = AUTO;
  int Seed = 0;
  double SolidAnglePerSample = 0.0;
  double ErrorTolerance = 0.0;
  int MaximumLightSamples = 4096;
  bool Reconstruction = true;
  bool ExactShares = true;
  bool Planner = true;
  double PlannerTolerance = 1.0 / 1024.0;
  double HardPenumbra = 1.0;
  double PlanarityTolerance = 0.0;
  bool ProxyPlane = false;
  int ProxyPlaneMode = BEST_FIT;
  double ProxyOrigin[3] = { 0.0, 0.0, 0.0 };
  double ProxyNormal[3] = { 0.0, 0.0, 1.0 };
  bool CastShadow = true;
};

#endif

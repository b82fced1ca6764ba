// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSoftShadowPass
 * @brief a render pass that shows soft shadows of area lights on planar receivers
 *
 * The pass finds the area lights (actors of vtkAreaLightSource's output), the receivers (actors of
 * vtkShadowReceiver's output) and the occluders (every other visible surface) among the renderer's
 * props, bakes the receivers' radiance textures (vtkRadianceBaker), and lets its delegate draw the
 * scene with shaders that read them (Heckbert and Herf 1997). A bake is only redone when something
 * that it depends on has changed; the camera is not among that.
 *
 * Receivers keep their colours, scalar colouring, opacity and picking. Everything else is drawn by
 * the delegate as it would be without this pass.
 *
 * In plain VTK:
 * @code
 * vtkNew<vtkSoftShadowPass> pass;
 * renderer->SetPass(pass);
 * @endcode
 *
 * Wherever there is no light, nothing is in shadow: receivers are then drawn plain. Lights shine
 * while they are visible, however they are drawn. Occluders are what is drawn as surfaces: actors
 * in wireframe or points, and wholly transparent ones, cast no shadow.
 *
 * @sa vtkAreaLightSource, vtkShadowReceiver, vtkRadianceMap
 */
#ifndef vtkSoftShadowPass_h
#define vtkSoftShadowPass_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
#include "vtkOpenGLRenderPass.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer

#include <memory> // for unique_ptr
#include <vector> // for props

class vtkFloatArray;
class vtkInformationIntegerKey;
class vtkOpenGLRenderWindow;
class vtkProp;
class vtkRadianceBaker;
class vtkRenderer;

class PENUMBRARENDERING_EXPORT vtkSoftShadowPass : public vtkOpenGLRenderPass
{
public:
  static vtkSoftShadowPass* New();
  vtkTypeMacro(vtkSoftShadowPass, vtkOpenGLRenderPass)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// How receivers show what was baked.
  enum ShadingMode
  {
    SHADOW = 0,  ///< it dims the actor's diffuse shade: radiance over what it would be unblocked
    RADIANCE = 1 ///< it is the shade: the actor's colour times the radiance, no other light
  };

  ///@{
  /**
   * The pass that draws the scene. Default is nullptr: a vtkRenderStepsPass of its own, which draws
   * as a renderer without a pass does.
   */
  void SetDelegatePass(vtkRenderPass* pass);
  vtkRenderPass* GetDelegatePass();
  ///@}

  ///@{
  /**
   * How receivers are shaded that Designate() does not say it for: SHADOW or RADIANCE. Default is
   * SHADOW.
   */
  vtkSetClampMacro(Shading, int, SHADOW, RADIANCE);
  vtkGetMacro(Shading, int);
  ///@}

  ///@{
  /**
   * Whether only props named by Designate() receive shadows, of those whose data have receiver
   * settings. Default is off: all do.
   */
  vtkSetMacro(OnlyDesignated, bool);
  vtkGetMacro(OnlyDesignated, bool);
  vtkBooleanMacro(OnlyDesignated, bool);
  ///@}

  ///@{
  /**
   * While on, what has been baked is shown as it is, whatever has changed since: for frames in
   * which coarser data stand in for the real ones. Default is off.
   */
  vtkSetMacro(KeepBakes, bool);
  vtkGetMacro(KeepBakes, bool);
  vtkBooleanMacro(KeepBakes, bool);
  ///@}

  ///@{
  /**
   * How long a part of a texture a pixel may show, in its widths, without being blurred, 1 to 16:
   * shadows stay sharp where a floor is seen at a grazing angle. Default is 0: 16 on graphics
   * processors, and 1 on software OpenGL, whose frames it would make about twice as long.
   */
  vtkSetClampMacro(MaximumAnisotropy, int, 0, 16);
  vtkGetMacro(MaximumAnisotropy, int);
  ///@}

  ///@{
  /**
   * Name a prop as a receiver with a shading mode of its own, or take that back. It is written into
   * the prop's property keys, for all passes.
   */
  static void Designate(vtkProp* prop, int shading);
  static void Undesignate(vtkProp* prop);
  static vtkInformationIntegerKey* DESIGNATED();
  ///@}

  /**
   * How many times receivers have been baked, each frame in which any was counting once.
   */
  vtkGetMacro(BakeCount, int);

  /**
   * How many receivers the pass shows at present.
   */
  int GetNumberOfReceivers() const;

  /**
   * The texels of a receiver as they are shown, i (along its first edge) fastest: three components
   * of irradiance over pi, and what is blocked, in their mean. The window must be current.
   * Receivers are in the order of their props and of the polygons within each. nullptr if there is
   * no such receiver.
   */
  vtkSmartPointer<vtkFloatArray> GetTexels(int receiver);

  /**
   * Bytes of all textures that the pass holds at present.
   */
  vtkTypeInt64 GetTextureBytes() const;

  void Render(const vtkRenderState* s) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

  ///@{
  /**
   * For VTK's mappers: see vtkOpenGLRenderPass.
   */
  bool PostReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
    std::string& fragmentShader, vtkAbstractMapper* mapper, vtkProp* prop) override;
  bool SetShaderParameters(vtkShaderProgram* program, vtkAbstractMapper* mapper, vtkProp* prop,
    vtkOpenGLVertexArrayObject* VAO = nullptr) override;
  vtkMTimeType GetShaderStageMTime() override;
  ///@}

protected:
  vtkSoftShadowPass();
  ~vtkSoftShadowPass() override;

private:
  vtkSoftShadowPass(const vtkSoftShadowPass&) = delete;
  void operator=(const vtkSoftShadowPass&) = delete;

  struct Internals;
  static vtkInformationIntegerKey* RECEIVER_INDEX();
  void UpdateScene(vtkRenderer* renderer, vtkOpenGLRenderWindow* window);
  void BakeReceivers(vtkOpenGLRenderWindow* window);
  void ChooseShading();
  std::vector<vtkProp*> MarkReceivers();

  vtkSmartPointer<vtkRenderPass> DelegatePass;
  int Shading = SHADOW;
  bool OnlyDesignated = false;
  bool KeepBakes = false;
  int MaximumAnisotropy = 0;
  int BakeCount = 0;
  vtkNew<vtkRadianceBaker> Baker;
  std::unique_ptr<Internals> Impl;
};

#endif

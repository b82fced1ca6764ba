// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSoftShadowPass
 * @brief a render pass that shows soft shadows of area lights on receivers
 *
 * The pass finds the area lights (actors of vtkAreaLightSource's output), the receivers (actors of
 * vtkShadowReceiver's output) and the occluders (every other visible surface) among the renderer's
 * props, bakes the receivers' radiance textures (vtkRadianceBaker), and lets its delegate draw the
 * scene with shaders that read them (Heckbert and Herf 1997). A bake is only redone when something
 * that it depends on has changed; the camera is not among that.
 *
 * Receivers are planar, or have a plane that stands for them: then each point shows what was baked
 * where it is projected to, onto the plane, from the lights' centre
 * (vtkShadowReceiver::ProxyPlane). RADIANCE is the plane's there, its cosine too.
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
 * in wireframe or points, and wholly transparent ones, cast no shadow. Translucent ones weaken
 * light by their opacity o: 1 - o of it passes, tinted by the actor's diffuse colour unless scalars
 * or a texture colour it, and by the alpha of a texture. An actor weakens a ray once, also where
 * the ray enters and leaves it. What its data say (vtkShadowCaster) goes before that.
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
class vtkTable;

namespace penumbra
{
struct ReceiverPlan;
}

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

  /// How much of a bake a frame does.
  enum BakeModes
  {
    COMPLETE = 0,   ///< all of it: every frame is finished
    DRAFT = 1,      ///< what has changed is baked with one sample a light; what is finished stays
    PROGRESSIVE = 2 ///< as DRAFT; frames in which nothing has changed go on, for BatchSeconds each
  };

  ///@{
  /**
   * How much of a bake a frame does. Default is COMPLETE.
   */
  vtkSetClampMacro(BakeMode, int, COMPLETE, PROGRESSIVE);
  vtkGetMacro(BakeMode, int);
  ///@}

  ///@{
  /**
   * About how many seconds a PROGRESSIVE frame spends on baking. Default is 0.1.
   */
  vtkSetMacro(BatchSeconds, double);
  vtkGetMacro(BatchSeconds, double);
  ///@}

  /**
   * How much of what is shown is final, from 0 to 1; 1 as well where nothing is to be baked. When a
   * frame changes it, vtkCommand::ProgressEvent is invoked with it (a double*).
   */
  double GetBakeProgress() const;

  ///@{
  /**
   * The most memory in MiB, 1 or more, that the textures of a view may take, with what is kept to
   * bake less the next time. Where it would be more, receivers get larger texels than they ask for,
   * those with the widest penumbrae first (penumbra::FitTextures), and a warning says so. Any other
   * number is an error, and changes nothing. Default is 256.
   */
  void SetMaximumTextureMemory(double memory);
  vtkGetMacro(MaximumTextureMemory, double);
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

  ///@{
  /**
   * Whether a prop casts shadows. Default is on. It is written into the prop's property keys, for
   * all passes.
   */
  static void SetCastShadow(vtkProp* prop, bool cast);
  static bool GetCastShadow(vtkProp* prop);
  static vtkInformationIntegerKey* CASTS_NO_SHADOW();
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
   * of irradiance over pi, and what is blocked, in their mean. Those that are not shown, beyond a
   * triangle's half, are baked for the answer if another one has their place. The window must be
   * current.
   * Receivers are in the order of their props and of the polygons within each. nullptr if there is
   * no such receiver, or its texture went with its window.
   */
  vtkSmartPointer<vtkFloatArray> GetTexels(int receiver);

  /**
   * What was decided and done for each receiver and light at the last bake that concerned it, a row
   * each: Receiver and Light (indices), Effect, Reason, LightSamples, Texels, Triangles,
   * SceneTriangles, Milliseconds, Bytes, ExactTexels. The table is made anew.
   */
  void GetPlan(vtkTable* table);

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
  int GetShadingOf(vtkProp* prop) const;
  void UpdateScene(vtkRenderer* renderer, vtkOpenGLRenderWindow* window);
  std::vector<penumbra::ReceiverPlan> PlanReceivers();
  /// Gives receivers larger texels where MaximumTextureMemory asks for it.
  void FitTextures(const std::vector<std::vector<std::size_t>>& ofProps,
    std::vector<penumbra::ReceiverPlan>& plans);
  /// Adds the other sides of receivers as receivers, with their plans. The answer is each prop's
  /// receivers, these last.
  std::vector<std::vector<std::size_t>> AddOtherSides(std::vector<penumbra::ReceiverPlan>& plans);
  /// Adds windows of receivers as receivers of their props, with their plans.
  void AddWindows(
    std::vector<std::vector<std::size_t>>& ofProps, std::vector<penumbra::ReceiverPlan>& plans);
  void BakeReceivers(vtkOpenGLRenderWindow* window);
  /// Bakes what is a draft as it is to be: in a PROGRESSIVE frame, as much as there is time for.
  void FinishDrafts();
  void ReportProgress();
  void ChooseShading();
  std::vector<vtkProp*> MarkReceivers();

  vtkSmartPointer<vtkRenderPass> DelegatePass;
  int Shading = SHADOW;
  bool OnlyDesignated = false;
  int BakeMode = COMPLETE;
  double BatchSeconds = 0.1;
  double ReportedProgress = 1.0;
  double MaximumTextureMemory = 256.0;
  int MaximumAnisotropy = 0;
  int BakeCount = 0;
  vtkNew<vtkRadianceBaker> Baker;
  std::unique_ptr<Internals> Impl;
};

#endif

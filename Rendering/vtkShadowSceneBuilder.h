// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowSceneBuilder
 * @brief turns VTK's data into the scene of a bake
 *
 * Data come in by AddData(), each with the matrix of its actor and with the roles that it may play,
 * and go into a penumbra::ShadowScene: polygons, triangle strips and triangles as surfaces that
 * block light, planar regions of data with receiver settings, or their proxy plane, as receivers,
 * and data with light settings as lights. Surfaces with caster settings may let light pass: what is
 * translucent and receives nothing is one surface of the scene for each call of AddData(), which
 * weakens light once. Lights come first where data may need a proxy plane: they
 * decide how it lies (penumbra::PlaceProxy).
 *
 * Data that make no sense (a curved receiver, a light without area, settings out of range) are
 * reported by vtkErrorMacro, with the name under which they came in, and left out; the rest is
 * kept.
 */
#ifndef vtkShadowSceneBuilder_h
#define vtkShadowSceneBuilder_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkObject.h"

#include <set>    // for messages
#include <string> // for names
#include <vector> // for lights

class vtkCompositeDataDisplayAttributes;
class vtkDataObject;
class vtkMatrix4x4;
class vtkPolyData;

class PENUMBRARENDERING_EXPORT vtkShadowSceneBuilder : public vtkObject
{
public:
  static vtkShadowSceneBuilder* New();
  vtkTypeMacro(vtkShadowSceneBuilder, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What data may become; combined by |. Data with light settings are lights or nothing.
  enum Role
  {
    Receiver = 1,        ///< if it carries receiver settings
    DefaultReceiver = 2, ///< with default settings if it carries none
    Occluder = 4,
    Light = 8
  };

  /**
   * Add polygonal data, or composite data of them, in the coordinates of `matrix` (nullptr: the
   * world's). `name` names them in error messages. Blocks that `attributes` (may be nullptr) hides
   * are left out.
   */
  void AddData(vtkDataObject* data, vtkMatrix4x4* matrix, int roles, const std::string& name,
    vtkCompositeDataDisplayAttributes* attributes = nullptr);

  /**
   * How the surfaces of data that come in from now on cast shadows, but for what the data
   * themselves say. They are opaque by default.
   */
  void SetCaster(const penumbra::CasterSettings& caster) { this->Caster = caster; }

  ///@{
  /**
   * Lights that others have added: with those of the data, they decide how proxy planes lie.
   * Whether any data needed to know them.
   */
  void SetLights(const std::vector<penumbra::Light>& lights) { this->OtherLights = lights; }
  bool DependsOnLights() const { return this->HasProxy; }
  ///@}

  ///@{
  /**
   * The errors and warnings so far, and those that are not to be printed again: of an earlier
   * scene, much of which is the same.
   */
  const std::set<std::string>& GetMessages() const { return this->Messages; }
  void SetEarlierMessages(const std::set<std::string>& messages)
  {
    this->EarlierMessages = messages;
  }
  ///@}

  /**
   * The scene so far.
   */
  const penumbra::ShadowScene& GetScene() const { return this->Scene; }

  /**
   * What makes polygonal data unfit to receive shadows with these settings, or the settings
   * themselves, and what is allowed; empty if they are fit.
   */
  static std::string FindReceiverProblem(
    vtkPolyData* data, const penumbra::ReceiverSettings& settings);

  /**
   * What makes polygons unfit to be a light of many cells, and what is allowed; empty if they are
   * fit.
   */
  static std::string FindSurfaceLightProblem(
    vtkPolyData* data, const penumbra::LightSettings& settings);

protected:
  vtkShadowSceneBuilder();
  ~vtkShadowSceneBuilder() override;

private:
  vtkShadowSceneBuilder(const vtkShadowSceneBuilder&) = delete;
  void operator=(const vtkShadowSceneBuilder&) = delete;

  void AddPolyData(vtkPolyData* data, vtkMatrix4x4* matrix, int roles, const std::string& name);
  void AddLight(vtkPolyData* data, const penumbra::LightSettings& settings, vtkMatrix4x4* matrix,
    const std::string& name);
  /// `problem` is what has been reported of the data.
  void AddSurface(vtkPolyData* data, vtkMatrix4x4* matrix,
    const penumbra::ReceiverSettings* receiver, const std::string& name, std::string problem);
  glm::dvec3 FindTransmittance(vtkPolyData* data, const std::string& name);
  void AddTranslucent(penumbra::Surface surface);
  /// The answer is empty or the problem that was reported.
  std::string AddReceivers(vtkPolyData* polygons, const penumbra::ReceiverSettings& settings,
    const penumbra::Surface& surface, bool isMirrored, const std::string& name);
  void ReportError(const std::string& message);
  void ReportWarning(const std::string& message);
  bool IsNew(const std::string& message);

  penumbra::ShadowScene Scene;
  std::vector<penumbra::Light> OtherLights;
  penumbra::CasterSettings Caster;
  std::vector<penumbra::Surface> Translucent; ///< of the data that are being added
  bool HasProxy = false;
  std::set<std::string> Messages;
  std::set<std::string> EarlierMessages;
};

#endif

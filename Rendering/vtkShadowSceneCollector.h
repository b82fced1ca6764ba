// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShadowSceneCollector
 * @brief finds the lights, receivers and occluders among a renderer's props
 *
 * All visible props count, also those outside the camera's view: their shadows may fall into it.
 * Surfaces block light, or weaken it by the opacity and the diffuse colour of their actor
 * (penumbra::GetTransmittance; coloured by scalars or a texture: by the opacity alone), unless
 * vtkSoftShadowPass::SetCastShadow() or their data say otherwise. Update() remembers what it saw,
 * so that it can tell whether anything that a bake depends on has changed since. Surfaces of actors
 * that have not changed are the same penumbra::SharedSurface.
 *
 * Points drawn as spheres and lines drawn as tubes cast with the size that they have in the view,
 * at the middle of their actor, when they are first seen. They keep it while the camera moves,
 * until it is zoomed (the world's length of a pixel at its focal distance) by more than a factor
 * of 2.
 */
#ifndef vtkShadowSceneCollector_h
#define vtkShadowSceneCollector_h

#include "DrawnSlice.h"              // for slices of images
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer
#include "vtkWeakPointer.h"  // for vtkWeakPointer

#include <cstddef> // for counts
#include <cstdint> // for the signature
#include <map>     // for sizes
#include <set>     // for warnings
#include <string>  // for warnings
#include <vector>  // for receivers

class vtkProp;
class vtkRenderer;
class vtkShadowSceneBuilder;

class PENUMBRARENDERING_EXPORT vtkShadowSceneCollector : public vtkObject
{
public:
  static vtkShadowSceneCollector* New();
  vtkTypeMacro(vtkShadowSceneCollector, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// A prop with the receivers in its data, as indices into the scene's.
  struct ReceiverProp
  {
    /// Weak, since mappers hold on to the passes that drew them: no prop may be held by its pass.
    vtkWeakPointer<vtkProp> Prop;
    std::vector<std::size_t> Receivers;
  };

  /**
   * Look at the renderer's props. True if something that a bake depends on has changed since the
   * last call (visibility, geometry, block visibility, matrices, settings): then the scene is a new
   * one. While actors with levels of detail have only coarser data at hand, nothing has changed.
   * With `onlyDesignated`, only props that carry vtkSoftShadowPass::DESIGNATED() may receive
   * shadows. Call it while the renderer draws: its cullers have then brought the data of its actors
   * up to date, and this does not ask for that again.
   */
  bool Update(vtkRenderer* renderer, bool onlyDesignated);

  /// How many actors, parts of assemblies among them, the last Update() made surfaces, receivers or
  /// lights of: those that were new or had changed.
  std::size_t GetNumberOfBuiltParts() const { return this->NumberOfBuiltParts; }

  const penumbra::ShadowScene& GetScene() const { return this->Scene; }
  const std::vector<ReceiverProp>& GetReceiverProps() const { return this->ReceiverProps; }

protected:
  vtkShadowSceneCollector();
  ~vtkShadowSceneCollector() override;

private:
  vtkShadowSceneCollector(const vtkShadowSceneCollector&) = delete;
  void operator=(const vtkShadowSceneCollector&) = delete;

  using Signature = std::vector<std::uint64_t>;
  /// What was made of one actor: it stays the same for as long as its signature does.
  struct Part
  {
    Signature Seen;
    vtkSmartPointer<vtkShadowSceneBuilder> Builder;
    vtkWeakPointer<vtkProp> Prop;
    double PixelLength = 0.0; ///< penumbra::DrawnActor::PixelLength
    bool IsNew = false;       ///< while it is being built

    /// Begins anew; messages of an earlier builder (nullptr: none) are not printed again.
    void MakeBuilder(const vtkShadowSceneBuilder* earlier);
  };
  /// The size of what is drawn in pixels: the world's length of one.
  struct PixelSize
  {
    double Length = 0.0;      ///< at the middle of the part
    double FocalLength = 0.0; ///< at the camera's focal distance
  };
  /// The size that the part had until now, unless the camera has been zoomed since.
  PixelSize ChooseSize(const Signature& seen, const PixelSize& now) const;
  void Build(vtkRenderer* renderer, bool onlyDesignated);
  /// The parts that there are now, those that have not changed with their builders of before.
  std::vector<Part> TakeParts(vtkRenderer* renderer, bool onlyDesignated);
  void Assemble();
  /// Volumes and slices of images that cannot be found, which cast no shadow; actors whose shadow
  /// is not their picture's.
  void WarnOfVolumes(vtkRenderer* renderer);
  void WarnOfActors(vtkRenderer* renderer);

  penumbra::SliceActors Slices;
  std::set<std::string> Said;                ///< warnings, each once
  std::map<Signature, PixelSize> PixelSizes; ///< by what was seen of the part but for the size
  std::vector<Part> Parts;                   ///< in the order of the renderer's props
  penumbra::ShadowScene Scene;
  std::vector<ReceiverProp> ReceiverProps;
  std::size_t NumberOfBuiltParts = 0;
};

#endif

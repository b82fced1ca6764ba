// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkBakedProp
 * @brief the radiance of the receivers of one prop, kept up to date
 *
 * Update() bakes what has changed since the last time, and no more: the texels that an occluder may
 * shade that came, went or moved; without drawing, where only a light's radiance is another. What
 * it leaves is, to the bit, what a whole bake of the same scene gives.
 *
 * Receivers whose light is smooth have a few vertices instead of texels
 * (penumbra::ShadingVertices); a prop whose receivers have no shadow and no hue to show has no
 * texture. Two triangles share a rectangle of texels (penumbra::AtlasLayout).
 */
#ifndef vtkBakedProp_h
#define vtkBakedProp_h

#include "EffectPlanner.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceBaker.h" // for its reports
#include "vtkWeakPointer.h"   // for vtkWeakPointer

#include <limits> // for limits that are none
#include <vector> // for receivers

class vtkOpenGLRenderWindow;
class vtkRadianceTexture;

class PENUMBRARENDERING_EXPORT vtkBakedProp : public vtkObject
{
public:
  static vtkBakedProp* New();
  vtkTypeMacro(vtkBakedProp, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What Update() did.
  enum class Outcome
  {
    Unchanged,
    Baked,
    Failed ///< after vtkErrorMacro: there is nothing to show
  };

  /**
   * Of a receiver, how many vertices along each edge stand for its radiance; 0: it takes texels.
   */
  static int CountVertices(const penumbra::ReceiverPlan& plan,
    const penumbra::ReceiverSettings& settings, bool showsRadiance);

  /**
   * The most bytes that may be kept for each texel, to bake less the next time.
   */
  void SetKeptBytesPerTexel(double bytes);

  /**
   * Bring the radiance up to date.
   *
   * @param baker has taken up the scene
   * @param receivers the prop's, as indices into the scene's
   * @param plans of all receivers of the scene
   * @param window must be current
   * @param showsRadiance whether radiance is shown, or shadows alone: without shadows, there is
   * then nothing to bake
   * @param draft whether what has changed is baked with one sample a light: Finish() does the rest
   */
  Outcome Update(vtkRadianceBaker* baker, const penumbra::ShadowScene& scene,
    const std::vector<std::size_t>& receivers, const std::vector<penumbra::ReceiverPlan>& plans,
    vtkOpenGLRenderWindow* window, bool showsRadiance, bool draft);

  /**
   * Bake what is a draft with all samples: all of it, or, if `seconds` > 0, tile by tile for about
   * so long. `baker` has taken up the scene of the last Update(). Tiles change no bit.
   */
  Outcome Finish(vtkRadianceBaker* baker, double seconds);

  ///@{
  /**
   * The texels that are drafts, but for what is done of them already; and all.
   */
  double CountDraftTexels() const;
  double CountTexels() const;
  ///@}

  /**
   * False if there is nothing to show: no receiver has a shadow, and radiance is not shown.
   */
  bool HasTexture() const { return this->IsTextured; }

  /**
   * The texture, whose regions are in the order of the receivers.
   */
  vtkRadianceTexture* GetTexture() { return this->Texture; }

  /// A receiver, and what was done for it.
  struct Entry
  {
    std::size_t Receiver = 0; ///< index into the scene's
    penumbra::SharedSurface Surface;
    penumbra::Receiver Settings;
    penumbra::ReceiverPlan Plan;    ///< of its texels
    penumbra::Parallelogram Base;   ///< that the texture's region covers
    int Vertices = 0;               ///< along each edge; 0: it has texels
    penumbra::TexelRectangle Draft; ///< the texels that have one sample a light
    std::vector<vtkRadianceBaker::KeptLight> Kept;
    vtkRadianceBaker::Report Report; ///< of its last bake
    bool HasWindows = false;         ///< that are entries: its own texels have no small shadows
    /// The mean of what arrives at its middle, irradiance over pi, were nothing in the way.
    float MiddleLight = 0.0f;
  };
  const std::vector<Entry>& GetEntries() const { return this->Entries; }

  /**
   * How many of the entries are parts of others, their windows (penumbra::Receiver::WindowOf) or
   * other sides (penumbra::Receiver::OtherSideOf): the last ones.
   */
  std::size_t CountParts() const;

  /**
   * What was done for an entry, and for the windows that it has.
   */
  vtkRadianceBaker::Report GetReport(std::size_t entry) const;

  /**
   * A receiver's texels, as vtkRadianceTexture::Texels::Irradiance: those of the texture; what its
   * vertices stand for, or lies in a half that is another triangle's, baked anew. `window` must be
   * current.
   */
  std::vector<glm::vec4> Download(
    const penumbra::ShadowScene& scene, std::size_t entry, vtkOpenGLRenderWindow* window);

  /**
   * The bytes of the texture and of all that is kept to bake less the next time.
   */
  std::size_t GetBytes() const;

  /**
   * Free what Finish() has begun.
   */
  void DropTile();

  /**
   * Free the textures.
   */
  void ReleaseGraphicsResources();

protected:
  vtkBakedProp();
  ~vtkBakedProp() override;

private:
  vtkBakedProp(const vtkBakedProp&) = delete;
  void operator=(const vtkBakedProp&) = delete;

  bool IsSameLayout(const std::vector<Entry>& entries, vtkOpenGLRenderWindow* window) const;
  bool Bake(vtkRadianceBaker* baker, Entry& entry, std::size_t region,
    const penumbra::TexelRectangle& rectangle, bool draft);
  bool FinishTiles(
    vtkRadianceBaker* baker, Entry& entry, std::size_t region, double seconds, double until);
  void BeginTile(const Entry& entry, std::size_t region);
  /// Bakes into a new texture; what the entries of before, which are those of the texture of
  /// before, have is copied, and of it only what has changed is baked.
  Outcome BakeAll(vtkRadianceBaker* baker, std::vector<Entry> entries, std::vector<Entry> before,
    vtkRadianceTexture* texture, bool draft);
  Outcome BakeChanges(vtkRadianceBaker* baker, std::vector<Entry> entries, bool draft);
  /// Bakes what has changed of an entry, whose region has what it was before. Outcome::Unchanged if
  /// that is nothing.
  Outcome BakeChange(
    vtkRadianceBaker* baker, Entry& now, Entry& before, std::size_t region, bool draft);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkRadianceTexture> Texture;
  std::vector<Entry> Entries;
  bool IsTextured = false;
  double KeptBytesPerTexel = std::numeric_limits<double>::infinity();
  /// What Finish() is about, from frame to frame.
  struct Tile
  {
    std::size_t Region = 0;
    penumbra::TexelRectangle Rectangle; ///< empty: there is none
    penumbra::TexelRectangle Left;      ///< of the draft, without it
    penumbra::PartMasks Masks;
  };
  Tile Begun;
  int TileSide = 32; ///< of the next tile: about what is resolved in a part of a batch
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Everything that a bake depends on.
 */
#ifndef ShadowScene_h
#define ShadowScene_h

#include "ClusterTree.h"
#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "PlanarRegions.h"
#include "ReceiverFrame.h"
#include "ShadowSettings.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace penumbra
{

/// A triangulated surface in world coordinates.
struct Surface
{
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<glm::dvec3> Points;
  std::vector<Triangle> Triangles;
  /// Of each triangle, the receiver region that it belongs to; empty if the surface receives
  /// nothing.
  std::vector<int> Regions;
  /// How far the coordinates may be off by the rounding of their type, along each axis.
  glm::dvec3 Rounding{ 0.0 };
  /// The share of light that passes (red, green, blue), 0 to 1 each: 0 blocks, 1 casts no shadow.
  /// The surface weakens a ray once, however many of its triangles the ray crosses.
  glm::dvec3 Transmittance{ 0.0 };

  bool IsTranslucent() const { return this->Transmittance != glm::dvec3(0.0); }
  bool CastsShadow() const { return this->Transmittance != glm::dvec3(1.0); }
};

/**
 * Finds which triangles hang together, by points that are at the same place: the answer has an
 * index for each triangle, the same for all of a connected part.
 */
PENUMBRARENDERING_EXPORT std::vector<std::uint32_t> FindConnectedParts(
  const std::vector<glm::dvec3>& points, const std::vector<Surface::Triangle>& triangles);

/**
 * A surface that scenes share for as long as it does not change, with the tree of its triangles.
 */
class PENUMBRARENDERING_EXPORT SharedSurface
{
public:
  SharedSurface(Surface surface);

  const Surface& operator*() const { return this->Shared->Contents; }
  const Surface* operator->() const { return &this->Shared->Contents; }
  const ClusterTree& GetClusters() const { return this->Shared->Clusters; }
  /// Of each triangle, the connected part that it belongs to (FindConnectedParts); found when it is
  /// first asked for.
  const std::vector<std::uint32_t>& GetParts() const;

  /// Whether both are the same one, not only alike.
  bool operator==(const SharedSurface& other) const { return this->Shared == other.Shared; }
  bool operator!=(const SharedSurface& other) const { return this->Shared != other.Shared; }

private:
  struct Indexed
  {
    explicit Indexed(Surface&& surface);

    Surface Contents;
    ClusterTree Clusters;
    mutable std::once_flag PartsAreFound;
    mutable std::vector<std::uint32_t> Parts;
  };
  std::shared_ptr<const Indexed> Shared;
};

/// A receiver: one planar region of one surface, or a plane that stands for all of it.
struct PENUMBRARENDERING_EXPORT Receiver
{
  std::size_t Surface = 0;
  int Region = 0;
  Parallelogram Base;
  /// It fills the lower left half of its base, where u + v <= 1: what is beyond is baked, but not
  /// shown.
  bool IsTriangle = false;
  /// How far its own points are off its plane, in the world: what its surface has no higher above
  /// it is no occluder of it.
  double Deviation = 0.0;
  /// Its side is never Both: vtkShadowSceneBuilder makes two receivers of these settings.
  ReceiverSettings Settings;
  /// It is one side of a region whose other side is a receiver, too: ReceiverSide::Both.
  bool IsOneOfBoth = false;
  /// It is the back of these: as data, its texels are in the order of a parallelogram with the
  /// edges exchanged, whose normal is that of the back.
  bool IsTurned = false;
  /// The closed surface that it is a part of, if it is and no light passes it.
  std::optional<ClosedSurface> Enclosed;
  /// Texels along EdgeX and EdgeY.
  glm::ivec2 Texels{ 1 };
  /// ChooseTexels() has chosen the texels without a TexelSize: shadows that these are too large for
  /// get finer ones of their own (PlanWindows).
  bool IsAutomatic = false;
  /// Of a window of another receiver that is shown by itself (FineWindow): that one's index among
  /// the scene's.
  std::optional<std::size_t> WindowOf;
  /// Of the other side of a receiver, which is lit, too, and shown with it: that one's index among
  /// the scene's.
  std::optional<std::size_t> OtherSideOf;
  /// Of a plane that stands for a surface (PlaceProxy): the surface's points are projected onto it
  /// from here, homogeneous, in the world.
  std::optional<glm::dvec4> ProxyCentre;

  /// Of the texels times Supersampling squared.
  double GetBakedTexels() const;

  ///@{
  /// As data: the parallelogram, the texels along its edges, and which texel is the i-th.
  Parallelogram GetDataBase() const;
  glm::ivec2 GetDataTexels() const;
  std::size_t GetTexelOfData(std::size_t i) const;
  ///@}
};

/**
 * The surfaces, receivers and lights of a bake, free of VTK. All surfaces block light, or weaken it
 * by their transmittance, those of the receivers among them; the lights' own surfaces do not.
 */
struct PENUMBRARENDERING_EXPORT ShadowScene
{
  std::vector<SharedSurface> Surfaces;
  std::vector<Receiver> Receivers;
  std::vector<Light> Lights;

  /// The largest texture side and the most bytes that a surface's textures may take.
  static constexpr int MaximumTextureSide = 16384;
  static constexpr double MaximumTextureBytes = 256.0 * 1024 * 1024;
  /// Bytes of a texel: 16 of irradiance and, once it is shown, either 4 of vtkShadowFactors with a
  /// third more for its mip levels, or the mip levels of the irradiance itself, as many; while it
  /// is being baked, 4 of variance instead.
  static constexpr int BytesPerTexel = 22;

  /**
   * Sets the texels of the receivers from `first` on, which share a texture: along each edge as
   * many of TexelSize as cover it (0: 512 along the receiver's longest edge). Where they would pass
   * the limits above, the texels grow; the answer is by how much, 1 if not at all. Triangles count
   * with all of their texels, though they may share them when they are shown (AtlasLayout).
   */
  double ChooseTexels(std::size_t first);

  /// Adds all that is in another scene.
  void Append(const ShadowScene& other);

  /// The frame of a receiver with its lit side, which Auto chooses by the light that its centre
  /// gets.
  ReceiverFrame MakeFrame(const Receiver& receiver) const;

  /**
   * The lights in an order that depends on nothing but the lights themselves: sums over them come
   * out the same, to the bit, in whatever order they were added.
   */
  std::vector<std::size_t> GetLightOrder() const;
};

} // namespace penumbra

#endif

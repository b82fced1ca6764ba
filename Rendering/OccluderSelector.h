// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Which triangles may block a light from a receiver, and where their shadows may fall.
 */
#ifndef OccluderSelector_h
#define OccluderSelector_h

#include "BlockingRegion.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowBounds.h"
#include "ShadowScene.h"

#include <limits>
#include <unordered_map>
#include <vector>

namespace penumbra
{

/// A surface of the scene that may block a light from a receiver.
struct Caster
{
  std::size_t Surface = 0;   ///< index into the scene's
  std::size_t Triangles = 0; ///< how many of its triangles may
  std::size_t First = 0;     ///< of these, in GetTriangles() or GetTranslucent()
  double Rounding = 0.0;     ///< how far their points may be off, in units of the receiver's size
  ShadowBounds Shadow;
};

/// The shadow of a connected part of a surface.
struct PartShadow
{
  ShadowBounds Bounds;
  ///@{
  /// From the light's centre alone, in u and v: where it is, and the area of its triangles'
  /// shadows, added up.
  glm::dvec2 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec2 High{ -std::numeric_limits<double>::infinity() };
  double Area = 0.0;
  ///@}
  double Lowest = std::numeric_limits<double>::infinity(); ///< height of its points that may block
  double Highest = 0.0;
};

/**
 * Selects, for one receiver and one light after the other, the triangles that reach between them
 * (BlockingRegion); of triangles that go far beyond, the part that does. Only clusters of triangles
 * that touch the region are looked at, and brought into the receiver's frame, in double: what is
 * close to the receiver keeps its height, wherever in the world it is.
 *
 * Triangles of the receiver itself are left out, and surfaces that cast no shadow. What lies in the
 * receiver's plane, or in that of a flat light, but for the rounding of coordinates, blocks
 * nothing: a rug on a floor, a ceiling around a lamp.
 */
class PENUMBRARENDERING_EXPORT OccluderSelector
{
public:
  using Triangle = Surface::Triangle;

  /// Take up a scene, which is kept by reference.
  void SetScene(const ShadowScene& scene);

  /// Take up a receiver of the scene, which is kept by reference.
  void SetReceiver(const Receiver& receiver, const ReceiverFrame& frame);

  /**
   * Select the triangles that may block `seen`, the light's part in front of the receiver, from the
   * part of the receiver in `range`: (u, v) from its low to its high corner, some texels wide.
   */
  void Select(const LightShape& seen, const glm::dvec4& range = { 0.0, 0.0, 1.0, 1.0 });

  ///@{
  /// Whether Select() also finds the shadow of each connected part. Default is false.
  void SetFindsParts(bool finds) { this->FindsParts = finds; }
  const std::vector<PartShadow>& GetParts() const { return this->PartShadows; }
  ///@}

  /// Select the triangles of the whole scene, wherever they are: to check Select() by.
  void SelectAll(const LightShape& seen);

  /// Points in the receiver's frame, to which triangles refer; others may be among them.
  const std::vector<glm::dvec3>& GetPoints() const { return this->Points; }
  /// The triangles of opaque surfaces, and those of translucent ones, surface by surface.
  const std::vector<Triangle>& GetTriangles() const { return this->Selected; }
  const std::vector<Triangle>& GetTranslucent() const { return this->Translucent; }
  /// The surfaces that these are of.
  const std::vector<Caster>& GetCasters() const { return this->Casters; }
  /// Those among them that are translucent.
  std::vector<Caster> GetTranslucentCasters() const;

  /// Of each point, a height that all of its surface is below.
  const std::vector<double>& GetTops() const { return this->Tops; }

  /// Forget the receiver.
  void Clear();

private:
  /// Of each point of a surface its index in Points, or NoPlace. It is made by pages, where points
  /// are looked at: what is elsewhere in a large surface costs a receiver next to nothing.
  class PlaceTable
  {
  public:
    void Resize(std::size_t points);
    std::uint32_t& operator[](std::uint32_t point);

  private:
    std::size_t Size = 0;
    std::vector<std::vector<std::uint32_t>> Pages;
  };
  /// What is known of a surface in the receiver's frame.
  struct Part
  {
    PlaceTable Places;
    glm::dvec3 Uncertainty{ 0.0 }; ///< of its points, in the world, along each axis
    double Contact = 0.0;          ///< the height up to which a point may lie in the receiver
    double Top = 0.0;              ///< a height that no point is above
  };
  /// What Select() goes by.
  struct Search
  {
    BlockingRegion Region; ///< of the part of the receiver
    BlockingRegion Whole;  ///< of all of it, by which triangles are cut: the same for all parts
    ShadowProjector Projector;
    ConvexRegion Planes;    ///< of Region, in the world; none: all is looked at, and taken
    glm::dvec3 LightNormal; ///< of a flat light, its components' sizes
  };

  Search MakeSearch(const LightShape& seen, const glm::dvec4& range) const;
  void Run(const Search& search);
  Part& GetPart(std::size_t surface);
  std::uint32_t AddPoint(const glm::dvec3& point, const Part& part);
  std::uint32_t GetPlace(Part& part, const Surface& surface, std::uint32_t point);
  void SelectFrom(std::size_t surface, const Search& search);
  bool MayBlock(const Triangle& triangle, const Part& part, const Search& search) const;
  void AddTriangle(const Triangle& triangle, const Part& part, const Search& search,
    std::vector<Triangle>& selected, ShadowBounds& shadow);
  void NotePoint(std::uint32_t place, const Search& search, ShadowBounds& shadow);
  PartShadow& GetPartShadow(std::uint32_t part);
  void NotePart(std::uint32_t part, std::size_t first, const Search& search,
    const std::vector<Triangle>& selected);

  const ShadowScene* Scene = nullptr;
  ClusterTree Surfaces; ///< the scene's, by their boxes
  const Receiver* Base = nullptr;
  ReceiverFrame Frame;
  std::unordered_map<std::size_t, Part> Parts; ///< of the surfaces that were looked at
  std::vector<glm::dvec3> Points;              ///< of the surfaces, and those that cutting made
  std::vector<double> Tops;                    ///< of each point
  std::vector<std::uint32_t> NotedBy; ///< of each point, the last selection that noted its shadow
  std::uint32_t Selections = 0;
  std::vector<Triangle> Selected;
  std::vector<Triangle> Translucent;
  std::vector<Caster> Casters;
  bool FindsParts = false;
  std::vector<PartShadow> PartShadows;
  /// Where the parts of the surface that is looked at are in PartShadows.
  std::unordered_map<std::uint32_t, std::size_t> PartPlaces;
};

} // namespace penumbra

#endif

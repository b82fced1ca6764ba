// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Where a texture is transparent, and polygons cut along that.
 */
#ifndef AlphaMap_h
#define AlphaMap_h

#include "PenumbraRenderingModule.h" // for the export macro

#include "Vectors.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace penumbra
{

/// What lies beyond a texture's edges.
enum class TextureWrap
{
  Edge,   ///< the texels at the edge go on
  Repeat, ///< the texture again
  Mirror, ///< the texture again, every other one mirrored
  Border  ///< one alpha
};

/// The alpha of a texture.
struct AlphaTexels
{
  glm::ivec2 Size{ 0 };      ///< columns, rows
  std::vector<double> Alpha; ///< 0 to 1, row by row from the texture coordinates (0, 0) on
  TextureWrap Wrap = TextureWrap::Repeat;
  double Border = 0.0; ///< the alpha beyond the edges for TextureWrap::Border
};

/**
 * The plane of texture coordinates divided into rectangles of one alpha each: bands of rows that
 * are alike (or of columns, if that makes fewer), and runs of one alpha in these. Cells are texels,
 * or the means of some. If more than `levels` alphas occur, they are rounded to multiples of
 * 1 / levels, and edges that are smoothed over two cells become sharp: a translucent cell with both
 * opaque and transparent ones within two cells becomes what it is nearer to. How texels are
 * interpolated is not looked at: edges of alpha are right to half a cell.
 */
class PENUMBRARENDERING_EXPORT AlphaMap
{
public:
  /// Means of `step` x `step` texels (1 or more) are taken for one.
  AlphaMap(const AlphaTexels& texels, int step, int levels);

  /// A corner of a polygon, and what is linear on the polygon.
  struct Corner
  {
    glm::dvec2 Place{ 0.0 }; ///< texture coordinates
    glm::dvec3 Point{ 0.0 };
    double Value = 0.0; ///< anything
  };

  /// A part of a polygon, as a fan of triangles about the first corner. If `IsAround`, that lies
  /// inside, and the fan closes.
  struct Piece
  {
    double Alpha = 1.0;
    std::vector<Corner> Corners;
    bool IsAround = false;

    std::size_t CountTriangles() const { return this->Corners.size() - (this->IsAround ? 1 : 2); }
  };

  /// Whether to go on.
  using Visitor = std::function<bool(const Piece&)>;

  /**
   * Calls visit(piece) for each part of the triangle whose alpha is above 0, until that is false;
   * the answer is its last one. Parts have a corner wherever their neighbours have one, so that no
   * rounding opens a gap between them. A triangle that is a line or a point of the texture has the
   * alphas there.
   */
  bool VisitPieces(const std::array<Corner, 3>& triangle, const Visitor& visit) const;

private:
  static constexpr int EdgeWidth = 2; ///< cells: of an edge that is smoothed
  static constexpr std::size_t Root = 0;
  using Polygon = std::vector<Corner>;

  /// A rectangle, or a line that halves one.
  struct Node
  {
    int Axis = -1;     ///< which the line is at right angles to; -1 for a rectangle of one alpha
    double Line = 0.0; ///< where the two children meet
    std::array<std::size_t, 2> Children{}; ///< below the line, above it
    double Alpha = 0.0;
    glm::ivec2 Low{ 0 }, High{ 0 }; ///< the rectangle, as indices into Lines
    /// The places of other rectangles' corners along its sides at Low.x, High.x, Low.y and High.y.
    std::array<std::vector<double>, 4> Sides;
  };

  void SetCells(const AlphaTexels& texels, int step);
  void Round(int levels);
  glm::ivec2 GetSize() const; ///< the columns and rows of cells
  double GetCell(const glm::ivec2& at) const;
  bool IsEdge(const glm::ivec2& at) const;
  /// Where rows (axis 1) or columns (axis 0) of a rectangle are not those before them.
  std::vector<int> FindChanges(const glm::ivec2& low, const glm::ivec2& high, int axis) const;
  /// The first node is that of all cells.
  std::size_t Build(const glm::ivec2& low, const glm::ivec2& high, int bands);
  std::vector<bool> FindCorners() const;
  void FindSides();
  static void Split(const Polygon& polygon, int axis, double line, Polygon& below, Polygon& above);
  bool VisitPeriods(const Polygon& polygon, int axis, const Visitor& visit) const;
  bool VisitNode(std::size_t index, const Polygon& polygon, const Visitor& visit) const;
  Piece MakePiece(const Node& rectangle, const Polygon& polygon) const;
  /// The corners of other rectangles between two corners on one side of a rectangle, in order.
  Polygon FindBetween(const Node& rectangle, const Corner& a, const Corner& b) const;

  std::array<std::vector<double>, 2> Lines; ///< between the columns, and between the rows, of cells
  std::vector<double> Cells;                ///< their alphas
  double Period = 0.0; ///< all repeats at this distance; 0 if the outermost cells go on for ever
  std::vector<Node> Nodes;
};

} // namespace penumbra

#endif

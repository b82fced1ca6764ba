// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkOccluderGeometry
 * @brief the triangles that may block light from a receiver, in its frame, as OpenGL buffers
 *
 * Points are brought into the receiver's frame in double precision before they become floats: what
 * is close to the receiver keeps its height to a relative precision of 1e-7, wherever in the world
 * it is. Triangles of the receiver itself are left out, as are those wholly below it. For each
 * light only those are taken that reach between it and the receiver (penumbra::BlockingRegion); of
 * triangles that go far beyond, the part that does.
 *
 * What lies in the receiver's plane, or in that of a flat light, but for the rounding of
 * coordinates, blocks nothing: a rug on a floor, a ceiling around a lamp.
 */
#ifndef vtkOccluderGeometry_h
#define vtkOccluderGeometry_h

#include "BlockingRegion.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"

#include <vector> // for triangles

class vtkOpenGLBufferObject;
class vtkShaderProgram;

class PENUMBRARENDERING_EXPORT vtkOccluderGeometry : public vtkObject
{
public:
  static vtkOccluderGeometry* New();
  vtkTypeMacro(vtkOccluderGeometry, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Bring the scene into the frame of `receiver`. Both are kept by reference.
   */
  void SetReceiver(const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver,
    const penumbra::ReceiverFrame& frame);

  /**
   * Select the triangles that have a point above the receiver and within the region, and do not lie
   * in the light. The answer is how many there are.
   */
  std::size_t Select(const penumbra::BlockingRegion& region);

  /**
   * Upload the triangles that were selected last. Needs a current OpenGL context. False, after
   * vtkErrorMacro, if OpenGL refuses.
   */
  bool Upload();

  /**
   * How many triangles were selected.
   */
  std::size_t GetNumberOfTriangles() const { return this->Selected.size(); }

  /**
   * Draw all triangles `instances` times with the current program, whose attribute vertexUVH gets
   * (u, v, h).
   */
  void Draw(vtkShaderProgram* program, int instances);

  /**
   * Free the OpenGL buffers.
   */
  void ReleaseGraphicsResources();

protected:
  vtkOccluderGeometry();
  ~vtkOccluderGeometry() override;

private:
  vtkOccluderGeometry(const vtkOccluderGeometry&) = delete;
  void operator=(const vtkOccluderGeometry&) = delete;

  /// The corners of a triangle: indices into Points.
  using Triangle = penumbra::Surface::Triangle;
  void AddClipped(const Triangle& triangle, const penumbra::BlockingRegion& region);

  std::vector<glm::dvec3> Points; ///< of all surfaces, in the frame, then those that clipping made
  std::size_t ScenePoints = 0;    ///< how many are the surfaces'
  /// Of each surface: all triangles that may block any light, and how far its points may be off, in
  /// the world, along each axis.
  struct Part
  {
    std::vector<Triangle> Triangles;
    glm::dvec3 Uncertainty{ 0.0 };
  };
  std::vector<Part> Parts;
  std::vector<Triangle> Selected;
  vtkNew<vtkOpenGLBufferObject> Vertices;
  vtkNew<vtkOpenGLBufferObject> Indices;
  std::size_t IndexCount = 0;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkOccluderGeometry
 * @brief the triangles that may block light from a receiver, in its frame, as OpenGL buffers
 *
 * Points are brought into the receiver's frame in double precision before they become floats: what
 * is close to the receiver keeps its height to a relative precision of 1e-7, wherever in the world
 * it is. Triangles of the receiver itself are left out, as are those wholly below it or above all
 * lights.
 */
#ifndef vtkOccluderGeometry_h
#define vtkOccluderGeometry_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "ShadowScene.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"

class vtkOpenGLBufferObject;
class vtkShaderProgram;

class PENUMBRARENDERING_EXPORT vtkOccluderGeometry : public vtkObject
{
public:
  static vtkOccluderGeometry* New();
  vtkTypeMacro(vtkOccluderGeometry, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Select and upload the triangles for `receiver`, whose frame is `frame`. Only those reach
   * between the receiver and its lights that have a point at h in (GetContactTolerance(),
   * maximumHeight). Needs a current OpenGL context if any triangle is left.
   */
  void Build(const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver,
    const penumbra::ReceiverFrame& frame, double maximumHeight);

  /**
   * How many triangles may block light.
   */
  std::size_t GetNumberOfTriangles() const { return this->IndexCount / 3; }

  /**
   * The height, in units of the receiver's size, up to which surfaces count as lying in the
   * receiver: 1e-6, or four times what the rounding of the coordinates can amount to.
   */
  double GetContactTolerance() const { return this->ContactTolerance; }

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

  vtkNew<vtkOpenGLBufferObject> Vertices;
  vtkNew<vtkOpenGLBufferObject> Indices;
  std::size_t IndexCount = 0;
  double ContactTolerance = 0.0;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkOccluderGeometry
 * @brief the triangles that may block light from a receiver, as OpenGL buffers
 *
 * penumbra::OccluderSelector selects them, and keeps their points in the receiver's frame in double
 * precision; here they become floats.
 */
#ifndef vtkOccluderGeometry_h
#define vtkOccluderGeometry_h

#include "OccluderSelector.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
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
   * Upload the triangles that were selected last. Needs a current OpenGL context. False, after
   * vtkErrorMacro, if OpenGL refuses.
   */
  bool Upload(const penumbra::OccluderSelector& occluders);

  /**
   * Draw all triangles `instances` times with the current program, whose attribute vertexUVHT gets
   * (u, v, h) and a height that all of the vertex's surface is below.
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
};

#endif

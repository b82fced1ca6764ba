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

#include <vector> // for sets

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
   * The triangles come in sets: 0 are those of all opaque surfaces, each of the others those of one
   * translucent surface, in the order of the selector's casters.
   */
  std::size_t GetNumberOfSets() const { return this->Sets.size(); }

  /**
   * Draw the triangles of a set `instances` times with the current program, whose attribute
   * vertexUVHT gets (u, v, h) and a height that all of the vertex's surface is below.
   */
  void Draw(std::size_t set, vtkShaderProgram* program, int instances);

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
  /// The indices of a set in the buffer.
  struct Range
  {
    std::size_t First = 0;
    std::size_t Count = 0;
  };
  std::vector<Range> Sets;
};

#endif

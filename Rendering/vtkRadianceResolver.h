// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRadianceResolver
 * @brief adds what one light sends to a receiver to its radiance texture
 *
 * The closed form of the unoccluded light times the share of its samples that the masks leave
 * visible (vtkRadianceResolveFS.glsl). One instance serves one light on one receiver: Begin(), then
 * Resolve() for each band of rows whose masks have been drawn.
 */
#ifndef vtkRadianceResolver_h
#define vtkRadianceResolver_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "PolygonLight.h"
#include "ReceiverFrame.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkRadianceTexture.h" // for its Region
#include "vtkWeakPointer.h"     // for vtkWeakPointer

#include <vector> // for samples

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkTextureObject;
class vtkVisibilityMask;

class PENUMBRARENDERING_EXPORT vtkRadianceResolver : public vtkObject
{
public:
  static vtkRadianceResolver* New();
  vtkTypeMacro(vtkRadianceResolver, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Take up a light on a receiver of the given reflectance: `seen` is its part in front of the
   * receiver, `samples` (world coordinates) are the points of it whose masks will come; none if
   * nothing can block it. The first half of the samples (the greater, if their number is odd) and
   * the second must each be spread over the light. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
    const glm::dvec3& reflectance, const penumbra::PolygonLight& seen,
    const std::vector<glm::dvec3>& samples);

  /**
   * Add the light to the rows [firstRow, lastRow) of a region of `target`. Row r is row r -
   * firstRow of `masks` (nullptr if there are no samples). The caller saves and restores
   * vtkOpenGLState around it.
   */
  void Resolve(vtkRadianceTexture* target, const vtkRadianceTexture::Region& region, int firstRow,
    int lastRow, vtkVisibilityMask* masks);

  /**
   * Free the OpenGL resources.
   */
  void ReleaseGraphicsResources();

protected:
  vtkRadianceResolver();
  ~vtkRadianceResolver() override;

private:
  vtkRadianceResolver(const vtkRadianceResolver&) = delete;
  void operator=(const vtkRadianceResolver&) = delete;

  void SetLightUniforms(const penumbra::ReceiverFrame& frame, const penumbra::PolygonLight& seen);
  bool UploadSamples(const penumbra::ReceiverFrame& frame, const std::vector<glm::dvec3>& samples);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkShaderProgram* Program = nullptr; ///< the window's
  vtkNew<vtkOpenGLBufferObject> SampleBuffer;
  vtkNew<vtkTextureObject> Samples;
};

#endif

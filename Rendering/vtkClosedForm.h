// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkClosedForm
 * @brief what a light sends to each texel of a receiver where nothing blocks it
 *
 * Irradiance over pi in three components, for a rectangle of texels at a time. Polygons are
 * evaluated by OpenGL (vtkPolygonFormFactor.glsl), added up where the light has several; other
 * lights by penumbra::LightShape::Irradiance(), in double.
 */
#ifndef vtkClosedForm_h
#define vtkClosedForm_h

#include "LightShape.h"
#include "PenumbraRenderingModule.h" // for the export macro
#include "TexelRectangle.h"
#include "vtkNew.h" // for vtkNew
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include <array> // for programs

class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkStageTexture;

class PENUMBRARENDERING_EXPORT vtkClosedForm : public vtkObject
{
public:
  static vtkClosedForm* New();
  vtkTypeMacro(vtkClosedForm, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Take up a light on a receiver of the given texels. `seen`, the light's part in front of the
   * receiver, is kept by reference. `largest` bounds the rectangles that will be drawn. False,
   * after vtkErrorMacro, if OpenGL refuses.
   */
  bool Begin(vtkOpenGLRenderWindow* window, const penumbra::ReceiverFrame& frame,
    const penumbra::LightShape& seen, const glm::ivec2& texels, const glm::ivec2& largest);

  /**
   * Evaluate a rectangle of the receiver's texels; its first one goes to (0, 0). The caller saves
   * and restores vtkOpenGLState around it.
   */
  void Draw(const penumbra::TexelRectangle& rectangle);

  vtkStageTexture* GetTexture() { return this->Texture; }

  /**
   * Free the OpenGL resources.
   */
  void ReleaseGraphicsResources();

protected:
  vtkClosedForm();
  ~vtkClosedForm() override;

private:
  vtkClosedForm(const vtkClosedForm&) = delete;
  void operator=(const vtkClosedForm&) = delete;

  bool PrepareProgram(bool isLow);
  void DrawPolygons(const penumbra::TexelRectangle& rectangle);
  void Evaluate(const penumbra::TexelRectangle& rectangle);

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  /// The window's, for polygons that are not low (vtkPolygonFormFactor.glsl) and that are; none for
  /// lights that are not polygons.
  std::array<vtkShaderProgram*, 2> Programs{};
  penumbra::ReceiverFrame Frame;
  const penumbra::LightShape* Seen = nullptr;
  glm::ivec2 Texels{ 1 };
  vtkNew<vtkStageTexture> Texture;
};

#endif

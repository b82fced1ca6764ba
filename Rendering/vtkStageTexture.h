// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkStageTexture
 * @brief what one stage of a bake draws and the next one reads
 *
 * A texture in single precision for a rectangle of a receiver's texels, without filtering.
 */
#ifndef vtkStageTexture_h
#define vtkStageTexture_h

#include "PenumbraRenderingModule.h" // for the export macro
#include "vtkNew.h"                  // for vtkNew
#include "vtkObject.h"
#include "vtkWeakPointer.h" // for vtkWeakPointer

#include "TexelRectangle.h"

#include <vector> // for values

class vtkOpenGLFramebufferObject;
class vtkOpenGLRenderWindow;
class vtkTextureObject;

class PENUMBRARENDERING_EXPORT vtkStageTexture : public vtkObject
{
public:
  static vtkStageTexture* New();
  vtkTypeMacro(vtkStageTexture, vtkObject)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Make room, if there is not just that already. False, after vtkErrorMacro, if OpenGL refuses.
   */
  bool Allocate(vtkOpenGLRenderWindow* window, const glm::ivec2& size, int components);

  const glm::ivec2& GetSize() const { return this->Size; }

  /**
   * Make a rectangle the target of drawing; with `add`, what is drawn adds to what is there. The
   * caller saves and restores vtkOpenGLState around it.
   */
  void BindAsTarget(const penumbra::TexelRectangle& rectangle, bool add);

  /**
   * Write a rectangle of the given size at the texture's origin, `values` with all components.
   */
  void Upload(const glm::ivec2& size, const float* values);

  /**
   * What a rectangle holds, with all components, row by row. The caller saves and restores
   * vtkOpenGLState around it.
   */
  std::vector<float> Download(const penumbra::TexelRectangle& rectangle);

  /**
   * Fill the texture with the values, and copy a rectangle from another one of as many components
   * to where its first texel is `to`. The caller saves and restores vtkOpenGLState around it.
   */
  void FillAndCopy(const glm::vec4& values, vtkStageTexture* source,
    const penumbra::TexelRectangle& rectangle, const glm::ivec2& to);

  /**
   * OpenGL's name of the texture.
   */
  unsigned int GetHandle();

  /**
   * The bytes that the texture takes.
   */
  std::size_t GetBytes() const;

  /**
   * Free the texture.
   */
  void ReleaseGraphicsResources();

protected:
  vtkStageTexture();
  ~vtkStageTexture() override;

private:
  vtkStageTexture(const vtkStageTexture&) = delete;
  void operator=(const vtkStageTexture&) = delete;

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkTextureObject> Texture;
  vtkNew<vtkOpenGLFramebufferObject> Framebuffer;
  glm::ivec2 Size{ 0 };
  int Components = 0;
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * An OpenGL that refuses what a test chooses.
 */
#ifndef OpenGLRefusal_h
#define OpenGLRefusal_h

#include <functional>
#include <string>

/// What OpenGL is asked for.
struct OpenGLCall
{
  enum Kind
  {
    Texture,       ///< glTexImage2D or glTexImage3D
    Buffer,        ///< glBufferData
    TextureBuffer, ///< glTexBuffer
    Mipmaps,       ///< glGenerateMipmap
    Shader,        ///< glCompileShader
    Draw           ///< glDrawArrays or glDrawElementsInstanced
  };

  Kind What = Texture;
  unsigned int Format = 0; ///< of a texture, as GL_RGBA32F
  int Width = 0, Height = 0;
  std::string Source; ///< of a shader
  int Index = 0;      ///< how many calls of its kind there were before
};

/**
 * While it lives, calls that are chosen fail as OpenGL's own do: they raise an error and make
 * nothing; a shader does not compile. There may be one at a time.
 *
 * glTexImage2D is the program's own, which the dynamic linker puts in front of OpenGL's; the others
 * are the loader's function pointers. So make it once the window has its context.
 */
class OpenGLRefusal
{
public:
  using Choice = std::function<bool(const OpenGLCall&)>;
  explicit OpenGLRefusal(const Choice& choice);
  ~OpenGLRefusal();
  OpenGLRefusal(const OpenGLRefusal&) = delete;
  OpenGLRefusal& operator=(const OpenGLRefusal&) = delete;

  /// How many calls have been refused.
  int GetCount() const;
};

/// While it lives, OpenGL says that its context is lost, whenever it is asked for errors.
class LostContext
{
public:
  LostContext();
  ~LostContext();
  LostContext(const LostContext&) = delete;
  LostContext& operator=(const LostContext&) = delete;
};

#endif

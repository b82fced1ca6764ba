// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLRefusal.h"

#include "vtk_glew.h"

#include <dlfcn.h>

#include <array>
#include <vector>

namespace
{

/// What is refused at present.
struct State
{
  OpenGLRefusal::Choice Choice;
  std::array<int, OpenGLCall::Shader + 1> Calls{};
  int Refused = 0;
  bool IsLost = false;
};

State Now;

bool IsRefused(OpenGLCall call)
{
  if (!Now.Choice)
  {
    return false;
  }
  call.Index = Now.Calls[call.What]++;
  const bool isRefused = Now.Choice(call);
  Now.Refused += isRefused ? 1 : 0;
  return isRefused;
}

/// OpenGL's own function.
template <typename Function>
Function FindNext(const char* name)
{
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// No size and no target: OpenGL raises an error.
constexpr GLsizei NoSize = -1;
constexpr GLenum NoTarget = GL_NONE;

struct Functions
{
  PFNGLTEXIMAGE3DPROC TexImage3D;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLTEXBUFFERPROC TexBuffer;
  PFNGLGENERATEMIPMAPPROC GenerateMipmap;
  PFNGLCOMPILESHADERPROC CompileShader;
};

Functions Own;

void GLAPIENTRY TexImage3D(GLenum target, GLint level, GLint internalFormat, GLsizei width,
  GLsizei height, GLsizei depth, GLint border, GLenum format, GLenum type, const void* pixels)
{
  const bool isRefused = IsRefused(
    { OpenGLCall::Texture, static_cast<unsigned int>(internalFormat), width, height, {}, 0 });
  Own.TexImage3D(target, level, internalFormat, isRefused ? NoSize : width, height, depth, border,
    format, type, pixels);
}

void GLAPIENTRY BufferData(GLenum target, GLsizeiptr size, const void* data, GLenum usage)
{
  const bool isRefused = IsRefused({ OpenGLCall::Buffer, 0, 0, 0, {}, 0 });
  Own.BufferData(target, isRefused ? NoSize : size, data, usage);
}

void GLAPIENTRY TexBuffer(GLenum target, GLenum internalFormat, GLuint buffer)
{
  const bool isRefused = IsRefused({ OpenGLCall::TextureBuffer, internalFormat, 0, 0, {}, 0 });
  Own.TexBuffer(isRefused ? NoTarget : target, internalFormat, buffer);
}

void GLAPIENTRY GenerateMipmap(GLenum target)
{
  const bool isRefused = IsRefused({ OpenGLCall::Mipmaps, 0, 0, 0, {}, 0 });
  Own.GenerateMipmap(isRefused ? NoTarget : target);
}

std::string GetSource(GLuint shader)
{
  GLint length = 0;
  glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &length);
  std::vector<char> source(static_cast<std::size_t>(length) + 1, '\0');
  glGetShaderSource(shader, length, nullptr, source.data());
  return source.data();
}

void GLAPIENTRY CompileShader(GLuint shader)
{
  if (!IsRefused({ OpenGLCall::Shader, 0, 0, 0, GetSource(shader), 0 }))
  {
    Own.CompileShader(shader); // one that is never compiled has failed to
  }
}

} // namespace

extern "C" void GLAPIENTRY glTexImage2D(GLenum target, GLint level, GLint internalFormat,
  GLsizei width, GLsizei height, GLint border, GLenum format, GLenum type, const void* pixels)
{
  static const auto own = FindNext<decltype(&glTexImage2D)>("glTexImage2D");
  const bool isRefused = IsRefused(
    { OpenGLCall::Texture, static_cast<unsigned int>(internalFormat), width, height, {}, 0 });
  own(target, level, internalFormat, isRefused ? NoSize : width, height, border, format, type,
    pixels);
}

extern "C" GLenum GLAPIENTRY glGetError()
{
  static const auto own = FindNext<decltype(&glGetError)>("glGetError");
  return Now.IsLost ? GL_CONTEXT_LOST : own();
}

OpenGLRefusal::OpenGLRefusal(const Choice& choice)
{
  Own = { __glewTexImage3D, __glewBufferData, __glewTexBuffer, __glewGenerateMipmap,
    __glewCompileShader };
  Now = { choice, {}, 0, false };
  __glewTexImage3D = TexImage3D;
  __glewBufferData = BufferData;
  __glewTexBuffer = TexBuffer;
  __glewGenerateMipmap = GenerateMipmap;
  __glewCompileShader = CompileShader;
}

OpenGLRefusal::~OpenGLRefusal()
{
  __glewTexImage3D = Own.TexImage3D;
  __glewBufferData = Own.BufferData;
  __glewTexBuffer = Own.TexBuffer;
  __glewGenerateMipmap = Own.GenerateMipmap;
  __glewCompileShader = Own.CompileShader;
  Now = {};
}

int OpenGLRefusal::GetCount() const
{
  return Now.Refused;
}

LostContext::LostContext()
{
  Now.IsLost = true;
}

LostContext::~LostContext()
{
  Now.IsLost = false;
}

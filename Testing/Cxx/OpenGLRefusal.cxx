// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLRefusal.h"

#include "OpenGLLoader.h"

#include <dlfcn.h>

#include <array>
#include <vector>

/// The loader's pointer to one of OpenGL's functions. GLAD has one for each of them, GLEW only for
/// those that are younger than OpenGL 1.2.
#if PENUMBRA_OPENGL_BY_GLAD
#define LOADED(name) glad_gl##name
#else
#define LOADED(name) __glew##name
#endif

namespace
{

/// What is refused at present.
struct State
{
  OpenGLRefusal::Choice Choice;
  std::array<int, OpenGLCall::Draw + 1> Calls{};
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

/// No size, no target and nothing to draw: OpenGL raises an error.
constexpr GLsizei NoSize = -1;
constexpr GLenum NoTarget = GL_NONE;
constexpr GLenum NoMode = GL_TEXTURE;

using TexImage2DFunction = void(GLAPIENTRY*)(
  GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
using GetErrorFunction = GLenum(GLAPIENTRY*)();
using DrawArraysFunction = void(GLAPIENTRY*)(GLenum, GLint, GLsizei);

struct Functions
{
  TexImage2DFunction TexImage2D;
  GetErrorFunction GetError;
  DrawArraysFunction DrawArrays;
  PFNGLTEXIMAGE3DPROC TexImage3D;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLTEXBUFFERPROC TexBuffer;
  PFNGLGENERATEMIPMAPPROC GenerateMipmap;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLDRAWELEMENTSINSTANCEDPROC DrawElementsInstanced;
};

Functions Own;

void GLAPIENTRY TexImage2D(GLenum target, GLint level, GLint internalFormat, GLsizei width,
  GLsizei height, GLint border, GLenum format, GLenum type, const void* pixels)
{
  const bool isRefused = IsRefused(
    { OpenGLCall::Texture, static_cast<unsigned int>(internalFormat), width, height, {}, 0 });
  Own.TexImage2D(target, level, internalFormat, isRefused ? NoSize : width, height, border, format,
    type, pixels);
}

GLenum GLAPIENTRY GetError()
{
  return Now.IsLost ? GL_CONTEXT_LOST : Own.GetError();
}

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

void GLAPIENTRY DrawArrays(GLenum mode, GLint first, GLsizei count)
{
  const bool isRefused = IsRefused({ OpenGLCall::Draw, 0, 0, 0, {}, 0 });
  Own.DrawArrays(isRefused ? NoMode : mode, first, count);
}

void GLAPIENTRY DrawElementsInstanced(
  GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances)
{
  const bool isRefused = IsRefused({ OpenGLCall::Draw, 0, 0, 0, {}, 0 });
  Own.DrawElementsInstanced(isRefused ? NoMode : mode, count, type, indices, instances);
}

} // namespace

#if PENUMBRA_OPENGL_BY_GLAD
namespace
{
void FindOldFunctions()
{
  Own.TexImage2D = LOADED(TexImage2D);
  Own.GetError = LOADED(GetError);
  Own.DrawArrays = LOADED(DrawArrays);
}
void SetOldFunctions(
  TexImage2DFunction texImage2D, GetErrorFunction getError, DrawArraysFunction drawArrays)
{
  LOADED(TexImage2D) = texImage2D;
  LOADED(GetError) = getError;
  LOADED(DrawArrays) = drawArrays;
}
} // namespace
#else
// Of what GLEW has no pointer to, the program has functions of its own, which come first.
namespace
{
void FindOldFunctions()
{
  static const auto texImage2D =
    reinterpret_cast<TexImage2DFunction>(dlsym(RTLD_NEXT, "glTexImage2D"));
  static const auto getError = reinterpret_cast<GetErrorFunction>(dlsym(RTLD_NEXT, "glGetError"));
  static const auto drawArrays =
    reinterpret_cast<DrawArraysFunction>(dlsym(RTLD_NEXT, "glDrawArrays"));
  Own.TexImage2D = texImage2D;
  Own.GetError = getError;
  Own.DrawArrays = drawArrays;
}
void SetOldFunctions(TexImage2DFunction /*texImage2D*/, GetErrorFunction /*getError*/,
  DrawArraysFunction /*drawArrays*/)
{
}
} // namespace

extern "C" void GLAPIENTRY glTexImage2D(GLenum target, GLint level, GLint internalFormat,
  GLsizei width, GLsizei height, GLint border, GLenum format, GLenum type, const void* pixels)
{
  FindOldFunctions();
  TexImage2D(target, level, internalFormat, width, height, border, format, type, pixels);
}

extern "C" GLenum GLAPIENTRY glGetError()
{
  FindOldFunctions();
  return GetError();
}

extern "C" void GLAPIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count)
{
  FindOldFunctions();
  DrawArrays(mode, first, count);
}
#endif

OpenGLRefusal::OpenGLRefusal(const Choice& choice)
{
  FindOldFunctions();
  Own.TexImage3D = LOADED(TexImage3D);
  Own.BufferData = LOADED(BufferData);
  Own.TexBuffer = LOADED(TexBuffer);
  Own.GenerateMipmap = LOADED(GenerateMipmap);
  Own.CompileShader = LOADED(CompileShader);
  Own.DrawElementsInstanced = LOADED(DrawElementsInstanced);
  Now = { choice, {}, 0, false };
  SetOldFunctions(TexImage2D, GetError, DrawArrays);
  LOADED(TexImage3D) = TexImage3D;
  LOADED(BufferData) = BufferData;
  LOADED(TexBuffer) = TexBuffer;
  LOADED(GenerateMipmap) = GenerateMipmap;
  LOADED(CompileShader) = CompileShader;
  LOADED(DrawElementsInstanced) = DrawElementsInstanced;
}

OpenGLRefusal::~OpenGLRefusal()
{
  SetOldFunctions(Own.TexImage2D, Own.GetError, Own.DrawArrays);
  LOADED(TexImage3D) = Own.TexImage3D;
  LOADED(BufferData) = Own.BufferData;
  LOADED(TexBuffer) = Own.TexBuffer;
  LOADED(GenerateMipmap) = Own.GenerateMipmap;
  LOADED(CompileShader) = Own.CompileShader;
  LOADED(DrawElementsInstanced) = Own.DrawElementsInstanced;
  Now = {};
}

int OpenGLRefusal::GetCount() const
{
  return Now.Refused;
}

LostContext::LostContext()
{
  FindOldFunctions();
  SetOldFunctions(Own.TexImage2D, GetError, Own.DrawArrays);
  Now.IsLost = true;
}

LostContext::~LostContext()
{
  SetOldFunctions(Own.TexImage2D, Own.GetError, Own.DrawArrays);
  Now.IsLost = false;
}

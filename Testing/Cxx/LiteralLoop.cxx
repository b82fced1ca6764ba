// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "LiteralLoop.h"

#include "ExactRadiance.h"
#include "SamplingPattern.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <chrono>

namespace
{

/// Seconds since some moment.
double GetTime()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// z_u "big": almost at the height of the sample.
constexpr float FarthestDepth = 1e7f;
/// The nearest and the farthest z_u of what blocks. H&H clip at 1 - epsilon, which keeps what lies
/// in the receiver's plane; what blocks must be above it, by more than rounding.
constexpr float OccluderDepths[2] = { 1.0f + 1e-6f, FarthestDepth };
/// Those of the receiver, which is not clipped. (Mesa 22.3 clips by what a shader writes even where
/// GL_CLIP_DISTANCE0 is off.)
constexpr float ReceiverDepths[2] = { 0.0f, FarthestDepth };

/// Points relative to the receiver's corner, through scale(sx, sy, 1) M, to OpenGL's clip
/// coordinates. Whoever clips does so by the depth z_u = z/w, in [near, far].
const char* const VertexShader = R"(//VTK::System::Dec
in vec3 relativePoint;
uniform mat4 pyramidToBox;
uniform vec2 depthRange;
out float gl_ClipDistance[2];
void main()
{
  vec4 box = pyramidToBox * vec4(relativePoint, 1.0);
  gl_Position = vec4(2.0 * box.xy - box.w, 0.0, box.w);
  gl_ClipDistance[0] = box.z - depthRange.x * box.w;
  gl_ClipDistance[1] = depthRange.y * box.w - box.z;
})";

/// The second factor of eq. 2 in rgb: cos t cos t' Le / (pi r^2), and without Le in a.
const char* const ReceiverShader = R"(//VTK::System::Dec
//VTK::Output::Dec
uniform vec2 texels;
uniform vec3 edgeX;
uniform vec3 edgeY;
uniform vec3 normal;
uniform vec3 apex;
uniform vec3 lightNormal;
uniform vec3 lightRadiance;
uniform int twoSided;
void main()
{
  vec2 uv = gl_FragCoord.xy / texels;
  vec3 toLight = apex - (uv.x * edgeX + uv.y * edgeY);
  float r2 = dot(toLight, toLight);
  float cosine = max(dot(normal, toLight), 0.0);
  float lightCosine = -dot(lightNormal, toLight);
  lightCosine = twoSided != 0 ? abs(lightCosine) : max(lightCosine, 0.0);
  float w = cosine * lightCosine / (3.14159265358979 * r2 * r2);
  gl_FragData[0] = vec4(w * lightRadiance, w);
})";

/// Ambient light is no business of one sample's: 0.
const char* const OccluderShader = R"(//VTK::System::Dec
//VTK::Output::Dec
void main()
{
  gl_FragData[0] = vec4(0.0);
})";

const char* const ScreenShader = R"(//VTK::System::Dec
in vec2 corner;
void main()
{
  gl_Position = vec4(corner, 0.0, 1.0);
})";

/// glAccum(GL_ACCUM, weight), which core profiles lack.
const char* const AccumulateShader = R"(//VTK::System::Dec
//VTK::Output::Dec
uniform sampler2D hardShadow;
uniform float weight;
void main()
{
  gl_FragData[0] = weight * texelFetch(hardShadow, ivec2(gl_FragCoord.xy), 0);
})";

/// The matrix M of H&H 1997, section 3.3: of the pyramid with the apex a over the parallelogram
/// b, ex, ey.
glm::dmat4 PyramidToBox(
  const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& ex, const glm::dvec3& ey)
{
  const glm::dvec3 ew = b - a;
  const glm::dvec3 nx = glm::cross(ew, ey);
  const glm::dvec3 ny = glm::cross(ex, ew);
  const glm::dvec3 nw = glm::cross(ey, ex);
  const double alphaX = 1.0 / glm::dot(nx, ex);
  const double alphaY = 1.0 / glm::dot(ny, ey);
  const double alphaW = 1.0 / glm::dot(nw, ew);
  return glm::transpose(glm::dmat4(glm::dvec4(alphaX * nx, -alphaX * glm::dot(nx, b)),
    glm::dvec4(alphaY * ny, -alphaY * glm::dot(ny, b)), glm::dvec4(0.0, 0.0, 0.0, 1.0),
    glm::dvec4(alphaW * nw, -alphaW * glm::dot(nw, a))));
}

void SetVector(vtkShaderProgram* program, const char* name, const glm::dvec3& v)
{
  const glm::vec3 single(v);
  program->SetUniform3f(name, glm::value_ptr(single));
}

/// Vertices, and if there are any, triangles of them.
class Mesh
{
public:
  Mesh(const std::vector<float>& coordinates, int components,
    const std::vector<penumbra::Surface::Triangle>& triangles)
    : Components(components)
    , Vertices(static_cast<GLsizei>(coordinates.size()) / components)
    , Indices(static_cast<GLsizei>(3 * triangles.size()))
  {
    glGenVertexArrays(1, &this->Array);
    glBindVertexArray(this->Array);
    glGenBuffers(2, this->Buffers);
    glBindBuffer(GL_ARRAY_BUFFER, this->Buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(coordinates.size() * sizeof(float)),
      coordinates.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->Buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
      static_cast<GLsizeiptr>(triangles.size() * sizeof(penumbra::Surface::Triangle)),
      triangles.data(), GL_STATIC_DRAW);
    glBindVertexArray(0);
  }
  ~Mesh()
  {
    glDeleteVertexArrays(1, &this->Array);
    glDeleteBuffers(2, this->Buffers);
  }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  /// With the current program, the vertices as its `attribute`: the triangles, or else a strip.
  void Draw(vtkShaderProgram* program, const char* attribute) const
  {
    const GLint place = glGetAttribLocation(static_cast<GLuint>(program->GetHandle()), attribute);
    glBindVertexArray(this->Array);
    glBindBuffer(GL_ARRAY_BUFFER, this->Buffers[0]);
    glVertexAttribPointer(
      static_cast<GLuint>(place), this->Components, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(static_cast<GLuint>(place));
    if (this->Indices > 0)
    {
      glDrawElements(GL_TRIANGLES, this->Indices, GL_UNSIGNED_INT, nullptr);
    }
    else
    {
      glDrawArrays(GL_TRIANGLE_STRIP, 0, this->Vertices);
    }
    glBindVertexArray(0);
  }

private:
  GLuint Array = 0;
  GLuint Buffers[2] = { 0, 0 };
  GLint Components;
  GLsizei Vertices;
  GLsizei Indices;
};

/// A picture of RGBA in single precision that can be drawn to.
class Image
{
public:
  Image(const glm::ivec2& size, vtkOpenGLState* state)
    : Size(size)
    , State(state)
  {
    glGenTextures(1, &this->Texture);
    glBindTexture(GL_TEXTURE_2D, this->Texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size.x, size.y, 0, GL_RGBA, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTexture(GL_TEXTURE_2D, 0);
    glGenFramebuffers(1, &this->Framebuffer);
    this->BindAsTarget();
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, this->Texture, 0);
    this->Complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  ~Image()
  {
    // VTK takes a new framebuffer for the old one if their names are the same.
    this->State->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &this->Framebuffer);
    glDeleteTextures(1, &this->Texture);
  }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  /// Whether OpenGL can draw to it.
  bool IsComplete() const { return this->Complete; }
  void BindAsTarget() const
  {
    this->State->vtkglBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffer);
  }
  GLuint GetTexture() const { return this->Texture; }

  std::vector<glm::vec4> Download() const
  {
    std::vector<glm::vec4> pixels(
      static_cast<std::size_t>(this->Size.x) * static_cast<std::size_t>(this->Size.y));
    glBindTexture(GL_TEXTURE_2D, this->Texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, pixels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    return pixels;
  }

private:
  glm::ivec2 Size;
  vtkOpenGLState* State;
  GLuint Texture = 0;
  GLuint Framebuffer = 0;
  bool Complete = false;
};

/// The four corners of a parallelogram at the origin, as a strip.
std::vector<float> GetCorners(const penumbra::Parallelogram& base)
{
  std::vector<float> corners;
  for (const glm::dvec3& p : { glm::dvec3(0.0), base.EdgeX, base.EdgeY, base.EdgeX + base.EdgeY })
  {
    const glm::vec3 single(p);
    corners.insert(corners.end(), { single.x, single.y, single.z });
  }
  return corners;
}

/// Everything but the receiver itself, relative to the receiver's corner.
std::vector<float> GetOccluderPoints(
  const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver)
{
  std::vector<float> coordinates;
  for (const penumbra::SharedSurface& surface : scene.Surfaces)
  {
    for (const glm::dvec3& point : surface->Points)
    {
      const glm::vec3 relative(point - receiver.Base.Corner);
      coordinates.insert(coordinates.end(), { relative.x, relative.y, relative.z });
    }
  }
  return coordinates;
}

std::vector<penumbra::Surface::Triangle> GetOccluderTriangles(
  const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver)
{
  std::vector<penumbra::Surface::Triangle> triangles;
  std::uint32_t first = 0;
  for (std::size_t s = 0; s < scene.Surfaces.size(); ++s)
  {
    const penumbra::Surface& surface = *scene.Surfaces[s];
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      if (s != receiver.Surface || surface.Regions[t] != receiver.Region)
      {
        const auto& [a, b, c] = surface.Triangles[t];
        triangles.push_back({ first + a, first + b, first + c });
      }
    }
    first += static_cast<std::uint32_t>(surface.Points.size());
  }
  return triangles;
}

/// H&H 1997, 3.6, first test.
bool IsReceiverBehind(const penumbra::PolygonLight& light, const penumbra::Parallelogram& base)
{
  for (const glm::dvec3& corner : { base.Corner, base.Corner + base.EdgeX, base.Corner + base.EdgeY,
         base.Corner + base.EdgeX + base.EdgeY })
  {
    if (glm::dot(corner - light.GetVertices()[0], light.GetNormal()) > 0.0)
    {
      return false;
    }
  }
  return !light.TwoSided;
}

/// The oracle's, at every texel's centre.
std::vector<double> GetFormFactors(
  const penumbra::Receiver& receiver, const glm::dvec3& normal, const penumbra::PolygonLight& light)
{
  const auto toOracle = [](const glm::dvec3& v) { return oracle::Vec3{ v.x, v.y, v.z }; };
  oracle::Light exact;
  exact.TwoSided = light.TwoSided;
  for (const glm::dvec3& vertex : light.GetVertices())
  {
    exact.Vertices.push_back(toOracle(vertex));
  }
  const penumbra::Parallelogram& base = receiver.Base;
  std::vector<double> factors;
  for (int j = 0; j < receiver.Texels.y; ++j)
  {
    for (int i = 0; i < receiver.Texels.x; ++i)
    {
      const glm::dvec3 x = base.Corner + (i + 0.5) / receiver.Texels.x * base.EdgeX +
        (j + 0.5) / receiver.Texels.y * base.EdgeY;
      factors.push_back(
        static_cast<double>(oracle::FormFactor(toOracle(x), toOracle(normal), exact)));
    }
  }
  return factors;
}

/// No z-buffer, and blending that adds, for when it is on.
void SetState(vtkOpenGLState* state, const glm::ivec2& texels)
{
  for (unsigned int capability : { GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE })
  {
    state->vtkglDisable(capability);
  }
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglBlendEquation(GL_FUNC_ADD);
  state->vtkglBlendFunc(GL_ONE, GL_ONE);
  state->vtkglViewport(0, 0, texels.x, texels.y);
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
}

} // namespace

/// What the stages of one bake share.
struct LiteralLoop::Bakery
{
  const penumbra::Receiver& Receiver;
  glm::dvec3 Normal; ///< of the lit side
  vtkOpenGLRenderWindow* Window;
  bool KeepsUnblocked; ///< whether occluders leave alpha as it is
  Mesh Base;
  Mesh Occluders;
  Mesh Screen;
  Image HardShadow;

  Bakery(const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver,
    vtkOpenGLRenderWindow* window, bool keepsUnblocked);

  vtkShaderProgram* Ready(const char* vertexShader, const char* fragmentShader) const
  {
    vtkShaderProgram* program =
      this->Window->GetShaderCache()->ReadyShaderProgram(vertexShader, fragmentShader, "");
    return program && program->GetCompiled() ? program : nullptr;
  }

  bool AddLight(const penumbra::PolygonLight& light, const std::vector<glm::dvec2>& pattern,
    const Image& accumulator) const;
  bool DrawReceiver(const penumbra::PolygonLight& light, const glm::dvec3& apex,
    const glm::mat4& pyramidToBox) const;
  bool DrawOccluders(const glm::mat4& pyramidToBox) const;
  bool Accumulate(double weight, const Image& accumulator) const;
};

LiteralLoop::Bakery::Bakery(const penumbra::ShadowScene& scene, const penumbra::Receiver& receiver,
  vtkOpenGLRenderWindow* window, bool keepsUnblocked)
  : Receiver(receiver)
  , Normal(scene.MakeFrame(receiver).GetNormal())
  , Window(window)
  , KeepsUnblocked(keepsUnblocked)
  , Base(GetCorners(receiver.Base), 3, {})
  , Occluders(GetOccluderPoints(scene, receiver), 3, GetOccluderTriangles(scene, receiver))
  , Screen({ -1.0f, -1.0f, 1.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f }, 2, {})
  , HardShadow(receiver.Texels, window->GetState())
{
}

bool LiteralLoop::Bakery::DrawReceiver(
  const penumbra::PolygonLight& light, const glm::dvec3& apex, const glm::mat4& pyramidToBox) const
{
  vtkShaderProgram* program = this->Ready(VertexShader, ReceiverShader);
  if (!program)
  {
    return false;
  }
  program->SetUniformMatrix4x4("pyramidToBox", const_cast<float*>(glm::value_ptr(pyramidToBox)));
  program->SetUniform2f("depthRange", ReceiverDepths);
  const glm::vec2 texels(this->Receiver.Texels);
  program->SetUniform2f("texels", glm::value_ptr(texels));
  SetVector(program, "edgeX", this->Receiver.Base.EdgeX);
  SetVector(program, "edgeY", this->Receiver.Base.EdgeY);
  SetVector(program, "normal", this->Normal);
  SetVector(program, "apex", apex);
  SetVector(program, "lightNormal", light.GetNormal());
  SetVector(program, "lightRadiance", light.Radiance);
  program->SetUniformi("twoSided", light.TwoSided ? 1 : 0);
  this->Base.Draw(program, "relativePoint");
  return true;
}

bool LiteralLoop::Bakery::DrawOccluders(const glm::mat4& pyramidToBox) const
{
  vtkShaderProgram* program = this->Ready(VertexShader, OccluderShader);
  if (!program)
  {
    return false;
  }
  vtkOpenGLState* state = this->Window->GetState();
  program->SetUniformMatrix4x4("pyramidToBox", const_cast<float*>(glm::value_ptr(pyramidToBox)));
  program->SetUniform2f("depthRange", OccluderDepths);
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, this->KeepsUnblocked ? GL_FALSE : GL_TRUE);
  this->Occluders.Draw(program, "relativePoint");
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return true;
}

bool LiteralLoop::Bakery::Accumulate(double weight, const Image& accumulator) const
{
  vtkShaderProgram* program = this->Ready(ScreenShader, AccumulateShader);
  vtkOpenGLState* state = this->Window->GetState();
  if (!program)
  {
    return false;
  }
  accumulator.BindAsTarget();
  state->vtkglActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, this->HardShadow.GetTexture());
  program->SetUniformi("hardShadow", 0);
  program->SetUniformf("weight", static_cast<float>(weight));
  state->vtkglEnable(GL_BLEND);
  this->Screen.Draw(program, "corner");
  state->vtkglDisable(GL_BLEND);
  glBindTexture(GL_TEXTURE_2D, 0);
  return true;
}

bool LiteralLoop::Bakery::AddLight(const penumbra::PolygonLight& light,
  const std::vector<glm::dvec2>& pattern, const Image& accumulator) const
{
  const penumbra::Parallelogram& base = this->Receiver.Base;
  for (const glm::dvec2& s : pattern)
  {
    const glm::dvec3 apex = light.Sample(s) - base.Corner;
    // H&H 1997, 3.6, second test.
    if (glm::dot(apex, this->Normal) <= 0.0)
    {
      continue;
    }
    const glm::mat4 pyramidToBox(PyramidToBox(apex, glm::dvec3(0.0), base.EdgeX, base.EdgeY));
    this->HardShadow.BindAsTarget();
    glEnable(GL_CLIP_DISTANCE0);
    glEnable(GL_CLIP_DISTANCE1);
    const bool drawn =
      this->DrawReceiver(light, apex, pyramidToBox) && this->DrawOccluders(pyramidToBox);
    glDisable(GL_CLIP_DISTANCE1);
    glDisable(GL_CLIP_DISTANCE0);
    if (!drawn ||
      !this->Accumulate(light.GetArea() / static_cast<double>(pattern.size()), accumulator))
    {
      return false;
    }
  }
  return true;
}

bool LiteralLoop::Bake(const penumbra::ShadowScene& scene, std::size_t receiver,
  vtkOpenGLRenderWindow* window, Estimator estimator)
{
  this->Kind = estimator;
  this->Seconds = 0.0;
  this->Radiance.clear();
  this->Sums.assign(scene.Lights.size(), {});
  this->FormFactors.assign(scene.Lights.size(), {});

  vtkOpenGLState* state = window->GetState();
  state->Push();
  const penumbra::Receiver& r = scene.Receivers[receiver];
  SetState(state, r.Texels);
  const double start = GetTime();
  const Bakery bakery(scene, r, window, estimator == Estimator::Ratio);
  this->Seconds = GetTime() - start;
  bool done = bakery.HardShadow.IsComplete();
  for (std::size_t i = 0; i < scene.Lights.size() && done; ++i)
  {
    this->Radiance.push_back(scene.Lights[i]->Radiance);
    done =
      this->BakeLight(bakery, dynamic_cast<const penumbra::PolygonLight&>(*scene.Lights[i]), i);
  }
  state->Pop();
  return done;
}

bool LiteralLoop::BakeLight(
  const Bakery& bakery, const penumbra::PolygonLight& light, std::size_t index)
{
  const double start = GetTime();
  const penumbra::Receiver& receiver = bakery.Receiver;
  const penumbra::PolygonLight seen = light.ClippedToFront(receiver.Base.Corner, bakery.Normal);
  if (!seen.IsValid() || IsReceiverBehind(seen, receiver.Base))
  {
    return true;
  }
  const std::vector<glm::dvec2> pattern =
    penumbra::GetSamplingPatterns()[static_cast<std::size_t>(receiver.Settings.SamplingPattern)]
      .Generate(receiver.Settings.GetSampleCount(),
        static_cast<std::uint32_t>(receiver.Settings.Seed), seen.GetAspect());
  vtkOpenGLState* state = bakery.Window->GetState();
  const Image accumulator(receiver.Texels, state);
  if (!accumulator.IsComplete())
  {
    return false;
  }
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  const bool done = bakery.AddLight(seen, pattern, accumulator);
  glFinish();
  this->Seconds += GetTime() - start;
  this->Sums[index] = accumulator.Download();
  if (this->Kind == Estimator::Ratio)
  {
    this->FormFactors[index] = GetFormFactors(receiver, bakery.Normal, seen);
  }
  return done;
}

std::vector<float> LiteralLoop::GetVisibleShares(std::size_t light) const
{
  // The component with the most light; all give the same share.
  const glm::dvec3& radiance = this->Radiance[light];
  const int c = radiance.x >= std::max(radiance.y, radiance.z) ? 0
    : radiance.y >= radiance.z                                 ? 1
                                                               : 2;
  std::vector<float> shares;
  for (const glm::vec4& sum : this->Sums[light])
  {
    const double unblocked = radiance[c] * static_cast<double>(sum.a);
    shares.push_back(unblocked > 0.0 ? static_cast<float>(sum[c] / unblocked) : 0.0f);
  }
  return shares;
}

std::vector<glm::dvec3> LiteralLoop::GetIrradiance(std::size_t light) const
{
  std::vector<glm::dvec3> irradiance;
  if (this->Kind == Estimator::PlainSum)
  {
    for (const glm::vec4& sum : this->Sums[light])
    {
      irradiance.emplace_back(sum);
    }
    return irradiance;
  }
  const std::vector<float> shares = this->GetVisibleShares(light);
  for (std::size_t i = 0; i < shares.size(); ++i)
  {
    irradiance.push_back(
      this->Radiance[light] * (this->FormFactors[light][i] * static_cast<double>(shares[i])));
  }
  return irradiance;
}

std::vector<glm::dvec3> LiteralLoop::GetIrradiance() const
{
  std::vector<glm::dvec3> total;
  for (std::size_t light = 0; light < this->Radiance.size(); ++light)
  {
    const std::vector<glm::dvec3> part = this->GetIrradiance(light);
    total.resize(std::max(total.size(), part.size()), glm::dvec3(0.0));
    std::transform(part.begin(), part.end(), total.begin(), total.begin(),
      [](const glm::dvec3& a, const glm::dvec3& b) { return a + b; });
  }
  return total;
}

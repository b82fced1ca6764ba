// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "ReceiverShader.h"

#include "FullScreenTriangle.h"
#include "ScreenMap.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkOpenGLCamera.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceTexture.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkSoftShadowFS.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace penumbra
{
namespace
{

/// Uniforms that a receiver takes, in units of four floats, and what is left to VTK's own.
constexpr int VectorsPerReceiver = 7;
constexpr int VectorsOfVTK = 128;

/// If the actor is lit and no geometry shader comes between, hands where the vertex lies on its
/// only receiver from the vertex shader to the fragment shader.
bool AddVarying(std::string& vertexShader, const std::string& geometryShader)
{
  const std::string position = "vertexVCVSOutput = MCVCMatrix * vertexMC;";
  if (!geometryShader.empty() || vertexShader.find(position) == std::string::npos)
  {
    return false;
  }
  vtkShaderProgram::Substitute(vertexShader, "//VTK::System::Dec",
    "//VTK::System::Dec\nuniform mat4 penumbraViewMaps[1];\nout vec2 penumbraUVVSOutput;\n", false);
  vtkShaderProgram::Substitute(vertexShader, position,
    position + "\n  penumbraUVVSOutput = (penumbraViewMaps[0] * vertexVCVSOutput).xy;", false);
  return vertexShader.find("out vec2 penumbraUVVSOutput") != std::string::npos;
}

/// What takes a fragment's position to its place on the receiver: in the view, or on the screen.
glm::dmat4 MakeMap(
  const Receiver& receiver, const Parallelogram& base, bool fromView, const ScreenMatrices& screen)
{
  if (receiver.ProxyCentre)
  {
    const glm::dvec4& centre = *receiver.ProxyCentre;
    return fromView
      ? MakeProxyViewMap(base, centre, screen.WorldToView)
      : MakeProxyScreenMap(base, centre, screen.WorldToView, screen.ViewToClip, screen.Viewport);
  }
  return fromView ? MakeViewMap(base, screen.WorldToView)
                  : MakeScreenMap(base, screen.WorldToView, screen.ViewToClip, screen.Viewport);
}

/// The uniforms of vtkSoftShadowFS.glsl, an element for each receiver.
struct ReceiverUniforms
{
  /// Far more than u + v is of any receiver.
  static constexpr float NoLimit = 1e9f;

  std::vector<glm::mat4> Maps;
  std::vector<glm::vec4> Places, Ambient;
  std::vector<glm::vec3> Reflectance;

  /// `inset`: how many texels inside the region's border (u, v) begin and end.
  void Add(const glm::dmat4& map, const ReceiverSettings& settings,
    const vtkRadianceTexture::Region& region, const glm::vec2& textureSize, float inset)
  {
    this->Maps.emplace_back(map);
    const bool isHalf = region.Half != AtlasHalf::Whole;
    this->Ambient.emplace_back(glm::vec3(settings.AmbientRadiance), isHalf ? 1.0f : NoLimit);
    this->Reflectance.emplace_back(settings.Reflectance);
    // Where a region is turned, (u, v) = (0, 0) is its end, and its size is negative.
    const auto step = static_cast<float>(region.GetStep());
    const glm::vec2 start(step > 0.0f ? region.Origin : region.Origin + region.Size);
    this->Places.emplace_back((start + step * inset) / textureSize,
      step * (glm::vec2(region.Size) - 2.0f * inset) / textureSize);
  }

  void Set(vtkShaderProgram* program, const char* maps)
  {
    const auto count = static_cast<int>(this->Maps.size());
    program->SetUniformMatrix4x4v(maps, count, &this->Maps.front()[0].x);
    program->SetUniform4fv("penumbraPlaces", count, &this->Places.front().x);
    program->SetUniform4fv("penumbraAmbient", count, &this->Ambient.front().x);
    program->SetUniform3fv("penumbraReflectance", count, &this->Reflectance.front().x);
  }
};

} // namespace

std::size_t GetMaximumReceivers(vtkOpenGLRenderWindow* window)
{
  GLint components = 0;
  window->GetState()->vtkglGetIntegerv(GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, &components);
  return static_cast<std::size_t>(
    std::max(1, (components / 4 - VectorsOfVTK) / VectorsPerReceiver));
}

bool CompilesShadowCode(std::size_t receivers, vtkOpenGLRenderWindow* window)
{
  const std::string source = "//VTK::System::Dec\n//VTK::Output::Dec\n#define PENUMBRA_RECEIVERS " +
    std::to_string(receivers) + "\n#define PENUMBRA_WINDOWS 0\n" + vtkSoftShadowFS +
    "void main()\n{\n  gl_FragData[0] = vec4(penumbraShadow(gl_FragCoord) + "
    "penumbraRadiance(gl_FragCoord), 1.0);\n}\n";
  return ReadyFullScreenProgram(window, source.c_str());
}

void AddShadowCode(const ShadowCode& code, std::string& vertexShader,
  const std::string& geometryShader, std::string& fragmentShader)
{
  std::string defines = "#define PENUMBRA_RECEIVERS " + std::to_string(code.Receivers) +
    "\n#define PENUMBRA_WINDOWS " + std::to_string(code.Windows) + "\n";
  std::string position = "vec4(gl_FragCoord.xyz, 1.0)";
  if (fragmentShader.find("vec4 vertexVC = ") != std::string::npos)
  {
    defines += "#define PENUMBRA_VIEW\n";
    position = "vec4(vertexVC.xyz, 1.0)";
    if (code.HasProxy)
    {
      defines += "#define PENUMBRA_PROXY\n";
    }
    else if (code.Receivers == 1 && AddVarying(vertexShader, geometryShader))
    {
      defines += "#define PENUMBRA_VARYING\n";
    }
  }
  vtkShaderProgram::Substitute(
    fragmentShader, "//VTK::Output::Dec", "//VTK::Output::Dec\n" + defines + vtkSoftShadowFS);

  // The parts of VTK's light model are there by name, save for unlit and physically based shading.
  // Without a specular material their specular part is 0, and need not be computed.
  const std::string shades = "ambientColor + diffuse + specular";
  const std::string shadow = "penumbraShadow(" + position + ")";
  if (!code.ShowsRadiance && fragmentShader.find(shades) != std::string::npos)
  {
    vtkShaderProgram::Substitute(fragmentShader, shades,
      "ambientColor + diffuse * " + shadow + (code.IsMatte ? "" : " + specular"));
    return;
  }
  const std::string shade = code.ShowsRadiance
    ? "  gl_FragData[0].rgb = diffuseColor * penumbraRadiance(" + position + ");\n"
    : "  gl_FragData[0].rgb *= " + shadow + ";\n";
  vtkShaderProgram::Substitute(
    fragmentShader, "//VTK::Light::Impl", "//VTK::Light::Impl\n" + shade, false);
}

ScreenMatrices::ScreenMatrices(vtkRenderer* renderer)
{
  // vtkOpenGLCamera gives them transposed, as OpenGL reads them.
  vtkMatrix4x4 *worldToView, *viewToClip, *worldToClip;
  vtkMatrix3x3* normals;
  vtkOpenGLCamera::SafeDownCast(renderer->GetActiveCamera())
    ->GetKeyMatrices(renderer, worldToView, normals, viewToClip, worldToClip);
  this->WorldToView = glm::make_mat4(worldToView->GetData());
  this->ViewToClip = glm::make_mat4(viewToClip->GetData());
  vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow())
    ->GetState()
    ->vtkglGetIntegerv(GL_VIEWPORT, &this->Viewport.x);
}

void SetReceiverUniforms(
  vtkShaderProgram* program, vtkBakedProp* baked, const ScreenMatrices& matrices)
{
  const bool fromView = program->IsUniformUsed("penumbraViewMaps");
  const std::vector<vtkBakedProp::Entry>& entries = baked->GetEntries();
  vtkRadianceTexture* texture = baked->GetTexture();
  // Alone, a receiver fills its texture, and (u, v) are the texture's; of several, the closest is
  // looked for, by its own parallelogram.
  const bool isAlone = entries.size() == 1;
  ReceiverUniforms uniforms;
  // Windows, the last entries, come first: see vtkSoftShadowFS.glsl.
  const std::size_t windows = baked->CountWindows();
  for (std::size_t place = 0; place < entries.size(); ++place)
  {
    const std::size_t i = (place + entries.size() - windows) % entries.size();
    const vtkBakedProp::Entry& entry = entries[i];
    const Parallelogram& base = isAlone ? entry.Base : entry.Settings.Base;
    uniforms.Add(MakeMap(entry.Settings, base, fromView, matrices), entry.Settings.Settings,
      texture->GetRegions()[i], glm::vec2(texture->GetSize()),
      !isAlone && entry.Vertices > 0 ? 0.5f : 0.0f);
  }
  uniforms.Set(program, fromView ? "penumbraViewMaps" : "penumbraScreenMaps");
}

} // namespace penumbra

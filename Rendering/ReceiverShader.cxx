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

#include <map>
#include <utility>

namespace penumbra
{
namespace
{

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
    "//VTK::System::Dec\nuniform mat4 penumbraViewMap;\nout vec2 penumbraUVVSOutput;\n", false);
  vtkShaderProgram::Substitute(vertexShader, position,
    position + "\n  penumbraUVVSOutput = (penumbraViewMap * vertexVCVSOutput).xy;", false);
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

/// What vtkSoftShadowFS.glsl has to know of the prop.
std::string MakeDefines(const ShadowCode& code)
{
  std::string defines;
  if (code.HasSeveral)
  {
    defines += "#define PENUMBRA_SEVERAL\n#define PENUMBRA_RECORD " +
      std::to_string(vtkReceiverTable::RecordTexels) + "\n";
  }
  if (code.HasProxy)
  {
    defines += "#define PENUMBRA_PROXY " + std::to_string(ProxyHeight) + "\n";
  }
  return defines;
}

/// Whether the side of a receiver that its texels are for is seen.
bool IsSeen(const ReceiverPlan& plan, const ScreenMatrices& matrices)
{
  const glm::dmat4 viewToWorld = glm::inverse(matrices.WorldToView);
  const glm::dvec3 towardsEye = matrices.AreRaysParallel()
    ? glm::dvec3(viewToWorld[2])
    : glm::dvec3(viewToWorld[3]) - plan.Frame.GetBase().Corner;
  return glm::dot(towardsEye, plan.Frame.GetNormal()) >= 0.0;
}

void SetUniform(vtkShaderProgram* program, const char* name, const glm::vec3& value)
{
  program->SetUniform3f(name, &value.x);
}

} // namespace

bool CompilesShadowCode(const ShadowCode& code, vtkOpenGLRenderWindow* window)
{
  const std::string source = "//VTK::System::Dec\n//VTK::Output::Dec\n" + MakeDefines(code) +
    vtkSoftShadowFS +
    "void main()\n{\n  gl_FragData[0] = vec4(penumbraShadow(gl_FragCoord) + "
    "penumbraRadiance(gl_FragCoord), 1.0);\n}\n";
  return ReadyFullScreenProgram(window, source.c_str());
}

void AddShadowCode(const ShadowCode& code, std::string& vertexShader,
  const std::string& geometryShader, std::string& fragmentShader)
{
  std::string defines = MakeDefines(code);
  std::string position = "vec4(gl_FragCoord.xyz, 1.0)";
  if (fragmentShader.find("vec4 vertexVC = ") != std::string::npos)
  {
    defines += "#define PENUMBRA_VIEW\n";
    position = "vec4(vertexVC.xyz, 1.0)";
    if (!code.HasProxy && !code.HasSeveral && AddVarying(vertexShader, geometryShader))
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
  vtkShaderProgram* program, const vtkBakedProp::Entry& entry, const ScreenMatrices& matrices)
{
  // A receiver fills its texture, alone, and (u, v) are the texture's.
  const bool fromView = program->IsUniformUsed("penumbraViewMap");
  const glm::mat4 map(MakeMap(entry.Settings, entry.Base, fromView, matrices));
  program->SetUniformMatrix4x4(fromView ? "penumbraViewMap" : "penumbraScreenMap",
    const_cast<float*>(glm::value_ptr(map))); // VTK does not change it
  const ReceiverSettings& settings = entry.Settings.Settings;
  SetUniform(program, "penumbraAmbient", glm::vec3(settings.AmbientRadiance));
  SetUniform(program, "penumbraReflectance", glm::vec3(settings.Reflectance));
  program->SetUniformf("penumbraMiddleLight", entry.MiddleLight);
  program->SetUniformi(
    "penumbraIsSeen", entry.Settings.ProxyCentre || IsSeen(entry.Plan, matrices));
}

void SetReceiverUniforms(
  vtkShaderProgram* program, vtkReceiverTable* table, const ScreenMatrices& matrices)
{
  const glm::dmat4 viewToWorld = glm::inverse(matrices.WorldToView);
  const glm::mat3 fromView(glm::dmat3(viewToWorld) / table->GetUnit());
  const glm::dvec3 eye = (glm::dvec3(viewToWorld[3]) - table->GetOrigin()) / table->GetUnit();
  SetUniform(program, "penumbraGridScale", glm::vec3(table->GetGridScale()));
  SetUniform(program, "penumbraGridOffset", glm::vec3(table->GetGridOffset()));
  SetUniform(program, "penumbraGridCells", glm::vec3(table->GetGridCells()));
  program->SetUniformMatrix3x3(
    "penumbraFromView", const_cast<float*>(glm::value_ptr(fromView))); // VTK does not change it
  SetUniform(program, "penumbraEye", glm::vec3(eye));
  SetUniform(program, "penumbraEyeRest", glm::vec3(eye - glm::dvec3(glm::vec3(eye))));
  const glm::vec4 sight(-fromView[2], matrices.AreRaysParallel() ? 1.0f : 0.0f);
  program->SetUniform4f("penumbraSight", glm::value_ptr(sight));
  if (program->IsUniformUsed("penumbraToView"))
  {
    const glm::mat4 toView(MakeWindowToView(matrices.ViewToClip, matrices.Viewport));
    program->SetUniformMatrix4x4(
      "penumbraToView", const_cast<float*>(glm::value_ptr(toView))); // VTK does not change it
  }
}

std::vector<vtkReceiverTable::Record> MakeReceiverRecords(vtkBakedProp* baked)
{
  const std::vector<vtkBakedProp::Entry>& entries = baked->GetEntries();
  const std::vector<vtkRadianceTexture::Region>& regions = baked->GetTexture()->GetRegions();
  const glm::vec2 textureSize(baked->GetTexture()->GetSize());
  constexpr int FrontSide = 1, BackSide = 2, BothSides = FrontSide | BackSide;
  std::map<std::pair<std::size_t, int>, int> sides; // of each region, those that have texels
  for (const vtkBakedProp::Entry& entry : entries)
  {
    sides[{ entry.Settings.Surface, entry.Settings.Region }] |=
      entry.Plan.GetSide() == ReceiverSide::Front ? FrontSide : BackSide;
  }
  std::vector<vtkReceiverTable::Record> records;
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    const Receiver& receiver = entries[i].Settings;
    const vtkRadianceTexture::Region& region = regions[i];
    vtkReceiverTable::Record record;
    record.Base = receiver.Base;
    record.IsTriangle = receiver.IsTriangle;
    record.IsHalf = region.Half != AtlasHalf::Whole;
    record.IsWindow = receiver.WindowOf.has_value();
    record.ProxyCentre = receiver.ProxyCentre;
    // Vertices are at the middles of texels: (u, v) begin and end half a texel inside the border.
    const float inset = entries[i].Vertices > 0 ? 0.5f : 0.0f;
    // Where a region is turned, (u, v) = (0, 0) is its end, and its size is negative.
    const auto step = static_cast<float>(region.GetStep());
    const glm::vec2 start(step > 0.0f ? region.Origin : region.Origin + region.Size);
    record.Place = glm::vec4((start + step * inset) / textureSize,
      step * (glm::vec2(region.Size) - 2.0f * inset) / textureSize);
    record.Ambient = glm::vec3(receiver.Settings.AmbientRadiance);
    record.Reflectance = glm::vec3(receiver.Settings.Reflectance);
    if (!receiver.ProxyCentre)
    {
      const bool isFront = entries[i].Plan.GetSide() == ReceiverSide::Front;
      const bool hasBoth = sides[{ receiver.Surface, receiver.Region }] == BothSides;
      record.SeenSide = (isFront ? 1.0f : -1.0f) * (hasBoth ? 2.0f : 1.0f);
      record.MiddleLight = entries[i].MiddleLight;
    }
    records.push_back(record);
  }
  return records;
}

} // namespace penumbra

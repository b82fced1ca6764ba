// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkSoftShadowPass.h"

#include "ScreenMap.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLCamera.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkProp.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkRenderState.h"
#include "vtkRenderStepsPass.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkShadowSceneCollector.h"
#include "vtkSoftShadowFS.h"
#include "vtkTextureObject.h"
#include "vtkTextureUnitManager.h"
#include "vtkWeakPointer.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSoftShadowPass);
vtkInformationKeyMacro(vtkSoftShadowPass, DESIGNATED, Integer);
vtkInformationKeyMacro(vtkSoftShadowPass, RECEIVER_INDEX, Integer);

namespace
{

/// A prop that shows receivers, with what its shader needs.
struct ShownProp
{
  vtkWeakPointer<vtkProp> Prop;
  std::vector<std::size_t> Receivers; ///< indices into the scene's
  vtkSmartPointer<vtkRadianceTexture> Texture;
  int Shading = vtkSoftShadowPass::SHADOW;
};

/// Uniforms that a receiver takes, in units of four floats, and what is left to VTK's own.
constexpr int VectorsPerReceiver = 7;
constexpr int VectorsOfVTK = 128;

/// How many receivers the shader of one prop can tell apart.
std::size_t GetMaximumReceivers(vtkOpenGLRenderWindow* window)
{
  GLint components = 0;
  window->GetState()->vtkglGetIntegerv(GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, &components);
  return static_cast<std::size_t>(
    std::max(1, (components / 4 - VectorsOfVTK) / VectorsPerReceiver));
}

/// The uniforms of vtkSoftShadowFS.glsl, an element (of penumbraRows three) for each receiver.
struct ReceiverUniforms
{
  std::vector<glm::vec3> Rows, Depths, Ambient, Reflectance;
  std::vector<glm::vec4> Places;

  void Add(const penumbra::ScreenMap& map, const penumbra::ReceiverSettings& settings,
    const vtkRadianceTexture::Region& region, const glm::vec2& textureSize)
  {
    this->Rows.insert(this->Rows.end(), std::begin(map.Rows), std::end(map.Rows));
    this->Depths.emplace_back(map.Depth);
    this->Ambient.emplace_back(settings.AmbientRadiance);
    this->Reflectance.emplace_back(settings.Reflectance);
    this->Places.emplace_back(
      glm::vec2(region.Origin) / textureSize, glm::vec2(region.Size) / textureSize);
  }

  void Set(vtkShaderProgram* program) const
  {
    const auto set = [&](const char* name, const std::vector<glm::vec3>& values)
    { program->SetUniform3fv(name, static_cast<int>(values.size()), &values.front().x); };
    set("penumbraRows", this->Rows);
    set("penumbraDepths", this->Depths);
    set("penumbraAmbient", this->Ambient);
    set("penumbraReflectance", this->Reflectance);
    program->SetUniform4fv(
      "penumbraPlaces", static_cast<int>(this->Places.size()), &this->Places.front().x);
  }
};

} // namespace

struct vtkSoftShadowPass::Internals
{
  vtkNew<vtkShadowSceneCollector> Collector;
  std::vector<ShownProp> Shown;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkTimeStamp BakeTime;
  vtkTimeStamp ShaderTime;
  /// While the delegate draws:
  vtkRenderer* Renderer = nullptr;
  int TextureUnit = -1;
};

vtkSoftShadowPass::vtkSoftShadowPass()
  : Impl(new Internals)
{
}

vtkSoftShadowPass::~vtkSoftShadowPass() = default;

void vtkSoftShadowPass::SetDelegatePass(vtkRenderPass* pass)
{
  if (this->DelegatePass != pass)
  {
    this->DelegatePass = pass;
    this->Modified();
  }
}

vtkRenderPass* vtkSoftShadowPass::GetDelegatePass()
{
  return this->DelegatePass;
}

void vtkSoftShadowPass::Designate(vtkProp* prop, int shading)
{
  vtkSmartPointer<vtkInformation> keys = prop->GetPropertyKeys();
  if (!keys)
  {
    keys = vtkSmartPointer<vtkInformation>::New();
    prop->SetPropertyKeys(keys);
  }
  keys->Set(DESIGNATED(), shading);
}

void vtkSoftShadowPass::Undesignate(vtkProp* prop)
{
  if (vtkInformation* keys = prop->GetPropertyKeys())
  {
    keys->Remove(DESIGNATED());
  }
}

void vtkSoftShadowPass::Render(const vtkRenderState* s)
{
  this->NumberOfRenderedProps = 0;
  if (!this->DelegatePass)
  {
    this->DelegatePass = vtkSmartPointer<vtkRenderStepsPass>::New();
  }
  vtkRenderer* renderer = s->GetRenderer();
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window)
  {
    vtkErrorMacro("The renderer has no OpenGL window; one is needed to show shadows.");
    return;
  }
  this->UpdateScene(renderer, window);

  vtkTextureUnitManager* units = window->GetState()->GetTextureUnitManager();
  this->Impl->Renderer = renderer;
  this->Impl->TextureUnit = this->Impl->Shown.empty() ? -1 : units->Allocate();
  std::vector<vtkProp*> props;
  if (this->Impl->TextureUnit >= 0)
  {
    props = this->MarkReceivers();
  }
  else if (!this->Impl->Shown.empty())
  {
    vtkErrorMacro(
      "No texture unit is free, and one is needed. Receivers are drawn without shadows.");
  }
  vtkRenderState receivers(renderer);
  receivers.SetPropArrayAndCount(props.data(), static_cast<int>(props.size()));
  receivers.SetFrameBuffer(s->GetFrameBuffer());

  this->PreRender(&receivers);
  this->DelegatePass->Render(s);
  this->PostRender(&receivers);
  this->NumberOfRenderedProps = this->DelegatePass->GetNumberOfRenderedProps();

  if (this->Impl->TextureUnit >= 0)
  {
    units->Free(this->Impl->TextureUnit);
  }
  this->Impl->TextureUnit = -1;
  this->Impl->Renderer = nullptr;
}

void vtkSoftShadowPass::UpdateScene(vtkRenderer* renderer, vtkOpenGLRenderWindow* window)
{
  const bool isNewWindow = window != this->Impl->Window ||
    window->GetContextCreationTime() > this->Impl->BakeTime.GetMTime();
  if (this->KeepBakes && !isNewWindow && !this->Impl->Shown.empty())
  {
    return;
  }
  if (this->Impl->Collector->Update(renderer, this->OnlyDesignated) || isNewWindow)
  {
    this->BakeReceivers(window);
  }
}

void vtkSoftShadowPass::BakeReceivers(vtkOpenGLRenderWindow* window)
{
  const penumbra::ShadowScene& scene = this->Impl->Collector->GetScene();
  this->Impl->Shown.clear();
  this->Impl->Window = window;
  this->Impl->BakeTime.Modified();
  this->Impl->ShaderTime.Modified();
  // Without a light nothing is in shadow: receivers are drawn plain.
  if (scene.Lights.empty() || scene.Receivers.empty())
  {
    return;
  }
  ++this->BakeCount;
  const std::size_t maximum = GetMaximumReceivers(window);
  for (const auto& [prop, receivers] : this->Impl->Collector->GetReceiverProps())
  {
    if (receivers.size() > maximum)
    {
      vtkErrorMacro("A surface has " << receivers.size() << " planar receivers; allowed: "
                                     << maximum << ". Divide it. It is drawn without shadows.");
      continue;
    }
    ShownProp shown{ prop, receivers, vtkSmartPointer<vtkRadianceTexture>::New() };
    if (!this->Baker->Bake(scene, receivers, window, shown.Texture).empty())
    {
      shown.Texture->ReleaseVariance();
      this->Impl->Shown.push_back(shown);
    }
  }
}

std::vector<vtkProp*> vtkSoftShadowPass::MarkReceivers()
{
  std::vector<vtkProp*> props;
  for (std::size_t i = 0; i < this->Impl->Shown.size(); ++i)
  {
    ShownProp& shown = this->Impl->Shown[i];
    vtkInformation* keys = shown.Prop->GetPropertyKeys();
    const int shading = keys && keys->Has(DESIGNATED()) ? keys->Get(DESIGNATED()) : this->Shading;
    if (shading != shown.Shading)
    {
      shown.Shading = shading;
      this->Impl->ShaderTime.Modified();
    }
    if (!keys)
    {
      vtkNew<vtkInformation> newKeys;
      shown.Prop->SetPropertyKeys(newKeys);
      keys = newKeys;
    }
    keys->Set(RECEIVER_INDEX(), static_cast<int>(i));
    props.push_back(shown.Prop);
  }
  return props;
}

bool vtkSoftShadowPass::PostReplaceShaderValues(std::string& /*vertexShader*/,
  std::string& /*geometryShader*/, std::string& fragmentShader, vtkAbstractMapper* /*mapper*/,
  vtkProp* prop)
{
  // A uniform that is declared twice does not compile, and VTK crashes on shaders that do not.
  if (fragmentShader.find("penumbraTexture") != std::string::npos)
  {
    return true;
  }
  const auto index = static_cast<std::size_t>(prop->GetPropertyKeys()->Get(RECEIVER_INDEX()));
  const ShownProp& shown = this->Impl->Shown[index];
  vtkShaderProgram::Substitute(fragmentShader, "//VTK::Output::Dec",
    "//VTK::Output::Dec\n#define PENUMBRA_RECEIVERS " + std::to_string(shown.Receivers.size()) +
      "\n" + vtkSoftShadowFS);

  // The parts of VTK's light model are there by name, save for unlit and physically based shading.
  const bool hasDiffuse =
    fragmentShader.find("ambientColor + diffuse + specular") != std::string::npos;
  const std::string shade = shown.Shading == RADIANCE
    ? "  gl_FragData[0].rgb = diffuseColor * penumbraRadiance();\n"
    : hasDiffuse ? "  gl_FragData[0].rgb += (penumbraShadow() - 1.0) * diffuse;\n"
                 : "  gl_FragData[0].rgb *= penumbraShadow();\n";
  vtkShaderProgram::Substitute(
    fragmentShader, "//VTK::Light::Impl", "//VTK::Light::Impl\n" + shade, false);
  return true;
}

bool vtkSoftShadowPass::SetShaderParameters(vtkShaderProgram* program,
  vtkAbstractMapper* /*mapper*/, vtkProp* prop, vtkOpenGLVertexArrayObject* /*VAO*/)
{
  if (!program->IsUniformUsed("penumbraTexture"))
  {
    return true;
  }
  const auto index = static_cast<std::size_t>(prop->GetPropertyKeys()->Get(RECEIVER_INDEX()));
  const ShownProp& shown = this->Impl->Shown[index];
  vtkOpenGLState* state = this->Impl->Window->GetState();
  state->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(this->Impl->TextureUnit));
  glBindTexture(GL_TEXTURE_2D, shown.Texture->GetIrradiance()->GetHandle());
  program->SetUniformi("penumbraTexture", this->Impl->TextureUnit);

  // The matrices that the mappers use; vtkOpenGLCamera gives them transposed, as OpenGL reads them.
  vtkMatrix4x4 *worldToView, *viewToClip, *worldToClip;
  vtkMatrix3x3* normals;
  vtkOpenGLCamera::SafeDownCast(this->Impl->Renderer->GetActiveCamera())
    ->GetKeyMatrices(this->Impl->Renderer, worldToView, normals, viewToClip, worldToClip);
  glm::ivec4 viewport;
  state->vtkglGetIntegerv(GL_VIEWPORT, &viewport.x);

  const penumbra::ShadowScene& scene = this->Impl->Collector->GetScene();
  ReceiverUniforms uniforms;
  for (std::size_t i = 0; i < shown.Receivers.size(); ++i)
  {
    const penumbra::Receiver& receiver = scene.Receivers[shown.Receivers[i]];
    uniforms.Add(penumbra::MakeScreenMap(receiver.Base, glm::make_mat4(worldToView->GetData()),
                   glm::make_mat4(viewToClip->GetData()), viewport),
      receiver.Settings, shown.Texture->GetRegions()[i], glm::vec2(shown.Texture->GetSize()));
  }
  uniforms.Set(program);
  return true;
}

vtkMTimeType vtkSoftShadowPass::GetShaderStageMTime()
{
  return this->Impl->ShaderTime.GetMTime();
}

int vtkSoftShadowPass::GetNumberOfReceivers() const
{
  std::size_t count = 0;
  for (const ShownProp& shown : this->Impl->Shown)
  {
    count += shown.Receivers.size();
  }
  return static_cast<int>(count);
}

vtkSmartPointer<vtkFloatArray> vtkSoftShadowPass::GetTexels(int receiver)
{
  auto index = static_cast<std::size_t>(receiver);
  for (const ShownProp& shown : this->Impl->Shown)
  {
    if (index < shown.Receivers.size())
    {
      const auto texels = shown.Texture->Download(shown.Texture->GetRegions()[index]).Irradiance;
      auto array = vtkSmartPointer<vtkFloatArray>::New();
      array->SetNumberOfComponents(4);
      array->SetNumberOfTuples(static_cast<vtkIdType>(texels.size()));
      std::copy_n(&texels.front().x, 4 * texels.size(), array->GetPointer(0));
      return array;
    }
    index -= shown.Receivers.size();
  }
  return nullptr;
}

vtkTypeInt64 vtkSoftShadowPass::GetTextureBytes() const
{
  std::size_t bytes = 0;
  for (const ShownProp& shown : this->Impl->Shown)
  {
    bytes += shown.Texture->GetBytes();
  }
  return static_cast<vtkTypeInt64>(bytes);
}

void vtkSoftShadowPass::ReleaseGraphicsResources(vtkWindow* window)
{
  if (this->DelegatePass)
  {
    this->DelegatePass->ReleaseGraphicsResources(window);
  }
  if (window == this->Impl->Window)
  {
    this->Impl->Shown.clear();
    this->Impl->Window = nullptr; // the next frame bakes anew
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkSoftShadowPass::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "DelegatePass: " << this->DelegatePass << "\n";
  os << indent << "Shading: " << this->Shading << "\n";
  os << indent << "OnlyDesignated: " << this->OnlyDesignated << "\n";
  os << indent << "KeepBakes: " << this->KeepBakes << "\n";
  os << indent << "BakeCount: " << this->BakeCount << "\n";
  os << indent << "Receivers: " << this->GetNumberOfReceivers() << "\n";
}

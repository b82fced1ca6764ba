// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkSoftShadowPass.h"

#include "FullScreenTriangle.h"
#include "PlanTable.h"
#include "ScreenMap.h"
#include "vtkActor.h"
#include "vtkBakedProp.h"
#include "vtkCommand.h"
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
#include "vtkProperty.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkRenderState.h"
#include "vtkRenderStepsPass.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkShadowFactors.h"
#include "vtkShadowSceneCollector.h"
#include "vtkSoftShadowFS.h"
#include "vtkTextureObject.h"
#include "vtkTextureUnitManager.h"
#include "vtkTimerLog.h"
#include "vtkWeakPointer.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSoftShadowPass);
vtkInformationKeyMacro(vtkSoftShadowPass, DESIGNATED, Integer);
vtkInformationKeyMacro(vtkSoftShadowPass, CASTS_NO_SHADOW, Integer);
vtkInformationKeyMacro(vtkSoftShadowPass, RECEIVER_INDEX, Integer);

namespace
{

/// A prop that shows receivers, with what its shader needs.
struct ShownProp
{
  vtkWeakPointer<vtkProp> Prop;
  vtkSmartPointer<vtkBakedProp> Baked;
  vtkSmartPointer<vtkShadowFactors> Factors = nullptr; ///< for SHADOW alone
  int Shading = vtkSoftShadowPass::SHADOW;
  bool HasShownTexture = false; ///< the one of the shading
  bool WasTried = false;        ///< to make it: once, so that an error is not one of each frame
  bool IsMatte = false;

  std::size_t CountReceivers() const { return this->Baked->GetEntries().size(); }
  std::size_t GetBytes() const
  {
    return this->Baked->GetBytes() + (this->Factors ? this->Factors->GetBytes() : 0);
  }
};

vtkInformation* GetOrMakeKeys(vtkProp* prop)
{
  if (!prop->GetPropertyKeys())
  {
    vtkNew<vtkInformation> keys;
    prop->SetPropertyKeys(keys);
  }
  return prop->GetPropertyKeys();
}

/// The largest factor that the diffuse shade of receivers may have.
double GetLargestFactor(
  const penumbra::ShadowScene& scene, const std::vector<glm::dvec3>& ambientRadiances)
{
  double largest = 1.0;
  for (const glm::dvec3& ambient : ambientRadiances)
  {
    largest = std::max(largest, vtkShadowFactors::GetLargestFactor(ambient));
  }
  for (const penumbra::Light& light : scene.Lights)
  {
    // Cells may be of any hue.
    largest = std::max(largest,
      light->GetEmission() == penumbra::Emission::Cells
        ? vtkShadowFactors::LargestFactor
        : vtkShadowFactors::GetLargestFactor(light->Radiance));
  }
  return largest;
}

/// Makes what the prop's shading shows, and frees what it does not.
void MakeShownTexture(
  ShownProp& shown, const penumbra::ShadowScene& scene, vtkOpenGLRenderWindow* window)
{
  shown.WasTried = true;
  vtkOpenGLState* state = window->GetState();
  state->Push();
  vtkRadianceTexture* texture = shown.Baked->GetTexture();
  if (shown.Shading == vtkSoftShadowPass::RADIANCE)
  {
    if (shown.Factors)
    {
      shown.Factors->ReleaseGraphicsResources();
    }
    shown.HasShownTexture = texture->GenerateMipmaps();
  }
  else
  {
    std::vector<glm::dvec3> ambient;
    for (const vtkBakedProp::Entry& entry : shown.Baked->GetEntries())
    {
      ambient.push_back(entry.Settings.Settings.AmbientRadiance);
    }
    texture->ReleaseMipmaps();
    shown.Factors = vtkSmartPointer<vtkShadowFactors>::New();
    shown.HasShownTexture =
      shown.Factors->Make(window, texture, ambient, GetLargestFactor(scene, ambient));
  }
  state->Pop();
}

/// Whether OpenGL compiles what the shaders of props with so many receivers get: VTK crashes on
/// shaders that do not compile.
bool CompilesShadowCode(std::size_t receivers, vtkOpenGLRenderWindow* window)
{
  const std::string source = "//VTK::System::Dec\n//VTK::Output::Dec\n#define PENUMBRA_RECEIVERS " +
    std::to_string(receivers) + "\n" + vtkSoftShadowFS +
    "void main()\n{\n  gl_FragData[0] = vec4(penumbraShadow(gl_FragCoord) + "
    "penumbraRadiance(gl_FragCoord), 1.0);\n}\n";
  return penumbra::ReadyFullScreenProgram(window, source.c_str());
}

/// True if an actor's material has no specular part.
bool IsMatte(vtkProp* prop)
{
  auto* actor = vtkActor::SafeDownCast(prop);
  const auto hasNone = [](vtkProperty* property)
  { return !property || property->GetSpecular() == 0.0; };
  return actor && hasNone(actor->GetProperty()) && hasNone(actor->GetBackfaceProperty());
}

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
glm::dmat4 MakeMap(const penumbra::Receiver& receiver, bool fromView, const glm::dmat4& worldToView,
  const glm::dmat4& viewToClip, const glm::ivec4& viewport)
{
  const penumbra::Parallelogram& base = receiver.Base;
  if (receiver.ProxyCentre)
  {
    const glm::dvec4& centre = *receiver.ProxyCentre;
    return fromView ? penumbra::MakeProxyViewMap(base, centre, worldToView)
                    : penumbra::MakeProxyScreenMap(base, centre, worldToView, viewToClip, viewport);
  }
  return fromView ? penumbra::MakeViewMap(base, worldToView)
                  : penumbra::MakeScreenMap(base, worldToView, viewToClip, viewport);
}

/// Uniforms that a receiver takes, in units of four floats, and what is left to VTK's own.
constexpr int VectorsPerReceiver = 7;
constexpr int VectorsOfVTK = 128;

/// The prop's entry of before, taken out of there, or a new one.
ShownProp TakeShown(std::vector<ShownProp>& before, vtkProp* prop)
{
  const auto entry = std::find_if(
    before.begin(), before.end(), [prop](const ShownProp& shown) { return shown.Prop == prop; });
  if (entry == before.end())
  {
    return { prop, vtkSmartPointer<vtkBakedProp>::New() };
  }
  ShownProp shown = *entry;
  before.erase(entry);
  return shown;
}

/// How many receivers the shader of one prop can tell apart.
std::size_t GetMaximumReceivers(vtkOpenGLRenderWindow* window)
{
  GLint components = 0;
  window->GetState()->vtkglGetIntegerv(GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, &components);
  return static_cast<std::size_t>(
    std::max(1, (components / 4 - VectorsOfVTK) / VectorsPerReceiver));
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
  void Add(const glm::dmat4& map, const penumbra::ReceiverSettings& settings,
    const vtkRadianceTexture::Region& region, const glm::vec2& textureSize, float inset)
  {
    this->Maps.emplace_back(map);
    const bool isHalf = region.Half != penumbra::AtlasHalf::Whole;
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

struct vtkSoftShadowPass::Internals
{
  vtkNew<vtkShadowSceneCollector> Collector;
  penumbra::ShadowScene Scene; ///< the collector's, with texels that fit into the memory
  std::vector<ShownProp> Shown;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkTimeStamp BakeTime;
  vtkTimeStamp ShaderTime;
  /// While the delegate draws:
  vtkRenderer* Renderer = nullptr;
  int TextureUnit = -1;

  /// What a prop shows; nullptr if that was released since the delegate began.
  const ShownProp* Find(vtkProp* prop) const
  {
    vtkInformation* keys = prop->GetPropertyKeys();
    const int index = keys && keys->Has(RECEIVER_INDEX()) ? keys->Get(RECEIVER_INDEX()) : -1;
    const bool isThere = index >= 0 && index < static_cast<int>(this->Shown.size());
    return isThere ? &this->Shown[static_cast<std::size_t>(index)] : nullptr;
  }
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
  GetOrMakeKeys(prop)->Set(DESIGNATED(), shading);
}

void vtkSoftShadowPass::Undesignate(vtkProp* prop)
{
  if (vtkInformation* keys = prop->GetPropertyKeys())
  {
    keys->Remove(DESIGNATED());
  }
}

void vtkSoftShadowPass::SetCastShadow(vtkProp* prop, bool cast)
{
  if (!cast)
  {
    GetOrMakeKeys(prop)->Set(CASTS_NO_SHADOW(), 1);
  }
  else if (vtkInformation* keys = prop->GetPropertyKeys())
  {
    keys->Remove(CASTS_NO_SHADOW());
  }
}

bool vtkSoftShadowPass::GetCastShadow(vtkProp* prop)
{
  vtkInformation* keys = prop->GetPropertyKeys();
  return !keys || !keys->Has(CASTS_NO_SHADOW());
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
  this->ChooseShading();

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

int vtkSoftShadowPass::GetShadingOf(vtkProp* prop) const
{
  vtkInformation* keys = prop->GetPropertyKeys();
  return keys && keys->Has(DESIGNATED()) ? keys->Get(DESIGNATED()) : this->Shading;
}

void vtkSoftShadowPass::UpdateScene(vtkRenderer* renderer, vtkOpenGLRenderWindow* window)
{
  const bool isNewWindow = window != this->Impl->Window ||
    window->GetContextCreationTime() > this->Impl->BakeTime.GetMTime();
  // What is shown decides what has to be baked.
  const bool isShadedOtherwise = std::any_of(this->Impl->Shown.begin(), this->Impl->Shown.end(),
    [this](const ShownProp& shown)
    { return shown.Prop && this->GetShadingOf(shown.Prop) != shown.Shading; });
  if (this->Impl->Collector->Update(renderer, this->OnlyDesignated) || isNewWindow ||
    isShadedOtherwise)
  {
    if (isNewWindow)
    {
      this->Impl->Shown.clear();
    }
    this->BakeReceivers(window);
  }
  else if (this->BakeMode != DRAFT && this->GetBakeProgress() < 1.0)
  {
    this->FinishDrafts();
  }
  this->ReportProgress();
}

void vtkSoftShadowPass::BakeReceivers(vtkOpenGLRenderWindow* window)
{
  this->Impl->Scene = this->Impl->Collector->GetScene();
  const penumbra::ShadowScene& scene = this->Impl->Scene;
  this->Impl->Window = window;
  this->Impl->BakeTime.Modified();
  std::vector<ShownProp> before;
  before.swap(this->Impl->Shown);
  // Without a light nothing is in shadow: receivers are drawn plain.
  if (scene.Lights.empty() || scene.Receivers.empty())
  {
    this->Impl->ShaderTime.Modified();
    return;
  }
  vtkOpenGLState* state = window->GetState();
  state->Push();
  this->Baker->SetScene(scene);
  const std::vector<penumbra::ReceiverPlan> plans = this->PlanReceivers();
  bool isBaked = false;
  const std::size_t maximum = GetMaximumReceivers(window);
  for (const auto& [prop, receivers] : this->Impl->Collector->GetReceiverProps())
  {
    if (receivers.size() > maximum)
    {
      vtkErrorMacro("A surface has " << receivers.size() << " planar receivers; allowed: "
                                     << maximum << ". Divide it. It is drawn without shadows.");
      continue;
    }
    ShownProp shown = TakeShown(before, prop);
    const int shading = this->GetShadingOf(prop);
    const vtkBakedProp::Outcome outcome = shown.Baked->Update(this->Baker, scene, receivers, plans,
      window, shading == RADIANCE, this->BakeMode != COMPLETE);
    if (outcome != vtkBakedProp::Outcome::Unchanged)
    {
      shown.HasShownTexture = false;
      shown.WasTried = false;
    }
    isBaked = isBaked || outcome == vtkBakedProp::Outcome::Baked;
    if (outcome != vtkBakedProp::Outcome::Failed)
    {
      this->Impl->Shown.push_back(shown);
    }
  }
  this->Baker->ReleaseGraphicsResources();
  state->Pop();
  this->BakeCount += isBaked ? 1 : 0;
  this->Impl->ShaderTime.Modified();
}

void vtkSoftShadowPass::FinishDrafts()
{
  const double start = vtkTimerLog::GetUniversalTime();
  vtkOpenGLState* state = this->Impl->Window->GetState();
  state->Push();
  bool isBaked = false;
  for (ShownProp& shown : this->Impl->Shown)
  {
    constexpr double Shortest = 1e-3;
    const double left = this->BatchSeconds - (vtkTimerLog::GetUniversalTime() - start);
    if (shown.Baked->CountDraftTexels() > 0.0 &&
      (this->BakeMode == COMPLETE || !isBaked || left > 0.0))
    {
      shown.Baked->Finish(this->Baker, this->BakeMode == COMPLETE ? 0.0 : std::max(left, Shortest));
      shown.HasShownTexture = false;
      shown.WasTried = false;
      isBaked = true;
    }
  }
  this->Baker->ReleaseGraphicsResources();
  state->Pop();
  this->BakeCount += isBaked ? 1 : 0;
}

double vtkSoftShadowPass::GetBakeProgress() const
{
  double drafts = 0.0, all = 0.0;
  for (const ShownProp& shown : this->Impl->Shown)
  {
    drafts += shown.Baked->CountDraftTexels();
    all += shown.Baked->CountTexels();
  }
  return all > 0.0 ? 1.0 - drafts / all : 1.0;
}

void vtkSoftShadowPass::ReportProgress()
{
  double progress = this->GetBakeProgress();
  if (progress != this->ReportedProgress)
  {
    this->ReportedProgress = progress;
    this->InvokeEvent(vtkCommand::ProgressEvent, &progress);
  }
}

std::vector<penumbra::ReceiverPlan> vtkSoftShadowPass::PlanReceivers()
{
  std::vector<penumbra::ReceiverPlan> plans;
  for (std::size_t i = 0; i < this->Impl->Scene.Receivers.size(); ++i)
  {
    plans.push_back(this->Baker->Plan(i));
  }
  return plans;
}

void vtkSoftShadowPass::ChooseShading()
{
  // Props may have been deleted since they were baked.
  std::vector<ShownProp>& all = this->Impl->Shown;
  all.erase(
    std::remove_if(all.begin(), all.end(), [](const ShownProp& s) { return !s.Prop; }), all.end());
  for (ShownProp& shown : this->Impl->Shown)
  {
    const int shading = this->GetShadingOf(shown.Prop);
    const bool isMatte = IsMatte(shown.Prop);
    const bool isOther = shading != shown.Shading;
    vtkRadianceTexture* texture = shown.Baked->GetTexture();
    if (texture->GetMaximumAnisotropy() != this->MaximumAnisotropy)
    {
      texture->SetMaximumAnisotropy(this->MaximumAnisotropy);
      shown.WasTried = false;
    }
    if (isOther || isMatte != shown.IsMatte)
    {
      shown.Shading = shading;
      shown.IsMatte = isMatte;
      this->Impl->ShaderTime.Modified();
    }
    if (shown.Baked->HasTexture() && (isOther || !shown.WasTried))
    {
      MakeShownTexture(shown, this->Impl->Scene, this->Impl->Window);
      if (!CompilesShadowCode(shown.CountReceivers(), this->Impl->Window))
      {
        vtkErrorMacro("The shader code that shows shadows on "
          << shown.CountReceivers() << " receivers did not compile. They are drawn without "
          << "shadows; update the OpenGL driver.");
        shown.HasShownTexture = false;
      }
    }
  }
}

std::vector<vtkProp*> vtkSoftShadowPass::MarkReceivers()
{
  std::vector<vtkProp*> props;
  for (std::size_t i = 0; i < this->Impl->Shown.size(); ++i)
  {
    const ShownProp& shown = this->Impl->Shown[i];
    if (!shown.HasShownTexture)
    {
      continue; // drawn plain
    }
    GetOrMakeKeys(shown.Prop)->Set(RECEIVER_INDEX(), static_cast<int>(i));
    props.push_back(shown.Prop);
  }
  return props;
}

bool vtkSoftShadowPass::PostReplaceShaderValues(std::string& vertexShader,
  std::string& geometryShader, std::string& fragmentShader, vtkAbstractMapper* /*mapper*/,
  vtkProp* prop)
{
  // A uniform that is declared twice does not compile, and VTK crashes on shaders that do not.
  const ShownProp* found = this->Impl->Find(prop);
  if (!found || fragmentShader.find("penumbraTexture") != std::string::npos)
  {
    return true;
  }
  const ShownProp& shown = *found;
  std::string defines =
    "#define PENUMBRA_RECEIVERS " + std::to_string(shown.CountReceivers()) + "\n";
  const std::vector<vtkBakedProp::Entry>& entries = shown.Baked->GetEntries();
  const bool hasProxy = std::any_of(entries.begin(), entries.end(),
    [](const vtkBakedProp::Entry& entry) { return entry.Settings.ProxyCentre.has_value(); });
  std::string position = "vec4(gl_FragCoord.xyz, 1.0)";
  if (fragmentShader.find("vec4 vertexVC = ") != std::string::npos)
  {
    defines += "#define PENUMBRA_VIEW\n";
    position = "vec4(vertexVC.xyz, 1.0)";
    if (hasProxy)
    {
      defines += "#define PENUMBRA_PROXY\n";
    }
    else if (shown.CountReceivers() == 1 && AddVarying(vertexShader, geometryShader))
    {
      defines += "#define PENUMBRA_VARYING\n";
    }
  }
  vtkShaderProgram::Substitute(
    fragmentShader, "//VTK::Output::Dec", "//VTK::Output::Dec\n" + defines + vtkSoftShadowFS);

  // The parts of VTK's light model are there by name, save for unlit and physically based shading.
  // Without a specular material their specular part is 0, and need not be computed.
  const std::string shades = "ambientColor + diffuse + specular";
  const bool hasDiffuse = fragmentShader.find(shades) != std::string::npos;
  const std::string shadow = "penumbraShadow(" + position + ")";
  if (shown.Shading == SHADOW && hasDiffuse)
  {
    vtkShaderProgram::Substitute(fragmentShader, shades,
      "ambientColor + diffuse * " + shadow + (shown.IsMatte ? "" : " + specular"));
    return true;
  }
  const std::string shade = shown.Shading == RADIANCE
    ? "  gl_FragData[0].rgb = diffuseColor * penumbraRadiance(" + position + ");\n"
    : "  gl_FragData[0].rgb *= " + shadow + ";\n";
  vtkShaderProgram::Substitute(
    fragmentShader, "//VTK::Light::Impl", "//VTK::Light::Impl\n" + shade, false);
  return true;
}

bool vtkSoftShadowPass::SetShaderParameters(vtkShaderProgram* program,
  vtkAbstractMapper* /*mapper*/, vtkProp* prop, vtkOpenGLVertexArrayObject* /*VAO*/)
{
  const ShownProp* found = this->Impl->Find(prop);
  if (!found || !program->IsUniformUsed("penumbraTexture"))
  {
    return true;
  }
  const ShownProp& shown = *found;
  vtkOpenGLState* state = this->Impl->Window->GetState();
  state->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(this->Impl->TextureUnit));
  vtkRadianceTexture* radiance = shown.Baked->GetTexture();
  vtkTextureObject* texture =
    shown.Shading == RADIANCE ? radiance->GetIrradiance() : shown.Factors->GetTexture();
  glBindTexture(GL_TEXTURE_2D, texture->GetHandle());
  program->SetUniformi("penumbraTexture", this->Impl->TextureUnit);

  // The matrices that the mappers use; vtkOpenGLCamera gives them transposed, as OpenGL reads them.
  vtkMatrix4x4 *worldToView, *viewToClip, *worldToClip;
  vtkMatrix3x3* normals;
  vtkOpenGLCamera::SafeDownCast(this->Impl->Renderer->GetActiveCamera())
    ->GetKeyMatrices(this->Impl->Renderer, worldToView, normals, viewToClip, worldToClip);
  const glm::dmat4 toView = glm::make_mat4(worldToView->GetData());
  const glm::dmat4 toClip = glm::make_mat4(viewToClip->GetData());
  glm::ivec4 viewport;
  state->vtkglGetIntegerv(GL_VIEWPORT, &viewport.x);

  const bool fromView = program->IsUniformUsed("penumbraViewMaps");
  ReceiverUniforms uniforms;
  for (std::size_t i = 0; i < shown.CountReceivers(); ++i)
  {
    const vtkBakedProp::Entry& entry = shown.Baked->GetEntries()[i];
    penumbra::Receiver receiver = entry.Settings;
    // Alone, it fills its texture, and (u, v) are the texture's; of several, the closest is looked
    // for, by its own parallelogram.
    const bool isAlone = shown.CountReceivers() == 1;
    receiver.Base = isAlone ? entry.Base : receiver.Base;
    uniforms.Add(MakeMap(receiver, fromView, toView, toClip, viewport), receiver.Settings,
      radiance->GetRegions()[i], glm::vec2(radiance->GetSize()),
      !isAlone && entry.Vertices > 0 ? 0.5f : 0.0f);
  }
  if (shown.Factors)
  {
    program->SetUniformf("penumbraScale", shown.Factors->GetScale());
  }
  uniforms.Set(program, fromView ? "penumbraViewMaps" : "penumbraScreenMaps");
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
    count += shown.CountReceivers();
  }
  return static_cast<int>(count);
}

vtkSmartPointer<vtkFloatArray> vtkSoftShadowPass::GetTexels(int receiver)
{
  auto index = static_cast<std::size_t>(receiver);
  for (const ShownProp& shown : this->Impl->Shown)
  {
    if (index < shown.CountReceivers())
    {
      if (!this->Impl->Window)
      {
        return nullptr; // the texels went with it
      }
      const auto texels = shown.Baked->Download(this->Impl->Scene, index, this->Impl->Window);
      if (texels.empty())
      {
        return nullptr;
      }
      auto array = vtkSmartPointer<vtkFloatArray>::New();
      array->SetNumberOfComponents(4);
      array->SetNumberOfTuples(static_cast<vtkIdType>(texels.size()));
      std::copy_n(&texels.front().x, 4 * texels.size(), array->GetPointer(0));
      return array;
    }
    index -= shown.CountReceivers();
  }
  return nullptr;
}

void vtkSoftShadowPass::GetPlan(vtkTable* table)
{
  penumbra::MakePlanTable(table);
  int receiver = 0;
  for (const ShownProp& shown : this->Impl->Shown)
  {
    for (const vtkBakedProp::Entry& entry : shown.Baked->GetEntries())
    {
      penumbra::AddToPlanTable(receiver++, entry.Report, table);
    }
  }
}

vtkTypeInt64 vtkSoftShadowPass::GetTextureBytes() const
{
  std::size_t bytes = 0;
  for (const ShownProp& shown : this->Impl->Shown)
  {
    bytes += shown.GetBytes();
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
    this->Impl->Shown.clear();    // textures free themselves in their own context
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
  os << indent << "BakeMode: " << this->BakeMode << "\n";
  os << indent << "BatchSeconds: " << this->BatchSeconds << "\n";
  os << indent << "BakeProgress: " << this->GetBakeProgress() << "\n";
  os << indent << "MaximumAnisotropy: " << this->MaximumAnisotropy << "\n";
  os << indent << "BakeCount: " << this->BakeCount << "\n";
  os << indent << "Receivers: " << this->GetNumberOfReceivers() << "\n";
}

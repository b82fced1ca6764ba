// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenGLLoader.h"

#include "vtkSoftShadowPass.h"

#include "PlanTable.h"
#include "ReceiverShader.h"
#include "ShadingVertices.h"
#include "TextureMemory.h"
#include "vtkActor.h"
#include "vtkBakedProp.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkProp.h"
#include "vtkProperty.h"
#include "vtkRadianceBaker.h"
#include "vtkRadianceTexture.h"
#include "vtkReceiverTable.h"
#include "vtkRenderState.h"
#include "vtkRenderStepsPass.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkShadowFactors.h"
#include "vtkShadowSceneCollector.h"
#include "vtkTextureObject.h"
#include "vtkTextureUnitManager.h"
#include "vtkTimerLog.h"
#include "vtkWeakPointer.h"

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
  vtkSmartPointer<vtkReceiverTable> Table = nullptr;   ///< of several receivers
  int Shading = vtkSoftShadowPass::SHADOW;
  bool HasShownTexture = false; ///< the one of the shading
  bool WasTried = false;        ///< to make it: once, so that an error is not one of each frame
  bool HasProxy = false;        ///< a plane stands for a surface; as of when the texture was made
  bool IsMatte = false;

  std::size_t CountEntries() const { return this->Baked->GetEntries().size(); }
  std::size_t CountReceivers() const { return this->CountEntries() - this->Baked->CountParts(); }
  std::size_t GetBytes() const
  {
    return this->Baked->GetBytes() + (this->Factors ? this->Factors->GetBytes() : 0) +
      (this->Table ? this->Table->GetBytes() : 0);
  }
  penumbra::ShadowCode GetCode() const
  {
    penumbra::ShadowCode code;
    code.HasSeveral = this->CountEntries() > 1;
    code.HasProxy = this->HasProxy;
    code.ShowsRadiance = this->Shading == vtkSoftShadowPass::RADIANCE;
    code.IsMatte = this->IsMatte;
    return code;
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
  const std::vector<vtkBakedProp::Entry>& entries = shown.Baked->GetEntries();
  shown.HasProxy = std::any_of(entries.begin(), entries.end(),
    [](const vtkBakedProp::Entry& entry) { return entry.Settings.ProxyCentre.has_value(); });
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
    for (const vtkBakedProp::Entry& entry : entries)
    {
      ambient.push_back(entry.Settings.Settings.AmbientRadiance);
    }
    texture->ReleaseMipmaps();
    shown.Factors = vtkSmartPointer<vtkShadowFactors>::New();
    shown.HasShownTexture =
      shown.Factors->Make(window, texture, ambient, GetLargestFactor(scene, ambient));
  }
  state->Pop();
  if (shown.HasShownTexture && shown.CountEntries() > 1)
  {
    if (!shown.Table)
    {
      shown.Table = vtkSmartPointer<vtkReceiverTable>::New();
    }
    shown.HasShownTexture = shown.Table->Update(window, penumbra::MakeReceiverRecords(shown.Baked));
  }
}

/// True if an actor's material has no specular part.
bool IsMatte(vtkProp* prop)
{
  auto* actor = vtkActor::SafeDownCast(prop);
  const auto hasNone = [](vtkProperty* property)
  { return !property || property->GetSpecular() == 0.0; };
  return actor && hasNone(actor->GetProperty()) && hasNone(actor->GetBackfaceProperty());
}

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

} // namespace

struct vtkSoftShadowPass::Internals
{
  vtkNew<vtkShadowSceneCollector> Collector;
  penumbra::ShadowScene Scene; ///< the collector's, with texels that fit into the memory
  penumbra::TextureBudget Budget;
  double BudgetMemory = 0.0; ///< the MaximumTextureMemory that this is of
  std::string BudgetWarning; ///< the last one
  std::vector<ShownProp> Shown;
  double Progress = 1.0; ///< of what is shown, see UpdateProgress()
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkTimeStamp BakeTime;
  vtkTimeStamp ShaderTime;
  /// While the delegate draws:
  vtkRenderer* Renderer = nullptr;
  enum Unit
  {
    ShownUnit,   ///< of what is shown
    RecordsUnit, ///< of tables of several receivers
    GridUnit,
    NumberOfUnits
  };
  std::vector<int> Units; ///< of textures: all of them, or none

  /// What a prop shows; nullptr if that was released since the delegate began.
  const ShownProp* Find(vtkProp* prop) const
  {
    vtkInformation* keys = prop->GetPropertyKeys();
    const int index = keys && keys->Has(RECEIVER_INDEX()) ? keys->Get(RECEIVER_INDEX()) : -1;
    const bool isThere = index >= 0 && index < static_cast<int>(this->Shown.size());
    return isThere ? &this->Shown[static_cast<std::size_t>(index)] : nullptr;
  }

  /// To be called when what is shown has changed: frames do not go through all receivers.
  void UpdateProgress()
  {
    double drafts = 0.0, all = 0.0;
    for (const ShownProp& shown : this->Shown)
    {
      drafts += shown.Baked->CountDraftTexels();
      all += shown.Baked->CountTexels();
    }
    this->Progress = all > 0.0 ? 1.0 - drafts / all : 1.0;
  }

  /// If there is anything to show.
  void AllocateUnits(vtkTextureUnitManager* units)
  {
    while (!this->Shown.empty() && this->Units.size() < NumberOfUnits)
    {
      this->Units.push_back(units->Allocate());
      if (this->Units.back() < 0)
      {
        this->Units.pop_back();
        this->FreeUnits(units);
        return;
      }
    }
  }

  void FreeUnits(vtkTextureUnitManager* units)
  {
    for (const int unit : this->Units)
    {
      units->Free(unit);
    }
    this->Units.clear();
  }

  /// Gives a texture to a shader's sampler.
  void Bind(vtkShaderProgram* program, const char* sampler, Unit which, unsigned int kind,
    vtkTextureObject* texture) const
  {
    const int unit = this->Units[which];
    this->Window->GetState()->vtkglActiveTexture(GL_TEXTURE0 + static_cast<unsigned int>(unit));
    glBindTexture(kind, texture->GetHandle());
    program->SetUniformi(sampler, unit);
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

void vtkSoftShadowPass::SetMaximumTextureMemory(double memory)
{
  if (!(memory >= 1.0)) // nor NaN
  {
    vtkErrorMacro("MaximumTextureMemory is " << memory << "; allowed: 1 MiB or more.");
  }
  else if (memory != this->MaximumTextureMemory)
  {
    this->MaximumTextureMemory = memory;
    this->Modified();
  }
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
  this->Impl->AllocateUnits(units);
  std::vector<vtkProp*> props;
  if (!this->Impl->Units.empty())
  {
    props = this->MarkReceivers();
  }
  else if (!this->Impl->Shown.empty())
  {
    vtkErrorMacro("Three free texture units are needed, and there are not so many. Receivers are "
                  "drawn without shadows.");
  }
  vtkRenderState receivers(renderer);
  receivers.SetPropArrayAndCount(props.data(), static_cast<int>(props.size()));
  receivers.SetFrameBuffer(s->GetFrameBuffer());

  this->PreRender(&receivers);
  this->DelegatePass->Render(s);
  this->PostRender(&receivers);
  this->NumberOfRenderedProps = this->DelegatePass->GetNumberOfRenderedProps();

  this->Impl->FreeUnits(units);
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
    isShadedOtherwise || this->Impl->BudgetMemory != this->MaximumTextureMemory)
  {
    if (isNewWindow)
    {
      // VTK frees what was of another window in that one's context, which may stay current.
      this->Impl->Shown.clear();
      window->MakeCurrent();
    }
    this->BakeReceivers(window);
    this->Impl->UpdateProgress();
  }
  else if (this->BakeMode != DRAFT && this->GetBakeProgress() < 1.0)
  {
    this->FinishDrafts();
    this->Impl->UpdateProgress();
  }
  this->ReportProgress();
}

void vtkSoftShadowPass::BakeReceivers(vtkOpenGLRenderWindow* window)
{
  this->Impl->Scene = this->Impl->Collector->GetScene();
  const penumbra::ShadowScene& scene = this->Impl->Scene;
  this->Impl->BudgetMemory = this->MaximumTextureMemory;
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
  std::vector<penumbra::ReceiverPlan> plans = this->PlanReceivers();
  std::vector<std::vector<std::size_t>> ofProps = this->AddOtherSides(plans);
  this->FitTextures(ofProps, plans);
  this->AddWindows(ofProps, plans);
  double windowTexels = 0.0;
  for (const penumbra::Receiver& receiver : scene.Receivers)
  {
    windowTexels += receiver.WindowOf ? receiver.GetBakedTexels() : 0.0;
  }
  const double keptBytes = this->Impl->Budget.GetBytesLeftPerTexel(windowTexels);
  std::size_t place = 0;
  bool isBaked = false;
  for (const auto& [prop, own] : this->Impl->Collector->GetReceiverProps())
  {
    const std::vector<std::size_t>& receivers = ofProps[place++];
    ShownProp shown = TakeShown(before, prop);
    const int shading = this->GetShadingOf(prop);
    shown.Baked->SetKeptBytesPerTexel(keptBytes);
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
  return this->Impl->Progress;
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

std::vector<std::vector<std::size_t>> vtkSoftShadowPass::AddOtherSides(
  std::vector<penumbra::ReceiverPlan>& plans)
{
  penumbra::ShadowScene& scene = this->Impl->Scene;
  std::vector<std::vector<std::size_t>> ofProps;
  for (const auto& [prop, own] : this->Impl->Collector->GetReceiverProps())
  {
    ofProps.push_back(own);
    for (const std::size_t i : own)
    {
      if (const auto other = penumbra::FindOtherSide(scene, i, plans[i]))
      {
        ofProps.back().push_back(scene.Receivers.size());
        scene.Receivers.push_back(*other);
        plans.push_back(this->Baker->Plan(scene.Receivers.size() - 1));
      }
    }
  }
  return ofProps;
}

void vtkSoftShadowPass::FitTextures(
  const std::vector<std::vector<std::size_t>>& ofProps, std::vector<penumbra::ReceiverPlan>& plans)
{
  std::vector<penumbra::Receiver>& receivers = this->Impl->Scene.Receivers;
  std::vector<penumbra::TextureNeed> asked;
  for (std::size_t p = 0; p < ofProps.size(); ++p)
  {
    const std::vector<std::size_t>& indices = ofProps[p];
    const bool showsRadiance =
      this->GetShadingOf(this->Impl->Collector->GetReceiverProps()[p].Prop) == RADIANCE;
    penumbra::TextureNeed need;
    bool hasTexture = showsRadiance;
    for (const std::size_t i : indices)
    {
      const penumbra::ReceiverSettings& settings = receivers[i].Settings;
      const int vertices = vtkBakedProp::CountVertices(plans[i], settings, showsRadiance);
      hasTexture = hasTexture || !penumbra::IsPlain(plans[i], settings);
      need.HasVariance = need.HasVariance || settings.ErrorTolerance > 0.0;
      need.Receivers.push_back({ vertices > 0 ? glm::ivec2(vertices) : receivers[i].Texels,
        penumbra::FindSharpestPenumbra(plans[i]), vertices > 0,
        receivers[i].IsTriangle && vertices == 0 });
    }
    asked.push_back(hasTexture ? need : penumbra::TextureNeed());
  }
  constexpr double MiB = 1024.0 * 1024.0;
  const std::vector<penumbra::TextureNeed>& fitted =
    this->Impl->Budget.Fit(asked, MiB * this->MaximumTextureMemory);
  for (std::size_t p = 0; p < fitted.size(); ++p)
  {
    const std::vector<std::size_t>& indices = ofProps[p];
    for (std::size_t r = 0; r < fitted[p].Receivers.size(); ++r)
    {
      const penumbra::TexelNeed& need = fitted[p].Receivers[r];
      if (!need.IsFixed && need.Texels != receivers[indices[r]].Texels)
      {
        receivers[indices[r]].Texels = need.Texels;
        plans[indices[r]] = this->Baker->Plan(indices[r]);
      }
    }
  }
  const std::string problem = this->Impl->Budget.Describe();
  if (!problem.empty() && problem != this->Impl->BudgetWarning)
  {
    vtkWarningMacro("The view's textures do not fit into MaximumTextureMemory ("
      << this->MaximumTextureMemory << " MiB): " << problem
      << ". Allow more, or use a larger TexelSize.");
  }
  this->Impl->BudgetWarning = problem;
}

void vtkSoftShadowPass::AddWindows(
  std::vector<std::vector<std::size_t>>& ofProps, std::vector<penumbra::ReceiverPlan>& plans)
{
  // Half of what memory is left is theirs.
  std::vector<penumbra::Receiver>& receivers = this->Impl->Scene.Receivers;
  double left = 0.5 * this->Impl->Budget.GetBytesLeft() / penumbra::ShadowScene::BytesPerTexel;
  for (std::vector<std::size_t>& ofProp : ofProps)
  {
    const std::vector<std::size_t> own = ofProp;
    for (const std::size_t i : own)
    {
      const std::vector<penumbra::FineWindow> windows =
        penumbra::LimitWindows(plans[i].Fine.Windows, std::min(left, penumbra::MostFineTexels));
      if (receivers[i].ProxyCentre)
      {
        continue; // its own texels take their mean
      }
      for (const penumbra::FineWindow& window : windows)
      {
        penumbra::Receiver receiver = window.MakeReceiver(receivers[i], plans[i].GetSide());
        receiver.WindowOf = i;
        left -= window.Fine.GetArea();
        plans.push_back(this->Baker->PlanWindow(receiver, plans[i]));
        ofProp.push_back(receivers.size());
        receivers.push_back(receiver);
      }
    }
  }
}

void vtkSoftShadowPass::ChooseShading()
{
  // Props may have been deleted since they were baked.
  std::vector<ShownProp>& all = this->Impl->Shown;
  const auto gone =
    std::remove_if(all.begin(), all.end(), [](const ShownProp& s) { return !s.Prop; });
  if (gone != all.end())
  {
    all.erase(gone, all.end());
    this->Impl->UpdateProgress();
  }
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
      if (!penumbra::CompilesShadowCode(shown.GetCode(), this->Impl->Window))
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
  penumbra::AddShadowCode(found->GetCode(), vertexShader, geometryShader, fragmentShader);
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
  vtkTextureObject* texture = shown.Shading == RADIANCE ? shown.Baked->GetTexture()->GetIrradiance()
                                                        : shown.Factors->GetTexture();
  this->Impl->Bind(program, "penumbraTexture", Internals::ShownUnit, GL_TEXTURE_2D, texture);
  if (shown.Factors)
  {
    program->SetUniformf("penumbraScale", shown.Factors->GetScale());
  }
  const penumbra::ScreenMatrices matrices(this->Impl->Renderer);
  if (shown.GetCode().HasSeveral)
  {
    this->Impl->Bind(program, "penumbraRecords", Internals::RecordsUnit, GL_TEXTURE_BUFFER,
      shown.Table->GetRecords());
    this->Impl->Bind(
      program, "penumbraGrid", Internals::GridUnit, GL_TEXTURE_BUFFER, shown.Table->GetGrid());
    penumbra::SetReceiverUniforms(program, shown.Table, matrices);
  }
  else
  {
    penumbra::SetReceiverUniforms(program, shown.Baked->GetEntries().front(), matrices);
  }
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
      const penumbra::Receiver& settings = shown.Baked->GetEntries()[index].Settings;
      for (std::size_t i = 0; i < texels.size(); ++i)
      {
        array->SetTypedTuple(static_cast<vtkIdType>(i), &texels[settings.GetTexelOfData(i)].x);
      }
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
    for (std::size_t i = 0; i < shown.CountReceivers(); ++i)
    {
      penumbra::AddToPlanTable(receiver++, shown.Baked->GetReport(i), table);
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
    for (ShownProp& shown : this->Impl->Shown)
    {
      shown.Baked->DropTile();
    }
    this->Impl->Shown.clear();    // textures free themselves in their own context
    this->Impl->Window = nullptr; // the next frame bakes anew
    this->Impl->UpdateProgress();
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
  os << indent << "MaximumTextureMemory: " << this->MaximumTextureMemory << "\n";
  os << indent << "MaximumAnisotropy: " << this->MaximumAnisotropy << "\n";
  os << indent << "BakeCount: " << this->BakeCount << "\n";
  os << indent << "Receivers: " << this->GetNumberOfReceivers() << "\n";
}

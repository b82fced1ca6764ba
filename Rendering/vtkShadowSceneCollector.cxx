// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShadowSceneCollector.h"

#include "DrawnGlyphs.h"
#include "DrawnSurface.h"
#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkCamera.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCuller.h"
#include "vtkCullerCollection.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDataSet.h"
#include "vtkFrustumCoverageCuller.h"
#include "vtkGlyph3DMapper.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPointGaussianMapper.h"
#include "vtkPolyDataMapper.h"
#include "vtkPropCollection.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkShadowSceneBuilder.h"
#include "vtkSkybox.h"
#include "vtkSoftShadowPass.h"
#include "vtkVersionMacros.h"
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#include "vtkCompositePolyDataMapper2.h"
#else
#include "vtkCompositePolyDataMapper.h"
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <string>

vtkStandardNewMacro(vtkShadowSceneCollector);

namespace
{

/// A visible actor of polygonal data, a prop of its own or a part of an assembly.
struct VisitedPart
{
  vtkActor* Actor;
  bool IsSurface; ///< what is drawn as lines or points, or wholly transparent, receives nothing
  bool IsSolid;   ///< nor does it block, unless the lines are tubes or the points spheres
  vtkSmartPointer<vtkMatrix4x4> Matrix;
  vtkDataObject* Data;
  vtkCompositeDataDisplayAttributes* Attributes;
};

#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0) // the two became one
using CompositeMapper = vtkCompositePolyDataMapper2;
#else
using CompositeMapper = vtkCompositePolyDataMapper;
#endif

vtkCompositeDataDisplayAttributes* GetAttributes(vtkMapper* mapper)
{
  if (auto* glyphs = vtkGlyph3DMapper::SafeDownCast(mapper))
  {
    return glyphs->GetBlockAttributes();
  }
  auto* composite = CompositeMapper::SafeDownCast(mapper);
  return composite ? composite->GetCompositeDataDisplayAttributes() : nullptr;
}

bool IsDrawnAsSurface(vtkActor* actor)
{
  return actor->GetProperty()->GetOpacity() > 0.0 &&
    actor->GetProperty()->GetRepresentation() == VTK_SURFACE;
}

/// The mapper of an actor's data themselves: actors with levels of detail answer GetMapper() by the
/// one that they draw with now.
vtkMapper* GetFullMapper(vtkActor* actor)
{
  return actor->vtkActor::GetMapper();
}

/// Whether the actor may draw something that blocks light.
bool IsDrawnAsSolid(vtkActor* actor)
{
  penumbra::DrawnActor drawn;
  drawn.Actor = actor;
  drawn.Mapper = GetFullMapper(actor);
  return IsDrawnAsSurface(actor) ||
    (actor->GetProperty()->GetOpacity() > 0.0 && penumbra::DrawsPixelSolids(drawn));
}

/// The data of a mapper of surfaces, brought up to date unless they are; nullptr for other mappers.
vtkDataObject* GetMappedData(vtkMapper* mapper, bool areUpToDate = false)
{
  if (!penumbra::IsKnown(mapper) && !CompositeMapper::SafeDownCast(mapper))
  {
    return nullptr;
  }
  if (!areUpToDate && mapper->GetNumberOfInputConnections(0) > 0 && !mapper->GetStatic())
  {
    mapper->GetInputAlgorithm()->Update();
  }
  for (int i = 0; vtkGlyph3DMapper::SafeDownCast(mapper) && !mapper->GetStatic() &&
       i < mapper->GetNumberOfInputConnections(1);
       ++i)
  {
    mapper->GetInputAlgorithm(1, i)->Update();
  }
  return mapper->GetInputDataObject(0, 0);
}

/// Marks that programs draw over things, such as ParaView's outlines of what is selected, carry the
/// field data of what they mark. They are lines or points that cannot be picked, and no part of the
/// scene.
bool IsMark(vtkActor* actor)
{
  return !IsDrawnAsSurface(actor) && !actor->GetPickable();
}

/// Whether the renderer asks its visible props for their bounds before it draws. An actor's mapper
/// brings its data up to date for them: to ask for that again costs as much.
bool AsksForBounds(vtkRenderer* renderer)
{
  vtkCollectionSimpleIterator it;
  vtkCullerCollection* cullers = renderer->GetCullers();
  cullers->InitTraversal(it);
  while (vtkCuller* culler = cullers->GetNextCuller(it))
  {
    if (vtkFrustumCoverageCuller::SafeDownCast(culler))
    {
      return true;
    }
  }
  return false;
}

/// The part that an actor, which stands for a slice of an image, is.
VisitedPart MakeSlicePart(vtkActor* slice, vtkMatrix4x4* matrix)
{
  return { slice, IsDrawnAsSurface(slice), IsDrawnAsSurface(slice), matrix,
    slice->GetMapper()->GetInputDataObject(0, 0), nullptr };
}

/// Calls visit(prop, part) if the actor, the prop itself or a part of it, is a visible one of
/// polygonal data or a slice. False if it is drawn by a level of detail while its data themselves
/// are not at hand. `areUpToDate` tells that the mapper that draws it has been asked for its
/// bounds.
template <typename Visitor>
bool VisitActor(vtkProp* prop, vtkActor* actor, vtkMatrix4x4* matrix, bool areUpToDate,
  penumbra::SliceActors& slices, Visitor&& visit)
{
  vtkMapper* mapper = GetFullMapper(actor);
  if (!mapper || !actor->GetVisibility() || IsMark(actor) || vtkSkybox::SafeDownCast(actor))
  {
    return true;
  }
  const bool isDrawnInFull = mapper == actor->GetMapper();
  if (vtkDataObject* data = GetMappedData(mapper, areUpToDate && isDrawnInFull))
  {
    visit(prop,
      VisitedPart{ actor, IsDrawnAsSurface(actor), IsDrawnAsSolid(actor), matrix, data,
        GetAttributes(mapper) });
    return true;
  }
  if (vtkActor* slice = slices.Find(actor))
  {
    visit(prop, MakeSlicePart(slice, matrix));
    return true;
  }
  return isDrawnInFull || !GetMappedData(actor->GetMapper());
}

/// Calls visit(prop, part) for every visible actor of polygonal data among the renderer's props,
/// and for the rectangles of slices of images. False if one of them is drawn by a level of detail
/// while its data themselves are not at hand.
template <typename Visitor>
bool VisitParts(vtkRenderer* renderer, penumbra::SliceActors& slices, Visitor&& visit)
{
  const bool areUpToDate = AsksForBounds(renderer);
  bool areAllAtHand = true;
  vtkCollectionSimpleIterator it;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    if (!prop->GetVisibility())
    {
      continue;
    }
    if (auto* actor = vtkActor::SafeDownCast(prop)) // its one path would be made anew each time
    {
      areAllAtHand =
        VisitActor(prop, actor, actor->GetMatrix(), areUpToDate, slices, visit) && areAllAtHand;
      continue;
    }
    prop->InitPathTraversal();
    while (vtkAssemblyPath* path = prop->GetNextPath())
    {
      vtkAssemblyNode* node = path->GetLastNode();
      vtkProp* drawn = node->GetViewProp();
      if (vtkActor* slice = drawn->GetVisibility() ? slices.Find(drawn) : nullptr)
      {
        visit(prop, MakeSlicePart(slice, node->GetMatrix()));
      }
      else if (auto* actor = vtkActor::SafeDownCast(drawn))
      {
        areAllAtHand =
          VisitActor(prop, actor, node->GetMatrix(), false, slices, visit) && areAllAtHand;
      }
    }
  }
  return areAllAtHand;
}

penumbra::DrawnActor GetDrawn(const VisitedPart& part, double pixelLength = 0.0)
{
  return { part.Actor, GetFullMapper(part.Actor), part.Matrix, part.Data, part.Attributes,
    pixelLength };
}

/// The world's length of a pixel at some distance before the camera.
double GetPixelLength(vtkRenderer* renderer, double distance)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  const int* size = renderer->GetSize();
  const double height = camera->GetParallelProjection()
    ? 2.0 * camera->GetParallelScale()
    : 2.0 * distance * std::tan(0.5 * vtkMath::RadiansFromDegrees(camera->GetViewAngle()));
  const bool isOfWidth = camera->GetUseHorizontalViewAngle() && !camera->GetParallelProjection();
  return height / std::max(size[isOfWidth ? 0 : 1], 1);
}

/// How far before the camera the middle of a part is; of what is behind it, the camera's focus.
double GetDistance(vtkRenderer* renderer, const VisitedPart& part)
{
  const double* bounds = GetFullMapper(part.Actor)->GetBounds();
  double middle[4] = { 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]),
    0.5 * (bounds[4] + bounds[5]), 1.0 };
  if (part.Matrix)
  {
    part.Matrix->MultiplyPoint(middle, middle);
  }
  vtkCamera* camera = renderer->GetActiveCamera();
  double position[3], direction[3], offset[3];
  camera->GetPosition(position);
  camera->GetDirectionOfProjection(direction);
  vtkMath::Subtract(middle, position, offset);
  const double distance = vtkMath::Dot(offset, direction);
  return distance > 0.0 ? distance : camera->GetDistance();
}

/// Whether the mapper's shaders can show shadows on the polygons of its data.
bool CanShowShadows(vtkMapper* mapper)
{
  return CompositeMapper::SafeDownCast(mapper) ||
    (vtkPolyDataMapper::SafeDownCast(mapper) && !vtkPointGaussianMapper::SafeDownCast(mapper));
}

/// Only a prop of its own can receive: the parts of an assembly have no property keys of their own.
bool MayReceive(vtkProp* prop, const VisitedPart& part, bool onlyDesignated)
{
  vtkInformation* keys = prop->GetPropertyKeys();
  return prop == part.Actor && part.IsSurface && CanShowShadows(GetFullMapper(part.Actor)) &&
    (!onlyDesignated || (keys && keys->Has(vtkSoftShadowPass::DESIGNATED())));
}

/// Whether the data are drawn in the colours of their scalars.
bool HasScalarColours(vtkMapper* mapper, vtkDataObject* data)
{
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    vtkSmartPointer<vtkDataObjectTreeIterator> it;
    it.TakeReference(tree->NewTreeIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      if (HasScalarColours(mapper, it->GetCurrentDataObject()))
      {
        return true;
      }
    }
    return false;
  }
  int isOfCells = 0;
  return mapper->GetScalarVisibility() &&
    vtkAbstractMapper::GetAbstractScalars(vtkDataSet::SafeDownCast(data), mapper->GetScalarMode(),
      mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(),
      isOfCells) != nullptr;
}

/// How the part casts shadows, unless its data say otherwise. An opaque one's colour is not looked
/// at.
penumbra::CasterSettings GetCaster(vtkProp* prop, const VisitedPart& part)
{
  penumbra::CasterSettings caster;
  caster.CastShadow =
    vtkSoftShadowPass::GetCastShadow(prop) && vtkSoftShadowPass::GetCastShadow(part.Actor);
  vtkProperty* property = part.Actor->GetProperty();
  if (property->GetOpacity() < 1.0)
  {
    glm::dvec3 colour(1.0);
    if (!part.Actor->GetTexture() && !HasScalarColours(GetFullMapper(part.Actor), part.Data))
    {
      property->GetDiffuseColor(&colour.x);
    }
    caster.Transmittance = penumbra::GetTransmittance(property->GetOpacity(), colour);
  }
  return caster;
}

/// How a part of an actor casts shadows that is drawn otherwise than the actor's data are.
penumbra::CasterSettings GetCaster(
  vtkProp* prop, const VisitedPart& visited, const penumbra::DrawnPart& part)
{
  penumbra::CasterSettings caster = GetCaster(prop, visited);
  const glm::dvec3 colour = part.Colour.value_or(glm::dvec3(1.0));
  caster.Transmittance = penumbra::GetTransmittance(part.Opacity, colour);
  return caster;
}

/// Adds all that an actor draws to the builder, lights apart. The answer says what is left out.
std::string AddDrawn(vtkShadowSceneBuilder* builder, vtkProp* prop, const VisitedPart& visited,
  double pixelLength, bool mayReceive, const std::string& name)
{
  const int roles = (visited.IsSolid ? vtkShadowSceneBuilder::Occluder : 0) |
    (mayReceive ? vtkShadowSceneBuilder::Receiver : 0);
  const penumbra::DrawnActor drawn = GetDrawn(visited, pixelLength);
  if (!roles || penumbra::IsDrawnAsItIs(drawn))
  {
    builder->SetCaster(GetCaster(prop, visited));
    builder->AddData(visited.Data, visited.Matrix, roles, name, visited.Attributes);
    return "";
  }
  std::string problem;
  for (const penumbra::DrawnPart& part : penumbra::FindDrawnParts(drawn, mayReceive, problem))
  {
    builder->SetCaster(GetCaster(prop, visited, part));
    builder->AddData(part.Data, visited.Matrix, roles, name);
  }
  return problem;
}

/// How error messages name an actor.
std::string Describe(vtkActor* actor)
{
  std::ostringstream text;
  text << actor->GetClassName() << " (" << actor << ")";
  return text.str();
}

template <typename Value>
void Append(std::vector<std::uint64_t>& signature, const Value& value)
{
  static_assert(sizeof(Value) <= sizeof(std::uint64_t), "one word a value");
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof(Value));
  signature.push_back(word);
}

/// The data's own time does not tell of changes in its blocks. The attributes' time tells of too
/// much: ParaView writes them anew, the same, in the frame after each update.
void AppendData(std::vector<std::uint64_t>& signature, vtkDataObject* data,
  vtkCompositeDataDisplayAttributes* attributes)
{
  Append(signature, data);
  Append(signature, data->GetMTime());
  const bool hasVisibility = attributes && attributes->HasBlockVisibility(data);
  Append(signature, hasVisibility);
  Append(signature, hasVisibility && attributes->GetBlockVisibility(data));
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    vtkSmartPointer<vtkDataObjectTreeIterator> it;
    it.TakeReference(tree->NewTreeIterator());
    it->VisitOnlyLeavesOff();
    it->TraverseSubTreeOff();
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      AppendData(signature, it->GetCurrentDataObject(), attributes);
    }
  }
}

/// Everything about the part that a bake depends on.
void AppendPart(std::vector<std::uint64_t>& signature, const VisitedPart& part, bool mayReceive,
  const penumbra::CasterSettings& caster)
{
  Append(signature, part.Actor);
  Append(signature, part.IsSurface);
  Append(signature, part.IsSolid);
  Append(signature, mayReceive);
  const glm::dvec3 passing = caster.GetTransmittance();
  for (int i = 0; i < 3 && part.IsSolid; ++i)
  {
    Append(signature, passing[i]);
  }
  AppendData(signature, part.Data, part.Attributes);
  if (part.IsSolid)
  {
    penumbra::AppendDrawnState(signature, GetDrawn(part));
  }
  for (int i = 0; part.Matrix && i < 16; ++i)
  {
    Append(signature, part.Matrix->GetElement(i / 4, i % 4));
  }
}

} // namespace

vtkShadowSceneCollector::vtkShadowSceneCollector() = default;
vtkShadowSceneCollector::~vtkShadowSceneCollector() = default;

bool vtkShadowSceneCollector::Update(vtkRenderer* renderer, bool onlyDesignated)
{
  this->Slices.Prune();
  this->WarnOfVolumes(renderer);
  this->NumberOfBuiltParts = 0;
  std::size_t count = 0;
  bool isSame = true;
  std::map<Signature, PixelSize> sizes;
  Signature seen; // one for all: most of the time there is nothing to keep
  const bool areAllAtHand = VisitParts(renderer, this->Slices,
    [&](vtkProp* prop, const VisitedPart& visited)
    {
      seen.clear();
      AppendPart(
        seen, visited, MayReceive(prop, visited, onlyDesignated), GetCaster(prop, visited));
      if (penumbra::DrawsPixelSolids(GetDrawn(visited)))
      {
        const PixelSize now = { GetPixelLength(renderer, GetDistance(renderer, visited)),
          GetPixelLength(renderer, renderer->GetActiveCamera()->GetDistance()) };
        Append(seen, sizes.emplace(seen, this->ChooseSize(seen, now)).first->second.Length);
      }
      isSame = isSame && count < this->Parts.size() && this->Parts[count].Seen == seen &&
        this->Parts[count].Prop == prop;
      ++count;
    });
  if ((isSame && count == this->Parts.size()) || (!areAllAtHand && !this->Parts.empty()))
  {
    return false;
  }
  this->PixelSizes = std::move(sizes);
  this->Build(renderer, onlyDesignated);
  this->Assemble();
  this->WarnOfActors(renderer);
  return true;
}

vtkShadowSceneCollector::PixelSize vtkShadowSceneCollector::ChooseSize(
  const Signature& seen, const PixelSize& now) const
{
  constexpr double MostZoom = 2.0; // of a camera that turns and shifts, too, nothing is baked
  const auto before = this->PixelSizes.find(seen);
  const bool isKept = before != this->PixelSizes.end() &&
    now.FocalLength <= MostZoom * before->second.FocalLength &&
    before->second.FocalLength <= MostZoom * now.FocalLength;
  return isKept ? before->second : now;
}

void vtkShadowSceneCollector::WarnOfActors(vtkRenderer* renderer)
{
  VisitParts(renderer, this->Slices,
    [this](vtkProp*, const VisitedPart& part)
    {
      const std::string text = penumbra::DescribeUnlikeShadow(GetDrawn(part));
      if (!text.empty() && this->Said.insert(Describe(part.Actor) + text).second)
      {
        vtkWarningMacro("'" << Describe(part.Actor) << "': " << text << ".");
      }
    });
}

void vtkShadowSceneCollector::WarnOfVolumes(vtkRenderer* renderer)
{
  vtkCollectionSimpleIterator it;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    const bool isSlice = prop->IsA("vtkImageSlice");
    if (!prop->GetVisibility() || !(isSlice || prop->IsA("vtkVolume")) || this->Slices.Find(prop))
    {
      continue;
    }
    std::ostringstream text;
    text << prop->GetClassName() << " (" << prop << ")";
    if (this->Said.insert(text.str()).second)
    {
      vtkWarningMacro(
        "'" << text.str() << "': "
            << (isSlice ? "slices of images that follow the camera or are resliced" : "volumes")
            << " cast no shadow.");
    }
  }
}

std::vector<vtkShadowSceneCollector::Part> vtkShadowSceneCollector::TakeParts(
  vtkRenderer* renderer, bool onlyDesignated)
{
  std::vector<Part> parts;
  VisitParts(renderer, this->Slices,
    [&](vtkProp* prop, const VisitedPart& visited)
    {
      Part& part = parts.emplace_back();
      AppendPart(
        part.Seen, visited, MayReceive(prop, visited, onlyDesignated), GetCaster(prop, visited));
      if (penumbra::DrawsPixelSolids(GetDrawn(visited)))
      {
        part.PixelLength = this->PixelSizes.at(part.Seen).Length;
        Append(part.Seen, part.PixelLength);
      }
      part.Prop = prop; // another one may have come to the same address, with the same mapper
    });
  // Most are where they were; what was before or behind them may have come or gone.
  std::map<Signature, const Part*> before;
  std::map<std::uint64_t, const Part*> ofActor;
  for (std::size_t i = 0; i < this->Parts.size(); ++i)
  {
    const Part& part = this->Parts[i];
    if (i < parts.size() && parts[i].Seen == part.Seen)
    {
      parts[i].Builder = part.Builder;
      continue;
    }
    before.emplace(part.Seen, &part);
    ofActor[part.Seen.front()] = &part;
  }
  for (Part& part : parts)
  {
    const auto same = part.Builder ? before.end() : before.find(part.Seen);
    if (same != before.end())
    {
      part.Builder = same->second->Builder;
    }
    else if (!part.Builder)
    {
      const auto other = ofActor.find(part.Seen.front());
      part.MakeBuilder(other == ofActor.end() ? nullptr : other->second->Builder.Get());
    }
  }
  return parts;
}

void vtkShadowSceneCollector::Part::MakeBuilder(const vtkShadowSceneBuilder* earlier)
{
  const vtkNew<vtkShadowSceneBuilder> made;
  if (earlier)
  {
    made->SetEarlierMessages(earlier->GetMessages());
  }
  this->Builder = made.Get();
  this->IsNew = true;
}

void vtkShadowSceneCollector::Build(vtkRenderer* renderer, bool onlyDesignated)
{
  std::vector<Part> parts = this->TakeParts(renderer, onlyDesignated);
  // Lights come first: they decide how a proxy plane lies.
  std::vector<penumbra::Light> lights;
  std::size_t i = 0;
  bool areLightsOthers = false;
  VisitParts(renderer, this->Slices,
    [&](vtkProp*, const VisitedPart& visited)
    {
      Part& part = parts[i++];
      if (part.IsNew)
      {
        part.Builder->AddData(visited.Data, visited.Matrix, vtkShadowSceneBuilder::Light,
          Describe(visited.Actor), visited.Attributes);
      }
      const std::vector<penumbra::Light>& own = part.Builder->GetScene().Lights;
      lights.insert(lights.end(), own.begin(), own.end());
      areLightsOthers = areLightsOthers || (part.IsNew && !own.empty());
    });
  areLightsOthers = areLightsOthers || lights.size() != this->Scene.Lights.size();
  i = 0;
  VisitParts(renderer, this->Slices,
    [&](vtkProp* prop, const VisitedPart& visited)
    {
      Part& part = parts[i++];
      if (!part.IsNew && areLightsOthers && part.Builder->DependsOnLights())
      {
        part.MakeBuilder(vtkSmartPointer<vtkShadowSceneBuilder>(part.Builder));
      }
      if (part.IsNew)
      {
        part.Builder->SetLights(lights);
        const std::string name = Describe(visited.Actor);
        const std::string problem = AddDrawn(part.Builder, prop, visited, part.PixelLength,
          MayReceive(prop, visited, onlyDesignated), name);
        if (!problem.empty() && this->Said.insert(name + problem).second)
        {
          vtkWarningMacro("'" << name << "': " << problem << ".");
        }
        part.IsNew = false;
        ++this->NumberOfBuiltParts;
      }
    });
  this->Parts = std::move(parts);
}

void vtkShadowSceneCollector::Assemble()
{
  this->Scene = penumbra::ShadowScene();
  this->ReceiverProps.clear();
  for (const Part& part : this->Parts)
  {
    const std::size_t first = this->Scene.Receivers.size();
    this->Scene.Append(part.Builder->GetScene());
    if (first < this->Scene.Receivers.size())
    {
      ReceiverProp& entry = this->ReceiverProps.emplace_back();
      entry.Prop = part.Prop;
      for (std::size_t i = first; i < this->Scene.Receivers.size(); ++i)
      {
        entry.Receivers.push_back(i);
      }
    }
  }
}

void vtkShadowSceneCollector::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ReceiverProps: " << this->ReceiverProps.size() << "\n";
  os << indent << "NumberOfBuiltParts: " << this->NumberOfBuiltParts << "\n";
}

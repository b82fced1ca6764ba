// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBakedProp.h"

#include "BakeChange.h"
#include "ShadingVertices.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkRadianceTexture.h"
#include "vtkTimerLog.h"
#include "vtkVisibilityMask.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

vtkStandardNewMacro(vtkBakedProp);

namespace
{

/// The size of a receiver's region of the texture.
glm::ivec2 GetRegionSize(const vtkBakedProp::Entry& entry)
{
  return entry.Vertices > 0 ? glm::ivec2(entry.Vertices) : entry.Settings.Texels;
}

/// Whether the same texels would do, but for what comes from elsewhere.
bool IsSameReceiver(const vtkBakedProp::Entry& a, const vtkBakedProp::Entry& b)
{
  const penumbra::Parallelogram &p = a.Settings.Base, &q = b.Settings.Base;
  return a.Surface == b.Surface && a.Settings.Region == b.Settings.Region && p.Corner == q.Corner &&
    p.EdgeX == q.EdgeX && p.EdgeY == q.EdgeY && a.Settings.Settings == b.Settings.Settings &&
    a.Settings.Texels == b.Settings.Texels && a.Vertices == b.Vertices &&
    a.HasWindows == b.HasWindows &&
    a.Settings.WindowOf.has_value() == b.Settings.WindowOf.has_value() &&
    a.Plan.Frame.GetNormal() == b.Plan.Frame.GetNormal();
}

/// Which of some entries has the same texels, but for what comes from elsewhere; from the given one
/// on first.
std::optional<std::size_t> FindSame(const vtkBakedProp::Entry& entry,
  const std::vector<vtkBakedProp::Entry>& others, std::size_t first)
{
  for (std::size_t k = 0; k < others.size(); ++k)
  {
    const std::size_t i = (first + k) % others.size();
    if (IsSameReceiver(entry, others[i]))
    {
      return i;
    }
  }
  return std::nullopt;
}

/// Lets masks and textures stay below n/8 + 24 bytes a texel, as do the textures alone once the
/// masks are gone: 16 of irradiance, a third of that for what is shown, and what is kept.
void LimitBytes(
  const vtkBakedProp::Entry& entry, double keptBytesPerTexel, vtkRadianceBaker::Part& part)
{
  int samples = 0;
  for (const penumbra::PairPlan& pair : entry.Plan.Pairs)
  {
    samples = std::max(samples, pair.Samples);
  }
  constexpr double Irradiance = 16.0, Shown = 16.0 / 3.0;
  const double allowed = samples / 8.0 + 24.0;
  const double texels = entry.Settings.GetBakedTexels();
  const double kept = std::clamp(allowed - Irradiance - Shown, 0.0, keptBytesPerTexel);
  part.KeptBytes = static_cast<std::size_t>(kept * texels);
  part.MaskAndKeptBytes = static_cast<std::size_t>((allowed - Irradiance) * texels);
}

/// The bytes that all masks of a receiver take for each texel, were they drawn at once.
double GetMaskBytesPerTexel(const penumbra::ReceiverPlan& plan)
{
  double bytes = 0.0;
  for (const penumbra::PairPlan& pair : plan.Pairs)
  {
    const int layers = pair.Samples / vtkVisibilityMask::SamplesPerLayer + 1;
    bytes += static_cast<double>(sizeof(std::uint32_t)) * layers *
      static_cast<double>(1 + pair.Translucent);
  }
  return bytes * plan.Supersampling * plan.Supersampling;
}

std::size_t CountKeptBytes(const vtkBakedProp::Entry& entry)
{
  std::size_t bytes = 0;
  for (const vtkRadianceBaker::KeptLight& kept : entry.Kept)
  {
    bytes += kept.Shares.GetBytes();
  }
  return bytes;
}

void ReleaseKept(vtkBakedProp::Entry& entry)
{
  for (vtkRadianceBaker::KeptLight& kept : entry.Kept)
  {
    kept.Shares.Release();
  }
}

/// The receiver's texels that some of its finer ones are a part of, by a tent that reaches to the
/// neighbours' centres.
penumbra::TexelRectangle Coarsen(
  const penumbra::TexelRectangle& fine, int factor, const glm::ivec2& texels)
{
  const penumbra::TexelRectangle grown = factor > 1 ? fine.Grown(factor / 2) : fine;
  const glm::ivec2 low = glm::max(grown.Low, glm::ivec2(0)) / factor;
  const glm::ivec2 high = (grown.High + factor - 1) / factor;
  return penumbra::TexelRectangle{ low, high }.Intersection(penumbra::WholeRectangle(texels));
}

/// A rectangle with all of the windows that it touches: what a change decides of one, such as how
/// many samples it takes, may concern all of it.
penumbra::TexelRectangle AddWindows(
  const penumbra::TexelRectangle& rectangle, const penumbra::ReceiverPlan& plan)
{
  penumbra::TexelRectangle all = rectangle, before;
  while (all != before)
  {
    before = all;
    for (const penumbra::FineWindow& window : plan.Fine.Windows)
    {
      const penumbra::TexelRectangle texels = window.GetTexels();
      all = all.Intersection(texels).IsEmpty() ? all : all.Union(texels);
    }
  }
  return all;
}

/// The receiver's texels of the windows that only one of the plans has.
penumbra::TexelRectangle FindOtherWindows(
  const penumbra::ReceiverPlan& a, const penumbra::ReceiverPlan& b)
{
  penumbra::TexelRectangle others;
  for (const auto& [plan, other] : { std::pair(&a, &b), std::pair(&b, &a) })
  {
    const std::vector<penumbra::FineWindow>& windows = other->Fine.Windows;
    for (const penumbra::FineWindow& window : plan->Fine.Windows)
    {
      const bool isShared = std::find(windows.begin(), windows.end(), window) != windows.end();
      others = isShared ? others : others.Union(window.GetTexels());
    }
  }
  return others;
}

/// The receiver's texels that a change concerns.
penumbra::TexelRectangle FindRectangle(const vtkBakedProp::Entry& entry,
  const penumbra::ReceiverPlan& before, const penumbra::BakeChange& change)
{
  const glm::ivec2 size = GetRegionSize(entry);
  const penumbra::TexelRectangle windows =
    entry.Vertices > 0 ? penumbra::TexelRectangle() : FindOtherWindows(entry.Plan, before);
  if (entry.Vertices > 0 || entry.Settings.Settings.ErrorTolerance > 0.0)
  {
    const bool isSame = change.Resolved.IsEmpty() && windows.IsEmpty();
    return isSame ? penumbra::TexelRectangle() : penumbra::WholeRectangle(size);
  }
  const penumbra::TexelRectangle changed = Coarsen(change.Resolved, entry.Plan.Supersampling, size);
  return AddWindows(changed.Union(windows), entry.Plan);
}

/// An entry's MiddleLight.
float FindMiddleLight(const penumbra::ReceiverPlan& plan)
{
  const glm::dvec3 middle = plan.Frame.ToWorld({ 0.5, 0.5, 0.0 });
  glm::dvec3 arriving(0.0);
  for (const penumbra::Light& light : plan.Lights)
  {
    if (light->IsValid())
    {
      arriving += light->Irradiance(middle, plan.Frame.GetNormal());
    }
  }
  return static_cast<float>((arriving.x + arriving.y + arriving.z) / 3.0);
}

/// Whether more samples would change anything.
bool HasMoreSamples(const vtkBakedProp::Entry& entry)
{
  return (!entry.Plan.Fine.Windows.empty() && !entry.HasWindows) ||
    std::any_of(entry.Plan.Pairs.begin(), entry.Plan.Pairs.end(),
      [](const penumbra::PairPlan& pair) { return pair.Needed == penumbra::Effect::Soft; });
}

/// A receiver's texels: those that its region owns, and the others as they were baked apart.
std::vector<glm::vec4> MergeHalves(const vtkRadianceTexture::Region& region,
  const std::vector<glm::vec4>& owned, std::vector<glm::vec4> others)
{
  for (std::size_t i = 0; i < others.size(); ++i)
  {
    const int index = static_cast<int>(i);
    others[i] =
      region.Owns({ index % region.Size.x, index / region.Size.x }) ? owned[i] : others[i];
  }
  return others;
}

/// Takes a tile of about side^2 texels off a rectangle.
penumbra::TexelRectangle TakeTile(penumbra::TexelRectangle& rectangle, int side)
{
  const glm::ivec2 size = rectangle.GetSize();
  penumbra::TexelRectangle tile = rectangle;
  if (rectangle.GetArea() <= static_cast<double>(side) * side)
  {
    rectangle = {};
    return tile;
  }
  // Off the longer side: what is left stays a rectangle.
  const int axis = size.x > size.y ? 0 : 1;
  const int thickness = side * side / size[1 - axis];
  tile.High[axis] = std::min(tile.Low[axis] + std::max(thickness, 1), tile.High[axis]);
  rectangle.Low[axis] = tile.High[axis];
  return tile;
}

} // namespace

vtkBakedProp::vtkBakedProp() = default;
vtkBakedProp::~vtkBakedProp() = default;

int vtkBakedProp::CountVertices(const penumbra::ReceiverPlan& plan,
  const penumbra::ReceiverSettings& settings, bool showsRadiance)
{
  // Where nothing is blocked, and nothing has a hue, factors are 1 at any vertex.
  return penumbra::IsPlain(plan, settings) && !showsRadiance
    ? 2
    : penumbra::CountShadingVertices(plan, settings);
}

void vtkBakedProp::SetKeptBytesPerTexel(double bytes)
{
  this->KeptBytesPerTexel = bytes;
  for (Entry& entry : this->Entries)
  {
    if (CountKeptBytes(entry) > bytes * entry.Settings.GetBakedTexels())
    {
      ReleaseKept(entry);
    }
  }
}

vtkBakedProp::Outcome vtkBakedProp::Update(vtkRadianceBaker* baker,
  const penumbra::ShadowScene& scene, const std::vector<std::size_t>& receivers,
  const std::vector<penumbra::ReceiverPlan>& plans, vtkOpenGLRenderWindow* window,
  bool showsRadiance, bool draft)
{
  this->DropTile();
  window->MakeCurrent(); // which that may have changed
  std::vector<Entry> entries;
  bool isPlain = !showsRadiance;
  for (const std::size_t i : receivers)
  {
    const penumbra::Receiver& receiver = scene.Receivers[i];
    Entry entry{ i, scene.Surfaces[receiver.Surface], receiver, plans[i], receiver.Base, 0, {}, {},
      {} };
    isPlain = isPlain && penumbra::IsPlain(entry.Plan, receiver.Settings);
    entry.Vertices = CountVertices(entry.Plan, receiver.Settings, showsRadiance);
    entry.Report = vtkRadianceBaker::MakeReport(entry.Plan, scene, i);
    entry.MiddleLight = FindMiddleLight(entry.Plan);
    if (receiver.WindowOf)
    {
      for (Entry& other : entries)
      {
        other.HasWindows = other.HasWindows || other.Receiver == *receiver.WindowOf;
      }
    }
    entries.push_back(std::move(entry));
  }
  if (isPlain)
  {
    const bool wasTextured = this->IsTextured;
    this->ReleaseGraphicsResources();
    this->Entries = std::move(entries);
    return wasTextured ? Outcome::Baked : Outcome::Unchanged;
  }
  if (this->IsSameLayout(entries, window))
  {
    return this->BakeChanges(baker, std::move(entries), draft);
  }
  vtkNew<vtkRadianceTexture> texture;
  std::vector<Entry> before;
  if (this->IsTextured && this->Window == window && this->Texture->IsAllocated())
  {
    texture->Swap(this->Texture);
    before = std::move(this->Entries);
  }
  this->Window = window;
  const Outcome outcome =
    this->BakeAll(baker, std::move(entries), std::move(before), texture, draft);
  texture->ReleaseGraphicsResources();
  return outcome;
}

bool vtkBakedProp::IsSameLayout(
  const std::vector<Entry>& entries, vtkOpenGLRenderWindow* window) const
{
  return this->IsTextured && this->Window == window &&
    std::equal(
      entries.begin(), entries.end(), this->Entries.begin(), this->Entries.end(), IsSameReceiver);
}

vtkBakedProp::Outcome vtkBakedProp::BakeAll(vtkRadianceBaker* baker, std::vector<Entry> entries,
  std::vector<Entry> before, vtkRadianceTexture* texture, bool draft)
{
  this->Texture->ReleaseGraphicsResources();
  this->Entries = std::move(entries);
  std::vector<penumbra::AtlasReceiver> receivers;
  bool withVariance = false;
  for (const Entry& entry : this->Entries)
  {
    receivers.emplace_back(GetRegionSize(entry), entry.Settings.IsTriangle && entry.Vertices == 0);
    withVariance = withVariance || entry.Settings.Settings.ErrorTolerance > 0.0;
  }
  this->IsTextured = this->Texture->Allocate(this->Window, receivers, withVariance);
  if (withVariance != texture->GetHasVariance())
  {
    before.clear();
  }
  std::size_t next = 0; // they come in the same order
  for (std::size_t i = 0; i < this->Entries.size() && this->IsTextured; ++i)
  {
    const std::optional<std::size_t> same = FindSame(this->Entries[i], before, next);
    const auto& region = this->Texture->GetRegions()[i];
    if (same && region.HasShapeOf(texture->GetRegions()[*same]))
    {
      next = *same + 1;
      this->Texture->CopyRegion(texture, texture->GetRegions()[*same], region);
      this->IsTextured =
        this->BakeChange(baker, this->Entries[i], before[*same], i, draft) != Outcome::Failed;
    }
    else
    {
      this->IsTextured =
        this->Bake(baker, this->Entries[i], i, penumbra::WholeRectangle(receivers[i].Size), draft);
    }
  }
  if (!this->IsTextured)
  {
    this->ReleaseGraphicsResources();
    return Outcome::Failed;
  }
  return Outcome::Baked;
}

vtkBakedProp::Outcome vtkBakedProp::BakeChanges(
  vtkRadianceBaker* baker, std::vector<Entry> entries, bool draft)
{
  Outcome outcome = Outcome::Unchanged;
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    const Outcome ofEntry = this->BakeChange(baker, entries[i], this->Entries[i], i, draft);
    if (ofEntry == Outcome::Failed)
    {
      this->ReleaseGraphicsResources();
      return Outcome::Failed;
    }
    outcome = ofEntry == Outcome::Baked ? Outcome::Baked : outcome;
  }
  this->Entries = std::move(entries);
  return outcome;
}

vtkBakedProp::Outcome vtkBakedProp::BakeChange(
  vtkRadianceBaker* baker, Entry& now, Entry& before, std::size_t region, bool draft)
{
  const int halo = now.Settings.Settings.Reconstruction && now.Vertices == 0
    ? vtkRadianceResolver::GetReconstructionHalo()
    : 0;
  const penumbra::BakeChange change = penumbra::FindBakeChange(before.Plan, now.Plan, halo);
  now.Report.Seconds = 0.0;
  now.Kept.resize(now.Plan.Lights.size());
  for (std::size_t l = 0; l < change.Lights.size() && !before.Kept.empty(); ++l)
  {
    const penumbra::LightChange& light = change.Lights[l];
    if (light.Before != penumbra::LightChange::New)
    {
      now.Kept[l] = before.Kept[static_cast<std::size_t>(light.Before)];
      now.Kept[l].Stale = now.Kept[l].Stale.Union(light.Stale);
    }
  }
  now.Base = before.Base;
  now.Draft = before.Draft;
  penumbra::TexelRectangle rectangle = FindRectangle(now, before.Plan, change);
  rectangle = draft ? rectangle : rectangle.Union(now.Draft);
  if (rectangle.IsEmpty())
  {
    now.Report = before.Report;
    return Outcome::Unchanged;
  }
  return this->Bake(baker, now, region, rectangle, draft) ? Outcome::Baked : Outcome::Failed;
}

bool vtkBakedProp::Bake(vtkRadianceBaker* baker, Entry& entry, std::size_t region,
  const penumbra::TexelRectangle& rectangle, bool draft)
{
  vtkRadianceBaker::Part part;
  part.Rectangle = rectangle;
  part.TakesMeans = !entry.HasWindows;
  if (entry.Vertices > 0)
  {
    const penumbra::ReceiverPlan vertices = penumbra::PlanVertices(entry.Plan, entry.Vertices);
    entry.Base = vertices.Frame.GetBase();
    entry.Report =
      baker->BakePart(vertices, entry.Receiver, this->Window, this->Texture, region, part);
    return entry.Report.IsComplete;
  }
  if (draft)
  {
    part.MostSamples = 1;
    entry.Draft = HasMoreSamples(entry) ? entry.Draft.Union(rectangle) : entry.Draft;
  }
  else
  {
    entry.Draft = rectangle.Holds(entry.Draft) ? penumbra::TexelRectangle() : entry.Draft;
    if (entry.Settings.Settings.ErrorTolerance <= 0.0 && entry.Plan.Supersampling == 1)
    {
      entry.Kept.resize(entry.Plan.Lights.size());
      part.Kept = &entry.Kept;
      LimitBytes(entry, this->KeptBytesPerTexel, part);
    }
  }
  entry.Report =
    baker->BakePart(entry.Plan, entry.Receiver, this->Window, this->Texture, region, part);
  return entry.Report.IsComplete;
}

vtkBakedProp::Outcome vtkBakedProp::Finish(vtkRadianceBaker* baker, double seconds)
{
  if (!this->IsTextured)
  {
    return Outcome::Unchanged; // it failed before
  }
  const double until = vtkTimerLog::GetUniversalTime() + seconds;
  if (seconds <= 0.0)
  {
    this->DropTile();
  }
  Outcome outcome = Outcome::Unchanged;
  for (std::size_t i = 0; i < this->Entries.size(); ++i)
  {
    Entry& entry = this->Entries[i];
    if (entry.Draft.IsEmpty() ||
      (outcome == Outcome::Baked && seconds > 0.0 && vtkTimerLog::GetUniversalTime() > until))
    {
      continue;
    }
    const bool isDone = seconds > 0.0 && entry.Settings.Settings.ErrorTolerance <= 0.0
      ? this->FinishTiles(baker, entry, i, seconds, until)
      : this->Bake(baker, entry, i, entry.Draft, false);
    if (!isDone)
    {
      this->ReleaseGraphicsResources();
      return Outcome::Failed;
    }
    outcome = Outcome::Baked;
  }
  return outcome;
}

bool vtkBakedProp::FinishTiles(
  vtkRadianceBaker* baker, Entry& entry, std::size_t region, double seconds, double until)
{
  constexpr int SmallestTile = 16, LargestTile = 4096;
  constexpr double ShortestSeconds = 1e-4;
  double now = 0.0;
  do
  {
    this->BeginTile(entry, region);
    Tile& tile = this->Begun;
    const penumbra::DrawProgress progress = baker->DrawMasksUntil(
      until, entry.Plan, entry.Receiver, this->Window, tile.Rectangle, tile.Masks);
    if (progress != penumbra::DrawProgress::Done)
    {
      return progress != penumbra::DrawProgress::Failed;
    }
    const double start = vtkTimerLog::GetUniversalTime();
    vtkRadianceBaker::Part part;
    part.Rectangle = tile.Rectangle;
    part.Masks = &tile.Masks;
    part.TakesMeans = !entry.HasWindows;
    entry.Report =
      baker->BakePart(entry.Plan, entry.Receiver, this->Window, this->Texture, region, part);
    if (!entry.Report.IsComplete)
    {
      return false;
    }
    entry.Draft = tile.Left;
    this->DropTile();
    // To resolve a tile, which is done at once, is to take about a quarter of a batch.
    now = vtkTimerLog::GetUniversalTime();
    const double taken = std::max(now - start, ShortestSeconds);
    const double growth = std::sqrt(0.25 * seconds / taken);
    this->TileSide = std::clamp(
      static_cast<int>(this->TileSide * std::clamp(growth, 0.25, 4.0)), SmallestTile, LargestTile);
  } while (!entry.Draft.IsEmpty() && now < until);
  return true;
}

void vtkBakedProp::BeginTile(const Entry& entry, std::size_t region)
{
  if (!this->Begun.Rectangle.IsEmpty() && this->Begun.Region == region)
  {
    return;
  }
  this->DropTile();
  // Its masks stay from frame to frame.
  constexpr double MostBytes = 16.0 * 1024 * 1024;
  const double most = MostBytes / GetMaskBytesPerTexel(entry.Plan);
  this->Begun.Region = region;
  this->Begun.Left = entry.Draft;
  this->Begun.Rectangle =
    TakeTile(this->Begun.Left, std::min(this->TileSide, static_cast<int>(std::sqrt(most)) + 1));
}

void vtkBakedProp::DropTile()
{
  if (this->Window && this->Begun.Masks.GetBytes() > 0)
  {
    this->Window->PushContext();
    this->Begun.Masks.Release();
    this->Window->PopContext();
  }
  this->Begun = Tile();
}

double vtkBakedProp::CountDraftTexels() const
{
  double texels = 0.0;
  for (const Entry& entry : this->Entries)
  {
    texels += entry.Draft.GetArea();
  }
  return texels - this->Begun.Rectangle.GetArea() * this->Begun.Masks.GetShare();
}

double vtkBakedProp::CountTexels() const
{
  double texels = 0.0;
  for (const Entry& entry : this->Entries)
  {
    texels += penumbra::WholeRectangle(entry.Settings.Texels).GetArea();
  }
  return texels;
}

std::vector<glm::vec4> vtkBakedProp::Download(
  const penumbra::ShadowScene& scene, std::size_t entry, vtkOpenGLRenderWindow* window)
{
  if (this->IsTextured && !this->Texture->IsAllocated())
  {
    return {}; // it went with its window
  }
  std::vector<glm::vec4> shown;
  if (this->IsTextured && this->Entries[entry].Vertices == 0 && !this->Entries[entry].HasWindows)
  {
    const vtkRadianceTexture::Region& region = this->Texture->GetRegions()[entry];
    shown = this->Texture->Download(region).Irradiance;
    if (region.Half == penumbra::AtlasHalf::Whole)
    {
      return shown;
    }
  }
  vtkNew<vtkRadianceBaker> baker;
  vtkNew<vtkRadianceTexture> texture;
  std::vector<glm::vec4> texels;
  if (!baker->Bake(scene, { this->Entries[entry].Receiver }, window, texture).empty())
  {
    texels = texture->Download(texture->GetRegions().front()).Irradiance;
  }
  texture->ReleaseGraphicsResources();
  return shown.empty() || texels.empty()
    ? texels
    : MergeHalves(this->Texture->GetRegions()[entry], shown, std::move(texels));
}

std::size_t vtkBakedProp::CountParts() const
{
  return static_cast<std::size_t>(std::count_if(this->Entries.begin(), this->Entries.end(),
    [](const Entry& entry) { return entry.Settings.WindowOf || entry.Settings.OtherSideOf; }));
}

vtkRadianceBaker::Report vtkBakedProp::GetReport(std::size_t entry) const
{
  vtkRadianceBaker::Report report = this->Entries[entry].Report;
  for (const Entry& other : this->Entries)
  {
    if (other.Settings.WindowOf && *other.Settings.WindowOf == this->Entries[entry].Receiver)
    {
      vtkRadianceBaker::AddReport(other.Report, report);
    }
  }
  return report;
}

std::size_t vtkBakedProp::GetBytes() const
{
  std::size_t bytes = this->Texture->GetBytes() + this->Begun.Masks.GetBytes();
  for (const Entry& entry : this->Entries)
  {
    bytes += CountKeptBytes(entry);
  }
  return bytes;
}

void vtkBakedProp::ReleaseGraphicsResources()
{
  this->DropTile();
  for (Entry& entry : this->Entries)
  {
    ReleaseKept(entry);
    entry.Draft = {}; // of texels that are gone
  }
  this->Texture->ReleaseGraphicsResources();
  this->IsTextured = false;
  this->Window = nullptr;
}

void vtkBakedProp::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Receivers: " << this->Entries.size() << "\n";
  os << indent << "HasTexture: " << this->IsTextured << "\n";
}

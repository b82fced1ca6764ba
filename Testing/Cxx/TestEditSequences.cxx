// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Random sequences of edits: after the last one, the texels are those of a whole bake, to the bit.
// A sequence that fails is shrunk to the edits that it takes. PENUMBRA_EDIT_SEQUENCES says how many
// are tried; 150 by default.

#include "RandomGeometry.h"
#include "TestScenes.h"
#include "vtkBakedProp.h"

#include "vtkNew.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using penumbra::ShadowScene;
using penumbra::SharedSurface;
using penumbra::Surface;

constexpr std::size_t Boxes = 4;
constexpr std::size_t Lights = 2;
constexpr double FloorSide = 8.0;
/// So many that there is memory to keep the shares of both lights; of a quarter, there is little.
constexpr int Samples = 256;

/// What an edit changes.
enum class EditKind
{
  MoveBox,
  ShowOrHideBox,
  ChangeOpacity,
  ChangeRadiance,
  MoveLight,
  ShowOrHideLight,
  ChangeSamples,
  ToggleReconstruction,
  LimitKept,
  Count
};

constexpr std::array<const char*, static_cast<std::size_t>(EditKind::Count)> EditNames{ "move box",
  "show or hide box", "opacity of box", "radiance of light", "move light", "show or hide light",
  "samples", "reconstruction", "kept bytes a texel" };

struct Edit
{
  EditKind Kind = EditKind::MoveBox;
  std::size_t Index = 0; ///< of the box or of the light
  glm::dvec3 Value{ 0.0 };
  bool IsDraft = false; ///< the frame after it is a draft

  friend std::ostream& operator<<(std::ostream& os, const Edit& edit)
  {
    return os << "  " << EditNames[static_cast<std::size_t>(edit.Kind)] << " " << edit.Index << ": "
              << edit.Value.x << ", " << edit.Value.y << ", " << edit.Value.z
              << (edit.IsDraft ? " (draft)" : "") << "\n";
  }
};

/// Two floors, four small boxes and two lamps, which edits change.
class EditedScene
{
public:
  EditedScene()
  {
    for (std::size_t i = 0; i < Boxes; ++i)
    {
      const auto place = static_cast<double>(i);
      this->Casters.push_back({ MakeBox({ 1.5 + 1.4 * place, 5.5 - 1.1 * place, 0.2 }, 0.0) });
      this->Casters.back().IsShown = i % 2 == 0;
    }
    for (std::size_t i = 0; i < Lights; ++i)
    {
      this->Lamps.push_back({ { 2.0 + 3.0 * static_cast<double>(i), 3.0, 5.0 } });
    }
    this->Settings.LightSamples = Samples;
  }

  void Apply(const Edit& edit)
  {
    Caster& caster = this->Casters[edit.Index % Boxes];
    Lamp& lamp = this->Lamps[edit.Index % Lights];
    switch (edit.Kind)
    {
      case EditKind::MoveBox:
        caster.Place = MakeBox(edit.Value, caster.Place->Transmittance.x);
        break;
      case EditKind::ShowOrHideBox:
        caster.IsShown = !caster.IsShown;
        break;
      case EditKind::ChangeOpacity:
        caster.Place =
          MakeBox(caster.Place->Points.front(), caster.Place->Transmittance.x > 0.0 ? 0.0 : 0.5);
        break;
      case EditKind::ChangeRadiance:
        lamp.Radiance = edit.Value;
        break;
      case EditKind::MoveLight:
        lamp.Origin = { edit.Value.x, edit.Value.y, 5.0 };
        break;
      case EditKind::ShowOrHideLight:
        lamp.IsShown = !lamp.IsShown;
        break;
      case EditKind::ChangeSamples:
        this->Settings.LightSamples =
          this->Settings.LightSamples == Samples ? Samples / 4 : Samples;
        break;
      case EditKind::ToggleReconstruction:
        this->Settings.Reconstruction = !this->Settings.Reconstruction;
        break;
      default:
        this->KeptBytesPerTexel = edit.Value.x * 8.0;
    }
  }

  ShadowScene Make() const
  {
    ShadowScene scene;
    scene.Surfaces.push_back(this->Floors);
    for (const Caster& caster : this->Casters)
    {
      if (caster.IsShown)
      {
        scene.Surfaces.push_back(caster.Place);
      }
    }
    for (int region = 0; region < 2; ++region)
    {
      penumbra::Receiver receiver;
      receiver.Region = region;
      receiver.Base = { { FloorSide * region, 0, 0 }, { FloorSide, 0, 0 }, { 0, FloorSide, 0 } };
      receiver.Settings = this->Settings;
      receiver.Texels = { 24, 20 };
      scene.Receivers.push_back(receiver);
    }
    for (const Lamp& lamp : this->Lamps)
    {
      if (lamp.IsShown)
      {
        scene.Lights.emplace_back(penumbra::PolygonLight::Parallelogram(lamp.Origin,
          lamp.Origin + glm::dvec3(0.0, 0.4, 0.0), lamp.Origin + glm::dvec3(0.4, 0.0, 0.0)));
        scene.Lights.back()->Radiance = lamp.Radiance;
      }
    }
    return scene;
  }

  double KeptBytesPerTexel = std::numeric_limits<double>::infinity();

private:
  struct Caster
  {
    SharedSurface Place;
    bool IsShown = true;
  };
  struct Lamp
  {
    glm::dvec3 Origin;
    glm::dvec3 Radiance{ 1.0 };
    bool IsShown = true;
  };

  static SharedSurface MakeFloors()
  {
    Surface floors;
    floors.Points = { { 0, 0, 0 }, { FloorSide, 0, 0 }, { FloorSide, FloorSide, 0 },
      { 0, FloorSide, 0 }, { 2 * FloorSide, 0, 0 }, { 2 * FloorSide, FloorSide, 0 } };
    floors.Triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 1, 4, 5 }, { 1, 5, 2 } };
    floors.Regions = { 0, 0, 1, 1 };
    return { floors };
  }

  /// A box whose first point is its lower corner.
  static SharedSurface MakeBox(const glm::dvec3& corner, double transmittance)
  {
    constexpr double Side = 0.4;
    Surface box;
    for (int i = 0; i < 8; ++i)
    {
      box.Points.push_back(
        corner + Side * glm::dvec3(i & 1, static_cast<double>(i >> 1 & 1), i >> 2));
    }
    box.Triangles = { { 0, 1, 3 }, { 0, 3, 2 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
      { 2, 3, 7 }, { 2, 7, 6 }, { 0, 2, 6 }, { 0, 6, 4 }, { 1, 3, 7 }, { 1, 7, 5 } };
    box.Transmittance = glm::dvec3(transmittance);
    return { box };
  }

  SharedSurface Floors = MakeFloors();
  std::vector<Caster> Casters;
  std::vector<Lamp> Lamps;
  penumbra::ReceiverSettings Settings;
};

/// The receivers' radiance, kept up to date.
class UpdatedProp
{
public:
  UpdatedProp() = default;
  ~UpdatedProp() { this->Prop->ReleaseGraphicsResources(); }
  UpdatedProp(const UpdatedProp&) = delete;
  void operator=(const UpdatedProp&) = delete;

  void Update(const EditedScene& edited, bool draft)
  {
    const ShadowScene scene = edited.Make();
    if (scene.Lights.empty())
    {
      this->Prop->ReleaseGraphicsResources(); // as the pass does: receivers are drawn plain
      return;
    }
    this->Baker->SetScene(scene);
    std::vector<std::size_t> receivers(scene.Receivers.size());
    std::iota(receivers.begin(), receivers.end(), std::size_t{ 0 });
    std::vector<penumbra::ReceiverPlan> plans;
    for (const std::size_t i : receivers)
    {
      plans.push_back(this->Baker->Plan(i));
    }
    this->Prop->SetKeptBytesPerTexel(edited.KeptBytesPerTexel);
    ASSERT_NE(
      this->Prop->Update(this->Baker, scene, receivers, plans, GetTestWindow(), true, draft),
      vtkBakedProp::Outcome::Failed);
    this->Baker->ReleaseGraphicsResources();
  }

  std::vector<glm::vec4> GetTexels() const
  {
    std::vector<glm::vec4> all;
    if (this->Prop->HasTexture())
    {
      for (const vtkRadianceTexture::Region& region : this->Prop->GetTexture()->GetRegions())
      {
        const std::vector<glm::vec4> own = this->Prop->GetTexture()->Download(region).Irradiance;
        all.insert(all.end(), own.begin(), own.end());
      }
    }
    return all;
  }

private:
  vtkNew<vtkRadianceBaker> Baker;
  vtkNew<vtkBakedProp> Prop;
};

std::vector<Edit> MakeSequence(unsigned seed)
{
  constexpr std::size_t MostEdits = 8;
  RandomGeometry random(seed);
  std::vector<Edit> edits(1 + random.Below(MostEdits));
  for (Edit& edit : edits)
  {
    // Half of them concern what is kept of shadows that have moved away.
    constexpr std::array<EditKind, 3> Frequent{ EditKind::MoveBox, EditKind::ShowOrHideBox,
      EditKind::ChangeRadiance };
    edit.Kind = random.Below(2) == 0
      ? Frequent[random.Below(Frequent.size())]
      : static_cast<EditKind>(random.Below(static_cast<std::size_t>(EditKind::Count)));
    edit.Index = random.Below(Boxes);
    edit.Value = { random.Between(0.0, FloorSide), random.Between(0.0, FloorSide),
      random.Between(0.05, 2.0) };
    edit.IsDraft = random.Between(0.0, 1.0) < 0.15;
  }
  return edits;
}

/// What is wrong after the edits, or nothing. What is a draft then has become final.
std::string FindDifference(const std::vector<Edit>& edits)
{
  EditedScene scene;
  UpdatedProp kept, whole;
  kept.Update(scene, false);
  for (std::size_t step = 0; step < edits.size(); ++step)
  {
    scene.Apply(edits[step]);
    kept.Update(scene, edits[step].IsDraft && step + 1 < edits.size());
  }
  whole.Update(scene, false);
  const std::vector<glm::vec4> texels = kept.GetTexels(), right = whole.GetTexels();
  if (texels.size() != right.size())
  {
    return "there are " + std::to_string(texels.size()) +
      " texels, right: " + std::to_string(right.size());
  }
  for (std::size_t i = 0; i < texels.size(); ++i)
  {
    if (texels[i] != right[i])
    {
      std::ostringstream text;
      text.precision(9);
      text << "texel " << i << " is " << texels[i].x << ", " << texels[i].y << ", " << texels[i].z
           << ", right: " << right[i].x << ", " << right[i].y << ", " << right[i].z;
      return text.str();
    }
  }
  return "";
}

/// The edits without those that the failure does not take.
std::vector<Edit> Shrink(std::vector<Edit> edits)
{
  for (std::size_t i = 0; i < edits.size();)
  {
    std::vector<Edit> fewer = edits;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    if (FindDifference(fewer).empty())
    {
      ++i;
    }
    else
    {
      edits = fewer;
      i = 0; // what was needed may no longer be
    }
  }
  return edits;
}

unsigned CountSequences()
{
  const char* asked = std::getenv("PENUMBRA_EDIT_SEQUENCES");
  return asked ? static_cast<unsigned>(std::atoi(asked)) : 150u;
}

} // namespace

TEST(EditSequences, GiveTheTexelsOfWholeBakesToTheBit)
{
  vtkOpenGLState* state = GetTestWindow()->GetState();
  state->Push();
  for (unsigned seed = 1; seed <= CountSequences(); ++seed)
  {
    const std::vector<Edit> edits = MakeSequence(seed);
    if (FindDifference(edits).empty())
    {
      continue;
    }
    const std::vector<Edit> shortest = Shrink(edits);
    std::ostringstream text;
    for (const Edit& edit : shortest)
    {
      text << edit;
    }
    ADD_FAILURE() << "seed " << seed << ": " << FindDifference(shortest) << "\n" << text.str();
    break;
  }
  state->Pop();
}

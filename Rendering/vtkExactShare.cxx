// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExactShare.h"

#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"
#include "vtkStageTexture.h"

#include <algorithm>
#include <optional>

vtkStandardNewMacro(vtkExactShare);

namespace
{

constexpr int TileSide = 16;
/// How near to a penumbra a texel is looked at that all samples, or none, reach.
constexpr int Margin = 3; // as many as vtkRadianceResolver has counts of
constexpr float None = -1.0f;
/// What a share is away from 0 or 1 by rounding.
constexpr double Rounding = 1e-9;

/// The index of a texel in a rectangle's rows.
std::size_t GetIndex(const penumbra::TexelRectangle& rectangle, const glm::ivec2& texel)
{
  const glm::ivec2 d = texel - rectangle.Low;
  return static_cast<std::size_t>(d.y) * static_cast<std::size_t>(rectangle.GetSize().x) +
    static_cast<std::size_t>(d.x);
}

template <typename Use>
void ForEachTexel(const penumbra::TexelRectangle& rectangle, const Use& use)
{
  for (int j = rectangle.Low.y; j < rectangle.High.y; ++j)
  {
    for (int i = rectangle.Low.x; i < rectangle.High.x; ++i)
    {
      use(glm::ivec2(i, j));
    }
  }
}

} // namespace

vtkExactShare::vtkExactShare() = default;
vtkExactShare::~vtkExactShare() = default;

bool vtkExactShare::Begin(const penumbra::PolygonVisibility* visibility,
  vtkOpenGLRenderWindow* window, const glm::ivec2& texels, const glm::ivec2& largest)
{
  this->Visibility = visibility;
  this->Texels = texels;
  this->Count = 0;
  return !visibility || this->Texture->Allocate(window, largest, 1);
}

bool vtkExactShare::Find(vtkStageTexture* counted, const glm::ivec2& firstTexel,
  const penumbra::TexelRectangle& around, const penumbra::TexelRectangle& rectangle)
{
  if (!this->Visibility || rectangle.IsEmpty() || around.IsEmpty())
  {
    return false;
  }
  const std::vector<float> counts =
    counted->Download({ around.Low - firstTexel, around.High - firstTexel });
  const std::size_t components = counts.size() / static_cast<std::size_t>(around.GetArea());
  const auto area = static_cast<std::size_t>(rectangle.GetArea());
  this->Wanted.assign(area, false);
  ForEachTexel(around,
    [&](const glm::ivec2& texel)
    {
      const float share = counts[GetIndex(around, texel) * components];
      if (share > 0.0f && share < 1.0f)
      {
        const penumbra::TexelRectangle near{ texel - Margin, texel + Margin + 1 };
        ForEachTexel(near.Intersection(rectangle),
          [&](const glm::ivec2& wanted) { this->Wanted[GetIndex(rectangle, wanted)] = true; });
      }
    });
  this->Shares.assign(area, None);
  const glm::ivec2 tiles = (rectangle.GetSize() + TileSide - 1) / TileSide;
  vtkSMPTools::For(0, static_cast<vtkIdType>(tiles.x) * tiles.y, 1,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        const auto tile = static_cast<int>(i);
        const glm::ivec2 low =
          rectangle.Low + TileSide * glm::ivec2(tile % tiles.x, tile / tiles.x);
        const penumbra::TexelRectangle whole{ low, low + TileSide };
        this->FindTile(whole.Intersection(rectangle), rectangle);
      }
    });
  const auto found = static_cast<std::size_t>(std::count_if(
    this->Shares.begin(), this->Shares.end(), [](float share) { return share != None; }));
  this->Count += found;
  if (found == 0)
  {
    return false;
  }
  this->Texture->Upload(rectangle.GetSize(), this->Shares.data());
  return true;
}

void vtkExactShare::FindTile(
  const penumbra::TexelRectangle& tile, const penumbra::TexelRectangle& rectangle)
{
  std::optional<penumbra::PolygonVisibility::Indices> near;
  const glm::dvec2 texels(this->Texels);
  ForEachTexel(tile,
    [&](const glm::ivec2& texel)
    {
      const std::size_t index = GetIndex(rectangle, texel);
      if (!this->Wanted[index])
      {
        return;
      }
      if (!near)
      {
        near =
          this->Visibility->FindNear(glm::dvec2(tile.Low) / texels, glm::dvec2(tile.High) / texels);
      }
      const std::optional<double> share =
        this->Visibility->FindShare((glm::dvec2(texel) + 0.5) / texels, *near);
      if (share)
      {
        const double rounded = *share < Rounding ? 0.0 : *share > 1.0 - Rounding ? 1.0 : *share;
        this->Shares[index] = static_cast<float>(rounded);
      }
    });
}

void vtkExactShare::ReleaseGraphicsResources()
{
  this->Texture->ReleaseGraphicsResources();
}

void vtkExactShare::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Count: " << this->Count << "\n";
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExactShare.h"

#include "vtkObjectFactory.h"
#include "vtkRadianceResolver.h"
#include "vtkSMPTools.h"
#include "vtkStageTexture.h"

#include <algorithm>
#include <numeric>
#include <optional>

vtkStandardNewMacro(vtkExactShare);

namespace
{

constexpr int TileSide = 16;
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
  this->Found.clear();
  return !visibility || this->Texture->Allocate(window, largest, 1);
}

bool vtkExactShare::Find(vtkStageTexture* counted, const glm::ivec2& firstTexel,
  const penumbra::TexelRectangle& around, const penumbra::TexelRectangle& rectangle)
{
  if (!this->Visibility || rectangle.IsEmpty() || around.IsEmpty())
  {
    return false;
  }
  auto shares = std::find_if(this->Found.begin(), this->Found.end(),
    [&](const Shares& found) { return found.Rectangle == rectangle; });
  if (shares == this->Found.end())
  {
    this->Found.push_back(this->FindShares(counted, firstTexel, around, rectangle));
    shares = this->Found.end() - 1;
  }
  if (shares->Count > 0)
  {
    this->Texture->Upload(rectangle.GetSize(), shares->Values.data());
  }
  return shares->Count > 0;
}

vtkExactShare::Shares vtkExactShare::FindShares(vtkStageTexture* counted,
  const glm::ivec2& firstTexel, const penumbra::TexelRectangle& around,
  const penumbra::TexelRectangle& rectangle) const
{
  const std::vector<float> counts =
    counted->Download({ around.Low - firstTexel, around.High - firstTexel });
  const std::size_t components = counts.size() / static_cast<std::size_t>(around.GetArea());
  const auto area = static_cast<std::size_t>(rectangle.GetArea());
  std::vector<bool> wanted(area, false);
  const int margin = vtkRadianceResolver::GetReconstructionHalo(); // as far as there are counts
  ForEachTexel(around,
    [&](const glm::ivec2& texel)
    {
      const float share = counts[GetIndex(around, texel) * components];
      if (share > 0.0f && share < 1.0f)
      {
        const penumbra::TexelRectangle nearby{ texel - margin, texel + margin + 1 };
        ForEachTexel(nearby.Intersection(rectangle),
          [&](const glm::ivec2& other) { wanted[GetIndex(rectangle, other)] = true; });
      }
    });
  Shares shares{ rectangle, std::vector<float>(area, None) };
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
        this->FindTile(whole.Intersection(rectangle), wanted, shares);
      }
    });
  shares.Count = static_cast<std::size_t>(std::count_if(
    shares.Values.begin(), shares.Values.end(), [](float share) { return share != None; }));
  return shares;
}

void vtkExactShare::FindTile(
  const penumbra::TexelRectangle& tile, const std::vector<bool>& wanted, Shares& shares) const
{
  std::optional<penumbra::PolygonVisibility::Indices> nearby;
  const glm::dvec2 texels(this->Texels);
  ForEachTexel(tile,
    [&](const glm::ivec2& texel)
    {
      const std::size_t index = GetIndex(shares.Rectangle, texel);
      if (!wanted[index])
      {
        return;
      }
      if (!nearby)
      {
        nearby =
          this->Visibility->FindNear(glm::dvec2(tile.Low) / texels, glm::dvec2(tile.High) / texels);
      }
      const std::optional<double> share =
        this->Visibility->FindShare((glm::dvec2(texel) + 0.5) / texels, *nearby);
      if (share)
      {
        const double rounded = *share < Rounding ? 0.0 : *share > 1.0 - Rounding ? 1.0 : *share;
        shares.Values[index] = static_cast<float>(rounded);
      }
    });
}

std::size_t vtkExactShare::GetCount() const
{
  return std::accumulate(this->Found.begin(), this->Found.end(), std::size_t{ 0 },
    [](std::size_t sum, const Shares& shares) { return sum + shares.Count; });
}

void vtkExactShare::ReleaseGraphicsResources()
{
  this->Visibility = nullptr;
  this->Found.clear();
  this->Texture->ReleaseGraphicsResources();
}

void vtkExactShare::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Count: " << this->GetCount() << "\n";
}

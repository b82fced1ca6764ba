// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TextureMemory.h"

#include "AtlasLayout.h"
#include "ShadowScene.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace penumbra
{
namespace
{

/// Of a fraction of the texels along an edge that a step leaves.
constexpr double Step = 0.8;

bool CanShrink(const TexelNeed& need)
{
  return !need.IsFixed && need.Texels != glm::ivec2(1);
}

void Shrink(TexelNeed& need)
{
  const glm::dvec2 before(need.Texels);
  need.Texels = glm::max(glm::ivec2(Step * before), glm::ivec2(1));
  const glm::dvec2 left = glm::dvec2(need.Texels) / before;
  need.PenumbraTexels *= std::min(left.x, left.y);
}

bool AsksForTheSame(const TextureNeed& a, const TextureNeed& b)
{
  return a.HasVariance == b.HasVariance &&
    std::equal(a.Receivers.begin(), a.Receivers.end(), b.Receivers.begin(), b.Receivers.end(),
      [](const TexelNeed& x, const TexelNeed& y)
      { return x.Texels == y.Texels && x.IsFixed == y.IsFixed; });
}

} // namespace

double TextureNeed::GetBytes() const
{
  std::vector<AtlasReceiver> receivers;
  for (const TexelNeed& need : this->Receivers)
  {
    receivers.emplace_back(need.Texels, need.IsTriangle);
  }
  const AtlasLayout layout(receivers, ShadowScene::MaximumTextureSide);
  const auto texels = static_cast<double>(layout.CountTexels(false)),
             withMipmaps = static_cast<double>(layout.CountTexels(true));
  constexpr double Irradiance = 16.0, Factors = 4.0, Variance = 4.0;
  return std::max(Irradiance * withMipmaps, Irradiance * texels + Factors * withMipmaps) +
    (this->HasVariance ? Variance * texels : 0.0);
}

double FindSharpestPenumbra(const ReceiverPlan& plan)
{
  // Bounds may be far wider, such as those of an occluder that reaches the light's height.
  const auto side = static_cast<double>(std::max(plan.Texels.x, plan.Texels.y));
  double narrowest = side;
  for (const PairPlan& pair : plan.Pairs)
  {
    if (pair.Needed == Effect::Hard || pair.Needed == Effect::Soft)
    {
      narrowest = std::min(narrowest, pair.PenumbraTexels);
    }
  }
  return narrowest / plan.Supersampling;
}

void FitTextures(std::vector<TextureNeed>& textures, double maximumBytes)
{
  std::vector<double> bytes;
  double sum = 0.0;
  for (const TextureNeed& texture : textures)
  {
    bytes.push_back(texture.GetBytes());
    sum += bytes.back();
  }
  while (sum > maximumBytes)
  {
    std::size_t chosen = textures.size();
    TexelNeed* widest = nullptr;
    for (std::size_t i = 0; i < textures.size(); ++i)
    {
      for (TexelNeed& need : textures[i].Receivers)
      {
        if (CanShrink(need) && (!widest || need.PenumbraTexels > widest->PenumbraTexels))
        {
          widest = &need;
          chosen = i;
        }
      }
    }
    if (!widest)
    {
      return;
    }
    Shrink(*widest);
    sum -= bytes[chosen];
    bytes[chosen] = textures[chosen].GetBytes();
    sum += bytes[chosen];
  }
}

const std::vector<TextureNeed>& TextureBudget::Fit(
  const std::vector<TextureNeed>& asked, double maximumBytes)
{
  const bool isSame = maximumBytes == this->MaximumBytes &&
    std::equal(asked.begin(), asked.end(), this->Asked.begin(), this->Asked.end(), AsksForTheSame);
  if (!isSame)
  {
    this->Asked = asked;
    this->Fitted = asked;
    this->MaximumBytes = maximumBytes;
    FitTextures(this->Fitted, maximumBytes);
  }
  return this->Fitted;
}

double TextureBudget::GetBytesLeft() const
{
  double left = this->MaximumBytes;
  for (const TextureNeed& texture : this->Fitted)
  {
    left -= texture.GetBytes();
  }
  return std::max(left, 0.0);
}

double TextureBudget::GetBytesLeftPerTexel(double others) const
{
  double texels = others;
  for (const TextureNeed& texture : this->Fitted)
  {
    for (const TexelNeed& need : texture.Receivers)
    {
      texels += static_cast<double>(need.Texels.x) * need.Texels.y;
    }
  }
  const double left = this->GetBytesLeft() - ShadowScene::BytesPerTexel * others;
  return std::max(left, 0.0) / std::max(texels, 1.0);
}

std::string TextureBudget::Describe() const
{
  std::size_t all = 0, larger = 0;
  double growth = 1.0;
  for (std::size_t i = 0; i < this->Asked.size(); ++i)
  {
    all += this->Asked[i].Receivers.size();
    for (std::size_t r = 0; r < this->Asked[i].Receivers.size(); ++r)
    {
      const glm::dvec2 asked(this->Asked[i].Receivers[r].Texels);
      const glm::dvec2 fitted(this->Fitted[i].Receivers[r].Texels);
      larger += asked != fitted ? 1 : 0;
      growth = std::max({ growth, asked.x / fitted.x, asked.y / fitted.y });
    }
  }
  if (larger == 0)
  {
    return {};
  }
  std::ostringstream text;
  text << larger << " of " << all << " receivers get texels up to " << std::setprecision(3)
       << growth << " times as large as asked for";
  return text.str();
}

} // namespace penumbra

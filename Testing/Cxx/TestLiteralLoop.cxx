// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// Visibility masks against the loop of H&H 1997, section 3.5, texel by texel.

#include "LiteralLoop.h"
#include "SamplingPattern.h"
#include "TestScenes.h"

#include "vtkOpenGLRenderWindow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <tuple>

namespace
{

std::vector<TestScene> GetScenes()
{
  std::vector<TestScene> scenes = GetOccludedScenes();
  for (TestScene& s : scenes) s.Texels = {96, 80};
  return scenes;
}

} // namespace

class LiteralLoopTest : public testing::TestWithParam<std::tuple<TestScene, int>>
{
};

TEST_P(LiteralLoopTest, EqualsMasks)
{
  TestScene ts = std::get<0>(GetParam());
  ts.Settings.SamplingPattern = std::get<1>(GetParam());
  for (int n : {1,16,64,256,1021})
  {
    ts.Settings.LightSamples = n;
    auto scene = ts.MakeScene();
    auto bake = BakeReceiver(scene);
    LiteralLoop loop;
    ASSERT_TRUE(loop.Bake(scene, 0, GetTestWindow(), LiteralLoop::Estimator::Ratio));
    auto ref = loop.GetIrradiance();
    double peak=0; for (auto&r:ref) peak=std::max({peak,r.x,r.y,r.z});
    int flips=0; double maxAll=0, maxNo=0;
    for (size_t i=0;i<ref.size();++i){ glm::dvec3 e=glm::abs(glm::dvec3(bake.Texels.Irradiance[i])-ref[i]); double m=std::max({e.x,e.y,e.z})/peak; maxAll=std::max(maxAll,m); if(m>1e-5)++flips; else maxNo=std::max(maxNo,m);}
    std::cout << ts.Name << " " << ts.Settings.SamplingPattern << " n " << n << " samples " << bake.Reports[0].LightSamples[0] << " max " << maxAll << " flips " << flips << " else " << maxNo << "\n";
  }
}

INSTANTIATE_TEST_SUITE_P(All, LiteralLoopTest, testing::Combine(testing::ValuesIn(GetScenes()), testing::Range(0,5)));

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// The same bits every time; smooth films.

#include "StabilityTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace
{

using Texels = std::vector<glm::vec4>;

/// What a command prints.
std::string Run(const std::string& command)
{
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> buffer{};
  while (pipe && fgets(buffer.data(), static_cast<int>(buffer.size()), pipe))
  {
    text += buffer.data();
  }
  EXPECT_EQ(pipe ? pclose(pipe) : -1, 0) << command;
  return text;
}

/// Every component, by a process of its own.
void ExpectSameDigest(const std::string& what, const std::vector<std::string>& commands)
{
  const std::string first = Run(PENUMBRA_BAKE_DIGEST);
  EXPECT_EQ(first.size(), 17u) << first; // 16 digits and the line's end, but for a leading 0
  double differences = 0.0;
  for (const std::string& command : commands)
  {
    differences += Run(command) != first ? 1.0 : 0.0;
  }
  ExpectWithin(what + ": digests that differ", differences, 0.0);
}

constexpr int Frames = 120;

/// The receiver 2 x 2, a lamp 1 x 1 at a height of 4, and half as high a plate that reaches far to
/// one side and beyond the lamp's shadow in the other direction: one edge alone crosses the light.
TestScene MakeFrame(double plate, double light)
{
  TestScene scene;
  scene.Base = { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } };
  scene.Texels = { 24, 24 };
  scene.Settings.LightSamples = 256;
  scene.AddLight({ light - 0.5, 0.5, 4.0 }, { light + 0.5, 0.5, 4.0 }, { light - 0.5, -0.5, 4.0 });
  scene.AddPlate({ plate - 50.0, -50.0, 2.0 }, { 50.0, 0.0, 0.0 }, { 0.0, 100.0, 0.0 });
  return scene;
}

/// The largest second difference over the frames, of the peak.
double GetJerk(const std::function<TestScene(int)>& makeFrame, bool reconstruction)
{
  std::vector<Texels> frames;
  double peak = 0.0, largest = 0.0;
  for (int f = 0; f < Frames; ++f)
  {
    TestScene scene = makeFrame(f);
    scene.Settings.Reconstruction = reconstruction;
    frames.push_back(BakeReceiver(scene.MakeScene()).Texels.Irradiance);
    for (std::size_t i = 0; i < frames.back().size(); ++i)
    {
      peak = std::max(peak, static_cast<double>(frames.back()[i].r));
      if (f >= 2)
      {
        const auto a = frames.size() - 1;
        largest = std::max(largest,
          static_cast<double>(
            std::abs(frames[a][i].r - 2.0f * frames[a - 1][i].r + frames[a - 2][i].r)));
      }
    }
  }
  return largest / peak;
}

/**
 * Of an edge that crosses the light by `step` of its width a frame. A net of n samples has one in
 * each of n equal strips: the samples on one side of an edge are as many as its share says, to
 * within 1. Their second difference is the edge's own, at most `step`, as it enters and leaves the
 * light, plus 4 times that 1. A sample weighs more than the mean by at most (r_max / r_min)^4, here
 * with r^2 from 4^2 to 4^2 + 1.5^2 + 1.5^2.
 */
double GetJerkBound(double step)
{
  const double r2 = (16.0 + 4.5) / 16.0;
  return r2 * r2 * (step + 4.0 / 256.0);
}

} // namespace

TEST(StabilityDeterminism, OneTwoOrEightThreads)
{
  std::vector<std::string> commands;
  for (const char* threads : { "1", "2", "8" })
  {
    commands.push_back(std::string("LP_NUM_THREADS=") + threads + " VTK_SMP_MAX_THREADS=" +
      threads + " VTK_SMP_BACKEND_IN_USE=STDThread " + PENUMBRA_BAKE_DIGEST);
  }
  ExpectSameDigest("threads", commands);
}

TEST(StabilityDeterminism, OSMesaAndEGL)
{
  ExpectSameDigest("EGL", { std::string("env -u DISPLAY ") + PENUMBRA_BAKE_DIGEST_EGL });
}

TEST(StabilityDeterminism, AnyOrderOfActors)
{
  std::vector<std::string> commands;
  for (const char* order : { " 1", " 7", " 24", " 42", " 66", " 95", " 119" }) // of 5! = 120
  {
    commands.push_back(PENUMBRA_BAKE_DIGEST + std::string(order));
  }
  ExpectSameDigest("orders of actors", commands);
}

TEST(StabilityDeterminism, WithOtherViewsOpen)
{
  ExpectSameDigest("other views", { std::string(PENUMBRA_BAKE_DIGEST) + " 0 2" });
}

TEST(StabilityFilm, OccluderThatMoves)
{
  // Over 3 units, each seen on the light as twice as much: it stands half-way.
  const double step = 3.0 / Frames;
  const auto makeFrame = [&](int f) { return MakeFrame(-1.5 + step * f, 0.0); };
  for (const bool reconstruction : { false, true })
  {
    ExpectWithin(reconstruction ? "second difference, reconstructed" : "second difference",
      GetJerk(makeFrame, reconstruction), GetJerkBound(2.0 * step));
  }
}

TEST(StabilityFilm, LightThatMoves)
{
  const double step = 1.5 / Frames;
  const auto makeFrame = [&](int f) { return MakeFrame(0.1, -0.75 + step * f); };
  for (const bool reconstruction : { false, true })
  {
    // With the light, what is unblocked changes, too: over 120 frames smoothly, by (f / 120)^2.
    ExpectWithin(reconstruction ? "second difference, reconstructed" : "second difference",
      GetJerk(makeFrame, reconstruction), GetJerkBound(step) + 2.0 / (Frames * Frames));
  }
}

// What a moving occluder does not reach stays as it is, to the bit: no new samples from frame to
// frame.
TEST(StabilityFilm, SamplesStayFromFrameToFrame)
{
  double changes = 0.0;
  Texels before;
  for (int f = 0; f < 20; ++f)
  {
    TestScene scene = MakeFrame(-0.3, 0.0);
    const double x = 0.7 + 0.01 * f;
    scene.AddPlate({ x, 0.6, 0.02 }, { 0.1, 0.0, 0.0 }, { 0.0, 0.1, 0.0 });
    const Texels now = BakeTexels(scene);
    // The little plate is low and to the right: it hides nothing from the left half.
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      changes += i % 24 < 12 && now[i] != before[i] ? 1.0 : 0.0;
    }
    before = now;
  }
  ExpectWithin("texels out of reach that change", changes, 0.0);
}

// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What every benchmark needs.
 */
#ifndef BenchmarkTools_h
#define BenchmarkTools_h

#include "vtkOpenGLRenderWindow.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

/// Seconds since some moment.
inline double GetTime()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline double GetMedian(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// A window that needs no display: OSMesa's, or VTK's own from 9.4 on.
inline vtkSmartPointer<vtkOpenGLRenderWindow> MakeWindow()
{
  return vtkOpenGLRenderWindow::SafeDownCast(vtkSmartPointer<vtkRenderWindow>::New());
}

/// Prints a line for what is not as required; the answer is whether it is.
inline bool Require(bool holds, const std::string& what)
{
  if (!holds)
  {
    std::printf("FAILED: %s\n", what.c_str());
  }
  return holds;
}

/**
 * A benchmark's main function: reads `[--smallest] [results.json]`, and answers what run(plan,
 * jsonPath) does, whose plan is the first or, for CI, the smallest.
 */
template <typename Plan, typename Run>
int RunBenchmark(
  int argc, char** argv, const char* name, Plan plan, const Plan& smallest, const Run& run)
{
  std::string jsonPath;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--smallest")
    {
      plan = smallest;
    }
    else if (argument[0] != '-' && jsonPath.empty())
    {
      jsonPath = argument;
    }
    else
    {
      std::fprintf(stderr, "usage: %s [--smallest] [results.json]\n", name);
      return 2;
    }
  }
  return run(plan, jsonPath);
}

#endif

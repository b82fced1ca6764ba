// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Part of every test program that draws, where VTK brings windows of EGL: they are chosen before
// main(), also where there is a display. Without one, VTK would look for an X server first, and
// complain. (gtest_discover_tests() cannot give its tests several variables.)
#include <cstdlib>

namespace
{
[[maybe_unused]] const int Chosen = setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow", 0);
}

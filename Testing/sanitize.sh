#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the C++ tests with AddressSanitizer and UndefinedBehaviorSanitizer in a folder of their own, and runs them:
#   sh Testing/sanitize.sh BUILD_FOLDER VTK_DIR
# Debian's VTK has no debug-leaks report (VTK_DEBUG_LEAKS is off); LeakSanitizer sees every VTK object that is lost.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
build=$1
vtk=$2

cmake -G Ninja -S "$source" -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 \
  -DPENUMBRA_BUILD_PLUGIN=OFF -DPENUMBRA_BUILD_TESTING=ON -DPENUMBRA_SANITIZE=address,undefined \
  -DVTK_DIR="$vtk" -DPython3_EXECUTABLE=/usr/bin/python3 >"$build.configure.log" 2>&1 ||
  { cat "$build.configure.log"; exit 1; }
cmake --build "$build" --target PenumbraBakeTests

ASAN_OPTIONS=detect_leaks=1
UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
LSAN_OPTIONS=suppressions=$source/Testing/leaks.supp:print_suppressions=0
export ASAN_OPTIONS UBSAN_OPTIONS LSAN_OPTIONS
exec "$build/bin/PenumbraBakeTests" --gtest_brief=1

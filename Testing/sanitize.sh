#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds a program of the tests with clang, AddressSanitizer and UndefinedBehaviorSanitizer, and code for libFuzzer, in
# a folder of their own, and runs it:
#   sh Testing/sanitize.sh BUILD_FOLDER VTK_DIR PROGRAM [ARGUMENT...]
#   sh Testing/sanitize.sh build/sanitize /usr/lib/x86_64-linux-gnu/cmake/paraview-5.11/vtk PenumbraBakeTests
# To search ten minutes for polygonal data that are not parsed well, and keep what is found in a folder that is there:
#   ... PenumbraFuzz -max_total_time=600 -max_len=600 -len_control=0 build/sanitize/corpus
# An input that fails is written to BUILD_FOLDER; BUILD_FOLDER/bin/PenumbraFuzz FILE repeats it.
# Debian's VTK has no debug-leaks report (VTK_DEBUG_LEAKS is off); LeakSanitizer sees every VTK object that is lost.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
build=$1
vtk=$2
program=$3
shift 3

cmake -G Ninja -S "$source" -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DPENUMBRA_BUILD_PLUGIN=OFF -DPENUMBRA_BUILD_TESTING=ON \
  -DPENUMBRA_SANITIZE=fuzzer-no-link,address,undefined,float-cast-overflow \
  -DVTK_DIR="$vtk" -DPython3_EXECUTABLE=/usr/bin/python3 >"$build.configure.log" 2>&1 ||
  { cat "$build.configure.log"; exit 1; }
cmake --build "$build" --target "$program"

ASAN_OPTIONS=detect_leaks=1
UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
LSAN_OPTIONS=suppressions=$source/Testing/leaks.supp:print_suppressions=0
export ASAN_OPTIONS UBSAN_OPTIONS LSAN_OPTIONS
cd "$build"
exec "bin/$program" "$@"

#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the fuzzer of polygonal data with clang, AddressSanitizer and UndefinedBehaviorSanitizer in a folder of its
# own, and runs it:
#   sh Testing/fuzz.sh BUILD_FOLDER VTK_DIR [LIBFUZZER_OPTION...]
# Without options, it tries 10 000 inputs, the same each time. To search for ten minutes, and keep what is found:
#   sh Testing/fuzz.sh BUILD_FOLDER VTK_DIR -max_total_time=600 -max_len=600 -len_control=0 BUILD_FOLDER/corpus
# An input that fails is written to BUILD_FOLDER; BUILD_FOLDER/bin/PenumbraFuzz FILE repeats it.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
build=$1
vtk=$2
shift 2
[ $# -gt 0 ] || set -- -seed=1 -runs=10000 -max_len=600 -len_control=0

cmake -G Ninja -S "$source" -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DPENUMBRA_BUILD_PLUGIN=OFF -DPENUMBRA_BUILD_TESTING=ON \
  -DPENUMBRA_SANITIZE=fuzzer-no-link,address,undefined,float-cast-overflow \
  -DVTK_DIR="$vtk" -DPython3_EXECUTABLE=/usr/bin/python3 >"$build.configure.log" 2>&1 ||
  { cat "$build.configure.log"; exit 1; }
cmake --build "$build" --target PenumbraFuzz

ASAN_OPTIONS=detect_leaks=1
UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
LSAN_OPTIONS=suppressions=$source/Testing/leaks.supp:print_suppressions=0
export ASAN_OPTIONS UBSAN_OPTIONS LSAN_OPTIONS
for folder; do
  case $folder in
    -*) ;;
    *) mkdir -p "$folder" ;;
  esac
done
exec "$build/bin/PenumbraFuzz" -artifact_prefix="$build/" "$@"

#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs every test, on a Debian 12 or newer with nothing but git: installs what is missing, checks the format, builds,
# and tests; those labelled `quick` come first, and the others only if they pass. Arguments go to ctest, in one run:
#   sh Testing/test.sh -R Projection
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
. "$source/Plugin/setup.sh"

# The version that .clang-format is written for; others format some lines otherwise.
clang_format_version=14

check_format()
{
  clang-format --version | grep -q " version $clang_format_version\." || {
    echo "Format not checked: that takes clang-format $clang_format_version."
    return 0
  }
  cd "$source"
  git ls-files '*.cxx' '*.h' >"$build/sources.txt" || fail "git cannot list the files whose format is to be checked."
  logged format xargs --arg-file="$build/sources.txt" --no-run-if-empty clang-format --dry-run -Werror ||
    fail "not formatted as .clang-format says (clang-format -i mends it):" \
      "$(sed -n 's/^\([^ :]*\):[0-9].* error: .*/\1/p' "$log" | sort -u | tr '\n' ' ')(log: $log)"
}

run_tests()
{
  ctest --test-dir "$build" --parallel "$(nproc)" --output-on-failure --no-tests=error "$@"
}

install_packages clang clang-format libclang-rt-dev libgtest-dev xvfb xauth
check_format
build_penumbra -DPENUMBRA_BUILD_TESTING=ON ${CI:+-DPENUMBRA_WARNINGS_AS_ERRORS=ON}
if [ $# -gt 0 ]; then
  run_tests "$@"
else
  run_tests --label-regex '^quick$'
  run_tests --label-exclude '^quick$'
fi

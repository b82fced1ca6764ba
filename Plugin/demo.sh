#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Renders the demo without a display, on a Debian 12 or newer with nothing but git: installs what is missing, builds,
# and draws <build>/demo.png. Run again, it only draws. Arguments go to Plugin/demo.py.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
. "$source/Plugin/setup.sh"

install_packages
build_penumbra
/usr/bin/pvpython "$source/Plugin/demo.py" "$build/demo.png" "$@" ||
  fail "the demo has failed; the reason is above."

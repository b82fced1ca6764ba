#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# demo.sh [NAME [MULTIPLIER]]: renders a scene of Data/scenes.py without a display, on a Debian 12 or newer with nothing
# but git: installs what is missing, builds, and draws <build>/demo.png, or <build>/demo-NAME.png for other scenes than
# the room. Run again, it only draws. MULTIPLIER is a factor of the scene's light samples.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
. "$source/Plugin/setup.sh"

# A wrong name is told before anything is installed or built.
name=${1:-room}
names=$(sed -n 's/^    "\([a-z-]*\)": (".*/\1/p' "$source/Data/scenes.py" | tr '\n' ' ')
case " $names" in
  *" $name "*) ;;
  *) fail "there is no scene $name; there are: $names" ;;
esac
[ "$name" = room ] && picture=$build/demo.png || picture=$build/demo-$name.png

install_packages
build_penumbra
/usr/bin/pvpython "$source/Plugin/demo.py" "$picture" "$name" "${2:-1}" ||
  fail "the demo has failed; the reason is above."

# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# The set-up that Plugin/demo.sh and Testing/test.sh share. They source it, with `source` set to the top level:
#   install_packages [NAME...]       installs the Debian packages that Penumbra needs, and these; only what is missing
#   build_penumbra [-DNAME=VALUE...] configures, if the build folder does not say so yet, and builds
# Both do nothing where nothing is to be done, and end the script with one sentence and exit status 1 where they fail.
# The build folder is PENUMBRA_BUILD_DIR, or build/ at the top level; the logs are kept in it.
# shellcheck shell=sh

fail()
{
  echo "Penumbra: $*" >&2
  exit 1
}

build=${PENUMBRA_BUILD_DIR:-$source/build}
build=$(mkdir -p "$build" 2>/dev/null && CDPATH='' cd -- "$build" && pwd) ||
  fail "the build folder ${PENUMBRA_BUILD_DIR:-$source/build} cannot be made; PENUMBRA_BUILD_DIR may name another."
PENUMBRA_BUILD_DIR=$build
export PENUMBRA_BUILD_DIR

# The same pixels on every machine: no X server, and one vector width for Mesa's software rasteriser.
unset DISPLAY
LP_NATIVE_VECTOR_WIDTH=256
export LP_NATIVE_VECTOR_WIDTH

oldest_paraview=5.11

# The packages that every release has, by the same names.
packages="paraview paraview-dev python3-paraview libglm-dev libegl-dev libopengl-dev libglew-dev libfreetype-dev
  libopenmpi-dev libpython3-dev python3-dev ninja-build cmake g++"

# packages_of VERSION: what else ParaView needs in this version.
packages_of()
{
  if dpkg --compare-versions "$1" ge 6.1; then
    echo libvtk9-dev # apart from ParaView's own files; until then the two exclude each other
  else
    echo libosmesa6-dev # Mesa has dropped it since; VTK then brings windows without X of its own
  fi
}

# logged NAME COMMAND...: sends the command's output to the log NAME. Logs of CI are lost: there a failure prints it.
logged()
{
  log=$build/$1.log
  shift
  "$@" >"$log" 2>&1 && return
  [ -z "${CI:-}" ] || cat "$log"
  return 1
}

as_root()
{
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo "$@"
  fi
}

# The installed version of a package; nothing if it is not installed.
installed()
{
  dpkg-query --show --showformat '${db:Status-Status} ${Version}\n' "$1" 2>/dev/null | sed -n 's/^installed //p'
}

# The version of a package that apt would install; nothing if it has none.
available()
{
  LC_ALL=C apt-cache policy "$1" | sed -n 's/^  Candidate: \([^(].*\)/\1/p'
}

missing()
{
  for package; do
    [ -n "$(installed "$package")" ] || printf ' %s' "$package"
  done
}

# Refreshes apt's lists, once a run. A list that cannot be had only matters if a package is then not found.
lists=unread
update_lists()
{
  [ "$lists" = unread ] || return 0
  command -v apt-get >/dev/null ||
    fail "Debian packages are missing and there is no apt-get here; on another system, build with CMake by hand."
  [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null ||
    fail "Debian packages are missing, and only root or sudo can install them:$(missing "$@")"
  as_root true 2>"$build/sudo.log" ||
    fail "Debian packages are missing, and sudo does not let this user install them:$(missing "$@")"
  lists=current
  logged update as_root apt-get --option APT::Update::Error-Mode=any update || lists=unreachable
}

require_available()
{
  for package; do
    [ -n "$(available "$package")" ] && continue
    [ "$lists" = current ] ||
      fail "the Debian packages cannot be downloaded; is there a network? (log: $build/update.log)"
    fail "this system has no package $package; Penumbra needs Debian 12 or newer. (log: $build/update.log)"
  done
}

install_packages()
{
  # shellcheck disable=SC2086 # a list of words
  set -- $packages "$@"
  paraview=$(installed paraview-dev)
  if [ -z "$paraview" ]; then
    update_lists "$@"
    require_available paraview-dev
    paraview=$(available paraview-dev)
  fi
  dpkg --compare-versions "$paraview" ge $oldest_paraview ||
    fail "ParaView $oldest_paraview or newer is needed, and this system's is $paraview."

  # shellcheck disable=SC2046 # a list of words
  set -- $(missing "$@" $(packages_of "$paraview"))
  [ $# -gt 0 ] || return 0
  update_lists "$@"
  require_available "$@"
  echo "Installing $# Debian packages and what they need (log: $build/install.log)"
  logged install as_root env DEBIAN_FRONTEND=noninteractive apt-get --option DPkg::Lock::Timeout=600 \
    install --yes --no-install-recommends "$@" && return
  grep -q 'Failed to fetch' "$log" &&
    fail "the Debian packages cannot be downloaded; is there a network? (log: $log)"
  fail "apt-get cannot install the Debian packages. (log: $log)"
}

# cache_says -DNAME=VALUE...: whether CMake was last run with these values.
cache_says()
{
  for option; do
    name=${option#-D}
    grep -q "^${name%%=*}:[A-Z]*=${name#*=}\$" "$build/CMakeCache.txt" || return 1
  done
}

build_penumbra()
{
  [ -f "$build/CMakeCache.txt" ] ||
    set -- -G Ninja -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE=/usr/bin/python3 "$@"
  if [ ! -f "$build/build.ninja" ] || ! cache_says "$@"; then
    echo "Configuring in $build"
    logged configure cmake -S "$source" -B "$build" "$@" || fail "CMake cannot configure the build. (log: $log)"
  fi
  cmake --build "$build" || fail "the build has failed; the reason is above."
}

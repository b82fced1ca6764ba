#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the README's two commands in a clean Debian of another release, in a folder of its own:
#   sh Testing/debian.sh RELEASE [FOLDER]      bookworm, trixie, sid, or 12 and 13
# As root, with Debian's package debootstrap. FOLDER (default: /var/tmp/penumbra-RELEASE) is made once, from the mirror
# that this system uses, and holds the release and a clone of what is committed; run again, it goes on with it. What the
# tests print is in FOLDER/root/penumbra/build. Remove the folder by hand, after its proc, sys and dev are unmounted.
set -eu
source=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)

fail()
{
  echo "debian.sh: $*" >&2
  exit 1
}

[ $# -ge 1 ] || fail "no release is named; allowed: bookworm, trixie, sid, 12, 13."
case $1 in
  12 | bookworm) release=bookworm ;;
  13 | trixie) release=trixie ;;
  sid) release=sid ;;
  *) fail "there is no release $1; allowed: bookworm, trixie, sid, 12, 13." ;;
esac
folder=${2:-/var/tmp/penumbra-$release}
[ "$(id -u)" -eq 0 ] || fail "only root may make a system in a folder."
command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"

# The mirror of this system's own package lists.
mirror=$(apt-cache policy | sed -n 's|^ *[0-9-]* \(https\{0,1\}://[^ ]*/debian\) .*|\1|p' | head -n 1)
[ -n "$mirror" ] || fail "apt knows no Debian mirror; run apt-get update."

if [ ! -e "$folder/etc/debian_version" ]; then
  echo "Making $release in $folder"
  debootstrap --variant=minbase --include=ca-certificates,git "$release" "$folder" "$mirror" >"$folder.log" 2>&1 ||
    fail "debootstrap has failed. (log: $folder.log)"
fi
for kind in proc sys dev; do
  mountpoint -q "$folder/$kind" || mount --bind "/$kind" "$folder/$kind" || fail "$folder/$kind cannot be mounted."
done
cp /etc/resolv.conf "$folder/etc/resolv.conf"

clone=$folder/root/penumbra
if [ -d "$clone" ]; then
  git -C "$clone" fetch --quiet "$source" HEAD && git -C "$clone" checkout --quiet --detach FETCH_HEAD
else
  git clone --quiet "$source" "$clone"
fi || fail "the repository cannot be cloned to $clone."

in_folder()
{
  chroot "$folder" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 sh -c "cd /root/penumbra && $1"
}
in_folder "sh Plugin/demo.sh"
in_folder "sh Testing/test.sh"
in_folder "git status --porcelain" | grep . && fail "the commands left these files in the source tree."
echo "Both commands pass on $release."

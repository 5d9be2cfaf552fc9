#!/usr/bin/env bash
# A person's desk for tests/gui/e2e: a screen (Xvfb), a window manager (openbox) and hands (xdotool), from Debian's packages.
set -euo pipefail

missing=()
declare -A package_of=([Xvfb]=xvfb [openbox]=openbox [xdotool]=xdotool)
for program in Xvfb openbox xdotool; do
    command -v $program >/dev/null || missing+=("${package_of[$program]}")
done
[ ${#missing[@]} -eq 0 ] && exit 0
if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null; then
    echo "setup: the tests that drive the window by mouse and keys need ${missing[*]}; install them and run again:" >&2
    echo "    sudo apt-get install ${missing[*]}" >&2
    exit 1
fi
apt-get update -qq >/dev/null || true
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null || {
    echo "setup: apt-get could not install ${missing[*]}" >&2
    exit 1
}

#!/usr/bin/env bash
# LinuxCNC's stand-alone RS-274 interpreter for tests/gcode/test_rs274.py: taken out of Debian's packages into .rs274,
# never installed. It brings what it links against that a bare system may lack, its Python included.
set -euo pipefail
cd "$(dirname "$0")/.."

home=$PWD/.rs274
wanted=$(sha256sum <tests/setup_rs274.sh)
[ "$(cat "$home/.stamp" 2>/dev/null)" = "$wanted" ] && exit 0
for tool in apt-get apt-cache dpkg-deb; do
    command -v $tool >/dev/null || { echo "setup: LinuxCNC's rs274 is taken from a Debian package, and there is no $tool here" >&2; exit 1; }
done
rm -rf "$home"
mkdir -p "$home/packages"
cd "$home/packages"

if ! apt-cache show linuxcnc-uspace >/dev/null 2>&1; then
    [ "$(id -u)" = 0 ] && apt-get update -qq >/dev/null || true
fi
needs() { apt-cache depends "$1" 2>/dev/null | sed -n 's/^ *Depends: \([a-z0-9.+-]*\)$/\1/p'; }
libraries=$(needs linuxcnc-uspace | grep -E '^lib(boost-python|edit|python3)')
python=$(grep -m1 '^libpython3' <<<"$libraries")
# apt grumbles that its own user cannot see this folder; what matters is what it leaves here.
# shellcheck disable=SC2086  # one word a package
apt-get download -qq linuxcnc-uspace $libraries "$python-minimal" "$python-stdlib" 2>/dev/null || {
    echo "setup: apt-get could not download linuxcnc-uspace" >&2
    exit 1
}
for package in *.deb; do dpkg-deb --extract "$package" "$home"; done
cd "$home"
rm -rf packages etc lib usr/share usr/include

# It must draw a half circle, and refuse one whose ends are not equally far from the centre.
run() { LD_LIBRARY_PATH=$(echo "$home"/usr/lib "$home"/usr/lib/*-linux-gnu | tr ' ' :) PYTHONHOME=$home/usr usr/bin/rs274 -g -t /dev/null -v "$home/.var" "$1"; }
printf 'G21\nG90\nG0 X10 Y10\nG3 X20 Y10 I5 J0 F200\nM2\n' >.good
sed 's/I5/I5.2/' .good >.bad
if ! run .good 2>/dev/null | grep -q ARC_FEED || run .bad >/dev/null 2>&1; then
    echo "setup: LinuxCNC's rs274 does not run here" >&2
    exit 1
fi
rm -f .good .bad .var*
echo "$wanted" >.stamp

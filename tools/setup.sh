#!/usr/bin/env bash
# Make .venv with everything in it; do nothing when all is there. System packages that are missing are
# installed where the user is root, and listed where not. What is missing is found by trying, not assumed.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=.venv
stamp=$venv/.stamp

say() { echo "setup: $*"; }
fail() { echo "setup: $*" >&2; exit 1; }

# system_packages PURPOSE PACKAGE...: install them, or say what to install; false where that did not work.
updated=no
system_packages() {
    local purpose=$1; shift
    if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null; then
        echo "setup: $purpose needs system packages; install them and run again:" >&2
        echo "    sudo apt-get install $*" >&2
        return 1
    fi
    say "installing $* ($purpose)"
    if [ $updated = no ]; then apt-get update -qq >/dev/null || true; updated=yes; fi
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null || { echo "setup: apt-get could not install $*" >&2; return 1; }
}

python_of_age() {
    local candidate
    for candidate in python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then echo "$candidate"; return; fi
    done
    return 1
}

wanted=$(cat requirements.lock pyproject.toml tools/setup.sh | sha256sum | cut -d' ' -f1)
if [ -x $venv/bin/skinfab ] && [ "$(cat $stamp 2>/dev/null)" = "$wanted" ]; then exit 0; fi

python=$(python_of_age) || { system_packages "Python" python3 python3-venv && python=$(python_of_age); } || fail "Python 3.11 or later is needed"

if [ ! -x $venv/bin/python ] || ! $venv/bin/python -m pip --version >/dev/null 2>&1; then
    # Debian ships venv without what fills it.
    "$python" -c 'import venv, ensurepip' 2>/dev/null || system_packages "the virtual environment" python3-venv \
        || fail "the virtual environment cannot be made"
    say "making $venv with $("$python" --version)"
    "$python" -m venv $venv
fi

say "installing packages from requirements.lock"
# Two at once, each every other package: pip unpacks on one core. The one after them has the last word, and tells what failed.
pip="$venv/bin/python -m pip install --quiet --disable-pip-version-check --no-compile --only-binary :all:"
for half in 0 1; do
    $pip --no-deps $(grep -v '^#' requirements.lock | awk -v half=$half 'NF && NR % 2 == half') >/dev/null 2>&1 &
done
wait
$pip -r requirements.lock
$venv/bin/python -m pip install --quiet --disable-pip-version-check --no-compile --no-deps --no-build-isolation -e .

# Compiled beside what follows, and without the packages' own tests: pip takes 45 s for all, on one core and while nothing else is done.
# What does not compile are files for other versions of Python.
$venv/bin/python -m compileall -qq -j 0 -x '/tests?/' "$PWD/$venv/lib" >/dev/null 2>&1 &

# What pymeshlab's libraries cannot find, by the package that has it.
declare -A package_of=([libGL.so.1]=libgl1 [libEGL.so.1]=libegl1 [libOpenGL.so.0]=libopengl0 [libGLU.so.1]=libglu1-mesa [libgomp.so.1]=libgomp1
    [libxkbcommon.so.0]=libxkbcommon0 [libfontconfig.so.1]=libfontconfig1 [libdbus-1.so.3]=libdbus-1-3 [libglib-2.0.so.0]=libglib2.0-0
    [libX11.so.6]=libx11-6 [libfreetype.so.6]=libfreetype6)
probe='import pymeshlab; pymeshlab.MeshSet(); import igl, manifold3d, cvxopt, matplotlib.image'
if said=$($venv/bin/python -W ignore -c "$probe" 2>&1) && [ -z "$said" ]; then :; else
    folder=$($venv/bin/python -c 'import importlib.util as u; print(u.find_spec("pymeshlab").submodule_search_locations[0])')
    missing=()
    while read -r library; do
        [ -n "${package_of[$library]:-}" ] && missing+=("${package_of[$library]}")
    done < <(find "$folder" -name '*.so*' -exec ldd {} + 2>/dev/null | awk '/not found/ {print $1}' | sort -u)
    if [ ${#missing[@]} -gt 0 ]; then system_packages "mesh repair (pymeshlab)" "${missing[@]}" || fail "pymeshlab cannot be loaded without them"; fi
    $venv/bin/python -W ignore -c "$probe" || fail "a library cannot be loaded; the lines above say which"
fi

# Compiled once, here, instead of in the user's first command.
say "compiling what is computed most"
$venv/bin/python -W ignore - <<'WARM' || say "left for the first use"
import numpy as np
from skinfab.bench.disks import bumpy_cap
from skinfab.flatten import bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.mesh.door import load_usable
from skinfab.seams.auto import find_seams
from skinfab.seams.judge import Limits
from gui.view3d import painter
painter.warm()
flatten_isometric(*bumpy_cap(5400))
turn, r = np.meshgrid(np.linspace(0, 4 * np.pi, 81), np.linspace(1, 2, 5))
V = np.stack([r.ravel() * np.cos(turn.ravel()), r.ravel() * np.sin(turn.ravel()), 0.3 * turn.ravel()], axis=1)
k = (81 * np.arange(4)[:, None] + np.arange(80)).ravel()
bijective.flatten_bijective(V, np.concatenate([np.stack([k, k + 1, k + 82], axis=1), np.stack([k, k + 82, k + 81], axis=1)]))
find_seams(load_usable("meshes/cube.obj").mesh, Limits(), aim="fewest")
WARM

# Only the GUI and its tests need a Tk and, where there is no screen, a virtual one: without them the rest still works.
gui=()
$venv/bin/python -c 'import tkinter' 2>/dev/null || gui+=(python3-tk)
[ -n "${DISPLAY:-}" ] || command -v Xvfb >/dev/null || gui+=(xvfb)
if [ ${#gui[@]} -gt 0 ]; then system_packages "the GUI" "${gui[@]}" || say "going on without the GUI"; fi

wait
echo "$wanted" >$stamp
say "done: $venv/bin/skinfab"

#!/usr/bin/env bash
# printrun (reader and sender) and pyGCodeDecode (planner) in an environment of their own, for tests/gcode: the windows
# of the one and the 3D views of the other pull in packages without wheels, or very large ones, that no test needs.
set -euo pipefail
cd "$(dirname "$0")/.."

stamp=.venv-printrun/.stamp
wanted=$(sha256sum <tests/setup_printrun.sh)
[ "$(cat $stamp 2>/dev/null)" = "$wanted" ] && exit 0
rm -rf .venv-printrun
"${PYTHON:-.venv/bin/python}" -m venv .venv-printrun
.venv-printrun/bin/pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    "printrun==2.2.0" "pyserial>=3.5" "platformdirs" "pygcodedecode==1.5.1" "pyyaml>=6.0.2,<7" "numpy>=2.0"
.venv-printrun/bin/python -c 'import printrun.printcore, pyGCodeDecode.gcode_interpreter'
echo "$wanted" >$stamp

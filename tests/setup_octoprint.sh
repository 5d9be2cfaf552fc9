#!/usr/bin/env bash
# OctoPrint's G-code analysis in an environment of its own, for tests/gcode/test_verifiers.py: its pins contradict ours.
# Without --no-deps pip gives up: its netifaces has no wheel. The analysis command needs only the modules below,
# and netifaces2 is the same module with wheels.
set -euo pipefail
cd "$(dirname "$0")/.."

stamp=.venv-octoprint/.stamp
wanted=$(sha256sum <tests/setup_octoprint.sh)
[ "$(cat $stamp 2>/dev/null)" = "$wanted" ] && exit 0
rm -rf .venv-octoprint
"${PYTHON:-.venv/bin/python}" -m venv .venv-octoprint
.venv-octoprint/bin/pip install --quiet --no-deps --only-binary :all: \
    "octoprint==1.11.8" "click>=8.1.8,<8.2" "werkzeug>=3.0.6,<3.2" markupsafe "zipstream-ng>=1.8,<2" "frozendict>=2.4.6,<3" \
    "netaddr>=1.3,<1.4" "netifaces2>=0.0.22" "pyyaml>=6.0.2,<7" "requests>=2.32.3,<3" "urllib3<3" idna certifi charset-normalizer
.venv-octoprint/bin/octoprint analysis gcode --help >/dev/null
echo "$wanted" >$stamp

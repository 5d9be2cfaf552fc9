#!/usr/bin/env bash
# Install an extra of pyproject.toml that requirements.lock does not hold (docs, fuzz), leaving what it holds as it is.
set -euo pipefail
cd "$(dirname "$0")/.."
.venv/bin/python -c 'import sys, tomllib; print("\n".join(tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"][sys.argv[1]]))' "$1" |
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --only-binary :all: -c requirements.lock -r /dev/stdin

#!/usr/bin/env bash
# Contacts in the two logs of a simulated cube that lie beside this script, as README shows: calibration/scripts/contact.sh [FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."
.venv/bin/skinfab contact calibration/logs/contact_cube_1.csv calibration/logs/contact_cube_2.csv --false-alarms 0.1 -o "${1:-contact_out}"

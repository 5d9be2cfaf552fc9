#!/bin/sh
# Contacts in the two logs of a simulated cube that lie beside this script, as README says: calibration/scripts/contact.sh OUT
set -eu
out=${1:?give a folder to write into}
here=$(dirname "$0")
logs=$here/../logs
"$here/../../.venv/bin/skinfab" contact "$logs/contact_cube_1.csv" "$logs/contact_cube_2.csv" --false-alarms 0.1 -o "$out"

#!/bin/sh
# Calibrate both simulated fingers from their logs, then let the robot's follow the human's, as published and improved.
# As README says: calibration/scripts/control.sh OUT
set -eu
out=${1:?give a folder to write into}
here=$(dirname "$0")
logs=$here/../logs
skinfab() { "$here/../../.venv/bin/skinfab" "$@"; }
for model in poly branches; do
  skinfab calibrate "$logs/human_finger.csv" --signal human_V --angle PIP_deg --range 10 80 --model $model --degree 3 -o "$out/human_$model"
  skinfab calibrate "$logs/robot_finger.csv" --signal robot_V --angle PIP_deg --range 10 80 --model $model --degree 4 -o "$out/robot_$model"
done
skinfab control simulator --human "$out/human_poly/calibration.json" --robot "$out/robot_poly/calibration.json" \
  --controller p --gain 5.1 -o "$out/published"
skinfab control simulator --human "$out/human_branches/calibration.json" --robot "$out/robot_branches/calibration.json" -o "$out/improved"
skinfab control "$logs/human_finger.csv" --human "$out/human_branches/calibration.json" -o "$out/log"

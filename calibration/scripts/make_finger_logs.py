"""Write the logs of the simulated fingers: ``python calibration/scripts/make_finger_logs.py [FOLDER]``.

Without a folder they go beside this script's, into ``calibration/logs``; the same files come out every time.
"""

import sys
from pathlib import Path

from calibration.finger.logs import log_text
from calibration.finger.simulated import HUMAN, ROBOT
from skinfab.files import atomic_write

if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "logs"
    folder.mkdir(parents=True, exist_ok=True)
    for sensor in (HUMAN, ROBOT):
        atomic_write(folder / f"{sensor.name}_finger.csv", log_text(sensor))

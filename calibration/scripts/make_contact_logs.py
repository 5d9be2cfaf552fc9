"""Write two trials of the simulated cube: ``python calibration/scripts/make_contact_logs.py [FOLDER]``.

Without a folder they go beside this script's, into ``calibration/logs``, with the true contacts; the same files come out every time.
"""

import csv
import io
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from calibration.contact.simulator import simulate
from skinfab.files import atomic_write
from skinfab.readout.logs.log import write_log

SEEDS = (1, 2)


def rounded(values: np.ndarray) -> np.ndarray:
    """To the four digits that a converter gives."""
    with np.errstate(invalid="ignore"):
        digits = 10 ** (3 - np.floor(np.log10(np.abs(values))))
        return np.round(values * digits) / digits


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "logs"
    folder.mkdir(parents=True, exist_ok=True)
    for seed in SEEDS:
        trial = simulate("cube", seed=seed)
        write_log(replace(trial.recording, values=rounded(trial.recording.values)), folder / f"contact_cube_{seed}.csv")
        text = io.StringIO()
        rows = csv.writer(text, lineterminator="\n")
        rows.writerow(["channel", "start_s", "end_s", "sign", "strength", "simulated"])
        rows.writerows([c.channel, f"{c.start:.3f}", f"{c.end:.3f}", c.sign, f"{c.strength:.4f}", 1] for c in trial.truth)
        atomic_write(folder / f"contact_cube_{seed}_truth.csv", text.getvalue())

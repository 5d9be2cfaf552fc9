"""Captures that are made for tests: C3D files by ezc3d, and exports as Vicon writes them."""

from pathlib import Path

import ezc3d
import numpy as np

LABELS = ("MCP", "PIP", "DIP")


def positions(frames: int = 200) -> dict[str, np.ndarray]:
    """A finger that bends from 0 to 110 degrees, mm."""
    bent = np.radians(np.linspace(0, 110, frames))
    zero = np.zeros(frames)
    pip = np.stack([40 + zero, 5 + zero, 800 + zero], axis=1)
    dip = pip + 25 * np.stack([np.cos(bent), np.sin(bent), zero], axis=1)
    return {"MCP": pip - [40.0, 0, 0], "PIP": pip, "DIP": dip}


def write_c3d(path: Path, made: dict[str, np.ndarray], *, rate: float = 200.0, unit: str = "mm", scale: float = 1.0) -> None:
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [rate]
    file["parameters"]["POINT"]["UNITS"]["value"] = [unit] if unit else []
    file["parameters"]["POINT"]["LABELS"]["value"] = tuple(made)
    at = np.stack(list(made.values()), axis=0) * scale
    file["data"]["points"] = np.concatenate([at.transpose(2, 0, 1), np.ones((1, *at.shape[:2]))])
    file.write(str(path))


def vicon_text(made: dict[str, np.ndarray], *, delimiter: str = ",", rate: str = "100", unit: str = "mm", residuals: bool = False) -> str:
    width = 4 if residuals else 3
    d = delimiter
    columns = ["X", "Y", "Z"] + ["Residual"] * residuals
    lines = ["Trajectories", rate, d * 2 + d.join(f"Anna:{name}" + d * (width - 1) for name in made)]
    lines += [d.join(["Frame", "Sub Frame", *columns * len(made)]), d.join(["", "", *([unit] * 3 + [""] * residuals) * len(made)])]
    for k in range(len(next(iter(made.values())))):
        cells = [str(k + 1), "0"]
        for each in made.values():
            cells += ["" if np.isnan(value) else f"{value:.6g}" for value in each[k]] + ["0.1"] * residuals
        lines.append(d.join(cells))
    return "\n".join(lines) + "\n"

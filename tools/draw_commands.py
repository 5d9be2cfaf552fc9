"""Draws into docs/pictures what docs/commands.md shows of commands that have no picture elsewhere: `make pictures` runs it.

Flat skin, tool path and strips are files that the commands write; a mould and an angle are drawn of what they write.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np

from skinfab.cli.main import main as skinfab
from skinfab.files import atomic_path
from skinfab.mesh.io import load_mesh
from skinfab.report.object_view import View
from skinfab.report.raster import rasterise

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/pictures"
SUPERSAMPLING = 3


def run(*words: object) -> None:
    if status := skinfab([str(word) for word in words]):
        raise SystemExit(status)


def draw_mould(stl: Path, picture: Path) -> None:
    """The mould from above and the side, shaded by how its faces are turned."""
    from matplotlib.image import imsave

    mesh = load_mesh(stl, units="mm").mesh
    axes = View(-60.0, 40.0).axes()
    seen = mesh.V @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = 720 * SUPERSAMPLING / (high - low)[0]
    shape = (int(scale * (high - low)[1]) + 40, 760 * SUPERSAMPLING)
    shape = (shape[0] - shape[0] % SUPERSAMPLING, shape[1])
    face, _ = rasterise(scale * (seen - (low + high) / 2) + [shape[1] / 2, shape[0] / 2, 0], mesh.F, shape=shape)
    corners = mesh.V[mesh.F]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    light = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
    colours = np.append((0.35 + 0.6 * np.clip(normal @ light, 0, 1))[:, None] * [0.80, 0.87, 0.95], [[1.0, 1.0, 1.0]], axis=0)
    image = colours[face].reshape(shape[0] // SUPERSAMPLING, SUPERSAMPLING, shape[1] // SUPERSAMPLING, SUPERSAMPLING, 3).mean(axis=(1, 3))
    with atomic_path(picture) as path:
        imsave(path, np.round(image * 31) / 31, format="png")  # few greys, a small file


def draw_angle(log: Path, truth: np.ndarray, picture: Path) -> None:
    """What `skinfab angle` makes of simulated markers, and what the paper's arcsine would."""
    from matplotlib.figure import Figure

    from skinfab.readout.table import read_table

    table = read_table(log)
    angle = table.columns["angle_deg"]
    figure = Figure(figsize=(7.2, 2.6), layout="constrained")
    axes = figure.subplots()
    axes.plot(table.time, truth, color="0.6", linewidth=4, label="true")
    axes.plot(table.time, np.degrees(np.arcsin(np.sin(np.radians(angle)))), color="#d55e00", label="by arcsine (eq. 2)")
    axes.plot(table.time, angle, color="#0072b2", label="skinfab angle")
    axes.set(xlabel="time (s)", ylabel="angle (deg)", title="A finger that bends to 110 degrees; markers seen to 0.2 mm (simulated)")
    axes.title.set_fontsize("medium")
    axes.set_ylim(-8, 150)
    axes.legend(loc="upper center", ncols=3, fontsize="small")
    with atomic_path(picture) as path:
        figure.savefig(path, format="png", dpi=110)


def markers(csv: Path) -> np.ndarray:
    """Markers of a bending finger as a Vicon export at 100 Hz, one gap in it; the true angle."""
    rng = np.random.default_rng(0)
    time = np.arange(600) / 100
    angle = 55 - 55 * np.cos(2 * np.pi * time / 3)
    a = np.radians(angle)
    mcp, pip = np.zeros((600, 3)), np.tile([40.0, 0, 0], (600, 1))
    dip = pip + 25 * np.column_stack([np.cos(a), -np.sin(a), 0 * a])
    places = np.hstack([mcp, pip, dip]) + rng.normal(0, 0.2, (600, 9))
    names = "MCP", "PIP", "DIP"
    lines = [
        "Trajectories",
        "100",
        ",," + ",,,".join(f"finger:{name}" for name in names) + ",,",
        "Frame,Sub Frame" + ",X,Y,Z" * 3,
        ",," + "mm," * 8 + "mm",
    ]
    rows = [
        f"{k + 1},0," + ",".join("" if 200 <= k < 230 and j >= 6 else f"{x:.3f}" for j, x in enumerate(row)) for k, row in enumerate(places)
    ]
    csv.write_text("\n".join([*lines, *rows, ""]))
    return angle


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("make", ROOT / "meshes/robot_finger.obj", "-o", folder / "first")
        run("strips", "-o", folder / "strips")
        truth = markers(folder / "finger.csv")
        run("angle", folder / "finger.csv", "--mcp", "MCP", "--pip", "PIP", "--dip", "DIP", "-o", folder / "angle.csv")
        draw_mould(folder / "first/mould/P1.stl", PICTURES / "mould.png")
        draw_angle(folder / "angle.csv", truth, PICTURES / "angle.png")
        for made, picture in (
            ("first/flat.svg", "flat.svg"),
            ("first/toolpath/P1.svg", "toolpath.svg"),
            ("strips/toolpath/P1.svg", "strips.svg"),
        ):
            with atomic_path(PICTURES / picture) as path:
                shutil.copyfile(folder / made, path)


if __name__ == "__main__":
    main()

"""What `skinfab make` wrote, judged from the files alone: nothing here uses the code that made them."""

import json
import math
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import gcodeparser
import jsonschema
import numpy as np
import shapely
import trimesh

OCTOPRINT = Path(__file__).parents[1] / ".venv-octoprint/bin/octoprint"
ALWAYS = (
    "skin.skin",
    "report.json",
    "report.html",
    "flat.svg",
    "flat.dxf",
    "flat.pdf",
    "flat.obj",
    "preview.png",
    "wiring.csv",
    "wrap_strain.svg",
)


def read_report(folder: Path) -> dict:
    """The report, strict: no NaN, and valid by the schema in the package."""

    def refuse(word: str) -> None:
        raise ValueError(f"{word} in report.json")

    report = json.loads((folder / "report.json").read_text(), parse_constant=refuse)
    from skinfab.report.build import report_schema

    jsonschema.Draft202012Validator(report_schema()).validate(report)
    return report


def read_flat_obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """V (n, 3), UV (k, 2), F (m, 3) and FT (m, 3) of an OBJ whose faces are v/vt corners."""
    V, UV, F, FT = [], [], [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or ["#"]
        if word == "v":
            V.append([float(x) for x in rest[:3]])
        elif word == "vt":
            UV.append([float(x) for x in rest[:2]])
        elif word == "f":
            corners = [corner.split("/") for corner in rest]
            F.append([int(c[0]) - 1 for c in corners])
            FT.append([int(c[1]) - 1 for c in corners])
    return np.array(V), np.array(UV), np.array(F), np.array(FT)


def distortion(V: np.ndarray, UV: np.ndarray, F: np.ndarray, FT: np.ndarray) -> tuple[float, int]:
    """Area-weighted mean of d by numpy's SVD, and the number of flipped triangles."""
    p, q = V[F], UV[FT]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    normal = np.cross(e1, e2)
    area = np.linalg.norm(normal, axis=1) / 2
    # A triangle whose height is lost in the digits of the file has no shape to compare.
    real = area > 1e-8 * (e1**2).sum(axis=1)
    x = e1 / np.linalg.norm(e1, axis=1, keepdims=True)
    y = np.cross(normal, x)
    y /= np.maximum(np.linalg.norm(y, axis=1, keepdims=True), 1e-300)
    frame = np.stack([x, y], axis=1)
    rest = np.stack([np.einsum("mij,mj->mi", frame, e) for e in (e1, e2)], axis=2)[real]
    flat = np.stack([q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]], axis=2)[real]
    J = flat @ np.linalg.inv(rest)
    s = np.linalg.svd(J, compute_uv=False)
    d = (1 + (s[:, 0] * s[:, 1]) ** -2.0) * (s**2).sum(axis=1)
    return float(np.average(d, weights=area[real])), int((np.linalg.det(J) <= 0).sum())


def overlap(UV: np.ndarray, FT: np.ndarray) -> float:
    """Part of the flat area that is covered more than once."""
    triangles = shapely.polygons(UV[FT])
    total = float(shapely.area(triangles).sum())
    return 1 - float(shapely.union_all(triangles).area) / total


def arc_faults(text: str) -> tuple[int, list[str]]:
    """How many arcs a G-code text has, and what is wrong with its moves (absolute XY, relative E)."""
    at, faults, arcs = [0.0, 0.0], [], 0
    for number, line in enumerate(text.splitlines(), start=1):
        words = dict(re.findall(r"([A-Z])(-?\d+\.?\d*)", line.split(";")[0]))
        if not re.match(r"G[0123](?!\d)", line):
            continue
        end = [float(words.get("X", at[0])), float(words.get("Y", at[1]))]
        if line.startswith(("G2", "G3")):
            arcs += 1
            centre = [at[0] + float(words["I"]), at[1] + float(words["J"])]
            if abs(math.dist(at, centre) - math.dist(end, centre)) > 0.002:
                faults.append(f"line {number}: the arc's end is not on its circle")
        if "E" in words and ("X" in words or "Y" in words) and not float(words["E"]) > 0:
            faults.append(f"line {number}: E is not positive")
        if not all(0 <= c <= 350 for c in end):
            faults.append(f"line {number}: outside the bed")
        at = end
    modes = re.findall(r"^(G90|G91|M82|M83)\b", text, flags=re.M)
    if modes != ["G90", "M83"]:
        faults.append(f"modes are {modes}")
    return arcs, faults


def octoprint_ink_mm3(file: Path, *, e_per_mm3: float) -> float:
    """The extrusion that OctoPrint finds in a G-code file."""
    run = subprocess.run([OCTOPRINT, "analysis", "gcode", "--g90-extruder", file], capture_output=True, text=True, check=True, timeout=120)
    found = re.search(r"extrusion_length:\n- (\S+)", run.stdout)
    return float(found[1]) / e_per_mm3 if found else 0.0


def gcodeparser_ink_mm3(text: str, *, e_per_mm3: float) -> float:
    """The signed sum of E over the lines that gcodeparser reads."""
    return sum(line.params.get("E", 0.0) for line in gcodeparser.parse_gcode_lines(text)) / e_per_mm3


def cavity_ml(stl: Path, floor: float, depth: float) -> float:
    """Silicone that a mould holds up to `depth` over its floor: the empty space inside its own convex outline there."""
    mesh = trimesh.load(stl)
    assert mesh.is_watertight and mesh.is_winding_consistent
    volume = 0.0
    steps = 5
    for k in range(steps):
        section = mesh.section([0, 0, 1], [0, 0, floor + depth * (k + 0.5) / steps])
        rings = [shapely.Polygon(loop[:, :2]) for loop in section.discrete]
        solid = shapely.Polygon()
        for ring in rings:
            solid = solid.symmetric_difference(ring)
        volume += (shapely.union_all(rings).area - solid.area) * depth / steps
    return volume / 1000


def drawn_arcs(folder: Path) -> tuple[int, int]:
    """True arcs in flat.svg (A commands) and in flat.dxf (bulges and ARCs)."""
    svg = ElementTree.parse(folder / "flat.svg")
    in_svg = sum(len(re.findall(r"[Aa]", path.get("d", ""))) for path in svg.iter("{http://www.w3.org/2000/svg}path"))
    space = ezdxf.readfile(folder / "flat.dxf").modelspace()
    in_dxf = len(space.query("ARC")) + sum(bool(b) for line in space.query("LWPOLYLINE") for *_, b in line.get_points("xyb"))
    return in_svg, in_dxf

"""Whole files for every parser, as small as they can be: what is broken to look for findings."""

from __future__ import annotations

import copy
import io
import json
import tempfile
import zipfile
from functools import cache
from pathlib import Path

import numpy as np

from gcode.printer import load_printer
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import write_log

ROOT = Path(__file__).resolve().parents[2]


@cache
def document() -> bytes:
    from skinfab.cli.main import main

    with tempfile.TemporaryDirectory() as folder:
        document = Path(folder, "cube.skin")
        assert main(["segment", str(ROOT / "meshes/cube.obj"), "-o", str(document)]) == 0
        assert main(["place", str(document)]) == 0
        return document.read_bytes()


def document_texts() -> list[bytes]:
    with zipfile.ZipFile(io.BytesIO(document())) as whole:
        return [whole.read("skin.json")]


def meshes(kind: str) -> list[bytes]:
    import trimesh

    V, F = np.array([[0.0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]]), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    solid = trimesh.Trimesh(V, F, process=False)
    made = [solid.export(file_type=each) for each in ([kind, "stl_ascii"] if kind == "stl" else [kind])]
    if kind == "ply":
        made.append(solid.export(file_type="ply", encoding="ascii"))
    if kind == "obj":
        made.append("v 0 0 0\nv 1 0 0 .5 .5 .5\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 -1 -2\n")
    return [each.encode() if isinstance(each, str) else bytes(each) for each in made]


def programs() -> list[bytes]:
    from gcode.emit import emit
    from gcode.geometry import Curve, Straight
    from gcode.program import Comment, Dwell, Extrude, Prime, Program, Retract, Travel

    steps = (
        *(Comment("sensor C1"), Travel(z=5.0, speed=10.0), Travel(x=20.0, y=20.0, speed=50.0), Prime(1.0, 0.5)),
        *(
            Extrude(Straight((20.0, 20.0), (30.0, 20.0)), 2.0, 5.0),
            Extrude(Curve((30.0, 20.0), (30.0, 30.0), (30.0, 25.0), False), 3.0, 5.0),
        ),
        *(Retract(1.0, 0.5), Dwell(0.5), Travel(z=10.0, speed=10.0)),
    )
    program = Program("P1", steps, None)
    ours = [emit(program, load_printer(name)).encode() for name in ("generic-marlin", "generic-grbl")]
    return [
        *ours,
        b"G28\nG90\nM83\nN1 G1 X10 Y10 E.5 F600*93\nG3 X2 Y0 I1 J0 E0.5 ; arc\nG2 X9 R5\nM3 S100\n(said)\nG92 E0\nG5 I1 J1 P1 Q1 X5\n",
    ]


def profiles() -> list[bytes]:
    return [
        *(file.read_bytes() for file in sorted((ROOT / "gcode/profiles").glob("*.toml"))),
        b'extends = "generic-marlin"\n[bed]\nsize = [100, 100]\n',
    ]


def recording() -> Recording:
    values = np.array([[0.5, 1.5], [np.nan, 2.5], [0.75, 1e9]])
    return Recording.of_values(Stream("two", (Channel("a", "V"), Channel("b", "rad")), 100.0), values, device_time=np.arange(3) / 100)


def wire() -> list[bytes]:
    from skinfab.readout.packets import Layout

    made = recording()
    layout = Layout(made.stream)
    packets = layout.description + b"".join(layout.frame_packet(frame) for frame in made) + b"hurt\0"
    return [
        packets,
        b"\nsequence,time_ms,S1,S2\n7,20,1.5,nan\n8,30,1.5,2\n",
        b"\n1,2\n1,3\n1,4\n2,5\n# said\n",
        b"\n1,5;2,5\n1,6;2\n1;2\n1;3\n",
    ]


@cache
def logs(name: str) -> list[bytes]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        write_log(recording(), path)
        return [(next(path.glob("*.db3")) if path.is_dir() else path).read_bytes()]


def tables() -> list[bytes]:
    return [
        *logs("a.csv"),
        b"time_ms,S1,angle [deg]\n0,1.5,0\n10,1.25,\n20,1.0,30\n",
        b"# simulated: true\ntimestamp;S1 (V);b\n2026-01-31 12:00:00.000;1,5;x\n2026-01-31 12:00:00.010;1,25;y\n",
        b'time\t"a\tb"\n0\t1\n1\t2\n',
    ]


def captures() -> list[bytes]:
    head = "Trajectories\n100\n,,hand:MCP,,,hand:PIP,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n"
    cut = head + "1,0,1.5,2,3,4,5,6\n2,0,1.25"
    return [
        (head + "1,0,1,2,3,4,5,6\n2,0,1,2,3,,,\n").encode(),
        cut.replace(",", ";").replace(".", ",").encode(),
    ]


@cache
def c3d() -> list[bytes]:
    import ezc3d

    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["POINT"]["LABELS"]["value"] = ("MCP", "PIP")
    file["data"]["points"] = np.arange(24.0).reshape(4, 2, 3) + 1
    analog = copy.deepcopy(file)
    analog["parameters"]["ANALOG"]["RATE"]["value"] = [200.0]
    analog["parameters"]["ANALOG"]["LABELS"]["value"] = ("force",)
    analog["data"]["analogs"] = np.ones((1, 1, 6))
    with tempfile.TemporaryDirectory() as folder:
        for each, name in ((file, "a.c3d"), (analog, "b.c3d")):
            each.write(str(Path(folder, name)))
        return [Path(folder, name).read_bytes() for name in ("a.c3d", "b.c3d")]


def calibrations() -> list[bytes]:
    from calibration.finger.logs import calibrated
    from calibration.finger.simulated import HUMAN
    from calibration.strain.document import save_calibration

    with tempfile.TemporaryDirectory() as folder:
        files = []
        for model in ("poly", "branches", "play", "lag"):
            save_calibration(calibrated(HUMAN, model), path := Path(folder, f"{model}.json"))
            files.append(path.read_bytes())
        return files


def models() -> list[bytes]:
    from skinfab.fingertip.saved import save_model

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a.model")
        save_model(path, kind="nail", version=1, facts={"simulated": True}, arrays={"w": np.eye(2), "k": np.arange(3)})
        return [path.read_bytes()]


def sensor_files() -> list[bytes]:
    spiral = b'[[sensor]]\nkind = "contact-spiral"\nparams = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }\n'
    return [
        b'[auto]\nkinds = ["contact-spiral"]\nsizes = [22, 15]\nper_piece = 2\n',
        spiral + b'pose = { piece = "P1", x = 12.5, y = 20.0, angle_deg = 90 }\nid = "S1"\nchannel = 7\n',
        spiral + b"pose = { point = [4.0, 0, 1] }\n",
        b'[[sensor]]\nkind = "strain-lines"\nparams = { l1 = 60, l2 = 54, b = 6 }\n'
        b"pose = { joint = [45.0, 0.0, 0.0], along = [1, 0, 0], facing = [0, 0, 1] }\n",
    ]


def plans() -> list[bytes]:
    meshes = str(ROOT / "meshes/cube.obj").encode()
    return [
        b'meshes = ["' + meshes + b'"]\n[settings]\npieces = ["usual", "fewest"]\nmax-distortion = [4.05, 4.1]\n[limits]\ntime_s = 600\n'
    ]


def records() -> list[bytes]:
    """Of a job that was made, and of one that nobody could do."""
    lost: dict[str, object] = {
        **{"job": "n", "mesh": "/a.obj", "settings": {"pieces": "fewest"}, "limits": {"time_s": 60, "memory_mb": None}},
        **{"skinfab": "1.0", "host": "a", "status": "lost", "message": "3 workers died", "attempts": 3},
    }
    figures = {"n_faces": 12, "n_pieces": 2, "d_mean": 4.01, "d_p99": 4.2, "seam_mm": 50.0}
    made = {**lost, "wall_s": 1.5, "cpu_s": 1.4, "peak_mb": 250.0, "status": "made", "message": "", "figures": figures}
    return [json.dumps(each).encode() for each in (made, lost)]


def strip_tables() -> list[bytes]:
    return [b"sensor,length_mm,r_kohm\nL1,30,12.5\nL2,60,\nL3,90,38\n", b"length_mm;r_kohm\n30,5;12,5\n60;25\n"]


def wirings() -> list[bytes]:
    head = b"wire,sensor,kind,piece,terminal,lead,x_mm,y_mm,channel,board,board_input,unit,low,median,high\n"
    return [
        head
        + b"".join(
            b"C1-%d,C1,contact-spiral,P1,%d,%s,2,3,17,2,1,kohm,49,154,487\n" % (k, k, lead) for k, lead in ((1, b"signal"), (2, b"return"))
        )
    ]


def documents() -> list[bytes]:
    return [document()]


def materials() -> list[bytes]:
    return [(ROOT / "skinfab/materials/carbon-grease-ecoflex.toml").read_bytes()]


def cuts() -> list[bytes]:
    return [b"12 87 14 # one\n3, 4, 5\n"]


def pictures() -> list[bytes]:
    import cv2

    grey = np.arange(48, dtype=np.uint8).reshape(6, 8)
    return [cv2.imencode(kind, grey)[1].tobytes() for kind in (".png", ".jpg", ".bmp", ".tif", ".pgm")]


def picture(name: str) -> bytes:
    """Two that are not alike."""
    return pictures()[["one", "two"].index(name)]


def targets() -> list[bytes]:
    return [
        b"image,offset_mm,angle_deg,depth_mm,group\none.png,1.5,30,.5,a\ntwo.png,-2,-45,1,b\n",
        b"sep=;\nimage;offset_mm;angle_deg\none.png;1,5;30\n",
    ]


def nail_labels() -> list[bytes]:
    from skinfab.fingertip.nail.labels import Label, write_labels

    with tempfile.TemporaryDirectory() as folder:
        write_labels(
            path := Path(folder, "a.csv"), [Label("a.csv", 0.5, 2.0, "edge", x_mm=1.5), Label("b.csv", 0, 1, "none")], simulated=True
        )
        return [path.read_bytes(), b"log;start_s;label;end_s\na.csv;0,5;edge;\n"]


def events() -> list[bytes]:
    return [b"log,kind,start_s,end_s,told_s,simulated\na.csv,rolling,1.000,2.000,1.100,1\nb.csv,separation,0,1,,0\n"]


def places() -> list[bytes]:
    return [b"log,x_mm,y_mm,z_mm\na.csv,1,2.5,-3\nb.csv,0,0,1e1\n"]


def force_labels() -> list[bytes]:
    return [b'# by hand\nlog;label;group\na.csv;felt;1\nb.csv;"wool; raw";2\n']


@cache
def fingertips() -> dict[str, bytes]:
    """The smallest models of each kind."""
    from skinfab.fingertip.array.geometry import Geometry
    from skinfab.fingertip.array.learn import KIND as ARRAY
    from skinfab.fingertip.array.learn import save_array
    from skinfab.fingertip.array.matched import ArrayModel
    from skinfab.fingertip.array.simulator import Rubber
    from skinfab.fingertip.force.shape import KIND as SHAPE
    from skinfab.fingertip.force.shape import SHAPES, VERSION
    from skinfab.fingertip.force.texture_model import FEATURES
    from skinfab.fingertip.saved import save_model

    rng = np.random.default_rng(1)
    ones, bands, made = np.ones, len(FEATURES["bands"][1]), {"simulated": True, "made_from": []}
    liquid = {"false_alarm": 0.05, "seconds": 4.0, "rate_hz": 100.0, "pieces": 3, **made}
    texture = {"features": "bands", "n_fft": 256, "rate_hz": 500.0, "names": ["felt", "silk"], **made}
    texture["lengths"] = [{"samples": 256, "far": 9.5, "right": 0.9}]
    nail = {"names": ["none", "edge", "dot"], "rate_hz": 1000.0, "drive_hz": 200.0, "shrinkage": 0.1, "temperature": 1.0, "made_from": {}}
    optical = {"shape": [48, 64], "level": 128, "gamma": 0.5, "ridge": 0.1, "made_from": {}}
    trials = {"drive_real": (4, 6), "drive_imag": (4, 6), "noise": (6,), "targets": (4, 5)}
    edge = {"rest": (12, 2), "mean": (24,), "basis": (24, 2), "support": (5, 2), "weights": (5, 3), "centre": (3,), "spacing": (5,)}
    models = {
        "force contact": ({"surface": "fingertip", **made}, {"matrix": np.eye(6), "spread": np.eye(36), "noise": ones(2)}),
        "force hand": ({"weighings": 4, **made}, {"offset": ones(6), "weight": ones(1), "moment": ones(3), "covariance": np.eye(10)}),
        "force texture": (texture, {"centre": ones(bands), "scale": ones(bands), "means": ones((2, bands)), "precision": np.eye(bands)}),
        SHAPE: (
            {"features": "pose-free", "shapes": list(SHAPES), "misfit_limit": 2.5, **made},
            {"mean": ones(2), "scale": ones(2), "hidden": ones((3, 4)), "output": ones((5, len(SHAPES)))},
        ),
        "force liquid": (liquid, {"limit": ones(1) / 2}),
        "nail phasors": (
            nail,
            {name: rng.normal(size=shape) for name, shape in trials.items()}
            | {"classes": np.array([0, 1, 2, 1]), "channels": ones(6, dtype=int), "targets_known": ones((4, 5), dtype=int)},
        ),
        "optical edge": (optical, {name: ones(shape) for name, shape in edge.items()} | {"wrong": ones(5) / 2, "usual": ones(3)}),
    }
    files = {}
    with tempfile.TemporaryDirectory() as folder:
        for kind, (facts, arrays) in models.items():
            save_model(path := Path(folder, "a.model"), kind=kind, version=VERSION if kind == SHAPE else 1, facts=facts, arrays=arrays)
            files[kind] = path.read_bytes()
        geometry = Geometry()
        save_array(path, ArrayModel(geometry, Rubber(), ones(geometry.shape)), made)
        files[ARRAY] = path.read_bytes()
    return files


def fingertip_texts() -> list[bytes]:
    texts = []
    for file in fingertips().values():
        with zipfile.ZipFile(io.BytesIO(file)) as whole:
            texts.append(whole.read("model.json"))
    return texts

"""Build the source distribution and the wheel, and use the wheel where the source tree is out of reach (`make package`).

Built is a copy, so that nothing is left in the tree; the wheel is made from the unpacked source distribution, as an installer
makes it. `package.py FOLDER --clean` installs it, and from a package index the dependencies that it names itself, into an environment where
nothing else is; without it the environment takes all other packages from the one that runs this, which needs no network.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("skinfab", "gcode", "gui", "calibration")

#: Not of the project, or not of what is packed: `calibration` is shown on logs that nobody who installed it asked for.
LEFT_OUT = ("calibration/scripts/", "calibration/logs/")
NOT_COPIED = (
    ".git",
    ".venv*",
    ".*_cache",
    ".hypothesis",
    ".rs274",
    ".fuzz",
    "__pycache__",
    "*.egg-info",
    "build",
    "dist",
    "demo_out",
    "site",
)


def main(folder: str = "dist", *options: str) -> None:
    """Build both into `folder`, and try the wheel."""
    made = Path(folder).resolve()
    made.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        source, wheel = build(Path(scratch, "build"), made)
        check_contents(source, wheel)
        smoke(wheel, Path(scratch, "use"), clean="--clean" in options)
    sys.stdout.write(f"package: {source} and {wheel.name}; the wheel works outside the source tree\n")


def build(scratch: Path, made: Path) -> tuple[Path, Path]:
    """The source distribution, and the wheel made of it."""
    copy = scratch / "copy"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*NOT_COPIED))
    source = made / _hook("build_sdist", copy, made)
    with tarfile.open(source) as packed:
        packed.extractall(scratch, filter="data")
    return source, made / _hook("build_wheel", scratch / source.name.removesuffix(".tar.gz"), made)


def _hook(name: str, tree: Path, made: Path) -> str:
    """Ask the build backend (PEP 517) for a file; its name."""
    code = f"import sys; from setuptools import build_meta; print(build_meta.{name}(sys.argv[1]), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code, str(made)], cwd=tree, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"package: {name} failed: {done.stderr[-2000:]}")
    return done.stderr.split()[-1]


def check_contents(source: Path, wheel: Path) -> None:
    """Every file of the four packages is in both, and nothing but them in the wheel."""
    tree = {str(p.relative_to(ROOT)) for name in PACKAGES for p in (ROOT / name).rglob("*") if p.is_file() and "__pycache__" not in p.parts}
    with tarfile.open(source) as packed:
        there = {name.partition("/")[2] for name in packed.getnames()}
    if missing := sorted(tree - there):
        sys.exit(f"package: {source.name} lacks {', '.join(missing)}; name them in MANIFEST.in")
    with zipfile.ZipFile(wheel) as unpacked:
        held = {name for name in unpacked.namelist() if ".dist-info/" not in name}
    wanted = {name for name in tree if not name.startswith(LEFT_OUT)}
    if held != wanted:
        sys.exit(
            f"package: {wheel.name} differs from the tree in {', '.join(sorted(held ^ wanted))}; see [tool.setuptools] in pyproject.toml"
        )


def smoke(wheel: Path, scratch: Path, *, clean: bool) -> None:
    """Install the wheel and do the main job with it, in a folder with nothing of the project but one mesh."""
    venv.create(scratch / "env")
    env = scratch / "env" / ("Scripts" if os.name == "nt" else "bin")
    pip = [sys.executable, "-m", "pip", "--python", str(env / "python")]
    if clean:
        _run([*pip, "install", "--quiet", "--only-binary", ":all:", str(wheel)], scratch)
        _run([*pip, "check"], scratch)
    else:
        site = Path(sysconfig.get_path("purelib", vars={"base": str(scratch / "env")}))
        # As a mere folder on the path: the .pth files in it, of which one names the source tree, are not followed.
        (site / "all_others.pth").write_text(sysconfig.get_path("purelib") + "\n")
        _run([*pip, "install", "--quiet", "--no-deps", "--no-index", "--no-compile", str(wheel)], scratch)
    where = _run(
        [str(env / "python"), "-c", f"import {', '.join(PACKAGES)}; print({'.__file__, '.join(PACKAGES)}.__file__, sep='\\n')"], scratch
    )
    if any(not line.startswith(str(scratch)) for line in where.split()):
        sys.exit(f"package: the source tree was used, not the wheel: {where}")
    shutil.copy(ROOT / "meshes/cube.obj", scratch)
    skinfab = str(env / "skinfab")
    if "usage: skinfab" not in _run([skinfab, "--help"], scratch):
        sys.exit("package: skinfab --help says nothing")
    _run([skinfab, "make", "cube.obj", "-o", "out"], scratch)
    programs = sorted((scratch / "out/gcode").glob("*.gcode"))
    if not programs or not (scratch / "out/report.html").is_file():
        sys.exit("package: skinfab make wrote no G-code or no report")
    _run([skinfab, "gcode", "check", str(programs[0])], scratch)


def _run(command: list[str], folder: Path) -> str:
    # Compiling for a cube takes longer than all the rest, and every test of the project does it.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"package: {' '.join(command[-5:])} failed: {(done.stderr or done.stdout)[-2000:]}")
    return done.stdout


if __name__ == "__main__":
    main(*sys.argv[1:])

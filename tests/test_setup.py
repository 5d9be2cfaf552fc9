"""`make setup` says what is missing, and does nothing when nothing is."""

import hashlib
import re
import shutil
import subprocess
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ("requirements.lock", "pyproject.toml", "tools/setup.sh")
TOOLS = ("bash", "cat", "cut", "dirname", "sha256sum", "env")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A copy of what set-up reads, and a machine with nothing on it but the tools named above, used by somebody who is not root."""
    for name in SOURCES:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy2(ROOT / name, tmp_path / name)
    (tmp_path / "bin").mkdir()
    for tool in TOOLS:
        (tmp_path / "bin" / tool).symlink_to(str(shutil.which(tool)))
    fake(tmp_path, "id", "echo 1000")
    return tmp_path


def fake(checkout: Path, name: str, script: str) -> None:
    path = checkout / "bin" / name
    path.write_text(f"#!{shutil.which('bash')}\n{script}\n")
    path.chmod(0o755)


def setup(checkout: Path) -> subprocess.CompletedProcess[str]:
    environment = {"PATH": str(checkout / "bin"), "HOME": str(checkout)}
    return subprocess.run([str(checkout / "tools/setup.sh")], env=environment, capture_output=True, text=True, timeout=60)


def test_nothing_to_do_when_all_is_there(checkout: Path) -> None:
    stamp = hashlib.sha256(b"".join((checkout / name).read_bytes() for name in SOURCES)).hexdigest()
    (checkout / ".venv/bin").mkdir(parents=True)
    (checkout / ".venv/bin/skinfab").write_text("#!/bin/sh\n")
    (checkout / ".venv/bin/skinfab").chmod(0o755)
    (checkout / ".venv/.stamp").write_text(stamp + "\n")
    assert setup(checkout).returncode == 0 and setup(checkout).stdout == ""
    (checkout / "requirements.lock").write_text("numpy==2.0.0\n")  # now there is something to do, and no Python to do it with
    assert setup(checkout).returncode == 1


def test_without_python_it_says_what_to_install(checkout: Path) -> None:
    said = setup(checkout)
    assert said.returncode == 1 and "sudo apt-get install python3 python3-venv" in said.stderr and "Python 3.11 or later" in said.stderr


def test_python_too_old_is_no_python(checkout: Path) -> None:
    fake(checkout, "python3", "exit 1")
    assert "Python 3.11 or later is needed" in setup(checkout).stderr


def test_without_venv_it_says_what_to_install(checkout: Path) -> None:
    fake(checkout, "python3", 'case "$*" in *ensurepip*) exit 1;; *) exit 0;; esac')
    said = setup(checkout)
    assert said.returncode == 1 and "sudo apt-get install python3-venv" in said.stderr and not (checkout / ".venv/.stamp").exists()


def test_root_installs_what_is_missing(checkout: Path) -> None:
    fake(checkout, "id", "echo 0")
    fake(checkout, "apt-get", f'echo "$*" >>{checkout}/apt.log')
    setup(checkout)
    assert "install -y -qq --no-install-recommends python3 python3-venv" in (checkout / "apt.log").read_text()


def locked() -> dict[str, str]:
    lines = (ROOT / "requirements.lock").read_text().splitlines()
    return dict(line.split("==") for line in lines if not line.startswith("#"))


def test_lock_holds_every_dependency_within_its_bound() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    wanted = [
        *project["build-system"]["requires"],
        *project["project"]["dependencies"],
        *project["project"]["optional-dependencies"]["dev"],
    ]
    for requirement in wanted:
        name, _, bound = requirement.partition(">=")
        pinned = locked()[re.sub(r"[-_.]+", "-", name).lower()]
        numbers = [[int(n) for n in re.findall(r"\d+", v)[:3]] for v in (pinned, bound)]
        assert numbers[0] >= numbers[1], requirement


def test_lock_is_what_is_installed() -> None:
    assert {name: version(name) for name in locked()} == locked()

"""The set-up of a verifier says what is missing, leaves nothing half made, and does nothing when all is there."""

import hashlib
import shutil
import subprocess
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """The script alone, on a machine with nothing but a few tools."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "bin").mkdir()
    shutil.copy2(TESTS / "setup_rs274.sh", tmp_path / "tests")
    for tool in ("bash", "env", "dirname", "sha256sum", "cat", "rm", "mkdir"):
        (tmp_path / "bin" / tool).symlink_to(str(shutil.which(tool)))
    return tmp_path


def run(checkout: Path) -> subprocess.CompletedProcess[str]:
    script = checkout / "tests/setup_rs274.sh"
    return subprocess.run([str(script)], env={"PATH": str(checkout / "bin")}, capture_output=True, text=True, timeout=60)


def test_without_debians_tools_it_says_so(checkout: Path) -> None:
    said = run(checkout)
    assert said.returncode == 1 and "is taken from a Debian package, and there is no apt-get here" in said.stderr
    assert not (checkout / ".rs274").exists()


def test_what_is_there_is_left_alone(checkout: Path) -> None:
    (checkout / ".rs274").mkdir()
    digest = hashlib.sha256((checkout / "tests/setup_rs274.sh").read_bytes()).hexdigest()
    (checkout / ".rs274/.stamp").write_text(f"{digest}  -\n")
    assert run(checkout).returncode == 0 and run(checkout).stderr == ""


@pytest.mark.parametrize("script", sorted(TESTS.glob("setup_*.sh")), ids=lambda path: path.stem)
def test_no_script_names_where_packages_come_from(script: Path) -> None:
    assert "://" not in script.read_text()

"""The wheel of this tree installs and does the main job with the source tree out of reach."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def test_the_wheel_works_outside_the_source_tree(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, str(ROOT / "tools/package.py"), str(tmp_path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "the wheel works outside the source tree" in done.stdout
    assert sorted(p.suffix for p in tmp_path.iterdir()) == [".gz", ".whl"]

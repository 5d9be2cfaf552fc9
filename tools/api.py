"""Build the API reference into a folder from the docstrings, any warning being an error (`make docs`); nothing of the project is run.

A page for each package, its modules below one another; what begins with an underscore is left out.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("skinfab", "gcode", "calibration", "gui")

CONFIG = """
site_name: skinfab, from Python
docs_dir: {docs}
site_dir: {site}
theme: {{name: mkdocs}}
plugins:
  - search
  - mkdocstrings:
      handlers:
        python:
          paths: [{root}]
          options:
            docstring_style: numpy
            docstring_options: {{warn_unknown_params: true, warn_missing_types: false}}
            filters: ["!^_"]
            heading_level: 2
            members_order: source
            separate_signature: true
            show_root_heading: true
            show_root_full_path: true
            show_signature_annotations: true
            show_source: false
            show_submodules: false
"""

INDEX = """# skinfab, from Python

Arrays mean the same thing everywhere: `V` is (n, 3) float64 mm, `F` is (m, 3) int64, `UV` is (k, 2) float64 mm. Whatever
cannot be used raises `skinfab.errors.InputError`, whatever fails its own checks `skinfab.errors.RefusedError`, each with one
sentence. The packages, and what may import what: gui, then gcode and calibration, then skinfab.

"""


def main(site: str = "site") -> None:
    """Write the reference."""
    with tempfile.TemporaryDirectory() as scratch:
        docs = Path(scratch, "docs")
        docs.mkdir()
        listed = []
        for name, modules in pages():
            (docs / f"{name}.md").write_text(f"# {name}\n\n" + "\n\n".join(f"::: {module}" for module in modules) + "\n", encoding="utf-8")
            listed.append(f"* [`{name}`]({name}.md)")
        (docs / "index.md").write_text(INDEX + "\n".join(listed) + "\n", encoding="utf-8")
        config = Path(scratch, "mkdocs.yml")
        config.write_text(CONFIG.format(docs=docs, site=Path(site).resolve(), root=ROOT), encoding="utf-8")
        sys.exit(
            subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "-f", str(config)], check=False).returncode
        )


def pages() -> Iterator[tuple[str, list[str]]]:
    """Each package and its modules, by their full names."""
    for top in PACKAGES:
        for start in sorted((ROOT / top).rglob("__init__.py")):
            name = ".".join(start.parent.relative_to(ROOT).parts)
            files = sorted(p for p in start.parent.glob("*.py") if not p.name.startswith("_"))
            yield name, [name, *(f"{name}.{p.stem}" for p in files)]


if __name__ == "__main__":
    main(*sys.argv[1:])

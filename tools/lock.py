"""Write requirements.lock: this environment's versions of all that pyproject.toml asks for, and of what those need.

Run it with the environment's own Python (`make lock`) after changing dependencies.
"""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def normalised(name: str) -> str:
    """The one spelling of a package's name."""
    return re.sub(r"[-_.]+", "-", name).lower()


def wanted(requirement: str) -> str | None:
    """Name of a requirement, or None where it is of an extra nobody asked for."""
    if "extra ==" in requirement:
        return None
    match = re.match(r"[A-Za-z0-9._-]+", requirement)
    return match.group() if match else None


def closure(roots: list[str]) -> dict[str, str]:
    """Version of each installed package reached from `roots`, by name."""
    versions: dict[str, str] = {}
    queue = [name for r in roots if (name := wanted(r))]
    while queue:
        name = normalised(queue.pop())
        if name in versions:
            continue
        try:
            found = distribution(name)
        except PackageNotFoundError:
            continue  # for another system or an older Python; a root that is missing shows when the lock is installed
        versions[name] = found.version
        queue += [n for r in found.requires or [] if (n := wanted(r))]
    return versions


def main() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    roots = [*project["build-system"]["requires"], *project["project"]["dependencies"], *project["project"]["optional-dependencies"]["dev"]]
    lines = [f"{name}=={version}" for name, version in sorted(closure(roots).items())]
    header = "# Runtime, test and build packages; made by `make lock`, installed by `make setup`. Wheels only.\n"
    (ROOT / "requirements.lock").write_text(header + "\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

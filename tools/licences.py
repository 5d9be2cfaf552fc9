"""Write docs/licences.md: the licence of every package in requirements.lock, as the installed package itself states it (`make lock`)."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import Distribution, distribution
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: Packages whose metadata name no licence, or none by its name: read in the file that they bring along.
READ = {
    "apsw": "Zlib",
    "cvxopt": "GPL-3.0-or-later",
    "cycler": "BSD-3-Clause",
    "ezc3d": "MIT",
    "kiwisolver": "BSD-3-Clause",
    "matplotlib": "PSF-based (matplotlib)",
    "xatlas": "MIT",
}

#: The short names that metadata of older packages write in words.
SHORT = {
    "mit license": "MIT",
    "bsd license": "BSD",
    "apache software license": "Apache-2.0",
    "apache 2.0": "Apache-2.0",
    "mozilla public license 2.0 (mpl 2.0)": "MPL-2.0",
    "python software foundation license": "PSF-2.0",
    "gpl-3.0": "GPL-3.0",
    "gpl3": "GPL-3.0",
    "2-clause bsd": "BSD-2-Clause",
}

HEAD = """# Licences

skinfab is GPL-3.0-or-later: pymeshlab, cvxopt and pingouin are under the GPL, and whoever passes skinfab on together with them
has to keep to it. All others below may be combined with it. This page is made by `make lock` from what the installed packages
state themselves; a test holds it against `requirements.lock`. "Needed" is what a user's installation brings; "development" is
what tests and linters bring beyond that.

"""


def locked() -> dict[str, str]:
    """Version by name."""
    lines = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()
    return dict(line.split("==") for line in lines if not line.startswith("#"))


def licence(name: str) -> str:
    """A package's licence, by its short name.

    Raises
    ------
    LookupError
        Its metadata name none, and `READ` does not either.
    """
    if name in READ:
        return READ[name]
    data = distribution(name).metadata
    stated = [data.get("License-Expression"), data.get("License")]
    stated += [each.rpartition(" :: ")[2] for each in data.get_all("Classifier") or [] if each.startswith("License :: ")]
    for text in stated:
        if text and len(text) < 80 and "\n" not in text and text != "OSI Approved":
            return SHORT.get(text.lower(), text)
    raise LookupError(f"the metadata of {name} name no licence; read the file that it brings along and add it to READ in tools/licences.py")


def homepage(found: Distribution) -> str:
    """Where a package is at home, if it says so."""
    urls = dict(each.split(", ", 1) for each in found.metadata.get_all("Project-URL") or [])
    ranked = {key.lower(): url for key, url in urls.items()}
    return found.metadata.get("Home-page") or next(
        (ranked[key] for key in ("homepage", "home", "source", "repository") if key in ranked), ""
    )


def needed() -> set[str]:
    """Names of what a user's installation brings."""
    from lock import closure

    return set(closure(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]))


def table() -> str:
    """The page."""
    run, rows = needed(), []
    for name, version in locked().items():
        url = homepage(distribution(name))
        named = f"[{name}]({url})" if re.match(r"https?://", url) else name
        rows.append(f"| {named} | {version} | {licence(name)} | {'needed' if name in run else 'development'} |")
    return HEAD + "\n".join(["| package | version | licence | for |", "|---|---|---|---|", *rows]) + "\n"


if __name__ == "__main__":
    (ROOT / "docs/licences.md").write_text(table(), encoding="utf-8")

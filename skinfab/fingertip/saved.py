"""A fitted model as a file: plain arrays and JSON in one zip, which reading can only copy and never execute.

The suffix is ``.npz`` by custom: numpy opens the arrays, any zip tool the JSON.
"""

from __future__ import annotations

import json
import math
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.archive import Archive, write_archive
from skinfab.errors import InputError
from skinfab.files import atomic_path

#: The JSON member, and what the file is called in messages.
_HEAD, _WHAT = "model.json", "a model of a fingertip"
#: No model has more: a thousand support vectors of a thousand features are 8 MB.
MAX_NUMBERS = 100_000_000


@dataclass(frozen=True, eq=False)
class Saved:
    """What a model file holds.

    Parameters
    ----------
    kind : str
        What it is a model of: ``nail phasors``, ``force texture``, ...
    version : int
        Of the kind's schema.
    facts : mapping
        What is no array: names, units, where it was learned from, how good it was.
    arrays : mapping of str to array of float64 or int64
    """

    kind: str
    version: int
    facts: Mapping[str, Any]
    arrays: Mapping[str, NDArray[Any]]


def save_model(
    path: str | Path,
    *,
    kind: str,
    facts: Mapping[str, Any],
    arrays: Mapping[str, NDArray[np.float64] | NDArray[np.int64]],
    version: int = 1,
) -> None:
    """Write a model, whole or not at all; the same model gives the same bytes.

    Parameters
    ----------
    path : path
    kind : str
    facts : mapping
        Must be JSON: no NaN, no infinity.
    arrays : mapping of str to array
        Of float or int, finite, of any shape.
    version : int
        From 1; raise it when an older program could misread what is written.

    Raises
    ------
    InputError
        The file cannot be written.
    RefusedError
        An array holds NaN or infinity.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "model.npz"
    >>> save_model(path, kind="demo", facts={"names": ["a", "b"]}, arrays={"mean": np.zeros((2, 3))})
    >>> loaded = load_model(path, kind="demo")
    >>> loaded.facts["names"], loaded.arrays["mean"].shape
    (['a', 'b'], (2, 3))
    """
    shapes = {name: [_dtype(array), *array.shape] for name, array in arrays.items()}
    head = {"kind": kind, "version": version, "arrays": shapes, "facts": dict(facts)}
    with atomic_path(path) as partial:
        write_archive(partial, text={_HEAD: json.dumps(head, indent=1, allow_nan=False) + "\n"}, arrays=arrays)


def _dtype(array: NDArray[Any]) -> str:
    return "<f8" if np.issubdtype(array.dtype, np.floating) else "<i8"


def load_model(path: str | Path, *, kind: str | tuple[str, ...], version: int = 1) -> Saved:
    """Read a model of this kind (or of one of these).

    Parameters
    ----------
    path : path
    kind : str or tuple of str
    version : int
        The newest that is understood.

    Raises
    ------
    InputError
        There is no such file, it is no model, it is of another kind or of a later version, or it is cut off, damaged or pickled.
    """
    path = Path(path)
    again = "train it again, or take another copy"
    try:
        with Archive(path, head=_HEAD, what=_WHAT) as archive:
            return _read(archive, (kind,) if isinstance(kind, str) else kind, version)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; give a model that the train command has written") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a folder; give the model's file") from None
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a model that can be read") from fault
    except zipfile.BadZipFile as fault:
        if _pickled(path):
            raise InputError(f"{path} is a pickle, which could run anything when it is read; train the model again with skinfab") from None
        raise InputError(f"{path} is not a whole model ({fault}); {again}") from None
    except InputError as fault:
        raise InputError(f"{path}: {fault}; {again}") from fault


def _pickled(path: Path) -> bool:
    with path.open("rb") as file:
        head = file.read(2)
    return head[:1] == b"\x80" and head[1:] in (b"\x02", b"\x03", b"\x04", b"\x05")


def _read(archive: Archive, kinds: tuple[str, ...], newest: int) -> Saved:
    head = archive.json(_HEAD)
    try:
        kind, version, facts = head["kind"], head["version"], head["facts"]
        shapes = {str(name): (str(each[0]), tuple(int(n) for n in each[1:])) for name, each in head["arrays"].items()}
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as fault:
        raise InputError(f"{_HEAD} is not one of a model ({type(fault).__name__}: {fault})") from fault
    if kind not in kinds:
        raise InputError(f"it is a model of another kind, {kind!r}, and {' or '.join(map(repr, kinds))} is wanted")
    if not isinstance(version, int) or isinstance(version, bool) or version < 1 or not isinstance(facts, dict):
        raise InputError(f"{_HEAD} is not one of a model: its version is {version!r}")
    if version > newest:
        raise InputError(f"it was made by a later skinfab (version {version}; {newest} is understood): update skinfab")
    arrays = {}
    for name, (dtype, shape) in shapes.items():
        if dtype not in ("<f8", "<i8"):
            raise InputError(f"{name} is said to be of dtype {dtype!r}; only plain numbers are read")
        if math.prod(float(n) for n in shape) > MAX_NUMBERS:
            raise InputError(f"{name} is said to have shape {shape}; no model is that large")
        arrays[name] = archive.array(name, dtype, shape)
    return Saved(kind, version, facts, arrays)

"""The methods that flatten one disk, with holes or without, by name: to add one, add one entry.

An entry is ``module:function``; the function takes V (n, 3) and F (m, 3) of one component of genus 0 with a
boundary, and F's topology where it is at hand, and returns UV (n, 2) in mm. Modules are imported when asked for,
so that a fast method does not wait for another's library.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Protocol

from skinfab.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from skinfab.mesh.topology import Topology


class Flatten(Protocol):
    """What every method looks like."""

    def __call__(self, V: NDArray[np.float64], F: NDArray[np.int64], *, topology: Topology | None = None) -> NDArray[np.float64]: ...


METHODS = {
    "bff": "skinfab.flatten.holes:flatten_filled",
    "isometric": "skinfab.flatten.holes:flatten_least",
    "bijective": "skinfab.flatten.holes:flatten_apart",
    "lscm": "skinfab.flatten.classic:lscm",
    "harmonic": "skinfab.flatten.classic:harmonic",
    "arap": "skinfab.flatten.classic:arap",
    "slim": "skinfab.flatten.classic:slim",
}


def method(name: str) -> Flatten:
    """The function that flattens by the method of that name.

    Raises
    ------
    InputError
        No such method.

    Examples
    --------
    >>> method("isometric").__name__
    'flatten_least'
    """
    if name not in METHODS:
        raise InputError(f"no flattening method {name!r}; there are {', '.join(METHODS)}")
    module, function = METHODS[name].split(":")
    found: Flatten = getattr(import_module(module), function)
    return found

"""Surfaces with holes, laid flat as disks: the holes are filled for the solve, and empty again after it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff import BffSolver
from skinfab.flatten.distortion import best_scale
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def fill_holes(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> tuple[FloatArray, IntArray]:
    """The mesh with a fan about a new vertex in every boundary loop but the longest (mm), which stays the border.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component.
    topology : Topology, optional
        Of `F`, where it is at hand.

    Returns
    -------
    V : (n + h, 3) float64, mm
        The given vertices, then the middle of each of the h holes.
    F : (m + k, 3) int64
        The given faces, then the fans.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [0.9, 0.9, 0], [1.2, 0.9, 0], [0.9, 1.2, 0]])
    >>> ring = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])
    >>> W, G = fill_holes(V, ring)
    >>> W[6:].round(6).tolist(), len(G), Topology(G).euler
    ([[1.006066, 1.006066, 0.0]], 9, 1)
    """
    loops = (topology or Topology(F)).boundary_loops
    steps = [np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1) for loop in loops]
    border = int(np.argmax([step.sum() for step in steps])) if loops else 0
    middles: list[FloatArray] = []
    fans: list[IntArray] = []
    for k, (loop, step) in enumerate(zip(loops, steps, strict=True)):
        if k == border:
            continue
        # The middle of the line, not of its vertices, whose spacing says nothing about the hole.
        weight = step + np.roll(step, 1)
        middles.append(weight @ V[loop] / weight.sum() if weight.sum() > 0 else V[loop].mean(axis=0))
        centre = np.full(len(loop), len(V) + len(fans))
        fans.append(np.column_stack([np.roll(loop, -1), loop, centre]))
    if not fans:
        return V, F
    return np.vstack([V, *middles]), np.vstack([F, *fans])


def flatten_filled(V: FloatArray, F: IntArray) -> FloatArray:
    """Free-boundary BFF of a surface with or without holes, at the scale of the least d.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component of genus 0 with a boundary; every vertex in use.

    Returns
    -------
    (n, 2) float64, mm

    Raises
    ------
    InputError
        Even with its holes filled it is no disk: closed, with a handle, or in several components.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [0.9, 0.9, 0], [1.2, 0.9, 0], [0.9, 1.2, 0]])
    >>> ring = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])
    >>> uv = flatten_filled(V, ring)
    >>> float(np.linalg.norm(uv[5] - uv[4]).round(6))
    0.424264
    """
    uv = BffSolver(*fill_holes(V, F)).free()[: len(V)]
    return uv * best_scale(V, F, uv)

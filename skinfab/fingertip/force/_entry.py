"""Where the line of a force enters a hemisphere, sample by sample. Compiled."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
FlagArray = NDArray[np.uint8]

#: What can be wrong with a sample; several can be at once.
INVALID, NO_CONTACT, MISSED, TORSION, AMBIGUOUS = 1, 2, 4, 8, 16
#: Columns of what comes out: point (3), inward normal (3), |f|, inclination, torsion, miss, standard deviation.
COLUMNS = 11
#: The distance has at most two minima on the rim, so that steps of 5.6 degrees part them; then to 1e-7 of a step. What a pull costs, mm.
_RIM_STEPS, _RIM_HALVINGS, _GOLDEN, _PULLS = 64, 34, 0.6180339887498949, 1e6


@njit(cache=True)
def point_variance(
    fx: float,
    fy: float,
    fz: float,
    force: float,
    px: float,
    py: float,
    pz: float,
    nx: float,
    ny: float,
    nz: float,
    force_sd: float,
    moment_sd: float,
) -> float:
    """Trace of a contact point's covariance, mm^2, to first order; infinite where the force only grazes the surface.

    From p x f = m and n . dp = 0: dp = a - (n . a) / (n . f^) f^ with a = f^ x (dm - p x df) / |f|.
    """
    dx, dy, dz = fx / force, fy / force, fz / force
    cosine = nx * dx + ny * dy + nz * dz
    if cosine == 0.0:
        return math.inf
    p2 = px * px + py * py + pz * pz
    along = px * dx + py * dy + pz * dz
    across2 = max(p2 - along * along, 0.0)
    wx, wy, wz = ny * dz - nz * dy, nz * dx - nx * dz, nx * dy - ny * dx
    w2 = wx * wx + wy * wy + wz * wz
    pw = px * wx + py * wy + pz * wz
    f2, m2 = force_sd * force_sd, moment_sd * moment_sd
    a2 = 2.0 * m2 + f2 * (2.0 * p2 - across2)
    na2 = m2 * w2 + f2 * (p2 * w2 - pw * pw)
    return float((a2 + na2 / (cosine * cosine)) / (force * force))


@njit(cache=True)
def describe(
    out: FloatArray,
    fx: float,
    fy: float,
    fz: float,
    force: float,
    torsion: float,
    miss: float,
    largest: float,
    force_sd: float,
    moment_sd: float,
) -> None:
    """Fill in what follows from force, point and inward normal (already in `out`)."""
    nx, ny, nz = out[3], out[4], out[5]
    cosine = (nx * fx + ny * fy + nz * fz) / force
    out[6] = force
    out[7] = math.acos(min(max(cosine, -1.0), 1.0))
    out[8] = torsion
    out[9] = miss
    variance = point_variance(fx, fy, fz, force, out[0], out[1], out[2], nx, ny, nz, force_sd, moment_sd)
    out[10] = min(math.sqrt(variance), largest)


@njit(cache=True)
def state(
    fx: float,
    fy: float,
    fz: float,
    mx: float,
    my: float,
    mz: float,
    least_force: float,
    force_sd: float,
    moment_sd: float,
    torsion_sd: float,
) -> tuple[int, float, float, float, float, float]:
    """Flags, |f|, the line's point q that is nearest to the origin, and the moment about the line (N mm)."""
    force = math.sqrt(fx * fx + fy * fy + fz * fz)
    if not (math.isfinite(force) and math.isfinite(mx) and math.isfinite(my) and math.isfinite(mz)):
        return INVALID | NO_CONTACT, 0.0, 0.0, 0.0, 0.0, 0.0
    if not force > least_force:
        return NO_CONTACT, force, 0.0, 0.0, 0.0, 0.0
    dx, dy, dz = fx / force, fy / force, fz / force
    qx, qy, qz = (dy * mz - dz * my) / force, (dz * mx - dx * mz) / force, (dx * my - dy * mx) / force
    torsion = dx * mx + dy * my + dz * mz
    variance = moment_sd * moment_sd + force_sd * force_sd * (qx * qx + qy * qy + qz * qz)
    flags = TORSION if torsion * torsion > torsion_sd * torsion_sd * variance else 0
    return flags, force, qx, qy, qz, torsion


@njit(cache=True)
def _apart2(x: float, y: float, z: float, ox: float, oy: float, oz: float, dx: float, dy: float, dz: float) -> float:
    """Squared distance of a point from the line through o along d."""
    ex, ey, ez = x - ox, y - oy, z - oz
    along = ex * dx + ey * dy + ez * dz
    return max(ex * ex + ey * ey + ez * ez - along * along, 0.0)


@njit(cache=True)
def _on_rim(angle: float, radius: float, aside: FloatArray, other: FloatArray) -> tuple[float, float, float]:
    c, s = radius * math.cos(angle), radius * math.sin(angle)
    return c * aside[0] + s * other[0], c * aside[1] + s * other[1], c * aside[2] + s * other[2]


@njit(cache=True)
def _rim_cost(
    angle: float, radius: float, aside: FloatArray, other: FloatArray, ox: float, oy: float, oz: float, dx: float, dy: float, dz: float
) -> float:
    """Squared distance of a point of the rim from the line; far more where the force would pull there."""
    x, y, z = _on_rim(angle, radius, aside, other)
    return _apart2(x, y, z, ox, oy, oz, dx, dy, dz) + _PULLS * max(x * dx + y * dy + z * dz, 0.0)


@njit(cache=True)
def nearest_on_dome(
    ox: float,
    oy: float,
    oz: float,
    dx: float,
    dy: float,
    dz: float,
    radius: float,
    axis: FloatArray,
    aside: FloatArray,
) -> tuple[float, float, float]:
    """Of the dome about the origin, where the force can push (not pull), the point nearest to the line through o along d.

    o is the line's own nearest point to the origin. Where the line passes the ball by, it is the ball's nearest point if that is
    on the dome. Else it is on the rim: looked for in steps, then by golden section about the best one.
    """
    across2 = ox * ox + oy * oy + oz * oz
    if across2 > radius * radius and ox * axis[0] + oy * axis[1] + oz * axis[2] >= 0.0:
        scale = radius / math.sqrt(across2)
        return ox * scale, oy * scale, oz * scale
    other = np.empty(3)  # their cross product: numba takes 5 s to compile NumPy's
    other[0] = axis[1] * aside[2] - axis[2] * aside[1]
    other[1] = axis[2] * aside[0] - axis[0] * aside[2]
    other[2] = axis[0] * aside[1] - axis[1] * aside[0]
    step = 2.0 * math.pi / _RIM_STEPS
    best, least = 0.0, math.inf
    for k in range(_RIM_STEPS):
        far = _rim_cost(k * step, radius, aside, other, ox, oy, oz, dx, dy, dz)
        if far < least:
            best, least = k * step, far
    low, high = best - step, best + step
    for _ in range(_RIM_HALVINGS):
        a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        at_a = _rim_cost(a, radius, aside, other, ox, oy, oz, dx, dy, dz)
        if at_a < _rim_cost(b, radius, aside, other, ox, oy, oz, dx, dy, dz):
            high = b
        else:
            low = a
    best = 0.5 * (low + high)
    least = _rim_cost(best, radius, aside, other, ox, oy, oz, dx, dy, dz)
    # Where the rim turns from pushed to pulled is a minimum that steps may pass over.
    edge = math.atan2(-(dx * aside[0] + dy * aside[1] + dz * aside[2]), dx * other[0] + dy * other[1] + dz * other[2])
    for angle in (edge, edge + math.pi):
        x, y, z = _on_rim(angle, radius, aside, other)
        far = _apart2(x, y, z, ox, oy, oz, dx, dy, dz)
        if far < least:
            best, least = angle, far
    return _on_rim(best, radius, aside, other)


@njit(cache=True)
def enter_hemisphere(
    F: FloatArray,
    M: FloatArray,
    radius: float,
    centre: FloatArray,
    axis: FloatArray,
    aside: FloatArray,
    least_force: float,
    force_sd: float,
    moment_sd: float,
    torsion_sd: float,
    out: FloatArray,
    flags: FlagArray,
) -> None:
    """Fill `out` (n, COLUMNS) and `flags` (n,). `aside` is any direction across the axis."""
    for k in range(len(F)):
        fx, fy, fz = F[k, 0], F[k, 1], F[k, 2]
        flag, force, qx, qy, qz, torsion = state(fx, fy, fz, M[k, 0], M[k, 1], M[k, 2], least_force, force_sd, moment_sd, torsion_sd)
        row = out[k]
        if flag & NO_CONTACT:
            # Nothing is known: the pole, and an error as large as the fingertip.
            for j in range(3):
                row[j] = centre[j] + radius * axis[j]
                row[3 + j] = -axis[j]
            row[6] = force
            row[7] = row[8] = row[9] = 0.0
            row[10] = 2.0 * radius
            flags[k] = flag
            continue
        dx, dy, dz = fx / force, fy / force, fz / force
        ox, oy, oz = qx - centre[0], qy - centre[1], qz - centre[2]
        along = ox * dx + oy * dy + oz * dz
        ox, oy, oz = ox - along * dx, oy - along * dy, oz - along * dz
        across2 = ox * ox + oy * oy + oz * oz
        left = radius * radius - across2
        root = math.sqrt(max(left, 0.0))  # of the two roots the one where the force goes in
        x, y, z = ox - root * dx, oy - root * dy, oz - root * dz
        if left < 0.0 or x * axis[0] + y * axis[1] + z * axis[2] < 0.0:
            flag |= MISSED
            x, y, z = nearest_on_dome(ox, oy, oz, dx, dy, dz, radius, axis, aside)
        miss = 0.0
        if flag & MISSED:
            miss = math.sqrt(_apart2(x, y, z, ox, oy, oz, dx, dy, dz))
        row[0], row[1], row[2] = x + centre[0], y + centre[1], z + centre[2]
        row[3], row[4], row[5] = -x / radius, -y / radius, -z / radius
        describe(row, fx, fy, fz, force, torsion, miss, 2.0 * radius, force_sd, moment_sd)
        flags[k] = flag

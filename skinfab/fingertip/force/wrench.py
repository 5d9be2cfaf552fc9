"""What a six-axis fingertip sensor reads: a force and a moment in its own frame, and how noisy they are."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Stream

#: Channels of a six-axis sensor, in this order everywhere: force in N, moment about the frame's origin in N mm.
WRENCH = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")

#: Of the seed's fingertip: half a table tennis ball.
RADIUS_MM = 20.0


#: A declared unit in ours, N and N mm; written without blanks, points and stars.
_FORCE_UNITS = {"N": 1.0, "mN": 1e-3, "kN": 1e3}
_MOMENT_UNITS = {"Nmm": 1.0, "mNm": 1.0, "Ncm": 10.0, "Nm": 1000.0, "mNmm": 1e-3}
#: As ROS calls the vectors of a Wrench, behind a topic's name.
_VECTORS = {"force": "F", "torque": "M", "moment": "M"}
#: So large a part of the forces must pass within a thousandth of the reach before moments are said to be in N m.
_NEARLY_ALL = 0.95


@dataclass(frozen=True)
class SensorNoise:
    """Standard deviation of each axis of a sensor, sample by sample.

    Parameters
    ----------
    force_n : float, N
    moment_nmm : float, N mm

    Raises
    ------
    InputError
        One of them is negative or no number.
    """

    force_n: float = 0.02
    moment_nmm: float = 0.2

    def __post_init__(self) -> None:
        for name, value in (("force_n", self.force_n), ("moment_nmm", self.moment_nmm)):
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"a sensor noise {name} of {value:g} is none; give its standard deviation, 0 or more")

    def averaged(self, samples: int) -> SensorNoise:
        """Of a mean over so many samples.

        Examples
        --------
        >>> SensorNoise().averaged(4)
        SensorNoise(force_n=0.01, moment_nmm=0.1)
        """
        return SensorNoise(self.force_n / math.sqrt(samples), self.moment_nmm / math.sqrt(samples))


def force_stream(name: str, rate_hz: float, *, simulated: bool = False) -> Stream:
    """The stream of one six-axis sensor.

    Examples
    --------
    >>> force_stream("fingertip", 200.0).names
    ('Fx', 'Fy', 'Fz', 'Mx', 'My', 'Mz')
    """
    channels = tuple(Channel(each, "N" if each[0] == "F" else "N mm", "force" if each[0] == "F" else "moment") for each in WRENCH)
    return Stream(name, channels, rate_hz, simulated)


def wrench_columns(names: Iterable[str], units: Mapping[str, str], *, where: str) -> tuple[tuple[str, float], ...]:
    """Which column is which of the six components, and by what it is multiplied to be N or N mm.

    A column is called ``Fx``, ``Fx (mN)`` or ``TOPIC.force.x``, as the vectors of a ROS Wrench are.

    Parameters
    ----------
    names : iterable of str
    units : mapping of str
        Of the columns that say theirs; others are taken for N and N mm.
    where : str
        For the words of an error.

    Raises
    ------
    InputError
        A component has no column or more than one, or its unit is not known.

    Examples
    --------
    >>> wrench_columns(["Fx", "Fy", "Fz", "Mx (N m)", "My (N m)", "Mz (N m)"], {"Mx (N m)": "N m"}, where="a.csv")[2:4]
    (('Fz', 1.0), ('Mx (N m)', 1000.0))
    """
    names = list(names)
    found: dict[str, list[str]] = {each: [] for each in WRENCH}
    for name in names:
        if (component := _component(name)) in found:
            found[component].append(name)
    # A column that is called exactly so stands above those that only may be it.
    chosen = {each: [each] if each in of else of for each, of in found.items()}
    if twice := next((of for of in chosen.values() if len(of) > 1), None):
        raise InputError(f"{where}: {' and '.join(twice)} are one component of two sensors; leave the columns of one of them in the log")
    if missing := [name for name, of in chosen.items() if not of]:
        raise InputError(
            f"{where} has no column {', '.join(missing)}; call the forces Fx, Fy, Fz (N) and the moments Mx, My, Mz (N mm); "
            f"there are {', '.join(names) or 'none'}"
        )
    return tuple((of[0], _scale(each, of[0], units.get(of[0], ""), where)) for each, of in chosen.items())


def _component(name: str) -> str:
    """Fx ... Mz, or nothing."""
    plain = re.sub(r"\s*[\[(][^\])]*[\])]\s*$", "", name)
    if match := re.fullmatch(r"(?:.*[./])?(force|torque|moment)\.([xyz])", plain):
        return _VECTORS[match[1]] + match[2]
    return plain


def _scale(component: str, name: str, unit: str, where: str) -> float:
    known = _FORCE_UNITS if component[0] == "F" else _MOMENT_UNITS
    if not unit:
        return 1.0
    plain = re.sub(r"[\s.*\u00b7\u22c5]", "", unit)
    if plain not in known:
        raise InputError(f"{where}: {name} is in {unit}, which is not known; give {', '.join(known)}")
    return known[plain]


def require_nmm(force: NDArray[np.float64], moment: NDArray[np.float64], *, reach_mm: float, least_force: float, where: str) -> None:
    """Refuse moments that would be of contacts within a thousandth of where they can be: they are in N m, and nobody said so.

    Parameters
    ----------
    force, moment : (n, 3) float
    reach_mm : float
        How far from the origin a contact, or a weight, can be.
    least_force : float, N
        Weaker ones say nothing of where they act.
    where : str

    Raises
    ------
    InputError

    Examples
    --------
    >>> F = np.array([[0.2, 0.0, -1.0]] * 3)
    >>> M_nm = np.cross([0.0, 0.0, 0.020], F)
    >>> try:
    ...     require_nmm(F, M_nm, reach_mm=20.0, least_force=0.3, where="a.csv")
    ... except InputError as fault:
    ...     print(str(fault)[:63])
    a.csv: all forces would pass within 0.0039 mm of the origin, so
    """
    size = np.linalg.norm(force, axis=1)
    held = size > least_force
    if not held.any():
        return
    arm = float(np.quantile(np.linalg.norm(moment[held], axis=1) / size[held], _NEARLY_ALL))
    if arm < reach_mm / 1000:
        raise InputError(
            f"{where}: all forces would pass within {arm:.2g} mm of the origin, so the moments are in N m; "
            "write that into their headings, Mx (N m), or convert them to N mm"
        )

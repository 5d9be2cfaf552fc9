"""Values of a printer profile that contradict each other: which, which profile each was said in, and what to say instead."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gcode.profile import Profile
from skinfab.errors import InputError

if TYPE_CHECKING:
    from gcode.printer import Printer, Spindle

HOME_POLICIES = ("xyz", "xy", "none")


def check_values(printer: Printer, profile: Profile) -> None:
    """Refuse the first contradiction.

    Raises
    ------
    InputError
        It names both fields, their values, the profile that each was taken over from, and the remedy.
    """
    for fault in _faults(printer, profile):
        raise InputError(fault)


def _faults(printer: Printer, profile: Profile) -> Iterator[str]:
    yield from _not_positive(printer, profile)
    if printer.home not in HOME_POLICIES:
        yield f"{_said(printer, profile, 'home')}; it must be one of {', '.join(HOME_POLICIES)}"
    yield from _off_the_bed(printer, profile)
    yield from _heights(printer, profile)
    yield from _cleaning(printer, profile)
    yield from _ink(printer, profile)
    if printer.spindle:
        yield from _grbl(printer, printer.spindle, profile)
    else:
        for key in ("max_e", "max_e_speed"):
            if math.isinf(getattr(printer.pump, key)):
                yield f"{profile.where('pump')}: field {key!r} is missing; only a pump that is a [spindle] goes without"


def _value(printer: Printer, keys: Sequence[str]) -> Any:
    return functools.reduce(getattr, keys, printer)


def _and(printer: Printer, profile: Profile, *keys: str) -> str:
    """A field, what it is and whose."""
    value = _value(printer, keys)
    shown = f"{value:g}" if isinstance(value, float) else f"{value[0]:g} x {value[1]:g}" if isinstance(value, tuple) else repr(value)
    return f"{', '.join(keys)} is {shown}{profile.taken_over(*keys)}"


def _said(printer: Printer, profile: Profile, *keys: str) -> str:
    """The same as an error begins with it."""
    return f"{profile.where()}, {_and(printer, profile, *keys)}"


def _remedy(profile: Profile, *keys: str) -> str:
    """Where to say a field."""
    return f"say {keys[-1]} under [{keys[0]}] in {_short(profile)}"


def _short(profile: Profile) -> str:
    return Path(profile.name).name


def _not_positive(printer: Printer, profile: Profile) -> Iterator[str]:
    for k, side in enumerate(printer.bed.size):
        if not side > 0:
            yield f"{profile.where('bed', 'size')} is {side:g}{profile.taken_over('bed', 'size')} in {'xy'[k]}; it must be more than zero"
    positive = [
        ("bed", "height"),
        ("process", "chord_tolerance"),
        *(("motion", f.name) for f in fields(printer.motion)),
        *(("pump", key) for key in ("e_per_mm3", "max_e", "max_e_speed", "flow_max", "prime_rate")),
        *(("spindle", f.name) for f in (fields(printer.spindle) if printer.spindle else ())),
    ]
    for keys in positive:
        if not _value(printer, keys) > 0:
            yield f"{_said(printer, profile, *keys)}; it must be more than zero"


def _off_the_bed(printer: Printer, profile: Profile) -> Iterator[str]:
    """A place of a larger bed is often taken over for a smaller one."""
    for name in ("cleaning", "park"):
        place = getattr(printer, name)
        for axis, end in zip("xy", printer.bed.size, strict=True):
            if place and getattr(place, axis) > end:
                yield (
                    f"{_said(printer, profile, name, axis)}, and {_and(printer, profile, 'bed', 'size')} mm; "
                    f"{_remedy(profile, name, axis)}: at most {end:g}, on the bed and beside the largest mould"
                )
    place, width = printer.cleaning, printer.bed.size[0]
    if place and place.x + place.wipe > width:
        yield (
            f"{_said(printer, profile, 'cleaning', 'wipe')} and {_and(printer, profile, 'cleaning', 'x')}, so the nozzle is wiped up to "
            f"x = {place.x + place.wipe:g}, and {_and(printer, profile, 'bed', 'size')} mm; "
            f"{_remedy(profile, 'cleaning', 'x')}: at most {width - place.wipe:g}, or wipe less"
        )


def _heights(printer: Printer, profile: Profile) -> Iterator[str]:
    rising = [("heights", "print_min"), ("heights", "print"), ("heights", "print_max"), ("heights", "travel"), ("bed", "height")]
    for low, high in itertools.pairwise(rising):
        a, b = _value(printer, low), _value(printer, high)
        if a > b or (a == b and high == ("heights", "travel")):
            yield (
                f"{_said(printer, profile, *low)} mm, and {_and(printer, profile, *high)} mm; "
                f"print_min <= print <= print_max < travel <= bed height must hold, {_remedy(profile, *low)}"
            )


def _cleaning(printer: Printer, profile: Profile) -> Iterator[str]:
    place, travel = printer.cleaning, printer.heights.travel
    if place is None:
        return
    if place.height is not None and place.height > travel:
        yield (
            f"{_said(printer, profile, 'cleaning', 'height')} mm, and {_and(printer, profile, 'heights', 'travel')} mm: the nozzle "
            f"would meet the pad from the side; {_remedy(profile, 'cleaning', 'height')}: at most {travel:g}, or raise travel"
        )
    if place.wipe and place.height is None:
        yield (
            f"{_said(printer, profile, 'cleaning', 'wipe')} mm, and there is no height: it would wipe nothing; "
            f"{_remedy(profile, 'cleaning', 'height')}: how high the pad is over the floor of the mould's cavity"
        )


def _ink(printer: Printer, profile: Profile) -> Iterator[str]:
    p = printer.pump
    if p.flow_min > p.flow_max:
        yield (
            f"{_said(printer, profile, 'pump', 'flow_min')}, above {_and(printer, profile, 'pump', 'flow_max')} mm^3/s; "
            f"{_remedy(profile, 'pump', 'flow_min')}, or flow_max"
        )
    if p.prime != p.retract:
        yield (
            f"{_said(printer, profile, 'pump', 'prime')} and {_and(printer, profile, 'pump', 'retract')} mm^3; "
            f"a pattern must end as it began, make them equal in {_short(profile)}"
        )


def _grbl(printer: Printer, spindle: Spindle, profile: Profile) -> Iterator[str]:
    p = printer.pump
    if printer.home != "none":
        yield (
            f"{_said(printer, profile, 'home')}; GRBL homes by $H, which is no G-code: "
            f"home before the start and say home = 'none' in {_short(profile)}"
        )
    for key, left_out in (("e_per_mm3", 1.0), ("max_e", math.inf), ("max_e_speed", math.inf)):
        if getattr(p, key) != left_out:
            yield (
                f"{_said(printer, profile, 'pump', key)}; a pump that is a spindle has no E axis: "
                "take out e_per_mm3, max_e and max_e_speed, or extend 'generic-grbl'"
            )
    fastest = "flow_max" if p.flow_max >= p.prime_rate else "prime_rate"
    s = getattr(p, fastest) * spindle.s_per_flow
    if s > spindle.s_max:
        yield (
            f"{_said(printer, profile, 'pump', fastest)} mm^3/s, which asks for S{s:g} as "
            f"{_and(printer, profile, 'spindle', 's_per_flow')}, and {_and(printer, profile, 'spindle', 's_max')}; "
            f"{_remedy(profile, 'pump', fastest)}: at most {spindle.s_max / spindle.s_per_flow:g}, or lower s_per_flow"
        )

"""How far direction, place and force are off what a table of labels says: of what `skinfab nail train` held out, of new trials of `run`."""

from __future__ import annotations

from typing import Any


def mean_errors(off: Any) -> dict[str, float | None]:
    """Of errors (n, 3) in degrees, mm and parts of the force, NaN where unknown: their means, None where none is known.

    Examples
    --------
    >>> import numpy as np
    >>> mean_errors(np.array([[np.nan, 1.0, 0.1], [np.nan, 2.0, 0.3]]))
    {'mean_angle_error_deg': None, 'mean_place_error_mm': 1.5, 'mean_force_error_percent': 20.0}
    """
    import numpy as np

    known = [column[np.isfinite(column)] for column in np.asarray(off, dtype=float).T]
    angle, place, force = (float(each.mean()) if len(each) else None for each in known)
    return {
        "mean_angle_error_deg": angle,
        "mean_place_error_mm": place,
        "mean_force_error_percent": None if force is None else 100 * force,
    }


def off_line(facts: dict[str, Any]) -> str:
    """How far off direction, place and force are, as far as they are known.

    Examples
    --------
    >>> off_line({"mean_angle_error_deg": None, "mean_place_error_mm": 1.26, "mean_force_error_percent": 24.8})
    ', off by 1.3 mm, 25 % of the force in the mean'
    """
    each = (("angle_error_deg", ".1f", "degrees"), ("place_error_mm", ".1f", "mm"), ("force_error_percent", ".0f", "% of the force"))
    said = [f"{facts[f'mean_{key}']:{form}} {unit}" for key, form, unit in each if facts[f"mean_{key}"] is not None]
    return f", off by {', '.join(said)} in the mean" if said else ""

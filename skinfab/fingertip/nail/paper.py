"""What the paper reports, to be put beside what comes out here.

Source: Kon et al. (see `published`), its text; numbers that it only draws (figures 6, 8 and 10) are not known, and its confusion
matrices are pictures. Of the twelve edges it says "around 50 %" of all conditions but three: these are bounds of a kind, not means.
"""

from __future__ import annotations

#: Mean accuracy of ten participants, %, by test and sensor condition.
ACCURACY: dict[str, dict[str, float]] = {
    "edges4": {
        "AxAyAzGxGyGz": 74.75,
        "GxGyGz": 76.75,
        "GxGy": 64.25,
        "GyGz": 57.0,
        "GzGx": 67.75,
        "AxAy": 47.25,
        "AyAz": 51.25,
        "AzAx": 50.0,
    },
    "pins6": {"AxAyAzGxGyGz": 91.33, "GxGyGz": 88.17, "AxAy": 59.17},
    "edges12": {"AxAyAzGxGyGz": 71.67, "GxGyGz": 68.4, "AxAy": 39.5},
}

#: What it calls "comparable accuracy levels, each around 50 %", %.
AROUND: dict[str, dict[str, float]] = {"edges12": dict.fromkeys(("AyAz", "AzAx", "GxGy", "GyGz", "GzGx"), 50.0)}

#: Peaks of the readings, in G and deg/s: "around 2.0 G" and "250 deg/s".
PEAK_G, PEAK_DPS = 2.0, 250.0

#: Pairs of conditions that differ (p < 0.05 after correction). Of the pins it names these four, and says besides, in words that can be
#: read in several ways, that conditions of two channels differ from those of more.
_ALL, _A, _G = "AxAyAzGxGyGz", "AxAyAz", "GxGyGz"
DIFFERING: dict[str, tuple[set[str], ...]] = {
    "edges4": (
        *({_ALL, other} for other in (_A, "AxAy", "AyAz", "AzAx")),
        *({_G, other} for other in (_A, "AxAy", "AyAz", "AzAx")),
    ),
    "pins6": ({_A, "AxAy"}, {_G, "AxAy"}, {_G, "AzAx"}, {_G, "GyGz"}),
    "edges12": (
        *({_ALL, other} for other in (_A, "AxAy", "AyAz", "AzAx", "GxGy", "GyGz", "GzGx")),
        *({_G, other} for other in ("AxAy", "AyAz", "AzAx", "GxGy", "GyGz", "GzGx")),
        {_A, "AxAy"},
        {"AxAy", "AyAz"},
    ),
}

"""Forces of all sizes: told better than by a constant, in every test, and a sentence of the table's numbers."""

from dataclasses import asdict

from skinfab.bench.nail_force import FORCES_N, measure, sentence
from skinfab.fingertip.nail.protocol import Protocol


def test_forces_are_told_better_than_a_constant_would() -> None:
    rows = measure(Protocol(participants=3, training=5, rounds=8, samples=64), ("edges4", "pins6"))
    assert [(row.test, row.trials, row.samples, (row.low_n, row.high_n)) for row in rows] == [
        ("edges4", 96, 33, FORCES_N),
        ("pins6", 144, 33, FORCES_N),
    ]
    for row in rows:
        # Of who says the geometric mean of forces that are log-uniform over a decade: 2 / ln 10 * (cosh(ln 10 / 2) - 1) = 64 %.
        assert 45 < row.constant_off_percent < 85 and 3 < row.force_off_percent < 0.6 * row.constant_off_percent
        assert row.simulated and row.low <= row.percent <= row.high
    said = sentence([asdict(row) for row in rows])
    assert all(f"{row.force_off_percent:.0f} % of {row.test}" in said and f"{row.percent:.1f} % of {row.test}" in said for row in rows)
    assert "simulated" in said and "0.3 to 3 N" in said

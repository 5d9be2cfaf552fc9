"""The frame's chart: every way is measured on the same images, and the sentence says what the table holds."""

import pytest

from skinfab.bench import optical_frame as bench


def test_ways_are_measured_and_said() -> None:
    rows = bench.measure(counts=(60,), judged=20, repeats=1)
    assert [row.method for row in rows] == [bench.PUBLISHED, bench.LINEAR, bench.WHOLE, bench.DEFAULT]
    old, linear, whole, new = rows
    assert new.offset_mm < linear.offset_mm < old.offset_mm and new.angle_deg < old.angle_deg and whole.told == new.told == 1
    assert all(row.ms > 0 and row.simulated for row in rows)
    said = bench.sentence([vars(row) for row in rows])
    assert f"{new.offset_mm:.2f} mm off" in said and f"{old.angle_deg:.1f} degrees" in said and said.endswith("far off.")
    assert new.depth_mm == pytest.approx(new.depth_mm)  # it tells one, the published way none
    assert old.depth_mm != old.depth_mm

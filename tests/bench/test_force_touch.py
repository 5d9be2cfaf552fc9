"""The table of touches: defects are taken out at places that were not touched, and a straight sensor has none to take out."""

from skinfab.bench.force_touch import DEFECTS, measure


def test_what_touches_take_out_of_a_sensor() -> None:
    some = {name: DEFECTS[name] for name in ("all defects", "origin off alone", "straight")}
    rows = {row.sensor: row for row in measure(defects=some, touches=(8,), sensors=2)}
    assert list(rows) == list(some) and {row.touches for row in rows.values()} == {8}
    crooked, off, straight = rows.values()
    assert crooked.learned_mm < crooked.as_read_mm / 2 and off.learned_mm < off.as_read_mm
    assert crooked.as_read_mm > off.as_read_mm > straight.as_read_mm
    assert crooked.helped == off.helped == 1.0
    assert straight.learned_mm > 0.8 * straight.as_read_mm

"""Rows of numbers from frames: with a calibration, without one, and through a bridge."""

import math

import numpy as np
import pytest

from calibration.strain.live import Live, _against, drawn
from skinfab.errors import InputError
from skinfab.readout.bridge import QuarterBridge
from skinfab.readout.frame import Channel, Recording, Stream

N = 400


def recording(*units: str, rate: float = 100.0) -> Recording:
    stream = Stream("skin", tuple(Channel(f"S{k}", unit, "", 0.0, 3.3) for k, unit in enumerate(units)), rate)
    time = np.arange(N) / (rate or 100.0)
    bent = np.clip(np.sin(time) - 0.2, 0, None)
    bridge = QuarterBridge(3.3, 100.0)
    values = np.column_stack([bridge.voltage(150 * (1 + 0.3 * bent)) for _ in units])
    return Recording.of_values(stream, values, device_time=time)


def columns(live: Live, made: Recording) -> dict[str, list[float]]:
    rows = [live.step(frame) for frame in made]
    return dict(zip(live.names, map(list, zip(*rows, strict=True)), strict=True))


def test_through_a_bridge() -> None:
    made = recording("V", "pF")
    live = Live(made.stream, made, None, bridge=(3.3, 100.0))
    assert live.names == ("time_s", "S0", "S1", "S0 (kohm)", "S0 (dR/R0)")
    table = columns(live, made)
    assert np.allclose(table["S0 (kohm)"], 150 * (1 + 0.3 * np.clip(np.sin(made.device_time) - 0.2, 0, None)))
    assert max(table["S0 (dR/R0)"]) == pytest.approx(0.24, abs=1e-3) and min(table["S0 (dR/R0)"]) == 0
    assert live.facts(table)["r0_kohm"] == {"S0": pytest.approx(150)}
    time, (panel,) = drawn(table, made, None)
    assert panel.quantity == "S0 (dR/R0, %)" and panel.flagged is None and time[0] == 0
    assert panel.curves["S0 (dR/R0)"].max() == pytest.approx(24, abs=0.1)


def test_a_panel_a_channel_with_its_unit_once() -> None:
    made = recording("V", "pF")
    named = Recording.of_values(
        Stream("skin", (Channel("S0", "V"), Channel("C (pF)", "pF"), Channel("n")), 100.0),
        np.column_stack([made.values, made.values[:, 0]]),
        device_time=made.device_time,
    )
    _, panels = drawn(columns(Live(named.stream, named, None), named), named, None)
    assert [panel.quantity for panel in panels] == ["S0 (V)", "C (pF)", "n"]


def test_a_dead_bridge_has_no_rest() -> None:
    made = recording("V", "V")
    made.values[:, 1] = 0.0
    made.saturated[:, 1] = True
    live = Live(made.stream, made, None, bridge=(3.3, 100.0))
    table = columns(live, made)
    assert live.facts(table)["r0_kohm"]["S1"] is None and np.isnan(table["S1 (dR/R0)"]).all()


def test_no_volts_no_bridge() -> None:
    made = recording("pF")
    with pytest.raises(InputError, match="no channel is in volts"):
        Live(made.stream, made, None, bridge=(3.3, 100.0))


def test_one_invalid_frame_is_one_gap() -> None:
    made = recording("V", "V")
    made.valid[100, 0] = False
    made.values[100, 0] = np.nan
    table = columns(Live(made.stream, made, None), made)
    assert [k for k, value in enumerate(table["S0"]) if math.isnan(value)] == [100]
    assert np.isfinite(table["S1"]).all()


def test_too_slow_a_log_is_given_as_it_is() -> None:
    made = recording("V", rate=8.0)
    live = Live(made.stream, made, None)
    table = columns(live, made)
    assert live.facts(table)["filter_hz"] is None and table["S0"] == made.values[:, 0].tolist()


def test_names_that_clash() -> None:
    made = Recording.of_values(Stream("a", (Channel("time_s"),), 100.0), np.ones((3, 1)), device_time=np.arange(3.0))
    with pytest.raises(InputError, match="'time_s'"):
        Live(made.stream, made, None)


@pytest.mark.parametrize("gap", [slice(0, 0), slice(1500, 1800), slice(2600, 3000), slice(0, 400)], ids=["none", "middle", "end", "start"])
def test_the_delay_is_taken_off_but_gaps_are_not_bridged(gap: slice) -> None:
    time = np.arange(3000) / 100
    truth = 45 - 30 * np.cos(time)
    late = np.interp(time - 0.08, time, truth)
    truth[gap] = np.nan
    found = _against(time, late, truth, 0.08, (10.0, 80.0))
    assert found["rms_in_step_deg"] == pytest.approx(0, abs=0.02) and found["rms_deg"] == pytest.approx(30 * 0.08 / 2**0.5, rel=0.1)

"""Lines of numbers: with and without headings, cut at both ends, and never a crash."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.readout.ascii_lines import LONGEST_LINE, LineDecoder
from skinfab.readout.checks import check_times
from skinfab.readout.frame import Recording


def test_headings_name_count_and_clock() -> None:
    decoder = LineDecoder()
    frames = decoder.feed(b"1.5\n# a remark\r\nsequence,time_us,S1,S2 (V)\r\n5,2000000,1.5,-2e-3\r\n6,2010000,,7\r\n", host_time=3.0)
    assert decoder.stream is not None and decoder.stream.names == ("S1", "S2 (V)") and not decoder.checked
    assert [(f.sequence, f.device_time, f.host_time) for f in frames] == [(5, 2.0, 3.0), (6, 2.01, 3.0)]
    assert frames[0].values.tolist() == [1.5, -0.002] and frames[1].valid.tolist() == [False, True] and decoder.bad == 0


def test_where_no_headings_come_lines_alike_tell_the_channels() -> None:
    decoder = LineDecoder()
    assert decoder.feed(b"9\n1,2\n3,4\n5,6\n", host_time=10.0) == [] and decoder.stream is None
    frames = decoder.feed(b"7,8\n9,0\n", host_time=11.5)
    assert decoder.stream is not None and decoder.stream.names == ("ch1", "ch2")
    # Of the lines that waited when the port was opened only the last has a time; the next two came within 1.5 s.
    assert [f.values.tolist() for f in frames] == [[5, 6], [7, 8], [9, 0]] and [f.sequence for f in frames] == [0, 1, 2]
    assert [f.device_time for f in frames] == [0.0, 0.75, 1.5] and [f.host_time for f in frames] == [10.0, 11.5, 11.5]


def test_lines_that_come_in_one_go_have_times_of_their_own() -> None:
    """Without a device's clock nothing must look as if one stood still: a port is read by the chunk."""
    rng, decoder, data, frames = np.random.default_rng(0), LineDecoder(), b"1,2\n" * 300, []
    for k in range(60):
        size = int(rng.integers(0, 30))
        frames += decoder.feed(data[:size], host_time=5.0 + 0.05 * k)
        data = data[size:]
    times = np.array([f.device_time for f in frames])
    assert decoder.stream is not None
    recording = Recording.of_frames(decoder.stream, frames)
    assert len(frames) > 50 and np.diff(times).min() > 0 and times[-1] < 3.0
    assert not any("stands still" in note for note in check_times(recording))


def test_after_the_port_was_gone_lines_are_not_spread_over_the_time_without_it() -> None:
    decoder = LineDecoder()
    frames = decoder.feed(b"\na,b\n1,2\n", host_time=0.0)
    decoder.reset()
    frames += decoder.feed(b"2,3\n3,4\n4,5\n", host_time=10.0) + decoder.feed(b"5,6\n6,7\n", host_time=10.1)
    assert [(f.values[0], round(f.device_time, 6)) for f in frames] == [(1, 0), (4, 10), (5, 10.05), (6, 10.1)]


@pytest.mark.parametrize(
    "text",
    [
        "sequence;time_ms;S1;S2\n0;10;1,5;-2\n1;20;2,5;\n",
        "sequence\ttime_ms\tS1\tS2\n0\t10\t1,5\t-2\n1\t20\t2,5\tnan\n",
        "sequence;time_ms;S1;S2\n0;10;1.5;-2,0e0\n1;20;,25e1;nan\n",
    ],
)
def test_semicolons_tabs_and_decimal_commas(text: str) -> None:
    decoder = LineDecoder()
    frames = decoder.feed(text.encode(), host_time=0.0)
    assert decoder.stream is not None and decoder.stream.names == ("S1", "S2") and decoder.bad == 0
    np.testing.assert_array_equal([f.values for f in frames], [[1.5, -2], [2.5, np.nan]])
    assert [(f.sequence, f.device_time) for f in frames] == [(0, 0.01), (1, 0.02)]


def test_semicolons_without_headings_and_a_mark_that_changes() -> None:
    decoder = LineDecoder()
    decoder.feed(b"0\n1,5;2\n", host_time=0.0)
    decoder.feed(b"1,6;2\n1,7;2\n", host_time=1.0)
    frames = decoder.feed(b"1,8;2\n", host_time=2.0)
    assert [f.values.tolist() for f in frames] == [[1.6, 2], [1.7, 2], [1.8, 2]]
    assert decoder.feed(b"1.9,2\n", host_time=3.0) == [] and decoder.bad == 1


@pytest.mark.parametrize(
    ("line", "says"),
    [
        (b"0,871,1,234", "the line '0,871,1,234' has 4 numbers where 2 are named; are these decimal commas"),
        (b"1.0 2.0", "'1.0 2.0' is no line of numbers parted by commas, semicolons or tabs"),
        (b"U=1.5 V, 2", "'U=1.5 V, 2' is no line of numbers"),
        (b"S1 = " + b"1" * 900, "is no line of numbers"),
        (b"1,2\x00\x07", ""),
    ],
)
def test_what_was_seen_in_a_bad_line_is_said(line: bytes, says: str) -> None:
    decoder = LineDecoder()
    decoder.feed(b"\nS1,S2\n", host_time=0.0)
    assert decoder.fault == "" and decoder.feed(line + b"\n", host_time=0.1) == []
    assert says in decoder.fault and decoder.bad == 1 and len(decoder.fault) < 200


def test_headings_that_come_in_time_are_waited_for() -> None:
    decoder = LineDecoder()
    assert decoder.feed(b"9,9\n0,1.5\n1,1.5\n2,1.5\n3,1.5\n", host_time=10.0) == []
    assert [f.sequence for f in decoder.feed(b"sequence,S1\n4,1.5\n", host_time=11.0)] == [4]


def test_the_first_line_is_passed_over_for_it_may_have_been_cut() -> None:
    decoder = LineDecoder()
    decoder.feed(b"3.5,1\n123.5,1\n", host_time=0.0)
    frames = decoder.feed(b"123.5,1\n123.5,1\n", host_time=2.0)
    assert len(frames) == 3 and {f.values[0] for f in frames} == {123.5}
    decoder = LineDecoder()
    decoder.feed(b"uence,S1\nsequence,S1\n", host_time=0.0)
    assert decoder.stream is not None and decoder.stream.names == ("S1",)
    decoder = LineDecoder()
    assert len(decoder.feed(b"sequence,S1\n0,5\n", host_time=0.0)) == 1


@pytest.mark.parametrize("cell", ["1_0", "0x1", "1.2.3", "1,2", "one", "--1", "1e", "\xff", "\N{FULLWIDTH DIGIT ONE}", "inf", "1 2"])
def test_what_is_no_plain_number_is_a_bad_line(cell: str) -> None:
    decoder = LineDecoder()
    decoder.feed(b"\na,b\n", host_time=0.0)
    assert decoder.feed(f"{cell},1\n".encode(), host_time=0.0) == [] and decoder.bad == 1


def test_headings_again_are_no_fault_and_others_are() -> None:
    decoder = LineDecoder()
    decoder.feed(b"\na,b\n1,2\na,b\n", host_time=0.0)
    assert decoder.bad == 0
    decoder.feed(b"a,c\n", host_time=0.0)
    assert decoder.bad == 1


@pytest.mark.parametrize("line", [b"sequence,time_us\n", b"a,a\n", b"time_us,time_ms,a\n", b"a,\n", b",,\n"])
def test_headings_that_name_no_channels_are_none(line: bytes) -> None:
    decoder = LineDecoder()
    decoder.feed(b"\n" + line, host_time=0.0)
    assert decoder.stream is None and decoder.bad == 1


@given(st.lists(st.binary(max_size=60) | st.from_regex(rb"[0-9.,\n+-eE_a-z]*", fullmatch=True), max_size=30))
def test_no_bytes_crash_it_and_what_comes_out_fits_the_stream(pieces: list[bytes]) -> None:
    decoder = LineDecoder()
    for piece in pieces:
        for frame in decoder.feed(piece, host_time=1.0):
            assert decoder.stream is not None and frame.values.shape == (len(decoder.stream.channels),)
            assert np.isfinite(frame.device_time)


def test_a_line_without_end_is_not_kept() -> None:
    decoder = LineDecoder()
    for _ in range(50):
        decoder.feed(b"1," * LONGEST_LINE, host_time=0.0)
    assert decoder.bad == 1
    decoder.feed(b"\na,b\n1,2\n", host_time=0.0)
    assert decoder.stream is not None


def fed(lines: str) -> LineDecoder:
    """A decoder that was given these lines for two seconds."""
    decoder = LineDecoder()
    for k in range(40):
        decoder.feed(f"{lines.splitlines()[k % len(lines.splitlines())]}\n".encode(), host_time=k / 20)
    return decoder


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ("1,050\n1,125", "'1,050' is read as 2 channels, and may be one number with a decimal comma; .*with 2 names it is 2 channels"),
        ("1,050,2,030\n1,125,2,110", "'1,050,2,030' is read as 4 channels, and may be 2 numbers with decimal commas; let the board print"),
        ("1,125,2,03\n1,125,2,11", "'1,125,2,03' is read as 4"),  # each number has digits of its own
        ("1,125,2,130\n1,225,2,110", ""),  # no zero leads
        ("1,050,2,030\n1,5,2,030", ""),  # not always as many
        ("1,050,2\n1,125,3", ""),  # three cells are no pairs
        ("1,050,2.5,030\n1,125,2.5,010", ""),  # points there are
    ],
)
def test_cells_that_may_be_halves_of_numbers(lines: str, says: str) -> None:
    doubt = fed(lines).doubt
    assert re.search(says, doubt) if says else doubt == ""

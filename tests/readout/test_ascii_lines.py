"""Lines of numbers: with and without headings, cut at both ends, and never a crash."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.readout.ascii_lines import LONGEST_LINE, LineDecoder


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
    assert [f.values.tolist() for f in frames] == [[3, 4], [5, 6], [7, 8], [9, 0]] and [f.sequence for f in frames] == [0, 1, 2, 3]


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

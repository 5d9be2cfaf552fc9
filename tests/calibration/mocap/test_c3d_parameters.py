"""The parameter section is held together before the library reads it, which it does for ever where the file ends too soon."""

from pathlib import Path

import pytest
from captures import positions, write_c3d

from calibration.mocap.c3d_parameters import fault


def whole(tmp_path: Path) -> bytearray:
    write_c3d(tmp_path / "a.c3d", positions(5))
    return bytearray((tmp_path / "a.c3d").read_bytes())


def test_a_file_cut_off_anywhere_in_its_parameters_is_told(tmp_path: Path) -> None:
    data = whole(tmp_path)
    assert fault(data) == ""
    end = data.index(b"\0" * 64, 512)  # the last entry and what fills its block up
    said = [fault(data[:size]) for size in range(1, end)]
    assert set(said) == {"its parameters are cut off"}


@pytest.mark.parametrize(
    ("at", "value", "says"),
    [
        (0, 0, "lie before the file"),
        (0, 255, "are cut off"),
        (515, 7, "of processor 7, not 84, 85 or 86"),
        (517, 0, "'POINT' is of no group"),
        (523, 90, "'POINT' has 3 bytes and says 90"),
    ],
)
def test_what_does_not_hold_together_is_told(tmp_path: Path, at: int, value: int, says: str) -> None:
    data = whole(tmp_path)
    data[at] = value
    assert says in fault(data)


def test_a_parameter_has_a_type_and_axes_that_there_are(tmp_path: Path) -> None:
    data = whole(tmp_path)
    kind = data.index(b"RATE") + 4 + 2
    assert data[kind] == 4
    for value, axes, says in ((3, 1, "'RATE' is of type 3 with 1 axes"), (4, 8, "with 8 axes"), (4, 7, "are cut off")):
        broken = data[: kind + 40]
        broken[kind : kind + 9] = bytes([value, axes, *[255] * 7])
        assert says in fault(broken)


def test_numbers_of_mips_have_their_first_byte_first(tmp_path: Path) -> None:
    entry = b"\x01\xffA" + (3).to_bytes(2, "big") + b"\0"
    assert fault(b"\x02\x50" + bytes(510) + bytes([1, 80, 1, 86]) + entry + b"\0") == ""
    assert "says 768" in fault(b"\x02\x50" + bytes(510) + bytes([1, 80, 1, 85]) + entry + b"\0")

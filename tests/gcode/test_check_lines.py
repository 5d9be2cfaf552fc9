"""A wrong checksum is found at its line; right ones, and asterisks elsewhere, are not."""

from hypothesis import given
from hypothesis import strategies as st

from gcode.check import check_text
from gcode.check_lines import checksum, line_findings
from gcode.printer import Printer

SOUND = ["G28 X Y", "M83", "M302 P1", "G0 Z10 F300", "G0 X100 Y100 F6000", "G0 Z1.6 F300", "G1 X110 Y100 E40 F240", "G0 Z10 F300"]


def numbered(lines: list[str]) -> list[str]:
    return [f"N{k} {line}*{checksum(f'N{k} {line}')}" for k, line in enumerate(lines, 1)]


def test_a_numbered_file_is_sound_and_each_wrong_sum_is_found(printer: Printer) -> None:
    lines = numbered(SOUND)
    assert check_text("\n".join(lines), printer) == ()
    for k, line in enumerate(lines):
        wrong = [*lines[:k], line.partition("*")[0] + f"*{checksum(line.partition('*')[0]) ^ 1}", *lines[k + 1 :]]
        (fault,) = check_text("\r\n".join(wrong), printer)
        assert fault.line == k + 1 and "its checksum is" in fault.what


def test_asterisks_elsewhere() -> None:
    assert not list(line_findings("; N1 * 5\nM117 a*b*3\nG0 X1 ; *7\nN4 G0 X1 ; a note *\nN5 G0 X1*"))
    assert not list(line_findings("N3 T0*57 ; a note"))


@given(st.text("NGM0123456789XYE.- ", min_size=1, max_size=40), st.integers(0, 39), st.integers(1, 255))
def test_one_byte_changed_is_always_found(body: str, at: int, other: int) -> None:
    line = "N7 " + body
    assert not list(line_findings(f"{line}*{checksum(line)}"))
    k = 3 + at % len(body)
    garbled = line[:k] + chr(ord(line[k]) ^ (1 if other % 2 else 2)) + line[k + 1 :]
    assert list(line_findings(f"{garbled}*{checksum(line)}"))

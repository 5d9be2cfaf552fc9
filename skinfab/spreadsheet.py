"""CSV as spreadsheets of all lands save it: the encoding is found, and the mark that parts the columns."""

from __future__ import annotations

import codecs
import csv
from pathlib import Path

from skinfab.errors import InputError


def read_csv_lines(path: str | Path, *, max_bytes: int, wanted: str) -> tuple[list[str], str]:
    """Lines of a CSV file, and what parts its columns: a comma, a semicolon or a tab.

    UTF-8 with and without byte order mark, UTF-16 and Windows-1252 (a spreadsheet's plain "CSV" in western Europe) are
    read. A first line such as ``sep=;`` is Excel's own and left out; lines that begin with ``#`` do not count as headings.

    Parameters
    ----------
    path : path
    max_bytes : int
        A larger file is refused.
    wanted : str
        What is to be given instead of a file that cannot be read, for the message.

    Raises
    ------
    InputError
        It cannot be read, is too large, or is no text.
    """
    path = Path(path)
    try:
        if (size := path.stat().st_size) > max_bytes:
            raise InputError(f"{path} has {size / 1e6:.0f} MB, which is too large here; give {wanted}")
        data = path.read_bytes()
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give {wanted}") from fault
    lines = _decoded(data, path, wanted).splitlines()
    if lines and lines[0].strip().strip('"').lower() in ("sep=,", "sep=;", "sep=\t", "sep="):
        # What it says is in the headings too; an own line number is kept by leaving the line empty.
        lines[0] = ""
    head = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    return lines, max(",;\t", key=head.count)


def read_csv_rows(path: str | Path, *, max_bytes: int, wanted: str) -> list[dict[str, str]]:
    """Rows of a CSV file by its headings, read as `read_csv_lines` does; remarks and empty lines are left out.

    A row that is too short has empty cells.

    Raises
    ------
    InputError
        As `read_csv_lines`, or a cell is out of all proportion.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.csv"
    >>> _ = path.write_text("# by hand\\nlog;label\\na.csv;felt\\nb.csv\\n")
    >>> read_csv_rows(path, max_bytes=1000, wanted="a table")
    [{'log': 'a.csv', 'label': 'felt'}, {'log': 'b.csv', 'label': ''}]
    """
    lines, delimiter = read_csv_lines(path, max_bytes=max_bytes, wanted=wanted)
    told = (line for line in lines if line.strip() and not line.startswith("#"))
    try:
        return list(csv.DictReader(told, restkey="", restval="", delimiter=delimiter))
    except csv.Error as fault:
        raise InputError(f"{path} is no table ({fault}); give {wanted}") from fault


def _decoded(data: bytes, path: Path, wanted: str) -> str:
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encodings = ["utf-16"]
    elif b"\0" in data:
        encodings = []
    else:
        encodings = ["utf-8-sig", "cp1252"]
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:  # no file can be called by it
            return text
    raise InputError(f"{path} is not a text file; give {wanted}")

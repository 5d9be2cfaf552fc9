"""CSV as spreadsheets of all lands save it: the encoding is found, and the mark that parts the columns."""

from __future__ import annotations

import codecs
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


def _decoded(data: bytes, path: Path, wanted: str) -> str:
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encodings = ["utf-16"]
    elif b"\0" in data:
        encodings = []
    else:
        encodings = ["utf-8-sig", "cp1252"]
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    raise InputError(f"{path} is not a text file; give {wanted}")

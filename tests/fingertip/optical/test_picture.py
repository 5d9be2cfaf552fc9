"""One picture: what is damaged or larger than any camera's is refused before it takes memory."""

import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.picture import read_picture

GREY = np.arange(48, dtype=np.uint8).reshape(6, 8)


def png() -> bytes:
    return cv2.imencode(".png", GREY)[1].tobytes()


@pytest.mark.parametrize("suffix", [".png", ".bmp", ".tif", ".pgm"])
def test_pictures_of_all_kinds(tmp_path: Path, suffix: str) -> None:
    cv2.imwrite(str(tmp_path / f"a{suffix}"), GREY)
    image, simulated = read_picture(tmp_path / f"a{suffix}")
    assert (image == GREY).all() and not simulated


@pytest.mark.parametrize("at", range(8, len(png()) - 8))
def test_a_png_hit_anywhere_is_none_and_says_one_line(tmp_path: Path, capfd: pytest.CaptureFixture[str], at: int) -> None:
    """A chunk's length alone made OpenCV take 4 GB: found by a search."""
    data = bytearray(png())
    data[at] ^= 0xFF
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(InputError, match=r"is no picture that can be read|million pixels"):
        read_picture(tmp_path / "a.png")
    assert capfd.readouterr().err == ""


def test_a_png_cut_off_anywhere_is_none(tmp_path: Path) -> None:
    for size in range(len(png())):
        (tmp_path / "a.png").write_bytes(png()[:size])
        with pytest.raises(InputError, match="is no picture"):
            read_picture(tmp_path / "a.png")


def claims(width: int, height: int) -> list[bytes]:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    heading = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return [
        b"\x89PNG\r\n\x1a\n" + heading + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b""),
        b"P5\n%d %d\n255\n" % (width, height) + bytes(100),
        b"BM" + struct.pack("<IHHIIiiHHIIiiII", 100, 0, 0, 54, 40, width, height, 1, 8, 0, 0, 0, 0, 0, 0) + bytes(100),
    ]


@pytest.mark.parametrize("size", [(8000, 8000), (10_000, 10_000), (30_000, 30_000)])
def test_what_claims_more_than_a_cameras_pixels_is_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    for data in claims(*size):
        (tmp_path / "a").write_bytes(data)
        with pytest.raises(InputError, match="of more than 50 million pixels"):
            read_picture(tmp_path / "a")


def test_a_file_too_large_is_not_read_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skinfab.fingertip.optical.picture.MAX_BYTES", 50)
    (tmp_path / "a.png").write_bytes(png())
    with pytest.raises(InputError, match="of more than 50 million pixels"):
        read_picture(tmp_path / "a.png")


def test_what_no_file_can_be_called(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="embedded null byte; give a picture"):
        read_picture(f"{tmp_path}/a\0b.png")

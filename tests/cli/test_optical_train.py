"""`skinfab optical train` and `run`: learned from images, judged on others, and used on a folder and a video."""

import contextlib
import csv
import io
import json
import os
import shutil
import signal
import time
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.fingertip.optical.simulator import Fingertip
from skinfab.fingertip.optical.source import EdgeSource
from skinfab.readout.frame import Frame

TRAIN, RUN = ["errors.csv", "model.npz", "result.json", "train.png"], ["edges.csv", "optical.png", "result.json"]


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("optical")
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["optical", "simulate", "--images", "100", "--reach", "3", "--depth", "1.6", "2.4", "-o", str(folder / "sim")]) == 0
        assert main(["optical", "train", "--targets", str(folder / "sim/targets.csv"), "-o", str(folder / "train")]) == 0
    return folder


def test_held_out_errors_are_told(made: Path) -> None:
    assert sorted(each.name for each in (made / "train").iterdir()) == TRAIN
    result = json.loads((made / "train/result.json").read_text())
    assert result["simulated"] and result["images"] == 100 and result["groups"] == 10 and result["pins"] == 127
    assert not result["notes"] and 0 < result["held_out"]["sure"] <= 100
    table = rows(made / "train/errors.csv")
    assert [row["quantity"] for row in table] == ["offset", "depth", "angle"] and {row["simulated"] for row in table} == {"1"}
    for row in table:
        assert float(row["low"]) < float(row["mean"]) < float(row["high"]) < float(row["guess"])
    assert float(table[0]["mean"]) < 0.8


def test_columns_and_test_table_are_named(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = rows(made / "sim/targets.csv")
    for name, part in (("learn", table[:80]), ("test", table[80:])):
        lines = ["pic,y,yaw", *(f"{Path(row['image']).name},{row['offset_mm']},{row['angle_deg']}" for row in part)]
        (tmp_path / f"{name}.csv").write_text("\n".join(lines) + "\n")
    images = str(made / "sim/images")
    columns = ["--image-column", "pic", "--offset-column", "y", "--angle-column", "yaw"]
    words = ["optical", "train", "--targets", str(tmp_path / "learn.csv"), "--images", images, *columns, "--count", "60", "--json"]
    test = ["--test-targets", str(tmp_path / "test.csv"), "--test-images", images]
    assert main([*words, *test, "-o", str(tmp_path / "out")]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["images"] == 60 and said["held_out"]["images"] == 20 and said["simulated"]
    assert [each["quantity"] for each in said["held_out"]["errors"]] == ["offset", "angle"]
    assert any("depth is not learned" in note for note in said["notes"])
    again = ["--test-targets", str(tmp_path / "learn.csv"), "--test-images", images]
    assert main([*words, *again, "-o", str(tmp_path / "out")]) == 1
    assert "which was learned from" in capsys.readouterr().err
    assert main([*words, "--test-images", images, "-o", str(tmp_path / "out")]) == 2


def test_tables_that_cannot_be_used_are_refused(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (made / "sim/targets.csv").read_text()
    shutil.copytree(made / "sim/images", tmp_path / "images")
    whole, lines = (tmp_path / "images/00007.png").read_bytes(), text.splitlines()
    shutil.copy(tmp_path / "images/00001.png", tmp_path / "images/copy.png")
    for wrong, words in (
        (text, "00007.png is no picture"),
        (text.replace("images/00009", "images/x"), "images/x.png: No such file"),
        ("\n".join([*lines[:3], lines[2]]), "twice"),
        (text.replace("offset_mm", "off"), "has no column 'offset_mm'"),
        ("\n".join([lines[0], lines[1].replace(",0.", ",?", 1).replace(",1", ",x"), *lines[2:]]), "is not a number"),
        ("\n".join([*lines, lines[1].replace("images/", "./images/")]), "'./images/00001.png' twice (as 'images/00001.png' first)"),
        (
            "\n".join([*lines, lines[40].replace("00040.png", "copy.png")]),
            "'images/00001.png' and 'images/copy.png' are alike in every pixel and of other groups",
        ),
        (
            "\n".join([lines[0], *(line.replace(",", ";").replace(".", ",").replace(",png", ".png") for line in lines[1:])]).replace(
                lines[0], lines[0].replace(",", ";")
            ),
            "has a decimal comma; write a point",
        ),
        (lines[0], "has no rows"),
    ):
        (tmp_path / "targets.csv").write_text(wrong)
        (tmp_path / "images/00007.png").write_bytes(b"" if wrong is text else whole)
        assert main(["optical", "train", "--targets", str(tmp_path / "targets.csv"), "-o", str(tmp_path / "out")]) == 1
        assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_chance_is_named_and_a_constant_refused(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = rows(made / "sim/targets.csv")
    words = ["optical", "train", "--images", str(made / "sim/images"), "--targets", str(tmp_path / "t.csv"), "-o", str(tmp_path / "out")]
    others = iter(table[37:] + table[:37])
    rewritten(table, tmp_path / "t.csv", lambda _: float(next(others)["offset_mm"]))
    assert main(words) == 0
    out = capsys.readouterr()
    assert "offset: " in out.err and "who says the same of every image: nothing was learned" in out.err and "depth: " not in out.err
    assert out.out.count("(a guess: ") == 3 and "more than half sure of" in out.out
    rewritten(table, tmp_path / "t.csv", lambda _: 2.5)
    assert main([*words[:-1], str(tmp_path / "none")]) == 1
    assert "'offset_mm' is 2.5 in all images" in capsys.readouterr().err and not (tmp_path / "none").exists()


def rewritten(table: list[dict[str, str]], path: Path, offset: Callable[[float], float]) -> None:
    """The table with other offsets."""
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(table[0]))
        writer.writeheader()
        writer.writerows({**row, "offset_mm": offset(float(row["offset_mm"]))} for row in table)


def test_results_do_not_go_among_the_pictures(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = made / "sim/images"
    assert main(["optical", "run", str(folder), "--model", str(made / "train/model.npz"), "-o", f"{folder}/../images"]) == 1
    assert "holds the pictures" in capsys.readouterr().err and not (folder / "optical.png").exists()


def test_a_folder_and_a_video_are_read(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(made / "sim/images", tmp_path / "images")
    for name in ("00007.png", "00012.png"):
        (tmp_path / "images" / name).write_bytes(b"")
    model = ["--model", str(made / "train/model.npz")]
    assert main(["optical", "run", str(tmp_path / "images"), *model, "-o", str(tmp_path / "folder"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["simulated"] and said["pictures"] == 98 and said["unreadable"] == 2
    assert sum("00007.png is no picture" in note and note.endswith("passed over, as was one more") for note in said["notes"]) == 1
    assert sorted(each.name for each in (tmp_path / "folder").iterdir()) == RUN
    felt, true = rows(tmp_path / "folder/edges.csv"), rows(made / "sim/targets.csv")
    assert abs(float(felt[0]["offset_mm"]) - float(true[0]["offset_mm"])) < 1 and felt[0]["simulated"] == "1"
    path = tmp_path / "some.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 25, (240, 240), False)
    for k in range(1, 6):
        writer.write(cv2.imread(str(made / f"sim/images/{k:05d}.png"), cv2.IMREAD_GRAYSCALE))
    writer.release()
    assert main(["optical", "run", str(path), *model, "-o", str(tmp_path / "video")]) == 0
    assert "5 pictures" in capsys.readouterr().out
    assert main(["optical", "run", "--camera", str(path), *model, "-o", str(tmp_path / "camera")]) == 0
    assert "mm off the plate" in capsys.readouterr().out
    assert {row["simulated"] for row in rows(tmp_path / "camera/edges.csv")} == {"1"}


def test_run_keeps_no_picture(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """A camera runs for hours: what is kept of a picture is its name, its times and what was felt."""
    images: list[weakref.ref[np.ndarray]] = []
    left: list[int] = []
    read, close = EdgeSource.read, EdgeSource.close

    def reading(self: EdgeSource, timeout: float | None = None) -> Frame | None:
        frame = read(self, timeout)
        if frame is not None and self.last is not None:
            images.append(weakref.ref(self.last.image))
        return frame

    def closing(self: EdgeSource) -> None:
        left.append(sum(image() is not None for image in images))
        close(self)

    monkeypatch.setattr(EdgeSource, "read", reading)
    monkeypatch.setattr(EdgeSource, "close", closing)
    assert main(["optical", "run", str(made / "sim/images"), "--model", str(made / "train/model.npz"), "-o", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["pictures"] == len(images) == 100 and left == [1]  # the source's own last one


def test_rest_is_for_a_camera_that_has_moved(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "images").mkdir()
    tip = Fingertip()
    cv2.imwrite(str(tmp_path / "rest.png"), np.roll(tip.image(tip.rest), 3, axis=1))
    for k in range(1, 11):
        image = cv2.imread(str(made / f"sim/images/{k:05d}.png"), cv2.IMREAD_GRAYSCALE)
        cv2.imwrite(str(tmp_path / f"images/{k}.png"), np.roll(image, 3, axis=1))
    words = ["optical", "run", str(tmp_path / "images"), "--model", str(made / "train/model.npz"), "-o", str(tmp_path / "out"), "--json"]
    sure = []
    for rest in ([], ["--rest", str(tmp_path / "rest.png")]):
        assert main([*words, *rest]) == 0
        said = json.loads(capsys.readouterr().out)
        sure.append(said["sure"])
    assert sure[0] == 0 and sure[1] >= 5
    assert said["rest"]["shift_px"] == pytest.approx(3, abs=0.3) and said["rest"]["turn_deg"] == pytest.approx(0, abs=0.2)
    assert "--rest" not in " ".join(said["notes"])
    turned = cv2.warpAffine(tip.image(tip.rest), cv2.getRotationMatrix2D((119.5, 119.5), 10.0, 1.0), (240, 240))
    cv2.imwrite(str(tmp_path / "rest.png"), turned)
    assert main([*words[:-1], "--rest", str(tmp_path / "rest.png")]) == 0
    shown = capsys.readouterr()
    assert "of a pin's pitch" in shown.err and "the camera has moved by " in shown.out
    cv2.imwrite(str(tmp_path / "rest.png"), np.zeros((240, 240), np.uint8))
    assert main([*words, "--rest", str(tmp_path / "rest.png")]) == 1
    assert "127 of 127 pins are not found in the image at rest" in capsys.readouterr().err
    cv2.imwrite(str(tmp_path / "rest.png"), np.zeros((128, 200), np.uint8))
    train = ["optical", "train", "--targets", str(made / "sim/targets.csv"), "-o", str(tmp_path / "learned")]
    for command in (words, train):
        assert main([*command, "--rest", str(tmp_path / "rest.png")]) == 1
        assert "(--rest), is of 200 x 128 pixels, and the images that are learned from are of 240 x 240" in capsys.readouterr().err


class Camera:
    """In OpenCV's place: simulated contacts, the first one late; Ctrl-C comes with the `press`-th, the `small`-th has another size."""

    def __init__(self, folder: Path, count: int, *, press: int = -1, small: int = -1, late_s: float = 0.0) -> None:
        self.folder, self.count, self.press, self.small, self.late_s, self.taken = folder, count, press, small, late_s, 0

    def isOpened(self) -> bool:
        return True

    def get(self, setting: int) -> float:
        return 30.0

    def release(self) -> None:
        """Nothing to give back."""

    def read(self) -> tuple[bool, np.ndarray | None]:
        time.sleep(0.02 if self.taken else self.late_s)  # slower than they are read
        if self.taken == self.press:
            time.sleep(0.3)
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.1)
        if self.taken == self.count:
            return False, None
        self.taken += 1
        image = cv2.imread(str(self.folder / f"{self.taken:05d}.png"), cv2.IMREAD_GRAYSCALE)
        return True, image[:200] if self.taken - 1 == self.small else image


@pytest.fixture
def from_camera(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., int]]:
    def run(camera: Camera, *words: str) -> int:
        monkeypatch.setattr(cv2, "VideoCapture", lambda what, backend, settings: camera)
        model = str(made / "train/model.npz")
        return main(["optical", "run", "--camera", "0", "--model", model, "-o", str(tmp_path / "out"), *words])

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield run
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_ends_a_camera_and_a_second_one_does_not_lose_what_it_saw(
    made: Path, tmp_path: Path, from_camera: Callable[..., int], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def drawing(times: list[float], edges: object, path: Path, **words: object) -> None:
        signal.raise_signal(signal.SIGINT)
        path.write_bytes(b"")

    monkeypatch.setattr("skinfab.fingertip.optical.figure.draw_run", drawing)
    assert from_camera(Camera(made / "sim/images", 90, press=4), "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["pictures"] == len(rows(tmp_path / "out/edges.csv")) == 4 and said["notes"] == []
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == RUN


def test_ctrl_c_before_the_first_picture_is_an_interrupt(
    made: Path, tmp_path: Path, from_camera: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert from_camera(Camera(made / "sim/images", 0, press=0)) == 130
    assert "interrupted" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_seconds_count_from_the_first_picture(made: Path, from_camera: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    assert from_camera(Camera(made / "sim/images", 90, late_s=0.4), "--seconds", "0.1", "--json") == 0
    assert 1 <= json.loads(capsys.readouterr().out)["pictures"] < 90


def test_a_camera_that_goes_or_changes_is_told_and_what_came_before_is_kept(
    made: Path, tmp_path: Path, from_camera: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert from_camera(Camera(made / "sim/images", 5)) == 0
    assert "note: camera 0 gave no more after 0." in capsys.readouterr().err
    assert from_camera(Camera(made / "sim/images", 4, small=3), "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["pictures"] == 3 and "240 x 200 pixels" in said["notes"][0] and said["notes"][0].endswith("; what came before is kept")
    assert from_camera(Camera(made / "sim/images", 1, small=0)) == 1
    assert "240 x 200 pixels" in capsys.readouterr().err


def test_wrong_use_says_what_is_right(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = ["--model", str(made / "train/model.npz"), "-o", str(tmp_path / "out")]
    for words in (["run", *model], ["run", "x", "--camera", "0", *model], ["run", "x", "--seconds", "3", *model]):
        assert main(["optical", *words]) == 2
    capsys.readouterr()
    assert main(["optical", "run", "--camera", "77", *model]) == 1
    assert "there is no camera 77" in capsys.readouterr().err
    assert main(["optical", "run", str(made / "sim/targets.csv"), *model]) == 1
    assert "no video that can be read" in capsys.readouterr().err

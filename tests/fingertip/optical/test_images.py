"""Pictures from folders, videos and cameras: in order, with their times, and with what was lost or broken counted and named."""

import itertools
import shutil
import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.camera import WAITING, CameraImages
from skinfab.fingertip.optical.images import FolderImages, VideoImages
from skinfab.fingertip.optical.labelled import labelled
from skinfab.fingertip.optical.model_file import load_edge, save_edge
from skinfab.fingertip.optical.picture import read_picture
from skinfab.fingertip.optical.regress import EdgeModel, train
from skinfab.fingertip.optical.simulator import Fingertip
from skinfab.fingertip.optical.source import EdgeSource
from skinfab.readout.frame import Recording
from skinfab.readout.source import StaleError

COUNT, RATE = 12, 25


def numbered(k: int) -> np.ndarray:
    return np.full((64, 64), 10 * k + 20, np.uint8)


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("video") / "some.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), RATE, (64, 64), False)
    for k in range(COUNT):
        writer.write(numbered(k))
    writer.release()
    return path


def test_a_folder_is_read_in_the_order_of_its_numbers(tmp_path: Path) -> None:
    for k in (10, 9, 2):
        cv2.imwrite(str(tmp_path / f"image_{k}.png"), numbered(k))
    (tmp_path / "image_3.png").write_bytes(b"no picture")
    (tmp_path / "image_4.png").write_bytes((tmp_path / "image_2.png").read_bytes()[:40])
    (tmp_path / "targets.csv").write_text("image\n")
    with FolderImages(tmp_path, rate_hz=10) as source:
        each = list(source)
        assert [(one.name, round(one.device_time, 3), one.sequence) for one in each] == [
            ("image_2.png", 0.0, 0),
            ("image_9.png", 0.3, 3),
            ("image_10.png", 0.4, 4),
        ]
        assert [int(one.image[0, 0]) for one in each] == [40, 110, 120]
        assert source.counts.frames == 3 and source.counts.bad == 2 and source.ended
        assert len(source.notes) == 1 and "image_3.png is no picture" in source.notes[0]
        assert source.notes[0].endswith("; it was passed over, as was one more")
    assert len(list(source.open())) == 3  # again


def test_a_video_keeps_its_times(video: Path) -> None:
    with VideoImages(video) as source:
        each = list(source)
    assert source.rate_hz == RATE and source.counts.frames == COUNT and source.counts.lost == 0
    np.testing.assert_allclose([one.device_time for one in each], np.arange(COUNT) / RATE, atol=1e-6)
    np.testing.assert_allclose([one.image.mean() for one in each], [numbered(k).mean() for k in range(COUNT)], atol=3)
    assert all(b.host_time >= a.host_time for a, b in itertools.pairwise(each))


def test_a_camera_that_is_not_read_in_time_loses_the_oldest(video: Path) -> None:
    """A file in the camera's place is as fast as it can be read: nobody waits for the reader."""
    with CameraImages(str(video)) as source:
        end = time.monotonic() + 10
        while source.counts.lost != COUNT - WAITING and time.monotonic() < end:
            time.sleep(0.01)
        each = list(source)
    assert source.counts.lost == COUNT - WAITING and source.counts.frames == WAITING
    assert [one.sequence for one in each] == list(range(COUNT - WAITING, COUNT)) and source.ended


def test_what_is_not_there_is_named(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="holds no picture"):
        FolderImages(tmp_path)
    with pytest.raises(InputError, match="No such file"):
        FolderImages(tmp_path / "none")
    with pytest.raises(InputError, match="no such file"):
        VideoImages(tmp_path / "none.avi")
    (tmp_path / "text.avi").write_text("no video")
    with pytest.raises(InputError, match="no video that can be read"):
        VideoImages(tmp_path / "text.avi")
    with pytest.raises(InputError, match="there is no camera 77"):
        CameraImages(77).open()
    assert capfd.readouterr().err == ""  # OpenCV's warnings say nothing more


@pytest.fixture(scope="module")
def model() -> EdgeModel:
    each = list(labelled(Fingertip(), 40, reach_mm=3))
    return train([one.image for one in each], [one.edge for one in each])


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pressed")
    for k, one in enumerate(labelled(Fingertip(), 3, reach_mm=3, seed=5)):
        cv2.imwrite(str(folder / f"{k}.png"), one.image)
    return folder


def test_a_fingertip_is_a_source_of_the_readout_layer(model: EdgeModel, pressed: Path) -> None:
    with EdgeSource(FolderImages(pressed, rate_hz=20), model) as source:
        recording = Recording.of_frames(source.stream, source)
    assert recording.stream.names == ("offset", "depth", "angle", "confidence") and recording.stream.rate_hz == 20
    assert len(recording) == source.counts.frames == 3 and recording.valid.all()
    np.testing.assert_allclose(recording.device_time, [0, 0.05, 0.1])
    edge = model.edge(cv2.imread(str(pressed / "1.png"), cv2.IMREAD_GRAYSCALE))
    np.testing.assert_allclose(recording.values[1], [edge.offset_mm, edge.depth_mm, np.degrees(edge.angle_rad), edge.confidence])


def test_the_newest_frame_has_an_age(model: EdgeModel, pressed: Path) -> None:
    with EdgeSource(FolderImages(pressed), model) as source:
        assert source.read_latest(5.0).sequence == 0
        time.sleep(0.05)
        assert source.read_latest(5.0).sequence == 1
        assert source.read() is not None and source.read() is None
        with pytest.raises(StaleError, match="s old"):
            source.read_latest(1e-6)
    with EdgeSource(FolderImages(pressed), model) as source:
        list(source)
    source.open().images.close()
    with pytest.raises(StaleError, match="no frame yet"):
        source.read_latest(1.0)


def test_a_picture_of_another_size_is_named_and_the_others_are_read(model: EdgeModel, pressed: Path, video: Path, tmp_path: Path) -> None:
    shutil.copytree(pressed, tmp_path / "some")
    cv2.imwrite(str(tmp_path / "some/0a.png"), numbered(1))
    with EdgeSource(FolderImages(tmp_path / "some"), model) as source:
        assert len(list(source)) == source.counts.frames == 3 and source.counts.bad == 1
        assert source.images.notes == ["0a.png is of 64 x 64 pixels, and the model is of 240 x 240; it was passed over"]
    for k in range(3):
        cv2.imwrite(str(tmp_path / f"some/1{k}.png"), numbered(1))
    (tmp_path / "some/9.png").write_bytes(b"")
    with EdgeSource(FolderImages(tmp_path / "some"), model) as source:
        assert len(list(source)) == 3 and source.counts.bad == 5
        assert [note.partition("; it was")[2] for note in source.images.notes] == [" passed over, as were 3 others", " passed over"]
    with EdgeSource(VideoImages(video), model) as source, pytest.raises(InputError, match="an image of 64 x 64 pixels"):
        source.read()  # none of them will do


def test_what_is_worked_out_once_is_there_before_the_first_picture(model: EdgeModel, pressed: Path, tmp_path: Path) -> None:
    save_edge(tmp_path / "model.npz", model, {})
    fresh, _ = load_edge(tmp_path / "model.npz")
    with EdgeSource(FolderImages(pressed), fresh):
        assert {"_owner", "_near"} <= fresh.pins.__dict__.keys() and {"_support_square", "_scale"} <= fresh.__dict__.keys()


def test_opencv_says_nothing_of_its_own(pressed: Path, video: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    whole = (pressed / "0.png").read_bytes()
    (tmp_path / "cut.png").write_bytes(whole[: len(whole) // 2])
    writer = cv2.VideoWriter(str(tmp_path / "whole.mp4"), cv2.VideoWriter_fourcc(*"mp4v"), RATE, (64, 64), False)
    for k in range(COUNT):
        writer.write(numbered(k))
    writer.release()
    (tmp_path / "cut.mp4").write_bytes((tmp_path / "whole.mp4").read_bytes()[:1000])
    (tmp_path / "cut.avi").write_bytes(video.read_bytes()[:1000])
    with pytest.raises(InputError, match="no picture that can be read"):
        read_picture(tmp_path / "cut.png")
    with pytest.raises(InputError, match="no video that can be read"):
        VideoImages(tmp_path / "cut.mp4")
    with pytest.raises(InputError, match="no video that can be read"):
        VideoImages(tmp_path / "cut.avi")
    assert capfd.readouterr().err == ""


def test_what_was_learned_of_two_greys_is_read_as_jpeg_and_as_video(tmp_path: Path) -> None:
    each = list(labelled(Fingertip(), 60, reach_mm=3))
    greys = [np.where(one.image > 128, 255, 0).astype(np.uint8) for one in each]
    model = train(greys[:40], [one.edge for one in each[:40]])
    writer = cv2.VideoWriter(str(tmp_path / "some.avi"), cv2.VideoWriter_fourcc(*"MJPG"), RATE, (240, 240), False)
    for kind in ("png", "jpg"):
        (tmp_path / kind).mkdir()
    for k, grey in enumerate(greys):
        writer.write(grey)
        for kind in ("png", "jpg"):
            cv2.imwrite(str(tmp_path / f"{kind}/{k}.{kind}"), grey)
    writer.release()
    felt = []
    for images in (FolderImages(tmp_path / "png"), FolderImages(tmp_path / "jpg"), VideoImages(tmp_path / "some.avi")):
        with EdgeSource(images, model) as source:
            felt.append(np.array([frame.values for frame in source]))
    assert np.median(felt[0][:, 3]) > 0.5
    for other in felt[1:]:
        offset, depth, angle, confidence = (other - felt[0]).T
        assert np.abs(offset).max() < 0.2 and np.abs(depth).max() < 0.1 and np.abs(confidence).max() < 0.3
        assert np.abs((angle + 180) % 360 - 180)[felt[0][:, 3] > 0.5].max() < 5

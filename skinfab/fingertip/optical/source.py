"""An optical fingertip as a source of the readout layer: a frame a picture, whose channels are what the fingertip feels.

So logs, watches and controllers take it as any other sensor.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from types import TracebackType
from typing import Self

import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.optical.camera import CameraImages
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.images import FolderImages, ImageSource, Picture
from skinfab.fingertip.optical.regress import EdgeModel
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.source import Counts, HostClock, StaleError

#: What an optical fingertip's frames hold.
CHANNELS = (
    Channel("offset", "mm", "optical"),
    Channel("depth", "mm", "optical"),
    Channel("angle", "deg", "optical"),
    Channel("confidence", "", "optical", 0.0),
)


class EdgeSource:
    """Frames of what an optical fingertip feels; pictures of a folder that are not of the model's size are passed over with a note.

    Parameters
    ----------
    images : ImageSource
    model : EdgeModel

    Attributes
    ----------
    last : Picture or None
        What the last frame was made of.
    last_ms : float
        How long that took.

    Raises
    ------
    InputError
        On reading: a video's or camera's images are of another size than those of the training.
    """

    def __init__(self, images: ImageSource, model: EdgeModel) -> None:
        self.images, self._model = images, model
        self.stream = Stream(f"optical fingertip, {images.name}", CHANNELS, images.rate_hz, images.simulated)
        self.last: Picture | None = None
        self.last_ms = math.nan
        self._newest: Frame | None = None

    @property
    def counts(self) -> Counts:
        """Those of the images."""
        return self.images.counts

    def open(self) -> Self:
        """Begin."""
        # What is worked out once (whose pixel is which pin's, above all) is not to delay the first picture.
        self._model.edge_of(self._model.pins.match(self._model.pins.rest))
        self._model.edge(np.zeros(self._model.pins.shape, np.uint8))
        self.images.open()
        self.stream = replace(self.stream, rate_hz=self.images.rate_hz)
        self.last, self._newest = None, None
        return self

    def close(self) -> None:
        """Give no more."""
        self.images.close()

    def read(self, timeout: float | None = None) -> Frame | None:
        """What the next picture shows; None after `timeout` seconds without one, or at the end."""
        picture = self.images.read(timeout)
        while picture is not None and isinstance(self.images, FolderImages) and picture.image.shape != self._model.pins.shape:
            self.images.pass_over(picture, "and the model is of {1} x {0}".format(*self._model.pins.shape))
            picture = self.images.read(timeout)
        if picture is None:
            return None
        self.last, began = picture, time.perf_counter()
        try:
            self._newest = self._frame(picture, self._model.edge(picture.image))
        except InputError as fault:
            raise InputError(f"{self.images.name}, picture {picture.name}: {fault}") from fault
        self.last_ms = 1000 * (time.perf_counter() - began)
        return self._newest

    def read_latest(self, max_age: float) -> Frame:
        """The newest frame there is; those before it are passed over.

        Raises
        ------
        StaleError
            It is older than `max_age` seconds, or there is none.
        """
        while self.read(0.0) is not None and isinstance(self.images, CameraImages):
            pass
        if self._newest is None:
            raise StaleError(f"{self.stream.name} has given no frame yet; open it, and wait for one")
        age = HostClock().now() - self._newest.host_time
        if age > max_age:
            raise StaleError(f"the newest frame of {self.stream.name} is {age:.3g} s old, and {max_age:g} s are allowed")
        return self._newest

    def _frame(self, picture: Picture, edge: Edge) -> Frame:
        values = np.array([edge.offset_mm, edge.depth_mm, math.degrees(edge.angle_rad), edge.confidence])
        valid = np.isfinite(values)
        return Frame(picture.device_time, picture.host_time, picture.sequence, values, valid, np.zeros(len(values), dtype=bool))

    def __iter__(self) -> Iterator[Frame]:
        while (frame := self.read()) is not None:
            yield frame

    def __enter__(self) -> Self:
        return self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

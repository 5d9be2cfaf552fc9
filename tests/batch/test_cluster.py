"""Where the workers of a batch come from; `test_run` has real ones."""

import signal
from pathlib import Path

import pytest

from skinfab.batch.cluster import connected


def test_an_interrupt_while_workers_start_waits_for_them_and_ends_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a cluster whose making was broken off nobody would know, and Dask complained of it with a traceback as Python ended."""
    happened: list[str] = []

    class Cluster:
        def __init__(self, **settings: object) -> None:
            happened.append("begun")
            signal.raise_signal(signal.SIGINT)
            happened.append("made")

        def close(self) -> None:
            happened.append("closed")

    monkeypatch.setattr("distributed.LocalCluster", Cluster)
    with pytest.raises(KeyboardInterrupt), connected(folder=tmp_path, scheduler=None, workers=2):
        happened.append("used")
    assert happened == ["begun", "made", "closed"]

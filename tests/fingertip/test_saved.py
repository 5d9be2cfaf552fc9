"""Model files: what is saved is loaded bit by bit, and whatever else is given as one is refused in a sentence."""

import io
import json
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.saved import load_model, save_model

numbers = hnp.arrays(np.float64, hnp.array_shapes(max_dims=3, max_side=4), elements=st.floats(allow_nan=False, allow_infinity=False))


class Alarm:
    def __reduce__(self) -> tuple[Any, ...]:
        return (pytest.fail, ("the pickle was run",))


@pytest.fixture
def model(tmp_path: Path) -> Path:
    save_model(tmp_path / "m.npz", kind="demo", facts={"names": ["a"]}, arrays={"w": np.arange(6.0).reshape(2, 3), "n": np.arange(4)})
    return tmp_path / "m.npz"


def members(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def rewritten(path: Path, **changed: bytes | None) -> Path:
    each = members(path) | {name.replace("__", "."): data for name, data in changed.items()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in each.items():
            if data is not None:
                archive.writestr(name, data)
    return path


def head(path: Path, **changed: object) -> bytes:
    return json.dumps(json.loads(members(path)["model.json"]) | changed).encode()


@settings(deadline=None, max_examples=30)
@given(numbers, st.dictionaries(st.text(max_size=5), st.integers() | st.text(max_size=5), max_size=3))
def test_what_is_saved_is_loaded(tmp_path_factory: pytest.TempPathFactory, array: np.ndarray, facts: dict[str, object]) -> None:
    path = tmp_path_factory.mktemp("m") / "m.npz"
    save_model(path, kind="demo", facts=facts, arrays={"w": array}, version=2)
    loaded = load_model(path, kind=("other", "demo"), version=3)
    assert loaded.facts == facts and loaded.version == 2 and loaded.kind == "demo"
    assert loaded.arrays["w"].shape == array.shape and loaded.arrays["w"].tobytes() == array.tobytes()
    first = path.read_bytes()
    save_model(path, kind="demo", facts=facts, arrays={"w": array}, version=2)
    assert path.read_bytes() == first


def test_numpy_opens_the_arrays(model: Path) -> None:
    with np.load(model, allow_pickle=False) as arrays:
        assert arrays["w"].tolist() == [[0, 1, 2], [3, 4, 5]] and arrays["n"].dtype == np.int64


def test_what_is_not_finite_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match="not finite"):
        save_model(tmp_path / "m.npz", kind="demo", facts={}, arrays={"w": np.array([np.nan])})
    with pytest.raises(ValueError, match="JSON"):
        save_model(tmp_path / "m.npz", kind="demo", facts={"error": float("nan")}, arrays={})
    assert list(tmp_path.iterdir()) == []


def test_another_kind_and_a_later_version(model: Path) -> None:
    with pytest.raises(InputError, match=r"m.npz: it is a model of another kind, 'demo', and 'nail phasors' is wanted; train it again"):
        load_model(model, kind="nail phasors")
    rewritten(model, model__json=head(model, version=2))
    with pytest.raises(InputError, match=r"later skinfab \(version 2; 1 is understood\): update"):
        load_model(model, kind="demo")


@pytest.mark.parametrize("version", [0, True, "1", None, 1.0])
def test_a_version_that_is_none(model: Path, version: object) -> None:
    rewritten(model, model__json=head(model, version=version))
    with pytest.raises(InputError, match="its version is"):
        load_model(model, kind="demo")


def test_every_length_it_may_be_cut_to(model: Path, tmp_path: Path) -> None:
    whole = model.read_bytes()
    for length in range(0, len(whole), 7):
        (tmp_path / "cut.npz").write_bytes(whole[:length])
        with pytest.raises(InputError, match=r"cut\.npz"):
            load_model(tmp_path / "cut.npz", kind="demo")


def test_a_bit_that_flipped(model: Path) -> None:
    whole = bytearray(model.read_bytes())
    where = whole.index(np.float64(5.0).tobytes())
    whole[where] ^= 1
    model.write_bytes(whole)
    with pytest.raises(InputError, match=r"not a whole model .*CRC"):
        load_model(model, kind="demo")


def test_a_pickle_is_never_run(model: Path, tmp_path: Path) -> None:
    for protocol in (2, 3, 4, 5):
        (tmp_path / "p.pkl").write_bytes(pickle.dumps(Alarm(), protocol=protocol))
        with pytest.raises(InputError, match="is a pickle, which could run anything"):
            load_model(tmp_path / "p.pkl", kind="demo")
    inside = io.BytesIO()
    np.save(inside, np.array([Alarm()], dtype=object), allow_pickle=True)
    rewritten(model, w__npy=inside.getvalue())
    with pytest.raises(InputError, match=r"w\.npy"):
        load_model(model, kind="demo")
    rewritten(model, model__json=head(model, arrays={"w": ["|O", 1]}))
    with pytest.raises(InputError, match="only plain numbers are read"):
        load_model(model, kind="demo")


def test_files_of_others(tmp_path: Path) -> None:
    np.savez(tmp_path / "foreign.npz", w=np.zeros(3))
    with pytest.raises(InputError, match=r"model.json is missing; not a model of a fingertip"):
        load_model(tmp_path / "foreign.npz", kind="demo")
    (tmp_path / "text.npz").write_text("hello")
    with pytest.raises(InputError, match="not a whole model"):
        load_model(tmp_path / "text.npz", kind="demo")
    with pytest.raises(InputError, match="no such file"):
        load_model(tmp_path / "none.npz", kind="demo")
    with pytest.raises(InputError, match="is a folder"):
        load_model(tmp_path, kind="demo")


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"arrays": {"w": ["<f8", 2, 2]}}, r"w.npy has shape \(2, 3\); model.json says \(2, 2\)"),
        ({"arrays": {"w": ["<f8", 10**9, 10**9]}}, "no model is that large"),
        ({"arrays": {"w": ["<f8", -2, -3]}}, "no size can be negative"),
        ({"arrays": {"w": []}}, "is not one of a model"),
        ({"arrays": {"w": ["<f8", "x"]}}, "is not one of a model"),
        ({"arrays": [1]}, "is not one of a model"),
        ({"arrays": {"gone": ["<f8", 2]}}, "gone.npy is missing"),
        ({"facts": 3}, "is not one of a model"),
    ],
)
def test_a_head_that_lies(model: Path, changed: dict[str, object], says: str) -> None:
    rewritten(model, model__json=head(model, **changed))
    with pytest.raises(InputError, match=says):
        load_model(model, kind="demo")


def test_an_array_that_is_gone(model: Path) -> None:
    rewritten(model, w__npy=None)
    with pytest.raises(InputError, match=r"w\.npy is missing"):
        load_model(model, kind="demo")

"""Recent files and the theme, from one run to the next."""

import pytest

from gui.state.store import MOST_RECENT, Remembered, recall, remember, state_folder


def test_what_is_remembered_is_recalled(tmp_path):
    what = Remembered(theme="dark", geometry="900x700+0+0").with_recent(tmp_path / "a.skin").with_recent(tmp_path / "b.obj")
    remember(tmp_path, what)
    assert recall(tmp_path) == what


@pytest.mark.parametrize("text", ["", "{", "[]", '{"theme": 3, "recent": {"a": 1}, "geometry": []}', "[" * 100_000])
def test_damage_gives_the_defaults(tmp_path, text):
    (tmp_path / "gui.json").write_text(text)
    assert recall(tmp_path) == Remembered()


def test_recent_files_are_few_and_each_once():
    what = Remembered()
    for k in [*range(20), 5]:
        what = what.with_recent(f"/tmp/{k}.skin")
    assert len(what.recent) == MOST_RECENT and what.recent[:2] == ("/tmp/5.skin", "/tmp/19.skin") and len(set(what.recent)) == MOST_RECENT


def test_the_folder_can_be_named(tmp_path, monkeypatch):
    monkeypatch.setenv("SKINFAB_STATE", str(tmp_path / "mine"))
    assert state_folder() == tmp_path / "mine" and state_folder().is_dir()
    monkeypatch.delenv("SKINFAB_STATE")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "xdg"))
    assert state_folder() == tmp_path / "xdg" / "skinfab"

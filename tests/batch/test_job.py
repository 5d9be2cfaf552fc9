"""A job's name is that of its content."""

from pathlib import Path

from skinfab.batch.job import Job, name_of


def test_the_name_is_of_the_content_and_not_of_the_place(tmp_path: Path) -> None:
    for name, text in (("a.obj", "v 1"), ("b.OBJ", "v 1"), ("a.stl", "v 1"), ("c.obj", "v 2")):
        (tmp_path / name).write_text(text)
    one = name_of(tmp_path / "a.obj", {"seed": 1, "pieces": "fewest"})
    assert one == name_of(tmp_path / "b.OBJ", {"pieces": "fewest", "seed": 1})
    others = [name_of(tmp_path / "a.stl", {"seed": 1}), name_of(tmp_path / "c.obj", {"seed": 1}), name_of(tmp_path / "a.obj", {"seed": 2})]
    assert len({one, *others, name_of(tmp_path / "a.obj", {"seed": 1})}) == 5


def test_files_of_the_settings_count_by_their_content_with_what_they_extend(tmp_path: Path) -> None:
    mesh, own, parent = tmp_path / "a.obj", tmp_path / "own.toml", tmp_path / "parent.toml"
    mesh.write_text("v")
    parent.write_text('extends = "own.toml"\nx = 1\n')  # in a circle: the job will be told, naming it must end
    own.write_text('extends = "parent.toml"\n')
    job = Job(name_of(mesh, {"printer": str(own)}, ("printer",)), str(mesh), {"printer": str(own)}, ("printer",))
    (tmp_path / "copy").mkdir()
    for file in (own, parent):
        (tmp_path / "copy" / file.name).write_text(file.read_text())
    assert name_of(mesh, {"printer": str(tmp_path / "copy/own.toml")}, ("printer",)) == job.name
    assert not job.has_changed()
    parent.write_text("x = 2\n")
    assert job.has_changed()


def test_a_mesh_that_cannot_be_read_has_a_name_until_it_can(tmp_path: Path) -> None:
    job = Job(name_of(tmp_path / "a.obj", {}), str(tmp_path / "a.obj"), {})
    assert not job.has_changed()
    (tmp_path / "a.obj").write_text("v")
    assert job.has_changed()

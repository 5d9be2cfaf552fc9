"""What cannot be written is told with its own reason, and leaves nothing behind."""

import errno
import os
import stat
from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.files import atomic_path, atomic_write, explain_os_error


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("gone/a.skin", "its folder does not exist; create it first"),
        ("file/a.skin", "file is a file, not a folder; choose another folder"),
        ("file/below/a.skin", "file is a file, not a folder; choose another folder"),
        ("folder", "it is a folder; name a file in it"),
    ],
)
def test_each_place_has_its_own_reason(tmp_path, name, reason):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError) as refused:
        atomic_write(tmp_path / name, "whole")
    assert str(refused.value).startswith(f"cannot write {tmp_path / name}: ") and str(refused.value).endswith(reason)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder"] and (tmp_path / "file").read_text() == "mine"


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="only where the system shows its processes as files")
def test_a_folder_that_takes_no_files_is_not_called_missing():
    with pytest.raises(InputError, match=r"cannot write /proc/x\.skin: /proc takes no new files; choose another folder"):
        atomic_write("/proc/x.skin", "whole")


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(tmp_path):
    tmp_path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        with pytest.raises(InputError, match="no permission; choose another folder"):
            atomic_write(tmp_path / "a.skin", "whole")
    finally:
        tmp_path.chmod(stat.S_IRWXU)


@pytest.mark.parametrize(
    ("number", "reason"),
    [
        (errno.EACCES, "no permission; choose another folder"),
        (errno.EROFS, "no permission; choose another folder"),
        (errno.ENOSPC, "the disk is full; free some space and run again"),
        (errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG)),
    ],
)
def test_what_the_system_says_in_words(number, reason):
    assert explain_os_error(OSError(number, os.strerror(number), "out/.a.partial"), "out/a.skin") == f"cannot write out/a.skin: {reason}"


def _half(target):
    with atomic_path(target) as partial:
        partial.write_text("half")
        raise ZeroDivisionError


def test_a_fault_while_writing_leaves_what_was_there(tmp_path):
    (tmp_path / "a.txt").write_text("before")
    with pytest.raises(ZeroDivisionError):
        _half(tmp_path / "a.txt")
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"] and (tmp_path / "a.txt").read_text() == "before"

"""Where results go: a regular file is replaced whole, a link stays, all else is written into."""

import os
import stat
from errno import ENOSPC
from unittest.mock import Mock

import pytest

from contactlaw import _atomic


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("call", ["fsync", "replace"])
@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(ENOSPC, os.strerror(ENOSPC))])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(error, call, tmp_path, monkeypatch):
    (tmp_path / "table.h").write_text("before")

    def fail(*_):
        raise error

    monkeypatch.setattr(os, call, fail)
    with pytest.raises(type(error)):
        _atomic.write(tmp_path / "table.h", b"after")
    assert names(tmp_path) == ["table.h"] and (tmp_path / "table.h").read_text() == "before"


def test_what_is_no_file_passes_the_content_on_and_stays_one(tmp_path, monkeypatch):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    _atomic.write(pipe, b"a line\n")
    assert os.read(end, 99) == b"a line\n"
    assert stat.S_ISFIFO(os.lstat(pipe).st_mode) and names(tmp_path) == ["pipe"]
    os.close(end)
    full = OSError(ENOSPC, os.strerror(ENOSPC))  # as of /dev/full, which root would lose if a file replaced it
    monkeypatch.setattr(_atomic, "open", Mock(side_effect=full), raising=False)
    with pytest.raises(OSError, match="No space left"):
        _atomic.write(pipe, b"another\n")


@pytest.mark.parametrize("there", [True, False], ids=["to a file", "to nothing yet"])
def test_a_link_stays_and_what_it_leads_to_is_written(there, tmp_path):
    folder = tmp_path / "disk"
    folder.mkdir()
    if there:
        (folder / "table.h").write_text("before")
    (tmp_path / "second").symlink_to("disk/table.h")
    (tmp_path / "first").symlink_to(tmp_path / "second")
    _atomic.write(tmp_path / "first", b"after")
    assert (folder / "table.h").read_bytes() == b"after" and names(folder) == ["table.h"]
    assert (tmp_path / "first").is_symlink() and (tmp_path / "second").is_symlink()
    assert names(tmp_path) == ["disk", "first", "second"]


@pytest.mark.parametrize(
    ("target", "reason"), [("folder", "Is a directory"), ("no/such/file", "no such folder"), ("x", "Too many levels")]
)
def test_links_to_no_file_are_refused(target, reason, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "x").symlink_to(target)
    with pytest.raises(OSError, match=reason):
        _atomic.write(tmp_path / "x", b"after")
    assert names(tmp_path) == ["folder", "x"] and os.readlink(tmp_path / "x") == target


def test_a_folder_may_be_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to("disk")
    (tmp_path / "disk" / "build.sh").symlink_to("kept.sh")
    with _atomic.folder(tmp_path / "out") as made:
        (made / "build.sh").write_text("after")
    assert (tmp_path / "out").is_symlink() and (tmp_path / "out" / "build.sh").is_symlink()
    assert (tmp_path / "disk" / "kept.sh").read_text() == "after"
    assert names(tmp_path) == ["disk", "out"]


def test_a_folder_is_replaced_only_when_all_its_files_are_written(tmp_path, monkeypatch):
    (tmp_path / "out").mkdir()
    for name in "abcde":
        (tmp_path / "out" / name).write_text("before")
    synced = []

    def fail(handle):
        synced.append(handle)
        if len(synced) == 4:
            raise OSError(ENOSPC, os.strerror(ENOSPC))

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="No space left"), _atomic.folder(tmp_path / "out") as made:
        for name in "abcdef":
            (made / name).write_text("after")
    assert names(tmp_path) == ["out"] and names(tmp_path / "out") == list("abcde")
    assert {path.read_text() for path in (tmp_path / "out").iterdir()} == {"before"}


def test_a_folder_in_the_way_of_a_file_is_named(tmp_path):
    (tmp_path / "out" / "wall.h").mkdir(parents=True)
    with pytest.raises(IsADirectoryError, match="out/wall.h"), _atomic.folder(tmp_path / "out") as made:
        (made / "a.h").write_text("after")
        (made / "wall.h").write_text("after")
    assert names(tmp_path) == ["out"] and names(tmp_path / "out") == ["wall.h"]
    with pytest.raises(IsADirectoryError, match="new"), _atomic.folder(tmp_path / "new") as made:
        (made / "sub").mkdir()
    assert names(tmp_path) == ["out"]


def test_a_folder_replaces_no_device(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "one").write_text("old")
    (tmp_path / "out").mkdir()
    for name, target in (("a", "pipe"), ("b", "one")):
        (tmp_path / "out" / name).symlink_to(tmp_path / target)
    match = "no file that can be replaced"
    with pytest.raises(FileExistsError, match=match) as refused, _atomic.folder(tmp_path / "out") as made:
        for name in "ab":
            (made / name).write_text(name)
    assert "None" not in str(refused.value)
    assert (tmp_path / "pipe").is_fifo() and (tmp_path / "one").read_text() == "old"

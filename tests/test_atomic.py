"""Where results go: a regular file is replaced whole, a link stays, all else is written into."""

import os
from errno import ENOSPC
from pathlib import Path
from unittest.mock import Mock

import pytest

from contactlaw import _atomic

pytestmark = pytest.mark.usefixtures("folder")
FULL = OSError(ENOSPC, os.strerror(ENOSPC))


def names(folder="."):
    return sorted(os.listdir(folder))


@pytest.mark.parametrize("call", ["fsync", "replace"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, FULL])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(error, call, monkeypatch):
    Path("table.h").write_text("before")
    monkeypatch.setattr(os, call, Mock(side_effect=error))
    with pytest.raises((KeyboardInterrupt, OSError)):
        _atomic.write("table.h", b"after")
    assert names() == ["table.h"] and Path("table.h").read_text() == "before"


def test_what_is_no_file_passes_the_content_on_and_stays_one(monkeypatch):
    os.mkfifo("pipe")
    end = os.open("pipe", os.O_RDWR | os.O_NONBLOCK)
    _atomic.write("pipe", b"a line\n")
    assert os.read(end, 99) == b"a line\n"
    assert Path("pipe").is_fifo() and names() == ["pipe"]
    os.close(end)
    # as /dev/full, which root would lose if a file replaced it
    monkeypatch.setattr(_atomic, "open", Mock(side_effect=FULL), raising=False)
    with pytest.raises(OSError, match="No space left"):
        _atomic.write("pipe", b"another\n")


@pytest.mark.parametrize("there", [True, False], ids=["to a file", "to nothing yet"])
def test_a_link_stays_and_what_it_leads_to_is_written(there):
    os.mkdir("disk")
    if there:
        Path("disk/table.h").write_text("before")
    os.symlink("disk/table.h", "second")
    os.symlink("second", "first")
    _atomic.write("first", b"after")
    assert Path("disk/table.h").read_bytes() == b"after" and names("disk") == ["table.h"]
    assert os.readlink("first") == "second" and os.readlink("second") == "disk/table.h"
    assert names() == ["disk", "first", "second"]


@pytest.mark.parametrize(
    ("target", "reason"), [("folder", "Is a directory"), ("no/such/file", "no such folder"), ("x", "Too many levels")]
)
def test_links_to_no_file_are_refused(target, reason):
    os.mkdir("folder")
    os.symlink(target, "x")
    with pytest.raises(OSError, match=reason):
        _atomic.write("x", b"after")
    assert names() == ["folder", "x"] and os.readlink("x") == target


def test_a_folder_may_be_a_link():
    os.mkdir("disk")
    os.symlink("disk", "out")
    os.symlink("kept.sh", "disk/build.sh")
    with _atomic.folder("out") as made:
        (made / "build.sh").write_text("after")
    assert os.readlink("out") == "disk" and os.readlink("out/build.sh") == "kept.sh"
    assert Path("disk/kept.sh").read_text() == "after"
    assert names() == ["disk", "out"]


def test_a_folder_is_replaced_only_when_all_its_files_are_written(monkeypatch):
    os.mkdir("out")
    Path("out/a").write_text("before")
    monkeypatch.setattr(os, "fsync", Mock(side_effect=[None, FULL]))
    with pytest.raises(OSError, match="No space left"), _atomic.folder("out") as made:
        for name in "abc":
            (made / name).write_text("after")
    assert names() == ["out"] and names("out") == ["a"] and Path("out/a").read_text() == "before"


def test_a_folder_in_the_way_of_a_file_is_named():
    os.makedirs("out/wall.h")
    with pytest.raises(IsADirectoryError, match="out/wall.h"), _atomic.folder("out") as made:
        (made / "a.h").write_text("after")
        (made / "wall.h").write_text("after")
    assert names() == ["out"] and names("out") == ["wall.h"]
    with pytest.raises(IsADirectoryError, match="new"), _atomic.folder("new") as made:
        (made / "sub").mkdir()
    assert names() == ["out"]


def test_a_folder_replaces_no_device():
    os.mkfifo("pipe")
    Path("one").write_text("old")
    os.mkdir("out")
    os.symlink("../pipe", "out/a")
    os.symlink("../one", "out/b")
    with pytest.raises(FileExistsError, match="no file that can be replaced") as refused, _atomic.folder("out") as made:
        for name in "ab":
            (made / name).write_text(name)
    assert "None" not in str(refused.value)
    assert Path("pipe").is_fifo() and Path("one").read_text() == "old"

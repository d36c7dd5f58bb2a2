"""Where results go: a regular file is replaced whole, a link stays, all else is written into."""

import os
import stat
import threading
import tty
from unittest.mock import MagicMock

import pytest

from contactlaw import _atomic
from contactlaw.cli import main

HEADER = ["export", "header", "--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc",
          "--table", "none", "--out"]  # fmt: skip


@pytest.mark.parametrize("kind", ["pipe", "terminal"])
def test_what_is_no_file_passes_the_content_on_and_stays_one(kind, tmp_path):
    """The folder of a terminal takes no other file; a pipe does not hold the content."""
    content, pipe = b"a line\n" * 20_000, tmp_path / "pipe"
    if kind == "pipe":
        os.mkfifo(pipe)
        ours = its = os.open(pipe, os.O_RDWR)
    else:
        ours, its = os.openpty()
        tty.setraw(its)
    name = pipe if kind == "pipe" else os.ttyname(its)
    found = []

    def read():
        """Collect what comes out at the other end, which is open before something goes in."""
        while sum(map(len, found)) < len(content) and (part := os.read(ours, 65536)):
            found.append(part)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    _atomic.write(name, content)
    thread.join(timeout=20)
    assert b"".join(found) == content
    assert (stat.S_ISFIFO if kind == "pipe" else stat.S_ISCHR)(os.lstat(name).st_mode)
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"] * (kind == "pipe")
    for descriptor in {ours, its}:
        os.close(descriptor)


@pytest.mark.parametrize("there", [True, False], ids=["to a file", "to nothing yet"])
def test_a_link_stays_and_what_it_leads_to_is_written(there, tmp_path):
    folder = tmp_path / "disk"
    folder.mkdir()
    if there:
        (folder / "table.h").write_text("before")
    (tmp_path / "second").symlink_to("disk/table.h")
    (tmp_path / "first").symlink_to(tmp_path / "second")
    _atomic.write(tmp_path / "first", b"after")
    assert (folder / "table.h").read_bytes() == b"after"
    assert (tmp_path / "first").is_symlink() and (tmp_path / "second").is_symlink()
    assert [path.name for path in folder.iterdir()] == ["table.h"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["disk", "first", "second"]


@pytest.mark.parametrize(
    ("target", "reason"),
    [("folder", "Is a directory"), ("no/such/file", "no such folder"), ("x", "Too many levels")],
)
def test_links_to_no_file_are_refused(target, reason, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "x").symlink_to(target)
    with pytest.raises(OSError, match=reason):
        _atomic.write(tmp_path / "x", b"after")
    assert {path.name for path in tmp_path.rglob("*")} == {"folder", "x"}
    assert os.readlink(tmp_path / "x") == target


def test_a_full_device_is_an_error_in_words(tmp_path, monkeypatch, capsys):
    """A stand-in for /dev/full, which root would lose if this failed."""
    ours, its = os.openpty()

    name, full = os.ttyname(its), MagicMock()
    full.__enter__().write.side_effect = OSError(28, "No space left on device")
    monkeypatch.setattr(_atomic, "open", lambda *_: full, raising=False)
    assert main([*HEADER, name]) == 1
    assert f"--out: cannot write {name}: No space left on device" in capsys.readouterr().err
    os.close(ours)
    os.close(its)


def test_a_folder_for_liggghts_may_be_a_link(tmp_path, capsys):
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to("disk")
    (tmp_path / "disk" / "build.sh").symlink_to("kept.sh")
    assert main(["export", "liggghts", *HEADER[2:8], "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.startswith(str(tmp_path / "out"))  # what the command was told
    assert (tmp_path / "out").is_symlink() and (tmp_path / "out" / "build.sh").is_symlink()
    assert (tmp_path / "disk" / "kept.sh").read_text().startswith("#!")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["disk", "out"]

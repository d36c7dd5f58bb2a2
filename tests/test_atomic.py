"""Where results go: a regular file is replaced whole, a link stays, all else is written into."""

import os
import stat
import threading
import tty

import pytest

from contactlaw import _atomic
from contactlaw.cli import main

HEADER = ["export", "header", "--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc",
          "--table", "none", "--out"]  # fmt: skip


def reads_in_thread(descriptor, size):
    """Collect what comes out at the other end, which has to be open before something goes in."""
    found = []

    def read():
        while sum(map(len, found)) < size and (part := os.read(descriptor, 65536)):
            found.append(part)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    return thread, found


def test_a_named_pipe_passes_the_content_on(tmp_path):
    pipe, content = tmp_path / "pipe", b"0123456789" * 50_000  # more than a pipe holds
    os.mkfifo(pipe)
    ours = os.open(pipe, os.O_RDWR)
    thread, found = reads_in_thread(ours, len(content))
    _atomic.write(pipe, content)
    thread.join(timeout=20)
    os.close(ours)
    assert b"".join(found) == content
    assert stat.S_ISFIFO(os.lstat(pipe).st_mode)
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]


def test_a_device_takes_the_content_and_stays_one():
    """The device is a terminal, whose folder takes no other file."""
    ours, its = os.openpty()
    tty.setraw(its)
    name, content = os.ttyname(its), b"a line\n" * 1000
    thread, found = reads_in_thread(ours, len(content))
    _atomic.write(name, content)
    thread.join(timeout=20)
    assert b"".join(found) == content
    assert stat.S_ISCHR(os.stat(name).st_mode)
    os.close(ours)
    os.close(its)


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


def test_links_to_no_file_are_refused(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "to folder").symlink_to("folder")
    (tmp_path / "nowhere").symlink_to("no/such/file")
    (tmp_path / "round").symlink_to("round")
    before = sorted(tmp_path.rglob("*"))
    for name, reason in (
        ("to folder", "Is a directory"),
        ("nowhere", "no such folder"),
        ("round", "Too many levels"),
    ):
        with pytest.raises(OSError, match=reason):
            _atomic.write(tmp_path / name, b"after")
    assert sorted(tmp_path.rglob("*")) == before
    assert all(os.readlink(tmp_path / name) for name in ("to folder", "nowhere", "round"))


def test_the_command_follows_links_and_says_what_it_was_told(tmp_path, capsys):
    (tmp_path / "law.h").symlink_to("elsewhere.h")
    assert main([*HEADER, str(tmp_path / "law.h")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'law.h'}\n"
    assert "contactlaw_step" in (tmp_path / "elsewhere.h").read_text()
    assert (tmp_path / "law.h").is_symlink()


def test_a_full_device_is_an_error_in_words(tmp_path, monkeypatch, capsys):
    """A stand-in for /dev/full, which root would lose if this failed."""
    ours, its = os.openpty()

    class Full:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

        def write(self, _):
            raise OSError(28, "No space left on device")

    name = os.ttyname(its)
    monkeypatch.setattr(_atomic, "open", lambda *_: Full(), raising=False)
    assert main([*HEADER, name]) == 1
    assert f"--out: cannot write {name}: No space left on device" in capsys.readouterr().err
    os.close(ours)
    os.close(its)


def test_a_folder_for_liggghts_may_be_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to("disk")
    (tmp_path / "disk" / "build.sh").symlink_to("kept.sh")
    assert main(["export", "liggghts", *HEADER[2:8], "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out").is_symlink() and (tmp_path / "out" / "build.sh").is_symlink()
    assert (tmp_path / "disk" / "kept.sh").read_text().startswith("#!")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["disk", "out"]

"""The commands that export: they write what Python writes, all of it or nothing, or say why not."""

import errno
import os

import pytest

import contactlaw as cl
from contactlaw import cli
from contactlaw.export import c_header

BODIES = ["--sphere", "bearing-steel-52100", "--plate", "aluminium-6061-t6"]
MODEL = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
COMMANDS = {
    "header": (["export", "header", *BODIES], cl.export.header),
    "liggghts": (["export", "liggghts", *BODIES], cl.export.liggghts),
    "lammps": (["export", "lammps", *BODIES], cl.export.lammps),
    "page": (["explore", *BODIES], cl.export.page),
}


def contents(path):
    """Bytes of a file, or of the files of a folder by name."""
    if path.is_file():
        return path.read_bytes()
    return {one.name: one.read_bytes() for one in path.iterdir()}


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        ("header", {"law": "fem"}),
        ("header", {"law": "myc", "table": "none", "prefix": "steel"}),
        ("liggghts", {"law": "myc"}),
        ("page", {"law": "myc"}),
    ],
)
def test_the_command_writes_what_python_writes(kind, options, tmp_path, capsys):
    (command, export), words = COMMANDS[kind], []
    for name, value in options.items():
        words += [f"--{name}", value]
    assert cli.main([*command, *words, "--out", str(tmp_path / "shell")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'shell'}\n"
    model = cl.ImpactModel(MODEL.pair, options.pop("law"))
    export(tmp_path / "python", model, **options)
    assert contents(tmp_path / "shell") == contents(tmp_path / "python")


NOWHERE = (["--out", "nowhere/out"], "--out: there is no folder nowhere")
REFUSED = [(kind, *NOWHERE) for kind in COMMANDS]
REFUSED += [
    ("header", ["--out", "."], "--out: . is a folder"),
    ("header", ["--sphere", "glass", "--law", "myc"], "--sphere: law 'myc' needs a yield strength"),
    ("header", ["--law", "mcy"], "--law: got 'mcy'; unknown law"),
    ("header", ["--prefix", "Steel"], "--prefix: got 'Steel'; must be lower-case words"),
    ("liggghts", ["--out", "file"], "--out: file is no folder"),
    ("liggghts", ["--out", "file/out"], "--out: there is no folder file"),
    ("page", ["--sphere", "steal"], "--sphere: unknown material 'steal'"),
]


@pytest.mark.parametrize(("kind", "change", "message"), REFUSED)
def test_the_command_refuses_in_its_own_words(kind, change, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    assert cli.main([*COMMANDS[kind][0], "--out", "out", *change]) == 1
    assert message in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("kind", COMMANDS)
def test_a_failure_leaves_what_was_there(kind, tmp_path, monkeypatch):
    export = COMMANDS[kind][1]
    with pytest.raises(TypeError, match=r"model: expected a contactlaw.ImpactModel, got 'myc'"):
        export(tmp_path / "out", "myc")
    assert list(tmp_path.iterdir()) == []
    other = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    for model in (other, MODEL):  # the tables of both are kept from now on
        export(tmp_path / "out", model)
    before = contents(tmp_path / "out")
    if (tmp_path / "out").is_file():
        assert (tmp_path / "out").stat().st_mode & 0o777 == 0o644

    def full(file):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        export(tmp_path / "out", other)
    assert contents(tmp_path / "out") == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_header_that_grows_too_large_is_not_written(tmp_path, monkeypatch):
    monkeypatch.setattr(c_header, "LARGEST", 100_000)
    with pytest.raises(ValueError, match=r"table: the header would have \d+ bytes, above 100000"):
        cl.export.header(tmp_path / "out.h", MODEL)
    assert list(tmp_path.iterdir()) == []


def test_files_of_a_folder_are_replaced_and_others_stay(tmp_path):
    (tmp_path / "in.rain").write_text("mine")
    (tmp_path / "build.sh").write_text("old")
    cl.export.liggghts(tmp_path, MODEL)
    found = contents(tmp_path)
    assert len(found) == 8 and found["in.rain"] == b"mine"
    assert b"old" not in found["build.sh"]
    assert len(found["README.txt"].splitlines()) <= 15
    del found["contactlaw_beads.h"]  # the same lines with longer names
    for content in found.values():
        assert max(map(len, content.decode().splitlines())) <= 100
    cl.export.header(tmp_path / "alone.h", MODEL, "none")
    assert found["contactlaw.h"] == (tmp_path / "alone.h").read_bytes()

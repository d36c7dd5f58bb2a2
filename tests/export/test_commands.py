"""The commands that export: they write what Python writes, or say why not; see `test_atomic.py` for what fails."""

import math

import pytest
from places import ROOT

import contactlaw as cl
from contactlaw import cli, walls
from contactlaw.export import c_header

BODIES = ["--sphere", "bearing-steel-52100", "--plate", "aluminium-6061-t6"]
PAIR = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
COMMANDS = {
    "header": (["export", "header", *BODIES], cl.export.header),
    "liggghts": (["export", "liggghts", *BODIES], cl.export.liggghts),
    "page": (["explore", *BODIES], cl.export.page),
}


DRUM = """
beads = ["soda-lime-glass", "bearing-steel-52100"]
largest = "2mm"
plate = "stainless-steel-304"
friction = 0.3

[shell]
shape = "cylinder"
start = [0, 0, 0]
end = [0, "20mm", 0]
radius = "30mm"
thickness = "0.8mm"
edges = ["free", "none"]
motion = {kind = "rotation", axis = [0, 1, 0], speed = "60rpm"}

["a window"]
shape = "disc"
centre = [0, 0, 0]
normal = [0, 1, 0]
radius = "30mm"
plate = "glass"
types = [1]
thickness = [["glass", "2mm"], ["pmma", "1mm"]]

[bed]
shape = "plate"
corner = [0, 0, "-0.04 m"]
edge_a = [1, 0, 0]
edge_b = [0, 1, 0]
thickness = {kind = "foundation", thickness = "2mm", stiffness = "0.1GN/m3"}

[part]
file = "part.stl"
scale = "1mm"
thickness = "1mm"
motion = {kind = "tabulated", times = [0, "1ms"], displacements = [[0, 0, 0], [0, 0, "1mm"]]}
"""
STL = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid"


@pytest.fixture
def drum(tmp_path):
    """File with a scene as text."""
    (tmp_path / "drum.toml").write_text(DRUM)
    (tmp_path / "part.stl").write_text(STL)
    return tmp_path / "drum.toml"


def test_a_scene_as_text_is_what_python_writes(drum, tmp_path, capsys):
    command = ["export", "lammps", str(drum), "--out", str(tmp_path / "out"), "--set", "shell.thickness=1mm"]
    assert cli.main([*command, "--set", "softening=20"]) == 0
    spheres = "soda-lime-glass", "bearing-steel-52100"
    steel, glass = (
        {n: cl.ImpactModel(cl.Pair(one, plate)) for n, one in enumerate(spheres, 1)}
        for plate in ("stainless-steel-304", "glass")
    )
    turning = walls.Rotation((0, 1, 0), 2.0 * math.pi)
    table = walls.Tabulated([0, 1e-3], [[0, 0, 0], [0, 0, 1e-3]])
    layers = cl.Layers([("glass", 2e-3), ("pmma", 1e-3)])
    named = {
        "shell": walls.Cylinder((0, 0, 0), (0, 0.02, 0), 0.03, 1e-3, steel, turning, ("free", None)),
        "a window": walls.Disc((0, 0, 0), (0, 1, 0), 0.03, layers, {1: glass[1], 2: None}),
        "bed": walls.Plate((0, 0, -0.04), (1, 0, 0), (0, 1, 0), cl.Foundation(2e-3, 1e8), steel),
        "part": walls.Mesh.read(tmp_path / "part.stl", 1e-3, scale=1e-3, model=steel, motion=table),
    }
    cl.export.scene(tmp_path / "own", named, steel, largest=2e-3, types=2, friction=0.3, softening=20)
    assert (tmp_path / "out/drum.scene").read_bytes() == (tmp_path / "own").read_bytes()


def test_the_scene_of_the_page_is_one(tmp_path):
    text = (ROOT / "docs/lammps_walls.md").read_text().partition("```toml\n")[2].partition("```")[0]
    (tmp_path / "page.toml").write_text(text)
    assert cli.main(["export", "lammps", str(tmp_path / "page.toml"), "--out", str(tmp_path / "out")]) == 0


CHANGED = [  # a text of the scene, what it becomes, and the message
    ("largest", "langest", "line 3: unknown 'langest'; did you mean largest? known: beads, largest"),
    ('largest = "2mm"', "", "line 1: lacks largest"),
    ("0.8mm", "0.8mmm", "line 12: [shell]: thickness: got '0.8mmm': 'mmm' is no unit of length; take m, cm"),
    ("0.8mm", "-1mm", "line 12: [shell]: thickness: got -0.001; "),
    ("speed", "sped", "line 14: [shell]: motion: unknown 'sped'; did you mean speed? known: axis"),
    ('radius = "30mm"\nthick', "thick", "line 7: [shell]: lacks radius"),
    ('"pmma"', '"pmna"', "[a window]: unknown material 'pmna': did you mean 'pmma'"),
    ('plate = "glass"', 'plate = "galss"', "line 21: [a window]: plate: unknown material 'galss': did you mean"),
    ("beads = [", "beads = [[", "drum.toml: "),
    ('"2mm"', "2mm", 'line 3, column 12); write names and numbers with a unit in quotes: "1mm"'),
    ('"stainless-steel-304"', '"stainles"', "line 4: plate: unknown material 'stainles'"),
    ('plate = "stainless-steel-304"', "", "[shell]: lacks plate"),
    ('shape = "cylinder"', "", "line 7: [shell]: lacks shape"),
    ("largest", "motion = {}\nlargest", "line 3: unknown 'motion'; known: beads, largest"),
    ("--law", "fame", "--law: got 'fame'; unknown law"),
    ("--set", "friction=-1", "--set: friction: friction: got -1; "),
    ("--set", "shel.thickness=1mm", "--set: unknown 'shel'; did you mean shell?"),
    ("--set", "shell.thickness=1mmm", "--set: shell.thickness: thickness: got '1mmm'"),
]


@pytest.mark.parametrize(("old", "new", "message"), CHANGED)
def test_a_scene_with_a_wrong_word_is_refused(old, new, message, drum, tmp_path, capsys):
    change = [old, new] if old.startswith("--") else []
    drum.write_text(DRUM.replace(old, new, 1))
    assert cli.main(["export", "lammps", str(drum), "--out", str(tmp_path / "out"), *change]) == 1
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def contents(path):
    """Bytes of a file, or of the files of a folder by name."""
    return {one.name: one.read_bytes() for one in path.iterdir()} if path.is_dir() else path.read_bytes()


@pytest.mark.parametrize(
    ("kind", "options"), [("header", {"table": "none", "prefix": "steel"}), ("liggghts", {}), ("page", {})]
)
def test_the_command_writes_what_python_writes(kind, options, tmp_path, capsys):
    (command, export), words = COMMANDS[kind], [f"--{name}={value}" for name, value in options.items()]
    assert cli.main([*command, "--law", "myc", *words, "--out", str(tmp_path / "shell")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'shell'}\n"
    export(tmp_path / "python", cl.ImpactModel(PAIR, "myc"), **options)
    assert contents(tmp_path / "shell") == contents(tmp_path / "python")
    with pytest.raises(TypeError, match=r"model: expected a contactlaw.ImpactModel.*, got 'myc'"):
        export(tmp_path / "out", "myc")


@pytest.mark.parametrize(
    ("kind", "change", "message"),
    [
        *((kind, ["--out", "nowhere/out"], "--out: there is no folder nowhere") for kind in COMMANDS),
        ("header", ["--out", "."], "--out: . is a folder"),
        ("header", ["--sphere", "glass", "--law", "myc"], "--sphere: law 'myc' needs a yield strength"),
        ("liggghts", ["--out", "file"], "--out: file is no folder"),
    ],
)
def test_the_command_refuses_in_its_own_words(kind, change, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    assert cli.main([*COMMANDS[kind][0], "--out", "out", *change]) == 1
    assert message in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_header_that_grows_too_large_is_not_written(tmp_path, monkeypatch):
    monkeypatch.setattr(c_header, "LARGEST", 100_000)
    with pytest.raises(ValueError, match=r"table: the header would have \d+ bytes, above 100000"):
        cl.export.header(tmp_path / "out.h", cl.ImpactModel(PAIR))
    assert list(tmp_path.iterdir()) == []

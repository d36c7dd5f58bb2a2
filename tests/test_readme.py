"""What README and pages show is what the code does."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from runpy import run_path

import needs
import numpy as np
import pytest
from lasting import long
from places import ROOT
from rains import write_rain

import contactlaw as cl
from contactlaw import cli, laws, quantities
from contactlaw.cli import old_names
from contactlaw.table import BOUNDS, file

PATHS = {path.stem: path for path in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]}
PATHS["examples"] = ROOT / "docs/examples/README.md"
PAGES = {name: path.read_text() for name, path in PATHS.items()}
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
# How many lines of a page state numbers, which are compared.
STATED = {
    "README": 1,
    "angles_and_edges": 10,
    "engines": 3,
    "fit": 3,
    "how_sure": 2,
    "lammps": 1,
    "lammps_walls": 1,
    "laws": 10,
    "materials": 4,
    "measure": 2,
    "not_in_the_model": 5,
    "softening": 2,
    "time_step": 3,
    "tutorial": 6,
    "walls": 4,
    "what_a_wall_feels": 7,
}
SAID = " ".join(PAGES["how_sure"].split())
HOUSE = tuple(f"{name}/" for name in ("contactlaw", "dem_demo", "docs", "tests", "validation"))
TREE = [*ROOT.glob("*"), *(path for name in HOUSE for path in (ROOT / name).rglob("*"))]
EXAMPLES = sorted((ROOT / "docs/examples").glob("*.py"))


def blocks(page):
    return re.findall(r"```python\n(.*?)```", PAGES[page], re.DOTALL)


def run(code):
    """Run code blocks in one namespace; compare every line that states numbers in a comment."""
    names, compared = {}, 0
    for block in code:
        exec(compile(block, "README.md", "exec"), names)
        for line in block.splitlines():
            statement, _, comment = line.partition("  # ")
            stated = NUMBER.findall(comment)
            if stated and not re.match(r"\s|\w+ = |from |import ", statement):
                value = np.ravel(eval(statement, names))
                for number, text in zip(value, stated, strict=False):  # to the digits printed
                    digits, _, power = text.partition("e")
                    last = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
                    assert abs(number - float(text)) <= 0.501 * last, (line, value)
                compared += 1
    return names, compared


@pytest.mark.parametrize("page", sorted(PAGES))
def test_snippets_say_what_they_give(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where the tutorial writes its report
    if page.startswith("lammps"):
        needs.lammps()
    names, compared = run(blocks(page))
    assert compared == STATED.get(page, 0)
    if "hit" in names:
        assert names["hit"].flags == cl.Validity(0)
    if "lmp" in names:
        names["lmp"].close()


# A block of commands, and what they print if the page shows it: the first block after it, with one
# line of text between them at most.
CONSOLE = re.compile(r"```sh\n(.*?)```\n+(?:[^\n`]+\n+)?(?:```text\n(.*?)```)?", re.DOTALL)
# A file that a block of commands writes.
FILE = re.compile(r"cat > (\S+) << END\n(.*?)END\n", re.DOTALL)
SHOWN = {"README": 1, "command_line": 3, "materials": 1, "measure": 2}  # blocks of output of a page, which are compared


def commands(block):
    """Calls of contactlaw in a block; ... and | stand for what a reader has to fill in."""
    for line in FILE.sub("", block).replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] == ["contactlaw"] and not {"...", "|", "hits.*.npy"} & set(words):
            yield words[1 : words.index(">") if ">" in words else None]


@pytest.mark.parametrize("page", sorted(PAGES.keys() - {"fit"}))  # test_fit.py has that page
def test_commands_print_what_the_page_shows(page, tmp_path, monkeypatch, capsys, pair):
    monkeypatch.chdir(tmp_path)
    Path("impacts.csv").write_text("speed_m/s\n0.5\n1.2\n")
    Path("docs/examples").mkdir(parents=True)
    for name in ("rebounds.csv", "pom_drops.csv", "phyphox.csv"):
        shutil.copy(ROOT / "docs/examples" / name, "docs/examples")
    Path("rain").mkdir()
    write_rain(Path("rain/rain.h5"), pair)
    compared = 0
    for block, shown in CONSOLE.findall(PAGES[page]):
        for name, text in FILE.findall(block):
            Path(name).write_text(text)
        for words in commands(block):
            assert cli.main(words) == 0, capsys.readouterr().err
        printed = capsys.readouterr().out
        if shown:
            assert printed == shown
            compared += 1
    assert compared == SHOWN.get(page, 0)


def test_the_stated_rows_of_a_speed_table():
    model = cl.ImpactModel(cl.Pair("glass", "carbon-steel-1020"))
    assert "by no more than the error, with 14 rows for 1e-3 here" in " ".join(PAGES["engines"].split())
    assert len(model.speed_table(1e-3, 1e-3, 1e-3, 0.1, 10).speed) == 14


def test_the_numbers_of_the_readme_are_those_of_its_first_command_and_of_ball_and_bar():
    (row,) = re.findall(r"^\| COR \| (.*) \|$", PAGES["README"], re.MULTILINE)
    (printed,) = re.findall(r"```text\n(.*?)```", PAGES["README"], re.DOTALL)
    restitution = [float(line.split()[1]) for line in printed.splitlines()[3:]]
    assert row.split(" | ") == [f"{value:.2f}" for value in restitution]
    for material in ("stainless-steel-304-ball", "stainless-steel-304"):
        assert f"{cl.ImpactModel(cl.Pair(material, 'glass')).restitution(3.0, 1e-3, 5e-3):.3f}" in PAGES["README"]


def test_materials_lists_the_catalogue():
    assert set(cl.materials()) <= set(re.findall(r"[a-z0-9-]+", PAGES["materials"]))


@pytest.mark.parametrize("page", sorted(PAGES.keys() - {"CHANGELOG"}))
def test_paths_that_a_page_names_are_there(page):
    """A name without its folder may be that of any file."""
    text = re.sub(r"^```.*?^```", "", PAGES[page], flags=re.DOTALL | re.MULTILINE)
    for name in re.findall(r"`([\w./-]+)`", text):
        if "NAME" not in name and (name.endswith((".py", ".md")) or name.startswith(HOUSE)):
            assert any(f"{path}/".endswith(f"/{name.rstrip('/')}/") for path in TREE), name


def test_a_few_beads_run_down_the_hopper(capsys):
    """The whole example takes 12 s."""
    found = run_path(ROOT / "docs/examples/hopper_pymunk.py")["main"](beads=3, duration=0.18)
    assert set(found["plate"]) >= {0, 1}
    assert len(capsys.readouterr().out.splitlines()) == 2


@pytest.mark.parametrize(
    "script", [long(one) if one.stem == "hopper_pymunk" else one for one in EXAMPLES], ids=lambda path: path.stem
)
def test_examples_run(script):
    """Run the examples as a user does; each prints a result."""
    assert len(script.read_text().splitlines()) <= 60
    if "lammps" in script.stem:
        needs.lammps()
    if script.stem == "own_loop":
        return  # its loop takes half a minute to compile: tests/stepping runs it
    if "yade" in script.stem:
        return  # YADE has a Python of its own: tests/engines/test_yade.py runs it
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) >= 2


def test_the_menu_lists_every_page_and_the_examples_every_file():
    menu = (ROOT / "mkdocs.yml").read_text()
    for path in PATHS.values():
        name = "index.md" if path.stem == "README" else path.name
        assert f": {name}\n" in menu or path.parent.name == "examples", path
    for path in (ROOT / "docs/examples").glob("*.*"):
        assert path.name == "README.md" or path.name in PAGES["examples"], path


@pytest.mark.parametrize("page", ["messages", "public"])
def test_the_page_is_made_from_the_code(page):
    """`python docs/messages.py` and `python docs/public.py` write them again."""
    assert PAGES[page] == run_path(ROOT / f"docs/{page}.py")["written"]()


def test_the_page_of_units_lists_those_that_text_may_have():
    rows = [set(re.split("[ ,;|]+", line)) for line in PAGES["units"].splitlines() if line.startswith("|")]
    for kind in vars(quantities).values():
        if isinstance(kind, quantities.Quantity):
            assert any(kind.units.keys() <= row for row in rows), kind


def test_old_commands_stand_above_the_new_ones():
    """What follows each of them is run by `test_commands_print_what_the_page_shows`."""
    lines = PAGES["from_0_3"].replace("\\\n#", "").splitlines()
    old = [line.removeprefix("# contactlaw ") for line in lines if line.startswith("# contactlaw ")]
    assert old and all(old_names.answer(shlex.split(line)) for line in old)


def test_the_notebook_is_made_from_the_tutorial():
    """`python docs/notebook.py` writes it again."""
    assert (ROOT / "docs/tutorial.ipynb").read_text() == run_path(ROOT / "docs/notebook.py")["written"](
        PAGES["tutorial"]
    )


def test_the_stated_accuracy_is_that_of_the_certificate():
    """Tables of other laws are compared with the solver in tests/table."""
    largest = file.packaged(laws.law("myc")).certificate.largest
    assert "The COR of every table is within 5e-5" in SAID and BOUNDS["restitution"] == 5e-5
    assert "The table of `myc` is within 3e-5 in COR" in SAID and largest["restitution"] < 3e-5
    assert "histories from the table are within 1e-3 of their peak" in SAID and BOUNDS["force_history"] == 1e-3
    assert "within 1e-3 of their largest values and contact times within 2e-3" in SAID
    assert (BOUNDS["peak_force"], BOUNDS["contact_time"]) == (1e-3, 2e-3)

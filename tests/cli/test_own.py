"""Materials of one's own on the command line, and lengths that are likelier millimetres."""

import json
import math
import re

import pytest
from command_line import refused
from places import ROOT

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.parts.own import material_of
from contactlaw.walls import Mesh, Plate

NUMBERS = {"youngs_modulus": 2.8e9, "poissons_ratio": 0.35, "density": 1410, "kind": "polymer"}
POM = "E=2.8GPa nu=0.35 rho=1410 yield=62MPa kind=polymer"
FILE = """
[my-pom]
aliases = ["delrin"]
kind = "polymer"
youngs_modulus = 2.8e9
poissons_ratio = 0.35
density = 1410
yield_strength = 62e6
uncertainty = {yield_strength = 0.1}

[hard-304]
like = "stainless-steel-304"
hardness = "32 HRC"
source = {hardness = "measured"}

[soft]
like = "pmma"
loss_factor = [0.011, 1e3]
uncertainty = {loss_factor = 0.98}
"""
PAGE = (ROOT / "docs/materials.md").read_text("utf-8")
IMPACT = "--plate steel-dc01 --diameter 2mm --thickness 1mm --speed 2 --json".split()


@pytest.mark.parametrize(
    ("text", "more"),
    [
        (POM, {"yield_strength": 62e6}),
        ("E=2.8 GPa, nu=0.35, rho=1.41g/cm3, hardness=30 HV, kind=polymer", {"hardness": "30 HV"}),
    ],
)
def test_numbers_make_the_material_that_python_makes(text, more):
    assert material_of("sphere", text, {}) == cl.Material(text, **NUMBERS, **more)


def test_a_name_and_what_differs():
    """What is replaced has no known error any more, and a hardness is the strength."""
    soft = material_of("plate", "pmma yield=70MPa", {})
    assert soft.yield_strength == 70e6 and soft.density == cl.material("pmma").density
    assert soft.uncertainty["youngs_modulus"] == 0.11 and "yield_strength" not in soft.uncertainty
    hard = material_of("plate", "steel-s235 hardness=140HV", {})
    assert hard.strength == hard.hardness / 3.0 and not hard.uncertainty.keys() - {"youngs_modulus"}
    lighter, stronger = (material_of("plate", f"steel-s235 {text}", {}) for text in ("rho=7800", "yield=300MPa"))
    assert (lighter.specified_minimum, stronger.specified_minimum, hard.specified_minimum) == (True, False, False)


def test_a_file_is_read_as_the_catalogue_is(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    path.write_text(FILE, encoding="utf-8-sig")  # as editors of Windows save it
    mine = cl.read_materials(path)
    assert mine["delrin"] == cl.Material(
        "my-pom", **NUMBERS, yield_strength=62e6, source="my-pom", uncertainty={"yield_strength": 0.1}
    )
    assert mine["hard-304"].density == cl.material("304").density
    assert mine["hard-304"].source.endswith("hardness 3.11851e+09 Pa: measured")
    band = cl.ImpactModel(cl.Pair(mine["soft"], "glass")).uncertainty(0.3, 3e-3, 20e-3).restitution
    assert max(band.causes, key=band.causes.get) == "loss factor of the bead" and band.high - band.low > 0.02
    assert main(["cor", "--materials", str(path), "--sphere", "Delrin", *IMPACT]) == 0
    row = json.loads(capsys.readouterr().out)
    model = cl.ImpactModel(cl.Pair(mine["my-pom"], "steel-dc01"))
    assert row["restitution"] == pytest.approx(model.restitution(2.0, 1e-3, 1e-3), abs=1e-6)
    assert (row["sphere"], row["radius"]) == ("my-pom", 1e-3)
    assert main(["materials", "--materials", str(path)]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [row[:2] for row in rows[2:5]] == [["hard-304", "193"], ["my-pom", "2.8"], ["soft", "2.7"]]


@pytest.mark.parametrize(
    ("like", "low", "high"),
    [("pmma", 0.002, 0.06), *((name, 0.003, 0.1) for name in ("hdpe", "polypropylene", "polystyrene"))],
)
def test_the_lines_of_handbooks_are_those_of_their_extremes(like, low, high, tmp_path):
    """In the logarithm, as if every value between the extremes were as likely."""
    rows = re.findall(r"^\| ([a-z, ]+) \| `(loss_factor = .*?)`, `(uncertainty = .*?)` \|$", PAGE, re.MULTILINE)
    (lines,) = [lines for names, *lines in rows if like in names.split(", ")]
    path = tmp_path / "mine.toml"
    path.write_text("\n".join(["[mine]", f'like = "{like}"', *lines]))
    mine = cl.read_materials(path)["mine"]
    assert mine.loss_factor == (pytest.approx(math.sqrt(low * high), rel=0.02), 1e3)
    assert mine.uncertainty["loss_factor"] == pytest.approx(math.log(high / low) / math.sqrt(12.0), rel=0.02)


def test_one_source_for_all_numbers(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('[soft]\nlike = "glass"\nyield_strength = 1e8\nsource = "tests of {May}"')
    assert cl.read_materials(path)["soft"].source.endswith("yield strength 1e+08 Pa: tests of {May}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("pomm", "did you mean 'pom' or 'pmma'? `contactlaw materials` lists all; one of your own is"),
        ("E=2.8GPa nuu=0.35 rho=1410", "--sphere: unknown 'nuu'; did you mean nu? known: E, nu"),
        ("E=2.8GPa", "'E=2.8GPa' lacks nu and rho, as in \"E=2.8GPa nu"),
        ("E=2.8GPa nu=0.35 rho=1410m", "--sphere: got '1410m': 'm' is no unit of density"),
        ("E=2.8 nu=0.35 rho=1410", '--sphere: E=2.8 has no unit, as in "E=2.8GPa nu=0.35'),
        ("E=70000 nu=0.35 rho=2.7 yield=276MPa", "--sphere: E=70000 has no unit"),
        ("E=200GPa nu=0.3 rho=7800 hardness=62", "--sphere: hardness=62 has no unit"),
        ("E=2GPa E=3GPa nu=0.35 rho=1410", "--sphere: 'E=2GPa E=3GPa nu=0.35 rho=1410' has a key twice"),
        ("name=a E=2GPa nu=0.35 rho=1410 name=b", "has a key twice: leave one out"),
        ("yeild 350MPa E=207GPa nu=0.3 rho=7850", "--sphere: unknown material 'yeild 350MPa'"),
        (
            "pmma loss_factor=handbook",
            "got 'handbook'; must be (tan delta, frequency), the frequency in Hz: write loss_factor = [",
        ),
    ],
)
def test_what_is_no_material_is_refused_with_the_remedy(text, message, capsys):
    refused(["cor", "--sphere", text, *IMPACT], message, capsys=capsys)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("density", "densty", r"mine.toml: \[my-pom\]: unknown 'densty'; did you mean density\?"),
        ("density = 1410", "", r"\[my-pom\]: give density, in SI units"),
        ('"stainless-steel-304"', '"304L"', r"\[hard-304\]: like = '304L' is no entry"),
        ('"stainless-steel-304"', '"hard-304"', r"\[hard-304\]: like = 'hard-304' is no other entry"),
        ("= 2.8e9", "= ", "mine.toml: Invalid value"),
        ("= 2.8e9", "= " + "[" * 3000, "mine.toml: .*recursion"),
        ("[my-pom]", "", "mine.toml: "),
        ("{yield_strength = 0.1}", "0.1", "mine.toml: "),
        ("[my-pom]", "pom = 3\n[my-pom]", r"pom = 3 is no material: write \[pom\]"),
        ('["delrin"]', '["Hard 304"]', r"\[hard-304\]: leave out 'hard-304', a name of \[my-pom\]"),
        ('["delrin"]', '["pom-1", "POM_1"]', r"pom\]: leave out 'POM_1', a name of \[my-pom\]"),
        ("hard-304", "My-POM", r"\[My-POM\]: leave out 'My-POM', a name of \[my-pom\]"),
        ('["delrin"]', '"delrin"', r"\[my-pom\]: aliases must be a list of names, got 'delrin'"),
        ("{yield_strength = 0.1}", "{yield_strength = inf}", "leave it out, and write specified_minimum = true"),
        (
            "{yield_strength = 0.1}",
            "{yield_strength = -1.0}",
            "yield_strength must be a relative standard error from 0 to 1",
        ),
        ("[0.011, 1e3]", '"handbook"', r"write loss_factor = \[0.03, 1e4\]"),
    ],
)
def test_a_file_with_a_mistake_is_refused(old, new, message, tmp_path):
    (tmp_path / "mine.toml").write_text(FILE.replace(old, new, 1))
    with pytest.raises(ValueError, match=message):
        cl.read_materials(tmp_path / "mine.toml")


def test_a_length_without_a_unit_draws_a_warning(capsys, tmp_path):
    asked = [*IMPACT, "--outside", "solve", "--sphere", "alumina", "--thickness"]
    assert main(["cor", *asked, "1m", "--diameter", "3"]) == 0
    assert capsys.readouterr().err == "contactlaw: warning: 3 is 3 m; 3mm?\n"
    assert main(["cor", *asked, "1m,inf", "--diameter", "3m"]) == 0
    assert main(["cor", *asked, "0.05,inf", "--diameter", "0.01"]) == 0
    assert capsys.readouterr().err == ""
    with pytest.warns(UserWarning, match="thickness: 1 is 1 m; 1e-3 for 1 mm") as said:
        Plate((0, 0, 0), (1, 0, 0), (0, 1, 0), thickness=1.0)
    part = tmp_path / "part.obj"
    part.write_text("v 0 0 0\nv 100 0 0\nv 0 50 0\nf 1 2 3\n")
    with pytest.warns(UserWarning, match="the mesh is 100 m long; scale=1e-3 if it") as again:
        Mesh.read(part, 1e-3)
    assert {one.filename for one in (*said, *again)} == {__file__}
    assert Mesh.read(part, 1e-3, scale=1.0).area == pytest.approx(2500)


def test_numbers_of_a_file_may_have_units_and_short_names(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        '[sheet]\nlike = "dc01"\nyield = "250 N/mm2"\nhardness = "1.1 GPa"\n'
        '[bead]\nE = "2.8 GPa"\nnu = 0.35\nrho = "1.41 g/cm3"\nhardness = "80 HV"\n'
        '[other]\nlike = "BEAD"\nE = 3e9'
    )
    mine, steel = cl.read_materials(path), cl.material("DC01")
    sheet, bead = mine["sheet"], mine["bead"]
    assert (sheet.youngs_modulus, sheet.density) == (steel.youngs_modulus, steel.density)
    assert (sheet.yield_strength, sheet.hardness) == (250e6, 1.1e9)
    assert (bead.youngs_modulus, bead.poissons_ratio, bead.density) == (2.8e9, 0.35, 1410.0)
    assert bead.hardness == cl.Material("bead", 2.8e9, 0.35, 1410.0, hardness="80 HV").hardness
    assert (mine["other"].youngs_modulus, mine["other"].density) == (3e9, 1410.0)
    for old, new, said in (
        ("2.8 GPa", "2.8 psi", "'psi' is no unit of stress"),
        ("nu =", "youngs_modulus = 1e9\nnu =", "give the short name or the long one"),
    ):
        path.write_text(path.read_text().replace(old, new))
        with pytest.raises(ValueError, match=f"mine.toml: .*{said}"):
            cl.read_materials(path)
        path.write_text(path.read_text().replace(new, old))

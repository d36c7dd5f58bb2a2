"""Materials of one's own on the command line, and lengths that are likelier millimetres."""

import math
import re

import pytest
from places import ROOT

import contactlaw as cl
from contactlaw.cli.parts.own import material_of
from contactlaw.walls import Mesh, Plate

NUMBERS = {"youngs_modulus": 2.8e9, "poissons_ratio": 0.35, "density": 1410, "kind": "polymer"}
FILE = """
[my-pom]
aliases = ["delrin"]
kind = "polymer"
E = "2.8 GPa"
nu = 0.35
rho = "1.41 g/cm3"
yield = "62 N/mm2"
uncertainty = {yield_strength = 0.1}

[hard-304]
like = "stainless-steel-304"
hardness = "32 HRC"
source = {hardness = "measured"}

[soft]
like = "pmma"
loss_factor = [0.011, 1e3]
uncertainty = {loss_factor = 0.98}
source = "tests of {May}"

[stiff]
like = "DELRIN"
E = 3e9
yield = 7e7
"""
PAGE = (ROOT / "docs/materials.md").read_text("utf-8")
IMPACT = "cor --plate steel-dc01 --diameter 2mm --thickness 1mm --speed 2 --json"


@pytest.mark.parametrize(
    ("text", "more"),
    [
        ("E=2.8GPa nu=0.35 rho=1410 yield=62MPa kind=polymer", {"yield_strength": 62e6}),
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


def test_a_file_is_read_as_the_catalogue_is(folder, answer):
    (folder / "mine.toml").write_text(FILE, encoding="utf-8-sig")  # as editors of Windows save it
    mine = cl.read_materials("mine.toml")
    assert mine["delrin"] == cl.Material(
        "my-pom", **NUMBERS, yield_strength=62e6, source="my-pom", uncertainty={"yield_strength": 0.1}
    )
    hard, sheet = mine["hard-304"], cl.material("304")
    assert hard.density == sheet.density and hard.uncertainty == {"youngs_modulus": 0.03}
    assert hard.source.split("; ")[1:4] == sheet.source.split("; ")[1:4]
    assert hard.source.endswith("hardness 3.11851e+09 Pa: measured")
    assert "loss factor and its frequency [Hz] 0.011, 1000: tests of {May}" in mine["soft"].source
    stiff = mine["stiff"]
    assert (stiff.youngs_modulus, stiff.density, stiff.uncertainty) == (3e9, 1410.0, {})
    band = cl.ImpactModel(cl.Pair(mine["soft"], "glass")).uncertainty(0.3, 3e-3, 20e-3).restitution
    assert max(band.causes, key=band.causes.get) == "loss factor of the bead" and band.high - band.low > 0.02
    row = answer(f"{IMPACT} --materials mine.toml --sphere Delrin").values
    model = cl.ImpactModel(cl.Pair(mine["my-pom"], "steel-dc01"))
    assert row["restitution"] == pytest.approx(model.restitution(2.0, 1e-3, 1e-3), abs=1e-6)
    assert (row["sphere"], row["radius"]) == ("my-pom", 1e-3)
    rows = [line.split() for line in answer("materials --materials mine.toml").out.splitlines()]
    assert [row[:2] for row in rows[2:6]] == [["hard-304", "193"], ["my-pom", "2.8"], ["soft", "2.7"], ["stiff", "3"]]


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


def test_a_length_without_a_unit_draws_a_warning(answer, tmp_path):
    asked = f"{IMPACT} --outside solve --sphere alumina --diameter"
    assert answer(f"{asked} 3 --thickness 1m").err == "contactlaw: warning: 3 is 3 m; 3mm?\n"
    assert answer(f"{asked} 3m --thickness 1m,inf").err == answer(f"{asked} 0.01 --thickness 0.05,inf").err == ""
    with pytest.warns(UserWarning, match="thickness: 1 is 1 m; 1e-3 for 1 mm") as of_plate:
        Plate((0, 0, 0), (1, 0, 0), (0, 1, 0), thickness=1.0)
    part = tmp_path / "part.obj"
    part.write_text("v 0 0 0\nv 100 0 0\nv 0 50 0\nf 1 2 3\n")
    with pytest.warns(UserWarning, match="the mesh is 100 m long; scale=1e-3 if it") as of_mesh:
        Mesh.read(part, 1e-3)
    assert {warning.filename for warning in (*of_plate, *of_mesh)} == {__file__}
    assert Mesh.read(part, 1e-3, scale=1.0).area == pytest.approx(2500)

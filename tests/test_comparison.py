"""Measured CORs beside the model: chi-squared, its probability, and what is not known."""

import dataclasses

import numpy as np
import pytest
from rebounds import RADIUS, THICKNESS

import contactlaw as cl
from contactlaw import laws
from contactlaw.cli.parts import rebounds

STEEL = cl.Material("my steel", 200e9, 0.29, 7800.0, 1.2e9, kind="metal", uncertainty={"yield_strength": 0.1})
PAIR = cl.Pair(STEEL, "soda-lime-glass")
SPEED = np.geomspace(0.5, 8.0, 9)
HEAD = """# title = "steel on glass"
# thickness_error = "2%"
# plate = "soda-lime-glass"
# [sphere]
# name = "my steel"
# E = "200 GPa"
# nu = 0.29
# rho = 7800.0
# yield = "1200 MPa"
# kind = "metal"
# uncertainty = {yield_strength = 0.1}
"""


def data(cor, error):
    return {"speed": SPEED, "radius": RADIUS, "thickness": THICKNESS, "restitution": cor, "restitution_error": error}


def test_data_that_scatter_as_stated_agree_by_chance_as_often_as_stated():
    """The model's own rebounds, with bead of a wrong strength, the law's error, and noise."""
    random, error, shares = np.random.default_rng(1), 0.01, []
    exact = cl.ImpactModel(PAIR).solve(SPEED, RADIUS, THICKNESS).restitution
    band = cl.compare(PAIR, data(exact, error)).band
    for _ in range(40):
        off = random.standard_normal() * band.causes["yield strength of the bead"]
        off = off + error * random.standard_normal(SPEED.size)
        shares.append(cl.compare(PAIR, data(exact + off, error)).probability)
    # chi-squared counts the law's error too, which these data do not have
    assert 0.45 < np.mean(shares) < 0.75 and np.mean(np.less(shares, 0.05)) < 0.1
    wrong = cl.compare(PAIR, data(exact - 0.1 * np.linspace(-1.0, 1.0, SPEED.size), error))
    assert wrong.probability < 1e-6


def test_an_error_that_all_rebounds_share_is_no_scatter():
    """With a strength 2 standard errors off, chi-squared is 2^2 or less, and not that of 9 rebounds."""
    stronger = cl.Material("s", 200e9, 0.29, 7800.0, 1.2e9 * np.exp(0.2), kind="metal")
    moved = cl.ImpactModel(cl.Pair(stronger, "soda-lime-glass")).solve(SPEED, RADIUS, THICKNESS).restitution
    found = cl.compare(PAIR, data(moved, 3e-3))
    assert 2.0 < found.chi_squared < 4.6  # the strength is not quite linear
    alone = sum(((moved - found.restitution) / 3e-3) ** 2)
    assert alone > 20.0 * found.chi_squared


def test_an_error_that_moves_thin_and_thick_plates_apart_does_so_in_chi_squared():
    """A stiffer sheet raises the COR, a stiffer block lowers it: CORs that both rise are no such error."""
    impacts = {"speed": [0.5, 3.0], "radius": 3e-3, "thickness": [1.8e-3, 30e-3], "restitution_error": 1e-4}
    ball = cl.Material("ball", 203e9, 0.29, 7800.0, kind="ceramic")
    sheet = cl.Material("sheet", 69e9, 0.33, 2700.0, 100e6, kind="metal", uncertainty={"youngs_modulus": 0.1})
    pairs = [cl.Pair(ball, body) for body in (sheet, dataclasses.replace(sheet, youngs_modulus=76e9))]
    exact, stiffer = (cl.ImpactModel(pair).solve(impacts["speed"], 3e-3, impacts["thickness"]) for pair in pairs)
    off = stiffer.restitution - exact.restitution
    assert off[0] > 0.0 > off[1]
    moved, both = (cl.compare(pairs[0], impacts | {"restitution": exact.restitution + x}) for x in (off, abs(off)))
    assert moved.if_exact < 2.0 and both.if_exact > 50.0


def test_rebounds_that_are_alike_with_hardly_an_error_have_a_chi_squared():
    pair = cl.Pair("soda-lime-glass", "aluminium-6061-t6")
    impact = {"speed": [2.0] * 3, "radius": 3e-3, "thickness": 5e-3, "restitution_error": 1e-9}
    alike = cl.compare(pair, impact | {"restitution": 0.7})
    shared = sum(size[0] ** 2 for size in alike.band.causes.values())
    assert alike.chi_squared == pytest.approx((0.7 - alike.restitution[0]) ** 2 / shared, rel=1e-3)
    assert cl.compare(pair, impact | {"restitution": [0.7, 0.7, 0.701]}).chi_squared > 1e5


def test_what_is_not_known_is_named():
    found = cl.compare(cl.Pair("stainless-steel-304", "glass"), data(0.5 * np.ones(9), 0.01))
    assert found.unknown == ("yield strength of the bead",) and np.isfinite(found.chi_squared)
    assert np.isfinite([found.band.low, found.band.high]).all()
    assert cl.compare(cl.Pair("stainless-steel-304", "glass"), found.data, "hertz").unknown == ()
    with pytest.raises(cl.ArgumentError, match="restitution_error: has to be given"):
        cl.compare(PAIR, {**data(0.5, 0.1), "restitution_error": None})


def test_the_command_reads_conditions_draws_and_prints_for_other_programs(folder, answer):
    impacts = {"speed": [2.0, 3.0], "radius": 3e-3, "thickness": [np.inf, 5e-3]}
    cors = cl.ImpactModel(PAIR).solve(**impacts).restitution.tolist()
    rows = f"2,6,inf,{cors[0]},0.02\n3,6,5,{cors[1]},0.02\n"
    (folder / "mine.csv").write_text(f"{HEAD}speed_m/s,diameter_mm,thickness_mm,COR,COR_error\n{rows}")
    found = cl.compare(PAIR, impacts | {"restitution": cors, "restitution_error": 0.02}, thickness_error=0.02)
    text = answer("compare mine.csv").text
    assert "steel on glass" in text and "my steel on soda-lime-glass, law fem" in text
    assert "the data agree with the model" in text and "Law fem is nearest to the data." in text
    answer("compare mine.csv --plot one.svg")
    assert "By their errors, the data agree with the model" in (folder / "one.svg").read_text()
    (folder / "far.csv").write_text(f"{HEAD}speed_m/s,diameter_mm,thickness_mm,COR,COR_error\n3,6,5,0.1,0.02\n")
    text = answer("compare far.csv").text
    assert "the probability of a value as large is below 0.01 %: the data differ from the model by" in text
    answer("compare far.csv --plot one.svg")
    assert "the data differ from the model" in (folder / "one.svg").read_text()
    printed = answer("compare mine.csv --json").values
    assert printed["title"] == "steel on glass" and printed["chi_squared"] == pytest.approx(found.chi_squared)
    assert printed["probability"] == printed["laws"]["fem"]["probability"] == pytest.approx(found.probability)
    assert printed["rebounds"][0]["thickness"] == "inf" and printed["rebounds"][1]["measured"] == cors[1]
    assert [row["high"] for row in printed["rebounds"]] == pytest.approx(found.band.high.tolist())
    restitution = [float(row["restitution"]) for row in answer("compare mine.csv --csv").rows]
    assert restitution == pytest.approx(found.restitution.tolist())


@pytest.mark.parametrize(
    ("head", "numbers"),
    [
        ('hardness = "300 HV"', {"yield_strength": None, "hardness": "300 HV"}),
        (
            'yield = "300 MPa"\n# uncertainty = {yield_strength = 0.05}',
            {"yield_strength": 300e6, "uncertainty": {"youngs_modulus": 0.03, "yield_strength": 0.05}},
        ),
    ],
)
def test_a_body_like_another_has_the_numbers_of_the_head_and_their_errors(head, numbers, tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text(f'# [plate]\n# like = "stainless-steel-304"\n# {head}\nspeed_m/s,COR\n1,0.5\n')
    plate = rebounds.read(path, {}, lambda bodies: cl.Pair("glass", bodies["plate"])).pair.plate
    minimum = {} if "hardness" in numbers else {"specified_minimum": False}
    wanted = dataclasses.replace(cl.material("stainless-steel-304"), **numbers | minimum)
    assert (plate, dict(plate.uncertainty)) == (wanted, dict(wanted.uncertainty))


def test_a_head_of_windows_keeps_its_letters_and_no_head_moves_the_cursor(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_bytes('# title = "Gl\u00e4tte\\u001b[2J"\nspeed_m/s,COR\n1,0.5\n'.encode("cp1252"))
    assert rebounds.read(path, {}, lambda _: cl.Pair("glass", "glass")).title == "Gl\u00e4tte [2J"


@pytest.mark.parametrize(("share", "is_distinct"), [(0.1, False), (0.001, True)])
def test_a_law_that_the_data_do_not_distinguish_from_the_nearest_is_named_with_it(share, is_distinct, folder, answer):
    """Data between the CORs of two laws: with a large error either may be the nearest one."""
    pair = cl.Pair("gamma-alumina", "glass")
    fem, myc = (cl.ImpactModel(pair, law).solve(2.0, 2e-3, np.inf).restitution for law in ("fem", "myc"))
    row = f"2,2,inf,{0.51 * fem + 0.49 * myc},{share / 0.1 * abs(fem - myc)}"
    (folder / "mine.csv").write_text(f"speed_m/s,radius_mm,thickness,COR,COR_error\n{row}\n")
    text = answer("compare mine.csv --sphere gamma-alumina --plate glass").text
    assert "Law fem is nearest to the data." in text
    assert ("errors of data and materials do not distinguish it from " in text) != is_distinct


def test_the_nearest_law_is_that_of_the_data_whatever_the_strength():
    """A bead as strong as its error allows: another law is nearer by chance, and not over the speed."""
    stronger = dataclasses.replace(STEEL, yield_strength=1.25 * 1.2e9)
    cor = cl.ImpactModel(cl.Pair(stronger, "soda-lime-glass")).solve(SPEED, RADIUS, THICKNESS).restitution
    law = {name: cl.compare(PAIR, data(cor, 5e-3), name) for name in laws.names()}
    assert min(law, key=lambda name: law[name].rms) != "fem"
    assert law["fem"].if_exact + 30.0 < min(one.if_exact for name, one in law.items() if name != "fem")


def test_rebounds_that_differ_a_little_share_a_curve(folder, answer):
    """Noted speeds differ from drop to drop; a curve for each would fill figure and legend."""
    random = np.random.default_rng(0)
    rows = [f"{v},{h},{random.uniform(0.5, 0.6)},0.02" for v in random.uniform(1.9, 2.1, 30) for h in (2, 5)]
    (folder / "mine.csv").write_text("\n".join([f"{HEAD}speed_m/s,thickness_mm,COR,COR_error", *rows]))
    answer("compare mine.csv --diameter 6mm --plot mine.svg")
    drawn = (folder / "mine.svg").read_text()
    assert drawn.count("<!-- speed 2 m/s") <= 3 and drawn.count("<!-- ") < 60
    assert "Band: " in drawn

"""Walls that are no bare sheet, and oblique impacts, on the command line, against the model."""

import numpy as np
import pytest

import contactlaw as cl

BARE = "cor --sphere glass --plate aluminium-6061-t6 --thickness 0.5mm,1mm --radius 1mm --speed 2"
BEAD = "cor --sphere alumina --plate glass --radius 2.5mm --thickness 25mm --speed 3.9"


@pytest.mark.parametrize(
    ("option", "named", "wall"),
    [
        (
            "--on steel-s235:2mm",
            "on steel-s235:2mm",
            lambda h: cl.Layers([("aluminium-6061-t6", h), ("steel-s235", 2e-3)]),
        ),
        ("--cylinder 20mm", "(cylinder 20 mm)", lambda h: cl.Shell(h, 0.02)),
        ("--bowl=-30mm", "(bowl -30 mm)", lambda h: cl.Shell(h, -0.03, "sphere")),
        ("--foundation 10N/mm3", "(foundation 1e+10 N/m3)", lambda h: cl.Foundation(h, 1e10)),
    ],
)
def test_walls_are_those_of_the_model(option, named, wall, answer):
    """Layers have a band; the constant of one speed is its COR."""
    rows = answer(f"{BARE} --csv {option}").rows
    constants = answer(f"{BARE.replace('cor', 'constant', 1)} --csv {option}").rows
    model = cl.ImpactModel(cl.Pair("glass", "aluminium-6061-t6"))
    exact = [model.solve(2.0, 1e-3, wall(h)).restitution for h in (0.5e-3, 1e-3)]
    for values in (rows, constants):
        assert [float(row["restitution"]) for row in values] == pytest.approx(exact, abs=1e-6)
    assert [row["thickness_m"] for row in rows] == ["0.0005", "0.001"]
    assert bool(rows[0].get("restitution_low")) == option.startswith("--on")
    history = answer(f"{BARE} --thickness 1mm --history --samples 3 {option}").rows
    assert {row["plate"] for row in (*rows, *constants, *history)} == {f"aluminium-6061-t6 {named}"}


def test_liners_are_found_and_tables_know_foundations(answer):
    pair = "--sphere glass --plate aluminium-6061-t6 --radius 1mm"
    (row,) = answer(f"find thickness {pair} --speed 2 --cor 0.55 --on steel-s235:0.5mm --csv").rows
    model = cl.ImpactModel(cl.Pair("glass", "aluminium-6061-t6"))
    exact = model.thickness(0.55, 2.0, 1e-3, lambda h: cl.Layers([("aluminium-6061-t6", h), ("steel-s235", 5e-4)]))
    assert float(row["thickness_m"]) == exact.value and row["plate"].endswith(" on steel-s235:0.5mm")
    words = f"constant {pair} --thickness 1mm --foundation 1e12N/m3 --speed 0.1,10 --table"
    question, _, first, *_ = answer(words).out.splitlines()
    assert "(foundation 1e+12 N/m3)" in question
    exact = model.solve(0.1, 1e-3, cl.Foundation(1e-3, 1e12)).restitution
    assert float(first.partition(",")[2]) == pytest.approx(exact, abs=1e-6)


def test_rows_of_oblique_impacts_are_those_of_the_model(answer):
    rows = answer(f"{BEAD} --angle 0,10,60 --friction 0.1,0.3 --csv").rows
    assert [(row["friction"], row["angle_deg"]) for row in rows[2:4]] == [("0.1", "60.0"), ("0.3", "0.0")]
    row = {name: float(value) for name, value in rows[4].items() if value and not value[0].isalpha()}
    angle = np.radians(10)
    speed, sliding = 3.9 * np.cos(angle), 3.9 * np.sin(angle)
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    hit = model.oblique(speed, sliding, 2.5e-3, 25e-3, 0.3, method="solve")
    assert row["tangential_restitution"] == pytest.approx(hit.tangential_restitution, rel=1e-12)
    assert row["sliding_speed_m/s"] == pytest.approx(hit.sliding_speed, rel=1e-12)
    along = hit.tangential_restitution * sliding
    assert row["spin_rad/s"] == pytest.approx(2.5 * (sliding - along) / 2.5e-3, rel=1e-9)  # of a solid sphere
    leaves = np.degrees(np.arctan2(along, hit.restitution * speed))
    assert row["rebound_angle_deg"] == pytest.approx(leaves, rel=1e-9)


def test_a_table_of_oblique_impacts_has_the_columns_that_vary(answer):
    *question, names, units, _, _, _ = answer(f"{BEAD} --angle 10:80:3 --friction 0.2").out.splitlines()
    assert " ".join(question) == (
        "alumina on glass, law fem, friction 0.2, speed 3.9 m/s, radius 2.5 mm, thickness 25 mm"
    )
    assert names.split() == "angle COR tangential rotational spin leaves at".split()
    assert units.split() == "[deg] [-] [-] [-] [rad/s] [deg]".split()


@pytest.mark.parametrize("wall", ["", "--on steel-s235:3mm", "--cylinder 50mm", "--mass 0.2g"])
def test_a_straight_bead_rebounds_as_without_friction(wall, answer):
    """Walls and masses, too, are those of a normal impact, within the tolerance of `solve`."""
    straight, _ = answer(f"{BEAD} {wall} --angle 0,10 --friction 0.2 --json").values
    normal = answer(f"{BEAD} {wall} --solve --no-band --json").values
    assert straight["restitution"] == pytest.approx(normal["restitution"], abs=1e-8)
    assert straight["plate"] == normal["plate"]
    assert straight["angle"] == 0.0 and straight["tangential_restitution"] is None

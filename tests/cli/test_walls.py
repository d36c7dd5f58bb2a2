"""Walls that are no bare sheet, on the command line."""

import csv

import pytest

import contactlaw as cl
from contactlaw.cli import main

LINED = "cor --sphere glass --plate aluminium-6061-t6 --thickness 0.5mm,1mm --on steel-s235:2mm --radius 1mm --speed 2"
BARE = "cor --sphere glass --plate steel-s235 --thickness 0.5mm,1mm --radius 1mm --speed 2"


def rows(capsys, words):
    main(words.split())
    return list(csv.DictReader(capsys.readouterr().out.splitlines()))


@pytest.mark.parametrize("solve", ["", " --solve"])
def test_layers_are_those_of_the_model(solve, capsys):
    found = rows(capsys, f"{LINED} --csv{solve}")
    model = cl.ImpactModel(cl.Pair("glass", "aluminium-6061-t6"))
    whole = [cl.Layers([("aluminium-6061-t6", h), ("steel-s235", 2e-3)]) for h in (0.5e-3, 1e-3)]
    hit = (model.solve if solve else model.lookup)(2.0, 1e-3, whole)
    assert [float(row["restitution"]) for row in found] == pytest.approx(hit.restitution.tolist(), abs=1e-6)
    assert [row["thickness_m"] for row in found] == ["0.0005", "0.001"]
    assert {row["plate"] for row in found} == {"aluminium-6061-t6 on steel-s235:2mm"}
    assert all(row["restitution_low"] for row in found)


@pytest.mark.parametrize(
    ("option", "wall"),
    [
        ("--cylinder 20mm", lambda h: cl.Shell(h, 0.02)),
        ("--bowl=-30mm", lambda h: cl.Shell(h, -0.03, "sphere")),
        ("--foundation 10N/mm3", lambda h: cl.Foundation(h, 1e10)),
    ],
)
def test_what_swings_is_that_of_the_model(option, wall, capsys):
    found = rows(capsys, f"{BARE} --csv {option}")
    model = cl.ImpactModel(cl.Pair("glass", "steel-s235"))
    exact = model.solve(2.0, 1e-3, wall([0.5e-3, 1e-3])).restitution
    assert [float(row["restitution"]) for row in found] == pytest.approx(exact.tolist(), abs=1e-6)
    main(["cor", "--history", *BARE.replace("0.5mm,", "").split()[1:], *option.split(), "--samples", "3"])
    assert "steel-s235 (" in capsys.readouterr().out


def test_liners_are_found_and_tables_know_foundations(capsys):
    pair = "--sphere glass --plate aluminium-6061-t6 --radius 1mm"
    (found,) = rows(capsys, f"find thickness {pair} --speed 2 --cor 0.55 --on steel-s235:0.5mm --csv")
    model = cl.ImpactModel(cl.Pair("glass", "aluminium-6061-t6"))
    exact = model.thickness(0.55, 2.0, 1e-3, lambda h: cl.Layers([("aluminium-6061-t6", h), ("steel-s235", 5e-4)]))
    assert float(found["thickness_m"]) == exact.value and found["plate"].endswith(" on steel-s235:0.5mm")
    words = f"constant {pair} --thickness 1mm --foundation 1e12N/m3 --speed 0.1,10"
    main(f"{words} --table".split())
    said, _, first, *_ = capsys.readouterr().out.splitlines()
    assert "(foundation 1e+12 N/m3)" in said
    exact = model.solve(0.1, 1e-3, cl.Foundation(1e-3, 1e12)).restitution
    assert float(first.partition(",")[2]) == pytest.approx(exact, abs=1e-6)
    (wall,) = rows(capsys, f"{words} --csv")
    best = model.constant([0.1, 10.0], 1e-3, cl.Foundation(1e-3, 1e12))
    assert float(wall["restitution"]) == pytest.approx(best.restitution, rel=1e-12)
    assert wall["plate"] == "aluminium-6061-t6 (foundation 1e+12 N/m3)"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--on steel-s235", "expected a material and a thickness, as steel-s235:3mm"),
        ("--on steal-s235:3mm", "steel-s235"),
        ("--on steel-s235:-3mm", "must be positive"),
        ("--cylinder 0.5mm", "larger than the bead's"),
        ("--foundation=-3", "must lie between 0"),
    ],
)
def test_bad_walls_are_refused_in_words(words, said, capsys):
    assert main([*BARE.split(), *words.split()]) != 0
    assert said in capsys.readouterr().err

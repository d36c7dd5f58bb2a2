"""``contactlaw cor --angle --friction`` against the model and the numbers that follow from its columns."""

import csv
import io
import json

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.cli import main

BEAD = "cor --sphere alumina --plate glass --radius 2.5mm --thickness 25mm --speed 3.9".split()


def test_rows_are_those_of_the_model(capsys):
    assert main([*BEAD, "--angle", "0,10,60", "--friction", "0.1,0.3", "--csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [(row["friction"], row["angle_deg"]) for row in rows[2:4]] == [("0.1", "60.0"), ("0.3", "0.0")]
    row = {name: float(value) for name, value in rows[4].items() if value and not value[0].isalpha()}
    angle = np.radians(10)
    speed, sliding = 3.9 * np.cos(angle), 3.9 * np.sin(angle)
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    hit = model.oblique(speed, sliding, 2.5e-3, 25e-3, 0.3, method="solve")
    assert row["tangential_restitution"] == pytest.approx(hit.tangential_restitution, rel=1e-12)
    assert row["sliding_speed_m/s"] == pytest.approx(hit.sliding_speed, rel=1e-12)
    velocity, spin = model.collide(
        [sliding, 0, -speed], [0, 0, 0], [0, 0, 1], 2.5e-3, 25e-3, 0.3
    )  # by the table, whose error is 2e-3 of friction times speed
    assert row["spin_rad/s"] == pytest.approx(spin[1], abs=2e-3 * 0.3 * 3.9 / 2.5e-3)
    leaves = np.degrees(np.arctan2(velocity[0], velocity[2]))
    assert row["rebound_angle_deg"] == pytest.approx(leaves, abs=0.1)


def test_a_table_has_the_columns_that_vary(capsys):
    assert main([*BEAD, "--angle", "10:80:3", "--friction", "0.2"]) == 0
    *question, names, units, _, _, _ = capsys.readouterr().out.splitlines()
    assert " ".join(question) == (
        "alumina on glass, law fem, friction 0.2, speed 3.9 m/s, radius 2.5 mm, thickness 25 mm"
    )
    assert names.split() == "angle COR tangential rotational spin leaves at".split()
    assert units.split() == "[deg] [-] [-] [-] [rad/s] [deg]".split()
    assert main([*BEAD, "--angle", "0,10", "--friction", "0.2", "--json"]) == 0
    straight, _ = json.loads(capsys.readouterr().out)
    assert straight["angle"] == 0.0 and straight["tangential_restitution"] is None


def test_a_straight_bead_rebounds_as_without_friction(capsys):
    """Walls and masses, too, are those of a normal impact, within the tolerance of `solve`."""
    for wall in ([], ["--on", "steel-s235:3mm"], ["--cylinder", "50mm"], ["--mass", "0.2g"]):
        rows = []
        for more in (["--angle", "0", "--friction", "0.2"], ["--solve", "--no-band"]):
            assert main([*BEAD, *wall, *more, "--json"]) == 0
            rows.append(json.loads(capsys.readouterr().out))
        assert rows[0]["restitution"] == pytest.approx(rows[1]["restitution"], abs=1e-8)
        assert rows[0]["plate"] == rows[1]["plate"]

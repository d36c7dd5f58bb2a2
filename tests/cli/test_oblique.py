"""``contactlaw oblique`` against the model and the numbers that follow from its columns."""

import csv
import io

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.cli import main

BEAD = "oblique --sphere alumina --plate glass --radius 2.5mm --thickness 25mm --speed 3.9".split()


def test_rows_are_those_of_the_model(capsys):
    assert main([*BEAD, "--angle", "0,10,60", "--friction", "0.1,0.3", "--csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [(row["friction"], row["angle_deg"]) for row in rows[2:4]] == [
        ("0.1", "60.0"), ("0.3", "0.0"),
    ]  # fmt: skip
    row = {name: float(value) for name, value in rows[4].items() if name != "flags"}
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


def test_a_table_and_a_plot(capsys, tmp_path):
    assert main([*BEAD, "--angle", "10:80:3", "--friction", "0.2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 5 and lines[0].split()[:3] == ["angle", "friction", "COR"]
    path = tmp_path / "oblique.png"
    assert main([*BEAD, "--angle", "1:80:9", "--friction", "0.1", "--plot", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("angle", "friction", "message"),
    [
        ("90", "0.1", "--angle: got 90.0; must lie between 0 and 89.999 degrees from the normal"),
        ("-1", "0.1", "--angle: got -1.0"),
        ("10", "-0.1", "--friction: got -0.1"),
        ("10", "inf", "--friction: got inf"),
    ],
)
def test_refusals(capsys, angle, friction, message):
    assert main([*BEAD, f"--angle={angle}", f"--friction={friction}"]) == 1
    assert message in capsys.readouterr().err

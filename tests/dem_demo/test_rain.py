"""`dem-demo rain`: its file, its physics, its figures, and what it leaves when it fails."""

import re

import h5py
import numpy as np
import pytest
from demos import RAIN, files, names, runs_of

import contactlaw as cl
from contactlaw.reporting import summary as tables
from contactlaw.reporting.run import Run, shares
from dem_demo import cli
from dem_demo.kit import restitution
from dem_demo.kit.scene import GRAVITY
from dem_demo.kit.session import facts
from dem_demo.rain import scene as scenes
from dem_demo.rain.figures import constant_cor, energy

FIGURES = constant_cor, energy, restitution


@pytest.fixture(scope="module")
def run(rain):
    return runs_of(rain)[0]


def test_all_files_are_there_and_the_record_explains_itself(rain):
    assert names(rain) == files("rain", FIGURES)
    with h5py.File(rain / "rain.h5") as file:
        known = {name: file.attrs[name] for name in ("scene", "seed", "law")}
        assert known == {"scene": "rain", "seed": 1, "law": "myc"}
        assert "--beads 40" in file.attrs["command"]
        seen = []

        def visit(name, item):
            if isinstance(item, h5py.Dataset):
                seen.append(name)
                assert item.attrs["units"] and item.attrs["description"], name
                assert not np.isnan(item[()]).any(), name

        file.visititems(visit)
    assert {"impacts/wave_energy", "trajectories/position", "beads/radius"} <= set(seen)


def test_impacts_near_edges_are_on_the_lines_of_the_model(tmp_path, monkeypatch, nothing_drawn):
    monkeypatch.setattr(scenes, "WIDTH", 0.01)
    monkeypatch.setattr(scenes, "MARGIN", 1e-4)
    thin = ["rain", "--beads", "120", "--plates", "0.5e-3,0.6e-3,0.7e-3,inf", "--duration", "0.3"]
    assert cli.main([*thin, "--law", "myc", "--out", str(tmp_path)]) == 0
    ((run,),) = nothing_drawn
    rows, thickness = run.impacts, np.array(run.scene.plates)[run.impacts["plate"]]
    distance = abs(run.scene.ends[rows["plate"]] - rows["x"][:, None]).min(axis=1)
    speed, radius = rows["approach_speed"], run.scene.radius[rows["bead"]]
    expected = run.model.solve(speed, radius, thickness, edge="free", edge_distance=distance)
    # An impact that an edge changes by less than that may be answered as on an endless plate.
    np.testing.assert_allclose(rows["restitution"], expected.restitution, rtol=0, atol=1e-3)
    assert ((rows["flags"] & cl.Validity.NEAR_EDGE) != 0).sum() > 3


def test_summary_is_that_of_any_run_with_such_a_record(rain, run):
    text, saved = (rain / "summary.txt").read_text(), cl.read_record(rain / "rain.h5")
    assert text.endswith(tables.text(Run(saved)) + "\n") and {bodies.law for bodies in saved.bodies} == {"myc"}
    for n in range(3):
        mine = run.record.rows[run.record.rows["plate"] == n]
        assert re.search(rf"^wall {n}, .* +{mine.size} +{np.median(mine['approach_speed']):.3g} ", text, re.M)
        assert shares(mine, False).sum() == pytest.approx(1.0, abs=1e-5)
    assert "half-space" in text and max(map(len, text.splitlines()[2:])) <= 80


def test_the_same_seed_gives_the_same_rain(rain, tmp_path, nothing_drawn):
    first = cl.read_record(rain / "rain.h5").rows
    for seed, same in (("1", True), ("2", False)):
        out = tmp_path / seed
        assert cli.main([*RAIN, "--seed", seed, "--out", str(out)]) == 0
        again = cl.read_record(out / "rain.h5").rows
        assert (again.tobytes() == first.tobytes()) is same


def test_friction_spins_beads_and_takes_energy(oblique):
    """Energy along a wall is m s^2/7: the part of it that friction can take of a solid sphere."""
    (run,) = runs_of(oblique)
    rows, energy = run.contacts, run.account
    mass = run.scene.mass[rows["bead"]]
    ends = (1.0, "sliding_speed"), (rows["restitution"], "sliding_speed_after")
    before, after = (
        mass * (0.5 * (cor * rows["approach_speed"]) ** 2 + rows[sliding] ** 2 / 7) for cor, sliding in ends
    )
    lost = [rows[f"{name}_energy"].sum() / before.sum() for name in ("wave", "plastic", "other", "friction")]
    assert shares(rows, True).tolist() == pytest.approx([after.sum() / before.sum(), *lost], abs=1e-5)
    assert (rows["friction_energy"] > 0).mean() > 0.9
    # What the walls did not take, and the beads did not keep, was lost where beads hit each other.
    whole = energy.start[-1] + energy.gravity[-1]
    spinning = 0.2 * float(run.scene.mass * run.scene.radius**2 @ run.spin[-1, :, 0].astype(float) ** 2)
    assert spinning > 0.05 * whole < 20 * energy.friction[-1]
    pairs = run.record.rows[run.record.rows["other"] >= 0]
    one, two = (run.scene.mass[pairs[name]] for name in ("bead", "other"))
    normal = 0.5 * one * two / (one + two) * pairs["approach_speed"] ** 2
    assert abs(energy.others[-1] - normal @ (1.0 - pairs["restitution"] ** 2)) < 1e-4 * whole
    assert any(name == "friction on the plates" for name, _ in facts(run))


def test_beads_of_tilted_nozzles_land_on_plates():
    beads, upright = scenes.rain(beads=300, friction=0.2, tilt=40.0), scenes.rain(beads=300)
    down = -beads.velocity[:, 1]
    angle = np.degrees(np.arctan2(beads.velocity[:, 0], down))
    assert abs(np.abs(angle[down > 2.0]) - 40.0).max() < 2.0
    assert (angle > 0).sum() == (angle < 0).sum()
    fall = (np.sqrt(down**2 + 2 * GRAVITY * (scenes.HEIGHT - beads.radius)) - down) / GRAVITY
    lands = beads.position[:, 0] + fall * beads.velocity[:, 0]
    assert (np.abs(lands - upright.position[:, 0]) <= scenes.SIDEWAYS * fall + 1e-12).all()


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--sphere", "gamma-alumnia"], "gamma-alumina"),
        (["--sphere", "glass"], "needs a yield strength"),
        (["--plates", "-1e-3"], "thickness must be positive"),
        (["--plates", "1e-5", "--outside", "raise"], "too thin"),
        (["--speed", "nan,5"], "--speed: needs MIN,MAX"),
        (["--speed", "5,1e4", "--outside", "raise"], "chi ="),
        (["--radius", "1,2"], "with units: 1mm,2mm"),
        (["--beads", "0"], "--beads: got 0; at least one"),
        (["--beads", "100000"], "emitted into each other"),
        (["--seed", "-1"], "seed"),
        (["--duration", "-1"], "duration"),
        (["--friction", "-0.1"], "--friction: got -0.1; must be finite and not negative"),
        (["--tilt", "80"], "--tilt: got 80.0; must lie between 0 and 75 degrees"),
    ],
    ids=" ".join,
)
def test_refused_physics_is_one_sentence(flags, message, tmp_path, capsys):
    assert cli.main([*RAIN, *flags, "--out", str(tmp_path / "out")]) == 1
    captured = capsys.readouterr()
    assert captured.err.startswith("dem-demo: ")
    assert message in captured.err
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == []

"""`dem-demo rain`: its file, its physics, its figures, and what it leaves when it fails."""

import math
import re

import h5py
import numpy as np
import pytest
from demos import RAIN, files, names, runs_of
from matplotlib.image import imread

import contactlaw as cl
from contactlaw import style
from contactlaw.reporting import summary as tables
from contactlaw.reporting.run import Run, shares
from dem_demo import cli
from dem_demo.kit import restitution
from dem_demo.kit.scene import GRAVITY
from dem_demo.kit.session import facts, summary
from dem_demo.rain import scene as scenes
from dem_demo.rain.figures import constant_cor, energy

FIGURES = constant_cor, energy, restitution
FILES = files("rain", FIGURES)


@pytest.fixture(scope="module")
def run(rain):
    return runs_of(rain)[0]


def test_all_files_are_there_and_nothing_else(rain):
    assert names(rain) == FILES
    assert names(rain.parent) == {"out"}


def test_file_explains_itself(rain):
    with h5py.File(rain / "rain.h5") as file:
        assert file.attrs["scene"] == "rain"
        assert file.attrs["seed"] == 1
        assert file.attrs["law"] == "myc"
        assert file.attrs["version_engine"] and file.attrs["version_contactlaw"]
        assert "--beads 40" in file.attrs["command"]
        assert "Table 1" in file["bodies/0/sphere"].attrs["source"]
        assert np.isinf(file["impacts/thickness"][()]).any()
        seen = []

        def visit(name, item):
            if isinstance(item, h5py.Dataset):
                seen.append(name)
                assert item.attrs["units"], name
                assert item.attrs["description"], name
                assert not np.isnan(item[()]).any(), name

        file.visititems(visit)
    assert {"impacts/wave_energy", "trajectories/position", "beads/radius"} <= set(seen)


def test_each_impact_has_the_flags_of_the_model(tmp_path, empty_pictures, kept):
    thin = ["rain", "--beads", "30", "--plates", "0.35e-3,0.4e-3", "--duration", "0.3"]
    thin += ["--law", "myc"]
    assert cli.main([*thin, "--out", str(tmp_path)]) == 0
    ((run,),) = kept
    on, radius = run.contacts, run.scene.radius
    thickness = np.array(run.scene.plates)[on["plate"]]
    found = run.model.lookup(on["approach_speed"], radius[on["bead"]], thickness, edge_distance=run.scene.from_edge(on))
    assert on["flags"].tolist() == found.flags.tolist()
    thin = (on["flags"] & cl.Validity.THIN_PLATE) != 0
    assert thin.tolist() == (radius[on["bead"]] > 1.8 * thickness).tolist()
    assert 0 < thin.sum() < thin.size
    (meaning,) = cl.explain(cl.Validity.THIN_PLATE)
    assert f"thin plate, {thin.sum()} impacts:" in (tmp_path / "summary.txt").read_text()
    for file in ("summary.txt", "index.html"):
        assert meaning in " ".join((tmp_path / file).read_text().split())


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
    endless = run.model.restitution(speed, radius, thickness)
    assert (rows["restitution"] < endless - 0.02).sum() > 3
    flagged = (rows["flags"] & cl.Validity.NEAR_EDGE) != 0
    assert 0 < flagged.sum() == np.count_nonzero(rows["flags"])
    assert "near an edge" not in summary([run])


def test_summary_is_that_of_any_run_with_such_a_record(rain, run):
    text = (rain / "summary.txt").read_text()
    assert text.endswith(tables.text(Run(cl.read_record(rain / "rain.h5"))) + "\n")
    for n in range(3):
        mine = run.record.rows[run.record.rows["plate"] == n]
        assert re.search(rf"^wall {n}, .* +{mine.size} +{np.median(mine['approach_speed']):.3g} ", text, re.M)
        assert shares(mine, False).sum() == pytest.approx(1.0, abs=1e-5)
    assert "half-space" in text and max(map(len, text.splitlines()[2:])) <= 80


def test_beads_fly_on_parabolas(run):
    """Between two frames without a collision a bead is in free fall."""
    hits = np.sort(run.record.rows["time"])
    checked = 0
    for k in range(run.time.size - 1):
        t0, t1 = run.time[k], run.time[k + 1]
        if np.searchsorted(hits, t0) != np.searchsorted(hits, t1):
            continue
        free = (run.status[k] == 1) & (run.status[k + 1] == 1)
        dt = t1 - t0
        fall = run.velocity[k, free, 1] * dt - 0.5 * GRAVITY * dt**2
        moved = run.position[k + 1, free] - run.position[k, free]
        # the engine's Euler steps fall behind by g dt step/2, below 1e-6 m; float32 rounds at 2e-8
        np.testing.assert_allclose(moved[:, 1], fall, rtol=0, atol=2e-6)
        np.testing.assert_allclose(moved[:, 0], run.velocity[k, free, 0] * dt, rtol=0, atol=1e-7)
        checked += int(free.sum())
    assert checked > 100


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
    rows = run.contacts
    mass = run.scene.mass[rows["bead"]]
    ends = (1.0, "sliding_speed"), (rows["restitution"], "sliding_speed_after")
    before, after = (
        mass * (0.5 * (cor * rows["approach_speed"]) ** 2 + rows[sliding] ** 2 / 7) for cor, sliding in ends
    )
    lost = [rows[f"{name}_energy"].sum() / before.sum() for name in ("wave", "plastic", "other", "friction")]
    assert shares(rows, True).tolist() == pytest.approx([after.sum() / before.sum(), *lost], abs=1e-5)
    assert (rows["friction_energy"] > 0).mean() > 0.9 and rows["spin_z"].any()


def test_the_account_closes(oblique):
    """What the walls did not take, and the beads did not keep, was lost where beads hit each other."""
    (run,) = runs_of(oblique)
    energy = run.account
    whole = energy.start[-1] + energy.gravity[-1]
    spinning = 0.2 * float(run.scene.mass * run.scene.radius**2 @ run.spin[-1, :, 0].astype(float) ** 2)
    assert spinning > 0.05 * whole < 20 * energy.friction[-1]
    pairs = run.record.rows[run.record.rows["other"] >= 0]
    one, two = (run.scene.mass[pairs[name]] for name in ("bead", "other"))
    normal = 0.5 * one * two / (one + two) * pairs["approach_speed"] ** 2
    assert abs(energy.others[-1] - normal @ (1.0 - pairs["restitution"] ** 2)) < 1e-4 * whole
    assert any(name == "friction on the plates" for name, _ in facts(run))


def test_without_friction_nothing_tells_of_it(rain, run):
    with h5py.File(rain / "rain.h5") as file:
        assert not file["trajectories/spin"][()].any()
    assert not run.record.rows["friction_energy"].any()
    # the arm of an impulse along the normal is rounded: 1e-9 rad/s, of a thousand with friction
    assert abs(run.record.rows["spin_z"]).max() < 1e-8
    assert '"spin"' not in (rain / "index.html").read_text()


def test_beads_of_tilted_nozzles_land_on_plates():
    scene = scenes.rain(beads=300, friction=0.2, tilt=40.0)
    beads, upright = scene, scenes.rain(beads=300)
    angle = np.degrees(np.arctan2(beads.velocity[:, 0], -beads.velocity[:, 1]))
    fast = -beads.velocity[:, 1] > 2.0
    assert abs(np.abs(angle[fast]) - 40.0).max() < 2.0
    assert (angle > 0).sum() == (angle < 0).sum()
    height = scenes.HEIGHT - beads.radius
    down = -beads.velocity[:, 1]
    fall = (np.sqrt(down**2 + 2 * GRAVITY * height) - down) / GRAVITY
    lands = beads.position[:, 0] + fall * beads.velocity[:, 0]
    aside = np.abs(lands - upright.position[:, 0])
    assert (aside <= scenes.SIDEWAYS * fall + 1e-12).all()
    speed = np.hypot(*(beads.velocity - [[1, 0]] * (upright.velocity[:, :1])).T)
    np.testing.assert_allclose(speed, -upright.velocity[:, 1], rtol=1e-12)


@pytest.mark.parametrize("more", [[], ["--friction", "1"]], ids=["model", "oblique"])
def test_a_rain_that_never_lands(more, tmp_path, empty_pictures, capfd):
    """Its page is shown in test_page.py. Without a terminal it is quiet."""
    few = ["rain", "--law", "myc", *"--beads 2 --speed 0.5,0.6 --duration 0.01".split(), *more]
    assert cli.main([*few, "--out", str(tmp_path)]) == 0
    assert cl.read_record(tmp_path / "rain.h5").rows.size == 0
    assert "All impacts on walls are inside" in (tmp_path / "summary.txt").read_text()
    said, errors = capfd.readouterr()
    assert "Written to" in said and errors == ""


@pytest.mark.parametrize("which", ["rain", "oblique"])
def test_no_label_runs_into_the_title(request, which):
    runs = runs_of(request.getfixturevalue(which))
    for module in FIGURES:
        with style.applied():
            drawn = module.draw(runs)
            drawn.draw_without_rendering()
            heads = [text.get_window_extent() for text in drawn.texts]
            for axes in drawn.axes:
                for label in (axes.xaxis.label, axes.yaxis.label):
                    place = label.get_window_extent()
                    assert not (label.get_text() and any(map(place.overlaps, heads))), label


@pytest.mark.parametrize("name", sorted(name for name in FILES if name.endswith(".png")))
def test_figures_are_pictures(rain, name):
    picture = imread(rain / name)
    height, width, _ = picture.shape
    assert width > 800  # two points for each of a phone's
    assert height > 600
    colours = np.unique(picture[::7, ::7, :3].reshape(-1, 3), axis=0)
    assert len(colours) > 10  # not blank


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--sphere", "gamma-alumnia"], "gamma-alumina"),
        (["--plate", "no-such-thing"], "unknown material"),
        (["--sphere", "glass"], "needs a yield strength"),
        (["--law", "mcy"], "did you mean 'myc'"),
        (["--plates", "-1e-3"], "thickness must be positive"),
        (["--plates", "-1mm"], "thickness must be positive"),
        (["--plates", "0"], "thickness must be positive"),
        (["--plates", "nan"], "thickness must be positive"),
        (["--plates", "1e-5", "--outside", "raise"], "too thin"),
        (["--speed", "nan,5"], "--speed: needs MIN,MAX"),
        (["--speed", "5,1e4", "--outside", "raise"], "chi ="),
        (["--radius", "0,1e-3"], "--radius: needs MIN,MAX"),
        (["--radius", "1,2"], "with units: 1mm,2mm"),
        (["--beads", "0"], "--beads: got 0; at least one"),
        (["--beads", "100000"], "emitted into each other"),
        (["--seed", "-1"], "seed"),
        (["--duration", "-1"], "duration"),
        (["--friction", "-0.1"], "--friction: got -0.1; must be finite and not negative"),
        (["--friction", "nan"], "--friction: got nan; must be finite and not negative"),
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


def test_quantities_may_have_units():
    units = ["rain", "--plates", "0.5mm, inf", "--radius", "500um,0.9mm", "--speed", "18km/h,10m/s"]
    given = cli.parser().parse_args(units)
    assert given.plates == pytest.approx((0.5e-3, math.inf))
    assert given.radius == pytest.approx((0.5e-3, 0.9e-3))
    assert given.speed == pytest.approx((5.0, 10.0))


@pytest.mark.parametrize(
    "argv",
    [[], ["snow"], ["rain", "--plates", "thin"], ["rain", "--radius", "1e-3"], ["rain", "--dur=1"]],
    ids=" ".join,
)
def test_wrong_usage_is_status_2(argv, capsys):
    with pytest.raises(SystemExit) as stop:
        cli.main(argv)
    assert stop.value.code == 2
    assert "usage:" in capsys.readouterr().err


def test_scene_spreads_over_its_ranges():
    scene = scenes.rain(beads=500, seed=7)
    radius, speed = scene.radius, -scene.velocity[:, 1]
    assert radius.min() == pytest.approx(0.5e-3, rel=0.05)
    assert radius.max() == pytest.approx(0.9e-3, rel=0.05)
    assert speed.max() > 14
    assert (np.diff(scene.emission_time) >= 0).all()
    assert scene.top_speed * scene.time_step < radius.min() / 2

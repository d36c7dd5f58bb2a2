"""Files of records: what engines save is what is read, and what a table says of it."""

import dataclasses
import re

import command_line
import h5py
import numpy as np
import pytest
from places import ROOT
from pymunk_room import make_bead, make_plate, make_space, steps

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from contactlaw.engines.record import IMPACT
from contactlaw.export.scene_file import surface_of
from contactlaw.record.file import flagged

MODELS = [
    cl.ImpactModel(cl.Pair(sphere, plate))
    for sphere in ("gamma-alumina", "glass")
    for plate in ("glass", "carbon-steel-1020")
]


@pytest.fixture(scope="module")
def run():
    """Beads of two materials that fall on plates of two materials, and two that meet."""
    space = make_space(0.0)
    impacts = attach(space, MODELS)

    def add_bead(sphere, *motion):
        impacts.add_bead(make_bead(space, *motion, density=cl.material(sphere).density), material=sphere)

    for n, plate in enumerate(("glass", "carbon-steel-1020")):
        shape = make_plate(space, (0.1 * n, 0), (0.1 * n + 0.09, 0))
        impacts.add_plate(shape, 1e-3, material=plate)
        for k, sphere in enumerate(("gamma-alumina", "glass", "glass")):
            add_bead(sphere, (0.1 * n + 0.02 * k, 2e-3), (0, -2.0 - k))
    for side, sphere in ((-1, "gamma-alumina"), (1, "glass")):
        add_bead(sphere, (1 + 1e-3 * side, 1), (-side, 0))
    steps(space, 20)
    return space, impacts


def test_a_flipped_bit_is_refused_or_changes_no_number(tmp_path):
    """Data, their types and shapes, and attributes have checksums, all but the texts of attributes."""
    random, path = np.random.default_rng(23), tmp_path / "run.h5"
    rows = np.zeros(40, [(name, IMPACT[name]) for name in ("time", "x", "flags")])
    rows["time"], rows["x"] = np.sort(random.random((2, 40)))
    cl.Record(rows, [cl.Bodies(MODELS[3].pair, "fem")]).save(path)
    content = path.read_bytes()
    with h5py.File(path) as file:
        places = [file["impacts"][name].id.get_chunk_info(0).byte_offset for name in ("time", "x", "flags", "bodies")]

    def numbers(*bits):
        changed = bytearray(content)
        for bit in bits:
            changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        record = cl.read_record(path)
        bodies = [dataclasses.astuple(body)[1:5] for bodies in record.bodies for body in bodies.pair.given]
        return record.rows.tobytes(), bodies

    wanted, refused = numbers(), 0
    for place in places:
        with pytest.raises(ValueError, match="is damaged: "):
            numbers(8 * place + 19)
    for bit in random.choice(8 * len(content), 200, replace=False).tolist():
        try:
            assert numbers(bit) == wanted, bit
        except ValueError:
            refused += 1
    assert refused > 100


def test_what_is_saved_is_read(run, tmp_path):
    run[1].save(tmp_path / "run.h5")
    found = cl.read_record(tmp_path / "run.h5")
    rows = run[1].collisions()
    assert found.rows.tolist() == rows[np.lexsort((rows["bead"], rows["time"]))].tolist()
    assert found.lacks == "the surface of the walls" and found.rows.size == 7
    assert (found.made["engine"], found.made["version_contactlaw"]) == ("pymunk", cl.__version__)
    spheres, plates = (table["material"] for table in (run[1].beads(), run[1].plates()))
    for row, n in zip(found.rows, found.which, strict=True):
        pair, law = found.bodies[n]
        on = plates[row["plate"]] if row["plate"] >= 0 else spheres[row["other"]]
        assert (pair.sphere.name, pair.plate.name) == (spheres[row["bead"]], on)
        if row["plate"] >= 0:
            again = cl.ImpactModel(pair, law)
            size = row["approach_speed"], row["radius"], row["thickness"]
            assert again.restitution(*map(float, size)) == row["restitution"]


def test_results_are_by_material_and_wall(run, folder, answer, capsys, empty_pictures):
    run[1].save("run.h5")
    answer("report run.h5 --out out")
    text = (folder / "out/summary.txt").read_text()
    shown = re.findall(r"^wall (\d), 1 mm of (\S+), beads of (\S+) +(\d+) ", text, re.MULTILINE)
    plates, spheres = enumerate(("glass", "carbon-steel-1020")), (("gamma-alumina", "1"), ("glass", "2"))
    assert {*shown} >= {(str(n), plate, *sphere) for n, plate in plates for sphere in spheres}
    constants = answer("constant run.h5 --csv").rows
    record = run[1].record()
    assert len(constants) == 4
    for row in constants:
        names = [(bodies.pair.sphere.name, bodies.pair.plate.name) for bodies in record.bodies]
        own = record.rows[(record.which == names.index((row["sphere"], row["plate"]))) & (record.rows["plate"] >= 0)]
        best = np.average(own["restitution"] ** 2, weights=own["approach_speed"] ** 2)  # all beads are of one size
        assert float(row["restitution"]) ** 2 == pytest.approx(best, rel=2e-6)
    refused = command_line.run("constant run.h5 --sphere PMMA", capsys)
    assert "--sphere: got 'PMMA'; the record has gamma-alumina on glass, " in refused.err


def test_several_files_of_a_run_are_one(run, tmp_path):
    """Also where a run went on after a save: rows that are in both files are taken once."""
    whole = run[1].record()
    first, second = tmp_path / "1.h5", tmp_path / "2.h5"
    order = np.lexsort((whole.rows["bead"], whole.rows["time"]))
    whole.part(order[4:]).save(first)
    whole.rows["flags"][order[4]] |= cl.Validity.SHARED_PLATE  # which the first save could not know
    half = whole.part(order[:5])  # whose materials are in another order
    dataclasses.replace(half, bodies=half.bodies[::-1], which=len(half.bodies) - 1 - half.which).save(second)
    dataclasses.replace(whole.part(order[:0]), bodies=[]).save(nothing := tmp_path / "0.h5")  # nothing has hit yet
    for paths in ((first, second), (second, first, nothing), (nothing, first, second)):
        found = cl.read_record(*paths)
        assert found.rows.tolist() == whole.rows[order].tolist()
        bodies = [whole.bodies[n] for n in whole.which[order]]
        assert [found.bodies[n] for n in found.which] == bodies
    np.save(tmp_path / "3.npy", whole.rows)
    with pytest.raises(ValueError, match=r"3\.npy: it lacks materials and law.* but the file before it lacks"):
        cl.read_record(first, tmp_path / "3.npy")
    with pytest.raises(TypeError, match="expected the path of a file"):
        cl.read_record()


def rows_of(run, start, *times):
    rows = np.zeros(len(times), IMPACT)
    rows["run"], rows["run_start"], rows["time"] = run, start, times
    return rows


@pytest.mark.parametrize("end", ["h5", "npy"])
def test_files_of_two_runs_are_one_only_if_one_goes_on_from_the_other(end, folder):
    runs = {"a": (7, 0.0, 0.1, 0.5, 0.6), "b": (7, 0.0, 0.2), "on": (8, 0.5, 0.55), "anew": (9, 0.0, 0.3)}
    old = [name for name in IMPACT.names if not name.startswith("run")]  # of a version without these columns
    for name, times in runs.items():
        np.save(f"{name}.npy", rows_of(*times))
        np.save(f"old_{name}.npy", rows_of(*times)[old])
        cl.Record(rows_of(*times)).save(f"{name}.h5")

    def read(*names):
        return cl.read_record(*(f"{name}.{end}" for name in names)).rows["time"].tolist()

    assert read("b", "a") == [0.1, 0.2, 0.5, 0.6]
    with pytest.warns(UserWarning, match="1 rows are left out: the run that goes on from a restart"):
        assert read("on", "a") == [0.1, 0.5, 0.55]
    for names in (("a", "on", "anew"), ("anew", "a")):
        with pytest.raises(ValueError, match=f"begins at 0 s, too: leave out the files of the earlier .*a.{end}"):
            read(*names)
    assert cl.read_record("old_a.npy", "old_b.npy").rows.size == 4
    with pytest.raises(ValueError, match=r"anew.npy: .*a.npy is of another run.* the earlier one, as old_a.npy"):
        cl.read_record("old_a.npy", "anew.npy")


@pytest.mark.parametrize(
    ("share", "plates", "shared"), [(0.15, (0, 0), True), (0.07, (0, 0), False), (0.5, (0, 1), False)]
)
def test_two_beads_share_a_plate_from_a_tenth_of_motion_on(share, plates, shared):
    rows = np.zeros(2, IMPACT)
    rows["mass"], rows["approach_speed"], rows["thickness"] = 2e-6, 3.0, 1e-3
    rows["wave_energy"], rows["contact_time"], rows["peak_force"] = share * 0.5 * 2e-6 * 3.0**2, 1e-5, 20.0
    rows["plate"], rows["x"] = plates, (0.0, 3e-3)
    found = flagged(cl.Record(rows, [cl.Bodies(cl.Pair("glass", "glass"), "fem")]))
    assert (found.rows["flags"] == int(cl.Validity.SHARED_PLATE) * shared).all()


def test_every_field_of_a_material_is_kept(tmp_path):
    more = {"hardness": 2e9, "hardening": (5e6, 0.3), "rate": (0.02, 1.0)}
    more |= {"loss_factor": (0.05, 1e4), "uncertainty": {"yield_strength": 0.15}, "specified_minimum": True}
    sphere = dataclasses.replace(cl.material("gamma-alumina"), **more)
    plate = cl.Material("steel", 207e9, 0.3, 7850, kind="metal", hardness="62 HRC", hardening=0.1)
    assert None not in dataclasses.astuple(sphere)
    bodies = [cl.Bodies(cl.Pair(sphere, plate), "fem")]
    cl.Record(np.zeros(1, IMPACT), bodies).save(tmp_path / "run.h5")
    assert list(cl.read_record(tmp_path / "run.h5").bodies) == bodies
    with pytest.raises(ValueError, match=r"path: got .*run.txt'; must end in .h5 or .hdf5"):
        cl.Record(np.zeros(1, IMPACT), bodies).save(tmp_path / "run.txt")


def test_errors_of_minima_that_0_3_stored_are_not_stated(tmp_path):
    path = tmp_path / "run.h5"
    cl.Record(np.zeros(1, IMPACT), [cl.Bodies(cl.Pair("glass", "steel-s235"), "fem")]).save(path)
    with h5py.File(path, "r+") as file:
        plate = file["bodies/0/plate"].attrs
        del plate["specified_minimum"]
        plate["uncertainty"] = '{"youngs_modulus": 0.03, "yield_strength": -0.42, "hardness": Infinity}'
    found = cl.read_record(path).bodies[0].pair.plate
    assert found.uncertainty == {"youngs_modulus": 0.03} and not found.specified_minimum


def test_a_record_of_1_0_and_its_scene_are_read_by_all_later_versions():
    """The fix of LAMMPS made them; they may not be made anew.

    Two elastic beads of 0.9 mm, of 879 and 7850 kg/m3, hit 1 and 3 mm of glass at 2 m/s. COR and
    contact time are those of `oracle.series`, which integrates Zener's equation by scipy.
    """
    found = cl.read_record(ROOT / "tests/record/run_1_0.h5")
    assert found.rows["restitution"] == pytest.approx([0.922782, 0.937648], abs=1e-6)
    assert found.rows["contact_time"] == pytest.approx([5.832176e-6, 7.221939e-6], rel=1e-6)
    given = [(pair.sphere.density, pair.plate.youngs_modulus, law) for pair, law in found.bodies]
    assert given == [(879, 73e9, "hertz"), (7850, 73e9, "hertz")]
    for surface in found.surface, surface_of(ROOT / "tests/export/walls_1_0.scene", found.rows):
        assert [*surface.names] == ["thin", "thick"]
        assert surface.corners[surface.wall == 1].min(axis=(0, 1)).tolist() == [0, -0.02, 0]

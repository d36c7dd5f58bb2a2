"""Beads and plates of several materials in LAMMPS, and other units than SI."""

import dataclasses
import itertools

import metal
import numpy as np
import pytest
from lammps_box import ALIKE, DENSITY, PAIR, PLATE, R, above, attach, flat, make, quiet, state

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate, Rotation, Translation, pair_coeff

SPHERES = ("gamma-alumina", "glass", "bearing-steel-52100")
STEEL, ALUMINIUM = "stainless-steel-304", "aluminium-6061-t6"


def models(plate):
    return {n: cl.ImpactModel(cl.Pair(name, plate)) for n, name in enumerate(SPHERES, start=1)}


def run(kinds, places, velocity, walls, model, *commands):
    """Impacts of beads of these atom types, and LAMMPS."""
    density = [cl.material(SPHERES[kind - 1]).density for kind in kinds]
    lmp = make(places, velocity, density=density, types=3, kind=kinds)
    lmp.commands_list(list(commands))
    attached = attach(lmp, model, walls)
    lmp.command("run 1500")
    return np.sort(attached.collisions(), order="bead"), lmp


THREE = [1, 1, 2, 2, 3, 3], [above(1e-5, x, 0.01 * kind) for kind in (1, 2, 3) for x in (-0.02, 0.02)]


def test_each_bead_and_plate_has_its_material():
    """Beads on each other, too: in the air a pair of each two types meets."""
    left, right = models(STEEL), models(ALUMINIUM)
    walls = [flat(1e-3, x=-0.05, width=0.05, model=left), flat(2e-3, x=0.0, width=0.05)]
    pairs = list(itertools.combinations_with_replacement((1, 2, 3), 2))
    places = THREE[1] + [(side * (R + 1e-5), 0.01 * n - 0.03, 0.02) for n in range(len(pairs)) for side in (-1, 1)]
    velocity = [(0, 0, -3)] * 6 + [(1.5, 0, 0), (-1.5, 0, 0)] * len(pairs)
    line = pair_coeff(SPHERES, radius=R, speed=3.0, friction=0.4)
    granular = "comm_modify vel yes", "pair_style granular", *line.split("\n")
    rows, lmp = run(THREE[0] + [*itertools.chain(*pairs)], places, velocity, walls, right, *granular)
    assert rows["bead"].tolist() == [1, 2, 3, 4, 5, 6]
    v = state(lmp)["v"][6:, 0].reshape(-1, 2)
    asked = [cl.restitution_sphere_sphere(SPHERES[i - 1], SPHERES[j - 1], 3.0, R, R) for i, j in pairs]
    assert (v[:, 1] - v[:, 0]) / 3.0 == pytest.approx(asked, abs=2e-3)
    expected = [table[kind].restitution(3.0, R, h) for kind in (1, 2, 3) for table, h in ((left, 1e-3), (right, 2e-3))]
    assert rows["restitution"] == pytest.approx(expected, abs=5e-4)
    assert len({round(e, 2) for e in expected}) == 6


def test_fines_fly_through_the_deck_of_a_sieve():
    """They hit walls below as if it were not there, also while they overlap it."""
    wall = Plate((0.02 + R, -0.05, -2.1 * R), (0, 0.1, 0), (0, 0, 2.1 * R), thickness=2e-3)
    walls = [wall, flat(1e-3, height=-2.1 * R), flat(1e-3, model={2: None})]
    places = [above(-2 * R, 0.02 - 1e-5), above(1e-5, -0.01)]
    below, _ = run([2], places[:1], (2, 0, -3), walls[:2], models(STEEL))
    both, _ = run([2, 1], places, (2, 0, -3), walls, models(STEEL))
    assert both["plate"].tolist() == [0, 1, 2]
    for name in ALIKE:
        assert both[name][:2].tolist() == below[name].tolist(), name


def test_a_type_without_a_model_is_named():
    given = models(STEEL)
    del given[2]
    with pytest.raises(RuntimeError, match=r"model: there is none for beads of type 2"):
        run(*THREE, (0, 0, -3), [flat(1e-3)], given)


ON_STEEL = models(STEEL)


@pytest.mark.parametrize(
    ("given", "of_plate", "message"),
    [
        ({1: ON_STEEL[1], 2: None}, {2: ON_STEEL[2]}, "for atom type 2, and has None"),
        (ON_STEEL, ON_STEEL[2], "these beads for atom type 1, and has"),
    ],
)
def test_models_that_do_not_fit_are_refused(given, of_plate, message):
    with pytest.raises(ValueError, match=message):
        attach(make(above(), types=3), given, [flat(1e-3, model=of_plate)])


def in_contact(given):
    """A bead of type 1 in mid-contact with a plate."""
    lmp = make(above(1e-5), (0, 0, -3), density=given[1].pair.sphere.density, types=3)
    walls = attach(lmp, given, [flat(1e-3)])
    lmp.command("run 60")
    assert lmp.numpy.extract_atom("d2_contactlaw")[0, PLATE] != 0.0
    return lmp, walls


SMALLER = f"set group all diameter 4e-4 density {DENSITY}"
OTHER_RATE = cl.Pair(dataclasses.replace(metal.PAIR.sphere, rate=(0.0701, 1.0)), "glass")


@pytest.mark.parametrize(
    ("given", "commands", "words"),
    [
        (ON_STEEL, "set group all diameter 2.4e-3", "diameter: its radius is 0.0012 m, and 0.0009 m"),
        (ON_STEEL, SMALLER, "diameter: its radius is 0.0002 m, and 0.0009 m"),
        (ON_STEEL, "set group all mass 1e-6", "density: its mass is 1e-06 kg, and 2.68"),
        (ON_STEEL, "set group all type 2", "type: it is of type 2, and of 1, of another model"),
        ({1: ON_STEEL[1], 2: None}, "set group all type 2", "type: it is of type 2, and of 1"),
        ({1: metal.MODEL, 2: cl.ImpactModel(OTHER_RATE)}, "set group all type 2", "type: it is of type 2"),
    ],
)
def test_a_bead_that_is_changed_in_mid_contact(given, commands, words):
    """It is an error, and its impact is never recorded. Beads differ if their rates do."""
    lmp, walls = in_contact(given)
    with pytest.raises(RuntimeError, match=f"bead 1 at step.*{words}.*beads that touch no"):
        lmp.commands_string(f"{commands}\nrun 200")
    assert len(walls.collisions()) == 0
    if "type" not in commands and commands != SMALLER:  # as another bead it starts inside the plate
        with pytest.raises(RuntimeError, match="1.*(deep in the wall|density: its mass)"):
            lmp.command("run 200")
        assert len(walls.collisions()) == 0


@pytest.mark.parametrize("commands", [f"set group all diameter {2 * R!r} density {DENSITY}", "set group all type 3"])
def test_a_change_that_is_none_in_mid_contact(commands):
    """Setting the same numbers again, or another atom type of the same model, changes nothing.

    Between two contacts a bead may become another.
    """
    alumina, glass = cl.ImpactModel(cl.Pair(SPHERES[0], STEEL)), ON_STEEL[2]
    lmp, walls = in_contact({1: alumina, 2: glass, 3: alumina})
    lmp.commands_string(f"{commands}\nrun 1000")
    lmp.command(f"set group all type 2 diameter 1.2e-3 density {glass.pair.sphere.density}")
    lmp.commands_string("set group all z 7e-4 vz -2\nrun 2000")
    expected = alumina.restitution(3.0, R, 1e-3), glass.restitution(2.0, 0.6e-3, 1e-3)
    assert walls.collisions()["restitution"] == pytest.approx(expected, abs=5e-4)


def constants(units):
    """Angstrom, femtosecond and Boltzmann's constant, as LAMMPS has them in some units."""
    lmp = quiet(f"units {units}")
    return np.array([lmp.extract_global(name) for name in ("angstrom", "femtosecond", "boltz")])


def outcome(units):
    """Record and, in SI, paths and loads of two beads on walls that move."""
    length, time, energy = (constants("si") / constants(units)).tolist()
    low, high, cutoff, skin, diameter = (np.array([-0.05, 0.05, 0.004, 0.0005, 2 * R]) / length).tolist()
    lmp = quiet(f"""
        units {units}
        atom_style sphere
        boundary f f f
        region box block {3 * f"{low} {high} "}
        create_box 1 box
        comm_modify cutoff {cutoff}
        neighbor {skin} bin
        timestep {1e-7 / time!r}
        fix move all nve/sphere""")
    places = np.array([above(1e-5, -0.02, 0.003), above(1e-5 + 0.002, 0.02, 0.003)]) / length
    lmp.create_atoms(2, [1, 2], [1, 1], places.ravel(), np.array([2, 1, -5] * 2) * time / length)
    lmp.command(f"set group all diameter {diameter!r} density {DENSITY * length**5 / (energy * time**2)!r}")
    drum = Mesh.disc((0, 0, 0), (0, 0, 1), 0.05, 1e-3, motion=Rotation((0, 0, 1), 40.0))
    rising = flat(0.5e-3, x=0.01, width=0.03, height=0.002, motion=Translation((0, 0, 0.5)))
    walls = attach(lmp, cl.ImpactModel(PAIR, law="myc"), [drum, rising], friction=0.3)
    lmp.command("run 100")
    loads = np.column_stack(walls.loads()[1:])
    lmp.command("run 600")
    now = state(lmp)
    return walls.collisions(), now["x"] * length, now["v"] * length / time, now["omega"] / time, loads, [walls.time]


@pytest.mark.parametrize("units", ["cgs", "micro"])
def test_units_are_converted_at_the_border(units):
    """Meshes, models and the record are SI; the beads' path is that of SI, to rounding."""
    (rows, *path), (others, *other_path) = outcome("si"), outcome(units)
    assert len(rows) == 2 and abs(rows["wall_work"]).min() > 1e-7
    assert abs(path[3]).max(axis=0).min() > 0.0
    for name in ALIKE:
        assert others[name] == pytest.approx(rows[name], rel=1e-9, abs=1e-15), name
    for one, other in zip(path, other_path, strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-12)
    assert path[-1] == pytest.approx([7e-5], rel=1e-9)

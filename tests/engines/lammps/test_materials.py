"""Beads and plates of several materials in LAMMPS, and other units than SI."""

import dataclasses
import itertools
import math

import metal
import numpy as np
import pytest
from lammps_box import ALIKE, DENSITY, PAIR, PLATE, R, above, attach, flat, quiet, state

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate, Rotation, Translation, pair_coeff

SPHERES = ("gamma-alumina", "glass", "bearing-steel-52100")
STEEL, ALUMINIUM = "stainless-steel-304", "aluminium-6061-t6"


def constants(units):
    """Angstrom, femtosecond and Boltzmann's constant, as LAMMPS has them in some units."""
    lmp = quiet(f"units {units}")
    return np.array([lmp.extract_global(name) for name in ("angstrom", "femtosecond", "boltz")])


def units_of(system):
    """Units of length, time and mass in SI, by what LAMMPS itself computes with."""
    length, time, energy = (constants("si") / constants(system)).tolist()
    return length, time, energy * time**2 / length**2


def scene(units="si", types=3, beads=()):
    """Beads of (type, position, velocity, density), given in SI, in a box of other units."""
    length, time, mass = units_of(units)
    side, low, high = 0.06 / length, -0.02 / length, 0.08 / length
    lmp = quiet(
        f"""
        units {units}
        atom_style sphere 1  # fix adapt may change diameters
        boundary f f f
        region box block -{side} {side} -{side} {side} {low} {high} units box
        create_box {types} box
        comm_modify cutoff {0.004 / length}
        neighbor {0.0005 / length} bin
        timestep {1e-7 / time!r}
        fix move all nve/sphere
        """
    )
    for number, (kind, place, velocity, density) in enumerate(beads, start=1):
        x = (np.asarray(place) / length).tolist()
        v = (np.asarray(velocity) * time / length).tolist()
        lmp.create_atoms(1, [number], [kind], x, v)
        density = density * length**3 / mass
        lmp.command(f"set atom {number} diameter {2 * R / length!r} density {density!r}")
    return lmp


def models(plate):
    return {n: cl.ImpactModel(cl.Pair(name, plate)) for n, name in enumerate(SPHERES, start=1)}


def three():
    """A bead of each material over each of two plates."""
    return [
        (kind, above(1e-5, x, 0.01 * kind), (0, 0, -3), cl.material(name).density)
        for kind, name in enumerate(SPHERES, start=1)
        for x in (-0.02, 0.02)
    ]


def run(lmp, given, walls):
    attached = attach(lmp, given, walls)
    lmp.command("run 1500")
    return np.sort(attached.collisions(), order="bead")


def test_each_bead_and_plate_has_its_material():
    """Beads on each other, too: in the air a pair of each two types meets."""
    left, right = models(STEEL), models(ALUMINIUM)
    walls = [flat(1e-3, x=-0.05, width=0.05, model=left), flat(2e-3, x=0.0, width=0.05)]
    pairs, beads = list(itertools.combinations_with_replacement((1, 2, 3), 2)), three()
    for n, pair in enumerate(pairs):
        for side, kind in zip((-1, 1), pair, strict=True):
            density = cl.material(SPHERES[kind - 1]).density
            beads.append((kind, (side * (R + 1e-5), 0.01 * n - 0.03, 0.02), (-1.5 * side, 0, 0), density))
    lmp = scene(beads=beads)
    lmp.commands_string(
        f"comm_modify vel yes\npair_style granular\n{pair_coeff(SPHERES, radius=R, speed=3.0, friction=0.4)}"
    )
    rows = run(lmp, right, walls)
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
    floor = flat(1e-3, height=-2.1 * R)
    fine, coarse = above(-2 * R, 0.02 - 1e-5), above(1e-5, -0.01)
    beads = [(k, x, (2, 0, -3), cl.material(SPHERES[k - 1]).density) for k, x in ((2, fine), (1, coarse))]
    below = run(scene(beads=beads[:1]), models(STEEL), [wall, floor])
    both = run(scene(beads=beads), models(STEEL), [wall, floor, flat(1e-3, model={2: None})])
    assert both["plate"].tolist() == [0, 1, 2]
    for name in ALIKE:
        assert both[name][:2].tolist() == below[name].tolist(), name


def test_a_type_that_flies_through_all_walls():
    """It may be of any speed and mass; a bead that is made one in mid-contact is named."""
    beads = [(1, above(1e-5), (0, 0, -3), DENSITY), (2, above(0.07, 0.02), (0, 0, -1e4), 5.0)]
    lmp = scene(types=2, beads=beads)
    attach(lmp, {1: models(STEEL)[1], 2: None}, [flat(1e-3)])
    lmp.command("run 60")
    with pytest.raises(RuntimeError, match="bead 1 at step 60: type: it is of type 2, and of 1"):
        lmp.commands_string("set group all type 2\nrun 1")


def test_a_type_without_a_model_is_named():
    lmp = scene(beads=three())
    some = {kind: model for kind, model in models(STEEL).items() if kind != 2}
    attach(lmp, some, [flat(1e-3)])
    with pytest.raises(RuntimeError, match=r"model: there is none for beads of type 2"):
        lmp.command("run 1500")


@pytest.mark.parametrize(
    ("model", "plate", "message"),
    [
        (lambda: {4: models(STEEL)[1]}, None, r"types of beads are 1 to 3, got \[4\]"),
        (lambda: {}, None, "model: has none for any atom type"),
        (lambda: {1: None}, None, "model: has none for any atom type"),
        (lambda: {"1": models(STEEL)[1]}, None, "got '1'; atom types are integers from 1 on"),
        (lambda: {1: "steel"}, None, "expected a contactlaw.ImpactModel or None for atom type 1"),
        (lambda: models(STEEL), lambda: {4: None}, r"types of beads are 1 to 3, got \[1, 2, 3, 4\]"),
        (lambda: {1: models(STEEL)[1], 2: None}, lambda: {2: models(STEEL)[2]}, "for atom type 2, and has None"),
        (lambda: models(STEEL), lambda: {1: models(STEEL)[2]}, "these beads for atom type 1, and has"),
        (lambda: models(STEEL), lambda: models(STEEL)[2], "these beads for atom type 1, and has"),
    ],
)
def test_models_that_do_not_fit_are_refused(model, plate, message):
    lmp = scene()
    with pytest.raises((ValueError, TypeError), match=message):
        attach(lmp, model(), [flat(1e-3, model=plate and plate())])


GROWING = "variable d equal 1.8e-3+1e-6*elapsed\nfix grow all adapt 1 atom diameter v_d"
SMALLER = f"set group all diameter 4e-4 density {DENSITY}"


def in_contact(given):
    """A bead in mid-contact with a plate."""
    lmp = scene(beads=[(1, above(1e-5), (0, 0, -3), DENSITY)])
    walls = attach(lmp, given, [flat(1e-3)])
    lmp.command("run 60")
    assert lmp.numpy.extract_atom("d2_contactlaw")[0, PLATE] != 0.0
    return lmp, walls


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ("set group all diameter 2.4e-3", "diameter: its radius is 0.0012 m, and 0.0009 m"),
        (f"set group all diameter 2.4e-3 density {DENSITY}", "diameter: its radius is 0.0012 m"),
        (SMALLER, "diameter: its radius is 0.0002 m, and 0.0009 m"),
        (GROWING, "diameter: its radius is 0.00090"),
        ("set group all mass 1e-6", "density: its mass is 1e-06 kg, and 2.68"),
        ("set group all density 900", "density: its mass is 2.748"),
        ("set group all type 2", "type: it is of type 2, and of 1, of another model"),
    ],
)
def test_a_bead_that_is_changed_in_mid_contact(commands, words):
    """A bead that changes in mid-contact is an error, and its impact is never recorded."""
    lmp, walls = in_contact(models(STEEL))
    with pytest.raises(RuntimeError, match=f"bead 1 at step.*{words}.*beads that touch no"):
        lmp.commands_string(f"{commands}\nrun 200")
    assert len(walls.collisions()) == 0
    if commands != SMALLER:  # as another bead it starts inside the plate
        with pytest.raises(RuntimeError, match="1.*(deep in the wall|density: its mass)"):
            lmp.command("run 200")
        assert len(walls.collisions()) == 0


@pytest.mark.parametrize("commands", [f"set group all diameter {2 * R!r} density {DENSITY}", "set group all type 3"])
def test_a_change_that_is_none_in_mid_contact(commands):
    """Setting the same numbers again, or another atom type of the same model, changes nothing."""
    alumina = cl.ImpactModel(cl.Pair(SPHERES[0], STEEL))
    lmp, walls = in_contact({1: alumina, 2: models(STEEL)[2], 3: alumina})
    lmp.commands_string(f"{commands}\nrun 1000")
    (row,) = walls.collisions()
    assert row["restitution"] == pytest.approx(alumina.restitution(3.0, R, 1e-3), abs=5e-4)


def test_beads_may_change_between_contacts():
    lmp, walls = in_contact(models(STEEL))
    lmp.command("run 1000")
    glass = cl.material("glass")
    lmp.commands_string(
        f"set group all type 2 diameter 1.2e-3 density {glass.density}\nset group all z 7e-4 vz -2\nrun 2000"
    )
    _, row = walls.collisions()
    expected = models(STEEL)[2].restitution(2.0, 0.6e-3, 1e-3)
    assert row["restitution"] == pytest.approx(expected, abs=5e-4)


@pytest.mark.parametrize("units", ["cgs", "micro"])
def test_units_are_converted_at_the_border(units, model):
    """Meshes, models and the record are SI; the beads' path is that of SI, to rounding."""
    drum = Mesh.disc((0, 0, 0), (0, 0, 1), 0.05, 1e-3, motion=Rotation((0, 0, 1), 40.0))
    rising = flat(0.5e-3, x=0.01, width=0.03, height=0.002, motion=Translation((0, 0, 0.5)))
    beads = [
        (1, above(1e-5, -0.02, 0.003), (2, 1, -5), DENSITY),
        (1, above(1e-5 + 0.002, 0.02, 0.003), (2, 1, -5), DENSITY),
    ]
    outcomes = {}
    for system in ("si", units):
        length, time, _ = units_of(system)
        lmp = scene(system, 1, beads)
        walls = attach(lmp, cl.ImpactModel(PAIR, law="myc"), [drum, rising], friction=0.3)
        lmp.command("run 100")
        loads = walls.loads()
        lmp.command("run 600")
        order = np.argsort(lmp.numpy.extract_atom("id")[:2])
        atoms = {name: lmp.numpy.extract_atom(name)[:2][order] for name in ("x", "v", "omega")}
        outcomes[system] = (
            walls.collisions(),
            atoms["x"] * length,
            atoms["v"] * length / time,
            atoms["omega"] / time,
            walls.time,
            np.column_stack(loads[1:]),
        )
    rows, others = outcomes["si"][0], outcomes[units][0]
    assert len(rows) == 2 and abs(rows["wall_work"]).min() > 1e-7
    assert abs(outcomes["si"][5]).max(axis=0).min() > 0.0
    for name in ALIKE:
        assert others[name] == pytest.approx(rows[name], rel=1e-9, abs=1e-15), name
    for one, other in zip(outcomes["si"][1:], outcomes[units][1:], strict=True):
        assert np.asarray(other) == pytest.approx(np.asarray(one), rel=1e-9, abs=1e-12)
    assert math.isclose(outcomes[units][4], 7e-5, rel_tol=1e-9)


def test_a_type_of_beads_is_another_with_another_rate():
    """A bead that changes its type in contact was taken for the same."""
    other = cl.Pair(dataclasses.replace(metal.PAIR.sphere, rate=(0.0701, 1.0)), "glass")
    contacts = attach(scene(types=2), {1: metal.MODEL, 2: cl.ImpactModel(other)}, [flat(1e-3)])
    rows = contacts._contacts.scene.plate_rows
    assert rows["alike"][0, 0] != rows["alike"][1, 0]

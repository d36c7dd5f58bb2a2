"""Beads that drop on a plate in LAMMPS: the record is what the solver says, and energies add up."""

import math

import metal
import numpy as np
import polymer
import pytest
from lammps_box import PAIR, R, above, dropped, flat, lost, scene

import contactlaw as cl
from contactlaw.engines.lammps import Translation

HERTZ, MYC, FEM = (cl.ImpactModel(PAIR, law=law) for law in ("hertz", "myc", "fem"))
# Thickness [m] and speed [m/s]: lambda up to 0.8, elastic, below and above yield.
USUAL = [(1e-3, 5.0), (1e-3, 15.0), (0.5e-3, 3.0), (0.5e-3, 20.0), (0.25e-3, 3.0)]
# Model, radius, thickness, speed, and how far the COR may be off at 50 steps a contact.
DROPS = [(HERTZ, R, math.inf, 3.0, 1.2e-5), (MYC, R, math.inf, 20.0, 1.2e-5)]
DROPS += [(MYC, R, *drop, 1.2e-5) for drop in USUAL]
# Law fem corrects for the plate from the second step on.
DROPS += [(FEM, R, *drop, 3e-5) for drop in ((3e-3, 20.0), (1e-3, 5.0), (1e-3, 20.0))]
YIELDING = [  # neither, the plate, both
    ("soda-lime-glass", "alumina", 1e-3, 3.0),
    ("alumina", "aluminium-6061-t6", 5e-3, 2.0),
    ("bearing-steel-52100", "aluminium-6061-t6", 1.5e-3, 1.0),
    ("carbon-steel-1020", "carbon-steel-1020", 3e-3, 0.5),
]
DROPS += [(cl.ImpactModel(cl.Pair(sphere, plate)), 1e-3, *drop, 1e-4) for sphere, plate, *drop in YIELDING]
DROPS += [(one, r, h, v, 2e-3) for one in polymer.MODELS for v, r, h in polymer.DROPS]
DROPS += [(metal.MODEL, *drop, 6e-4) for drop in metal.DROPS]


@pytest.mark.parametrize(("steps", "rising"), [(21, 0.0), (50, 0.0), (50, 1.5)])
@pytest.mark.parametrize(("model", "radius", "thickness", "speed", "bound"), DROPS)
def test_drops_are_the_solvers(model, radius, thickness, speed, bound, steps, rising):
    """The beads first touch, at any phase of a step, plates that stand still or rise.

    The error is of fourth order, since start and end of the force within a step are resolved.
    Energies add up to rounding.
    """
    phases = np.linspace(0.0, 1.0, 13)
    hit, elastic = model.solve(speed, radius, thickness), cl.ImpactModel(model.pair, law="hertz")
    dt = float(min(hit.contact_time, elastic.solve(speed, radius, math.inf).contact_time)) / steps
    places = [above(speed * dt * (2 + phase), 0.009 * n - 0.055, radius=radius) for n, phase in enumerate(phases)]
    plate = flat(thickness, width=0.118, x=-0.059, motion=Translation((0.0, 0.0, rising)) if rising else None)
    bead = {"radius": radius, "density": model.pair.sphere.density, "dt": dt, "steps": 4 * steps}
    rows, now = dropped(model, [plate], places, (0, 0, rising - speed), **bead)
    assert len(rows) == len(phases) and (rows["kind"] == 0).all()
    assert rows["approach_speed"] == pytest.approx(speed, rel=1e-9)
    assert rows["restitution"] * speed + rising == pytest.approx(now["v"][:, 2], rel=1e-9)
    energy = 2 / 3 * math.pi * bead["density"] * radius**3 * speed**2
    assert lost(rows) / energy == pytest.approx(1 - rows["restitution"] ** 2, abs=1e-9)
    if steps == 21:
        assert rows["restitution"] == pytest.approx(hit.restitution, abs=12.5 * bound)
        return
    assert rows["restitution"] == pytest.approx(hit.restitution, abs=bound)
    peak, shares = (3e-3, 3e-3) if model in polymer.MODELS else (1e-3, 2e-3)
    assert rows["contact_time"] == pytest.approx(hit.contact_time, rel=3e-3)
    assert rows["peak_force"] == pytest.approx(hit.peak_force, rel=peak)
    for channel in ("plastic", "wave", "other"):
        share = rows[f"{channel}_energy"] / energy
        assert share == pytest.approx(getattr(hit, f"{channel}_fraction"), abs=shares), channel
    assert (rows["flags"] == hit.flags).all()


CHANGES = ["timestep {less}", "timestep {more}", "fix adapt all dt/reset 1 {less} {more} {way} units box"]


@pytest.mark.parametrize("command", CHANGES)
@pytest.mark.parametrize(
    ("model", "thickness", "speed"), [(HERTZ, math.inf, 3.0), (MYC, 1e-3, 5.0), (MYC, 0.5e-3, 3.0)]
)
def test_the_step_may_change_in_mid_contact(model, thickness, speed, command):
    """The step may change each time, as by fix dt/reset; 50 steps per contact promise 1e-4."""
    hit = model.solve(speed, R, thickness)
    dt = float(hit.contact_time) / 50
    for after in range(1, 50, 6):
        lmp, walls = scene(model, [flat(thickness)], above(2.4 * dt * speed), (0, 0, -speed), dt=dt)
        lmp.command(f"run {2 + after}")
        lmp.command(command.format(less=0.5 * dt, more=1.4 * dt, way=0.5 * speed * dt))
        lmp.command("run 200")
        bound = 1e-8 if model is HERTZ else 1e-4
        assert walls.collisions()["restitution"] == pytest.approx(hit.restitution, abs=bound), after

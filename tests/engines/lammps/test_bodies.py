"""Beads of rigid bodies in LAMMPS beside an integration of a dumbbell that shares no code."""

import lammps_box
import numpy as np
import pytest
from dumbbell import UP, Dumbbell, impact
from lammps_box import PAIR, R, flat, quiet

import contactlaw as cl
from contactlaw.engines.lammps import attach
from contactlaw.engines.record import Kind

H, N, SLIDE, DT = 0.5e-3, 30, 0.3, 5e-8
BODY = Dumbbell.of(PAIR.sphere.density, R)
BOX = "boundary p p f\nregion box block -0.05 0.05 -0.05 0.05 -0.01 0.05"


def thrown(axes, friction=0.0, softening=1.0, density=PAIR.sphere.density, before="", pieces=1):
    """Dumbbells whose lower spheres fall onto a plate; the first one lies across the border of the box."""
    lmp = quiet(f"units si\natom_style sphere\natom_modify map array\n{BOX}\ncreate_box 1 box")
    for n, axis in enumerate(axes):
        x, y, z = -0.05 + 0.016 * (n % 6), 0.016 * (n // 6) - 0.045, R + 1e-6
        upper = np.array([x, y, z]) - 2 * R * axis
        across = int(upper[0] < -0.05)
        upper[0] += 0.1 * across
        lmp.commands_string(f"""
            create_atoms 1 single {x} {y} {z}
            create_atoms 1 single {" ".join(map(str, upper))}
            set atom {2 * n + 2} image {-across} 0 0""")
    lmp.commands_string(f"""
        comm_modify cutoff 0.01
        fix number all property/atom mol
        set group all diameter {2 * R} density {density}
        variable body atom ceil(id/2)
        set group all mol v_body
        velocity all set {SLIDE} 0 -1
        fix body all rigid/small molecule
        thermo_style custom step
        timestep {DT * softening**0.4}
        {before}""")
    model = cl.ImpactModel(PAIR, law="myc")
    walls = attach(lmp, model, [flat(H)], friction=friction, softening=softening)
    for _ in range(pieces):
        lmp.command(f"run {1200 // pieces}")
    return lmp, walls, np.sort(walls.record().rows, order="bead")


def orientations(steepest=0.97):
    """Axes to the lower sphere; of a flatter dumbbell the other sphere would touch soon after."""
    height = np.linspace(0.15, steepest, N)
    angle = np.random.default_rng(5).uniform(0, 2 * np.pi, N)
    side = np.sqrt(1 - height**2)
    return np.stack([side * np.cos(angle), side * np.sin(angle), -height], axis=1)


def energies(lmp, count):
    """Kinetic energy of each dumbbell now."""
    order = np.argsort(lmp.numpy.extract_atom("id")[: 2 * count])
    v, spin, x = (np.array(lmp.numpy.extract_atom(name)[: 2 * count])[order] for name in ("v", "omega", "x"))
    axes = x[::2] - x[1::2]
    axes[:, :2] -= 0.1 * np.round(axes[:, :2] / 0.1)
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    middle = 0.5 * (v[::2] + v[1::2])
    return np.array([BODY.energy(a, m, w) for a, m, w in zip(axes, middle, spin[::2], strict=True)])


@pytest.mark.parametrize(("friction", "softening"), [(0.0, 1), (0.1, 1), (0.5, 1), (3.0, 1), (0.0, 50), (0.5, 50)])
def test_a_dumbbell_rebounds_as_a_rigid_body_on_springs(friction, softening):
    axes = orientations()
    lmp, _, rows = thrown(axes, friction, softening)
    first = rows[np.unique(rows["bead"], return_index=True)[1]]
    assert first["bead"].tolist() == list(range(1, 2 * N, 2)) and (first["kind"] == Kind.OF_BODY).all()
    masses = [1 / BODY.response(axis) for axis in axes]  # at first touch; the record has it at the end
    assert first["mass"] == pytest.approx(masses, rel=2e-3 * softening**0.4)
    for row, axis in zip(first, axes, strict=True):
        v, time = impact(BODY, PAIR, H, axis, (SLIDE, 0.0, -1.0), friction)
        assert row["restitution"] == pytest.approx(v[2], abs=1.5e-3 if softening == 1 else 4e-3)
        assert row["contact_time"] == pytest.approx(time, rel=5e-3)
        if friction:
            assert row["sliding_speed_after"] == pytest.approx(v[0], abs=0.02 * friction)
    lost = sum(first[name] for name in first.dtype.names if name.endswith("_energy"))
    came = 0.5 * BODY.mass * (1 + SLIDE**2)
    assert (energies(lmp, N) + lost) / came == pytest.approx(1.0, abs=1e-5 if softening == 1 else 1e-4)

"""The finite elements against closed forms and invariants."""

import math

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import elements, mesh, solver

STEEL = cl.Material("steel", 200e9, 0.3, 8000.0, yield_strength=400e6)


def block(columns, rows, width, height, inner=0.0, skew=0.0):
    """A rectangle of elements; its inner nodes may be pushed about by `skew` of an element."""
    r = inner + np.linspace(0.0, width, columns + 1)
    z = np.linspace(0.0, height, rows + 1)
    index = np.arange(r.size * z.size).reshape(z.size, r.size)
    nodes = np.stack(np.meshgrid(r, z), axis=-1)
    push = np.random.default_rng(0).uniform(-skew, skew, nodes.shape)
    nodes[1:-1, 1:-1] += (push * [width / columns, height / rows])[1:-1, 1:-1]
    quads = mesh._cells(index)
    return mesh.Mesh(nodes.reshape(-1, 2), quads, index[:0, 0])


def alone(one, material=STEEL, yields=False):
    """A system of one body, and the step that is stable."""
    nothing = mesh.Mesh(np.empty((0, 2)), np.empty((0, 4), dtype=np.int64), np.empty(0, np.int64))
    below = one._replace(surface=np.array([0, 1]))
    system = solver.assemble((nothing, below), (material, material), yields=False)
    body = solver.body(one, material, 0, 1.0, yields)
    system = system._replace(plate=body)
    return system, 0.85 * elements.stable_step(body, system.x, material.density)


@pytest.mark.parametrize(("skew", "inner"), [(0.0, 0.0), (0.25, 0.0), (0.25, 1000.0)])
def test_patch_a_linear_field_gives_one_stress_and_no_hourglass(skew, inner):
    one = block(5, 5, 1.0, 1.0, inner=inner, skew=skew)
    system, dt = alone(one)
    stretch = np.array([1e-6, -2e-6])  # rr and tt; zz
    system.v[:] = system.x * stretch / dt
    elements.add_forces(system.plate, system.x, system.v, dt, system.force)
    lame, shear = system.plate.bulk, system.plate.shear
    trace = 2 * stretch[0] + stretch[1]
    expected = [lame * trace + 2 * shear * e for e in (stretch[0], stretch[1], stretch[0], 0.0)]
    assert system.plate.stress == pytest.approx(np.tile(expected, (25, 1)), rel=1e-6, abs=1e-3)
    edge = np.isin(system.x - [inner, 0.0], [0.0, 1.0]).any(axis=1)
    largest = np.abs(system.force[edge]).max()
    assert np.abs(system.plate.hourglass).max() < 1e-8 * largest
    rest = np.abs(system.force[~edge]).max() / largest
    # one integration point has the forces of the volume "area times mean radius", which is exact
    # for rectangles and for a plane; skewed elements near the axis miss by their width over r
    assert rest < (1e-12 if skew == 0.0 else 1e-4 if inner else 0.02)


def test_jaumann_rate_turns_the_stress_with_the_body():
    """A quarter turn swaps rr and zz."""
    one = block(1, 1, 1.0, 1.0, inner=1.0)
    system, _ = alone(one)
    body = system.plate._replace(bulk=0.0, shear=0.0, bending=np.zeros(len(system.plate.bending)))
    body.stress[:] = [100.0, -50.0, 0.0, 0.0]
    steps = 2000
    angle = 0.5 * math.pi / steps
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    centre = system.x.mean(axis=0)
    for _ in range(steps):
        offset = system.x - centre
        system.v[:] = angle * np.column_stack([-offset[:, 1], offset[:, 0]])
        system.x[:] = centre + offset @ turn
        elements.add_forces(body, system.x, system.v, 1.0, system.force)
    assert body.stress[0] == pytest.approx([-50.0, 100.0, 0.0, 0.0], abs=0.5)


def test_yielding_tube_carries_the_closed_form_pressure():
    """Thick tube, plane strain, perfectly plastic: p = (2/sqrt 3) Y ln(b/a) (Hill 1950, ch. V)."""
    inner, outer, columns = 1.0, 2.0, 24
    one = block(columns, 1, outer - inner, 0.04, inner=inner)
    system, dt = alone(one, yields=True)
    system.inverse_mass[:, 1] = 0.0
    bore = np.flatnonzero(system.x[:, 0] == inner)
    system.inverse_mass[bore, 0] = 0.0
    load = np.zeros_like(system.x)
    steps, widened = 6000, 0.01
    for n in range(60):
        system.v[bore, 0] = widened / (steps * dt) * 2 * math.sin(math.pi * (n + 0.5) / 60) ** 2
        solver.advance(system, load, dt, steps // 60)
    a, b = inner + widened, outer + widened * inner / outer
    expected = 2 / math.sqrt(3) * STEEL.yield_strength * math.log(b / a)
    pressure = -system.force[bore, 0].sum() / (a * 0.04)
    assert system.plate.plastic_strain.min() > 0.0
    assert abs(pressure) == pytest.approx(expected, rel=0.01)

"""Walls of a measured or computed mobility, beside modes and a convolution that no fit has touched."""

import functools
import math
import re

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.physical.mobility import _beams, _clamped
from validation.derivations.walls import convolved

MODEL = cl.ImpactModel(cl.Pair("glass", "steel-s235"), law="hertz")
STEEL = MODEL.pair.plate
SPEED, RADIUS, H = 1.0, 3e-3, 1e-3
LONGEST = 2.4e-5  # [s]; contacts of this bead take 2e-5
BENDING, AREAL = STEEL.plane_modulus * H**3 / 12.0, STEEL.density * H
ENDLESS = 1.0 / (8.0 * math.sqrt(BENDING * AREAL))
UNIT = (math.pi * MODEL.pair.sphere.density / MODEL.pair.effective_modulus) ** 0.4 * RADIUS / SPEED**0.2  # T_H


def modes(size, place, highest):
    """Angular frequencies of a supported plate, and what each adds to the mobility."""
    path = math.sqrt(BENDING / AREAL)
    counts = (np.arange(1, int(math.sqrt(highest / path) * side / math.pi) + 2) for side in size)
    m, n = (one.ravel() for one in np.meshgrid(*counts))
    omega = path * math.pi**2 * ((m / size[0]) ** 2 + (n / size[1]) ** 2)
    shape = np.sin(m * math.pi * place[0] / size[0]) * np.sin(n * math.pi * place[1] / size[1])
    return omega, 4.0 / (AREAL * size[0] * size[1]) * shape**2


def by_modes(size, place, damping=0.0, steps=1000):
    """COR by a convolution with the sum of all modes up to 2000/T_H, the last ones faded out."""
    step, highest = 3.2181 / steps, 2000.0 / UNIT
    omega, strength = modes(size, place, highest)
    strength = strength * np.exp(-((omega / (0.45 * highest)) ** 2)) / omega
    t = np.arange(3 * steps) * step * UNIT
    back = np.array([(strength * np.exp(-0.5 * damping * omega * one) * np.sin(omega * one)).sum() for one in t])
    back[0] = ENDLESS
    return convolved(float(MODEL.solve(SPEED, RADIUS, H).inelasticity), back / ENDLESS, step)


@pytest.mark.parametrize(
    ("size", "place"), [((0.05, 0.05), (0.025, 0.025)), ((0.03, 0.04), (0.015, 0.01)), ((0.02, 0.02), (0.008, 0.01))]
)
def test_a_small_plate_answers_as_its_modes_do(size, place):
    sheet = cl.Mobility.of_plate(STEEL, H, size, place, LONGEST)
    hit = MODEL.solve(SPEED, RADIUS, sheet)
    assert sheet.error < 0.06 and sheet.thickness == pytest.approx(H, rel=1e-12)
    assert hit.restitution == pytest.approx(by_modes(size, place), abs=0.002)
    assert hit.restitution**2 + hit.wave_fraction == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("edge", "distance"),
    [*(("supported", far) for far in (4e-3, 5e-3, 1e-2)), *(("clamped", far) for far in (5e-3, 7e-3, 1e-2))],
)
def test_a_large_plate_answers_as_its_nearest_edge(edge, distance):
    """The response near an edge is derived from waves along it, that of a plate from modes."""
    sheet = cl.Mobility.of_plate(STEEL, H, (0.15, 0.1), (distance, 0.05), LONGEST, edge)
    near = MODEL.solve(SPEED, RADIUS, H, edge=edge, edge_distance=distance)
    assert MODEL.solve(SPEED, RADIUS, sheet).restitution == pytest.approx(near.restitution, abs=0.002)


def test_a_clamped_plate_has_the_frequencies_of_the_literature():
    """Leissa, Vibration of Plates (NASA SP-160, 1969), over sqrt(D/m)/a^2 of squares."""
    side = 2.0
    omega, strength = _clamped(_beams(side, 0.74, 5.0), _beams(side, 0.82, 5.0))
    assert omega[[0, 1, 3, 4, 5]] * side**2 == pytest.approx([35.992, 73.413, 108.27, 131.64, 132.24], rel=6e-4)
    # those that are odd, or that change sign with the axes, do not move the middle
    omega, strength = _clamped(_beams(side, 1.0, 5.0), _beams(side, 1.0, 5.0))
    assert omega[strength > 1e-9][:2] * side**2 == pytest.approx([35.992, 132.24], rel=6e-4)


@functools.cache
def measured(damping=0.05):
    """Mobility over frequency of a plate whose modes are damped, as a hammer would find it."""
    f = np.arange(0.0, 16.0 / LONGEST, 50.0)
    omega, strength = modes((0.05, 0.05), (0.02, 0.025), 12.0 * math.pi * f[-1])
    each = ((1j * w * strength / (omega**2 - w * w + 1j * damping * w * omega)).sum() for w in 2.0 * math.pi * f)
    return f, np.fromiter(each, complex)


def test_a_measured_mobility_answers_as_the_wall_it_was_measured_on():
    wall = cl.Mobility(STEEL, *measured(), longest=LONGEST)
    assert wall.endless == pytest.approx(ENDLESS, rel=0.02)
    known = cl.Mobility(STEEL, *measured(), longest=LONGEST, endless=ENDLESS)
    exact = by_modes((0.05, 0.05), (0.02, 0.025), damping=0.05)
    assert MODEL.solve(SPEED, RADIUS, known).restitution == pytest.approx(exact, abs=0.003)
    slid = cl.ImpactModel(MODEL.pair).oblique(SPEED, 0.5, RADIUS, known, 0.2)
    assert slid.restitution == pytest.approx(cl.ImpactModel(MODEL.pair).lookup(SPEED, RADIUS, known).restitution)


def test_an_endless_plate_is_found_again():
    f = np.linspace(0.0, 20.0 / LONGEST, 400)
    flat = cl.Mobility(STEEL, f, np.full(f.size, ENDLESS), LONGEST)
    assert flat.error < 1e-3
    assert MODEL.solve(SPEED, RADIUS, flat).restitution == pytest.approx(
        MODEL.solve(SPEED, RADIUS, H).restitution, abs=2e-3
    )


def test_what_is_no_mobility_of_the_contact_is_refused_in_words():
    f, value = measured()
    for call, said in (
        (lambda: cl.Mobility(STEEL, f, -value, LONGEST), "value: -.* no negative real part"),
        (lambda: cl.Mobility(STEEL, f[:4000], value[:4000], LONGEST), "frequency: does not cover contacts of"),
        (lambda: cl.Mobility(STEEL, f[::400], value[::400], LONGEST), "in steps of at most that"),
        (lambda: cl.Mobility(STEEL, f, value[1:], LONGEST), "a value for each"),
        (lambda: cl.Mobility.of_plate(STEEL, H, (0.02, 0.02), (0.03, 0.01), LONGEST), "place: .*within the plate"),
        (lambda: cl.Mobility.of_plate(STEEL, H, (0.1, 0.1), (0.05, 0.05), LONGEST, "free"), "edges: .*supported or cl"),
        (lambda: cl.Mobility.of_plate(STEEL, H, (0.1, 0.1), (0.05, 0.05), 5e-4), "longest: .*shorter contacts"),
        (lambda: cl.Mobility(STEEL, f[::4], value[::4], LONGEST), "value: .*finer than the resonances"),
        (lambda: MODEL.solve(3e-3, RADIUS, cl.Mobility(STEEL, f, value, LONGEST)), "over the longest"),
        (
            lambda: cl.ImpactModel(cl.Pair("glass", "glass")).solve(1.0, RADIUS, cl.Mobility(STEEL, f, value, LONGEST)),
            re.escape("beads touch 'steel-s235'"),
        ),
    ):
        with pytest.raises(ValueError, match=said):
            call()

"""Plates that are no bare sheet: layers, wood, foundations, shells, beside programs of other methods."""

import copy
import math
import pickle
import re

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pymunk
import pytest
from scipy.integrate import quad
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve
from scipy.special import ellipk

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from contactlaw.equation import outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.force import HERTZ
from contactlaw.physical.responses import REACH, response_of
from contactlaw.physical.scaling import plate_mobility
from contactlaw.stepping.plate_rows import plate_rows
from contactlaw.walls import Mesh, Plate
from validation.derivations.walls import kernel, restitution

STEEL, ALUMINIUM = cl.material("stainless-steel-304"), cl.material("aluminium-6061-t6")
PAIR = cl.Pair("gamma-alumina", "glass")
MODEL = cl.ImpactModel(PAIR)
IMPACT = 5.0, 0.9e-3  # speed [m/s], radius [m]
H = 0.5e-3


def refused(call, *said):
    with pytest.raises(ValueError, match=".*".join(map(re.escape, said))):
        call()


def mobility(bending, areal):
    """Speed over force of a thin plate."""
    return 1.0 / (8.0 * math.sqrt(bending * areal))


def test_one_layer_is_a_thickness_to_the_last_bit():
    for size in (0.3e-3, H, 1.1e-3):
        alone = cl.Layers([("glass", size)])
        assert alone == size
        for answer in (MODEL.solve, MODEL.lookup):
            assert answer(*IMPACT, alone) == answer(*IMPACT, size)
    parted = cl.Layers([("glass", 0.2e-3), ("glass", 0.3e-3)])
    assert float(parted) == pytest.approx(H, rel=1e-14)


def test_layers_bend_as_beams_of_many_slices():
    """The stiffness is least about the neutral plane; here it is searched for on 2000 slices."""
    layers = [(STEEL, 1e-3), (ALUMINIUM, 3e-3), (STEEL, 0.5e-3)]
    depth = (np.arange(2000) + 0.5) * (4.5e-3 / 2000)
    modulus = np.where((depth < 1e-3) | (depth > 4e-3), STEEL.plane_modulus, ALUMINIUM.plane_modulus)
    neutral = (modulus * depth).sum() / modulus.sum()
    bending = (modulus * (depth - neutral) ** 2).sum() * 4.5e-3 / 2000
    areal = 1.5e-3 * STEEL.density + 3e-3 * ALUMINIUM.density
    made = cl.Layers(layers)
    assert made.bending == pytest.approx(bending, rel=1e-3) and made.areal == pytest.approx(areal)
    assert plate_mobility(STEEL, np.array(float(made))) == pytest.approx(mobility(made.bending, areal), rel=1e-12)
    assert made.alike == pytest.approx(ALUMINIUM.plane_modulus / STEEL.plane_modulus)


@pytest.mark.parametrize(("x", "y", "k"), [(10.0, 10.0, 10.0), (90.0, 1.0, 3.0), (40.0, 7.0, -10.0), (1e4, 1.0, 5.0)])
def test_orthotropic_plates_have_the_mean_over_all_directions(x, y, k):
    made = cl.Orthotropic(STEEL, x, y, k, mass=8.0)

    def share(phi):
        c, s = math.cos(phi) ** 2, math.sin(phi) ** 2
        return (x * c * c + 2.0 * k * c * s + y * s * s) ** -0.5

    mean = 2.0 / math.pi * quad(share, 0.0, 0.5 * math.pi, epsabs=0.0, epsrel=1e-11, limit=500)[0]
    # the same in closed form: an elliptic integral, with the sine of half an angle between waves
    closed = 2.0 / math.pi * (x * y) ** -0.25 * ellipk(0.5 * (1.0 - k / math.sqrt(x * y)))
    assert mean == pytest.approx(closed, rel=1e-9)
    assert plate_mobility(STEEL, np.array(float(made))) == pytest.approx(mean / (8.0 * math.sqrt(8.0)), rel=1e-9)


def struck(stiffness, areal, speed, steps=500, count=150, size=24.0):
    """COR of a sphere and a spring of Hertz on a supported plate, by the modes of it step by step.

    The plate is so large that little comes back. The force is a line within each step.
    """
    x, y, k = stiffness
    star, density = PAIR.effective_modulus, PAIR.sphere.density
    mass, spring = 4.0 / 3.0 * math.pi * density * IMPACT[1] ** 3, 4.0 / 3.0 * star * math.sqrt(IMPACT[1])
    time = (math.pi * density / star) ** 0.4 * IMPACT[1] / speed**0.2
    a, b = (size * (one / areal * time**2) ** 0.25 for one in (x, y))
    p, q = ((math.pi * (2.0 * np.arange(count) + 1.0) / side) ** 2 for side in (a, b))
    p, q = (one.ravel() for one in np.meshgrid(p, q))  # of the modes that move the middle
    w, step = np.sqrt((x * p * p + 2.0 * k * p * q + y * q * q) / areal), 3.22 * time / steps
    c, s, share = np.cos(w * step), np.sin(w * step), 4.0 / (areal * a * b)
    ends = share * (step - s / w) / (w * w * step), share * (1.0 - c) / (w * w * step)
    starts = share * (1.0 - c) / (w * w) - ends[0], share * s / w - ends[1]
    z, turn, place, u, f = np.zeros_like(w), np.zeros_like(w), 0.0, speed, 0.0
    for n in range(4 * steps):
        z, turn = c * z + s / w * turn + starts[0] * f, c * turn - w * s * z + starts[1] * f
        place += u * step - f / mass * step**2 / 3.0
        before, known = f, place - z.sum()
        for _ in range(50):
            f = spring * max(known - (step**2 / (6.0 * mass) + ends[0].sum()) * f, 0.0) ** 1.5
        z, turn, place = z + ends[0] * f, turn + ends[1] * f, place - f / mass * step**2 / 6.0
        u -= 0.5 * (before + f) / mass * step
        if f == 0.0 and n > 10:
            return -u / speed
    raise RuntimeError("the sphere stays")


@pytest.mark.parametrize(
    ("ratio", "twist", "thickness"), [(1.0, 1.0, 0.9), (12.0, 3.0, 0.5), (40.0, -0.5, 0.36), (100.0, 0.3, 0.24)]
)
def test_orthotropic_plates_answer_as_the_sum_of_their_modes(ratio, twist, thickness):
    """Modes know of no mean over directions; stiffnesses are about those of glass, in mm."""
    glass = PAIR.plate
    d, areal = glass.plane_modulus * (1e-3 * thickness) ** 3 / 12.0, 1e-3 * thickness * glass.density
    stiffness = d * math.sqrt(ratio), d / math.sqrt(ratio), d * twist
    hit = cl.ImpactModel(PAIR, law="hertz").solve(*IMPACT, cl.Orthotropic(glass, *stiffness, areal))
    assert 0.06 < hit.inelasticity < 1.1
    assert hit.restitution == pytest.approx(struck(stiffness, areal, IMPACT[0]), abs=2e-4)


def cell(share, nu, count=20):
    """Bending stiffnesses of a square cell with a hole, over D of the sheet, by Morley's triangles.

    A quarter of the cell: where curvatures are even no side turns, where they are odd no side moves.
    """
    angle = np.linspace(0.0, 0.5 * math.pi, 2 * count + 1)
    hole, side = math.sqrt(share / math.pi), 0.5 / np.maximum(np.cos(angle), np.sin(angle))
    r = hole + (side - hole) * np.linspace(0.0, 1.0, count + 1)[:, None]
    node, at = np.stack([r * np.cos(angle), r * np.sin(angle)], -1).reshape(-1, 2), np.arange(r.size).reshape(r.shape)
    a, b, c, d = (one.ravel() for one in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    corners = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    lines, line = np.unique(np.sort(corners[:, [[1, 2], [2, 0], [0, 1]]]).reshape(-1, 2), axis=0, return_inverse=True)
    line, run, middle = line.reshape(-1, 3), node[lines[:, 1]] - node[lines[:, 0]], node[lines].mean(axis=1)
    normal = np.stack([run[:, 1], -run[:, 0]], 1) / np.linalg.norm(run, axis=1)[:, None]
    freedoms, centre = np.hstack([corners, len(node) + line]), node[corners].mean(axis=1)[:, None]
    (x, y), (u, v), (n, m) = (
        np.moveaxis(one, -1, 0) for one in (node[corners] - centre, middle[line] - centre, normal[line])
    )
    heights = np.stack([x**0, x, y, x * x, x * y, y * y], -1)
    slopes = np.stack([0 * n, n, m, 2 * u * n, v * n + u * m, 2 * v * m], -1)
    bend = 2.0 * np.linalg.inv(np.concatenate([heights, slopes], 1))[:, [3, 5, 4]]
    area = 0.5 * ((x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0]))
    law = np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])
    moments = area[:, None, None] * np.swapaxes(bend, 1, 2) @ law
    places = np.repeat(freedoms, 6, 1).ravel(), np.tile(freedoms, (1, 6)).ravel()
    stiff, load = csc_array(((moments @ bend).ravel(), places)), np.zeros((len(node) + len(lines), 3))
    np.add.at(load, freedoms, moments)
    beside, straight = ((np.isclose(z, 0.0) | np.isclose(z, 0.5)).any(axis=1) for z in (node, middle))
    even, odd, whole = np.append(0 * beside, straight) > 0, np.append(beside, 0 * straight) > 0, area.sum() * law
    even[at[0, 0]] = True
    for held, cases in ((even, [0, 1]), (odd, [2])):
        free = np.flatnonzero(~held)
        moved = spsolve(stiff[free][:, free], load[np.ix_(free, cases)]).reshape(free.size, -1)
        whole[np.ix_(cases, cases)] -= load[np.ix_(free, cases)].T @ moved
    return 4.0 * whole


@pytest.mark.parametrize(("share", "off"), [(0.05, 1e-3), (0.2, 2e-3), (0.4, 0.01), (0.5, 0.03)])
def test_perforated_sheets_bend_as_finite_elements_of_a_cell(share, off):
    glass = PAIR.plate
    sheet, made = glass.plane_modulus * H**3 / 12.0, cl.Orthotropic.perforated(glass, H, share)
    (x, across, _), (_, y, _), (_, _, turn) = sheet * cell(share, glass.poissons_ratio)
    exact = cl.Orthotropic(glass, x, y, across + 2.0 * turn, (1.0 - share) * glass.density * H)
    assert made.bending == pytest.approx(exact.bending, rel=off) and made.areal == pytest.approx(exact.areal)
    assert float(cl.Orthotropic.perforated(glass, H, 0.0)) == pytest.approx(H, rel=1e-12)


def test_descriptions_are_copied_pickled_and_shown():
    clad = cl.Layers([(STEEL, 1e-3), (ALUMINIUM, 4e-3)])
    wood = cl.Orthotropic(STEEL, 3.0, 1.0, 1.0, mass=8.0, pitch=0.02)
    for one in (clad, wood):
        for again in (copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
            assert again == one and repr(vars(again)) == repr(vars(one))
    assert repr(clad) == "Layers([('stainless-steel-304', 0.001), ('aluminium-6061-t6', 0.004)])"
    assert repr(wood) == "Orthotropic('stainless-steel-304', 3.0, 1.0, 1.0, 8.0, 0.02)"


def test_a_layered_plate_goes_wherever_a_thickness_goes():
    clad = cl.Layers([("glass", 0.3e-3), ("aluminium-6061-t6", 0.4e-3)])
    bare = float(clad)
    here = {"corner": (0, 0, 0), "edge_a": (1, 0, 0), "edge_b": (0, 1, 0)}
    assert Plate(**here, thickness=clad).thickness == bare
    assert MODEL.restitution(*IMPACT, clad) == MODEL.restitution(*IMPACT, bare)
    assert MODEL.lookup(*IMPACT, [clad, H]).restitution.tolist() == [MODEL.restitution(*IMPACT, h) for h in (bare, H)]
    assert MODEL.curve(0.9e-3, clad)(5.0) == MODEL.curve(0.9e-3, bare)(5.0)
    slid = MODEL.oblique(5.0, 1.0, 0.9e-3, [clad, H], 0.2).sliding_speed
    assert slid[0] == MODEL.oblique(5.0, 1.0, 0.9e-3, bare, 0.2).sliding_speed


def test_edges_are_as_far_in_waves_of_the_layers():
    """The time to the edge and back, s^2/b with b = sqrt(D/m), is that of a sheet that is as fast."""
    clad = cl.Layers([("glass", 0.3e-3), ("aluminium-6061-t6", 0.4e-3)])
    slow, fast = (
        float(clad) * math.sqrt(PAIR.plate.plane_modulus / 12.0 / PAIR.plate.density),
        math.sqrt(clad.bending / clad.areal),
    )
    near = MODEL.solve(*IMPACT, clad, edge_distance=2e-3).restitution
    assert near == pytest.approx(
        MODEL.solve(*IMPACT, float(clad), edge_distance=2e-3 * math.sqrt(slow / fast)).restitution, abs=1e-12
    )


def elastic(lam, swing, kind):
    edges = Edges(response_of(kind, 0.3, np.zeros(1)), np.ones(1), np.array([swing]), np.zeros(1))
    found = outcome.at(np.array([lam]), np.array([math.inf]))
    zener.solve_all(HERTZ, 1e-10, found, few=True, edges=edges)
    return float(found.restitution[0])


@pytest.mark.parametrize("kind", ["sphere", "cylinder"])
@pytest.mark.parametrize(("lam", "swing"), [(0.1, 1.0), (0.3, 0.5), (0.6, 0.2), (1.0, 0.5), (1.0, 1.0)])
def test_what_swings_is_as_by_a_convolution_in_time(kind, lam, swing):
    assert elastic(lam, swing, kind) == pytest.approx(restitution(lam, swing, kind), abs=5e-4)


@pytest.mark.parametrize("kind", ["sphere", "cylinder"])
def test_the_fitted_response_is_the_bessel_function(kind):
    p = response_of(kind, 0.3, np.zeros(1))[0]
    t = np.linspace(0.0, REACH, 4001)
    found = np.ones_like(t)
    for part in (p[:18], p[18:]):
        for block in range(3):
            first, second, turn, _ = part[4 * block : 4 * block + 4]
            one, two = part[12 + 2 * block : 14 + 2 * block]
            if turn > 0.0:
                gone = 1.0 - np.exp(-complex(first, turn) * t)
                found += one * gone.real + two * gone.imag
            else:
                found += one * (1.0 - np.exp(-first * t)) + two * (1.0 - np.exp(-second * t))
    assert abs(found - kernel(kind, t)).max() < (2e-5 if kind == "sphere" else 5e-5)


def test_a_foundation_swings_as_its_spring_and_the_plates_mass():
    areal = PAIR.plate.density * H
    free = MODEL.solve(*IMPACT, H)
    hertz = cl.ImpactModel(PAIR, law="hertz")
    unit = math.pi * PAIR.sphere.density / PAIR.effective_modulus
    time = unit**0.4 * IMPACT[1] / IMPACT[0] ** 0.2
    for swing in (0.1, 0.4, 1.0):
        stiffness = areal * (swing / time) ** 2
        found = hertz.solve(*IMPACT, cl.Foundation(H, stiffness)).restitution
        lam = hertz.solve(*IMPACT, H).inelasticity
        assert found == pytest.approx(restitution(lam, swing, "sphere"), abs=5e-4)
    assert MODEL.solve(*IMPACT, cl.Foundation(H, 0.0)) == free
    several = MODEL.constant([1.0, 5.0], 0.9e-3, cl.Foundation(H, 1e12), weights=[[1.0], [2.0]])
    each = MODEL.solve([1.0, 5.0], 0.9e-3, cl.Foundation(H, 1e12)).restitution
    assert several.impacts == 4 and several.mean == pytest.approx(each.mean(), rel=1e-9)
    stiff = MODEL.solve(*IMPACT, cl.Foundation(H, [1e11, 1e12, 1e13]))
    assert (np.diff(stiff.restitution) > 0.0).all()
    balance = stiff.restitution**2 + stiff.plastic_fraction + stiff.wave_fraction + stiff.other_fraction
    assert balance == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("kind", [cl.Foundation, cl.Shell])
def test_walls_of_arrays_are_equal_by_value(kind):
    one, two, three = (kind(np.array([H, size]), np.full(2, 1e-2)) for size in (H, H, 2 * H))
    assert one == two and hash(one) == hash(two) and one != three and {one, two, three} == {one, three}
    assert one == kind([H, H], [1e-2, 1e-2]) and one != kind(H, 1e-2) and kind(H, 1) == kind(H, 1.0)


def test_answers_of_arrays_are_equal_by_value():
    speed = [1.0, 5.0]
    for answer in (MODEL.solve, MODEL.sensitivity, lambda *impact: MODEL.oblique(impact[0], 1.0, *impact[1:], 0.3)):
        one, two, three = (answer(np.array(speed), IMPACT[1], size) for size in (H, H, 2 * H))
        assert one == two and hash(one) == hash(two) and one != three


EXTREME = st.one_of(st.floats(), st.floats(-330, 310).map(lambda power: 10.0**power if power < 308 else np.inf))


@hypothesis.settings(max_examples=300, deadline=None)
@hypothesis.given(EXTREME, EXTREME, EXTREME, EXTREME)
@hypothesis.example(1e308, 0.3, 0.0, 1.0)
@hypothesis.example(1e-300, 1e300, -1e-10, 1e-300)
def test_plates_of_any_numbers_are_finite_or_refused_in_words(a, b, c, d):
    for make in (
        lambda: cl.Layers([("glass", a), ("pom", b)]),
        lambda: cl.Orthotropic("glass", a, b, c, d),
        lambda: cl.Orthotropic.perforated("glass", a, b, c),
    ):
        try:
            plate = make()
        except cl.ArgumentError:
            continue
        assert 0.0 < plate < np.inf and np.isfinite([plate.areal, plate.bending]).all()


def test_flat_shells_and_half_spaces_do_not_swing():
    for kind in ("cylinder", "sphere"):
        for answer in (MODEL.solve, MODEL.lookup):
            assert answer(*IMPACT, cl.Shell(H, math.inf, kind)) == answer(*IMPACT, H)
        # on a half-space nothing but R* is left of the curvature
        half = MODEL.solve(*IMPACT, cl.Shell(math.inf, 0.01, kind))
        assert half.restitution == pytest.approx(MODEL.solve(*IMPACT, math.inf).restitution, abs=5e-3)


def test_shells_take_both_radii_and_swing():
    """With w0 = c/a, and R* of Hertz's law; in a cylinder the geometric mean of two."""
    law, r, a = cl.ImpactModel(PAIR, law="hertz"), IMPACT[1], 0.01
    c = math.sqrt(PAIR.plate.youngs_modulus / PAIR.plate.density)
    for kind, star in (("sphere", 1.0 / (1.0 - r / a)), ("cylinder", (1.0 - r / a) ** -0.5)):
        time = (math.pi * PAIR.sphere.density / PAIR.effective_modulus) ** 0.4 * r / IMPACT[0] ** 0.2 * star**-0.2
        hit = law.solve(*IMPACT, cl.Shell(H, a, kind))
        lam = law.solve(*IMPACT, H).inelasticity * star**0.2
        assert hit.inelasticity == pytest.approx(lam, rel=1e-9)
        assert hit.restitution == pytest.approx(restitution(lam, c / a * time, kind), abs=5e-4)
    clad = cl.Layers([("glass", 0.3e-3), ("aluminium-6061-t6", 0.4e-3)])
    fast = math.sqrt(clad.membrane / clad.areal)
    assert fast == pytest.approx(math.sqrt((0.3 * 63e9 + 0.4 * 68.9e9) / (0.3 * 2500 + 0.4 * 2700)), rel=0.1)
    both = MODEL.solve(*IMPACT, cl.Shell(clad, a, "sphere"))
    assert both.restitution > MODEL.solve(*IMPACT, clad).restitution


def test_flags_say_where_a_description_ends():
    thin = cl.Layers([("glass", 0.05e-3), ("aluminium-6061-t6", 0.6e-3)])
    unlike = cl.Layers([("glass", 0.6e-3), ("pmma", 0.6e-3)])
    good = cl.Layers([("glass", 0.4e-3), ("aluminium-6061-t6", 0.6e-3)])
    for answer in (MODEL.solve, MODEL.lookup):
        flags = answer(*IMPACT, [thin, unlike, good, 1e-3]).flags
        assert [bool(one & cl.Validity.LINER) for one in flags] == [True, True, False, False]
    glass = cl.material("glass")
    d, m = glass.plane_modulus * H**3 / 12.0, glass.density * H
    time = MODEL.solve(*IMPACT, H).contact_time
    quarter = 0.25 * 2.0 * math.pi * math.sqrt(math.sqrt(d / m) * time / math.pi)
    for pitch, ribs in ((0.99 * quarter, False), (1.01 * quarter, True)):
        hit = MODEL.lookup(*IMPACT, cl.Orthotropic(glass, d, d, d, m, pitch))
        assert bool(hit.flags & cl.Validity.RIBS) is ribs
    assert MODEL.solve(*IMPACT, cl.Shell(H, 5e-3)).flags == 0
    assert MODEL.solve(*IMPACT, cl.Shell(H, 3e-3, "sphere")).flags & cl.Validity.CURVED_WALL


def test_bad_plates_are_refused_in_words():
    refused(lambda: cl.Layers([]), "layers", "expected pairs")
    refused(lambda: cl.Layers([("glass", 0.0)]), "layers", "0.0", "positive")
    refused(lambda: cl.Layers([("glas", 1e-3)]), "unknown material 'glas'")
    refused(lambda: cl.Orthotropic("glass", 1.0, 4.0, -2.0, 8.0), "twist", "above -sqrt(along across)")
    refused(lambda: cl.Orthotropic("glass", 1.0, 4.0, 2.0, 0.0), "mass", "positive")
    refused(lambda: cl.Orthotropic.perforated("glass", H, 30.0), "open_area", "30.0", "between 0 and 0.5")
    other = cl.Layers([("aluminium-6061-t6", H)])
    refused(lambda: MODEL.solve(*IMPACT, other), "beads touch 'aluminium-6061-t6'", "'glass'")
    refused(lambda: MODEL.restitution(*IMPACT, [H, other]), "beads touch 'aluminium-6061-t6'")
    for answer in (
        lambda: MODEL.oblique(5.0, 1.0, 0.9e-3, other, 0.2),
        lambda: MODEL.speed(0.5, 0.9e-3, other),
        lambda: MODEL.constant(*IMPACT, other),
        lambda: MODEL.speed_table(0.9e-3, other),
        lambda: MODEL.collide([0.0, 0.0, -1.0], 0.0, [0.0, 0.0, 1.0], 0.9e-3, other, 0.2),
        lambda: cl.load_signal([0.0], *IMPACT, other, model=MODEL, rate=1e4),
    ):
        refused(answer, "beads touch")
    refused(lambda: MODEL.solve(*IMPACT, cl.Shell(H, 0.8e-3)), "radius", "0.0008", "larger than the bead's")
    refused(lambda: MODEL.solve(*IMPACT, cl.Shell(H, 0.1, "cone")), "kind", "cylinder, sphere")
    refused(lambda: MODEL.solve(*IMPACT, cl.Foundation(H, -1.0)), "stiffness", "between 0")
    refused(lambda: MODEL.solve(*IMPACT, cl.Foundation(H, 1e17)), "60", "swings")
    wall = cl.Foundation(H, 1e11)
    refused(lambda: MODEL.solve(*IMPACT, wall, edge_distance=1e-3), "neither edges")
    refused(lambda: MODEL.yield_speed(0.9e-3, wall), "take solve")
    refused(lambda: MODEL.curve(0.9e-3, wall), "thickness", "expected one number")


def test_engines_refuse_another_material_and_edges_of_layers():
    clad = cl.Layers([("glass", 0.3e-3), ("aluminium-6061-t6", 0.4e-3)])
    other = cl.Layers([("aluminium-6061-t6", 0.4e-3), ("glass", 0.3e-3)])
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    here = {"corner": (0, 0, 0), "edge_a": (1, 0, 0), "edge_b": (0, 1, 0)}
    assert plate_rows([Plate(**here, thickness=clad), Mesh(corners, [[0, 1, 2]], clad)], {1: MODEL}, 1)[0].size == 1
    for wall in (Plate(**here, thickness=other), Mesh(corners, [[0, 1, 2]], other)):
        refused(lambda wall=wall: plate_rows([wall], {1: MODEL}, 1), "beads touch 'aluminium-6061-t6'")
    refused(lambda: plate_rows([Plate(**here, thickness=clad, edges="free")], {1: MODEL}, 1), "only bare sheets")
    space = pymunk.Space()
    impacts, segment = attach(space, MODEL), pymunk.Segment(space.static_body, (0, 0), (1, 0), 0.0)
    refused(lambda: impacts.add_plate(segment, thickness=other), "beads touch")
    refused(lambda: impacts.add_plate(segment, thickness=clad, edge="free"), "only bare sheets")
    impacts.add_plate(segment, thickness=clad)
    assert impacts.plates()["thickness"].tolist() == [float(clad)]

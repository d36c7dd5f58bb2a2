"""Plates that are no bare sheet: layers, wood, foundations, shells, beside programs of other methods."""

import copy
import math
import pickle

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
from scipy.integrate import quad
from skfem import Basis, BilinearForm, ElementTriMorley, LinearForm, MeshQuad, condense, solve
from skfem.helpers import dd, ddot, eye, trace

import contactlaw as cl
from contactlaw.physical.scaling import plate_mobility
from contactlaw.walls import Plate
from validation.derivations.walls import restitution

STEEL, ALUMINIUM = cl.material("stainless-steel-304"), cl.material("aluminium-6061-t6")
PAIR = cl.Pair("gamma-alumina", "glass")
MODEL = cl.ImpactModel(PAIR)
IMPACT = 5.0, 0.9e-3  # speed [m/s], radius [m]
ELASTIC = cl.ImpactModel(PAIR, law="hertz")
TIME = (math.pi * PAIR.sphere.density / PAIR.effective_modulus) ** 0.4 * IMPACT[1] / IMPACT[0] ** 0.2  # Hertz's [s]
H = 0.5e-3
CLAD = cl.Layers([("glass", 0.3e-3), ("aluminium-6061-t6", 0.4e-3)])
OTHER = cl.Layers([("aluminium-6061-t6", 0.4e-3), ("glass", 0.3e-3)])  # beads touch the other material
FLAT = {"corner": (0, 0, 0), "edge_a": (1, 0, 0), "edge_b": (0, 1, 0)}


def mobility(bending, areal):
    """Speed over force of a thin plate."""
    return 1.0 / (8.0 * math.sqrt(bending * areal))


def test_one_layer_is_a_thickness_to_the_last_bit():
    for size in (0.3e-3, H, 1.1e-3):
        assert cl.Layers([("glass", size)]) == size
    assert float(cl.Layers([("glass", 0.2e-3), ("glass", 0.3e-3)])) == pytest.approx(H, rel=1e-14)


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
    """Of D(phi)^-1/2, by which the speed over force of a plate goes that bends alike in all directions."""
    made = cl.Orthotropic(STEEL, x, y, k, mass=8.0)

    def share(phi):
        c, s = math.cos(phi) ** 2, math.sin(phi) ** 2
        return (x * c * c + 2.0 * k * c * s + y * s * s) ** -0.5

    mean = 2.0 / math.pi * quad(share, 0.0, 0.5 * math.pi, epsabs=0.0, epsrel=1e-11, limit=500)[0]
    assert plate_mobility(STEEL, np.array(float(made))) == pytest.approx(mean / (8.0 * math.sqrt(8.0)), rel=1e-9)


def cell(share, nu, count=20):
    """Bending, coupling and torsion of a square cell with a hole, over D of the sheet, by Morley's triangles.

    A quarter of the cell: where curvatures are even no side turns, where they are odd no side moves.
    """
    grid = MeshQuad.init_tensor(np.linspace(0.0, 1.0, count + 1), np.linspace(0.0, 0.5 * math.pi, 2 * count + 1))
    outward, direction, hole = grid.p[0], np.array([np.cos(grid.p[1]), np.sin(grid.p[1])]), math.sqrt(share / math.pi)
    r = hole + (0.5 / direction.max(axis=0) - hole) * outward
    basis = Basis(MeshQuad(r * direction, grid.t).to_meshtri(), ElementTriMorley())

    def moments(curvature):
        return (1.0 - nu) * curvature + nu * eye(trace(curvature), 2)

    def energy(curvature, held):
        """Twice the energy of the cell, which relaxes from a curvature that is the same everywhere."""
        whole = np.array(curvature)[:, :, None, None]
        load = LinearForm(lambda v, _: ddot(moments(whole), dd(v))).assemble(basis)
        relaxed = load @ solve(*condense(stiff, load, D=held))
        return (1.0 - share) * ddot(moments(whole), whole).item() - 4.0 * relaxed

    stiff = BilinearForm(lambda u, v, _: ddot(moments(dd(u)), dd(v))).assemble(basis)
    sides = basis.get_dofs(lambda x: np.isclose(x * (x - 0.5), 0.0).any(axis=0))
    even = np.append(sides.all("u_n"), 0)
    along, both = (energy([[1, 0], [0, y]], even) for y in (0, 1))
    return np.array([along, 0.5 * both - along, energy([[0, 0.5], [0.5, 0]], sides.all("u"))])


@pytest.mark.parametrize(("share", "off"), [(0.05, 1e-3), (0.2, 2e-3), (0.4, 0.01), (0.5, 0.03)])
def test_perforated_sheets_bend_as_finite_elements_of_a_cell(share, off):
    glass = PAIR.plate
    sheet, made = glass.plane_modulus * H**3 / 12.0, cl.Orthotropic.perforated(glass, H, share)
    along, across, turn = sheet * cell(share, glass.poissons_ratio)
    exact = cl.Orthotropic(glass, along, along, across + 2.0 * turn, (1.0 - share) * glass.density * H)
    assert made.bending == pytest.approx(exact.bending, rel=off) and made.areal == pytest.approx(exact.areal)
    assert float(cl.Orthotropic.perforated(glass, H, 0.0)) == pytest.approx(H, rel=1e-12)


def test_descriptions_are_copied_pickled_and_shown():
    clad = cl.Layers([(STEEL, 1e-3), (ALUMINIUM, 4e-3)])
    wood = cl.Orthotropic(STEEL, 3.0, 1.0, 1.0, mass=8.0, pitch=0.02)
    for plate in (clad, wood):
        for again in (copy.deepcopy(plate), pickle.loads(pickle.dumps(plate))):
            assert again == plate and repr(vars(again)) == repr(vars(plate))
    assert repr(clad) == "Layers([('stainless-steel-304', 0.001), ('aluminium-6061-t6', 0.004)])"
    assert repr(wood) == "Orthotropic('stainless-steel-304', 3.0, 1.0, 1.0, 8.0, 0.02)"


def test_a_layered_plate_goes_wherever_a_thickness_goes():
    bare = float(CLAD)
    assert Plate(**FLAT, thickness=CLAD).thickness == bare
    for answer in (
        lambda *h: MODEL.restitution(*IMPACT, *h),
        lambda *h: MODEL.solve(*IMPACT, *h).restitution,
        lambda *h: MODEL.lookup(*IMPACT, [*h, H]).restitution[0],
        lambda *h: MODEL.oblique(5.0, 1.0, 0.9e-3, [*h, H], 0.2).sliding_speed[0],
        lambda *h: MODEL.curve(0.9e-3, *h)(5.0),
    ):
        assert answer(CLAD) == answer(bare)


def test_edges_are_as_far_in_waves_of_the_layers():
    """The time to the edge and back, s^2/b with b = sqrt(D/m), is that of a sheet that is as fast."""
    slow = float(CLAD) * math.sqrt(PAIR.plate.plane_modulus / 12.0 / PAIR.plate.density)
    alike = 2e-3 * math.sqrt(slow / math.sqrt(CLAD.bending / CLAD.areal))
    near = MODEL.solve(*IMPACT, CLAD, edge_distance=2e-3).restitution
    assert near == pytest.approx(MODEL.solve(*IMPACT, float(CLAD), edge_distance=alike).restitution, abs=1e-12)


@pytest.mark.parametrize(("kind", "exponent"), [("sphere", -1.0), ("cylinder", -0.5)])
@pytest.mark.parametrize(
    ("thickness", "radius"), [(1e-3, 8e-3), (0.6e-3, 16e-3), (0.45e-3, 40e-3), (0.35e-3, 16e-3), (0.35e-3, 8e-3)]
)
def test_a_shell_swings_as_by_a_convolution_in_time(kind, exponent, thickness, radius):
    """With w0 = c/a, and R* of Hertz's law; in a cylinder the geometric mean of two."""
    star = (1.0 - IMPACT[1] / radius) ** exponent
    swing = math.sqrt(PAIR.plate.youngs_modulus / PAIR.plate.density) / radius * TIME * star**-0.2
    hit = ELASTIC.solve(*IMPACT, cl.Shell(thickness, radius, kind))
    lam = ELASTIC.solve(*IMPACT, thickness).inelasticity * star**0.2
    assert 0.05 < lam < 1.5 and 0.1 < swing < 1.2
    assert hit.inelasticity == pytest.approx(lam, rel=1e-9)
    assert hit.restitution == pytest.approx(restitution(lam, swing, kind), abs=5e-4)


@pytest.mark.parametrize("swing", [0.1, 0.4, 1.0])
def test_a_foundation_swings_as_its_spring_and_the_plates_mass(swing):
    stiffness = PAIR.plate.density * H * (swing / TIME) ** 2
    exact = restitution(ELASTIC.solve(*IMPACT, H).inelasticity, swing, "sphere")
    assert ELASTIC.solve(*IMPACT, cl.Foundation(H, stiffness)).restitution == pytest.approx(exact, abs=5e-4)


def test_a_stiffer_foundation_gives_back_more_and_none_changes_nothing():
    assert MODEL.solve(*IMPACT, cl.Foundation(H, 0.0)) == MODEL.solve(*IMPACT, H)
    stiff = MODEL.solve(*IMPACT, cl.Foundation(H, [1e11, 1e12, 1e13]))
    assert (np.diff(stiff.restitution) > 0.0).all()
    balance = stiff.restitution**2 + stiff.plastic_fraction + stiff.wave_fraction + stiff.other_fraction
    assert balance == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    "make",
    [
        lambda h: cl.Foundation(np.array([H, h]), np.full(2, 1e-2)),
        lambda h: cl.Shell(np.array([H, h]), np.full(2, 1e-2)),
        lambda h: MODEL.solve([1.0, 5.0], IMPACT[1], h),
        lambda h: MODEL.sensitivity([1.0, 5.0], IMPACT[1], h),
        lambda h: MODEL.oblique([1.0, 5.0], 1.0, IMPACT[1], h, 0.3),
    ],
)
def test_walls_and_answers_of_arrays_are_equal_by_value(make):
    one, two, three = make(H), make(H), make(2 * H)
    assert one == two and hash(one) == hash(two) and one != three


EXTREME = st.one_of(st.floats(), st.floats(-330, 310).map(lambda power: 10.0**power if power < 308 else np.inf))


@hypothesis.settings(max_examples=100, deadline=None)
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


def test_a_shell_of_layers_has_their_membrane():
    fast = math.sqrt(CLAD.membrane / CLAD.areal)
    assert fast == pytest.approx(math.sqrt((0.3 * 63e9 + 0.4 * 68.9e9) / (0.3 * 2500 + 0.4 * 2700)), rel=0.1)
    both = MODEL.solve(*IMPACT, cl.Shell(CLAD, 0.01, "sphere"))
    assert both.restitution > MODEL.solve(*IMPACT, CLAD).restitution


def test_flags_say_where_a_description_ends():
    thin = cl.Layers([("glass", 0.05e-3), ("aluminium-6061-t6", 0.6e-3)])
    unlike = cl.Layers([("glass", 0.6e-3), ("pmma", 0.6e-3)])
    for answer in (MODEL.solve, MODEL.lookup):
        flags = answer(*IMPACT, [thin, unlike, CLAD, 1e-3]).flags
        assert [bool(one & cl.Validity.LINER) for one in flags] == [True, True, False, False]
    glass = PAIR.plate
    d, m = glass.plane_modulus * H**3 / 12.0, glass.density * H
    time = MODEL.solve(*IMPACT, H).contact_time
    quarter = 0.25 * 2.0 * math.pi * math.sqrt(math.sqrt(d / m) * time / math.pi)
    for pitch, ribs in ((0.99 * quarter, False), (1.01 * quarter, True)):
        hit = MODEL.lookup(*IMPACT, cl.Orthotropic(glass, d, d, d, m, pitch))
        assert bool(hit.flags & cl.Validity.RIBS) is ribs
    assert MODEL.solve(*IMPACT, cl.Shell(H, 5e-3)).flags == 0
    assert MODEL.solve(*IMPACT, cl.Shell(H, 3e-3, "sphere")).flags & cl.Validity.CURVED_WALL


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: cl.Layers([]), "layers.*expected pairs"),
        (lambda: cl.Layers([("glass", 0.0)]), "layers.*0.0.*positive"),
        (lambda: cl.Orthotropic("glass", 1.0, 4.0, 2.0, 0.0), "mass.*positive"),
        (lambda: cl.Layers([("glas", 1e-3)]), "unknown material 'glas'"),
        (lambda: cl.Orthotropic("glass", 1.0, 4.0, -2.0, 8.0), r"twist.*above -sqrt\(along across\)"),
        (lambda: cl.Orthotropic.perforated("glass", H, 30.0), "open_area.*30.0.*between 0 and 0.5"),
        (lambda: MODEL.solve(*IMPACT, OTHER), "beads touch 'aluminium-6061-t6'.*'glass'"),
        (lambda: MODEL.restitution(*IMPACT, [H, OTHER]), "beads touch 'aluminium-6061-t6'"),
        (lambda: cl.load_signal([0.0], *IMPACT, OTHER, model=MODEL, rate=1e4), "beads touch"),
        (lambda: MODEL.solve(*IMPACT, cl.Shell(H, 0.8e-3)), "radius.*0.0008.*larger than the bead's"),
        (lambda: MODEL.solve(*IMPACT, cl.Shell(H, 0.1, "cone")), "kind.*cylinder, sphere"),
        (lambda: MODEL.solve(*IMPACT, cl.Foundation(H, -1.0)), "stiffness.*between 0"),
        (lambda: MODEL.solve(*IMPACT, cl.Foundation(H, 1e17)), "60.*swings"),
        (lambda: MODEL.solve(*IMPACT, cl.Foundation(H, 1e11), edge_distance=1e-3), "neither edges"),
        (lambda: MODEL.yield_speed(0.9e-3, cl.Foundation(H, 1e11)), "take solve"),
        (lambda: MODEL.curve(0.9e-3, cl.Foundation(H, 1e11)), "thickness.*expected one number"),
    ],
)
def test_bad_plates_are_refused_in_words(call, words):
    with pytest.raises(ValueError, match=words):
        call()

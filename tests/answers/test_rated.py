"""Pairs with a rate of strain: each impact is that of the pair that is as strong as at its rate."""

import ctypes
import dataclasses
import functools
import math
import pickle

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.answers.solver import Solver
from contactlaw.cli import main
from contactlaw.equation import force
from contactlaw.physical import rate
from contactlaw.physical.impacts import Impacts
from contactlaw.table import Settings, bounds, file

R = 1e-3
COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
STEEL = cl.Material("steel", 207e9, 0.29, 7850, 350e6, kind="metal", rate=(0.022, 1.0))
STEEP = cl.Material("steep", 70e9, 0.33, 2700, 300e6, kind="metal", rate=(0.08, 1.0))
HARD = cl.Material("hard", 207e9, 0.3, 7800, 1.35e9, kind="metal", rate=(0.03, 1.0))
OTHER = cl.Material("other", 70e9, 0.3, 2700, 400e6, kind="metal")
PAIRS = {
    "sphere": cl.Pair(COPPER, "glass"),
    "plate": cl.Pair("glass", STEEL),
    "both": cl.Pair(STEEP, STEEP),
    "the other becomes the weaker": cl.Pair(STEEL, OTHER),
    "a corner of the law": cl.Pair(HARD, "glass"),
}
# Each needs about ten tables; those of the others are of the same kinds.
LONG = pytest.mark.long
NAMES = [pytest.param(name, marks=LONG) if name in ("plate", "a corner of the law") else name for name in PAIRS]
FIELDS = [name for name in cl.Rebound.__dataclass_fields__ if name != "flags"]


@functools.cache
def model(name, **options):
    return cl.ImpactModel(PAIRS[name], **options)


def factors(name, speed, radius):
    return rate.factors(rate.flow_with_rate(PAIRS[name], model(name).force_law), speed, radius)


@functools.cache
def impacts(name, count=80):
    """Random impacts inside the tables, from below yield to deep contacts."""
    rng = np.random.default_rng(5)
    speed = PAIRS[name].yield_speed * np.exp(rng.uniform(-1.0, 10.0, 10 * count))
    radius = np.exp(rng.uniform(math.log(2e-5), math.log(1e-2), speed.size))
    thickness = np.where(rng.random(speed.size) < 0.1, np.inf, radius / rng.uniform(0.05, 2.0))
    look_up = model(name).kernel
    inside = [look_up(*one) >= 0.0 for one in zip(speed, radius, thickness, strict=True)]
    return tuple(values[inside][:count] for values in (speed, radius, thickness))


@pytest.mark.parametrize("name", NAMES)
def test_tables_are_certified(name):
    given = impacts(name)
    assert np.ptp(factors(name, *given[:2])) > 0.06
    found, exact = model(name).lookup(*given), model(name).solve(*given)
    bound = bounds(model(name).force_law)
    clear = np.abs(exact.overload - 1.0) > 0.02  # next to yield two fields begin at zero
    for field in FIELDS:
        ours, true = getattr(found, field), getattr(exact, field)
        if field == "restitution":
            assert np.abs(ours - true).max() < bound[field], field
        else:
            errors = np.abs(ours - true) / np.maximum(np.abs(true), 1e-12)
            assert errors[clear].max() < bound.get(field, 5e-4), field
    shares = found.plastic_fraction + found.wave_fraction + found.other_fraction
    assert shares == pytest.approx(1.0 - found.restitution**2, abs=1e-5)
    assert np.count_nonzero(found.flags != exact.flags) <= 2  # some lie on a limit


@pytest.mark.parametrize("seed", [1, 8, *(pytest.param(n, marks=LONG) for n in (0, 2, 3, 5, 7, 9))])
def test_two_bodies_with_rates_of_their_own(seed):
    """Of published size and absurd ones: tables knew the rate of the weaker body alone."""
    rng = np.random.default_rng(seed)
    slopes, rates = ((0.005, 0.3), (1e-3, 1e4)) if seed % 2 else ((0.005, 0.06), (1e-2, 1e3))

    def between(low, high):
        return math.exp(rng.uniform(math.log(low), math.log(high)))

    def body():
        strength = between(90e6, 800e6)
        hardening = strength * rng.uniform(0.2, 3.0), rng.uniform(0.2, 0.7)
        known = rng.uniform(60e9, 220e9), rng.uniform(0.25, 0.35), 7850, strength
        flow = {"hardening": hardening, "rate": (between(*slopes), between(*rates))}
        return cl.Material("random", *known, kind="metal", **flow)

    bodies = body(), body()
    coarse = Settings(0.5, 40.0, inelasticity_nodes=25, log_overload_step=0.1, rtol=1e-9)
    one = cl.ImpactModel(cl.Pair(*bodies), table=coarse)
    r, v = (np.exp(rng.uniform(*np.log(ends), 2000)) for ends in ((2e-5, 2e-2), (1e-2, 1e2)))
    inside = np.array([one.kernel(*at) >= 0.0 for at in zip(v, r, 4.0 * r, strict=True)])
    v, r = v[inside][:200], r[inside][:200]
    exact = one.solve(v, r, 4.0 * r).restitution
    assert v.size == 200
    assert np.abs(one.restitution(v, r, 4.0 * r) - exact).max() < 1e-5
    assert np.abs(one.lookup(v, r, 4.0 * r).restitution - exact).max() < 1e-5
    for n in range(3):  # each body is as strong as at the rate of the impact
        at = [rate.scaled(b, b.flow.factor(rate.SHARE * v[n] / r[n])) for b in bodies]
        alone = cl.ImpactModel(cl.Pair(*(dataclasses.replace(b, rate=None) for b in at)))
        assert alone.solve(v[n], r[n], 4.0 * r[n]).restitution == pytest.approx(exact[n], abs=5e-6)


@pytest.mark.parametrize("name", ["sphere", "both"])
def test_all_entries_have_one_cor(name):
    one, (v, r, h) = model(name), impacts(name)
    expected = pytest.approx(one.lookup(v, r, h).restitution, abs=1e-6)
    given = list(zip(v.tolist(), r.tolist(), h.tolist(), strict=True))
    double = ctypes.c_double
    pointer = ctypes.CFUNCTYPE(double, double, double, double)(one.address)
    assert one.restitution(v, r, h) == expected
    assert np.array([one.restitution(*at) for at in given]) == expected
    assert np.array([pointer(*at) for at in given]) == expected
    assert np.array([one.curve(b, c)(a) for a, b, c in given]) == expected
    # slow impacts know no rate, and 600 impacts are more than one chunk
    slow = cl.ImpactModel(rate.strengthened(PAIRS[name], 1.0)).restitution(1e-3, R, R)
    assert one.restitution(np.full(600, 1e-3), R, R) == pytest.approx(slow, abs=2e-6)
    again = pickle.loads(pickle.dumps(one)).restitution(*given[0])
    assert again == pytest.approx(one.restitution(*given[0]), rel=1e-12)


def test_outside_the_tables():
    v, r, h = np.array([1.0, 1.0, 3e3, 5.0]), np.array([R, R, R, 1e-8]), [R, 1e-4, 1e-2, 1e-3]
    for n, reason in ((1, "too thin"), (2, "too fast"), (3, "its rate makes the bodies 1.4")):
        with pytest.raises(ValueError, match=f"impact 1 is outside the table.*{reason}"):
            model("sphere").restitution(v[[0, n]], r[[0, n]], np.array(h)[[0, n]])
    exact = model("sphere").solve(v, r, h)
    assert cl.ImpactModel(PAIRS["sphere"], outside="solve").restitution(v, r, h) == pytest.approx(
        exact.restitution, abs=1e-6
    )
    clamped = cl.ImpactModel(PAIRS["sphere"], outside="clamp")
    hit = clamped.lookup(v, r, h)
    assert clamped.clamped == 3
    assert ((hit.flags & cl.Validity.CLAMPED) > 0).tolist() == [False, True, True, True]
    assert hit.inelasticity == pytest.approx(exact.inelasticity, rel=1e-5)
    with pytest.raises(ValueError, match="speed: got -1"):
        model("sphere").restitution([1.0, -1.0], R, R)
    assert math.isnan(model("sphere").kernel(-1.0, R, R))


@pytest.mark.parametrize("name", NAMES)
def test_yield_speed_is_at_its_own_rate(name):
    for thickness in (R, math.inf):
        found = model(name).yield_speed(R, thickness)
        assert model(name).lookup(found, R, thickness).overload == pytest.approx(1.0, abs=1e-5)
        given = Impacts(np.ones(1), np.array([R]), np.array([thickness]), None)
        own = Solver(model(name)._bodies).yield_speeds(given)
        assert own == pytest.approx(found, rel=1e-5)


@pytest.mark.parametrize("other", [None, "glass", pytest.param(STEEL, marks=pytest.mark.long)])
def test_beads(other):
    """The rate goes with the reduced radius."""
    v, r, o = 3.0, R, 3.0 * R
    beads = cl.Pair(COPPER, other or COPPER)
    flow = rate.flow_with_rate(beads, model("sphere").force_law)
    pair = rate.strengthened(beads, float(rate.factors(flow, v, r * o / (r + o))))
    alone = cl.ImpactModel(pair).lookup_sphere_sphere(v, r, o, pair.plate)
    found = model("sphere").lookup_sphere_sphere(v, r, o, other)
    assert found.restitution == pytest.approx(alone.restitution, abs=1e-5)
    assert found.contact_time == pytest.approx(alone.contact_time, rel=1e-4)
    e = pytest.approx(found.restitution, abs=1e-6)
    assert model("sphere").sphere_sphere_curve(r, o, other)(v) == e
    assert cl.restitution_sphere_sphere(COPPER, other or COPPER, v, r, o) == e
    assert model("sphere")._beads(other).integrated(v, r, o) == e


def test_histories_are_those_of_the_solver():
    given = [0.5, 3.0], R, [2e-3, 5e-3]
    ours, exact = (model("sphere").force_history(*given, samples=65, method=how) for how in ("table", "solve"))
    for name, values in exact._asdict().items():
        assert np.abs(getattr(ours, name) - values).max() < 3e-3 * values.max(), name
    load = cl.load_signal([0.0, 1e-3], *given, model=model("sphere"), rate=1e6)
    assert load.force.sum() / 1e6 == pytest.approx(exact.impulse[:, -1].sum(), rel=1e-4)


def test_oblique_impacts():
    """Within 5e-3 of mu V, as the docs say; `collide` and its kernel have the same."""
    v, r, h = (values[:40] for values in impacts("sphere"))
    slide = 0.3 * v * np.random.default_rng(2).uniform(0.0, 6.0, v.size)
    one = model("sphere")
    ours, exact = (one.oblique(v, slide, r, h, 0.3, method=how) for how in ("table", "solve"))
    assert (np.abs(ours.sliding_speed - exact.sliding_speed) / (0.3 * v)).max() < 5e-3
    rest, up = np.zeros(3), np.array([0.0, 0.0, 1.0])
    velocity = np.array([slide[0], 0.0, -v[0]])
    after, _ = one.collide(velocity, rest, up, r[0], h[0], 0.3)
    assert after[2] == pytest.approx(v[0] * ours.restitution[0], rel=1e-6)
    assert after[0] == pytest.approx(slide[0] - (slide[0] - ours.sliding_speed[0]) / 3.5, rel=1e-6)
    again, _ = one.collide_kernel(*map(tuple, (velocity, rest, up)), r[0], h[0], 0.3, tuple(rest))
    assert again == pytest.approx(after, rel=1e-9)


def test_sensitivities_move_the_rate():
    v, r, h = 3.0, R, 2e-3
    found = model("sphere").sensitivity(v, r, h)

    def slope(*ends):
        below, above = (np.log(one.solve(*at, rtol=1e-13).restitution) for one, at in ends)
        return (above - below) / 2e-3

    def by(change):
        return slope(*((model("sphere"), change(math.exp(x))) for x in (-1e-3, 1e-3)))

    def moved(number, x):
        body = dataclasses.replace(COPPER, **{number: x * getattr(COPPER, number)})
        return cl.ImpactModel(cl.Pair(body, "glass"))

    assert found.speed == pytest.approx(by(lambda x: (x * v, r, h)), abs=1e-4)
    assert found.radius == pytest.approx(by(lambda x: (v, x * r, h)), abs=1e-4)
    assert abs(found.radius + found.thickness) > 5e-3  # without rate they cancel
    for number, name in (("density", "sphere_density"), ("yield_strength", "yield_strength")):
        ends = ((moved(number, math.exp(x)), (v, r, h)) for x in (-1e-3, 1e-3))
        assert getattr(found, name) == pytest.approx(slope(*ends), abs=2e-3)  # rounds the law


def test_a_fit_finds_the_strength_at_a_known_rate():
    speed = [0.5, 1.0, 2.0, 4.0]
    e = model("sphere").solve(speed, R, 5e-3).restitution
    start = cl.Pair(dataclasses.replace(COPPER, yield_strength=120e6), "glass")
    data = {"speed": speed, "radius": R, "thickness": 5e-3, "restitution": e}
    found = cl.fit(start, data, unknown="yield_strength")
    assert found.values["yield_strength"] == pytest.approx(90e6, rel=1e-3)


def test_tables_of_the_user(tmp_path, capsys):
    short = Settings(largest_overload=5.0, inelasticity_nodes=41, log_overload_step=0.05)
    given = 0.01, R, 2e-3
    own = cl.ImpactModel(PAIRS["sphere"], table=short)
    assert own.restitution(*given) == pytest.approx(model("sphere").restitution(*given), abs=1e-5)
    with pytest.raises(ValueError, match="overload chi = .* is above 5: the impact is too fast"):
        own.restitution(1.0, R, 2e-3)
    path = tmp_path / "pair.h5"
    file.write(own.table, path)
    again = cl.ImpactModel(PAIRS["sphere"], table=path)
    assert again.restitution(*given) == own.restitution(*given)
    with pytest.raises(ValueError, match="it belongs to law 'fem.*', the model needs one of"):
        cl.ImpactModel(PAIRS["plate"], table=own.table)
    quicker = dataclasses.replace(COPPER, rate=(0.03, 1.0))
    known = rf"data {own.table.law.key} and .* differ in their rates"
    with pytest.raises(ValueError, match=known):
        cl.ImpactModel(cl.Pair(quicker, "glass"), table=own.table)
    assert main(["table", "info", str(path)]) == 0
    assert "strength to 1.332" in capsys.readouterr().out


def test_a_damaged_table_is_refused(tmp_path):
    """Of laws of several strengths, too, kernels follow addresses."""
    laws = model("sphere").table.law.at_any_strength
    force.check_strengths(laws)
    for entry, value in ((force.FIRST_ROW + force.BEGINS, 1e9), (force.FIRST_ROW + force.WIDTH, 5)):
        damaged = laws.copy()
        damaged[entry] = value
        with pytest.raises(ValueError, match="its law"):
            force.check_strengths(damaged)


def test_other_laws_know_no_rate():
    plain = cl.Pair(dataclasses.replace(COPPER, rate=None), "glass")
    given = [1e-3, 0.1, 1.0], R, 3e-3
    for law in ("myc", "jackson_green", "fem(500,0,0.4,0.3,0.2)"):
        with_rate, without = (cl.ImpactModel(one, law) for one in (PAIRS["sphere"], plain))
        assert (with_rate.solve(*given).restitution == without.solve(*given).restitution).all()


def test_a_rate0_that_no_impact_reaches_is_no_rate():
    slow = dataclasses.replace(STEEL, rate=(0.05, 5.9e5))
    one = cl.ImpactModel(cl.Pair(slow, "glass"))
    plain = cl.ImpactModel(cl.Pair(dataclasses.replace(STEEL, rate=None), "glass"))
    assert one.restitution(3.0, R, 5 * R) == plain.restitution(3.0, R, 5 * R) > 0.5


def test_no_impacts_have_empty_answers():
    one = model("sphere")
    assert one.lookup([], R, R).restitution.shape == (0,)
    assert one.force_history([], R, R, samples=3).force.shape == (0, 3)
    assert one.sensitivity([], R, R).speed.shape == (0,)
    assert one.solve([], R, R).flags.shape == (0,)
    assert one.force_history([], R, R, samples=3, method="solve").force.shape == (0, 3)

"""Pairs with a rate of strain: each impact is that of the pair that is as strong as at its rate."""

import dataclasses
import math

import kinds
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.equation import force
from contactlaw.physical import rate
from contactlaw.table import Settings, file

R = 1e-3
LONG = pytest.mark.long
PAIR = kinds.RATED["rate of the sphere"]
MODEL = kinds.model("rate of the sphere")


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
    coarse = Settings(0.5, 40.0, rows=24, columns=30)
    one = cl.ImpactModel(cl.Pair(*bodies), table=coarse)
    r, v = (np.exp(rng.uniform(*np.log(ends), 2000)) for ends in ((2e-5, 2e-2), (1e-2, 1e2)))
    inside = np.array([one.kernel(*at) >= 0.0 for at in zip(v, r, 4.0 * r, strict=True)])
    v, r = v[inside][:200], r[inside][:200]
    exact = one.solve(v, r, 4.0 * r).restitution
    assert v.size == 200
    assert np.abs(one.restitution(v, r, 4.0 * r) - exact).max() < 1e-4
    assert np.abs(one.lookup(v, r, 4.0 * r).restitution - exact).max() < 1e-4
    for n in range(3):  # each body is as strong as at the rate of the impact
        at_rate = rate.SHARE * v[n] / r[n] * (cl.Pair(*bodies).yield_speed / v[n]) ** 0.3
        at = [rate.scaled(b, b.flow.factor(at_rate)) for b in bodies]
        alone = cl.ImpactModel(cl.Pair(*(dataclasses.replace(b, rate=None) for b in at)))
        assert alone.solve(v[n], r[n], 4.0 * r[n]).restitution == pytest.approx(exact[n], abs=7e-5)


def test_outside_the_tables():
    v, r, h = np.array([1.0, 1.0, 3e3, 5.0]), np.array([R, R, R, 1e-8]), [R, 1e-4, 1e-2, 1e-3]
    for n, reason in ((1, "too thin"), (2, "too fast"), (3, "its rate makes the bodies stronger")):
        with pytest.raises(ValueError, match=f"impact 1 is outside the table.*{reason}"):
            MODEL.restitution(v[[0, n]], r[[0, n]], np.array(h)[[0, n]])
    exact = MODEL.solve(v, r, h)
    assert cl.ImpactModel(PAIR, outside="solve").restitution(v, r, h) == pytest.approx(exact.restitution, abs=1e-4)
    clamped = cl.ImpactModel(PAIR, outside="clamp")
    hit = clamped.lookup(v, r, h)
    assert clamped.clamped == 3
    assert ((hit.flags & cl.Validity.CLAMPED) > 0).tolist() == [False, True, True, True]
    assert hit.inelasticity == pytest.approx(exact.inelasticity, rel=1e-5)
    with pytest.raises(ValueError, match="speed: got -1"):
        MODEL.restitution([1.0, -1.0], R, R)
    assert math.isnan(MODEL.kernel(-1.0, R, R))


@pytest.mark.parametrize("other", [None, "glass", pytest.param(kinds.STEEL, marks=pytest.mark.long)])
def test_beads(other):
    """The rate goes with the reduced radius."""
    v, r, o = 3.0, R, 3.0 * R
    beads = cl.Pair(kinds.COPPER, other or kinds.COPPER)
    pair = rate.strengthened(beads, float(rate.factors(beads, v, r * o / (r + o))))
    alone = cl.ImpactModel(pair).lookup_sphere_sphere(v, r, o, pair.plate)
    found = MODEL.lookup_sphere_sphere(v, r, o, other)
    assert found.restitution == pytest.approx(alone.restitution, abs=1e-4)
    assert found.contact_time == pytest.approx(alone.contact_time, rel=2e-3)
    e = pytest.approx(found.restitution, abs=1e-4)
    assert MODEL.sphere_sphere_curve(r, o, other)(v) == e
    assert cl.restitution_sphere_sphere(kinds.COPPER, other or kinds.COPPER, v, r, o) == e


def test_histories_are_those_of_the_solver():
    given = [0.5, 3.0], R, [2e-3, 5e-3]
    ours, exact = (MODEL.force_history(*given, samples=65, method=how) for how in ("table", "solve"))
    for name, values in exact._asdict().items():
        assert np.abs(getattr(ours, name) - values).max() < 3e-3 * values.max(), name
    load = cl.load_signal([0.0, 1e-3], *given, model=MODEL, rate=1e6)
    assert load.force.sum() / 1e6 == pytest.approx(exact.impulse[:, -1].sum(), rel=1e-4)


def test_oblique_impacts():
    """Within 2e-3 of mu V, and 7e-3 at overloads above 50, as the docs say."""
    v, r, h = (values[:40] for values in kinds.impacts("rate of the sphere"))
    slide = 0.3 * v * np.random.default_rng(2).uniform(0.0, 6.0, v.size)
    ours, exact = (MODEL.oblique(v, slide, r, h, 0.3, method=how) for how in ("table", "solve"))
    off = np.abs(ours.sliding_speed - exact.sliding_speed) / (0.3 * v)
    assert (off < np.where(MODEL.solve(v, r, h).overload > 50.0, 7e-3, 2e-3)).all()


def test_sensitivities_move_the_rate():
    v, r, h = 3.0, R, 2e-3
    found = MODEL.sensitivity(v, r, h)

    def slope(*ends):
        below, above = (np.log(one.solve(*at, rtol=1e-13).restitution) for one, at in ends)
        return (above - below) / 2e-3

    def by(change):
        return slope(*((MODEL, change(math.exp(x))) for x in (-1e-3, 1e-3)))

    def moved(number, x):
        body = dataclasses.replace(kinds.COPPER, **{number: x * getattr(kinds.COPPER, number)})
        return cl.ImpactModel(cl.Pair(body, "glass"))

    assert found.speed == pytest.approx(by(lambda x: (x * v, r, h)), abs=1e-4)
    assert found.radius == pytest.approx(by(lambda x: (v, x * r, h)), abs=1e-4)
    assert abs(found.radius + found.thickness) > 5e-3  # without rate they cancel
    for number, name in (("density", "sphere_density"), ("yield_strength", "yield_strength")):
        ends = ((moved(number, math.exp(x)), (v, r, h)) for x in (-1e-3, 1e-3))
        assert getattr(found, name) == pytest.approx(slope(*ends), abs=2e-3)  # rounds the law


def test_a_fit_finds_the_strength_at_a_known_rate():
    speed = [0.5, 1.0, 2.0, 4.0]
    e = MODEL.solve(speed, R, 5e-3).restitution
    start = cl.Pair(dataclasses.replace(kinds.COPPER, yield_strength=120e6), "glass")
    data = {"speed": speed, "radius": R, "thickness": 5e-3, "restitution": e}
    found = cl.fit(start, data, unknown="yield_strength")
    assert found.values["yield_strength"] == pytest.approx(90e6, rel=1e-3)


def test_tables_of_the_user(tmp_path, capsys):
    short = Settings(largest_overload=5.0)
    given = 0.01, R, 2e-3
    own = cl.ImpactModel(PAIR, table=short)
    assert own.restitution(*given) == pytest.approx(MODEL.restitution(*given), abs=2e-4)
    with pytest.raises(ValueError, match="overload chi = .* is above 5: the impact is too fast"):
        own.restitution(1.0, R, 2e-3)
    path = tmp_path / "pair.h5"
    file.write(own.table, path)
    again = cl.ImpactModel(PAIR, table=path)
    assert again.restitution(*given) == own.restitution(*given)
    with pytest.raises(ValueError, match="it belongs to law 'fem.*', the model needs one of"):
        cl.ImpactModel(kinds.RATED["rate of the plate"], table=own.table)
    quicker = dataclasses.replace(kinds.COPPER, rate=(0.03, 1.0))
    known = rf"data {own.table.law.key} and .* differ in their rates"
    with pytest.raises(ValueError, match=known):
        cl.ImpactModel(cl.Pair(quicker, "glass"), table=own.table)
    assert main(["table", "info", str(path)]) == 0
    assert "strengths up to 1.332 times: " in " ".join(capsys.readouterr().out.split())


def test_a_damaged_table_is_refused(tmp_path):
    """Of laws of several strengths, too, kernels follow addresses."""
    laws = MODEL.table.law.at_any_strength
    force.check_strengths(laws)
    for entry, value in ((1 + force.BEGINS, 1e9), (1 + force.SIZE, 1e9), (0, -1e9)):
        damaged = laws.copy()
        damaged[entry] = value
        with pytest.raises(ValueError, match="its law"):
            force.check_strengths(damaged)


def test_other_laws_know_no_rate():
    plain = cl.Pair(dataclasses.replace(kinds.COPPER, rate=None), "glass")
    given = [1e-3, 0.1, 1.0], R, 3e-3
    for law in ("myc", "jackson_green", "fem(500,0,0.4,0.3,0.2)"):
        with_rate, without = (cl.ImpactModel(one, law) for one in (PAIR, plain))
        assert (with_rate.solve(*given).restitution == without.solve(*given).restitution).all()


def test_a_rate0_that_no_impact_reaches_is_no_rate():
    slow = dataclasses.replace(kinds.STEEL, rate=(0.05, 6e5))
    one = cl.ImpactModel(cl.Pair(slow, "glass"))
    plain = cl.ImpactModel(cl.Pair(dataclasses.replace(kinds.STEEL, rate=None), "glass"))
    assert one.restitution(3.0, R, 5 * R) == plain.restitution(3.0, R, 5 * R) > 0.5


def test_no_impacts_have_empty_answers():
    one = MODEL
    assert one.lookup([], R, R).restitution.shape == (0,)
    assert one.force_history([], R, R, samples=3).force.shape == (0, 3)
    assert one.sensitivity([], R, R).speed.shape == (0,)
    assert one.solve([], R, R).flags.shape == (0,)
    assert one.force_history([], R, R, samples=3, method="solve").force.shape == (0, 3)

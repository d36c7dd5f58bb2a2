"""ImpactModel: SI in, SI out, from the table and from the solver."""

import math
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws, table

R, H = 0.9e-3, 1e-3
ALUMINA = cl.Pair("gamma-alumina", "glass")  # of the fixture `model`


@pytest.fixture(scope="module")
def small_table():
    return table.build(laws.law("myc"), table.Settings(largest_inelasticity=1.0, largest_overload=5.0))


def test_shapes(model):
    """Broadcasting, and types; arrays of any shape are in tests/answers/test_shapes.py."""
    assert isinstance(model.restitution(5.0, R, H), float)
    assert isinstance(model.restitution(5, np.float64(R), np.array(H)), float)
    assert {type(curve(np.array(5))) for curve in (model.curve(R, H), model.sphere_sphere_curve(R, R))} == {float}
    assert model.restitution(np.ones((3, 1)), [R, R], H).shape == (3, 2)
    assert model.restitution(np.float32([5.0]), R, H).dtype == np.float64
    assert isinstance(model.lookup(5.0, R, H).flags, cl.Validity)


REFUSALS = [
    *(
        (lambda m, method=method, impact=impact: getattr(m, method)(*impact), rf"^{name}: got .*must lie .*m")
        for method in ("restitution", "lookup", "solve")
        for name, *impact in (
            ("speed", 1e6, R, H),
            ("speed", math.inf, R, H),
            ("radius", 5.0, 1e6, H),
            ("radius", 5.0, 1e-12, H),
            ("thickness", 5.0, R, 1e-12),
        )
    ),
    *(
        (lambda m, method=method, speed=speed: getattr(m, method)(speed, R, H), f"impact {place} is outside the table")
        for method in ("restitution", "lookup", "force_history", "sensitivity")
        for speed, place in (([1.0, 2.0, 500.0, 3000.0], 3), ([[1.0, 2.0, 3.0], [4.0, 3000.0, 3000.0]], 4), (3000.0, 0))
    ),
    (lambda m: m.restitution([1.0, 2.0, -3.0], R, H), r"speed: got .*-3.0.* \(element 2\)"),
    (lambda m: m.restitution(np.ones(3), np.full(2, R), H), r"do not broadcast: speed \(3,\), radius \(2,\)"),
    (lambda m: m.restitution(5.0, 5e-3, 0.3e-3), r"lambda = .* above 5.*too thin.*outside=\"solve\""),
    (lambda m: m.lookup(1e4, R, H), r"chi = .* above 40.*too fast"),
    *(
        (lambda m, rtol=rtol: m.solve(5.0, R, H, rtol=rtol), "rtol: got .*must be a float")
        for rtol in (0.0, 1e-5, math.nan)
    ),
    *((lambda m, bad=bad: m.curve(R, H)(bad), "speed: got .*expected one number") for bad in ([5.0, 6.0], [])),
    (lambda m: m.curve(-1.0, H), "radius: got -1.0"),
    (lambda m: m.curve([R], H), "radius: got .*expected one number"),
    (lambda m: m.sphere_sphere_curve(R, [R]), "other_radius: got .*expected one number"),
    (lambda m: cl.ImpactModel(ALUMINA, law="mcy"), "law: got 'mcy'; unknown law; did you mean 'myc'"),
    (lambda m: cl.ImpactModel(ALUMINA, outside="ignore"), "outside: got 'ignore'; must be 'raise', 'solve' or 'clamp'"),
    (
        lambda m: cl.ImpactModel(cl.Pair("glass", "stainless-steel-304"), law="myc"),
        r"glass.*law=\"fem\".*yield_strength",
    ),
    (lambda m: cl.restitution_sphere_sphere("glass", "glass", 5.0, R, R, law="myc"), "yield"),
    (lambda m: cl.restitution_sphere_sphere("gamma-alumina", "glass", 5.0, R, -R), "other_radius: got"),
]


@pytest.mark.parametrize(("call", "message"), REFUSALS)
def test_what_is_refused_and_how(call, message, model):
    with pytest.raises(ValueError, match=message):
        call(model)


def test_a_pair_of_another_kind_is_refused():
    with pytest.raises(TypeError, match="pair: expected a contactlaw.Pair"):
        cl.ImpactModel(("gamma-alumina", "glass"), law="myc")


@pytest.mark.parametrize("method", ["restitution", "lookup"])
def test_the_impact_that_does_not_solve_is_named_by_its_place(pair, method):
    ask = getattr(cl.ImpactModel(pair, law="myc", outside="solve"), method)
    with pytest.raises(RuntimeError, match=r"did not solve .*\(element 3\)"):
        # 1 and 3 are outside the table
        ask([5.0, 5.0, 5.0, 1e3], [R, 5e-3, R, 1.0], [H, 0.3e-3, H, 0.01])


def test_outside_is_solved_or_has_the_value_at_the_border(pair, small_table):
    """That each method obeys `outside` is in tests/answers/test_outside.py."""
    solving, clamping = (cl.ImpactModel(pair, "myc", small_table, outside) for outside in ("solve", "clamp"))
    speeds = np.linspace(20, 200, 2001)
    hit = solving.solve(speeds, R, math.inf, rtol=1e-10)
    assert solving.curve(R, math.inf)(200.0) == hit.restitution[-1]
    border = hit.restitution[hit.overload < 5.0][-1]  # the largest speed inside the table
    assert clamping.restitution(300.0, R, math.inf) == pytest.approx(border, abs=1e-3)


def test_threads_lose_no_count(pair, small_table):
    model = cl.ImpactModel(pair, law="myc", table=small_table, outside="clamp")
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)  # a thread may be interrupted between any two instructions
    try:
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda n: model.lookup([200.0, 5.0, 200.0], R, H), range(1000)))
    finally:
        sys.setswitchinterval(interval)
    assert model.clamped == 2000
    twin = pickle.loads(pickle.dumps(model))
    twin.restitution(200.0, R, H)
    assert (twin.clamped, model.clamped) == (1, 2000)


def test_hertz_needs_no_yield_strength(model):
    elastic = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    hit = elastic.lookup(50.0, R, H)
    assert hit.plastic_fraction == hit.overload == 0.0 and elastic.yield_speed(R, H) == math.inf
    below_yield = cl.ImpactModel(model.pair, law="hertz").restitution(2.0, R, H)
    assert below_yield == pytest.approx(model.restitution(2.0, R, H), rel=2e-15)


def test_a_callers_disk_cache_keeps_no_table(tmp_path):
    """A user's cached loop over one model must not answer for another one's."""
    (tmp_path / "user.py").write_text(
        "import sys, warnings, numba, contactlaw as cl\n"
        "warnings.simplefilter('ignore')  # numba cannot cache the loop\n"
        "model = cl.ImpactModel(cl.Pair(sys.argv[1], 'glass'))\n"
        "cor = model.kernel\n"
        "@numba.njit(cache=True)\n"
        "def loop(v): return cor(v, 1e-3, 1e-3)\n"
        "print(loop(0.5) - model.restitution(0.5, 1e-3, 1e-3))\n"
    )
    for sphere in ("gamma-alumina", "nylon-66"):
        command = [sys.executable, str(tmp_path / "user.py"), sphere]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        assert abs(float(done.stdout)) < 1e-12, sphere


def test_sphere_on_sphere(model):
    bead = model.pair.sphere
    # by hand: bulk impact, v = V/V_Y0 with R* = R/2, m* = m/2 and E* of the twins
    twins = cl.Pair(bead, bead)
    strain = math.pi * bead.yield_strength / twins.effective_modulus
    k = 4 / 3 * twins.effective_modulus * math.sqrt(R / 2)
    mass = 4 / 3 * math.pi * R**3 * bead.density / 2
    v_y0 = math.sqrt(0.8 * k * (0.68 * strain**2 * R / 2) ** 2.5 / mass)
    v = np.array([0.5, 1.5, 4.0])
    expected = np.where(v < 1, 1.0, (1 - (1 - np.maximum(v, 1) ** -0.8) ** 2) ** 0.25)
    hit = model.lookup_sphere_sphere(v * v_y0, R, R)
    assert hit.restitution == pytest.approx(expected, abs=5e-5)
    assert cl.restitution_sphere_sphere(bead, bead, v * v_y0, R, R, law="myc").tolist() == hit.restitution.tolist()
    assert model.sphere_sphere_curve(R, R)(1.5 * v_y0) == pytest.approx(hit.restitution[1], rel=1e-13)
    assert hit.plastic_fraction == pytest.approx(1 - expected**2, abs=1e-3)
    assert (hit.wave_fraction == 0).all()
    soft_plate = cl.ImpactModel(cl.Pair("bearing-steel-52100", "ptfe"), law="myc")
    assert soft_plate.lookup_sphere_sphere(0.1, R, R).flags == 0  # there is no plate
    forth = cl.restitution_sphere_sphere("gamma-alumina", "glass", 20.0, 1e-3, 2e-3)
    back = cl.restitution_sphere_sphere("glass", "gamma-alumina", 20.0, 2e-3, 1e-3)
    assert 0 < forth == back < 1

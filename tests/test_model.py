"""ImpactModel: SI in, SI out, from the table and from the solver."""

import dataclasses
import math
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.equation import zener
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import TwoSpheres
from contactlaw.physical.law import law_of

R, H = 0.9e-3, 1e-3
NOT_POSITIVE = [-1.0, 0.0, math.nan, -math.inf, "5", "five", None, True, 1j, [1.0, -1.0]]
NOT_POSITIVE += [np.ma.masked_array([5.0, 6.0], mask=[0, 1])]


@pytest.fixture(scope="module")
def small_table():
    return table.build(laws.law("myc"), table.Settings(largest_inelasticity=1.0, largest_overload=5.0))


def test_at_the_yield_speed_the_compression_is_the_yield_compression(model):
    radius, thickness = np.array([0.5e-3, 0.9e-3, 2e-3]), np.array([0.5e-3, 0.5e-3, 5e-3])
    hit = model.solve(model.yield_speed(radius, thickness), radius, thickness, rtol=1e-10)
    strain = math.pi * model.pair.sphere.yield_strength / model.pair.effective_modulus
    assert hit.peak_compression == pytest.approx(0.68 * strain**2 * radius, rel=1e-9)
    assert hit.overload == pytest.approx(1.0, rel=1e-9)


def test_shapes(model):
    assert isinstance(model.restitution(5.0, R, H), float)
    assert isinstance(model.restitution(5, np.float64(R), np.array(H)), float)
    assert model.restitution([5.0], R, H).shape == (1,)
    assert model.restitution(np.ones((3, 1)), [R, R], H).shape == (3, 2)
    assert model.restitution(np.float32([5.0]), R, H).dtype == np.float64
    assert model.restitution(np.empty(0), R, H).shape == (0,)
    hit = model.lookup([[5.0], [6.0]], R, H)
    assert {np.shape(values) for values in vars(hit).values()} == {(2, 1)}
    assert isinstance(model.lookup(5.0, R, H).flags, cl.Validity)


def test_strided_input_is_taken_as_it_reads(model):
    speed = np.arange(1.0, 21.0)[::-2]
    speed.flags.writeable = False
    each = [model.restitution(v, R, H) for v in speed]
    np.testing.assert_allclose(model.restitution(speed, R, H), each, rtol=0, atol=2e-11)


@pytest.mark.parametrize("method", ["restitution", "lookup", "solve"])
@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("speed", 1e6),
        ("speed", math.inf),
        ("radius", 1e6),
        ("radius", math.inf),
        ("radius", 1e-12),
        ("thickness", 1e-12),
    ],
)
def test_huge_and_tiny_numbers_are_refused(model, method, name, bad):
    good = {"speed": 5.0, "radius": R, "thickness": H}
    with pytest.raises(ValueError, match=rf"^{name}: got .*must lie .*m"):
        getattr(model, method)(**{**good, name: bad})


def test_the_element_at_fault_is_named(model):
    with pytest.raises(ValueError, match=r"speed: got .*-3.0.* \(element 2\)"):
        model.restitution([1.0, 2.0, -3.0], R, H)


def test_shapes_that_do_not_broadcast(model):
    with pytest.raises(ValueError, match=r"do not broadcast: speed \(3,\), radius \(2,\)"):
        model.restitution(np.ones(3), np.full(2, R), H)


def test_outside_raise(model):
    with pytest.raises(ValueError, match=r"lambda = .* above 5.*too thin.*outside=\"solve\""):
        model.restitution(5.0, 5e-3, 0.3e-3)
    with pytest.raises(ValueError, match=r"chi = .* above 40.*too fast"):
        model.lookup(1e4, R, H)


@pytest.mark.parametrize("method", ["restitution", "lookup", "force_history", "sensitivity"])
def test_the_impact_outside_is_named_by_its_place(model, method):
    ask = getattr(model, method)
    with pytest.raises(ValueError, match="impact 3 is outside the table"):
        ask([1.0, 2.0, 500.0, 3000.0], R, H)
    with pytest.raises(ValueError, match="impact 4 is outside the table"):
        ask(np.array([[1.0, 2.0, 3.0], [4.0, 3000.0, 3000.0]]), R, H)
    with pytest.raises(ValueError, match="impact 0 is outside the table"):
        ask(3000.0, R, H)


@pytest.mark.parametrize("method", ["restitution", "lookup"])
def test_the_impact_that_does_not_solve_is_named_by_its_place(pair, method):
    ask = getattr(cl.ImpactModel(pair, law="myc", outside="solve"), method)
    with pytest.raises(RuntimeError, match=r"did not solve .*\(element 3\)"):
        # 1 and 3 are outside the table
        ask([5.0, 5.0, 5.0, 1e3], [R, 5e-3, R, 1.0], [H, 0.3e-3, H, 0.01])


def test_outside_solve(pair, small_table):
    model = cl.ImpactModel(pair, law="myc", table=small_table, outside="solve")
    inside, thin, fast = (5.0, R, H), (5.0, R, R / 8), (200.0, R, H)
    arrays = [np.array(column) for column in zip(inside, thin, fast, strict=True)]
    exact = model.solve(*arrays, rtol=1e-10)
    assert exact.inelasticity[1] > 1.0
    assert exact.overload[2] > 5.0
    np.testing.assert_array_equal(model.lookup(*arrays).restitution[1:], exact.restitution[1:])
    np.testing.assert_array_equal(model.restitution(*arrays)[1:], exact.restitution[1:])
    assert model.curve(R, H)(200.0) == exact.restitution[2]


def test_outside_clamp_is_counted_and_flagged(pair, small_table):
    model = cl.ImpactModel(pair, law="myc", table=small_table, outside="clamp")
    hit = model.lookup([5.0, 200.0], R, H)
    assert [bool(f & cl.Validity.CLAMPED) for f in hit.flags] == [False, True]
    assert model.clamped == 1
    # Every answer has a closed balance of energy, whatever the arguments.
    for speed, thickness in ((200.0, H), (9e3, 5e-5), (5.0, R / 12), (9e3, math.inf)):
        hit = model.lookup(speed, R, thickness)
        parts = hit.restitution**2, hit.plastic_fraction, hit.wave_fraction
        assert sum(parts) == pytest.approx(1.0, abs=1e-5)
        assert all(0 <= part <= 1 for part in parts)
    model.clamped = 1
    # the border value: the largest speed inside the table has chi = 5
    top = cl.ImpactModel(pair, law="myc", table=small_table)
    speeds = np.linspace(20, 200, 2001)
    inside = speeds[top.solve(speeds, R, math.inf).overload < 5.0]
    border = top.restitution(inside[-1], R, math.inf)
    assert model.restitution(300.0, R, math.inf) == pytest.approx(border, abs=1e-3)
    assert model.clamped == 2


def test_threads_lose_no_count(pair, small_table):
    model = cl.ImpactModel(pair, law="myc", table=small_table, outside="clamp")
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)  # a thread may be interrupted between any two instructions
    try:
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda n: model.lookup([200.0, 5.0, 200.0], R, H), range(4000)))
    finally:
        sys.setswitchinterval(interval)
    assert model.clamped == 8000
    twin = pickle.loads(pickle.dumps(model))
    twin.restitution(200.0, R, H)
    assert (twin.clamped, model.clamped) == (1, 8000)


def test_hertz_needs_no_yield_strength(model):
    elastic = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    hit = elastic.lookup(50.0, R, H)
    assert hit.plastic_fraction == 0.0
    assert hit.overload == 0.0
    assert hit.restitution == pytest.approx(elastic.solve(50.0, R, H).restitution, abs=1e-6)
    assert elastic.yield_speed(R, H) == math.inf
    # Below yield the two laws agree.
    same = cl.ImpactModel(model.pair, law="hertz")
    assert same.restitution(2.0, R, H) == pytest.approx(model.restitution(2.0, R, H), rel=2e-15)


def test_a_bead_without_yield_strength_is_refused():
    with pytest.raises(ValueError, match=r"glass.*law=\"fem\".*yield_strength"):
        cl.ImpactModel(cl.Pair("glass", "stainless-steel-304"), law="myc")
    cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"), law="myc")  # the plate may be brittle


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"law": "mcy"}, "law: got 'mcy'; unknown law; did you mean 'myc'"),
        ({"outside": "ignore"}, "outside: got 'ignore'; must be 'raise', 'solve' or 'clamp'"),
    ],
)
def test_wrong_options(pair, arguments, message):
    with pytest.raises(ValueError, match=message):
        cl.ImpactModel(pair, **arguments)


def test_a_pair_is_needed():
    with pytest.raises(TypeError, match="pair: expected a contactlaw.Pair"):
        cl.ImpactModel(("gamma-alumina", "glass"), law="myc")


def test_settings_of_a_finer_table_are_taken(pair, model, tmp_path, monkeypatch):
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(tmp_path))
    wide = table.Settings(largest_overload=100.0)
    speed = 240 * pair.yield_speed
    with pytest.raises(ValueError, match="outside the table"):
        model.restitution(speed, R, math.inf)
    ours = cl.ImpactModel(pair, law="myc", table=wide).restitution(speed, R, math.inf)
    assert ours == pytest.approx(model.solve(speed, R, math.inf).restitution, abs=1e-6)
    assert [path.suffix for path in tmp_path.glob("*.h5")] == [".h5"]


@pytest.mark.parametrize("bodies", [("lead", "stainless-steel-304-ball"), ("natural-rubber", "aluminium-2024-t3")])
@pytest.mark.parametrize("rtol", [1e-13, 1e-10, 1e-6])
def test_energies_add_up(bodies, rtol):
    """Of 60 pairs of the catalogue these had the largest errors."""
    rng, n = np.random.default_rng(0), 200
    speed, radius = 10 ** rng.uniform(-1.5, 1.5, n), 10 ** rng.uniform(-3.5, -2.0, n)
    thickness = radius * 10 ** rng.uniform(-0.5, 1.2, n)
    hit = cl.ImpactModel(cl.Pair(*bodies), outside="solve").solve(speed, radius, thickness, rtol=rtol)
    energies = hit.restitution**2 + hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
    np.testing.assert_allclose(energies, 1.0, atol=500 * rtol)


@pytest.mark.parametrize("rtol", [0.0, 1e-5, math.nan, -1e-8, "fine"])
def test_solve_refuses_a_tolerance_out_of_range(model, rtol):
    with pytest.raises(ValueError, match="rtol: got .*must be a float between"):
        model.solve(5.0, R, H, rtol=rtol)


@pytest.mark.parametrize("bad", [[5.0, 6.0], [], np.array([5.0])], ids=repr)
def test_a_curve_is_for_one_number(model, bad):
    with pytest.raises(ValueError, match="speed: got .*expected one number"):
        model.curve(R, H)(bad)
    with pytest.raises(ValueError, match="radius: got -1.0"):
        model.curve(-1.0, H)
    with pytest.raises(ValueError, match="radius: got .*expected one number"):
        model.curve(bad, H)
    with pytest.raises(ValueError, match="other_radius: got .*expected one number"):
        model.sphere_sphere_curve(R, bad)


def test_a_curve_takes_any_kind_of_number(model):
    for curve in (model.curve(R, H), model.sphere_sphere_curve(R, R)):
        for speed in (5, np.float64(5.0), np.float32(5.0), np.int64(5), np.array(5.0)):
            assert curve(speed) == curve(5.0)
            assert type(curve(speed)) is float


def test_what_was_given_cannot_be_changed(model):
    for name in ("pair", "law", "outside"):
        with pytest.raises(AttributeError):
            setattr(model, name, getattr(model, name))


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
    e = cl.restitution_sphere_sphere(bead, bead, v * v_y0, R, R, law="myc")
    assert e == pytest.approx(expected, abs=5e-5)
    hit = model.lookup_sphere_sphere(v * v_y0, R, R)
    np.testing.assert_array_equal(hit.restitution, e)
    assert hit.plastic_fraction == pytest.approx(1 - expected**2, abs=1e-3)
    assert (hit.wave_fraction == 0).all()
    soft_plate = cl.ImpactModel(cl.Pair("bearing-steel-52100", "ptfe"), law="myc")
    assert soft_plate.lookup_sphere_sphere(0.1, R, R).flags == 0  # there is no plate
    assert model.sphere_sphere_curve(R, R)(1.5 * v_y0) == pytest.approx(e[1], rel=1e-13)


def test_two_spheres_have_the_law_that_was_named(pair, model):
    """A law that depends on E*/sigma_Y has other numbers for two spheres than for the pair."""
    named, own = "jackson_green(23.2,0.21)", "jackson_green(23.1922,0.21)"
    # tables are one below yield
    tables = {name: dataclasses.replace(model.table, law=laws.law(name)) for name in (named, own)}
    taking = cl.ImpactModel(pair, law="jackson_green", table=tables[own])
    assert taking.law == own
    twins = cl.Pair(pair.sphere, pair.sphere)
    law = law_of(twins, "jackson_green")
    assert law.name.startswith("jackson_green(13.5")
    units = TwoSpheres(twins, law).numbers(Impact(25.0, 0.5 * R, math.inf, 4.0))
    exact = zener.solve(law.data, 0.0, units.yield_ratio.item(), 1e-11).restitution
    for one in (taking, pickle.loads(pickle.dumps(taking))):
        assert one.lookup_sphere_sphere(25.0, R, R).restitution == pytest.approx(exact, abs=1e-6)
        assert one.sphere_sphere_curve(R, R)(25.0) == pytest.approx(exact, abs=1e-6)
    assert abs(exact - taking.solve(25.0, R, math.inf).restitution) > 0.02  # of the other law

    given = cl.ImpactModel(pair, law=named, table=tables[named])
    hit = given.lookup_sphere_sphere(0.5, R, R)
    mass = 4 / 3 * math.pi * R**3 * pair.sphere.density / 2
    stiffness = 4 / 3 * twins.effective_modulus * math.sqrt(R / 2)
    peak = (5 / 4 * mass * 0.5**2 / stiffness) ** 0.4  # Hertz
    assert hit.peak_compression == pytest.approx(peak, rel=1e-6)
    assert given.sphere_sphere_curve(R, R)(0.5) == hit.restitution


def test_sphere_on_sphere_is_symmetric():
    arguments = ("gamma-alumina", "glass", 20.0, 1e-3, 2e-3)
    swapped = ("glass", "gamma-alumina", 20.0, 2e-3, 1e-3)
    ours = cl.restitution_sphere_sphere(*arguments)
    assert 0 < ours < 1
    assert cl.restitution_sphere_sphere(*swapped) == ours
    with pytest.raises(ValueError, match="yield"):
        cl.restitution_sphere_sphere("glass", "glass", 5.0, R, R, law="myc")
    with pytest.raises(ValueError, match="other_radius: got"):
        cl.restitution_sphere_sphere("gamma-alumina", "glass", 5.0, R, -R)


def test_batches_of_every_length(model):
    # the batch works in chunks; one bad impact sends its chunk another way
    rng = np.random.default_rng(4)
    speed = rng.uniform(0.1, 60, 1100)
    exact = model.lookup(speed, R, H).restitution
    for n in (1, 511, 512, 513, 1100):
        np.testing.assert_allclose(model.restitution(speed[:n], R, H), exact[:n], atol=2e-11)
    solving = cl.ImpactModel(model.pair, law="myc", outside="solve")
    speed[700] = 9000.0
    mixed = solving.restitution(speed, R, math.inf)
    assert mixed[700] == solving.solve(9000.0, R, math.inf, rtol=1e-10).restitution
    others = np.arange(1100) != 700
    fine = model.restitution(speed[others], R, math.inf)
    np.testing.assert_allclose(mixed[others], fine, rtol=0, atol=2e-11)

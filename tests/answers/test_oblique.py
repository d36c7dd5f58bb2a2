"""Oblique impacts: table against integration, mechanics that hold whatever the law, refusals."""

import kinds
import numba
import numpy as np
import polymer
import pytest

import contactlaw as cl

PAIRS = {
    "myc": cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"),
    "fem": cl.ImpactModel(cl.Pair("alumina", "aluminium-6061-t6")),
    "hertz": cl.ImpactModel(cl.Pair("alumina", "glass"), law="hertz"),
    "losses and flow": polymer.WEAK_MODEL,
    "rate": kinds.model("rate of the sphere"),
}
REST = np.zeros(3)


def impacts(count, seed=0):
    """Normal and sliding speeds, radii, thicknesses and coefficients of friction."""
    generator = np.random.default_rng(seed)
    speed = 10 ** generator.uniform(-1, 0.8, count)
    friction = generator.uniform(0.02, 0.6, count)
    sliding = generator.uniform(0, 12, count) * friction * speed
    radius = 10 ** generator.uniform(-3.3, -2.3, count)
    return speed, sliding, radius, radius * 10 ** generator.uniform(0, 1.5, count), friction


@pytest.mark.parametrize(
    "law", ["myc", "losses and flow", *(pytest.param(law, marks=pytest.mark.long) for law in ("fem", "hertz"))]
)
def test_table_is_within_its_promise(law):
    model, (v, s, r, h, mu) = PAIRS[law], impacts(1000)
    table, solved = (model.oblique(v, s, r, h, mu, method=how) for how in ("table", "solve"))
    error = np.abs(table.sliding_speed - solved.sliding_speed) / (mu * v)
    assert error.max() < 2e-3
    assert np.median(error) < 2e-4


@pytest.mark.parametrize("method", ["table", "solve"])
def test_fields_belong_together(method):
    model, (v, s, r, h, mu) = PAIRS["myc"], impacts(200)
    hit = model.oblique(v, s, r, h, mu, method=method)
    mass = 4 / 3 * np.pi * model.pair.sphere.density * r**3
    pulled = hit.impulse_ratio * mass * v * (1 + hit.restitution)
    assert s - 3.5 * pulled / mass == pytest.approx(hit.sliding_speed, rel=1e-12, abs=1e-12)
    assert hit.rotational_restitution == pytest.approx(-hit.sliding_speed / s, rel=1e-12)
    assert hit.tangential_restitution == pytest.approx(1 - pulled / mass / s, rel=1e-12)
    # what the tangential motion of centre and spin loses, if the bead came without spin
    spin = 2.5 * pulled / mass / r
    kinetic = 0.5 * mass * (s * hit.tangential_restitution) ** 2 + 0.2 * mass * (r * spin) ** 2
    assert 0.5 * mass * s**2 - kinetic == pytest.approx(hit.friction_energy, rel=1e-9)
    shares = hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
    assert 1 - hit.restitution**2 == pytest.approx(shares, abs=1e-5)
    assert (np.abs(hit.impulse_ratio) <= mu * (1 + 1e-9)).all()
    assert (hit.friction_energy >= 0).all()
    # the normal part is that of an impact without friction
    normal = model.lookup(v, r, h) if method == "table" else model.solve(v, r, h, rtol=1e-10)
    assert np.array_equal(hit.restitution, normal.restitution)


def test_no_random_impact_makes_energy():
    for model in PAIRS.values():
        v, s, r, h, mu = impacts(100_000, seed=1)
        hit = model.oblique(v, s, r, h, mu)
        assert (hit.friction_energy >= 0).all()


def test_no_friction_no_sliding_and_grazing():
    model = PAIRS["myc"]
    none = model.oblique(2.0, 1.0, 1e-3, 3e-3, 0.0)
    assert (none.sliding_speed, none.friction_energy, none.impulse_ratio) == (1.0, 0.0, 0.0)
    assert none.tangential_restitution == 1.0
    still = model.oblique(2.0, 0.0, 1e-3, 3e-3, 0.3)
    assert (still.sliding_speed, still.friction_energy, still.impulse_ratio) == (0.0, 0.0, 0.0)
    assert np.isnan(still.tangential_restitution) and np.isnan(still.rotational_restitution)
    grazing = model.oblique(1e-9, 5.0, 1e-3, 3e-3, 0.3)
    change = 3.5 * 0.3 * 1e-9 * (1 + grazing.restitution)
    assert 5.0 - grazing.sliding_speed == pytest.approx(change, rel=1e-6)
    back = model.oblique(2.0, [-1.0, 1.0], 1e-3, 3e-3, 0.3)
    assert back.sliding_speed[0] == -back.sliding_speed[1]


def random_beads(count):
    generator = np.random.default_rng(3)
    velocity, normal = generator.normal(size=(2, count, 3))
    return velocity, generator.normal(size=(count, 3)) * 500, normal


@pytest.mark.parametrize("law", ["myc", "losses and flow", "rate"])
def test_collide_keeps_momenta_and_agrees_with_oblique(law):
    model, count = PAIRS[law], 1000
    velocity, spin, normal = random_beads(count)
    wall = np.random.default_rng(4).normal(size=(count, 3)) * 0.3
    radius, thickness, friction = 1e-3, 4e-3, 0.25
    new, turned = model.collide(velocity, spin, normal, radius, thickness, friction, wall)
    n = normal / np.linalg.norm(normal, axis=1)[:, None]
    speed = -((velocity - wall) * n).sum(axis=1)
    hits = speed > 0
    assert 300 < hits.sum() < 700
    assert np.array_equal(new[~hits], velocity[~hits])
    assert np.array_equal(turned[~hits], spin[~hits])

    def point(v, omega):
        """Velocity of the contact point along the plate."""
        at = v - wall - radius * np.cross(omega, n)
        return at - (at * n).sum(axis=1)[:, None] * n

    # all forces act at the contact point: no change of the angular momentum about it
    shift = np.cross(-radius * n, new - velocity) - 0.4 * radius**2 * (turned - spin)
    assert np.abs(shift).max() < 1e-15
    before, after = point(velocity, spin)[hits], point(new, turned)[hits]
    size = np.linalg.norm(before, axis=1)
    hit = model.oblique(speed[hits], size, radius, thickness, friction)
    assert (after * before).sum(axis=1) / size == pytest.approx(hit.sliding_speed, abs=1e-9)
    up = ((new - wall) * n).sum(axis=1)[hits]
    assert up == pytest.approx(hit.restitution * speed[hits], rel=1e-9)


def test_kernel_is_collide():
    model = PAIRS["myc"]
    velocity, spin, normal = random_beads(50)
    ours = model.collide(velocity, spin, normal, 1e-3, 4e-3, 0.25)
    collide = model.collide_kernel

    @numba.njit
    def one(v, omega, n):
        return collide(
            (v[0], v[1], v[2]), (omega[0], omega[1], omega[2]), (n[0], n[1], n[2]), 1e-3, 4e-3, 0.25, (0.0, 0.0, 0.0)
        )

    for n in range(50):
        new, turned = one(velocity[n], spin[n], normal[n])
        assert new == pytest.approx(ours[0][n], rel=1e-13)
        assert turned == pytest.approx(ours[1][n], rel=1e-13)
    down, up = (0.0, 0.0, -1e3), (0.0, 0.0, 1.0)
    assert np.isnan(collide(down, (0.0, 0.0, 0.0), up, 1e-3, 4e-3, 0.25, (0.0, 0.0, 0.0))[0][2])


def test_shapes():
    model = PAIRS["myc"]
    new, spin = model.collide(REST - [0, 0, 1], REST, [0, 0, 2], [[1e-3], [2e-3]], [3e-3] * 4, 0.1)
    assert new.shape == spin.shape == (2, 4, 3)
    assert model.collide([1, 0, -1], REST, [0, 0, 1], 1e-3, 3e-3, 0.1)[0].shape == (3,)
    hit = model.oblique(1.0, [[0.1], [0.2]], 1e-3, [1e-3, 2e-3, 3e-3], 0.1)
    assert hit.sliding_speed.shape == hit.restitution.shape == (2, 3)


@pytest.mark.parametrize("length", [5e-324, 1e-200, 1e200])
def test_a_normal_of_any_length(length):
    model, v, rest = PAIRS["myc"], (0.5, 0.0, -1.0), (0.0, 0.0, 0.0)
    usual, turned = model.collide(v, 0, [0, 0, 1], 1e-3, 3e-3, 0.1)
    new, spin = model.collide(v, 0, [0, 0, length], 1e-3, 3e-3, 0.1)
    assert np.array_equal((new, spin), (usual, turned))
    one = model.collide_kernel(v, rest, (0.0, 0.0, length), 1e-3, 3e-3, 0.1, rest)
    assert one == (pytest.approx(usual, rel=1e-13), pytest.approx(turned, rel=1e-13))


@pytest.mark.parametrize("x", [0.0, 0.5, 1e200])
@pytest.mark.parametrize("friction", [-0.1, np.nan, 1001.0])
def test_kernel_gives_nan_for_bad_input(x, friction):
    rest = (0.0, 0.0, 0.0)
    given = (x, 0.0, -1.0), rest, (0.0, 0.0, 1.0), 1e-3, 3e-3
    assert np.isnan(PAIRS["myc"].collide_kernel(*given, friction, rest)).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("method", ["table", "solve"])
def test_next_to_no_friction(method):
    hit = PAIRS["myc"].oblique(1.0, [5.0, 1e-3], 1e-3, 3e-3, 1e-310, method=method)
    assert np.array_equal(hit.sliding_speed, [5.0, 1e-3])


def test_outside_the_table():
    v, thin = [0, 0, -1.0], 2e-5
    model = PAIRS["myc"]
    with pytest.raises(ValueError, match="outside the table"):
        model.collide(v, REST, [0, 0, 1], 1e-3, thin, 0.1)
    solving = cl.ImpactModel(model.pair, law="myc", outside="solve")
    hit = solving.oblique(1.0, 0.5, 1e-3, [thin, 3e-3], 0.1)
    solved = solving.oblique(1.0, 0.5, 1e-3, [thin, 3e-3], 0.1, method="solve")
    assert hit.sliding_speed == pytest.approx(solved.sliding_speed, abs=2e-4)
    new, _ = solving.collide([0.5, 0, -1.0], REST, [0, 0, 1], 1e-3, [thin, 3e-3], 0.1)
    assert new[:, 2] == pytest.approx(hit.restitution, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"friction": -0.1}, "friction: got -0.1"),
        ({"friction": np.nan}, "friction: got nan"),
        ({"sliding_speed": np.inf}, "sliding_speed: got inf"),
        ({"speed": 0.0}, "speed: got 0.0"),
        ({"method": "sovle"}, "method: got 'sovle'; must be 'table' or 'solve'"),
    ],
)
def test_oblique_refuses(change, match):
    given = {"speed": 1.0, "sliding_speed": 1.0, "radius": 1e-3, "thickness": 1e-3, "friction": 0.1}
    with pytest.raises(ValueError, match=match):
        PAIRS["myc"].oblique(**(given | change))


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"velocity": [1.0, 2.0]}, "velocity: expected vectors of three numbers"),
        ({"spin": [np.nan, 0, 0]}, "spin: got .*must be finite"),
        ({"normal": [0, 0, 0]}, "normal: got .*must not be zero"),
        ({"velocity": np.zeros((2, 3)), "spin": np.zeros((4, 3))}, "shapes do not broadcast"),
        ({"radius": -1.0}, "radius: got -1.0"),
        ({"friction": "a"}, "friction: got .a.; expected a number"),
        ({"velocity": -1.0}, "velocity: expected vectors of three numbers"),
        ({"velocity": [1e200, 0, -1]}, "sliding_speed: got inf"),
        ({"velocity": [0, 0, -1e6]}, "speed: got 1000000.0"),
    ],
)
def test_collide_refuses(change, match):
    given = {
        "velocity": [0, 0, -1.0],
        "spin": REST,
        "normal": [0, 0, 1.0],
        "radius": 1e-3,
        "thickness": 3e-3,
        "friction": 0.1,
    }
    with pytest.raises(ValueError, match=match):
        PAIRS["myc"].collide(**(given | change))

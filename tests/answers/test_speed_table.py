"""The rows against trying all choices, and their error against the model itself."""

import math
from itertools import combinations

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws
from contactlaw.answers.speed_table import longest_lines

R, H = 0.9e-3, 1e-3
RNG = np.random.default_rng(5)
X = np.sort(RNG.uniform(0, 1, 13))
# Curves: convex, of changing curvature, with a corner, and random.
CURVES = {
    "root": np.sqrt(X),
    "wave": np.sin(9 * X),
    "corner": np.abs(X - X[5]),
    "noise": RNG.uniform(0, 1, X.size),
    "step": np.where(X > 0.4, 1.0, 0.0),
}


def largest_miss(x, y, rows):
    return np.abs(np.interp(x, x[rows], y[rows]) - y).max()


@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("error", [0.005, 0.05, 0.2])
def test_no_choice_has_less_than_half_of_the_rows(curve, error):
    """All choices of points are tried by brute force; of convex curves none has fewer rows."""
    y = CURVES[curve]
    rows = longest_lines(X, y, error)
    assert largest_miss(X, y, rows) <= error * (1 + 1e-12)
    inner = range(1, X.size - 1)
    fewest = next(
        count
        for count in range(X.size - 1)
        for chosen in combinations(inner, count)
        if largest_miss(X, y, [0, *chosen, X.size - 1]) <= error * (1 + 1e-12)
    )
    assert len(rows) - 2 <= (fewest if curve in ("root", "corner") else 2 * fewest)


STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")


@pytest.mark.parametrize(
    ("pair", "law", "thickness", "error", "ends", "bound"),
    [
        *((STEEL, law, 2e-3, 2e-3, (0.05, 5.0), 2e-3 + 1e-9) for law in laws.names()),
        # measured at the candidate speeds alone, the error would reach 1.0013e-5 between them
        (STEEL, "fem", 0.5e-3, 1e-5, (0.1, 10.0), 1.0001e-5),
        # with a corner of the COR at the border of the table
        (cl.Pair("gamma-alumina", "glass"), "myc", R, 1e-4, (1e-29, 1e5), 1.1e-4),
    ],
)
def test_straight_lines_are_within_the_error(pair, law, thickness, error, ends, bound):
    model = cl.ImpactModel(pair, law, outside="clamp")
    rows = model.speed_table(R, thickness, error, *ends)
    v = np.geomspace(*ends, 300_007)
    miss = np.abs(np.interp(v, *rows[:2]) - model.restitution(v, R, thickness)).max()
    assert miss <= bound
    assert rows.error == pytest.approx(miss, rel=bound / error - 1.0 + 1e-3)
    # In a longer array compiled code may round the last digit differently.
    own = model.restitution(rows.speed, R, thickness)
    assert rows.restitution.tolist() == pytest.approx(own.tolist(), rel=1e-15, abs=0.0)
    assert (rows.speed[0], rows.speed[-1]) == ends


def test_tables_of_one_plate(model):
    # as many rows as with three times as many speeds to choose from
    assert [len(model.speed_table(R, 0.5e-3, error).speed) for error in (1e-2, 1e-3, 1e-4)] == [4, 11, 32]
    # on a half-space one line leads to yield, below which the COR is 1
    rows, yields = model.speed_table(R, math.inf, error=1e-5), model.yield_speed(R, math.inf)
    assert rows.speed[1] == pytest.approx(yields, rel=0.01)
    assert model.speed_table(R, math.inf, error=1e-5, fastest=yields).speed.tolist() == [0.1, yields]
    assert model.speed_table(R, H).flags == {}
    fast = model.speed_table(R, H, fastest=60.0)
    assert fast.flags == {cl.Validity.FAST_IMPACT: int((fast.speed > 7 * 7.4265).sum())}

"""Whatever a model is of, all ways to an answer give that of the solver."""

import ctypes
import math
import pickle

import kinds
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.table import bounds

R = 1e-3
FIELDS = [name for name in cl.Rebound.__dataclass_fields__ if name != "flags"]


@pytest.mark.parametrize("kind", kinds.params())
def test_tables_are_certified(kind):
    model, given = kinds.model(kind), kinds.impacts(kind)
    found, exact = model.lookup(*given), model.solve(*given, rtol=1e-12)
    assert found.restitution.size >= 80 and np.ptp(found.restitution) > 0.05
    rated, most = kind in kinds.RATED, bounds(model.force_law)
    for field in FIELDS:
        ours, true = getattr(found, field), getattr(exact, field)
        scale = 1.0 if field == "restitution" or "fraction" in field else np.maximum(np.abs(true), 0.01 * true.max())
        assert (np.abs(ours - true) <= most.get(field, 5e-4 if rated else 1e-5) * scale).all(), field
    for hit, error in ((found, 1e-12), (exact, 1e-9)):
        shares = np.array([values for name, values in vars(hit).items() if name.endswith("_fraction")])
        assert np.abs(shares.sum(axis=0) + hit.restitution**2 - 1.0).max() < error and (shares >= 0.0).all()
    assert np.count_nonzero(found.flags != exact.flags) <= (2 if rated else 0)  # some lie on a limit
    some = [values[:20] for values in given]
    history, solved = (model.force_history(*some, samples=65, method=how) for how in ("table", "solve"))
    for name, values in solved._asdict().items():
        assert np.abs(getattr(history, name) - values).max() < 3e-3 * values.max(), name


@pytest.mark.parametrize("kind", kinds.params("hertz", slow=kinds.SLOW + ("the other becomes the weaker",)))
def test_all_entries_have_one_cor(kind):
    """Each speed, radius and thickness alone, by a compiled function, its address, or a curve."""
    model, (v, r, h) = kinds.model(kind), kinds.impacts(kind)
    expected = pytest.approx(model.lookup(v, r, h).restitution, abs=1e-6 if kind in kinds.RATED else 2e-11)
    given = list(zip(v.tolist(), r.tolist(), h.tolist(), strict=True))
    pointer = ctypes.CFUNCTYPE(*[ctypes.c_double] * 4)(model.address)
    assert model.restitution(v, r, h) == expected
    for entry in (model.restitution, model.kernel, pointer, pickle.loads(pickle.dumps(model)).restitution):
        assert np.array([entry(*at) for at in given]) == expected
    assert np.array([model.curve(b, c)(a) for a, b, c in given]) == expected
    outside = (-1.0, R, R), (math.nan, R, R), (5.0, 0.0, R), (5.0, R, -R), (1e4, R, R)
    for entry in (model.kernel, pointer):
        assert np.isnan([entry(*at) for at in outside]).all()


@pytest.mark.parametrize("kind", kinds.params("hertz", "losses"))
def test_yield_begins_at_the_yield_speed(kind):
    """With its own rate, if it has one."""
    model = kinds.model(kind)
    for thickness in (R, math.inf):
        found = model.yield_speed(R, thickness)
        assert model.solve(found, R, thickness).overload == pytest.approx(1.0, abs=1e-9)
        assert model.lookup(found, R, thickness).overload == pytest.approx(1.0, abs=1e-4)  # 2.5e-5 with a rate

"""Beyond the table an impact is refused with its limit, integrated, or has the answer of the border."""

import kinds
import numpy as np
import pytest

import contactlaw as cl

# Speed, radius and thickness of an impact inside the table, and of ones that are not, with the reason.
INSIDE = (3.0, 1e-3, 1e-3)
BEYOND = {"too thin": (3.0, 1e-3, 1e-4), "too fast": (4e3, 1e-3, 1e-2)}
BEYOND_RATES = {"its rate makes the bodies stronger": (5.0, 1e-8, 1e-3)}
ANSWERS = {
    "restitution": lambda m, v, r, h: m.restitution(v, r, h),
    "lookup": lambda m, v, r, h: m.lookup(v, r, h).restitution,
    "collide": lambda m, v, r, h: m.collide(np.outer(v, (0, 0, -1)), 0, [0, 0, 1.0], r, h, 0.1)[0][:, 2] / v,
    "oblique": lambda m, v, r, h, **how: m.oblique(v, 0.5, r, h, 0.1, **how).sliding_speed,
    "force_history": lambda m, v, r, h, **how: m.force_history(v, r, h, 9, **how).force,
}


@pytest.mark.parametrize(
    ("kind", "beyond"), [("myc", BEYOND), ("rate of the sphere", BEYOND | BEYOND_RATES)], ids=["myc", "rate"]
)
def test_each_method_does_what_outside_says(kind, beyond):
    at = np.array([INSIDE, *beyond.values()]).T
    models = [cl.ImpactModel(*kinds.PAIRS[kind], outside=outside) for outside in ("raise", "solve", "clamp")]
    refusing, solving, clamping = models
    for n, reason in enumerate(beyond, 1):
        with pytest.raises(ValueError, match=f"impact 1 is outside the table.*{reason}"):
            refusing.restitution(*at[:, [0, n]])
    exact, border = refusing.solve(*at), clamping.lookup(*at)
    assert clamping.clamped == len(beyond)
    assert ((border.flags & cl.Validity.CLAMPED) > 0).tolist() == [False] + [True] * len(beyond)
    assert border.inelasticity == pytest.approx(exact.inelasticity, rel=1e-5)
    for name, answer in ANSWERS.items():
        with pytest.raises(ValueError, match="outside the table"):
            answer(refusing, *at)
        if name in ("oblique", "force_history"):
            expected = answer(refusing, *at, method="solve")
        else:
            expected = exact.restitution
        integrated = answer(solving, *at)
        np.testing.assert_allclose(integrated[1:], expected[1:], rtol=1e-6, atol=1e-12, err_msg=name)
        assert integrated[0] == pytest.approx(answer(refusing, *at[:, :1])[0], rel=1e-12), name
        assert np.isfinite(answer(clamping, *at)).all(), name
    for call in (refusing.sensitivity, refusing.constant, lambda v, *sizes: refusing.speed_table(*sizes, fastest=1e4)):
        with pytest.raises(ValueError, match="outside the table"):
            call(*at[:, 2])

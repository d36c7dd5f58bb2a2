"""Laws that users bring: made of plain functions, or of measured points."""

import math

import numpy as np
import pytest
from own_laws import CUT_OFF, PAIR, R, measured, own, points, residual

import contactlaw as cl
from contactlaw import laws
from contactlaw.laws import HERTZ, Loading, Unloading
from contactlaw.physical.scaling import yield_scales


def loading(*branches):
    return {"loading": [Loading(0.0, HERTZ), *branches]}


def unloading(*arguments, **options):
    return {"unloading": [Unloading(1.0, *arguments, **options)]}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (loading(Loading(2.0, CUT_OFF.force)), "do not meet at 2 d_Y: 2.828427.* and 2.5 F_Y"),
        (
            loading(CUT_OFF, Loading(3.0, lambda d: 4.0 + np.sin(d - 3.0))),
            r"loading force of 'mine' does not rise at 4\.5",
        ),  # 3 + pi/2
        (loading(Loading(1.0, lambda d: np.sqrt(2.0 - d))), r"'mine'; its loading force is nan at 2\.0\d+ d_Y"),
        (
            loading(Loading(1.0, lambda d: math.sqrt(d))),
            "'mine'; its loading force has to take an array, as numpy's functions do",
        ),
        (
            loading(Loading(5.0, CUT_OFF.force), Loading(2.0, CUT_OFF.force)),
            "branches have to begin one after the other, below 100000 d_Y",
        ),
        (loading(Loading(0.5, CUT_OFF.force)), "follow Hertz's curve up to yield, 1 d_Y"),
        (
            {"loading": [Loading(0.0, lambda d: d**1.5), CUT_OFF]},
            "'mine'; its first branch has to begin at 0 with a polynomial, HERTZ",
        ),
        ({"loading": [CUT_OFF]}, "'mine'; its first branch has to begin at 0"),
        (unloading(residual, 1.2), r"'mine'; its loss is -0\.00\d+ at 1\.\d+ d_Y.*a loop would gain energy"),
        (
            {"unloading": [Unloading(1.0, residual), Unloading(4.0, lambda d: 0.5 * residual(d))]},
            "'mine'; its residual compression jumps at 4 d_Y, from 1.35 to 0.675",
        ),
        ({"unloading": [Unloading(1.0, residual), Unloading(4.0, residual, 1.6)]}, "'mine'; its loss jumps at 4 d_Y"),
        (
            unloading(lambda dm: 1.01 * (dm - 1.0) ** 2),
            r"'mine'; its residual compression is not below the largest one at 2\.6",
        ),
        (
            unloading(lambda dm: np.where(dm < 10.0, residual(dm), np.nan)),
            r"'mine'; its residual compression is nan at 1\d\.\d+ d_Y",
        ),
        (unloading(residual, loss=residual), "'mine'; its loss is not the work of loading minus that of unloading"),
        ({"unloading": [Unloading(2.0, residual)]}, "the first of unloading begins there"),
        ({"yield_coefficient": None}, "must be a positive number: the law yields, got None"),
        (loading() | {"unloading": []}, "must be None: it never yields, got 0.5"),
        (
            loading(Loading(1.0, lambda d: 1.5 * d - 0.5 + 1e-3 * np.floor(7.0 * d - 7.0))),
            r"'mine'; it is not smooth near .* d_Y; give each kink",
        ),
    ],
)
def test_wrong_laws_are_refused_and_the_message_says_where(wrong, message):
    with pytest.raises(ValueError, match=message):
        own(**wrong)


def test_a_law_of_ones_own_has_no_name_of_the_package():
    """It would get the errors of that one, and its records would be read as of that one."""
    for law in (own("fem"), own("myc"), measured(name="hertz")):
        with pytest.raises(ValueError, match=f"law: got '{law.family}'; a law of contactlaw has this name"):
            cl.ImpactModel(PAIR, law)
    for name in laws.names():
        law = cl.ImpactModel(PAIR, name).force_law
        assert cl.ImpactModel(PAIR, law).force_law == law


class TestMeasured:
    def test_points_of_a_law_give_it_back(self):
        law, myc = measured(), laws.law("myc")
        for d in (1.5, 3.0, 8.0, 20.0, 39.0):
            # a cubic in ln d through a curve that has a kink
            assert law.loading(math.sqrt(d)) == pytest.approx(myc.loading(math.sqrt(d)), rel=0.01)
            assert law.residual(d) == pytest.approx(myc.residual(d), rel=1e-9)

    def test_noise_is_smoothed(self):
        compression, force = points(laws.law("myc"), noise=0.01, count=60)
        noisy, exact = measured(compression=compression, force=force), measured()
        d = np.geomspace(1.2, 39.0, 20)
        off = [noisy.loading(math.sqrt(x)) / exact.loading(math.sqrt(x)) - 1 for x in d]
        assert np.abs(off).max() < 0.01  # three of a hundred points are 2 % off

    def test_a_measured_residual_is_followed(self):
        compression, force = points(laws.law("myc"))
        d_y, _ = yield_scales(PAIR, 0.68, R)
        dm = np.maximum(compression / d_y, 1.0)
        law = measured(residual=0.7 * (dm - 1.0) ** 2 / dm * d_y)
        for x in (1.5, 5.0, 30.0):
            assert law.residual(x) == pytest.approx(0.7 * (x - 1.0) ** 2 / x, rel=1e-6)

    def test_a_size_scales(self):
        """Points of a sphere twice as large, at twice the compression and four times the force."""
        compression, force = points(laws.law("myc"))
        large = measured(radius=2 * R, compression=2 * compression, force=4 * force)
        small = measured()
        # the fit by least squares magnifies the rounding of the points
        for dm in (1.01, 2.0, 7.0, 39.0, 41.0, 1e4):
            for of in (lambda law, dm=dm: law.loading(math.sqrt(dm)), lambda law, dm=dm: law.residual(dm)):
                assert of(large) == pytest.approx(of(small), rel=1e-9)
            assert large.dissipation(dm) == pytest.approx(small.dissipation(dm), rel=1e-9, abs=1e-12)

    @pytest.mark.parametrize(
        ("count", "change", "message"),
        [
            (4, lambda d, f: {}, r"compression: 3 points lie beyond yield, .* at least 4"),
            (30, lambda d, f: {"compression": d[::-1]}, "have to be positive and finite, and to rise"),
            (30, lambda d, f: {"force": np.full_like(f, np.nan)}, "have to be positive and finite, and to rise"),
            # a range of the gauge was changed
            (
                20,
                lambda d, f: {"force": np.append(f[:12], 1.8 * f[12:])},
                r"force: point \d+ beyond yield is off any smooth",
            ),
            (
                8,
                lambda d, f: {"force": f * (1.0 + 0.7 * (np.arange(8) == 5))},
                r"force: point \d beyond yield is off any",
            ),
            (30, lambda d, f: {"radius": -1.0}, "radius"),
            (
                20,
                lambda d, f: {"residual": np.where(np.arange(20) == 15, 0.1, 0.5) * d},
                r"residual: point \d+ beyond yield is off any smooth",
            ),
        ],
    )
    def test_wrong_points_are_refused(self, count, change, message):
        compression, force = points(laws.law("myc"), count=count)
        wrong = {"compression": compression, "force": force} | change(compression, force)
        with pytest.raises(ValueError, match=message):
            measured(**wrong)

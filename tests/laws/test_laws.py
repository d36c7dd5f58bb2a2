"""Every registered law, by being registered."""

import itertools
import math
import random

import numpy as np
import pytest
import reference_laws
from lasting import long
from mpmath import mpf
from oracle import ALL_LAWS, NUMBERS

import contactlaw as cl
from contactlaw import laws

PAIRS = list(itertools.product(cl.materials(), repeat=2))
# polymers give way before these spheres yield: E*/sigma_Y is 2.4, 2.0, 2.3 and 0.002
SOFT = [
    ("stainless-steel-420", "pom"),
    ("alloy-steel-4340", "polypropylene"),
    ("aluminium-2024-t351", "ptfe"),
    ("bearing-steel-52100", "natural-rubber"),
]


# The pair of the other tests, and one that jackson_green was fitted for.
REFERENCED = [*ALL_LAWS, laws.law("jackson_green(150,0.3)")]


def assert_close(got, exact, rtol=1e-12):
    """Compare numbers with mpmath's."""
    np.testing.assert_allclose(got, np.array(exact, float), rtol=rtol)


def places(kinks, count):
    """Compressions from 1e-3 to 1e5 d_Y: random ones, and at, below and above kinks."""
    rng = np.random.default_rng(1904)
    spread = np.exp(
        np.concatenate([rng.uniform(*np.log([1e-3, reference_laws.END]), count), rng.uniform(0, np.log(200), count)])
    )
    steps = [0.0, *np.geomspace(1e-9, 0.1, 9), *-np.geomspace(1e-9, 0.1, 5)]
    near = [kink * (1 + step) for kink in kinks for step in steps]
    return [float(d) for d in (*spread, *near)]


@pytest.mark.parametrize("law", REFERENCED, ids=lambda law: law.name)
class TestAgainstTheFormulas:
    """Each quantity agrees to 1e-12 with a reference that shares no code."""

    def test_kinks_and_yield(self, law):
        exact = reference_laws.of(law.name)
        assert law.loading_kinks == pytest.approx(exact.loading_kinks, rel=1e-12)
        if exact.coefficient is not None:
            assert law.yield_coefficient == pytest.approx(float(exact.coefficient), rel=1e-14)

    def test_loading(self, law):
        exact = reference_laws.of(law.name)
        q = [math.sqrt(d) for d in places(exact.outcome_kinks, 200)]
        force = [exact.loading(mpf(one) ** 2) for one in q]
        assert_close([law.loading(one) for one in q], force)

    def test_unloading(self, law):
        exact = reference_laws.of(law.name)
        deepest = [dm for dm in places(exact.outcome_kinks, 100) if dm > 1.0 and law.yields]
        curves = [law.unloading_curve(dm) for dm in deepest]
        left = [exact.residual(mpf(dm)) for dm in deepest]
        assert_close([curve.residual for curve in curves], left)
        assert_close([0.5 * curve.exponent for curve in curves], [exact.exponent(mpf(d)) for d in deepest])
        for share in (1e-3, 0.3, 0.7, 0.99):
            q = [share * math.sqrt(dm - c.residual) for dm, c in zip(deepest, curves, strict=True)]
            got = [law.unloading(one, curve) for one, curve in zip(q, curves, strict=True)]
            want = [exact.unloading(dr + mpf(one) ** 2, mpf(dm)) for one, dr, dm in zip(q, left, deepest, strict=True)]
            assert_close(got, want)

    def test_loss(self, law):
        exact = reference_laws.of(law.name)
        deepest = [dm for dm in places(exact.outcome_kinks, 10) if dm > 1.0 and law.yields]
        assert_close([law.dissipation(dm) for dm in deepest], [exact.loss(mpf(dm)) for dm in deepest])

    def test_beyond_the_last_piece(self, law):
        """The law continues along its tangent, with the same residual share and exponent."""
        exact = reference_laws.of(law.name)
        deepest = [reference_laws.END * step for step in (1.0, 1.0 + 1e-9, 1.01, 2.0, 1e3, 1e9)]
        force = [exact.loading(mpf(math.sqrt(dm)) ** 2) for dm in deepest]
        # the slope is that of a polynomial, at its end
        assert_close([law.loading(math.sqrt(dm)) for dm in deepest], force, 1e-10)
        if not law.yields:
            return
        curves = [law.unloading_curve(dm) for dm in deepest]
        for got, want in (
            ([curve.residual for curve in curves], exact.residual),
            ([0.5 * curve.exponent for curve in curves], exact.exponent),
            ([law.dissipation(dm) for dm in deepest], exact.loss),
        ):
            assert_close(got, [want(mpf(dm)) for dm in deepest], 1e-10)


def test_every_registered_law_has_a_reference():
    missing = {law.family for law in ALL_LAWS} - vars(reference_laws).keys()
    assert not missing, "write the printed formulas in tests/shared/reference_laws.py: a function with the law's name"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("hertzz", "law: got 'hertzz'; unknown law.*'hertz'.*hertz, jackson_green"),
        ("kogut_etsion(x)", "unknown law"),
        ("_etsion", "unknown law"),
        ("jackson_green(100)", r"name it as jackson_green\(modulus_ratio,poissons_ratio\)"),
        ("myc(3)", r"law: got 'myc\(3\)'; takes no numbers"),
        ("kogut_etsion(0.9)", "poissons_ratio must lie between 0 and 0.5, not '0.9'"),
        ("kogut_etsion(-0.1)", "between 0 and 0.5, not '-0.1'"),
        ("kogut_etsion(e)", "between 0 and 0.5, not 'e'"),
        ("jackson_green(5,0.3)", r"law: got 'jackson_green'; E\*/sigma_Y is 5, must be 10 or more"),
        ("jackson_green(1e400,0.3)", "modulus_ratio must lie between"),
        ("jackson_green(20,0.5)", "Poisson's ratio 0.5"),
    ],
)
def test_names_of_no_law_are_refused_and_told_what_there_is(name, message):
    with pytest.raises(ValueError, match=message):
        laws.law(name)


@pytest.mark.parametrize("pairs", [SOFT + random.Random(44).sample(PAIRS, 12), long(PAIRS)], ids=["some", "all"])
@pytest.mark.parametrize("name", laws.names())
def test_pairs_of_the_catalogue_have_an_answer_or_are_told_what_to_take(name, pairs):
    for pair in pairs:
        try:
            model = cl.ImpactModel(cl.Pair(*pair), law=name)
        except ValueError as refusal:
            assert name != "fem", pair
            assert 'take law="fem"' in str(refusal), pair
        else:
            cor = model.solve(np.array([0.01, 1.0, 30.0]), 1e-3, 5e-3).restitution
            assert ((cor > 0.0) & (cor < 1.0)).all(), pair


def test_a_law_holds_its_parameters_with_all_digits_and_its_name_six():
    number = 0.3 + 1e-9
    law = laws.exact("kogut_etsion", poissons_ratio=number)
    assert law.parameters == {"poissons_ratio": number}
    assert law.name == laws.law("kogut_etsion(0.30000004)").name == "kogut_etsion(0.3)"
    taken = laws.law("jackson_green", **NUMBERS)
    assert taken.parameters == {name: NUMBERS[name] for name in taken.from_pair}

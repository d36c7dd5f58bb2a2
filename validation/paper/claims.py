"""Every quantitative claim of the paper, with our number and a verdict.

`claims` computes them all, in the order of the paper; `validation.paper.verdicts` judges.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

import contactlaw as cl
from contactlaw import laws
from contactlaw.laws.myc import P
from contactlaw.physical.scaling import plate_mobility, scales
from contactlaw.turning_point import WAVE_SLOPE
from validation.accuracy import compare
from validation.fem import store
from validation.paper import closed_form, evidence, formulas
from validation.paper.closed_form import elastic_compression, yield_speed_ratio
from validation.paper.setting import (
    ETA,
    FASTEST,
    PAIR,
    RADIUS,
    SPEED,
    THINNEST,
    Array,
    borderline,
    impacts,
)
from validation.paper.verdicts import (
    FAILS,
    LIMITED,
    MISPRINT,
    Claim,
    at_most,
    more_than,
    near,
    undecided,
)


def claims() -> tuple[Claim, ...]:
    """Compute all claims in the order of the paper."""
    return tuple(claim for section in SECTIONS for claim in of_section(section))


@functools.cache
def of_section(section: Callable[[], Iterator[Claim]]) -> tuple[Claim, ...]:
    """Compute the claims of one of `SECTIONS`, once."""
    return tuple(section())


DEEPEST = np.array([30.0])  # compression of the deepest indentation [d_Y]


def _largest(values: Array) -> float:
    """Value of the largest magnitude."""
    return float(values[np.abs(values).argmax()])


def _percent(share: float, digits: int = 0) -> str:
    return f"{100.0 * share:.{digits}f} %"


def _section_1() -> Iterator[Claim]:
    taken, beside = evidence.taken_by_thick_plate()
    yield undecided(
        "wave in a half-space", "section 1",
        "elastic waves in a half-space take less than 5 % of the energy (Hunter, Reed)", 0.05,
        "the model has bending waves only, and our plates of finite elements a lower face: ours is "
        "what 10 R of glass take at most (0.3 to 7 V_Y0)", taken,
    )  # fmt: skip
    yield undecided(
        "wave and plastic flow", "section 1",
        "there the wave's loss is negligible beside plastic flow's (Hutchings; Wu et al.)", None,
        "for the same reason; ours is one over the other on 10 R of glass at 7 V_Y0", beside,
    )  # fmt: skip
    lam = np.linspace(0.0, 0.95, 96)
    mueller, zener = closed_form.mueller(lam), np.asarray(closed_form.zener(lam))
    inside = zener > 0.2
    yield at_most(
        "Mueller's range", "section 1", "Eq. 3 approximates Zener's model where COR > 0.2", 0.02,
        float(np.abs(mueller - zener)[inside].max()),
        "largest absolute error of the COR; no number is printed, 0.02 is ours",
    )  # fmt: skip
    short, long = evidence.bending_by_transits()
    yield undecided(
        "transits", "section 1",
        "bending needs a contact of 6 to 8 transits of the thickness (Boettcher; Koller, Kolsky)",
        6.0, "no accuracy is printed. Our finite plates take up to "
        f"{short:.1f} times the energy of the model's bending wave in contacts below 6 transits, "
        f"and up to {long:.2f} times (ours) above 8",
        long,
    )  # fmt: skip
    yield undecided(
        "Mueller's contact times", "section 1",
        "Zener's contact time may be too short for thin plates, R/H > 3.3 (Mueller et al. 2016)",
        None, "an experiment. Ours is Zener's time over that of finite elements at R/H = 2.5, the "
        "thinnest we have, while the bead is elastic: too long, if anything",
        evidence.zener_time_on_the_thinnest(),
    )  # fmt: skip
    v = np.array([1e3, 1e4])
    e = np.asarray(closed_form.half_space(v))
    yield near(
        "bulk power", "section 1", "on a half-space the COR falls as V0^-0.5 (Wu et al. 2003)",
        -0.5, evidence.slope((v[0], e[0]), (v[1], e[1])), 0.02,
        "in the model: every contact law with linear loading (MYC, Thornton) has -1/4, Johnson's "
        "classical result; Wu et al. find -1/2 where deformations are finite",
    )  # fmt: skip
    one, two = (float(impacts(x, 1.0).inelasticity) for x in (1.0, 2.0))
    yield near(
        "lambda power", "section 1", "lambda grows as V0^0.2", 0.2,
        evidence.slope((1.0, one), (2.0, two)), 1e-9,
    )  # fmt: skip


def _section_2() -> Iterator[Claim]:
    glass, thickness = PAIR.plate, 1e-3
    root = math.sqrt(3.0 * glass.density * (1.0 - glass.poissons_ratio**2) / glass.youngs_modulus)
    bending = glass.plane_modulus * thickness**3 / 12.0
    impedance = 8.0 * math.sqrt(bending * glass.density * thickness)
    yield near(
        "alpha", "Eq. 1", "alpha = sqrt(3 rho2 (1 - nu2^2)/E2)/(4 rho2 H^2)",
        impedance * root / (4.0 * glass.density * thickness**2),
        impedance * float(plate_mobility(glass, np.array(thickness))), 1e-12,
        "relative to the mobility of an infinite plate, 1/(8 sqrt(D rho2 H)), D = E2' H^3/12",
    )  # fmt: skip
    yield near(
        "exponent of Eq. 2", "Eq. 2", "lambda has E1'/(E1' + E2') to the power 4/5", 0.8,
        evidence.exponent_of_moduli(), 1e-3,
        "2/5: lambda = alpha m/T_H of Eq. 1 and the T_H of section 3.2, differentiated numerically",
        MISPRINT,
    )  # fmt: skip
    sphere, strength = PAIR.sphere, PAIR.sphere.require_yield_strength("myc")
    contact = evidence.contact(PAIR, "thornton", 0.0)
    energy = 0.8 * float(contact.stiffness * contact.yield_compression**2.5)
    thornton = math.sqrt(energy / float(contact.mass))
    davies = math.sqrt(strength**5 * RADIUS**3 / (PAIR.effective_modulus**4 * float(contact.mass)))
    yield near(
        "factor of Davies", "section 2", "V_Y0 = 3.194 sqrt(sigma_Y^5 R^3/(E*^4 m)) for Thornton",
        3.194, thornton / davies, 5e-4,
    )  # fmt: skip
    unit = math.pi**2 * math.sqrt(strength**5 / sphere.density) / PAIR.effective_modulus**2
    yield near(
        "factor of Eq. 4", "Eq. 4", "V_Y0 = 0.552 sqrt(pi^4 sigma_Y^5/(rho1 E*^4))", 0.552,
        SPEED / unit, 5e-4,
    )  # fmt: skip
    yield near(
        "V_Y0, MYC", "section 2", "gamma-Al2O3 on glass yields at 7.426 m/s", 7.426, SPEED, 0.01,
        "7.430 with the factor 0.5523 that Eq. 4 rounds to 0.552",
    )  # fmt: skip
    yield near(
        "V_Y0, Thornton", "section 2", "and at 2.126 m/s with Thornton's d_Y", 2.126, thornton,
        2e-3, f"the same rounding: {7.426 * (0.25 / 0.68) ** 1.25:.3f} is 7.426 (0.25/0.68)^1.25",
    )  # fmt: skip


def _section_3_1() -> Iterator[Claim]:
    d = np.linspace(0.5, 10.0, 191)
    off = compare.loading_errors(d)
    deep = {name: _percent(float(one[0])) for name, one in compare.loading_errors(DEEPEST).items()}
    what = "largest difference from our finite elements while loading from 0.5 to 10 d_Y"
    yield at_most(
        "MYC", "section 3.1, Fig. 3", "MYC is within 6 % of finite elements", 0.06,
        float(np.abs(off["myc"]).max()),
        f"{what}; it includes a ripple of theirs, as nodes come into contact. {deep['myc']} "
        "high at 30 d_Y", LIMITED,
    )  # fmt: skip
    worst = evidence.unloading_error()
    yield at_most(
        "MYC, unloading", "section 3.1, Fig. 3", "and while unloading", 0.06, worst,
        "largest difference from 5 and 10 d_Y, over the largest force; less of the loading work "
        "comes back than in finite elements, from 5 d_Y 58 % instead of 64 %", LIMITED,
    )  # fmt: skip
    too_high = d[(d > 1.0) & (np.abs(off["hertz"]) > 0.06)]
    yield at_most(
        "Hertz", "section 3.1, Fig. 3", "Hertz's law works in the elastic regime only (to d_Y)",
        1.0, float(too_high[0]),
        "compression [d_Y] from which it is 6 % high while loading: MYC itself loads along Hertz's "
        "curve up to d_P = 3.15 d_Y. Unloading parts from it at d_Y", LIMITED,
    )  # fmt: skip
    thornton, stronge = (_largest(off[name]) for name in ("thornton", "stronge"))
    slow, fast = compare.loading_errors(np.array([2.0, evidence.FASTEST_COMPRESSION]))["thornton"]
    yield near(
        "Thornton", "section 3.1, Fig. 3", "Thornton's force is about 64 % low", -0.64, thornton,
        0.05, f"{what}: at 10 d_Y. {_percent(-slow)} low at 2 d_Y, {_percent(-fast)} at 4.77, that "
        "7 V_Y0 reaches on a half-space: less in the paper's own range of speeds",
    )  # fmt: skip
    yield near(
        "Stronge", "section 3.1, Fig. 3", "Stronge's force is about 40 % high", 0.40, stronge, 0.05,
        f"{what}; {deep['stronge']} at 30 d_Y",
    )  # fmt: skip
    yield undecided(
        "Dong et al.", "section 3.1", "MYC has the better COR from 1.6 m/s on (Dong et al. 2018)",
        1.6, "their pair and thickness are not printed; the bead of the paper's pair does not "
        f"even yield below {SPEED:.2f} m/s",
    )  # fmt: skip


def _section_3_2() -> Iterator[Claim]:
    contact = evidence.contact(PAIR, "myc", 1.0)
    scale = math.pi * PAIR.sphere.density / (PAIR.effective_modulus * math.sqrt(5.0))
    yield near(
        "scale of time", "section 3.2", "t = R (pi rho1/(E* V0^0.5))^0.4 tau leads to Eq. 5", 1.0,
        float(scales(contact, np.array(5.0)).time) / (RADIUS * math.pow(scale, 0.4)), 1e-12,
        "relative to (m/(K V0^0.5))^0.4, which makes the factor of w^1.5 one",
    )  # fmt: skip
    yield near(
        "c2", "section 3.2", "w_m^-1.5 is (5/4)^(-3/5) at lambda = 0", 1.25**-0.6,
        float(elastic_compression(0.0)) ** -1.5, 1e-9,
    )  # fmt: skip
    lam = np.linspace(0.0, 2.0, 81)
    rise = np.asarray(elastic_compression(lam)) ** -1.5 - 1.25**-0.6
    short, slope = (
        float((lam * rise)[part].sum() / (lam[part] ** 2).sum())
        for part in (lam <= 0.5, lam <= 2.0)
    )
    yield near(
        "c1", "section 3.2, Eq. 6", "a least-squares fit of w_m^-1.5 has the slope 1.00", 1.0,
        slope, 5e-3,
        f"over lambda 0 to 2; {short:.3f} over 0 to 0.5; at 0 exactly 0.6 J (5/4)^(-3/5) = "
        f"{0.6 * WAVE_SLOPE * 1.25**-0.6:.4f}; 1 is its limit for large lambda. Eq. 6 is 3 % low "
        "in w_m at most", FAILS,
    )  # fmt: skip
    yield near(
        "Eq. 8", "Eq. 8", "at V_Y, its left side is d_Y, whatever V0 (here 7 V_Y0)", 1.0,
        evidence.left_side_of_eq_8(FASTEST), 1e-3, "V_Y in the place of V0: then it is "
        f"{evidence.left_side_of_eq_8(None):.6f} d_Y", MISPRINT,
    )  # fmt: skip
    yield near(
        "eta", "Eq. 10", "eta with pi^3 and the exponent 4/5", evidence.eq_10(3.0, 0.8), ETA, 1e-3,
        f"pi^(3/5) and 2/5, as in Eq. 2: {evidence.eq_10(0.6, 0.4):.4f}, lambda at V_Y0 and R = H",
        MISPRINT,
    )  # fmt: skip
    q = 1.25**0.6 * ETA * THINNEST**2
    x = float(evidence.eq_11(np.array(q)))
    yield near(
        "Eq. 11", "Eqs. 9, 11", "Eq. 11 solves Eq. 9, whose left side is 1 then", 1.0,
        evidence.left_side_of_eq_9(x), 1e-12, "at R/H = 1.8, with lambda of Eq. 2 corrected",
    )  # fmt: skip
    x = evidence.yield_speed_of_eq_9()
    yield near(
        "Eq. 12", "Eq. 12", "V_Y/V_Y0 - q = (V_Y/V_Y0)^(1/5)", x**0.2, x - q, 1e-6,
        f"exponent -1/5: {x**-0.2:.4f}. Ours is from the root of Eq. 9 at R/H = 1.8", MISPRINT,
    )  # fmt: skip
    yield from _eq_14()


def _eq_14() -> Iterator[Claim]:
    q = np.linspace(0.0, 20.0, 200_001)
    n = np.arange(60)
    coefficients = np.cumprod(-(0.2 + n) / (1.0 + n))  # a_n of x^(-1/5)
    yield at_most(
        "Taylor coefficients", "section 3.2", "|a_n| < 1", 1.0, float(np.abs(coefficients).max())
    )
    bound = (1.0 - (q + 1.0) ** -0.2) / (1.0 + q * (q + 1.0) ** 0.2)
    sums = []
    for power in (5.0, 0.2):
        step = (1.0 - (q + 1.0) ** -power) / (q + 1.0)
        series = sum(step**k for k in range(1, 60)) / (q + 1.0) ** 0.2
        sums.append(float(np.abs(series - bound).max()))
    yield at_most(
        "sum of Eq. 13", "Eq. 13", "the series, with (q + 1)^-5, has the sum in closed form", 1e-6,
        sums[0], f"largest difference; with the exponent -1/5 it has, to {max(sums[1], 1e-12):.0e}",
        MISPRINT,
    )  # fmt: skip
    yield at_most(
        "bound of Eq. 13", "Eq. 13", "the residual is at most 0.061", 0.061, float(bound.max())
    )
    yield near(
        "place of the bound", "Eq. 13", "at q = 1.179", 1.179, float(q[bound.argmax()]), 1e-3
    )
    solved = evidence.eq_11(q)
    error = np.abs(q + (1.0 + q) ** -0.2 - solved)
    yield at_most(
        "error of Eq. 14", "section 3.2", "Eq. 14 solves Eq. 11 to 0.061 at worst", 0.061,
        float(error.max()), "the bound is generous",
    )  # fmt: skip
    yield at_most(
        "relative error of Eq. 14", "section 3.2", "and to 6.1 % of V_Y", 0.061,
        float((error / solved).max()), "of Eq. 11's V_Y",
    )  # fmt: skip
    ratio = np.linspace(0.0, THINNEST, 37)
    yield at_most(
        "Eq. 14 against the model", "section 3.4, Fig. 6",
        "Eq. 14 is within 1.2 % of the model", 0.012,
        _error_of_eq_14(ETA * ratio**2), "up to R/H = 1.8, with eta corrected; 1.21 % there",
        digits=3,
    )  # fmt: skip
    yield at_most(
        "Eq. 14, any thickness", "section 5", "V_Y by Eq. 14 is within 6 %", 0.06,
        _error_of_eq_14(np.linspace(0.0, 5.0, 101)),
        "of the model, lambda_Y up to 5 (R/H = 8, if it were a plate); most near lambda_Y = 2",
    )  # fmt: skip


def _error_of_eq_14(at_yield: Array) -> float:
    exact = np.asarray(yield_speed_ratio(at_yield))
    return float(np.abs(formulas.eq_14(at_yield) / exact - 1.0).max())


def _section_3_3() -> Iterator[Claim]:
    myc = laws.law("myc")
    yield near(
        "Eq. 16, Hertz", "Eqs. 16, 19", "below d_P the force is K d_P^1.5, a constant", 1.0,
        myc.loading(1.2) / myc.loading(1.0), 1e-3,
        "d in the place of d_P in both elastic branches; ours is F(1.44 d_Y)/F(d_Y) = 1.44^1.5",
        MISPRINT,
    )  # fmt: skip
    h = 1e-6
    before, after = (
        (myc.loading(math.sqrt(d + h)) - myc.loading(math.sqrt(d - h))) / (2.0 * h)
        for d in (P - 2.0 * h, P + 2.0 * h)
    )
    yield near(
        "Eq. 19", "Eqs. 19, 20", "loading goes on with the slope at d_P, 1.5 K d_P^0.5", 1.0,
        after / before, 1e-5, "slopes of the law on both sides of d_P",
    )  # fmt: skip
    yield near(
        "Eq. 20, loading", "Eq. 20", "F' = 2 E* R^0.5 d_P^0.5 there", 1.5 * math.sqrt(P), after,
        1e-5, "in units of F_Y/d_Y: 1.5 (d_P/d_Y)^0.5",
    )  # fmt: skip
    # F' on the unloading curve from 5 d_Y, half way between d_r and d_m, in F_m/(d_m - d_r)
    top = 5.0
    span, curve = top - myc.residual(top), myc.unloading_curve(top)
    down = [myc.unloading(math.sqrt(0.5 * span + step), curve) for step in (-h, h)]
    yield near(
        "Eq. 20, unloading", "Eq. 20, last line",
        "F' = 1.5 F_m/(x3 - x1) ((x1 - d_r)/(x3 - d_r))^0.5, half way from d_r to x3",
        1.5 / 0.5 * math.sqrt(0.5),
        (down[1] - down[0]) / (2.0 * h) * span / myc.loading(math.sqrt(top)), 1e-3,
        "in units of F_m/(x3 - d_r). The denominator is x3 - d_r; ours is the difference quotient "
        "of the law", MISPRINT,
    )  # fmt: skip


def _section_3_4() -> Iterator[Claim]:
    v = np.linspace(0.05, FASTEST, 120)
    ratio = np.linspace(0.02, THINNEST, 46)
    surface = np.asarray(impacts(v, ratio[:, None]).restitution)
    rise = max(np.diff(surface, axis=0).max(), np.diff(surface, axis=1).max())
    yield at_most(
        "monotone", "section 3.4, Fig. 5", "the COR falls with speed and with R/H", 0.0,
        float(rise), "largest rise between neighbours on a fine grid",
    )  # fmt: skip
    elastic = closed_form.mueller(ETA * ratio**2 * FASTEST**0.2)
    yield more_than(
        "Mueller, plastic", "section 3.4, Fig. 5B",
        "Mueller's model is significantly high for V0 > V_Y", 0.2,
        float((elastic / surface[:, -1] - 1).min()),
        "least excess over the modified Zener model at 7 V_Y0, R/H 0.02 to 1.8; no number is "
        "printed, 20 % is that of section 4.1",
    )  # fmt: skip
    slow = np.linspace(1.0, P**1.25, 50)
    half_space = np.asarray(impacts(slow, 0.0).restitution)
    error = np.abs(formulas.eq_21(slow) / half_space - 1).max()
    yield at_most(
        "Eq. 21", "Eq. 21", "the COR on a half-space, exactly (to 1e-6)", 1e-6, float(error),
        "up to v = (d_P/d_Y)^(5/4) = 4.19", LIMITED,
    )  # fmt: skip
    over = float(formulas.eq_21(FASTEST) / closed_form.half_space(FASTEST))
    yield at_most(
        "Eq. 21 beyond 4.19", "Eq. 21", "beyond that speed too", 1e-6, over - 1.0,
        "loading is linear from there on; Eq. 21 is 2 % high at v = 7, 4.4 % at 10. The errata "
        "have the exact form",
    )  # fmt: skip
    bulk = closed_form.peng(v, 0.0, ETA) - formulas.eq_21(v)
    yield at_most(
        "Eq. 22 for thick plates", "Eq. 22", "it tends to Eq. 21 (to 1e-12)",
        1e-12,
        float(np.abs(bulk).max()),
    )  # fmt: skip
    yield near(
        "c of Eq. 22, as printed", "Eq. 22", "c = 0.0935, without a factor", 0.0935,
        evidence.fitted_c(surface, v, ratio, factor=False), 2e-3,
        "a fit of the printed form gives 0.33, and the form jumps to 1 at yield: a factor is "
        "missing", MISPRINT,
    )  # fmt: skip
    yield near(
        "c of Eq. 22, continuous", "Eq. 22", "c = 0.0935, with the elastic COR at yield as factor",
        0.0935, evidence.fitted_c(surface, v, ratio), 2e-3, "with eta corrected everywhere",
        LIMITED,
    )  # fmt: skip
    yield near(
        "c of Eq. 22, 4/5 in g", "Eq. 22", "c = 0.0935, and g with eta's exponent 4/5", 0.0935,
        evidence.fitted_c(surface, v, ratio, exponent=0.8), 2e-3,
        "closest of the three: we guess that g was computed so. 0.093 to 0.108 over other "
        "ranges and weights, with 2/5 in g 0.106 to 0.117",
    )  # fmt: skip
    as_printed = formulas.eq_22(v, ratio[:, None], ETA)
    yield at_most(
        "error of Eq. 22, as printed", "Eq. 22", "as printed, it is within 14 %",
        0.14,
        float(np.abs(as_printed / surface - 1).max()), "against the modified Zener model", MISPRINT,
    )  # fmt: skip
    continuous = closed_form.peng(v, ratio[:, None], ETA)
    yield at_most(
        "error of Eq. 22, continuous", "Eq. 22", "with the factor, it is within 14 %", 0.14,
        float(np.abs(continuous / surface - 1).max()), "against the modified Zener model",
    )  # fmt: skip


def _section_4_1() -> Iterator[Claim]:
    forms = evidence.elastic_forms_against_impacts()
    for name in ("Zener", "Raman"):
        elastic, least, fastest = forms[name]
        yield at_most(
            f"{name}, elastic", "section 4.1, Fig. 7", f"{name}'s model predicts elastic impacts",
            0.05, elastic,
            "largest error in COR over 24 elastic impacts of finite elements, R/H 0.1 to 1.8; no "
            "number is printed, 5 % is ours",
        )  # fmt: skip
        yield more_than(
            f"{name}, plastic", "section 4.1, Fig. 7",
            f"{name}'s model is more than 20 % high where the bead yields, at small lambda", 0.2,
            least,
            "the least over the yielded impacts of finite elements on R/H = 0.1 and 0.25, at 1.5 "
            f"V_Y0: yielding begins with no loss. At 7 V_Y0 it is at least {_percent(fastest)}, at "
            "5 V_Y0 not yet 20 %", LIMITED,
        )  # fmt: skip
    continuous, printed = evidence.eq_22_against_impacts()
    yield at_most(
        "14 %", "section 4.1, Fig. 8", "Eq. 22 is within 14 % for H >= 0.556 R and V0 <= 7 V_Y0",
        0.14, continuous,
        "in its continuous form, against finite elements: 64 impacts with R/H 0.1 to 1.8, v 0.3 to "
        f"7; {_percent(printed)} as printed, the modified Zener model itself 4.6 %", LIMITED,
    )  # fmt: skip
    place, thin, rest = evidence.eq_22_on_thin_plates()
    yield near(
        "14 %, where", "section 4.1, Fig. 8", "its error is largest at H = 0.556 R", 1.0 / 0.556,
        place, 2e-3,
        f"R/H = 1.8: {_percent(thin, 1)} there, {_percent(rest, 1)} on all thicker plates. Half of "
        "it is that of the modified Zener model itself",
    )  # fmt: skip


def _section_4_2() -> Iterator[Claim]:
    ratio = np.linspace(0.1, 1.2, 23)
    speed = np.array([borderline(float(x)) for x in ratio])
    short, middle = (evidence.fitted_border(x) for x in (1.0, 1.1))
    yield near(
        "Eq. 23", "Eq. 23", "v^(2/5) = 1 + 1.001 (R/H)^2", 1.001, evidence.fitted_border(1.2), 0.02,
        f"least squares in v^(2/5) over R/H 0.1 to 1.2; {short:.3f} up to 1.0, {middle:.3f} up to "
        "1.1: the range decides the last digits",
    )  # fmt: skip
    yield at_most(
        "Eq. 23, error", "Eq. 23", "the border to within 5 % in speed (bound ours)", 0.05,
        float(np.abs(formulas.border(ratio) / speed - 1).max()),
        "10 % low at R/H = 0.2 to 0.3: near yield v - 1 grows as R/H, not its square", LIMITED,
    )  # fmt: skip
    sliver = borderline(0.1) - float(yield_speed_ratio(ETA * 0.01))
    yield undecided(
        "Kharaz and Gorham", "section 4.2", "the states of their plastic impacts are in region II",
        None, "neither thickness nor speed is printed. A doubt: if the plate was thick, R/H = 0.1 "
        f"say, region II of the paper's pair is {sliver:.2f} V_Y0 wide, so that marked plastic "
        "loss would lie in III",
    )  # fmt: skip
    yield undecided(
        "Mueller, Patil and Higgs", "section 4.2, Fig. 9A", "their states span I, and II to III",
        None, "neither thickness nor speed nor radius is printed",
    )  # fmt: skip
    yield more_than(
        "R/H = 1.2", "section 4.2, Fig. 9B", "plastic loss never dominates at R/H = 1.2", FASTEST,
        borderline(1.2), "speed [V_Y0] at which it would; the paper goes to 7",
    )  # fmt: skip
    yield at_most(
        "R/H = 0.5", "section 4.2, Fig. 9B", "the main loss shifts to plastic flow at R/H = 0.5",
        FASTEST, borderline(0.5), "speed [V_Y0] at which it does, within the paper's range",
    )  # fmt: skip
    fast = impacts(FASTEST, 0.2)
    yield at_most(
        "R/H = 0.2", "section 4.2, Fig. 9B", "at R/H = 0.2 the wave is insignificant", 0.02,
        float(fast.wave_fraction), "share of the energy at 7 V_Y0; no number is printed, 2 % is "
        "ours",
    )  # fmt: skip
    yielding = float(yield_speed_ratio(ETA * 0.2**2))
    share = [
        float(one.plastic_fraction / (one.plastic_fraction + one.wave_fraction))
        for one in (impacts(1.05 * yielding, 0.2), impacts(2.0, 0.2), fast)
    ]
    yield more_than(
        "only cause", "section 4.2", "at R/H = 0.2 plastic flow is the only cause of loss from V_Y "
        "on 'if we ignore the insignificant flexural wave'", 0.9, share[0],
        "its share of the loss 5 % above V_Y (90 % is ours): the wave is not insignificant at "
        f"once. More than half from {borderline(0.2):.2f} V_Y0 on, {_percent(share[1])} at 2, "
        f"{_percent(share[2])} at 7", LIMITED,
    )  # fmt: skip


def _section_4_3() -> Iterator[Claim]:
    thin, thick = impacts(1.0, 1.8), impacts(1.0, 0.1)
    yield more_than(
        "thin plates", "section 4.3, Fig. 10", "thinner plates prolong the contact", 0.0,
        float(thin.contact_time / thick.contact_time - 1), "from R/H = 0.1 to 1.8 at V_Y0",
    )  # fmt: skip
    v, ratio = np.linspace(0.2, FASTEST, 120), np.linspace(0.05, THINNEST, 15)[:, None]
    time = np.asarray(impacts(v, ratio).contact_time)
    yield at_most(
        "fast impacts", "section 4.3, Fig. 10", "at a given thickness, faster contacts are shorter",
        0.0, float((np.diff(time) / time[:, :-1]).max()),
        "largest relative change from one speed to the next, 0.2 to 7 V_Y0, R/H 0.05 to 1.8; in "
        "finite elements at all eight thicknesses too",
    )  # fmt: skip
    one, two = (float(impacts(x, 0.0, law="hertz").contact_time) for x in (1.0, 32.0))
    yield near(
        "Hertz's time", "section 4.3", "t_d grows as (m/V0^0.5)^0.4: as V0^-0.2", -0.2,
        evidence.slope((1.0, one), (32.0, two)), 1e-6,
    )  # fmt: skip
    heavy = cl.Pair(replace(PAIR.sphere, density=2.0 * PAIR.sphere.density), PAIR.plate)
    two = float(cl.ImpactModel(heavy, law="hertz").lookup(SPEED, RADIUS, math.inf).contact_time)
    yield near(
        "Hertz's time, mass", "section 4.3", "and as m^0.4", 0.4,
        evidence.slope((1.0, one), (2.0, two)), 1e-6,
    )  # fmt: skip
    model, zener = evidence.contact_time_errors()
    yield at_most(
        "contact time of the model", "section 4.3, Fig. 10",
        "the modified Zener model predicts the contact time of finite elements", 0.05,
        float(np.abs(model).max()),
        "largest error over 64 impacts; the model is a little long. No number is printed, 5 % is "
        "ours",
    )  # fmt: skip
    yield more_than(
        "contact time by Zener", "section 4.3, Fig. 10",
        "Zener's model slightly overestimates it where the bead yields", 0.0, float(zener.min()),
        f"the least of {zener.size} impacts of finite elements; rms {_rms(zener)} and up to "
        f"{_percent(float(zener.max()))}, where the modified model has an rms of {_rms(model)}",
    )  # fmt: skip
    short = 1.0 - time / np.asarray(impacts(v, ratio, law="hertz").contact_time)
    yield at_most(
        "plasticity and time", "sections 4.3, 5", "plastic flow changes the contact time little",
        0.1, float(short.max()), "largest shortening up to 7 V_Y0 (no number is printed, 10 % is "
        "ours); 'can be ignored', section 5, is true to that",
    )  # fmt: skip


def _rms(errors: Array) -> str:
    return _percent(math.sqrt(float((errors**2).mean())), 1)


def _appendix() -> Iterator[Claim]:
    yield near(
        "plastic strain", "appendix, Fig. 12",
        "the largest plastic strain is 0.039 at 26 m/s on H = 0.5 mm", 0.039,
        float(store.read("paper").data["largest_plastic_strain"]), 1e-3,
    )  # fmt: skip
    yield more_than(
        "in touch", "appendix, Fig. 13", "sphere and plate touch at 1, 2 and 3 us of that impact",
        3e-6, evidence.last_touch(), "end of the contact [s] in our finite elements",
    )  # fmt: skip
    yield at_most(
        "no reflection", "appendix, Fig. 13", "no wave returns from an edge at 150 mm", 0.150,
        evidence.nearest_harmless_edge(),
        "distance [m] from which on a free edge changes our finite elements' COR by less than "
        "0.2 %, at V_Y0 on H = 0.6 mm",
    )  # fmt: skip


SECTIONS = (
    _section_1,
    _section_2,
    _section_3_1,
    _section_3_2,
    _section_3_3,
    _section_3_4,
    _section_4_1,
    _section_4_2,
    _section_4_3,
    _appendix,
)

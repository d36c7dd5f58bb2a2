"""Every quantitative claim of the paper, with our number and a verdict.

`claims` computes them all. A verdict is the outcome of a comparison, not an opinion: a claim holds
if our number is within the tolerance of the printed one (or below a printed bound); if it is not,
the verdict is the one named beside it.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from contactlaw import closed_form, laws
from contactlaw.closed_form import WAVE_SLOPE, elastic_compression, yield_speed_ratio
from validation import evidence
from validation.fem import compare, store
from validation.paper import (
    ETA,
    FASTEST,
    PAIR,
    SHARE,
    THINNEST,
    borderline,
    impacts,
)

HOLDS = "holds"
MISPRINT = "misprint"
LIMITED = "holds in part"
FAILS = "does not hold"
OPEN = "not reproducible here"


@dataclass(frozen=True)
class Claim:
    """A claim of the paper and what became of it.

    Parameters
    ----------
    name : str
        Short name, for tests and links.
    where : str
        Section, equation or figure.
    statement : str
        What the paper says.
    printed, ours : float or None
        The paper's number and ours; None where there is none.
    tolerance : str
        What counts as agreement.
    verdict : str
        `HOLDS`, `MISPRINT`, `LIMITED`, `FAILS` or `OPEN`.
    note : str
        Correction, range or reason.
    """

    name: str
    where: str
    statement: str
    printed: float | None
    ours: float | None
    tolerance: str
    verdict: str
    note: str = ""


def _near(
    name: str,
    where: str,
    statement: str,
    printed: float,
    ours: float,
    within: float,
    note: str = "",
    otherwise: str = FAILS,
) -> Claim:
    """Agreement within an absolute tolerance."""
    verdict = HOLDS if abs(ours - printed) <= within else otherwise
    return Claim(name, where, statement, printed, ours, f"within {within:g}", verdict, note)


def _bounded(
    name: str,
    where: str,
    statement: str,
    bound: float,
    ours: float,
    note: str = "",
    otherwise: str = FAILS,
) -> Claim:
    """Agreement with an upper bound, to two digits of it, as the paper rounds."""
    rounded = round(ours, 1 + math.ceil(-math.log10(bound))) if bound else ours
    verdict = HOLDS if rounded <= bound else otherwise
    return Claim(name, where, statement, bound, ours, "at most", verdict, note)


def _open(name: str, where: str, statement: str, printed: float | None, why: str) -> Claim:
    return Claim(name, where, statement, printed, None, "-", OPEN, why)


@functools.cache
def claims() -> tuple[Claim, ...]:
    """Compute all claims in the order of the paper."""
    return tuple(claim for group in GROUPS for claim in group())


def _section_1() -> Iterator[Claim]:
    v = np.array([1e3, 1e4])
    e = np.asarray(closed_form.half_space(v))
    yield _near(
        "bulk power", "section 1", "on a half-space the COR falls as V0^-0.5 (Wu et al. 2003)",
        -0.5, float(np.diff(np.log(e))[0] / np.diff(np.log(v))[0]), 0.02,
        "Wu et al. find -1/2 for finite deformation; every contact law with linear loading (MYC, "
        "Thornton) has -1/4, Johnson's classical result", LIMITED,
    )  # fmt: skip
    lam = [impacts(x, 1.0).inelasticity for x in (1.0, 2.0)]
    yield _near(
        "lambda power", "section 1", "lambda grows as V0^0.2", 0.2,
        float(math.log(lam[1] / lam[0]) / math.log(2.0)), 1e-9,
    )  # fmt: skip
    yield _open(
        "wave in a half-space", "section 1",
        "elastic waves in a half-space take less than 5 % of the energy (Hunter, Reed)", 0.05,
        "the model has bending waves only, and our plates of finite elements a lower face: 10 R of "
        "glass take 0.4 to 2 % (0.3 to 7 V_Y0)",
    )  # fmt: skip


def _section_2() -> Iterator[Claim]:
    yield _near(
        "exponent of Eq. 2", "Eq. 2", "lambda has E1'/(E1' + E2') to the power 4/5", 0.8,
        evidence.exponent_of_moduli(), 1e-3,
        "2/5: lambda = alpha m/T_H of Eq. 1 and the T_H of section 3.2, differentiated numerically",
        MISPRINT,
    )  # fmt: skip
    lam = np.linspace(0.0, 0.95, 96)
    mueller, zener = closed_form.mueller(lam), np.asarray(closed_form.zener(lam))
    inside = zener > 0.2
    yield _bounded(
        "Mueller's range", "section 1", "Eq. 3 approximates Zener's model where COR > 0.2", 0.02,
        float(np.abs(mueller - zener)[inside].max()),
        "largest absolute error of the COR; no number is printed, 0.02 is ours",
    )  # fmt: skip
    davies = math.sqrt(0.8 * 4 / 3) * (math.pi / 2) ** 2.5
    yield _near(
        "factor of Davies", "section 2", "V_Y0 = 3.194 sqrt(sigma_Y^5 R^3/(E*^4 m)) for Thornton",
        3.194, davies, 5e-4,
    )  # fmt: skip
    factor = math.sqrt(0.8 * 0.68**2.5)  # V_Y0^2 = (4/5) K d_Y^2.5/m
    yield _near(
        "factor of Eq. 4", "Eq. 4", "V_Y0 = 0.552 sqrt(pi^4 sigma_Y^5/(rho1 E*^4))", 0.552, factor,
        5e-4,
    )  # fmt: skip
    speed = PAIR.yield_speed
    yield _near(
        "V_Y0, MYC", "section 2", "gamma-Al2O3 on glass yields at 7.426 m/s", 7.426, speed, 0.01,
        "7.430 with the factor 0.5523 that Eq. 4 rounds to 0.552",
    )  # fmt: skip
    thornton = speed * (0.25 / 0.68) ** 1.25
    yield _near(
        "V_Y0, Thornton", "section 2", "and at 2.126 m/s with Thornton's d_Y", 2.126, thornton, 2e-3
    )


def _section_3_1() -> Iterator[Claim]:
    d = np.linspace(0.5, 10.0, 191)
    off = compare.loading_errors(d)
    yielded = d >= 2.0
    yield _near(
        "Stronge", "section 3.1, Fig. 3", "Stronge's force is about 40 % high", 0.40,
        float(np.median(off["stronge"][yielded])), 0.05,
        "against our finite elements, median over 2 to 10 d_Y: 38 to 44 %, and 121 % at 30 d_Y",
    )  # fmt: skip
    yield _near(
        "Thornton", "section 3.1, Fig. 3", "Thornton's force is about 64 % low", -0.64,
        float(off["thornton"][d <= 4.77].min()), 0.05,
        "against our finite elements 41 % low at 2 d_Y, 57 % at 4.77 d_Y (7 V_Y0 on a half-space); "
        "64 % at 10 to 14 d_Y, beyond the paper's speeds", LIMITED,
    )  # fmt: skip
    yield _bounded(
        "MYC", "section 3.1, Fig. 3", "MYC is within 6 % of finite elements", 0.06,
        float(np.abs(off["myc"]).max()),
        "largest difference while loading from 0.5 to 10 d_Y; 29 % high at 30 d_Y", LIMITED,
    )  # fmt: skip
    myc = laws.law("myc")
    yield _near(
        "Eq. 16, Hertz", "Eqs. 16, 19", "below d_P the force is K d_P^1.5, a constant", 1.0,
        myc.loading(1.2) / myc.loading(1.0), 1e-3,
        "d in the place of d_P in both elastic branches; ours is F(1.44 d_Y)/F(d_Y) = 1.44^1.5",
        MISPRINT,
    )  # fmt: skip


def _section_3_2() -> Iterator[Claim]:
    yield _near(
        "c2", "section 3.2", "w_m^-1.5 is (5/4)^(-3/5) at lambda = 0", 1.25**-0.6,
        float(elastic_compression(0.0)) ** -1.5, 1e-9,
    )  # fmt: skip
    lam = np.linspace(0.0, 2.0, 81)
    rise = np.asarray(elastic_compression(lam)) ** -1.5 - 1.25**-0.6
    yield _near(
        "c1", "section 3.2, Eq. 6", "a least-squares fit of w_m^-1.5 has the slope 1.00", 1.0,
        float((lam * rise).sum() / (lam**2).sum()), 5e-3,
        f"0.929 over lambda 0 to 2, 0.914 over 0 to 0.5; at 0 exactly 0.6 J (5/4)^(-3/5) = "
        f"{0.6 * WAVE_SLOPE * 1.25**-0.6:.4f}; 1 is its limit for large lambda. Eq. 6 is 3 % low "
        "in w_m at most", FAILS,
    )  # fmt: skip
    yield _near(
        "Eq. 8", "Eq. 8", "at V_Y, its left side is d_Y, whatever V0 (here 7 V_Y0)", 1.0,
        evidence.left_side_of_eq_8(FASTEST), 1e-3, "V_Y in the place of V0: then it is "
        f"{evidence.left_side_of_eq_8(None):.6f} d_Y", MISPRINT,
    )  # fmt: skip
    yield _near(
        "eta", "Eq. 10", "eta with pi^3 and the exponent 4/5", ETA * SHARE**0.4 * math.pi**2.4,
        ETA, 1e-3, "pi^(3/5) and 2/5, as in Eq. 2: 0.0751 in the place of 0.539", MISPRINT,
    )  # fmt: skip
    x = 2.0
    yield _near(
        "Eq. 12", "Eq. 12", "V_Y/V_Y0 - q = (V_Y/V_Y0)^(1/5), at V_Y/V_Y0 = 2", x**0.2,
        x - (x - x**-0.2), 1e-6, "exponent -1/5: Eq. 11 solved for x gives x - q = x^(-1/5)",
        MISPRINT,
    )  # fmt: skip
    q = np.linspace(0.0, 20.0, 200_001)
    bound = (1.0 - (q + 1.0) ** -0.2) / (1.0 + q * (q + 1.0) ** 0.2)
    yield _bounded(
        "bound of Eq. 13", "Eq. 13", "the residual is at most 0.061", 0.061, float(bound.max())
    )
    yield _near(
        "place of the bound", "Eq. 13", "at q = 1.179", 1.179, float(q[bound.argmax()]), 1e-3
    )
    root = 1.0 + q  # Newton for x - x^(-1/5) = q
    for _ in range(20):
        root -= (root - root**-0.2 - q) / (1.0 + 0.2 * root**-1.2)
    yield _bounded(
        "error of Eq. 14", "section 3.2", "Eq. 14 solves Eq. 11 to 0.061 at worst", 0.061,
        float(np.abs(q + (1.0 + q) ** -0.2 - root).max()), "0.011 in fact: the bound is generous",
    )  # fmt: skip
    ratio = np.linspace(0.0, THINNEST, 37)
    exact = np.asarray(yield_speed_ratio(ETA * ratio**2))
    printed = np.asarray(yield_speed_ratio(ETA * ratio**2, printed=True))
    yield _bounded(
        "Eq. 14 against the model", "section 3.4, Fig. 6", "error below 1.2 %", 0.012,
        float(np.abs(printed / exact - 1).max()), "up to R/H = 1.8, with eta corrected",
    )  # fmt: skip


def _section_3_3() -> Iterator[Claim]:
    # F' on the unloading curve half way between d_r and d_m, in units of F_m/(d_m - d_r)
    yield _near(
        "Eq. 20", "Eq. 20, last line", "F' = 1.5 F_m/(x3 - x1) ((x1 - d_r)/(x3 - d_r))^0.5",
        1.5 / 0.5 * math.sqrt(0.5), ((0.5 + 1e-6) ** 1.5 - (0.5 - 1e-6) ** 1.5) / 2e-6, 1e-3,
        "the denominator is x3 - d_r; ours is the difference quotient of Eq. 19", MISPRINT,
    )  # fmt: skip


def _section_3_4() -> Iterator[Claim]:
    v = np.linspace(0.05, FASTEST, 120)
    ratio = np.linspace(0.02, THINNEST, 46)
    surface = np.asarray(impacts(v, ratio[:, None]).restitution)
    rise = max(np.diff(surface, axis=0).max(), np.diff(surface, axis=1).max())
    yield _bounded(
        "monotone", "section 3.4, Fig. 5", "the COR falls with speed and with R/H", 0.0,
        float(rise), "largest rise between neighbours on a fine grid",
    )  # fmt: skip
    linear = (2.14 / 0.68) ** 1.25
    slow = np.linspace(1.0, linear, 50)
    half_space = np.asarray(impacts(slow, 0.0).restitution)
    error = np.abs(closed_form.half_space(slow, printed=True) / half_space - 1).max()
    yield _bounded(
        "Eq. 21", "Eq. 21", "the COR on a half-space, exactly (to 1e-6)", 1e-6, float(error),
        "up to v = (d_P/d_Y)^(5/4) = 4.19", LIMITED,
    )  # fmt: skip
    over = float(closed_form.half_space(FASTEST, printed=True) / closed_form.half_space(FASTEST))
    yield _bounded(
        "Eq. 21 beyond 4.19", "Eq. 21", "and beyond", 1e-6, over - 1.0,
        "loading is linear from there on; Eq. 21 is 2 % high at v = 7, 4.4 % at 10. The exact form "
        "is closed_form.half_space", LIMITED,
    )  # fmt: skip
    plain, factor, misprinted = (
        evidence.fitted_c(surface, v, ratio, **form)
        for form in (
            {"factor": False, "exponent": 0.4},
            {"factor": True, "exponent": 0.4},
            {"factor": True, "exponent": 0.8},
        )
    )
    yield _near(
        "c of Eq. 22, as printed", "Eq. 22", "c = 0.0935, without a factor", 0.0935, plain, 2e-3,
        "a fit of the printed form gives 0.33, and the form jumps to 1 at yield: a factor is "
        "missing", MISPRINT,
    )  # fmt: skip
    yield _near(
        "c of Eq. 22, continuous", "Eq. 22", "c = 0.0935, with the elastic COR at yield as factor",
        0.0935, factor, 2e-3, "0.108 with eta corrected everywhere", LIMITED,
    )  # fmt: skip
    yield _near(
        "c of Eq. 22, with their g", "Eq. 22", "c = 0.0935, and g with eta's exponent 4/5", 0.0935,
        misprinted, 2e-3, "closest of the three; 0.093 to 0.108 over other ranges and "
        "weights, with 2/5 in g 0.106 to 0.117",
    )  # fmt: skip
    as_printed = closed_form.peng(v, ratio[:, None], ETA, printed=True)
    yield _bounded(
        "error of Eq. 22, as printed", "Eq. 22", "within 14 % (of finite elements)", 0.14,
        float(np.abs(as_printed / surface - 1).max()), "against the modified Zener model", MISPRINT,
    )  # fmt: skip
    continuous = closed_form.peng(v, ratio[:, None], ETA)
    yield _bounded(
        "error of Eq. 22, continuous", "Eq. 22", "within 14 % (of finite elements)", 0.14,
        float(np.abs(continuous / surface - 1).max()), "4 % against the modified Zener model",
    )  # fmt: skip


def _section_4_1() -> Iterator[Claim]:
    thick = impacts(FASTEST, 0.2)
    over = float(closed_form.zener(thick.inelasticity) / thick.restitution - 1)
    yield _near(
        "overestimate", "section 4.1, Fig. 7", "elastic models are above 20 % high at small lambda",
        1.0, float(over > 0.2), 0.0, f"Zener is {over:.0%} above the model at 7 V_Y0, R/H = 0.2",
    )  # fmt: skip
    yield _near(
        "0.556", "sections 4.1, 5", "H >= 0.556 R is R/H <= 1.8", 1.0 / 0.556, THINNEST, 2e-3
    )
    yield _bounded(
        "14 %", "section 4.1, Fig. 8", "Eq. 22 is within 14 % of finite elements", 0.14,
        evidence.eq_22_against_impacts(),
        "in its continuous form, 64 impacts with R/H 0.1 to 1.8, v 0.3 to 7; the modified Zener "
        "model itself: 4.7 %", LIMITED,
    )  # fmt: skip


def _section_4_2() -> Iterator[Claim]:
    ratio = np.linspace(0.1, 1.2, 23)
    speed = np.array([borderline(x) for x in ratio])
    fit = float(((speed**0.4 - 1) * ratio**2).sum() / (ratio**4).sum())
    yield _near(
        "Eq. 23", "Eq. 23", "v^(2/5) = 1 + 1.001 (R/H)^2", 1.001, fit, 0.02,
        "least squares in v^(2/5) over R/H 0.1 to 1.2",
    )  # fmt: skip
    yield _bounded(
        "Eq. 23, error", "Eq. 23", "the border to within 5 % in speed (bound ours)", 0.05,
        float(np.abs(closed_form.border(ratio) / speed - 1).max()),
        "10 % low at R/H = 0.2 to 0.3: near yield v - 1 grows as (R/H)^1, not ^2", LIMITED,
    )  # fmt: skip
    yield _near(
        "R/H = 1.2", "section 4.2, Fig. 9B", "plastic loss never dominates at R/H = 1.2", 1.0,
        float(borderline(1.2) > FASTEST), 0.0, f"not below v = {borderline(1.2):.2f}",
    )  # fmt: skip
    yield _near(
        "R/H = 0.5", "section 4.2, Fig. 9B", "the main loss shifts to plastic flow at R/H = 0.5",
        1.0, float(1.0 < borderline(0.5) < FASTEST), 0.0, f"at v = {borderline(0.5):.2f}",
    )  # fmt: skip
    wave = float(impacts(FASTEST, 0.2).wave_fraction)
    yield _bounded(
        "R/H = 0.2", "section 4.2, Fig. 9B", "at R/H = 0.2 the wave is insignificant", 0.02, wave,
        "share of the energy at v = 7; plastic loss overtakes at v = 1.22, not at V_Y itself",
    )  # fmt: skip
    sliver = borderline(0.1) - float(yield_speed_ratio(ETA * 0.01))
    yield _open(
        "Kharaz and Gorham", "section 4.2", "their plastic loss on thick plates is in region II",
        None, "neither thickness nor speed is printed. A doubt: at R/H = 0.1 region II of the "
        f"paper's pair is {sliver:.2f} V_Y0 wide, so that marked plastic loss would lie in III",
    )  # fmt: skip
    yield _open(
        "Mueller, Patil and Higgs", "section 4.2, Fig. 9A", "their states span I, and II to III",
        None, "neither thickness nor speed nor radius is printed",
    )  # fmt: skip


def _section_4_3() -> Iterator[Claim]:
    one = [impacts(x, 0.0, law="hertz").contact_time for x in (1.0, 32.0)]
    yield _near(
        "Hertz's time", "section 4.3", "t_d grows as (m/V0^0.5)^0.4: as V0^-0.2", -0.2,
        float(math.log(one[1] / one[0]) / math.log(32.0)), 1e-6,
    )  # fmt: skip
    thin, thick = impacts(1.0, 1.8), impacts(1.0, 0.1)
    yield _near(
        "thin plates", "section 4.3, Fig. 10", "thinner plates prolong the contact", 1.0,
        float(thin.contact_time > thick.contact_time), 0.0,
        f"by {float(thin.contact_time / thick.contact_time - 1):.1%} from R/H = 0.1 to 1.8 at V_Y0",
    )  # fmt: skip
    v, ratio = np.linspace(0.2, FASTEST, 30), np.linspace(0.05, THINNEST, 15)[:, None]
    short = 1.0 - impacts(v, ratio).contact_time / impacts(v, ratio, law="hertz").contact_time
    yield _bounded(
        "plasticity and time", "sections 4.3, 5", "plastic flow changes the contact time little",
        0.1, float(short.max()), "largest shortening up to 7 V_Y0 (no number is printed, 10 % is "
        "ours); 'can be ignored', section 5, is true to that",
    )  # fmt: skip


def _appendix() -> Iterator[Claim]:
    yield _near(
        "plastic strain", "appendix, Fig. 12",
        "the largest plastic strain is 0.039 at 26 m/s on H = 0.5 mm", 0.039,
        float(store.read("paper").data["largest_plastic_strain"]), 1e-3,
    )  # fmt: skip
    yield _bounded(
        "no reflection", "appendix, Fig. 13", "no wave returns from an edge at 150 mm", 0.150,
        evidence.nearest_harmless_edge(),
        "distance [m] from which on a free edge changes our finite elements' COR by less than "
        "0.2 %, at V_Y0 on H = 0.6 mm",
    )  # fmt: skip


GROUPS = (
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

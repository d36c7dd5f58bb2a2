"""What the stored finite elements say of the paper's claims: the numbers of `claims`."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from contactlaw import laws
from validation.accuracy import compare
from validation.fem import store
from validation.paper import closed_form
from validation.paper.setting import FASTEST, PAIR, THINNEST, Array, extreme, impacts, largest, unloading
from validation.paper.verdicts import Numbers

FASTEST_COMPRESSION = 4.77  # largest compression at 7 V_Y0 on a half-space [d_Y]
_LOADING = np.linspace(0.5, 10.0, 191)  # [d_Y]


def taken_by_thick_plate() -> tuple[float, float]:
    """Find the largest share of the energy that a plate of 10 R takes in finite elements.

    The second number is its share at 7 V_Y0 over that of plastic flow.
    """
    case = compare.comparison("matrix")
    thick = np.isclose(case.slenderness, 0.1)
    fastest = thick & np.isclose(case.speed_ratio, FASTEST)
    wave = case.fem["wave"]
    return float(wave[thick].max()), (wave[fastest] / case.fem["plastic"][fastest]).item()


def zener_time_on_the_thinnest() -> float:
    """Find Zener's contact time over that of finite elements at R/H = 2.5, below yield."""
    case = compare.comparison("limits")
    here = np.isclose(case.slenderness, 2.5) & ~case.yielded
    return float((case.model["contact_time"] / case.fem["contact_time"])[here].item())


def bending_by_transits() -> Numbers:
    """Energy that the plate takes over that of the model's bending wave, the largest ratio.

    Where the contact lasts for more than 8 transits H/c_L of the plate's thickness, and where it is
    as short as less than 6.
    """
    case = compare.comparison("matrix")
    plate = PAIR.plate
    nu = plate.poissons_ratio
    stiffness = plate.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    transit = case.fem["thickness"] / math.sqrt(stiffness / plate.density)
    transits = case.fem["contact_time"] / transit
    more = case.fem["wave"] / case.model["wave_fraction"]
    return {"ours": more[transits > 8.0].max(), "short": more[transits < 6.0].max()}


def loading_error(law: str, of: Callable[[Array], float] = extreme) -> Numbers:
    """Largest error of a law's loading force from 0.5 to 10 d_Y; its size at 2, 4.77 and 30 d_Y."""
    near = compare.loading_errors(_LOADING)[law]
    slow, fast, deep = np.abs(compare.loading_errors(np.array([2.0, FASTEST_COMPRESSION, 30.0]))[law])
    return {"ours": of(near), "slow": slow, "fast": fast, "deep": deep}


def end_of_hertz() -> float:
    """Find the compression [d_Y] from which Hertz's loading force is more than 6 % off."""
    off = np.abs(compare.loading_errors(_LOADING)["hertz"])
    return float(_LOADING[(_LOADING > 1.0) & (off > 0.06)][0])


def unloading_error() -> float:
    """Find the largest error of MYC's unloading from 5 and 10 d_Y, over the largest force."""
    law, worst = laws.law("myc"), 0.0
    for depth in (5.0, 10.0):
        back, load = unloading(law, depth)
        found = compare.force_at(f"{depth:g}", back, loading=False)
        worst = max(worst, float(np.abs(load - found).max() / found.max()))
    return worst


def eq_22_error() -> Numbers:
    """Find the largest relative error of Eq. 22 in COR, continuous and as printed."""
    found = compare.errors(compare.comparison("matrix"))
    return {"ours": found["Eq. 22, continuous"][0], "as_printed": found["Eq. 22, printed"][0]}


def eq_22_on_thin_plates() -> Numbers:
    """R/H at which the continuous form errs most; its error at R/H = 1.8 and on thicker plates."""
    case = compare.comparison("matrix")
    off = np.abs(case.restitution["Eq. 22, continuous"] / case.fem["restitution"] - 1.0)
    thin = np.isclose(case.slenderness, THINNEST)
    place = case.slenderness[off.argmax()]
    return {"ours": place, "thin": off[thin].max(), "rest": off[~thin].max()}


def _excess_of_elastic(name: str) -> Array:
    """Excess of Zener's or Raman's COR over that of the matrix."""
    case = compare.comparison("matrix")
    cor = np.asarray({"Zener": closed_form.zener, "Raman": closed_form.raman}[name](case.inelasticity))
    return cor / case.fem["restitution"] - 1.0


def elastic_error(name: str) -> float:
    """Find the largest error of Zener's or Raman's model while the bead does not yield."""
    return largest(_excess_of_elastic(name)[~compare.comparison("matrix").yielded])


def plastic_excess(name: str) -> Numbers:
    """Least excess of Zener's or Raman's model where the bead yields on the two thickest plates.

    Beside it, the least at 7 V_Y0.
    """
    case, excess = compare.comparison("matrix"), _excess_of_elastic(name)
    return {
        "ours": excess[case.yielded & (case.slenderness < 0.3)].min(),
        "fastest": excess[case.speed_ratio > 0.99 * FASTEST].min(),
    }


def contact_time_errors() -> tuple[Array, Array]:
    """Errors of contact times relative to finite elements.

    The modified Zener model's over the whole matrix; Zener's where the bead yields.
    """
    case = compare.comparison("matrix")
    fem = case.fem["contact_time"]
    elastic = np.asarray(impacts(case.speed_ratio, case.slenderness, law="hertz").contact_time)
    return case.model["contact_time"] / fem - 1.0, (elastic / fem - 1.0)[case.yielded]


def contact_time_by_zener() -> Numbers:
    """Find the least and largest excess of Zener's contact time where the bead yields, and rms."""
    model, zener = contact_time_errors()
    rms, model_rms = (np.sqrt((errors**2).mean()) for errors in (zener, model))
    extent = {"ours": zener.min(), "longest": zener.max(), "count": zener.size}
    return {**extent, "rms": rms, "model_rms": model_rms}


def last_touch() -> float:
    """Find the time [s] at which the bead leaves the plate in the finite elements of Fig. 13."""
    data = store.read("paper").data
    return float(data["time"][data["force"] > 0.0].max())


def nearest_harmless_edge() -> float:
    """Find the distance [m] from which on the edge changes the COR by less than 0.2 %."""
    edge = store.read("edge").data
    change = np.abs(edge["restitution"] / edge["restitution"][-1] - 1.0)
    felt = np.flatnonzero(change > 2e-3)
    return float(edge["width"][felt[-1] + 1])

"""Finite elements beside the model: errors of the model in numbers, by region."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from validation.fem import store
from validation.fem.cases import elastic_plate
from validation.paper import closed_form, setting, turning_point

Array = NDArray[np.float64]


class Comparison(NamedTuple):
    """Impacts of a study and what is predicted of them; one entry per impact."""

    slenderness: Array  # R/H
    speed_ratio: Array  # V0/V_Y0
    inelasticity: Array  # lambda
    fem: dict[str, Array]
    model: dict[str, Array]  # the modified Zener model, all fields of Rebound by name
    restitution: dict[str, Array]  # COR by each predictor, the model included
    yielded: NDArray[np.bool_]  # by the model


@functools.cache
def comparison(name: str) -> Comparison:
    """Read a study of impacts and predict each of them.

    Examples
    --------
    >>> bool(errors(comparison("matrix"))["modified Zener"][0] < 0.1)
    True
    """
    fem = store.read(name).data
    fields = [field for field in cl.Rebound.__dataclass_fields__ if field != "flags"]
    model = {field: np.empty(fem["speed"].size) for field in fields}
    ratio, eta = np.empty(fem["speed"].size), np.empty(fem["speed"].size)
    slenderness = fem["radius"] / fem["thickness"]
    for pair, rows, found in _solved(fem, "myc"):
        for field in fields:
            model[field][rows] = getattr(found, field)
        ratio[rows] = fem["speed"][rows] / pair.yield_speed
        eta[rows] = closed_form.eta(pair)
    lam = model["inelasticity"]
    at_yield = eta * slenderness**2
    # Eq. 22 depends on lambda_Y only: take R/H of the paper's pair at the same lambda_Y
    like = np.sqrt(at_yield / setting.ETA)
    restitution = {
        "modified Zener": model["restitution"],
        "turning point": turning_point.restitution(ratio, at_yield),
        "Eq. 22, continuous": closed_form.peng(ratio, like, setting.ETA),
        "Eq. 22, printed": closed_form.eq_22(ratio, like, setting.ETA),
        "Zener": closed_form.zener(lam),
        "Mueller, Eq. 3": closed_form.mueller(lam),
    }
    return Comparison(slenderness, ratio, lam, fem, model, restitution, model["overload"] > 1.0)


@functools.cache
def by_law() -> dict[str, Array]:
    """COR of every impact of the matrix by each of `setting.all_laws`; each has its own d_Y."""
    case = comparison("matrix")
    at_yield = setting.ETA * case.slenderness**2
    impacts = list(zip(case.speed_ratio, at_yield, strict=True))
    return {
        name: np.array([setting.restitution(*one, law) for one in impacts]) for name, law in setting.all_laws().items()
    }


@functools.cache
def by_fem(name: str) -> Array:
    """COR of every impact of a study by the law ``"fem"``.

    Examples
    --------
    >>> bool(deviation(by_fem("matrix"), comparison("matrix"))[0] < 0.03)
    True
    """
    fem = store.read(name).data
    cor = np.empty(fem["speed"].size)
    for _, rows, found in _solved(fem, "fem"):
        cor[rows] = found.restitution
    return cor


def _solved(fem: dict[str, Array], law: str) -> Iterator[tuple[cl.Pair, NDArray[np.bool_], cl.Rebound]]:
    """Integrate the impacts of a study by a law: each pair, its rows in the study, rebounds."""
    for sphere, plate in set(zip(fem["sphere"], fem["plate"], strict=True)):
        rows = (fem["sphere"] == sphere) & (fem["plate"] == plate)
        pair = elastic_plate(sphere, plate)
        impacts = (fem[name][rows] for name in ("speed", "radius", "thickness"))
        yield pair, rows, cl.ImpactModel(pair, law).solve(*impacts)


class Yielded(NamedTuple):
    """One impact of the studies `pairs` and `strengths`, with its COR by each law."""

    ratio: float  # E/sigma_Y of the sphere
    plate: str
    fem: float  # COR
    laws: dict[str, float]  # COR by name of the law


def by_strain(speed_ratio: float) -> list[Yielded]:
    """List impacts at one V0/V_Y0 and the lambda_Y of R/H = 1, by E/sigma_Y of the sphere.

    Examples
    --------
    >>> softest, *_, stiffest = by_strain(7.0)
    >>> softest.ratio < 20.0, stiffest.ratio > 200.0
    (True, True)
    """
    found = []
    for study in ("pairs", "strengths"):
        case = comparison(study)
        lam_y = case.inelasticity * case.speed_ratio**-0.2
        chosen = np.isclose(lam_y, setting.ETA, rtol=1e-3)
        chosen &= np.isclose(case.speed_ratio, speed_ratio)
        for n in np.flatnonzero(chosen):
            pair = elastic_plate(case.fem["sphere"][n], case.fem["plate"][n])
            ratio = pair.sphere.youngs_modulus / pair.sphere.require_yield_strength("by_strain")
            cor = {
                name: setting.restitution(speed_ratio, setting.ETA, law) for name, law in setting.all_laws(pair).items()
            }
            cor["fem"] = float(by_fem(study)[n])
            found.append(Yielded(ratio, pair.plate.name, float(case.fem["restitution"][n]), cor))
    return sorted(found, key=lambda one: one.ratio)


def deviation(cor: Array, case: Comparison, where: NDArray[np.bool_] | slice = slice(None)) -> Array:
    """Largest and rms error of predicted COR, relative to the finite elements [-]."""
    off = (cor / case.fem["restitution"] - 1.0)[where]
    return np.array([np.abs(off).max(), np.sqrt(np.mean(off**2))])


def errors(case: Comparison, where: NDArray[np.bool_] | slice = slice(None)) -> dict[str, Array]:
    """Largest and rms error of each predictor in COR, relative to the finite elements [-]."""
    return {name: deviation(cor, case, where) for name, cor in case.restitution.items()}


def regions(case: Comparison) -> dict[str, NDArray[np.bool_]]:
    """Impacts of a study in each of the paper's three regions, and on thick and thin plates."""
    plastic, wave = case.model["plastic_fraction"], case.model["wave_fraction"]
    return {
        "elastic": ~case.yielded,
        "wave dominates": case.yielded & (plastic <= wave),
        "plasticity dominates": case.yielded & (plastic > wave),
        "R/H <= 1": case.slenderness < 1.01,
        "R/H > 1": case.slenderness > 1.01,
    }


def field_errors(case: Comparison) -> dict[str, Array]:
    """Relative error of the model in other quantities of every impact [-]; shares: difference."""
    fem, model = case.fem, case.model
    return {
        "contact time": model["contact_time"] / fem["contact_time"] - 1.0,
        "peak force": model["peak_force"] / fem["peak_force"] - 1.0,
        "peak compression": model["peak_compression"] / fem["peak_compression"] - 1.0,
        "plastic share": model["plastic_fraction"] - fem["plastic"],
        "wave share": model["wave_fraction"] - fem["wave"],
    }


def indentation(name: str) -> tuple[Array, Array, int]:
    """Compression [d_Y], force [F_Y] and index of the turning point of a stored indentation.

    Parameters
    ----------
    name : str
        Suffix in the file, "10" say, or "calculix".
    """
    if name == "calculix":
        data = store.read("calculix").data
        compression, force = data["compression"], data["force"]
    else:
        data = store.read("indentation").data
        compression, force = data[f"compression_{name}"], data[f"force_{name}"]
    return compression / setting.YIELD_COMPRESSION, force / setting.FORCE, int(compression.argmax())


def force_at(name: str, compression: Array, *, loading: bool = True) -> Array:
    """Force [F_Y] of a stored indentation at compressions [d_Y], loading or unloading."""
    x, force, top = indentation(name)
    part = slice(None, top + 1) if loading else slice(None, top - 1, -1)
    return np.interp(compression, x[part], force[part])


def loading_errors(compression: Array) -> dict[str, Array]:
    """Error of the loading force of each law, relative to the indentation to 30 d_Y [-].

    The laws are those of `setting.all_laws`, and Stronge's.

    Parameters
    ----------
    compression : ndarray
        Compressions [d_Y of MYC], from 0.4, where the force is no longer small, to 30.

    Examples
    --------
    >>> bool(abs(loading_errors(np.array([5.0]))["myc"][0]) < 0.06)
    True
    """
    fem, laws = force_at("30", compression), setting.all_laws()
    found = {name: setting.force(law, compression) / fem - 1.0 for name, law in laws.items()}
    return found | {"stronge": closed_form.stronge(compression) / fem - 1.0}


def returned(compression: Array, force: Array, top: int) -> float:
    """Work of unloading over that of loading [-]."""
    spent = np.trapezoid(force[: top + 1], compression[: top + 1])
    return float(-np.trapezoid(force[top:], compression[top:]) / spent)


def discretisation() -> dict[str, Array]:
    """Estimate the relative error of elements of 0.01 R; one entry per thickness [-].

    At 26 m/s, on plates of 0.5 and 1 mm. Grid convergence index (Roache, J. Fluids Eng. 116 (1994)
    405): 1.25 times the distance from the limit of ever finer elements, extrapolated from those of
    0.02, 0.01 and 0.005 R at the order p that they show, at most 1, or at 1 where they oscillate.
    The plate's mesh away from the contact, halved once, adds its own error at order 1.
    """
    data = store.read("verification").data
    found: dict[str, Array] = {}
    for name in ("restitution", "peak_force", "contact_time", "plastic_strain"):
        estimated = []
        for thickness in sorted(set(data["thickness"][data["check"] == "mesh"])):
            rows = data["thickness"] == thickness
            _, coarse, fine, finest = data[name][rows & (data["check"] == "mesh")]
            (far,) = data[name][rows & (data["check"] == "far mesh")]
            ratio = (fine - coarse) / (finest - fine)  # 2^p; below 0 where they oscillate
            ratio = min(ratio, 2.0) if ratio > 0.0 else 2.0
            near = 1.25 * abs(finest - fine) * ratio / (ratio - 1.0)
            estimated.append((near + 1.25 * 2.0 * abs(far - fine)) / fine)
        found[name] = np.array(estimated)
    return found

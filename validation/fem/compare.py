"""Finite elements beside the model: errors of the model in numbers, by region."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import laws
from contactlaw.impact import sphere_on_plate
from validation.fem import published, store
from validation.fem.studies import yield_compression

Array = NDArray[np.float64]


class Comparison(NamedTuple):
    """Impacts of a study and what is predicted of them; one entry per impact."""

    slenderness: Array  # R/H
    speed_ratio: Array  # V0/V_Y0
    inelasticity: Array  # lambda
    fem: dict[str, Array]
    model: dict[str, Array]  # the modified Zener model, all fields of Rebound by name
    restitution: dict[str, Array]  # of each predictor, the model included
    yielded: NDArray[np.bool_]  # the model says so


@functools.cache
def comparison(name: str) -> Comparison:
    """Read a study of impacts and predict each of them.

    Examples
    --------
    >>> bool(errors(comparison("matrix"))["modified Zener"][0] < 0.1)
    True
    """
    fem = store.read(name).data
    solved = {key: _solved(fem, key) for key in laws.names()}
    model = solved["myc"]
    ratio = model["speed_ratio"]
    slenderness = fem["radius"] / fem["thickness"]
    lam = model["inelasticity"]
    restitution = {
        "modified Zener": model["restitution"],
        "closed form (Eq. 22)": published.closed_form(lam, ratio, slenderness),
        "Zener": solved["hertz"]["restitution"],
        "Mueller (Eq. 3)": published.mueller(lam),
    }
    for key in set(laws.names()) - {"myc", "hertz"}:
        restitution[key] = solved[key]["restitution"]
    return Comparison(slenderness, ratio, lam, fem, model, restitution, model["overload"] > 1.0)


def _solved(fem: dict[str, Array], law: str) -> dict[str, Array]:
    """Solve the model for all impacts of a study, pair by pair; V0/V_Y0 too."""
    fields = [field for field in cl.Rebound.__dataclass_fields__ if field != "flags"]
    out = {field: np.empty(fem["speed"].size) for field in (*fields, "speed_ratio")}
    for sphere, plate in set(zip(fem["sphere"], fem["plate"], strict=True)):
        rows = (fem["sphere"] == sphere) & (fem["plate"] == plate)
        pair = cl.Pair(sphere, plate)
        impacts = fem["speed"][rows], fem["radius"][rows], fem["thickness"][rows]
        found = cl.ImpactModel(pair, law=law).solve(*impacts)
        for field in fields:
            out[field][rows] = getattr(found, field)
        out["speed_ratio"][rows] = impacts[0] / pair.yield_speed
    return out


def errors(case: Comparison, where: NDArray[np.bool_] | slice = slice(None)) -> dict[str, Array]:
    """Largest and rms error of each predictor in COR, relative to the finite elements [-]."""
    table = {}
    for name, cor in case.restitution.items():
        off = (cor / case.fem["restitution"] - 1.0)[where]
        table[name] = np.array([np.abs(off).max(), np.sqrt(np.mean(off**2))])
    return table


def regions(case: Comparison) -> dict[str, NDArray[np.bool_]]:
    """Parts of a matrix: the paper's three, and its thin plates."""
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
        way, force = data["compression"], data["force"]
    else:
        data = store.read("indentation").data
        way, force = data[f"compression_{name}"], data[f"force_{name}"]
    unit = yield_compression()
    pair = cl.Pair("gamma-alumina", "glass")
    contact = sphere_on_plate(pair, laws.law("myc"), np.array(0.9e-3), np.array(1.0))
    return way / unit, force / (float(contact.stiffness) * unit**1.5), int(way.argmax())


def loading_curves(way: Array) -> dict[str, Array]:
    """Compute the loading force [F_Y] of each law, registered or published, at way [d_Y]."""
    curves = {
        name: np.array([laws.law(name).loading(float(q)) for q in np.sqrt(way)])
        for name in laws.names()
    }
    return {"thornton": published.thornton(way), "stronge": published.stronge(way), **curves}


def report() -> str:
    """All numbers as text."""
    lines = []
    matrix = comparison("matrix")
    lines.append(f"COR over the matrix ({matrix.slenderness.size} impacts): largest, rms [%]")
    parts: dict[str, NDArray[np.bool_] | slice] = {"all": slice(None), **regions(matrix)}
    for part, where in parts.items():
        cells = ", ".join(
            f"{name} {100 * big:.1f} {100 * rms:.1f}"
            for name, (big, rms) in errors(matrix, where).items()
        )
        lines.append(f"  {part:22s} {cells}")
    for name, off in field_errors(matrix).items():
        n = int(np.abs(off).argmax())
        lines.append(
            f"  {name:18s} largest {100 * off[n]:+.1f} at R/H {matrix.slenderness[n]:.2f}, "
            f"v {matrix.speed_ratio[n]:.1f}; rms {100 * np.sqrt(np.mean(off**2)):.1f} [%]"
        )
    for name in ("pairs", "limits"):
        case = comparison(name)
        lines.append(f"{name}: FEM COR, model COR, difference")
        for n in range(case.slenderness.size):
            fem, model = case.fem["restitution"][n], case.model["restitution"][n]
            lines.append(
                f"  {case.fem['sphere'][n]:20s} R/H {case.slenderness[n]:.2f} "
                f"v {case.speed_ratio[n]:5.1f} lambda {case.inelasticity[n]:.3f}: "
                f"{fem:.4f} {model:.4f} {model - fem:+.4f}"
            )
    return "\n".join(lines)

"""Many impacts at once: cases, their outcomes, and the file that keeps both."""

from __future__ import annotations

import math
import multiprocessing
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np

import contactlaw as cl
from validation.fem import store
from validation.fem.impact import impact
from validation.fem.mesh import SOLID, Core
from validation.fem.solver import SETTINGS
from validation.paper.setting import PAIR, RADIUS

_UNITS = {
    "speed": "m/s",
    "radius": "m",
    "thickness": "m",
    "width": "m",
    "size": "sphere radius",
    "contact_time": "s",
    "peak_force": "N",
    "peak_compression": "m",
    "residual_compression": "m",
    "step": "s",
}
_DEFAULTED = "size", "width", "hourglass_stiffness"  # by `impact`, where a case has NaN
_MEASURED = (
    "restitution",
    "contact_time",
    "peak_force",
    "peak_compression",
    "residual_compression",
    "plastic",
    "wave",
    "vibration",
    "friction_loss",
    "hourglass",
    "touching_loss",
    "viscous",
    "balance",
    "plastic_strain",
)
OUTCOMES = *_MEASURED, "steps", "step", "elements"
_HALF = 1.027  # element sizes of two meshes whose contacts differ by half an element


@dataclass(frozen=True)
class Case:
    """One impact to be computed, see `impact.impact`; NaN stands for the default."""

    speed: float  # [m/s]
    thickness: float  # [m]
    radius: float = RADIUS  # [m]
    sphere: str = PAIR.sphere.name
    plate: str = PAIR.plate.name
    size: float = math.nan  # [radius]
    width: float = math.nan  # [m]
    friction: float = 0.1
    yields: bool = True
    plate_yields: bool = False
    far: float = 1.0
    hourglass_stiffness: float = math.nan
    meshes: int = 2  # 1 or 2, see `solve`
    core: Core = SOLID

    @property
    def pair(self) -> cl.Pair:
        """Materials."""
        return cl.Pair(material(self.sphere), material(self.plate))


def material(name: str) -> cl.Material:
    """Look a material up; "glass, yield strength x 0.5" is glass with half its strength.

    "body, elastic 2e11 0.3 7800" has this Young's modulus, Poisson's ratio and density.
    "glass, flow 3e8 2e8 0.3 0.02 1" is glass with these constants of the flow stress, and
    "glass, loss 0.1 1e4" glass with that loss factor, and its modulus, at that frequency.

    Examples
    --------
    >>> material("gamma-alumina, yield strength x 0.5").yield_strength
    236250000.0
    >>> material("glass, flow 3e8 2e8 0.3 0.02 1").hardening
    (200000000.0, 0.3)
    >>> material("gamma-alumina, yield strength x 0.5, loss 0.1 1e4").loss_factor
    (0.1, 10000.0)
    """
    name, lossy, numbers = name.partition(", loss ")
    if lossy:
        loss, frequency = map(float, numbers.split())
        return replace(material(name), loss_factor=(loss, frequency))
    name, flowing, numbers = name.partition(", flow ")
    if flowing:
        a, b, n, c, rate0 = map(float, numbers.split())
        return replace(material(name), yield_strength=a, hardening=(b, n), rate=(c, rate0), hardness=None)
    name, elastic, numbers = name.partition(", elastic ")
    if elastic:
        e, nu, rho = map(float, numbers.split())
        return cl.Material(f"{name}{elastic}{numbers}", e, nu, rho, kind="metal")
    name, weaker, factor = name.partition(", yield strength x ")
    found = cl.material(name)
    if not weaker:
        return found
    return replace(found, yield_strength=float(factor) * found.require_yield_strength("fem"))


def elastic_plate(sphere: str, plate: str) -> cl.Pair:
    """Pair in which the sphere alone may yield, as in `Case` by default.

    Examples
    --------
    >>> elastic_plate("bearing-steel-52100", "aluminium-6061-t6").plate.yield_strength is None
    True
    """
    return cl.Pair(material(sphere), replace(material(plate), yield_strength=None))


def solve(case: Case) -> dict[str, Any]:
    """Compute a case; its inputs and outcomes by name.

    A contact grows node by node, and the outcome of an impact oscillates with the place of the
    contact's edge between two nodes: with 15 to 20 elements in the radius by 1.3 % in COR and 1.6 %
    in force if a body flows. On two meshes whose contacts differ by half an element these errors
    are opposite: the mean of both is kept, and half their difference in COR as ``mesh_error``,
    which one mesh does not give.
    """
    one = _on_mesh(case)
    if case.meshes == 1:
        return one
    other = _on_mesh(replace(case, size=one["size"] / _HALF))
    means = {name: 0.5 * (one[name] + other[name]) for name in _MEASURED}
    error = 0.5 * abs(other["restitution"] / one["restitution"] - 1.0)
    return {**one, **means, "mesh_error": error}


def _on_mesh(case: Case) -> dict[str, Any]:
    given = {name: value for name in _DEFAULTED if not math.isnan(value := getattr(case, name))}
    hit = impact(
        case.pair,
        case.speed,
        case.radius,
        case.thickness,
        friction=case.friction,
        yields=case.yields,
        plate_yields=case.plate_yields,
        far=case.far,
        core=case.core,
        **given,
    )
    named = {"friction_loss": hit.friction, "touching_loss": hit.contact}
    outcome = {key: named[key] if key in named else getattr(hit, key) for key in OUTCOMES}
    width = float(hit.system.x[:, 0].max())
    stiffness = float(hit.system.sphere.bending[0]) / case.pair.sphere.plane_modulus
    taken = {"size": hit.size, "width": width, "hourglass_stiffness": stiffness}
    return {**asdict(case), **outcome, **taken}


def _leave_ctrl_c_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def workers(processes: int) -> Iterator[ProcessPoolExecutor]:
    """Start processes for a block; an exception in it, Ctrl-C included, ends them at once."""
    with ProcessPoolExecutor(processes, initializer=_leave_ctrl_c_to_the_parent) as pool:
        try:
            yield pool
        except BaseException:
            # The workers end a moment after cancelled work was forgotten: the pool's thread would
            # report an error of its own for it (Python below 3.12). That thread has to be waited
            # for: the interpreter's exit wakes it, and fails where it is closing its pipe.
            threading.Timer(0.2, _end_workers).start()
            pool.shutdown(cancel_futures=True)
            raise


def _end_workers() -> None:
    for child in multiprocessing.active_children():
        child.terminate()


def columns(rows: list[dict[str, Any]]) -> dict[str, np.ndarray]:
    """Arrays by name, of the outcomes of cases."""
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def stored(name: str) -> list[Case]:
    """Read the impacts of a stored study: their inputs, as they were computed.

    Examples
    --------
    >>> len(stored("kept_out")), stored("kept_out")[0].meshes
    (80, 2)
    """
    data = store.read(name).data
    inputs = {field.name: data[field.name].tolist() for field in fields(Case) if field.name in data}
    # As a rule size is a 15th of the contact's radius, so that the finest part of a mesh has 19.5
    # elements, which rounding errors make 19 or 20; a hair finer, they are 20.
    inputs["size"] = [(1.0 - 1e-9) * size for size in inputs["size"]]
    if "core" in inputs:
        inputs["core"] = [Core(*numbers) for numbers in inputs["core"]]
    return [Case(**dict(zip(inputs, row, strict=True))) for row in zip(*inputs.values(), strict=True)]


def save(name: str, about: str, data: dict[str, np.ndarray]) -> None:
    """Keep computed cases as a file."""
    units = {name: _UNITS.get(name, "-") for name in data}
    store.write(
        name,
        about,
        data,
        units,
        mesh="conformal half disc, plate graded by 1.1; element size [R] in column size",
        **SETTINGS,
    )

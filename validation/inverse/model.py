"""Errors of each law beside finite elements that no fit has seen: `answers.law_errors`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import laws
from contactlaw.answers.law_errors import doubtful
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.predictions import impacts
from contactlaw.fitting.unknowns import UNKNOWNS, Setting
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import NoYieldStrengthError
from contactlaw.physical.rebound import Rebound
from validation.fem import fit, store

Array = NDArray[np.float64]

STUDIES = "everyday_5", "kept_out"  # the studies that no fit has seen
_LEAST = {"restitution": 0.3}  # the error of a lower value is relative to this one


def rebounds(one: Any, law: str) -> Rebound:
    """Predict the rebounds of a measurement as `contactlaw.fit` does.

    `one` has a pair, a radius, a thickness [m], and a speed or several [m/s].
    """
    speed = np.atleast_1d(one.speed)
    size = np.ones_like(speed)
    at = Setting(one.pair, speed, one.radius * size, one.thickness * size)
    return impacts(at, law_of(one.pair, law))


def true(one: Any, name: str) -> float:
    """Find the true value of an unknown of `contactlaw.fit` in a measurement, as in `rebounds`."""
    unknown = UNKNOWNS[name]
    of = getattr(one.pair, unknown.body) if unknown.body else one
    value = getattr(of, unknown.field)
    return float(value[0] if isinstance(value, tuple) else value)


class Impact(NamedTuple):
    """One impact by finite elements."""

    pair: cl.Pair  # bodies that did not yield have no strength
    speed: float
    radius: float
    thickness: float
    yields: bool
    values: dict[str, float]  # value of each kind that can be measured

    @property
    def slenderness(self) -> float:
        """R/H."""
        return self.radius / self.thickness


def unseen() -> list[Impact]:
    """List the impacts that no fit has seen.

    Examples
    --------
    >>> len(unseen())
    160
    """
    found = []
    for study in STUDIES:
        data = store.read(study).data
        for n in range(data["speed"].size):
            row: dict[str, Any] = {key: values[n] for key, values in data.items()}
            found.append(
                Impact(
                    pair=fit.pair_of(row),
                    speed=float(row["speed"]),
                    radius=float(row["radius"]),
                    thickness=float(row["thickness"]),
                    yields=bool(row["plastic_strain"] > 0.0),
                    values={kind: float(row[kind]) for kind in NORMAL},
                )
            )
    return found


def rms(law: str) -> tuple[Array, Array]:
    """Errors of a law in each kind of value, relative: inside its limits, and of doubtful impacts.

    Impacts without the yield strength that the law needs are left out.

    Examples
    --------
    >>> [errors.round(4).tolist() for errors in rms("fem")]
    [[0.0044, 0.0057, 0.0066], [0.0169, 0.0184, 0.014]]
    """
    off, beyond = [], []
    for one in unseen():
        try:
            hit = rebounds(one, law)
        except NoYieldStrengthError:
            continue
        off.append(
            [
                (float(np.asarray(getattr(hit, kind))[0]) - value) / max(value, _LEAST.get(kind, 0.0))
                for kind, value in one.values.items()
            ]
        )
        beyond.append(bool(doubtful(hit, np.array([one.slenderness]))[0]))
    squares, outer = np.array(off) ** 2, np.array(beyond)
    inside, outside = (np.sqrt(squares[part].mean(axis=0)) for part in (~outer, outer))
    return np.asarray(inside), np.asarray(outside)


def report() -> str:
    """Write the errors of all laws as text."""
    lines = ["rms errors of COR, contact time, peak force [%], inside limits and where doubtful"]
    for law in laws.names():
        parts = ("  ".join(f"{100.0 * error:6.2f}" for error in errors) for errors in rms(law))
        lines.append(f"{law:14s} {' | '.join(parts)}")
    return "\n".join(lines)

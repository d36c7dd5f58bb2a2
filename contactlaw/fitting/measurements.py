"""Measured rebounds in SI units, checked."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Mask
from contactlaw._errors import ArgumentError
from contactlaw.fitting.drops import NAMES, rebounds_of
from contactlaw.physical import flight
from contactlaw.physical.arguments import broadcast, check, within
from contactlaw.physical.kind import Kind
from contactlaw.record.file import Record


class Measurable(NamedTuple):
    """A measured quantity and its limits, in SI units."""

    title: str
    unit: str
    least: float
    largest: float
    hint: str  # the usual mistake behind a value beyond the limits
    shift: float = 0.0  # added before ratios are taken, so that values keep one sign


NORMAL = {
    # a measured COR may be a little above 1, from its error
    "restitution": Measurable("COR", "-", 1e-3, 1.2, "in per cent?"),
    "contact_time": Measurable("contact time", "s", 1e-9, 10.0, "in microseconds?"),
    "peak_force": Measurable("peak force", "N", 1e-12, 1e9, "in another unit?"),
}
# Of beads that came without spin. Between the first and the second there is the identity
# tangential = 1 - (2/7) (1 + rotational); 1 + rotational is what friction took of the sliding.
OBLIQUE = {
    "tangential_restitution": Measurable("tangential restitution", "-", 1e-3, 1.2, "in per cent?"),
    "rotational_restitution": Measurable("rotational restitution", "-", -0.9999, 1.2, "in per cent?", 1.0),
    "spin": Measurable("spin", "rad/s", 1e-3, 1e9, "its size, without a sign; in rpm?"),
}
KINDS = NORMAL | OBLIQUE

# What is known of each rebound, besides what was measured.
INPUTS = ("speed", "sliding_speed", "radius", "thickness", "friction")

# Smallest standard error over its value. A trial is integrated to 1e-9: no comparison is finer, and
# the weight 1/error^2 of a far smaller one overflows.
_LEAST_ERROR = 1e-9


@dataclass(frozen=True, eq=False)
class Measurements:
    """Rebounds as they were measured: any mix of COR, contact time, peak force and oblique kinds.

    Arguments broadcast; afterwards each is a flat array of one length, or None.

    Parameters
    ----------
    speed : array_like
        Normal approach speeds [m/s]; with angles, the speeds of the beads.
    radius, thickness : array_like, optional
        Sizes of beads and plates [m], one for each or one for all; ``inf`` is the half-space. A
        size that is left out has to be an unknown of the fit.
    restitution, contact_time, peak_force : array_like, optional
        Measured quantities [-, s, N]; NaN where a rebound lacks it. One without any is left out.
    angle : array_like, optional
        Angles of incidence from the plate's normal [deg], 0 to below 90. Afterwards `speed` is the
        normal part and `sliding_speed` the other one.
    sliding_speed : array_like, optional
        Speeds of the contact point along the plate [m/s] in place of angles; of any sign.
    friction : array_like, optional
        Coulomb's coefficients [-], for all rebounds with an oblique kind unless it is unknown.
    tangential_restitution, rotational_restitution, spin : array_like, optional
        As in `contactlaw.ImpactModel.oblique`, of beads that came without spin [-, -, rad/s].
    restitution_error, contact_time_error, ... : array_like, optional
        Standard errors of all these quantities, in the same units, for all rebounds that have the
        quantity. Without them a fit takes errors of one relative size and finds it from the
        scatter.
    line : array_like, optional
        Lines of a file, or other numbers by which you know the rebounds: messages name them.

    Raises
    ------
    ValueError
        A value out of its range, no quantity at all, or errors without their quantity.

    Examples
    --------
    >>> import contactlaw as cl
    >>> data = cl.Measurements(speed=[1.0, 2.0], radius=0.9e-3, restitution=[0.93, 0.91])
    >>> data.radius, data.thickness
    (array([0.0009, 0.0009]), None)
    """

    speed: ArrayLike
    radius: ArrayLike | None = None
    thickness: ArrayLike | None = None
    restitution: ArrayLike | None = None
    contact_time: ArrayLike | None = None
    peak_force: ArrayLike | None = None
    angle: ArrayLike | None = None
    sliding_speed: ArrayLike | None = None
    friction: ArrayLike | None = None
    tangential_restitution: ArrayLike | None = None
    rotational_restitution: ArrayLike | None = None
    spin: ArrayLike | None = None
    restitution_error: ArrayLike | None = None
    contact_time_error: ArrayLike | None = None
    peak_force_error: ArrayLike | None = None
    tangential_restitution_error: ArrayLike | None = None
    rotational_restitution_error: ArrayLike | None = None
    spin_error: ArrayLike | None = None
    line: ArrayLike | None = None

    def __post_init__(self) -> None:
        """Check every value and store flat arrays."""
        given = {name: values for name, values in vars(self).items() if values is not None}
        if not given.keys() & KINDS.keys():
            reason = f"have to hold at least one of {', '.join(KINDS)}, got none"
            raise ArgumentError("data", None, reason)
        *arrays, _ = broadcast(**{name: _missing(values) for name, values in given.items()})
        flat: dict[str, Array] = dict(zip(given, arrays, strict=True))
        missing = np.all([np.isnan(flat[name]) for name in KINDS if name in flat], axis=0)
        if missing.any() and not missing.all():
            said = f"data: rebounds {np.flatnonzero(missing)} have no quantity and are left out"
            warnings.warn(f"{said}; the others are numbered from 0 anew", stacklevel=4)
            flat = {name: values[~missing] for name, values in flat.items()}
        sizes = {name: flat[name] for name in INPUTS if name in flat}
        if flat["speed"].size == 0:
            raise ArgumentError("data", None, "got no rebound, at least one is needed")
        check(**sizes)
        if "angle" in flat:
            if "sliding_speed" in flat:
                raise ArgumentError("angle", None, "give angles or sliding speeds, not both")
            angle = flat.pop("angle")
            within("angle", angle, 0.0, 89.999, "degrees from the plate's normal")
            flat["sliding_speed"] = flat["speed"] * np.sin(np.radians(angle))
            flat["speed"] = flat["speed"] * np.cos(np.radians(angle))
            check(speed=flat["speed"])
        elif "sliding_speed" in flat:
            flat["sliding_speed"] = np.abs(flat["sliding_speed"])
        for name, kind in KINDS.items():
            _check_kind(name, kind, flat)
            if name in OBLIQUE and name in flat:  # friction did nothing to beads that did not slide
                if "sliding_speed" not in flat:
                    reason = f"has to be given with {name} [deg], from the normal; or sliding_speed [m/s]"
                    raise ArgumentError("angle", None, reason)
                if (still := np.isfinite(flat[name]) & (flat["sliding_speed"] == 0.0)).any():
                    n = int(np.argmax(still))
                    reason = "its bead came without sliding: leave this value out, or state the angle"
                    raise ArgumentError(name, flat[name][n], reason, n)
        object.__setattr__(self, "angle", None)
        for name, values in flat.items():
            values.flags.writeable = False
            object.__setattr__(self, name, values)

    def __len__(self) -> int:
        """Count the rebounds."""
        return int(np.size(self.speed))

    def part(self, rows: Collection[int] | Mask) -> Measurements:
        """Keep some of the rebounds."""
        given = {name: values[rows] for name, values in vars(self).items() if values is not None}
        return Measurements(**given)

    def rebound(self, n: int) -> str:
        """Name a rebound by its number, and by its line if that is known."""
        at = "" if self.line is None else f", line {np.asarray(self.line)[n]:.0f}"
        return f"rebound {n}{at}"

    @property
    def is_oblique(self) -> bool:
        """Whether anything was measured that depends on friction."""
        return any(getattr(self, name) is not None for name in OBLIQUE)

    @classmethod
    def of(
        cls,
        data: Measurements | Mapping[str, ArrayLike] | Record,
        unknown: Collection[str] = (),
        density: float = flight.NO_AIR,
    ) -> Measurements:
        """Return measurements as they are, or make them from a mapping of names, as a DataFrame.

        A mapping may have heights and times in place of speeds and COR: ``drop``, ``bounce``,
        ``bounce2``, ... [m], ``t1``, ``t2``, ... [s] from each bounce to the next, and their errors
        ``drop_error``, ``bounce_error`` and ``time_error``, of an instant. Each row is one drop, of
        a bead of this `density` [kg/m3] in air; without it there is no air.

        Of the record of a run these are the COR of its impacts on walls, with the sizes that are
        not `unknown`; `line` is the number of the row. Impacts of clumps are left out with a warning.

        Raises
        ------
        ValueError
            A name that is none of the arguments of this class.
        TypeError
            If `data` is neither measurements nor a mapping.
        """
        if isinstance(data, Measurements):
            return data
        if isinstance(data, Record):
            columns = {*(data.rows.dtype.names or ())}
            of_body = data.rows["kind"] == Kind.OF_BODY if "kind" in columns else False
            if np.any(of_body):
                reason = "a fit takes beads as solid spheres"
                warnings.warn(f"data: {np.sum(of_body)} impacts of rigid bodies are left out: {reason}", stacklevel=4)
            line = np.flatnonzero(data.impact & (data.rows["plate"] >= 0) & ~np.asarray(of_body))
            names = {"restitution", "radius", "thickness"} & columns - {*unknown}
            named = {name: data.rows[name][line] for name in names}
            return cls(data.rows["approach_speed"][line], **named, line=line)
        if not (hasattr(data, "keys") and hasattr(data, "__getitem__")):
            raise TypeError(f"data: expected Measurements, a Record or a mapping of names, got {data!r}")
        known = [field.name for field in fields(cls)]
        named = rebounds_of({str(name): _missing(data[name]) for name in data.keys()}, density)  # noqa: SIM118
        wrong = [name for name in named if name not in known]
        if wrong or "speed" not in named:
            what = f"does not know {', '.join(map(repr, wrong))}" if wrong else "lacks 'speed'"
            raise ArgumentError("data", None, f"{what}; names are {', '.join(known)}, {NAMES}")
        return cls(**named)


def _missing(values: ArrayLike) -> ArrayLike:
    """Replace None in a list by NaN, which says that a value was not measured."""
    if isinstance(values, list | tuple) and any(value is None for value in values):
        return [np.nan if value is None else value for value in values]
    return values


def _check_kind(name: str, kind: Measurable, flat: dict[str, Array]) -> None:
    """Refuse values out of range, and errors that some values lack."""
    values, errors = flat.get(name), flat.get(f"{name}_error")
    if values is None:
        if errors is not None:
            raise ArgumentError(f"{name}_error", None, f"there is no {name} that it is of")
        return
    wrong = ~(np.isnan(values) | ((values >= kind.least) & (values <= kind.largest)))
    if wrong.any():
        n = int(np.argmax(wrong))
        limits = f"{kind.least:g} and {kind.largest:g} [{kind.unit}] ({kind.hint})"
        raise ArgumentError(name, values[n], f"must lie between {limits}", n)
    if np.isnan(values).all():
        raise ArgumentError(name, None, "no rebound has one: leave it out")
    if errors is None:
        return
    measured = np.isfinite(values)
    least = _LEAST_ERROR * np.abs(values)
    bad = measured & ~((errors > 0.0) & (errors >= least) & (errors < np.inf))
    if bad.any():
        n = int(np.argmax(bad))
        where = f"[{kind.unit}] wherever there is a {name}, and at least {_LEAST_ERROR:g} of it"
        reason = f"must be positive {where}; leave all of them out if they are not known"
        raise ArgumentError(f"{name}_error", errors[n], reason, n)

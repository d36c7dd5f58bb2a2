"""The motion of a plate at a point, such as that of a sensor, from all impacts of a record.

Under a unit impulse at a distance r an endless thin plate moves at the speed

    h(r, t) = (2 alpha/pi) sin(a/t)/t,    a = r^2/(4 b),    b = sqrt(D/m),

and it stands at alpha (1 - (2/pi) Si(a/t)) afterwards (Buessow, arXiv physics/0610163; alpha, D, m
as in `contactlaw.physical.plates`). High frequencies arrive first and have no upper limit, so h
must not be sampled. Here each sample is a mean over its interval. It is integrated in closed form, with
a force that is constant, or for the acceleration straight, within each of many steps of the contact.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.histories import Histories, histories_of
from contactlaw.physical.arguments import positive
from contactlaw.record.file import Record

_FINE = 256.0  # least steps of a contact
_STEPS = 4.0  # least steps of a sampling interval
# Time after an impact from which on its force may be replaced by its impulse at the middle of it:
# in the contact time T, and in sqrt(a T). What that changes is 3e-4 of the wave then.
_LATE, _LATE_WAVE = 20.0, 3.0


class PlateSignal(NamedTuple):
    """Motion of a plate at a point, at even times.

    Attributes
    ----------
    time
        Middle of each sampling interval, in the time of the record [s].
    value
        Mean velocity [m/s] or acceleration [m/s2] over the interval; positive away from the beads.
    first_echo
        Time after an impact at which a wave may come back from an edge [s]: that of the fastest
        waves that the rate resolves. What arrives later is not in the signal; inf if no distance
        was given.
    """

    time: Array
    value: Array
    first_echo: float


def plate_signal(
    record: Record,
    wall: int,
    at: ArrayLike,
    rate: float,
    quantity: Literal["velocity", "acceleration"] = "velocity",
    edge_distance: float = math.inf,
) -> PlateSignal:
    """Motion of a wall at a point from all impacts on it, before waves come back from its edges.

    Parameters
    ----------
    record : Record
        Contacts with their materials and laws. The wall is taken as a flat endless plate of one
        material, in which bending waves run.
    wall : int
        Number of the wall.
    at : array_like
        The point on the wall, x, y and z [m].
    rate : float
        Samples per second [1/s]. Each sample is a mean over its interval, so that faster motion is
        filtered out and not folded down. To see the peak of a contact next to the point, take ten
        samples or more in the contact time.
    quantity : {"velocity", "acceleration"}, optional
        What the sensor measures.
    edge_distance : float, optional
        Least distance of the point, and of the impacts, from an edge of the wall [m].

    Returns
    -------
    PlateSignal
        From the first impact until the wave of the last one has passed the point. Contacts without a
        force history are not in it; `Record.spectrum` has their share of the waves' energy.

    Raises
    ------
    ValueError
        As `Record.spectrum`; a wall without impacts, or a half-space; parcels, whose beads do not
        hit at one time; a point that is not in one plane with the impacts, within the wall's
        thickness; a rate so low that all of a wave passes within two samples.

    Notes
    -----
    Above the frequency (pi/18) sqrt(D/m)/H^2 bending waves are shorter than 6 H, with D, m and H the
    stiffness, mass per area and thickness of the wall. There a real plate differs from the thin one
    of this signal: take a rate of twice that at most.

    The time that the signal takes goes as the number of impacts times that of samples, 0.1 us for each.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from contactlaw.engines.record import IMPACT, fill
    >>> pair = cl.Pair("bearing-steel-52100", "steel-s235")
    >>> rows = np.zeros(1, IMPACT)
    >>> rows["approach_speed"], rows["radius"], rows["thickness"], rows["mass"] = 1.0, 1e-3, 1e-3, 3.27e-5
    >>> fill(rows, cl.ImpactModel(pair).lookup([1.0], 1e-3, 1e-3), np.array([1.64e-5]))
    >>> record = cl.Record(rows, [cl.Bodies(pair, "fem")])
    >>> signal = cl.plate_signal(record, wall=0, at=(0.1, 0.0, 0.0), rate=1e6)
    >>> f"{1e3 * signal.value.max():.2f} mm/s after {1e3 * signal.time[signal.value.argmax()]:.2f} ms"
    '3.93 mm/s after 0.06 ms'
    """
    rate = positive("rate", rate, "1/s")
    if quantity not in ("velocity", "acceleration"):
        raise ArgumentError("quantity", quantity, "must be 'velocity' or 'acceleration'")
    on_wall = record.part(record.rows["plate"] == wall)
    found = Histories(*map(np.concatenate, zip(*histories_of(on_wall), strict=True)))
    hit = on_wall.rows[found.row]
    if hit["parcel"].max() > 1.0:
        raise ArgumentError("record", None, "has parcels: their beads do not hit at one time")
    if hit["thickness"].max() == math.inf:
        raise ArgumentError("wall", wall, "is a half-space, in which no bending wave runs")
    distance = _distances(on_wall.points[found.row], at, float(hit["thickness"].max()))
    # At this time after the impact the phase of the wave is 1: it has passed.
    passed = distance**2 / (4.0 * found.spread)
    lasts = found.time[:, -1] + passed
    if rate * lasts.max() < 2.0:
        least = f"must be {2.0 / lasts.max():.3g} or more [1/s], or each wave is in one sample or two"
        raise ArgumentError("rate", rate, least)
    first = math.floor(rate * hit["time"].min())
    begins = hit["time"] - first / rate
    count = math.ceil(rate * (begins + lasts).max())
    edges, motion = np.arange(count + 1) / rate, np.zeros(count)
    for n in range(hit.size):
        interval = int(rate * begins[n])  # in which the contact begins
        contact = found.time[n], found.force[n], found.impulse[n], passed[n]
        changes = _changes(edges[interval:] - begins[n], *contact, quantity == "acceleration")
        motion[interval:] += rate * found.mobility[n] * changes
    echo = math.hypot(distance.min(), 2.0 * edge_distance) / (2.0 * math.sqrt(math.pi * found.spread.max() * rate))
    return PlateSignal((first + np.arange(0.5, count)) / rate, motion, echo)


def _distances(points: Array, at: ArrayLike, thickness: float) -> Array:
    """Distances of impacts from a point in their plane [m]."""
    place = np.asarray(at, dtype=float)
    if place.shape != (3,):
        raise ArgumentError("at", at, "must be the x, y and z of a point [m]")
    every = np.vstack([points, place])
    every -= every.mean(axis=0)
    normal = np.linalg.eigh(every.T @ every)[1][:, 0]  # to the plane that is nearest to all
    if not abs(every @ normal).max() <= thickness:
        raise ArgumentError("at", at, "is not in one plane with the impacts on this wall, within its thickness")
    return np.asarray(np.linalg.norm(points - place, axis=1))


def _changes(edges: Array, time: Array, force: Array, impulse: Array, passed: float, accelerates: bool) -> Array:
    """Change of a plate's displacement, or of its speed if it `accelerates`, over the mobility.

    From edge to edge of sampling intervals, which are times since first touch. The plate follows
    the impulse, or the force, less what the wave has not yet brought: with B(t) the integral of
    Si(a/t), a change of the slope is worth -(2/pi) B(t) a time t later.
    """
    from scipy.interpolate import CubicHermiteSpline
    from scipy.special import sici

    interval, long, lag = edges[1] - edges[0], time[-1], max(passed, 1e-300)  # Ci(0) is infinite
    steps = math.ceil(max(_STEPS, _FINE * interval / long))
    near = int(np.searchsorted(edges[:-1], max(_LATE * long, _LATE_WAVE * math.sqrt(lag * long))))
    fine = np.arange(near * steps + 1) * (interval / steps)
    curve = CubicHermiteSpline(time, impulse, force)
    follows = curve(np.clip(edges[0] + fine, 0.0, long), int(accelerates))
    bends = np.trim_zeros(np.diff(follows, 2, prepend=0.0) / fine[1], "b")
    sine, cosine = sici(lag / fine[1:])
    brought = fine[1:] * (sine + np.sin(lag / fine[1:])) - lag * cosine
    follows[1:] -= 2.0 / math.pi * np.convolve(bends, brought)[: brought.size]
    whole = impulse[-1]
    late = edges[near:] - long + time[1] * (impulse.sum() / whole - 0.5)  # since the mean time of the force
    moved = np.sin(lag / late) / late if accelerates else -sici(lag / late)[0]
    return np.append(np.diff(follows[::steps]), 2.0 / math.pi * whole * np.diff(moved))

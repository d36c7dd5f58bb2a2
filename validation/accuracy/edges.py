"""Impacts near a straight edge of a thin plate: ``python -m validation.accuracy.edges``.

This solution by finite elements judges the package's answer near an edge, and shares no code with
it. The plate is a strip that repeats along its edge: waves along the edge, cubic beam elements
across. The bending energy of Kirchhoff's plate,

    D/2 integral of (w_xx + w_yy)^2 - 2 (1 - nu) (w_xx w_yy - w_xy^2),

makes a free edge free without any condition. Each wave has its modes, and a mode's answer to a
force that is linear between samples is exact. Only the force of the law "fem" is the package's
own, as a function of the compression and of the largest one so far.

Units. Plate: D = rho h = 1, so that a force F moves a large plate at the speed F/8; lengths in
sqrt(T) for a time T that the plate is followed. Impact: Hertz's scale, as in
`contactlaw.equation.zener`, where a large plate moves at lambda f; distances from the edge in
sqrt(b T_H) with b = sqrt(D/(rho h)).
"""

from __future__ import annotations

import csv
import functools
import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.linalg import cholesky, eigh, solve_triangular
from scipy.optimize import brentq

from contactlaw.laws import fem

Array = NDArray[np.float64]

FILE = Path(__file__).parent.parent / "data/edges.csv"
EDGES = ("free", 0.2), ("free", 0.3), ("free", 0.5), ("supported", 0.3), ("clamped", 0.3)
INELASTICITIES = 0.03, 0.1, 0.3, 1.0
DISTANCES = 0.15, 0.3, 0.6, 1.2, 2.4, 4.8  # [sqrt(b T_H)]; steps of 2 share plates, see `SPANS`
OVERLOADS = {"hertz": (0.0,), "myc": (10.0, 100.0), "fem": (1.0, 10.0, 100.0)}
SPANS = 8.0, 32.0  # times for which the plate is followed [T_H]: the second for long contacts
# Gamma-alumina on glass, where only the sphere yields: first numbers of `contactlaw.laws.fem.PARAMETERS`.
FEM = 23.2, 0.0, 0.1435, 0.21, 0.21
_TRUSTED = 0.75  # share of that time in which no wave has come back from the far boundary
_HELD = {"free": 0, "supported": 1, "clamped": 2}  # of deflection and slope at the edge


class Resolution(NamedTuple):
    """How finely a plate and its time are resolved."""

    wave_number: float  # largest one along the edge; elements have a quarter of that wavelength
    width: float  # from the force to the far boundary, which is clamped
    length: float  # after which the plate and the force repeat along the edge
    samples: int  # of the time


COARSE = Resolution(24.0, 7.0, 14.0, 400)
FINE = Resolution(32.0, 9.0, 18.0, 800)


class Response(NamedTuple):
    """Motion of a plate under the force, over that of a large plate, at even times up to 1."""

    time: Array
    velocity: Array  # under a constant force: G, which is 1 for a large plate
    displacement: Array  # the integral of G
    ramp: Array  # displacement under a force that grows like the time


class Impact(NamedTuple):
    """One impact on Hertz's scale; energies as shares of the initial one."""

    restitution: float  # of the speed, when the bodies first part; may be negative
    contact_time: float  # inf: they are together still when the plate is no longer followed
    peak_compression: float
    plate_fraction: float  # work on the plate
    struck_again: bool  # the plate swings back and hits the sphere while it is followed


@functools.lru_cache(maxsize=32)
def response(edge: str, nu: float, distance: float, resolution: Resolution = FINE) -> Response:
    """Find how a plate moves at the force, at a distance from its edge, at times up to 1.

    Parameters
    ----------
    edge : str
        "free", "supported" or "clamped".
    nu : float
        Poisson's ratio of the plate, which matters at a free edge only.
    distance : float
        From the edge to the force; by similarity, s/sqrt(b T) for a plate followed for a time T.
    resolution : Resolution
        How finely the plate and the time are resolved.

    Returns
    -------
    Response
        Motion of the plate. The velocity is smoothed: without the highest modes it lacks what
        happens within about 10/wave_number^2. Impacts need only the ramp, which has all of it.
    """
    top, width, length, samples = resolution
    time, step = np.linspace(0.0, 1.0, samples + 1), 2.0 * math.pi / length
    size = 0.5 * math.pi / top
    inner = max(4, math.ceil(distance / size))
    outer = np.linspace(0.0, width, math.ceil(width / size) + 1)
    nodes = np.concatenate([np.linspace(0.0, distance, inner + 1)[:-1], distance + outer])
    bending, twist, mass = _beams(nodes, nu, _HELD[edge])
    root = cholesky(mass, lower=True)

    def without_mass(matrix: Array) -> Array:
        half = solve_triangular(root, matrix, lower=True)
        return np.asarray(solve_triangular(root, half.T, lower=True))

    bending, twist = without_mass(bending), without_mass(twist)
    unit = np.zeros(len(root))
    unit[2 * inner - _HELD[edge]] = 1.0
    force = solve_triangular(root, unit, lower=True)
    velocity, displacement, ramp = np.zeros((3, time.size))
    waves = math.ceil(top / step)
    for n in range(waves + 1):
        xi = n * step
        squares, modes = eigh(bending + xi**2 * twist, driver="evd", check_finite=False)
        omega = np.sqrt(np.maximum(squares + xi**4, 1e-12))
        share = (force @ modes) ** 2 * 8.0 / math.pi * step * (0.5 if n in (0, waves) else 1.0)
        # Modes far above the largest wave number follow the force at once.
        moving = omega < 9.0 * top**2
        at_once = float((share / omega**2)[~moving].sum())
        omega, share = omega[moving], share[moving]
        phase = np.outer(time, omega)
        sine, flexible = np.sin(phase), share / omega**2
        # Leaving out the highest modes gradually keeps the velocity from ringing.
        velocity += sine @ (share / omega * np.exp(-((1.5 * omega / top**2) ** 4)))
        displacement += (1.0 - np.cos(phase)) @ flexible + at_once
        ramp += time * (flexible.sum() + at_once) - sine @ (flexible / omega)
    rest = _at_once(edge, nu, distance, waves * step)
    displacement[1:] += rest
    displacement[0] = 0.0
    return Response(time, velocity, displacement, ramp + rest * time)


def _beams(nodes: Array, nu: float, held: int) -> tuple[Array, Array, Array]:
    """Matrices of the plate for a wave cos(xi x): K = bending + xi^2 twist + xi^4 mass, and mass.

    Unknowns are deflection and slope at each node, without those that the boundaries hold.
    """
    at, weight = leggauss(4)
    t, weight = 0.5 * (at + 1.0), 0.5 * weight
    bending, mixed, slopes, mass = np.zeros((4, 2 * nodes.size, 2 * nodes.size))
    for n, h in enumerate(np.diff(nodes)):
        shape = np.array([1 - 3 * t**2 + 2 * t**3, h * (t - 2 * t**2 + t**3), 3 * t**2 - 2 * t**3, h * (t**3 - t**2)])
        slope = np.array([6 * (t**2 - t) / h, 1 - 4 * t + 3 * t**2, 6 * (t - t**2) / h, 3 * t**2 - 2 * t])
        bend = np.array([(12 * t - 6) / h**2, (6 * t - 4) / h, (6 - 12 * t) / h**2, (6 * t - 2) / h])
        here, dy = slice(2 * n, 2 * n + 4), weight * h
        bending[here, here] += (bend * dy) @ bend.T
        mixed[here, here] += (bend * dy) @ shape.T + (shape * dy) @ bend.T
        slopes[here, here] += (slope * dy) @ slope.T
        mass[here, here] += (shape * dy) @ shape.T
    inside = slice(held, -2)
    twist = 2.0 * (1.0 - nu) * slopes - nu * mixed
    return bending[inside, inside], twist[inside, inside], mass[inside, inside]


def _at_once(edge: str, nu: float, distance: float, lowest: float) -> float:
    """Sum the static displacement by the waves above a wave number, over that of a large plate.

    They are faster than the contact. Far above 1/distance the edge does not matter, and a wave's
    flexibility is 1/(4 xi^3).
    """
    highest = max(30.0 / distance, 2.0 * lowest)
    at, weight = leggauss(12)
    span = 0.5 * math.log(highest / lowest)
    total = 1.0 / (8.0 * highest**2)
    for xi, share in zip(lowest * np.exp((at + 1.0) * span), weight * span, strict=True):
        total += share * xi * _flexibility(edge, nu, distance, xi)
    return 8.0 / math.pi * total


def _flexibility(edge: str, nu: float, distance: float, xi: float) -> float:
    """Solve for the static displacement at the force by one wave."""
    reach = 16.0 / xi  # where the displacement has died out
    outer = distance + reach * np.linspace(0.0, 1.0, 101) ** 1.5
    begin, held = (distance - reach, 2) if distance > reach else (0.0, _HELD[edge])
    nodes = np.concatenate([np.linspace(begin, distance, 81)[:-1], outer])
    bending, twist, mass = _beams(nodes, nu, held)
    unit = np.zeros(len(mass))
    unit[2 * 80 - held] = 1.0
    return float(np.linalg.solve(bending + xi**2 * twist + xi**4 * mass, unit) @ unit)


class Law:
    """Contact force over compression, both on Hertz's scale; y is the yield compression there."""

    def __init__(self, name: str, y: float) -> None:
        self.y, self.largest, self.residual = y, 0.0, 0.0
        self._fem = fem.law(*FEM) if name == "fem" else None
        self._myc = name == "myc"
        self._unload: Callable[[float], float] = lambda w: 0.0

    def loading(self, w: float) -> float:
        """Give the force at a compression that is the largest so far."""
        if self._fem:
            return float(self.y**1.5 * self._fem.loading(math.sqrt(w / self.y)))
        flow = 2.14 / 0.68 * self.y  # Peng et al. 2021, Eq. 16
        if self._myc and w > flow:
            return float(flow**1.5 + 1.5 * math.sqrt(flow) * (w - flow))
        return float(w**1.5)

    def reach(self, w: float) -> None:
        """Note a compression; if it is the largest so far, unloading begins there."""
        if w <= self.largest:
            return
        self.largest, over = w, w / self.y
        if self._fem:
            law, curve, left = self._fem, self._fem.unloading_curve(over), self._fem.residual(over)
            self._unload = lambda w: self.y**1.5 * law.unloading(math.sqrt(max(w / self.y - left, 0.0)), curve)
        else:  # Eqs. 17 and 18
            left = over - math.sqrt(2.0 * over - 1.0) if self._myc and over > 1.0 else 0.0
            top, rest = self.loading(w), left * self.y if left else 0.0
            self._unload = lambda at: top * (max(at - rest, 0.0) / (w - rest)) ** 1.5
        self.residual = left * self.y if left else 0.0

    def force(self, w: float) -> float:
        """Give the force at any compression."""
        return self.loading(w) if w > self.largest else self._unload(w)


def cor_near_edge(
    law: str,
    inelasticity: float,
    yield_compression: float,
    edge: str,
    distance: float,
    nu: float = 0.3,
    resolution: Resolution = FINE,
) -> Impact:
    """Follow an impact near an edge until the bodies first part.

    Parameters
    ----------
    law : str
        "hertz", "myc", or "fem" of the bodies `FEM`.
    inelasticity : float
        Lambda.
    yield_compression : float
        d_Y/(V0 T_H); of no meaning to "hertz".
    edge, nu, resolution
        As `response` takes them.
    distance : float
        From the edge to the contact, s/sqrt(b T_H).

    Returns
    -------
    Impact
        The restitution is negative if the sphere still moves towards the plate when they part,
        because a plate that gives way much goes ahead of it, or if they do not part.
    """
    for span in SPANS:
        plate = response(edge, nu, distance / math.sqrt(span), resolution)
        found = _follow(Law(law, yield_compression), inelasticity, span, plate)
        if found.contact_time < math.inf:
            break
    return found


def _follow(law: Law, lam: float, span: float, plate: Response) -> Impact:
    """Integrate with forces that are linear between samples.

    Sphere and plate move exactly under such a force, so each step solves w = free - soft f(w).
    """
    steps = plate.time.size - 1
    dt = span / steps
    # Displacement of the plate, so many steps after the force has risen by 1 within one step.
    after = lam * span**2 / dt * np.diff(plate.ramp)
    soft = dt**2 / 6.0 + after[0]
    force, rise, moved = np.zeros((3, steps + 1))
    sphere, speed, w, work = 0.0, 1.0, 0.0, 0.0
    contact_time, again = math.inf, False
    for n in range(1, int(_TRUSTED * steps)):
        before = force[n - 1]
        # Positions at the end of the step if the force falls to zero within it.
        sphere += speed * dt - dt**2 / 3.0 * before
        moved[n] = rise[1:n] @ after[n - 1 : 0 : -1] - before * after[0]
        free = sphere - moved[n]
        if free <= law.residual:
            part = (w - law.residual) / (w - free)  # of the step, until they part
            contact_time = (n - 1 + part) * dt
            speed -= 0.4 * before * part * dt  # the force falls like the power 3/2
            work += 0.4 * before * part * (moved[n] - moved[n - 1])
            rise[n] = -before
            times = np.arange(1, steps - n + 1) * dt
            swings = np.convolve(rise[1:], after)[n:steps]
            again = bool((sphere + speed * times - swings > law.residual).any())
            break

        def gap(w: float, free: float = free) -> float:
            return float(w + soft * law.force(w) - free)

        w = brentq(gap, law.residual, free, xtol=1e-14)
        force[n] = law.force(w)
        law.reach(w)
        rise[n] = force[n] - before
        moved[n] += force[n] * after[0]
        sphere -= dt**2 / 6.0 * force[n]
        speed -= 0.5 * dt * (before + force[n])
        work += 0.5 * (before + force[n]) * (moved[n] - moved[n - 1])
    return Impact(-float(speed), float(contact_time), law.largest, 2.0 * float(work), again)


def on_large_plate(law: str, inelasticity: float, yield_compression: float, span: float) -> Impact:
    """Follow an impact far from any edge for a time; the paper's equation, for checks.

    Examples
    --------
    >>> round(on_large_plate("hertz", 0.0, 1.0, 8.0).restitution, 3)
    1.0
    """
    time = np.linspace(0.0, 1.0, FINE.samples + 1)
    plate = Response(time, np.ones_like(time), time, 0.5 * time**2)
    return _follow(Law(law, yield_compression), inelasticity, span, plate)


def rows() -> Iterator[dict[str, Any]]:
    """Compute all cases; `error` is the change of the restitution from `COARSE` to `FINE`."""
    scales = [(lam, on_large_plate("hertz", lam, math.inf, 8.0).peak_compression) for lam in INELASTICITIES]
    for (edge, nu), distance in ((edge, distance) for edge in EDGES for distance in DISTANCES):
        for lam, scale in scales:
            for law, overload in ((name, chi) for name in OVERLOADS for chi in OVERLOADS[name]):
                y = float(f"{scale / overload:.4g}") if overload else math.inf
                case = law, lam, y, edge, distance, nu
                coarse, fine = (cor_near_edge(*case, each) for each in (COARSE, FINE))
                error = abs(fine.restitution - coarse.restitution)
                yield {
                    "edge": edge,
                    "poissons_ratio": nu,
                    "distance": distance,
                    "inelasticity": lam,
                    "law": law,
                    "yield_compression": y,
                    **{
                        name: int(value) if name == "struck_again" else f"{value:.5f}"
                        for name, value in fine._asdict().items()
                    },
                    "error": f"{error:.1e}",
                }


def main() -> int:
    """Write `FILE` and print its rows; it takes a few minutes."""
    found = []
    for row in rows():
        print(*row.values(), sep="\t", flush=True)
        found.append(row)
    with FILE.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(found[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(found)
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Walls whose mobility was measured or computed: finite plates with their modes, panels on frames."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.equation.edge import SIZE
from contactlaw.physical.arguments import positive
from contactlaw.physical.materials import Material, resolve

SHORTEST = 0.5  # [longest]; in shorter contacts the smoothing of the response would show
_SMOOTH = 40.0  # [1/longest] angular frequency at which the response is damped by 1/e
_BAND = 13.0  # [1/longest] frequency up to which data have to reach; there it is damped by exp(-4)
_SAMPLES = 241  # of the response, from 0 to the longest contact
_EARLY = 4.0  # [1/longest] rate by which late parts of the response count less in the choice of rates
_UNSURE = 0.02  # largest difference of what the two parts of the data say comes back
_SPECTRUM = 200  # frequencies that stand for all modes of a clamped plate
_WORST = 0.06  # of the error; up to there the COR of elastic impacts is within 0.002 at lambda 0.5


class Mobility:
    """A wall that answers a force at the place of impact with a measured or computed speed.

    What the wall sends back within the contact is fitted by twelve exponentials, weighted as it
    counts in the work of a force sin^2 of the longest contact.

    Parameters
    ----------
    contact : Material or str
        Material of the contact, the plate of the model's pair.
    frequency : array_like, shape (n,)
        Rising frequencies [Hz], from at most 1/(4 longest) to at least 13/longest, in steps of at
        most 1/(4 longest).
    value : array_like, shape (n,)
        Driving-point mobility, speed over force [m/(s N)]: complex, or its real part, on which the
        answer rests; the imaginary part serves to judge the data.
    longest : float
        Longest contact that is asked for [s]; the shortest is half of it.
    endless : float, optional
        Mobility without what comes back, 1/(8 sqrt(D m)) of a plate [m/(s N)]; by default the mean
        of the real part over the upper half of the band.

    Attributes
    ----------
    error : float
        Error of the response [-], over the mobility without what comes back, root mean square.
    endless : float
        As given or found.

    Raises
    ------
    ValueError
        Data that do not cover the contact, a negative real part, or a response that twelve
        exponentials do not fit within 0.06.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("glass", "steel-s235"))
    >>> wall = cl.Mobility.of_plate("steel-s235", 1e-3, (0.02, 0.02), (0.01, 0.01), longest=2.4e-5)
    >>> round(model.solve(1.0, 3e-3, wall).restitution, 2), round(model.solve(1.0, 3e-3, 1e-3).restitution, 2)
    (0.32, 0.29)
    """

    def __init__(
        self,
        contact: Material | str,
        frequency: ArrayLike,
        value: ArrayLike,
        longest: float,
        endless: float | None = None,
    ) -> None:
        span = positive("longest", longest, "s")
        f, whole = np.asarray(frequency, float), np.asarray(value)
        y = whole.real
        if f.ndim != 1 or f.shape != y.shape or f.size < 2 or not (np.diff(f) > 0.0).all() or not f[0] >= 0.0:
            raise ArgumentError("frequency", None, "expected rising frequencies [Hz], and a value for each")
        if not (np.isfinite(y).all() and (y >= 0.0).all()):
            n = int(np.argmin(np.where(np.isfinite(y), y, -math.inf)))
            reason = f"{y[n]:.4g} at {f[n]:g} Hz: a wall that only takes energy has no negative real part"
            raise ArgumentError("value", None, reason)
        if max(f[0], np.diff(f).max()) * span > 0.25 or f[-1] * span < _BAND:
            need = f"from {0.25 / span:.4g} Hz, in steps of at most that, to {_BAND / span:.4g} Hz"
            raise ArgumentError("frequency", None, f"does not cover contacts of {span:g} s: give it {need}")
        if endless is None:
            endless = float(y[f >= 0.5 * f[-1]].mean())
        f, y = np.append(0.0, f), np.append(y[0], y)  # as at the lowest frequency
        late = np.append(0.0, whole.imag) if np.iscomplexobj(whole) else None
        width = np.gradient(f)
        width[[0, -1]] *= 0.5
        # response to an impulse from the real part alone, which holds for what answers after its cause
        both = 4.0 * width * y, None if late is None else 4.0 * width * late
        self._fit(contact, positive("endless", endless, "m/(s N)"), 2.0 * math.pi * f, *both, span)

    def __repr__(self) -> str:
        return f"Mobility({self.contact.name!r}, ..., longest={self.longest:g})"

    @classmethod
    def of_plate(
        cls,
        contact: Material | str,
        thickness: float,
        size: tuple[float, float],
        place: tuple[float, float],
        longest: float,
        edges: str = "supported",
    ) -> Mobility:
        """Mobility of a rectangular plate, from its modes.

        Parameters
        ----------
        contact : Material or str
            Material of the plate.
        thickness : float
            Its thickness [m].
        size, place : (float, float)
            Lengths of its sides, and distances of the impact from two of them [m].
        longest : float
            As in `Mobility`.
        edges : {"supported", "clamped"}, optional
            How all four are held.
        """
        if edges not in ("supported", "clamped"):
            raise ArgumentError("edges", edges, "must be supported or clamped")
        body = resolve("contact", contact)
        h, span = positive("thickness", thickness, "m"), positive("longest", longest, "s")
        (a, b), (x, y) = ((positive(n, v, "m") for v in pair) for n, pair in (("size", size), ("place", place)))
        if not (x < a and y < b):
            raise ArgumentError("place", place, f"must lie within the plate of {a:g} m by {b:g} m")
        bending, areal = body.plane_modulus * h**3 / 12.0, body.density * h
        path, highest = math.sqrt(bending / areal), 2.0 * _SMOOTH / span
        waves = math.sqrt(highest / path) / math.pi
        if edges == "clamped":
            omega, strength = _clamped(_beams(a, x, waves), _beams(b, y, waves))
        else:
            m, n = (np.arange(1, int(waves * side) + 2) for side in (a, b))
            omega = math.pi**2 * ((m / a) ** 2 + ((n / b) ** 2)[:, None]).ravel()
            strength = 4.0 * (np.sin(m * math.pi * x / a) * np.sin(n * math.pi * y / b)[:, None]).ravel() ** 2
        made = cls.__new__(cls)
        endless = 1.0 / (8.0 * math.sqrt(bending * areal))
        made._fit(body, endless, path * omega, strength / (areal * a * b), None, span)
        return made

    def _fit(
        self, contact: Material | str, endless: float, omega: Array, strength: Array, late: Array | None, longest: float
    ) -> None:
        """Fit the response that is a sum of sines, strength sin(omega t)/omega.

        That of cosines with the strengths `late` is the same, but for a constant, if the answer
        comes after its cause. What differs is an error: of the data, or because their steps are
        wider than a resonance.
        """
        body = resolve("contact", contact)
        self.endless, self.longest, self.contact = endless, longest, body
        self.thickness = math.sqrt(math.sqrt(3.0) / (4.0 * endless * math.sqrt(body.density * body.plane_modulus)))
        t, cut = np.linspace(0.0, 1.0, _SAMPLES), _SMOOTH
        w = omega * longest
        damped = strength * longest / endless * np.exp(-((w / cut) ** 2))
        wave = np.array([(damped * np.sinc(w * one / math.pi)).sum() * one for one in t])
        # of an endless plate this smoothing makes the error function
        back = wave - np.array([math.erf(0.5 * cut * one) for one in t])
        rates = _rates(back, t[1])
        columns, blocks = [], []
        for first, second in rates:
            one = 1.0 - np.exp(-first * t)
            columns += [one.real, (1.0 - np.exp(-second * t)).real if second else one.imag]
            turn, other = float(first.imag), float(first.real if second is None else second)
            blocks.append([first.real, other, turn, turn or other])
        matrix = np.array(columns).T
        force = np.sin(math.pi * t) ** 2
        overlap = np.correlate(force, force, "full")[_SAMPLES - 1 :] / (force @ force)
        counts = np.sqrt(np.maximum(-np.gradient(overlap, t), 0.02) / _SAMPLES)
        wide = matrix.shape[1]
        system = np.vstack([matrix * counts[:, None], 1e-5 * np.eye(wide)])
        weights = np.linalg.lstsq(system, np.append(back * counts, np.zeros(wide)), rcond=None)[0]
        self.error = float(np.linalg.norm((matrix @ weights - back) * counts))
        if late is not None:
            w, damped = w[w > 0.0], (late * longest / endless * np.exp(-((w / cut) ** 2)))[w > 0.0]
            other = back - np.array([(damped / w * np.cos(w * one)).sum() for one in t])
            other -= other[: _SAMPLES // 10].mean()
            unsure = float(np.linalg.norm(other * counts))
            if not unsure <= _UNSURE:
                reason = f"real and imaginary part differ by {unsure:.2g} in what comes back, not by {_UNSURE} at most"
                raise ArgumentError("value", None, f"{reason}: are the steps finer than the resonances are wide?")
            self.error = math.hypot(self.error, unsure)
        if not self.error <= _WORST:
            reason = f"twelve exponentials fit this wall to {self.error:.2g} of its mobility, not to {_WORST}"
            raise ArgumentError("longest", longest, f"{reason}: ask for shorter contacts")
        self.response = np.zeros(2 * SIZE)
        for n, block in enumerate(blocks):
            at = SIZE * (n // 3)
            self.response[at + 4 * (n % 3) : at + 4 * (n % 3) + 4] = block
            self.response[at + 12 + 2 * (n % 3) : at + 14 + 2 * (n % 3)] = weights[2 * n : 2 * n + 2]


def _beams(side: float, place: float, waves: float) -> tuple[Array, Array, Array]:
    """Wave numbers of a beam that is clamped at both ends, its modes at a place, products of slopes.

    Products of two such modes are what a clamped plate moves in; they are no modes of it, for the
    slopes of different ones are not orthogonal.
    """
    n, at = np.arange(int(waves * side) + 2), place / side
    k = np.asarray((n + 1.5) * math.pi, np.float64)
    for _ in range(8):  # cos(k) cosh(k) = 1
        k += (np.cos(k) - 1.0 / np.cosh(np.minimum(k, 700.0))) / np.sin(k)
    e = np.exp(-k)
    below = 1.0 - e * e - 2.0 * e * np.sin(k)
    s = (1.0 + e * e - 2.0 * e * np.cos(k)) / below
    grows = (np.cos(k) - e - np.sin(k)) / below * np.exp(k * (at - 1.0))
    shape = grows + 0.5 * (1.0 + s) * np.exp(-k * at) - np.cos(k * at) + s * np.sin(k * at)
    other, gap = k[:, None], k**4 - k[:, None] ** 4
    np.fill_diagonal(gap, 1.0)
    slopes = 8.0 * (k * other) ** 2 * (s[:, None] * other - s * k) / gap * ((n + n[:, None]) % 2 == 0)
    np.fill_diagonal(slopes, s * k * (s * k - 2.0))
    return k / side, shape, slopes / side**2


def _clamped(along: tuple[Array, Array, Array], across: tuple[Array, Array, Array]) -> tuple[Array, Array]:
    """Angular frequencies over sqrt(D/m) and strengths of a plate, by Ritz's method and Lanczos'.

    Some frequencies stand for all modes: they are those of Gauss's quadrature, which is exact for
    polynomials, as the response is in a time that is short.
    """
    stiff, pulled = along[0][:, None] ** 4 + across[0] ** 4, np.outer(along[1], across[1])
    basis, middle, beside = np.zeros((min(_SPECTRUM, stiff.size), *stiff.shape)), [], []
    whole = left = float(np.linalg.norm(pulled))
    for n in range(len(basis)):
        basis[n] = q = pulled / left
        pulled = stiff * q + 2.0 * along[2] @ q @ across[2]
        middle.append(float((q * pulled).sum()))
        for _ in range(2):
            pulled -= np.tensordot(np.tensordot(basis[: n + 1], pulled, 2), basis[: n + 1], 1)
        left = float(np.linalg.norm(pulled))
        if left < 1e-9 * stiff.max():
            break  # all modes that move the place are found
        beside.append(left)
    square, vectors = np.linalg.eigh(np.diag(middle) + np.diag(beside[:n], -1))  # it reads what is below
    return np.sqrt(square), (whole * vectors[0]) ** 2


def _rates(back: Array, step: float) -> list[tuple[Any, Any]]:
    """Rates of a response, complex ones alone and real ones in pairs: from its shifts in time.

    The space of all its stretches is spanned by a few, on which a shift by one sample acts (ESPRIT,
    Roy & Kailath 1989).
    """
    moved = np.diff(back) * np.exp(-_EARLY * step * np.arange(back.size - 1))
    stretches = np.lib.stride_tricks.sliding_window_view(moved, back.size // 2)
    space = np.linalg.svd(stretches.T, full_matrices=False)[0][:, :12]
    shift = np.linalg.lstsq(space[:-1], space[1:], rcond=None)[0]
    with np.errstate(divide="ignore"):
        found = -np.log(np.linalg.eigvals(shift).astype(complex)) / step - _EARLY
    found = np.maximum(found.real, 0.05) + 1j * found.imag  # none grows
    turning = [one for one in found if 1e-6 < one.imag < 0.99 * math.pi / step]
    real = [float(one.real) for one in found if abs(one.imag) <= 1e-6]
    real += [_EARLY] * (len(real) % 2)
    return [(one, None) for one in turning] + list(zip(real[::2], real[1::2], strict=True))

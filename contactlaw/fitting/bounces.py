"""Speeds and CORs of beads that bounce, from the sound of their impacts or from noted times."""

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Integers, Places
from contactlaw._errors import ArgumentError
from contactlaw.fitting.drops import METRES, rebounds_of
from contactlaw.physical import flight
from contactlaw.physical.arguments import number, positive, within
from contactlaw.table.cache import progress_bar

# All numbers are our choice, by the recordings of validation/hostile/recordings.py.
_RATE, _MOST = 16e3, 120.0  # least samples in a second; longest recording [s], which takes 0.5 GB
_FRAME = 1e-3  # [s] steps of the spectrum, whose window is four times as long
_BAND = 400.0, 16e3  # [Hz] in which impacts are sought
_SURE, _RISE = 6.0, 0.2  # least rise of the spectrum in deviations of the noise's, and in logarithms
_ORDER, _PAST = 48, 30e-3  # linear prediction of an impact from the ringing before it, of this time [s]
_INSTANT = 5e-5  # [s] least error of an instant; contacts last about so long
_SHORTEST, _LONGEST = 0.02, 1.5  # [s] between two bounces
_NEXT = 6  # impacts among which the next bounce of a bead is sought
_FEWEST = 5  # impacts of a bead, or one more if another bounces meanwhile, or two if its COR is not steady
_SHRINKS = 0.85  # largest ratio of the last time between bounces to the first: clocks tick evenly
_FADES = 0.2  # least power of the speed with which the loudness grows, which is 1 but for noise and places
_SCATTER, _STEADY = 0.08, 0.03  # most by which a COR is off the one before; where few bounces are enough
_SLOWER = 0.2  # power of the COR with which it rises to that of the next bounce, which is slower, at most
_OF_DROP = 0.85, 1.2  # ratio of the second COR to the first of a drop, from which the air is not taken off
_LOUDER = 1.6  # most by which a bounce is louder than the root of the COR makes it: sound depends on the place, too
_ECHO, _FAINT = 80e-3, 0.8  # [s] until an echo, and how loud it is at most beside its impact
_STRANGERS = 0.2  # largest number of other impacts during a series, over the number of its own
_CROWD = 20  # other impacts in a recording, among which five may follow each other by chance
_UNSURE = 0.0025  # a COR with a larger standard error is left out


@dataclass(frozen=True, eq=False)
class Bounces:
    """Bounces that were heard, which `fit` takes as ``{**found, "radius": radius}``.

    Attributes
    ----------
    at : ndarray (n,)
        Time of each bounce that has a COR [s].
    speed : ndarray (n,)
        Its speed of approach [m/s].
    restitution : ndarray (n,)
        Its COR [-].
    restitution_error : ndarray (n,) or None
        Standard error, of the instants, or by how far CORs are off their neighbours if that is more;
        None if nothing is known of these.
    drop : ndarray of int (n,)
        Number of the drop that it belongs to, from 0.
    impacts : tuple of ndarray
        Times of all bounces of each drop [s].
    """

    at: Array
    speed: Array
    restitution: Array
    restitution_error: Array | None
    drop: Integers
    impacts: tuple[Array, ...]

    def keys(self) -> list[str]:
        """Names of what `fit` takes."""
        return ["speed", "restitution", *["restitution_error"] * (self.restitution_error is not None)]

    def __getitem__(self, name: str) -> Array:
        return np.asarray(getattr(self, name))


def bounces(
    samples: ArrayLike,
    rate: float,
    drop: float | None = None,
    *,
    radius: float | None = None,
    density: float | None = None,
) -> Bounces:
    """Hear a bead that is dropped and bounces on a plate: speeds and CORs from the times between bounces.

    Parameters
    ----------
    samples : array_like (n,) or (n, channels)
        The recording, as `scipy.io.wavfile.read` gives it; floats lie between -1 and 1.
    rate : float
        Samples in a second, at least 16000.
    drop : float, optional
        Height from which each bead fell from rest [m], for the speed and the COR of the first bounce.
    radius, density : float, optional
        Of the beads [m, kg/m3], whose drag in air is then taken off.

    Returns
    -------
    Bounces
        Those whose COR is known within a standard error of 0.0025, as far as the instants go.

    Raises
    ------
    ValueError
        A silent or a clipped recording, or one in which nothing bounces.
    ImportError
        Without scipy.

    Notes
    -----
    A bead has to bounce five times or more, with hardly another sound meanwhile. A voice, ticks of
    a clock and echoes are left out.

    Examples
    --------
    >>> import contactlaw as cl
    >>> rate, sound = 44100, np.random.default_rng(1).normal(0.0, 0.001, 88200)
    >>> for n, at in enumerate(0.2 + 0.5 * np.array([0.0, 0.8, 1.44, 1.952, 2.3616, 2.68928])):
    ...     t = np.arange(4410) / rate
    ...     sound[round(at * rate) :][:4410] += 0.8**n * np.exp(-t / 0.01) * np.sin(2 * np.pi * 3000 * t) / 2
    >>> found = cl.bounces(sound, rate)
    >>> found.speed.round(2), found.restitution.round(2)
    (array([1.96, 1.57, 1.26, 1.  ]), array([0.8, 0.8, 0.8, 0.8]))
    """
    x = _checked(samples, rate)
    t, error, strength = _impacts(x, rate)
    series = list(_series(t, strength))
    if not series:
        reason = f"{t.size} impacts, but no {_FEWEST} that follow each other as the bounces of a bead do"
        raise ArgumentError("samples", None, f"{reason}: let it bounce on, beside the microphone, in silence")
    measured = {tuple(t[one].tolist()): _measured(t[one], error[one], drop, radius, density) for one in series}
    found = {impacts: one for impacts, one in measured.items() if one[0].size}
    if not found:
        reason = f"no COR is known within {_UNSURE:g}, as bounces follow each other too soon: drop it from higher up"
        raise ArgumentError("samples", None, reason)
    at, speed, cor, errors = (np.concatenate(part) for part in zip(*found.values(), strict=True))
    number = np.repeat(np.arange(len(found)), [one[0].size for one in found.values()])
    return Bounces(at, speed, cor, errors, number, tuple(map(np.array, found)))


def of_times(
    times: ArrayLike, drop: float | None, radius: float | None = None, density: float | None = None
) -> Bounces:
    """Find speeds and CORs from the times of all bounces of one drop [s], of which no errors are known."""
    t = np.asarray(times, dtype=np.float64)
    wrong = ~((np.diff(t) > 0.0) & np.isfinite(t[1:]))
    if wrong.any():
        n = int(np.argmax(wrong)) + 1
        reason = "times of bounces have to rise; `contactlaw fit` takes times between them, as columns t1, t2, ..."
        raise ArgumentError("times", t[n], reason, n)
    if t.size < 3 - (drop is not None):
        raise ArgumentError("times", t.tolist(), "a COR takes three bounces, or two and the height of the drop")
    at, speed, cor, _ = _measured(t, 0.0 * t, drop, radius, density)
    return Bounces(at, speed, cor, None, np.zeros(at.size, dtype=np.int64), (t,))


def _measured(
    t: Array, error: Array, drop: float | None, radius: float | None, density: float | None
) -> Sequence[Array]:
    """Find times, speeds, CORs and their errors of the bounces of one drop."""
    if (radius is None) != (density is None):
        raise ArgumentError("radius, density", None, "the air is taken off with both, and left in without both")
    gaps, at = np.diff(t), t[1:-1]
    worst = np.max([error[:-2], error[1:-1], error[2:]], axis=0)
    rows = {"drop": np.full(at.size, np.nan), "t1": gaps[:-1], "t2": gaps[1:], "time_error": worst}
    if drop is not None:
        within("drop", np.array([number("drop", drop)]), *METRES)
        first = 0.5 * flight.GRAVITY * gaps[0] / math.sqrt(2.0 * flight.GRAVITY * drop)
        if t.size > 2 and not (first < 1.0 and _OF_DROP[0] < gaps[1] / gaps[0] / first < _OF_DROP[1]):
            said = f"the bounce at {t[0]:.3f} s is not the first after a drop from {drop:g} m, and gets no COR"
            warnings.warn(said, stacklevel=3)
            drop = None
    if drop is not None:
        one = {"drop": drop, "t1": gaps[0], "t2": np.nan, "time_error": error[:2].max()}
        rows, at = {name: np.insert(values, 0, one[name]) for name, values in rows.items()}, t[:-1]
    found = rebounds_of(
        rows | {"radius": 1.0 if radius is None else radius}, flight.NO_AIR if density is None else density
    )
    speed, cor, errors = (found[name] for name in ("speed", "restitution", "restitution_error"))
    sure, bends = errors <= _UNSURE, np.abs(np.diff(cor, 2)) / math.sqrt(6.0)  # the errors, if these are independent
    for n, bend in enumerate(bends):
        own = slice(n, n + (1 if n == 0 and drop is not None else 3))  # an error of the height is in one COR
        errors[own] = np.maximum(errors[own], bend)
    sure &= (errors <= max(_UNSURE, 3.0 * float(np.median([0.0, *bends])))) | (not error.any())
    if drop is not None and not sure[0]:
        said = (
            f"{drop:g} m gives the bounce at {t[0]:.3f} s a COR of {cor[0]:.3f}, which the next ones do not go on from"
        )
        warnings.warn(f"drop: {said}; it is left out: is the height to the bead's lower side?", stacklevel=3)
    return at[sure], speed[sure], cor[sure], errors[sure]


def loudest(samples: Array) -> Array:
    """Channel of a recording; the mean of channels would blur instants, or be silent."""
    return samples if samples.ndim == 1 else np.asarray(samples[:, samples.std(axis=0).argmax()])


def _checked(samples: ArrayLike, rate: float) -> Array:
    """One channel of a recording, between -1 and 1."""
    given = np.asarray(samples)
    if given.dtype.kind not in "iuf" or given.ndim not in (1, 2) or not given.size or not np.isfinite(given).all():
        reason = f"expected finite numbers (n,) or (n, channels), got {given.dtype} {given.shape}"
        raise ArgumentError("samples", None, reason)
    x, step = given.astype(np.float64), 0.0
    if given.dtype.kind in "iu":
        step = 0.5 ** (8 * given.itemsize - 1)
        x = x * step - (given.dtype.kind == "u")
    x = loudest(x)
    if positive("rate", rate, "1/s") < _RATE:
        raise ArgumentError("rate", rate, f"must be at least {_RATE:g} [1/s]: of calls and memos too little is left")
    if not 0.5 <= x.size / rate <= _MOST:
        raise ArgumentError("samples", None, f"{x.size / rate:.3g} s; must last from 0.5 to {_MOST:g} s: cut it")
    low, high = x.min(), x.max()
    if not high - low > max(2e-4, 8.0 * step):
        reason = f"silent, {0.5 * (high - low):.1g} of full scale: was the microphone on, and allowed to the app?"
        raise ArgumentError("samples", None, reason)
    if np.count_nonzero(((x == low) | (x == high))[1:] & (x[1:] == x[:-1])) >= 5:
        reason = f"clipped at {max(-low, high):.3g} of full scale: record with less gain, or from farther away"
        raise ArgumentError("samples", None, reason)
    return x


def _impacts(x: Array, rate: float) -> tuple[Array, Array, Array]:
    """Instants of impacts [s], their errors [s], and how loud they are beside the noise."""
    from scipy import linalg, ndimage, signal

    step = round(_FRAME * rate)
    f, _, power = signal.spectrogram(x, rate, "hann", 4 * step, 3 * step, detrend=False, scaling="spectrum")
    power = power[(f > _BAND[0]) & (f < _BAND[1])]
    live = power.sum(axis=0) > 1e-10 * power.sum(axis=0).max()  # recorders blank what is faint, or the start
    floor = np.median(power[:, live], axis=1, keepdims=True) + 1e-9 * power.max()
    after, before = (ndimage.uniform_filter1d(power, n, axis=1) for n in (3, 5))
    rise = np.zeros(power.shape[1])
    rise[8:-1] = np.maximum(np.log((after[:, 9:] + floor) / (before[:, 2:-7] + floor)), 0.0).mean(axis=0)
    usual = np.median(rise[live])
    least = usual + max(_SURE * 1.4826 * np.median(np.abs(rise[live] - usual)), _RISE)
    at = np.flatnonzero((rise == ndimage.maximum_filter1d(rise, 17)) & (rise > least))
    at = at[(at > 5 + 1.1 * _PAST / _FRAME) & (at < rise.size - 8)]
    high = signal.sosfilt(signal.butter(2, _BAND[0], "high", fs=rate, output="sos"), x)
    frames = progress_bar(iter((at - 4).tolist()), at.size)
    instants = [_instant(high, n, step, rate, linalg.solve_toeplitz) for n in frames]
    loud = np.sqrt(np.maximum((power / floor).mean(axis=0) - 1.0, 0.0))
    times, errors = np.array(instants).reshape(-1, 2).T
    return times, errors, ndimage.maximum_filter1d(loud, 5)[at + 2]


def _instant(x: Array, frame: int, step: int, rate: float, solve_toeplitz: Any) -> tuple[float, float]:
    """Instant of the impact within nine frames, and its error [s], by Akaike's criterion.

    What cannot be predicted from the sound before has one variance until the impact and another
    one after it (Sleeman and van Eck 1999, for earthquakes).
    """
    first = frame * step
    past = x[first - round(_PAST * rate) : first + step]
    r = np.correlate(past, past, "full")[past.size - 1 : past.size + _ORDER]
    r[0] = r[0] * (1.0 + 1e-4) + 1e-30
    whole = x[first - _ORDER : first + 9 * step]
    new = np.convolve(whole, np.concatenate([[1.0], -solve_toeplitz(r[:-1], r[1:])]), "valid")
    energy = np.cumsum(new**2) + 1e-30
    m = np.arange(8, energy.size - 8)
    left, right = energy[m - 1], energy[-1] - energy[m - 1]
    aic = m * np.log(left / m) + (energy.size - m) * np.log(right / (energy.size - m) + 1e-30)
    weight = np.exp(0.5 * (aic.min() - aic))
    weight /= weight.sum()
    spread = math.sqrt(float(weight @ (m - weight @ m) ** 2)) / rate
    return (first + float(m[np.argmin(aic)])) / rate, math.hypot(spread, _INSTANT)


def _series(t: Array, strength: Array) -> Iterator[Places]:
    """Impacts of each bead, without echoes, and without series that other sounds are mixed with."""
    free, found = np.ones(t.size, dtype=bool), list[Places]()
    for best in sorted(_chains(t, strength), key=lambda one: (-one.size, -strength[one].sum())):
        if not free[best].all():
            continue
        free[best] = False
        gaps = np.diff(t[best])
        fades = np.polyfit(np.log(gaps), np.log(strength[best[1:]]), 1)[0] > _FADES
        if (
            best.size >= _FEWEST + 2 * _is_uneven(gaps)
            and gaps[-1] < _SHRINKS * gaps[0]
            and fades
            and not _is_echo(best, t, strength)
        ):
            found.append(best)
    heard, rest = np.concatenate([*found, np.empty(0, dtype=np.int64)]), np.flatnonzero(free)
    late = t[rest, None] - t[heard]
    echoes = (late > 0.0) & (late < _ECHO) & (strength[rest, None] < _FAINT**2 * strength[heard])
    rest = rest[~echoes.any(axis=1)]
    for one in sorted(found, key=lambda one: t[one[0]]):
        meanwhile = sum(t[other[0]] < t[one[-1]] and t[one[0]] < t[other[-1]] for other in found) > 1
        near = (t[rest] > t[one[0]]) & (t[rest] < t[one[-1]]) & (strength[rest] > 0.5 * strength[one].min())
        strangers = np.count_nonzero(near)
        mixed = meanwhile or strangers > 0
        least = _FEWEST + meanwhile + 2 * (rest.size > _CROWD)
        uneven = mixed and _is_uneven(np.diff(t[one]))
        if one.size >= least and strangers <= _STRANGERS * one.size and not uneven:
            yield one[int(mixed) :]  # the first impact may be another bead's


def _is_uneven(gaps: Array) -> bool:
    """Whether CORs go up and down by more than those of a bead that hardly spins."""
    logs = np.diff(np.log(gaps))
    bends = np.diff(logs)
    return bool(((bends < -_STEADY) | (bends > _STEADY - _SLOWER * logs[:-1])).any())


def _is_echo(one: Places, t: Array, strength: Array) -> bool:
    """Whether most impacts of a series come equally late after louder ones."""
    late = t[one, None] - t
    late[(late <= 0.0) | (late > _ECHO) | (strength[one, None] > _FAINT * strength)] = np.inf
    lags = late[np.isfinite(late)]
    return any((np.abs(late - lag) < 2.0 * _FRAME).any(axis=1).mean() > 0.6 for lag in lags)


def _chains(t: Array, strength: Array) -> Iterator[Places]:
    """Find series of impacts whose intervals shrink as a bead's, with many impacts in common."""
    for n in progress_bar(iter(range(t.size)), t.size):
        for m in range(n + 1, min(n + 1 + _NEXT, t.size)):
            for last in range(m + 1, min(m + 1 + _NEXT, t.size)):
                if (one := _extended(t, strength, [n, m, last])).size >= _FEWEST:
                    yield one


def _extended(t: Array, strength: Array, chain: list[Any]) -> Places:
    """Add to three impacts those that may follow; nothing if the three cannot be of a bead."""
    i, j, k = chain
    first, gap = t[j] - t[i], t[k] - t[j]
    cor = gap / first
    most = _LOUDER * math.sqrt(cor)
    fades = strength[j] < most * strength[i] and strength[k] < most * strength[j]
    if not (_SHORTEST < gap < 0.99 * first < _LONGEST and fades):
        return np.empty(0, dtype=np.intp)
    while True:
        low, high = (1.0 - _SCATTER) * cor, (1.0 + _SCATTER) * cor ** (1.0 - _SLOWER)
        ends = t[chain[-1]] + gap * np.array([max(low, _SHORTEST / gap), min(high, 0.995)])
        after = np.arange(*np.searchsorted(t, ends))
        after = after[strength[after] < _LOUDER * math.sqrt(cor) * strength[chain[-1]]]
        if not after.size:
            return np.array(chain)
        chain.append(after[np.argmax(strength[after])])
        cor = (t[chain[-1]] - t[chain[-2]]) / gap
        gap *= cor

"""The power that impacts feed into walls, and the spectrum of their forces, in third octaves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw.histories import Histories, histories_of
from contactlaw.physical.arguments import positive
from contactlaw.record.file import Record

# IEC 61260-1, base ten: the edges of third octaves are half a band from 1 kHz times powers of 10^(1/10).
# The first band is all below the third octave of 100 Hz, and the last all above that of 1 MHz.
EDGES: Array = np.array([0.0, *1e3 * 10.0 ** (np.arange(-10.5, 31.0) / 10.0), np.inf])


class Spectrum(NamedTuple):
    """What impacts feed into walls, by frequency; arrays have a row for each of w walls.

    Attributes
    ----------
    wall
        Numbers of the walls, shape (w,).
    frequency
        Centres of third octaves by IEC 61260-1 from 100 Hz to 1 MHz [Hz], shape (b,). Before them
        stands 0, for all that is below, and after them inf, for all that is above.
    power
        Power fed into the wall in each band, shape (w, b) [W]. All bands together have the mean
        power of the bending waves.
    force
        One-sided spectrum of the force, its mean over each band, shape (w, b) [N2/Hz].
    left_out
        Share of the waves' energy that is not in the power, shape (w,) [-]: that of contacts without
        a force history. These are beads that were struck, slid on or were parts of bodies, and
        impacts next to edges, on shells and on foundations.
    duration
        Time over which the power is a mean [s].

    Notes
    -----
    An impact of the force F(t) feeds its mobility times the integral of F^2, which by Parseval's
    theorem is that over all frequencies of |F(f)|^2. The mobility is the wave's energy in the
    record over the integral of F^2: 1/(8 sqrt(D m)) by laws whose plate is thin, and that of the
    corrected plate by law fem. N independent impacts a second have the one-sided spectrum
    2 N <|F(f)|^2> (Campbell's theorem).
    """

    wall: Integers
    frequency: Array
    power: Array
    force: Array
    left_out: Array
    duration: float

    @classmethod
    def of(cls, record: Record, duration: float | None) -> Spectrum:
        """Compute the spectrum of contacts on walls, as `Record.spectrum` does."""
        rows, waves = record.rows, np.nan_to_num(record.rows["wave_energy"])
        wall, owner = np.unique(rows["plate"], return_inverse=True)
        square, power = np.zeros((2, wall.size, EDGES.size - 1))
        unknown = waves.copy()
        for found in histories_of(record):
            bands = _by_band(found)
            np.add.at(square, owner[found.row], bands)
            np.add.at(power, owner[found.row], bands * (waves[found.row] / found.square)[:, None])
            unknown[found.row] = 0.0
        time = positive("duration", float(np.ptp(rows["time"])) if duration is None else duration, "s")
        left_out, whole = np.bincount(owner, unknown), np.bincount(owner, waves)
        frequency, force = np.sqrt(EDGES[:-1] * EDGES[1:]), square / (time * np.diff(EDGES))
        return cls(wall, frequency, power / time, force, left_out / (whole + (whole == 0.0)), time)


def _by_band(found: Histories) -> Array:
    """Integral of |F(f)|^2 over frequencies of either sign in each band [N2 s].

    It is exact for the samples: |F(f)|^2 is a sum of cosines of the lags, with the autocorrelation
    for coefficients, which is integrated term by term.
    """
    step, count = found.time[:, 1], found.force.shape[1]
    lags = np.fft.irfft(abs(np.fft.rfft(found.force, 2 * count)) ** 2)[:, :count]
    lags *= np.append(1.0, np.full(count - 1, 2.0)) * (found.square / lags[:, 0])[:, None]
    share = np.minimum(2.0 * EDGES[1:] * step[:, None], 1.0)  # of the highest frequency that the samples have
    below = share * (np.sinc(share[:, :, None] * np.arange(count)) @ lags[:, :, None])[:, :, 0]
    return np.diff(below, prepend=0.0)

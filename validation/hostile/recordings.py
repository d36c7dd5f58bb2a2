"""Recordings of drops, and of everything else: the COR within 0.005, and no bounce that is none.

The sounds are made here, from the modes of a plate that each impact strikes; nothing of the package
is used. Every fourth recording has one or two beads that bounce, the others have none. A bead with
eight bounces or more has to be heard where the noise is 20 dB below its first impact, if its COR
is steady within 0.03; of the others it scatters by 1 or 2 %.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl

Floats = NDArray[np.float64]

FULL = 667  # of which 500 have no bounce
BOUND = 0.005  # largest error of a COR, unless three stated errors are more
OTHERS = "noise", "talk", "typing", "ticks", "knocks"
_G = 9.80665


def faults(count: int, seed: int) -> Iterator[str]:
    """Listen to that many recordings."""
    for n in range(count):
        rng = np.random.default_rng((seed, n))
        rate, ratio, beads = int(rng.choice([44100, 48000])), rng.uniform(10.0, 40.0), (n % 4 == 0) + (n % 8 == 4)
        name = f"recording {n} (seed {seed}), {beads} beads, {ratio:.0f} dB, {OTHERS[n % 5]}"
        if beads:
            times, cors, sound, drop = drops(rng, rate, beads, ratio)
        else:
            times, cors, sound, drop = np.empty(0), np.empty(0), without_bounces(rng, OTHERS[n % 5], rate), 0.3
        try:
            found = cl.bounces(sound, rate, drop=drop if n % 3 else None)
        except ValueError as error:
            if beads == 1 and ratio > 20.0 and times.size > 7 and np.abs(np.diff(cors)).max() < 0.03:
                yield f"{name}: {error}"
            continue
        for at, cor, sigma in zip(found.at, found.restitution, found["restitution_error"], strict=True):
            off = np.min(np.abs(cors[np.abs(times - at) < 5e-3] - cor), initial=1.0)
            if not off <= max(BOUND, 3.0 * sigma):
                yield f"{name}: COR {cor:.4f} +- {sigma:.4f} at {at:.3f} s"


def drops(rng: np.random.Generator, rate: int, beads: int, decibels: float) -> tuple[Floats, Floats, Floats, float]:
    """Make times and CORs of the bounces of some beads, their sound, and the drop's height [m].

    The noise has so many `decibels` less power than the first 10 ms of the first impact.
    """
    height = float(rng.uniform(0.1, 0.6))
    sound, modes, lasts = np.zeros(int(4.5 * rate)), plate(rng), 10.0 ** rng.uniform(-4.6, -4.0)
    times, cors = [], []
    for bead in range(beads):
        t, v = rng.uniform(0.3, 0.6) + 0.37 * bead, math.sqrt(2.0 * _G * height)
        lowest, rises, first = rng.uniform(0.45, 0.93), rng.uniform(0.0, 0.12), v
        scatter = rng.choice([0.0, 0.01, 0.02])
        for _ in range(20):
            times.append(t)
            cors.append(min(lowest * (v / first) ** -rises * rng.normal(1.0, scatter), 0.96))
            strike(rng, sound, rate, modes, t, v, lasts)
            v *= cors[-1]
            t += 2.0 * v / _G
            if v < 0.15 or t > 4.2:
                break
    loud = sound[int(times[0] * rate) :][: int(0.01 * rate)].std()
    if rng.random() < 0.5:  # an echo from a wall
        late, less = int(rng.uniform(0.008, 0.07) * rate), rng.uniform(0.2, 0.5)
        sound[late:] += less * (sound[:-late] + np.roll(sound[:-late], 1)) / 2.0
    sound += loud * 10.0 ** (-decibels / 20.0) * noise(rng, sound.size)
    return np.array(times), np.array(cors), 0.7 * sound / np.abs(sound).max(), height


def plate(rng: np.random.Generator) -> Floats:
    """Frequencies [Hz], rates of decay [1/s] and wave numbers of a supported rectangle's modes."""
    wide, long, thick = rng.uniform((0.1, 0.1, 0.5e-3), (0.5, 0.5, 8e-3))
    m, n = (part.ravel() for part in np.meshgrid(np.arange(1, 40), np.arange(1, 40)))
    f = 0.5 * math.pi * math.sqrt(70e9 * thick**2 / (12.0 * 0.91 * 2700.0)) * ((m / wide) ** 2 + (n / long) ** 2)
    heard = np.flatnonzero((f > 80.0) & (f < 16e3))
    heard = heard[np.argsort(f[heard])[:150]]
    return np.column_stack([f, math.pi * f * 10.0 ** rng.uniform(-3.0, -1.5) + 5.0, m, n])[heard]


def strike(
    rng: np.random.Generator, sound: Floats, rate: int, modes: Floats, at: float, speed: float, lasts: float
) -> None:
    """Add the sound of an impact that `lasts` so long [s], somewhere near the middle of the plate."""
    f, decay, m, n = modes.T
    x, y = rng.uniform(0.4, 0.6, 2)
    size = speed * np.sin(math.pi * m * x) * np.sin(math.pi * n * y)
    size *= np.abs(np.cos(math.pi * f * lasts)) / (1.0 + (2.0 * f * lasts) ** 2)
    start = math.ceil(at * rate)
    t = np.arange(start, min(sound.size, start + int(0.6 * rate))) / rate - at
    for k in range(f.size):
        part = t[: int(12.0 / decay[k] * rate)]
        sound[start:][: part.size] += size[k] * np.exp(-decay[k] * part) * np.sin(2.0 * math.pi * f[k] * part)
    direct = np.gradient(np.exp(-0.5 * ((t[:90] - 1.5e-4) / (lasts / 2.0 + 2e-5)) ** 2))
    sound[start:][: direct.size] += speed * rng.uniform(1.0, 3.0) * direct


def noise(rng: np.random.Generator, count: int) -> Floats:
    """Noise of rms 1 whose power falls with frequency as that of white or pink noise, or between."""
    spectrum = np.fft.rfft(rng.normal(size=count)) * np.fft.rfftfreq(count).clip(1e-3) ** (-0.5 * rng.random())
    made = np.fft.irfft(spectrum, count)
    return np.asarray(made / made.std())


def without_bounces(rng: np.random.Generator, kind: str, rate: int) -> Floats:
    """Seconds of talk, of clicks and knocks at random, of a clock, or of noise alone."""
    t = np.arange((12 if kind == "typing" else 4) * rate) / rate
    sound = 0.0 * t
    if kind == "talk":
        talk(rng, sound, t)
    elif kind != "noise":
        modes, often = plate(rng), rng.uniform(1.0, 10.0 if kind == "typing" else 4.0)
        gaps = rng.normal(1.0, 0.01, 120) / often if kind == "ticks" else rng.exponential(1.0 / often, 120) + 0.02
        for at in np.cumsum(gaps)[np.cumsum(gaps) < t[-1] - 0.1]:
            strike(rng, sound, rate, modes, at, rng.lognormal(0.0, 0.1 if kind == "ticks" else 0.6), 5e-5)
    sound += (sound.std() or 1.0) * 10.0 ** -rng.uniform(0.5, 2.0) * noise(rng, sound.size)
    return np.asarray(0.7 * sound / np.abs(sound).max())


def talk(rng: np.random.Generator, sound: Floats, t: Floats) -> None:
    """Add syllables: glottal pulses through formants, hissing consonants, and bursts before vowels."""
    at = 0.1
    while at < t[-1] - 0.5:
        lasts, pitch = rng.uniform(0.08, 0.25), rng.uniform(85.0, 230.0)
        part = slice(*np.searchsorted(t, [at, at + lasts]))
        here, voice = t[part] - at, 0.0 * t[part]
        for f, width in zip(rng.uniform((300, 900, 2200), (800, 2000, 3200)), (60.0, 90.0, 150.0), strict=True):
            for pulse in np.cumsum(rng.normal(1.0, 0.01, int(lasts * pitch)) / pitch):
                after = (here - pulse).clip(0.0)
                voice += np.exp(-math.pi * width * after) * np.sin(2.0 * math.pi * f * after)
        sound[part] += np.sin(math.pi * here / lasts) ** 0.7 * voice
        if rng.random() < 0.5:  # a plosive
            burst = sound[part.start - 800 : part.start]
            burst += rng.uniform(0.5, 4.0) * np.exp(-np.arange(800) / 180.0) * rng.normal(size=800)
        if rng.random() < 0.4:  # a sibilant
            sound[part][:3500] += (
                rng.uniform(0.2, 1.0) * np.hanning(here[:3500].size) * rng.normal(size=here[:3500].size)
            )
        at += lasts + rng.uniform(0.03, 0.2)

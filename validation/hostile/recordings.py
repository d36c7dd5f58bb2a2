"""Recordings of drops, and of everything else: the COR within 0.005, and no bounce that is none.

The sounds are made here, from sums of a plate's modes that each impact strikes; nothing of the
package is used. Every fourth recording has one or two beads that bounce, the others have none. A
bead with six bounces or more has to be heard where the noise is 20 dB below its first impact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl

Floats = NDArray[np.float64]

FULL = 667  # of which 500 have no bounce
BOUND = 0.005  # largest error of a COR
_G = 9.80665
_LAST = 0.03  # [s] from the last but one bounce to the last


def faults(count: int, seed: int) -> Iterator[str]:
    """Listen to that many recordings."""
    for n in range(count):
        rng = np.random.default_rng((seed, n))
        rate = int(rng.choice([44100, 48000]))
        if n % 4:
            kind = ("noise", "talk", "typing", "ticks", "tones", "knocks")[n % 6]
            try:
                found = cl.bounces(_no_bounce(rng, kind, rate), rate, drop=0.3 if n % 3 else None)
            except ValueError:
                continue
            yield f"recording {n} (seed {seed}), {kind}: bounces at {found.at}"
            continue
        ratio, beads = rng.uniform(10.0, 40.0), 1 + (n % 8 == 4)
        times, cors, sound, drop = drops(rng, rate, beads, ratio)
        try:
            found = cl.bounces(sound, rate, drop=drop if n % 3 else None)
        except ValueError as error:
            if beads == 1 and ratio > 20.0 and times.size > 5:
                yield f"recording {n} (seed {seed}), {ratio:.0f} dB, {times.size} bounces: {error}"
            continue
        errors = np.asarray(found.restitution_error)
        for at, cor, error in zip(found.at, found.restitution, errors, strict=True):
            off = np.min(np.abs(cors[np.abs(times - at) < 5e-3] - cor), initial=1.0)
            if not off <= max(BOUND, 3.0 * error):
                yield f"recording {n} (seed {seed}), {beads}, {ratio:.0f} dB: COR {cor:.4f} +- {error:.4f} at {at:.3f} s"


def drops(rng: np.random.Generator, rate: int, beads: int, decibels: float) -> tuple[Floats, Floats, Floats, float]:
    """Times and CORs of the bounces of some beads, their sound, and the height of the drop [m].

    The noise has so many `decibels` less power than the first 10 ms of the first impact.
    """
    height = float(rng.uniform(0.1, 0.6))
    sound, modes, lasts = np.zeros(int(4.5 * rate)), plate(rng), 10.0 ** rng.uniform(-4.6, -4.0)
    times, cors, first = [], [], []
    for bead in range(beads):
        t, v = rng.uniform(0.3, 0.6) + 0.37 * bead, math.sqrt(2.0 * _G * height)
        slow, rises, struck = rng.uniform(0.45, 0.93), rng.uniform(0.0, 0.12), v
        first.append(t)
        for _ in range(20):
            cor = min(slow * (v / struck) ** -rises, 0.96)
            times.append(t)
            cors.append(cor)
            strike(rng, sound, rate, modes, t, v, lasts)
            t, v = t + 2.0 * cor * v / _G, cor * v
            if 2.0 * cor * v / _G < _LAST or t > sound.size / rate - 0.3:
                break
    if rng.random() < 0.5:  # an echo from a wall
        late, less = int(rng.uniform(0.008, 0.07) * rate), rng.uniform(0.2, 0.5)
        sound[late:] += less * (sound[:-late] + np.roll(sound[:-late], 1)) / 2.0
    loud = sound[int(first[0] * rate) :][: int(0.01 * rate)].std()
    sound += loud * 10.0 ** (-decibels / 20.0) * noise(rng, sound.size)
    return np.array(times), np.array(cors), 0.7 * sound / np.abs(sound).max(), height


def plate(rng: np.random.Generator) -> Floats:
    """Frequencies [Hz], rates of decay [1/s] and wave numbers of a supported rectangle's modes."""
    wide, long, thick = rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.5), rng.uniform(0.5e-3, 8e-3)
    m, n = (part.ravel() for part in np.meshgrid(np.arange(1, 40), np.arange(1, 40)))
    f = 0.5 * math.pi * math.sqrt(70e9 * thick**2 / (12.0 * 0.91 * 2700.0)) * ((m / wide) ** 2 + (n / long) ** 2)
    heard = (f > 80.0) & (f < 16e3)
    order = np.argsort(f[heard])[:150]
    loss = 10.0 ** rng.uniform(-3.0, -1.5)
    return np.column_stack([f, math.pi * f * loss + 5.0, m, n])[heard][order]


def strike(
    rng: np.random.Generator, sound: Floats, rate: int, modes: Floats, at: float, speed: float, lasts: float
) -> None:
    """Add the sound of an impact that `lasts` so long, somewhere near the middle of the plate."""
    f, decay, m, n = modes.T
    x, y = rng.uniform(0.4, 0.6, 2)
    size = (
        np.sin(math.pi * m * x)
        * np.sin(math.pi * n * y)
        * np.abs(np.cos(math.pi * f * lasts) / (1.0 + (2 * f * lasts) ** 2))
    )
    start = math.ceil(at * rate)
    t = np.arange(start, min(sound.size, start + int(0.6 * rate))) / rate - at
    for k in range(f.size):
        part = t[: int(min(t.size, 12.0 / decay[k] * rate))]
        sound[start : start + part.size] += (
            speed * size[k] * np.exp(-decay[k] * part) * np.sin(2 * math.pi * f[k] * part)
        )
    click = t[: int(0.002 * rate)]
    direct = np.exp(-((click - 1.5e-4) ** 2) / (2.0 * (lasts / 2 + 2e-5) ** 2))
    sound[start : start + click.size] += speed * 2.0 * rng.uniform(0.5, 1.5) * np.gradient(direct)


def noise(rng: np.random.Generator, count: int, power: float | None = None) -> Floats:
    """Noise whose power falls with frequency as white or pink noise, or between; of rms 1."""
    spectrum = np.fft.rfft(rng.normal(size=count))
    falls = rng.uniform(0.0, 1.0) if power is None else power
    spectrum *= np.maximum(np.fft.rfftfreq(count), 1e-3) ** (-0.5 * falls)
    made = np.fft.irfft(spectrum, count)
    return made / made.std()


def _no_bounce(rng: np.random.Generator, kind: str, rate: int) -> Floats:
    """Four seconds of talk, of clicks and knocks at random, of a clock, of tones, or of noise alone."""
    count = 4 * rate
    sound = np.zeros(count)
    if kind == "talk":
        sound = talk(rng, count, rate)
    elif kind in ("typing", "knocks", "ticks"):
        modes = plate(rng)
        often = rng.uniform(2.0, 10.0) if kind == "typing" else rng.uniform(1.0, 4.0)
        gaps = rng.exponential(1.0 / often, 60) + 0.02
        if kind == "ticks":
            gaps = rng.normal(1.0, 0.01, 60) / often
        for at in np.cumsum(gaps):
            if at < 3.9:
                strike(rng, sound, rate, modes, at, rng.lognormal(0.0, 0.1 if kind == "ticks" else 0.6), 5e-5)
    elif kind == "tones":
        for at in np.cumsum(rng.choice([0.125, 0.25, 0.5], 30)):
            t = np.arange(count) / rate - at
            f = 220.0 * 2.0 ** (rng.integers(0, 36) / 12.0)
            for k in range(1, 6):
                sound += (
                    np.where(t > 0, np.exp(-4.0 * t.clip(0)) * (1.0 - np.exp(-t.clip(0) / 0.003)), 0.0)
                    * np.sin(2 * math.pi * k * f * t)
                    / k
                )
    loud = sound.std() or 1.0
    sound += loud * 10.0 ** -rng.uniform(0.5, 2.0) * noise(rng, count)
    return 0.7 * sound / np.abs(sound).max()


def talk(rng: np.random.Generator, count: int, rate: int) -> Floats:
    """Syllables: glottal pulses through formants, hissing consonants, and bursts before vowels."""
    sound, at = np.zeros(count), 0.1
    while at < count / rate - 0.5:
        lasts, pitch = rng.uniform(0.08, 0.25), rng.uniform(85.0, 230.0)
        start, t = int(at * rate), np.arange(int(lasts * rate)) / rate
        envelope = np.sin(math.pi * t / lasts) ** 0.7
        period = np.cumsum(np.full(int(lasts * pitch), 1.0 / pitch) * rng.normal(1.0, 0.01, int(lasts * pitch)))
        voice = np.zeros(t.size)
        for f, width in zip(rng.uniform((300, 900, 2200), (800, 2000, 3200)), (60.0, 90.0, 150.0), strict=True):
            for pulse in period:
                after = (t - pulse).clip(0.0)
                voice += np.where(t > pulse, np.exp(-math.pi * width * after) * np.sin(2 * math.pi * f * after), 0.0)
        sound[start : start + t.size] += envelope * voice
        if rng.random() < 0.5:  # a plosive
            burst = np.arange(int(0.02 * rate)) / rate
            first = start - burst.size
            sound[first : first + burst.size] += (
                rng.uniform(0.5, 4.0) * np.exp(-burst / 0.004) * rng.normal(size=burst.size)
            )
        if rng.random() < 0.4:  # a sibilant
            hiss = np.diff(noise(rng, int(0.08 * rate) + 1, 0.0)) * np.hanning(int(0.08 * rate))
            sound[start : start + hiss.size] += rng.uniform(0.2, 1.0) * hiss
        at += lasts + rng.uniform(0.03, 0.2)
    return sound

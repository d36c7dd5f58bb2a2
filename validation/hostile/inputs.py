"""Impacts of any size and speed, on plates of any thickness: all interfaces give the same answer.

A case is one impact of a random pair, with speed, radius and thickness drawn over 12 to 15 decades.
Every interface is called with it. Either all return the same number, within its range, or all
refuse it with an error that names the argument.
"""

from __future__ import annotations

import ctypes
import math
import shutil
import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import contactlaw as cl
from contactlaw.answers.backend import UnsolvedError
from contactlaw.answers.tabulated import Outside
from contactlaw.softsphere import Contacts
from validation.hostile.headers import compiled

FULL = 1_600_000
_EACH = 8_000  # impacts per pair
_OUTSIDE: tuple[Outside, ...] = ("raise", "clamp", "solve")
_LAWS = ("fem", "fem", "fem", "myc", "hertz", "kogut_etsion")
_SOLVED = 40  # impacts per pair that are integrated, which takes the longest
_CLOSE = 1e-5  # error of COR that the table of a pair promises
_ROUNDING = 1e-12  # difference of COR between two ways to read one table
# Least compression over radius; "fem" has no losses below 1e-9, where its table ends.
_LEAST = 1e-7
_HEADERS = 20  # every so many pairs a header is compiled, which takes seconds


def faults(count: int, seed: int) -> Iterator[str]:
    """Try that many impacts."""
    rng = np.random.default_rng(seed)
    number, left = 0, count
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        while left > 0:
            part = min(_EACH, left)
            left -= part
            pair = _pair(rng)
            law = str(rng.choice(_LAWS))
            try:
                models = {how: cl.ImpactModel(pair, law, outside=how) for how in _OUTSIDE}
            except ValueError as error:
                if not _in_words(error):
                    yield f"{pair!r}, law {law}: {error}"
                continue
            except UserWarning:  # the table of this pair is less accurate, and says so
                continue
            where = f"{_described(pair)}, law {law}"
            impacts = _impacts(rng, part)
            for fault in _of_pair(rng, models, impacts, headers=number % _HEADERS == 0):
                yield f"{where}: {fault}"
            number += 1


def _described(pair: cl.Pair) -> str:
    bodies = pair.sphere, pair.plate
    return " on ".join(one.name if one.name in cl.materials() else repr(one) for one in bodies)


def _pair(rng: np.random.Generator) -> cl.Pair:
    """Draw a pair of materials, each of the catalogue or of its own."""
    return cl.Pair(*(_own(rng) if rng.random() < 0.4 else _known(rng) for _ in range(2)))


def _known(rng: np.random.Generator) -> str:
    return str(rng.choice(cl.materials()))


def _own(rng: np.random.Generator) -> cl.Material:
    """Draw any solid from a foam to tungsten."""
    density = 10.0 ** rng.uniform(1.5, 4.3)
    modulus = max(density * 10.0 ** rng.uniform(2.5, 8.3), 1e4)
    strength = modulus * 10.0 ** rng.uniform(-3.3, -1.0) if rng.random() < 0.7 else None
    return cl.Material("own", modulus, rng.uniform(0.0, 0.49), density, strength)


def _impacts(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Draw speeds, radii and thicknesses: half over all decades, half in the usual range."""
    wide = rng.random(count) < 0.5
    speed = 10.0 ** np.where(wide, rng.uniform(-10, 5, count), rng.uniform(-3, 2.5, count))
    radius = 10.0 ** np.where(wide, rng.uniform(-9, 3, count), rng.uniform(-5, -1, count))
    ratio = 10.0 ** np.where(wide, rng.uniform(-3, 12, count), rng.uniform(-1.5, 2.1, count))
    thickness = np.maximum(radius / ratio, 1e-9)
    thickness[rng.random(count) < 0.01] = math.inf
    return speed, radius, thickness


def _where(speed: float, radius: float, thickness: float) -> str:
    sizes = {"speed": speed, "radius": radius, "thickness": thickness}
    return "at " + ", ".join(f"{name} = {float(value)!r}" for name, value in sizes.items())


def _in_words(error: Exception) -> bool:
    """Whether an error names the argument, as the errors of contactlaw do."""
    names = "speed", "radius", "thickness", "youngs_modulus", "yield_strength", "density", "lambda"
    return any(name in str(error) for name in names)


def _of_pair(
    rng: np.random.Generator, models: dict[Outside, cl.ImpactModel], impacts: Any, headers: bool
) -> Iterator[str]:
    model = models["raise"]
    v, r, h = impacts
    foil = cl.table.lookup.THINNEST * r > h
    cor, at = model.kernel, ctypes.CFUNCTYPE(*[ctypes.c_double] * 4)(model.address)
    one = np.array([cor(*x) for x in zip(v, r, h, strict=True)])
    inside = ~np.isnan(one)
    named = impacts

    def first(wrong: np.ndarray, what: str, *also: np.ndarray) -> Iterator[str]:
        if wrong.any():
            n = int(np.argmax(wrong))
            answers = ", ".join(repr(float(x[n])) for x in also)
            yield f"{what} for {int(wrong.sum())}, {_where(*(x[n] for x in named))}: {answers}"

    yield from first(inside & foil, "an answer for a foil", one)
    yield from first(inside & ~((one >= 0.0) & (one <= 1.0)), "COR out of range", one)
    some = rng.integers(0, v.size, 200)
    by_address = np.array([at(v[n], r[n], h[n]) for n in some])
    if not np.array_equal(by_address, one[some], equal_nan=True):
        yield "kernel and address differ"

    # batches answer what the kernel answers
    named = tuple(x[inside] for x in impacts)
    batch, hit = np.asarray(model.restitution(*named)), model.lookup(*named)
    for what, values in ("batch", batch), ("lookup", np.asarray(hit.restitution)):
        off = np.abs(values - one[inside]) > _ROUNDING
        yield from first(off, f"kernel and {what} differ", one[inside], values)
    yield from _fields(hit, first)

    for n in rng.choice(np.flatnonzero(inside), min(_SOLVED, int(inside.sum())), replace=False):
        exact = model.solve(v[n], r[n], h[n])
        if not abs(exact.restitution - one[n]) <= _CLOSE and exact.peak_compression > _LEAST * r[n]:
            yield f"table {one[n]!r}, equation {exact.restitution!r}, {_where(v[n], r[n], h[n])}"

    # beyond the table: an error, the border or the equation, as `outside` says; a foil: an error
    for n in rng.choice(np.flatnonzero(~inside), min(_SOLVED, int((~inside).sum())), replace=False):
        yield from _refused(models, float(v[n]), float(r[n]), float(h[n]), bool(foil[n]))
    named = tuple(x[~foil] for x in impacts)
    hit = models["clamp"].lookup(*named)
    yield from _fields(hit, first)
    clamped = (hit.flags & int(cl.Validity.CLAMPED)) != 0
    yield from first(clamped != ~inside[~foil], "clamped, though inside, or not though beyond")
    yield from _soft(model, named, first)
    if headers and shutil.which("gcc"):
        yield from _header(model, impacts, one)


def _fields(hit: cl.Rebound, first: Any) -> Iterator[str]:
    """Check every field of many rebounds."""
    for name in ("restitution", "plastic_fraction", "wave_fraction", "other_fraction"):
        values = getattr(hit, name)
        wrong = ~((values >= -1e-6) & (values <= 1.0 + 1e-4))
        yield from first(wrong, f"{name} out of 0 to 1", values)
    for name in ("contact_time", "peak_force", "peak_compression", "inelasticity"):
        values = getattr(hit, name)
        yield from first(~((values >= 0.0) & (values < math.inf)), f"{name} is no number", values)


def _calls(model: cl.ImpactModel, v: float, r: float, h: float) -> dict[str, Callable[[], Any]]:
    return {
        "restitution": lambda: model.restitution(v, r, h),
        "lookup": lambda: model.lookup(v, r, h).restitution,
        "curve": lambda: model.curve(r, h)(v),
        "solve": lambda: model.solve(v, r, h).restitution,
    }


def _refused(models: dict[Outside, cl.ImpactModel], v: float, r: float, h: float, foil: bool) -> Iterator[str]:
    where = _where(v, r, h)
    for how, model in models.items():
        for name, call in _calls(model, v, r, h).items():
            try:
                value = call()
            except ValueError as error:
                if not (_in_words(error) and (foil or (how == "raise" and name != "solve"))):
                    yield f"{name}, outside {how!r}, {where}: {error}"
            except UnsolvedError as error:
                if foil or not (how == "solve" or name == "solve"):
                    yield f"{name}, outside {how!r}, {where}: {error}"
            else:
                if foil or (how == "raise" and name != "solve") or not 0.0 <= value <= 1.0:
                    yield f"{name}, outside {how!r}, {where}: answers {value!r}"


def _soft(model: cl.ImpactModel, known: Any, first: Any) -> Iterator[str]:
    """Check that the force of the first time steps of contacts is a finite number."""
    v, r, h = known
    contacts = Contacts(model, r, h)
    step = 1e-2 * float(np.min(r / np.maximum(v, 1.0)))
    for n in (1, 2, 3):
        force = contacts.advance(n * v * step, step)
        yield from first(~((force >= 0.0) & (force < math.inf)), f"force of step {n}", force)


_SOURCE = """#include "contactlaw.h"
double restitution(double v, double r, double h) { return contactlaw_restitution(v, r, h); }
double rebound(double v, double r, double h) { return contactlaw_rebound(v, r, h).restitution; }
"""


def _header(model: cl.ImpactModel, impacts: Any, one: np.ndarray) -> Iterator[str]:
    """Compile the header of a pair, and compare its answers with the kernel's."""
    with tempfile.TemporaryDirectory() as folder:
        library = compiled(model, Path(folder), _SOURCE, "-O1", "-fsanitize=undefined", "-fno-sanitize-recover")
        for name in ("restitution", "rebound"):
            call = getattr(library, name)
            call.argtypes, call.restype = [ctypes.c_double] * 3, ctypes.c_double
        for (v, r, h), ours in zip(zip(*impacts, strict=True), one, strict=True):
            value = library.restitution(v, r, h)
            same = math.isnan(value) if math.isnan(ours) else abs(value - ours) <= _CLOSE
            if not same:
                yield f"header {value!r}, kernel {ours!r}, {_where(v, r, h)}"
                return
        for v, r, h in list(zip(*impacts, strict=True))[:_SOLVED]:
            value = library.rebound(v, r, h)
            if not (math.isnan(value) or 0.0 <= value <= 1.0):
                yield f"header's rebound {value!r}, {_where(v, r, h)}"

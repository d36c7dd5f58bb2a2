"""Which model answers for which bead on which plate."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from functools import cache, cached_property, lru_cache
from typing import Any

import numpy as np

from contactlaw import Material, edge_distance
from contactlaw._errors import ArgumentError
from contactlaw.engines.needs import CorBySpeed, RestitutionModel, knows
from contactlaw.equation.tangential import POINT
from contactlaw.physical.plates import sheet_of
from contactlaw.physical.rate import flow_with_rate


class Answers:
    """What a model answers for beads of a radius [m] on a plate: a thickness [m], or what swings back."""

    def __init__(self, model: Any, radius: float, wall: Any, friction: float | None) -> None:
        self._model, self._radius, self._wall, self._friction = model, radius, wall, friction
        self._swings = sheet_of(wall) is not wall
        # COR by speed far from edges; a curve takes half a millisecond to make.
        self.cor = self._far if knows(model, "restitution") else model.curve(radius, wall)
        self._reach, self._kernel, self._octave = cache(self._reach_of), cache(self._kernel_of), cache(self._corners)

    def _far(self, speed: float) -> float:
        with suppress(ValueError):  # some of the speeds are refused, perhaps this one
            if self._swings:
                return float(np.interp(speed, *self._octave(math.frexp(speed)[1])))
        return float(self._model.restitution(speed, self._radius, self._wall))

    def _corners(self, octave: int) -> Any:
        """Compute 33 CORs in a doubling of the speed [m/s]."""
        speeds = np.ldexp(np.linspace(0.5, 1.0, 33), octave)
        return speeds, self._model.restitution(speeds, self._radius, self._wall)

    def reach(self, speed: float) -> float:
        """Distance [m] from which on edges do not matter."""
        return self._reach(math.frexp(speed)[1])

    def _reach_of(self, octave: int) -> float:
        # Slower impacts last longer, so the slowest of these speeds has the longest reach.
        time = self._model.lookup(math.ldexp(0.5, octave), self._radius, self._wall).contact_time
        return float(edge_distance(self._model.pair.plate, self._wall, time))

    def near(self, speed: float, kind: str, distance: float) -> float:
        """COR at a distance [m] from an edge."""
        kernel = self._kernel(kind)
        cor = math.nan if kernel is None else kernel(speed, self._radius, self._wall, distance)
        # The kernel knows no rate of strain, and cannot say what is wrong with an impact.
        return float(self._model.restitution(speed, self._radius, self._wall, kind, distance) if cor != cor else cor)

    def _kernel_of(self, kind: str) -> Any:
        law = self._model.force_law
        return None if law.yields and flow_with_rate(self._model.pair, law) else self._model.edge_kernel(kind)

    def slide(self, speed: float, sliding_speed: float) -> float:
        """Sliding speed afterwards [m/s].

        One impact takes below a microsecond by the model's ``collide_kernel``. Without one, and for
        impacts that it does not know, ``oblique`` answers, or says what is wrong.
        """
        if self._collide is not None:
            before, rest, up = (sliding_speed, 0.0, -speed), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
            (centre, _, _), _ = self._collide(before, rest, up, self._radius, self._wall, self._friction, rest)
            if centre == centre:
                return sliding_speed - POINT * (sliding_speed - float(centre))
        return float(self._model.oblique(speed, sliding_speed, self._radius, self._wall, self._friction).sliding_speed)

    @cached_property
    def _collide(self) -> Any:
        try:
            return None if self._swings else getattr(self._model, "collide_kernel", None)
        except RuntimeError:  # numba is switched off
            return None


class Models:
    """The models of one space, one per pair of materials; the first has the default materials."""

    def __init__(self, given: RestitutionModel | Sequence[RestitutionModel]) -> None:
        models: list[Any] = list(given) if isinstance(given, list | tuple) else [given]
        if not models:
            raise ArgumentError("model", None, "expected at least one ImpactModel, got an empty list")
        # Bounded: a thousand different beads make half a million pairs.
        self.sphere_curve = lru_cache(maxsize=65536)(self._sphere_curve)
        self.spheres: list[Any] = []  # materials by number
        self.plates: list[Any] = []
        self.by_pair: dict[tuple[int, int], Any] = {}
        for model in models:
            if not callable(getattr(model, "curve", None)):
                raise TypeError(f"model: expected an ImpactModel or an object with curve(), got {model!r}")
            sphere, plate = materials_of(model)
            key = _number(sphere, self.spheres), _number(plate, self.plates)
            if key in self.by_pair:
                reason = f"two are for {name_of(sphere)} on {name_of(plate)}; give one for each pair"
                raise ArgumentError("model", None, reason)
            self.by_pair[key] = model

    def find(self, kind: str, material: Material | str | None) -> int:
        """Return the number of a material of `spheres` or `plates`, by default that of the first model."""
        known = getattr(self, kind)
        for number, one in enumerate(known):
            if material in (None, one, name_of(one)):
                return number
        names = ", ".join(repr(name_of(one)) for one in known)
        raise ArgumentError(
            "material",
            None,
            f"no model is attached for {kind} of {name_of(material)!r}, only for {names}: "
            "attach(space, [model, ...]) takes one for each pair of materials",
        )

    def of_pair(self, sphere: int, plate: int) -> Any:
        """Model for beads on plates of these materials."""
        if (sphere, plate) not in self.by_pair:
            raise ArgumentError(
                "model",
                None,
                f"none is attached for Pair({name_of(self.spheres[sphere])!r}, {name_of(self.plates[plate])!r}): "
                "attach(space, [model, ...]) takes one for each pair of materials that meets",
            )
        return self.by_pair[sphere, plate]

    def of_beads(self, sphere: int, other: int) -> tuple[Any, tuple[Any, ...]]:
        """First model for beads of a material, and what its methods need of those of another one that they meet."""
        model = next(model for (its, _), model in self.by_pair.items() if its == sphere)
        return model, () if sphere == other else (self.spheres[other],)

    def _sphere_curve(self, one: tuple[float, int], two: tuple[float, int]) -> CorBySpeed:
        """Restitution by speed of two beads, each of a radius [m] and a material."""
        (radius, number), (other_radius, other) = one, two
        model, more = self.of_beads(number, other)
        if not knows(model, "sphere_sphere_curve"):
            raise TypeError(f"beads meet, but {model!r} has no sphere_sphere_curve()")
        curve: CorBySpeed = model.sphere_sphere_curve(radius, other_radius, *more)
        return curve


def materials_of(model: RestitutionModel) -> tuple[Any, Any]:
    """Materials of a model's beads and plates, None if it has no pair."""
    pair = getattr(model, "pair", None)
    return getattr(pair, "sphere", None), getattr(pair, "plate", None)


def _number(material: Any, known: list[Any]) -> int:
    if material not in known:
        known.append(material)
    return known.index(material)


def name_of(material: Any) -> str:
    """Name of a material, "" for that of a model without a pair."""
    return "" if material is None else str(getattr(material, "name", material))

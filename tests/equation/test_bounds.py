"""No kernel reads outside its arrays, whatever floats it gets: run as Python, indices checked."""

import importlib
import math
import pkgutil
from functools import partial

import metal
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from oracle import ALL_LAWS, FEM

from contactlaw import equation
from contactlaw._arrays import Array
from contactlaw.equation import edge, force, integrator, legs, near_edge, outcome, tangential, zener
from contactlaw.physical.responses import response_of
from contactlaw.physical.strengths import by_strength, with_strengths
from contactlaw.table import build, file, lookup, slides
from contactlaw.table.grid import Settings

PARTS = [f"{equation.__name__}.{one.name}" for one in pkgutil.iter_modules(equation.__path__)]
MODULES = [lookup, *map(importlib.import_module, PARTS)]
READ = {"law", "table", "response", "r"}  # arrays in which floats lead to places


def written(hint):
    """Name of a type, whether or not its module has its annotations evaluated."""
    return "Array" if hint is Array else getattr(hint, "__name__", hint)


READING = {
    kernel: [(name, written(hint)) for name, hint in kernel.py_func.__annotations__.items()][:-1]
    for kernel in (kernel for module in MODULES for kernel in vars(module).values())
    if hasattr(kernel, "py_func") and READ & kernel.py_func.__annotations__.keys()
}
INNER = "locate", "cor_at"  # take a place in the table
FLOATS = st.sampled_from([np.nan, np.inf, 0.5, 1.5]) | st.floats()
CALLED = set()


class Strict(np.ndarray):
    def __getitem__(self, key):  # Python counts negative indices from the end, machine code does not
        assert isinstance(key, slice | tuple) or key >= 0, f"index {key} is negative"
        return super().__getitem__(key)


LAWS = [law.data.view(Strict) for law in (*ALL_LAWS, FEM)]
STRENGTHS = by_strength(metal.PAIR, metal.MODEL.force_law).view(Strict)
COARSE = Settings(rows=6, columns=8, largest_overload=30.0, rtol=1e-6)
RATED = build(with_strengths(metal.PAIR, metal.MODEL.force_law), COARSE, points=100).packed
TABLES = file.packaged(ALL_LAWS[3]).packed.view(Strict), RATED.view(Strict)
EDGE = response_of("free", 0.3).view(Strict)


def attempt(data):
    many = data.draw(arrays(float, (20, 3, 4), elements=FLOATS, fill=st.nothing())).view(Strict)
    law = LAWS[data.draw(st.integers(0, len(LAWS) - 1))]
    table = TABLES[data.draw(st.integers(0, 1))]
    for strength in (many[0, 0, 0], math.inf, math.nan):
        force.unloading(force.at_strength(STRENGTHS, strength), many[0, 0, 1])
    for row in many[12:].reshape(8, 12):
        own = force.alone(law)
        curve, loads = force.unloading(own, row[0]), bool(row[2] > 0.0)
        leg = legs.up(own, legs.FIRST) if loads else legs.down(own, row[1])
        known = {"law": law, "laws": law, "table": table, "response": EDGE, "kind": leg.kind}
        typed = {"Array": many[0, 0], "Outcome": outcome.at(*many[1, :2]), "bool": loads}
        typed |= {"Extremes": outcome.extremes(4), "UnloadingCurve": curve, "Leg": leg}
        for kernel, hints in READING.items():
            given = [
                own if t == "BlendedLaw" else known.get(n, typed.get(t, x))
                for (n, t), x in zip(hints, row, strict=False)
            ]
            if all({n, t} & {*known, *typed, "float"} for n, t in hints):
                kernel.__name__ in INNER or run(kernel, *given)
    many[:8, :, 0] = 0.4  # an ordinary impact beside three others
    edges, notes = edge.Edges(np.tile(EDGE, (4, 1)), *many[2]), zener.Notes(*many[3:8, :2].mT)
    for goal, near in ((0, None), (1, None), (1, edges), (2, edges), (3, None)):
        zener._integrate(goal, law, *many[0, :2], np.zeros(4), 1e-3, notes, np.empty((11, 4)), near)
    tangential.slide_all(law, many[0, 0], np.zeros(4), many[1, 0, 0], outcome.History(*many[8:12]), many[2], 3)


def run(kernel, *arguments):
    CALLED.add(kernel)
    return kernel.py_func(*arguments)


def test_no_float_leads_out_of_an_array(monkeypatch):
    for module in MODULES:
        monkeypatch.setattr(module, "math", np, raising=False)  # gives inf where math raises
        for name, kernel in list(vars(module).items()):
            if hasattr(kernel, "py_func"):
                monkeypatch.setattr(module, name, partial(run, kernel))
    for module, most in ((integrator, "MAX_STEPS"), (zener, "MAX_STEPS"), (near_edge, "_MOST")):
        monkeypatch.setattr(module, most, 12)
    with np.errstate(all="ignore"):
        # which floats are drawn depends on the modules that are loaded; one impact is in the table
        assert 0.0 < lookup.restitution_on_plate(TABLES[0], 1.0, 1e-3, math.inf, 1.0) <= 1.0
        settings(max_examples=15, deadline=None, derandomize=True)(given(st.data())(attempt))()
    assert not {one.__name__ for one in READING.keys() - CALLED}
    assert np.isnan(slides.change.py_func(np.ones(64), None, 0.5, np.nan))

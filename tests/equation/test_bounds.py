"""No kernel reads outside its arrays, whatever floats it gets: run as Python, indices checked."""

import importlib
import math
import pkgutil

import metal
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from oracle import ALL_LAWS, FEM

from contactlaw import equation
from contactlaw.equation import edge, force, integrator, near_edge, outcome, tangential, zener
from contactlaw.physical.responses import response_of
from contactlaw.physical.strengths import by_strength, with_strengths
from contactlaw.table import build, file, lookup
from contactlaw.table.grid import Settings

PARTS = [f"{equation.__name__}.{one.name}" for one in pkgutil.iter_modules(equation.__path__)]
MODULES = [lookup, *map(importlib.import_module, PARTS)]
FLOATS = st.sampled_from([np.nan, np.inf, 0.5, 1.5]) | st.floats()


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
    law = data.draw(st.sampled_from(LAWS))
    for table in TABLES:
        for speed, radius, thickness, mass in many[12:].reshape(-1, 4):
            lookup.restitution_on_plate(table, speed, radius, thickness, mass)
            lookup.place_at(table, lookup.head_of(table), speed, radius, thickness, True)
        lookup.fields(table, True, outcome.at(*many[1, :2]))
    for strength, depth, x, y in many[12:].reshape(-1, 4):
        for own in (force.alone(law), force.at_strength(STRENGTHS, strength)):
            curve = force.unloading(own, depth)
            force.loading(own, x), force.unloading_force(own, curve, x), force.deepest(own, depth)
            tangential.stiffness_at(own, y, 1.0, depth, x, strength)
    many[:8, :, 0] = 0.4  # an ordinary impact beside three others
    edges, notes = edge.Edges(np.tile(EDGE, (4, 1)), *many[2]), zener.Notes(*many[3:8, :2].mT)
    for goal, near in ((0, None), (1, None), (1, edges), (2, edges), (3, None)):
        zener._integrate(goal, law, *many[0, :2], np.zeros(4), 1e-3, notes, np.empty((11, 4)), near)
    tangential.slide_all(law, many[0, 0], np.zeros(4), many[1, 0, 0], outcome.History(*many[8:12]), many[2], 3)


def test_no_float_leads_out_of_an_array(monkeypatch):
    for module in MODULES:
        monkeypatch.setattr(module, "math", np, raising=False)  # gives inf where math raises
        for name, kernel in list(vars(module).items()):
            if hasattr(kernel, "py_func"):
                monkeypatch.setattr(module, name, kernel.py_func)
    for module, most in ((integrator, "MAX_STEPS"), (zener, "MAX_STEPS"), (near_edge, "_MOST")):
        monkeypatch.setattr(module, most, 12)
    with np.errstate(all="ignore"):
        # which floats are drawn depends on the modules that are loaded; one impact is in the table
        assert 0.0 < lookup.restitution_on_plate(TABLES[0], 1.0, 1e-3, math.inf, 1.0) <= 1.0
        settings(max_examples=15, deadline=None, derandomize=True)(given(st.data())(attempt))()

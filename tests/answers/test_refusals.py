"""What models refuse, and how they say so. What is no number at all is in tests/physical/test_arguments.py."""

import math

import numpy as np
import pytest

import contactlaw as cl

R, H = 0.9e-3, 1e-3
FEM = cl.ImpactModel(cl.Pair("stainless-steel-304-ball", "glass"))
LINED = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
MYC = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
CLAMPING = cl.ImpactModel(MYC.pair, law="myc", outside="clamp")
FOAM = cl.Material("w", 600e9, 0.2, 2500, kind="ceramic", uncertainty={"youngs_modulus": 1.0})
IMPACT = {"speed": 2.0, "radius": R, "thickness": H}
# The method with valid arguments, and changes of them with the words of the refusal.
REFUSED = [
    (
        MYC.oblique,
        IMPACT | {"sliding_speed": 1.0, "friction": 0.1},
        [
            ({"friction": -0.1}, "friction: got -0.1"),
            ({"method": "sovle"}, "method: got 'sovle'; must be 'table' or 'solve'"),
        ],
    ),
    (
        MYC.collide,
        {
            "velocity": [0, 0, -1.0],
            "spin": np.zeros(3),
            "normal": [0, 0, 1.0],
            "radius": R,
            "thickness": H,
            "friction": 0.1,
        },
        [
            ({"velocity": [1.0, 2.0]}, "velocity: expected vectors of three numbers"),
            ({"spin": [math.nan, 0, 0]}, "spin: got .*must be finite"),
            ({"normal": [0, 0, 0]}, "normal: got .*must not be zero"),
            ({"velocity": np.zeros((2, 3)), "spin": np.zeros((4, 3))}, "shapes do not broadcast"),
            ({"velocity": [1e200, 0, -1]}, "sliding_speed: got inf"),
        ],
    ),
    (
        MYC.force_history,
        IMPACT,
        [
            ({"samples": 1}, "samples: got 1; must be an integer from 2 to 1 000 000"),
            ({"samples": 10.0}, "samples: got 10.0; must be an integer"),
        ],
    ),
    (
        MYC.constant,
        IMPACT | {"speed": [1.0, 2.0]},
        [
            ({"keep": "mass"}, "keep: got 'mass'; must be 'energy' or 'momentum'"),
            ({"weights": [1.0, -1.0]}, "weights: got -1.0 .*must lie between 0"),
            ({"weights": 0.0}, "weights: all of them are 0"),
        ],
    ),
    (
        MYC.speed_table,
        {"radius": R, "thickness": H},
        [
            ({"error": 1e-6}, "error: got 1e-06; must lie between 1e-05 and 0.1"),
            ({"slowest": 10.0}, "slowest: got 10.0; must be below the fastest speed, 10.0"),
        ],
    ),
    (
        cl.load_signal,
        IMPACT | {"times": [0.1], "model": MYC, "rate": 1e3},
        [({"rate": 1e15}, "duration: got .*must be at most"), ({"times": [math.nan]}, "times: got nan")],
    ),
    (
        FEM.thickness,
        {"restitution": 0.5, "speed": 2.0, "radius": 1e-3},
        [
            *(({"restitution": bad}, "restitution: got") for bad in (0.0, 1.0, math.nan)),
            ({"speed": 2e4}, "^speed: got 20000.0; no thickness brings"),
        ],
    ),
    (
        FEM.speed,
        {"restitution": 0.5, "radius": 1e-3, "thickness": H},
        [({"thickness": 1e-5}, "^thickness: got 1e-05; no speed brings")],
    ),
    (
        LINED.thickness,
        {"restitution": 0.5, "speed": 2.0, "radius": 1.5e-3},
        [({"plate": lambda h: cl.Layers([("steel-s235", h)])}, "beads touch 'steel-s235'")],
    ),
    (
        FEM.solve,
        IMPACT,
        [
            ({"edge": "loose", "edge_distance": H}, "edge: got 'loose'; must be one of free, supported, cl"),
            ({"edge_distance": -1.0}, "edge_distance: got -1.0; must lie between 0 and inf"),
            (
                {"edge": "clamped", "edge_distance": R, "hole_radius": R},
                "hole_radius: the rim of a hole is a free edge",
            ),
        ],
    ),
    (FEM.uncertainty, IMPACT, [({"speed_error": 5.0}, "speed_error: got 5.0; must lie between 0 and 1")]),
    (cl.ImpactModel(cl.Pair(FOAM, "glass")).uncertainty, IMPACT, [({}, "material 'w'")]),
    (FEM.yield_speed, {"radius": R}, [({"thickness": R / 20.0}, "thickness: got .*; too thin for the table")]),
]


@pytest.mark.parametrize(
    ("call", "arguments", "words"),
    [(call, valid | change, words) for call, valid, rows in REFUSED for change, words in rows],
)
def test_wrong_arguments_are_refused_in_words(call, arguments, words):
    with pytest.raises(ValueError, match=words):
        call(**arguments)

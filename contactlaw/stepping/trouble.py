"""What ends a run: codes that kernels give, and what each one says to a user."""

from __future__ import annotations

import enum

from contactlaw.stepping.spring import FEWEST_STEPS


class Trouble(enum.IntEnum):
    """Errors that end a run.

    From STARTS_INSIDE on, the bead's contacts are no longer valid, and no wall acts on it until its
    caller has taken its mark away, so that none of these contacts gets into the record.
    """

    STEP_TOO_LARGE = 1
    TOO_MANY_IMPACTS = 2
    NO_MODEL = 3
    TOO_FAST = 4
    NOT_FINITE = 5
    NO_STEPS = 6
    RESPA = 7
    TRICLINIC = 8
    DEFORMED = 9
    STARTS_INSIDE = 10
    CROSSED = 11
    WRONG_MASS = 12
    TOO_THIN = 13
    FOIL = 14
    NO_FORCE = 15
    TOO_WIDE = 16
    RESIZED = 17
    REWEIGHED = 18
    RETYPED = 19
    CLASH = 20


_NO_STEPS = "the force of the walls depends on the time steps before it"
_CHANGED = "; change the diameter, density and type of beads that touch nothing"
# `value` is the wrong value and `limit` its limit, in SI units; `quotient` is their ratio.
MESSAGES: dict[Trouble, str] = {
    Trouble.STEP_TOO_LARGE: (
        "timestep: too large for an impact at {value:.4g} m/s, which needs {steps} steps; take {limit:.2g} s or less"
    ),
    Trouble.TOO_MANY_IMPACTS: (
        "records: more than {limit:.0f} impacts ended within one command; make room for more, or "
        "run fewer steps at a time"
    ),
    Trouble.NO_MODEL: (
        "model: there is none for beads of type {value:.0f}; give the walls a model for this type, "
        "or None for beads that fly through them"
    ),
    Trouble.TOO_FAST: (
        "timestep: at {value:.4g} m/s relative to a wall it flies further than its radius of "
        "{limit:.4g} m in a step, and could jump through the wall; take {quotient:.2g} s at most"
    ),
    Trouble.NOT_FINITE: "its velocity is not finite; the simulation has blown up before",
    Trouble.NO_STEPS: f"minimize, rerun: {_NO_STEPS}, and here are none; take the walls out before",
    Trouble.RESPA: f"run_style respa: {_NO_STEPS}, which must have one length; use 'run_style verlet'",
    Trouble.TRICLINIC: "box: it is triclinic, and beads would lose walls at its boundaries; use an orthogonal one",
    Trouble.DEFORMED: "box: a periodic side changes its length during the run, and walls do not; keep it constant",
    Trouble.STARTS_INSIDE: (
        "the first touch finds it {value:.4g} m deep in the wall, more than its speed explains; "
        "place it outside, or at most {limit:.2g} m deep"
    ),
    Trouble.CROSSED: (
        "its centre went through the wall at {value:.4g} m/s, pushed by a force stronger than the "
        "contact's: take a shorter timestep, less softening or less load"
    ),
    Trouble.WRONG_MASS: (
        "density: its mass is {value:.6g} kg, a sphere of the model's material has {limit:.6g} kg; "
        "give the beads the density of that material"
    ),
    Trouble.TOO_THIN: (
        "thickness: the wall is too thin for the bead, the inelasticity lambda = {value:.4g} is "
        "above {limit:.4g}, beyond which the model has no answer; take a thicker wall or smaller "
        "beads (in Python, ImpactModel(..., outside='solve') integrates such impacts)"
    ),
    Trouble.FOIL: (
        "thickness: the wall is a foil beside the bead, R/H = {value:.4g} is above {limit:.4g}, "
        "and the model does not cover such impacts; take a thicker wall or smaller beads"
    ),
    Trouble.NO_FORCE: "no finite force at {value:.4g} m/s and a radius of {limit:.4g} m",
    Trouble.TOO_WIDE: "radius: inside a round wall of {limit:.8g} m, which a bead of {value:.8g} m does not fit into",
    Trouble.RESIZED: f"diameter: its radius is {{value:.6g}} m, and {{limit:.6g}} m when it began to touch{_CHANGED}",
    Trouble.REWEIGHED: f"density: its mass is {{value:.6g}} kg, and {{limit:.6g}} kg when it began to touch{_CHANGED}",
    Trouble.RETYPED: (
        f"type: it is of type {{value:.0f}}, and of {{limit:.0f}}, of another model, when it began to touch{_CHANGED}"
    ),
    Trouble.CLASH: (
        "softening, parcel: it touches a wall with softening {value:g}, parcel {limit:g}; give the "
        "walls these numbers, or wait until it has left"
    ),
}


def explain(code: int, wall: int, value: float, limit: float, bead: int = -1, step: int = -1) -> str:
    """Say what happened to a bead, and what to do about it; -1 where bead, wall or step is unknown."""
    place = [f"bead {bead}"] if bead >= 0 else []
    place += [f"on wall {wall}"] if wall >= 0 else []
    place += [f"at step {step}"] if step >= 0 else []
    quotient = limit / value if value else 0.0
    what = MESSAGES[Trouble(code)].format(value=value, limit=limit, quotient=quotient, steps=FEWEST_STEPS)
    return f"{' '.join(place)}: {what}" if place else what

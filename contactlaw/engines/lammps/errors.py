"""Messages for the errors that the C function reports: argument, value, remedy."""

from contactlaw.engines.lammps import memory
from contactlaw.stepping import Trouble
from contactlaw.stepping.spring import FEWEST_STEPS

_CHANGED = (
    "; an impact is one of one sphere, so change beads that touch nothing, or detach() the plates "
    "before and attach them when the bead has left"
)
_MESSAGES: dict[int, str] = {
    Trouble.STEP_TOO_LARGE: (
        "timestep: too large for an impact at {value:.4g} m/s, which needs {steps} steps; take {limit:.2g} s or less"
    ),
    Trouble.STARTS_INSIDE: (
        "the first touch finds it {value:.4g} m deep in the plate, more than its speed explains; "
        "place it outside, or at most {limit:.2g} m deep (and give by itself, not among other "
        "commands, a delete_atoms or reset_atoms that changes IDs in mid-contact)"
    ),
    memory.RESIZED: ("diameter: its radius is {value:.6g} m and was {limit:.6g} m when it began to touch" + _CHANGED),
    memory.REWEIGHED: ("density: its mass is {value:.6g} kg and was {limit:.6g} kg when it began to touch" + _CHANGED),
    memory.RETYPED: (
        "type: it is of atom type {value:.0f} and was of {limit:.0f}, of another model, when it "
        "began to touch" + _CHANGED
    ),
    Trouble.TOO_THIN: (
        "thickness: the plate is too thin for the bead, the inelasticity lambda = {value:.4g} is "
        "above {limit:.4g}, beyond which the model has no answer; take a thicker plate or smaller "
        "beads (ImpactModel(..., outside='solve') integrates such impacts)"
    ),
    Trouble.FOIL: (
        "thickness: the plate is a foil beside the bead, R/H = {value:.4g} is above {limit:.4g}, "
        "and the model does not cover such impacts; take a thicker plate or smaller beads"
    ),
    Trouble.CROSSED: (
        "its centre went through the plate at {value:.4g} m/s, pushed by a force stronger than the "
        "contact's: take a shorter timestep, less softening or less load"
    ),
    Trouble.WRONG_MASS: (
        "density: its mass is {value:.6g} kg, a sphere of the model's material has {limit:.6g} kg; "
        "'set group all density' to that of model.pair.sphere"
    ),
    Trouble.TOO_MANY_IMPACTS: (
        "records: more than {limit:.0f} impacts ended within one command; attach with more "
        "records, or run fewer steps at a time"
    ),
    memory.TOO_FAST: (
        "timestep: at {value:.4g} m/s it flies further than its radius of {limit:.4g} m in a step, "
        "and could jump through a plate; take {quotient:.2g} s at most"
    ),
    Trouble.TOO_WIDE: "radius: inside a round wall of {limit:.8g} m, which a bead of {value:.8g} m does not fit into",
    Trouble.NO_FORCE: "no finite force at {value:.4g} m/s and a radius of {limit:.4g} m",
    Trouble.NO_MODEL: (
        "model: there is none for beads of its atom type {value:.0f} here; attach(lmp, "
        "{{{value:.0f}: model, ...}}, ...), or None in place of it for beads that fly through"
    ),
    memory.NO_STEPS: (
        "beads were moved without time steps, as minimize and rerun do; the plates, whose force "
        "depends on the steps between, added none; detach() them before"
    ),
    memory.NOT_FINITE: "its velocity is not finite; the simulation has blown up before",
}


def message(code: int, step: int, bead: int, plate: int, value: float, limit: float) -> str:
    """Write the message of an error: what happened to a bead, and what to do about it."""
    where = f"bead {bead} " if bead >= 0 else ""
    where += (f"on plate {plate} " if plate >= 0 else "") + f"at step {step}"
    quotient = limit / value if value else 0.0
    what = _MESSAGES[code].format(value=value, limit=limit, quotient=quotient, steps=FEWEST_STEPS)
    return f"{where}: {what}"

"""What the C function found wrong, in words: argument, value, remedy."""

from __future__ import annotations

from contactlaw.engines.lammps import memory as codes
from contactlaw.softsphere import FEWEST_STEPS


def message(code: int, step: int, bead: int, plate: int, value: float, limit: float) -> str:
    """Say what happened to a bead, and what to do about it."""
    where = f"bead {bead}" + (f" on plate {plate}" if plate >= 0 else "") + f" at step {step}"
    what = {
        codes.STEP_TOO_LARGE: (
            f"timestep: too large for an impact at {value:.4g} m/s, which needs "
            f"{FEWEST_STEPS} steps; take {limit:.2g} s or less"
        ),
        codes.STARTS_INSIDE: (
            f"the first touch finds it {value:.4g} m deep in the plate; place it outside, or take "
            f"a shorter timestep, so that this is below {limit:.2g} m"
        ),
        codes.CROSSED: (
            f"its centre went through the plate at {value:.4g} m/s; something pushed it there that "
            "is stronger than the contact: take a shorter timestep, or remove the load"
        ),
        codes.TOO_MANY_PLATES: (
            f"plates: it touches more than {limit:.0f} of them at once; join some"
        ),
        codes.WRONG_MASS: (
            f"density: its mass is {value:.6g} kg, a sphere of the model's material has "
            f"{limit:.6g} kg; 'set group all density' to that of model.pair.sphere"
        ),
        codes.TOO_MANY_RECORDS: (
            f"records: more than {limit:.0f} impacts ended within one command; attach with more, "
            "or run fewer steps at a time"
        ),
        codes.TOO_FAST: (
            f"timestep: it flies further than its radius of {limit:.4g} m in a step, at "
            f"{value:.4g} m/s, and could jump through a plate; take {limit / value:.2g} s at most"
        ),
        codes.NOT_FINITE: "its velocity is not finite; the simulation has blown up before",
    }[code]
    return f"{where}: {what}"

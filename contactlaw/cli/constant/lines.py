"""One COR per wall as lines that engines read: LAMMPS, LIGGGHTS, YADE."""

from collections.abc import Callable, Iterator

import numpy as np

from contactlaw._escaped import line
from contactlaw._readable import relative
from contactlaw._version import VERSION
from contactlaw.answers.backend import OutsideTableError
from contactlaw.answers.constant import Constant, Keep, constant
from contactlaw.cli.constant.walls import Wall, meaning
from contactlaw.cli.parts.table import wrapped
from contactlaw.dashpot import betan
from contactlaw.engines.lammps.beads import hertz_material
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import explain

Lines = Callable[[ImpactModel, list[Wall], Keep], Iterator[str]]

_LIGGGHTS_LEAST = 0.05  # LIGGGHTS 3.8.0: "0.05 < coefficientRestitution <= 1 required"


def lammps(model: ImpactModel, found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines of LAMMPS: ``pair_coeff`` for bead on bead, a ``fix wall/gran`` for each wall.

    LAMMPS takes E/(2 (1 - nu^2)) of a wall as the effective modulus, whatever the bead's material
    is. The line has the E for which this is the effective modulus of the pair.
    """
    yield from _head(model, found, keep)
    sphere, pair = model.pair.sphere, model.pair
    beads = _bead_on_bead(model, found, keep)
    free = "linear_nohistory 0 0"
    yield "# No friction: put your own after `tangential`. Define before where each wall"
    yield '# is, as in `variable wall1 string "zplane 0 NULL"`.'
    yield "# Bead on bead by the same law at the same speeds; after `pair_style granular`."
    yield "pair_coeff * * " + hertz_material(sphere.youngs_modulus, beads.restitution, sphere.poissons_ratio, free)
    modulus = 2.0 * (1.0 - sphere.poissons_ratio**2) * pair.effective_modulus
    for n, wall in enumerate(found, start=1):
        contact = hertz_material(modulus, wall.best.restitution, sphere.poissons_ratio, free)
        yield f"fix wall{n} all wall/gran granular {contact} ${{wall{n}}}"


def liggghts(model: ImpactModel, found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines of LIGGGHTS: ``fix property/global``, type 1 for beads, one more for each wall."""
    yield from _head(model, found, keep)
    beads = _bead_on_bead(model, found, keep)
    for where, best in [("bead on bead", beads), *((wall.name, wall.best) for wall in found)]:
        if not best.restitution > _LIGGGHTS_LEAST:
            raise ValueError(
                f"{where}: the COR is {best.restitution:.3g}, and LIGGGHTS takes none below {_LIGGGHTS_LEAST}"
            )
    types = (f"{n} {wall.name}" for n, wall in enumerate(found, start=2))
    yield from _comment(f"Atom types: 1 beads, {', '.join(types)}. Wall on wall never happens: 1.")
    yield "# Bead on bead by the same law at the same speeds. `model hertz` reproduces this"
    yield "# COR; it needs its moduli as property/global, and above 1 GPa"
    yield "# `hard_particles yes`."
    size = 1 + len(found)
    matrix = np.ones((size, size))
    matrix[0] = matrix[:, 0] = [beads.restitution, *(wall.best.restitution for wall in found)]
    yield f"fix cor all property/global coefficientRestitution peratomtypepair {size} &"
    for n, row in enumerate(matrix, start=1):
        yield "    " + " ".join(f"{e:.6g}" for e in row) + " &" * (n < size)


def yade(model: ImpactModel, found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines of YADE, which is Python: ``betan`` by materials ``bead``, ``wall1`` and so on."""
    yield from _head(model, found, keep)
    yield "# For Ip2_FrictMat_FrictMat_MindlinPhys(betan=betan), without en. The results of"
    yield "# O.materials.append are called bead, wall1 and so on."
    yield "# Bead on bead by the same law at the same speeds."
    pairs = [("bead", _bead_on_bead(model, found, keep))]
    pairs += [(f"wall{n}", wall.best) for n, wall in enumerate(found, start=1)]
    matches = (f"(bead, {other}, {betan(best.restitution):.6g})" for other, best in pairs)
    yield f"betan = MatchMaker(matches=[{', '.join(matches)}])"


def _head(model: ImpactModel, found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines of a comment: the source of the numbers, and the errors of each."""
    pair = f"{model.pair.sphere.name} on {model.pair.plate.name}"
    yield from _comment(f"contactlaw {VERSION}: {pair}, law {model.force_law.family}; SI units.")
    yield from _comment(meaning(keep))
    for n, wall in enumerate(found, start=1):
        best = wall.best
        error, of_mean = (relative(e, "+z.2%") for e in (best.energy_error, best.mean_energy_error))
        yield from _comment(
            f"wall{n}, {wall.name}: COR {best.restitution:.6g} of {best.impacts} impacts. For 95 % of beads the "
            f"rebound height is wrong by less than {relative(best.rebound_error)}. The energy that the wall takes "
            f"in total is wrong by {error}; with the plain mean of the CORs, {best.mean:.4f}, by {of_mean}."
        )
        for flag, count in best.flags.items():
            yield from _comment(f"    {flag.name}, {count} of {best.impacts}: {explain(flag)[0]}")


def _comment(text: str) -> list[str]:
    return wrapped(line(f"# {text}"), "#     ")


def _bead_on_bead(model: ImpactModel, found: list[Wall], keep: Keep) -> Constant:
    """One COR for beads that hit beads of their own size at the speeds of the impacts on walls."""
    v, r, w = (np.concatenate([getattr(wall, name) for wall in found]) for name in ("speed", "radius", "weights"))
    try:
        rebound = model.lookup_sphere_sphere(v, r, r)
    except OutsideTableError as error:
        raise ValueError(
            f"bead on bead, {v[error.impact]:g} m/s: outside the table, {error.reason}. --outside "
            "clamp takes the value at its border"
        ) from error
    return constant(v, r, w, np.asarray(rebound.restitution), np.asarray(rebound.flags), keep)

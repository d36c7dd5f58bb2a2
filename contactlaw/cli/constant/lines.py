"""One COR per wall as lines that engines read: LAMMPS, LIGGGHTS, YADE."""

from collections.abc import Iterator

import numpy as np

from contactlaw._escaped import line
from contactlaw._readable import relative
from contactlaw._version import VERSION
from contactlaw.answers.backend import OutsideTableError
from contactlaw.answers.constant import Keep, constant
from contactlaw.cli.constant.records import Recorded
from contactlaw.cli.constant.walls import Wall, meaning
from contactlaw.cli.parts.table import wrapped
from contactlaw.dashpot import betan
from contactlaw.engines.lammps.beads import hertz_material
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair
from contactlaw.physical.validity import explain

_LIGGGHTS_LEAST = 0.05  # LIGGGHTS 3.8.0: "0.05 < coefficientRestitution <= 1 required"


def lines(form: str, model: ImpactModel, recorded: Recorded, found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines of an engine below comments: the source of the numbers, and the errors of each."""
    yield from _head(model, found, keep)
    cors = [_bead_on_bead(model, recorded, keep), *(wall.best.restitution for wall in found)]
    yield from {"lammps": _lammps, "liggghts": _liggghts, "yade": _yade}[form](model.pair, cors, found)


def _lammps(pair: Pair, cors: list[float], found: list[Wall]) -> Iterator[str]:
    """Lines of LAMMPS: ``pair_coeff`` for bead on bead, a ``fix wall/gran`` for each wall.

    LAMMPS takes E/(2 (1 - nu^2)) of a wall as the effective modulus, whatever the bead's material
    is. The line has the E for which this is the effective modulus of the pair.
    """
    yield "# No friction: put your own after `tangential`. Define before where each wall"
    yield '# is, as in `variable wall1 string "zplane 0 NULL"`.'
    yield "# Bead on bead by the same law at the same speeds; after `pair_style granular`."
    nu = pair.sphere.poissons_ratio
    moduli = [pair.sphere.youngs_modulus, *[2.0 * (1.0 - nu**2) * pair.effective_modulus] * len(found)]
    for n, (modulus, cor) in enumerate(zip(moduli, cors, strict=True)):
        contact = hertz_material(modulus, cor, nu, "linear_nohistory 0 0")
        yield f"fix wall{n} all wall/gran granular {contact} ${{wall{n}}}" if n else f"pair_coeff * * {contact}"


def _liggghts(pair: Pair, cors: list[float], found: list[Wall]) -> Iterator[str]:
    """Lines of LIGGGHTS: ``fix property/global``, type 1 for beads, one more for each wall."""
    for where, cor in zip(["bead on bead", *(wall.name for wall in found)], cors, strict=True):
        if not cor > _LIGGGHTS_LEAST:
            raise ValueError(f"{where}: the COR is {cor:.3g}, and LIGGGHTS takes none below {_LIGGGHTS_LEAST}")
    types = (f"{n} {wall.name}" for n, wall in enumerate(found, start=2))
    yield from _comment(f"Atom types: 1 beads, {', '.join(types)}. Wall on wall never happens: 1.")
    yield "# Bead on bead by the same law at the same speeds. `model hertz` reproduces this"
    yield "# COR; it needs its moduli as property/global, and above 1 GPa"
    yield "# `hard_particles yes`."
    size = len(cors)
    matrix = np.ones((size, size))
    matrix[0] = matrix[:, 0] = cors
    yield f"fix cor all property/global coefficientRestitution peratomtypepair {size} &"
    for n, row in enumerate(matrix, start=1):
        yield "    " + " ".join(f"{e:.6g}" for e in row) + " &" * (n < size)


def _yade(pair: Pair, cors: list[float], found: list[Wall]) -> Iterator[str]:
    """Lines of YADE, which is Python: ``betan`` by materials ``bead``, ``wall1`` and so on."""
    yield "# For Ip2_FrictMat_FrictMat_MindlinPhys(betan=betan), without en. The results of"
    yield "# O.materials.append are called bead, wall1 and so on."
    yield "# Bead on bead by the same law at the same speeds."
    matches = (f"(bead, {f'wall{n}' if n else 'bead'}, {betan(cor):.6g})" for n, cor in enumerate(cors))
    yield f"betan = MatchMaker(matches=[{', '.join(matches)}])"


def _head(model: ImpactModel, found: list[Wall], keep: Keep) -> Iterator[str]:
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


def _bead_on_bead(model: ImpactModel, recorded: Recorded, keep: Keep) -> float:
    """One COR for beads that hit beads of their own size at the speeds of the impacts on walls."""
    v, r = recorded.speed, recorded.radius
    try:
        rebound = model.lookup_sphere_sphere(v, r, r)
    except OutsideTableError as error:
        raise ValueError(
            f"bead on bead, {v[error.impact]:g} m/s: outside the table, {error.reason}. --outside "
            "clamp takes the value at its border"
        ) from error
    e, flags = np.asarray(rebound.restitution), np.asarray(rebound.flags)
    return constant(v, r, recorded.weights, e, flags, keep).restitution

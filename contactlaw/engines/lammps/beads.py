"""Contacts between beads: a line for LAMMPS's own granular contact, with contactlaw's COR."""

import itertools
from collections.abc import Sequence

from contactlaw.answers.beads import Beads
from contactlaw.laws import DEFAULT
from contactlaw.physical.arguments import scalars
from contactlaw.physical.materials import Material
from contactlaw.stepping.friction import check_friction
from contactlaw.stepping.softened import check_softening


def hertz_material(youngs_modulus: float, restitution: float, poissons_ratio: float, tangential: str) -> str:
    """Write a contact model of LAMMPS's ``pair_style granular`` with a given COR.

    Of LAMMPS's damping models, ``coeff_restitution`` alone gives that COR at any speed.
    """
    return (
        f"hertz/material {youngs_modulus:g} {restitution:.6g} {poissons_ratio:g} "
        f"tangential {tangential} damping coeff_restitution"
    )


def pair_coeff(
    sphere: Material | str | Sequence[Material | str],
    *,
    radius: float,
    speed: float,
    friction: float = 0.0,
    softening: float = 1.0,
    parcel: float = 1.0,
) -> str:
    """Write LAMMPS's ``pair_coeff`` for ``pair_style granular``.

    Parameters
    ----------
    sphere : Material or str, or a sequence of them
        Material of the beads, or those of the atom types from 1 on.
    radius : float
        Radius of a typical bead [m]; the COR does not depend on it.
    speed : float
        Typical approach speed of two beads [m/s]. LAMMPS takes one COR for all speeds, and the line
        has the one at this speed.
    friction : float, optional
        Coulomb's coefficient of friction between beads [-].
    softening, parcel : float, optional
        As in `attach`: a modulus lower by `softening`, and that with which a parcel has the force
        of the beads that it stands for. The COR is that of the true beads.

    Returns
    -------
    str
        A line for ``lmp.commands_string``, after ``pair_style granular``; for several materials,
        one for each pair of types.

    Raises
    ------
    TypeError, ValueError
        As `contactlaw.restitution_sphere_sphere`, and for a friction that is not a finite number
        of 0 or more.

    Notes
    -----
    ``hertz/material`` takes both beads of a pair for alike: the line of two materials has their
    mean Poisson's ratio, and the Young's modulus that then gives the effective one of the pair. Its
    ``coeff_restitution`` gives the COR of the line. The springs are those of LAMMPS's manual; the
    plastic flow of the beads affects the COR alone.

    Examples
    --------
    >>> from contactlaw.engines.lammps import pair_coeff
    >>> pair_coeff("gamma-alumina", radius=0.9e-3, speed=40.0).split(" tangential")[0]
    'pair_coeff * * hertz/material 1.223e+10 0.86996 0.21'
    """
    found = sphere if isinstance(sphere, list | tuple) else [sphere]
    scalars(radius=radius, speed=speed)
    check_friction(friction)
    check_softening(softening, parcel)
    tangential = f"mindlin NULL 0 {friction:g}" if friction else "linear_nohistory 0 0"
    lines = []
    for (i, one), (j, two) in itertools.combinations_with_replacement(enumerate(found, 1), 2):
        beads = Beads(one, two, DEFAULT, "raise")
        pair = beads.bodies.pair
        ratio = 0.5 * (pair.sphere.poissons_ratio + pair.plate.poissons_ratio)
        modulus = 2.0 * (1.0 - ratio**2) * pair.effective_modulus * parcel**2.5 / softening
        (part,) = beads.integrated(beads.between(speed, radius, radius))
        types = f"{i} {j}" if len(found) > 1 else "* *"
        contact = hertz_material(modulus, part.outcome.restitution.item(), ratio, tangential)
        lines.append(f"pair_coeff {types} {contact}")
    return "\n".join(lines)

"""Contacts between beads: a line for LAMMPS's own granular contact, with contactlaw's COR."""

from __future__ import annotations

from contactlaw.answers.beads import Beads
from contactlaw.answers.tabulated import Border
from contactlaw.laws import DEFAULT
from contactlaw.physical.arguments import scalars
from contactlaw.physical.materials import Material, material
from contactlaw.stepping.friction import check_friction


def hertz_material(
    youngs_modulus: float, restitution: float, poissons_ratio: float, tangential: str
) -> str:
    """Write a contact model of LAMMPS's ``pair_style granular`` with a given COR.

    Of LAMMPS's damping models, ``coeff_restitution`` alone gives that COR at any speed.
    """
    return (
        f"hertz/material {youngs_modulus:g} {restitution:.6g} {poissons_ratio:g} "
        f"tangential {tangential} damping coeff_restitution"
    )


def pair_coeff(
    sphere: Material | str, *, radius: float, speed: float, friction: float = 0.0
) -> str:
    """Write LAMMPS's ``pair_coeff`` line for ``pair_style granular``, for beads of one material.

    Parameters
    ----------
    sphere : Material or str
        Material of the beads.
    radius : float
        Radius of a typical bead [m]; the COR does not depend on it.
    speed : float
        Typical approach speed of two beads [m/s]. LAMMPS takes one COR for all speeds, and the line
        has the one at this speed.
    friction : float, optional
        Coulomb's coefficient of friction between beads [-].

    Returns
    -------
    str
        A command for ``lmp.command``, after ``pair_style granular``.

    Raises
    ------
    TypeError, ValueError
        As `contactlaw.restitution_sphere_sphere`, and for a friction that is not a finite number
        of 0 or more.

    Notes
    -----
    ``hertz/material`` takes the Young's modulus of one bead and combines it with the other's
    itself; its ``coeff_restitution`` gives the COR of the line. The springs are those of LAMMPS's
    manual; the plastic flow of the beads affects the COR alone.

    Examples
    --------
    >>> from contactlaw.engines.lammps import pair_coeff
    >>> pair_coeff("gamma-alumina", radius=0.9e-3, speed=40.0).split(" tangential")[0]
    'pair_coeff * * hertz/material 1.223e+10 0.86996 0.21'
    """
    one = material(sphere) if isinstance(sphere, str) else sphere
    scalars(radius=radius, speed=speed)
    check_friction(friction)
    beads = Beads(one, one, DEFAULT, Border("raise"))
    restitution = beads.integrated(speed, radius, radius)
    tangential = f"mindlin NULL 0 {friction:g}" if friction else "linear_nohistory 0 0"
    return "pair_coeff * * " + hertz_material(
        one.youngs_modulus, float(restitution), one.poissons_ratio, tangential
    )

"""Restitution of a wall over the angle of impact, as particle tracers take it.

Fluent: the macro ``DEFINE_DPM_BC`` of its UDF manual, which computes the angle itself, so that the
file does not rest on how a dialog counts it. AcuTrace: ``FINITE_MASS_BOUNDARY_CONDITION`` and the
syntax of arrays in Altair's command reference. Neither program was at hand to try a file in it.
"""

from string import Template

from contactlaw._arrays import Array
from contactlaw._escaped import c_comment, line

_FLUENT = Template("""\
/* Rebound of beads from a wall, by contactlaw $version, for Ansys Fluent; not tried in Fluent.
   $about
   A compiled user-defined function: build and load it, and choose it as the discrete-phase
   boundary condition of the wall, in place of reflect. A tracked particle has no spin here. The
   wall is at rest, and the flow is not axisymmetric with swirl. Old releases call TP_VEL P_VEL. */
#include "udf.h"

#define ROWS $rows

/* angle between path and wall [deg], normal and tangential restitution */
static const real table[ROWS][3] = {
$table
};

DEFINE_DPM_BC(contactlaw_reflect, tp, t, f, f_normal, dim)
{
    real normal = 0.0, size = 0.0, along, angle, share, coefficient[2];
    int i, row = 0;

    for (i = 0; i < dim; i++) {
        normal += TP_VEL(tp)[i] * f_normal[i];
        size += TP_VEL(tp)[i] * TP_VEL(tp)[i];
    }
    along = size - normal * normal;
    angle = atan2(fabs(normal), along > 0.0 ? sqrt(along) : 0.0) * 180.0 / 3.14159265358979;
    while (row < ROWS - 2 && angle > table[row + 1][0])
        row++;
    share = (angle - table[row][0]) / (table[row + 1][0] - table[row][0]);
    share = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    for (i = 0; i < 2; i++)
        coefficient[i] = (1.0 - share) * table[row][i + 1] + share * table[row + 1][i + 1];
    for (i = 0; i < dim; i++) {
        TP_VEL(tp)[i] = coefficient[1] * (TP_VEL(tp)[i] - normal * f_normal[i])
                        - coefficient[0] * normal * f_normal[i];
        TP_VEL0(tp)[i] = TP_VEL(tp)[i];
    }
    return PATH_ACTIVE;
}
""")

_ACUSOLVE = Template("""\
# Rebound of beads from a wall, by contactlaw $version, for AcuTrace (AcuSolve); not tried in it.
# $about
# AcuTrace takes both coefficients over the normal part of the impact velocity. The tangential
# ones hold for beads of the speed above alone: it stands for the angle. "wall" is the name of a
# PARTICLE_SURFACE: put in yours.
FINITE_MASS_BOUNDARY_CONDITION( "wall" ) {
    particle_surface         = "wall"
    wall_type                = reflect
    wall_en_type             = piecewise_linear
    wall_en_curve_fit_values = {
$normal
    }
    wall_et_type             = piecewise_linear
    wall_et_curve_fit_values = {
$tangential
    }
}
""")


def fluent(about: str, version: str, angle: Array, normal: Array, tangential: Array) -> str:
    """Write a user-defined function; angles rise and are from the wall [deg]."""
    rows = zip(angle, normal, tangential, strict=True)
    table = ",\n".join(f"    {{{a:.10g}, {n:.6g}, {t:.6g}}}" for a, n, t in rows)
    return _FLUENT.substitute(about=c_comment(about), version=version, rows=angle.size, table=table)


def acusolve(about: str, version: str, speed: Array, normal: Array, tangential: Array) -> str:
    """Write a boundary condition; normal speeds rise [m/s]."""
    columns = {
        name: "\n".join(f"        {v:.10g}, {e:.6g} ;" for v, e in zip(speed, values, strict=True))
        for name, values in (("normal", normal), ("tangential", tangential))
    }
    return _ACUSOLVE.substitute(about=line(about), version=version, **columns)

"""Walls in a LAMMPS simulation: the stateful law, in an engine that integrates the contact.

`attach` puts plates and meshes into a user's own ``lammps`` object. Their force on the beads comes
from `contactlaw.softsphere`, through ``fix external``; a compiled function is called in each time
step, no Python. What a bead remembers of its contacts is in ``fix property/atom``: it moves with
the bead from rank to rank and is part of restart files.

Simulation
    ``units si``, ``cgs`` or ``micro``, three dimensions, ``atom_style sphere``, integrated by ``fix
    nve/sphere``. Without a pair style LAMMPS needs ``comm_modify cutoff``. Beads are solid spheres
    of the model's material; for several materials `attach` takes a model for each atom type. Walls,
    models, records and errors are in SI units, whatever LAMMPS's are. Bead on bead is LAMMPS's own:
    ``pair_style granular`` and the line that `pair_coeff` writes.
Walls
    `Plate` is a rectangle, `Mesh` any triangles: from a file, from arrays, a cylinder, cone or
    disc. Each may have its own thickness, each triangle too, its own material, and a motion:
    `Translation`, `Rotation`, `Vibration`, `Tabulated`. Beads touch either side of a sheet. The
    facets near a bead are found by a grid, in coordinates that move with the wall.
Dump
    ``d_contactlaw_restitution`` is the COR of each bead's last impact on a wall, 0 before the first
    one. ``d2_contactlaw[1]`` and so on are the memory of its contacts, which is of no use in a dump
    (rows of `contactlaw.stepping.contact.CONTACT`, see `contactlaw.engines.lammps.memory`).
Time step
    A contact lasts some microseconds and takes at least 20 steps:
    `contactlaw.softsphere.time_step` tells how long one may be. An impact that is too fast for the
    step ends the run. It is judged by 20 steps of an elastic contact with a half-space; a plastic
    one is shorter, 18 such steps at 60 m/s, which `time_step` knows.
Thin plates
    An impact so inelastic that the model's table does not reach it (lambda above 5 or 6: R/H of
    some 9 at 5 m/s) ends the run, as it is refused by the model; ``ImpactModel(...,
    outside="solve")`` has it integrated.
Walls that meet
    Where facets meet within 1e-4 of a bead's radius they are one surface: the bead has one contact,
    with that which has the nearest point on its face, else on an edge, else at a corner (the first
    of them on the seam itself), and takes it along from one to the next. So it is where faces meet
    at less than 20 degrees, as in a tessellated cylinder: the contact is with the deepest. Of more
    than eight contacts at once the deepest are kept; `LammpsPlates.left_out` counts the others.
Motion
    The pose follows from the number of steps since the walls' clock began, `LammpsPlates.time`, and
    so has the same bits in one run or many. `attach` starts it where LAMMPS's own clock is;
    ``reset_timestep`` does not touch it. (After one, a restart starts from the clock that was set.)
    Speeds in the record are those relative to the wall, and ``wall_work`` is what the wall's motion
    has done on the bead: kinetic energy after an impact is that before, and this, less the losses
    and, with friction, less what sliding takes, which the record does not have.
Several ranks
    Every rank makes its LAMMPS object, attaches the same plates and gives the same commands. Beads
    that feel plates alone move on the same path, to the last bit, on 1 and 2 ranks and in one run
    or many.
Restart
    ``read_restart``, then the fixes of your own, then `attach` with the same plates and friction:
    the contacts go on where they were. The record of impacts begins anew. ``reset_timestep`` and
    ``timestep`` change no contact that is under way, and walls go on moving from where they were;
    `LammpsPlates.detach` ends it without a record.
Errors
    What goes wrong in a time step stops the run within 100 steps, on all ranks, and is raised by
    the ``command``, ``commands_string``, ``commands_list`` or ``file`` that ran it. A command with
    time steps in it is one for all ranks; any other waits for nobody.
Other commands
    ``clear`` ends the attachment; its record stays. What would take the adapter's own parts out
    (``unfix contactlaw`` and so on) is refused, `LammpsPlates.detach` does it, and so are
    ``minimize``, ``rerun`` and their like, which move beads without time steps, and ``run_style
    respa``, under which LAMMPS asks no plate; where a file hides them, the error comes after them.
    ``delete_atoms`` and ``reset_atoms`` leave the contacts of the other beads as they are, if given
    as a ``command`` by themselves. A bead that is set elsewhere in mid-contact (``displace_atoms``,
    ``set``, ``read_dump``) ends the contact there, at the speed that it happens to have. One whose
    diameter, mass or atom type becomes another in mid-contact (``set``, ``fix adapt``, also of a
    bead at rest) is an error, and makes no record: an impact is one of one sphere. Of a ``fix
    wall/gran`` rank 0 warns: a bead on both walls at once has a restitution that is of neither.
What it leaves out
    Walls are not seen across a periodic boundary; a contact goes on across it with the wall there
    that the bead overlaps as deeply. The virial has no part of them. A wall's own
    curvature is none of the law's, and at an edge the law is that of the face. Sliding friction has
    a spring without damping, as LAMMPS's ``mindlin``; there is no rolling friction.
"""

from contactlaw.engines.lammps.attachment import LammpsPlates, attach
from contactlaw.engines.lammps.beads import pair_coeff
from contactlaw.walls import Mesh, Plate, Rotation, Tabulated, Translation, Vibration

__all__ = [
    "LammpsPlates",
    "Mesh",
    "Plate",
    "Rotation",
    "Tabulated",
    "Translation",
    "Vibration",
    "attach",
    "pair_coeff",
]

"""Walls in a LAMMPS simulation, whose force on the beads depends on the history of each contact.

`attach` puts walls into a user's own ``lammps`` object. Their force on the beads is that of
`contactlaw.softsphere`. It goes through ``fix external``, which calls a compiled function in each
time step, and no Python. The state of a bead's contacts is in ``fix property/atom``: it moves with
the bead from rank to rank and is part of restart files.

Simulation
    ``units si``, ``cgs`` or ``micro``, three dimensions, ``atom_style sphere``, integrated by ``fix
    nve/sphere``. Without a pair style LAMMPS needs ``comm_modify cutoff``. Beads are solid spheres
    of the model's material; for several materials `attach` takes a model for each atom type. Walls,
    models, records and errors are in SI units, whatever LAMMPS's are. Contacts between beads are
    LAMMPS's own: ``pair_style granular`` and the line that `pair_coeff` writes.
Walls
    See docs/lammps.md. Beads touch a wall from either side; each wall knows its own edges only.
Time step
    A contact lasts some microseconds and takes at least 20 steps:
    `contactlaw.softsphere.time_step` gives the longest step. An impact too fast for the step ends
    the run. The longest step allowed is 1/20 of an elastic contact with a half-space; a plastic
    contact is shorter, 18 such steps at 60 m/s, which `time_step` takes into account.
Thin plates
    An impact so inelastic that it is outside the model's table (lambda above 5 or 6: R/H of some 9
    at 5 m/s) ends the run, because the model refuses it. A model with ``outside="solve"``
    integrates it instead.
Walls that meet
    Facets that meet within 1e-4 of a bead's radius are one surface, on which the bead has one
    contact: with a facet whose nearest point is on its face, else on an edge, else at a corner (on
    a seam: the first). It moves on from facet to facet. The same holds for faces that meet at less
    than 20 degrees, as in a tessellated cylinder: the contact is with the deepest one. Of more than
    eight contacts of a bead the deepest are kept; `LammpsPlates.left_out` counts the others.
Motion
    A wall starts where it was given, when it is attached; ``attach(..., start=...)`` says another
    time. Its position follows from `LammpsPlates.time`, which counts whole steps, and so has the
    same bits in one run or many. This clock starts at LAMMPS's own time, and ``reset_timestep`` does
    not change it (a restart after that starts at the reset time). Speeds in the record are relative
    to the wall, and ``wall_work`` is the work of the wall's motion on the bead: the kinetic energy
    after an impact, with that of the spin, is that before, plus this work, less the energies that
    the record says are lost.
Restart
    ``read_restart``, then the fixes of your own, then `attach` with the same plates and friction:
    the contacts and the motion of walls go on where they were. The record of impacts begins anew.
    ``reset_timestep`` and ``timestep`` change no contact in progress, and walls go on from where
    they are; `LammpsPlates.detach` ends a contact without a record.
Errors
    An error in a time step stops the run within 100 steps, on all ranks, and is raised by the
    ``command``, ``commands_string``, ``commands_list`` or ``file`` that ran it. All ranks have to
    give a command with time steps together; other commands may be given by one rank alone.
Other commands
    ``clear`` ends the attachment; its record stays. Commands that take out the adapter's own parts
    (``unfix contactlaw`` and so on; use `LammpsPlates.detach`), that move beads without time steps
    (``minimize``, ``rerun``), and ``run_style respa``, under which LAMMPS does not call the plates,
    end with an error. ``delete_atoms`` and ``reset_atoms`` keep the contacts of the other beads if
    they are not in one call with time steps. A bead that is moved away in mid-contact
    (``displace_atoms``, ``set``, ``read_dump``) ends its contact there, at its present speed. A
    change of diameter, mass or atom type in mid-contact (``set``, ``fix adapt``), even of a bead at
    rest, is an error and not recorded, because an impact belongs to one sphere.
What it leaves out
    Beads do not touch walls on the other side of a periodic boundary; the contact of a bead that
    crosses one goes on with the wall there that has the same overlap. Triclinic boxes, and periodic
    ones that deform, are refused. The virial has no part of the walls. The law
    knows the curvature of round walls alone, and has no rolling friction.
"""

from contactlaw.engines.lammps.attachment import LammpsPlates, attach
from contactlaw.engines.lammps.beads import pair_coeff
from contactlaw.walls import Cone, Cylinder, Disc, Mesh, Plate, Ring, Sphere
from contactlaw.walls.motion import Rotation, Tabulated, Translation, Vibration

__all__ = ["LammpsPlates", "attach", "pair_coeff", "Cone", "Cylinder", "Disc", "Mesh", "Plate", "Ring", "Sphere"]
__all__ += ["Rotation", "Tabulated", "Translation", "Vibration"]

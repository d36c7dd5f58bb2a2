"""The same indentations and one impact by CalculiX, a program that shares no code with this solver.

G. Dhondt, K. Wittig, CalculiX, www.calculix.de; the Debian package is ``calculix-ccx``. Units in
its input are mm, N, MPa and us, in which a density has the number that it has in kg/m^3.

An impact avoids three faults of version 2.20. Initial velocities do not reach the
nodes into which it expands axisymmetric elements (github.com/Dhondtguido/CalculiX, issue 63): a
uniform body force sets the sphere in motion without stress. Face-to-face contact reads, in dynamic
steps, state variables of plastic material that are not set yet (repaired in its source in July
2023): contact is of nodes with faces. That does not converge on faces that shrink to a point at the
axis: both bodies have a thin hole along it.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from validation.fem import mesh
from validation.fem.impact import PATIENCE, Expected, expect, free_width, meshed
from validation.fem.indentation import BLOCK, core
from validation.fem.mesh import Mesh

Array = NDArray[np.float64]

FRICTION = 0.1  # as in the paper
# Our choices.
_STIFFNESS = 20.0  # stiffness of the contact, over the sphere's modulus per smallest element ...
_SOFTER = 10.0  # ... and in an impact, where nodes of a stiffer contact chatter
_STICK = 0.1  # stiffness of sticking, over that of the contact
_TENSION = 0.1  # on nodes far from faces [MPa]; ccx needs one; a thousandth of the pressures
_REACH = 1.0  # how far from the axis the surfaces may touch [R]: contacts have less than 0.3
_STRAINS = np.geomspace(1e-5, 1.0, 60).tolist()  # of the polygon that hardening is given as
_HARDENING = 1e-4  # slope over Young's modulus; the iterations need one
_HOLE = 0.02  # radius, over the smallest element
_FLIGHT = 3  # increments that set the sphere in motion ...
_GAP = 2.5  # ... and those from there to the contact, which begins in mid-increment
_SILENT = 2e-3  # part of the peak force below which the sphere has left
_WEDGE = 180.0  # its axisymmetric elements are wedges of 2 degrees
_MM, _MPA, _US = 1e3, 1e-6, 1e6  # per m, per Pa, per s

SETTINGS = {
    "procedure": "NLGEOM, STATIC, increments up to 0.02 of the way",
    "contact": "surface to surface, pressure linear in overclosure",
    "contact_stiffness": f"{_STIFFNESS:g} E/h; sphere's modulus E, smallest element h",
    "stick_stiffness": f"{_STICK:g} of the contact's",
    "hardening": f"{_HARDENING:g} E",
}
IMPACT_SETTINGS = {
    **SETTINGS,
    "procedure": "NLGEOM, DYNAMIC (Hilber-Hughes-Taylor), equal increments",
    "contact": "node to surface, pressure linear in overclosure",
    "contact_stiffness": f"{_SOFTER:g} E/h; sphere's modulus E, smallest element h",
    "hole": f"{_HOLE:g} h",
}


class History(NamedTuple):
    """One impact; time 0 is when the gap would close, and the first samples are earlier."""

    time: Array  # equally spaced [s]
    force: Array  # contact force [N]
    speed: Array  # mean of the sphere, towards the plate [m/s]

    @property
    def contact_time(self) -> float:
        """Time until the force is zero for good [s]."""
        return float(self.time[self._last() + 1])

    @property
    def restitution(self) -> float:
        """Mean speed after the contact over that before it [-]."""
        return float(-self.speed[self._last() + 2 :].mean() / self.speed[0])

    def _last(self) -> int:
        return int(np.flatnonzero(self.force > _SILENT * self.force.max())[-1])


def installed() -> bool:
    """Whether ``ccx`` can be run."""
    return shutil.which("ccx") is not None


def version() -> str:
    """Version that ``ccx`` reports."""
    text = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    return " ".join(text.split()[-2:])


def facts(pair: cl.Pair) -> dict[str, Any]:
    """State what made a result: version, friction and materials."""
    return {
        "calculix_version": version(),
        "friction": FRICTION,
        **{role: _stated(getattr(pair, role)) for role in ("sphere", "plate")},
    }


def elements(text: str) -> int:
    """Count the elements of an input."""
    return len(re.findall(r"^\d+(?:, \d+){4}$", text, re.M))


def deck(pair: cl.Pair, radius: float, depth: float, size: float, friction: float = FRICTION) -> str:
    """Input of ``ccx`` for a hemisphere that is pressed into a block and drawn back.

    Parameters
    ----------
    pair : contactlaw.Pair
        Materials of hemisphere and block; what has a yield strength yields.
    radius, depth : float
        Radius of the hemisphere and largest compression [m].
    size : float
        Smallest element, over the radius.
    friction : float, optional
        Coefficient of friction.

    Examples
    --------
    >>> import contactlaw as cl
    >>> text = deck(cl.Pair("gamma-alumina", "glass"), 0.9e-3, 1e-5, 0.1)
    >>> text.count("*STEP"), text.count("CAX4")
    (2, 2)
    """
    fine, block, width = size * radius, BLOCK * radius, core(radius, depth)
    above = mesh.sphere(radius, fine, width, hemisphere=True)
    below = mesh.plate(radius, fine, width, block, block)
    top = np.flatnonzero(above.nodes[:, 1] > radius * (1 - 1e-9))
    foot = len(above.nodes) + np.flatnonzero(below.nodes[:, 1] < -block * (1 - 1e-9))
    motion = "".join(
        f"*STEP, NLGEOM, INC=2000\n*STATIC\n0.01, 1., 1e-6, 0.02\n"
        f"*BOUNDARY\nTOP, 2, 2, {-target * _MM:.9e}\n"
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP\n"
        for target in (depth, 0.0)
    )
    return (
        _bodies(pair, radius, above, below)
        + _set("TOP", top)
        + _set("FOOT", foot)
        + _contact(pair, "SURFACE TO SURFACE", _STIFFNESS / fine, friction)
        + "*BOUNDARY\nFOOT, 2, 2\n"
        + motion
    )


class Fall(NamedTuple):
    """An impact as `impact_deck` and `run_impact` take it."""

    pair: cl.Pair
    speed: float  # [m/s]
    radius: float  # of the sphere [m]
    thickness: float  # of the plate [m]
    size: float  # smallest element, over the radius
    damping: float = 0.05  # -alpha of Hilber, Hughes and Taylor, 0 to 1/3
    increments: int = 115  # in the contact time that the model expects; 0.03 R needs 170
    friction: float = FRICTION  # coefficient

    @property
    def expected(self) -> Expected:
        """Contact time and radius of the contact by the model."""
        return expect(self.pair, self.speed, self.radius, self.thickness)

    @property
    def meshes(self) -> tuple[Mesh, Mesh]:
        """Sphere and plate as `impact.impact` makes them."""
        width = free_width(self.pair.plate, self.expected.time)
        return meshed(self.expected, self.radius, self.thickness, self.size, width)


def impact_deck(fall: Fall) -> str:
    """Input of ``ccx`` for a sphere that falls on a plate.

    Examples
    --------
    >>> import contactlaw as cl
    >>> text = impact_deck(Fall(cl.Pair("gamma-alumina", "glass"), 26.0, 0.9e-3, 0.5e-3, 0.1))
    >>> text.count("*DYNAMIC"), text.count("CAX4")
    (2, 2)
    """
    above, below = fall.meshes
    step = fall.expected.time / fall.increments
    flight, fine = _FLIGHT * step, fall.size * fall.radius
    gap = fall.speed * (0.5 * flight + _GAP * step)
    raised = above._replace(nodes=above.nodes + [0.0, gap])
    period = round(_GAP + (1.0 + PATIENCE) * fall.increments) * step
    return (
        _bodies(fall.pair, fall.radius, raised, below, _HOLE * fine)
        + _set("SPHERE", np.arange(len(above.nodes)))
        + _contact(fall.pair, "NODE TO SURFACE", _SOFTER / fine, fall.friction)
        + f"*STEP, NLGEOM\n*DYNAMIC, ALPHA=0., DIRECT\n{step * _US:.9e}, {flight * _US:.9e}\n"
        + f"*DLOAD\nSPHERE, GRAV, {fall.speed / flight * _MM / _US**2:.9e}, 0., -1., 0.\n"
        + "*NODE PRINT, NSET=SPHERE\nU\n*END STEP\n"
        + f"*STEP, NLGEOM, INC=2000\n*DYNAMIC, ALPHA={-fall.damping:g}, DIRECT\n"
        + f"{step * _US:.9e}, {period * _US:.9e}\n*DLOAD, OP=NEW\n*END STEP\n"
    )


def run(pair: cl.Pair, radius: float, depth: float, size: float, friction: float = FRICTION) -> tuple[Array, Array]:
    """Compression [m] and force [N], loading then unloading, by ``ccx``.

    Parameters
    ----------
    pair, radius, depth, size, friction
        As in `deck`.

    Raises
    ------
    RuntimeError
        If ``ccx`` does not reach the end.
    """
    text = _printed(deck(pair, radius, depth, size, friction))
    found = re.findall(r"set TOP and time\s+(\S+)\s+\S+\s+(\S+)", text)
    time, force = np.array(found, dtype=float).T
    compression = depth * np.where(time <= 1.0, time, 2.0 - time)
    return compression, -_WEDGE * force


def run_impact(fall: Fall) -> History:
    """Compute an impact by ``ccx``; force and speed are from the displacements of the sphere.

    Raises
    ------
    RuntimeError
        If ``ccx`` does not reach the end.
    """
    text = _printed(impact_deck(fall))
    blocks = re.split(r"displacements \(vx,vy,vz\) for set SPHERE and time", text)[1:]
    mass = _masses(fall.meshes[0], fall.pair.sphere.density)
    time, fallen = np.empty(len(blocks)), np.empty(len(blocks))
    for n, block in enumerate(blocks):
        instant, table = block.split("\n\n")[:2]
        time[n] = float(instant) / _US
        nodes = np.array([line.split()[2] for line in table.splitlines()], dtype=float)
        fallen[n] = -mass @ nodes / mass.sum() / _MM
    time, fallen = time[_FLIGHT - 1 :], fallen[_FLIGHT - 1 :]  # from the end of the flight on
    step = time[1] - time[0]
    force = -mass.sum() * np.diff(fallen, 2) / step**2
    since = time[1:-1] - time[0] - _GAP * step
    return History(since, force, (fallen[2:] - fallen[:-2]) / (2.0 * step))


def _masses(body: Mesh, density: float) -> Array:
    """Sum of each row of the consistent mass matrix [kg], which gives the momentum exactly."""
    mass = np.zeros(len(body.nodes))
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    r, z = (body.nodes[body.elements, k] for k in range(2))
    for point in corners / math.sqrt(3.0):  # Gauss
        near = 1.0 + corners * point
        shape = 0.25 * near.prod(axis=1)
        a, b = (0.25 * corners * near[:, ::-1]).T
        area = (r @ a) * (z @ b) - (r @ b) * (z @ a)
        volume = 2.0 * math.pi * (r @ shape) * area
        np.add.at(mass, body.elements, density * volume[:, None] * shape)
    return mass


def _printed(text: str) -> str:
    """Run ``ccx`` on an input; return the text of its data file."""
    with tempfile.TemporaryDirectory() as folder:
        job = Path(folder) / "job"
        job.with_suffix(".inp").write_text(text)
        done = subprocess.run(
            ["ccx", job.name], cwd=folder, env={**os.environ, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True
        )
        if "Job finished" not in done.stdout:
            raise RuntimeError(f"ccx did not finish: {done.stdout[-500:]}")
        return job.with_suffix(".dat").read_text()


def _bodies(pair: cl.Pair, radius: float, above: Mesh, below: Mesh, hole: float = 0.0) -> str:
    """Both bodies with their materials, faces that may touch, and axis."""
    first = len(above.nodes)
    nodes = np.concatenate([above.nodes, below.nodes])
    axis = nodes[:, 0] == 0.0
    nodes[axis, 0] = hole
    return (
        "*NODE\n"
        + "".join(f"{n + 1}, {r:.9e}, {z:.9e}, 0.\n" for n, (r, z) in enumerate(nodes * _MM))
        + _elements("SPHERE", above.elements, 0)
        + _elements("PLATE", below.elements + first, len(above.elements))
        + _surface("ABOVE", above, 0, _REACH * radius)
        + _surface("BELOW", below, len(above.elements), _REACH * radius)
        + _material("SPHERE", pair.sphere)
        + _material("PLATE", pair.plate)
        + _set("AXIS", np.flatnonzero(axis))
        + "*BOUNDARY\nAXIS, 1, 1\n"
    )


def _contact(pair: cl.Pair, kind: str, stiffness: float, friction: float) -> str:
    """Contact whose stiffness is given over the sphere's modulus [1/m]."""
    slope = stiffness / _MM * pair.sphere.youngs_modulus * _MPA
    return (
        "*SURFACE INTERACTION, NAME=TOUCH\n"
        f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{slope:.6e}, {_TENSION:g}\n"
        + (f"*FRICTION\n{friction:g}, {_STICK * slope:.6e}\n" if friction else "")
        + f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={kind}\nABOVE, BELOW\n"
    )


def _elements(name: str, quads: NDArray[np.int64], first: int) -> str:
    lines = (f"{first + e + 1}, " + ", ".join(map(str, q + 1)) for e, q in enumerate(quads))
    return f"*ELEMENT, TYPE=CAX4, ELSET={name}\n" + "\n".join(lines) + "\n"


def _set(name: str, nodes: NDArray[np.int64]) -> str:
    return f"*NSET, NSET={name}\n" + "".join(f"{n + 1},\n" for n in nodes)


def _surface(name: str, body: Mesh, first: int, reach: float) -> str:
    """Faces of elements between neighbours of the surface, as far as they may touch."""
    near = body.surface[body.nodes[body.surface, 0] <= reach]
    lines = []
    for e, quad in enumerate(body.elements):
        for k in range(4):
            if np.isin(quad[[k, (k + 1) % 4]], near).all():
                lines.append(f"{first + e + 1}, S{k + 1}\n")
    return f"*SURFACE, NAME={name}, TYPE=ELEMENT\n" + "".join(lines)


def _material(name: str, material: cl.Material) -> str:
    modulus, ratio = material.youngs_modulus * _MPA, material.poissons_ratio
    lines = [
        f"*SOLID SECTION, ELSET={name}, MATERIAL={name}",
        f"*MATERIAL, NAME={name}",
        f"*ELASTIC\n{modulus:.6e}, {ratio:g}",
        f"*DENSITY\n{material.density:.6e}",
    ]
    flow = material.flow
    if flow is not None:  # a body that has none is elastic
        strains = (0.0, *_STRAINS) if flow.hardening else (0.0, 1.0)
        lines.append("*PLASTIC")
        lines += [
            f"{flow.stress(strain) * _MPA + _HARDENING * modulus * strain:.6e}, {strain:#.6g}" for strain in strains
        ]
    return "\n".join(lines) + "\n"


def _stated(material: cl.Material) -> str:
    strength = material.strength
    return (
        f"{material.name}: E {material.youngs_modulus:g} Pa, nu {material.poissons_ratio:g}, "
        f"{material.density:g} kg/m^3, "
        + (f"yield strength {strength:g} Pa" if strength else "elastic")
        + (f", hardening {material.hardening}" if material.hardening else "")
    )

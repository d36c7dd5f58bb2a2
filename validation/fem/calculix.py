"""The same indentation by CalculiX, a program that shares no line with this solver.

G. Dhondt, K. Wittig, CalculiX, www.calculix.de; the Debian package is ``calculix-ccx``. Units in
its input are mm, N and MPa.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from validation.fem import mesh
from validation.fem.indentation import BLOCK, core
from validation.fem.mesh import Mesh

Array = NDArray[np.float64]

SETTINGS = (
    "NLGEOM, STATIC, increments up to 0.02 of the way; contact pressure linear in overclosure, "
    "20 times the sphere's modulus over the smallest element; hardening 1e-4 of the modulus"
)
_STIFFNESS = 20.0  # of the contact, over the sphere's modulus per smallest element
_HARDENING = 1e-4  # of Young's modulus, which the iterations need
_WEDGE = 180.0  # its axisymmetric elements are wedges of 2 degrees


def installed() -> bool:
    """Whether ``ccx`` can be run."""
    return shutil.which("ccx") is not None


def version() -> str:
    """Version that ``ccx`` reports."""
    text = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    return " ".join(text.split()[-2:])


def deck(pair: cl.Pair, radius: float, depth: float, size: float, friction: float = 0.1) -> str:
    """Input of ``ccx`` for a hemisphere that is pressed into a block and drawn back.

    Parameters
    ----------
    pair : contactlaw.Pair
        Materials of hemisphere and block.
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
    unit = 1e3  # m to mm
    fine, block = size * radius, BLOCK * radius
    width = core(radius, depth)
    above = mesh.sphere(radius, fine, width, hemisphere=True)
    below = mesh.plate(radius, fine, width, block, block)
    first = len(above.nodes)
    nodes = np.concatenate([above.nodes, below.nodes]) * unit
    top = np.flatnonzero(above.nodes[:, 1] > radius * (1 - 1e-9))
    foot = first + np.flatnonzero(below.nodes[:, 1] < -block * (1 - 1e-9))
    axis = np.flatnonzero(nodes[:, 0] == 0.0)
    soft = pair.sphere.youngs_modulus * 1e-6
    slope = _STIFFNESS * soft / (fine * unit)
    strength = pair.sphere.require_yield_strength("calculix") * 1e-6
    motion = "".join(
        f"*STEP, NLGEOM, INC=2000\n*STATIC\n0.01, 1., 1e-6, 0.02\n"
        f"*BOUNDARY\nTOP, 2, 2, {-way * unit:.9e}\n"
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP\n"
        for way in (depth, 0.0)
    )
    return (
        "*NODE\n"
        + "".join(f"{n + 1}, {r:.9e}, {z:.9e}, 0.\n" for n, (r, z) in enumerate(nodes))
        + _elements("SPHERE", above.elements, 0)
        + _elements("BLOCK", below.elements + first, len(above.elements))
        + _set("TOP", top)
        + _set("FOOT", foot)
        + _set("AXIS", axis)
        + _surface("ABOVE", above, 0, 1.0 * radius)
        + _surface("BELOW", below, len(above.elements), 1.0 * radius)
        + _material("SPHERE", pair.sphere)
        + f"*PLASTIC\n{strength:.6e}, 0.\n{strength + _HARDENING * soft:.6e}, 1.\n"
        + _material("BLOCK", pair.plate)
        + "*SURFACE INTERACTION, NAME=TOUCH\n"
        + f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{slope:.6e}, 0.1\n"
        + (f"*FRICTION\n{friction:g}, {0.1 * slope:.6e}\n" if friction else "")
        + "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE\nABOVE, BELOW\n"
        + "*BOUNDARY\nAXIS, 1, 1\nFOOT, 2, 2\n"
        + motion
    )


def run(
    pair: cl.Pair, radius: float, depth: float, size: float, friction: float = 0.1
) -> tuple[Array, Array]:
    """Compression [m] and force [N], loading then unloading, as ``ccx`` has them.

    Parameters
    ----------
    pair, radius, depth, size, friction
        As in `deck`.

    Raises
    ------
    RuntimeError
        If ``ccx`` does not reach the end.
    """
    with tempfile.TemporaryDirectory() as folder:
        job = Path(folder) / "indentation"
        job.with_suffix(".inp").write_text(deck(pair, radius, depth, size, friction))
        done = subprocess.run(["ccx", job.name], cwd=folder, capture_output=True, text=True)
        if "Job finished" not in done.stdout:
            raise RuntimeError(f"ccx did not finish: {done.stdout[-500:]}")
        text = job.with_suffix(".dat").read_text()
    found = re.findall(r"set TOP and time\s+(\S+)\s+\S+\s+(\S+)", text)
    time, force = np.array(found, dtype=float).T
    compression = depth * np.where(time <= 1.0, time, 2.0 - time)
    return compression, -_WEDGE * force


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
    modulus, ratio = material.youngs_modulus * 1e-6, material.poissons_ratio
    return (
        f"*SOLID SECTION, ELSET={name}, MATERIAL={name}\n*MATERIAL, NAME={name}\n"
        f"*ELASTIC\n{modulus:.6e}, {ratio:g}\n"
    )

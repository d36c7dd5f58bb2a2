"""``contactlaw report``: a page with figures about recorded impacts."""

from __future__ import annotations

import argparse
import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._content import content_of
from contactlaw.cli.parts import columns, options, quantities, wording
from contactlaw.cli.parts.quantities import LENGTH
from contactlaw.engines import hdf5, layout
from contactlaw.engines.record import typed
from contactlaw.report import files
from contactlaw.report.run import Run
from contactlaw.report.surface import Surface
from contactlaw.walls.mesh import Mesh

Floats = NDArray[np.float64]

_TOO_LARGE = 300.0  # [extent of the contacts on it]: a mesh in millimetres is 1000 times as large
_APART = 1e-3  # [extent of the mesh]; contacts farther from their triangles are of walls that move
_HDF5 = ".h5", ".hdf5"


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    command = options.command(commands, "report", "a page with figures about a run", _run)
    add = command.add_argument
    add(
        "record",
        help="recorded impacts: an engine's, saved by np.save (.npy), or a file of dem-demo (.h5)",
    )
    add(
        "--mesh", action="append", default=[], metavar="FILE",
        help="mesh of the wall (STL, PLY, OBJ), for a map of the energy; several for several "
        "walls, in the order of their numbers (default: none, and no map)",
    )  # fmt: skip
    add(
        "--scale", type=options.reader_of(quantities.value, LENGTH), metavar="LENGTH",
        help="length of the mesh's unit, 1mm for a drawing in millimetres (default: 1 m)",
    )  # fmt: skip
    add("--out", default="report", metavar="FOLDER", help="default: %(default)s")


def _run(arguments: argparse.Namespace) -> None:
    path = Path(arguments.record)
    read = _hdf5 if path.suffix.lower() in _HDF5 else _npy
    with wording.reading(path):
        run = read(content_of(path), path.name)
    if arguments.mesh:
        surface = _surface(run, arguments.mesh, arguments.scale)
        run = dataclasses.replace(run, surface=surface)
    with wording.writing("out", arguments.out, folder=True):
        print(files.write(arguments.out, run))
    if not arguments.mesh and (run.record["triangle"] >= 0).any():
        wording.print_message("without --mesh there is no map of the energy on the walls")


def _npy(content: bytes, name: str) -> Run:
    return Run(typed(columns.saved(content)), name)


def _hdf5(content: bytes, name: str) -> Run:
    with hdf5.opened(content) as file:
        sphere, plate = (material.name for material in layout.materials(file))
        layout.hits(file)  # refuses the numbers of plates and beads that the file does not have
        rows = layout.impacts(file)
    plates = (plate,) * (int(rows["plate"].max(initial=-1)) + 1)
    return Run(rows, f"{sphere} on {plate}, {name}", plates)


def _surface(run: Run, paths: list[str], scale: float | None) -> Surface:
    """Read the meshes of the walls whose triangles the record names."""
    rows, point = run.record, run.points
    plates = np.unique(rows["plate"][rows["triangle"] >= 0])
    if plates.size != len(paths):
        raise wording.Refused(
            f"--mesh: got {len(paths)} for the {plates.size} walls of the record that are meshes"
        )
    corners: list[Floats] = []
    wall: list[NDArray[np.int64]] = []
    triangle = np.full(rows.size, -1)
    for plate, path in zip(plates.tolist(), paths, strict=True):
        with wording.reading(path):
            mesh = Mesh.read(path, math.inf, scale=1.0 if scale is None else scale)
        here = np.flatnonzero(rows["plate"] == plate)
        hit = rows["triangle"][here]
        found = np.searchsorted(mesh.kept, hit).clip(max=len(mesh.kept) - 1)
        if (lacks := mesh.kept[found] != hit).any():
            raise wording.Refused(
                f"--mesh: {path} has no triangle {hit[lacks][0]}, which the record has hits on: it "
                f"is not the mesh of wall {plate}"
            )
        triangle[here] = found + sum(len(one) for one in corners)
        corners.append(mesh.vertices[mesh.triangles])
        wall.append(np.full(len(mesh.triangles), plate))
    surface = Surface(np.concatenate(corners), np.concatenate(wall), triangle, point)
    extent, reach = (float(np.ptp(one.reshape(-1, 3), axis=0).max())
                     for one in (surface.corners, point[triangle >= 0]))  # fmt: skip
    if scale is None and extent > _TOO_LARGE * reach > 0.0:
        raise wording.Refused(
            f"--scale: the mesh is {extent:.3g} m wide, the contacts on it are within {reach:.3g} "
            "m: give --scale 1mm if it is in millimetres, or --scale 1m if it is not"
        )
    return surface if _still(surface, point, _APART * extent) else surface._replace(point=None)


def _still(surface: Surface, point: Floats, apart: float) -> bool:
    """Whether the contact points are on their triangles, as on walls that do not move."""
    hit = surface.triangle >= 0
    a, b, c = np.moveaxis(surface.corners[surface.triangle[hit]], 1, 0)
    normal = np.cross(b - a, c - a)
    height = ((point[hit] - a) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1)
    return bool((abs(height) <= apart).all())

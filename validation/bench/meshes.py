"""Meshes in LAMMPS: time of a step over triangles and over beads, beside LAMMPS's own wall.

A tenth of the beads rests on the wall, others fly above it. `figure` draws what `rows` measured.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import style
from contactlaw.engines.lammps import Mesh, Plate, Rotation, attach
from validation.bench import lammps as plane
from validation.bench.lammps import BEADS, LAYERS, RADIUS, THICKNESS
from validation.bench.row import Row, on_ranks

from lammps import lammps  # isort: skip

FIGURE = Path(__file__).with_name("meshes.png")
FEW = 2000  # beads above many plates
CELLS = (1, 10, 71, 224)  # along each side of the square wall: 2 to 1e5 triangles
CLOUDS = (1000, 10_000, 100_000)
PLATES = (8, 64, 512, 2048)
_DRUM, _LENGTH = 0.1, 0.4  # radius and length of the drum [m]


def rows() -> Iterator[Row]:
    """Measure on one rank, and the mesh on two with the same and with twice as many beads."""
    one = on_ranks(__name__, 1, BEADS)
    two, weak = (on_ranks(__name__, 2, beads, "flat")["flat"] for beads in (BEADS, 2 * BEADS))
    figure(one)
    flat, drum, plates = one["flat"], one["drum"], one["plates"]
    for cells in CELLS:
        triangles = 2 * cells * cells
        yield Row(
            f"LAMMPS mesh, {triangles:.0e} triangles",
            flat[str(cells)] / flat["plate"],
            "x",
            1.5 if triangles < 2e4 else None,
            note=f"{flat[str(cells)]:.0f} us a step of {BEADS:.0e} beads; one plate "
            f"{flat['plate']:.0f}, no wall {flat['none']:.0f}; {flat['touching']:.0f} touch",
        )
    for name in ("72 facets", "5000 facets", "72 facets that turn"):
        yield Row(
            f"LAMMPS drum, {name}",
            drum[name],
            "us",
            None,
            "wall/gran/region",
            drum["own"] / drum[name],
            note=f"no wall {drum['none']:.0f} us",
        )
    for count in PLATES:
        yield Row(f"{FEW} beads, {count} plates", plates[str(count)], "us", note=f"no wall {plates['none']:.0f} us")
    near, none = plates["all near edges"], plates["none"]
    yield Row("walls near edges, over endless ones", (near - none) / (plates["8"] - none), "x", 3.0)
    mesh = str(CELLS[2])
    for name, more in (("strong", two), ("weak", weak)):
        yield Row(
            f"{name} scaling, mesh, 2 ranks over 1",
            more[mesh] / flat[mesh],
            "x",
            note=f"no wall {more['none'] / flat['none']:.3g}x",
        )


def figure(found: dict[str, Any]) -> None:
    """Draw the time of a step over triangles, and over beads."""
    flat, clouds = found["flat"], found["clouds"]
    with style.applied():
        drawing = style.figure(
            10.0,
            5.0,
            "A step hardly depends on the number of triangles",
            "LAMMPS, beads above a square wall, a tenth of them on it; one rank; beads do not meet",
        )
        left, right = drawing.subplots(1, 2)
        left.semilogx(
            [2 * n * n for n in CELLS], [flat[str(n)] / 1e3 for n in CELLS], "o-", color=style.BLUE, label="mesh"
        )
        left.axhline(flat["plate"] / 1e3, color=style.VERMILION, ls="--", label="one plate")
        left.axhline(flat["none"] / 1e3, color=style.MUTED, ls=":", label="no wall")
        left.set(xlabel="triangles", ylabel="time per step [ms]", ylim=(0, None))
        left.set_title("10\u2075 beads")
        for name, label, mark, colour in (
            ("mesh", "mesh of 10\u2074 triangles", "o-", style.BLUE),
            ("plate", "one plate", "s--", style.VERMILION),
            ("none", "no wall", "^:", style.MUTED),
        ):
            right.loglog(CLOUDS, [clouds[str(n)][name] / 1e3 for n in CLOUDS], mark, color=colour, label=label)
        right.set(xlabel="beads", ylabel="time per step [ms]")
        right.set_title("1 000 to 100 000 beads")
        for axes in (left, right):
            axes.legend()
        FIGURE.write_bytes(style.png(drawing))


def barrel(beads: int) -> lammps:
    """Put a tenth of the beads on the wall of a drum about the y axis, the others inside."""
    rng = np.random.default_rng(1)
    angle, along = rng.uniform(0, 2 * math.pi, beads), rng.uniform(0.01, 0.99, beads) * _LENGTH
    out = np.sqrt(rng.uniform(0, 1, beads)) * (_DRUM - 4 * RADIUS)
    out[: beads // LAYERS] = _DRUM - RADIUS + plane.OVERLAP  # of the exact cylinder
    places = 0.5 * _LENGTH + out * np.cos(angle), along, 1.1 * _DRUM + out * np.sin(angle)
    return plane.box(_LENGTH, 0.0, 2.2 * _DRUM, np.column_stack(places))


def square(cells: int, width: float) -> Mesh:
    """Plate of cells x cells squares, two triangles each."""
    line = np.linspace(0, width, cells + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    i, j = (k.ravel() for k in np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij"))
    a, b = i * (cells + 1) + j, (i + 1) * (cells + 1) + j
    triangles = np.concatenate((np.stack((a, b, b + 1), 1), np.stack((a, b + 1, a + 1), 1)))
    return Mesh(np.column_stack((x.ravel(), y.ravel(), 0.0 * x.ravel())), triangles, THICKNESS)


def over(beads: int, walls: dict[str, list[Any]]) -> dict[str, float]:
    """Time a cloud over each list of walls, and over none [us]; count what touches a plate."""
    simulations = {name: plane.cloud(beads) for name in ("none", *walls)}
    for name, listed in walls.items():
        attach(simulations[name], plane.paper(), listed)
    found: dict[str, float] = {}
    if "plate" in simulations:
        simulations["plate"].command("run 1 post no")
        found["touching"] = plane.touching(simulations["plate"])
    return found | closed(simulations)


def closed(simulations: dict[str, lammps]) -> dict[str, float]:
    """Time simulations [us], and close them."""
    found = plane.times(simulations, 50)
    for lmp in simulations.values():
        lmp.close()
    return found


def drums(beads: int) -> dict[str, float]:
    """Time beads in a drum of facets, and in LAMMPS's own cylinder [us]."""
    x, z = 0.5 * _LENGTH, 1.1 * _DRUM
    ends = (x, 0.0, z), (x, _LENGTH, z)
    simulations = {"none": barrel(beads), "own": barrel(beads)}
    simulations["own"].commands_string(
        f"region drum cylinder y {x} {z} {_DRUM} 0 {_LENGTH} units box\n"
        f"fix wall all wall/gran/region {plane.own_wall()} region drum"
    )
    turning = Rotation((0, 1, 0), 1.0, ends[0])
    for facets, motion in ((72, None), (5000, None), (72, turning)):
        name = f"{facets} facets{' that turn' if motion else ''}"
        # circumscribed, so that beads on the exact wall are on or just off the facets
        out = _DRUM / math.cos(math.pi / facets)
        drum = Mesh.cylinder(*ends, out, THICKNESS, facets=facets, motion=motion)
        simulations[name] = barrel(beads)
        attach(simulations[name], plane.paper(), [drum])
    return closed(simulations)


def tiles(count: int, **edges: Any) -> list[Plate]:
    """Plates that lie beside each other below some beads."""
    along = 2 ** math.ceil(math.log2(math.sqrt(count)))
    a, b = plane.width(FEW) / along, plane.width(FEW) / (count // along)
    return [
        Plate((i * a, j * b, 0), (a, 0, 0), (0, b, 0), THICKNESS, **edges)
        for i in range(along)
        for j in range(count // along)
    ]


def main(beads: int, flat_only: bool) -> dict[str, Any]:
    """Time the simulations on this rank."""
    side = plane.width(beads)
    walls: dict[str, list[Any]] = {str(cells): [square(cells, side)] for cells in CELLS}
    found: dict[str, Any] = {"flat": over(beads, {"plate": [plane.floor(side)], **walls})}
    if flat_only:
        return found
    found["clouds"] = {}
    for count in CLOUDS:
        side = plane.width(count)
        both: dict[str, list[Any]] = {"plate": [plane.floor(side)], "mesh": [square(71, side)]}
        found["clouds"][count] = over(count, both)
    found["drum"] = drums(beads)
    many = {str(count): tiles(count) for count in PLATES}
    found["plates"] = over(FEW, {**many, "all near edges": tiles(PLATES[0], edges="free")})
    return found


if __name__ == "__main__":
    plane.printed(main(int(sys.argv[1]), len(sys.argv) > 2))

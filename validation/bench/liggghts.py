"""The exported wall against LIGGGHTS's own wall: 1e5 falling beads, on 1 and 2 ranks.

Contacts between beads are left out: they cost the same with any wall, and would hide its cost.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import contactlaw as cl
from validation.bench.row import Row

BEADS = 100_000
RADIUS, SPEED, THICKNESS = 0.9e-3, 5.0, 1e-3
PITCH, HEIGHT = 2.5e-3, 1.1e-3  # spacing and initial height of the beads [m]; 8 % touch at any time
STEPS, PARTS, ROUNDS = 100, 4, 4  # the simulations take turns, so that all see the same noise
WALL = "fix wall all wall/gran model {} primitive type 2 zplane 0"
WALLS = {
    "none": "",
    "hertz": WALL.format("hertz tangential history"),
    "history": WALL.format("contactlaw tangential history"),
    "springs": WALL.format("contactlaw tangential contactlaw"),
}
SCRIPT = """
units si
atom_style granular
boundary f f f
newton off
communicate single vel yes
hard_particles yes
processors * * 1
region box block 0 {width} 0 {width} -0.02 0.06 units box
create_box 2 box
lattice sc {pitch} origin 0.5 0.5 {height}
region fill block 0 {width} 0 {width} 0 {pitch} units box
create_atoms 1 region fill
set group all diameter {diameter} density 879
displace_atoms all random 0.0003 0.0003 0.00015 15485863 units box
velocity all set 0 0 -{speed} units box
neighbor 0.001 bin
fix modulus all property/global youngsModulus peratomtype 12.23e9 73e9
fix ratio all property/global poissonsRatio peratomtype 0.21 0.21
fix restitution all property/global coefficientRestitution peratomtypepair 2 0.9 0.9 0.9 0.9
fix friction all property/global coefficientFriction peratomtypepair 2 0.2 0.2 0.2 0.2
fix thickness all property/global plateThickness peratomtype 1 {thickness}
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-7
{wall}
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
thermo 1000
run 300
"""


def rows() -> Iterator[Row]:
    """Measure on one rank and on two; yield nothing where LIGGGHTS is not installed."""
    if not shutil.which("liggghts"):
        print("liggghts: not installed, see `make test-engines`", file=sys.stderr)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "wall"
        cl.export.liggghts(folder, cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"))
        subprocess.run(["sh", folder / "build.sh"], check=True, capture_output=True)
        for ranks in (1, 2):
            times: dict[str, list[float]] = {wall: [] for wall in WALLS}
            for _ in range(ROUNDS):
                for wall, found in times.items():
                    found.append(_measure(folder, wall, ranks))
            built_in, none = min(times["hertz"]), min(times["none"])
            for friction, least in (("history", 0.75), ("springs", 0.6)):
                own = min(times[friction])
                yield Row(
                    f"LIGGGHTS step, {friction}, {BEADS:.0e} beads, {ranks} ranks",
                    own,
                    "us",
                    peer="wall/gran hertz",
                    least_ratio=least,
                    ratio=built_in / own,
                    note=f"{built_in:.0f} us; without a wall {none:.0f} us",
                )


def _measure(folder: Path, wall: str, ranks: int) -> float:
    """Least microseconds per step of one simulation, by LIGGGHTS's own clock."""
    width = math.ceil(math.sqrt(BEADS)) * PITCH
    script = SCRIPT.format(
        width=width,
        pitch=PITCH,
        height=HEIGHT / PITCH,
        speed=SPEED,
        diameter=2.0 * RADIUS,
        thickness=THICKNESS,
        wall=WALLS[wall],
    )
    (folder / "in.bench").write_text(script + f"run {STEPS} pre no\n" * PARTS)
    load = f"LD_PRELOAD={folder / 'wall_contactlaw.so'}"
    command = ["mpirun.openmpi", "--oversubscribe", "-np", str(ranks), "-x", load, "liggghts"]
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(
        [*command, "-in", "in.bench", "-log", "none"],
        cwd=folder,
        env=os.environ | root,
        capture_output=True,
        text=True,
        check=True,
    )
    seconds = [float(time) for time in re.findall(r"Loop time of ([0-9.e+-]+)", done.stdout)]
    return min(seconds[-PARTS:]) / STEPS * 1e6

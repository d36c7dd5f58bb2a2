"""The demo's sieve and drum with true and with softened contacts: ``python -m validation.softened``.

Writes ``data/softened.csv``, with a row for each wall of each run: the energies that all its contacts
took from the beads, the work of its motion, and the CPU time of the run. Both kinds of contacts take
turns, so that whatever else the machine does slows both.
"""

from __future__ import annotations

import csv
import itertools
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import contactlaw as cl
from contactlaw.engines.record import Kind
from dem_demo.drum.scene import drum
from dem_demo.kit import lammps
from dem_demo.kit.scene import Bed
from dem_demo.sieve.scene import sieve

FILE = Path(__file__).parent / "data/softened.csv"
CAUSES = "wave", "plastic", "other", "friction", "scheme"
_SCENES = {"sieve": sieve, "drum": drum}  # each as large as the command makes it
_SOFTENINGS = 1.0, 100.0, 300.0, 1000.0
_SEEDS = 1, 2, 3


def measure(scene: Bed) -> Iterator[dict[str, Any]]:
    """Simulate a scene under its law; a row for each wall, energies in J."""
    pair = cl.Pair(scene.sphere_material, scene.plate_material)
    model = cl.ImpactModel(pair, outside="clamp")
    step = lammps.time_step(scene, model)
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "softening: an impact")  # how deep is measured here
        scene.write_files(Path(folder))
        began = time.process_time()
        simulation = lammps.Simulation(scene, model, scene.thickness, step, Path(folder))
        for _ in range(scene.frames):
            simulation.advance()
        cpu = time.process_time() - began
        record = simulation.record()
        simulation.lmp.close()
    assert record is not None
    for wall in range(int(record.rows["plate"].max()) + 1):
        rows = record.rows[record.rows["plate"] == wall]
        yield {
            "scene": scene.NAME,
            "beads": scene.radius.size,
            "softening": scene.softening,
            "seed": scene.seed,
            "wall": wall,
            "contacts": rows.size,
            "struck": int((rows["kind"] == Kind.STRUCK).sum()),
            **{cause: f"{rows[f'{cause}_energy'].sum():.6g}" for cause in CAUSES},
            "wall_work": f"{rows['wall_work'].sum():.6g}",
            "step": f"{step:.4g}",
            "cpu": f"{cpu:.4g}",
        }


def main() -> None:
    """Measure all runs, and write each as soon as it has ended."""
    with FILE.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        for make, seed, softening in itertools.product(_SCENES.values(), _SEEDS, _SOFTENINGS):
            for row in measure(make(seed=seed, softening=softening)):
                if not file.tell():
                    table.writerow(row)
                table.writerow(row.values())
            file.flush()


if __name__ == "__main__":
    main()

"""The demo's sieve with true and with softened contacts: ``python -m validation.softened``.

Writes ``data/softened.csv``, with a row for each wall of each run: the energies [J] that all its
contacts took from the beads, the work of its motion, and the CPU time of the run [s]. True and
softened contacts take turns, so that whatever else the machine does slows both. Runs that the file
has are kept; all take 10 minutes of one core.
"""

from __future__ import annotations

import csv
import itertools
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import contactlaw as cl
from contactlaw.engines.record import Kind
from dem_demo.sieve import engine
from dem_demo.sieve.deck import FORM, write_stl
from dem_demo.sieve.scene import Sieve, sieve

FILE = Path(__file__).parent / "data/softened.csv"
_RUN = "scene", "beads", "softening", "seed"
_CAUSES = "wave", "plastic", "other", "friction", "scheme"
_SOFTENINGS = 1.0, 100.0, 300.0, 1000.0
# As large as the commands make them, and small enough a sieve for three feeds.
_SCENES: tuple[Callable[..., Sieve], ...] = (
    *(partial(sieve, beads=1500, seed=seed, sphere="gamma-alumina") for seed in (1, 2, 3)),
    partial(sieve, seed=1, sphere="gamma-alumina"),
)


def measure(scene: Sieve) -> Iterator[dict[str, Any]]:
    """Simulate a scene under its law; a row for each wall, energies in J."""
    pair = cl.Pair(scene.sphere_material, scene.plate_material)
    model = cl.ImpactModel(pair, outside="clamp")
    step = engine.time_step(scene, model)
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "softening: an impact")  # how deep is measured here
        write_stl(Path(folder) / FORM, scene.deck.triangles())
        began = time.process_time()
        simulation = engine.Simulation(scene, model, scene.plates[0], step, Path(folder))
        for _ in range(scene.frames):
            simulation.advance()
        cpu = time.process_time() - began
        record = simulation.record()
        simulation.lmp.close()
    assert record is not None
    for wall in range(int(record.rows["plate"].max()) + 1):
        rows = record.rows[record.rows["plate"] == wall]
        yield {
            **dict(zip(_RUN, (scene.NAME, scene.radius.size, f"{scene.softening:g}", scene.seed), strict=True)),
            "wall": wall,
            "contacts": rows.size,
            "struck": int((rows["kind"] == Kind.STRUCK).sum()),
            **{cause: f"{rows[f'{cause}_energy'].sum():.6g}" for cause in _CAUSES},
            "wall_work": f"{rows['wall_work'].sum():.6g}",
            "step": f"{step:.4g}",
            "cpu": f"{cpu:.4g}",
        }


def rows() -> list[dict[str, str]]:
    """Rows of the file."""
    return list(csv.DictReader(FILE.read_text("utf-8").splitlines())) if FILE.exists() else []


def main() -> None:
    """Measure the runs that the file lacks, and add each as soon as it has ended."""
    there = {tuple(row[name] for name in _RUN) for row in rows()}
    for make, softening in itertools.product(_SCENES, _SOFTENINGS):
        scene = make(softening=softening)
        if (scene.NAME, f"{scene.radius.size}", f"{softening:g}", f"{scene.seed}") in there:
            continue
        found = list(measure(scene))
        with FILE.open("a", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, found[0], lineterminator="\n")
            if not file.tell():
                table.writeheader()
            table.writerows(found)


if __name__ == "__main__":
    main()

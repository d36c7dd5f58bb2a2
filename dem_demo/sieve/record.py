"""The records of a sieve: sieve.h5 under the law, constant.h5 with one COR; written and read."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Pair
from contactlaw.cli.parts.hdf5 import material_of
from dem_demo.reader import closed, impacts, versions
from dem_demo.recorder import Dataset, Recorder, made_by, write, write_materials
from dem_demo.scene import Floats
from dem_demo.sieve.deck import Deck
from dem_demo.sieve.scene import Sieve

RECORD, CONSTANT = "sieve.h5", "constant.h5"
FORMAT, SCHEMA = "contactlaw-sieve", 1

_AXES = (
    "one row per impact on the deck; bead is a row of /beads, triangle one of /deck/triangles; z "
    "points up"
)
_NUMBERS = (  # of a scene, kept as attributes
    "thickness", "frequency", "amplitude", "friction", "duration", "seed",
)  # fmt: skip
_DECK = "columns", "rows", "opening"


def sieve_recorder(
    path: Path,
    scene: Sieve,
    model: ImpactModel,
    triangles: Floats,
    *,
    engine: tuple[str, str],
    command: str,
    files: Set[str],
    ranks: int,
    time_step: float,
    constant_cor: float | None = None,
) -> Recorder:
    """Begin the record of a sieve.

    Parameters
    ----------
    path : Path
        File to create.
    scene : Sieve
        What is recorded.
    model : ImpactModel
        What rules the impacts; with a constant COR what to compare them with.
    triangles : ndarray, shape (n, 3, 3)
        Of the deck, in the order of its file [m].
    engine : tuple of str
        Name and version of the engine.
    command : str
        Command line that made the file.
    files : set of str
        Names of the files that will be made of it.
    ranks : int
        Processes that share the work.
    time_step : float
        The engine's step [s].
    constant_cor : float, optional
        The COR of every impact, where there is one.
    """
    attributes: dict[str, object] = {
        "format": FORMAT,
        "schema": SCHEMA,
        **made_by(engine, command, model),
        **{name: getattr(scene, name) for name in _NUMBERS},
        "ranks": ranks,
        "time_step": time_step,
    }
    if constant_cor is not None:
        attributes["constant_cor"] = constant_cor
    n = scene.radius.size
    energy = "kinetic", "rotational", "potential"
    return Recorder(
        path,
        attributes=attributes,
        write_scene=lambda file: _write_scene(file, scene, triangles),
        trajectories=[
            Dataset("position", "f4", (n, 3), "m", "centre; of a bead that is gone: where it was"),
            Dataset("velocity", "f4", (n, 3), "m/s", "velocity; of a bead that is gone: 0"),
            Dataset("status", "u1", (n,), "1", "1 in the box, 2 gone"),
            *(Dataset(name, "f8", (), "J", f"{name} energy of all beads") for name in energy),
            Dataset("elapsed", "f8", (), "s", "computing time so far"),
        ],
        frame_rate=scene.frame_rate,
        axes=_AXES,
        files=files,
    )


def _write_scene(file: h5py.File, scene: Sieve, triangles: Floats) -> None:
    write_materials(file, scene.sphere_material, scene.plate_material)
    beads, deck = file.create_group("beads"), file.create_group("deck")
    write(beads, "radius", scene.radius, "m", "radius")
    write(beads, "mass", scene.mass, "kg", "mass of the sphere")
    write(beads, "position", scene.position, "m", "centre (x, y, z) at the start")
    write(beads, "velocity", scene.velocity, "m/s", "velocity (x, y, z) of all at the start")
    write(deck, "triangles", triangles, "m", "corners (x, y, z) of each triangle at rest")
    deck.attrs.update({name: getattr(scene.deck, name) for name in _DECK})


@dataclass(frozen=True, eq=False)
class Run:
    """One recorded sieve.

    Attributes
    ----------
    scene : Sieve
        What fell on what.
    triangles : ndarray, shape (n, 3, 3)
        Of the deck at rest [m].
    law : str
        Contact law; with a constant COR the one that it is to be compared with.
    constant_cor : float or None
        The COR of every impact, where there is one.
    ranks : int
        Processes that shared the work.
    engine, command, created : str
        What made it, the command line, and when.
    versions : dict of str
        Of the programs that made it, by name.
    reason : str
        Why it is partial; empty if it is complete.
    collisions : structured ndarray
        One row per impact on the deck, as in `contactlaw.engines.record`.
    time : ndarray, shape (T,)
        Of the frames [s].
    position, velocity, status : ndarray
        Frames (T, N, 3) [m], (T, N, 3) [m/s], (T, N).
    kinetic, rotational, potential, elapsed : ndarray, shape (T,)
        Energies of all beads [J], and computing time [s].
    """

    scene: Sieve
    triangles: Floats
    law: str
    constant_cor: float | None
    ranks: int
    engine: str
    command: str
    created: str
    versions: dict[str, str]
    reason: str
    collisions: NDArray[np.void]
    time: Floats
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    status: NDArray[np.uint8]
    kinetic: Floats
    rotational: Floats
    potential: Floats
    elapsed: Floats

    @property
    def pair(self) -> Pair:
        """Materials."""
        return Pair(self.scene.sphere_material, self.scene.plate_material)

    @property
    def dissipated(self) -> Floats:
        """Energy that each impact has lost at the deck, but for friction [J]."""
        rows = self.collisions
        lost: Floats = rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"]
        return lost

    @property
    def name(self) -> str:
        """What ruled its impacts, in a few words."""
        return f"law {self.law}" if self.constant_cor is None else f"COR {self.constant_cor:.3g}"


@dataclass(frozen=True, eq=False)
class Runs:
    """The same sieve twice: under the law, and with a constant COR if it got so far."""

    law: Run
    constant: Run | None

    @property
    def every(self) -> list[Run]:
        """Those there are."""
        return [self.law] if self.constant is None else [self.law, self.constant]

    @property
    def reason(self) -> str:
        """Why they are partial; empty if they are complete."""
        return next((run.reason for run in self.every if run.reason), "")


def read(folder: Path) -> Runs:
    """Read the records in a folder."""
    constant = folder / CONSTANT
    return Runs(_read(folder / RECORD), _read(constant) if constant.exists() else None)


def _read(path: Path) -> Run:
    with h5py.File(path, "r") as file:
        attributes = closed(file, path, FORMAT, SCHEMA)
        beads, deck = file["beads"], file["deck"]
        scene = Sieve(
            radius=beads["radius"][()],
            position=beads["position"][()],
            velocity=beads["velocity"][()],
            deck=Deck(**{name: deck.attrs[name].item() for name in _DECK}),
            sphere_material=material_of(file["materials/sphere"]),
            plate_material=material_of(file["materials/plate"]),
            **{name: attributes[name].item() for name in _NUMBERS},
        )
        return Run(
            scene=scene,
            triangles=deck["triangles"][()],
            constant_cor=attributes.get("constant_cor"),
            ranks=int(attributes["ranks"]),
            **{
                name: attributes[name] for name in ("law", "engine", "command", "created", "reason")
            },
            versions=versions(attributes),
            collisions=impacts(file["collisions"]),
            **{name: dataset[()] for name, dataset in file["trajectories"].items()},
        )

"""Running a scene and recording it, as an HDF5 file that explains itself.

The layout of the file is that of `contactlaw.Record`, with groups for the beads and their frames.
The file is written when the run has ended, in whichever way: HDF5 can neither be interrupted
halfway nor close a file that the disk has no room for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from contactlaw import ImpactModel, Pair, Record, _atomic
from contactlaw.record.file import bodies_of, write
from dem_demo.kit import signals
from dem_demo.kit.scene import GRAVITY, Floats, Scene
from dem_demo.kit.signals import Interrupted

S = TypeVar("S", bound=Scene)


class Frame(NamedTuple):
    """One instant of all N beads, in d dimensions; of a bead that is gone, the last one before."""

    position: Floats  # of the centres, shape (N, d) [m]
    velocity: Floats  # shape (N, d) [m/s]
    spin: Floats  # shape (N, 3) [rad/s]; in two dimensions (N, 1), counterclockwise
    status: NDArray[np.uint8]  # shape (N,)
    elapsed: float  # computing time so far [s]


# Type, unit and description of the dataset for each field of a frame.
_DATASETS = {
    "position": ("f4", "m", "centre; of a bead that is gone: where it was last"),
    "velocity": ("f4", "m/s", "velocity; of a bead that is gone: its last one"),
    "spin": ("f4", "rad/s", "angular velocity; in two dimensions counterclockwise seen from the front"),
    "status": ("u1", "1", "0 waiting for its emission, 1 flying, 2 gone"),
    "elapsed": ("f8", "s", "computing time so far"),
}


class Simulation(Protocol):
    """A scene in an engine; under MPI every rank has one, and all call its functions."""

    def advance(self) -> None:
        """Simulate one frame."""

    def look(self) -> Frame | None:
        """Return the current frame; None on all ranks but 0."""

    def record(self) -> Record | None:
        """Return the contacts so far; None on all ranks but 0."""


class Making(NamedTuple):
    """How a run is made."""

    law: ImpactModel  # of the impacts; with a constant COR, the model to compare them with
    command: str
    time_step: float  # of the engine [s]
    constant_cor: float | None = None  # of every impact; None if the model gives it


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Generic[S]):
    """One run of a scene; its T frames have the fields of `Frame`, stacked."""

    scene: S
    making: Making
    record: Record  # all contacts by time
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    spin: NDArray[np.float32]
    status: NDArray[np.uint8]
    elapsed: Floats

    @property
    def time(self) -> Floats:
        """Times of the frames, shape (T,) [s]."""
        return np.arange(len(self.elapsed)) / self.scene.FRAME_RATE

    @property
    def contacts(self) -> NDArray[np.void]:
        """Contacts with walls, one row for each, also those that are no impacts."""
        rows: NDArray[np.void] = self.record.rows[self.record.rows["plate"] >= 0]
        return rows

    @cached_property
    def impacts(self) -> NDArray[np.void]:
        """Impacts on walls; COR and speed of other contacts mean nothing."""
        rows: NDArray[np.void] = self.record.impacts[self.record.impacts["plate"] >= 0]
        return rows

    @property
    def dissipated(self) -> Floats:
        """Energy that each contact lost at its wall, without sliding friction [J]."""
        rows = self.contacts
        lost: Floats = rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"] + rows["scheme_energy"]
        return lost

    @property
    def mean_cor(self) -> float:
        """Mean COR of the impacts on walls, which is not known beforehand; NaN without any."""
        return float(self.impacts["restitution"].mean()) if self.impacts.size else math.nan

    @property
    def law(self) -> str:
        """Name of the contact law; with a constant COR, of the law to compare it with."""
        return bodies_of(self.making.law).law

    @cached_property
    def model(self) -> ImpactModel:
        """The law, whose curves may lie outside the table where no recorded impact does."""
        law = self.making.law
        return ImpactModel(law.pair, self.law, outside="clamp") if law.outside == "raise" else law

    @property
    def name(self) -> str:
        """Short name of the run: its law, or its constant COR."""
        constant = self.making.constant_cor
        return f"law {self.law}" if constant is None else f"COR {constant:.3g}"

    @cached_property
    def account(self) -> Account:
        """Energy balance until each frame."""
        rows = self.contacts
        end = rows["time"] + rows["contact_time"]
        order = np.argsort(end, kind="stable")
        until = np.searchsorted(end[order], self.time, side="right")
        losses = "wave_energy", "plastic_energy", "other_energy", "scheme_energy", "friction_energy"
        walls, wave, plastic, other, scheme, friction = (
            np.r_[0.0, np.cumsum(rows[name][order])][until] for name in ("wall_work", *losses)
        )
        other = other + scheme
        mass, radius = self.scene.mass, self.scene.radius
        speed, spin = ((one.astype(float) ** 2).sum(axis=2) for one in (self.velocity, self.spin))
        moving = speed @ (0.5 * mass) + spin @ (0.2 * mass * radius**2)  # of solid spheres
        potential = self.position[..., -1].astype(float) @ (GRAVITY * mass)
        start, gravity = np.full_like(moving, moving[0]), potential[0] - potential
        rest = start + gravity + walls - moving - wave - plastic - other - friction
        return Account(start, gravity, walls, moving, wave, plastic, other, friction, rest)

    def save(self, path: Path) -> None:
        """Write the record; without room for all, an `OSError` after the contacts alone are tried."""
        scene, making = self.scene, self.making
        on_wall, sphere = bodies_of(making.law), scene.sphere_material
        values = {one.name: getattr(scene, one.name) for one in fields(scene)}
        made = {
            **self.record.made,
            **{name: value for name, value in values.items() if isinstance(value, (int, float))},
            "scene": scene.NAME,
            "command": making.command,
            "law": on_wall.law,
            "outside": making.law.outside,
            "time_step": making.time_step,
        }
        if making.constant_cor is not None:
            made["constant_cor"] = making.constant_cor
        bodies = [on_wall, on_wall._replace(pair=Pair(sphere, sphere))]
        on_bead = (self.record.rows["plate"] < 0).astype(np.int64)
        whole = replace(self.record, bodies=bodies, which=on_bead, made=made)
        try:
            _atomic.write(path, whole.content(self._write_frames))
        except OSError:
            _atomic.write(path, whole.content())
            raise

    def _write_frames(self, file: h5py.File) -> None:
        write(file.create_group("beads"), "radius", self.scene.radius, "m", "radius")
        group = file.create_group("trajectories")
        write(group, "time", self.time, "s", "time of the frame")
        for name, (_, unit, description) in _DATASETS.items():
            write(group, name, getattr(self, name), unit, description)


Runs = Sequence[Run[S]]  # under the law; then, if there is a second one, with a constant COR


class Account(NamedTuple):
    """Energy balance of all beads at each frame [J]: input since the start, and where it went."""

    start: Floats  # kinetic energy at the start, also of beads that wait for their emission
    gravity: Floats
    walls: Floats  # work of the moving walls
    moving: Floats  # translational and rotational kinetic energy at the frame
    wave: Floats
    plastic: Floats
    vibration: Floats  # lost to friction within the contact and to vibration of the bodies
    friction: Floats  # lost to friction on the walls
    others: Floats  # the rest: bead on bead, and energy stored in open contacts


def simulate(
    begin: Callable[[], Simulation], scene: S, making: Making, path: Path | None
) -> tuple[Run[S] | None, BaseException | None]:
    """Simulate and record a run; return it, and what stopped it or kept frames out, if anything did.

    The record is written in whichever way the run ends, on rank 0; `path` is None on the others.
    """
    simulation: Simulation | None = None
    frames: list[list[NDArray[Any]]] = []
    run, stop = None, None
    try:
        simulation = begin()
        # None: no progress bar unless stderr is a terminal
        hidden = None if path is not None else True
        name = f"COR {making.constant_cor:g}" if making.constant_cor is not None else scene.NAME
        for n in tqdm(range(scene.frames + 1), desc=name, unit="frame", disable=hidden):
            if n > 0:
                simulation.advance()
            if (frame := simulation.look()) is not None:
                kinds = (kind for kind, *_ in _DATASETS.values())
                frames.append([np.array(one, kind) for one, kind in zip(frame, kinds, strict=True)])
    except (Exception, Interrupted) as error:
        came = signals.first()  # the error may be what an interrupt has left that Python dropped
        stop = Interrupted(came) if came else error
    with signals.held():
        try:
            record = None if simulation is None else simulation.record()
            if path is not None and record is not None:
                by_time = record.part(np.argsort(record.rows["time"], kind="stable"))
                stacked = zip(*frames, strict=True) if frames else np.empty((len(Frame._fields), 0))
                columns: dict[str, Any] = dict(zip(Frame._fields, map(np.array, stacked), strict=True))
                run = Run(scene=scene, making=making, record=by_time, **columns)
                run.save(path)
        except Exception as error:
            stop = stop or error
    return run, stop

"""Slow indentation of a hemisphere into a block, loading and unloading, by finite elements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.physical.arguments import checked
from validation.fem import mesh, solver
from validation.fem.solver import System

Array = NDArray[np.float64]

BLOCK = 20.0  # width and thickness of the block, over the sphere's radius
_WIDEST = 0.3  # finest part of the mesh, over the radius, however deep
_SAMPLES = 400
_TRANSITS = 200.0  # duration of an indentation, in transits of the pressure wave through R


@dataclass(frozen=True)
class Indentation:
    """Force against compression.

    Attributes
    ----------
    compression, force : ndarray
        Displacement of the hemisphere's equator [m] and force [N], loading then unloading.
    contact_radius : ndarray
        Largest radius at which the surfaces press on each other [m].
    kinetic : float
        Largest kinetic energy over the largest work done: small if quasi-static [-].
    plastic : float
        Plastic work over the work of loading [-].
    system : System
        All nodes and elements at the end.
    """

    compression: Array
    force: Array
    contact_radius: Array
    kinetic: float
    plastic: float
    system: System


def core(radius: float, depth: float) -> float:
    """Width of the finest part of the mesh [m]."""
    return min(mesh.CORE * math.sqrt(radius * depth), _WIDEST * radius)


def indent(
    pair: cl.Pair,
    radius: float,
    depth: float,
    *,
    size: float = 0.02,
    friction: float = 0.1,
    yields: bool = True,
    plate_yields: bool = False,
    slowness: float = 1.0,
) -> Indentation:
    """Press a hemisphere into a block and draw it back, smoothly and slowly.

    The equator moves by depth (1 - cos(2 pi t/T))/2; the foot of the block stands still.

    Parameters
    ----------
    pair : contactlaw.Pair
        Materials of hemisphere and block.
    radius, depth : float
        Radius of the hemisphere and largest compression, up to half of it [m].
    size : float, optional
        Smallest element, over the radius, 0.001 to 0.1.
    friction : float, optional
        Coefficient of friction, 0 to 1.
    yields, plate_yields : bool, optional
        Whether the hemisphere yields, and the block.
    slowness : float, optional
        Factor on the time T, 0.1 to 10, to show that it does not matter.

    Returns
    -------
    Indentation

    Raises
    ------
    ValueError
        If depth, size, friction or slowness is outside its range.
    RuntimeError
        If elements collapse.
    """
    checked(
        depth=(depth, 1e-6 * radius, 0.5 * radius, "metres, to half of the radius"),
        size=(size, 1e-3, 0.1, "sphere radii"),
        friction=(friction, 0.0, 1.0, ""),
        slowness=(slowness, 0.1, 10.0, ""),
    )
    width = core(radius, depth)
    fine, block = size * radius, BLOCK * radius
    meshes = (mesh.sphere(radius, fine, width, hemisphere=True), mesh.plate(radius, fine, width, block, block))
    materials = pair.sphere, pair.plate
    system = solver.assemble(meshes, materials, friction, yields, plate_yields)
    first = len(meshes[0].nodes)
    driven = np.flatnonzero(system.x[:first, 1] > radius * (1.0 - 1e-9))
    foot = first + np.flatnonzero(meshes[1].nodes[:, 1] < -block * (1.0 - 1e-9))
    system.inverse_mass[np.concatenate([driven, foot]), 1] = 0.0
    wave = min(
        math.sqrt((body.bulk + 2.0 * body.shear) / material.density)
        for body, material in zip((system.sphere, system.plate), materials, strict=True)
    )
    duration = slowness * _TRANSITS * radius / wave
    interval = duration / _SAMPLES
    load = np.zeros_like(system.x)
    before, rows, plastic = 0.0, [], []
    for n in range(1, _SAMPLES + 1):
        stable = solver.time_step(system, materials)  # elements get thinner
        if not (stable > 0.0 and np.isfinite(system.v).all()):
            raise RuntimeError(
                f"elements collapsed before depth {depth:g} m: take a smaller depth, or coarser elements than {size:g}"
            )
        every = math.ceil(interval / stable)
        target = 0.5 * depth * (1.0 - math.cos(2.0 * math.pi * n / _SAMPLES))
        system.v[driven, 1] = (before - target) / interval
        force, touched = solver.advance(system, load, interval / every, every)
        kinetic = 0.5 * system.mass @ (system.v**2).sum(axis=1)
        pressed = system.surfaces.slave[system.surfaces.impulse[:, 0] > 0.0]
        edge = system.x[pressed, 0].max(initial=0.0) if touched == every else 0.0
        rows.append((0.5 * (before + target), 2.0 * math.pi * force, edge, kinetic))
        plastic.append(system.sphere.work[0] + system.plate.work[0])
        before = target
    compression, force_, edge_, kinetic_ = np.array(rows).T
    top = int(compression.argmax())
    work = float(np.trapezoid(force_[: top + 1], compression[: top + 1])) / (2.0 * math.pi)
    return Indentation(compression, force_, edge_, float(kinetic_.max()) / work, plastic[-1] / work, system)

"""Structured meshes of 4-node quadrilaterals, finest at the contact: a sphere, a plate.

r is the distance from the axis, z points up; the bodies touch at the origin, the sphere above and
the plate below.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Our choices.
CORE = 1.3  # finest part, over the contact's expected radius sqrt(R d)
_FAR_CORE = 1.2  # width of the part around the far pole [R]
_GROWTH = 1.1  # size of one element of the plate over its neighbour
_OF_SHELL = 0.5  # factor on the elements of a hollow sphere: waves bend it
_COARSEST = 0.15  # largest element of the plate [R] ...
_LAYERS = 24  # ... or this part of its thickness: waves are at least 20 times longer


class Mesh(NamedTuple):
    """Nodes and elements of one body."""

    nodes: Array  # (n, 2), r and z [m]
    elements: Indices  # (m, 4), counter-clockwise in the (r, z) plane
    surface: Indices  # (s,), nodes that may touch the other body, from the axis outwards
    relative: Array | None = None  # (m, 2), density and moduli over the material's; None: all 1


class Core(NamedTuple):
    """Ball of another material about the centre of a sphere, bonded to the shell around it."""

    radius: float  # [R]
    density: float = 0.0  # over the shell's; 0: it is empty
    modulus: float = 0.0  # over the shell's

    @property
    def mass(self) -> float:
        """Mass of the sphere, over that of a solid one of the shell's material."""
        return 1.0 - (1.0 - self.density) * self.radius**3


SOLID = Core(0.0, 1.0, 1.0)


class Layer(NamedTuple):
    """One layer of a plate, from the top; the last one fills what is left of the thickness."""

    thickness: float  # [m]
    density: float = 1.0  # over that of the plate's material
    modulus: float = 1.0  # likewise


def sphere(radius: float, size: float, core: float, hemisphere: bool = False) -> Mesh:
    """Half a disc with elements of one size at the contact, growing away from it.

    A square at the contact, rings around it and a square at the far pole are laid into the
    quadrant p, q >= 0 of a plane u = p + iq, and taken to the half disc by x = u/(1 - iu/(2R)).
    The map is conformal: elements keep their right angles.

    Parameters
    ----------
    radius : float
        Radius R of the sphere [m].
    size, core : float
        Size of the elements at the contact, and how far from the axis they have it [m].
    hemisphere : bool, optional
        Stop at the equator, where z = R.

    Returns
    -------
    Mesh

    Examples
    --------
    >>> mesh = sphere(1.0, 0.05, 0.3)
    >>> r, z = mesh.nodes[mesh.surface].T
    >>> bool(np.allclose(r**2 + (z - 1) ** 2, 1))
    True
    """
    n = max(round(core / size), 4)
    side = np.linspace(0.0, 1.0, n + 1)
    square = side + 1j * side[:, None]
    rim = np.concatenate([square[:, n], square[n, -2::-1]])  # up the right side, back to the axis
    near, far = n * size * rim, 4.0 * radius**2 / (_FAR_CORE * radius * rim.conj())
    if hemisphere:
        far = 2.0 * radius * np.exp(0.5j * np.pi * np.linspace(0.0, 1.0, rim.size))
    # so many rings that their elements are as long as wide
    rings = round(np.log(abs(far[0] / near[0])) * 4 * n / np.pi)
    share = np.linspace(0.0, 1.0, rings + 1)[1:, None]
    grown = np.exp((1.0 - share) * np.log(near) + share * np.log(far))
    x = [_disc(n * size * square, radius).ravel(), _disc(grown, radius).ravel()]
    inner = np.arange(square.size).reshape(square.shape)
    ring = np.arange(grown.size).reshape(grown.shape) + inner.size
    columns = np.vstack([np.concatenate([inner[:, n], inner[n, -2::-1]]), ring])
    elements = [_cells(inner), _cells(columns.T)]
    if not hemisphere:
        pole = 2j * radius + _disc(_FAR_CORE * radius * square[:-1, :-1], radius).conj()
        x.append(pole.ravel())
        cap = np.empty_like(inner)
        cap[:-1, :-1] = np.arange(pole.size).reshape(pole.shape) + inner.size + ring.size
        cap[:, n], cap[n, -2::-1] = ring[-1, : n + 1], ring[-1, n + 1 :]
        elements.append(_cells(cap)[:, ::-1])  # mirrored
    nodes = np.concatenate(x)
    surface = np.concatenate([inner[0], ring[:, 0]])
    return Mesh(_points(nodes), np.concatenate(elements), surface)


def plate(
    radius: float,
    size: float,
    core: float,
    thickness: float,
    width: float,
    far: float = 1.0,
    layers: tuple[Layer, ...] = (),
) -> Mesh:
    """Rectangle of a plate's thickness, with elements of one size at the contact.

    Parameters
    ----------
    radius : float
        Radius of the sphere that hits it [m].
    size, core : float
        Size of the elements at the contact, and how far from the axis they have it [m].
    thickness, width : float
        Thickness of the plate and distance of its edge from the axis [m].
    far : float, optional
        Factor on the elements away from the contact: on the largest, and on how fast they grow.
    layers : tuple of Layer, optional
        What the plate is made of, from the top; by default of one material.

    Returns
    -------
    Mesh

    Examples
    --------
    >>> mesh = plate(1.0, 0.05, 0.3, 2.0, 10.0)
    >>> [float(v) for v in mesh.nodes.min(axis=0)], [float(v) for v in mesh.nodes.max(axis=0)]
    ([0.0, -2.0], [10.0, 0.0])
    """
    coarsest = far * max(_COARSEST * radius, thickness / _LAYERS)
    r = _graded(width, size, core, coarsest, _GROWTH**far)
    depth, step, counts = np.zeros(1), size, []
    for one in (*(layer.thickness for layer in layers[:-1]), math.inf):
        below = _graded(min(one, thickness - depth[-1]), step, 0.0, coarsest, _GROWTH**far)
        depth, step = np.append(depth, depth[-1] + below[1:]), below[-1] - below[-2]
        counts.append(below.size - 1)
    z = -depth[::-1]
    index = np.arange(r.size * z.size).reshape(z.size, r.size)
    made = Mesh(_points(r + 1j * z[:, None]), _cells(index), index[-1])
    if not layers:
        return made
    rows = np.repeat([layer[1:] for layer in layers], counts, axis=0)[::-1]
    return made._replace(relative=np.repeat(rows, r.size - 1, axis=0))


def bent(plate: Mesh, wall: float, end: float) -> Mesh:
    """Plate with a face that is part of a sphere of the radius `wall` [m], hollow if positive.

    From the distance `end` from the axis on, or 0.9 radii, it is level; the lower face stays flat.
    """
    if wall == math.inf:
        return plate
    r, z = plate.nodes.T
    height = abs(wall) - np.sqrt(wall * wall - np.minimum(r, min(end, 0.9 * abs(wall))) ** 2)
    risen = z + math.copysign(1.0, wall) * height * (1.0 - z / z.min())
    return plate._replace(nodes=np.column_stack((r, risen)))


def shell(plate: Mesh, wall: float) -> Mesh:
    """Plate bent as a whole to a shell; the radius of its face is positive for a cup [m].

    The map is conformal, as in `hollow`.
    """
    a = math.copysign(1.0, wall) * wall
    turned = a * np.exp((plate.nodes @ (1j, -math.copysign(1.0, wall))) / a)  # from the centre
    height = math.copysign(1.0, wall) * (a - turned.real)
    return plate._replace(nodes=_points(turned.imag + 1j * height))


def hollow(radius: float, size: float, core: float, inside: Core, far: float = 1.0) -> Mesh:
    """Half of a hollow sphere: the mesh of a plate as long as its meridian, bent.

    The map is conformal: it makes elements smaller towards the centre.

    Examples
    --------
    >>> mesh = hollow(1.0, 0.05, 0.3, Core(0.6))
    >>> distance = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1] - 1.0)
    >>> [round(float(v), 9) for v in (distance.min(), distance.max())]
    [0.6, 1.0]
    """
    depth = -radius * math.log(inside.radius)
    flat = plate(radius, size, core, depth, math.pi * radius, _OF_SHELL * far)
    turned = radius * np.exp((flat.nodes @ (1j, 1.0)) / radius)  # from the centre
    return Mesh(_points(1j * (radius - turned)), flat.elements[:, ::-1], flat.surface)


def layered(radius: float, size: float, core: float, inside: Core) -> Mesh:
    """Half of a sphere with a core: elements with their centre in the core belong to it."""
    whole = sphere(radius, size, core)
    centres = whole.nodes[whole.elements].mean(axis=1)
    within = np.hypot(centres[:, 0], centres[:, 1] - radius) < inside.radius * radius
    return whole._replace(relative=np.where(within[:, None], inside[1:], 1.0))


def _disc(u: NDArray[Any], radius: float) -> NDArray[np.complex128]:
    x: NDArray[np.complex128] = u / (1.0 - 0.5j * u / radius)
    return x


def _points(x: NDArray[np.complex128]) -> Array:
    points = np.column_stack([x.real.ravel(), x.imag.ravel()])
    points[abs(points[:, 0]) < 1e-12 * points[:, 0].max(), 0] = 0.0  # the axis, to the last bit
    return points


def _cells(index: Indices) -> Indices:
    """Elements between the rows and columns of a grid of nodes."""
    a, b = index[:-1, :-1], index[:-1, 1:]
    d, c = index[1:, :-1], index[1:, 1:]
    return np.stack([a, b, c, d], axis=-1).reshape(-1, 4)


def _graded(length: float, size: float, fine: float, coarsest: float, growth: float) -> Array:
    """Points from 0 to length: steps of one size up to `fine`, then growing to the coarsest."""
    steps = [size] * round(fine / size)
    while sum(steps) < length:
        steps.append(min(max(coarsest, size), growth * (steps[-1] if steps else size / growth)))
    points = np.concatenate([[0.0], np.cumsum(steps)])
    excess = points[-1] / length  # spread over the growing part
    start = round(fine / size) if length > fine else 0
    head, tail = points[: start + 1], points[start:]
    scale = (length - head[-1]) / (tail[-1] - tail[0]) if excess != 1.0 else 1.0
    return np.concatenate([head[:-1], head[-1] + scale * (tail - tail[0])])

"""Walls of triangles: from a file, from arrays, or a cylinder, a cone, a disc."""

from __future__ import annotations

import io
import math
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import check, number, warn_of_metres
from contactlaw.physical.plates import Foundation, Orthotropic, Shell, sheet_of
from contactlaw.walls.edges import Rims, boundary, edges_of, side_lengths, welded
from contactlaw.walls.motion import FARTHEST, Motion, check_motion, direction, floats, vector
from contactlaw.walls.plate import Models, check_models, checked_sheet
from contactlaw.walls.round import between, positive

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Vector = Sequence[float]

_LONGEST = 20.0  # [m] of a mesh that was likely drawn in metres; our choice
_FLAT = 1e-10  # least height of a triangle over its longest side; a flatter one has no sure normal


@dataclass(frozen=True, eq=False)
class Mesh:
    """A wall of triangles, which beads touch from either side.

    The wall may be open, and its triangles wound in either sense. Beads feel faces that meet at
    less than 20 degrees, as those of a tessellated cylinder, as one smooth surface.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        Corners of the triangles [m].
    triangles : array_like of int, shape (m, 3)
        For each triangle the numbers of its three corners, from 0. Vertices that differ by no more
        than the rounding of single precision become one, and of its numbers the mesh keeps one.
    thickness : float or array_like, shape (m,), or Foundation or Shell of such
        Plate thickness in the model, of all triangles or of each [m]; ``inf`` is the half-space.
        The geometry has no thickness. A `contactlaw.Shell` swings back as in `Plate`.
    model : ImpactModel or dict of int to ImpactModel, optional
        For a wall of another material than the attached model's; a dict has one by atom type.
    motion : Translation, Rotation, Vibration or Tabulated, optional
        How the wall moves; without it, the wall stands still.
    edges : {"free", "supported", "clamped"} or callable, optional
        How the wall ends at its rims and holes, the sides that one triangle alone has. A callable
        takes the middles of these sides, shape (n, 3) [m], and returns a kind, or None, for each.
        Without `edges`, the wall gives way as an endless plate.

    Attributes
    ----------
    dropped : int
        Number of triangles left out, with a warning: those without area, and duplicates. A flat one
        between others is no loss: its neighbour at the longest side is divided at its third corner.
    kept : ndarray of int
        For each triangle of the mesh, its number in the `triangles` that were given.
    rim : structured array
        Edges: start and vector to the end [m], number of the kind, of the triangle in the mesh.

    Raises
    ------
    TypeError, ValueError
        If the arrays do not fit together, a coordinate is not finite or beyond 1e6 m, no triangle
        has an area, a thickness is no positive number, the model or motion is of no such type,
        or an edge is of no such kind.

    Examples
    --------
    A square that is thin in one half and thick in the other:

    >>> corners = [[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]]
    >>> mesh = Mesh(corners, [[0, 1, 2], [0, 2, 3]], thickness=[0.5e-3, 2e-3])
    >>> mesh.area.sum().round(6).item()
    0.01
    """

    vertices: Any
    triangles: Any
    thickness: Any
    model: Models | None = None
    motion: Motion | None = None
    edges: Rims | None = None
    dropped: int = field(default=0, init=False)
    kept: Any = field(default=None, init=False)
    rim: Any = field(default=None, init=False)
    name: str = field(default="", init=False)  # of the file
    given: Any = field(default=None, init=False)  # for a thickness, where `thickness` has one for each triangle

    def __post_init__(self) -> None:
        """Check the arguments, and drop triangles without area and duplicates."""
        warn_of_metres("thickness", sheet_of(self.thickness), stacklevel=3)
        vertices = _vertices(self.vertices)
        triangles = _triangles(self.triangles, len(vertices))
        thickness = _thickness(checked_sheet(self.thickness), len(triangles))
        check_models(self.model)
        check_motion(self.motion)
        corners, good = _valid_triangles(vertices, triangles)
        lost = len(triangles) - len(good)
        if not good.size:
            raise ArgumentError("triangles", None, f"none of {len(triangles)} has an area [m2]")
        if lost:
            warnings.warn(
                f"Mesh: {lost} of {len(triangles)} triangles left out: without area, or duplicates", stacklevel=3
            )
        rim = () if self.edges is None else edges_of(self.edges, *boundary(vertices, corners))
        arrays = {"vertices": vertices, "triangles": corners, "thickness": thickness[good]}
        for name, value in {**arrays, "dropped": lost, "kept": good, "rim": rim, "given": self.thickness}.items():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)  # it has been checked
            object.__setattr__(self, name, value)

    @property
    def area(self) -> Floats:
        """Area of each triangle [m2]."""
        a, b, c = (self.vertices[self.triangles[:, n]] for n in range(3))
        area: Floats = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return area

    @classmethod
    def read(
        cls,
        path: str | Path,
        thickness: ArrayLike,
        *,
        scale: float | None = None,
        model: Models | None = None,
        motion: Motion | None = None,
        edges: Rims | None = None,
    ) -> Self:
        """Read a mesh from a file: STL (binary or text), PLY, OBJ or another that trimesh reads.

        Letters may have any encoding, and exponents may be those of Fortran (1.0D+01). A file that
        was cut is refused; of an OBJ, which counts no triangles, that is not always seen.

        Parameters
        ----------
        path : str or Path
            The file.
        thickness : float or array_like
            As in `Mesh`; an array has the triangles in the order of the file.
        scale : float, optional
            Length of the file's unit [m]: 1e-3 for a drawing in millimetres. Without it the unit
            is the metre, and a mesh longer than 20 m draws a warning.
        model, motion, edges
            As in `Mesh`.

        Raises
        ------
        ImportError, FileNotFoundError, TypeError, ValueError
            If trimesh or the file is missing, the file holds no mesh, or `Mesh` refuses it.

        Examples
        --------
        >>> import tempfile
        >>> ascii_stl = '''solid one
        ... facet normal 0 0 1
        ... outer loop
        ... vertex 0 0 0
        ... vertex 100 0 0
        ... vertex 0 100 0
        ... endloop
        ... endfacet
        ... endsolid one'''
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = Path(folder) / "part.stl"
        ...     _ = file.write_text(ascii_stl)
        ...     mesh = Mesh.read(file, thickness=1e-3, scale=1e-3)
        >>> f"{mesh.area[0]:.4f} m2"
        '0.0050 m2'
        """
        try:
            import trimesh
        except ImportError as error:
            raise ImportError("Mesh.read needs trimesh: pip install contactlaw[lammps]") from error
        size = 1.0 if scale is None else number("scale", scale)
        if not 0.0 < size < math.inf:
            raise ArgumentError("scale", scale, "must be positive, metres per unit of the file")
        if not Path(path).is_file():
            raise FileNotFoundError(f"path: no file {str(path)!r}")
        try:
            with warnings.catch_warnings():
                # trimesh would take the corners before a number that cannot be read for all
                warnings.filterwarnings("error", "string or file could not be read")
                source, kind, least = _source(path)
                found = trimesh.load_mesh(source, kind, process=False)
            vertices, triangles = np.asarray(found.vertices), np.asarray(found.faces)
            if len(triangles) < least:
                raise ValueError(f"{len(triangles)} triangles, where at least {least} should be")
            if not np.isfinite(vertices).all():
                raise ValueError("not all coordinates are finite")
        except Exception as error:  # trimesh's readers raise errors of many types
            what = "not all coordinates are numbers" if "unmatched data" in str(error) else error
            reason = f"no mesh that trimesh reads: {what}; write it again, best as a binary STL"
            raise ArgumentError("path", str(path), reason) from error
        extent = float(np.ptp(vertices, axis=0).max())
        if scale is None and extent > _LONGEST:
            said = f"scale: the mesh is {extent:g} m long; scale=1e-3 if it is drawn in mm?"
            warnings.warn(said, stacklevel=2)
        mesh = cls(size * vertices, triangles, thickness, model, motion, edges)
        object.__setattr__(mesh, "name", Path(path).name)
        return mesh

    @classmethod
    def cone(
        cls,
        start: Vector,
        end: Vector,
        start_radius: float,
        end_radius: float,
        thickness: Any,
        *,
        facets: int = 72,
        model: Models | None = None,
        motion: Motion | None = None,
        edges: Rims | None = None,
    ) -> Self:
        """Wall of a cone or a truncated cone, open at both ends, as of a hopper.

        Take a `contactlaw.walls.Cone` where beads roll or slide: facets take energy from them. Take
        this mesh for a wall whose triangles have thicknesses or records of their own.

        Parameters
        ----------
        start, end : sequence of 3 floats
            Ends of the axis [m].
        start_radius, end_radius : float
            Radii at the ends [m]; one may be 0. The corners of the facets are on the cone.
        thickness : float
            Plate thickness in the model [m].
        facets : int, optional
            Number of facets around the axis, at least 3. Fewer than 18 meet at more than 20
            degrees, and beads do not feel them as a smooth surface.
        model, motion, edges
            As in `Mesh`.

        Examples
        --------
        >>> hopper = Mesh.cone((0, 0, 0.1), (0, 0, 0), 0.1, 0.02, thickness=1e-3)
        >>> f"{hopper.area.sum():.4f} m2"
        '0.0482 m2'
        """
        profile, radii = between(start, end, start_radius, end_radius), (start_radius, end_radius)
        around = _circle(profile.axis, facets)
        n = len(around)
        rings = [place + r * around for place, r in zip((profile.origin, vector("end", end)), radii, strict=True)]
        here, there = np.arange(n), np.roll(np.arange(n), -1)
        lower = np.column_stack((here, there, here + n))
        upper = np.column_stack((there, there + n, here + n))
        parts = [part for part, r in zip((lower, upper), radii, strict=True) if r > 0.0]
        return cls(np.concatenate(rings), np.concatenate(parts), thickness, model, motion, edges)

    @classmethod
    def cylinder(
        cls,
        start: Vector,
        end: Vector,
        radius: float,
        thickness: Any,
        *,
        facets: int = 72,
        model: Models | None = None,
        motion: Motion | None = None,
        edges: Rims | None = None,
    ) -> Self:
        """Wall of a cylinder, open at both ends: a `cone` with the same radius [m] at both.

        Where beads roll or slide take a `contactlaw.walls.Cylinder`, which has no facets. The
        mesh swings back as that one does, but for an `Orthotropic` thickness; R* is flat.

        Examples
        --------
        >>> drum = Mesh.cylinder((0, -0.05, 0), (0, 0.05, 0), radius=0.1, thickness=2e-3)
        >>> len(drum.triangles)
        144
        """
        if not isinstance(thickness, Foundation | Shell | Orthotropic):
            thickness = Shell(thickness, radius)
        return cls.cone(start, end, radius, radius, thickness, facets=facets, model=model, motion=motion, edges=edges)

    @classmethod
    def disc(
        cls,
        centre: Vector,
        normal: Vector,
        radius: float,
        thickness: float,
        *,
        facets: int = 72,
        model: Models | None = None,
        motion: Motion | None = None,
        edges: Rims | None = None,
    ) -> Self:
        """Flat disc: the end of a drum, a spinning plate.

        A `contactlaw.walls.Disc` is round at its rim, too, and has one edge.

        Parameters
        ----------
        centre, normal : sequence of 3 floats
            Centre of the disc [m], and a vector normal to it of any length but zero.
        radius, thickness : float
            Radius of the disc, and plate thickness in the model [m].
        facets, model, motion, edges
            As in `cone`.

        Examples
        --------
        >>> plate = Mesh.disc((0, 0, 0), (0, 0, 1), radius=0.05, thickness=1e-3)
        >>> len(plate.triangles)
        72
        """
        middle, across = vector("centre", centre), direction("normal", normal)
        around = positive("radius", radius) * _circle(across, facets)
        n = len(around)
        here = np.arange(n)
        fan = np.column_stack((here, np.roll(here, -1), np.full(n, n)))
        return cls(np.vstack((middle + around, middle)), fan, thickness, model, motion, edges)


def _source(path: str | Path) -> tuple[Any, str | None, int]:
    """Prepare a file for trimesh: its path or content, its kind, and how many triangles it has at least.

    trimesh takes a cut file for a small one, and reads neither 1.0D+01 nor any letters but UTF-8.
    """
    content, kind = Path(path).read_bytes(), Path(path).suffix.lower()[1:]
    if kind not in ("stl", "ply", "obj", "off"):
        return str(path), None, 1
    size = 84 + 50 * int.from_bytes(content[80:84], "little")  # of a binary STL; some have zeros behind it
    if kind == "stl" and size <= len(content) and not content[size:].strip(b"\0\r\n"):
        return io.BytesIO(content[:size]), kind, 1
    end = content.find(b"end_header") if b"format binary" in content else len(content)
    code = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    text = io.TextIOWrapper(io.BytesIO(content[:end]), code, "replace").read()
    text = re.sub(r"\ufffd\\?", "?", text)  # a letter of Shift-JIS may end like a line that goes on
    text = re.sub(r"[dD](?<=[\d.].)(?=[-+\d])", "e", text)
    if kind == "stl":
        if not re.search(r"(?i)end\s*solid.*\W*$", text):
            raise ValueError(f"cut, or no STL: no endsolid at its end, and {len(content)} bytes in place of {size}")
        text = re.sub(r"(?im)^\s*(end)?\s*solid.*", r"\1solid", text)  # names may have the word "vertex"
    faces = re.match(r"(?s)(?:ply\s.*?element face|OFF(?:\s+#[^\n]*)*\s+\d+)\s+([1-9]\d*)", text)
    return io.BytesIO(text.encode() + content[end:]), kind, int(faces[1]) if faces else 1


def _circle(axis: Floats, facets: int) -> Floats:
    """Corners of a polygon on the unit circle around an axis."""
    if not isinstance(facets, int | np.integer) or isinstance(facets, bool) or facets < 3:
        raise ArgumentError("facets", facets, "expected an integer of 3 or more")
    first = np.cross(axis, np.eye(3)[np.argmin(abs(axis))])
    first /= np.linalg.norm(first)
    angle = 2.0 * math.pi * np.arange(facets)[:, None] / facets
    circle: Floats = np.cos(angle) * first + np.sin(angle) * np.cross(axis, first)
    return circle


def _vertices(given: Any) -> Floats:
    found = floats(given)
    if found.ndim != 2 or found.shape[1] != 3 or not len(found):
        raise ArgumentError("vertices", given, "expected an array of shape (n, 3) [m]")
    wrong = np.flatnonzero(~(abs(found) <= FARTHEST).all(axis=1))
    if wrong.size:
        reason = f"must be finite [m], none beyond {FARTHEST:g} ({wrong.size} in all)"
        raise ArgumentError("vertices", found[wrong[0]].tolist(), reason, wrong[0])
    return found


def _triangles(given: Any, vertices: int) -> Integers:
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.ndim != 2 or found.shape[1] != 3 or found.dtype.kind not in "iu" or not len(found):
        raise ArgumentError("triangles", given, "expected integers of shape (m, 3)")
    if found.min() < 0 or found.max() >= vertices:
        numbers = f"0 to {vertices - 1}, got {found.min()} to {found.max()}"
        raise ArgumentError("triangles", None, f"must be numbers of vertices, {numbers}")
    return found.astype(np.int64)


def _thickness(given: Any, triangles: int) -> Floats:
    found = floats(given)
    if found.shape not in ((), (triangles,)):
        reason = f"expected a number or one for each of {triangles} triangles [m]"
        raise ArgumentError("thickness", given, reason)
    check(thickness=np.atleast_1d(found))
    return np.broadcast_to(found, triangles).copy()


def _valid_triangles(vertices: Floats, triangles: Integers) -> tuple[Integers, Integers]:
    """Triangles that have an area, without duplicates; the number that each had.

    A flat triangle lies between one neighbour at its longest side and two at its other sides, which
    would not share sides without it. So the first neighbour is divided at the middle corner of the
    flat triangle, and one half takes the place of this.
    """
    triangles, close = welded(vertices, triangles)
    ordered = np.sort(triangles, axis=1)
    _, kept = np.unique(ordered, axis=0, return_index=True)
    kept = np.sort(kept[(np.diff(ordered[kept], axis=1) > 0).all(axis=1)])
    triangles = triangles[kept]
    area, longest = _sizes(vertices[triangles])
    flat = np.flatnonzero(area <= longest * np.maximum(close, _FLAT * longest))
    for n in flat[np.argsort(-longest[flat])]:
        end, middle, start = np.roll(triangles[n], -side_lengths(vertices[triangles[n]]).argmax())
        triangles[n] = middle  # without area
        beside = np.flatnonzero((triangles == start).any(axis=1) & (triangles == end).any(axis=1))
        if len(beside) == 1:
            whole = triangles[beside]
            triangles[n] = np.where(whole == start, middle, whole)
            triangles[beside] = np.where(whole == end, middle, whole)
    area, longest = _sizes(vertices[triangles])
    good = area > _FLAT * longest**2
    return triangles[good], kept[good]


def _sizes(corners: Floats) -> tuple[Floats, Floats]:
    """Twice the area of each triangle, and its longest side."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.linalg.norm(across, axis=1), side_lengths(corners).max(axis=1)

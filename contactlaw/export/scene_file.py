"""Walls as a file that an engine reads and passes to `contactlaw.stepping.step` by pointers.

A head of text with a line for each entry, then arrays as they lie in memory. A row holds an address
as the place of its array, counted from the first byte after the head; the array ``moved`` lists the
places of all addresses. A reader adds to each of them the address at which it has put the arrays,
and knows no field of the rows: their layout is that of the kernels, whose fingerprint is in the head.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import sys
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import _atomic
from contactlaw._arrays import Rows
from contactlaw._content import content_of
from contactlaw._errors import ArgumentError
from contactlaw._escaped import line
from contactlaw._version import VERSION
from contactlaw.physical.arguments import number, warn_of_metres
from contactlaw.record.columns import IMPACT
from contactlaw.record.file import Surface
from contactlaw.stepping.bead import WallContacts
from contactlaw.stepping.contact import CONTACT, STATUS
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.loads import LOAD
from contactlaw.stepping.plate_rows import PLATE_ROW
from contactlaw.stepping.step import HEAD, RUN
from contactlaw.walls.edges import EDGE
from contactlaw.walls.facet import FACET
from contactlaw.walls.frame import FRAME, Wall
from contactlaw.walls.grid import MARGIN
from contactlaw.walls.plate import Models
from contactlaw.walls.rest import at_rest
from contactlaw.walls.surface import OVERLAP

FORMAT = "contactlaw scene 1"
ROWS: dict[str, np.dtype[Any]] = {
    "plate_row": PLATE_ROW,
    "frame": FRAME,
    "facet": FACET,
    "overlap": OVERLAP,
    "impact_row": IMPACT,
    "status": STATUS,
    "load": LOAD,
    "edge": EDGE,
    "contact_row": CONTACT,
    "friction_row": FRICTION,
    "head": HEAD,
    "run": RUN,
}
# Fields that are addresses: their rows, the elements at the address, and the number of these.
_ADDRESSES: tuple[tuple[str, str, Any, Any], ...] = (
    ("plate_rows", "law", "f8", lambda row: row["law_size"] * (row["law"] != 0)),
    ("frames", "starts", "i8", lambda row: row["cell_count"] + 1),
    ("frames", "entries", "i4", lambda row: row["entry_count"]),
    ("frames", "busy", "u1", lambda row: (row["cell_count"] + 7) // 8),
    ("frames", "times", "f8", lambda row: row["count"]),
    ("frames", "displacements", "f8", lambda row: 3 * row["count"]),
    ("facets", "edges", EDGE, lambda row: row["edge_count"]),
)


def scene(
    path: str | os.PathLike[str],
    walls: Mapping[str, Wall] | Sequence[Wall],
    model: Models,
    *,
    largest: float,
    types: int = 1,
    **contact: float,
) -> None:
    """Write walls and materials as a file for LAMMPS's ``fix wall/contactlaw``.

    Parameters
    ----------
    path : path-like
        File to write; an existing one is replaced.
    walls : dict of str to wall, or sequence of walls
        Walls of `contactlaw.walls`, with names for messages and reports.
    model : ImpactModel or dict of int to ImpactModel
        Materials and law, for all beads or by atom type, as in `contactlaw.engines.lammps.attach`.
    largest : float
        Radius of the largest bead [m]; the fix refuses larger ones.
    types : int, optional
        Number of LAMMPS's atom types.
    **contact : float
        `friction`, `softening` and `parcel` as in `contactlaw.engines.lammps.attach`.

    Raises
    ------
    TypeError, ValueError
        If there is no wall, or an argument is refused as `attach` refuses it.
    OSError
        If the file cannot be written; nothing is left behind then.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from contactlaw.walls import Cylinder
    >>> drum = Cylinder((0, 0, 0), (0, 0.02, 0), 0.03, 0.8e-3)
    >>> model = cl.ImpactModel(cl.Pair("glass", "steel-s235"))
    >>> file = getfixture("tmp_path") / "drum.scene"
    >>> cl.export.scene(file, {"shell": drum}, model, largest=2e-3)
    >>> surface_of(file, np.zeros(0, IMPACT)).names
    ['shell']
    """
    if not walls:
        raise ArgumentError("walls", walls, "expected at least one wall of contactlaw.walls")
    if not 0.0 < number("largest", largest) < np.inf:
        raise ArgumentError("largest", largest, "must be the radius of the largest bead [m]")
    warn_of_metres("largest", largest, stacklevel=2)
    contacts = WallContacts(walls, model, largest, np.zeros(1, IMPACT), types=types, **contact)
    _atomic.write(path, _content(contacts, largest))


def fingerprint() -> str:
    """Return a hash of the layout of all rows, and the order of bytes."""
    layout = [(name, dtype.descr, dtype.itemsize) for name, dtype in ROWS.items()]
    return f"{hashlib.sha256(repr(layout).encode()).hexdigest()[:16]}-{sys.byteorder}"


def surface_of(path: str | os.PathLike[str], rows: Rows) -> Surface:
    """Walls of a scene as triangles, with their names, and where on them the rows of a record are."""
    head, _, content = content_of(Path(path)).partition(b"\nend\n")
    form, *lines = head.decode("utf-8", "replace").split("\n")
    values = dict(one.rpartition(" ")[::2] for one in lines if not one.startswith("wall "))
    if form != FORMAT or values["layout"] != fingerprint() or len(content) != int(values["bytes"]):
        reason = "is no whole scene of this version of contactlaw; `contactlaw export lammps` writes scenes"
        raise ArgumentError("scene", os.fspath(path), reason)
    memory = np.frombuffer(content + bytes(-len(content) % 8), np.int64).copy()

    def array(name: str, dtype: Any, count: str) -> Any:
        return np.frombuffer(memory, dtype, int(values[count]), int(values[f"at {name}"]))

    memory[array("moved", np.int64, "moves") // 8] += memory.ctypes.data
    facets, frames = array("facets", FACET, "facets"), array("frames", FRAME, "frames")
    names = [one.removeprefix("wall ") for one in lines if one.startswith("wall ")]
    if rows["plate"].max(initial=0) >= len(names):
        reason = f"has {len(names)} walls, and the record contacts on wall {rows['plate'].max()}: it is of another run"
        raise ArgumentError("scene", os.fspath(path), reason)
    return Surface(*at_rest(facets, frames, rows), names)


def _content(contacts: WallContacts, largest: float) -> bytes:
    """Head and arrays of a file."""
    rows_of = {name: np.copy(getattr(contacts.scene, name)) for name in ("plate_rows", "frames", "facets")}
    blob, stored, moved = bytearray(), dict[bytes, int](), list[tuple[str, int]]()

    def store(content: bytes) -> int:
        blob.extend(bytes(-len(blob) % 8))
        place = len(blob)
        blob.extend(content)
        return place

    for name, field, kind, count in _ADDRESSES:
        rows = rows_of[name].reshape(-1)
        sizes = [int(count(row)) * np.dtype(kind).itemsize for row in rows]
        for n, size in enumerate(sizes):
            content = ctypes.string_at(int(rows[field][n]), size) if size else b""
            if size and content not in stored:  # rows of one model have copies of its law
                stored[content] = store(content)
            rows[field][n] = stored.get(content, 0)
            if size:
                moved.append((name, n * rows.dtype.itemsize + rows[field].ctypes.data - rows.ctypes.data))
    places = {name: store(rows.tobytes()) for name, rows in rows_of.items()}
    places["moved"] = store(np.array([places[name] + offset for name, offset in moved], np.int64).tobytes())
    types, plates = contacts.scene.plate_rows.shape
    head = {
        "version": VERSION,
        "layout": fingerprint(),
        "bytes": len(blob),
        "largest": largest * MARGIN,
        **{name: getattr(contacts.scene, name) for name in ("friction", "softening", "parcel")},
        "contacts": contacts.places,
        "types": types,
        "plates": plates,
        "frames": len(contacts.scene.frames),
        "facets": len(contacts.scene.facets),
        "moves": len(moved),
        **{f"at {name}": place for name, place in places.items()},
    }
    lines = [FORMAT, *(f"{name} {value}" for name, value in head.items())]
    lines += [f"checksum {zlib.crc32(blob, zlib.crc32(repr(head).encode()))}"]  # by which a restart knows its scene
    lines += [*(f"wall {line(name)}" for name in contacts.names), "end\n"]
    return "\n".join(lines).encode() + bytes(blob)

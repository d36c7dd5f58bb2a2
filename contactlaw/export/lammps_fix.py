"""A fix of LAMMPS with the walls of `contactlaw.engines.lammps`, for input scripts alone.

The fix is C++ that reads the script and LAMMPS's arrays; what happens between a bead and the walls
is `contactlaw.stepping`, written in C by `contactlaw.emit`.
"""

import io
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from contactlaw import _atomic
from contactlaw._errors import ArgumentError
from contactlaw._escaped import line
from contactlaw._jit import kernel
from contactlaw._version import VERSION
from contactlaw.emit import DOUBLE, INT, NONE, Array, C, Program, Struct, Type, add
from contactlaw.equation.edge import KINDS
from contactlaw.export import c_header, functions
from contactlaw.model import ImpactModel
from contactlaw.physical.strengths import COARSE, by_strength
from contactlaw.record.columns import IMPACT
from contactlaw.softsphere import time_step
from contactlaw.stepping import Bead, Clock, interact
from contactlaw.stepping.bead import MOST_CONTACTS
from contactlaw.stepping.contact import CONTACT, STATUS, WallScene
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.loads import LOAD
from contactlaw.stepping.plate_rows import PLATE_ROW, plate_rows
from contactlaw.stepping.softened import DEEPEST_OVERLAP
from contactlaw.walls.edges import EDGE
from contactlaw.walls.facet import FACET, Point, Touch, on_facet
from contactlaw.walls.frame import FRAME
from contactlaw.walls.grid import MARGIN
from contactlaw.walls.motion import FARTHEST, move
from contactlaw.walls.plate import Plate
from contactlaw.walls.profile import Bend, bending, bent
from contactlaw.walls.surface import OVERLAP, ROOM, box, near

_THICKNESS = 2.0**-7  # [m] of the rows that the fix has, which it scales
REGION = 0  # kind of a facet that is a wall of one of LAMMPS's regions
_ROWS = {
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
}
_FILES = "fix_wall_contactlaw.h", "fix_wall_contactlaw.cpp", "plugin.cpp", "build.sh", "in.example.in", "README.txt.in"


def region_touch(facet: Any, p: Point, r: float) -> Touch:
    """Touch with a wall of a region; written in C++."""
    raise NotImplementedError


def region_bend(facet: Any, p: Point, r: float) -> Bend:
    """Curvatures of a region at a point; written in C++."""
    raise NotImplementedError


@kernel
def touch_or_region(facet: Any, p: Point, r: float) -> Touch:
    """Overlap and normal at the facet's nearest point, in the coordinates of the facet."""
    return region_touch(facet, p, r) if facet.kind == REGION else on_facet(facet, p, r)


@kernel
def bending_or_region(facet: Any, p: Point, size: float, r: float) -> Bend:
    """R*/R of a sphere at a facet or a region."""
    if facet.kind != REGION:
        return bending(facet, p, size, r)
    at = region_bend(facet, p, size)
    if 1.0 + at.around * size <= 0.0:
        return Bend(1.0 / at.around, at.around, at.along)
    return bent(at.around, at.along, r)


def lammps(folder: str | os.PathLike[str], model: ImpactModel | Sequence[ImpactModel]) -> None:
    """Write a fix of LAMMPS, for input scripts that run without Python.

    ``README.txt`` in the folder says how it is built, loaded and used.

    Parameters
    ----------
    folder : path-like
        Folder to write into; it is made if its parent exists. Files of the same names are
        replaced.
    model : ImpactModel or sequence of ImpactModel
        Pairs of beads and walls, each bead with each wall.

    Raises
    ------
    TypeError, ValueError
        If something is no ImpactModel, or a pair is missing or there twice.
    OSError
        If a file cannot be written; nothing is left behind then.

    Examples
    --------
    >>> import contactlaw as cl
    >>> folder = getfixture("tmp_path") / "wall"
    >>> cl.export.lammps(folder, cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    >>> sorted(path.name for path in folder.iterdir())  # doctest: +NORMALIZE_WHITESPACE
    ['README.txt', 'build.sh', 'contactlaw_kernels.h', 'fix_wall_contactlaw.cpp',
     'fix_wall_contactlaw.h', 'in.example', 'plugin.cpp']
    """
    given = c_header.models_of(model)
    by_pair = {one.pair.given: one for one in given}
    spheres, plates = ([*dict.fromkeys(pair[n] for pair in by_pair)] for n in range(2))
    if not len(given) == len(by_pair) == len(spheres) * len(plates) > 0:
        raise ArgumentError("model", None, "must have each bead's material with each wall's, once")
    names = [[line(one.name).replace("\\", "/") for one in bodies] for bodies in (spheres, plates)]
    if any(len({*some}) < len(some) for some in names):
        raise ArgumentError("model", names, "needs materials of different names")
    ordered = [by_pair[sphere, plate] for sphere in spheres for plate in plates]
    step = 0.5 * time_step(ordered[0], 1.0, 1e-3, 1e-3)  # of the example
    values = {
        "version": VERSION,
        "bead": names[0][0],
        "materials": "\n".join(f"    {one.name:<24} density {one.density:.6g} kg/m3" for one in spheres),
        "walls": ", ".join(names[1]),
        "density": repr(spheres[0].density),
        "timestep": f"{step:.1e}",
        "steps": str(int(400e-6 / step)),
    }
    with _atomic.folder(folder) as made:
        (made / "contactlaw_kernels.h").write_text(_kernels(ordered, *names), "utf-8")
        for name, content in c_header.filled("lammps", _FILES, values):
            (made / name).write_bytes(content)


def _kernels(models: Sequence[ImpactModel], spheres: Sequence[str], plates: Sequence[str]) -> str:
    """Kernels and the numbers of all pairs in C."""
    laws = [by_strength(one.pair, one.force_law, COARSE) for one in models]
    language = C()
    units, data = list[str](), list[str]()
    square = Plate((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), thickness=_THICKNESS)
    for n, (model, law) in enumerate(zip(models, laws, strict=True)):
        rows, _, _ = plate_rows([square], {1: model}, 1)
        rows["law"] = 0
        words = ", ".join(map(hex, rows.view(np.uint64).ravel().tolist()))
        units.append(f"static const unsigned long long contactlaw_unit_{n}[] = {{\n{words}\n}};")
        data.append(language.constant(f"law_{n}", law.tolist()))
    lists = []
    for name, kind, one in ("UNITS", "unsigned long long", "unit"), ("LAWS", "double", "law"):
        each = ", ".join(f"contactlaw_{one}_{n}" for n in range(len(laws)))
        lists.append(f"static const {kind} *const CONTACTLAW_{name}[] = {{ {each} }};")
    for name, texts in ("SPHERES", spheres), ("PLATES", plates), ("EDGES", KINDS):
        said = ", ".join(f'"{text}"' for text in texts)
        lists.append(f"static const char *const CONTACTLAW_{name}[] = {{ {said} }};")
    numbers = {"SPHERE_COUNT": len(spheres), "PLATE_COUNT": len(plates), "ROOM": ROOM, "MARGIN": MARGIN}
    # The kernels define what they need themselves.
    numbers |= {"FARTHEST": FARTHEST, "MOST_CONTACTS": MOST_CONTACTS, "DEEPEST_OVERLAP": DEEPEST_OVERLAP}
    constants = "\n".join(f"#define CONTACTLAW_{name} {value}" for name, value in numbers.items())
    head = "typedef const double contactlaw_data;"
    return "\n\n".join([head, c_header.preamble(), constants, _npy(), _program(), *units, *data, *lists]) + "\n"


def _npy() -> str:
    """Head of a file of ``np.save`` with rows of the record, and where in it their number stands."""
    head, number = io.BytesIO(), 10**17
    about = {"descr": np.lib.format.dtype_to_descr(IMPACT), "fortran_order": False, "shape": (number,)}
    np.lib.format.write_array_header_1_0(head, about)
    content, digits = head.getvalue(), str(number).encode()
    bytes_of = ", ".join(map(str, content.replace(digits, b" " * len(digits))))
    return (
        f"static const unsigned char contactlaw_npy[] = {{\n{bytes_of}\n}};\n"
        f'#define CONTACTLAW_NPY_ROWS {content.index(digits)}\n#define CONTACTLAW_NPY_DIGITS "%{len(digits)}lld"'
    )


def _program() -> str:
    """All kernels in C that the fix calls."""
    instead = functions.INSTEAD | {on_facet: touch_or_region, bending: bending_or_region}
    names = {dtype: name for name, dtype in _ROWS.items()}
    program = Program(C(), functions.FIXED, names | {3 * (DOUBLE,): "vector"}, instead)

    def rows(name: str, matrix: bool = False) -> Struct:
        return program.rows(program.row(_ROWS[name]), matrix)

    def struct(source: Any, **members: Type) -> Struct:
        return program.struct(source, dict.fromkeys(source._fields, DOUBLE) | members)

    point = program.struct(tuple, dict.fromkeys(("f0", "f1", "f2"), DOUBLE))
    program.elsewhere |= {region_touch: struct(Touch, face=INT), region_bend: struct(Bend)}
    scene = struct(
        WallScene,
        plate_rows=rows("plate_row", matrix=True),
        pressed=Array(),
        **{
            name: rows(row)
            for name, row in [("frames", "frame"), ("facets", "facet"), ("found", "overlap")]
            + [("impacts", "impact_row"), ("status", "status"), ("loads", "load")]
        },
    )
    vectors = dict.fromkeys(("x", "v", "omega"), point) | {"force": Array(), "torque": Array()}
    memory = {"contacts": rows("contact_row"), "friction": rows("friction_row")}
    bead = struct(Bead, number=INT, kind=INT, **vectors, **memory)
    rows("edge")
    add(program, move, rows("frame"), DOUBLE, DOUBLE)
    add(program, box, rows("frame"))
    add(program, near, rows("frame"), point, DOUBLE)
    add(program, interact, scene, struct(Clock, advancing=INT), bead, NONE)
    return program.text()

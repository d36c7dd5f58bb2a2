"""The fix of LAMMPS that reads scenes: sources that are the same for all walls and materials.

The fix is C++ that passes LAMMPS's arrays on; what happens between beads and walls is
`contactlaw.stepping.step`, written in C by `contactlaw.emit`.
"""

import io
import json
import os
from typing import Any

import numpy as np

from contactlaw import _atomic
from contactlaw._version import VERSION
from contactlaw.emit import DOUBLE, INT, LONG, NONE, Array, C, Program, Struct, Type, add
from contactlaw.export import c_header, functions, scene_file
from contactlaw.record.columns import IMPACT
from contactlaw.stepping.contact import Clock, WallScene
from contactlaw.stepping.softened import DEEPEST_OVERLAP
from contactlaw.stepping.spring import FEWEST_STEPS
from contactlaw.stepping.step import ROWS, RUN, Beads, begin, enclose, step
from contactlaw.stepping.trouble import MESSAGES, Trouble
from contactlaw.walls.surface import ROOM

_FILES = "fix_wall_contactlaw.h", "fix_wall_contactlaw.cpp", "plugin.cpp", "build.sh", "README.txt.in"


def lammps(folder: str | os.PathLike[str]) -> None:
    """Write the sources of LAMMPS's ``fix wall/contactlaw``, which are the same for all scenes.

    ``README.txt`` in the folder says how it is built, loaded and used.

    Parameters
    ----------
    folder : path-like
        Folder to write into; it is made if its parent exists. Files of the same names are
        replaced.

    Raises
    ------
    OSError
        If a file cannot be written; nothing is left behind then.

    Examples
    --------
    >>> import contactlaw as cl
    >>> folder = getfixture("tmp_path") / "wall"
    >>> cl.export.lammps(folder)
    >>> sorted(path.name for path in folder.iterdir())  # doctest: +NORMALIZE_WHITESPACE
    ['README.txt', 'build.sh', 'contactlaw_kernels.h', 'fix_wall_contactlaw.cpp',
     'fix_wall_contactlaw.h', 'plugin.cpp']
    """
    with _atomic.folder(folder) as made:
        (made / "contactlaw_kernels.h").write_text(_kernels(), "utf-8")
        for name, content in c_header.filled("lammps", _FILES, {"version": VERSION}):
            (made / name).write_bytes(content)


def _kernels() -> str:
    """Kernels in C, what they need, and the messages of their errors."""
    constants = {
        "ROOM": ROOM,
        "IMPACT_ROWS": 4 * ROWS,
        "DEEPEST_OVERLAP": DEEPEST_OVERLAP,
        "STEPS": FEWEST_STEPS,
        **{trouble.name: int(trouble) for trouble in (Trouble.NO_STEPS, Trouble.RESPA, Trouble.TRICLINIC)},
        "VERSION": json.dumps(VERSION),
        "FORMAT": json.dumps(scene_file.FORMAT),
        "LAYOUT": json.dumps(scene_file.fingerprint()),
    }
    lines = [f"#define CONTACTLAW_{name} {value}" for name, value in constants.items()]
    messages = C().table(
        "int code; const char *text;", "messages", ((int(code), text) for code, text in MESSAGES.items())
    )
    head = "typedef const double contactlaw_data;"
    return "\n\n".join([head, c_header.preamble(), "\n".join(lines), _npy(), _program(), messages]) + "\n"


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
    """Write `begin` and `step` in C, for any scene."""
    names: dict[Any, str] = {dtype: name for name, dtype in scene_file.ROWS.items()}
    program = Program(C(), functions.FIXED, names | {3 * (DOUBLE,): "vector"}, functions.INSTEAD)

    def rows(name: str, matrix: bool = False) -> Struct:
        return program.rows(program.row(scene_file.ROWS[name]), matrix)

    def struct(source: Any, **members: Type) -> Struct:
        return program.struct(source, dict.fromkeys(source._fields, DOUBLE) | members)

    named = {"frames": "frame", "facets": "facet", "found": "overlap", "impacts": "impact_row", "status": "status"}
    parts = {name: rows(row) for name, row in (named | {"loads": "load"}).items()}
    scene = struct(WallScene, plate_rows=rows("plate_row", matrix=True), **parts)
    vectors = dict.fromkeys(("x", "v", "omega", "force", "torque"), Array(shape=(-1, 3)))
    numbers = dict.fromkeys(("radius", "mass", "last"), Array()) | dict.fromkeys(("kind", "mask"), Array(of=INT))
    tags = Array(of=Type("contactlaw_tag"))  # of LAMMPS's atom IDs, which may have 32 or 64 bits
    whole = {"n": INT, "places": INT, "history": LONG, "bytes": LONG}
    beads = struct(Beads, tag=tags, bodies=NONE, **vectors, **numbers, **whole)
    clock = struct(Clock, advancing=INT)
    arguments = scene, rows("run"), clock, beads, INT
    add(program, enclose, program.row(RUN), clock, Array(), Array(), Array(of=INT))
    add(program, begin, *arguments)
    add(program, step, *arguments)
    return program.text()

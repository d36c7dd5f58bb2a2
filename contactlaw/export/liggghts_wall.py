"""A normal model for the walls of LIGGGHTS: its header, and what makes a library of it.

The law is that of `contactlaw.export.header`, which each contact steps through; LIGGGHTS has the
walls, their motion, friction and the ranks.
"""

from __future__ import annotations

import os
import string
import tempfile
from importlib import resources
from pathlib import Path

from contactlaw import _atomic
from contactlaw._version import VERSION
from contactlaw.equation.waves import CONTACT_TIME
from contactlaw.export import c_header
from contactlaw.model import ImpactModel
from contactlaw.stepping.spring import FEWEST_STEPS
from contactlaw.table import lookup

_FILES = "normal_model_contactlaw.h.in", "wall_contactlaw.cpp", "build.sh", "README.txt.in"


def liggghts(folder: str | os.PathLike[str], model: ImpactModel) -> None:
    """Write what adds a pair of materials to LIGGGHTS 3.8, as a normal model of ``fix wall/gran``.

    Parameters
    ----------
    folder : path-like
        Where to; it is made if need be, in a folder that is there. Files of the same names are
        replaced.
    model : ImpactModel
        Pair and law.

    Raises
    ------
    TypeError
        If the model is no ImpactModel.
    OSError
        If a file cannot be written; nothing is left behind then.

    Notes
    -----
    ``README.txt`` says how it is built and used. ``build.sh`` makes a library that Debian's binary
    loads; the headers ``contactlaw.h`` and ``normal_model_contactlaw.h`` also go into the sources
    of LIGGGHTS. A wall's thickness is a property of its type, so one pair serves walls of several.

    Normal impacts as in `contactlaw.softsphere`, with LIGGGHTS's ``tangential history`` for
    friction. Bead on bead is LIGGGHTS's own.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> folder = getfixture("tmp_path") / "liggghts"
    >>> cl.export.liggghts(folder, model)
    >>> sorted(path.name for path in folder.iterdir())  # doctest: +NORMALIZE_WHITESPACE
    ['README.txt', 'build.sh', 'contactlaw.h', 'normal_model_contactlaw.h', 'wall_contactlaw.cpp']
    """
    folder = Path(os.path.realpath(folder))  # beside what a link leads to: one file system
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.parent) as made:
        c_header.header(Path(made) / "contactlaw.h", model, table="none")
        for name, content in _texts(model).items():
            _atomic.write(Path(made) / name, content.encode())
        folder.mkdir(exist_ok=True)
        for path in Path(made).iterdir():
            _atomic.write(folder / path.name, path.read_bytes())


def _texts(model: ImpactModel) -> dict[str, str]:
    """Fill the templates."""
    pair = model.pair
    values = {
        "version": VERSION,
        "sphere": pair.sphere.name,
        "plate": pair.plate.name,
        "law": model.force_law.family,
        "tangential": repr(8.0 * pair.effective_shear_modulus),
        "contact_time": repr(CONTACT_TIME),
        "steps": str(FEWEST_STEPS),
        "R_MIN": repr(lookup.R_MIN),
        "THINNEST": repr(lookup.THINNEST),
    }
    found = {}
    for name in _FILES:
        text = (resources.files("contactlaw.export") / "liggghts" / name).read_text("utf-8")
        if name.endswith(".in"):
            name, text = name.removesuffix(".in"), string.Template(text).substitute(values)
        found[name] = text
    return found

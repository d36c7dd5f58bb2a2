"""Contact models for LIGGGHTS: headers, and the files to build a library of them.

Force and friction of each contact are those of `contactlaw.export.header`, step by step. Walls,
their motion and ranks are LIGGGHTS's.
"""

import os

from contactlaw import _atomic
from contactlaw._escaped import line
from contactlaw._version import VERSION
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.edge import KINDS
from contactlaw.export import c_header
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair
from contactlaw.stepping.spring import FEWEST_STEPS
from contactlaw.table import lookup

_FILES = (
    "normal_model_contactlaw.h.in",
    "tangential_model_contactlaw.h.in",
    "wall_contactlaw.cpp",
    "build.sh",
    "README.txt.in",
)


def liggghts(folder: str | os.PathLike[str], model: ImpactModel) -> None:
    """Write a pair of materials as contact models of LIGGGHTS 3.8, for walls and beads.

    Parameters
    ----------
    folder : path-like
        Folder to write into; it is made if its parent exists. Files of the same names are
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
    loads; the four headers also go into the sources of LIGGGHTS. The
    thickness is a property of a wall's atom type, so walls of one pair may differ in thickness; so
    is the distance from an edge, if walls have one.

    Normal forces are those of `contactlaw.softsphere`, friction is that of `contactlaw.stepping` or
    LIGGGHTS's ``tangential history``. Between beads ``pair_style gran model contactlaw`` has the
    law of `restitution_sphere_sphere`, and ``tangential history``.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> folder = getfixture("tmp_path") / "liggghts"
    >>> cl.export.liggghts(folder, model)
    >>> sorted(path.name for path in folder.iterdir())  # doctest: +NORMALIZE_WHITESPACE
    ['README.txt', 'build.sh', 'contactlaw.h', 'contactlaw_beads.h',
     'normal_model_contactlaw.h', 'tangential_model_contactlaw.h', 'wall_contactlaw.cpp']
    """
    if not isinstance(model, ImpactModel):
        raise TypeError(f"model: expected a contactlaw.ImpactModel, got {model!r}")
    law, sphere = model.force_law, model.pair.sphere
    between = ImpactModel(Pair(sphere, sphere), law.family if law.from_pair else law)
    with _atomic.folder(folder) as made:
        c_header.header(made / "contactlaw.h", model, table="none")
        c_header.header(made / "contactlaw_beads.h", between, table="none", prefix="contactlaw_beads")
        for name, content in c_header.filled("liggghts", _FILES, _values(model, between.pair)):
            (made / name).write_bytes(content)


def _values(model: ImpactModel, beads: Pair) -> dict[str, str]:
    """Give the numbers and names that the templates ask for."""
    pair = model.pair
    return {
        "version": VERSION,
        "sphere": line(pair.sphere.name),
        "plate": line(pair.plate.name),
        "law": line(model.force_law.family),
        "tangential": repr(8.0 * pair.effective_shear_modulus),
        "tangential_beads": repr(8.0 * beads.effective_shear_modulus),
        "contact_time": repr(CONTACT_TIME),
        "steps": str(FEWEST_STEPS),
        "R_MIN": repr(lookup.R_MIN),
        "R_MAX": repr(lookup.R_MAX),
        "THINNEST": repr(lookup.THINNEST),
        "edge_names": ", ".join(f'"{kind}Edge"' for kind in KINDS),
    }

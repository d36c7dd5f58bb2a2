"""One C header for a pair of materials: the law and a table of COR as data, and functions.

The functions are the kernels of `contactlaw.export.functions`, written in C by `contactlaw.emit`.
``contactlaw.h.in`` has what is C's own: how it is used, what differs between compilers, pointers.
"""

import hashlib
import os
import re
import string
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources
from typing import Any, Literal

from contactlaw import _atomic
from contactlaw._errors import ArgumentError
from contactlaw._escaped import c_comment
from contactlaw._version import VERSION
from contactlaw.emit import DOUBLE, INT, C, Known, Program, add
from contactlaw.equation.edge import KINDS
from contactlaw.equation.numbers import Impact
from contactlaw.export import functions
from contactlaw.export.functions import FIXED, Bodies, bodies_of
from contactlaw.model import ImpactModel
from contactlaw.physical.materials import Material
from contactlaw.physical.oblique import Sliding
from contactlaw.physical.validity import Validity, explain
from contactlaw.stepping.softened import SoftState, must_ask
from contactlaw.stepping.spring import Spring, State
from contactlaw.table import Table, certify
from contactlaw.table.lookup import V_MAX
from contactlaw.table.table import POINTS

LARGEST = 1_000_000  # bytes: a header is read by each source file that includes it
_WIDTH = 96
_TABLE = re.compile(r"^@table\n(.*?)^@end\n", re.DOTALL | re.MULTILINE)
# The text is C, but for what GPUs need before each function and each constant.
_DECLARED = re.compile(r"^static (inline|const)\b", re.MULTILINE)
_MACROS = {"inline": "CONTACTLAW_FN", "const": "CONTACTLAW_DATA"}
_PREFIX = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_NAMES = re.compile(r"\b(contactlaw|CONTACTLAW)(?=_)")
_VECTOR = 3 * (DOUBLE,)
# Names that users know, and those of the template.
_PUBLIC: dict[Any, str] = {
    _VECTOR: "vector",
    functions.SLIDING: "sliding",
    functions.Answer: "impact",
    Impact: "given",
    functions.BeadSpring: "spring",
    Spring: "contact_spring",
    Sliding: "approach",
    SoftState: "softened",
    **{one: one for one in "step flags collide set_edge friction_step vector_of store".split()},
    **{one: one for one in ("softened_step", "softened_friction_step")},
}


def header(
    path: str | os.PathLike[str],
    model: ImpactModel,
    table: Literal["cor", "none"] = "cor",
    *,
    prefix: str = "contactlaw",
) -> None:
    """Write the law and the COR of a pair of materials as one header for C, C++, CUDA, HIP, OpenCL.

    The first lines of the header say how it is used.

    Parameters
    ----------
    path : path-like
        File to write; an existing file is replaced.
    model : ImpactModel
        Pair, law and table.
    table : {"cor", "none"}, optional
        Whether the header has the model's table of COR, and with it ``contactlaw_restitution``.
    prefix : str, optional
        What the names in the header begin with, in lower case: headers of several pairs live in one
        source file if each has its own, as in ``steel_on_glass_step``.

    Raises
    ------
    TypeError
        If the model is no ImpactModel.
    ValueError
        If the kind of table is unknown, or a large table would make the header exceed 1 MB; if
        the prefix is not lower-case words of letters and digits, joined by single underscores.
    OSError
        If the file cannot be written; nothing is left behind then.

    Notes
    -----
    For every law, ``contactlaw_step`` computes what `contactlaw.softsphere` does,
    ``contactlaw_rebound`` `ImpactModel.solve`, ``contactlaw_collide`` `ImpactModel.collide`, and
    ``contactlaw_restitution`` `ImpactModel.kernel`.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> folder = getfixture("tmp_path")
    >>> cl.export.header(folder / "contactlaw.h", model)
    >>> "double contactlaw_restitution(" in (folder / "contactlaw.h").read_text()
    True
    """
    if not isinstance(model, ImpactModel):
        raise TypeError(f"model: expected a contactlaw.ImpactModel, got {model!r}")
    if table not in ("cor", "none"):
        raise ArgumentError("table", table, "must be 'cor' or 'none'")
    if not (isinstance(prefix, str) and _PREFIX.fullmatch(prefix)):
        reason = "must be lower-case words and digits joined by _, as 'steel_on_glass'"
        raise ArgumentError("prefix", prefix, reason)
    content = _text(model, model.table if table == "cor" else None, prefix).encode()
    if len(content) > LARGEST:
        raise ArgumentError(
            "table",
            None,
            f"the header would have {len(content)} bytes, above {LARGEST}: take 'none', or a "
            "model with coarser Settings, or one with a rate for one of two bodies alone",
        )
    _atomic.write(path, content)


def kernels(bodies: Bodies) -> str:
    """Write all functions for a pair in C, `functions.restitution` if it has tables."""
    program, pair = Program(C(), FIXED, _PUBLIC, functions.INSTEAD), Known(value=bodies)
    point = program.struct(tuple, dict(zip(("f0", "f1", "f2"), _VECTOR, strict=True)))
    sliding = program.row(functions.SLIDING)
    state = program.struct(State, dict.fromkeys(State._fields, DOUBLE))
    if bodies.table is not None:
        add(program, functions.restitution, pair, *_VECTOR)
    _, bead = add(program, functions.spring_of, pair, DOUBLE, DOUBLE)
    _, impact = add(program, functions.rebound, pair, *_VECTOR)
    add(program, functions.rebound_with_mass, pair, *_VECTOR, DOUBLE)
    add(program, functions.at_edge, pair, bead, INT, DOUBLE)
    add(program, functions.after_step, pair, bead, state, DOUBLE, DOUBLE)
    softened = program.struct(SoftState, dict.fromkeys(SoftState._fields, DOUBLE))
    add(program, functions.after_softened, bead, DOUBLE, DOUBLE, softened, DOUBLE, DOUBLE)
    add(program, functions.restitution_of, pair, bead, DOUBLE)
    add(program, functions.restitution_near, pair, *_VECTOR, INT, DOUBLE)
    add(program, functions.flags_for, pair, impact, *_VECTOR)
    add(program, functions.rub, pair, bead, state, sliding, DOUBLE, DOUBLE, point, point, DOUBLE)
    add(program, must_ask, INT, INT, DOUBLE, DOUBLE)
    one = program.rows(sliding)
    add(program, functions.rub_softened, pair, bead, DOUBLE, softened, one, DOUBLE, point, point, DOUBLE)
    add(program, functions.collided, pair, point, point, point, point, *_VECTOR)
    return program.text()


def filled(folder: str, files: Iterable[str], values: Mapping[str, str]) -> Iterator[tuple[str, bytes]]:
    """Fill the templates of a folder, whose names end in ``.in``; names and contents of all files."""
    for name in files:
        text = (resources.files("contactlaw.export") / folder / name).read_text("utf-8")
        if name.endswith(".in"):
            name, text = name.removesuffix(".in"), string.Template(text).substitute(values)
        yield name, text.encode()


def preamble() -> str:
    """Return what the kernels in C have of C itself: structures of their members, least and largest."""
    template = resources.files("contactlaw.export").joinpath("contactlaw.h.in").read_text("utf-8")
    return "/* A structure" + template.partition("/* A structure")[2].partition("/* The kernels")[0]


def _text(model: ImpactModel, table: Table | None, prefix: str) -> str:
    """Fill the template."""
    template = resources.files("contactlaw.export").joinpath("contactlaw.h.in").read_text("utf-8")
    filled = string.Template(_TABLE.sub(r"\1" if table else "", template))
    about, written = "\n".join(_about(model, table)), kernels(bodies_of(model, table))
    text = filled.substitute(
        version=VERSION,
        about="$about",  # filled in last, as names of materials do not take the prefix
        guard=hashlib.sha256((VERSION + written + about).encode()).hexdigest()[:16],
        V_MAX=V_MAX,
        edges=", ".join(f"CONTACTLAW_{kind.upper()}_EDGE" for kind in KINDS),
        validity=",\n".join(f"    CONTACTLAW_{f.name} = {f.value}" for f in Validity if f < Validity.CURVED_WALL),
        kernels=written,
    )
    text = _DECLARED.sub(lambda one: _MACROS[one[1]], text)
    named = _NAMES.sub(lambda one: prefix if one[1].islower() else prefix.upper(), text)
    return named.replace("$about", about)


def _about(model: ImpactModel, table: Table | None) -> Iterable[str]:
    """Lines of the first comment: law, pair, flags that the pair alone decides, certificate."""
    law, pair, limits = model.force_law, model.pair, model.limits
    if limits.always & Validity.RATE_DEPENDENT:
        yield from _comment(f"WARNING: {'; '.join(explain(Validity.RATE_DEPENDENT))}")
    yield from _comment(f"law {law.family}: {law.source}")
    yield from _comment(f"sphere {_body(pair.sphere)}")
    yield from _comment(f"plate {_body(pair.plate)}")
    on_yield = limits.on_yield | limits.flags_when_yielded
    for when, flags in (("every impact", limits.always), ("a body that yields", on_yield)):
        said = (f"{one.name}: {explain(one)[0]}" for one in Validity(flags))
        yield from _comment(f"flags of {when}: {'; '.join(said) or 'none'}")
    if table is None:
        yield from _comment("no table")
        return
    certificate, settings = table.certificate or certify(table, POINTS), table.settings
    strength = table.grid.rungs[-1, 0]
    stronger = f" and strengths to {strength:.4g}" if strength > 1.0 else ""
    yield from _comment(
        f"table of COR, lambda to {settings.largest_inelasticity:g} and chi to "
        f"{settings.largest_overload:g}{stronger}; certificate: within "
        f"{certificate.largest['restitution']:.1e} of the integrated equation"
    )


def _body(material: Material) -> str:
    flow = material.flow
    limit = "no yield strength" if flow is None else f"yield strength {flow.strength:.6g} Pa"
    if flow is not None and flow.hardening:
        limit += f", hardening {flow.hardening:.6g} Pa and {flow.exponent:.6g}"
    if material.loss_factor:
        loss, frequency = material.loss_factor
        limit += f", loss factor {loss:.6g} at {frequency:.6g} Hz"
    if flow is not None and flow.rate:
        limit += f", rate {flow.rate:.6g} above {flow.rate0:.6g} 1/s"
    return (
        f"{material.name}: E {material.youngs_modulus:.6g} Pa, nu {material.poissons_ratio:.6g}, "
        f"rho {material.density:.6g} kg/m3, {limit}"
    )


def _comment(text: str) -> list[str]:
    """Lines within a comment of C, which no name of a law or a material can end."""
    return textwrap.wrap(
        c_comment(text), _WIDTH, initial_indent=" * ", subsequent_indent=" *     ", break_on_hyphens=False
    )

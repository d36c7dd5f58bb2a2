"""One C header for a pair of materials: the law and a table of COR as data, and functions.

The functions, in ``contactlaw.h.in``, are the same for every law. They compute what
`contactlaw.equation`, `contactlaw.softsphere` and `contactlaw.table.lookup` do, and read the same
arrays.
"""

from __future__ import annotations

import hashlib
import inspect
import itertools
import math
import os
import re
import string
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import fields
from importlib import resources
from types import ModuleType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contactlaw import _atomic
from contactlaw._escaped import c_comment
from contactlaw._version import VERSION
from contactlaw.answers import solver
from contactlaw.answers.rated import Nodes
from contactlaw.answers.tabulated import Border
from contactlaw.equation import corrections, creep, force, integrator, tangential
from contactlaw.equation.edge import KINDS
from contactlaw.model import ImpactModel
from contactlaw.physical import scaling, validity
from contactlaw.physical.materials import Material
from contactlaw.physical.rate import largest_factor, rated, strengthened
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import factors, wave_path
from contactlaw.physical.validity import Limits, Validity, explain
from contactlaw.softsphere import unit_spring
from contactlaw.stepping import friction as stepping_friction
from contactlaw.stepping import spring as stepping_spring
from contactlaw.stepping import strength
from contactlaw.stepping.strength import levels_of
from contactlaw.table import Table, lookup
from contactlaw.table.nodes import thinned

Array = NDArray[np.float64]

LARGEST = 500_000  # bytes: a header is read by each source file that includes it
NODES = 4  # tables of a pair with a rate, through which COR is a cubic in ln(strength)
_ERROR_OF_NODE = 1e-4  # of one of these; together they err by less than 1e-3
ERROR = 4e-6  # largest of COR against the model's table, to be within 1e-5 of the equation
_WIDTH = 96
_STEP = 0.15  # of ln(factor) between two laws of a pair with a rate: COR within 1.2e-3 of itself
# Constants that have the same names in the template as in their modules.
_CONSTANTS: dict[ModuleType, str] = {
    corrections: "LENGTHENING LENGTHENING_3 LONGEST H_0 WIDEST DEEPEST BROADEST SATURATION "
    "CONTACT_TIME",
    lookup: "R_MIN R_MAX THINNEST V_MIN V_MAX",
    integrator: "MAX_STEPS LEAST_RESTITUTION FINER_EVERY",
    creep: "SLOW",
    tangential: "FLATTEST POINT RELAXING",
    solver: "RTOL",
    scaling: "NEAREST",
    stepping_friction: "SPRINGS _LEAST_SPEED _DEEPEST",
    stepping_spring: "ON_LOADING_CURVE MOST_ITERATIONS CONVERGED USUAL_SPEED",
    strength: "_STRIDE _FINE",
    validity: "TRANSITS",
}
# Offsets into the arrays, which become enumerators of C.
_IN_LAW = (
    "PIECES UNLOADINGS STARTS CURVE FAMILY_STARTS FAMILY CAPPED SCALE OFFSET DEGREE AT FIRST NEXT "
    "PIECE RESIDUAL EXPONENT LOSS CAP_LOW CAP_HIGH OTHER FUNCTION_POWER FUNCTION_DEGREE "
    "FUNCTION_AT FUNCTION UNLOADING_ROW"
)
_IN_TABLE = (
    "STRETCH X_MAX LOG_CHI_MAX NODES_PER_X COLUMNS SEGMENTS CURVED COR_AT HEADER BLOCKS START END "
    "PER_LOG CELLS COLUMN GRADED LINE BLOCK"
)
_ATTRIBUTES = re.compile(r"^(\w+(?:, \w+)*)\n((?: {4}.+\n?)+)", re.MULTILINE)
_SECTION = re.compile(r"^@(table|rate|plain)\n(.*?)^@end\n", re.DOTALL | re.MULTILINE)
# The template is C, but for what GPUs need before each function and each constant.
_DECLARED = re.compile(r"^static (inline|const)\b", re.MULTILINE)
_MACROS = {"inline": "CONTACTLAW_FN", "const": "CONTACTLAW_DATA"}
_PREFIX = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_NAMES = re.compile(r"\b(contactlaw|CONTACTLAW)(?=_)")


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
        Whether the header has a table, and with it ``contactlaw_restitution``. The table is coarser
        than the model's: its COR is within 1e-5 of the integrated equation, or as near as the
        model's own table. A pair with a rate of strain has four, with which it is within 2e-3.
    prefix : str, optional
        What the names in the header begin with, in lower case: headers of several pairs live in one
        source file if each has its own, as in ``steel_on_glass_step``.

    Raises
    ------
    TypeError
        If the model is no ImpactModel.
    ValueError
        If the kind of table is unknown, or a large table would make the header exceed 500 kB; if
        the prefix is not lower-case words of letters and digits, joined by single underscores; if
        another body may come to yield, because two that yield have not the same rate.
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
        raise ValueError(f"table: must be 'cor' or 'none', got {table!r}")
    if not (isinstance(prefix, str) and _PREFIX.fullmatch(prefix)):
        raise ValueError(
            "prefix: must be lower-case words of letters and digits, joined by single underscores "
            f"and beginning with a letter, as in 'steel_on_glass', got {prefix!r}"
        )
    content = _text(model, _nodes(model) if table == "cor" else {}, prefix).encode()
    if len(content) > LARGEST:
        raise ValueError(
            f"table: the header would have {len(content)} bytes, above {LARGEST}: take 'none', or "
            "a model with coarser Settings, or one with a rate for one of two bodies alone"
        )
    _atomic.write(path, content)


def packed(model: ImpactModel, table: Table) -> Array:
    """Array of the lookup kernels, without the part that COR does not need."""
    whole = lookup.with_plate(table.packed, factors(model.pair, model.force_law).plate)
    return whole[: int(whole[lookup.OTHERS_AT])]


def _nodes(model: ImpactModel) -> dict[float, tuple[ImpactModel, Table]]:
    """Tables of a pair, by the logarithm of its strength; a pair without a rate has one."""
    flow = rated(model.pair, model.force_law)
    if flow is None:
        return {0.0: (model, thinned(model.table, ERROR))}
    bodies = model.pair.sphere, model.pair.plate
    differ = all(one.flow for one in bodies) and bodies[0].rate != bodies[1].rate
    if differ and len(Nodes(model._bodies, None, Border("raise")).knots) > 2:
        raise ValueError(
            "table: as the strengths grow, another body may yield or one outgrow the other, which "
            "needs more tables than a header has room for: take 'none', and contactlaw_rebound"
        )
    found = {}
    for n in range(NODES):
        at = n / (NODES - 1) * math.log(largest_factor(flow))
        one = ImpactModel(strengthened(model.pair, math.exp(at)), model.force_law.family)
        found[at] = one, thinned(one.table, _ERROR_OF_NODE)
    return found


def _text(
    model: ImpactModel, nodes: dict[float, tuple[ImpactModel, Table]], prefix: str = "contactlaw"
) -> str:
    """Fill the template."""
    template = resources.files("contactlaw.export").joinpath("contactlaw.h.in").read_text("utf-8")
    levels = levels_of(model.pair, model.force_law, _STEP)
    parts = {"table": bool(nodes), "rate": levels is not None, "plain": levels is None}
    template = _SECTION.sub(lambda one: one[2] if parts[one[1]] else "", template)
    template = _DECLARED.sub(lambda one: _MACROS[one[1]], template)
    spring = unit_spring(model, 1.0)
    made = factors(model.pair, model.force_law)
    transit = made.plate.transit * made.time  # time of a shear wave through a plate of H = 1 m
    plate, groups = made.plate, list(_impact())
    span, work, early = force.returned(model.force_law.data)
    tables = [packed(*one) for one in nodes.values()]
    numbers = [value for one in tables for value in (one if levels is None else _rounded(one))]
    values = {
        "version": VERSION,
        "about": "$about",  # filled in last, as names of materials do not take the prefix
        "mass": _number(spring.mass),
        "stiffness": _number(spring.stiffness),
        "mobility": _number(spring.mobility),
        "scale": _number(spring.scale),
        "relaxation": _number(spring.relaxation),
        "transit": _number(transit),
        "tangential_ratio": _number(model.pair.tangential_ratio),
        "span": _number(span),
        "work": _number(work),
        "early": _number(early),
        "stiffening": _number(force.stiffening(model.force_law.data)),
        "plate": ", ".join(plate._fields[:4]),
        "plate_values": _array(plate[:4]),
        "growth": ", ".join(plate.growth._fields),
        "growth_values": _array(plate.growth),
        "corrections": ", ".join(plate.corrections._fields),
        "corrections_values": _array(plate.corrections),
        "law": _array(model.force_law.data) if levels is None else _array(_rounded(levels)),
        "law_is": "The law, laid out as contactlaw.equation.force says."
        if levels is None
        else "Laws by strength, laid out as contactlaw.stepping.strength says.",
        "first_law": "" if levels is None else " + contactlaw_LEVELS + 1",
        "also": "" if levels is None else ", and the strength",
        "c_chi": _number(made.log_overload),
        "table": _array(numbers),
        "nodes": len(nodes),
        "node": ", ".join(map(repr, nodes)),
        "node_at": ", ".join(str(sum(map(len, tables[:n]))) for n in range(len(tables))),
        **_definitions(),
        "impact": "\n".join(_members(names, text) for names, text in groups),
        "nothing": ", ".join("none" for names, _ in groups for _ in names),
        "validity": ",\n".join(f"    CONTACTLAW_{one.name} = {one.value}" for one in Validity),
        "edges": ", ".join(f"CONTACTLAW_{kind.upper()}_EDGE" for kind in KINDS),
        "responses": ",\n".join(
            f"{{\n{_array(response_of(kind, model.pair.plate.poissons_ratio, size='steps'))}\n}}"
            for kind in KINDS
        ),
        "wave_path": _number(wave_path(model.pair.plate)),
        "limits": "\n        ".join(textwrap.wrap(", ".join(Limits._fields), _WIDTH - 8)),
        "limit_values": _array(model.limits),
        "root_series": _array(lookup.ROOT),
        "fifths": _array(2.0 ** (n / 5) for n in range(1, 6)),
    }
    about = "\n".join(_about(model, nodes))
    values["guard"] = hashlib.sha256((repr(values) + about).encode()).hexdigest()[:16]
    text = string.Template(template).substitute(values)
    named = _NAMES.sub(lambda one: prefix if one[1].islower() else prefix.upper(), text)
    return named.replace("$about", about)


def _definitions() -> dict[str, str]:
    """Write the constants of Python that C needs."""
    constants = ((module, name) for module, names in _CONSTANTS.items() for name in names.split())
    return {
        **{name: repr(getattr(module, name)) for module, name in constants},
        "law_offsets": _enumerators(force, _IN_LAW),
        "table_offsets": _enumerators(lookup, _IN_TABLE),
        "strength_offsets": _enumerators(strength, "COUNT ROOM COEFFICIENT PER_SPEED STEP LEVELS"),
    }


def _impact() -> Iterator[tuple[list[str], str]]:
    """Members of an impact in C, in groups, with the descriptions of `Rebound`.

    The overload is left out, as it needs a second integration, and so are the flags, which have a
    function of their own.
    """
    said = {"loading_time": "Time from first touch to the largest compression [s]."}
    for names, text in _ATTRIBUTES.findall(inspect.getdoc(Rebound) or ""):
        said |= dict.fromkeys(names.split(", "), " ".join(text.replace("`", "").split()))
    members = [one.name for one in fields(Rebound) if one.name not in ("overload", "flags")]
    members.insert(members.index("contact_time") + 1, "loading_time")
    for text, group in itertools.groupby(members, lambda name: said.get(name, "")):
        yield list(group), text


def _members(names: list[str], text: str) -> str:
    """Members of a structure of C, below a comment."""
    comment = textwrap.wrap(f"/* {text} */", _WIDTH - 4, subsequent_indent=" * ")
    return textwrap.indent("\n".join([*comment, f"double {', '.join(names)};"]), "    ")


def _enumerators(module: ModuleType, names: str) -> str:
    """Write enumerators of C from a module's constants."""
    return ",\n".join(f"    contactlaw_{name} = {getattr(module, name)}" for name in names.split())


def _about(model: ImpactModel, nodes: dict[float, tuple[ImpactModel, Table]]) -> Iterable[str]:
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
    if not nodes:
        yield from _comment("no table")
    for at, (_, table) in nodes.items():
        certificate, settings = table.certificate, table.settings
        assert certificate is not None
        yield from _comment(
            f"table of COR{f' at {math.exp(at):.4g} of the strength' if len(nodes) > 1 else ''}, "
            f"lambda to {settings.largest_inelasticity:g} and chi to "
            f"{settings.largest_overload:g}; certificate: at {certificate.points} random points, "
            f"seed {certificate.seed}, within {certificate.largest['restitution']:.1e} of the "
            "integrated equation, 99 % of them within "
            f"{certificate.percentile_99['restitution']:.1e}"
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
        c_comment(text), _WIDTH, initial_indent=" * ", subsequent_indent=" *     ",
        break_on_hyphens=False,
    )  # fmt: skip


def _number(value: float) -> str:
    """Write a number for C, which reads back the same double."""
    if math.isinf(value):
        return "HUGE_VAL" if value > 0.0 else "-HUGE_VAL"
    return repr(float(value))


def _rounded(values: Array) -> list[float]:
    """Nine digits of numbers: laws and tables of several strengths are long."""
    return [float(f"{value:.9g}") for value in values]


def _array(values: Iterable[float]) -> str:
    """Lines of an array of C."""
    text = ", ".join(map(_number, values))
    return "\n".join(textwrap.wrap(text, _WIDTH, break_on_hyphens=False))

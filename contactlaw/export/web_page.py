"""A page with sliders for a browser; it answers for some pairs of materials.

The page computes by the package's own kernels, which `contactlaw.emit` writes in JavaScript.
``explore.html`` and ``explore.js`` are the page. The page of the demo's rain draws with the
functions of ``drawing.js``, too.
"""

import dataclasses
import math
import os
import re
import shlex
from collections.abc import Sequence
from typing import NamedTuple

from contactlaw import _atomic, laws, style
from contactlaw._template import template
from contactlaw._version import VERSION
from contactlaw.emit import DOUBLE, JavaScript, Known, Program, add
from contactlaw.equation.numbers import Impact
from contactlaw.export import functions, page_functions
from contactlaw.export.c_header import models_of
from contactlaw.export.functions import FIXED, Bodies, bodies_of
from contactlaw.export.page_functions import Page
from contactlaw.model import ImpactModel
from contactlaw.physical.materials import Material, material, materials
from contactlaw.physical.scaling import constants_of
from contactlaw.physical.validity import Validity, explain

_CONSTANT = re.compile(r"^const (\$\w+) = (.*?);$\n*", re.MULTILINE | re.DOTALL)


class _Kernels(NamedTuple):
    """Kernels in JavaScript, and the names of the constants of a pair that they read."""

    names: tuple[str, ...]
    functions: str


def page(path: str | os.PathLike[str], model: ImpactModel | Sequence[ImpactModel]) -> None:
    """Write a page for a browser that answers for pairs of materials, without a network.

    It has sliders for speed, radius, thickness, mass, angle and friction. It shows curves of the
    COR, where the energy goes, the force over time, and which limits of the model are exceeded. It
    integrates the law.

    Parameters
    ----------
    path : path-like
        File to write, 0.12 MB and 0.03 to 0.06 MB for each further pair; an existing file is
        replaced.
    model : ImpactModel or sequence of ImpactModel
        Pair and law. For several, the page has a menu to choose one.

    Raises
    ------
    TypeError, ValueError
        If a model is not an ImpactModel, or if the sequence is empty.
    OSError
        If the file cannot be written; nothing is left behind then.

    Notes
    -----
    The answers are those of `ImpactModel.solve` and `ImpactModel.oblique`; for a pair whose
    strength grows with the rate of strain the COR is within 1e-6. Curves are within 3e-4.

    Examples
    --------
    >>> import contactlaw as cl
    >>> file = getfixture("tmp_path") / "page.html"
    >>> cl.export.page(file, cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    >>> file.stat().st_size < 1e6
    True
    """
    models = models_of(model)
    made = [_kernels(*_bodies(one)) for one in models]
    kernels = list(dict.fromkeys(one for one, _ in made))  # each once, for all its pairs
    text = template("contactlaw.export", "explore.html").render(
        version=VERSION,
        energies=style.ENERGIES,
        words={flag.value: explain(flag)[0] for flag in Validity if flag < Validity.CURVED_WALL},
        pairs=[_shown(one) for one in models],
        kernels=kernels,
        constants=[(kernels.index(one), constants) for one, constants in made],
    )
    _atomic.write(path, text.encode())


def _shown(model: ImpactModel) -> dict[str, float | str]:
    """Collect what the page says of a pair; options are empty if the command line cannot take the pair."""
    pair, law = model.pair, model.force_law
    registered, default = law.family in laws.names(), law.family == laws.DEFAULT
    bodies = ", ".join(_python(body) for body in pair.given)
    chosen = "" if default else f", law={law.family!r}" if registered else ", law=law"
    typed = [_typed(body) for body in pair.given]
    options = "--sphere {} --plate {}".format(*map(shlex.quote, typed))
    options += "" if default else f" --law {law.family}"
    return {
        "title": f"{pair.sphere.name} on {pair.plate.name}",
        "law": f"law {law.family}: {law.source}",
        "solid": constants_of(pair, law).mass,
        "python": f"model = cl.ImpactModel(cl.Pair({bodies}){chosen})\n",
        "options": options if registered and all(typed) else "",
    }


def _bodies(model: ImpactModel) -> tuple[Bodies, Page]:
    """Numbers of a pair."""
    pair = model.pair
    weaker = min(body.strength or math.inf for body in pair.bodies)
    flag = Validity.SLIDING_FLOW.value
    return bodies_of(model, None), Page(pair.effective_modulus, weaker, flag)


def _kernels(bodies: Bodies, page: Page) -> tuple[_Kernels, list[str]]:
    """Kernels of `page_functions` for a pair, and the values of its constants, in JavaScript."""
    program, pair = Program(JavaScript("$"), FIXED), Known(value=bodies)
    asked = program.struct(Impact, dict.fromkeys(Impact._fields, DOUBLE))
    _, hit = add(program, page_functions.for_curve, pair, asked)
    add(program, functions.exceeded, pair, hit, asked)
    add(program, page_functions.shown, pair, hit, asked)
    add(program, page_functions.collide, pair, Known(value=page), asked, DOUBLE, DOUBLE)
    text = program.text()
    names, values = zip(*_CONSTANT.findall(text), strict=True)
    return _Kernels(names, _CONSTANT.sub("", text)), list(values)


def _in_catalogue(body: Material) -> bool:
    return body.name in materials() and material(body.name) == body


def _typed(body: Material) -> str:
    """Write a material as the command line takes it; "" if it has numbers that no option takes."""
    if _in_catalogue(body):
        return body.name
    if body.hardening or body.rate or body.loss_factor:
        return ""
    fields = {
        "E": body.youngs_modulus,
        "nu": body.poissons_ratio,
        "rho": body.density,
        "yield": body.yield_strength,
        "hardness": body.hardness,
        "kind": body.kind,
    }
    return " ".join(f"{key}={value}" for key, value in fields.items() if value is not None)


def _python(body: Material) -> str:
    """Write a material as an expression in Python."""
    if _in_catalogue(body):
        return repr(body.name)
    return f"cl.{dataclasses.replace(body, source='', uncertainty={})!r}"

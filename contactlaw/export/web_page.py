"""A page with sliders for a browser; it answers for a pair of materials.

The page computes by the package's own kernels, which `contactlaw.emit` writes in JavaScript.
``explore.html`` and ``explore.js`` are the page. The page of the demo's rain draws with the
functions of ``drawing.js``, too.
"""

import dataclasses
import math
import os

from contactlaw import _atomic, laws, style
from contactlaw._template import template
from contactlaw._version import VERSION
from contactlaw.emit import DOUBLE, JavaScript, Known, Program, add
from contactlaw.equation.numbers import Impact
from contactlaw.export import functions, page_functions
from contactlaw.export.functions import FIXED, bodies_of
from contactlaw.export.page_functions import Page
from contactlaw.model import ImpactModel
from contactlaw.physical.materials import material, materials
from contactlaw.physical.scaling import constants_of
from contactlaw.physical.validity import Validity, explain


def page(path: str | os.PathLike[str], model: ImpactModel) -> None:
    """Write a page for a browser that answers for a pair of materials, without a network.

    It has sliders for speed, radius, thickness, mass, angle and friction. It shows curves of the
    COR, where the energy goes, the force over time, and which limits of the model are exceeded. It
    integrates the law.

    Parameters
    ----------
    path : path-like
        File to write, 0.12 MB; an existing file is replaced.
    model : ImpactModel
        Pair and law.

    Raises
    ------
    TypeError
        If the model is not an ImpactModel.
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
    if not isinstance(model, ImpactModel):
        raise TypeError(f"model: expected a contactlaw.ImpactModel, got {model!r}")
    pair, law = model.pair, model.force_law
    text = template("contactlaw.export", "explore.html").render(
        version=VERSION,
        energies=style.ENERGIES,
        words={flag.value: explain(flag)[0] for flag in Validity if flag < Validity.CURVED_WALL},
        title=f"{pair.sphere.name} on {pair.plate.name}",
        law=f"law {law.family}: {law.source}",
        solid=constants_of(pair, law).mass,
        python=_python(model),
        kernels=_kernels(model),
    )
    _atomic.write(path, text.encode())


def _python(model: ImpactModel) -> str:
    """Write a model as an expression in Python."""
    bodies = (
        repr(body.name)
        if body.name in materials() and material(body.name) == body
        else f"cl.{dataclasses.replace(body, source='', uncertainty={})!r}"
        for body in model.pair.given
    )
    family = model.force_law.family
    law = "" if family == laws.DEFAULT else f", law={family!r}" if family in laws.names() else ", law=law"
    return f"cl.ImpactModel(cl.Pair({', '.join(bodies)}){law})"


def _kernels(model: ImpactModel) -> str:
    """Write the kernels of `page_functions` for a model, in JavaScript."""
    weaker = min(body.strength or math.inf for body in model.pair.bodies)
    page = Page(model.pair.effective_modulus, weaker, Validity.SLIDING_FLOW.value)
    program, pair = Program(JavaScript("$"), FIXED), Known(value=bodies_of(model, None))
    asked = program.struct(Impact, dict.fromkeys(Impact._fields, DOUBLE))
    _, hit = add(program, page_functions.for_curve, pair, asked)
    add(program, functions.exceeded, pair, hit, asked)
    add(program, page_functions.shown, pair, hit, asked)
    add(program, page_functions.collide, pair, Known(value=page), asked, DOUBLE, DOUBLE)
    return program.text()

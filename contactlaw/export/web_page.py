"""One page of a pair of materials for a browser, with sliders; it integrates the law itself.

``impact.js`` has the equation, ``drawing.js`` what the pages of the demo draw with, too, and
``explore.js`` the page of ``explore.html``. Their constants are those of Python's modules.
"""

from __future__ import annotations

import dataclasses
import html
import json
import math
import os
import re
import shlex
import string
from importlib import resources
from typing import Any

import numpy as np

from contactlaw import _atomic, laws
from contactlaw._version import VERSION
from contactlaw.answers import solver
from contactlaw.answers.backend import SphereOnPlate
from contactlaw.answers.rated import Nodes, flow_of, stronger
from contactlaw.answers.tabulated import Border
from contactlaw.equation import corrections, force, integrator, tangential
from contactlaw.model import ImpactModel
from contactlaw.physical import oblique, validity
from contactlaw.physical.materials import Material, material, materials
from contactlaw.physical.rate import SHARE
from contactlaw.physical.scaling import sphere_on_plate, wave_path
from contactlaw.physical.validity import Validity, explain
from contactlaw.table import lookup, strengths

# Modules whose constants the scripts use; of a name in two of them the last one counts.
_MODULES = (lookup, oblique, validity, solver, tangential, integrator, corrections, force)
_CAPITALS = re.compile(r"\b_?[A-Z][A-Z_0-9]+\b")


def page(path: str | os.PathLike[str], model: ImpactModel) -> None:
    """Write a page for a browser that answers for a pair of materials, without a network.

    It has sliders for speed, radius, thickness, angle and friction, curves of the COR, where the
    energy goes, the force over time and flags. It integrates the law in JavaScript.

    Parameters
    ----------
    path : path-like
        File to write, below 1 MB, or 2 if two bodies' rates differ; an existing file is replaced.
    model : ImpactModel
        Pair and law.

    Raises
    ------
    TypeError
        If the model is no ImpactModel.
    OSError
        If the file cannot be written; nothing is left behind then.

    Notes
    -----
    The COR is within 1e-6 of `ImpactModel.solve`, the sliding speed within 2e-3 of friction times
    speed of `ImpactModel.oblique`. For a pair whose strength grows with the rate of strain the page
    has laws at some strengths: the COR is within 3e-5, or 2e-3 beyond the range of the law, and the
    sliding speed within 4e-3 of friction times speed.

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
    _atomic.write(path, _text(model).encode())


def _text(model: ImpactModel) -> str:
    """Fill the template."""
    pair, law = model.pair, model.force_law
    registered, default = law.family in laws.names(), law.family == laws.DEFAULT
    bodies = ", ".join(_python(body) for body in pair.given)
    chosen = "" if default else f", law={law.family!r}" if registered else ", law=law"
    typed = [_typed(body) for body in pair.given]
    options = "--sphere {} --plate {}".format(*map(shlex.quote, typed))
    numbers = _numbers(model) | {
        "python": f"model = cl.ImpactModel(cl.Pair({bodies}){chosen})\n",
        "options": options + ("" if default else f" --law {law.family}"),
    }
    return string.Template(_read("explore.html")).substitute(
        title=html.escape(f"{pair.sphere.name} on {pair.plate.name}"),
        made=f"contactlaw {VERSION}; law {html.escape(f'{law.family}: {law.source}')}",
        hidden="" if registered and all(typed) else " hidden",
        script=_script(numbers),
    )


def _numbers(model: ImpactModel) -> dict[str, Any]:
    """Numbers of a pair, for a bead of radius 1 m on a plate of 1 m."""
    pair, one = model.pair, np.ones(())
    contact = sphere_on_plate(pair, model.force_law, one, one)
    plate = contact.plate
    parts = {"corrections": plate.corrections._asdict(), "growth": plate.growth._asdict()}
    return _strengths(model._bodies) | {
        "plate": plate._asdict() | parts,
        "mass": contact.mass.item(),
        "stiffness": contact.stiffness.item(),
        "modulus": pair.effective_modulus,
        "strength": min(body.strength or math.inf for body in (pair.sphere, pair.plate)),
        "tangential_ratio": pair.tangential_ratio,
        "wave_path": wave_path(pair.plate),
        "words": {flag.value: explain(flag)[0] for flag in Validity},
        "SLIDING_FLOW": Validity.SLIDING_FLOW.value,
    }


def _at_strength(bodies: SphereOnPlate) -> dict[str, Any]:
    """Numbers that depend on the strengths."""
    law, one = bodies.law, np.ones(())
    contact = sphere_on_plate(bodies.pair, law, one, one)
    return {
        "law": law.data.tolist(),
        "limits": bodies.limits._asdict(),
        # a law that never yields has no scale of its own
        "scale": min(contact.yield_compression.item(), 1.0),
        "saturated": contact.plate.saturated,
        "returned": force.returned(law.data),
        "stiffening": force.stiffening(law.data),
    }


def _strengths(bodies: SphereOnPlate) -> dict[str, Any]:
    """Law of a pair, or of one with a rate of strain those at the nodes of its tables."""
    flow = flow_of(bodies)
    if flow is None:
        return {"nodes": [_at_strength(bodies)]}
    nodes = Nodes(bodies, None, Border("raise"))
    return {
        "slope": flow.rate,
        "share": SHARE / flow.rate0,
        "knots": nodes.knots,
        "places": strengths.PLACES,
        "nodes": [_at_strength(stronger(bodies, factor)) for factor in nodes.factors],
    }


def _script(numbers: dict[str, Any]) -> str:
    """Scripts of the page, and the constants of Python that they use."""
    drawing, impact, explore = map(_read, ("drawing.js", "impact.js", "explore.js"))
    found = {
        name: getattr(module, name)
        for module in _MODULES
        for name in _CAPITALS.findall(impact)
        if hasattr(module, name)
    }
    constants = ", ".join(f"{name} = {found[name]!r}" for name in sorted(found))
    # JavaScript reads what json writes for inf; the name of a material could end the script
    data = json.dumps(numbers, separators=(",", ":")).replace("<", "\\u003c")
    return f"{drawing}\nconst {constants};\nconst pair = {data};\n{impact}\n{explore}"


def _read(name: str) -> str:
    return resources.files("contactlaw.export").joinpath(name).read_text("utf-8")


def _in_catalogue(body: Material) -> bool:
    return body.name in materials() and material(body.name) == body


def _typed(body: Material) -> str:
    """Write a material as the commands take it; "" if it has numbers that they do not take."""
    if _in_catalogue(body):
        return body.name
    if body.hardening or body.rate or body.loss_factor:
        return ""
    fields = {
        "E": body.youngs_modulus, "nu": body.poissons_ratio, "rho": body.density,
        "yield": body.yield_strength, "hardness": body.hardness, "kind": body.kind,
    }  # fmt: skip
    return " ".join(f"{key}={value}" for key, value in fields.items() if value is not None)


def _python(body: Material) -> str:
    """Write a material as Python has it."""
    if _in_catalogue(body):
        return repr(body.name)
    return f"cl.{dataclasses.replace(body, source='', uncertainty={})!r}"

"""Errors of a rain as sentences for the user of the command line."""

from __future__ import annotations

import re

from contactlaw import ImpactModel
from contactlaw.answers.backend import OutsideTableError
from contactlaw.reporting.limits import label
from dem_demo.kit import disk
from dem_demo.rain.scene import Scene


def sentence(error: BaseException, scene: Scene, model: ImpactModel) -> str:
    """Say what went wrong, where, and what would help.

    Parameters
    ----------
    error : BaseException
        What was raised during the rain.
    scene : Scene
        Gives the sizes of the beads and plates, which are named beside their numbers.
    model : ImpactModel
        The model in use: its own law and `outside` are not proposed as remedies.
    """
    text = str(error) or type(error).__name__
    if isinstance(error, OSError):
        return disk.complaint(error)
    if isinstance(error, OutsideTableError):
        law, reason = model.force_law.family, error.reason
        text = f"outside the table of the law {law}, {reason}. {_remedies(model, reason)}"
    where = "; ".join(getattr(error, "__notes__", []))
    return f"{_with_sizes(where, scene)}: {text}" if where else text


def _remedies(model: ImpactModel, reason: str) -> str:
    offers = []
    if model.force_law.family != "fem":
        offers.append("--law fem, which is for metals, ceramics and glasses")
    if model.outside == "raise":
        offers.append("--outside solve, which integrates such impacts")
        offers.append("--outside clamp, which takes the value at the border and flags it")
    thin = "too thin" in reason
    offers.append("thicker plates (--plates)" if thin else "slower beads (--speed)")
    return f"Take {', or '.join(offers)}."


def _with_sizes(where: str, scene: Scene) -> str:
    def bead(found: re.Match[str]) -> str:
        return f"bead {found[1]} (radius {scene.beads.radius[int(found[1])] * 1e3:.3g} mm)"

    def plate(found: re.Match[str]) -> str:
        return f"plate {found[1]} ({label(scene.plates[int(found[1])].thickness)})"

    where = re.sub(r"\bbead (\d+)", bead, where.removeprefix("for "))
    return re.sub(r"\bplate (\d+)", plate, where)

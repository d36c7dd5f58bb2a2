"""Facts and texts of the sieve for its summary and its page."""

from __future__ import annotations

import math

from contactlaw.reporting.limits import label
from dem_demo.kit.runs import Run
from dem_demo.kit.tale import Facts, Tale
from dem_demo.sieve import figures
from dem_demo.sieve.measure import loss_by_openings, on_faces, passed
from dem_demo.sieve.scene import Sieve


def title(run: Run[Sieve]) -> tuple[str, str]:
    """Title in two lines: feed and deck; motion of the deck."""
    scene, deck = run.scene, run.scene.deck
    small, large = scene.radius.min() * 1e3, scene.radius.max() * 1e3
    return (
        f"{scene.radius.size} beads of {scene.sphere_material.name}, radius {small:g} and "
        f"{large:g} mm, on a deck of {label(scene.thickness)} {scene.plate_material.name}, "
        f"{deck.length * 1e3:.0f} x {deck.width * 1e3:.0f} mm, openings of {label(deck.opening)}, "
        f"{len(deck.triangles())} triangles",
        f"{scene.duration * scene.frequency:.3g} periods of {scene.frequency:g} Hz, amplitude {label(scene.amplitude)}",
    )


def _facts(run: Run[Sieve]) -> Facts:
    above = run.position[-1, :, 2] > -run.scene.amplitude
    height = float(run.position[-1, above, 2].mean()) * 1e3 if above.any() else 0.0
    # A constant COR does not depend on the openings, which leaves nothing to compare.
    more = loss_by_openings(run) if run.constant_cor is None else math.nan
    openings = ("impacts on its flat lose, by the openings", f"{more:+.1%}")
    return [
        *([] if math.isnan(more) else [openings]),
        ("mean height of beads on the deck", f"{height:.1f} mm"),
        ("undersize beads that have passed", f"{passed(run)[-1]:.1%}"),
    ]


TALE = Tale(
    wall="deck",
    flat=("on its flat, not at a rim or a wall", on_faces),
    own=_facts,
    title=title,
    figures=figures,
    page={
        "heading": "Beads on a vibrating sieve",
        "lede": "The deck is a mesh from an STL file. Under the law the rebound of each impact "
        "follows from speed, bead, plate and the nearest opening, as does where its energy goes. "
        "For comparison, the same feed with one coefficient of restitution (COR) for all impacts.",
        "alt": "A slice of the bed",
        "others": "; <code>deck.stl</code>",
    },
)

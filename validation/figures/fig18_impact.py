"""Fig. 18: one impact in full, 26 m/s on 0.5 mm of glass: the paper's Figs 11 to 13.

The largest plastic strain is 0.0392 (the paper has about 0.039). The force peaks 2 % higher than
that of the model and a tenth of a microsecond earlier; CalculiX, on elements of 0.03 R, has the
same peak within 0.2 %. The plate under the contact is deeper than
the model's mobility has it (crosses): by a quarter at 1 us, when bending has had little time, by
4 % at 3 us.
"""

from __future__ import annotations

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from validation import figures
from validation.fem import store
from validation.figures import _style
from validation.paper import RADIUS, model

PART = figures.FINITE_ELEMENTS


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw force, deflection, mesh and plastic strain."""
    data, made = store.read("paper")
    strain = float(data["largest_plastic_strain"])
    figure = _style.figure(
        13.0,
        9.0,
        "One impact in full: 26 m/s on 0.5 mm of glass",
        f"gamma-alumina sphere, R = 0.9 mm; largest plastic strain {strain:.4f} (paper: about "
        "0.039)",
    )
    (a, b), (c, d) = figure.subplots(2, 2)
    contact = model().force_history(made["speed"], RADIUS, made["thickness"])
    a.plot(
        data["time"] * 1e6, data["force"], color=_style.INK, linewidth=2, label="finite elements"
    )
    a.plot(
        contact.time * 1e6, contact.force, "--", color=_style.BLUE, linewidth=2,
        label="modified Zener model",
    )  # fmt: skip
    other = store.read("calculix_impact").data
    a.plot(
        other["time"][::8] * 1e6, other["force"][::8], "s", color=_style.INK, markersize=6,
        markerfacecolor="none", label="CalculiX",
    )  # fmt: skip
    a.set(xlabel="time  [µs]", ylabel="contact force  [N]")
    a.legend(loc="lower center")
    colours = _style.ORANGE, _style.GREEN, _style.VERMILION
    sunk = np.interp(data["snapshot_time"], contact.time, contact.plate_displacement)
    for at, way, deep, colour in zip(
        data["snapshot_time"], data["deflection"], sunk, colours, strict=True
    ):
        b.plot(data["r"] * 1e3, -way * 1e6, color=colour, linewidth=2, label=f"{at * 1e6:.0f} µs")
        b.plot(
            0.0,
            deep * 1e6,
            "X",
            color=colour,
            markersize=10,
            markeredgecolor=_style.INK,
            clip_on=False,
            zorder=3,
        )
    b.set_xlim(0.0, 6.0)
    b.invert_yaxis()
    b.set(xlabel="distance from the axis  [mm]", ylabel="deflection of the plate  [µm]")
    _style.key(
        b, "model, on the axis", "X", color=_style.PALE, markersize=10, markeredgecolor=_style.INK
    )
    b.legend(loc="lower right")
    corners = data["corners"] * 1e3
    corners[..., 1] -= corners[..., 1].min()
    mesh = PolyCollection(list(corners), linewidth=0.3, facecolor="white", edgecolor=_style.INK)
    quads = PolyCollection(list(corners), linewidth=0.3, cmap="cividis", edgecolor="face")
    quads.set_array(data["plastic_strain"])
    figure.colorbar(quads, ax=d, pad=0.01).set_label("equivalent plastic strain")
    for axes, drawn, title in (
        (c, mesh, "mesh of the sphere"),
        (d, quads, "plastic strain after separation"),
    ):
        axes.add_collection(drawn)
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set_title(title)
        axes.set(xlabel="distance from the axis  [mm]", ylabel="height  [mm]")
    c.set(xlim=(0.0, 1.4), ylim=(-0.02, 1.82))
    d.set(xlim=(0.0, 0.45), ylim=(0.0, 0.3))
    return figure, {
        "largest plastic strain": strain,
        "peak force, model over finite elements, less 1": float(
            contact.force.max() / data["force"].max() - 1.0
        ),
        "peak force, CalculiX over finite elements, less 1": float(
            other["force"].max() / data["force"].max() - 1.0
        ),
        **{
            f"deflection at {us} us, model over finite elements, less 1": float(
                sunk[n] / -data["deflection"][n, 0] - 1.0
            )
            for n, us in ((0, 1), (2, 3))
        },
    }

"""Plates that are no bare sheet of one material: lined, ribbed, of wood, curved, on a foundation.

A thin plate answers a force F with the speed alpha F, alpha = 1/(8 sqrt(D m)), with D its bending
stiffness and m its mass per area. So `Layers` and `Orthotropic` are numbers: the thickness of a
plate of the contact's material that answers with the same speed. They go wherever a thickness
goes. From a `Foundation` and from the curvature of a `Shell` something comes back later, as from an
edge; such impacts are integrated, see `contactlaw.physical.responses`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import ByValue, Places
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import BARE, number, positive
from contactlaw.physical.materials import Material, resolve

SHELLS = "cylinder", "sphere"
SHEETS = BARE | {np.ndarray}  # types of thicknesses that describe no other plate
ATTRIBUTES = "areal", "bending", "membrane", "alike", "top", "pitch"
_DIRECTIONS = 4096  # of the mean over direction: exact to rounding up to Dx/Dy of 1e6


class EquivalentThickness(float):
    """Thickness [m] of a plate of one material with the mobility of another plate.

    Attributes
    ----------
    material : Material
        That of the contact, which is the plate of the model's pair.
    areal : float
        Mass per area [kg/m2].
    bending : float
        Bending stiffness D [N m]; of an orthotropic plate that of the isotropic one that answers
        alike.
    membrane : float
        Sum of Young's moduli times thicknesses [N/m], by which a shell is stiff.
    alike : float
        Modulus of the softest layer over that of the stiffest one.
    top : float
        Thickness of the layer that the bead touches [m]; inf if it is the only one.
    pitch : float
        Distance of ribs or waves [m]; 0 without.
    """

    material: Material
    areal: float
    bending: float
    membrane: float
    alike: float = 1.0
    top: float = math.inf
    pitch: float = 0.0
    given: tuple[Any, ...]

    def _described(self, given: tuple[Any, ...], body: Material, mass: float, bending: float, membrane: float) -> None:
        self.given, self.material = given, body
        self.areal, self.bending, self.membrane = mass, bending, membrane

    def __getnewargs__(self) -> tuple[Any, ...]:
        # pickle makes it again from these
        return self.given

    def __repr__(self) -> str:
        body, *numbers = self.given
        if isinstance(self, Layers):
            return f"Layers({[(one.name, thick) for one, thick in body]})"
        return f"Orthotropic({', '.join(map(repr, (body.name, *numbers)))})"


def _equivalent(body: Material, mass: float, bending: float) -> float:
    """Thickness [m] of a plate of this material with the mobility 1/(8 sqrt(D m))."""
    return math.sqrt(2.0 * math.sqrt(3.0 * bending * mass / (body.density * body.plane_modulus)))


class Layers(EquivalentThickness):
    """A plate of layers that are bonded: lined, coated, clad, laminated.

    It bends about its neutral plane, with E/(1 - nu^2) of each layer. The contact has the material
    of the top layer, which has to be the plate of the model's pair. As a number it is the thickness
    of a plate of that material that answers a force with the same speed.

    Parameters
    ----------
    layers : sequence of (Material or str, float)
        Material and thickness [m] of each layer, from the one that beads touch.

    Raises
    ------
    ValueError
        No layer, an unknown material, or a thickness that is not positive and finite.

    Examples
    --------
    >>> import contactlaw as cl
    >>> clad = cl.Layers([("stainless-steel-304", 1e-3), ("aluminium-6061-t6", 4e-3)])
    >>> round(float(clad), 5), round(clad.areal, 1)
    (0.00357, 18.8)
    >>> model = cl.ImpactModel(cl.Pair("glass", "stainless-steel-304"))
    >>> round(model.restitution(3.0, 1e-3, clad), 3)
    0.582
    """

    layers: tuple[tuple[Material, float], ...]

    def __new__(cls, layers: Sequence[tuple[Material | str, float]]) -> Layers:
        """Bend the layers about their neutral plane."""
        if isinstance(layers, str) or not isinstance(layers, Sequence) or not layers:
            raise ArgumentError("layers", layers, 'expected pairs as [("rubber", 6e-3), (steel, 3e-3)]')
        found = tuple(_layer(one) for one in layers)
        bodies = [(body.plane_modulus, body.density, body.youngs_modulus, thick) for body, thick in found]
        plane, density, youngs, h = np.array(bodies).T
        middle, stiff = np.cumsum(h) - 0.5 * h, plane * h
        arm = middle - (stiff @ middle) / stiff.sum()  # from the neutral plane
        bending, mass, membrane = float(stiff @ (h * h / 12.0 + arm * arm)), float(density @ h), float(youngs @ h)
        top, thick = found[0]
        alone = len(found) == 1
        self = super().__new__(cls, thick if alone else _equivalent(top, mass, bending))
        self._described((found,), top, mass, bending, membrane)
        self.layers, self.top = found, math.inf if alone else thick
        self.alike = float(plane.min() / plane.max())
        return self


def _layer(given: Any) -> tuple[Material, float]:
    """Check one layer."""
    try:
        body, thick = given
    except (TypeError, ValueError):
        raise ArgumentError("layers", given, "expected a material and a thickness [m]") from None
    return resolve("layers", body), positive("layers", thick, "m")


class Orthotropic(EquivalentThickness):
    """A plate that is stiffer along than across: wood, fibres, fine ribs or waves.

    A bead does not feel directions one by one: the plate answers with the mean of 1/sqrt(D) over
    all of them, D = Dx c^4 + 2 Dxy c^2 s^2 + Dy s^4.

    Parameters
    ----------
    contact : Material or str
        Material of the contact, the plate of the model's pair.
    along, across : float
        Bending stiffnesses Dx and Dy [N m].
    twist : float
        Dxy = nu_y Dx + 2 Dk [N m], with Dk = G H^3/12; above -sqrt(Dx Dy).
    mass : float
        Mass per area [kg/m2].
    pitch : float, optional
        Distance of ribs or waves [m]: a bead sees them one by one if it is above a quarter of the
        length of the bending wave, which `Validity.RIBS` flags.

    Raises
    ------
    ValueError
        Stiffnesses that are not positive definite, or a mass that is not positive.

    Examples
    --------
    >>> import contactlaw as cl
    >>> steel = cl.material("stainless-steel-304")
    >>> d = steel.plane_modulus * 1e-9 / 12
    >>> round(float(cl.Orthotropic(steel, d, d, d, mass=steel.density * 1e-3)), 9)
    0.001
    """

    def __new__(
        cls, contact: Material | str, along: float, across: float, twist: float, mass: float, pitch: float = 0.0
    ) -> Orthotropic:
        """Take the mean over all directions."""
        x, y, k = (number(*one) for one in (("along", along), ("across", across), ("twist", twist)))
        m, p = positive("mass", mass, "kg/m2"), number("pitch", pitch)
        if not (1e-200 <= min(x, y) <= max(x, y, k) <= 1e200 and -math.sqrt(x) * math.sqrt(y) < k):
            reason = "must be positive, up to 1e200, and twist above -sqrt(along across) [N m]: else no load bends it"
            raise ArgumentError("along, across, twist", (x, y, k), reason)
        if not 0.0 <= p < math.inf:
            raise ArgumentError("pitch", p, "must be 0 or more [m]")
        angle = np.arange(_DIRECTIONS) * (math.pi / _DIRECTIONS)
        c, s = np.cos(angle) ** 2, np.sin(angle) ** 2
        bending = float(np.mean((x * c * c + 2.0 * k * c * s + y * s * s) ** -0.5)) ** -2
        body = resolve("contact", contact)
        self = super().__new__(cls, _equivalent(body, m, bending))
        # of the isotropic plate that answers alike
        self._described((body, x, y, k, m, p), body, m, bending, math.nan)
        self.pitch = p
        return self

    @classmethod
    def perforated(cls, contact: Material | str, thickness: float, open_area: float, pitch: float = 0.0) -> Orthotropic:
        """Describe a sheet with round holes in a triangular or square pattern.

        A hole bends 2/(1 - nu) times as much as the thin sheet around it, or 4/(3 + nu) times into a
        saddle (Goodier, Phil. Mag. 22 (1936) 69). Each of many holes sees the mean of the sheet
        between them (Mori & Tanaka, Acta Metall. 21 (1973) 571).

        Parameters
        ----------
        contact : Material or str
            Material of the sheet.
        thickness : float
            Its thickness [m].
        open_area : float
            Share of the holes in its area [-], at most 0.5.
        pitch : float, optional
            Distance of the holes [m], as in `Orthotropic`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> sheet = cl.Orthotropic.perforated("stainless-steel-304", 1e-3, open_area=0.3)
        >>> model = cl.ImpactModel(cl.Pair("glass", "stainless-steel-304"))
        >>> model.solve(2.0, 1e-3, [sheet, 1e-3]).restitution.round(2)
        array([0.52, 0.56])
        """
        body, h = resolve("contact", contact), positive("thickness", thickness, "m")
        share, nu = number("open_area", open_area), body.poissons_ratio
        if not 0.0 <= share <= 0.5:
            raise ArgumentError("open_area", share, "must lie between 0 and 0.5: a share of the area")
        left = 1.0 - share
        dish, saddle = (left / (left + share * more) for more in (2.0 / (1.0 - nu), 4.0 / (3.0 + nu)))
        bending = body.plane_modulus * h**3 / 24.0 * ((1.0 + nu) * dish + (1.0 - nu) * saddle)
        return cls(body, bending, bending, bending, left * body.density * h, pitch)


@dataclass(frozen=True, eq=False)
class Foundation(ByValue):
    """A plate that lies on an elastic foundation: on rubber, glued to foam, on a bed of springs.

    Parameters
    ----------
    thickness : array_like
        Of the plate [m], also `Layers` or `Orthotropic`.
    stiffness : array_like
        Pressure per deflection [N/m3], of a mat E/t; 0 is none.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> model.solve(5.0, 0.9e-3, cl.Foundation(0.5e-3, [0.0, 1e12])).restitution.round(3)
    array([0.666, 0.855])
    """

    thickness: ArrayLike
    stiffness: ArrayLike


@dataclass(frozen=True, eq=False)
class Shell(ByValue):
    """A wall that is curved: a pipe, a drum, a bowl, a dome.

    Its curvature makes it stiff, so that it swings back, and R* in the contact is made of both
    radii, as on the walls of simulations, see `contactlaw.walls.Cylinder`.

    Parameters
    ----------
    thickness : array_like
        Of the wall [m], also `Layers`.
    radius : array_like
        Radius of the wall [m], positive where the bead is inside, negative where it hits from
        outside; larger than the bead's; ``inf`` is flat.
    kind : {"cylinder", "sphere"}, optional
        What is curved.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> model.solve(5.0, 0.9e-3, cl.Shell(0.5e-3, [0.01, -0.01], "sphere")).restitution.round(3)
    array([0.742, 0.753])
    """

    thickness: ArrayLike
    radius: ArrayLike
    kind: str = "cylinder"


Thickness = ArrayLike | Foundation | Shell
"""What goes for a thickness [m]; `Layers` and `Orthotropic` are numbers."""


@dataclass(frozen=True)
class Wall:
    """A plate as impacts have it: numbers, or arrays that can be broadcast, by name."""

    numbers: dict[str, Any]
    kind: str = ""  # of the response that comes back; none of a flat plate that lies on nothing

    def part(self, some: Places) -> Wall:
        """Plates of some of the impacts."""
        return replace(self, numbers={name: values[some] for name, values in self.numbers.items()})


def wall_of(thickness: Any) -> Wall:
    """Read what a user gave for a thickness; bare numbers have NaN for what only other plates have."""
    if isinstance(thickness, Wall):
        return thickness
    kind, more = "", {}
    if isinstance(thickness, Foundation):
        kind, more, thickness = "sphere", {"stiffness": thickness.stiffness}, thickness.thickness
    elif isinstance(thickness, Shell):
        if thickness.kind not in SHELLS:
            raise ArgumentError("kind", thickness.kind, f"must be one of {', '.join(SHELLS)}")
        kind, more, thickness = thickness.kind, {"wall_radius": thickness.radius}, thickness.thickness
    if any(True for _ in described(thickness)):
        more |= {name: _attribute(thickness, name) for name in ATTRIBUTES}
    return Wall({"thickness": thickness, **more}, kind)


def sheet_of(thickness: Any) -> Any:
    """Thickness of the sheet alone, of one that swings back."""
    return thickness.thickness if isinstance(thickness, Foundation | Shell) else thickness


def described(thickness: Any) -> Iterator[EquivalentThickness]:
    """Plates among a thickness or a list of them that are no bare numbers."""
    if isinstance(thickness, EquivalentThickness):
        yield thickness
    elif isinstance(thickness, list | tuple):
        for one in thickness:
            yield from described(one)


def _attribute(thickness: Any, name: str) -> Any:
    if isinstance(thickness, list | tuple):
        return [_attribute(one, name) for one in thickness]
    return getattr(thickness, name) if isinstance(thickness, EquivalentThickness) else math.nan


def check_wall(thickness: Any, model: Any, edges: Any) -> None:
    """Refuse a wall whose contact material is not the model's, and edges of any but bare sheets."""
    if sheet_of(thickness) is thickness and next(described(thickness), None) is None:
        return
    if edges is not None:
        raise ArgumentError("edges", edges, "only bare sheets have edges in engines: leave them out")
    if hasattr(model, "pair"):
        check_contact(thickness, model.pair.given[1])


def check_contact(thickness: Any, plate: Material) -> None:
    """Refuse another material of the contact than that of the model's plate."""
    if type(thickness) in SHEETS:
        return
    for touched in described(sheet_of(thickness)):
        body = touched.material
        if body != plate:
            reason = f"beads touch {body.name!r}, and the plate of the model's pair is {plate.name!r}"
            raise ArgumentError("thickness", thickness, f"{reason}: make the pair with {body.name!r}")

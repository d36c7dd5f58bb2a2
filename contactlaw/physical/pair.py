"""Two materials in contact: the sphere's and the plate's."""

import cmath
import math

from contactlaw.laws.myc import C_YIELD
from contactlaw.physical.materials import Material, resolve


class Pair:
    """Material of the sphere and material of the plate.

    Parameters
    ----------
    sphere, plate : Material or str
        Materials, or names from the catalogue (see `contactlaw.materials`). A body can yield if it
        has a yield strength and the law provides for it: in most laws only the sphere yields. If
        both have a loss factor, the plate's is carried to the frequency of the sphere's.

    Raises
    ------
    ValueError
        If a name is not in the catalogue.
    TypeError
        If an argument is neither a Material nor a name.

    Examples
    --------
    >>> import contactlaw as cl
    >>> pair = cl.Pair("gamma-alumina", "glass")
    >>> round(pair.yield_speed, 3)
    7.43
    """

    __slots__ = ("bodies", "given", "plate", "sphere")

    sphere: Material
    plate: Material
    bodies: tuple[Material, Material]  # sphere and plate
    given: tuple[Material, Material]  # before the plate's modulus was carried

    def __init__(self, sphere: Material | str, plate: Material | str) -> None:
        self.sphere = resolve("sphere", sphere)
        self.plate = resolve("plate", plate)
        self.given = self.sphere, self.plate
        if self.sphere.loss_factor and self.plate.loss_factor:
            self.plate = self.plate.at_frequency(self.sphere.loss_factor[1])
        self.bodies = self.sphere, self.plate

    def __repr__(self) -> str:
        return f"Pair({self.sphere.name!r}, {self.plate.name!r})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Pair):
            return NotImplemented
        return self.bodies == other.bodies

    def __hash__(self) -> int:
        return hash(self.bodies)

    @property
    def effective_modulus(self) -> float:
        """E* [Pa]: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (Johnson 1985, Eq. 4.20)."""
        return 1.0 / (1.0 / self.sphere.plane_modulus + 1.0 / self.plate.plane_modulus)

    @property
    def effective_shear_modulus(self) -> float:
        """G* [Pa]: 1/G* = (2 - nu1)/G1 + (2 - nu2)/G2, G = E/(2 (1 + nu)) (Johnson 1985, Eq. 7.43).

        A contact of radius a has the tangential stiffness 8 G* a.
        """
        compliance = sum(
            (2.0 - one.poissons_ratio) * 2.0 * (1.0 + one.poissons_ratio) / one.youngs_modulus for one in self.bodies
        )
        return 1.0 / compliance

    @property
    def tangential_ratio(self) -> float:
        """Stiffness of a contact along the surface over that across it, 4 G*/E* [-].

        From 2/3 to 4/3; 2 (1 - nu)/(2 - nu) for bodies of one material (Johnson 1985, section 7.3).

        Examples
        --------
        >>> import contactlaw as cl
        >>> round(cl.Pair("glass", "glass").tangential_ratio, 3)
        0.883
        """
        return 4.0 * self.effective_shear_modulus / self.effective_modulus

    @property
    def loss_factor(self) -> float:
        """Loss factor tan delta of a contact [-]: the bodies' compliances, complex, add up.

        Examples
        --------
        >>> import contactlaw as cl
        >>> bead = cl.Material("bead", 3e9, 0.35, 1200, loss_factor=(0.1, 1e4))
        >>> round(cl.Pair(bead, "glass").loss_factor, 4), round(cl.Pair(bead, bead).loss_factor, 4)
        (0.0957, 0.1)
        """
        compliance = sum(cmath.exp(-1j * one.loss_angle) / one.plane_modulus for one in self.bodies)
        return -compliance.imag / compliance.real

    @property
    def frequency(self) -> float | None:
        """Frequency at which the moduli are known [Hz]; None for bodies without losses."""
        lossy = self.sphere.loss_factor or self.plate.loss_factor
        return lossy[1] if lossy else None

    @property
    def yield_speed(self) -> float:
        """Speed V_Y0 [m/s] from which one of the bodies yields, on a half-space.

        That is 0.552 sqrt(pi^4 sigma_Y^5/(rho1 E*^4)) (Peng et al. 2021, Eq. 4), whatever the
        radius, with the yield compression of the MYC law and the weaker body's strength. A thinner
        plate gives way: see `ImpactModel.yield_speed`. ``inf`` if neither has a yield strength.
        """
        share = self.yield_share()
        if math.isinf(share):
            return math.inf
        # V_Y0^2 = (4/5) K dY^2.5/m with K = (4/3) E* R^0.5, m = (4/3) pi rho1 R^3
        energy = 0.8 * self.effective_modulus * share**2.5  # per (4/3) R^3
        return math.sqrt(energy / (math.pi * self.sphere.density))

    def yield_share(self, coefficient: float = C_YIELD, strength: float | None = None) -> float:
        """Yield compression over R of the body that yields first; ``inf`` if neither does.

        Parameters
        ----------
        coefficient : float, optional
            Factor of pi^2 (sigma_Y/E*)^2; by default that of law MYC (Peng et al. 2021, Eq. 18).
        strength : float, optional
            sigma_Y [Pa]; by default that of the weaker body.

        Examples
        --------
        >>> import contactlaw as cl
        >>> round(cl.Pair("gamma-alumina", "glass").yield_share(), 5)
        0.01248
        """
        if strength is None:
            strength = min(body.strength or math.inf for body in self.bodies)
        return coefficient * (math.pi * strength / self.effective_modulus) ** 2

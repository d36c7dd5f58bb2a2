"""The COR of a model as fast functions: for Python, for loops of numba, for C."""

import functools
import math
from collections.abc import Callable
from typing import Any

import numba

from contactlaw import _jit
from contactlaw._arrays import Array
from contactlaw._jit import in_memory, kernel
from contactlaw.answers import edges
from contactlaw.answers.beads import Beads, Other
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.edge import Edge
from contactlaw.equation.numbers import share_of_solid
from contactlaw.physical.arguments import scalars
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import check_kind
from contactlaw.table import lookup


class Compiled:
    """Functions that engines call once per collision, made for one model."""

    _bodies: SphereOnPlate
    _tabulated: TableLookup
    _beads: Callable[[Other], Beads]  # impacts of the pair's sphere on another

    def curve(self, radius: float, thickness: float, mass: float | None = None) -> Callable[[float], float]:
        """COR of one bead class on one plate, as a fast function of speed.

        Parameters
        ----------
        radius, thickness, mass : float
            As in `restitution`.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.curve(radius=0.9e-3, thickness=1e-3)(5.0), 4)
        0.8966
        """
        scalars(radius=radius, thickness=thickness, **({} if mass is None else {"mass": mass}))
        return self._tabulated.curve(self._bodies.given(1.0, radius, thickness, mass=mass))

    def sphere_sphere_curve(self, radius: float, other_radius: float, other: Other = None) -> Callable[[float], float]:
        """COR of the pair's sphere and another one, as a fast function of approach speed.

        Parameters
        ----------
        radius, other_radius : float
            Radii of the beads [m].
        other : Material or str, optional
            Material of the other bead, without it that of the pair's sphere.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.sphere_sphere_curve(1e-3, 1e-3)(20.0), 4)
        0.9616
        """
        return self._beads(other).curve(radius, other_radius)

    @functools.cached_property
    def kernel(self) -> Callable[..., float]:
        """COR as a numba-jitted ``f(speed, radius, thickness)`` for loops of your own [m/s, m, m].

        A fourth number may be the mass [kg], as in `restitution`.

        It reads this model's table as `restitution` does for three floats, but cannot raise (a
        raise would make a parallel loop serial): bad input and an impact outside the table give
        NaN, whatever `outside` says. Test for it with ``e != e``. Numba does not keep a caller of
        it on disk (``cache=True`` has no effect but a NumbaWarning), since the machine code
        contains the address of the table.

        Examples
        --------
        >>> import contactlaw as cl, numba
        >>> cor = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")).kernel
        >>> @numba.njit
        ... def rebound_speeds(speed, radius, thickness):
        ...     return [cor(v, radius, thickness) * v for v in speed]
        >>> [round(u, 3) for u in rebound_speeds((1.0, 5.0), 0.9e-3, 1e-3)]
        [0.925, 4.483]
        """
        return _jitted(self._tabulated.packed, self._bodies)

    def edge_kernel(self, edge: Edge = "free") -> Callable[..., float]:
        """COR near an edge as a numba-jitted ``f(speed, radius, thickness, edge_distance)``.

        A fifth number may be the mass [kg], as in `restitution`.
        As `kernel`, but it integrates the equation, within 1e-3 of `solve`: 10 to 15 us per
        impact, longer where a sphere stays on a plate that recedes.

        Parameters
        ----------
        edge : {"free", "supported", "clamped"}, optional
            As in `restitution`.

        Raises
        ------
        ValueError
            If there is no such kind of edge.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.edge_kernel("free")(2.0, 0.9e-3, 0.5e-3, 1e-3), 3)
        0.592
        """
        check_kind(edge)
        if edge not in self._edge_kernels:  # of two threads' kernels the first one stays
            made = edges.kernel_near(self._tabulated.bodies, edge)
            self._edge_kernels.setdefault(edge, made)
        return self._edge_kernels[edge]

    @functools.cached_property
    def _edge_kernels(self) -> dict[str, Callable[..., float]]:
        return {}

    @functools.cached_property
    def _c_function(self) -> Any:
        signature = numba.float64(numba.float64, numba.float64, numba.float64)
        on_plate, packed = lookup.solid_on_plate, in_memory(self._tabulated.packed)
        return _jit.c_function(signature, lambda v, r, h: on_plate(packed(), v, r, h))

    @property
    def address(self) -> int:
        """Address of a C function ``double f(double speed, double radius, double thickness)``.

        For engines in C and C++: `kernel` behind a plain function pointer, valid as long as this
        model lives, callable from any thread. It gives NaN where `kernel` does.

        Examples
        --------
        >>> import contactlaw as cl, ctypes
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> double = ctypes.c_double
        >>> f = ctypes.CFUNCTYPE(double, double, double, double)(model.address)
        >>> round(f(5.0, 0.9e-3, 1e-3), 4)
        0.8966
        """
        return int(self._c_function.address)


def _jitted(table: Array, bodies: SphereOnPlate) -> Callable[..., float]:
    """COR as a jitted function of speed, radius, thickness and mass, which belongs to one table."""
    on_plate, packed, density = lookup.restitution_on_plate, in_memory(table), bodies.constants.mass

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float, mass: float = math.inf) -> float:
        share = share_of_solid(density, radius, mass)
        return on_plate(packed(), speed, radius, thickness, share)

    return cor

"""The COR of a model as fast functions: for Python, for loops of numba, for C."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from contactlaw import _jit
from contactlaw._jit import in_memory, kernel
from contactlaw.answers import edges
from contactlaw.answers.beads import Beads, Other
from contactlaw.answers.tabulated import Tabulated
from contactlaw.equation.edge import Edge
from contactlaw.physical.arguments import scalars
from contactlaw.physical.impacts import Impacts, check_kind
from contactlaw.table import lookup


class Compiled:
    """Functions that engines call once per collision, made for one model."""

    _tabulated: Tabulated
    _beads: Callable[[Other], Beads]  # impacts of the pair's sphere on another

    def curve(self, radius: float, thickness: float) -> Callable[[float], float]:
        """COR of one bead class on one plate, as a fast function of speed.

        Parameters
        ----------
        radius, thickness : float
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
        r, h = scalars(radius=radius, thickness=thickness)
        return self._tabulated.curve(Impacts(np.ones(1), r, h, None))

    def sphere_sphere_curve(
        self, radius: float, other_radius: float, other: Other = None
    ) -> Callable[[float], float]:
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
    def kernel(self) -> Callable[[float, float, float], float]:
        """COR as a numba-jitted ``f(speed, radius, thickness)`` for loops of your own [m/s, m, m].

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
        return _jitted(self._tabulated.packed)

    def edge_kernel(self, edge: Edge = "free") -> Callable[[float, float, float, float], float]:
        """COR near an edge as a numba-jitted ``f(speed, radius, thickness, edge_distance)``.

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
    def _edge_kernels(self) -> dict[str, Callable[[float, float, float, float], float]]:
        return {}

    @functools.cached_property
    def _c_function(self) -> Any:
        signature = numba.float64(numba.float64, numba.float64, numba.float64)
        return _jit.c_function(signature, getattr(self.kernel, "py_func", self.kernel))

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


def _jitted(table: NDArray[np.float64]) -> Callable[[float, float, float], float]:
    """COR as a jitted function of speed, radius and thickness, which belongs to one table."""
    on_plate, packed = lookup.solid_on_plate, in_memory(table)

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float) -> float:
        return on_plate(packed(), speed, radius, thickness)

    return cor

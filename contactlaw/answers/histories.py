"""Answers over time: force, compression and the plate's displacement during contacts."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import Backend
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.edge import Edge
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.impacts import check_finite
from contactlaw.physical.plates import Thickness


class Histories:
    """Contacts of one model over time."""

    _tabulated: TableLookup

    def force_history(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        samples: int = 256,
        method: Literal["table", "solve"] = "table",
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> ForceHistory:
        """Force, compression, impulse and displacement of the plate over contacts.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.
        samples : int, optional
            Number of even times from first touch to separation, at least 2.
        method : {"table", "solve"}, optional
            Interpolate shapes of contacts in the table, or integrate the equation.
        edge, edge_distance, hole_radius, mass
            As in `restitution`.

        Returns
        -------
        ForceHistory
            Arrays with the samples along the last axis, and flags. By ``"table"`` within 1e-3 of
            the peak force of those by ``"solve"``.

        Raises
        ------
        ValueError
            As in `restitution`; too few samples, or an unknown method.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> contact = model.force_history(speed=12.0, radius=0.9e-3, thickness=1e-3, samples=5)
        >>> contact.force.round(1)
        array([ 0. , 16.9, 28.2, 15.1,  0. ])
        """
        if not (isinstance(samples, int | np.integer) and 2 <= samples <= 1_000_000):
            raise ArgumentError("samples", samples, "must be an integer from 2 to 1 000 000")
        if method not in ("table", "solve"):
            raise ArgumentError("method", method, "must be 'table' or 'solve'")
        bodies = self._tabulated.bodies
        by: Backend = self._tabulated if method == "table" else Solver(bodies)
        impacts = bodies.given(speed, radius, thickness, edge, edge_distance, hole_radius, mass, memory=True)
        found = by.histories(impacts, samples)
        check_finite(bodies.pair, impacts, *(np.ravel(one.sum(axis=-1)) for one in found))
        return found

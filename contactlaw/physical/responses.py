"""How thin plates remember: the rates and weights that `contactlaw.equation.edge` takes.

Near edges they are fitted by `validation.derivations.edges`. A plate on a foundation k and a sphere
of radius a swing: the displacement under F is alpha times the integral of F(t') J0(w0 (t - t')),
w0 = sqrt(k/(rho2 H)) or c/a, c = sqrt(E2/rho2). A cylinder has the mean of J0(w0 cos^2(phi)
(t - t')) over all directions. `validation.derivations.walls` fits these up to w0 t = `REACH`, to
2e-5 and 4e-5; their unit of time tau is 1/w0. All are kept in a file beside this module.
"""

import functools
import json
from importlib.resources import files
from typing import Any, Literal

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation.edge import KINDS, SIZE

REACH = 60.0  # w0 T up to which the response of curved walls and foundations was fitted


@functools.cache
def _fitted() -> Any:
    """Rates and weights; of a free edge for the shares s/(s + a) of holes of radius a, too."""
    return json.loads(files("contactlaw.physical").joinpath("responses.json").read_text())


@functools.cache
def _table(kind: str, poissons_ratio: float, size: str) -> tuple[Array, Array]:
    """Rates, four for each block, and weights, for all shares."""
    sizes = _fitted()["responses"][kind]
    one = sizes.get(size, sizes["equation"])
    p, second, turn = np.moveaxis(np.array(one["rates"]), -1, 0)
    rates = np.stack([p, second, turn, np.where(turn > 0.0, turn, second)], axis=-1)
    powers = poissons_ratio ** np.arange(np.shape(one["weights"])[2])
    weights = np.array(one["weights"]) @ powers
    if size not in sizes:
        weights[:, 0] += 1e-4  # a bead that lies near a held edge comes to rest in steps
    return rates, weights


def response_of(
    kind: str, poissons_ratio: float, share: Any = 0.0, size: Literal["equation", "steps"] = "equation"
) -> Array:
    """Responses in units of tau, in parts of `SIZE`: two, or of curved walls in steps one.

    Kinds are those of edges, "sphere" and "cylinder".
    `share` is s/(s + a) near the rim of a hole of radius a, and 0 near a straight edge.
    """
    rates, weights = _table(kind, poissons_ratio, size)
    shares, given = np.array(_fitted()["shares"]), np.asarray(share, float)
    if kind == "free":  # a hole without radius is none
        weights = np.vstack([weights, np.zeros_like(weights[:1])])
        each = np.stack([np.interp(given, shares, column) for column in weights.T], axis=-1)
    else:
        each = np.broadcast_to(weights[0], (*given.shape, weights.shape[1]))
    rates = np.broadcast_to(rates, (*given.shape, *rates.shape[-2:])).reshape(*given.shape, -1, 12)
    parts = np.concatenate([rates, each.reshape(*given.shape, -1, 6)], axis=-1)
    return np.ascontiguousarray(parts.reshape(*given.shape, -1))


RIMS = np.array(_fitted()["shares"][1:-1])  # of the responses near rims that steps choose from
SPHERE = len(KINDS) + len(RIMS)  # places of the curved walls
CYLINDER = SPHERE + 1
RESPONSES = CYLINDER + 1


def responses_of(poissons_ratio: float) -> Array:
    """Responses in steps: near a straight edge of each kind, near rims of holes, of curved walls."""
    straight = [response_of(kind, poissons_ratio, size="steps") for kind in KINDS]
    curved = [np.pad(response_of(kind, poissons_ratio, size="steps"), (0, SIZE)) for kind in ("sphere", "cylinder")]
    return np.array([*straight, *response_of("free", poissons_ratio, RIMS, "steps"), *curved])

"""From the campaign of finite elements to the numbers of the law ``"fem"``.

``python -m validation.fem fit`` reads the stored campaign and writes ``contactlaw/laws/fem.json``.
Every step is linear least squares, two steps of Newton's from a start that is near, or a search for
one number, so that it gives the same numbers on every machine.
"""

from __future__ import annotations

import copy
import dataclasses
import functools
import json
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

import contactlaw as cl
from contactlaw.equation import zener
from contactlaw.equation.corrections import SATURATION
from contactlaw.equation.numbers import Impact, Numbers
from contactlaw.equation.outcome import Solution
from contactlaw.laws import Law, fem
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.law import pair_numbers
from validation.fem import cases, store
from validation.fem.campaign import SAMPLES, YIELDING

Array = NDArray[np.float64]

FILE = Path(fem.__file__).with_name("fem.json")
Size = tuple[int, int]
Blocks = list[tuple[str, Size]]
Tables = list[tuple[tuple[str, str], Size]]  # by the body that yields, and the term
# Numbers of powers of t and w in a function, and in its changes with moduli and Poisson's ratio
STATIC = (5, 4), (4, 2), (3, 1)
IMPACT = (5, 4), (4, 3), (2, 2)
_IMPACT_RIDGE = 2e-4  # with less, v oscillates at deep contacts, of which there are few
# Weights in the fit of v: more for the paper's kind, whose bound is narrower; less for the
# campaign, most of which is far from everyday impacts
_WEIGHTS_OF = {"matrix": 8.0, "pairs": 8.0, "strengths": 8.0, "campaign_impact": 0.5}
_RAISED = 0.01  # step of v/t^2 in the derivative of the COR
_MOST_PLASTIC = 0.98  # plastic work over the loss; more is noise of small losses
_BEYOND_YIELD, _LEAST = 1.05, 0.1  # least root of d/d_Y, and least COR, in the fit
_THINNEST = 1.85  # R/H
_WEIGHTS = 0.002, 0.005, 0.007  # errors of COR, contact time and peak force of equal weight
_ELASTIC = 1e-4  # plastic share of an impact that counts as elastic
_FORCE_ALONE = math.inf, math.inf, 0.007
_SLENDER = 0.4  # R/H from which on a plate is thin
_FAST, _WEAK = 60.0, 0.3  # [m/s], COR: the law is not made for faster or less elastic impacts
_START = 0.8, -0.65, 0.12, 0.3, 2.0, 0.002, 0.05, 0.0  # first guess of the search in `elastic`
_RIDGE = 1e-4  # keeps coefficients small that the data do not determine
_WELL_MESHED = 0.6  # root of compression over the largest, from which a loading curve is used


class Pressed(NamedTuple):
    """One indentation, in terms of the law's functions."""

    q: float  # root of the largest compression over d_Y
    w: float  # root of the largest compression over R
    force: float  # over Hertz's
    recovery: float  # unloading work over loading work
    plastic: float  # plastic work over loading work
    residual: float  # over the largest compression
    path: Array  # (n, 3): q, w and force over Hertz's while loading


def presses(data: dict[str, Array], **chosen: Any) -> Iterator[tuple[int, float]]:
    """Find indentations with some inputs: their indices, and E*/sigma_Y of the weaker body."""
    wanted = {"friction": 0.1, "slowness": 1.0, **chosen}
    for n in range(data["depth"].size):
        if all(math.isclose(data[name][n], value) for name, value in wanted.items()):
            strains = data["sphere_yield_strain"][n], data["plate_yield_strain"][n]
            finite = [float(strain) for strain in strains if strain > 0.0]
            yield n, 1.0 / min(finite) if finite else 0.0


def read(data: dict[str, Array], n: int, ratio: float) -> Pressed:
    """Take one indentation from the campaign."""
    depth, unit = float(data["depth"][n]), fem.yield_scale(ratio, data["poissons_ratio"][n])
    share = np.linspace(0.0, 1.0, SAMPLES)
    used = share >= _WELL_MESHED
    d = share[used] ** 2 * depth
    path = np.column_stack([np.sqrt(d / unit), np.sqrt(d), data["loading"][n][used] / d**1.5])
    return Pressed(
        q=math.sqrt(depth / unit),
        w=math.sqrt(depth),
        force=float(data["force"][n]) / depth**1.5,
        recovery=float(data["unloading_work"][n] / data["loading_work"][n]),
        plastic=float(data["plastic_work"][n] / data["loading_work"][n]),
        residual=_residual(data, n),
        path=path,
    )


def _residual(data: dict[str, Array], n: int) -> float:
    """Residual over the largest compression, of the power law fitted to the unloading curve.

    The power law has the unloading work. The end of unloading itself is sampled too coarsely.
    """
    depth, left, top = (float(data[name][n]) for name in ("depth", "residual", "force"))
    d = left + np.linspace(0.0, 1.0, SAMPLES) * (depth - left)
    f = data["unloading"][n] / top
    work = float(data["unloading_work"][n]) / (top * depth)
    used = f > 0.05

    def off(residual: float) -> float:
        exponent = (1.0 - residual) / work - 1.0
        q = np.maximum(d[used] / depth - residual, 0.0) / (1.0 - residual)
        return float(((q**exponent - f[used]) ** 2).sum())

    most = min(1.3 * left / depth + 0.02, 0.999)
    return float(minimize_scalar(off, bounds=(0.0, most), method="bounded").x)


def stiffening(data: dict[str, Array]) -> tuple[list[float], float]:
    """Fit s = c0 + c1 E1'/(E1' + E2'), and phi, to indentations that yield nowhere."""
    rows, values, lost = [], [], []
    for share in np.unique(data["share"]):
        for friction in (0.0, 0.1):
            for n, ratio in presses(data, share=float(share), friction=friction, across=11.0):
                if ratio == 0.0:
                    root = math.sqrt(data["depth"][n])
                    rows.append([root, root * share])
                    values.append(data["force"][n] / root**3 - 1.0)
                    back = float(data["unloading_work"][n] / data["loading_work"][n])
                    lost.append((friction, 1.0 - back))
    found = np.linalg.lstsq(np.array(rows), np.array(values), rcond=None)[0]
    means = [np.mean([loss for f, loss in lost if f == friction]) for friction in (0.0, 0.1)]
    return found.tolist(), float(means[1] - means[0])


def case(data: dict[str, Array], yielding: str, stiff: list[float], friction: float) -> dict[str, Any]:
    """Fit the functions of one case: g, h, k and the plastic share."""
    chosen, moduli, ratios = [], [], []
    for n, ratio in presses(data):
        strains = data["sphere_yield_strain"][n], data["plate_yield_strain"][n]
        if not (ratio and np.allclose(strains, _strains(yielding, ratio))):
            continue
        one = read(data, n, ratio)
        if one.q > _BEYOND_YIELD:
            chosen.append(one)
            moduli.append(float(data["share"][n]))
            ratios.append(float(data["poissons_ratio"][n]))
    share, nu = np.array(moduli), np.array(ratios)
    q, w, recovery, plastic, residual = (
        np.array([getattr(one, name) for one in chosen]) for name in ("q", "w", "recovery", "plastic", "residual")
    )
    own = share if yielding != "plate" else 1.0 - share  # share of the body that yields
    path = np.concatenate([one.path for one in chosen])
    count = len(chosen[0].path)
    on, nus, shares = (np.repeat(values, count) for values in (own, nu, share))
    used = path[:, 0] > 1.0
    elastic = 1.0 + (stiff[0] + stiff[1] * shares) * path[:, 1]
    loss = 1.0 - recovery / (1.0 - friction)
    moved = yielding != "both"
    return {
        "loading": _fit(path[used, 0], path[used, 1], on[used], nus[used], (elastic / path[:, 2])[used], moved),
        "recovery": _fit(q, w, own, nu, (1.0 - friction) / recovery, moved),
        "residual": _fit(q, w, own, nu, 1.0 / (1.0 - residual), moved),
        "plastic": _least_squares(
            _basis(q, w, own, nu, _blocks(moved, *STATIC)),
            -np.log1p(-np.minimum(plastic / loss, _MOST_PLASTIC)),
            np.sqrt(loss) * np.maximum(1.0 - plastic / loss, 1.0 - _MOST_PLASTIC),
            moved,
        ),
    }


def _strains(yielding: str, ratio: float) -> tuple[float, float]:
    return (1.0 / ratio if yielding != "plate" else 0.0, 1.0 / ratio if yielding != "sphere" else 0.0)


def _blocks(moved: bool, *sizes: Size) -> Blocks:
    """Name the tables of powers; "both" has the usual one only."""
    names = ("usual", "share", "poissons_ratio")
    return list(zip(names, sizes, strict=True))[: 3 if moved else 1]


def _basis(q: Array, w: Array, share: Array, nu: Array, blocks: Blocks) -> Array:
    """Powers of t and w; those again times what the moduli and Poisson's ratio differ by."""
    t = (q - 1.0) / (q + fem.SHIFT)
    factors = {"usual": np.ones_like(q), "share": (1.0 - t) * (share - 0.5), "poissons_ratio": nu - 0.3}
    return np.concatenate(
        [
            np.polynomial.polynomial.polyvander2d(t, 2.0 * w, [n - 1, m - 1]) * factors[name][:, None]
            for name, (n, m) in blocks
        ],
        axis=1,
    )


def _fit(q: Array, w: Array, share: Array, nu: Array, over: Array, moved: bool) -> Any:
    """Powers of which `over` is 1 + (q - 1) t (their sum), weighted by 1/over."""
    rise = (q - 1.0) ** 2 / (q + fem.SHIFT)
    basis = _basis(q, w, share, nu, _blocks(moved, *STATIC))
    return _least_squares(basis, (over - 1.0) / rise, rise / over, moved)


def _least_squares(basis: Array, values: Array, weights: Array, moved: bool) -> Any:
    rows, right = basis * weights[:, None], values * weights
    return _ridge(rows, right, _RIDGE, _blocks(moved, *STATIC))


def _ridge(rows: Array, right: Array, ridge: float, blocks: Sequence[tuple[Any, Size]]) -> Any:
    """Solve for coefficients; tables of powers of t and w, eight digits each."""
    count = rows.shape[1]
    system = np.vstack([rows / math.sqrt(len(right)), ridge * np.eye(count)])
    known = np.append(right / math.sqrt(len(right)), np.zeros(count))
    found = np.linalg.lstsq(system, known, rcond=None)[0]
    parts, at = {}, 0
    for name, (n, m) in blocks:
        powers = found[at : at + n * m].reshape(n, m) * 2.0 ** np.arange(m)
        parts[name] = [[float(f"{x:.8g}") for x in row] for row in powers]
        at += n * m
    return parts


class Blow(NamedTuple):
    """One impact by finite elements, and what the law takes from its pair."""

    pair: cl.Pair
    given: fem.Given
    speed: float
    radius: float
    thickness: float
    restitution: float
    contact_time: float
    peak_force: float
    plastic: float
    weight: float  # weight of its row in the fit of v


def blows() -> list[Blow]:
    """Read the impacts of the campaign and of the studies before it, except on plates too thin."""
    listed = []
    for study in (
        "campaign_impact",
        "everyday",
        "everyday_2",
        "everyday_3",
        "everyday_4",
        "matrix",
        "pairs",
        "strengths",
        "limits",
    ):
        data = store.read(study).data
        for n in range(data["speed"].size):
            row = {name: values[n] for name, values in data.items()}
            pair = pair_of(row)
            blow = Blow(
                pair,
                numbers_of(pair),
                float(row["speed"]),
                float(row["radius"]),
                float(row["thickness"]),
                float(row["restitution"]),
                float(row["contact_time"]),
                float(row["peak_force"]),
                float(row["plastic"]),
                _WEIGHTS_OF.get(study, 1.0),
            )
            if blow.radius <= _THINNEST * blow.thickness:
                listed.append(blow)
    return listed


def pair_of(row: dict[str, Any]) -> cl.Pair:
    """Materials of an impact; those that did not yield have no strength."""
    yields = row["yields"], row.get("plate_yields", False)
    bodies = [cases.material(str(row[name])) for name in ("sphere", "plate")]
    return cl.Pair(
        *(
            body if may else dataclasses.replace(body, yield_strength=None)
            for body, may in zip(bodies, yields, strict=True)
        )
    )


def numbers_of(pair: cl.Pair) -> fem.Given:
    """Numbers that the law takes from a pair."""
    found = pair_numbers(pair, "fem")
    return fem.Given(**{n: float(f"{found[n]:.6g}") for n in fem.PARAMETERS if n in found})


def solved(blow: Blow, law: Law) -> tuple[Solution, Numbers]:
    """Impact by a law, and its units."""
    units = SphereOnPlate(blow.pair, law).numbers(Impact(blow.speed, blow.radius, blow.thickness))
    lam, y = float(units.inelasticity), float(units.yield_ratio)
    return zener.solve(law.data, lam, y, 1e-8), units


def elastic(found: dict[str, Any], measured: list[Blow]) -> dict[str, Any]:
    """Fit the stiffening of sphere and plate, and the loss to friction, to elastic impacts.

    A flying sphere is compressed by its own inertia, and is stiffer than a hemisphere whose equator
    is driven. The peak forces of impacts with plastic flow on thin plates are fitted too: these
    plates stiffen a contact as wide as they are thick.
    """
    listed = []
    for blow in measured:
        if blow.speed < _FAST and blow.restitution > _WEAK:
            if blow.plastic < _ELASTIC:
                given = blow.given._replace(sphere_ratio=0.0, plate_ratio=0.0)
                listed.append((blow._replace(given=given), np.array(_WEIGHTS)))
            elif blow.radius > _SLENDER * blow.thickness:
                listed.append((blow, np.array(_FORCE_ALONE)))

    def named(x: Array) -> dict[str, Any]:
        constant, slope, *plate, none, second, third = x.tolist()
        powers = [none, 0.0, second, third]
        changed = {"stiffening": [constant, slope], "plate": [*plate, 0.0], "friction": powers}
        return {**found, **changed}

    def off(x: Array) -> Array:
        rows, law_of = [], functools.cache(functools.partial(fem.law_of, found=named(x)))
        for blow, errors in listed:
            one, units = solved(blow, law_of(blow.given))
            ours = one.restitution, one.contact_time * units.time, one.peak_force * units.force
            theirs = blow.restitution, blow.contact_time, blow.peak_force
            rows.append((np.array(ours) / np.array(theirs) - 1.0) / errors)
        return np.concatenate(rows)

    # nearly linear: two steps of Newton's from a start that is near
    x = np.array(_START)
    for _ in range(2):
        here = off(x)
        slopes = np.column_stack([(off(x + step) - here) / 1e-3 for step in 1e-3 * np.eye(x.size)])
        x = x - np.linalg.lstsq(slopes, here, rcond=None)[0]
    return named(np.array([float(f"{value:.6g}") for value in x]))


def in_impacts(found: dict[str, Any], measured: list[Blow]) -> dict[str, Any]:
    """Fit v, the loss of impacts beyond that of slow contacts, and b_p; twice, as both change it.

    Each impact is a row of a linear system: the error of its COR by the law, and the derivatives of
    its COR with respect to the powers in v and to b_p. Errors of COR count as in `acceptance`.
    """
    tables: Tables = [((name, part), size) for name in YIELDING for part, size in _blocks(name != "both", *IMPACT)]
    tables += [(("any", "vibration"), (1, 1)), (("plate", "beyond"), (1, 1))]
    for _ in range(2):
        moved = {**found, "curves": {**found["curves"], "impact": _raised(found)}}
        law_of, other = (functools.cache(functools.partial(fem.law_of, found=one)) for one in (found, moved))
        rows, missing = [], []
        for blow in measured:
            if not blow.given.ratio or blow.speed > _FAST or blow.restitution < _LEAST:
                continue
            law = law_of(blow.given)
            one, units = solved(blow, law)
            lam, y = float(units.inelasticity), float(units.yield_ratio)
            q = math.sqrt(one.peak_compression / y)
            if q < _BEYOND_YIELD:
                continue
            unit = max(blow.restitution, _WEAK) / blow.weight
            v = float(fem.Curves(blow.given, found).impact(np.array([q]))[0])
            slope = (solved(blow, other(blow.given))[0].restitution - one.restitution) / _RAISED
            t = (q - 1.0) / (q + fem.SHIFT)  # v is raised by t^2, and slope is per t^2
            row = slope * _powers(blow.given, q, float(found["blend"]), tables)
            less = zener.solve(law.data, lam + _RAISED, y, 1e-8).restitution - one.restitution
            x, most = (math.sqrt(units.compression / blow.radius), SATURATION * math.sqrt(law.scale or 0.0))
            wide = blow.radius / blow.thickness * blow.given.modulus_share * max(x - most, 0.0)
            row[-1] = wide * less / _RAISED
            already = slope * v / t**2 + row[-1] * found["plate"][-1]
            rows.append(row / unit)
            missing.append((blow.restitution - one.restitution + already) / unit)
        solution = _ridge(np.array(rows), np.array(missing), _IMPACT_RIDGE, tables)
        parts: dict[str, Any] = {}
        for (name, part), table in solution.items():
            parts.setdefault(name, {})[part] = table
        (beyond,) = parts["plate"].pop("beyond")
        found = {**found, "plate": found["plate"][:-1] + beyond, "curves": {**found["curves"], "impact": parts}}
    return found


def _raised(found: dict[str, Any]) -> dict[str, Any]:
    """Tables of v + _RAISED t^2."""
    raised: dict[str, Any] = copy.deepcopy(found["curves"]["impact"])
    for name in YIELDING:
        raised[name]["usual"][0][0] += _RAISED
    return raised


def _powers(given: fem.Given, q: float, blend: float, tables: Tables) -> Array:
    """List what each power of each table adds to v/t^2."""
    weights = given.weights(blend)
    w = q * math.sqrt(given.yield_scale(blend))
    t = (q - 1.0) / (q + fem.SHIFT)
    return np.concatenate(
        [
            np.polynomial.polynomial.polyvander2d(t, 2.0 * w, [n - 1, m - 1]).ravel()
            * (weights.get(table, 0.0) * (1.0 - t if table[1] == "share" else 1.0))
            for table, (n, m) in tables
        ]
    )


def blend(data: dict[str, Array], found: dict[str, Any]) -> float:
    """Fit how the share of "both" falls with the ratio of the strengths."""
    mixed = []
    for n, ratio in presses(data):
        strains = [data[f"{body}_yield_strain"][n] for body in ("sphere", "plate")]
        if min(strains) > 0.0 and strains[0] != strains[1]:
            given = fem.Given(1.0 / strains[0], 1.0 / strains[1], 0.5, 0.3, 0.3)
            mixed.append((given, read(data, n, ratio)))

    def off(power: float) -> float:
        total = 0.0
        for given, one in mixed:
            curves, q = fem.Curves(given, {**found, "blend": power}), np.array([one.q])
            total += math.log(curves.recovery(q)[0] / one.recovery) ** 2
        return total

    return float(minimize_scalar(off, bounds=(1.0, 8.0), method="bounded").x)


def numbers() -> dict[str, Any]:
    """Compute all numbers of the law from the stored campaign."""
    data = store.read("campaign_indentation").data
    stiff, friction = stiffening(data)
    cases_ = {name: case(data, name, stiff, friction) for name in YIELDING}
    curves = {name: {one: cases_[one][name] for one in YIELDING} for name in cases_["sphere"]}
    none = {"usual": [[0.0]]}
    found: dict[str, Any] = {
        "stiffening": stiff,
        "friction": [friction],
        "blend": 1.0,
        # fitted by `metals` and `viscoelastic`, and too slow to be found with the rest
        **{name: fem.fitted()[name] for name in ("strain", "rate", "losses", "pressure")},
        "stiffest": 1.0,  # its limit was set afterwards, by the study `stiff_spheres`
        "plate": [0.0, 0.0, 0.0, 0.0],
        "curves": {**curves, "impact": dict.fromkeys(YIELDING, none)},
    }
    found["blend"] = float(f"{blend(data, found):.3g}")
    measured = blows()
    return {**in_impacts(elastic(found, measured), measured), "stiffest": fem.fitted()["stiffest"]}


def text_of(numbers: dict[str, Any]) -> str:
    """Write numbers as JSON, with each row of a table on one line."""
    row = re.compile(r"\[([^][{}]*)\]")
    return row.sub(lambda found: f"[{' '.join(found[1].split())}]", json.dumps(numbers, indent=1)) + "\n"


def run(_: int) -> None:
    """Write the numbers that the package ships."""
    FILE.write_text(text_of(numbers()), "utf-8")

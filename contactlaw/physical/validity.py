"""Where an answer may be trusted, and what the bodies may suffer."""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Integers
from contactlaw._jit import kernel
from contactlaw.laws import Law
from contactlaw.laws.fem import ALONE, RATIOS, Given, comparable
from contactlaw.physical.arguments import broadcast, check, shaped
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import REACH, flow_with_rate, largest_factor, strengthened
from contactlaw.physical.scaling import wave_path, yield_share
from contactlaw.physical.strengths import without_curves

SLENDER = 1.8  # R/H; Peng et al. 2021, section 4.4 and Fig. 8: H >= 0.556 R
_SLENDER_FEM = 5.8  # R/H for "fem"; TARGETS of `validation.accuracy.acceptance` has its errors
# How much stiffer than the other a body is that flows, and a sphere that flows alone: from there on
# the COR is up to 7 % off (of 0.3, if it is lower). A sphere 3 times as stiff as the plate is within
# 2 %, one 4 to 7 times as stiff up to 6 % too high (`bodies_wide` of `validation.fem.bodies`).
_STIFFEST, _STIFFEST_SPHERE = 12.0, 3.5
# V0/V_Y0 from which on yield matters; our choice, between the 1.5 and 3.5 of our finite elements
_WELL_YIELDED = 2.0
_FASTEST = 7.0  # V0/V_Y0; Peng et al. 2021, section 4.1: their finite elements reach no further
_SWIFTEST = 0.0131  # V0/sqrt(E*/rho1), 50 m/s for steel: up to there "fem" was fitted to impacts
_REACH = 2.66  # of edges [sqrt(b t)], see `edge_distance`
TRANSITS = 6.0  # contact time over H/c_L; Koller & Kolsky 1987 and Boettcher et al. 2017: 6 to 8
_BENDING = 0.6  # F/(sigma_Y H^2): 0.35 is within 2 % of our finite elements, 0.85 is not
# E*/sigma_Y from which on flow is complete in contacts so wide; our choice, between the 26 and 155
# of finite elements that are right, and wrong, beyond `_BENDING` with the strength of the sphere.
_COMPLETE = 55.0
_SOFTEST = 3000.0  # E*/sigma_Y; beyond 2000, where its campaign ends, "fem" goes by similarity
_HARDENED = 0.035  # d/R of bodies that harden, up to which the COR is within 3 % of finite elements
# Largest pressure over the hardness at which a brittle body begins to flow: 1.65 H/2.8, since flow
# begins at a mean pressure of 1.1 sigma_Y and is complete at 2.8 (Kharaz & Gorham 2000).
_FLOW = 1.65 / 2.8
# Least mass over that of a solid sphere at which hollow ones are as accurate as those: their COR is
# within 0.005 of finite elements from 0.95 on, within 0.06 from 0.65 on (`validation.fem.hollow`).
_HOLLOW = 0.95
_HEAVY = 3.05  # the largest that was tried, of dense cores
# Largest change of R* on a curved wall; our choice: up to there it adds an error of 0.012 to the COR
# (`validation.fem.curved`). Across a cylinder the geometric mean of the two radii makes Hertz's force
# 0.2 % too low there, by the exact one of an ellipse (Johnson 1985, 4.2).
_CURVED = 0.16
# Least thickness of a top layer over the radius of the contact, and least modulus of one layer over
# that of another: from there on the COR is within 0.01 of finite elements (`validation.fem.layers`).
_LINER, _ALIKE = 3.0, 0.2
_HARDNESS = 3.0  # largest mean pressure that a body bears over its yield strength (Tabor 1951)


class Validity(enum.IntFlag):
    """Limits that an impact exceeds; 0 if it exceeds none.

    All but `DAMAGE` are limits of the answer's accuracy; `ACCURACY` combines those. What the model
    leaves out altogether (adhesion, heating) raises no flag, nor does a metal without a rate of
    strain, which its material may have: at 1e4 per second steels are about a third stronger than in
    the tensile test that the catalogue quotes, and so yield at twice the speed. `explain` puts
    flags into words.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> model.lookup(speed=5.0, radius=0.9e-3, thickness=0.3e-3).flags
    <Validity.THIN_PLATE: 1>
    """

    THIN_PLATE = 1
    """The plate is thinner than R/1.8, for "fem" than R/5.8: its deflection is no longer small."""
    FAST_IMPACT = 2
    """Faster than the impacts that the law was checked for: 7 times the yield speed, for "fem"
    0.0131 sqrt(E*/rho1), 50 m/s for steel."""
    THICK_PLATE = 4
    """The contact ends before a pressure wave has crossed the plate 6 times; the law's is thin."""
    SOFT_PLATE = 8
    """The plate is weaker than the sphere and yields first; in this law only the sphere yields."""
    CLAMPED = 16
    """Outside the table: the value is that of its border."""
    OTHER_LAW = 32
    """Another law is nearer to finite elements here: "fem" for any pair."""
    DEEP_CONTACT = 64
    """Compression over radius is above that of the finite elements that the law is made from, or above
    0.035 where a body hardens."""
    BENT_PLATE = 128
    """The force bends the plate plastically; in the law it stays elastic except at the contact. Or a
    sphere has flowed until its contact is half as wide as the plate is thick."""
    RATE_DEPENDENT = 256
    """A body is a polymer, or of unknown kind and as soft and light as one, without a loss factor
    that the law takes: it loses energy by viscosity, and its modulus depends on the rate."""
    DAMAGE = 512
    """A brittle body may break or flow: the pressure is above 0.59 of its hardness."""
    UNTRIED_STRENGTH = 1024
    """A body yields whose E*/sigma_Y lies outside 11 to 3000, the range of "fem", or which is more
    than 12 times as stiff as the other, a sphere that yields alone more than 3.5 times."""
    SLIDING_FLOW = 2048
    """Friction makes a yielding body flow along the surface, which changes the normal motion, too.
    Of oblique impacts: from mu p = 0.5 sigma_Y or a slide of 0.3 a on, with p the mean pressure and
    a the radius of the contact at the largest force, or where the product of mu p/sigma_Y and
    slide/a is above 0.02."""

    FROM_HARDNESS = 4096
    """A metal yields whose strength is known from its hardness alone: it is that at 8 % of strain,
    above that at which flow begins, so that the COR is an upper bound."""

    NEAR_EDGE = 8192
    """Nearer to an edge than is described: the plate's thickness, or two radii of the contact."""
    STRIKES_AGAIN = 16384
    """The plate comes back and hits the sphere again, or recedes before it; the values are those of
    the first strike."""

    NOT_SOLID = 32768
    """Lighter than 0.95 of a solid sphere: a hollow one, which gives way as a whole. Or heavier
    than 3 of them, which was not tried."""

    CURVED_WALL = 65536
    """R* on a curved wall differs from the bead's radius by more than 16 %: inside a
    cylinder of less than 4 radii or a sphere of less than 7, say."""
    SHARED_PLATE = 131072
    """In a record of LAMMPS or `WallContacts`: another bead hits the plate too, or its bending
    wave passes. In the model each bead has the plate to itself."""

    COUPLED = 262144
    """In a simulation: friction has changed the normal motion of a rigid body by more than 2 % of the
    energy of its approach. The COR is that of the motion, and not of the contact."""

    LINER = 524288
    """The layer that a bead touches is thinner than 3 radii of the contact, or a layer is more than
    five times as stiff as another."""

    RIBS = 1048576
    """Ribs or waves are farther apart than a quarter of the length of the bending wave: a bead
    meets them one by one."""

    ACCURACY = 2096639
    """All limits of accuracy."""


# For each flag: which limit is exceeded; what to do about it, and by how much the COR is wrong in
# the finite elements of `validation`, where that is known. Errors are absolute.
_WORDS = {
    Validity.THIN_PLATE: (
        "plate thinner than R/1.8 (law fem: R/5.8), its deflection is not small",
        "take the values for estimates, by law myc the COR is up to 0.03 too high at R/2.5, by law "
        "fem the error is not known",
    ),
    Validity.FAST_IMPACT: (
        "faster than the impacts that the law was checked for",
        "take the values for estimates, the COR is up to 0.03 too low or too high",
    ),
    Validity.THICK_PLATE: (
        "too short for the plate to bend, the law's plate is thin",
        "take law fem, by law myc the COR is 0.02 too low to 0.07 too high",
    ),
    Validity.SOFT_PLATE: (
        "the plate yields first, the law has the sphere yield",
        "take law fem, by law myc the COR is up to 0.05 too high, and from twice the yield speed "
        "on 0.16 too low to 0.48 too high",
    ),
    Validity.CLAMPED: (
        "outside the table, the value is that of its border",
        "integrate there: the COR is too high by an unknown amount",
    ),
    Validity.OTHER_LAW: (
        "finite elements favour another law for these materials",
        "take law fem, by law myc the COR is up to 0.24 too low, or 0.15 too high for a sphere of "
        "a modulus below 20 strengths",
    ),
    Validity.DEEP_CONTACT: (
        "compressed deeper than the finite elements that the law is made of",
        "take the values for estimates, the COR is 0.07 too low to 0.05 too high",
    ),
    Validity.BENT_PLATE: (
        "the plate bends plastically, a loss that the law does not have, or the contact is half as wide "
        "as the plate is thick",
        "take a thicker plate, or the COR for an upper bound, up to 0.03 too high",
    ),
    Validity.RATE_DEPENDENT: (
        "a polymer, or a body as soft and light as one, whose loss factor the law does not have",
        "give law fem its loss factor, and its modulus at the frequency of the impact, or its kind "
        "if it is no polymer; the COR is too high by an unknown amount if no body flows, else too high or "
        "too low",
    ),
    Validity.DAMAGE: ("a brittle body may break or flow", "the values are for one that stays whole"),
    Validity.UNTRIED_STRENGTH: (
        "a body yields that is weaker or stronger for its stiffness than the finite elements that "
        "the law is made of, or more than 12 times as stiff as the other, or 3.5 times if it is the sphere alone",
        "take the values for estimates: of one much stiffer the COR is 0.04 too low to 0.02 too high, of "
        "other strengths the error is not known",
    ),
    Validity.SLIDING_FLOW: (
        "friction makes a body flow along the surface",
        "take the values for estimates: the COR is up to 5 % too high",
    ),
    Validity.FROM_HARDNESS: (
        "a metal yields whose strength is that at 8 % of strain, from its hardness",
        "take the COR for an upper bound, an unknown amount too high; give the exponent of hardening",
    ),
    Validity.NEAR_EDGE: (
        "nearer to an edge than the plate is thick or two contacts are wide",
        "take the values for estimates: so near, the theory of thin plates does not hold",
    ),
    Validity.STRIKES_AGAIN: (
        "the plate comes back and strikes the sphere again",
        "the values are those of the first strike",
    ),
    Validity.NOT_SOLID: (
        "lighter than a solid sphere, and if hollow giving way as a whole, or heavier than three",
        "take the COR of a hollow one for a lower bound, up to 0.06 too low, its peak force for an "
        "upper bound, up to 15 % too high; of heavier ones the error is not known",
    ),
    Validity.CURVED_WALL: (
        "a wall so round beside the bead that R* differs by more than 16 %",
        "take the values for estimates, the COR is up to 0.06 too high where the wall is hollow, 0.04 "
        "too low where it bulges",
    ),
    Validity.COUPLED: (
        "a rigid body whose normal motion friction has changed",
        "take the energies, which hold; the COR is not that of the contact",
    ),
    Validity.SHARED_PLATE: (
        "the plate moves from the impact of another bead, too",
        "take the values for estimates, with w the wave's share of the energy the COR is up to w/(1 + COR) "
        "too low if the other bead is on the other side, as much too high if it is on the same one",
    ),
    Validity.LINER: (
        "the layer that beads touch is thinner than 3 radii of the contact, or one is five times as stiff as another",
        "take the values for estimates: on a soft liner the COR is 0.02 too low to 0.02 too high, of rubber up to 0.1 "
        "too low (with law hertz 0.02 too high), and up to 0.09 too high if it is thin; on a stiff layer over a soft "
        "one, or a soft core, up to 0.13 too high",
    ),
    Validity.RIBS: (
        "ribs or waves farther apart than a quarter of the bending wave's length",
        "take the sheet between the ribs, and the ribs, for two plates; the COR is between theirs",
    ),
}


def explain(flags: int) -> tuple[str, ...]:
    """Say which limits some flags stand for, what to do, and how wrong the COR is if it is known.

    Examples
    --------
    >>> from contactlaw import Validity, explain
    >>> explain(Validity.DAMAGE)
    ('a brittle body may break or flow: the values are for one that stays whole',)
    """
    return tuple(": ".join(words) for flag, words in _WORDS.items() if flags & flag)


def limits_in_words(flags: int) -> tuple[str, ...]:
    """Say which limits some flags stand for, without the advice, where room is scarce.

    Examples
    --------
    >>> limits_in_words(Validity.DAMAGE)
    ('a brittle body may break or flow',)
    """
    return tuple(limit for flag, (limit, _) in _WORDS.items() if flags & flag)


def count_flags(flags: Integers) -> dict[Validity, int]:
    """Count the impacts beyond each limit; limits that none exceeds are left out.

    Examples
    --------
    >>> count_flags(np.array([0, 2, 6]))
    {<Validity.FAST_IMPACT: 2>: 2, <Validity.THICK_PLATE: 4>: 1}
    """
    counted = {limit: int(np.count_nonzero(flags & limit)) for limit in Validity}
    return {limit: count for limit, count in counted.items() if count}


class Limits(NamedTuple):
    """Limits of a pair and its law, for kernels; of several strengths an array has rows of them."""

    slender: float  # R/H beyond which THIN_PLATE is raised
    slowness: float  # of the pressure wave in the plate [s/m]; 0 where no plate is too thick
    always: int  # flags of every impact
    flags_when_yielded: int  # flags of an impact below `least_yield_ratio`
    least_yield_ratio: float  # d_Y/(V0 T_H) of the weaker body, below which they are raised
    fastest: float  # d_Y/(V0 T_H) below which FAST_IMPACT is raised; 0: none is too fast
    swiftest: float  # V0 T_H over R beyond which FAST_IMPACT is raised, too
    share: float  # d_Y/R of the weaker body; inf if none yields
    deepest: float  # compression over R beyond which DEEP_CONTACT is raised
    bending: float  # force over H^2 beyond which BENT_PLATE is raised [Pa]
    damage: float  # force over R^2 beyond which DAMAGE is raised [Pa]
    on_yield: int  # flags of an impact in which a body yields


def limits(pair: Pair, law: Law) -> Limits:
    """Limits of the model for a pair."""
    sphere, plate = strengths = [body.strength or math.inf for body in pair.bodies]
    taken = bool(law.parameters.get("loss_factor"))  # whether the law has the pair's losses
    unknown = any(body.is_polymer and not (taken and body.loss_factor) for body in pair.bodies)
    rate = unknown * Validity.RATE_DEPENDENT
    flowing = [body for body in pair.bodies if min(strengths) > ALONE * (body.strength or math.inf)]
    bound = any(body.strength_from_hardness and body.hardening is None for body in flowing)
    on_yield = bound * Validity.FROM_HARDNESS
    common = {
        # one criterion of yield for all thin-plate laws, which differ in theirs
        "share": pair.yield_share() if law.thin_plate else yield_share(pair, law),
        "bending": _BENDING * plate,
        "damage": _damage(pair),
    }
    if not law.thin_plate:
        given = Given(**law.parameters)
        ratios = [pair.effective_modulus / (body.strength or math.inf) for body in flowing]
        known = all(RATIOS[0] <= ratio <= _SOFTEST for ratio in ratios)
        most = _STIFFEST_SPHERE if flowing == [pair.sphere] else _STIFFEST
        most *= min(body.plane_modulus for body in pair.bodies)
        known &= all(body.plane_modulus <= most for body in flowing)
        untried = (not known) * Validity.UNTRIED_STRENGTH
        hardens = any(body.flow is not None and body.flow.hardening for body in flowing)
        return Limits(
            slender=_SLENDER_FEM,
            slowness=0.0,
            always=int(rate),
            flags_when_yielded=0,
            least_yield_ratio=0.0,
            fastest=0.0,
            swiftest=(math.pi * _SWIFTEST**2) ** 0.4,  # V0 T_H/R at V0/sqrt(E*/rho1)
            deepest=min(law.range[1] * (law.scale or 0.0), _HARDENED if hardens else math.inf),
            on_yield=int(on_yield | untried),
            **common | {"bending": _BENDING * min(plate, _flowing_sphere(pair, given))},
        )
    nu = pair.plate.poissons_ratio
    # E (1 - nu)/((1 + nu)(1 - 2 nu)) is infinite for an incompressible plate: no transit time then
    slowness = math.sqrt(pair.plate.density / pair.plate.youngs_modulus * (1 + nu) * (1 - 2 * nu) / (1 - nu))
    soft = law.yields and plate < sphere
    least, largest = law.yield_strains
    other = not (law.yields and least <= sphere / pair.sphere.youngs_modulus <= largest)
    return Limits(
        slender=SLENDER,
        slowness=slowness,
        always=int(rate | soft * Validity.SOFT_PLATE),
        flags_when_yielded=int((other or soft) * Validity.OTHER_LAW),
        least_yield_ratio=_y_at(_WELL_YIELDED if law.yields else 1.0),
        fastest=_y_at(_FASTEST),
        swiftest=math.inf,
        deepest=math.inf,
        on_yield=int(on_yield),
        **common,
    )


def _flowing_sphere(pair: Pair, given: Given) -> float:
    """Strength of a sphere that flows completely [Pa]: `_BENDING` is a contact half as wide as the plate is thick."""
    now = comparable(given)[-1]
    return pair.effective_modulus / now.sphere_ratio if now.sphere_ratio > _COMPLETE else math.inf


_ROWS = 33  # strengths, evenly spaced in ln k, between which limits are interpolated


def alone(limits: Limits) -> Array:
    """Array of limits that hold at any strength."""
    return np.array([[0.0, *limits]])


def limits_by_strength(pair: Pair, law: Law) -> Array:
    """Limits of a pair, a row for each of some strengths: ln k, then the fields of `Limits`.

    Flags that begin at a strength between two rows begin at the higher one.
    """
    flow = flow_with_rate(pair, law)
    if not law.yields or flow is None:
        return alone(limits(pair, law))
    rows = []
    for one in np.linspace(0.0, math.log(largest_factor(flow, REACH)), _ROWS).tolist():
        try:
            stronger = strengthened(pair, math.exp(one))
        except ValueError:  # no material is so strong
            break
        rows.append([one, *limits(stronger, without_curves(pair, law, one))])
    return np.array(rows)


@kernel(inline=True)
def _between(low: float, high: float, share: float) -> float:
    """Interpolate between numbers that may be infinite; NaN between infinity and less."""
    return low if low == high or share == 0.0 else low + share * (high - low)


@kernel
def limits_at(rows: Array, strength: float) -> Limits:
    """Limits of an impact, from its ln k."""
    n, last = 0, rows.shape[0] - 1
    while n < last and strength > rows[n + 1, 0]:
        n += 1
    a, b, share = rows[n], rows[min(n + 1, last)], 0.0
    if n < last:
        share = min(max((strength - a[0]) / (b[0] - a[0]), 0.0), 1.0)
    return Limits(
        a[1],
        a[2],
        int(a[3]),
        int(a[4]),
        a[5],
        a[6],
        a[7],
        _between(a[8], b[8], share),
        _between(a[9], b[9], share),
        _between(a[10], b[10], share),
        a[11],
        int(a[12]),
    )


def _bearable(body: Material) -> float:
    """Largest Hertzian pressure that a brittle body bears [Pa]; inf for one that is not."""
    if isinstance(body.hardness, float) and body.strength is None:
        return _FLOW * body.hardness
    return math.inf


def _damage(pair: Pair) -> float:
    """Least force over R^2 at which Hertz's pressure makes a brittle body flow [Pa].

    p0 = (6 F E*^2/(pi^3 R^2))^(1/3). If the other body yields, it limits the pressure.
    """
    least = math.inf
    for body, other in (pair.bodies, pair.bodies[::-1]):
        pressure = _bearable(body)
        if pressure < math.inf and (other.strength or math.inf) * _HARDNESS > pressure / 1.5:
            least = min(least, math.pi**3 * pressure**3 / (6.0 * pair.effective_modulus**2))
    return least


def _y_at(ratio: float) -> float:
    """d_Y/(V0 T_H) at a ratio V0/V_Y0: at V_Y0 on a half-space w_m = y = (5/4)^(2/5)."""
    return float((math.sqrt(1.25) / ratio) ** 0.8)


@kernel(entry=True)
def flags_of(
    limits: Limits, radius: float, thickness: float, scale: float, contact_time: float, compression: float, force: float
) -> int:
    """Flag an impact; scale is V0 T_H [m], compression and force the largest ones [m, N]."""
    flags = limits.always
    if compression > limits.share * radius:
        flags |= limits.on_yield
    if radius > limits.slender * thickness:
        flags |= Validity.THIN_PLATE.value
    if thickness < math.inf and contact_time < TRANSITS * thickness * limits.slowness:
        flags |= Validity.THICK_PLATE.value
    yield_ratio = limits.share * radius / scale
    if yield_ratio < limits.least_yield_ratio:
        flags |= limits.flags_when_yielded
    if yield_ratio < limits.fastest or scale > limits.swiftest * radius:
        flags |= Validity.FAST_IMPACT.value
    if compression > limits.deepest * radius:
        flags |= Validity.DEEP_CONTACT.value
    if force > limits.bending * (thickness * thickness):
        flags |= Validity.BENT_PLATE.value
    if force > limits.damage * (radius * radius):
        flags |= Validity.DAMAGE.value
    return flags


# The following rules take numbers or arrays.


@kernel
def mass_flags(mass: Any) -> Any:
    """Flag what is due to a mass, over that of a solid sphere."""
    return ((mass < _HOLLOW) | (mass > _HEAVY)) * Validity.NOT_SOLID.value


@kernel
def curved_flags(bending: Any) -> Any:
    """Flag what is due to a curved wall, from R* over the radius."""
    return (abs(bending - 1.0) > _CURVED) * Validity.CURVED_WALL.value


@kernel
def layer_flags(top: Any, alike: Any, pitch: Any, wave: Any, radius: Any, compression: Any, contact_time: Any) -> Any:
    """Flag what is due to layers and ribs, from the attributes of a plate and its sqrt(D/m) [m2/s]."""
    # by Hertz's law the radius of the contact is sqrt(R d)
    liner = (top < _LINER * np.sqrt(radius * compression)) | (alike < _ALIKE)
    ribs = pitch > 0.5 * np.sqrt(math.pi * wave * contact_time)  # the frequency is 1/(2 contact times)
    return liner * Validity.LINER.value + ribs * Validity.RIBS.value


def wall_flags(
    wall: Mapping[str, Array], radius: Array, bending: Array | None, contact_time: Array, compression: Array
) -> Integers:
    """Flag what is due to layers, ribs and curvature of impacts; R* over the radius is `bending`."""
    flags = np.zeros(radius.size, dtype=np.int64)
    if "alike" in wall:
        top, alike, pitch, wave = (wall[name] for name in ("top", "alike", "pitch", "wave"))
        flags |= layer_flags(top, alike, pitch, wave, radius, compression, contact_time)
    if bending is not None:
        flags |= curved_flags(bending)
    return flags


@kernel
def edge_flags(radius: Any, thickness: Any, compression: Any, edge_distance: Any, again: Any) -> Any:
    """Flag what is due to the edge of a plate, from the largest compression [m]."""
    # by Hertz's law the radius of the contact is sqrt(R d)
    near = edge_distance < np.maximum(2.0 * np.sqrt(radius * compression), thickness)
    return near * Validity.NEAR_EDGE.value + (again > 0.0) * Validity.STRIKES_AGAIN.value


def edge_distance(plate: Material, thickness: ArrayLike, contact_time: ArrayLike) -> float | Array:
    """Distance from an edge beyond which the edge no longer changes the impact [m].

    It is 2.66 sqrt(b contact_time), with b = sqrt(D/(rho2 H)): farther away, the waves that an edge
    sends back come too late. Beyond this distance a free, supported or clamped edge changes the COR
    of this model, elastic or yielding, by less than 0.25 % up to lambda 0.3, by less than 0.6 % up
    to lambda 0.5, and by less than 0.003 up to lambda 1.

    Parameters
    ----------
    plate : Material
        Material of the plate.
    thickness : array_like
        Thickness of the plate [m].
    contact_time : array_like
        Duration of the contact far from edges [s], as in `Rebound.contact_time`.

    Returns
    -------
    float or ndarray of float64
        Distance [m]; ``inf`` for a half-space, which has no bending waves.

    Raises
    ------
    ValueError
        If a number is not positive.

    Notes
    -----
    In finite elements with a free edge all around the impact (gamma-alumina on glass, R/H = 1.5, at
    the yield speed) the COR changes by less than 0.2 % beyond this distance, by 2.3 % at two thirds
    and by 9 % at 0.53 of it. Nearer impacts: `ImpactModel.restitution` and its `edge_distance`.

    Examples
    --------
    >>> import contactlaw as cl
    >>> round(cl.edge_distance(cl.material("glass"), 1e-3, 6e-6), 4)
    0.0082
    """
    h, time, shape = broadcast(thickness=thickness, contact_time=contact_time)
    check(thickness=h, contact_time=time)
    return shaped(_REACH * np.sqrt(wave_path(plate) * h * time), shape)

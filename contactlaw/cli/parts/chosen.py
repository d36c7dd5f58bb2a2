"""Models, materials and figures from the options that subcommands share."""

import dataclasses
import math
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.cli.parts import figure, own, rebounds, wording
from contactlaw.fitting.drops import rebounds_of
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import scalars
from contactlaw.physical.materials import Material, sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import Foundation, Layers, Shell
from contactlaw.record.file import HDF5

_UNITS = {"speed": "m/s", "radius": "m", "thickness": "m", "mass": "kg"}


def model(arguments: Namespace) -> ImpactModel:
    """Model of the given materials, with errors of their own if there are such options, and law."""
    bodies = []
    for role, body in zip(("sphere", "plate"), pair(arguments).given, strict=True):
        errors = dict(getattr(arguments, f"{role}_error", ()))
        try:
            changed = dataclasses.replace(body, uncertainty={**body.uncertainty, **errors})
        except ValueError as error:
            raise ArgumentError(f"{role}_error", None, str(error)) from error
        for name in errors:
            if name not in changed.uncertainty:
                raise ArgumentError(f"{role}_error", name, f"{body.name!r} has no such number")
        bodies.append(changed)
    return ImpactModel(Pair(*bodies), law=arguments.law, outside=getattr(arguments, "outside", "raise"))


def pair(arguments: Namespace, known: Any = None) -> Pair:
    """Materials that the options name, otherwise the `known` sphere and plate of a file."""
    return Pair(**{role: body(arguments, role, getattr(known, role, None)) for role in ("sphere", "plate")})


def is_record(paths: Sequence[str]) -> bool:
    """Whether files are those of a record, of which there may be several; a table is one file."""
    found = Path(paths[0]).suffix.lower() in (*HDF5, ".npy")
    if len(paths) > 1 and not found:
        raise ValueError(f"{paths[1]}: only the files of one record are put together: give one table, with all rows")
    return found


def of_record(arguments: Namespace, pairs: Mapping[int, Pair | None]) -> tuple[list[int], str]:
    """Numbers of the pairs of a record that the options choose, and the names of all its pairs.

    The materials of a single pair are not compared: options replace them.
    """
    names = ", ".join(f"{one.sphere.name} on {one.plate.name}" for one in pairs.values() if one)
    some = [*pairs]
    for role in ("sphere", "plate"):
        if (name := getattr(arguments, role)) and len(pairs) > 1:
            some = [n for n in some if (one := pairs[n]) and getattr(one, role).name == name]
            if not some:
                raise ArgumentError(role, name, f"the record has {names}")
    return some, names


def of_file(arguments: Namespace, path: str) -> rebounds.Source:
    """Read a table of rebounds; options come before what the head of the file says."""
    options = {n: size for n, size in vars(arguments).items() if n in rebounds.OF_ALL and size is not None}
    scalars(**{name: options[name] for name in ("radius", "thickness", "friction") if name in options})
    return rebounds.read(path, arguments.materials, lambda known: pair(arguments, SimpleNamespace(**known)), **options)


def body(arguments: Namespace, role: str, known: Material | None = None) -> Material:
    """Material that an option names, otherwise the one `known` from a file."""
    chosen = getattr(arguments, role)
    if chosen is None:
        if known is None:
            raise ArgumentError(role, None, "has to be given, no record or file says it")
        return known
    return own.material_of(role, chosen, arguments.materials)


def wall(arguments: Namespace, plate: Material, thickness: Any) -> Any:
    """Plates of these thicknesses [m], with what the options of `options.add_wall` add to them."""
    below = [layer(text, arguments.materials) for text in arguments.on]
    if below:
        if not np.isfinite(thickness).all():
            raise ArgumentError("thickness", math.inf, "a half-space has no layer below it: leave out --on")
        whole = [Layers([(plate, one), *below]) for one in np.ravel(thickness).tolist()]
        thickness = whole if np.ndim(thickness) else whole[0]
    if arguments.foundation is not None:
        return Foundation(thickness, arguments.foundation)
    if arguments.cylinder is not None:
        return Shell(thickness, arguments.cylinder)
    return thickness if arguments.bowl is None else Shell(thickness, arguments.bowl, "sphere")


def layer(text: str, materials: Mapping[str, Material]) -> tuple[Material, float]:
    """Material and thickness [m] of a layer, as "steel-s235:3mm"."""
    name, colon, thick = text.rpartition(":")
    if not colon:
        raise ArgumentError("on", text, "expected a material and a thickness, as steel-s235:3mm")
    material = own.material_of("on", name, materials)
    try:
        size = quantities.value(thick, quantities.LENGTH)
    except ValueError as error:
        raise ArgumentError("on", text, str(error)) from error
    if not 0.0 < size < math.inf:
        raise ArgumentError("on", text, "the thickness of a layer must be positive and finite")
    return material, size


def plate_in_words(arguments: Namespace, plate: str) -> str:
    """Name of the plate's material, with what the options of `options.add_wall` add to it."""
    words = plate + "".join(f" on {text}" for text in getattr(arguments, "on", ()))
    for name, unit in (("cylinder", "m"), ("bowl", "m"), ("foundation", "N/m3")):
        size = getattr(arguments, name, None)
        words += "" if size is None else f" ({name} {in_unit(size, unit)})"
    return words


def asked(arguments: Namespace, model: ImpactModel, **sizes: float | None) -> dict[str, Any]:
    """Repeat what the user asked: names of materials, wall and law, and sizes in SI units."""
    law, (sphere, plate) = model.force_law, model.pair.given
    name = law.family if law.from_pair else law.name
    numbers = {f"{n}_{_UNITS[n]}": float(size) for n, size in sizes.items() if size is not None}
    return {"sphere": sphere.name, "plate": plate_in_words(arguments, plate.name), "law": name, **numbers}


def take_drops(arguments: Namespace) -> None:
    """Turn heights of drops into speeds on arrival, and refuse round walls that are smaller than a bead."""
    if hasattr(arguments, "speed") and getattr(arguments, "drop", None) is not None:
        drops = arguments.drop
        fallen = rebounds_of({"drop": drops, "radius": bead_radius(arguments)}, density(arguments))["speed"].tolist()
        arguments.speed = tuple(fallen) if isinstance(drops, tuple) else fallen[0]
    for name in ("cylinder", "bowl"):
        size = getattr(arguments, name, None)
        if size is not None and abs(size) <= np.max(arguments.radius):
            raise ArgumentError(name, size, "must be larger than the bead's radius; negative if beads hit from outside")


def bead_radius(arguments: Namespace) -> float:
    """Radius of the beads that fall through air, of which there may be but one."""
    radii = np.unique(np.ravel(arguments.radius)).tolist() if arguments.radius is not None else []
    if len(radii) != 1:
        raise ArgumentError("drop", None, "takes one radius, as the air slows beads by their size; or give --speed")
    return float(radii[0])


def density(arguments: Namespace) -> float:
    """Density of the beads [kg/m3]; of those with a mass of their own, over their volume."""
    if (mass := getattr(arguments, "mass", None)) is not None:
        return float(mass) / sphere_mass(1.0, bead_radius(arguments))
    return pair(arguments).given[0].density


@contextmanager
def plot_file(arguments: Namespace) -> Iterator[None]:
    """Refuse a file that cannot be drawn into before anything is computed; print its name after."""
    if arguments.plot is None:
        yield
        return
    with wording.writing("plot", arguments.plot):
        wording.check_suffix("path", arguments.plot, figure.SUFFIXES)
        yield
    print(arguments.plot)

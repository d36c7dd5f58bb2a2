"""Scenes as text: a file of TOML that names beads and walls as their constructors do."""

import functools
import inspect
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import laws, quantities, walls
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import own, wording
from contactlaw.model import ImpactModel
from contactlaw.physical import plates
from contactlaw.physical.arguments import unknown
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

_MAKERS: dict[str, tuple[Any, ...]] = {
    "shape": (walls.Plate, walls.Cylinder, walls.Cone, walls.Sphere, walls.Disc, walls.Ring, walls.Mesh),
    "motion": (walls.Translation, walls.Rotation, walls.Vibration, walls.Tabulated),
    "thickness": (plates.Shell, plates.Foundation, plates.Orthotropic),
}
_QUANTITIES = {  # of texts with a unit; the others are lengths
    "velocity": quantities.SPEED,
    "speed": quantities.SPIN,
    "frequency": quantities.FREQUENCY,
    "times": quantities.TIME,
    "stiffness": quantities.STIFFNESS,
}


class Scene:
    """A file of TOML, and values that are set in place of its own, such as ``shell.thickness=2mm``."""

    def __init__(self, path: Path, changes: Sequence[str]) -> None:
        with wording.reading(path):
            self._path, self._text = path, path.read_text("utf-8-sig")
            try:
                table = tomllib.loads(self._text)
            except tomllib.TOMLDecodeError as error:
                raise ValueError(f'{error}; write names and numbers with a unit in quotes: "1mm"') from error
        self._changed = dict(map(_change, changes))
        for name, value in self._changed.items():
            wall, dot, word = name.rpartition(".")
            if dot and wall not in table:
                raise ArgumentError("set", None, unknown(wall, table))
            (table[wall] if dot else table)[word] = value
        self._walls = {name: words for name, words in table.items() if isinstance(words, dict) and name not in _MAKERS}
        self._of_all = {name: value for name, value in table.items() if name not in self._walls}

    def arguments(self, materials: Mapping[str, Material], law: str) -> dict[str, Any]:
        """Arguments of `contactlaw.export.scene`, but for the path."""
        laws.parameters(law)  # refuses an unknown law, which is no error of the file
        words = dict(self._of_all)
        with self.naming():
            _check(words, ["beads", "largest"], ["plate", "friction", "softening", "parcel"])
            beads, plate = words.pop("beads"), words.pop("plate", None)
            beads = beads if isinstance(beads, list) else [beads]
            spheres = [None if one == "none" else own.material_of("beads", one, materials) for one in beads]
            numbers = {name: _value(name, value, self._path) for name, value in words.items()}
            shared = plate and own.material_of("plate", plate, materials)
        model = functools.cache(lambda sphere, body: ImpactModel(Pair(sphere, body), law=law))
        made, models = dict[str, Any](), dict[int, Any]()
        for name, words in self._walls.items():
            with self.naming(name):
                body = own.material_of("plate", words["plate"], materials) if "plate" in words else shared
                if not body:
                    raise ValueError("lacks plate")
                by_type = {
                    kind: model(sphere, body) if sphere and kind in np.ravel(words.get("types", kind)) else None
                    for kind, sphere in enumerate(spheres, 1)
                }
                made[name] = _made("shape", words, self._path, by_type)
            models = by_type | {kind: one for kind, one in models.items() if one}
        return {"walls": made, "model": models, "types": len(spheres), **numbers}

    @contextmanager
    def naming(self, wall: str = "") -> Iterator[None]:
        """Name the line of the file, or the option, whose value is refused."""
        try:
            yield
        except (ValueError, TypeError) as error:
            message = wording.sentence(error, {})
            words = self._walls[wall] if wall else self._of_all
            word = min((one for one in words if one in message), key=message.index, default="")
            if (name := f"{wall}.{word}".strip(".")) in self._changed:
                raise ArgumentError("set", None, f"{name}: {message}") from error
            begins = len(re.split(rf"\[\"?{re.escape(wall)}", self._text, maxsplit=1)[0]) if wall else 0
            found = re.compile(rf'(?m)^[ \t]*"?{word}"?[ \t]*=').search(self._text, begins)
            line = 1 + self._text.count("\n", 0, found.start() if found else begins)
            raise ValueError(f"{self._path}, line {line}: {wall and f'[{wall}]: '}{message}") from error


def _change(text: str) -> tuple[str, Any]:
    """Name and value of ``--set``; a value that is no TOML is a text."""
    name, sign, value = text.partition("=")
    if not sign:
        raise ArgumentError("set", text, "expected a wall, a word and its value, as shell.thickness=2mm")
    try:
        return name, tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return name, value


def _check(words: Mapping[str, Any], needed: Sequence[str], others: Iterable[str]) -> None:
    """Refuse unknown words, and say which are missing."""
    own.check_keys(words, dict.fromkeys([*needed, *others]))
    if missing := [name for name in needed if name not in words]:
        raise ValueError(f"lacks {' and '.join(missing)}")


def _made(what: str, words: Mapping[str, Any], path: Path, model: Any = None) -> Any:
    """Call the constructor that a table names."""
    makers = {one.__name__.lower(): one for one in _MAKERS[what]}
    word = "shape" if what == "shape" else "kind"
    _check(words, [] if "file" in words else [word], words)
    if (kind := words.get(word, "mesh")) not in makers:
        raise ValueError(f"{word}: {unknown(kind, makers)}")
    make = walls.Mesh.read if kind == "mesh" else makers[kind]
    parameters = inspect.signature(make).parameters
    names = {{"path": "file", "model": "plate"}.get(name, name): name for name in parameters}
    needed = [one for one, name in names.items() if parameters[name].default is inspect.Parameter.empty]
    _check(words, needed, [word, *names, *(["types"] if what == "shape" else [])])
    values = {names[one]: _value(one, value, path) for one, value in words.items() if one in names and one != "plate"}
    return make(**values, **({"model": model} if what == "shape" else {}))


def _value(name: str, value: Any, path: Path) -> Any:
    """Value of an argument; texts of numbers have a unit."""
    if name == "thickness" and isinstance(value, list) and isinstance(value[0], list):
        return plates.Layers([(body, _value(name, thick, path)) for body, thick in value])
    if isinstance(value, list):
        return [_value(name, one, path) for one in value]
    if name == "file":
        return path.parent / value
    if name in ("edges", "contact", "shape"):
        return None if value == "none" else value
    with wording.reading(name):
        if isinstance(value, dict):
            return _made(name, value, path)
        return quantities.value(value, _QUANTITIES.get(name, quantities.LENGTH)) if isinstance(value, str) else value

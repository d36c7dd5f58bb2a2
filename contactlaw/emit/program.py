"""A program in another language: the kernels that were asked for, and all that they call."""

import re
from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np

from contactlaw.emit.languages import C as Language
from contactlaw.emit.types import DOUBLE, ELEMENTS, INT, Array, Known, Rows, Struct, Type, Value, traced


class Program:
    """Functions, structures and constants in one language, each once, in the order of their use.

    Functions are made anew for each value of parameters whose names are in `fixed`. `names` are for
    kernels, NamedTuples and dtypes, and for tuples by the types of their members; others get their
    own. A name may be kept for what is not written here, under any key. `instead` of some kernels
    others are written.
    """

    def __init__(
        self,
        language: Language,
        fixed: Collection[str] = (),
        names: Mapping[Any, str] | None = None,
        instead: Mapping[Callable[..., Any], Callable[..., Any]] | None = None,
    ) -> None:
        self.language, self.fixed, self.instead = language, fixed, instead or {}
        self._given: dict[Any, str] = dict(names or {})
        self._names = {*self._given.values()}
        self.parts: list[str] = []
        self._constants: dict[str, str] = {}
        self._structs: dict[Any, Struct] = {}
        self._rows: dict[tuple[Struct, bool], Rows] = {}
        self._arrays: dict[int, Value] = {}
        self.functions: dict[Any, tuple[str, Type] | None] = {}

    def struct(self, source: Any, members: Mapping[str, Type]) -> Struct:
        """Structure of a NamedTuple, a `tuple` or a dtype, with these types of its members."""
        key = source, *members.values()
        if key not in self._structs:
            name = re.sub(r"(?<!^)(?=[A-Z])", "_", getattr(source, "__name__", "row")).lower()
            name = self.free_name(key[1:] if source is tuple else source, name)
            row = isinstance(source, np.dtype)
            self._structs[key] = made = Struct(name, tuple(members.items()), source, row)
            if traced(made) and self.language.typed:
                self.parts.append(self.language.structure(made))
        return self._structs[key]

    def row(self, dtype: np.dtype[Any]) -> Struct:
        """Row of a dtype."""
        kinds = [(name, dtype[name]) for name in dtype.names or ()]
        numbers = {name: ELEMENTS[one.base.str[1:]] for name, one in kinds}
        made = {name: Array(shape=one.shape, of=numbers[name]) if one.shape else numbers[name] for name, one in kinds}
        return self.struct(dtype, made)

    def rows(self, row: Struct, matrix: bool = False) -> Rows:
        """Rows of a dtype, or a matrix of them."""
        if (row, matrix) not in self._rows:
            members = (("at", row), ("n", INT), ("m", INT))[: 3 if matrix else 2]
            made = Rows(self.free_name(None, f"{row.name}_{'matrix' if matrix else 'rows'}"), members)
            self._rows[row, matrix] = made
            self.parts.append(self.language.structure(made))
        return self._rows[row, matrix]

    def make(self, source: Any, parts: Mapping[str, Value]) -> Value:
        """Write a NamedTuple or a tuple of these members; those without a trace are left out."""
        made = self.struct(source, {name: one.type for name, one in parts.items()})
        texts = {name: one.text for name, one in parts.items() if traced(one.type)}
        return Value(made, self.language.make(made, texts))

    def free_name(self, thing: Any, *names: str) -> str:
        """Name that was given for something, or a free one of these."""
        numbered = (f"{names[-1]}_{n}" for n in range(2, 99))
        free = next(one for one in (*names, *numbered) if one not in self._names)
        free = self._given.pop(thing, free)
        self._names.add(free)
        return free

    def constant(self, value: Any) -> Value:
        """Write an object of Python."""
        match value:
            case bool() | np.bool_() | int() | np.integer():
                return Value(INT, str(int(value)), 10 if value < 0 else 12, int(value))
            case float() | np.floating():
                return Value(DOUBLE, self.language.number(float(value)), 10 if value < 0 else 12)
            case tuple() if hasattr(value, "_fields"):
                parts = zip(value._fields, map(self.constant, value), strict=True)
                return self.make(type(value), dict(parts))
        return Value(Known(value=value), "", known=value)

    def named(self, value: Any, name: str, module: str) -> Value:
        """Write an object that has a name in a module of Python; numbers are defined by it."""
        name, prefix = name.strip("_"), self.language.prefix
        if isinstance(value, np.ndarray):
            if value.dtype.names and id(value) not in self._arrays:
                row = self.row(value.dtype)  # all of them are zero
                at = f"{prefix}{self.free_name(id(value), name.strip('_').lower())}"
                self.parts.append(f"static {self.language.type(row)[:-2]} {at}[{value.size}] = {{ {{ 0 }} }};")
                self._arrays[id(value)] = self.span(row, at, str(value.size))
            if id(value) not in self._arrays:
                one = self.free_name(id(value), name.lower())
                self.parts.append(self.language.constant(one, value.ravel().tolist()))
                self._arrays[id(value)] = Value(Array("array", True, value.shape), f"{prefix}{one}")
            return self._arrays[id(value)]
        found = self.constant(value)
        if not traced(found.type) or found.text.strip("-") == self.language.inf:
            return found
        for one in (name, f"{module.rpartition('.')[2]}_{name}"):
            if self._constants.setdefault(one, found.text) == found.text:
                return Value(found.type, f"{prefix}{one}", known=found.known)
        raise ValueError(f"{one}: two constants have this name, rename one of them")

    def span(self, row: Struct, at: str, n: str) -> Value:
        """Rows from an address on."""
        made = self.rows(row)
        return Value(made, self.language.make(made, {"at": at, "n": n}))

    def text(self) -> str:
        """Definitions of all constants, structures and functions."""
        defined = [self.language.constant(name, text) for name, text in self._constants.items()]
        return "\n\n".join(["\n".join(defined), *self.parts])

"""A program in another language: the kernels that were asked for, and all that they call."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from contactlaw.emit.function import Function
from contactlaw.emit.c import C as Language
from contactlaw.emit.types import DOUBLE, INT, NONE, Array, Known, Row, Struct, Type, Value, traced

_COMMENT = re.compile(r"^    (\w+)\b.*?:.*?#\s*(.*)$", re.MULTILINE)


class Program:
    """Functions, structures and constants in one language, each once, in the order of their use.

    Parameters
    ----------
    language : Language
        How it is written.
    fixed : collection of str, optional
        Names of parameters for each value of which functions are made anew.
    """

    def __init__(self, language: Language, fixed: Collection[str] = ()) -> None:
        self.language, self.fixed = language, fixed
        self.parts: list[str] = []
        self.constants: dict[str, str] = {}
        self._structs: dict[tuple[str, Any], Struct] = {}
        self._functions: dict[tuple[str, str, Any], tuple[str, Type] | None] = {}
        self._names: set[str] = set()
        self._arrays: dict[int, str] = {}
        self.names: dict[type, str] = {}  # of NamedTuples that are not to have their own

    def add(
        self, kernel: Callable[..., Any], *types: Type, name: str | None = None
    ) -> tuple[str, Type]:
        """Add a kernel for these types of arguments; returns its name there, and its type."""
        python = getattr(kernel, "py_func", kernel)
        key = python.__module__, python.__name__, types
        if key not in self._functions:
            self._functions[key] = None
            module = python.__module__.rpartition(".")[2]
            plain = name or self._free(f"{module}_{python.__name__.strip('_')}")
            made = Function(self, python, types)
            result = made.infer()
            if result != NONE:
                self.parts.append(made.text(plain))
            self._functions[key] = plain, result
        found = self._functions[key]
        if found is None:
            raise RecursionError(f"{python.__module__}.{python.__name__} calls itself")
        return found

    def struct(self, source: type, members: tuple[tuple[str, Type], ...]) -> Struct:
        """Structure of a NamedTuple with these types of its members."""
        plain = re.sub(r"(?<!^)(?=[A-Z])", "_", source.__name__).lower()
        name = self.names.get(source, plain)
        return self._struct(name, members, source)

    def tuple_of(self, types: tuple[Type, ...]) -> Struct:
        """Structure of a tuple."""
        name = "_".join(one.name for one in types)
        return self._struct(name, tuple((f"f{n}", one) for n, one in enumerate(types)), None)

    def row(self, name: str, dtype: np.dtype[Any]) -> Row:
        """Row of a dtype."""
        sizes = ((one, math.prod(dtype[one].shape) * bool(dtype[one].shape))
                 for one in dtype.names or ())  # fmt: skip
        made = Row(self._free(name), tuple(sizes))
        self.parts.append(self.language.row(made))
        return made

    def _struct(self, name: str, members: Any, source: type | None) -> Struct:
        key = name, members
        if key not in self._structs:
            made = Struct(self._free(name), members, source)
            said = dict(_COMMENT.findall(inspect.getsource(source))) if source else {}
            self._structs[key] = made
            if traced(made):
                self.parts.append(self.language.structure(made, inspect.getdoc(source), said))
        return self._structs[key]

    def _free(self, name: str) -> str:
        """Take a name that nothing has: it, or it with a number."""
        names = (f"{name}_{n}" if n > 1 else name for n in range(1, 99))
        free = next(one for one in names if one not in self._names)
        self._names.add(free)
        return free

    def constant(self, value: Any, name: str = "", module: str = "") -> Value:
        """Write an object of Python; a number that has a name there is defined by that name."""
        known: Any = value
        match value:
            case None:
                return Value(NONE, "", known=None)
            case bool() | np.bool_() | int() | np.integer():
                kind, text, known = INT, str(int(value)), int(value)
            case float() | np.floating():
                kind, text = DOUBLE, self.language.number(float(value))
            case np.ndarray():
                return Value(Array(data=True, shape=value.shape), self._data(value, name))
            case tuple() if hasattr(value, "_fields"):
                parts = [self.constant(one) for one in value]
                types = tuple(part.type for part in parts)
                made = self.struct(type(value), tuple(zip(value._fields, types, strict=True)))
                kind, text = made, self.language.make(made, [part.text for part in parts])
            case _:
                return Value(Known(value=value), "", known=value)
        if not name:
            return Value(kind, text, 10 if text.startswith("-") else 12, known)
        name = name.strip("_")
        if self.constants.setdefault(name, text) != text:
            name = f"{module}_{name}"
            if self.constants.setdefault(name, text) != text:
                raise ValueError(f"{name}: two constants have this name, rename one of them")
        return Value(kind, self.language.name(name), known=known)

    def _data(self, values: Any, name: str) -> str:
        if id(values) not in self._arrays:
            plain = self._free(name.strip("_").lower() or "data")
            self.parts.append(self.language.data(plain, values.ravel().tolist()))
            self._arrays[id(values)] = self.language.name(plain)
        return self._arrays[id(values)]

    def text(self) -> str:
        """Definitions of all constants, structures and functions."""
        defined = [self.language.define(name, text) for name, text in self.constants.items()]
        return "\n\n".join(["\n".join(defined), *filter(None, self.parts)])

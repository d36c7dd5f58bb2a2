"""A program in another language: the kernels that were asked for, and all that they call."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np

from contactlaw.emit.c import C as Language
from contactlaw.emit.function import Function
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
    names : dict, optional
        Names for kernels, for NamedTuples, and for tuples by the types of their members; others get
        their own. A name may be kept for what is not written here, under any key.
    instead : dict of kernel to kernel, optional
        Kernels to write in place of others.
    """

    def __init__(
        self,
        language: Language,
        fixed: Collection[str] = (),
        names: Mapping[Any, str] | None = None,
        instead: Mapping[Callable[..., Any], Callable[..., Any]] | None = None,
    ) -> None:
        self.language, self.fixed, self._given = language, fixed, dict(names or {})
        self._instead = instead or {}
        self.parts: list[str] = []
        self.constants: dict[str, str] = {}
        self._structs: dict[tuple[str, Any], Struct] = {}
        self._functions: dict[tuple[str, str, Any], tuple[str, Type] | None] = {}
        self._names = {*self._given.values()}
        self._arrays: dict[int, str] = {}

    def add(self, kernel: Callable[..., Any], *types: Type) -> tuple[str, Type]:
        """Add a kernel for these types of arguments; returns its name there, and its type."""
        kernel = self._instead.get(kernel, kernel)
        python = getattr(kernel, "py_func", kernel)
        key = python.__module__, python.__name__, types
        if key not in self._functions:
            self._functions[key] = None
            module, short = python.__module__.rpartition(".")[2], python.__name__.strip("_")
            name = short if short not in self._names else f"{module}_{short}"
            plain = self._named(kernel, name)
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
        name = re.sub(r"(?<!^)(?=[A-Z])", "_", source.__name__).lower()
        return self._struct(source, name, members, source)

    def tuple_of(self, types: tuple[Type, ...]) -> Struct:
        """Structure of a tuple."""
        members = tuple((f"f{n}", one) for n, one in enumerate(types))
        return self._struct(types, "_".join(one.name for one in types), members, None)

    def row(self, name: str, dtype: np.dtype[Any]) -> Row:
        """Row of a dtype."""
        sizes = ((one, math.prod(dtype[one].shape) * bool(dtype[one].shape))
                 for one in dtype.names or ())  # fmt: skip
        made = Row(self._named(dtype, name), tuple(sizes))
        self.parts.append(self.language.row(made))
        return made

    def _struct(self, given: Any, name: str, members: Any, source: type | None) -> Struct:
        key = given, members
        if key not in self._structs:
            made = Struct(self._named(given, name), members, source)
            said = dict(_COMMENT.findall(inspect.getsource(source))) if source else {}
            self._structs[key] = made
            if traced(made):
                self.parts.append(self.language.structure(made, inspect.getdoc(source), said))
        return self._structs[key]

    def _named(self, thing: Any, name: str) -> str:
        """Name that was given for something, or this one, with a number where it is taken."""
        names = (f"{name}_{n}" if n > 1 else name for n in range(1, 99))
        free = self._given.pop(thing, None) or next(one for one in names if one not in self._names)
        self._names.add(free)
        return free

    def constant(self, value: Any) -> Value:
        """Write an object of Python."""
        match value:
            case None:
                return Value(NONE, "", known=None)
            case bool() | np.bool_() | int() | np.integer():
                text = str(int(value))
                return Value(INT, text, 10 if value < 0 else 12, int(value))
            case float() | np.floating():
                return Value(DOUBLE, self.language.number(float(value)), 10 if value < 0 else 12)
            case tuple() if hasattr(value, "_fields"):
                parts = [self.constant(one) for one in value]
                types = (part.type for part in parts)
                made = self.struct(type(value), tuple(zip(value._fields, types, strict=True)))
                return Value(made, self.language.make(made, [part.text for part in parts]))
        return Value(Known(value=value), "", known=value)

    def named(self, value: Any, name: str, module: str) -> Value:
        """Write an object that has a name in a module of Python; numbers are defined by it."""
        name = name.strip("_")
        if isinstance(value, np.ndarray):
            return Value(Array(data=True, shape=value.shape), self._data(value, name.lower()))
        found = self.constant(value)
        if not traced(found.type) or found.text.strip("-") == self.language.number(math.inf):
            return found
        if self.constants.setdefault(name, found.text) != found.text:
            name = f"{module.rpartition('.')[2]}_{name}"
            if self.constants.setdefault(name, found.text) != found.text:
                raise ValueError(f"{name}: two constants have this name, rename one of them")
        return Value(found.type, self.language.name(name), known=found.known)

    def _data(self, values: Any, name: str) -> str:
        if id(values) not in self._arrays:
            plain = self._named(id(values), name)
            self.parts.append(self.language.data(plain, values.ravel().tolist()))
            self._arrays[id(values)] = self.language.name(plain)
        return self._arrays[id(values)]

    def text(self) -> str:
        """Definitions of all constants, structures and functions."""
        defined = [self.language.define(name, text) for name, text in self.constants.items()]
        return "\n\n".join(["\n".join(defined), *filter(None, self.parts)])

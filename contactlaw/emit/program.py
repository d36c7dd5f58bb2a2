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
        Names for kernels, NamedTuples and dtypes, and for tuples by the types of their members;
        others get their own. A name may be kept for what is not written here, under any key.
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
        self._instead, self._names = instead or {}, {*self._given.values()}
        self._parts: list[str] = []
        self._constants: dict[str, str] = {}
        self._structs: dict[Any, Struct] = {}
        self._functions: dict[Any, tuple[str, Type] | None] = {}
        self._arrays: dict[int, str] = {}

    def add(self, kernel: Callable[..., Any], *types: Type) -> tuple[str, Type]:
        """Add a kernel for these types of arguments; returns its name there, and its type."""
        kernel = self._instead.get(kernel, kernel)
        python = getattr(kernel, "py_func", kernel)
        key = python.__module__, python.__name__, types
        if key not in self._functions:
            outermost = None not in self._functions.values()
            self._functions[key] = None
            module, short = python.__module__.rpartition(".")[2], python.__name__.strip("_")
            name = self._named(kernel, short if short not in self._names else f"{module}_{short}")
            made, said = Function(self, python, types), inspect.getdoc(python) or ""
            result = made.infer()
            if result != NONE:  # users read all of a docstring that is for them
                whole = outermost and self.language.typed
                self._parts.append(made.text(name, said if whole else said.partition("\n")[0]))
            self._functions[key] = name, result
        found = self._functions[key]
        if found is None:
            raise RecursionError(f"{python.__module__}.{python.__name__} calls itself")
        return found

    def struct(self, source: type, members: tuple[tuple[str, Type], ...]) -> Struct:
        """Structure of a NamedTuple with these types of its members."""
        if (source, members) not in self._structs:
            name = re.sub(r"(?<!^)(?=[A-Z])", "_", source.__name__).lower()
            made = Struct(self._named(source, name), members, source)
            said, of_members = (
                inspect.getdoc(source) or "",
                _COMMENT.findall(inspect.getsource(source)),
            )
            self._structs[source, members] = made
            self._declare(made, said.partition("\n")[0], dict(of_members))
        return self._structs[source, members]

    def tuple_of(self, types: tuple[Type, ...]) -> Struct:
        """Structure of a tuple."""
        if types not in self._structs:
            members = tuple((f"f{n}", one) for n, one in enumerate(types))
            self._structs[types] = Struct(self._named(types, "tuple"), members)
            self._declare(self._structs[types])
        return self._structs[types]

    def row(self, name: str, dtype: np.dtype[Any]) -> Row:
        """Row of a dtype."""
        sizes = ((one, math.prod(dtype[one].shape) * bool(dtype[one].shape))
                 for one in dtype.names or ())  # fmt: skip
        made = Row(self._named(dtype, name), tuple(sizes))
        self._declare(made)
        return made

    def _declare(
        self, kind: Struct | Row, said: str = "", comments: dict[str, str] | None = None
    ) -> None:
        if traced(kind) and self.language.typed:
            self._parts.append(self.language.structure(kind, said, comments or {}))

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
                return Value(INT, str(int(value)), 10 if value < 0 else 12, int(value))
            case float() | np.floating():
                return Value(DOUBLE, self.language.number(float(value)), 10 if value < 0 else 12)
            case tuple() if hasattr(value, "_fields"):
                parts = dict(zip(value._fields, map(self.constant, value), strict=True))
                made = self.struct(type(value), tuple((n, one.type) for n, one in parts.items()))
                texts = {n: one.text for n, one in parts.items() if traced(one.type)}
                return Value(made, self.language.make(made, texts))
        return Value(Known(value=value), "", known=value)

    def named(self, value: Any, name: str, module: str) -> Value:
        """Write an object that has a name in a module of Python; numbers are defined by it."""
        name = name.strip("_")
        if isinstance(value, np.ndarray):
            if id(value) not in self._arrays:
                self._arrays[id(value)] = plain = self._named(id(value), name.lower())
                self._parts.append(self.language.constant(plain, value.ravel().tolist()))
            text = f"{self.language.prefix}{self._arrays[id(value)]}"
            return Value(Array(data=True, shape=value.shape), text)
        found = self.constant(value)
        if not traced(found.type) or found.text.strip("-") == self.language.inf:
            return found
        if self._constants.setdefault(name, found.text) != found.text:
            name = f"{module.rpartition('.')[2]}_{name}"
            if self._constants.setdefault(name, found.text) != found.text:
                raise ValueError(f"{name}: two constants have this name, rename one of them")
        return Value(found.type, f"{self.language.prefix}{name}", known=found.known)

    def text(self) -> str:
        """Definitions of all constants, structures and functions."""
        defined = [self.language.constant(name, text) for name, text in self._constants.items()]
        return "\n\n".join(["\n".join(defined), *self._parts])

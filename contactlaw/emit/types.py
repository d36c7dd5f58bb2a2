"""Types of what kernels compute with, and values: an expression of the other language."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple


@dataclasses.dataclass(frozen=True)
class Type:
    """A number, or nothing: None is a type that leaves no trace."""

    name: str
    members: tuple[tuple[str, Any], ...] = ()


DOUBLE, INT, NONE, VOID = Type("double"), Type("int"), Type("none"), Type("void")


@dataclasses.dataclass(frozen=True)
class Struct(Type):
    """A NamedTuple, or a tuple, whose members are f0, f1, ... and have types."""

    source: type | None = dataclasses.field(default=None, compare=False)


@dataclasses.dataclass(frozen=True)
class Row(Type):
    """A row of a dtype, passed by its address; members are numbers, of length 0, and arrays."""


@dataclasses.dataclass(frozen=True)
class Array(Type):
    """Numbers in a row, or rows of them; with its shape where the kernel asks for it.

    `data` lies in the memory of constants; other arrays are the caller's, and may be written.
    """

    name: str = "array"
    data: bool = False
    shape: tuple[int, ...] = ()


@dataclasses.dataclass(frozen=True)
class Known(Type):
    """An argument that has this value, an object of Python; it leaves no trace either."""

    name: str = "known"
    value: Any = dataclasses.field(default=None, compare=False)
    key: Any = dataclasses.field(init=False)  # numbers are equal by value, all else by identity

    def __post_init__(self) -> None:
        value = self.value
        object.__setattr__(self, "key", value if isinstance(value, int) else id(value))


UNKNOWN: Any = object()


def traced(kind: Type) -> bool:
    """Whether something of this type is in the generated text at all."""
    if isinstance(kind, Struct):
        return any(traced(one) for _, one in kind.members)
    return kind != NONE and not isinstance(kind, Known) and 0 not in getattr(kind, "shape", ())


class Value(NamedTuple):
    """An expression in the other language."""

    type: Type
    text: str
    binds: int = 12  # how tightly, from 0, `?:`, to 12, a name or a call
    known: Any = UNKNOWN  # its value in Python, where that is decided already

    def within(self, binds: int) -> str:
        """Text of an operand of an operator that binds as tightly as this."""
        return self.text if self.binds >= binds else f"({self.text})"


TRUE, FALSE = (Value(INT, str(n), known=n) for n in (1, 0))

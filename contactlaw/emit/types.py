"""Types of what kernels compute with, and values: an expression of the other language."""

import dataclasses
from typing import Any, NamedTuple


@dataclasses.dataclass(frozen=True)
class Type:
    """A number, or what a function gives that returns nothing."""

    name: str


DOUBLE, INT, VOID = Type("double"), Type("int"), Type("void")
LONG = Type("int64_t")  # of whole numbers that may pass 2^31, such as addresses
NUMBERS = INT, LONG, DOUBLE  # a result has the type of its widest operand
# Members of rows and elements of arrays, by numpy's names; in formulas whole numbers are INT.
ELEMENTS = {"f8": DOUBLE, "i8": Type("long long"), "i4": INT, "u1": Type("unsigned char")}


@dataclasses.dataclass(frozen=True)
class Struct(Type):
    """A NamedTuple; a tuple, with members f0, f1, ...; a row of a dtype, passed by its address."""

    members: tuple[tuple[str, Type], ...] = ()
    source: Any = dataclasses.field(default=tuple, compare=False)
    row: bool = False


@dataclasses.dataclass(frozen=True)
class Array(Type):
    """Numbers in a row, or rows of them, whose shape may be known; `data` is in constant memory."""

    name: str = "array"
    data: bool = False
    shape: tuple[int, ...] = ()
    of: Type = DOUBLE


@dataclasses.dataclass(frozen=True)
class Rows(Struct):
    """Rows of a dtype: their address `at`, their number `n`, and of a matrix the number `m` of columns."""


@dataclasses.dataclass(frozen=True)
class Known(Type):
    """What has this value, an object of Python, in every call; it leaves no trace in the text."""

    name: str = "known"
    value: Any = dataclasses.field(default=None, compare=False)

    def __post_init__(self) -> None:  # numbers are equal by value, all else by identity
        key = self.value if isinstance(self.value, int) else id(self.value)
        object.__setattr__(self, "name", f"known {key}")


NONE = Known()
UNKNOWN: Any = object()


def traced(kind: Type) -> bool:
    """Whether something of this type is in the generated text at all."""
    if isinstance(kind, Struct):
        return any(traced(one) for _, one in kind.members)
    return not isinstance(kind, Known) and 0 not in getattr(kind, "shape", ())


class Value(NamedTuple):
    """An expression in the other language."""

    type: Type
    text: str
    binds: int = 12  # how tightly, from 0, `?:`, to 12, a name or a call
    known: Any = UNKNOWN  # its value in Python, where that is decided already

    def within(self, binds: int) -> str:
        """Text of an operand of an operator that binds as tightly as this."""
        return self.text if self.binds >= binds else f"({self.text})"

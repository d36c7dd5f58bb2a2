"""How C writes what a kernel does."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

from contactlaw.emit.types import DOUBLE, INT, Array, Row, Struct, Type, Value, traced

_WIDTH = 100
Variables = Sequence[tuple[Type, str]]


def _wrapped(line: str) -> str:
    """Break a line that is too long at its spaces."""
    if len(line) <= _WIDTH:
        return line
    indent = line[: len(line) - len(line.lstrip())] + 8 * " "
    broken = textwrap.wrap(
        line, _WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
    return "\n".join(broken)


class C:
    """C99 that is C++11, CUDA, HIP and OpenCL C too; names get a prefix.

    Structures are made by functions, since a literal of one is not C++.
    """

    reserved = frozenset(
        "auto both char class const delete double else enum extern far float goto int long near "
        "new operator private public register short signed static struct switch template this "
        "union unsigned void".split()
    )

    def __init__(self, prefix: str = "contactlaw_") -> None:
        self._prefix = prefix

    def name(self, name: str) -> str:
        """Write a name that the program gives."""
        return self._prefix + name

    def variable(self, name: str) -> str:
        """Write the name of a variable."""
        return f"{name}_" if name in self.reserved else name

    def number(self, value: float) -> str:
        """Write a number."""
        if math.isnan(value):
            return "(double)NAN"
        return repr(value) if math.isfinite(value) else "-HUGE_VAL"[value > 0 :]

    def type(self, kind: Type) -> str:
        """Write a type, with a space if a name may follow directly."""
        if isinstance(kind, Array):
            return self.name("data *") if kind.data else "double *"
        if isinstance(kind, Struct):
            return f"{self.name(kind.name)} "
        if isinstance(kind, Row):
            return f"{self.name(kind.name)} *"
        return f"{kind.name} "

    def make(self, kind: Struct, parts: Sequence[str]) -> str:
        """Make a structure of its members."""
        kept = [one for one, (_, t) in zip(parts, kind.members, strict=True) if traced(t)]
        return f"{self.name(f'make_{kind.name}')}({', '.join(kept)})"

    def member(self, text: str, name: str, kind: Type) -> str:
        """Read a member of a structure."""
        return f"{text}.{self.variable(name)}"

    def row_member(self, text: str, name: str) -> str:
        """Read a member of a row."""
        return f"{text}->{name}"

    def call(self, name: str, texts: Sequence[str]) -> str:
        """Call a function of mathematics."""
        return f"{name}({', '.join(texts)})"

    def extreme(self, name: str, kind: Type, one: str, other: str) -> str:
        """Take the smaller or larger of two numbers as Python does, also of a NaN."""
        return f"{self.name(name)}{'_int' if kind == INT else ''}({one}, {other})"

    def cast(self, name: str, value: Value) -> Value:
        """Convert a number."""
        if name == "abs":
            return Value(value.type, f"fabs({value.text})")
        if name == "int" and value.type == DOUBLE:
            return Value(INT, f"(int){value.within(10)}", 10)
        if name == "float" and value.type == INT:
            return Value(DOUBLE, f"(double){value.within(10)}", 10)
        return value

    def as_double(self, value: Value) -> str:
        """Convert an integer that is to be divided."""
        return f"(double){value.within(10)}"

    def quotient(self, one: str, other: str) -> tuple[str, int]:
        """Divide whole numbers that are not negative."""
        return f"{one} / {other}", 9

    def tail(self, array: Value, index: Value) -> str:
        """Take an array from an element on."""
        return f"{array.within(8)} + {index.within(9)}"

    def filled(self, name: str, size: int, value: str) -> list[str]:
        """Give all elements of an array a value."""
        return [f"{self.name('fill')}({name}, {size}, {value});"]

    def unpacked(self, kind: Struct, text: str, lines: list[str]) -> list[str]:
        """Take a tuple apart; it is `both` in the lines that do it."""
        return [
            "{",
            f"    const {self.type(kind)}both = {text};",
            *(f"    {one}" for one in lines),
            "}",
        ]

    def structure(self, kind: Struct, said: str | None, comments: dict[str, str]) -> str:
        """Declare a structure, and the function that makes it."""
        name, members = self.name(kind.name), [one for one in kind.members if traced(one[1])]
        lines = [f"/* {said.splitlines()[0]} */"] if said and kind.source else []
        lines.append(f"typedef struct {name} {{")
        for one, t in members:
            comment = f" /* {comments[one]} */" if one in comments else ""
            lines.append(f"    {self.type(t)}{self.variable(one)};{comment}")
        lines += [f"}} {name};", ""]
        given = ", ".join(f"{self.type(t)}{self.variable(one)}" for one, t in members)
        lines += [
            f"static inline {name} {self.name(f'make_{kind.name}')}({given})",
            "{",
            f"    {name} made;",
        ]
        lines += [f"    made.{v} = {v};" for v in (self.variable(one) for one, _ in members)]
        return "\n".join(_wrapped(one) for one in [*lines, "    return made;", "}"])

    def row(self, kind: Row) -> str:
        """Declare a row."""
        members = (f"    double {one}[{size}];" if size else f"    double {one};"
                   for one, size in kind.members)  # fmt: skip
        name = self.name(kind.name)
        return "\n".join([f"typedef struct {name} {{", *members, f"}} {name};"])

    def function(
        self, name: str, result: Type, given: Variables, own: Variables, body: list[str], said: str
    ) -> str:
        """Write a function."""
        comment = textwrap.wrap(f"/* {said.replace('`', '')} */", _WIDTH, subsequent_indent=" * ")
        parameters = ", ".join(f"{self.type(kind)}{one}" for kind, one in given) or "void"
        lines = [f"static inline {self.type(result)}{self.name(name)}({parameters})", "{"]
        by_type: dict[str, list[str]] = {}
        for kind, one in own:
            array = isinstance(kind, Array) and not kind.data and kind.shape
            sized = f"{one}[{math.prod(kind.shape)}]" if array else one  # type: ignore[attr-defined]
            by_type.setdefault("double " if array else self.type(kind), []).append(sized)
        for text, names in by_type.items():
            joined = ", *".join(names) if text.endswith("*") else ", ".join(names)
            lines.append(f"    {text}{joined};")
        lines += [*(f"    {line}" for line in body), "}"]
        return "\n".join([*comment, *(_wrapped(line) for line in lines)])

    def data(self, name: str, values: Sequence[float]) -> str:
        """Write an array of constants."""
        numbers = textwrap.wrap(", ".join(map(self.number, values)), _WIDTH)
        return "\n".join([f"static const double {self.name(name)}[] = {{", *numbers, "};"])

    def define(self, name: str, text: str) -> str:
        """Define a constant."""
        return f"#define {self.name(name)} {text if text[0] != '-' else f'({text})'}"

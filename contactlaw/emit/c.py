"""How C writes what a kernel does."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Sequence

from contactlaw.emit.types import Array, Row, Struct, Type, traced

WIDTH = 100
Variables = Sequence[tuple[Type, str]]


def wrapped(line: str, end: str = "") -> str:
    """Break a line that is too long at its spaces."""
    indent = line[: len(line) - len(line.lstrip())] + 8 * " "
    lines = textwrap.wrap(line, WIDTH - len(end), subsequent_indent=indent, break_long_words=False,
                          break_on_hyphens=False)  # fmt: skip
    return line if len(line) <= WIDTH else f"{end}\n".join(lines)


class C:
    """C99 that is C++11, CUDA, HIP and OpenCL C too; names get a prefix.

    `operations` are patterns, how tightly they bind, and how tightly their operands have to. A
    structure is made by ``PREFIXnew``, as a literal of one is not the same in C and in C++.
    """

    operations = {
        "float": ("(double){}", 10, (10,)), "int": ("(int){}", 10, (10,)),
        "abs": ("fabs({})", 12, (0,)), "quotient": ("{} / {}", 9, (9, 10)),
        "tail": ("{} + {}", 8, (8, 9)), "of_row": ("{}->{}", 11, (11, 0)),
    }  # fmt: skip
    head, array, local, unused = "static inline {}{}({})\n{{", "double {}[{}];", "", "(void){};"
    fill, define, data = (
        "{}fill({}, {}, {});",
        "#define {} {}",
        ("static const double {}[] = {{", "};"),
    )
    comment, typed, maths, own = ("/* ", " * ", " */"), True, "", frozenset[str]()
    nan, inf, whole = "(double)NAN", "HUGE_VAL", "_int"  # and what min and max of integers end with
    reserved = frozenset("auto bool both char class const constant delete double else enum extern "
                         "far float global goto half int kernel local long near new operator "
                         "private public register short signed static struct switch template this "
                         "union unsigned void".split())  # fmt: skip

    def __init__(self, prefix: str = "contactlaw_") -> None:
        self.prefix = prefix

    def variable(self, name: str) -> str:
        """Write the name of a variable."""
        return f"{name}_" if name in self.reserved else name

    def number(self, value: float) -> str:
        """Write a number."""
        if math.isinf(value):
            return self.inf if value > 0.0 else f"-{self.inf}"
        return self.nan if math.isnan(value) else repr(value)

    def type(self, kind: Type) -> str:
        """Write a type, with a space if a name may follow directly."""
        if isinstance(kind, Array):
            return f"{self.prefix}data *" * self.typed if kind.data else "double *" * self.typed
        own = self.prefix if isinstance(kind, Struct | Row) else ""
        return f"{own}{kind.name} {'*' * isinstance(kind, Row)}" * self.typed

    def make(self, kind: Struct, parts: dict[str, str]) -> str:
        """Make a structure of its members."""
        return f"{self.prefix}new({kind.name}){{ {', '.join(parts.values())} }}"

    def member(self, text: str, name: str, kind: Type) -> str:
        """Read a member of a structure."""
        return f"{text}.{self.variable(name)}"

    def call(self, name: str, texts: Sequence[str]) -> str:
        """Call a function of mathematics."""
        return f"{self.prefix if name in self.own else self.maths}{name}({', '.join(texts)})"

    def structure(self, kind: Struct | Row, said: str, comments: dict[str, str]) -> str:
        """Declare a structure, or a row, whose members are numbers and arrays of a size."""
        lines = [f"/* {said} */"] if said else []
        lines.append(f"typedef struct {self.prefix}{kind.name} {{")
        for one, t in kind.members:
            if isinstance(kind, Row):
                lines.append(f"    double {one}[{t}];" if t else f"    double {one};")
            elif traced(t):
                comment = f" /* {comments[one]} */" if one in comments else ""
                lines.append(f"    {self.type(t)}{self.variable(one)};{comment}")
        return "\n".join([*map(wrapped, lines), f"}} {self.prefix}{kind.name};"])

    def function(
        self, name: str, result: Type, given: Variables, own: Variables, body: list[str], said: str
    ) -> str:
        """Write a function."""
        begin, line, end = self.comment
        text = f"{begin}{said.replace('`', '')}{end}"
        comment = textwrap.wrap(text, WIDTH, subsequent_indent=line)
        parameters = ", ".join(f"{self.type(kind)}{one}" for kind, one in given)
        parameters = parameters or "void" * self.typed
        lines = self.head.format(self.type(result), self.prefix + name, parameters).split("\n")
        # an array that is assigned to is another name of one
        assigned, by_type = (
            {one.strip().partition(" = ")[0] for one in body},
            dict[str, list[str]](),
        )
        for kind, one in own:
            if isinstance(kind, Array) and kind.shape and not kind.data and one not in assigned:
                lines.append(f"    {self.array.format(one, math.prod(kind.shape))}")
            else:
                by_type.setdefault(self.type(kind), []).append(one)
        for text, names in by_type.items():
            joined = ", *".join(names) if text.endswith("*") else ", ".join(names)
            lines.append(f"    {self.local}{text}{joined};")
        return "\n".join([*comment, *map(wrapped, [*lines, *(f"    {one}" for one in body), "}"])])

    def constant(self, name: str, value: str | Sequence[float]) -> str:
        """Define a constant, a text or an array."""
        name = f"{self.prefix}{name}"
        if isinstance(value, str):
            text = self.define.format(name, value if value[0] != "-" else f"({value})")
            return wrapped(text, " \\" if text.startswith("#") else "")
        numbers = (re.sub(r"\b0(?=\.)", "", self.number(one).removesuffix(".0")) for one in value)
        text = "\n".join(textwrap.wrap(", ".join(numbers), WIDTH)).replace(", ", ",")
        return f"{self.data[0].format(name)}\n{text}\n{self.data[1]}"

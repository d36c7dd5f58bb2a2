"""How JavaScript writes what a kernel does."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

from contactlaw.emit.c import C, Variables
from contactlaw.emit.types import INT, Array, Struct, Type, Value, traced

_WIDTH = 100
HELPERS = """const $min = (one, other) => other < one ? other : one;
const $max = (one, other) => other > one ? other : one;
const $copysign = (x, sign) => sign < 0 || 1 / sign < 0 ? -Math.abs(x) : Math.abs(x);"""


class JavaScript(C):
    """JavaScript without rows; NamedTuples are objects, tuples arrays, arrays Float64Arrays.

    Names begin with $, so that no variable hides them; what Math lacks is in `HELPERS`.
    """

    reserved = frozenset("arguments await case catch class const debugger default delete do enum "
                         "eval export extends function implements in instanceof interface let new "
                         "package private protected public static super switch this throw typeof "
                         "var void with yield both".split())  # fmt: skip

    def __init__(self) -> None:
        super().__init__("$")

    def number(self, value: float) -> str:
        """Write a number."""
        if math.isnan(value):
            return "NaN"
        return repr(value).removesuffix(".0") if math.isfinite(value) else "-Infinity"[value > 0 :]

    def type(self, kind: Type) -> str:
        """Write no type."""
        return ""

    def make(self, kind: Struct, parts: Sequence[str]) -> str:
        """Make an object or an array of its members."""
        named = zip(parts, kind.members, strict=True)
        kept = {name: text for text, (name, one) in named if traced(one)}
        if kind.source is None:
            return f"[{', '.join(kept.values())}]"
        return f"{{ {', '.join(f'{name}: {text}' for name, text in kept.items())} }}"

    def member(self, text: str, name: str, kind: Type) -> str:
        """Read a member of an object or an array."""
        if not isinstance(kind, Struct) or kind.source is not None:
            return f"{text}.{name}"
        names, types = zip(*kind.members, strict=True)
        return f"{text}[{sum(map(traced, types[: names.index(name)]))}]"

    def call(self, name: str, texts: Sequence[str]) -> str:
        """Call a function of mathematics."""
        return f"{'$' if name == 'copysign' else 'Math.'}{name}({', '.join(texts)})"

    def extreme(self, name: str, kind: Type, one: str, other: str) -> str:
        """Take the smaller or larger of two numbers as Python does, also of a NaN."""
        return f"{self.name(name)}({one}, {other})"

    def cast(self, name: str, value: Value) -> Value:
        """Convert a number; all are floats."""
        if name == "int" and value.type != INT:
            return Value(INT, f"Math.trunc({value.text})")
        return Value(value.type, f"Math.abs({value.text})") if name == "abs" else value

    def as_double(self, value: Value) -> str:
        """Write an integer that is to be divided."""
        return value.within(10)

    def quotient(self, one: str, other: str) -> tuple[str, int]:
        """Divide whole numbers."""
        return f"Math.floor({one} / {other})", 12

    def tail(self, array: Value, index: Value) -> str:
        """Take an array from an element on."""
        return f"{array.within(11)}.subarray({index.text})"

    def filled(self, name: str, size: int, value: str) -> list[str]:
        """Give all elements of an array a value."""
        return [f"{name}.fill({value}, 0, {size});"]

    def structure(self, kind: Struct, said: str | None, comments: dict[str, str]) -> str:
        """Declare nothing."""
        return ""

    def function(
        self, name: str, result: Type, given: Variables, own: Variables, body: list[str], said: str
    ) -> str:
        """Write a function."""
        comment = textwrap.wrap(said.partition("\n")[0], _WIDTH - 3)
        lines = [f"function {self.name(name)}({', '.join(one for _, one in given)}) {{"]
        assigned = {line.strip().partition(" = ")[0] for line in body}  # other arrays' names, too
        arrays = {one: math.prod(kind.shape) for kind, one in own if one not in assigned
                  and isinstance(kind, Array) and not kind.data and kind.shape}  # fmt: skip
        lines += [f"    const {one} = new Float64Array({size});" for one, size in arrays.items()]
        plain = [one for _, one in own if one not in arrays]
        lines += [f"    let {', '.join(plain)};"] if plain else []
        lines += [f"    {line}" for line in body if not line.startswith("(void)")]
        return "\n".join([*(f"// {one}" for one in comment), *lines, "}"])

    def data(self, name: str, values: Sequence[float]) -> str:
        """Write an array of constants."""
        numbers = textwrap.wrap(", ".join(map(self.number, values)), _WIDTH)
        return "\n".join([f"const {self.name(name)} = new Float64Array([", *numbers, "]);"])

    def define(self, name: str, text: str) -> str:
        """Define a constant."""
        return f"const {self.name(name)} = {text};"

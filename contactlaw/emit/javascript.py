"""How JavaScript writes what a kernel does."""

from __future__ import annotations

from contactlaw.emit.c import C
from contactlaw.emit.types import Struct, Type, traced

HELPERS = """const $min = (one, other) => other < one ? other : one;
const $max = (one, other) => other > one ? other : one;
const $copysign = (x, sign) => sign < 0 || 1 / sign < 0 ? -Math.abs(x) : Math.abs(x);"""


class JavaScript(C):
    """JavaScript without rows; NamedTuples are objects, tuples arrays, arrays Float64Arrays.

    Names begin with $, so that no variable hides them; what Math lacks is in `HELPERS`.
    """

    operations = {
        "float": ("{}", 10, (10,)), "int": ("Math.trunc({})", 12, (0,)),
        "abs": ("Math.abs({})", 12, (0,)), "quotient": ("Math.floor({} / {})", 12, (9, 10)),
        "tail": ("{}.subarray({})", 11, (11, 0)),
    }  # fmt: skip
    head, array, local, unused = (
        "function {1}({2}) {{",
        "const {} = new Float64Array({});",
        "let ",
        "",
    )
    fill, define, data = (
        "{1}.fill({3}, 0, {2});",
        "const {} = {};",
        ("const {} = new Float64Array([", "]);"),
    )
    comment, typed, maths, own = ("// ", "// ", ""), False, "Math.", frozenset({"copysign"})
    nan, inf, whole = "NaN", "Infinity", ""
    reserved = frozenset("arguments await case catch class const debugger default delete do enum "
                         "eval export extends function implements in instanceof interface let new "
                         "package private protected public static super switch this throw typeof "
                         "var void with yield both".split())  # fmt: skip

    def __init__(self) -> None:
        super().__init__("$")

    def make(self, kind: Struct, parts: dict[str, str]) -> str:
        """Make an object or an array of its members."""
        if kind.source is None:
            return f"[{', '.join(parts.values())}]"
        return f"{{ {', '.join(f'{name}: {text}' for name, text in parts.items())} }}"

    def member(self, text: str, name: str, kind: Type) -> str:
        """Read a member of an object or an array."""
        names = [one for one, t in kind.members if traced(t)]
        is_tuple = isinstance(kind, Struct) and kind.source is None
        return f"{text}[{names.index(name)}]" if is_tuple else f"{text}.{name}"

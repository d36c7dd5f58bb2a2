"""One kernel for certain types of its arguments, written in another language."""

from __future__ import annotations

import ast
import builtins
import inspect
import math
import operator
import re
import textwrap
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from contactlaw.emit.types import DOUBLE, INT, NONE, UNKNOWN, Array, Known, Row, Struct, Type, Value, traced

if TYPE_CHECKING:
    from contactlaw.emit.program import Program

# Operators: how they are written, how tightly they bind, and what they do to known numbers.
_BINARY: dict[type, tuple[str, int, Callable[[Any, Any], Any]]] = {
    ast.Add: ("+", 8, operator.add),
    ast.Sub: ("-", 8, operator.sub),
    ast.Mult: ("*", 9, operator.mul),
    ast.Div: ("/", 9, operator.truediv),
    ast.BitOr: ("|", 3, operator.or_),
    ast.BitAnd: ("&", 4, operator.and_),
}
_COMPARE: dict[type, tuple[str, int, Callable[[Any, Any], Any]]] = {
    ast.Lt: ("<", 6, operator.lt),
    ast.LtE: ("<=", 6, operator.le),
    ast.Gt: (">", 6, operator.gt),
    ast.GtE: (">=", 6, operator.ge),
    ast.Eq: ("==", 5, operator.eq),
    ast.NotEq: ("!=", 5, operator.ne),
    ast.Is: ("==", 5, operator.is_),
    ast.IsNot: ("!=", 5, operator.is_not),
}
_TRUE, _FALSE = (Value(INT, str(n), known=n) for n in (1, 0))


class Function:
    """A kernel and the types of its arguments."""

    def __init__(
        self, program: Program, python: Callable[..., Any], types: tuple[Type, ...]
    ) -> None:
        lines, self._first = inspect.getsourcelines(python)
        self._node: Any = ast.parse(textwrap.dedent("".join(lines))).body[0]
        self._program, self._language, self._python = program, program.language, python
        self._scope = vars(builtins) | python.__globals__ | inspect.getclosurevars(python).nonlocals
        self._parameters = [one.arg for one in self._node.args.args]
        defaults = python.__defaults__ or ()
        given = len(self._parameters) - len(types)
        missing = [program.constant(one).type for one in defaults[len(defaults) - given :]]
        self._types: dict[str, Type] = dict(
            zip(self._parameters, [*types, *missing[: max(given, 0)]], strict=True)
        )
        self._result: Type | None = None

    def infer(self) -> Type:
        """Find the types of all variables, and that of the result."""
        before: Any = None
        while before != (self._types, self._result):
            before = dict(self._types), self._result
            self._block(self._node.body)
        return self._result or Type("void")

    def text(self, name: str) -> str:
        """Write the function."""
        body = self._block(self._node.body)
        words = set(re.findall(r"\w+", " ".join(body)))
        parameters, own = [], []
        for variable, kind in self._types.items():
            name_there = self._language.variable(variable)
            if traced(kind) and (variable in self._parameters or name_there in words):
                place = parameters if variable in self._parameters else own
                place.append((kind, name_there))
        said = inspect.getdoc(self._python) or ""
        unused = [variable for _, variable in parameters if variable not in words]
        body = [f"(void){variable};" for variable in unused] + body
        return self._language.function(name, self.infer(), parameters, own, body, said)

    def _refuse(self, node: Any, remedy: str) -> NoReturn:
        line = self._first + getattr(node, "lineno", 1) - 1
        file = inspect.getsourcefile(self._python)
        raise SyntaxError(
            f"{file}:{line}: {ast.unparse(node)!r} is not in the subset of Python that kernels are "
            f"written in, and cannot be in C or JavaScript; {remedy}"
        )

    # Statements: lists of lines, without the indentation of their block.

    def _block(self, nodes: list[Any]) -> list[str]:
        lines: list[str] = []
        for node in nodes:
            lines += self._statement(node)
            if self._ends(node):
                break
        return lines

    def _ends(self, node: Any) -> bool:
        """Whether nothing after a statement can be reached."""
        if isinstance(node, ast.If):
            known = self._truth(node.test).known
            branch = node.orelse if known is not UNKNOWN and not known else node.body
            return known is not UNKNOWN and any(map(self._ends, branch))
        return isinstance(node, ast.Return | ast.Break | ast.Continue)

    def _statement(self, node: Any) -> list[str]:
        match node:
            case ast.Expr(value=ast.Constant()):
                return []
            case ast.Expr(value=ast.Call()):
                return [f"{self._expression(node.value).text};"]
            case ast.Return(value=None):
                return ["return;"]
            case ast.Return():
                value = self._expression(node.value)
                self._result = self._unified(node, self._result, value.type)
                text = self._converted(value, self._result)
                return [f"return {text};" if traced(self._result) else "return;"]
            case ast.Break():
                return ["break;"]
            case ast.Continue():
                return ["continue;"]
            case ast.Assign(targets=[ast.Tuple() as target]):
                return self._unpack(target, node.value)
            case ast.Assign():
                value = self._expression(node.value)
                return [line for one in node.targets for line in self._assign(one, value)]
            case ast.AnnAssign(value=ast.expr()):
                return self._assign(node.target, self._expression(node.value))
            case ast.AugAssign():
                return self._augment(node)
            case ast.If():
                return self._if(node)
            case ast.While(orelse=[]):
                inside = self._block(node.body)
                return self._braced(f"while ({self._truth(node.test).text}) {{", inside)
            case ast.For(target=ast.Name(), iter=ast.Call(func=ast.Name("range")), orelse=[]):
                return self._for(node)
        self._refuse(node, "use assignments, if, while, for in a range, break and return")

    def _braced(self, head: str, lines: list[str]) -> list[str]:
        if lines and lines[0] == "{" and lines.index("}") == len(lines) - 1:  # a block of its own
            return [head, *lines[1:]]
        return [head, *(f"    {line}" for line in lines), "}"]

    def _augment(self, node: ast.AugAssign) -> list[str]:
        sign, binds, _ = _BINARY.get(type(node.op), ("", 0, None))
        value = self._expression(ast.copy_location(
            ast.BinOp(node.target, node.op, node.value), node
        ))  # fmt: skip
        place = self._expression(node.target).text
        lines = self._assign(node.target, value)
        begin = f"{place} = {place} {sign} "
        if len(lines) == 1 and lines[0].startswith(begin):
            right = self._expression(node.value)
            return [f"{place} {sign}= {right.text if value.type == INT else self._double(right)};"]
        return lines

    def _if(self, node: ast.If) -> list[str]:
        test = self._truth(node.test)
        if test.known is not UNKNOWN:
            return self._block(node.body if test.known else node.orelse)
        body, other = self._block(node.body), self._block(node.orelse)
        if not body and not other:
            return []
        lines = self._braced(f"if ({test.text}) {{", body)
        if len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If) and other[0][:2] == "if":
            return [*lines[:-1], f"}} else {other[0]}", *other[1:]]
        return [*lines[:-1], *self._braced("} else {", other)] if other else lines

    def _for(self, node: Any) -> list[str]:
        bounds = [self._expression(one) for one in node.iter.args]
        start, stop, step = {1: [_FALSE, *bounds, _TRUE], 2: [*bounds, _TRUE], 3: bounds}[len(bounds)]
        self._types[node.target.id] = INT
        body, name = self._block(node.body), self._language.variable(node.target.id)
        if not body:
            return []
        ahead = f"++{name}" if step.known == 1 else f"{name} += {step.text}"
        return self._braced(
            f"for ({name} = {start.text}; {name} < {stop.within(7)}; {ahead}) {{", body
        )

    def _unpack(self, target: Any, node: Any) -> list[str]:
        if isinstance(node, ast.Tuple):
            values = [self._expression(one) for one in node.elts]
            read = [ast.unparse(one) for one in node.elts]
            written = [ast.unparse(one) for one in target.elts]
            if not any(re.search(rf"\b{re.escape(one)}(?!\w)", later)
                       for n, one in enumerate(written) for later in read[n + 1 :]):  # fmt: skip
                pairs = zip(target.elts, values, strict=True)
                return [line for one, value in pairs for line in self._assign(one, value)]
        value = self._expression(node)
        if not isinstance(value.type, Struct):
            self._refuse(node, "unpack tuples only")
        lines = []
        for one, (name, kind) in zip(target.elts, value.type.members, strict=True):
            lines += self._assign(one, Value(kind, self._language.member(f"both", name, value.type)))
        return self._language.unpacked(value.type, value.text, lines)

    def _assign(self, target: Any, value: Value) -> list[str]:
        match target:
            case ast.Name(id="_"):
                return []
            case ast.Name():
                kind = self._unified(target, self._types.get(target.id), value.type)
                self._types[target.id] = kind
                if not traced(kind):
                    return []
                return self._stored(self._language.variable(target.id), value, kind)
            case ast.Subscript(value=base, slice=ast.Slice(lower=None, upper=None)):
                array = self._expression(base)
                return self._language.filled(array.text, math.prod(array.type.shape), value.text)
            case ast.Subscript() | ast.Attribute():
                place = self._expression(target)
                if isinstance(place.type, Array):
                    size = math.prod(place.type.shape)
                    return self._language.filled(place.text, size, value.text)
                stored = place.text != self._language.number(0.0)  # of an array without elements
                return [f"{place.text} = {self._converted(value, place.type)};"] if stored else []
            case ast.Tuple() if isinstance(value.type, Struct):
                members = zip(target.elts, value.type.members, strict=True)
                return [
                    line
                    for one, (name, kind) in members
                    for line in self._assign(
                        one, Value(kind, self._language.member(value.within(11), name, value.type))
                    )
                ]
        self._refuse(target, "assign to names, elements of arrays, and members of rows")

    def _stored(self, name: str, value: Value, kind: Type) -> list[str]:
        if isinstance(kind, Array) and kind.shape and value.text in ("zeros", "empty"):
            size = math.prod(kind.shape)
            return self._language.filled(name, size, "0.0") if value.text == "zeros" else []
        text = self._converted(value, kind)
        return [] if text == name else [f"{name} = {text};"]

    def _unified(self, node: Any, one: Type | None, other: Type) -> Type:
        """Type that holds values of both."""
        if one is None or one == other:
            return other
        if {one, other} == {INT, DOUBLE}:
            return DOUBLE
        if isinstance(one, Array) and isinstance(other, Array) and one.data == other.data:
            return Array(data=one.data)
        if isinstance(one, Struct) and isinstance(other, Struct) and one.source == other.source:
            if [name for name, _ in one.members] == [name for name, _ in other.members]:
                types = tuple(
                    self._unified(node, a, b)
                    for (_, a), (_, b) in zip(one.members, other.members, strict=True)
                )
                if one.source is None:
                    return self._program.tuple_of(types)
                names = [name for name, _ in one.members]
                return self._program.struct(one.source, tuple(zip(names, types, strict=True)))
        self._refuse(node, f"a variable has one type, not {one.name} and {other.name}")

    def _converted(self, value: Value, kind: Type) -> str:
        """Text of a value as another type; a structure of integers may have to become one of floats."""
        if isinstance(kind, Struct) and isinstance(value.type, Struct) and kind != value.type:
            parts = [
                self._converted(Value(one, self._language.member(value.within(11), name, kind)), to)
                for (name, one), (_, to) in zip(value.type.members, kind.members, strict=True)
            ]
            return self._language.make(kind, parts)
        return value.text

    # Expressions

    def _expression(self, node: Any) -> Value:
        match node:
            case ast.Constant():
                return self._program.constant(node.value)
            case ast.Name():
                return self._name(node)
            case ast.Attribute():
                return self._attribute(node)
            case ast.Subscript():
                return self._subscript(node)
            case ast.Tuple():
                parts = [self._expression(one) for one in node.elts]
                made = self._program.tuple_of(tuple(part.type for part in parts))
                return Value(made, self._language.make(made, [part.text for part in parts]))
            case ast.UnaryOp(op=ast.USub()):
                value = self._expression(node.operand)
                known = UNKNOWN if value.known is UNKNOWN else -value.known
                return Value(value.type, f"-{value.within(11)}", 10, known)
            case ast.UnaryOp(op=ast.Not()) | ast.BoolOp() | ast.Compare():
                return self._truth(node)
            case ast.BinOp():
                return self._binary(node)
            case ast.IfExp():
                return self._choice(node)
            case ast.Call():
                return self._call(node)
        self._refuse(node, "use numbers, NamedTuples, arrays, operators and calls of kernels")

    def _name(self, node: ast.Name) -> Value:
        kind = self._types.get(node.id)
        if isinstance(kind, Known):
            known = isinstance(kind.value, int)
            return self._program.constant(kind.value) if known else Value(kind, "", 12, kind.value)
        if kind is not None:
            known = None if kind == NONE else UNKNOWN
            return Value(kind, self._language.variable(node.id), known=known)
        if node.id not in self._scope:
            self._refuse(node, "give the variable a value before it is read")
        return self._global(self._scope[node.id], node.id)

    def _global(self, value: Any, name: str, module: str = "") -> Value:
        named = name if isinstance(value, int | float | np.ndarray | tuple) else ""
        home = (module or self._python.__module__).rpartition(".")[2]
        infinite = isinstance(value, float) and not math.isfinite(value)
        return self._program.constant(value, "" if infinite else named, home)

    def _attribute(self, node: ast.Attribute) -> Value:
        base = self._expression(node.value)
        match base.type:
            case Known(value=ModuleType() as module):
                return self._global(getattr(module, node.attr), node.attr, module.__name__)
            case Known(value=value):
                return self._global(getattr(value, node.attr), node.attr.upper())
            case Struct() as made:
                kind = made.member(node.attr)
                if isinstance(kind, Known):
                    return self._program.constant(kind.value)
                text = self._language.member(base.within(11), node.attr, made)
                return Value(kind, text, 11, None if kind == NONE else UNKNOWN)
            case Row(members=members):
                size = dict(members)[node.attr]
                text = self._language.row_member(base.within(11), node.attr)
                return Value(Array(shape=(size,)) if size else DOUBLE, text, 11)
            case Array(shape=shape) if shape and node.attr == "size":
                return self._program.constant(math.prod(shape))
            case Array(shape=shape) if shape and node.attr == "shape":
                return self._program.constant(shape)
        self._refuse(node, "an array needs a known shape for its size, others have no such member")

    def _subscript(self, node: ast.Subscript) -> Value:
        base = self._expression(node.value)
        if isinstance(base.type, Known):
            index = self._expression(node.slice)
            if index.known is UNKNOWN:
                self._refuse(node, "only a known index picks from a tuple")
            return self._program.constant(base.type.value[index.known])
        if isinstance(base.type, Struct):
            index = self._expression(node.slice)
            name, kind = base.type.members[index.known]
            return Value(kind, self._language.member(base.within(11), name, base.type), 11)
        if not isinstance(base.type, Array):
            self._refuse(node, "only arrays and tuples have elements")
        shape = base.type.shape
        if isinstance(node.slice, ast.Slice):
            lower = self._expression(node.slice.lower)
            return Value(Array(data=base.type.data), self._language.tail(base, lower), 8)
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if 0 in shape:
            return Value(DOUBLE, self._language.number(0.0))
        index = self._expression(parts[0])
        if len(shape) == 2:
            index = Value(INT, f"{index.within(9)} * {shape[1]}", 9)
            if len(parts) == 1:
                kind = Array(data=base.type.data, shape=shape[1:])
                return Value(kind, self._language.tail(base, index), 8)
            index = Value(INT, f"{index.text} + {self._expression(parts[1]).within(9)}", 8)
        elif len(parts) != 1:
            self._refuse(node, "an array of rows needs a known shape")
        return Value(DOUBLE, f"{base.within(11)}[{index.text}]", 11)

    def _binary(self, node: ast.BinOp) -> Value:
        left, right = self._expression(node.left), self._expression(node.right)
        if isinstance(node.op, ast.Pow):
            return Value(DOUBLE, self._language.call("pow", [left.text, self._double(right)]))
        if isinstance(node.op, ast.FloorDiv):
            return Value(INT, *self._language.quotient(left.within(9), right.within(10)))
        if type(node.op) not in _BINARY:
            self._refuse(node, "use + - * / // ** & |")
        sign, binds, act = _BINARY[type(node.op)]
        known = UNKNOWN
        if isinstance(left.known, int) and isinstance(right.known, int):
            known = act(left.known, right.known)
        kind = self._unified(node, left.type, right.type)
        if isinstance(node.op, ast.Div):
            kind, known = DOUBLE, UNKNOWN
            left, right = (Value(DOUBLE, self._double(one), one.binds) for one in (left, right))
        # a known number in a formula of doubles is one of them
        a, b = (
            self._double(one) if kind == DOUBLE and one.known is not UNKNOWN else
            one.within(12 if binds < 5 and one.binds < 11 else binds + (one is right))
            for one in (left, right)
        )  # fmt: skip
        return Value(kind, f"{a} {sign} {b}", binds, known)

    def _double(self, value: Value) -> str:
        """Text of a number that is to be divided as a float."""
        if isinstance(value.known, int) and value.text.lstrip("-").isdigit():
            return f"{value.text}.0"
        if value.type == INT:
            return self._language.as_double(value)
        return value.within(10)

    def _choice(self, node: ast.IfExp) -> Value:
        test = self._truth(node.test)
        if test.known is not UNKNOWN:
            return self._expression(node.body if test.known else node.orelse)
        one, other = self._expression(node.body), self._expression(node.orelse)
        kind = self._unified(node, one.type, other.type)
        texts = (Value(kind, self._converted(part, kind), part.binds) for part in (one, other))
        body, rest = (part.within(1) for part in texts)
        return Value(kind, f"{test.within(1)} ? {body} : {rest}", 0)

    def _truth(self, node: Any) -> Value:
        match node:
            case ast.Compare():
                return self._comparison(node)
            case ast.BoolOp():
                return self._connected(node)
            case ast.UnaryOp(op=ast.Not()):
                value = self._truth(node.operand)
                if value.known is not UNKNOWN:
                    return _FALSE if value.known else _TRUE
                return Value(INT, f"!{value.within(11)}", 10)
        return self._expression(node)

    def _comparison(self, node: ast.Compare) -> Value:
        values = [self._expression(one) for one in (node.left, *node.comparators)]
        texts = []
        for op, left, right in zip(node.ops, values, values[1:], strict=False):
            sign, binds, act = _COMPARE[type(op)]
            if isinstance(op, ast.Is | ast.IsNot):
                same = (left.type == NONE) == (right.type == NONE)
                return _TRUE if same == isinstance(op, ast.Is) else _FALSE
            if UNKNOWN not in (left.known, right.known):
                return _TRUE if act(left.known, right.known) else _FALSE
            texts.append(f"{left.within(8)} {sign} {right.within(8)}")
        return Value(INT, " && ".join(texts), 2 if len(texts) > 1 else binds)

    def _connected(self, node: ast.BoolOp) -> Value:
        either = isinstance(node.op, ast.Or)
        kept = []
        for one in node.values:
            value = self._truth(one)
            if value.known is UNKNOWN:
                kept.append(value)
            elif bool(value.known) == either:
                kept.append(value)
                break
        if not kept or (len(kept) == 1 and kept[0].known is not UNKNOWN):
            return _TRUE if either == bool(kept) else _FALSE
        sign, binds = ("||", 1) if either else ("&&", 2)
        texts = [one.within(3) for one in kept]
        return kept[0] if len(kept) == 1 else Value(INT, f" {sign} ".join(texts), binds)

    def _call(self, node: ast.Call) -> Value:
        if isinstance(node.func, ast.Attribute) and node.func.attr == "view":
            return self._language.bits(
                self._expression(node.func.value), ast.unparse(node.args[0])
            )
        called = self._expression(node.func)
        function = called.known
        if function is UNKNOWN:
            self._refuse(node, "call kernels, NamedTuples, and functions of math")
        if function in (np.zeros, np.empty):
            shape = self._expression(node.args[0])
            size = shape.known if shape.known is not UNKNOWN else tuple(
                self._expression(one).known for one in getattr(node.args[0], "elts", ()))  # fmt: skip
            given = (size,) if isinstance(size, int) else tuple(size)
            return Value(Array(shape=given), function.__name__)
        values = [self._expression(one) for one in node.args]
        if function in (min, max, np.minimum, np.maximum):
            return self._extreme(node, function.__name__[:3], values)
        if function is len and isinstance(values[0].type, Struct):
            return self._program.constant(len(values[0].type.members))
        if function in (int, bool, float, abs) or isinstance(function, type) and issubclass(
            function, np.generic
        ):
            return self._language.cast(function.__name__, values[0])
        if getattr(function, "__module__", "") == "math" or isinstance(function, np.ufunc):
            texts = [one.text if one.type == DOUBLE else self._double(one) for one in values]
            return Value(DOUBLE, self._language.call(function.__name__, texts))
        if isinstance(function, type) and hasattr(function, "_fields"):
            return self._made(node, function, values)
        return self._kernel(node, function, values)

    def _extreme(self, node: Any, name: str, values: list[Value]) -> Value:
        best = values[0]
        for one in values[1:]:
            kind = self._unified(node, best.type, one.type)
            best = Value(kind, self._language.extreme(name, kind, best.text, one.text))
        return best

    def _made(self, node: ast.Call, made: Any, values: list[Value]) -> Value:
        parts = dict(zip(made._fields, values, strict=False))
        parts |= {one.arg: self._expression(one.value) for one in node.keywords if one.arg}
        defaults = {name: self._program.constant(one) for name, one in made._field_defaults.items()}
        parts = defaults | parts
        members = tuple((name, parts[name].type) for name in made._fields)
        kind = self._program.struct(made, tuple(
            (name, Known(value=parts[name].known) if isinstance(one, Known) else one)
            for name, one in members))  # fmt: skip
        return Value(kind, self._language.make(kind, [parts[name].text for name in made._fields]))

    def _kernel(self, node: ast.Call, function: Any, values: list[Value]) -> Value:
        python = getattr(function, "py_func", function)
        if not inspect.isfunction(python):
            self._refuse(node, "call kernels, NamedTuples, and functions of math")
        names = list(inspect.signature(python).parameters)
        by_name = {one.arg: self._expression(one.value) for one in node.keywords if one.arg}
        values = [*values, *(by_name[name] for name in names[len(values) :] if name in by_name)]
        types = tuple(
            Known(value=one.known) if name in self._program.fixed and one.known is not UNKNOWN
            else one.type
            for name, one in zip(names, values, strict=False)
        )  # fmt: skip
        name, result = self._program.add(function, *types)
        texts = [one.text for one, kind in zip(values, types, strict=True)
                 if traced(kind)]  # fmt: skip
        if result == NONE:
            return Value(NONE, "", known=None)
        return Value(result, f"{self._language.name(name)}({', '.join(texts)})")

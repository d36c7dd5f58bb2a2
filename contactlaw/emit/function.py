"""One kernel for certain types of its arguments, written in another language."""

from __future__ import annotations

import ast
import inspect
import math
import re
import textwrap
from collections.abc import Callable
from typing import Any

from contactlaw.emit import types
from contactlaw.emit.expressions import OPERATORS, Expressions
from contactlaw.emit.types import INT, UNKNOWN, VOID, Array, Struct, Type, Value, traced


class Function(Expressions):
    """A kernel of a `Program` and the types of its arguments; statements are lists of lines."""

    def __init__(self, program: Any, python: Callable[..., Any], given: tuple[Type, ...]) -> None:
        lines, first = inspect.getsourcelines(python)
        super().__init__(program, python, first)
        tree: Any = ast.parse(textwrap.dedent("".join(lines)))
        self._node = tree.body[0]
        self._parameters = [one.arg for one in self._node.args.args]
        left = python.__defaults__ or ()
        left = left[len(left) + len(given) - len(self._parameters) :]
        kinds = [*given, *(program.constant(one).type for one in left)]
        self._types = dict(zip(self._parameters, kinds, strict=True))
        self._result: Type | None = None

    def infer(self) -> Type:
        """Find the types of all variables, and that of the result."""
        before: Any = None
        while before != (self._types, self._result):
            before = dict(self._types), self._result
            self._block(self._node.body)
        return self._result or VOID

    def text(self, name: str, said: str) -> str:
        """Write the function, which a comment says something of."""
        body = self._block(self._node.body)
        words = set(re.findall(r"\w+", " ".join(body)))
        given, own = [], []
        for one, kind in self._types.items():
            variable = kind, self._language.variable(one)
            if traced(kind) and one in self._parameters:
                given.append(variable)
            elif traced(kind) and variable[1] in words:
                own.append(variable)
        unused = (self._language.unused.format(one) for _, one in given if one not in words)
        body = [*filter(None, unused), *body]
        return self._language.function(name, self._result or VOID, given, own, body, said)

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
            known = self.value(node.test).known
            branch = node.body if known is UNKNOWN or known else node.orelse
            return known is not UNKNOWN and any(map(self._ends, branch))
        return isinstance(node, ast.Return | ast.Break | ast.Continue)

    def _statement(self, node: Any) -> list[str]:
        match node:
            case ast.Expr(value=ast.Constant()):
                return []
            case ast.Expr(value=ast.Call() as call):
                text = self.value(call).text
                return [f"{text};"] if text else []
            case ast.Return(value=None):
                return ["return;"]
            case ast.Return(value=value):
                found = self.value(value)
                self._result = self.unified(node, self._result, found.type)
                return [f"return {found.text};" if traced(self._result) else "return;"]
            case ast.Break() | ast.Continue():
                return [f"{type(node).__name__.lower()};"]
            case ast.Assign(targets=[ast.Tuple() as target], value=value):
                return self._unpack(target, value)
            case ast.Assign(targets=targets, value=value):
                found = self.value(value)
                return [line for one in targets for line in self._assign(one, found)]
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                return self._assign(target, self.value(value))
            case ast.AugAssign(target=target, op=op, value=right):
                whole = ast.copy_location(ast.BinOp(target, op, right), node)
                lines, found = self._assign(target, self.value(whole)), self.value(right)
                text = found.text if self.value(target).type == INT else self.double(found)
                sign = OPERATORS[type(op)][0]
                return [f"{self.value(target).text} {sign}= {text};"] if lines else []
            case ast.If():
                return self._if(node)
            case ast.While(test=test, body=inside, orelse=[]):
                return self._braced(f"while ({self.value(test).text}) {{", self._block(inside))
            case ast.For(target=ast.Name(), iter=ast.Call(func=ast.Name("range")), orelse=[]):
                return self._for(node)
        self.refuse(node, "use assignments, if, while, for in a range, break and return")

    def _braced(self, head: str, lines: list[str]) -> list[str]:
        if lines and lines[0] == "{" and lines.index("}") == len(lines) - 1:  # a block of its own
            return [head, *lines[1:]]
        return [head, *(f"    {line}" for line in lines), "}"]

    def _if(self, node: ast.If) -> list[str]:
        test = self.value(node.test)
        if test.known is not UNKNOWN:
            return self._block(node.body if test.known else node.orelse)
        body, other = self._block(node.body), self._block(node.orelse)
        lines = self._braced(f"if ({test.text}) {{", body)
        chained = len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If)
        if other and chained and other[0].startswith("if"):
            return [*lines[:-1], f"}} else {other[0]}", *other[1:]]
        lines = [*lines[:-1], *self._braced("} else {", other)] if other else lines
        return lines if body or other else []

    def _for(self, node: Any) -> list[str]:
        bounds = [self.value(one) for one in node.iter.args]
        start, stop = ([types.FALSE, *bounds] if len(bounds) == 1 else bounds)[:2]
        step = bounds[2] if len(bounds) == 3 else types.TRUE
        self._types[node.target.id] = INT
        body, name = self._block(node.body), self._language.variable(node.target.id)
        head = f"for ({name} = {start.text}; {name} < {stop.within(7)}; {name} += {step.text}) {{"
        return self._braced(head, body) if body else []

    def _unpack(self, target: Any, node: Any) -> list[str]:
        if isinstance(node, ast.Tuple):
            later = [ast.unparse(one) for one in node.elts]
            written = [rf"\b{re.escape(ast.unparse(one))}(?!\w)" for one in target.elts]
            if not any(re.search(w, one) for n, w in enumerate(written) for one in later[n + 1 :]):
                pairs = zip(target.elts, [self.value(one) for one in node.elts], strict=True)
                return [line for one, value in pairs for line in self._assign(one, value)]
        whole = self.value(node)
        if not isinstance(whole.type, Struct):
            self.refuse(node, "unpack tuples only")
        both = Value(whole.type, "both")
        pairs = zip(target.elts, [self.member(both, n) for n, _ in whole.type.members], strict=True)
        lines = [line for one, value in pairs for line in self._assign(one, value)]
        head = f"    const {self._language.type(whole.type)}both = {whole.text};"
        return ["{", head, *(f"    {one}" for one in lines), "}"]

    def _assign(self, target: Any, value: Value) -> list[str]:
        match target:
            case ast.Name(id="_"):
                return []
            case ast.Name(id=name):
                kind = self._types[name] = self.unified(target, self._types.get(name), value.type)
                place = Value(kind, self._language.variable(name))
            case ast.Subscript(value=base, slice=ast.Slice(lower=None)):
                place = self.value(base)
            case ast.Subscript() | ast.Attribute():
                place = self.value(target)
            case _:
                self.refuse(target, "assign to names, elements of arrays, and members of rows")
        if not (traced(place.type) and place.text) or value.text in (place.text, "empty"):
            return []
        zeros, language = value.text == "zeros", self._language
        if isinstance(place.type, Array) and (zeros or not isinstance(value.type, Array)):
            number, size = "0.0" if zeros else value.text, math.prod(place.type.shape)
            return [language.fill.format(language.prefix, place.text, size, number)]
        return [f"{place.text} = {value.text};"]

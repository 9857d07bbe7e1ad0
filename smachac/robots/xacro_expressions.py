"""Expressions of xacro, evaluated without Python's `eval`: they may be untrusted.

Literals, names, operators, indices, calls of listed functions, and comprehensions are evaluated.
No attribute of a Python object is read but those of the namespaces of xacro, keys of dictionaries,
and the listed methods.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator, Mapping
from typing import Any

_LARGEST_EXPONENT = 64
"""With a larger one the power of two integers is computed as a float, which has a limited size."""


def _power(base: Any, exponent: Any) -> Any:
    return (base if abs(exponent) <= _LARGEST_EXPONENT else float(base)) ** exponent


_BINARY: Mapping[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: _power,
}
_UNARY: Mapping[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
}
_COMPARE: Mapping[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
}
_METHODS: Mapping[type, frozenset[str]] = {
    str: frozenset(
        [
            "lower",
            "upper",
            "strip",
            "lstrip",
            "rstrip",
            "startswith",
            "endswith",
            "replace",
            "split",
            "join",
            "title",
        ]
    ),
    dict: frozenset(["get", "keys", "values", "items"]),
}
_REFUSED = (type, vars, hash, set, frozenset)
"""Functions of xacro that give access to the insides of Python objects, or whose results differ
from run to run."""


class NotAllowedError(Exception):
    """A part of an expression that is not evaluated."""

    help = "write the value itself, or pass it as an argument of the file"


class Evaluator:
    """Evaluates expressions; a replacement of `xacro.safe_eval`.

    Attributes:
        failed: the last expression that could not be evaluated, empty if there is none.
    """

    def __init__(self, namespace: type[Any], dictionary: type[Any]) -> None:
        self.namespace, self.dictionary = namespace, dictionary
        self.failed = ""

    def __call__(self, text: str, symbols: Any, _: object = None) -> Any:
        """The value of an expression. Raises an exception of any kind if it has none."""
        try:
            return self.value(ast.parse(text.strip(), mode="eval").body, symbols)
        except Exception:
            self.failed = self.failed or text
            raise

    def value(self, node: ast.expr, names: Any) -> Any:
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name):
                return self.name(name, names)
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _UNARY:
                return _UNARY[type(op)](self.value(operand, names))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
                return _BINARY[type(op)](self.value(left, names), self.value(right, names))
            case ast.BoolOp(op=op, values=parts):
                found: Any = None
                for part in parts:
                    found = self.value(part, names)
                    if bool(found) is isinstance(op, ast.Or):
                        break
                return found
            case ast.Compare(left=left, ops=ops, comparators=others):
                return self.compared(self.value(left, names), ops, others, names)
            case ast.IfExp(test=test, body=body, orelse=other):
                return self.value(body if self.value(test, names) else other, names)
            case ast.List(elts=parts):
                return [self.value(part, names) for part in parts]
            case ast.Tuple(elts=parts):
                return tuple(self.value(part, names) for part in parts)
            case ast.Dict(keys=keys, values=parts) if None not in keys:
                pairs = zip(keys, parts, strict=True)
                return {self.value(k, names): self.value(v, names) for k, v in pairs if k}
            case ast.Subscript(value=of, slice=ast.Slice(lower=low, upper=high, step=step)):
                edges = [
                    None if edge is None else self.value(edge, names) for edge in (low, high, step)
                ]
                return self.value(of, names)[slice(*edges)]
            case ast.Subscript(value=of, slice=index):
                return self.value(of, names)[self.value(index, names)]
            case ast.Attribute(value=of, attr=name):
                return self.attribute(self.value(of, names), name)
            case ast.Call(func=func, args=args, keywords=keywords) if all(k.arg for k in keywords):
                given = [self.value(arg, names) for arg in args]
                named = {key.arg: self.value(key.value, names) for key in keywords if key.arg}
                return self.value(func, names)(*given, **named)
            case (
                ast.ListComp(elt=item, generators=loops)
                | ast.GeneratorExp(elt=item, generators=loops)
            ):
                return [self.value(item, inner) for inner in self.loops(loops, names)]
        raise NotAllowedError(f"`{ast.unparse(node)}` is not an expression that is evaluated")

    def name(self, name: str, names: Any) -> Any:
        try:
            return _allowed(names[name], name)
        except KeyError:
            raise NameError(f"the name `{name}` is not defined") from None

    def attribute(self, of: Any, name: str) -> Any:
        if isinstance(of, self.namespace) and name in of:
            return _allowed(of[name], name)
        if isinstance(of, self.dictionary) and name in of:
            return of[name]
        for kind, methods in _METHODS.items():
            if isinstance(of, kind) and name in methods and not isinstance(of, self.namespace):
                return getattr(of, name)
        raise NotAllowedError(f"`.{name}` is not allowed here")

    def compared(
        self, value: Any, ops: list[ast.cmpop], others: list[ast.expr], names: Any
    ) -> bool:
        for op, other in zip(ops, others, strict=True):
            right = self.value(other, names)
            if not _COMPARE[type(op)](value, right):
                return False
            value = right
        return True

    def loops(self, loops: list[ast.comprehension], names: Any) -> Iterator[Any]:
        """The names in each round of a comprehension."""
        if not loops:
            yield names
            return
        first, *rest = loops
        for item in self.value(first.iter, names):
            inner = _Scope(names, _bound(first.target, item))
            if all(self.value(test, inner) for test in first.ifs):
                yield from self.loops(rest, inner)


def _allowed(value: Any, name: str) -> Any:
    if any(value is refused for refused in _REFUSED):
        raise NotAllowedError(f"the function `{name}` is not allowed")
    return value


class _Scope(dict[str, Any]):
    """The names in a comprehension, and those around it."""

    def __init__(self, outer: Any, bound: Mapping[str, Any]) -> None:
        super().__init__(bound)
        self.outer = outer

    def __missing__(self, name: str) -> Any:
        return self.outer[name]

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or name in self.outer


def _bound(target: ast.expr, value: Any) -> dict[str, Any]:
    match target:
        case ast.Name(id=name):
            return {name: value}
        case ast.Tuple(elts=parts):
            pairs = zip(parts, value, strict=True)
            return {
                name: item for part, inner in pairs for name, item in _bound(part, inner).items()
            }
    raise NotAllowedError(f"`{ast.unparse(target)}` is not the name of a value")

"""Random expressions over typed userdata, most of them well-typed, and values for its keys."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from typing import TypeAlias

from smachac.ir.expressions import (
    Attribute,
    Binary,
    Boolean,
    Call,
    Compare,
    Conditional,
    Constant,
    DictDisplay,
    Expr,
    Index,
    Lambda,
    ListDisplay,
    Name,
    TupleDisplay,
    Unary,
)
from smachac.ir.types import Type, parse_type

TYPES: Mapping[str, str] = {
    "flag": "bool",
    "n": "int",
    "m": "int",
    "x": "float<m>",
    "y": "float",
    "s": "str",
    "t": "str",
    "mode": "one_of[open, closed]",
    "whole": "list[int]",
    "reals": "list[float]",
    "words": "list[str]",
    "flags": "list[bool]",
    "three": "float[3]",
    "rows": "list[list[int]]",
    "table": "dict[str, int]",
    "scores": "dict[str, float]",
    "maybe": "int?",
    "note": "str?",
    "speed": "float?",
    "gaps": "list[int?]",
    "point": "Point",
    "pose": "Pose",
}


def key_type(name: str) -> Type:
    found = parse_type(TYPES[name])
    assert found is not None
    return found


INTS = (0, 1, -1, 2, 3, -7, 10, 100, 2**31, -(2**53) - 1, 2**62, 2**63 - 1, -(2**63))
FLOATS = (0.0, -0.0, 0.5, -2.5, 1.0, 3.0, 1e-7, 0.1, 1e16, 123456.789, 1e300, -1e-300, 5e-324)
WORDS = (
    "",
    "a",
    "b",
    "ab",
    "grün",
    "\N{GRINNING FACE}x",
    "open",
    "12",
    " -7\n",
    "1e3",
    "tab\t\"'\\",
)


def value(rng: random.Random, type_: Type) -> object:
    """A random value of a type, edges preferred."""
    match type_.name, type_.args:
        case "bool", _:
            return rng.random() < 0.5
        case "int", _:
            return rng.choice(INTS) if rng.random() < 0.3 else rng.randint(-5, 9)
        case "float", _:
            return rng.choice(FLOATS) if rng.random() < 0.5 else rng.randint(-40, 40) / 8
        case "str", _:
            return rng.choice(WORDS)
        case "one_of", choices:
            return rng.choice(choices)
        case "list", (Type() as item,):
            return [value(rng, item) for _ in range(rng.randint(0, 4))]
        case "array", (Type() as item, int(size)):
            return [value(rng, item) for _ in range(size)]
        case "dict", (Type() as item,):
            return {key: value(rng, item) for key in rng.sample(WORDS, rng.randint(0, 3))}
        case "optional", (Type() as item,):
            return None if rng.random() < 0.4 else value(rng, item)
        case "Point", _:
            return [value(rng, Type("float")) for _ in range(3)]
        case "Pose", _:
            return [value(rng, Type("Point")), [value(rng, Type("float")) for _ in range(4)]]
    raise AssertionError(type_)


def userdata(rng: random.Random) -> dict[str, object]:
    return {name: value(rng, key_type(name)) for name in TYPES}


Make: TypeAlias = Callable[["Source", int], Expr]
ARITHMETIC = ("+", "-", "*", "/", "//", "%", "**")
ORDER = ("<", "<=", ">", ">=", "==", "!=")
MEMBERS = (
    *(("int", "ints"), ("float", "floats"), ("str", "strs"), ("str", "str"), ("str", "table")),
    *(("int", "floats"), ("float", "ints"), ("ints", "rows")),
)
KINDS = ("bool", "int", "float", "str", "ints", "floats", "strs", "table", "maybe", "point")


def key(name: str) -> Expr:
    return Attribute(Name("ud"), name)


class Source:
    """Draws expressions. One in twenty parts has another type than its place wants."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.bound: list[tuple[str, str]] = []

    def some(self, *options: str) -> str:
        return self.rng.choice(options)

    def of(self, kind: str, depth: int) -> Expr:
        if self.rng.random() < 0.05:
            kind = self.some(*KINDS)
        bound = [name for name, its in self.bound if its == kind]
        if bound and self.rng.random() < 0.6:
            return Name(self.some(*bound))
        if depth <= 0 or self.rng.random() < 0.15:
            return self.rng.choice(LEAVES[kind])(self, depth)
        if self.rng.random() < 0.15:
            return self.any_form(kind, depth - 1)
        return self.rng.choice(FORMS[kind])(self, depth - 1)

    def any_form(self, kind: str, depth: int) -> Expr:
        """A form that a value of every kind may have."""
        if self.rng.random() < 0.5:
            test, then, otherwise = (
                self.of("bool", depth),
                self.of(kind, depth),
                self.of(kind, depth),
            )
            return Conditional(test, then, otherwise)
        word = self.some("and", "or")
        first = "maybe" if kind == "int" and word == "or" and self.rng.random() < 0.5 else kind
        return Boolean(word, (self.of(first, depth), self.of(kind, depth)))

    def several(self, kind: str, depth: int, least: int = 0, most: int = 3) -> tuple[Expr, ...]:
        return tuple(self.of(kind, depth) for _ in range(self.rng.randint(least, most)))

    def function(self, item: str, result: str, depth: int) -> Lambda:
        name = f"v{len(self.bound)}"
        self.bound.append((name, item))
        body = self.of(result, depth)
        self.bound.pop()
        return Lambda(name, body)

    def number(self, depth: int) -> Expr:
        return self.of(self.some("int", "float", "int", "float", "bool", "maybe"), depth)

    def arithmetic(self, depth: int) -> Expr:
        return Binary(self.some(*ARITHMETIC), self.number(depth), self.number(depth))

    def order(self, depth: int) -> Expr:
        kind = self.some("int", "float", "str", "ints", "floats", "number", "maybe", "strs")
        part = self.number if kind == "number" else lambda depth: self.of(kind, depth)
        rest = [(self.some(*ORDER), part(depth)) for _ in range(self.rng.choice((1, 1, 2, 3)))]
        return Compare(part(depth), tuple(rest))

    def equality(self, depth: int) -> Expr:
        one, other = self.some(*KINDS), self.some(*KINDS)
        other = one if self.rng.random() < 0.7 else other
        word = self.some("==", "!=")
        right = Constant(None) if self.rng.random() < 0.2 else self.of(other, depth)
        return Compare(self.of(one, depth), ((word, right),))

    def membership(self, depth: int) -> Expr:
        item, items = self.rng.choice(MEMBERS)
        return Compare(self.of(item, depth), ((self.some("in", "not in"), self.of(items, depth)),))

    def sequence(self, depth: int) -> Expr:
        return self.of(self.some("ints", "floats", "strs", "str", "table", "rows"), depth)

    def extreme(self, kind: str, item: str, depth: int) -> Expr:
        name = Name(self.some("min", "max"))
        if self.rng.random() < 0.4:
            return Call(name, self.several(item, depth, 2, 3))
        if self.rng.random() < 0.5:
            return Call(name, (self.of(kind, depth),))
        result = self.some("int", "float", "str")
        return Call(name, (self.of(kind, depth),), (("key", self.function(item, result, depth)),))

    def ordered(self, kind: str, item: str, depth: int) -> Expr:
        named: list[tuple[str, Expr]] = []
        if self.rng.random() < 0.5:
            named.append(("reverse", self.of("bool", depth)))
        if self.rng.random() < 0.5:
            named.append(("key", self.function(item, self.some("int", "float", "str"), depth)))
        return Call(Name("sorted"), (self.of(kind, depth),), tuple(named))


def _call(name: str, *kinds: str) -> Make:
    return lambda g, depth: Call(Name(name), tuple(g.of(kind, depth) for kind in kinds))


def _keys(*names: str) -> Make:
    return lambda g, depth: key(g.some(*names))


def _binary(word: str, left: str, right: str) -> Make:
    return lambda g, depth: Binary(word, g.of(left, depth), g.of(right, depth))


def _index(owner: str, place: str = "int") -> Make:
    return lambda g, depth: Index(g.of(owner, depth), g.of(place, depth))


def _display(item: str) -> Make:
    return lambda g, depth: ListDisplay(g.several(item, depth))


def _small(g: Source, depth: int) -> Expr:
    found = Constant(g.rng.choice((0, 1, 2, 3, 7)))
    return Unary("-", found) if g.rng.random() < 0.3 else found


def _constants(*values: bool | int | float | str | None) -> Make:
    return lambda g, depth: Constant(g.rng.choice(values))


LEAVES: Mapping[str, list[Make]] = {
    "bool": [_keys("flag"), _constants(True, False)],
    "int": [_keys("n", "m"), _keys("n", "m"), _small, _constants(0, 1, 5, 2**40, 2**63 - 1)],
    "float": [_keys("x", "y"), _keys("x", "y"), _constants(0.0, 0.5, 2.5, 1e16, 0.1)],
    "str": [_keys("s", "t", "mode"), _constants(*WORDS)],
    "ints": [_keys("whole"), lambda g, depth: Call(Name("range"), (Constant(4),))],
    "floats": [_keys("reals", "three")],
    "strs": [_keys("words")],
    "rows": [_keys("rows")],
    "table": [_keys("table", "scores")],
    "maybe": [_keys("maybe", "speed", "note"), _constants(None)],
    "point": [_keys("point"), lambda g, depth: Index(key("pose"), Constant(0))],
}

FORMS: Mapping[str, list[Make]] = {
    "bool": [
        Source.order,
        Source.order,
        Source.equality,
        Source.membership,
        lambda g, depth: Unary("not", g.of(g.some(*KINDS), depth)),
        lambda g, depth: Boolean(
            g.some("and", "or"), g.several(g.some("bool", "bool", "int"), depth, 2, 3)
        ),
        lambda g, depth: Call(Name("bool"), (g.of(g.some(*KINDS), depth),)),
        lambda g, depth: Index(key("flags"), g.of("int", depth)),
    ],
    "int": [
        lambda g, depth: Binary(
            g.some("+", "-", "*", "//", "%"), g.of("int", depth), g.of("int", depth)
        ),
        lambda g, depth: Binary("**", g.of("int", depth), Constant(g.rng.choice((0, 1, 2, 3, 5)))),
        Source.arithmetic,
        lambda g, depth: Unary(g.some("-", "+"), g.of("int", depth)),
        lambda g, depth: Call(Name("len"), (g.sequence(depth),)),
        lambda g, depth: Call(Name(g.some("abs", "int", "round")), (g.number(depth),)),
        _call("int", "str"),
        _call("sum", "ints"),
        _index("ints"),
        _index("table", "str"),
        lambda g, depth: g.extreme("ints", "int", depth),
        lambda g, depth: Index(key("gaps"), g.of("int", depth)),
    ],
    "float": [
        lambda g, depth: Binary(g.some(*ARITHMETIC), g.of("float", depth), g.of("float", depth)),
        Source.arithmetic,
        Source.arithmetic,
        lambda g, depth: Unary(g.some("-", "+"), g.of("float", depth)),
        lambda g, depth: Call(Name("float"), (g.number(depth),)),
        _call("float", "str"),
        _call("abs", "float"),
        lambda g, depth: Call(
            Name("round"), (g.of("float", depth), Constant(g.rng.choice((0, 1, 2, 5, 17, 400))))
        ),
        lambda g, depth: Call(
            Name("sum"), (g.of("floats", depth), *g.several("float", depth, 0, 1))
        ),
        _index("floats"),
        _index("point"),
        lambda g, depth: g.extreme("floats", g.some("float", "float", "int"), depth),
    ],
    "str": [
        _binary("+", "str", "str"),
        _binary("*", "str", "int"),
        _binary("*", "int", "str"),
        lambda g, depth: Call(Name("str"), (g.of(g.some(*KINDS), depth),)),
        _call("str", "int"),
        _call("str", "float"),
        _index("str"),
        _index("strs"),
        lambda g, depth: g.extreme("strs", "str", depth),
        lambda g, depth: g.extreme("table", "str", depth),
    ],
    "ints": [
        _display("int"),
        _display("int"),
        lambda g, depth: TupleDisplay(g.several("int", depth)),
        _binary("+", "ints", "ints"),
        _binary("*", "ints", "int"),
        _index("rows"),
        lambda g, depth: Call(Name("range"), g.several("int", depth, 1, 3)),
        _call("list", "ints"),
        _call("tuple", "ints"),
        lambda g, depth: g.ordered("ints", "int", depth),
    ],
    "floats": [
        _display("float"),
        lambda g, depth: ListDisplay(tuple(g.number(depth) for _ in range(3))),
        _binary("+", "floats", "floats"),
        _binary("+", "floats", "ints"),
        _binary("*", "int", "floats"),
        _call("list", "floats"),
        lambda g, depth: g.ordered("floats", "float", depth),
    ],
    "strs": [
        _display("str"),
        lambda g, depth: TupleDisplay(g.several("str", depth, 1, 3)),
        _binary("+", "strs", "strs"),
        _call("list", "str"),
        _call("sorted", "table"),
        lambda g, depth: g.ordered("strs", "str", depth),
        lambda g, depth: g.ordered("str", "str", depth),
    ],
    "rows": [_display("ints"), _binary("+", "rows", "rows"), _call("sorted", "rows")],
    "table": [
        lambda g, depth: DictDisplay(
            tuple((g.of("str", depth), g.of("int", depth)) for _ in range(g.rng.randint(0, 3)))
        ),
        lambda g, depth: Call(
            Name("dict"), (), (("a", g.of("int", depth)), ("b", g.of("int", depth)))
        ),
        _call("dict", "table"),
    ],
    "maybe": [
        lambda g, depth: Conditional(
            g.of("bool", depth), g.of(g.some("int", "float", "str"), depth), Constant(None)
        ),
        lambda g, depth: Index(key("gaps"), g.of("int", depth)),
    ],
    "point": [
        lambda g, depth: Conditional(
            g.of("bool", depth), key("point"), Index(key("pose"), Constant(0))
        ),
    ],
}


def expression(rng: random.Random) -> Expr:
    source = Source(rng)
    return source.of(source.some(*FORMS), rng.choice((1, 2, 2, 3, 3, 4)))

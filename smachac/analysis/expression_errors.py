"""Type errors in portable expressions.

An expression of unknown type has no error. Errors in parts that only some runs evaluate are marked.
A part that is guarded by a condition over a key has no error because of that key: the condition may
exclude the error.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple, TypeAlias

from smachac.analysis.expression_types import ATTRIBUTES, Names, body_of, keys_named, type_of
from smachac.analysis.type_lattice import (
    fields,
    item_of,
    length_of,
    mapping,
    misfit,
    unit_of,
    widened,
)
from smachac.analysis.units import FULL_TURN, conversion
from smachac.diagnostics.spelling import guesser
from smachac.ir.expressions import (
    Attribute,
    Binary,
    Boolean,
    Call,
    Compare,
    Conditional,
    Constant,
    Expr,
    Index,
    Lambda,
    Name,
    Unary,
    dotted,
    parts,
    print_expression,
)
from smachac.ir.nodes import Expression
from smachac.ir.script_code import script_code
from smachac.ir.types import Type
from smachac.records import dataclass, replace

FaultKind: TypeAlias = Literal["operation", "comparison", "unit", "doubt"]
"""The operation fails; the result of the comparison is always the same; the units differ; a number
seems to be in another unit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A type error in an expression.

    `what` is its description in a message, `keys` are the userdata keys in it. `always`: every
    evaluation of the whole expression evaluates this part. `word` is the name in the script instead
    of one of `choices`; `length`: the number of items is wrong, or an entry of a mapping of the
    script is missing, which hold while no state changes the value. `effect`: what happens if the
    fault is left, where that of the rule does not hold. `units`: the text of a number,
    its unit, and the unit of the other number. `entry`: the code that reads an entry of a mapping,
    which is meant.
    """

    kind: FaultKind
    expr: Expr
    what: str
    keys: tuple[str, ...] = ()
    always: bool = True
    help: str | None = None
    word: str = ""
    choices: tuple[str, ...] = ()
    length: bool = False
    effect: str | None = None
    units: tuple[str, str, str] | None = None
    entry: str = ""


EMPTY = mapping(())
"""The type of userdata without keys."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """A part of an expression, and the keys in the conditions before it."""

    expr: Expr
    always: bool = True
    guards: frozenset[str] = frozenset()


def expression_faults(
    expr: Expr,
    userdata: Type = EMPTY,
    parameters: tuple[str, ...] = (),
    others: Mapping[str, Type] = {},
) -> tuple[Fault, ...]:
    """The faults of an expression, outer parts first. `parameters` are the names of userdata,
    whose type is a record of its keys, `others` other names, which count as keys. Total."""
    judge = _Judge({**dict.fromkeys(parameters, userdata), **others}, parameters)
    found: list[Fault] = []
    todo = [_Part(expr=expr)]
    while todo:
        part = todo.pop()
        if isinstance(part.expr, Constant | Name):
            continue
        for fault in judge.judged(part.expr):
            if part.guards.isdisjoint(fault.keys):
                found.append(fault if part.always else _seldom(fault))
        todo.extend(reversed(list(judge.inside(part))))
    return tuple(found)


def function_faults(text: str, userdata: Type) -> tuple[Fault, ...]:
    """The faults of a function of the script over userdata, a record of the keys it reads. Code
    that is not portable has none. By text, as trees with `1` and `True` are alike."""
    tree = script_code(text).portable
    if tree is None:
        return ()
    body, parameters = body_of(tree)
    return expression_faults(body, userdata, parameters)


def always_fails(expression: Expression, userdata: Names) -> bool:
    """Whether a function of the script never gives a value, over the types of the keys it reads."""
    found = function_faults(expression.text, mapping(userdata.items()))
    return any(fault.kind == "operation" and fault.always and not fault.length for fault in found)


def _names(expr: Expr) -> Iterator[str]:
    """The names in an expression."""
    todo = [expr]
    while todo:
        expr = todo.pop()
        if isinstance(expr, Name):
            yield expr.name
        todo.extend(reversed(parts(expr)))


def _seldom(fault: Fault) -> Fault:
    return replace(fault, always=False)


class _Judge:
    """The names of one expression."""

    def __init__(self, names: Names, parameters: tuple[str, ...]) -> None:
        self.names = names
        self.parameters = parameters
        self.others = names.keys() - set(parameters)

    def type(self, expr: Expr) -> Type:
        return type_of(expr, self.names)

    def keys(self, *exprs: Expr) -> tuple[str, ...]:
        found = [key for expr in exprs for key in keys_named(expr, self.parameters)]
        if self.others:
            found += [name for expr in exprs for name in _names(expr) if name in self.others]
        return tuple(dict.fromkeys(found))

    def inside(self, part: _Part) -> Iterator[_Part]:
        """The parts of a part, in the order in which they are evaluated."""

        def sure(expr: Expr) -> _Part:
            return _Part(expr=expr, always=part.always, guards=part.guards)

        def perhaps(expr: Expr, *asked: Expr) -> _Part:
            guards = part.guards.union(self.keys(*asked))
            return _Part(expr=expr, always=False, guards=guards)

        def after(asked: Iterable[Expr], exprs: Iterable[Expr]) -> Iterator[_Part]:
            guards = part.guards.union(self.keys(*asked))
            for expr in exprs:
                yield _Part(expr=expr, always=False, guards=guards)
                guards = guards.union(self.keys(expr))

        match part.expr:
            case Lambda():
                # What it will be called with is not known.
                return
            case Conditional(test, then, otherwise):
                yield sure(test)
                yield perhaps(then, test)
                yield perhaps(otherwise, test)
            case Boolean(_, exprs):
                yield sure(exprs[0])
                yield from after(exprs[:1], exprs[1:])
            case Compare(first, rest):
                second, *others = (expr for _, expr in rest)
                yield from map(sure, (first, second))
                yield from after((first, second), others)
            case _:
                yield from map(sure, parts(part.expr))

    def judged(self, expr: Expr) -> Iterator[Fault]:
        """What is wrong with an expression, not counting its parts."""
        match expr:
            case Attribute(Name(name), _) if name in self.parameters:
                return
            case Index(Name(name), _) if name in self.parameters:
                return
            case Attribute(value, name):
                yield from self.attribute(expr, value, name)
            case Index(value, index):
                yield from self.index(expr, value, index)
            case Call():
                yield from self.call(expr)
            case Unary(word, operand) if word != "not":
                type_ = self.type(operand)
                if not can_be_negated(type_):
                    does = f"uses `{type_text(type_)}` as a number"
                    yield self.fault(expr, does, operand, help=f"remove the `{word}`")
            case Binary(word, left, right):
                yield from self.binary(expr, word, left, right)
            case Compare(first, rest):
                for word, operand in rest:
                    pair = Compare(first, ((word, operand),))
                    for fault in self.compare(pair, word, first, operand):
                        # Later pairs are compared only if the first ones hold.
                        yield fault if operand is rest[0][1] else _seldom(fault)
                    first = operand

    def fault(self, expr: Expr, does: str, *of: Expr, help: str | None = None) -> Fault:
        text = f"`{print_expression(expr)}` {does}"
        return Fault(kind="operation", expr=expr, what=text, keys=self.keys(*of), help=help)

    def attribute(self, expr: Expr, value: Expr, name: str) -> Iterator[Fault]:
        type_ = self.type(value)
        entry = ""
        if not has_attribute(type_, name):
            near = guesser(_attributes(type_))(name)
            help: str | None = f"remove `.{name}`, or use a value of another type"
            if near is not None:
                help = f"did you mean `{near}`?"
            if ATTRIBUTES.get(type_.name):
                help = None  # the nearest of its attributes
            elif kinds(type_) == {"mapping"} and near is None:
                entry = print_expression(Index(value, Constant(name)))
                help = None
            yield Fault(
                kind="operation",
                expr=expr,
                what=f"`{print_expression(expr)}` reads an attribute that"
                f" `{type_text(type_)}` does not have",
                keys=self.keys(value),
                help=help,
                word=name,
                choices=tuple(ATTRIBUTES.get(type_.name, ())),
                entry=entry,
            )

    def index(self, expr: Expr, value: Expr, index: Expr) -> Iterator[Fault]:
        owner, place = self.type(value), self.type(index)
        if not can_be_indexed(owner, place):
            found = kinds(owner)
            help = "remove the index: the value is not a list"
            does = f"reads an item of `{type_text(owner)}`, which has no items"
            if found & {"text", "list", "mapping"}:
                does = f"uses `{type_text(place)}` as an index of `{type_text(owner)}`"
                help = "use a number as the index: the first item is `[0]`"
                if found == {"mapping"}:
                    help = "use text as the index: the name of an entry"
            yield self.fault(expr, does, value, index, help=help)
            return
        size = _size(owner)
        known = place.args[0] if place.name == "literal" and len(place.args) == 1 else None
        closed = owner.name in ("record", "mapping")
        if isinstance(known, str) and closed and known not in fields(owner):
            lacks = f"`{owner}` lacks"
            if owner.name == "mapping":
                lacks = "the mapping in the script lacks"
            yield Fault(
                kind="operation",
                expr=expr,
                what=f"`{print_expression(expr)}` reads the field `{known}`, which {lacks}",
                keys=self.keys(value, index),
                word=known,
                choices=tuple(fields(owner)),
                length=owner.name == "mapping",
            )
        if isinstance(known, int) and size is not None and not -size <= known < size:
            count = f"{size} item{'s' if size != 1 else ''}"
            text = f"`{print_expression(expr)}` is out of range: `{type_text(owner)}` has {count}"
            last = f"use an index up to `[{size - 1}]`" if size else None
            keys = self.keys(value, index)
            yield Fault(kind="operation", expr=expr, what=text, keys=keys, help=last, length=True)

    def binary(self, expr: Expr, word: str, left: Expr, right: Expr) -> Iterator[Fault]:
        one, other = self.type(left), self.type(right)
        if word in ("/", "//", "%") and _is_zero(right) and "text" not in kinds(one):
            yield self.fault(expr, "divides by zero", left, help="divide by a number other than 0")
        elif fails(word, one, other):
            does = _DOES[word].format(type_text(one), type_text(other))
            help = _cure(word, one, other, left, right)
            yield self.fault(expr, does, left, right, help=help)
        elif word in ("+", "-", "%"):
            yield from self.units(expr, one, other, left, right)

    def compare(self, expr: Expr, word: str, left: Expr, right: Expr) -> Iterator[Fault]:
        one, other = self.type(left), self.type(right)
        if fails(word, one, other):
            does = _DOES.get(word, "compares `{}` with `{}`")
            does = does.format(type_text(one), type_text(other))
            help = _cure(word, one, other, left, right)
            yield self.fault(expr, does, left, right, help=help)
            return
        if word in ("in", "not in"):
            other = item_of(other) if kinds(other) == {"list"} else Type("any")
        if word in _EQUAL and never_equal(one, other):
            found = self.comparison(expr, word, one, other, self.keys(left, right))
            mixed = {*kinds(one), *kinds(other)} == {"number", "text"}
            bare = _without_quotes(left, right) if mixed else None
            yield replace(found, help=bare) if bare is not None else found
        elif word not in ("in", "not in"):
            yield from self.units(expr, one, other, left, right)
            yield from self.angles(expr, (one, right), (other, left), keys=self.keys(left, right))

    def angles(
        self, expr: Expr, *sides: tuple[Type, Expr], keys: tuple[str, ...]
    ) -> Iterator[Fault]:
        """A whole number of more than a full turn that is compared with an angle in radians."""
        for type_, side in sides:
            number = _whole_number(side) if unit_of(type_) == "rad" else None
            if number is None or abs(number) <= FULL_TURN:
                continue
            text = f"`{print_expression(expr)}` compares a value in `rad` with {number}"
            yield Fault(
                kind="doubt",
                expr=expr,
                what=f"{text}: is it in degrees?",
                keys=keys,
                help=f"write `{math.radians(number):.4g}`, which is {number} degrees in radians",
                effect="the comparison decides wrongly, or always in the same way",
            )

    def comparison(
        self, expr: Expr, word: str, one: Type, other: Type, keys: tuple[str, ...]
    ) -> Fault:
        result = "true" if word.startswith(("!", "not")) else "false"
        text = f"`{print_expression(expr)}` is always {result}: "
        chosen, given = (one, other) if one.name == "one_of" else (other, one)
        if chosen.name == "one_of" and given.name in ("one_of", "literal"):
            return Fault(
                kind="comparison",
                expr=expr,
                what=f"{text}`{chosen}` has no value {' or '.join(f'`{v}`' for v in given.args)}",
                keys=keys,
                word=str(given.args[0]),
                choices=tuple(map(str, chosen.args)),
            )
        text += f"`{type_text(one)}` never equals `{type_text(other)}`"
        help = f"compare with a value of the type `{type_text(one)}`"
        if {*kinds(one), *kinds(other)} == {"number", "text"}:
            help += "; if the text contains a number, `float(...)` converts it"
        return Fault(kind="comparison", expr=expr, what=text, keys=keys, help=help)

    def units(self, expr: Expr, one: Type, other: Type, left: Expr, right: Expr) -> Iterator[Fault]:
        if {one.name, other.name} <= {"int", "float"}:
            clash = misfit(one, Type("float", other.args))
            if clash is not None and clash.kind == "unit":
                text = f"`{print_expression(expr)}` combines `{one}` and `{other}`"
                yield Fault(
                    kind="unit",
                    expr=expr,
                    what=text,
                    keys=self.keys(left, right),
                    help=_in_one_unit(unit_of(one), unit_of(other), print_expression(right)),
                    effect=_no_meaning(unit_of(one), unit_of(other)),
                    units=(print_expression(right), unit_of(other), unit_of(one)),
                )

    def mixed(self, expr: Call) -> Iterator[Fault]:
        """The first argument of a call that has another unit than the one before it."""
        for left, right in itertools.pairwise(expr.arguments):
            found = [*self.units(expr, self.type(left), self.type(right), left, right)]
            if found:
                yield found[0]
                return

    def call(self, expr: Call) -> Iterator[Fault]:
        text = dotted(expr.function)
        if text is None or text.partition(".")[0] in self.names:
            type_ = self.type(expr.function)
            if isinstance(expr.function, Name) and text in self.parameters:
                return
            if not can_be_called(type_):
                does = f"calls a value of the type `{type_text(type_)}`, which is no function"
                help = f"remove the parentheses: write `{print_expression(expr.function)}`"
                if len(expr.arguments) == 1 and kinds(type_) <= {"text", "list", "mapping"}:
                    item = print_expression(Index(expr.function, expr.arguments[0]))
                    help += f", or `{item}` for one item of it"
                yield self.fault(expr, does, expr.function, help=help)
            return
        signature = SIGNATURES.get(text)
        if signature is None:
            return
        least, most, keywords, alone, many = signature
        given = len(expr.arguments)
        if text in ("max", "min") and given > 1:
            yield from self.mixed(expr)
        unknown = [name for name, _ in expr.keywords if name not in keywords]
        if unknown:
            does = f"passes the argument `{unknown[0]}` to `{text}`, which does not accept it"
            yield self.fault(expr, does, help=f"remove `{unknown[0]}=`")
        elif given > most or (given < least and not expr.keywords):
            count = f"{given} argument{'s' if given != 1 else ''}"
            due = (
                f"{least}"
                if least == most
                else f"{least} to {most}"
                if given > most
                else f"{least}"
            )
            help = f"pass {due} argument{'s' if due != '1' else ''} to `{text}`"
            yield self.fault(expr, f"passes {count} to `{text}`, which accepts {due}", help=help)
        elif given:
            type_ = self.type(expr.arguments[0])
            found, wanted = kinds(type_), alone if given == 1 else many
            if found and wanted and found.isdisjoint(wanted):
                does = f"passes `{type_text(type_)}` to `{text}`, which does not accept it"
                kind_words = " or ".join(sorted(_KIND_WORDS[kind] for kind in wanted))
                help = f"pass {kind_words} to `{text}`"
                yield self.fault(expr, does, expr.arguments[0], help=help)


_EQUAL = ("==", "!=", "in", "not in")

_DOES: Mapping[str, str] = {
    "+": "adds `{}` and `{}`",
    "-": "subtracts `{1}` from `{0}`",
    "*": "multiplies `{}` by `{}`",
    **dict.fromkeys(("/", "//", "%"), "divides `{}` by `{}`"),
    "**": "raises `{}` to the power of `{}`",
    **dict.fromkeys(("in", "not in"), "looks for `{}` in `{}`"),
}


def type_text(type_: Type) -> str:
    """A type as part of a message."""
    return str(widened(type_))


def _is_zero(expr: Expr) -> bool:
    return isinstance(expr, Constant) and expr.value == 0 and not isinstance(expr.value, bool)


def _size(type_: Type) -> int | None:
    """The number of items, if it is known."""
    return {"Point": 3, "Quaternion": 4}.get(type_.name, length_of(type_))


def _without_quotes(left: Expr, right: Expr) -> str | None:
    """The help for a number that is written as a text: one side of an operation."""
    for item in (left, right):
        text = item.value if isinstance(item, Constant) else None
        if isinstance(text, str) and re.fullmatch(r"-?\d+(\.\d+)?", text):
            return f"write `{text}` without quotes"
    return None


def _cure(word: str, one: Type, other: Type, left: Expr, right: Expr) -> str | None:
    both = {*kinds(one), *kinds(other)}
    if both == {"number", "text"}:
        bare = _without_quotes(left, right)
        if bare is not None:
            return bare
        if word == "+":
            return "convert the number with `str(...)`, or text that is a number with `float(...)`"
        return "convert a text that contains a number with `float(...)`"
    if "nothing" in both:
        return "give it a value: the script sets it only to nothing (`null`)"
    if word == "+" and both > {"list"}:
        return "write the value as a list as well, in brackets: `[...]`"
    if both > {"list"}:
        return "use an item of the list, such as the first one: `[0]`"
    return f"use two values of one type: `{type_text(one)}` or `{type_text(other)}`"


Kinds = frozenset[str]

ANYTHING: Kinds = frozenset()
"""The kinds of a value of unknown type."""

_KINDS: Mapping[str, Kinds] = {
    **dict.fromkeys(("bool", "int", "float"), frozenset(["number"])),
    "str": frozenset(["text"]),
    "none": frozenset(["nothing"]),
    **dict.fromkeys(("list", "array", "tuple"), frozenset(["list"])),
    **dict.fromkeys(("dict", "mapping", "record"), frozenset(["mapping"])),
    **dict.fromkeys(ATTRIBUTES, frozenset(["struct"])),
}

_KIND_WORDS: Mapping[str, str] = {
    "number": "a number",
    "text": "text",
    "nothing": "None",
    "list": "a list",
    "mapping": "a mapping",
    "struct": "a message",
}

_BUILT_IN: Mapping[str, tuple[type, ...]] = {
    "number": (int, float),
    "text": (str,),
    "nothing": (type(None),),
    "list": (list, tuple, range),
    "mapping": (dict,),
}
"""The classes of Python that values of a kind may have. A struct may be a list or an object."""


def kinds(type_: Type) -> Kinds:
    """The kinds that a value of a type can have: `number`, `text`, `list`, `mapping`, `struct`,
    `nothing`. Empty if they are unknown, as for `T?`, which conditions usually test before."""
    if type_.name in ("literal", "one_of"):
        return frozenset(
            "text" if isinstance(argument, str) else "number" for argument in type_.args
        )
    return _KINDS.get(type_.name, ANYTHING)


def fails(word: str, left: Type, right: Type) -> bool:
    """Whether an operation or comparison of two values fails, whichever they are."""
    pairs = [(one, other) for one in kinds(left) for other in kinds(right)]
    return bool(pairs) and not any(_works(word, *pair) for pair in pairs)


_ALIKE: Mapping[str, tuple[str, ...]] = {
    "+": ("number", "text", "list"),
    **dict.fromkeys(("<", "<=", ">", ">="), ("number", "text", "list")),
}


def _works(word: str, one: str, other: str) -> bool:
    """Whether two kinds go together in an operation."""
    if word in ("in", "not in"):
        if other == "text":
            return one == "text"
        return other in ("list", "struct") or (other == "mapping" and one != "mapping")
    if word in ("==", "!="):
        return True
    if word == "%" and one == "text":
        # Python fills in texts so.
        return True
    if "struct" in (one, other):
        # It may be an object, such as an array, that can do what lists cannot.
        return {one, other} <= {"struct", "list", "number"}
    if word == "*" and {one, other} in ({"number", "text"}, {"number", "list"}):
        return True
    return one == other and one in _ALIKE.get(word, ("number",))


def never_equal(left: Type, right: Type) -> bool:
    """Whether any two values of the types differ. False for a type that includes nothing, because a
    state can run before the value is set."""
    enumerations = {"one_of", "literal"}
    if "one_of" in (left.name, right.name) and {left.name, right.name} <= enumerations:
        return not any(one == other for one in left.args for other in right.args)
    one, other = kinds(left), kinds(right)
    unsure = {"nothing", "struct"}
    return bool(one and other) and not (one & other or (one | other) & unsure)


def can_be_negated(type_: Type) -> bool:
    """Whether some value of a type takes a sign."""
    found = kinds(type_)
    return not found or bool(found & {"number", "struct"})


def can_be_called(type_: Type) -> bool:
    found = kinds(type_)
    return not found or "struct" in found


def has_attribute(type_: Type, name: str) -> bool:
    """Whether some value of a type may have an attribute."""
    if type_.name in ATTRIBUTES:
        return name.startswith("_") or name in ATTRIBUTES[type_.name]
    found = kinds(type_)
    return not found or any(hasattr(type_, name) for kind in found for type_ in _BUILT_IN[kind])


def _attributes(type_: Type) -> list[str]:
    """The attributes that values of a type have in Python."""
    classes = [other for kind in kinds(type_) for other in _BUILT_IN.get(kind, ())]
    return sorted({name for class_ in classes for name in dir(class_) if not name.startswith("_")})


def is_method(type_: Type, name: str) -> bool:
    """Whether an attribute is a method of every value of a type."""
    classes = [other for kind in kinds(type_) for other in _BUILT_IN.get(kind, (object,))]
    return bool(classes) and all(callable(getattr(class_, name, None)) for class_ in classes)


def can_be_indexed(owner: Type, index: Type) -> bool:
    """Whether some value of a type has items with such an index."""
    known, wanted = kinds(owner), kinds(index)
    if not known or "struct" in known:
        return True
    if not known & {"text", "list", "mapping"}:
        return False
    if not wanted or "struct" in wanted:
        return True
    # The entries of mappings in a script have text as names.
    named = owner.name in ("mapping", "record") or bool(owner.args)
    by_number = bool(known & {"text", "list"}) or not named
    return (by_number and "number" in wanted) or ("mapping" in known and "text" in wanted) or (
        "mapping" in known and not named and bool(wanted - {"list", "mapping"})
    )  # fmt: skip


def _no_meaning(one: str, other: str) -> str | None:
    """The effect of an operation on numbers in two units between which there is no factor."""
    if conversion(other, one) is not None:
        return None
    return f"a number in `{one}` and a number in `{other}` give no meaningful result"


def _in_one_unit(one: str, other: str, right: str) -> str:
    """The help for two numbers in different units; `right` is the text of the second one."""
    factor = conversion(other, one)
    if factor is None:
        return (
            f"use a number in `{one}` in place of `{right}`, or correct the unit of one of the two"
        )
    whole = round(1 / factor)
    text = f"({right})" if " " in right else right
    if whole > 1 and math.isclose(1 / factor, whole):
        return f"1 {one} is {whole} {other}: write `{text} / {whole}`"
    return f"1 {other} is {factor:.6g} {one}: write `{text} * {factor:.6g}`"


class Signature(NamedTuple):
    """What a function of Python takes: how many arguments, which keywords, and the kinds of value
    that its first argument may be where it is alone (`many`: at all)."""

    least: int
    most: int
    keywords: tuple[str, ...] = ()
    kinds: Kinds = ANYTHING
    many: Kinds = ANYTHING


_ITEMS = frozenset(["text", "list", "mapping", "struct"])
_NUMBER = frozenset(["number", "struct"])
_PARSED = frozenset(["number", "text", "struct"])
_MANY = 1_000_000

SIGNATURES: Mapping[str, Signature] = {
    "abs": Signature(1, 1, (), _NUMBER, _NUMBER),
    "bool": Signature(0, 1),
    "float": Signature(0, 1, (), _PARSED, _PARSED),
    "int": Signature(0, 2, ("base",), _PARSED, _PARSED),
    "len": Signature(1, 1, (), _ITEMS, _ITEMS),
    "list": Signature(0, 1, (), _ITEMS, _ITEMS),
    "max": Signature(1, _MANY, ("default", "key"), _ITEMS),
    "min": Signature(1, _MANY, ("default", "key"), _ITEMS),
    "range": Signature(1, 3, (), _NUMBER, _NUMBER),
    "round": Signature(1, 2, ("ndigits", "number"), _NUMBER, _NUMBER),
    "sorted": Signature(1, 1, ("key", "reverse"), _ITEMS, _ITEMS),
    "str": Signature(0, 3, ("object", "encoding", "errors")),
    "sum": Signature(1, 2, ("start",), _ITEMS, _ITEMS),
    "tuple": Signature(0, 1, (), _ITEMS, _ITEMS),
}
"""The functions that every expression may call (evaluate.py), but for `dict`, which takes much."""


def _whole_number(expr: Expr) -> int | None:
    """The whole number that an expression is; None for another one."""
    match expr:
        case Unary("-", inner):
            number = _whole_number(inner)
            return -number if number is not None else None
        case Constant(bool()):
            return None
        case Constant(int() | float() as value) if math.isfinite(value) and value == int(value):
            return int(value)
    return None

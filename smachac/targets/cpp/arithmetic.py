"""`+ - * / // % **` as C++: whole numbers are checked, floats are not."""

from __future__ import annotations

from smachac.ir.types import Type
from smachac.targets.cpp.terms import (
    BOOL,
    NUMBER,
    PRODUCT,
    SIGNED,
    SUM,
    Term,
    Text,
    call,
    cpp,
    fixed,
    has,
    inside,
    join,
    number,
    present,
    shown,
)
from smachac.targets.cpp.types import FLOAT, INT, STR, UnportableError, cpp_literal

CHECKED = {
    "+": "add",
    "-": "subtract",
    "*": "multiply",
    "//": "floor_divide",
    "%": "modulo",
    "/": "divide",
}
BINDING = {"+": SUM, "-": SUM, "*": PRODUCT}


def signed(sign: str, operand: Term) -> Term:
    """`-x` and `+x`."""
    kind = number(operand.type)
    if kind is None:
        raise UnportableError(f"a `{shown(operand.type)}` has no sign")
    value = whole(operand) if kind == INT else real(operand)
    if kind == INT:
        return fixed(
            INT, call("negate", value.text) if sign == "-" else call("add", "0", value.text)
        )
    return fixed(kind, Text(f"-{value.at(SIGNED + 1)}", SIGNED) if sign == "-" else value)


def whole(term: Term) -> Text:
    """A whole number, or a truth value, as an argument that is a whole number."""
    return term.spell(present(term.type))


def real(term: Term) -> Text:
    """A number as a float, rounded where it has to be."""
    kind = present(term.type)
    if term.constant is not None and kind == INT:
        return term.spell(FLOAT)
    value = term.spell(kind)
    return call("real", value.text) if kind in (INT, BOOL) else value


def binary(word: str, left: Term, right: Term) -> Term:
    """An operation. Raises UnportableError where Python would raise TypeError."""
    one, other = number(left.type), number(right.type)
    if one is not None and other is not None:
        return _numbers(word, one, other, left, right)
    kinds = present(left.type), present(right.type)
    match word, kinds[0].name, kinds[1].name:
        case "+", "str", "str":
            return _joined_texts(left, right)
        case "+", ("list" | "array"), ("list" | "array"):
            return _joined_lists("list", left, right)
        case "+", "tuple", "tuple":
            return _joined_lists("tuple", left, right)
        case "*", ("str" | "list" | "array" | "tuple"), _ if other == INT:
            return _repeated(left, right)
        case "*", _, ("str" | "list" | "array" | "tuple") if one == INT:
            return _repeated(right, left)
    raise UnportableError(f"`{shown(left.type)}` {word} `{shown(right.type)}` has no value")


def _numbers(word: str, one: Type, other: Type, left: Term, right: Term) -> Term:
    if word == "**":
        return _power(one, other, left, right)
    if one == other == INT:
        return fixed(FLOAT if word == "/" else INT, call(CHECKED[word], *_wholes(left, right)))
    type_ = FLOAT if FLOAT in (one, other) or word == "/" else NUMBER
    first, second = real(left), real(right)
    if word in BINDING:
        own = BINDING[word]
        return fixed(type_, Text(f"{first.at(own)} {word} {second.at(own + 1)}", own))
    return fixed(type_, call(CHECKED[word], first.text, second.text))


def _wholes(left: Term, right: Term) -> tuple[str, str]:
    """Two whole numbers for a function that takes two floats as well: one says which is meant."""
    first, second = whole(left).text, whole(right).text
    if any(present(each.type) == INT and each.constant is None for each in (left, right)):
        return first, second
    return f"std::int64_t{{{first}}}", second


def _power(one: Type, other: Type, left: Term, right: Term) -> Term:
    if one == other == INT:
        exponent = right.constant
        if not isinstance(exponent, int):
            raise UnportableError(
                "the sign of the exponent says whether this is a float: write `float(...)`"
            )
        if exponent >= 0:
            return fixed(INT, call("power", *_wholes(left, right)))
    type_ = FLOAT if FLOAT in (one, other) or one == other == INT else NUMBER
    return fixed(type_, call("power", real(left).text, real(right).text))


def _joined_texts(left: Term, right: Term) -> Term:
    first, second = left.spell(STR).at(SUM), right.spell(STR).at(SUM + 1)
    if isinstance(right.constant, str) and "\0" not in right.constant:
        second = cpp_literal(right.constant)
    elif isinstance(left.constant, str) and "\0" not in left.constant:
        first = cpp_literal(left.constant)
    return fixed(STR, Text(f"{first} + {second}", SUM))


def _joined_lists(kind: str, left: Term, right: Term) -> Term:
    item = join(inside(present(left.type)), inside(present(right.type)))
    type_ = Type(kind, (item,))
    texts = (
        each.spell(type_).text if has(each.type, "never") else each.present()
        for each in (left, right)
    )
    return fixed(type_, call(f"concat<{cpp(item)}>", *texts))


def _repeated(items: Term, times: Term) -> Term:
    kind = present(items.type)
    type_ = (
        kind if kind == STR else Type("tuple" if kind.name == "tuple" else "list", kind.args[:1])
    )
    return fixed(type_, call("repeat", items.present(), whole(times).text))
